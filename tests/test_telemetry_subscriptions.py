"""Subscriptions on the robot: any variables, at any period or on change, counted when the line has no room."""

import struct

import pytest

from firmware.readings import Readings
from firmware.subscriptions import BESIDE, Subscriptions
from protocol import codes, frames, messages, variables
from tests.firmware_bench import BALL, Rig, refusal

ROOM = 512  # of a transmit buffer with nothing in it


@pytest.fixture
def rig():
    return Rig()


@pytest.fixture
def slots(rig):
    """Return the subscriptions of a core that a test steps by hand."""
    return Subscriptions(rig.core)


def numbers(*names: str) -> bytes:
    return bytes(variables.number(name) for name in names)


def told(slots, now_ms, room=ROOM):
    """Return (slot, count, values) of the records that are due."""
    records = []
    while record := slots.record(now_ms, room):
        row = messages.TELEMETRY.unpack(record)
        assert row.now_ms == now_ms
        records.append((row.slot, row.count, variables.veiled(row.values)))
    return records


def counts(slots, times_ms, room=ROOM):
    return [count for now_ms in times_ms for _, count, _ in told(slots, now_ms, room)]


def subscribe(rig, *names: str, slot=0, period_ms=50, on_change=0):
    return rig.say(messages.SUBSCRIBE, slot=slot, period_ms=period_ms, on_change=on_change, variables=numbers(*names))


def test_every_variable_can_be_read_and_fits_its_type(rig):
    rig.arm()
    rig.fire(0b101, 600, 9000)
    rig.run(300)
    readers = Readings(rig.core).readers
    assert len(readers) == len(variables.VARIABLES)

    for number, reader in enumerate(readers):
        values = []
        reader(values)
        packed = struct.pack(variables.layout([number], variables.counts(8)), *values)
        many = len(variables.VARIABLES[number].letter) > 1
        assert variables.unpack([number], packed, variables.counts(8)) == [tuple(values) if many else values[0]]


def test_what_is_told_is_what_the_robot_knows(rig):
    rig.arm()
    rig.fire(0b101, 600, 9000)
    subscribe(rig, "state", "coils_on", "duty_permille", "lease_left_ms", "supply_mv")

    record = [body for name, body in rig.run(100) if name == "telemetry"][-1]

    asked = numbers("state", "coils_on", "duty_permille", "lease_left_ms", "supply_mv")
    assert variables.unpack(asked, variables.veiled(record.values), variables.counts(8)) == [
        messages.ARMED, 0b101, (600, 0, 600, 0, 0, 0, 0, 0), 500, 2000,
    ]  # fmt: skip


@pytest.mark.parametrize(("period_ms", "expected"), [(5, 200), (7, 143), (12, 83), (50, 20), (999, 1), (1000, 1)])
def test_records_come_at_their_period_on_the_average_whatever_it_is(slots, period_ms, expected):
    slots.subscribe(0, period_ms, False, numbers("state"), 0, 0)

    assert counts(slots, range(0, 1000, 5)) == [count & 255 for count in range(expected)]


def test_four_slots_go_side_by_side(slots):
    for slot in range(4):
        slots.subscribe(slot, 10 * (slot + 1), False, numbers("state"), slot, 0)

    records = [slot for now_ms in range(0, 120, 5) for slot, _, _ in told(slots, now_ms)]

    assert [records.count(slot) for slot in range(4)] == [12, 6, 4, 3]


def test_on_change_is_told_at_once_then_only_what_changed(slots, rig):
    slots.subscribe(0, 20, True, numbers("supply_mv"), 0, 0)
    times_ms = []
    for now_ms in range(0, 600, 5):
        rig.core.sense.supply_mv = 2000 if now_ms < 250 else 2001 + now_ms // 300
        times_ms += [now_ms for _ in told(slots, now_ms)]

    assert times_ms == [0, 250, 300]


def test_on_change_keeps_its_distance_and_tells_the_last_value(slots, rig):
    slots.subscribe(0, 20, True, numbers("supply_mv"), 0, 0)
    records = []
    for now_ms in range(0, 200, 5):
        rig.core.sense.supply_mv = 2000 + min(now_ms, 100)
        records += [(now_ms, int.from_bytes(values, "little")) for _, _, values in told(slots, now_ms)]

    assert records == [(0, 2000), (20, 2020), (40, 2040), (60, 2060), (80, 2080), (100, 2100)]


def test_what_does_not_change_is_told_again_each_second_in_case_it_was_lost(slots):
    slots.subscribe(0, 20, True, numbers("supply_mv"), 0, 0)

    assert [now_ms for now_ms in range(0, 3500, 5) for _ in told(slots, now_ms)] == [0, 1000, 2000, 3000]


def test_a_full_line_gets_no_record_and_those_it_missed_are_counted(slots):
    slots.subscribe(0, 10, False, numbers("state"), 0, 0)
    assert counts(slots, range(0, 100, 5)) == list(range(10))

    assert counts(slots, range(100, 150, 5), room=100) == []

    assert counts(slots, [150, 155, 160]) == [15, 16]  # 10 to 14 found no room


def test_a_record_that_is_late_goes_as_soon_as_there_is_room(slots):
    slots.subscribe(0, 100, False, numbers("state"), 0, 0)
    assert counts(slots, [0]) == [0]

    assert counts(slots, range(100, 130, 5), room=100) == []

    assert counts(slots, [130, 200]) == [1, 2]


def test_a_change_that_finds_no_room_is_told_later_and_counted(slots, rig):
    slots.subscribe(0, 10, True, numbers("supply_mv"), 0, 0)
    told(slots, 0)
    rig.core.sense.supply_mv += 1

    assert counts(slots, range(100, 140, 5), room=100) == []

    assert counts(slots, [140, 145, 150]) == [5]  # at 100, 110, 120 and 130 there was no room


def test_telemetry_leaves_room_for_a_whole_frame_of_anything_else(slots):
    slots.subscribe(0, 10, False, numbers("state"), 0, 0)

    assert told(slots, 0, room=1 + BESIDE - 1) == []
    assert len(told(slots, 0, room=1 + BESIDE)) == 1
    assert BESIDE > frames.FRAME_MAX


def test_a_slot_that_fills_the_line_leaves_the_others_their_turn(slots):
    for slot in range(3):
        slots.subscribe(slot, 5, False, numbers("resistance_mohm", "duty_permille", "heat_permille"), slot, 0)
    sent = []
    for now_ms in range(0, 300, 5):
        record = slots.record(now_ms, ROOM)  # and no more in this step
        sent.append(record[0])

    assert [sent.count(slot) for slot in range(3)] == [20, 20, 20]


@pytest.mark.parametrize(
    ("fields", "code", "value", "limit"),
    [
        ({"slot": 4}, codes.SLOT_LIMIT, 4, 3),
        ({"period_ms": 4}, codes.PERIOD_LIMIT, 4, 5),
        ({"variables": bytes([0, 33])}, codes.UNKNOWN_VARIABLE, 33, 32),
        ({"variables": bytes([18]) * 8}, codes.RECORD_LIMIT, 256, 229),
        ({"variables": bytes([26, 28])}, codes.RECORD_LIMIT, 0, 1),  # of joints: it has none
    ],
)
def test_what_cannot_be_sent_is_refused_with_the_limit_and_what_was_stands(rig, fields, code, value, limit):
    subscribe(rig, "state", period_ms=5)

    answers = rig.say(
        messages.SUBSCRIBE, **{"slot": 0, "period_ms": 50, "on_change": 0, "variables": bytes([1]), **fields}
    )

    refused = refusal(answers)
    assert (refused.code, refused.value, refused.limit) == (code, value, limit)
    assert [len(body.values) for name, body in rig.run(50) if name == "telemetry"] == [1] * 10


def test_a_period_of_zero_ends_one_slot_and_no_other(rig):
    subscribe(rig, "state", slot=1)
    subscribe(rig, "step", slot=2)

    rig.say(messages.SUBSCRIBE, slot=1, period_ms=0, on_change=0, variables=b"")

    assert {body.slot for name, body in rig.run(200) if name == "telemetry"} == {2}


def test_the_count_of_a_slot_goes_on_from_one_subscription_to_the_next(slots):
    slots.subscribe(0, 10, False, numbers("state"), 0, 0)
    assert counts(slots, range(0, 50, 5)) == [0, 1, 2, 3, 4]

    slots.subscribe(0, 20, False, numbers("step"), 1, 50)

    assert counts(slots, range(50, 100, 5)) == [5, 6, 7]


def test_a_record_names_the_subscription_that_it_is_of(rig):
    rig.say(messages.SUBSCRIBE, slot=0, period_ms=50, on_change=0, variables=b"")
    subscribe(rig, "state", slot=1)

    forms = {body.slot: body.form for name, body in rig.run(100) if name == "telemetry"}

    assert forms == {0: 0, 1: 2}  # the usual variables; the frame numbered 1


def test_a_new_session_hears_nothing_of_what_the_last_one_asked_for(rig):
    subscribe(rig, "state")
    rig.hello(78)
    rig.run(20)

    assert not rig.core.reports.subscriptions.active
    assert [name for name, _ in rig.run(200) if name == "telemetry"] == []


def test_the_attitude_is_among_the_variables():
    rig = Rig(BALL)
    rig.run(100)
    subscribe(rig, "roll_decideg", "pitch_decideg", "down")

    record = [body for name, body in rig.run(100) if name == "telemetry"][-1]

    roll, pitch, down = variables.unpack(
        numbers("roll_decideg", "pitch_decideg", "down"), variables.veiled(record.values), variables.counts(18)
    )
    assert (abs(roll) <= 3, abs(pitch) <= 3, down != 255) == (True, True, True)


def test_the_usual_variables_read_at_once_are_those_read_one_by_one():
    rig = Rig(BALL)
    rig.run(100)
    rig.arm()
    rig.fire(0b101, 600, 9000)
    rig.run(300)
    readings, values = Readings(rig.core), []

    for number in variables.USUAL:
        readings.readers[number](values)

    assert readings.usual() == struct.pack(variables.layout(variables.USUAL, variables.counts(18)), *values)
