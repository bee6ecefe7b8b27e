"""Fuzz targets: the text protocols of CAN adapters. Whatever is typed, an answer comes and the bus goes on."""

from hil_sim.can.desk import CanDesk
from hil_sim.can.slcan import LINE_MAX, Slcan
from hil_sim.can.socketcand import PENDING_MAX, Socketcand
from hil_sim.devices.canframe import Frame
from tests.fuzz_script import Script


def slcan(data: bytes) -> None:
    """Lines of LAWICEL's adapters, whole and broken."""
    terminal = _typed(Slcan, data, b"")
    assert len(terminal._line) <= LINE_MAX + 1


def socketcand(data: bytes) -> None:
    """Commands in angle brackets, whole and broken."""
    terminal = _typed(Socketcand, data, b"< open can0 >< rawmode >")
    assert len(terminal._pending) <= PENDING_MAX


def _typed(make, data: bytes, begin: bytes):
    """Type the input in pieces with frames of another host between them."""
    script, desk = Script(data), CanDesk()
    terminal, other = make(desk), desk.host(500_000)
    terminal.take(begin)
    while script:
        act = script.byte()
        assert isinstance(terminal.take(script.some()), bytes)
        if act & 1 and other.room:
            other.send(Frame(act << 3, bytes(act % 9)))
        desk.clock.run_until(desk.clock.now_us + 20 * act)
        assert isinstance(terminal.told(), bytes)
    terminal.close()
    return terminal
