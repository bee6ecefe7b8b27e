"""The first thing a MicroPython process runs: the bench's hardware, time and flash take the place of its own.

Then boot.py and main.py, as on a board. What escapes them is told to the bench, which records it as a crash.
"""

import builtins
import io
import sys
import time  # noqa: F401

import machine  # noqa: F401  (found here, before the flash takes the place of this folder)
import micropython
import vfs
from bench import CRASH, DESK, FILES, READ, line

CTRL_C = 3


class Bytes(io.IOBase):
    """A file that is read piece by piece, as from flash: an import need not hold its source in memory."""

    def __init__(self, name) -> None:
        self._name = name.encode()
        self._at = 0
        self._size = line.call(DESK, "size", (name,))

    def readinto(self, buffer) -> int:
        """Fill the front of a buffer and return how much."""
        count = min(len(buffer), self._size - self._at)
        if count:
            line.ask(READ, 0, 0, self._at.to_bytes(4, "little") + count.to_bytes(4, "little") + self._name)
            line.take(memoryview(buffer)[:count])
            self._at += count
        return count

    def read(self, count=-1) -> bytes:
        """Return that many bytes, or all that are left."""
        left = self._size - self._at
        buffer = bytearray(left if count < 0 else min(count, left))
        self.readinto(buffer)
        return bytes(buffer)

    def seek(self, offset, whence=0) -> int:
        """Go to a place, counted from the beginning, from here or from the end, and return it."""
        self._at = offset + (0, self._at, self._size)[whence]
        return self._at

    def ioctl(self, request, argument) -> int:
        """Close, the one thing that is asked."""
        return 0

    def close(self) -> None:
        """Nothing is to be given back."""

    def __enter__(self):
        return self

    def __exit__(self, *raised) -> None:
        pass


class Flash:
    """The board's file system: all of it stands on the bench."""

    def __init__(self) -> None:
        self._folders = {""}
        self._files = set(line.call(DESK, "paths"))
        for path in self._files:
            parts = path.split("/")
            for depth in range(1, len(parts)):
                self._folders.add("/".join(parts[:depth]))

    def mount(self, readonly, mkfs) -> None:
        """Nothing is to be prepared."""

    def umount(self) -> None:
        """Nothing is to be given back."""

    def chdir(self, path) -> None:
        """There is one folder to be in."""

    def getcwd(self) -> str:
        """Return that folder."""
        return "/"

    def stat(self, path):
        """Return what `import` asks for: whether it is a file or a folder."""
        name = path.strip("/")
        if name not in self._files and name not in self._folders:
            raise OSError(2)
        return (0x8000 if name in self._files else 0x4000, 0, 0, 0, 0, 0, 0, 0, 0, 0)

    def open(self, path, mode):
        """Return a file of the flash."""
        name = path.strip("/")
        if mode not in ("r", "rt", "rb"):
            self._files.add(name)
            return line.call(FILES, "open", (name, mode))
        return Bytes(name) if mode == "rb" else io.StringIO(Bytes(name).read().decode())


def say(*values, sep=" ", end="\n", file=None) -> None:
    """Print on the console of the bench, or into a file."""
    text = sep.join([str(value) for value in values]) + end
    if file is None:
        line.call(DESK, "say", (text,))
    else:
        file.write(text)


class Micropython:
    """The module `micropython`, but that Ctrl-C is what is pressed on the bench."""

    def __init__(self) -> None:
        for name in dir(micropython):
            setattr(self, name, getattr(micropython, name))
        self.kbd_intr = heed


def heed(character) -> None:
    """Let that character of the console raise KeyboardInterrupt; -1: none does."""
    line.call(DESK, "heed", (character,))


def told(error) -> str:
    """Return an exception as the bench records it: itself in the first line, then where it came from."""
    trace = io.StringIO()
    sys.print_exception(error, trace)
    return f"{type(error).__name__}({', '.join([repr(value) for value in error.args])})\n{trace.getvalue()}"


def run(name, space) -> None:
    """Run a file of the flash, if there is one."""
    try:
        with open(name) as file:
            text = file.read()
    except OSError:
        return
    heed(CTRL_C)
    exec(compile(text, name, "exec"), space)


def main() -> None:
    """Boot."""
    builtins.print = say
    sys.modules["micropython"] = Micropython()
    vfs.umount("/")
    vfs.mount(Flash(), "/")
    sys.path[:] = ["", ".frozen", "/lib"]
    space = {"__name__": "__main__"}
    try:
        run("boot.py", space)
        run("main.py", space)
        line.flush()
    except BaseException as error:
        line.ask(CRASH, 0, 0, told(error).encode())


main()
