"""Real ports in front of a bench: a pseudo-terminal, a TCP port, and the wall clock they keep pace with.

Pacing is a wrapper around virtual time: the bench never learns of it, and bytes take their baud rate's time because
the virtual line makes them. When this process is held up, virtual time waits with it; it never jumps to catch up.

    with Pty(link=Path("robot")) as pty:
        serve(bench.clock, [SerialEnd(bench, [pty])], Pace(speed=1.0), ended)
"""

import os
import select
import socket
import termios
import time
import tty
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Protocol, Self

from hil_sim.bench import Bench
from hil_sim.clock import Clock

STALL_S = 0.020
TICK_S = 0.001
CHUNK = 65_536
LOOPBACK = "127.0.0.1"


class PortError(OSError):
    """A port or link that cannot be made; the text says why."""


class Port(Protocol):
    """Where bytes of a host come from and go to."""

    def handles(self) -> list[int]:
        """Return the file descriptors that may become readable."""

    def read(self) -> bytes:
        """Return what has come in."""

    def write(self, data: bytes) -> None:
        """Pass bytes on; what nobody takes is lost, as on a wire."""


class Pace:
    """Wall time turned into virtual time. `slipped_s` is how long this process has been held up."""

    def __init__(self, speed: float, wall_s: Callable[[], float] = time.monotonic) -> None:
        self.slipped_s = 0.0
        self._speed = speed
        self._wall_s = wall_s
        self._seen_s = wall_s()
        self._rest_us = 0.0

    def passed_us(self) -> int:
        """Return how much virtual time has passed since the last call, at most STALL_S of wall time's worth."""
        now_s = self._wall_s()
        passed_s = min(now_s - self._seen_s, STALL_S)
        self.slipped_s += now_s - self._seen_s - passed_s
        self._seen_s = now_s
        self._rest_us += passed_s * 1e6 * self._speed
        whole_us = int(self._rest_us)
        self._rest_us -= whole_us
        return whole_us


class End(Protocol):
    """Where the bench meets the world outside."""

    def handles(self) -> list[int]:
        """Return the file descriptors that may become readable."""

    def exchange(self) -> None:
        """Take in what has come, and pass on what the bench has to say."""


def serve(clock: Clock, ends: Sequence[End], pace: Pace, ended: Callable[[], bool]) -> None:
    """Run the benches of a clock in step with the wall clock until `ended` says so."""
    while not ended():
        select.select([handle for end in ends for handle in end.handles()], [], [], TICK_S)
        clock.run_until(clock.now_us + pace.passed_us())
        for end in ends:
            end.exchange()


class SerialEnd:
    """The serial line of a bench, with ports at its other end."""

    def __init__(self, bench: Bench, ports: Sequence[Port]) -> None:
        self._bench = bench
        self._ports = ports

    def handles(self) -> list[int]:
        """Return those of the ports."""
        return [handle for port in self._ports for handle in port.handles()]

    def exchange(self) -> None:
        """Move bytes both ways."""
        for port in self._ports:
            data = port.read()
            if data:
                self._bench.board.host_write(data)
        data = self._bench.board.uart.host_read(self._bench.clock.now_us)
        if data:
            for port in self._ports:
                port.write(data)


class Pty:
    """A pseudo-terminal in raw mode, at `path`; and at `link`, where one is asked for, as long as it lives.

    The far end is kept open here, so hosts may come and go.
    """

    def __init__(self, link: Path | None = None) -> None:
        _check_link(link)
        self._near, self._far = os.openpty()
        tty.setraw(self._far)
        os.set_blocking(self._near, False)
        self.path = os.ttyname(self._far)
        self.link = link
        if link is None:
            return
        try:
            _place_link(link, self.path)
        except OSError as error:
            self.link = None
            self.close()
            raise PortError(f"link {link}: {error.strerror}") from error

    def handles(self) -> list[int]:
        """Return the near end."""
        return [self._near]

    def read(self) -> bytes:
        """Return what the host has written."""
        try:
            return os.read(self._near, CHUNK)
        except BlockingIOError:
            return b""

    def write(self, data: bytes) -> None:
        """Let the host read; when nobody has for a while, what waits is dropped, so that a new host finds no past."""
        try:
            os.write(self._near, data)
        except BlockingIOError:
            self.forget()

    def offer(self, data: bytes) -> int:
        """Let the host read as much of `data` as there is room for; return how much that is."""
        try:
            return os.write(self._near, data)
        except BlockingIOError:
            return 0

    def forget(self) -> None:
        """Drop what waits to be read."""
        termios.tcflush(self._far, termios.TCIFLUSH)

    def close(self) -> None:
        """Take the terminal and its link away."""
        if self.link is not None and self.link.is_symlink() and os.readlink(self.link) == self.path:
            self.link.unlink()
        os.close(self._near)
        os.close(self._far)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


class Tcp:
    """A TCP port, on this machine only unless told otherwise; one host at a time, the next is refused.

    `port` 0 takes any free one.
    """

    def __init__(self, port: int, address: str = LOOPBACK) -> None:
        self._listener = listening(port, address)
        self._host: socket.socket | None = None
        self.port: int = self._listener.getsockname()[1]

    def handles(self) -> list[int]:
        """Return the listener and, where there is one, the host."""
        return [self._listener.fileno(), *([self._host.fileno()] if self._host is not None else [])]

    def read(self) -> bytes:
        """Return what the present host has sent, and take in a new one when it has hung up."""
        data = self._receive(CHUNK)
        if data == b"" or (data and self._receive(1, socket.MSG_PEEK) == b""):
            self._leave()
        self._accept()
        return data or b""

    def write(self, data: bytes) -> None:
        """Send to the host if there is one."""
        if self._host is None:
            return
        try:
            self._host.send(data)
        except BlockingIOError:
            pass
        except OSError:
            self._leave()

    def close(self) -> None:
        """Stop listening and hang up."""
        self._leave()
        self._listener.close()

    def _receive(self, count: int, flags: int = 0) -> bytes | None:
        """Return what there is, b"" when the host has hung up, None when there is nothing."""
        if self._host is None:
            return None
        try:
            return self._host.recv(count, flags)
        except BlockingIOError:
            return None
        except OSError:
            return b""

    def _accept(self) -> None:
        try:
            host, _ = self._listener.accept()
        except BlockingIOError:
            return
        if self._host is not None:
            host.close()
            return
        host.setblocking(False)
        host.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._host = host

    def _leave(self) -> None:
        if self._host is not None:
            self._host.close()
            self._host = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


def listening(port: int, address: str = LOOPBACK) -> socket.socket:
    """Return a socket that listens there and never blocks; PortError when it cannot. `port` 0 takes any free one."""
    listener = socket.socket(socket.AF_INET6 if ":" in address else socket.AF_INET, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((address, port))
    except OSError as error:
        listener.close()
        raise PortError(f"TCP port {port}: {error.strerror}") from error
    listener.listen(1)
    listener.setblocking(False)
    return listener


def _check_link(link: Path | None) -> None:
    if link is None:
        return
    if not link.parent.is_dir():
        raise PortError(f"link {link}: there is no folder {link.parent}")
    if os.path.lexists(link) and not link.is_symlink():
        raise PortError(f"link {link}: something that is not a symbolic link is there already; it stays")


def _place_link(link: Path, path: str) -> None:
    """Put a symbolic link in its place in one step."""
    waiting = link.with_name(f".{link.name}.{os.getpid()}")
    waiting.unlink(missing_ok=True)
    waiting.symlink_to(path)
    waiting.replace(link)
