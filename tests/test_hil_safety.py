"""Safety on the whole path: whatever happens to host, line or firmware, every coil goes off within its stated time.

Times are those at which the coil's current stopped on the bench, after outputs, supply switch and monostable.
"""

import pytest

from host.errors import Refused, SoftrigError
from host.robot import Robot
from host.run import run
from protocol import frames, program
from protocol.messages import DICTIONARY

STEP_S = 0.005
LEASE_S = 0.5
MONOSTABLE_S = 0.05


def test_a_coil_cools_when_its_hold_is_over_though_the_cable_was_cut(rig):
    """The hold runs in firmware, so a cut cable cannot burn a coil."""
    on_s = rig.fire("A", duty_percent=80, hold_s=0.3)
    rig.run(seconds=0.1)

    rig.happens("cable-cut")
    rig.run_alone(seconds=2)

    assert rig.coil("A").off_at_s - on_s == pytest.approx(0.300, abs=STEP_S)


def test_a_killed_host_leaves_no_coil_on_longer_than_the_lease(rig):
    rig.fire("A", "B", duty_percent=30, hold_s=5)
    rig.run(seconds=0.2)
    killed_s = rig.now_s

    rig.run_alone(seconds=2)

    for label in "AB":
        assert rig.coil(label).off_at_s - killed_s <= LEASE_S + 2 * STEP_S


def test_a_cut_cable_leaves_no_coil_on_longer_than_the_lease(rig):
    rig.fire("A", duty_percent=30, hold_s=5)

    cut_s = rig.happens("cable-cut")
    with pytest.raises(SoftrigError):
        rig.robot.status()

    assert rig.coil("A").off_at_s - cut_s <= LEASE_S + 2 * STEP_S


def test_a_host_that_lives_keeps_its_coil_on_for_the_whole_hold(rig):
    on_s = rig.fire("A", duty_percent=30, hold_s=2)

    rig.run(seconds=2.5)

    assert rig.coil("A").off_at_s - on_s == pytest.approx(2.0, abs=STEP_S)


def test_stop_switches_off_within_one_control_step_of_its_arrival(rig):
    rig.fire("A", "C", duty_percent=60, hold_s=5)
    asked_s = rig.now_s

    stopped = rig.robot.stop()

    byte_s = 10 / 115_200
    assert stopped.coils == ("A", "C")
    for label in "AC":
        assert rig.coil(label).off_at_s - asked_s <= 6 * byte_s + 2 * STEP_S


def test_after_stop_nothing_moves_until_clear(rig):
    rig.fire("A", duty_percent=60, hold_s=5)
    rig.robot.stop()

    with pytest.raises(Refused, match="R02"):
        rig.robot.arm()
    rig.robot.clear()
    rig.fire("A", duty_percent=60, hold_s=0.1)


def test_a_hung_firmware_loses_its_outputs_to_the_monostable(rig):
    rig.fire("A", duty_percent=60, hold_s=5)
    rig.run(seconds=0.1)

    hung_s = rig.happens("hang")
    rig.run_alone(seconds=0.15)

    assert rig.coil("A").off_at_s - hung_s <= MONOSTABLE_S + STEP_S


def test_a_hung_firmware_is_restarted_by_its_watchdog_and_says_so(rig):
    rig.fire("A", duty_percent=60, hold_s=5)
    rig.happens("hang")
    rig.run_alone(seconds=1.0)

    again = rig.robot.__class__(rig.link)
    again.connect()

    status = again.status()
    assert (status.state, status.code) == ("tripped", 112)
    assert rig.coil("A").duty_percent == 0
    assert not rig.bench.any_coil_on


def test_an_opened_emergency_stop_cuts_the_coil_at_once(rig):
    rig.fire("A", duty_percent=60, hold_s=5)

    opened_s = rig.happens("estop-open")
    rig.run(seconds=0.1)

    assert rig.coil("A").off_at_s == pytest.approx(opened_s, abs=1e-6)
    assert rig.robot.status().state == "tripped"


LIMITS = [
    ({"duty_percent": 100.1, "hold_s": 1}, "R04"),
    ({"duty_percent": 50, "hold_s": 10.001}, "R05"),
]


@pytest.mark.parametrize(("order", "code"), LIMITS)
def test_an_order_beyond_a_limit_is_refused_and_heats_nothing(rig, order, code):
    rig.robot.arm()
    tested_s = rig.coil("A").on_at_s

    with pytest.raises(Refused, match=code):
        rig.fire("A", **order)

    rig.run(seconds=0.5)
    assert rig.coil("A").on_at_s == tested_s


def test_full_duty_trips_the_heat_budget_before_the_coil_burns(rig):
    rig.fire("A", duty_percent=100, hold_s=10)

    rig.run(seconds=3)

    assert rig.robot.status().state == "tripped"
    assert rig.bench.coil("A").peak_degc < 150


@pytest.mark.parametrize("chip", ["pwm-dead", "monitor-dead", "monitor-forgets", "i2c-stuck"])
def test_a_chip_that_fails_opens_the_coil_supply(rig, chip):
    rig.fire("A", duty_percent=60, hold_s=5)

    failed_s = rig.happens(chip)
    rig.run(seconds=1.0)

    assert rig.coil("A").off_at_s - failed_s <= 0.4  # settings are read back every 64 steps
    assert rig.robot.status().code == 108


@pytest.mark.parametrize("fault", ["thermistor-open", "thermistor-short"])
def test_a_broken_thermistor_is_not_believed(rig, fault):
    rig.fire("A", duty_percent=30, hold_s=5)

    rig.happens(fault)
    rig.run(seconds=1.0)

    assert rig.robot.status().code == 109
    assert not rig.bench.any_coil_on


def test_a_flood_of_requests_is_answered_in_whole_frames_and_makes_no_step_late(rig):
    """What does not fit the transmit buffer is lost on the board: answers wait for the line's room instead."""
    rig.robot.subscribe(5)
    on_s = rig.fire("A", duty_percent=30, hold_s=1)
    page = DICTIONARY.pack(part=0, offset=0, count=200)
    flood = frames.encode(frames.seal(DICTIONARY.number, 0, 0, page, 0, 0)) * 100

    rig.link.write(flood)
    rig.run(seconds=2)

    status = rig.robot.status()
    assert status.overruns == 0
    assert rig.robot.statistics()["frames_damaged"] == 0
    assert rig.coil("A").off_at_s - on_s == pytest.approx(1.0, abs=STEP_S)


def test_after_its_program_ended_no_coil_is_on_and_the_supply_is_open(rig):
    code = program.fire(0b11, 300, 200) + program.delay(200) + program.halt()

    run(rig.robot, program.header(code, rig.robot.profile.crc) + code, lambda stage, done: None)

    assert not rig.bench.any_coil_on
    assert not rig.bench.board.powered
    assert rig.robot.status().state == "idle"


def test_a_bus_held_low_is_told_also_after_a_reset(rig):
    """Each transfer on a stuck bus costs its time-out; the watchdog must still be fed and the fault told."""
    rig.fire("A", duty_percent=60, hold_s=5)
    rig.happens("i2c-stuck")
    rig.happens("reset")
    rig.run_alone(seconds=3)
    resets = rig.bench.world.resets

    again = Robot(rig.link)
    again.connect()

    assert again.status().state == "tripped"
    assert rig.bench.world.resets == resets == 1


def test_bursts_with_a_reset_between_them_cannot_burn_a_coil(rig):
    """What a reset forgets it takes for hot."""
    for _ in range(4):
        robot = Robot(rig.link)
        robot.connect()
        if robot.status().state == "tripped":
            robot.clear()
        robot.arm()
        robot.fire(["A"], 1000, 1000)
        rig.run_alone(seconds=1.0)
        rig.happens("reset")
        rig.run_alone(seconds=0.1)

    assert rig.bench.coil("A").peak_degc < 135
