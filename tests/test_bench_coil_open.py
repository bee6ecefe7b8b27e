"""A coil whose wire is broken: it takes no current and stays cold, whatever it is driven with."""

import pytest

from hil_sim.address import parse
from hil_sim.assembly import assemble
from hil_sim.faults.happening import schedule
from hil_sim.robots.file import RobotFileError
from tests.bench_fakes import bench_of

HEATING = "begin()\nbeat.toggle()\nset_output(0, 1000)\nset_output(1, 1000)\nwhile True: beat_for(1000)"
EACH_A = 2.0 / (9.5 + 0.5 + 0.02)


@pytest.fixture
def bench(tmp_path):
    bench = bench_of(tmp_path, HEATING)
    yield bench
    bench.close()


def test_an_open_coil_stays_cold_and_the_other_gets_its_share_of_the_drop(bench):
    schedule(bench, 0, "coil-open:A")

    bench.run(2.0)

    assert bench.coil_gate("A") == 1.0
    assert bench.coil("A").peak_degc == 25.0
    assert bench.coil("B").peak_degc > 26
    assert bench.supply.current_a == pytest.approx(EACH_A)


def test_a_coil_that_breaks_while_it_is_on_takes_nothing_from_then_on(bench):
    schedule(bench, 1_000_000, "coil-open:A")

    bench.run(1.0)
    energy_j = bench.coil("A").energy_j
    bench.run(1.0)

    assert energy_j > 0.3
    assert bench.coil("A").energy_j == energy_j


def test_a_mended_coil_is_as_it_was(bench):
    schedule(bench, 0, "coil-open:A")
    schedule(bench, 1_000_000, "coil-whole:A")

    bench.run(2.0)

    assert bench.supply.power_w[0] == pytest.approx(bench.supply.power_w[1])
    assert bench.coil("A").energy_j == pytest.approx(bench.supply.power_w[0] * 1.0, rel=0.01)


@pytest.mark.parametrize(
    ("fault", "told"),
    [
        ("coil-open", "fault coil-open: write coil-open:LABEL"),
        ("coil-open:Z", "fault coil-open:Z: name a coil of this robot, as in coil-open:A"),
        ("coil-opn:A", "no fault 'coil-opn:A': known are .*coil-open.*did you mean coil-open"),
    ],
)
def test_a_fault_of_no_coil_is_refused(bench, fault, told):
    with pytest.raises(ValueError, match=told):
        schedule(bench, 0, fault)


def test_an_address_breaks_coils_before_the_run():
    bench = assemble(parse("sim:circular?open=B,D&open=F"))

    bench.run(0.1)
    bench.supply.drive([(0.0, 1.0)] * 8, 655.36)
    bench.supply.solve(bench.plant.resistance)

    powers = dict(zip(bench.plant.labels, bench.supply.power_w, strict=True))
    assert [label for label, power_w in powers.items() if not power_w] == ["B", "D", "F"]
    bench.close()


def test_an_address_that_breaks_a_coil_the_robot_has_not_is_refused():
    with pytest.raises(RobotFileError, match="open=A00m1: circular has no such coil"):
        assemble(parse("sim:circular?open=A00m1"))
