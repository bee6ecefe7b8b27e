"""Pictures of fingers: what they draw is true to scale and in balance, at the instants that the paper shows."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from host.attention import Attention
from host.errors import BadRequest
from host.view import draw_film, draw_grasp, draw_grips, draw_nail, draw_run, draw_tilting
from host.view.hand import push, tip_outline
from host.view.nail import centre_line_deg, normalised_moment
from host.view.swings import held, object_deg, of_fingers, phase_names, phases, swing_deg, telling
from host.view.tilting import sequence
from tests.pinched_plate import EXPERIMENT, PinchedPlate, recorded_pinch
from tests.rolling_ring import recorded_run

CUBE = {"radius_mm": 13.0, "link_mm": 105.0, "width_mm": 37.0}


@pytest.fixture(scope="module")
def pinch():
    return recorded_pinch()


@pytest.fixture(scope="module")
def experiment():
    return recorded_pinch(EXPERIMENT, **CUBE)


def texts(path):
    """Return what is written in an SVG: the backend leaves each text as a comment above its outlines."""
    return re.findall(r"<!-- (.*?) -->", path.read_text(encoding="utf-8"))


def face_distance(scene, label):
    """Return how far the points of a tip's outline lie before the object's face, in mm."""
    psi, body = np.radians(scene["object"]["deg"]), scene["object"]
    across = np.array([np.cos(psi), np.sin(psi)]) * (1 if label == "R" else -1)
    return (tip_outline(scene, label) - body["centre"]) @ across - body["width_mm"] / 2


@pytest.mark.parametrize("label", ["R", "L"])
def test_a_tip_ends_at_the_face_of_the_object_and_lies_on_it(label, experiment):
    for scene in (experiment.scenes[i] for i in phases(experiment)[1:]):
        before = face_distance(scene, label)

        assert before.min() == pytest.approx(0.0, abs=1e-6)
        assert (before < 1e-6).sum() == 2  # the ends of the straight edge between two arcs


def test_a_tip_that_touches_nothing_is_a_whole_hemisphere(pinch):
    scene = pinch.scenes[0]

    away = tip_outline(scene, "R") - scene["fingers"]["R"]["tip"]

    assert np.hypot(*away.T) == pytest.approx(20.0)
    assert np.ptp(away, axis=0) == pytest.approx([20.0, 40.0], abs=0.05)


def test_the_forces_that_are_drawn_hold_the_object_in_balance(pinch):
    for scene in (pinch.scenes[i] for i in phases(pinch)[1:]):
        (right, leftward), (left, rightward) = push(scene, "R"), push(scene, "L")

        assert leftward == pytest.approx(-rightward, rel=1e-6)
        between = right - left
        assert between[0] * leftward[1] - between[1] * leftward[0] == pytest.approx(0.0, abs=1e-2)  # N mm


def test_a_rest_in_parallel_belongs_to_phase_0():
    resting = recorded_pinch(((0.5, 0.0, 0.0), (1.0, 0.0, 8.0), (1.0, 20.0, 8.0)))

    assert phases(resting)[:2] == [10, 30]


def test_the_phases_end_parallel_gripping_and_at_the_end_of_each_rest(pinch):
    ends = phases(pinch)

    assert [pinch.scenes[i]["t_s"] for i in ends] == pytest.approx([0.0, 1.0, 2.5, 5.0], abs=0.06)
    assert swing_deg(pinch)[ends] == pytest.approx([0.0, 0.0, 20.0, -20.0])
    assert phase_names(pinch) == ["0", "1", "2", "3"]


def test_every_swing_of_several_is_found(experiment):
    assert phase_names(experiment) == ["0", "1", "2", "3", "2", "3", "2", "3"]


def test_a_single_swing_ends_where_it_rests():
    once = recorded_pinch(((1.0, 0.0, 8.0), (1.0, 20.0, 8.0), (0.5, 20.0, 8.0)))

    assert phases(once) == [0, 20, len(once.scenes) - 1]


def test_a_jerk_while_a_finger_settles_is_no_swing(pinch):
    shaken = recorded_pinch()
    shaken.scenes[45]["fingers"]["R"]["deg"] -= 3.0

    assert phases(shaken) == phases(pinch)


def test_figure_12_shows_the_four_poses_and_says_what_is_enlarged(pinch, tmp_path):
    draw_grips(pinch, tmp_path / "a.svg")

    written = texts(tmp_path / "a.svg")
    assert {"(a) parallel", "(b) 8.0° inward", "object 0.00°", "object −2.59°", "object +2.59°", "20 mm"} <= set(
        written
    )
    assert any("drawn 5 times as large" in text for text in written)


def test_figure_13_names_phases_and_values(pinch, tmp_path):
    draw_grasp(pinch, tmp_path / "a.svg")

    written = texts(tmp_path / "a.svg")
    assert {"phase 0", "1", "2", "3", "229.1", "213.5", "energy [mJ]", "d [mm]", "object [°]", "time [s]"} <= set(
        written
    )


def test_figure_14_shows_eight_instants_in_which_the_object_tilts_against_the_swing(experiment, tmp_path):
    draw_tilting(experiment, tmp_path / "a.svg")

    shown = sequence(experiment)
    tilted = object_deg(experiment)[shown][2:] * swing_deg(experiment)[shown][2:]
    assert len(shown) == 8
    assert (tilted < 0).all()
    assert [text[:3] for text in texts(tmp_path / "a.svg") if text[0] == "("] == [
        f"({letter})" for letter in "abcdefgh"
    ]


def test_fewer_swings_than_six_are_filled_up_to_eight_instants(pinch):
    shown = sequence(pinch)

    assert len(shown) == 8
    assert shown == sorted(set(shown))
    assert set(phases(pinch)) <= set(shown)


def test_the_moment_of_a_tip_is_that_of_the_closed_form_with_a_nail_and_none_without(pinch):
    angle, moment = normalised_moment(pinch)
    _, without = normalised_moment(recorded_pinch(tip="radial"))

    assert moment == pytest.approx(np.sin(np.radians(angle)) / np.cos(np.radians(angle)) ** 3)
    assert without == pytest.approx(0.0)


def test_without_a_nail_the_object_follows_the_line_of_the_tips():
    radial = recorded_pinch(tip="radial")
    shown = held(radial)

    right, left = of_fingers(radial, "d_mm")[shown].T
    assert object_deg(radial)[shown] == pytest.approx(centre_line_deg(radial)[shown], abs=1e-3)
    assert right == pytest.approx(left, abs=1e-4)


def test_what_comes_after_the_grip_opens_is_not_shown_as_held():
    opened = recorded_pinch(((1.0, 0.0, 8.0), (1.0, 20.0, 8.0), (1.0, 0.0, 8.0), (1.0, 0.0, 0.0)))

    assert [held(opened)[i] for i in (0, -1)] == [20, 60]


def test_the_nail_is_shown_by_two_runs(pinch, tmp_path):
    draw_nail(pinch, recorded_pinch(tip="radial"), tmp_path / "a.svg")

    assert {"1.708", "1.225", "displacement alone", "line of the tips' centres"} <= set(texts(tmp_path / "a.svg"))


def test_a_run_with_the_other_tip_is_refused(pinch, tmp_path):
    with pytest.raises(BadRequest, match="needs a run of fingers with tip=radial"):
        draw_nail(pinch, pinch, tmp_path / "a.svg")


def test_a_run_of_fingers_is_drawn_with_poses_and_the_curves_of_its_joints(pinch, tmp_path):
    draw_run(pinch, tmp_path / "a.svg")

    written = texts(tmp_path / "a.svg")
    assert {"R", "L", "commanded", "camera", "true", "joints [°]", "joints [mA]", "supply [mA]"} <= set(written)
    assert "coil [°C]" not in written
    ElementTree.parse(tmp_path / "a.svg")


def test_a_run_that_nobody_saw_has_the_curves_alone(tmp_path):
    draw_run(recorded_pinch(observed=False), tmp_path / "a.svg")

    written = set(texts(tmp_path / "a.svg"))
    assert {"R", "L", "camera", "joints [°]"} <= written
    assert not {"true", "a", "b"} & written


def test_fingers_that_never_swing_are_shown_as_they_close(tmp_path):
    closing = recorded_pinch(((1.0, 0.0, 8.0),))

    draw_run(closing, tmp_path / "a.svg")

    assert len(telling(closing, 6)) == 6
    with pytest.raises(BadRequest, match="never swung together"):
        draw_grasp(closing, tmp_path / "b.svg")


def test_the_same_fingers_give_the_same_bytes(pinch, tmp_path):
    for draw in (draw_grips, draw_grasp, draw_run):
        draw(pinch, tmp_path / "a.svg")
        draw(recorded_pinch(), tmp_path / "b.svg")

        assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


@pytest.mark.parametrize("draw", [draw_grips, draw_grasp, draw_tilting])
def test_figures_of_fingers_are_refused_for_a_body_and_without_scenes(draw, tmp_path):
    with pytest.raises(BadRequest, match="this figure shows fingers"):
        draw(recorded_run(1.0), tmp_path / "a.svg")
    with pytest.raises(BadRequest, match="needs an observer"):
        draw(recorded_pinch(observed=False), tmp_path / "a.svg")


def test_a_film_of_fingers_is_refused(pinch, tmp_path):
    with pytest.raises(BadRequest, match="shows a body"):
        draw_film(pinch, tmp_path / "a.svg")


def test_attention_is_paid_to_fingers_that_press():
    plate, attention = PinchedPlate(), Attention()
    attention.keep(plate.snapshot())

    plate.turn(0.0, 4.0)
    pressed = attention.stirs(plate.snapshot())

    assert pressed
