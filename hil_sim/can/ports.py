"""CAN adapters in front of a desk of robots, for programs that know nothing of a bench: slcan and socketcand.

Both only move text; the protocols are in slcan.py and socketcand.py. Whole messages are lost when nobody reads, never
parts of one, and whatever arrives is answered or dropped.

    with SlcanPort(desk) as slcan, SocketcandPort(desk, 29_536) as server:
        serve(desk.clock, [slcan, server], Pace(speed=1.0), ended)
"""

import socket
from pathlib import Path
from types import TracebackType
from typing import Self

from hil_sim.can.desk import CanDesk
from hil_sim.can.slcan import Slcan
from hil_sim.can.socketcand import Socketcand
from hil_sim.ports import CHUNK, LOOPBACK, Pty, listening

WAITING_MAX = 65_536  # bytes that a reader may be behind
CLIENTS_MAX = 16
CHANNEL = "can0"  # that socketcand's clients may name


class SlcanPort:
    """An slcan adapter on a pseudo-terminal."""

    def __init__(self, desk: CanDesk, link: Path | None = None) -> None:
        self._pty = Pty(link)
        self._adapter = Slcan(desk)
        self._waiting = b""
        self._openings = 0

    @property
    def address(self) -> str:
        """What `--robot` takes, without the number of a robot."""
        return f"can:slcan:{self._pty.link.absolute() if self._pty.link else self._pty.path}"

    def handles(self) -> list[int]:
        """Return the terminal's."""
        return self._pty.handles()

    def exchange(self) -> None:
        """Move text both ways; who opens the channel finds no past."""
        answers = self._adapter.take(self._pty.read())
        if self._openings != self._adapter.openings:
            self._openings = self._adapter.openings
            self._pty.forget()
            self._waiting = b""
        said = answers + self._adapter.told()
        if len(self._waiting) + len(said) <= WAITING_MAX:
            self._waiting += said
        if self._waiting:
            self._waiting = self._waiting[self._pty.offer(self._waiting) :]

    def close(self) -> None:
        """Take the adapter away."""
        self._adapter.close()
        self._pty.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


class SocketcandPort:
    """A socketcand server on this machine only, for several clients at once; `port` 0 takes any free one."""

    def __init__(self, desk: CanDesk, port: int) -> None:
        self._desk = desk
        self._listener = listening(port)
        self._clients: list[_Client] = []
        self.port: int = self._listener.getsockname()[1]

    @property
    def address(self) -> str:
        """What `--robot` takes, without the number of a robot."""
        return f"can:socketcand:{LOOPBACK}:{self.port}"

    def handles(self) -> list[int]:
        """Return the listener's and those of the clients."""
        return [self._listener.fileno(), *(client.line.fileno() for client in self._clients)]

    def exchange(self) -> None:
        """Take in new clients, move text both ways, and let go of those that have hung up."""
        self._accept()
        for client in list(self._clients):
            if not client.exchange():
                client.close()
                self._clients.remove(client)

    def close(self) -> None:
        """Hang up, and listen no more."""
        for client in self._clients:
            client.close()
        self._clients.clear()
        self._listener.close()

    def _accept(self) -> None:
        try:
            line, _ = self._listener.accept()
        except BlockingIOError:
            return
        if len(self._clients) >= CLIENTS_MAX:
            line.close()
            return
        line.setblocking(False)
        line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._clients.append(_Client(line, Socketcand(self._desk)))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


class _Client:
    """One client of the server."""

    def __init__(self, line: socket.socket, protocol: Socketcand) -> None:
        self.line = line
        self._protocol = protocol
        self._waiting = protocol.greeting

    def exchange(self) -> bool:
        """Move text both ways; return whether the client is still there and reads now and then."""
        try:
            data = self._received()
            if data == b"":
                return False
            self._waiting += self._protocol.take(data or b"")
            told = self._protocol.told()
            if len(self._waiting) + len(told) <= WAITING_MAX:
                self._waiting += told
            if self._waiting:
                self._waiting = self._waiting[self.line.send(self._waiting) :]
        except BlockingIOError:
            pass
        except OSError:
            return False
        return len(self._waiting) <= 2 * WAITING_MAX

    def close(self) -> None:
        """Hang up and leave the bus."""
        self._protocol.close()
        self.line.close()

    def _received(self) -> bytes | None:
        """Return what has come, b"" when the client has hung up, None when there is nothing."""
        try:
            return self.line.recv(CHUNK)
        except BlockingIOError:
            return None
