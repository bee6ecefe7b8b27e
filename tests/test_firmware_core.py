"""The core alone: states, lease, refusals and faults, in CPython on a table top of remembering chips."""

from binascii import crc32

import pytest

from firmware.core import Core
from protocol import codes, messages, program
from protocol.frames import RELIABLE, STOP, encode, seal
from protocol.program import Condition
from tests.firmware_bench import Rig, Table, refusal


@pytest.fixture
def rig():
    return Rig()


def test_it_starts_idle_with_the_supply_off_and_says_who_it_is(rig):
    name, identity = rig.got[0]

    assert name == "identity"
    assert identity.dictionary_crc == rig.core.link.decoder.seed
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

    said = refusal(rig.fire(**order))

    assert (said.code, said.channel) == (code, channel)
    assert rig.board.chip.writes == 0


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

    (_, identity) = rig.say(messages.HELLO, version=1, session=78)[0]

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


def test_a_coil_at_full_duty_trips_its_heat_budget_before_two_seconds(rig):
    rig.arm()

    rig.fire(1, duty_permille=1000, hold_ms=10_000)
    rig.run(2000)

    assert rig.core.code in (codes.HEAT_BUDGET, codes.OVER_TEMPERATURE)
    assert rig.events("tripped")[0].now_ms < 2000
    assert rig.events("tripped")[0].channel == 0


def test_boost_then_hold_stays_within_the_budget(rig):
    rig.arm()

    rig.fire(1, duty_permille=1000, hold_ms=700)
    rig.run(690)
    rig.fire(1, duty_permille=320, hold_ms=9000)
    rig.run(8000)

    assert rig.core.state == messages.ARMED
    assert rig.board.chip.duty_permille[0] == 320


def test_a_coil_that_was_on_as_long_as_it_may_must_rest(rig):
    rig.arm()
    rig.fire(1, duty_permille=100, hold_ms=10_000)
    rig.run(10_005)

    assert refusal(rig.fire(1)).code == codes.RESTING
    rig.run(1000)
    assert rig.fire(1)[0][0] == "ok"


def test_chained_orders_cannot_keep_a_coil_on_for_ever(rig):
    rig.arm()
    for _ in range(3):
        rig.fire(1, duty_permille=100, hold_ms=6000)
        rig.run(4000)

    assert rig.core.code == codes.ON_TOO_LONG


def run_program(rig, code, flags=0, robot_crc=None):
    header = program.header(code, rig.profile.crc if robot_crc is None else robot_crc, flags)
    answers = rig.upload(code, header)
    rig.arm()
    return answers + rig.say(messages.START)


def test_an_uploaded_program_runs_its_steps_on_time_and_says_when_it_is_done(rig):
    code = (
        program.repeat(2) + program.step(1) + program.fire(1, 1000, 100) + program.delay(100)
        + program.step(2) + program.fire(2, 500, 50) + program.delay(50) + program.next_() + program.halt()
    )  # fmt: skip

    run_program(rig, code)
    rig.run(400)

    begin = rig.events("started")[0].now_ms
    steps = [(event.step, event.now_ms - begin) for event in rig.events("step")]
    assert steps == [(1, 0), (2, 100), (1, 150), (2, 250)]
    assert rig.events("finished")[0].now_ms - begin == 300
    assert rig.core.state == messages.ARMED


def test_a_fire_that_follows_on_the_same_coil_leaves_no_gap(rig):
    code = program.fire(1, 1000, 100) + program.delay(100) + program.fire(1, 300, 100) + program.delay(100)
    duties = []

    run_program(rig, code + program.halt())
    for _ in range(45):
        rig.run(5)
        duties.append(rig.board.chip.duty_permille[0])

    on = [duty for duty in duties if duty]
    assert duties[: len(on)] == on
    assert sorted(set(on)) == [300, 1000]


def test_a_ramp_rises_to_its_duty(rig):
    run_program(rig, program.ramp(1, 400, 500, 0, 200) + program.halt())
    rig.run(80)
    half = rig.board.chip.duty_permille[0]
    rig.run(150)

    assert 150 <= half <= 230
    assert rig.board.chip.duty_permille[0] == 400


def test_a_cut_off_ends_the_order_when_the_estimate_reaches_it(rig):
    run_program(rig, program.fire(1, 1000, 3000, 600) + program.halt())

    rig.run(1500)

    (event,) = rig.events("cut-off")
    assert event.channel == 0
    assert 600 <= event.value < 620
    assert rig.events("finished")


def test_a_wait_ends_when_its_condition_holds(rig):
    warm = Condition(program.TEMPERATURE, program.ANY, program.ABOVE, 400, 0b1)

    wait = program.wait(warm, 5000, program.ABORT)
    run_program(rig, program.fire(1, 500, 1000) + wait + program.off(1) + program.halt())
    rig.run(1000)

    assert rig.events("finished")[0].now_ms < 500


def test_a_wait_that_runs_out_aborts_or_continues_as_written(rig):
    hot = Condition(program.TEMPERATURE, program.ALL, program.ABOVE, 900, 0b11)

    run_program(rig, program.wait(hot, 100, program.CONTINUE) + program.wait(hot, 200, program.ABORT) + program.halt())
    rig.run(400)

    (event,) = rig.events("aborted")
    assert event.code == codes.WAIT_TIMEOUT
    assert event.now_ms - rig.events("started")[0].now_ms == pytest.approx(300, abs=10)
    assert rig.core.state == messages.ARMED


def test_a_guard_trips_in_the_step_in_which_it_holds(rig):
    guard = Condition(program.TEMPERATURE, program.ANY, program.ABOVE, 500, 0xFF)

    run_program(rig, program.guard(guard) + program.fire(2, 1000, 2000) + program.halt())
    rig.run(1000)

    assert rig.core.code == codes.GUARD
    assert rig.board.chip.duty_permille[1] == 0


def test_a_program_step_beyond_the_limits_trips_and_names_them(rig):
    run_program(rig, program.fire(1, 1000, 20_000) + program.halt())
    rig.run(20)

    (event,) = rig.events("tripped")
    assert (event.code, event.channel, event.value) == (codes.REFUSED_STEP, 0, 20_000)


def test_a_program_dies_with_its_host_unless_it_may_outlive_it(rig):
    code = program.fire(1, 300, 3000) + program.halt()
    run_program(rig, code)
    rig.run(600, silent=True)
    assert rig.core.state == messages.IDLE

    other = Rig()
    run_program(other, code, flags=program.OUTLIVES_HOST)
    other.run(600, silent=True)
    assert other.core.state == messages.RUNNING
    assert other.board.chip.duty_permille[0] == 300


def test_a_program_that_ended_does_not_keep_a_silent_host_armed(rig):
    run_program(rig, program.delay(50) + program.halt(), flags=program.OUTLIVES_HOST)

    rig.run(1000, silent=True)

    assert rig.core.state == messages.IDLE


BAD_PROGRAMS = [
    ("other robot", {"robot_crc": 1}, program.halt(), codes.OTHER_ROBOT),
    ("bad code", {}, program.delay(1), codes.BAD_CODE),
    ("too large", {}, program.delay(1) * 1000 + program.halt(), codes.TOO_LARGE),
]


@pytest.mark.parametrize(("what", "options", "code", "expected"), BAD_PROGRAMS, ids=[row[0] for row in BAD_PROGRAMS])
def test_a_bad_program_is_refused_whole(rig, what, options, code, expected):
    answers = run_program(rig, code, **options)

    assert refusal(answers).code == expected
    assert rig.core.state == messages.ARMED


def test_a_program_whose_bytes_changed_on_the_way_does_not_start(rig):
    code = program.fire(1, 300, 100) + program.halt()
    rig.upload(code[:5] + b"\x01" + code[6:], program.header(code, rig.profile.crc))
    rig.arm()

    assert refusal(rig.say(messages.START)).code == codes.BAD_CODE


def test_while_a_program_runs_other_orders_are_refused_and_cancel_ends_it(rig):
    run_program(rig, program.fire(1, 300, 5000) + program.halt())

    assert refusal(rig.fire(2)).code == codes.BUSY
    rig.say(messages.CANCEL)
    assert rig.core.state == messages.ARMED
    assert rig.board.chip.duty_permille[0] == 0


def test_unknown_and_misshapen_messages_are_refused_not_raised(rig):
    rig.host.send(0x7F, b"", rig.now_ms)
    rig.host.send(messages.FIRE.number, b"short", rig.now_ms)
    answers = rig.run(10)
    rig.host.post(0x0E, b"")
    rig.host.post(messages.HELLO.number, b"")
    answers += rig.run(10)

    assert [body.code for name, body in answers if name == "refused"] == [codes.UNKNOWN_MESSAGE, codes.BAD_PAYLOAD]
    assert [body.code for name, body in answers if name == "nak"] == [codes.UNKNOWN_MESSAGE, codes.BAD_PAYLOAD]


def test_a_hello_of_another_version_is_told_so_whatever_it_carries(rig):
    """The frame says version 2 in its head, and its payload is longer than ours."""
    body = bytes((0x20, messages.HELLO.number, 0, 0)) + bytes((2, 1, 2, 3, 4, 5, 6, 7))
    answer = rig.core.step(rig.now_ms, encode(body + crc32(body).to_bytes(4, "little")), 1024)

    ((kind, _, payload),) = rig.host.receive(answer, 0)

    nak = messages.NAK.unpack(payload)
    assert (kind, nak.code, nak.version) == (messages.NAK.number, codes.OTHER_VERSION, 1)


def test_telemetry_comes_at_its_period_with_every_channel(rig):
    rig.arm()
    rig.fire(1)
    rig.say(messages.SUBSCRIBE, period_ms=50)

    records = [body for name, body in rig.run(1000) if name == "telemetry"]

    assert len(records) in (19, 20)
    assert len(records[0].channels) == 32
    assert int.from_bytes(records[0].channels[:2], "little") == 500


def test_after_a_watchdog_reset_it_stays_tripped_until_cleared():
    rig = Rig()
    core = Core(Table(), rig.profile, boot=2, after_reset=True)
    core.step(0, b"", 1024)

    assert (core.state, core.code) == (messages.TRIPPED, codes.WATCHDOG)


def test_coils_whose_order_ends_in_this_step_do_not_count_as_on_at_once(rig):
    six = program.fire(0b00111111, 300, 50) + program.delay(50) + program.fire(0b11111000, 300, 50) + program.halt()

    run_program(rig, six)
    rig.run(200)

    assert rig.events("finished")


def test_a_coil_is_not_charged_for_the_time_before_it_was_switched_on(rig):
    rig.arm()
    rig.run(300)

    rig.fire(0b10000000, duty_permille=1000, hold_ms=100)
    rig.run(140)

    full_uw = 2_000_000 // 10_020 * (2_000_000 // 10_020) * 9500 // 1000
    assert rig.core.sense.heat_uj[7] == pytest.approx(full_uw * 100 // 1000, rel=0.05)


def test_a_figure_greater_than_an_answer_can_carry_is_refused_all_the_same(rig):
    rig.arm()

    said = refusal(rig.fire(0xFFFFFFFF))

    assert (said.code, said.value) == (codes.UNKNOWN_CHANNEL, 0x7FFFFFFF)


def test_a_host_that_acknowledges_nothing_goes_without_answers(rig):
    rig.arm()

    for number in range(200):
        body = seal(messages.FIRE.number, (number + 1) & 255, 0, b"", rig.host.decoder.seed, RELIABLE)
        rig.core.step(rig.now_ms, encode(body), 1024)
        rig.now_ms += 5

    assert rig.core.state == messages.ARMED
    rig.run(5, line=STOP)
    assert rig.core.code == codes.STOP


def test_a_guard_within_a_loop_is_one_guard(rig):
    guard = Condition(program.TEMPERATURE, program.ANY, program.ABOVE, 500, 0xFF)
    body = program.guard(guard) + program.delay(10)

    run_program(rig, program.repeat(20) + body + program.next_() + program.fire(2, 1000, 2000) + program.halt())
    rig.run(1500)

    assert rig.core.code == codes.GUARD


def test_what_has_transformed_takes_no_latent_heat_a_second_time(rig):
    """Else the estimate lags behind a coil that is heated in bursts, and the coil cooks before the trip."""

    def driven(duty_permille: int, until) -> int:
        """Return the milliseconds until the estimate of coil 0 is there."""
        sense, begun = rig.core.sense, rig.now_ms
        while not until(sense.temperature_millidegc[0]):
            rig.now_ms += 5
            sense.update(rig.now_ms, 1, [duty_permille])
        return rig.now_ms - begun

    first_ms = driven(1000, lambda t: t >= 75_000)
    driven(0, lambda t: t <= 60_000)
    second_ms = driven(1000, lambda t: t >= 75_000)

    sensible_ms = (75 - 60) * rig.profile.coil.heat_capacity_uj_per_k // 380
    assert first_ms > 400
    assert second_ms < 2 * sensible_ms


def test_its_own_words_coming_back_are_not_answered(rig):
    """A loopback plug, or a line that echoes, must not make the robot talk to itself for ever."""
    rig.host.post(0x0E, b"")
    echo = rig.core.step(rig.now_ms, rig.host.poll(0), 1024)
    assert echo

    again = rig.core.step(rig.now_ms + 5, echo, 1024)

    assert again == b""


def test_a_reset_that_forgot_the_heat_takes_every_coil_as_hot():
    rig = Rig()
    core = Core(rig.board, rig.profile, boot=2, after_reset=True)
    core.step(0, b"", 1024)

    assert min(core.sense.temperature_millidegc) > 115_000
    for now_ms in range(5, 20_000, 5):
        core.step(now_ms, b"", 1024)
    assert max(core.sense.temperature_millidegc) < 30_000


def test_a_broken_thermistor_does_not_spoil_the_estimates(rig):
    rig.arm()
    rig.fire(1, duty_permille=1000, hold_ms=500)
    rig.run(500)
    before = rig.core.sense.temperature_millidegc[0]

    rig.board.decidegc = -9999
    rig.run(330)

    assert rig.core.code == codes.SENSOR
    assert 45_000 < rig.core.sense.temperature_millidegc[0] < before


def test_a_supply_that_is_too_high_is_never_let_onto_the_coils(rig):
    rig.board.supply.mv = 5000
    rig.run(400)

    assert rig.core.code == codes.SUPPLY_HIGH
    assert refusal(rig.arm()).code == codes.TRIPPED


def test_a_supply_that_was_low_while_it_was_off_does_not_trip_the_arming(rig):
    rig.board.supply.mv = 0
    rig.run(400)
    rig.arm()
    rig.board.supply.mv = 2000

    rig.run(80)

    assert rig.core.state == messages.ARMED


def test_a_new_session_inherits_no_arming_from_a_program_that_outlived_its_host(rig):
    run_program(rig, program.fire(1, 300, 2000) + program.halt(), flags=program.OUTLIVES_HOST)
    rig.run(600, silent=True)

    rig.host.reset(rig.core.link.decoder.seed)
    rig.host.post(messages.HELLO.number, messages.HELLO.pack(version=1, session=78))
    rig.run(10, silent=True, line=rig.host.poll(rig.now_ms))
    rig.run(3000)

    assert rig.board.chip.duty_permille[0] == 0
    assert refusal(rig.fire(1)).code == codes.NOT_ARMED


def test_a_long_program_is_verified_in_pieces_and_then_started(rig):
    code = program.delay(1) * 400 + program.halt()
    run_program(rig, code)
    assert not rig.events("started")

    answers = rig.run(100)

    assert rig.events("started")
    assert [name for name, _ in answers].count("ok") == 1


def test_a_program_that_waits_for_its_verification_dies_with_the_arming(rig):
    code = program.delay(1) * 400 + program.halt()
    rig.upload(code, program.header(code, rig.profile.crc))
    rig.arm()
    rig.host.send(messages.START.number, messages.START.pack(), rig.now_ms)
    rig.host.send(messages.DISARM.number, messages.DISARM.pack(), rig.now_ms)

    answers = rig.run(200)

    assert refusal(answers).code == codes.NOT_ARMED
    assert not rig.events("started")


def test_the_clock_begins_anew_only_when_nobody_is_at_work(rig):
    rig.core.now_ms = (1 << 29) + 1

    assert rig.core.may_restart()
    rig.core.state = messages.ARMED
    assert not rig.core.may_restart()


def test_after_the_end_of_a_program_no_step_is_told(rig):
    run_program(rig, program.step(7) + program.fire(1, 300, 50) + program.halt())
    rig.run(100)

    status = next(body for name, body in rig.say(messages.STATUS_REQUEST) if name == "status")

    assert rig.events("finished")[0].step == 7
    assert status.step == 0
