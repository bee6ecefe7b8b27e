"""Several robots on one clock and one CAN bus."""

import pytest

from hil_sim.address import AddressError, parse
from hil_sim.assembly import assemble
from hil_sim.clock import Clock
from hil_sim.devices.canframe import Frame
from hil_sim.devices.canstation import CanStation
from hil_sim.devices.canwire import CanWire
from hil_sim.faults.happening import schedule
from hil_sim.journal import CAN_HEARD, CAN_SENT
from hil_sim.worlds import cpython, micropython
from tests.bench_fakes import bench_of
from tests.invariants import Excuse

ADDRESS = "circular@{}?body=still"
ECHO = """
from machine import SPI
from firmware.drivers.mcp2515 import Mcp2515
can = Mcp2515(SPI(0, 8_000_000), Pin(17, Pin.OUT, value=1), 8_000_000)
can.begin(500_000)
while True:
    if can.receive():
        can.send(can.identifier + 1, can.data, can.length)
    time.sleep_ms(1)
"""


class Company:
    """Robots with the numbers 1, 2, ... on one clock and one bus."""

    def __init__(self, count: int) -> None:
        self.clock = Clock()
        self.wire = CanWire(self.clock)
        self.benches = [assemble(parse(ADDRESS.format(n)), self.clock, self.wire) for n in range(1, count + 1)]

    def run_ms(self, ms: int) -> None:
        self.clock.run_until(self.clock.now_us + 1000 * ms)


@pytest.fixture
def company():
    made = Company(3)
    yield made
    for bench in made.benches:
        bench.close()


def test_a_robot_does_in_company_what_it_does_alone(company):
    alone = assemble(parse(ADDRESS.format(2)))

    company.run_ms(700)
    alone.clock.run_until(700_000)

    assert company.benches[1].trace_sha256() == alone.trace_sha256()
    alone.close()


def test_closing_one_robot_leaves_the_others_running(company):
    company.run_ms(200)

    company.benches[0].close()
    company.benches[0].close()
    left = company.benches[0].trace_sha256()
    company.run_ms(500)

    assert company.benches[0].trace_sha256() == left
    assert [bench.world.running for bench in company.benches] == [False, True, True]
    assert len(company.wire.nodes) == 2
    assert not any(bench.crashes for bench in company.benches)


def test_a_closed_robot_has_no_power_whatever_is_broken(company):
    bench = company.benches[0]
    bench.witness.excuse(Excuse(late_us=300_000))  # two faults at once
    company.run_ms(200)
    for fault in ("contactor-welded", "mosfet-stuck:A"):
        schedule(bench, 200_000, fault)
    company.run_ms(50)
    assert bench.coil_gate("A") == 1.0

    bench.close()
    company.run_ms(500)

    assert bench.coil_gate("A") == 0.0
    assert bench.coil("A").off_at_us == 250_000


def test_a_fault_that_was_planned_for_a_closed_robot_does_not_wake_it(tmp_path):
    plan = tmp_path / "faults.toml"
    plan.write_text('[[fault]]\nname = "reset"\nat_ms = 400\n')
    clock = Clock()
    bench = assemble(parse(f"circular@1?body=still&faults={plan}"), clock, CanWire(clock))
    clock.run_until(200_000)

    bench.close()
    clock.run_until(600_000)

    assert (bench.world.resets, bench.world.running) == (0, False)


@pytest.mark.parametrize("world", [cpython, micropython], ids=["cpython", "micropython"])
def test_frames_of_anybody_are_in_the_journal_of_the_board_they_reach_and_leave(tmp_path, driver, world):
    clock = Clock()
    wire = CanWire(clock)
    bench = bench_of(tmp_path, ECHO, driver, execute=world.execute, keep_journal=True, clock=clock, can_wire=wire)
    foreign, other = CanStation(wire, 500_000), CanStation(wire, 500_000)
    clock.run_until(100_000)

    foreign.send(Frame(0x123, b"\x01\x02"))
    clock.run_until(120_000)

    crossed = [entry for entry in bench.journal.kept() if entry[1] in (CAN_SENT, CAN_HEARD)]
    assert [entry[1:] for entry in crossed] == [
        (CAN_HEARD, 0x123, b"\x00\x02\x01\x02"),
        (CAN_SENT, 0x124, b"\x00\x02\x01\x02"),
    ]
    assert other.received == [Frame(0x123, b"\x01\x02"), Frame(0x124, b"\x01\x02")]
    bench.close()


def test_a_robot_is_given_its_number_before_it_boots(company):
    numbers = [bench.board.flash.read("settings.0") for bench in company.benches]
    unnumbered = assemble(parse("circular?body=still"))

    company.run_ms(200)

    assert len(set(numbers)) == 3
    assert "settings.0" not in unnumbered.board.flash.paths()
    assert not any(bench.crashes for bench in company.benches)
    unnumbered.close()


def test_robots_of_a_kind_with_different_numbers_are_different_specimens(company):
    assert len({bench.board.unique_id for bench in company.benches}) == 3


def test_the_number_is_written_after_the_name_or_as_an_option():
    assert (parse("sim:circular@7?slope=2").robot, parse("sim:circular@7?slope=2").node) == ("circular", 7)
    assert parse("circular?node=126").node == 126
    assert parse("circular").node == 0
    assert parse("./my@home/robot.toml").robot == "./my@home/robot.toml"


@pytest.mark.parametrize("text", ["circular@0", "circular@127", "circular?node=x"])
def test_a_number_that_no_robot_can_have_is_refused(text):
    with pytest.raises(AddressError, match="a whole number from 1 to 126"):
        parse(text)


@pytest.fixture
def driver(request):
    """The files of the CAN driver."""
    root = request.config.rootpath
    text = (root / "firmware" / "drivers" / "mcp2515.py").read_text()
    return {"firmware/drivers/mcp2515.py": text, "firmware/__init__.py": "", "firmware/drivers/__init__.py": ""}
