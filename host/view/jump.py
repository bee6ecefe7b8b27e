"""The jump of a sphere: (a) its flight, (b) the release frame by frame, (c) and (d) its energies, slow and fast."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from host.errors import BadRequest
from host.recording import Recording, Scene
from host.view import march
from host.view.body import slope_of
from host.view.camera import on_paper
from host.view.energy import draw_energies, instants_of, jumps, mark_jump
from host.view.film import Box, frame, together
from host.view.floor import HALF, Ends, draw_floor, multiples
from host.view.instants import between, hub, hubs_of, scene_times
from host.view.sheet import BAR_MM, BOTTOM_MM, GAP_MM, LEFT_MM, NAME_MM, RIGHT_MM, TOP_MM, Sheet, heat_of
from host.view.solids import body_width
from host.view.sphere import draw_sphere
from host.view.style import COILS, FAINT, INK, PAGE_MM, Style

IN_FLIGHT, CLOSE = 5, 4  # bodies from take-off to landing, frames of the release
COLUMN, PATCH = 1.45, 0.55  # from body to body, and ground to either side of one, of the body's width
AFTER_S = 0.01  # frames of the release end so long after the take-off
RULER_MM = 50.0
ENERGY_MM, SLOW_SHARE, BETWEEN_MM = 42.0, 0.55, 10.0
AROUND_S = 0.03  # of the fast energies, before the release and after the landing


def jump_figure(recording: Recording) -> Figure:
    """Return the picture; BadRequest when the body did not jump."""
    if not instants_of(recording):
        raise BadRequest("the body did not jump in this run: there is nothing to draw")
    flight, close = Flight(recording), release_of(recording)
    box, wide = march.frame_boxes(recording, close)[0], PAGE_MM - LEFT_MM - RIGHT_MM
    flight_mm = (wide - BAR_MM) * (flight.room[3] - flight.room[2]) / (flight.room[1] - flight.room[0])
    close_mm = wide / CLOSE * (box[3] - box[2]) / (box[1] - box[0])
    total_mm = TOP_MM + flight_mm + close_mm + ENERGY_MM + 3 * NAME_MM + 2 * GAP_MM + BOTTOM_MM
    sheet, heat = Sheet(total_mm, recording.title), heat_of(recording)
    sheet.name("a", "the jump, each body at its time from the take-off, to scale; blue: the path of its hub, over time")
    flight.draw(sheet.axes(LEFT_MM, wide - BAR_MM, flight_mm), heat)
    sheet.bar(heat, flight_mm)
    sheet.y_mm -= flight_mm + GAP_MM
    sheet.name("b", f"the release, {march.scale_told(recording)}; a dot marks a coil that is driven")
    boxes = [sheet.axes(LEFT_MM + i * wide / CLOSE, wide / CLOSE, close_mm) for i in range(CLOSE)]
    march.draw_frames(boxes, recording, close, heat)
    sheet.y_mm -= close_mm + GAP_MM
    _draw_energies(sheet, recording, wide)
    return sheet.figure


def release_of(recording: Recording) -> list[int]:
    """Return scenes from the release to just after the take-off."""
    instants = instants_of(recording)
    return between(recording, instants["release"], instants["take-off"] + AFTER_S, CLOSE)


class Flight:
    """The jump as a row of bodies, each moved aside to its own column; `room` is what they need on paper."""

    def __init__(self, recording: Recording) -> None:
        self.recording = recording
        self.indexes = flight_of(recording)
        self._width = body_width(recording.scenes[0])
        self._from_mm = float(hub(recording.scenes[self.indexes[0]])[0])
        self._columns = [i * COLUMN * self._width for i in range(len(self.indexes))]
        self._scenes = [
            moved(recording.scenes[i], x - self._from_mm) for i, x in zip(self.indexes, self._columns, strict=True)
        ]
        pairs = zip(self._scenes, self._columns, strict=True)
        self.room: Box = together(march.extent(s, self._patch(x), self._width, slope_of(s)) for s, x in pairs)

    def draw(self, axes: Axes, heat: ScalarMappable) -> None:
        """Draw bodies, ground, path and heights."""
        times = scene_times(self.recording)
        takeoff = instants_of(self.recording)["take-off"]
        self._draw_ruler(axes)
        for index, x, scene in zip(self.indexes, self._columns, self._scenes, strict=True):
            slope = slope_of(scene)
            draw_floor(axes, self._patch(x), self._width, scene, slope, 0)
            draw_sphere(axes, scene, slope, heat, self.recording.driven(scene["host_ms"]))
            self._write_instant(axes, x, slope, 1000 * float(times[index] - takeoff))
        self._draw_path(axes)
        self._draw_rise(axes)
        frame(axes, self.room)

    def _patch(self, x_mm: float) -> Ends:
        return x_mm - PATCH * self._width, x_mm + PATCH * self._width

    def _draw_ruler(self, axes: Axes) -> None:
        """Draw heights above the ground as faint lines behind the bodies."""
        left, right, _, top = self.room
        for z in multiples(0.0, top, RULER_MM):
            axes.plot([left, right], [z, z], color=FAINT, lw=0.3, zorder=0.2)
            text = f"{z:g} mm" if z else "0"
            style: Style = {"ha": "right", "va": "center", "fontsize": 6, "color": INK, "annotation_clip": False}
            axes.annotate(text, (left, z), (-2, 0), textcoords="offset points", **style)

    def _write_instant(self, axes: Axes, x_mm: float, slope_deg: float, time_ms: float) -> None:
        """Write the time from the take-off below a body's ground."""
        place = on_paper([[x_mm, -HALF * self._width, 0.0]], slope_deg)[0]
        text = f"{time_ms:+.0f} ms" if abs(time_ms) >= 1 else "take-off"
        style: Style = {"ha": "center", "va": "top", "fontsize": 6.5, "color": INK}
        axes.annotate(text, (float(place[0]), float(place[1])), (0, -3), textcoords="offset points", **style)

    def _draw_path(self, axes: Axes) -> None:
        """Draw the path of the hub from the take-off on, drawn out over time from column to column."""
        times, flown = scene_times(self.recording), self.indexes[1:]
        span = np.arange(flown[0], flown[-1] + 1)
        aside = np.interp(times[span], times[flown], self._columns[1:]) - self._from_mm
        hubs = hubs_of([self.recording.scenes[i] for i in span]) + np.outer(aside, (1, 0, 0))
        path = on_paper(hubs, slope_of(self._scenes[0]))
        axes.plot(*path.T, color=COILS[0], lw=0.9, marker=".", ms=2.5, zorder=4.5)

    def _draw_rise(self, axes: Axes) -> None:
        """Draw how far the body rose above where it stood, beside its highest place."""
        highest = max(self._scenes, key=lambda scene: float(hub(scene)[2]))
        slope, jump = slope_of(highest), jumps(self.recording) or {}
        foot = on_paper([hub(self.recording.scenes[0]) * (0, 0, 1)], slope)[0, 1]
        x, top = on_paper([hub(highest)], slope)[0] + (0.66 * self._width, 0.0)
        arrow = {"arrowstyle": "<->", "lw": 0.6, "color": INK, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (x, top), (x, foot), arrowprops=arrow, zorder=5)
        style: Style = {"ha": "left", "va": "center", "fontsize": 6.5, "color": INK}
        axes.annotate(f"{jump['apex_mm']:.0f} mm", (x, (top + foot) / 2), (3, 0), textcoords="offset points", **style)


def flight_of(recording: Recording) -> list[int]:
    """Return the release, the take-off, and scenes at even times to the landing, the apex midway."""
    times, instants = scene_times(recording), instants_of(recording)
    takeoff, apex = instants["take-off"], instants["apex"]
    even = np.linspace(takeoff, min(2 * apex - takeoff, float(times[-1])), IN_FLIGHT)
    found = {int(np.abs(times - t).argmin()) for t in (instants["release"], *even)}
    return sorted(found)


def moved(scene: Scene, x_mm: float) -> Scene:
    """Return a scene that is moved along the ground."""
    shift = np.array([x_mm, 0.0, 0.0])
    ends: dict[str, Any] = {
        label: {**coil, "from": np.array(coil["from"]) + shift, "to": np.array(coil["to"]) + shift}
        for label, coil in scene["coils"].items()
    }
    return {**scene, "hub": hub(scene) + shift, "nodes": np.array(scene["nodes"]) + shift, "coils": ends}


def _draw_energies(sheet: Sheet, recording: Recording, wide: float) -> None:
    """Draw the energies of the whole run, and beside them those of the jump at another scale of time."""
    sheet.name("c", "the energies of the body: stored slowly, released at once")
    instants, times = instants_of(recording), scene_times(recording)
    slow = SLOW_SHARE * (wide - BETWEEN_MM)
    whole = sheet.axes(LEFT_MM, slow, ENERGY_MM)
    close = sheet.axes(LEFT_MM + slow + BETWEEN_MM, wide - BETWEEN_MM - slow, ENERGY_MM)
    landing = 2 * instants["apex"] - instants["take-off"]
    shown = instants["release"] - AROUND_S, min(landing + AROUND_S, float(times[-1]))
    for axes in (whole, close):
        draw_energies(axes, recording)
        axes.set_xlabel("time [s]", labelpad=1)
    mark_jump(close, recording, ("left", "left"))
    close.xaxis.set_major_locator(MaxNLocator(6))
    whole.set_xlim(0.0, float(times[-1]))
    whole.axvspan(*shown, color=FAINT, alpha=0.25, lw=0, zorder=0)
    close.set(xlim=shown, ylim=whole.get_ylim(), ylabel="")
    legend = close.get_legend()
    if legend is not None:
        legend.remove()
