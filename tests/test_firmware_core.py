"""The core alone: states, lease, refusals and faults, in CPython on a table top of remembering chips."""

import pytest

from firmware.core import Core
from protocol import codes, messages
from protocol.frames import STOP
from tests.firmware_bench import Rig, Table, refusal


@pytest.fixture
def rig():
    return Rig()


def test_it_starts_idle_with_the_supply_off_and_says_who_it_is(rig):
    name, identity = rig.got[0]

    assert name == "identity"
    assert identity.dictionary_crc == rig.core.link.decoder.dictionary_crc
    assert (identity.state, identity.role) == (messages.IDLE, messages.HOLDER)
    assert not rig.board.powered


def test_an_order_before_arming_is_refused(rig):
    assert refusal(rig.fire(1)).code == codes.NOT_ARMED
    assert rig.board.chip.writes == 0


def test_an_armed_robot_fires_and_the_order_carries_its_own_end(rig):
    rig.arm()

    rig.fire(0b101, duty_permille=600, hold_ms=300)
    assert rig.board.chip.duty_permille[:3] == [600, 0, 600]

    rig.run(285)
    assert rig.board.chip.duty_permille[:3] == [600, 0, 600]
    rig.run(15)
    assert rig.board.chip.duty_permille[:3] == [0, 0, 0]


LIMITS = [
    ("coils", {"coils": 1 << 8}, codes.UNKNOWN_CHANNEL, 255),
    ("no coil", {"coils": 0}, codes.UNKNOWN_CHANNEL, 255),
    ("duty", {"coils": 4, "duty_permille": 1001}, codes.DUTY_LIMIT, 2),
    ("hold", {"coils": 2, "hold_ms": 10_001}, codes.HOLD_LIMIT, 1),
    ("at once", {"coils": 0b1111111}, codes.AT_ONCE_LIMIT, 0),
]


@pytest.mark.parametrize(("what", "order", "code", "channel"), LIMITS, ids=[row[0] for row in LIMITS])
def test_an_order_beyond_a_limit_changes_nothing_and_names_the_limit(rig, what, order, code, channel):
    rig.arm()
    tested = rig.board.chip.writes

    said = refusal(rig.fire(**order))

    assert (said.code, said.channel) == (code, channel)
    assert rig.board.chip.writes == tested


def test_a_silent_host_loses_its_lease_and_every_coil_goes_off(rig):
    rig.arm(lease_ms=200)
    rig.fire(1, hold_ms=5000)

    rig.run(195, silent=True)
    assert rig.board.chip.duty_permille[0] == 500
    rig.run(15, silent=True)

    assert rig.board.chip.duty_permille[0] == 0
    assert not rig.board.powered
    assert rig.core.state == messages.IDLE


def test_a_lease_beyond_the_limit_is_refused(rig):
    said = refusal(rig.arm(lease_ms=5001))

    assert (said.code, said.value, said.limit) == (codes.LEASE_LIMIT, 5001, 5000)


def test_a_second_session_may_look_but_not_take_over_while_the_lease_lives(rig):
    rig.arm()
    rig.fire(1)

    (_, identity) = rig.hello(session=78)[0]

    assert identity.role == messages.VIEWER
    assert rig.board.chip.duty_permille[0] == 500


def test_stop_switches_off_in_the_same_step_and_latches_until_clear(rig):
    rig.arm()
    rig.fire(0b11, hold_ms=5000)

    answers = rig.run(5, line=b"\x07garbage" + STOP)

    assert rig.board.chip.duty_permille[:2] == [0, 0]
    assert ("stopped", (messages.TRIPPED, codes.STOP, 0b11, answers[0][1].now_ms)) in answers
    assert refusal(rig.arm()).code == codes.TRIPPED
    rig.say(messages.CLEAR)
    assert rig.core.state == messages.IDLE


FAULTS = [
    ("e-stop", lambda rig: setattr(rig.board, "closed", False), codes.ESTOP),
    ("thermistor", lambda rig: setattr(rig.board, "decidegc", 9999), codes.SENSOR),
    ("over-current", lambda rig: setattr(rig.board.supply, "ma", 1600), codes.OVER_CURRENT),
    ("sag", lambda rig: setattr(rig.board.supply, "mv", 1400), codes.SUPPLY_LOW),
    ("chip gone", lambda rig: setattr(rig.board.chip, "absent", True), codes.CHIP),
    ("chip reset", lambda rig: setattr(rig.board.chip, "lost", True), codes.CHIP),
]


@pytest.mark.parametrize(("what", "break_it", "code"), FAULTS, ids=[row[0] for row in FAULTS])
def test_a_fault_opens_the_supply_and_latches_with_its_code(rig, what, break_it, code):
    rig.arm()
    rig.fire(1, hold_ms=5000)

    break_it(rig)
    rig.run(400)

    assert rig.core.state == messages.TRIPPED
    assert rig.core.code == code
    assert not rig.board.powered
    assert [event.code for event in rig.events("tripped")] == [code]


def test_current_with_all_coils_off_is_a_stuck_switch(rig):
    rig.arm()
    rig.board.supply.ma = 150

    rig.run(400)

    assert rig.core.code == codes.STRAY_CURRENT


def test_a_fault_cannot_be_cleared_while_its_cause_is_there(rig):
    rig.board.closed = False
    rig.run(10)

    assert refusal(rig.say(messages.CLEAR)).code == codes.CAUSE_REMAINS
    rig.board.closed = True
    rig.say(messages.CLEAR)
    assert rig.core.state == messages.IDLE


def test_after_a_watchdog_reset_it_stays_tripped_until_cleared():
    rig = Rig()
    core = Core(Table(), rig.profile, boot=2, after_reset=True)
    core.step(0, b"", 1024)

    assert (core.state, core.code) == (messages.TRIPPED, codes.WATCHDOG)


def test_a_supply_that_is_too_high_is_never_let_onto_the_coils(rig):
    rig.board.supply.mv = 5000
    rig.run(400)

    assert rig.core.code == codes.SUPPLY_HIGH
    assert refusal(rig.arm()).code == codes.TRIPPED


def test_a_supply_that_was_low_while_it_was_off_does_not_trip_the_arming(rig):
    rig.board.supply.mv = 0
    rig.run(400)
    rig.board.supply.mv = 2000
    rig.arm()

    rig.run(80)

    assert rig.core.state == messages.ARMED


def test_the_clock_begins_anew_only_when_nobody_is_at_work(rig):
    rig.core.now_ms = (1 << 29) + 1

    assert rig.core.may_restart()
    rig.core.state = messages.ARMED
    assert not rig.core.may_restart()
    rig.core.state = messages.TRIPPED  # it is latched again after the reset
    assert rig.core.may_restart()
