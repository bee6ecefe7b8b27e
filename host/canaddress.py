"""Addresses of robots on CAN, and the bus of python-can behind them.

`can:INTERFACE:CHANNEL[@NODE][?host=N&bitrate=500000&fd=1]`, NODE being the robot's number, 1 to 126; without it the
only robot that answers is meant. Other words after the question mark are options of python-can's interface. The channel
of `socketcand` is written HOST:PORT or HOST:PORT/NAME, where NAME is `can0` unless it is told.

    open_bus(parse("can:slcan:/dev/ttyACM0@3?bitrate=250000"))
"""

from __future__ import annotations

import errno
import logging
import os
import re
import socket
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any

from host.errors import BadRequest, NoRobot, PortAbsent, PortBusy, PortForbidden, SoftrigError
from host.holder import holder_of
from protocol.canbus import ALL, HOST, NODE_MAX

if TYPE_CHECKING:
    from can import BusABC

BITRATE_HZ = 500_000
CONNECT_S = 5.0
SHAPE = "can:INTERFACE:CHANNEL[@NODE][?host=1&bitrate=500000&fd=1], as can:slcan:/dev/ttyACM0@3"
_ADDRESS = re.compile(r"can:(?P<interface>\w+):(?P<channel>.+?)(?:@(?P<node>\d+|all))?(?:\?(?P<query>[^?@]*))?")
_ABSENT = (errno.ENOENT, errno.ENODEV, errno.ENXIO, errno.ECONNREFUSED, errno.EHOSTUNREACH, errno.ETIMEDOUT)


@dataclass(frozen=True)
class CanAddress:
    """A robot on a bus, or ALL that are on it, as host number `host` sees it."""

    text: str
    interface: str
    channel: str
    node: int = ALL
    host: int = HOST
    fd: bool = False
    bitrate_hz: int = BITRATE_HZ
    options: dict[str, Any] = field(default_factory=dict)


def parse(text: str) -> CanAddress:
    """Return what an address means; BadRequest says how one is written."""
    match = _ADDRESS.fullmatch(text)
    if match is None:
        raise BadRequest(f"{text}: write it as {SHAPE}")
    options = dict(_pairs(text, match["query"]))
    host, bitrate_hz, fd = (options.pop(*each) for each in (("host", HOST), ("bitrate", BITRATE_HZ), ("fd", 0)))
    node = ALL if match["node"] in (None, "all") else int(match["node"])
    for name, number in (("node", HOST if node == ALL and match["node"] != str(ALL) else node), ("host", host)):
        if not (isinstance(number, int) and 1 <= number <= NODE_MAX):
            raise BadRequest(f"{text}: {name} {number}, must be 1 to {NODE_MAX}")
    if not isinstance(bitrate_hz, int) or bitrate_hz <= 0 or fd not in (0, 1):
        raise BadRequest(f"{text}: bitrate is a number of bits per second, fd is 0 or 1")
    return CanAddress(text, match["interface"], match["channel"], node, host, bool(fd), bitrate_hz, options)


def open_bus(address: CanAddress) -> BusABC:
    """Open the bus of python-can; the error says in one line why it cannot be had and what to do."""
    import can  # noqa: PLC0415

    logging.getLogger("can").addHandler(logging.NullHandler())  # its warnings are ours to tell
    if address.interface not in can.VALID_INTERFACES:
        known = ", ".join(sorted(can.VALID_INTERFACES))
        raise BadRequest(f"{address.text}: python-can has no interface {address.interface}; it has {known}")
    try:
        return can.Bus(interface=address.interface, ignore_config=True, **_arguments(address, can.interfaces.BACKENDS))
    except (can.CanError, OSError, ImportError) as error:
        raise _refusal(address, error) from error
    except (ValueError, TypeError) as error:
        raise BadRequest(f"{address.text}: {first_line(error)}") from error


def first_line(error: BaseException) -> str:
    """Return the first line of an error's text, or its name where it has none."""
    texts = [part for part in error.args if isinstance(part, str) and part.strip()]
    return str(getattr(error, "strerror", None) or next(iter(texts), type(error).__name__)).strip().splitlines()[0]


def _pairs(text: str, query: str | None) -> Iterator[tuple[str, Any]]:
    for pair in filter(None, (query or "").split("&")):
        name, equals, value = pair.partition("=")
        if not (equals and name and value):
            raise BadRequest(f"{text}: {pair!r} is no option: write name=value")
        yield name, int(value) if value.isascii() and value.isdigit() else value


def _arguments(address: CanAddress, backends: Mapping[str, tuple[str, str]]) -> dict[str, Any]:
    """Return what python-can's interface is called with."""
    told = {"channel": address.channel, "bitrate": address.bitrate_hz, **({"fd": True} if address.fd else {})}
    module, name = backends[address.interface]
    if address.node != ALL and getattr(getattr(import_module(module), name, None), "takes_node", False):
        told["node"] = address.node  # it makes the robots, and wants to know how the one that is meant is called
    elif address.interface == "slcan":
        told["sleep_after_open"] = 0.0  # two seconds otherwise, for adapters that begin anew when they are opened
    elif address.interface == "socketcand":
        told |= _daemon(address)
    return {**told, **address.options}


def _daemon(address: CanAddress) -> dict[str, Any]:
    """Return where a socketcand listens, once somebody has answered there: python-can would knock for ten seconds."""
    match = re.fullmatch(r"(?P<host>\[[0-9a-fA-F:]+\]|[^:/]+):(?P<port>\d{1,5})(?:/(?P<name>\w+))?", address.channel)
    if match is None:
        raise BadRequest(f"{address.text}: write it as can:socketcand:127.0.0.1:29536@3, or with /can1 after the port")
    host, port = match["host"].strip("[]"), int(match["port"])
    with socket.create_connection((host, port), timeout=CONNECT_S):
        pass
    return {"host": host, "port": port, "channel": match["name"] or "can0"}


def _refusal(address: CanAddress, error: BaseException) -> SoftrigError:
    """Return the error that says why a bus cannot be had."""
    numbers = {number for each in _causes(error) if (number := getattr(each, "errno", None)) is not None}
    is_file = os.path.exists(address.channel)
    if numbers & {errno.EACCES, errno.EPERM}:
        return PortForbidden(f"{address.text}: no permission: run as a user who may open it")
    if numbers & {errno.EBUSY, errno.EAGAIN}:
        holder = f"held by {holder_of(address.channel)}" if is_file else "in use"
        return PortBusy(f"{address.text}: it is {holder}: end that program, or use another channel")
    if numbers & set(_ABSENT) or (address.channel.startswith("/") and not is_file):
        return PortAbsent(f"{address.text}: there is no such channel ({first_line(error)}): is the adapter plugged in?")
    return NoRobot(f"{address.text}: {first_line(error)}")


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__
