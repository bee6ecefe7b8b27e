"""The picture of a run: (a) the body along the ground, (b) its fastest movement, (c) the curves over time.

Without scenes (a real robot, a plain log) only the curves are drawn.
"""

from __future__ import annotations

from collections.abc import Callable

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from host.errors import BadRequest
from host.recording import Recording
from host.view import curves
from host.view.body import slope_of
from host.view.film import draw_frames, draw_strip, frame_boxes, strip_extent, strip_slope
from host.view.instants import Numbers, fastest, nearby, scene_times
from host.view.style import FAINT, PAGE_MM, heat_scale, page

LEFT_MM, RIGHT_MM, TOP_MM, BOTTOM_MM = 14.0, 3.0, 9.0, 9.0
BAR_MM = 14.0  # to the right of the strip, for the colour bar
STRIP_MAX_MM = 90.0
FRAMES = 5
GAP_MM = 5.0
NAME_MM = 4.5  # a panel's letter and what it shows
Panel = tuple[Callable[[Axes, Recording], None], float]  # what draws it, and its height in mm
CURVES: tuple[Panel, ...] = ((curves.draw_temperatures, 36.0), (curves.draw_duties, 27.0), (curves.draw_current, 18.0))
TRAVEL_MM = 20.0


def run_figure(recording: Recording) -> Figure:
    """Return the picture; BadRequest when nothing was recorded."""
    if not recording.telemetry:
        raise BadRequest("nothing to draw: the record holds no telemetry")
    film = nearby(recording)
    frames = fastest(film, FRAMES) if len(film.scenes) > 1 else []
    panels = [*CURVES, (curves.draw_travel, TRAVEL_MM)] if frames else list(CURVES)
    film_mm = _film_heights(film, frames) if frames else (0.0, 0.0)
    height = TOP_MM + sum(film_mm) + NAME_MM + sum(mm + GAP_MM for _, mm in panels) + BOTTOM_MM
    figure = page(height)
    figure.text(LEFT_MM / PAGE_MM, 1 - 3.5 / height, recording.title, va="center", fontsize=8.5, weight="bold")
    sheet = _Sheet(figure, height)
    if frames:
        _draw_film(sheet, film, frames, film_mm)
    sheet.name("c" if frames else "", "what the robot measured" + ", and what was true" * bool(frames))
    _draw_curves(sheet, recording, panels, scene_times(film)[frames])
    return figure


class _Sheet:
    """Hands out axes from the top of the page down, in mm."""

    def __init__(self, figure: Figure, height_mm: float) -> None:
        self.figure = figure
        self._height = height_mm
        self.y_mm = height_mm - TOP_MM

    def axes(self, left_mm: float, width_mm: float, height_mm: float, share: Axes | None = None) -> Axes:
        """Return axes below the present height, which stays."""
        box = (left_mm / PAGE_MM, (self.y_mm - height_mm) / self._height, width_mm / PAGE_MM, height_mm / self._height)
        return self.figure.add_axes(box, sharex=share)

    def name(self, letter: str, what: str) -> None:
        """Write the panel's letter and what it shows, and go on below them."""
        y = self.y_mm / self._height
        self.figure.text(3.0 / PAGE_MM, y, letter, va="top", fontsize=8.5, weight="bold")
        self.figure.text(7.0 / PAGE_MM, y - 0.3 / self._height, what, va="top", fontsize=7)
        self.y_mm -= NAME_MM


def _film_heights(film: Recording, frames: list[int]) -> tuple[float, float]:
    """Return the heights of the strip and of the frames with their names, which follow from their widths."""
    strip, frame = strip_extent(film), frame_boxes(film, frames)[0]
    wide = PAGE_MM - LEFT_MM - RIGHT_MM - BAR_MM
    strip_mm = min(1.0, wide / (strip[1] - strip[0])) * (strip[3] - strip[2])  # never larger than it is
    frame_mm = (PAGE_MM - LEFT_MM - RIGHT_MM) / FRAMES * (frame[3] - frame[2]) / (frame[1] - frame[0])
    return NAME_MM + min(strip_mm, STRIP_MAX_MM) + GAP_MM, NAME_MM + frame_mm + GAP_MM


def _draw_film(sheet: _Sheet, film: Recording, frames: list[int], heights_mm: tuple[float, float]) -> None:
    hottest = max(coil["degc"] for scene in film.scenes for coil in scene["coils"].values())
    heat = heat_scale(hottest)
    strip_mm, frame_mm = (height - NAME_MM - GAP_MM for height in heights_mm)
    sheet.name("a", f"the body along the ground{_slope(film)}, scale in mm; blue: the path of its hub")
    wide = PAGE_MM - LEFT_MM - RIGHT_MM - BAR_MM
    draw_strip(sheet.axes(LEFT_MM, wide, strip_mm), film, heat)
    _draw_bar(sheet, heat, strip_mm)
    sheet.y_mm -= strip_mm + GAP_MM
    sheet.name("b", "its fastest movement, shaded in c; a dot marks the coil that is driven")
    each = (PAGE_MM - LEFT_MM - RIGHT_MM) / FRAMES
    boxes = [sheet.axes(LEFT_MM + i * each, each, frame_mm) for i in range(FRAMES)]
    draw_frames(boxes, film, frames, heat)
    sheet.y_mm -= frame_mm + GAP_MM


def _slope(recording: Recording) -> str:
    """Return what is to be said of the slope; a bench may tilt its plane only once the robot has taken hold."""
    slope = strip_slope(recording)
    if not slope:
        return ""
    level = [scene["host_ms"] for scene in recording.scenes if slope_of(scene) != slope]
    since = f" from {recording.seconds(level[-1]):.1f} s on" if level else ""
    return f" (slope {slope:.3g}°{since})"


def _draw_bar(sheet: _Sheet, heat: ScalarMappable, height_mm: float) -> None:
    box = sheet.axes(PAGE_MM - RIGHT_MM - BAR_MM + 4.0, 2.2, min(height_mm - 4.0, 34.0))
    bar = sheet.figure.colorbar(heat, cax=box)
    bar.outline.set_linewidth(0.4)
    box.set_title("coil [°C]", fontsize=6.5, pad=6)


def _draw_curves(sheet: _Sheet, recording: Recording, panels: list[Panel], shaded_s: Numbers) -> None:
    first: Axes | None = None
    for draw, height_mm in panels:
        axes = sheet.axes(LEFT_MM, PAGE_MM - LEFT_MM - RIGHT_MM, height_mm, first)
        first = first or axes
        draw(axes, recording)
        if len(shaded_s):
            axes.axvspan(shaded_s[0], shaded_s[-1], color=FAINT, alpha=0.25, lw=0, zorder=0)
        axes.yaxis.set_label_coords(-9.0 / (PAGE_MM - LEFT_MM - RIGHT_MM), 0.5)
        axes.tick_params(labelbottom=False)
        sheet.y_mm -= height_mm + GAP_MM
    axes.tick_params(labelbottom=True)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=10, steps=[1, 2, 5, 10]))
    axes.set_xlabel("time [s]", labelpad=1)
    times = curves.record_times(recording)
    axes.set_xlim(float(times[0]), float(times[-1]))
