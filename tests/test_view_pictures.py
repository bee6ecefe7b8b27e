"""Pictures are the same bytes each time, show what they must, and are refused before a robot moves."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from host import view
from host.errors import BadRequest
from host.recording import Recording
from host.view import check_pictures, draw_poses, draw_run
from host.view.body import spring
from host.view.style import AMBIENT_DEGC, HOT_DEGC, heat_scale
from tests.rolling_ring import LABELS, recorded_run


def texts(path):
    """Return what is written in an SVG: the backend leaves each text as a comment above its outlines."""
    return re.findall(r"<!-- (.*?) -->", path.read_text(encoding="utf-8"))


def test_a_run_with_an_observer_has_film_and_curves(tmp_path):
    picture = tmp_path / "run.svg"

    draw_run(recorded_run(6.0), picture)

    written = texts(picture)
    assert {"0.0 s", "mm", "coil [°C]", "supply [mA]", "travel [mm]", "time [s]", "true"} <= set(written)
    assert "circular-crawl.gait on sim:circular" in written
    assert set(LABELS) <= set(written)


def test_a_run_without_an_observer_has_curves_only(tmp_path):
    picture = tmp_path / "run.svg"

    draw_run(recorded_run(6.0, observed=False), picture)

    written = texts(picture)
    assert {"coil [°C]", "supply [mA]", "time [s]"} <= set(written)
    assert not {"travel [mm]", "mm", "true"} & set(written)


def test_the_slope_stands_in_the_picture(tmp_path):
    picture = tmp_path / "run.svg"

    draw_run(recorded_run(4.0, slope_deg=15.0), picture)

    assert any("slope 15°" in text for text in texts(picture))


def test_the_same_run_gives_the_same_bytes(tmp_path):
    first, second = tmp_path / "first.svg", tmp_path / "second.svg"

    draw_run(recorded_run(4.0), first)
    draw_run(recorded_run(4.0), second)

    assert first.read_bytes() == second.read_bytes()
    assert b"dc:date" not in first.read_bytes()


def test_figure_3_shows_the_body_at_rest_and_with_each_coil_contracted(tmp_path):
    picture = tmp_path / "poses.svg"

    draw_poses(recorded_run(16.0), picture)

    assert {"at rest", "coil A", "coil C", "coil E", "coil G"} <= set(texts(picture))
    ElementTree.parse(picture)


@pytest.mark.parametrize("suffix", ["svg", "png", "pdf"])
def test_a_picture_takes_the_format_of_its_name(suffix, tmp_path):
    picture = tmp_path / f"run.{suffix}"

    draw_run(recorded_run(1.0), picture)

    head = {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}[suffix]
    assert picture.read_bytes().startswith(head)


def test_a_name_that_is_no_picture_is_refused(tmp_path):
    with pytest.raises(BadRequest, match=r"name the picture \.svg, \.png or \.pdf"):
        check_pictures(tmp_path / "run.jpg")


def test_a_missing_folder_is_refused(tmp_path):
    with pytest.raises(BadRequest, match=r"there is no folder .*: mkdir -p "):
        check_pictures(tmp_path / "nowhere" / "run.svg")


def test_without_matplotlib_the_extra_to_install_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(view, "find_spec", lambda name: None)

    with pytest.raises(BadRequest, match=r"softrig\[plot\]"):
        check_pictures(tmp_path / "run.svg")


def test_an_empty_record_is_refused(tmp_path):
    with pytest.raises(BadRequest, match="nothing to draw"):
        draw_run(Recording(LABELS), tmp_path / "run.svg")


def test_poses_need_somebody_who_sees_the_body(tmp_path):
    with pytest.raises(BadRequest, match="needs an observer"):
        draw_poses(recorded_run(1.0, observed=False), tmp_path / "poses.svg")


def test_poses_need_each_coil_driven(tmp_path):
    with pytest.raises(BadRequest, match="coil G was never driven"):
        draw_poses(recorded_run(4.0), tmp_path / "poses.svg", ("A", "G"))


def test_a_shorter_coil_has_as_many_turns():
    hub = np.zeros(2)

    long, short = spring(hub, np.array([20.0, 0.0])), spring(hub, np.array([10.0, 0.0]))

    assert long.shape == short.shape
    assert long[:, 0] == pytest.approx(2 * short[:, 0])
    assert long[:, 1] == pytest.approx(short[:, 1])


def test_a_hotter_coil_is_darker():
    heat = heat_scale(90.0)

    light = [sum(heat.to_rgba(degc)[:3]) for degc in (AMBIENT_DEGC, 50.0, 75.0, HOT_DEGC)]

    assert light == sorted(light, reverse=True)
