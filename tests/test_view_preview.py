"""Pictures of scripts before they run: in SVG, light and dark, and in the terminal."""

import re
from io import StringIO
from xml.etree import ElementTree

import pytest
from rich.console import Console

from host.gait.compiler import compile_script
from host.gait.forecast import follow, model_of
from host.gait.model.course import Course, Gap
from host.gait.script import load, loads
from host.preview.compare import changes
from host.preview.drawing import wide
from host.preview.lanes import LEFT, RIGHT
from host.preview.picture import WIDTH, difference, picture
from host.preview.scale import Times, ticks, times_of
from host.preview.terminal import print_changes, print_timeline
from tests.gait_scripts import ROOT, circular, profile_of

SVG = "{http://www.w3.org/2000/svg}"
SCRIPT = """gait 1
robot circular
fire A at 60 % for 800 ms ramp 200 ms
hold B C at 80 C with 40 % for 2 s
note "B & C are <warm>"
wait until supply.current < 20 mA timeout 2 s else rest
fire D at 50 % for 1 s
label rest
"""
SHOWN = ["circular-crawl", "sphere-b-jump", "fingers-orient", "press-creep"]


@pytest.fixture(scope="module")
def forecast():
    return foretold(SCRIPT)


def foretold(text):
    """Return the forecast of a script for the circular robot, with curves."""
    return follow(compile_script(loads(text), circular()), model_of("sim:circular", circular()), 20)


def of_gait(name):
    """Return the forecast of a script of gaits/."""
    script = load(str(ROOT / "gaits" / f"{name}.gait"))
    robot = script.robot_name()
    profile = profile_of(robot)
    return follow(compile_script(script, profile), model_of(f"sim:{robot}", profile), 40)


def texts(svg):
    """Return place, width, height and text of everything that is written."""
    found = []
    for node in ElementTree.fromstring(svg).iter(f"{SVG}text"):
        size, text = float(node.get("font-size")), node.text or ""
        width = wide(text, size)
        x = float(node.get("x")) - {"end": width, "middle": width / 2}.get(node.get("text-anchor"), 0)
        found.append((x, float(node.get("y")) - 0.7 * size, width, 0.7 * size, text))
    return found


def test_a_picture_names_coils_lines_notes_peaks_and_units(forecast):
    written = {text for *_, text in texts(picture(forecast))}

    assert {"A", "B", "C", "D", "3", "B & C are <warm>", "label rest", "time [s]", "80 °C"} <= written
    assert "solid: other waits are over at once; dashed: they run out" in written


@pytest.mark.parametrize("name", SHOWN)
def test_no_text_of_a_picture_lies_over_another_or_beyond_its_edge(name):
    svg = picture(of_gait(name))

    places = texts(svg)
    over = [
        (a[4], b[4])
        for i, a in enumerate(places)
        for b in places[i + 1 :]
        if a[0] < b[0] + b[2] and b[0] < a[0] + a[2] and a[1] < b[1] + b[3] and b[1] < a[1] + a[3]
    ]
    assert len(places) > 10
    assert over == []
    assert all(x >= 0 and x + width <= 960 for x, _, width, _, _ in places)


def test_a_theme_is_dark_light_or_that_of_the_reader(forecast):
    light, dark, auto = (picture(forecast, theme) for theme in ("light", "dark", "auto"))

    assert "#ffffff" in light
    assert "#15181d" not in light
    assert "#15181d" in dark
    assert "#ffffff" not in dark
    assert "@media (prefers-color-scheme: dark)" in auto
    assert re.sub("<style>.*</style>", "", light) == re.sub("<style>.*</style>", "", dark)


def test_the_same_script_makes_the_same_picture(forecast):
    assert picture(forecast) == picture(foretold(SCRIPT))


def test_what_changed_is_told_for_each_coil_and_step(forecast):
    found = changes(forecast, foretold(SCRIPT.replace("for 2 s", "for 3 s").replace("D at", "E at")))

    by_label = {coil.label: coil for coil in found.coils}
    assert by_label["A"].same
    assert by_label["B"].on_ms.change == 1000
    assert by_label["D"].on_ms.new == by_label["E"].on_ms.old == 0
    assert [line for line, _ in found.added] == [line for line, _ in found.removed] == [4, 7]


def test_lines_are_those_of_the_script_also_where_it_calls_into_an_included_file():
    crawl = of_gait("circular-crawl")

    printed = on_terminal(lambda console: print_timeline(crawl, console)).splitlines()

    numbers = [number for line in printed if line.startswith("line ") for number in line.split()[1:]]
    assert set(numbers) == {"15", "19"}  # its two calls of push
    assert all(line.endswith("line 19") for line in printed if line.startswith(tuple("ABCDEFGH")))


def test_a_picture_of_a_change_lists_the_steps_of_both(forecast):
    svg = difference(forecast, foretold(SCRIPT.replace("for 2 s", "for 3 s")))

    written = [text for *_, text in texts(svg)]
    assert any(text.startswith("+") and "for 3 s" in text for text in written)
    assert any(text.startswith("−") and "for 2 s" in text for text in written)
    assert any("2.00 → 3.00 s" in text for text in written)


def test_the_terminal_shows_a_row_for_each_coil_with_its_peak(forecast):
    printed = on_terminal(lambda console: print_timeline(forecast, console))

    rows = [line for line in printed.splitlines() if line.startswith("B ")]
    assert len(rows) == 2  # early and late
    assert all("▒" in row and " 80 C" in row and "line 4" in row for row in rows)
    assert max(len(line) for line in printed.splitlines()) <= 100


def test_a_terminal_without_the_shades_gets_letters(forecast):
    printed = on_terminal(lambda console: print_timeline(forecast, console), "ascii")

    assert printed.isascii()
    assert "x" in printed


def test_the_terminal_tells_changes_as_a_table(forecast):
    other = foretold(SCRIPT.replace("for 2 s", "for 3 s"))

    printed = on_terminal(lambda console: print_changes(changes(forecast, other), console))

    assert "2.00 -> 3.00" in printed
    assert "+    4  hold B C at 80 C with 40 % for 3 s" in printed


def test_turns_that_are_not_told_take_little_room():
    times, gap = Times(0, 1000, 10_000), Gap(4_000, 1_004_000, 100)

    assert times.x(4_000, [gap]) == 400
    assert times.x(1_004_000, [gap]) == 460
    assert Course([], gaps=[gap], end_ms=1_006_000).told_ms == 6_000


def test_ticks_are_round_and_not_too_many():
    assert ticks(0, 18, 12) == [0, 2, 4, 6, 8, 10, 12, 14, 16, 18]
    assert ticks(-2.5, 0, 3) == [-2, -1, 0]


def on_terminal(show, encoding="utf-8"):
    """Return what a terminal of 100 columns was shown."""

    class Told(StringIO):
        pass

    Told.encoding = encoding
    told = Told()
    show(Console(file=told, width=100, highlight=False))
    return told.getvalue()


def test_what_happens_in_the_late_way_alone_is_drawn_dashed():
    forecast = of_gait("press-creep")

    paths = ElementTree.fromstring(picture(forecast)).iter(f"{SVG}path")
    solid = [node.get("d") for node in paths if node.get("class") == "joint"]

    ends = [float(x) for path in solid for x in re.findall(r"[ML]([\d.]+)", path)]
    times = times_of(list(forecast.ways.values()), LEFT, WIDTH - LEFT - RIGHT)
    assert max(ends) == pytest.approx(times.x(forecast.early.end_ms, []), abs=0.1)
