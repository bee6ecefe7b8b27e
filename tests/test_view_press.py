"""Pictures of a press: true to scale, at the instants that tell it, with what was measured beside what was true."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from hil_sim.physics.block.material import Material, Maxwell
from hil_sim.physics.block.stress import at_nodes as at_nodes_of
from host.errors import BadRequest
from host.view import draw_dents, draw_film, draw_run, draw_stresses
from host.view.dents import dents_figure
from host.view.meshes import deformed, edges_of, lowest, trails
from host.view.pressing import press_of, slices_of
from host.view.pressplot import body, telling
from host.view.stresses import KINDS, at_nodes, colours_of, levels_of, stresses_figure
from tests.pinched_plate import recorded_pinch
from tests.press_samples import MESHES
from tests.pressed_block import LABELS, recorded_press

TWICE = ((1.0, 3.0), (0.5, -1.0), (1.5, -1.0), (1.2, 2.8), (0.5, -1.0), (0.5, -1.0))
UNLIKE = Material((Maxwell(60e3, 300e3, nu=0.2),), c0=6e3, nu_c=0.45)


@pytest.fixture(scope="module")
def pressed():
    return recorded_press()


def texts(path):
    """Return what is written in an SVG: the backend leaves each text as a comment above its outlines."""
    return re.findall(r"<!-- (.*?) -->", path.read_text(encoding="utf-8"))


def lightness(colour):
    """Return how light a colour is in grey print."""
    return float(np.dot([0.299, 0.587, 0.114], to_rgb(colour)))


def test_the_four_instants_are_push_end_of_hold_release_and_long_after(pressed):
    assert [each.t_s for each in slices_of(pressed)] == pytest.approx([2.0, 5.0, 5.2, 7.8])


def test_a_slice_taken_just_after_a_scene_is_of_that_instant(pressed):
    late = replace(pressed, slices=[replace(each, host_ms=each.host_ms + 3) for each in pressed.slices])

    assert [each.t_s for each in slices_of(late)] == pytest.approx([2.0, 5.0, 5.2, 7.8])


def test_of_two_presses_the_stronger_is_shown_until_the_next_one_begins():
    twice = recorded_press(TWICE)

    press = press_of(twice)

    push, hold, freed, after = (twice.scenes[i]["t_s"] for i in press[1:])
    assert [push, hold] == pytest.approx([1.0, 1.0])
    assert 1.0 < freed < 1.3
    assert 3.0 < after < 3.7
    assert not any(twice.scenes[i]["touching"] for i in range(press.freed, press.after + 1))


@pytest.mark.parametrize(
    ("moves", "reason"),
    [(((1.0, 3.0), (1.0, 3.0)), "not lifted off the block"), (((1.0, -3.0),), "touched nothing")],
)
def test_a_press_that_was_not_made_or_not_lifted_has_no_figure(moves, reason, tmp_path):
    with pytest.raises(BadRequest, match=reason):
        draw_dents(recorded_press(moves), tmp_path / "a.svg")


def test_what_is_drawn_of_the_mesh_is_where_its_nodes_are(pressed):
    figure, mesh = dents_figure(pressed), pressed.mesh

    for axes, each in zip(figure.axes, slices_of(pressed), strict=True):
        drawn = axes.patches[1].get_path().vertices
        there = mesh.points_mm + each.displacement_mm
        assert axes.get_aspect() == 1.0
        assert {tuple(point) for point in drawn.round(9)} == {tuple(point) for point in deformed(mesh, each).round(9)}
        assert np.ptp(drawn, axis=0) == pytest.approx(np.ptp(there, axis=0), rel=1e-6)


@pytest.mark.parametrize("name", MESHES)
def test_a_mesh_is_drawn_with_each_edge_once_and_its_rim_as_one_loop(name, pressed):
    edges, rim = edges_of(replace(pressed.mesh, triangles=MESHES[name].triangles.T))

    passed = [tuple(sorted(pair)) for walk in trails(edges) for pair in pairwise(walk)]

    assert sorted(passed) == [tuple(edge) for edge in edges.tolist()]
    ((first, *_, last),) = trails(rim)
    assert first == last


def test_figure_15_says_its_scale_and_how_large_the_dent_is(pressed, tmp_path):
    draw_dents(pressed, tmp_path / "a.svg")

    written = texts(tmp_path / "a.svg")
    dents = [scene["observed"]["dent_mm"] for scene in pressed.scenes]
    assert any("to scale, displacements as large as they are" in text for text in written)
    assert {f"{dents[104]:.2f} mm", f"{dents[156]:.2f} mm", "20 mm"} <= set(written)
    assert f"push, 2.00 s: depth 4.00 mm, {pressed.scenes[40]['force_n']:.2f} N" in written


def test_the_dent_of_a_flat_punch_is_measured_in_its_middle(pressed):
    below = np.flatnonzero(np.abs(pressed.mesh.points_mm[:, 0] - 40) < 11)
    top = below[pressed.mesh.points_mm[below, 1] == 40]
    moved = np.zeros_like(pressed.slices[0].displacement_mm)
    moved[top] = [0.0, -2.0]

    node = lowest(pressed.mesh, replace(pressed.slices[0], displacement_mm=moved))

    assert pressed.mesh.points_mm[node] == pytest.approx([40, 40])


def test_stress_at_nodes_is_the_mean_of_the_triangles_around_by_area(pressed):
    for mesh in MESHES.values():
        values = np.random.default_rng(1).normal(size=mesh.area.size)
        seen = replace(pressed.mesh, points_mm=1000 * mesh.points, triangles=mesh.triangles.T)

        assert at_nodes(seen, values) == pytest.approx(at_nodes_of(mesh, values))


@pytest.mark.parametrize("what", KINDS)
def test_colours_of_stress_grow_darker_from_none_to_the_greatest(what):
    shades = [lightness(colour) for colour in colours_of(KINDS[what], 9).colors]

    falls = np.diff(shades if what == "von Mises" else shades[::-1])
    assert (falls < -0.02).all()


@pytest.mark.parametrize("what", KINDS)
def test_bands_of_stress_hold_all_values_and_one_of_them_no_stress(what):
    kind = KINDS[what]

    levels = levels_of(kind, [np.array([-13.7, 0.0]) if kind.first else np.array([0.0, 8.5])])

    assert levels[0] <= (-13.7 if kind.first else 0.0)
    assert levels[-1] >= (0.0 if kind.first else 8.5)
    assert 6 <= len(levels) <= 16
    assert 0.0 not in levels[1:]


def test_figure_16_has_one_bar_for_all_and_says_where_there_is_no_stress(pressed, tmp_path):
    draw_stresses(pressed, tmp_path / "a.svg")

    written = texts(tmp_path / "a.svg")
    assert written.count("von Mises stress [kPa]") == 1
    assert sum("below 0.001 kPa" in text for text in written) == 2  # one Poisson ratio: a dent without stress
    assert any("to scale" in text for text in written)
    assert len(stresses_figure(pressed).axes) == 5


def test_figure_16_shows_the_stress_that_unlike_poisson_ratios_leave(tmp_path):
    draw_stresses(recorded_press(material=UNLIKE), tmp_path / "a.svg")

    written = texts(tmp_path / "a.svg")
    assert not any("below 0.001" in text for text in written)


def test_figure_16_may_show_sigma_y_and_nothing_unknown(pressed, tmp_path):
    draw_stresses(pressed, tmp_path / "a.svg", "sigma_y")

    assert any("pressure negative" in text for text in texts(tmp_path / "a.svg"))
    with pytest.raises(BadRequest, match="no picture of 'sigma_q': von Mises, sigma_y"):
        draw_stresses(pressed, tmp_path / "b.svg", "sigma_q")


def test_figures_of_four_thousand_triangles_stay_small(tmp_path):
    fine = recorded_press(columns=64)

    for draw in (draw_dents, draw_stresses):
        draw(fine, tmp_path / "a.svg")

        assert (tmp_path / "a.svg").stat().st_size < 500_000


def test_a_run_of_a_press_shows_force_depth_and_cells(pressed, tmp_path):
    draw_run(pressed, tmp_path / "a.svg")

    written = texts(tmp_path / "a.svg")
    assert {"load cell", "true", "P, measured", "commanded", "indenter, true", *LABELS} <= set(written)
    assert {"force [N]", "depth [mm]", "cells [kPa]", "current [mA]", "time [s]"} <= set(written)
    assert f"2.00 s, {pressed.scenes[40]['force_n']:.2f} N" in written


def test_a_run_that_nobody_saw_has_the_curves_of_the_press_alone(tmp_path):
    draw_run(recorded_press(observed=False), tmp_path / "a.svg")

    written = set(texts(tmp_path / "a.svg"))
    assert {"load cell", "P, measured", *LABELS} <= written
    assert not {"true", "indenter, true", "a", "b"} & written


def test_a_block_that_nobody_saw_inside_is_drawn_by_its_surface(pressed, tmp_path):
    unseen = replace(pressed, mesh=None, slices=[])
    scene = pressed.scenes[telling(pressed)[1]]

    draw_run(unseen, tmp_path / "a.svg")

    (left, bottom), (right, _) = (getattr(body(unseen, scene).vertices, end)(axis=0) for end in ("min", "max"))
    assert [left, bottom, right] == pytest.approx([0.0, 0.0, 80.0], abs=1.0)
    assert body(pressed, scene).vertices[:, 1].max() == pytest.approx(
        body(unseen, scene).vertices[:, 1].max(), abs=1e-5
    )
    assert {"a", "b", "load cell"} <= set(texts(tmp_path / "a.svg"))


def test_a_press_without_a_load_cell_has_the_curves_that_it_has(pressed, tmp_path):
    bare = replace(pressed, telemetry=[replace(row, load_n=None) for row in pressed.telemetry])

    draw_run(bare, tmp_path / "a.svg")

    assert {"C1", "P, measured"} <= set(texts(tmp_path / "a.svg"))
    assert "load cell" not in texts(tmp_path / "a.svg")


def test_fingers_with_a_load_cell_are_drawn_as_fingers(tmp_path):
    pinch = recorded_pinch()
    loaded = replace(pinch, telemetry=[replace(row, load_n=1.0) for row in pinch.telemetry])

    draw_run(loaded, tmp_path / "a.svg")

    assert {"R", "L", "joints [°]"} <= set(texts(tmp_path / "a.svg"))


def test_a_press_without_a_hold_is_shown_with_the_block_before_it():
    twice = recorded_press(TWICE[2:])

    shown = [twice.scenes[i] for i in telling(twice)]

    assert [scene["touching"] for scene in shown] == [False, True, False, False]
    assert shown[0]["t_s"] < shown[1]["t_s"]


def test_a_press_that_still_presses_is_shown_at_even_times():
    pressing = recorded_press(((1.0, 3.0), (1.0, 3.0)))

    assert telling(pressing) == [0, 13, 26, 39]


def test_the_same_press_gives_the_same_bytes(pressed, tmp_path):
    again = recorded_press()
    for draw in (draw_dents, draw_stresses, draw_run):
        draw(pressed, tmp_path / "a.svg")
        draw(again, tmp_path / "b.svg")

        assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


@pytest.mark.parametrize("draw", [draw_dents, draw_stresses])
def test_figures_of_a_block_need_a_press_that_is_seen_inside(draw, pressed, tmp_path):
    with pytest.raises(BadRequest, match="shows a block under a press"):
        draw(recorded_pinch(), tmp_path / "a.svg")
    with pytest.raises(BadRequest, match="needs an observer"):
        draw(recorded_press(observed=False), tmp_path / "a.svg")
    with pytest.raises(BadRequest, match="needs the fields of a block"):
        draw(replace(pressed, mesh=None), tmp_path / "a.svg")


def test_a_film_of_a_press_is_refused(pressed, tmp_path):
    with pytest.raises(BadRequest, match="shows a body"):
        draw_film(pressed, tmp_path / "a.svg")


@pytest.mark.parametrize("draw", [draw_dents, draw_stresses, draw_run])
def test_a_picture_may_be_a_png(draw, pressed, tmp_path):
    draw(pressed, tmp_path / "a.png")

    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
