"""Fits of a press: planted materials are found again within their confidence, and what cannot be fitted is refused."""

import numpy as np
import pytest

from host.errors import BadRequest
from host.fit.drive import lag_of, lagged
from host.fit.estimate import MISFIT, estimate, spring_beside
from host.fit.shape import shape_of
from host.fit.trace import press_of
from tests.pressed_traces import LAG_S, PUSH, SHAPE_M, log_of, rheological

SETS = [(60e3, 300e3, 6e3), (20e3, 20e3, 2e3), (100e3, 1000e3, 10e3), (40e3, 60e3, 1e3)]
MOVES = [PUSH, ((0.5, -2.0), (4.0, 4.0), (3.0, 4.0), (0.75, -2.0)), ((0.5, 0.0), (2.7, 3.1), (6.0, 3.1), (0.5, 0.0))]


def fitted(material, moves=PUSH, spring=False, **options):
    """Return what is found in a made-up log of that material."""
    return estimate(press_of(log_of(material, moves, **options)), SHAPE_M, spring)


@pytest.mark.parametrize("planted", SETS)
@pytest.mark.parametrize("moves", MOVES)
def test_a_planted_material_is_found_again(planted, moves):
    found = fitted(rheological(*planted), moves, seed=1)

    for name, true in zip(("E", "c1", "c2"), planted, strict=True):
        value = found.values[name]
        assert abs(value.value - true) < 3.0 * value.error + 0.01 * true, name
    assert found.values["E"].value == pytest.approx(planted[0], rel=0.02)
    assert found.values["tau"].value == pytest.approx(planted[1] / planted[0], rel=0.02)
    assert 0.8 < found.misfit < 1.2


def test_confidence_intervals_hold_what_was_planted_as_often_as_they_say():
    true = {"E": 60e3, "c1": 300e3, "c2": 6e3, "tau": 5.0}
    found = [fitted(rheological(), seed=seed).values for seed in range(40)]

    for name, value in true.items():
        inside = sum(each[name].low <= value <= each[name].high for each in found)
        spread = np.std([each[name].value for each in found])
        assert 35 <= inside <= 40, name  # of 40; fewer would have a chance of 1.4 %
        assert 0.8 * spread < np.mean([each[name].error for each in found]) < 2.0 * spread, name


def test_errors_grow_with_the_noise():
    quiet, loud = (fitted(rheological(), noise_n=noise_n).values["E"].error for noise_n in (0.02, 0.1))

    assert loud == pytest.approx(5.0 * quiet, rel=0.5)


def test_a_spring_beside_the_dashpots_is_found_where_it_is_asked_for():
    moves = ((0.5, 0.0), (2.0, 4.0), (20.0, 4.0), (0.5, 0.0))

    found = fitted(rheological(E0=5e3), moves, spring=True).values

    assert found["E0"].value == pytest.approx(5e3, rel=0.02)
    assert found["E0"].low < 5e3 < found["E0"].high
    assert found["c2"].value == pytest.approx(6e3, rel=0.05)


def test_a_force_of_another_law_is_noticed():
    moves = ((0.5, 0.0), (2.0, 4.0), (20.0, 4.0), (0.5, 0.0))

    assert fitted(rheological(E0=5e3), moves).misfit > MISFIT
    assert fitted(rheological(E0=5e3), moves, spring=True).misfit < 1.2


@pytest.mark.parametrize(("E0", "told"), [(0.0, False), (10e3, True)])
def test_a_spring_that_the_residual_hides_in_a_short_hold_is_told_all_the_same(E0, told):
    log = log_of(rheological(E0=E0), seed=2)

    beside = spring_beside(press_of(log), SHAPE_M)

    assert estimate(press_of(log), SHAPE_M).misfit < MISFIT
    assert (beside is not None) == told
    assert beside is None or beside.low < E0 < beside.high


def test_an_axis_follows_a_ramp_a_lag_behind():
    t = np.arange(0.0, 2.0, 0.01)

    behind = lagged(t, np.clip(2.0 * t, 0.0, 2.0), 0.0, LAG_S)

    assert behind[99] == pytest.approx(1.98 - 2.0 * LAG_S, abs=1e-9)
    assert behind[105] == pytest.approx(2.0 - 2.0 * LAG_S * np.exp(-0.05 / LAG_S), abs=1e-9)


def test_the_drive_is_where_its_lag_and_delay_put_it():
    press = press_of(log_of(rheological(), noise_n=0.0))
    lag = lag_of(press)

    away = press.depth - lagged(press.t, press.command, lag.delay_s, lag.lag_s) - lag.offset_mm

    assert lag.delay_s + lag.lag_s == pytest.approx(LAG_S, abs=0.015)  # the step of the readings, and that of 0.01 mm
    assert np.abs(press.means(away)).max() < 0.01


def test_an_axis_that_did_not_follow_is_refused():
    log = log_of(rheological())
    for row in log.rows["samples"]:
        row["values"]["joint_centi"]["P"] = min(200, row["values"]["joint_centi"]["P"])

    with pytest.raises(BadRequest, match=r"the axis was not where it was told to be, 0\.\d+ mm off"):
        estimate(press_of(log), SHAPE_M)


@pytest.mark.parametrize(
    ("moves", "options", "said"),
    [
        (((0.5, 0.0), (1.0, -2.0)), {}, "holds no press: its force never stays above 0.1 N"),
        (((0.5, 0.0), (2.0, 4.0), (0.5, 0.0)), {}, "the press is not held"),
        (((0.5, 0.0), (2.0, 4.0), (0.3, 4.0), (0.5, 0.0)), {}, "the press is not held"),
        (((0.5, 0.0), (2.0, 4.0)), {}, "the press is not held"),
        (((0.5, 0.0), (0.01, 0.5), (2.0, 0.5)), {}, "the push is too short"),
        (
            PUSH,
            {"every": 10},
            "each 50 ms only, which misses the corners of a push: record it with `softrig run --log`",
        ),
    ],
)
def test_a_log_that_tells_too_little_is_refused(moves, options, said):
    with pytest.raises(BadRequest, match=said):
        press_of(log_of(rheological(), moves, **options))


def test_a_log_of_another_robot_is_refused():
    log = log_of(rheological())
    log.rows = {"telemetry": [{"joint_deg": {"R": 1.0}}]}

    with pytest.raises(BadRequest, match="tells no force and depth"):
        press_of(log)


@pytest.mark.parametrize(
    ("observed", "said"),
    [
        ({"shape_m": None, "model": {"indenter": "cylinder"}}, "a cylinder, whose contact grows with the depth"),
        ({"shape_m": None, "model": {"indenter": "polygon"}}, "press with a flat punch, sim:press.indenter=flat"),
        ({"shape_m": None, "model": {"indenter": "flat"}, "poisson_one": False}, "parts differ in Poisson ratio"),
        ({}, "give it, --shape 45.9mm"),
    ],
)
def test_a_geometry_without_a_closed_form_is_refused_with_what_to_do(observed, said):
    log = log_of(rheological(), ((0.5, 0.0),))
    log.rows["scenes"] = [{"touching": True, "observed": observed}]

    with pytest.raises(BadRequest, match=said):
        shape_of(log)


def test_only_the_first_press_is_fitted():
    again = (*PUSH, (2.0, 5.0), (3.0, 5.0), (0.5, 0.0))

    assert press_of(log_of(rheological(), again)).command.max() == 4.0
