"""Temperatures that given duties lead to, against a bench whose body is still."""

import numpy as np
import pytest

from hil_sim.assembly import parts_of, plant_of
from hil_sim.prediction import predictor
from hil_sim.robots.file import load
from hil_sim.supply import Supply

CLOSE = 0.05  # [K] steps of 1 ms against the longest ones
SCRIPTS = {
    "circular": [("A C", 800, 600), ("A", 300, 900), ("", 0, 2500), ("A B", 500, 700), ("", 0, 3000)],
    "sphere-a": [("A100 A010", 1000, 500), ("A100", 150, 1500), ("", 0, 2000)],
    "sphere-b": [("A100 B10m1", 600, 700), ("A100", 200, 800), ("", 0, 2500)],
}


@pytest.mark.parametrize("name", SCRIPTS)
def test_the_longest_steps_come_to_what_the_bench_comes_to_in_the_shortest(name):
    robot, ours = load(name), predictor(f"sim:{name}")

    theirs = still_bench(robot, SCRIPTS[name])
    found = []
    for labels, permille, time_ms in SCRIPTS[name]:
        found.append(ours.advance(duties(robot, labels, permille), time_ms).degc.copy())

    assert np.abs(np.array(found) - theirs).max() < CLOSE


def test_a_robot_is_known_by_its_name_alone_and_by_an_address_with_settings():
    bare, weak = predictor("circular"), predictor("sim:circular?supply=1")

    for coils in (bare, weak):
        coils.advance([1000] + [0] * 7, 300)

    assert bare.degc[0] > weak.degc[0] + 20


@pytest.mark.parametrize("name", ["no-such-robot", "fingers"])
def test_a_robot_without_a_model_or_without_coils_is_not_known(name):
    with pytest.raises(LookupError):
        predictor(name)


def test_a_coil_that_is_on_stops_time_at_its_limit_to_a_control_step():
    coils = predictor("sim:circular")

    passed = coils.advance([1000] + [0] * 7, 2000, limit_degc=[90] * 8)

    assert passed.ms < 1000
    assert 90 <= coils.degc[0] < 91.2  # 5 ms at full power


def test_what_is_asked_for_stops_time():
    coils = predictor("sim:circular")
    coils.advance([600] * 2 + [0] * 6, 800)

    passed = coils.advance([0] * 8, 20_000, until=(0b11, False, 45.0, True))

    assert passed.ms < 5000
    assert 44.8 < max(coils.degc[:2]) < 45


def test_a_coil_that_is_kept_stays_near_its_temperature():
    coils = predictor("sim:circular")
    limit = [80.0] * 8
    coils.advance([800] + [0] * 7, 2000, limit, kept=1)

    passed = coils.advance([800] + [0] * 7, 1000, limit, kept=1, every_ms=5)

    assert passed.ms == 1000
    assert np.abs(passed.trace[:, 1] - 80).max() < 1.5


def test_a_spare_coil_can_stand_for_another():
    coils = predictor("sim:circular", spare=1)
    coils.advance([800] + [0] * 8, 500)

    coils.copy(8, 0)
    coils.advance([0] * 9, 500)

    assert coils.degc[8] == coils.degc[0] > 50


def duties(robot, labels, permille):
    """Return the duty of each coil."""
    return [permille if label in labels.split() else 0 for label in robot.labels]


def still_bench(robot, script):
    """Return the temperatures at the end of each row of a script, from the bench's own plant and supply."""
    plant, parts = plant_of(robot, 1, "still"), parts_of(robot)
    series_ohm = np.array(parts.series_ohm)
    supply = Supply(series_ohm, parts.source_ohm, parts.shunt_ohm, parts.supply_v, parts.battery)
    places = [robot.wiring.outputs[label][1] / 16 for label in robot.labels]
    found = []
    for labels, permille, time_ms in script:
        widths = [each * 4096 // 1000 / 4096 for each in duties(robot, labels, permille)]
        supply.drive(list(zip(places, widths, strict=True)), 656.0)
        for _ in range(time_ms // 5):
            supply.solve(plant.resistance)
            plant.advance(5000, supply.power_w)
            supply.spend(5000)
        found.append(plant.temperature.copy())
    return np.array(found)


def test_coils_that_are_restarted_come_to_the_same_again():
    coils = predictor("sim:sphere-a")
    heated = [1000] * 3 + [0] * 15
    first = coils.advance(heated, 700).degc.copy()

    coils.restart()

    assert (coils.advance(heated, 700).degc == first).all()
