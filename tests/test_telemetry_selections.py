"""What a host makes of records: read by the form they name, and every one that did not come is counted."""

import random
import struct

import pytest

from host.profile import Parts
from host.records import Sample, Telemetry
from host.selections import Selection, Selections, selection_of
from protocol import messages, variables

ABC = Parts(("A", "B", "C"), ("A", "B", "C"))
SUPPLY = (variables.number("supply_mv"),)


def record(count, now_ms, supply_mv=2000, slot=0, form=1):
    """Return the payload of a record of the supply voltage."""
    values = variables.veiled(struct.pack("<H", supply_mv))
    return messages.TELEMETRY.pack(slot=slot, form=form, count=count & 255, now_ms=now_ms & 0xFFFFFFFF, values=values)


def usual(count, now_ms):
    """Return the payload of a record of the usual variables."""
    values = variables.veiled(struct.pack("<BHHHhhhB3H3h", 2, 7, 2000, 15, 231, 0, 0, 255, 0, 600, 0, 250, 991, 250))
    return messages.TELEMETRY.pack(slot=0, form=0, count=count, now_ms=now_ms, values=values)


def asked(period_ms=10, on_change=False, seq=0):
    selections = Selections()
    selections.ask(seq, Selection(0, SUPPLY, period_ms, on_change))
    return selections


def taken(selections, *payloads):
    """Return the robot's times of the records that were taken."""
    told = [selections.take(payload, ABC, 0) for payload in payloads]
    return [each.now_ms for each in told if each]


def test_a_record_of_named_variables_is_a_sample():
    selections = Selections()
    numbers = tuple(map(variables.number, ("state", "coils_on", "coil_decidegc")))
    selections.ask(7, Selection(2, numbers, 10, False))
    values = variables.veiled(struct.pack("<BI3h", 3, 5, 250, -10, 1203))

    told = selections.take(messages.TELEMETRY.pack(slot=2, form=8, count=0, now_ms=70, values=values), ABC, host_ms=80)

    named = {"state": "running", "coils_on": 5, "coil_decidegc": {"A": 250, "B": -10, "C": 1203}}
    assert told == Sample(80, 70, 2, named)


def test_a_record_of_the_usual_variables_is_telemetry_even_to_who_did_not_ask():
    values = variables.veiled(struct.pack("<BHHHhhhB3H3h", 2, 7, 2000, 15, 231, 0, 0, 255, 0, 600, 0, 250, 991, 250))
    payload = messages.TELEMETRY.pack(slot=1, form=0, count=9, now_ms=70, values=values)

    told = Selections().take(payload, ABC, host_ms=80)

    assert told == Telemetry(80, 70, "armed", 7, 2000, 15, 23.1, (0, 600, 0), (25.0, 99.1, 25.0))


def test_what_another_session_was_told_is_not_missed_by_this_one():
    """A robot goes on telling the session of a host that has gone, until the next one asks."""
    selections = Selections()

    before = [selections.take(usual(count, 1000 + 10 * count), ABC, 0) for count in (80, 81)]
    selections.ask(0, Selection(0, variables.USUAL, 10, False), robot_ms=1825)
    late = selections.take(usual(82, 1820), ABC, 0)
    own = [selections.take(usual(count, 1830 + 10 * count), ABC, 0) for count in (0, 1, 3)]

    assert None not in [*before, late, *own]
    assert selections.missed() == {0: 1}


def test_a_record_that_is_of_nobodys_asking_is_passed_over():
    assert asked().take(record(0, 5, form=99), ABC, 0) is None


def test_a_record_whose_values_do_not_fit_is_damaged():
    selections = asked()
    with pytest.raises(ValueError, match="3 bytes of values, expected 2"):
        selections.take(messages.TELEMETRY.pack(slot=0, form=1, count=0, now_ms=5, values=b"abc"), ABC, 0)
    assert selections.missed() == {0: 0}


def test_records_on_their_way_when_the_subscription_changes_are_read_as_what_they_are():
    selections = asked(seq=0)
    selections.ask(1, Selection(0, (variables.number("state"),), 10, False))
    state = messages.TELEMETRY.pack(slot=0, form=2, count=1, now_ms=20, values=variables.veiled(b"\x04"))

    old, new = selections.take(record(0, 10), ABC, 0), selections.take(state, ABC, 0)

    assert (old.values, new.values) == ({"supply_mv": 2000}, {"state": "tripped"})
    assert selections.missed() == {0: 0}


def test_what_is_lost_before_the_first_record_is_counted_too():
    selections = asked()

    taken(selections, record(3, 40))

    assert selections.missed() == {0: 3}


def test_a_record_that_comes_twice_or_late_is_told_once_and_counted_once():
    selections = asked()

    times_ms = taken(
        selections, record(0, 10), record(0, 10), record(2, 30), record(1, 20), record(2, 30), record(3, 40)
    )

    assert times_ms == [10, 30, 40]
    assert selections.missed() == {0: 1}


@pytest.mark.parametrize("lost", [1, 127, 128, 200, 255, 256, 257, 1000, 70_000])
def test_however_many_are_lost_in_a_row_the_count_is_exact(lost):
    selections = asked(period_ms=5)
    taken(selections, *[record(i, 5 * i) for i in range(300)])

    taken(selections, record(300 + lost, 5 * (300 + lost)), record(301 + lost, 5 * (301 + lost)))

    assert selections.missed() == {0: lost}


def test_on_change_a_gap_in_time_is_no_gap_in_the_count():
    selections = asked(period_ms=5, on_change=True)

    taken(selections, record(0, 0), record(1, 60_000), record(3, 60_005))

    assert selections.missed() == {0: 1}


@pytest.mark.parametrize("seed", range(5))
def test_a_lossy_line_loses_as_many_as_are_counted(seed):
    draw, selections = random.Random(seed), asked(period_ms=7)
    sent = [record(i, 7 * i + draw.randrange(7)) for i in range(3000)]
    kept = [payload for payload in sent[:-1] if draw.random() < 0.3] + sent[-1:]

    arrived = len(taken(selections, *[payload for payload in kept for _ in range(draw.choice((1, 1, 2)))]))

    assert arrived == len(kept)
    assert selections.missed() == {0: len(sent) - len(kept)}


def test_the_clock_of_the_robot_may_wrap():
    selections = asked(period_ms=10)

    taken(selections, *[record(i, (1 << 32) - 50 + 10 * i) for i in range(10) if i != 4])

    assert selections.missed() == {0: 1}


def test_a_clock_that_has_begun_anew_is_not_taken_for_a_late_record():
    selections = asked()

    assert taken(selections, record(0, 90_000), record(1, 90_010), record(0, 10)) == [90_000, 90_010, 10]


def test_each_slot_has_its_own_count():
    selections = asked()
    selections.ask(1, Selection(3, SUPPLY, 10, False))

    taken(selections, record(0, 10), record(0, 10, slot=3, form=2), record(5, 60, slot=3, form=2))

    assert selections.missed() == {0: 0, 3: 4}


def test_on_change_nothing_may_come_for_a_second():
    fields = {"slot": 1, "variables": b"\x00", "on_change": 1}

    assert selection_of({**fields, "period_ms": 10}).silence_ms == 1000
    assert selection_of({**fields, "period_ms": 3000}).silence_ms == 3000
    assert selection_of({**fields, "period_ms": 0}).silence_ms == 0
    assert selection_of({**fields, "period_ms": 10, "on_change": 0}).silence_ms == 10
