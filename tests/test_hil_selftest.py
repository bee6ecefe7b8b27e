"""Coils on the whole path: what the robot measures of them before ARM and while armed, against what the bench knows.

The bench's coils have phase, stretch and heat of their own; the firmware sees current and voltage of the supply alone.
"""

import json

import pytest
from click.testing import CliRunner

from host.cli import main
from host.errors import Refused
from tests.hil_rig import HilRig

ROBOTS = ("circular", "sphere-a", "sphere-b")
HEATED = [("circular", "A", 0.7, 32), ("sphere-a", "A100", 0.55, 10), ("sphere-b", "A100", 0.7, 18)]  # to 90 C at least
SOME_MS_K = 3  # by which a coil has cooled or warmed since it was measured
BODIES = [
    "circular?supply=1.7", "circular?supply=2.5", "circular?set=ground.ambient_degc:5",
    "circular?set=wiring.lead_ohm:0.9",
    "circular?set=coils.resistivity_martensite_uohm_m:1.15", "sphere-a?set=battery.charge_percent:5",
    "sphere-a?set=battery.charge_percent:100", "sphere-a?set=battery.internal_ohm:0.9", "sphere-b?supply=4.4",
    "sphere-b?supply=5.5", "sphere-b?set=coils.strain_resistance_ratio:1.5",
]  # fmt: skip


@pytest.fixture
def rig_of():
    rigs = []

    def built(address):
        rigs.append(HilRig(f"sim:{address}"))
        return rigs[-1]

    yield built
    for rig in rigs:
        rig.link.close()


def truth(rig, label):
    """Return a coil's resistance [ohm] and temperature [degC] as only the bench knows them."""
    plant = rig.bench.plant
    index = list(plant.labels).index(label)
    return float(plant.resistance[index]), float(plant.temperature[index])


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_self_test_measures_every_coil_within_one_percent(rig_of, robot):
    rig = rig_of(robot)

    rig.robot.arm()

    for label, coil in rig.robot.coils().items():
        assert coil.resistance_ohm == pytest.approx(truth(rig, label)[0], rel=0.01)
        assert coil.martensite_percent == 100


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_self_test_warms_no_coil_by_more_than_a_kelvin_and_no_step_is_late(rig_of, robot):
    rig = rig_of(robot)

    begun_s = rig.now_s
    rig.robot.arm()

    assert rig.now_s - begun_s < 0.005 * (len(rig.bench.coils) + 12)
    assert max(rig.bench.plant.temperature) < 26
    assert rig.robot.status().overruns == 0


def seen_while(rig, label, seconds):
    """Yield each new measurement of a coil, and its true temperature some ms later."""
    last = rig.robot.coils()[label]
    until_s = rig.now_s + seconds
    while rig.now_s < until_s:
        rig.run(0.02)
        coil = rig.robot.coils()[label]
        if coil != last:
            yield coil, truth(rig, label)[1]
        last = coil


@pytest.mark.parametrize(("robot", "label", "boost_s", "hold_percent"), HEATED)
def test_the_bracket_holds_the_true_temperature_while_a_coil_is_heated(rig_of, robot, label, boost_s, hold_percent):
    rig = rig_of(robot)
    rig.fire(label, duty_percent=100, hold_s=boost_s)
    seen = list(seen_while(rig, label, boost_s))
    rig.fire(label, duty_percent=hold_percent, hold_s=3)
    seen += seen_while(rig, label, 3)
    rig.fire(label, duty_percent=2, hold_s=3)
    seen += seen_while(rig, label, 3)

    assert len(seen) >= 6
    for coil, degc in seen:
        assert coil.at_least_degc is None or coil.at_least_degc < degc + SOME_MS_K
        assert coil.at_most_degc is None or coil.at_most_degc > degc - SOME_MS_K
    shares = [coil.martensite_percent for coil, _ in seen]
    assert min(shares) < 55
    assert shares[-1] > 65


@pytest.mark.parametrize("body", BODIES)
def test_a_robot_that_differs_within_reason_is_armed_and_runs(rig_of, body):
    rig = rig_of(body)
    first, second = rig.robot.profile.labels[:2]

    rig.fire(first, second, duty_percent=60, hold_s=0.6)
    rig.run(0.8)
    rig.fire(first, duty_percent=15, hold_s=1.5)
    rig.run(1.6)

    assert rig.robot.status().state == "armed"


def test_many_coils_at_once_with_ramps_at_odd_duties_raise_no_doubt_and_no_late_step(rig_of):
    rig = rig_of("sphere-b")
    labels = rig.robot.profile.labels[:10]
    rig.robot.arm()
    for i, label in enumerate(labels):
        rig.robot.fire([label], 37 + 31 * i, 1200 + 100 * i)

    rig.run(3.0)

    status = rig.robot.status()
    assert (status.state, status.overruns) == ("armed", 0)


def test_a_coil_of_another_robot_is_refused_with_what_was_measured(rig_of):
    rig = rig_of("circular?set=coils.resistivity_martensite_uohm_m:2.0")

    with pytest.raises(Refused, match=r"coil A\) refused: F18 .* mohm, at most 15200"):
        rig.robot.arm()

    assert rig.robot.status().state == "idle"
    assert not rig.bench.board.powered


def softrig(*arguments):
    """Run a command and return it."""
    return CliRunner().invoke(main, [*arguments, "--json"])


def test_a_run_with_a_broken_coil_is_refused_by_its_name_and_the_way_out():
    told = softrig("run", "gaits/circular-crawl.gait", "--robot", "sim:circular?open=C")

    assert told.exit_code == 4
    assert "coil C" in told.output
    assert "--without" in told.output


def test_a_run_without_its_broken_coil_leaves_that_cold_and_does_the_rest():
    told = softrig("run", "gaits/circular-crawl.gait", "--robot", "sim:circular?open=C,G", "--without", "C,G")

    fields = json.loads(told.stdout)
    assert (told.exit_code, fields["result"]) == (0, "done")
    assert fields["observed"]["coil_on_s"]["C"] == 0
    assert fields["observed"]["coil_on_s"]["A"] > 1


def test_firing_only_what_is_broken_is_a_mistake():
    told = softrig("fire", "A", "--duty", "50%", "--hold", "200ms", "--robot", "sim:circular", "--without", "A")

    assert told.exit_code == 2
    assert "nothing to fire" in told.output


def test_the_coils_that_are_passed_over_must_be_the_robot_s():
    told = softrig("arm", "--robot", "sim:circular", "--without", "A,Z")

    assert told.exit_code == 2
    assert "no coil Z" in told.output


def test_status_shows_what_the_resistances_say_once_they_were_measured(rig_of):
    rig = rig_of("circular")
    assert str(rig.robot.coils()["A"]) == "not measured yet"

    rig.robot.arm()

    assert str(rig.robot.coils()["A"]).startswith("10.2")
    told = softrig("status", "--coils", "--robot", "sim:circular")
    assert set(json.loads(told.stdout)["coils_seen"]) == set("ABCDEFGH")
