"""The console of a board as MicroPython's own: raw REPL with raw paste, for mpremote to talk to.

Run by the real interpreter: micropython raw_repl.py FOLDER [ran]. The folder is the flash, mounted at the root.
`machine.reset` ends the process with status 42. `ran`: a program has just crashed, and its watchdog will bite.
"""

import io
import struct
import sys

import micropython
import vfs

RESET = 42
WINDOW = 128
BANNER = b"raw REPL; CTRL-B to exit\r\n>"


class Flash(vfs.VfsPosix):
    """A folder as the flash. This interpreter's own `rename` mixes its two paths up when the root is a folder."""

    def rename(self, path, onto):
        """Put a file in the place of another."""
        with self.open(path, "rb") as file:
            data = file.read()
        with self.open(onto, "wb") as file:
            file.write(data)
        self.remove(path)


class Machine:
    """What a console may do to the processor."""

    def reset(self):
        """Start the board anew."""
        sys.exit(RESET)


def take(count):
    """Return `count` bytes of the host; the process ends with the line."""
    data = b""
    while len(data) < count:
        more = sys.stdin.buffer.read(1)
        if not more:
            sys.exit(0)
        data += more
    return data


def say(data):
    """Send bytes to the host."""
    sys.stdout.buffer.write(data)


def pasted():
    """Return what the host pastes, a window at a time; it ends with Ctrl-D."""
    say(b"R\x01" + struct.pack("<H", WINDOW))
    text, left = bytearray(), WINDOW
    while True:
        byte = take(1)
        if byte == b"\x04":
            say(b"\x04")
            return bytes(text)
        text += byte
        left -= 1
        if not left:
            say(b"\x01")
            left = WINDOW


def execute(source, space):
    """Run what was sent; say what it printed, then its error."""
    error = b""
    try:
        exec(compile(source, "<stdin>", "exec"), space)
    except Exception as problem:
        told = io.StringIO()
        sys.print_exception(problem, told)
        error = told.getvalue().encode()
    say(b"\x04" + error + b"\x04>")


def serve(space):
    """Serve the host for ever."""
    raw, line = False, b""
    while True:
        byte = take(1)
        if byte == b"\x01":
            raw, line = True, b""
            say(BANNER)
        elif byte == b"\x02":
            raw, line = False, b""
            say(b"\r\nMicroPython\r\n>>> ")
        elif byte == b"\x03":
            line = b""
        elif raw and byte == b"\x05" and not line:
            assert take(2) == b"A\x01"
            execute(pasted(), space)
        elif raw and byte == b"\x04":
            say(b"OK")
            execute(line, space)
            line = b""
        else:
            line += byte


micropython.kbd_intr(-1)
vfs.umount("/")
vfs.mount(Flash(sys.argv[1]), "/")
sys.path[:] = ["", ".frozen", "/lib"]
sys.modules["machine"] = Machine()
space = {"__name__": "__main__"}
if sys.argv[2:] == ["ran"]:
    sys.path.insert(0, "/a")
    space["SERVICE"] = 3
    space["change"] = lambda field, value: open("/asked", "w").close()
serve(space)
