"""Lines to a robot: one interface, whatever carries the bytes.

An address is opened by the scheme before its first colon, found among the entry points `softrig.links`; an address
without a scheme is a serial port. Only this file and deploy/console.py read the wall clock or wait on the host side.

    link = open_link("/dev/ttyACM0")
    link.write(b"...")
    data = link.read(link.now_s() + 0.1)
"""

from __future__ import annotations

import errno
import os
import re
import select
import socket
import time
from contextlib import suppress
from importlib.metadata import entry_points
from typing import Any, NoReturn, Protocol

from host.errors import BadRequest, LinkLost, NoRobot, PortAbsent, PortBusy, PortForbidden, SoftrigError
from host.holder import holder_of

BAUD = 115200
BAUD_MAX = 4_000_000
CONNECT_S = 5.0
WRITE_S = 2.0
CHUNK = 65536
LOST = (OSError, ValueError, TypeError)  # the last two are those of a port that closes while it is waited for


class Link(Protocol):
    """A line that carries bytes both ways, and the clock that its waiting goes by.

    It may have two things more. `repeatable`, True where what passes over the line depends on nothing but its address,
    as on a bench in this process: then the host brings neither its memory of other runs nor randomness of the system
    into the run; missing means False. And `reopen()`, of a line that can break: it returns the same line, opened again,
    or raises NoRobot; the broken one still tells the time and lets it pass by `pause(until_s)`.
    """

    def now_s(self) -> float:
        """Return the host's clock: virtual on a bench in this process, monotonic on a port."""

    def write(self, data: bytes) -> None:
        """Send all of `data`, or raise LinkLost."""

    def read(self, until_s: float) -> bytes:
        """Return bytes as soon as there are any, b"" at `until_s`, or raise LinkLost."""

    def close(self) -> None:
        """Let go of the line; closing twice does nothing."""

    @property
    def observer(self) -> Any:
        """Return what watches the robot from outside, or None.

        It has `observe()` and `snapshot()`, and may have `watch(glance)`: to call `glance` with the line's clock in ms
        whenever the body has moved on while the host waits.
        """


def open_link(address: str) -> Link:
    """Open the line at `address`; BadRequest when no scheme serves it, NoRobot and its kin when it cannot be had."""
    if not address.strip():
        raise BadRequest("no robot was named: write sim:circular, the path of a port, or socket://HOST:PORT")
    if not address.isprintable():
        raise BadRequest(f"{address!r} is no address: it holds what cannot be printed")
    schemes = {point.name: point for point in entry_points(group="softrig.links")}
    scheme, colon, _ = address.partition(":")
    if not (colon and scheme in schemes):
        if colon and re.fullmatch("[a-z][a-z0-9]+", scheme) and not os.path.exists(address):
            known = ", ".join(f"{name}:" for name in sorted(schemes))
            raise BadRequest(f"no line {scheme}: known are {known} and the path of a port")
        return open_serial(address)
    try:
        link: Link = schemes[scheme].load()(address)
    except (OSError, LookupError) as error:
        raise NoRobot(f"{address}: {error}") from error
    except ValueError as error:
        raise BadRequest(f"{address}: {error}") from error
    return link


def open_serial(address: str) -> Link:
    """Open a serial port or pty, for this program alone: `serial:PATH@BAUD`, of which the path is enough."""
    import serial  # noqa: PLC0415

    path, baud = _path_and_baud(address.removeprefix("serial:"))
    refusals: tuple[type[Exception], ...] = (OSError, ValueError, *_terminal_errors())
    try:
        port = serial.Serial(path, baud, timeout=0, write_timeout=WRITE_S, exclusive=True)
    except refusals as error:
        _refuse_port(path, error)
    return SerialLink(port, path, baud)


def open_socket(address: str) -> Link:
    """Open `socket://HOST:PORT`."""
    match = re.fullmatch(r"socket:(?://)?(?P<host>\[[0-9a-fA-F:]+\]|[^:/\s]+):(?P<port>\d{1,5})/?", address)
    if match is None:
        raise BadRequest(f"{address}: write it as socket://127.0.0.1:7000")
    place = (match["host"].strip("[]"), int(match["port"]))
    try:
        line = socket.create_connection(place, timeout=CONNECT_S)
    except (OSError, OverflowError) as error:
        raise PortAbsent(
            f"{address}: {_one_line(error)}; start the bench with `softrig sim NAME --tcp {place[1]}`"
        ) from error
    line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return SocketLink(line, address)


def wall_s() -> float:
    """Return the wall clock's seconds, for figures of speed that no decision rests on."""
    return time.perf_counter()


def monotonic_s() -> float:
    """Return the clock of a line that has none of its own."""
    return time.monotonic()


def pause_until(until_s: float) -> None:
    """Let time pass on that clock."""
    time.sleep(max(0.0, until_s - time.monotonic()))


class SerialLink:
    """A serial port that is ours alone."""

    observer = None

    def __init__(self, port: Any, path: str, baud: int = BAUD) -> None:
        self._port = port
        self._path = path
        self._baud = baud

    def now_s(self) -> float:
        """Return the monotonic clock."""
        return time.monotonic()

    def write(self, data: bytes) -> None:
        """Send all of `data`; LinkLost when the port is gone or takes nothing for two seconds."""
        try:
            self._port.write(data)
        except LOST as error:
            raise LinkLost(_lost(self._path, error)) from error

    def read(self, until_s: float) -> bytes:
        """Return bytes as soon as there are any, or b"" at `until_s`; LinkLost when the port is gone."""
        try:
            data = self._waited(max(0.0, until_s - time.monotonic()))
        except LOST as error:
            raise LinkLost(_lost(self._path, error)) from error
        if data is None:
            raise LinkLost(_lost(self._path, None))
        return data

    def close(self) -> None:
        """Let go of the port."""
        with suppress(OSError):  # of one that has gone
            self._port.close()

    def reopen(self) -> Link:
        """Return the same port, opened again."""
        self.close()
        return open_serial(f"{self._path}@{self._baud}")

    def pause(self, until_s: float) -> None:
        """Let time pass without the port."""
        time.sleep(max(0.0, until_s - time.monotonic()))

    def _waited(self, seconds: float) -> bytes | None:
        """Return what arrived within `seconds`; None at the end of the line."""
        if os.name != "posix":
            self._port.timeout = seconds
            return bytes(self._port.read(1) + self._port.read(self._port.in_waiting))
        if not select.select([self._port], [], [], seconds)[0]:
            return b""
        return os.read(self._port.fileno(), CHUNK) or None


class SocketLink:
    """A TCP connection to a bench or a serial server."""

    observer = None

    def __init__(self, line: socket.socket, address: str) -> None:
        self._line = line
        self._address = address

    def now_s(self) -> float:
        """Return the monotonic clock."""
        return time.monotonic()

    def write(self, data: bytes) -> None:
        """Send all of `data`; LinkLost when the other end is gone or takes nothing for two seconds."""
        try:
            self._line.settimeout(WRITE_S)
            self._line.sendall(data)
        except LOST as error:
            raise LinkLost(_lost(self._address, error)) from error

    def read(self, until_s: float) -> bytes:
        """Return bytes as soon as there are any, or b"" at `until_s`; LinkLost when the other end is gone."""
        try:
            if not select.select([self._line], [], [], max(0.0, until_s - time.monotonic()))[0]:
                return b""
            data = self._line.recv(CHUNK)
        except LOST as error:
            raise LinkLost(_lost(self._address, error)) from error
        if not data:
            raise LinkLost(_lost(self._address, None))
        return data

    def close(self) -> None:
        """Let go of the connection."""
        with suppress(OSError):
            self._line.close()

    def reopen(self) -> Link:
        """Return a new connection to the same place."""
        self.close()
        return open_socket(self._address)

    def pause(self, until_s: float) -> None:
        """Let time pass without the connection."""
        time.sleep(max(0.0, until_s - time.monotonic()))


def _path_and_baud(text: str) -> tuple[str, int]:
    """Return what stands before and after the last @; a path that has one in itself may be followed by another."""
    path, at, baud = text.rpartition("@")
    if not at or (os.path.exists(text) and not os.path.exists(path)):
        return text, BAUD
    if not (baud.isascii() and baud.isdigit() and 0 < int(baud) <= BAUD_MAX):
        raise BadRequest(f"{text}: {baud!r} is no rate; write {path}@921600")
    return path, int(baud)


def _refuse_port(path: str, error: Exception) -> NoReturn:
    """Raise the error that says why the port cannot be had and what to do."""
    number = getattr(error, "errno", error.args[0] if error.args else None)
    told: SoftrigError
    if not os.path.exists(path) or number in (errno.ENOENT, errno.ENXIO, errno.ENODEV, errno.EIO):
        told = PortAbsent(f"no port {path}: `softrig ports` lists those there are")
    elif number in (errno.EACCES, errno.EPERM):
        told = PortForbidden(f"no permission for {path}: {_permission_of(path)}")
    elif number in (errno.EBUSY, errno.EAGAIN, errno.EWOULDBLOCK) or "lock" in str(error):
        told = PortBusy(f"{path} is held by {holder_of(path)}: end it, or use another port")
    else:
        told = PortAbsent(f"{path} is no serial port ({_one_line(error)}): `softrig ports` lists those there are")
    raise told from error


def _terminal_errors() -> tuple[type[Exception], ...]:
    """Return what a terminal raises that is taken away while it is set up: it is no OSError."""
    try:
        import termios  # noqa: PLC0415
    except ImportError:
        return ()
    return (termios.error,)


def _permission_of(path: str) -> str:
    """Return what gives this user the right to open `path`."""
    try:
        import grp  # noqa: PLC0415

        group = grp.getgrgid(os.stat(path).st_gid).gr_name
    except (ImportError, KeyError, OSError):
        return "run as a user who may open it"
    return f"it belongs to the group {group}; `sudo usermod -aG {group} $USER`, then log in again"


def _lost(address: str, error: Exception | None) -> str:
    cause = f" ({_one_line(error)})" if error else ""
    return f"{address}: the line broke{cause}; a robot that was armed switches everything off by itself"


def _one_line(error: Exception) -> str:
    """Return the error's text without the number and the lines after the first."""
    texts = [part for part in error.args if isinstance(part, str) and part]
    return str(getattr(error, "strerror", None) or next(iter(texts), type(error).__name__)).splitlines()[0]
