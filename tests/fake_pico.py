"""A Pico on a USB port: a pseudo-terminal, a folder as its flash, and after each reset what the board would do.

While its program runs it is a bench in virtual time, on what stands in the folder; in service mode its console is the
real MicroPython interpreter (raw_repl.py). The seconds after a reset take none here: what is said then is said again
whenever it was read, so that a host hears it however late it opens the port.

    with FakePico(folder) as pico:
        deploy(pico.port)
"""

import fcntl
import os
import pty
import struct
import subprocess
import termios
import threading
import tty
from pathlib import Path
from select import select

from hil_sim.bench import Bench, Parts
from hil_sim.worlds.image import Image
from hil_sim.worlds.micropython import interpreter
from hil_sim.worlds.world import CTRL_C
from tests.bench_fakes import FakePlant
from tests.slot_bench import said

SCRIPT = Path(__file__).with_name("raw_repl.py")
RESET = 42
SETTLED_S = 60


class FakePico:
    """The board; `benches` are the lives of its program so far, `cut_after` pulls the cable after so many bytes.

    With `ran` the console is first found after a crash, the watchdog about to bite.
    """

    def __init__(self, folder: Path, cut_after: int = 1 << 60, ran: bool = False) -> None:
        self.folder = folder
        self.benches: list[Bench] = []
        self.failures: list[BaseException] = []
        self._left = cut_after
        self._found = ["ran"] if ran else []
        self._host, line = pty.openpty()
        tty.setraw(line)
        self.port = os.ttyname(line)
        self._line = line
        self._console: subprocess.Popen | None = None
        self.ordered = threading.Event()  # set: its program was ordered to open the console
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._live)

    def __enter__(self) -> "FakePico":
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._ended.set()
        self._thread.join()
        for end in (self._host, self._line):
            if end >= 0:
                os.close(end)
        assert not self.failures

    def _live(self) -> None:
        try:
            while not self._ended.is_set():
                if self._runs():
                    self._console_until_reset()
        except BaseException as failure:
            self.failures.append(failure)
        finally:
            if self._console is not None:
                self._console.kill()
                self._console.wait()

    def _runs(self) -> bool:
        """Run the program until Ctrl-C; return whether the console has the board now."""
        if self._found or not (self.folder / "main.py").exists():
            return True
        bench, pressed = self._settled(), False
        while "softrig: service" not in said(bench):
            if self._ended.is_set():
                return False
            if not (pressed or self._unread()):
                os.write(self._host, f"{said(bench)[-1]}\r\n".encode())
            if select([self._host], [], [], 0.05)[0] and b"\x03" in os.read(self._host, 4096):
                pressed = True
                bench.world.interrupt()
                bench.run(1)
            if self.ordered.is_set():
                self.ordered.clear()
                bench.world._life.heed(CTRL_C)  # as when the program itself raises KeyboardInterrupt
                bench.world.interrupt()
                bench.run(1)
        self._keep(bench)
        return True

    def _unread(self) -> int:
        """Return how many bytes wait for the host."""
        return struct.unpack("i", fcntl.ioctl(self._line, termios.FIONREAD, bytes(4)))[0]

    def _settled(self) -> Bench:
        """Return a bench on which the program in the folder has become healthy, or was rolled back."""
        parts = Parts([(0x60, output) for output in range(8)], [0.5] * 8)
        bench = Bench(parts, FakePlant(), Image.of_folder(self.folder))
        self.benches.append(bench)
        for _ in range(SETTLED_S):
            bench.run(1)
            if said(bench)[-1:] and said(bench)[-1].startswith("softrig: "):
                break
        self._keep(bench)
        return bench

    def _keep(self, bench: Bench) -> None:
        """Put what the program has written into the folder."""
        for path in ("boot.0", "boot.1"):
            if path in bench.board.flash.paths():
                (self.folder / path).write_bytes(bench.board.flash.read(path))

    def _console_until_reset(self) -> None:
        command = [interpreter(), str(SCRIPT), str(self.folder), *self._found]
        self._found = []
        self._console = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        said = self._console.stdout.fileno()
        while self._console.poll() is None and not self._ended.is_set():
            ready = select([self._host, said], [], [], 0.05)[0]
            if said in ready and self._host >= 0:
                os.write(self._host, os.read(said, 4096))
            if self._host in ready:
                self._heard(os.read(self._host, 4096))
        if self._console.returncode == RESET:
            os.write(self._host, self._console.stdout.read())
        elif self._console.returncode is not None:
            raise AssertionError(f"the console ended with {self._console.returncode}")

    def _heard(self, data: bytes) -> None:
        """Hand the host's bytes on, until the cable is pulled."""
        self._left -= len(data)
        if self._left <= 0:
            self._ended.set()
            os.close(self._line)
            os.close(self._host)
            self._host = self._line = -1
            return
        self._console.stdin.write(data)
