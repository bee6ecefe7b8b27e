"""The clock: one order of events, whoever drives it and however often."""

from hil_sim.clock import Clock


def test_events_run_in_the_order_of_time_then_of_insertion():
    clock, seen = Clock(), []
    for time_us, name in ((20, "c"), (10, "a"), (20, "d"), (10, "b")):
        clock.at(time_us, lambda name=name: seen.append((clock.now_us, name)))

    clock.run_until(20)

    assert seen == [(10, "a"), (10, "b"), (20, "c"), (20, "d")]


def test_a_run_ends_at_its_time_even_when_nothing_is_due():
    clock = Clock()

    clock.run_until(123)

    assert clock.now_us == 123


def test_an_event_beyond_the_end_waits_for_the_next_run():
    clock, seen = Clock(), []
    clock.at(101, lambda: seen.append(clock.now_us))

    clock.run_until(100)
    assert seen == []
    clock.run_until(200)

    assert seen == [101]


def test_a_cancelled_event_never_runs():
    clock, seen = Clock(), []
    clock.at(10, lambda: seen.append(1)).cancel()

    clock.run_until(20)

    assert seen == []


def test_an_event_in_the_past_runs_now():
    clock, seen = Clock(), []
    clock.at(50, lambda: clock.at(10, lambda: seen.append(clock.now_us)))

    clock.run_until(60)

    assert seen == [50]


def test_an_event_can_end_the_run_early_but_not_in_the_past():
    clock = Clock()
    clock.at(30, lambda: clock.stop_at(10))

    clock.run_until(1000)

    assert clock.now_us == 30


def test_a_client_may_pass_time_itself_only_below_the_limit():
    clock, limits = Clock(), []
    clock.at(10, lambda: limits.append(clock.limit_us))
    clock.at(40, lambda: limits.append(clock.limit_us))

    clock.run_until(60)

    assert limits == [40, 61]
