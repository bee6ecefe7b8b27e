"""Which instants of a run a picture shows."""

from itertools import pairwise

import pytest

from host.view.instants import apart, fastest, onsets, path_mm, resting, scene_times
from tests.rolling_ring import recorded_run


def test_a_drive_begins_where_a_coil_goes_on():
    assert onsets(recorded_run(7.0)) == pytest.approx([0.0, 2.0, 4.0, 6.0], abs=0.05)  # one record


def test_a_step_is_shown_at_rest_just_before_the_next_coil_is_driven():
    run = recorded_run(6.0)

    times = scene_times(run)[resting(run)]

    assert times == pytest.approx([0.0, 1.95, 3.95, 5.95, 6.0], abs=0.01)


def test_a_long_way_without_a_drive_is_filled_with_scenes():
    run = recorded_run(16.0)
    run.telemetry.clear()

    shown = resting(run)

    assert max(b - a for a, b in pairwise(path_mm(run.scenes)[shown])) < 45.0


def test_whole_bodies_stand_apart_and_the_first_and_last_are_among_them():
    run = recorded_run(16.0)
    shown = resting(run)

    whole = apart(run, shown, 43.0)

    hubs = [run.scenes[i]["hub"][0] for i in whole]
    assert (whole[0], whole[-1]) == (shown[0], shown[-1])
    assert len(whole) == 3
    assert min(b - a for a, b in pairwise(hubs)) >= 43.0


def test_a_body_that_stays_is_drawn_whole_once():
    run = recorded_run(0.3)

    assert apart(run, [0, 3, 6], 43.0) == [0]


def test_the_fastest_movement_lasts_from_one_drive_to_the_next():
    run = recorded_run(6.0)

    times = scene_times(run)[fastest(run, 5)]

    assert len(times) == 5
    assert times[-1] - times[0] == pytest.approx(2.0, abs=0.1)
    assert any(0.3 < t % 2.0 < 1.1 for t in times)  # while it rolls, not only at rest
