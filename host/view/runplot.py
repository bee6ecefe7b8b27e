"""The picture of a run: (a) the body along the ground, (b) its fastest movement, (c) the curves over time.

A body in space is drawn in space; robots with joints have pictures of their own (handplot, pressplot). Without scenes
(a real robot, a plain log) only the curves are drawn. The film of a run shows more frames and of the curves only the
travel.
"""

from __future__ import annotations

from types import ModuleType

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from host.errors import BadRequest
from host.recording import Recording
from host.view import curves, energy, march
from host.view import film as plane
from host.view.body import slope_of
from host.view.film import strip_slope
from host.view.handplot import hand_figure
from host.view.instants import between, fastest, nearby, scene_times
from host.view.jointcurves import has_joints
from host.view.panels import Panel, draw_panels, shade_over, stacked_mm
from host.view.presscurves import presses
from host.view.pressplot import press_figure
from host.view.sheet import BAR_MM, BOTTOM_MM, GAP_MM, LEFT_MM, NAME_MM, RIGHT_MM, TOP_MM, Sheet, heat_of
from host.view.style import PAGE_MM

STRIP_MAX_MM = 90.0
TEMPERATURES_MM, CURRENT_MM, TRAVEL_MM, ENERGY_MM = 36.0, 18.0, 20.0, 24.0
LABEL_MM, LONG_LABEL_MM = 9.0, 10.6  # from the axis to its name, where that of a coil is one letter, or longer
DUTY_MM, MOST_ROWS, ROW_MM = 27.0, 8, 3.2


def run_figure(recording: Recording) -> Figure:
    """Return the picture; BadRequest when nothing was recorded."""
    if not recording.telemetry:
        raise BadRequest("nothing to draw: the record holds no telemetry")
    if presses(recording):
        return press_figure(recording)
    if has_joints(recording):
        return hand_figure(recording)
    rows = len(curves.used(recording))
    duty_mm = DUTY_MM if rows <= MOST_ROWS else ROW_MM * rows
    measured: list[Panel] = [
        (curves.draw_temperatures, TEMPERATURES_MM),
        (curves.draw_duties, duty_mm),
        (curves.draw_current, CURRENT_MM),
    ]
    seen: list[Panel] = [(curves.draw_travel, TRAVEL_MM)]
    if energy.jumps(recording):
        seen.append((energy.draw_marked, ENERGY_MM))
    return _picture(recording, 1, measured, seen, "what the robot measured")


def film_figure(recording: Recording, rows: int = 2) -> Figure:
    """Return the film of a run that an observer saw: strip, frames in rows, travel."""
    return _picture(recording, rows, [], [(curves.draw_travel, TRAVEL_MM)], "")


def _picture(recording: Recording, rows: int, measured: list[Panel], seen: list[Panel], what: str) -> Figure:
    film = nearby(recording)
    frames = _frames(film, rows) if len(film.scenes) > 1 else []
    panels = measured + seen * bool(frames)
    strip_mm, row_mm = _film_heights(film, frames) if frames else (0.0, 0.0)
    rows_mm = strip_mm + row_mm * rows + (2 * NAME_MM + GAP_MM) * bool(frames)
    height = TOP_MM + rows_mm + NAME_MM + stacked_mm(panels) + BOTTOM_MM
    sheet = Sheet(height, recording.title)
    if frames:
        _draw_film(sheet, film, frames, (strip_mm, row_mm))
    told = ", and what was true" if measured else "how far it came"
    sheet.name("c" if frames else "", what + told * bool(frames))
    label_mm = LABEL_MM if max(map(len, recording.labels)) == 1 else LONG_LABEL_MM
    draw_panels(sheet, recording, panels, shade_over(scene_times(film)[frames]), label_mm)
    return sheet.figure


def _looks(film: Recording) -> ModuleType:
    """Return what draws bodies of these scenes: in the plane or in space."""
    return march if len(film.scenes[0]["nodes"][0]) == 3 else plane


def _frames(film: Recording, rows: int) -> list[int]:
    """Return the scenes for rows of frames: of a jump, from its release to its apex; else of the fastest movement."""
    count, instants = rows * _looks(film).ROW, energy.instants_of(film)
    return between(film, instants["release"], instants["apex"], count) if instants else fastest(film, count)


def _film_heights(film: Recording, frames: list[int]) -> tuple[float, float]:
    """Return the heights of the strip and of a row of frames with the gap below, which follow from their widths."""
    looks = _looks(film)
    strip, box = looks.strip_extent(film), looks.frame_boxes(film, frames)[0]
    wide = PAGE_MM - LEFT_MM - RIGHT_MM - BAR_MM
    strip_mm = min(1.0, wide / (strip[1] - strip[0])) * (strip[3] - strip[2])  # never larger than it is
    frame_mm = (PAGE_MM - LEFT_MM - RIGHT_MM) / looks.ROW * (box[3] - box[2]) / (box[1] - box[0])
    return min(strip_mm, STRIP_MAX_MM) + GAP_MM, frame_mm + GAP_MM


def _draw_film(sheet: Sheet, film: Recording, frames: list[int], heights_mm: tuple[float, float]) -> None:
    looks, heat = _looks(film), heat_of(film)
    strip_mm, row_mm = heights_mm
    grid = looks.scale_told(film)
    sheet.name("a", f"the body along the ground{_slope(film)}, {grid}; blue: the path of its hub")
    draw_strip_axes = sheet.axes(LEFT_MM, PAGE_MM - LEFT_MM - RIGHT_MM - BAR_MM, strip_mm - GAP_MM)
    looks.draw_strip(draw_strip_axes, film, heat)
    sheet.bar(heat, strip_mm - GAP_MM)
    sheet.y_mm -= strip_mm
    sheet.name("b", "its fastest movement, shaded in c; a dot marks the coil that is driven")
    each = (PAGE_MM - LEFT_MM - RIGHT_MM) / looks.ROW
    boxes: list[Axes] = []
    for _ in range(len(frames) // looks.ROW):
        boxes += [sheet.axes(LEFT_MM + i * each, each, row_mm - GAP_MM) for i in range(looks.ROW)]
        sheet.y_mm -= row_mm
    looks.draw_frames(boxes, film, frames, heat)


def _slope(recording: Recording) -> str:
    """Return what is to be said of the slope; a bench may tilt its plane only once the robot has taken hold."""
    slope = strip_slope(recording)
    if not slope:
        return ""
    level = [scene["host_ms"] for scene in recording.scenes if slope_of(scene) != slope]
    since = f" from {recording.seconds(level[-1]):.1f} s on" if level else ""
    return f" (slope {slope:.3g}°{since})"
