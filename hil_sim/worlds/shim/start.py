"""The first thing a MicroPython process runs: the bench's hardware, time and flash take the place of its own.

Then boot.py and main.py, as on a board. What escapes them is told to the bench, which records it as a crash.
"""

import builtins
import io
import sys
import time  # noqa: F401

import machine  # noqa: F401  (found here, before the flash takes the place of this folder)
import vfs
from bench import CRASH, DESK, FILES, line


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
        if "w" in mode:
            self._files.add(name)
            return line.call(FILES, "open", (name, mode))
        data = line.call(DESK, "read", (name,))
        return io.BytesIO(data) if "b" in mode else io.StringIO(data.decode())


def say(*values, sep=" ", end="\n", file=None) -> None:
    """Print on the console of the bench, or into a file."""
    text = sep.join([str(value) for value in values]) + end
    if file is None:
        line.call(DESK, "say", (text,))
    else:
        file.write(text)


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
    exec(compile(text, name, "exec"), space)


def main() -> None:
    """Boot."""
    builtins.print = say
    vfs.umount("/")
    vfs.mount(Flash(), "/")
    sys.path[:] = ["", ".frozen", "/lib"]
    space = {"__name__": "__main__"}
    try:
        run("boot.py", space)
        run("main.py", space)
    except BaseException as error:
        line.ask(CRASH, 0, 0, told(error).encode())


main()
