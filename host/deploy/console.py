"""The console of a board (a Pico's USB port), through mpremote; and the files on its flash.

Ctrl-C makes the firmware switch off and reset into service mode, because nothing but a reset stops its watchdog. The
port disappears with that reset and comes back, so opening it means trying until the console answers and no program has
run since the reset. mpremote resets the interpreter by itself only when asked to, and here it never is.

    with Console("/dev/ttyACM0") as console:
        console.hashes("/b")
"""

from __future__ import annotations

import io
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from typing import Any

from host.errors import BadRequest, LinkLost, NoRobot, NotOurs, PortAbsent, PortBusy, PortForbidden, SoftrigError

OPEN_S = 25.0  # to reset, to be listed by USB again, to answer
ABSENT_S = 5.0  # a port that is not there by then was never there
PAUSE_S = 0.3
CHUNK_BYTES = 512
OPENED_BY = (
    "a robot with a pairing key opens it only by --robot ADDRESS, any robot with GP22 bridged to ground at reset"
)
# What main.py has defined is at hand on the console; its `change` writes under a watchdog that is long enough.
RAN = "import sys\nprint(sys.path[0] in ('/a', '/b'))"
RESET = "import machine, time\ntime.sleep_ms(100)\nmachine.reset()"  # once the console has acknowledged it
ASK_FOR_SERVICE = f"change(SERVICE, 1)\n{RESET}"
LIST = """
import os, hashlib, binascii
def listed(folder):
    for row in os.ilistdir(folder):
        path = folder + "/" + row[0]
        if row[1] & 0x4000:
            listed(path)
            continue
        with open(path, "rb") as file:
            digest, block = hashlib.sha256(), file.read(512)
            while block:
                digest.update(block)
                block = file.read(512)
        print(binascii.hexlify(digest.digest()).decode(), path)
"""


class Console:
    """An open console, nothing running on the board; SoftrigError says why it cannot be had."""

    def __init__(self, port: str) -> None:
        self.port = port
        self._transport = _opened(port)

    def __enter__(self) -> Console:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the port."""
        _close(self._transport)

    def hashes(self, folder: str) -> dict[str, str]:
        """Return the SHA-256 of every file below a folder by its path in it; none when there is no such folder."""
        with _told(self.port):
            text = self._transport.exec(f"{LIST}\ntry:\n listed({folder!r})\nexcept OSError:\n pass\n").decode()
        rows = [line.split(" ", 1) for line in text.splitlines() if line]
        return {path.removeprefix(folder).lstrip("/"): digest for digest, path in rows}

    def read(self, path: str) -> bytes | None:
        """Return a file's bytes, or None when there is none."""
        with _told(self.port):
            try:
                return bytes(self._transport.fs_readfile(path))
            except FileNotFoundError:
                return None

    def write(self, path: str, data: bytes, progress: Callable[[int], None] = lambda done: None) -> None:
        """Write a file, and the folders that it needs."""
        with _told(self.port):
            for folder in _folders(path):
                with suppress(FileExistsError):
                    self._transport.fs_mkdir(folder)
            self._transport.fs_writefile(path, data, CHUNK_BYTES, lambda done, total: progress(done))

    def rename(self, path: str, onto: str) -> None:
        """Put a file in the place of another, at once and whole."""
        with _told(self.port):
            self._transport.exec(f"import os\nos.rename({path!r}, {onto!r})")

    def remove(self, path: str) -> None:
        """Take a file away."""
        with _told(self.port):
            self._transport.fs_rmfile(path)

    def reset(self) -> None:
        """Start the board anew, and let go of the port: it goes away with that."""
        with suppress(SoftrigError), _told(self.port):
            self._transport.exec_raw_no_follow(RESET)
        self.close()


def lines(port: str, for_s: float) -> Iterator[str]:
    """Yield the lines that a running board prints, for so long; it is not disturbed, and may reset meanwhile."""
    import serial  # noqa: PLC0415

    until_s = time.monotonic() + for_s
    heard, line = b"", None
    try:
        while time.monotonic() < until_s:
            try:
                line = line or serial.Serial(port, timeout=PAUSE_S, exclusive=True)
                heard += line.read(1) + line.read(line.in_waiting)
            except OSError:
                line = None
                time.sleep(PAUSE_S)
            *whole, heard = heard.split(b"\n")
            for text in whole:
                yield text.decode(errors="replace").strip()
    finally:
        if line is not None:
            line.close()


def _opened(port: str) -> Any:
    """Return mpremote's transport, in a console that nothing disturbs; ask for service until it is so."""
    begun_s = time.monotonic()
    patience_s: dict[type[SoftrigError], float] = {PortAbsent: ABSENT_S, PortBusy: 0.0, PortForbidden: 0.0}
    while True:
        try:
            transport = _entered(port)
            if _in_service(port, transport):
                return transport
            patience_s = {}  # it resets: now the port may be anything for a while
        except (NoRobot, LinkLost) as error:
            if time.monotonic() - begun_s >= patience_s.get(type(error), OPEN_S):
                raise
        if time.monotonic() - begun_s >= OPEN_S:
            raise NotOurs(f"{port}: the board does not go into service mode; {OPENED_BY}")
        time.sleep(PAUSE_S)


def _in_service(port: str, transport: Any) -> bool:
    """Return whether no program has run since the last reset, so that no watchdog does; else ask for service."""
    try:
        with _told(port):
            if transport.exec(RAN).strip() == b"False":
                return True
            transport.exec_raw_no_follow(ASK_FOR_SERVICE)
            time.sleep(PAUSE_S)
    except SoftrigError:
        _close(transport)
        raise
    _close(transport)
    return False


def _entered(port: str) -> Any:
    try:
        from mpremote.transport_serial import SerialTransport  # noqa: PLC0415
    except ImportError:
        raise BadRequest("softrig deploy needs mpremote: pip install 'softrig[deploy]'") from None
    _accessible(port)
    with _told(port):
        transport = SerialTransport(port, timeout=1)
    try:
        with _told(port):
            transport.enter_raw_repl(soft_reset=False, timeout_overall=3)
    except SoftrigError:
        _close(transport)
        raise
    return transport


def _accessible(port: str) -> None:
    if not os.path.exists(port):
        raise PortAbsent(f"there is no port {port}; `softrig ports` lists them")
    if not os.access(port, os.R_OK | os.W_OK):
        raise PortForbidden(f"{port} may not be opened by this user; on Debian and Ubuntu: sudo adduser $USER dialout")


@contextmanager
def _told(port: str) -> Iterator[None]:
    """Turn what mpremote and the port raise into errors of ours, and keep what mpremote prints off the terminal."""
    from mpremote.transport import TransportError, TransportExecError  # noqa: PLC0415

    try:
        with redirect_stdout(io.StringIO()):
            yield
    except TransportExecError as error:
        last = error.error_output.strip().splitlines()
        raise NotOurs(f"{port}: the board answers: {last[-1] if last else 'nothing'}") from error
    except TransportError as error:
        busy = "failed to access" in str(error)
        hint = "" if busy else f"; {OPENED_BY}"
        raise (PortBusy if busy else NotOurs)(f"{port}: no console of MicroPython there ({error}){hint}") from error
    except FileNotFoundError:
        raise
    except OSError as error:
        raise LinkLost(
            f"{port}: the line broke ({error}); plug it in and deploy again, it goes on where it was"
        ) from error


def _close(transport: Any) -> None:
    with suppress(OSError):
        transport.close()


def _folders(path: str) -> list[str]:
    parts = path.strip("/").split("/")[:-1]
    return ["/" + "/".join(parts[: depth + 1]) for depth in range(len(parts))]
