"""Several robots and hosts on one CAN bus and one clock, in lock-step.

    desk = CanDesk(addresses("circular@1,sphere-b@2?slope=10"))
    host = desk.host(500_000)
    host.send(Frame(0x123, b"hello"))
    desk.clock.run_until(200_000)
    desk.benches[2].observe()
    desk.close()

Each part of a channel is an address as after `sim:`; a robot without a number gets the lowest that is free. A comma
after a question mark belongs to the options, unless an @ or another question mark follows before the next comma.
"""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING
from urllib.parse import quote

from hil_sim.address import NODE_MAX, Address, AddressError, parse
from hil_sim.can.host import CanHost
from hil_sim.clock import Clock
from hil_sim.devices.canwire import CanWire

if TYPE_CHECKING:
    from hil_sim.bench import Bench

BOOTED_US = 100_000  # the robots have been on for a moment when a host finds them


class CanDesk:
    """Robots by their numbers; ValueError, LookupError or OSError say in their text why one cannot be built."""

    def __init__(self, wanted: Sequence[Address] = ()) -> None:
        self.channel = ",".join(f"{address.robot}@{address.node or 1}" for address in wanted)
        self.clock = Clock()
        self.wire = CanWire(self.clock)
        self.benches: dict[int, Bench] = {}
        self._hosts: list[CanHost] = []
        try:
            self._build(wanted)
        except BaseException:
            self.close()
            raise

    def host(self, bitrate_hz: int, silent: bool = False, data_bitrate_hz: int = 0) -> CanHost:
        """Return the controller of one more host."""
        host = CanHost(self.wire, self.clock, bitrate_hz, silent, data_bitrate_hz)
        self._hosts.append(host)
        return host

    def leave(self, host: CanHost) -> int:
        """Take a host off the bus; return how many are left."""
        self._hosts.remove(host)
        self.wire.leave(host)
        return len(self._hosts)

    def run(self, until_us: int, host: CanHost) -> None:
        """Let time pass up to then, or until `host` has something to take."""
        host.alarm = self._stop
        try:
            self.clock.run_until(until_us)
        finally:
            host.alarm = None

    def close(self) -> None:
        """End all robots."""
        for bench in self.benches.values():
            bench.close()

    def _stop(self) -> None:
        self.clock.stop_at(self.clock.now_us)

    def _build(self, wanted: Sequence[Address]) -> None:
        from hil_sim.assembly import assemble  # noqa: PLC0415  (heavy: the compiled physics)

        for address in wanted:
            self.benches[address.node or 1] = assemble(address, self.clock, self.wire)
        self.clock.run_until(BOOTED_US)
        for number, bench in self.benches.items():
            if bench.crashes:
                raise OSError(f"the firmware of robot {number} ended while it booted: {bench.crashes[0].error}")


def addresses(channel: str, sought: int = 0, **options: object) -> list[Address]:
    """Return the robots of a channel, each with its number and those options; AddressError when two have the same.

    If none was given the number that is `sought`, the last one without a number gets it.
    """
    parts: list[str] = []
    for piece in filter(None, channel.split(",")):
        if parts and "?" in parts[-1] and not {"@", "?"} & set(piece):
            parts[-1] += "," + piece
        else:
            parts.append(piece)
    wanted = [parse(_with(part, options)) for part in parts]
    taken = [address.node for address in wanted if address.node]
    if not 0 <= sought <= NODE_MAX:
        raise AddressError(f"node={sought}: a whole number from 1 to {NODE_MAX}")
    nameless = [address for address in wanted if not address.node]
    if nameless and sought not in (0, *taken):
        nameless[-1].node = sought
        taken.append(sought)
    for address in wanted:
        if taken.count(address.node) > 1:
            raise AddressError(f"{channel}: two robots have the number {address.node}")
        if not address.node:
            address.node = _free(taken)
            taken.append(address.node)
    return wanted


def _with(part: str, options: Mapping[str, object]) -> str:
    words = "&".join(f"{name}={quote(str(value), safe=':/,')}" for name, value in options.items())
    return part + ("&" if "?" in part else "?") + words


def _free(taken: list[int]) -> int:
    for number in range(1, NODE_MAX + 1):
        if number not in taken:
            return number
    raise AddressError(f"more than {NODE_MAX} robots on one bus")
