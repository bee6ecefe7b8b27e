"""Pictures of bodies in space: what is nearer hides what is farther, lengths can be read off, a jump is told."""

import re
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure

from hil_sim.bodies.sphere import SpherePlant
from hil_sim.robots.file import load
from host.errors import BadRequest
from host.view import draw_film, draw_jump, draw_run
from host.view.camera import distance, on_paper, plumb, silhouette
from host.view.energy import instants_of
from host.view.floor import grid_mm, profile_of
from host.view.jump import flight_of, release_of
from host.view.solids import core_radius, curved, edges, paint, shaded, springs, strips
from host.view.sphere import named, spread
from host.view.style import heat_scale
from tests.rolling_sphere import JumpingSphere, RollingSphere, recorded_jump, recorded_sphere


def texts(path):
    """Return what is written in an SVG: the backend leaves each text as a comment above its outlines."""
    return re.findall(r"<!-- (.*?) -->", path.read_text(encoding="utf-8"))


@pytest.fixture
def scene():
    sphere = RollingSphere()
    sphere.t_s = 3.4
    return sphere.snapshot()


def test_the_made_up_sphere_tells_what_that_of_the_bench_tells(scene):
    seen = SpherePlant(load("sphere-b")).snapshot()

    assert set(scene) == set(seen)
    assert set(scene["coils"]) == set(seen["coils"])
    assert set(scene["coils"]["A100"]) - {"duty"} == set(seen["coils"]["A100"])  # which the bench knows
    assert set(scene["energy_j"]) == set(seen["energy_j"])


def test_travel_height_and_slope_are_true_to_scale_on_paper():
    start, along, up = on_paper([[0, 30, 0], [10, 30, 0], [0, 30, 10]], 0.0)
    uphill = on_paper([[10.0, 0.0, 0.0]], 30.0)[0]

    assert along - start == pytest.approx([10, 0])
    assert up - start == pytest.approx([0, 10])
    assert uphill == pytest.approx([8.660, 5.0], abs=1e-3)


def test_what_falls_together_on_paper_is_told_apart_by_its_distance():
    near, far = [0.0, -20.0, 0.0], [-13.6, 20.0, -8.8]

    assert on_paper([near], 0.0) == pytest.approx(on_paper([far], 0.0))
    assert distance([near], 0.0)[0] < distance([far], 0.0)[0]


def test_a_shadow_lies_straight_below_on_a_slope():
    above, below = on_paper([[0, 0, 50.0]], 10.0)[0], on_paper(plumb([[0, 0, 50.0]], 10.0), 10.0)[0]

    assert above[0] == pytest.approx(below[0])
    assert below[1] < above[1]


def test_a_ball_is_at_least_as_wide_as_it_is():
    outline = silhouette([5.0, 0.0, 0.0], 10.0, 0.0)

    assert outline.mean(axis=0) == pytest.approx([5.0, 0.0])
    assert np.hypot(*(outline - [5.0, 0.0]).T).min() == pytest.approx(10.0, rel=0.01)


def test_a_strip_has_its_width_and_lies_across_the_plane_of_its_hoop(scene):
    for hoop, (left, right) in zip(scene["hoops"], edges(scene), strict=True):
        middle, nodes = (left + right) / 2, np.array(scene["nodes"])[hoop]

        assert np.linalg.norm(right - left, axis=1) == pytest.approx(scene["strip_mm"])
        assert middle[0:-1:2] == pytest.approx(nodes)


def test_a_curve_goes_through_the_points_that_it_is_given():
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])

    smooth = curved(ring)

    assert smooth[::2] == pytest.approx(ring)
    assert np.linalg.norm(smooth, axis=1) == pytest.approx(1.0, abs=1e-3)


def test_nearer_pieces_of_a_hoop_are_darker(scene):
    pieces = sorted(strips(scene, 0.0), key=lambda piece: piece.away)

    light = [sum(piece.filling[:3]) for piece in pieces]
    assert light == sorted(light)
    assert sum(shaded(-1.0)[:3]) < sum(shaded(1.0)[:3])


def test_what_is_nearer_is_painted_later(scene):
    axes = Figure().add_subplot()
    pieces = list(strips(scene, 0.0))

    paint(axes, pieces, zorder=3)

    (drawn,) = axes.collections
    last = drawn.get_paths()[-1].vertices[:-1]
    assert last == pytest.approx(min(pieces, key=lambda piece: piece.away).points)


def test_each_coil_is_drawn_and_a_driven_one_has_a_dot(scene):
    heat = heat_scale(120.0)

    without = list(springs(scene, 0.0, heat, ()))
    with_dot = list(springs(scene, 0.0, heat, ("A10m1",)))

    assert len(with_dot) == len(without) + 1
    assert any(piece.line == heat.to_rgba(scene["coils"]["A10m1"]["degc"]) for piece in without)


def test_a_core_is_as_large_as_the_beginnings_of_its_coils_say():
    assert core_radius(RollingSphere(0.0, 100.0, 30.0).snapshot()) == pytest.approx(30.0)


def test_coils_at_rest_carry_no_name(scene):
    assert named(scene, ("A10m1",)) == ["A00m1", "A10m1"]


def test_of_very_many_hot_coils_none_is_named():
    sphere = JumpingSphere()
    sphere.t_s = 2.5

    assert named(sphere.snapshot(), tuple(sphere.snapshot()["coils"])) == []


def test_names_move_apart_and_stay_in_order():
    moved = spread([0.0, 1.0, 1.5, 30.0], 5.0)

    assert all(b - a >= 5.0 for a, b in pairwise(moved))
    assert spread([], 5.0) == []


@pytest.mark.parametrize(("width_mm", "grid"), [(90.0, 20.0), (200.0, 50.0), (40.0, 10.0)])
def test_the_grid_is_a_round_length(width_mm, grid):
    assert grid_mm(width_mm) == pytest.approx(grid)


def test_uneven_ground_is_drawn_with_its_heights():
    scene = RollingSphere(terrain_mm=[(-100, 0), (50, 0), (50, 6), (400, 6)]).snapshot()

    profile = profile_of(scene, 0.0, 100.0)

    assert profile.tolist() == [[0, 0], [50, 0], [50, 6], [100, 6]]


def test_a_run_of_a_sphere_has_film_and_curves_of_the_coils_it_used(tmp_path):
    picture = tmp_path / "run.svg"

    draw_run(recorded_sphere(6.0), picture)

    written = texts(picture)
    assert {"0.0 s", "mm", "A00m1", "A10m1", "A100", "coil [°C]", "travel [mm]"} <= set(written)
    assert any("grid 20 mm" in text for text in written)
    assert "A0m10" not in written
    assert "energy [mJ]" not in written


def test_a_run_that_jumps_shows_its_energies(tmp_path):
    picture = tmp_path / "run.svg"

    draw_run(recorded_jump(), picture)

    assert {"energy [mJ]", "take-off", "apex"} <= set(texts(picture))


def test_a_film_has_its_slope_and_two_rows_of_frames(tmp_path):
    picture = tmp_path / "film.svg"

    draw_film(recorded_sphere(6.0, RollingSphere(10.0)), picture)

    written = texts(picture)
    assert any("slope 10°" in text for text in written)
    assert sum(bool(re.fullmatch(r"\d\.\d s", text)) for text in written) >= 8


def test_a_film_is_the_same_file_each_time(tmp_path):
    first, second = tmp_path / "first.svg", tmp_path / "second.svg"

    draw_film(recorded_sphere(4.0), first)
    draw_film(recorded_sphere(4.0), second)

    assert first.read_bytes() == second.read_bytes()
    ElementTree.parse(first)


def test_ground_that_is_not_even_is_drawn(tmp_path):
    picture = tmp_path / "film.svg"

    draw_film(recorded_sphere(3.0, RollingSphere(terrain_mm=[(-500, 0), (90, 0), (90, 5), (900, 5)])), picture)

    assert b"#ddd6ca" in picture.read_bytes()  # the cut through the ground


def test_release_take_off_and_apex_are_found(tmp_path):
    instants = instants_of(recorded_jump())

    assert instants["release"] == pytest.approx(4.93, abs=0.001)
    assert instants["take-off"] == pytest.approx(4.945, abs=0.001)
    assert instants["apex"] == pytest.approx(5.125, abs=0.003)


def test_a_flight_is_shown_from_the_release_over_the_apex_to_the_landing():
    jump = recorded_jump()

    times = [jump.seconds(jump.scenes[i]["host_ms"]) for i in flight_of(jump)]

    assert times == pytest.approx([4.93, 4.945, 5.035, 5.125, 5.215, 5.305], abs=0.003)


def test_frames_of_a_release_are_milliseconds_apart():
    jump = recorded_jump()

    times = [jump.scenes[i]["host_ms"] for i in release_of(jump)]

    assert max(b - a for a, b in pairwise(times)) <= 10


def test_the_picture_of_a_jump_tells_its_height_and_instants(tmp_path):
    picture = tmp_path / "jump.svg"

    draw_jump(recorded_jump(), picture)

    assert {"186 mm", "take-off", "+90 ms", "apex", "energy [mJ]", "200 mm"} <= set(texts(picture))


def test_a_crawl_is_no_jump_to_draw(tmp_path):
    with pytest.raises(BadRequest, match="did not jump"):
        draw_jump(recorded_sphere(3.0), tmp_path / "jump.svg")


def test_figures_of_a_body_need_somebody_who_sees_it(tmp_path):
    unseen = recorded_sphere(3.0)
    unseen.scenes.clear()

    with pytest.raises(BadRequest, match="needs an observer"):
        draw_film(unseen, tmp_path / "film.svg")
