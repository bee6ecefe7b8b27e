"""`softrig figure`: which script runs where, and what is told of each figure."""

import pytest

from host.cli import figure as figures
from host.cli import main as softrig
from host.errors import BadRequest


class Opened(Exception):
    """The address that was opened."""


@pytest.fixture
def no_robot(monkeypatch, tmp_path):
    script = tmp_path / "some.gait"
    script.write_text("gait 1\nrobot sphere-b\nfire A100 at 60 % for 1 s\n", encoding="utf-8")

    def refuse(address):
        raise Opened(address)

    monkeypatch.setattr(figures, "script_path", lambda name: script)
    monkeypatch.setattr(figures, "open_link", refuse)
    return tmp_path / "figure.svg"


@pytest.mark.parametrize(
    ("number", "address"),
    [
        ("7", "sim:sphere-b"),
        ("8", "sim:sphere-b?slope=10"),
        ("9", "sim:sphere-b"),
        ("13", "sim:sphere-b"),
        ("15", "sim:sphere-b"),
        ("16", "sim:sphere-b"),
        ("nail", "sim:sphere-b?tip=nail&set=servos.dead_band_us:0"),
    ],
)
def test_a_figure_runs_on_its_own_bench(number, address, no_robot):
    with pytest.raises(Opened, match=address.replace("?", r"\?") + "$"):
        softrig(["figure", number, "-o", str(no_robot)], standalone_mode=False)


def test_a_robot_that_is_named_is_taken_as_it_is(no_robot):
    with pytest.raises(Opened, match=r"sim:sphere-b$"):
        softrig(["figure", "8", "-o", str(no_robot), "--robot", "sim:sphere-b"], standalone_mode=False)


def test_a_figure_that_compares_two_benches_takes_no_robot(no_robot):
    with pytest.raises(BadRequest, match="figure nail compares 2 robots of the bench: it takes no --robot"):
        softrig(["figure", "nail", "-o", str(no_robot), "--robot", "sim:sphere-b"], standalone_mode=False)


def test_a_figure_of_several_runs_is_drawn_from_all_of_them_in_their_order(monkeypatch, tmp_path):
    drawn = []
    pair = figures.FIGURES["nail"]._replace(draw=lambda *given: drawn.append(given))
    monkeypatch.setitem(figures.FIGURES, "nail", pair)
    monkeypatch.setattr(figures, "recorded", lambda wanted, robot: wanted.settings)

    softrig(["figure", "nail", "-o", str(tmp_path / "a.svg")], standalone_mode=False)

    ((nail, radial, path),) = drawn
    assert ("tip=nail" in nail, "tip=radial" in radial, path) == (True, True, tmp_path / "a.svg")


def test_each_figure_has_its_line_of_help():
    for number, figure in figures.FIGURES.items():
        assert f"{number}: {figure.shows}." in figures.HELP.splitlines()


def test_scripts_that_are_not_here_are_asked_for_by_name(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)

    with pytest.raises(BadRequest, match=r"there is no gaits/nowhere\.gait here"):
        figures.script_path("nowhere.gait")
