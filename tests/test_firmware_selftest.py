"""The self-test before ARM, on the core alone: what it finds, what it refuses with, that it leaves everything off."""

import pytest

from protocol import codes, messages
from protocol.frames import STOP
from tests.firmware_bench import SESSION, Rig, refusal

OPEN, SHORTED = 0, 600  # a coil's resistance with its wires [mohm]


@pytest.fixture
def rig():
    return Rig()


def in_the_middle(rig, steps=8):
    """Begin to arm and stop after so many control steps of the self-test."""
    rig.host.send(messages.ARM.number, messages.ARM.pack(session=SESSION, lease_ms=0, without=0), rig.now_ms)
    rig.run(5 * steps)
    assert rig.core.control.selftest.running


def test_a_sound_robot_is_armed_after_one_step_a_coil_and_a_few_for_its_switch(rig):
    begun_ms = rig.now_ms

    rig.arm()

    assert rig.core.state == messages.ARMED
    assert rig.now_ms - begun_ms <= 5 * (8 + 8)
    assert rig.board.powered
    assert rig.board.chip.duty_permille == [0] * 16


def test_each_coil_is_on_alone_and_never_longer_than_its_look(rig):
    pulses = []
    rig.board.wait_us = lambda time_us: pulses.append((time_us, tuple(rig.board.chip.duty_permille[:8])))

    rig.arm()

    assert {sum(duties) for _, duties in pulses} == {0, 1000}
    assert sorted({duties.index(1000) for _, duties in pulses if any(duties)}) == list(range(8))
    for channel in range(1, 8):
        assert sum(us for us, duties in pulses if duties[channel]) < 2000


BROKEN = [
    ("open", {"coil_mohm": {2: OPEN}}, (codes.COIL_OPEN, 2, 999_999, 15_200)),
    ("shorted", {"coil_mohm": {5: SHORTED}}, (codes.COIL_SHORT, 5, 80, 7600)),
    ("of another robot", {"coil_mohm": {0: 22_000}}, (codes.COIL_OPEN, 0, 21_502, 15_200)),
    ("stuck MOSFET", {"stuck_mask": 8}, (codes.STRAY_CURRENT, 255, 184, 25)),
    ("welded", {"welded": True}, (codes.CONTACTOR, 255, 184, 25)),
    ("no supply", {"mv": 300}, (codes.SUPPLY_LOW, 255, 300, 1500)),
]


@pytest.mark.parametrize(("what", "fault", "expected"), BROKEN, ids=[row[0] for row in BROKEN])
def test_what_is_broken_is_refused_with_its_coil_and_figure_and_everything_is_off(rig, what, fault, expected):
    for channel, mohm in fault.pop("coil_mohm", {}).items():
        rig.board.coil_mohm[channel] = mohm
    rig.board.supply.mv = fault.pop("mv", 2000)
    for name, value in fault.items():
        setattr(rig.board, name, value)

    said = refusal(rig.arm())

    assert (said.code, said.channel) == expected[:2]
    assert (said.value, said.limit) == pytest.approx(expected[2:], rel=0.01)
    assert (rig.core.state, rig.board.powered) == (messages.IDLE, False)
    assert rig.board.chip.duty_permille == [0] * 16


def test_a_coil_that_is_said_to_be_broken_is_passed_over_and_never_driven(rig):
    rig.board.coil_mohm[2] = OPEN
    rig.arm(without=0b100)

    answers = rig.fire(0b110, duty_permille=600)

    assert answers[0][0] == "ok"
    assert rig.board.chip.duty_permille[:4] == [0, 600, 0, 0]


def test_a_coil_that_is_passed_over_counts_for_nothing_in_what_may_be_on_at_once(rig):
    rig.arm(without=0b1)

    assert rig.fire(0b1111111, duty_permille=100)[0][0] == "ok"


def test_a_coil_that_the_robot_has_not_cannot_be_passed_over(rig):
    assert refusal(rig.arm(without=1 << 8)).code == codes.UNKNOWN_CHANNEL


def test_with_every_coil_passed_over_it_arms_and_nothing_is_driven(rig):
    rig.board.coil_mohm = [OPEN] * 16
    rig.arm(without=0xFF)

    rig.fire(0b11)

    assert rig.core.state == messages.ARMED
    assert rig.board.chip.duty_permille == [0] * 16


def test_what_was_broken_is_forgotten_with_the_arming(rig):
    rig.arm(without=0b1)
    rig.say(messages.DISARM)
    rig.arm()

    rig.fire(0b1, duty_permille=500)

    assert rig.board.chip.duty_permille[0] == 500


def test_arming_an_armed_robot_only_renews_its_lease(rig):
    rig.arm()
    rig.fire(0b1, hold_ms=5000)
    looks = rig.board.supply.looks

    rig.say(messages.ARM, session=SESSION, lease_ms=1000, without=0)

    assert rig.board.supply.looks == looks
    assert rig.board.chip.duty_permille[0] == 500
    assert rig.core.lease_ms == 1000


def test_arming_an_armed_robot_without_other_coils_tests_it_again_with_all_off(rig):
    rig.arm()
    rig.fire(0b1, hold_ms=5000)

    rig.arm(without=0b1)

    assert rig.core.state == messages.ARMED
    assert rig.core.channels.on_mask == 0


def test_the_lease_begins_when_the_arming_is_answered(rig):
    """The test of a robot with many coils takes longer than a short lease."""
    rig.arm(lease_ms=50)

    assert rig.core.state == messages.ARMED
    rig.run(60, silent=True)
    assert rig.core.state == messages.IDLE


ENDS = [
    ("stop", lambda rig: rig.run(5, line=STOP), codes.STOP, messages.TRIPPED),
    ("disarm", lambda rig: rig.say(messages.DISARM), codes.NOT_ARMED, messages.IDLE),
    ("e-stop", lambda rig: setattr(rig.board, "closed", False), codes.ESTOP, messages.TRIPPED),
    ("chip gone", lambda rig: setattr(rig.board.chip, "absent", True), codes.CHIP, messages.TRIPPED),
    ("chip reset", lambda rig: (setattr(rig.board.chip, "lost", True), rig.board.coil_mohm.__setitem__(5, OPEN)),
     codes.CHIP, messages.TRIPPED),
]  # fmt: skip


@pytest.mark.parametrize(("what", "happen", "code", "state"), ENDS, ids=[row[0] for row in ENDS])
def test_what_ends_the_test_refuses_the_arming_and_leaves_everything_off(rig, what, happen, code, state):
    in_the_middle(rig)

    happen(rig)
    rig.run(100)

    assert [body.code for name, body in rig.got if name == "refused"] == [code]
    assert rig.core.state == state
    assert not rig.board.powered


def test_an_order_or_a_second_arming_in_the_middle_is_refused_and_the_test_goes_on(rig):
    in_the_middle(rig)

    assert refusal(rig.fire(0b1)).code == codes.BUSY
    assert refusal(rig.say(messages.ARM, session=SESSION, lease_ms=0, without=0)).code == codes.BUSY
    rig.run(60)
    assert rig.core.state == messages.ARMED


def test_a_session_that_takes_over_in_the_middle_ends_the_test(rig):
    in_the_middle(rig)

    rig.hello(session=78)
    rig.run(100)

    assert rig.core.state == messages.IDLE
    assert not rig.board.powered
    assert rig.board.chip.duty_permille == [0] * 16


def test_the_pulses_are_charged_to_the_coils(rig):
    before = list(rig.core.sense.heat_uj)

    rig.arm()

    taken = [after - earlier for after, earlier in zip(rig.core.sense.heat_uj, before, strict=True)]
    assert min(taken) > 0.9 * 378  # [mW] for 2 ms, some of it leaked away
    assert max(taken) < 2.1 * 378


def test_an_alert_is_a_fault_in_any_state(rig):
    rig.board.alerting = True
    rig.run(10)

    assert rig.core.code == codes.ALERT
    rig.say(messages.CLEAR)
    assert rig.core.state == messages.IDLE


def test_the_clock_does_not_begin_anew_in_the_middle_of_it(rig):
    in_the_middle(rig)

    rig.core.now_ms = (1 << 29) + 1

    assert not rig.core.may_restart()
