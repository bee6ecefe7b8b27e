"""The curves of a run over its time: temperatures, duties, supply current, travel."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from host.recording import Recording
from host.view.instants import Numbers, scene_times
from host.view.style import COILS, INK, Style, coil_colour, coil_dash

FAR_MM = 2000.0
STILL_MM = 2.0
FEW = 8  # coils
TOGETHER_S = 0.3  # peaks closer than this share one letter
Place = tuple[float, float, str]  # time [s], height [degC], colour
WARMED_K = 5.0  # a coil whose temperature rose by less carries no letter


def record_times(recording: Recording) -> Numbers:
    """Return the times of the telemetry in seconds."""
    return np.array([recording.seconds(row.host_ms) for row in recording.telemetry])


def used(recording: Recording) -> list[int]:
    """Return which coils have curves: all of a robot with few, else those that were driven, in their order."""
    count = len(recording.labels)
    if count <= FEW:
        return list(range(count))
    on = np.array([row.duty_permille for row in recording.telemetry]) > 0
    return sorted(np.flatnonzero(on.any(axis=0)).tolist(), key=lambda i: int(on[:, i].argmax()))


def draw_temperatures(axes: Axes, recording: Recording) -> None:
    """Draw each coil's temperature: as the robot estimates it, and dotted as it is, where an observer knows it."""
    times, seen = record_times(recording), scene_times(recording)
    estimates = np.array([row.temperature_degc for row in recording.telemetry])
    letters: dict[Place, list[str]] = {}
    for order, i in enumerate(used(recording)):
        label, colour = recording.labels[i], coil_colour(order)
        true = np.array([scene["coils"][label]["degc"] for scene in recording.scenes])
        axes.plot(times, estimates[:, i], color=colour, ls=coil_dash(order), lw=1.0)
        axes.plot(seen, true, color=colour, ls=":", lw=1.0)
        place = _peak(times, estimates[:, i], float(max(true, default=0.0)), colour)
        if place:
            letters.setdefault(place, []).append(label)
    _write_letters(axes, letters)
    if recording.scenes:
        styles = [Line2D([], [], color=INK, lw=1.0, label="estimated on the robot")]
        styles.append(Line2D([], [], color=INK, lw=1.0, ls=":", label="true"))
        axes.legend(handles=styles, loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2, frameon=False, fontsize=6.5)
    axes.margins(y=0.15)
    axes.set_ylabel("coil [°C]")


def draw_duties(axes: Axes, recording: Recording) -> None:
    """Draw one row for each coil, as high as its duty; a full row is 100 %."""
    times = record_times(recording)
    shown = used(recording)
    count = len(shown)
    for order, i in enumerate(shown):
        base = count - 1 - order
        duties = np.array([row.duty_permille[i] for row in recording.telemetry]) / 1000
        begins = np.concatenate([[0], np.flatnonzero(np.diff(duties)) + 1])
        edges = np.concatenate([times[begins], times[-1:]])
        axes.axhline(base, color="#dddddd", lw=0.4)
        axes.stairs(base + 0.85 * duties[begins], edges, baseline=base, fill=True, color=coil_colour(order), lw=0)
    axes.set_yticks([count - 1 - order + 0.4 for order in range(count)], [recording.labels[i] for i in shown])
    axes.tick_params(axis="y", labelsize=6.5 if count <= FEW else 5.5)
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(-0.1, count)
    axes.set_ylabel("duty [row: 100 %]")


def draw_current(axes: Axes, recording: Recording) -> None:
    """Draw the supply current that the robot measures."""
    current = [row.current_ma for row in recording.telemetry]
    axes.plot(record_times(recording), current, color=INK, lw=0.9, drawstyle="steps-post")
    axes.set_ylim(0, max([100, *current]) * 1.15)
    axes.set_ylabel("supply [mA]")


def draw_travel(axes: Axes, recording: Recording) -> None:
    """Draw how far the centre of mass has come along the ground; in metres when it ran away."""
    travel = np.array([scene["observed"]["travel_mm"] for scene in recording.scenes])
    far = float(np.abs(travel).max()) >= FAR_MM
    axes.plot(scene_times(recording), travel / 1000 if far else travel, color=COILS[0], lw=1.1)
    axes.margins(y=0.12)
    if np.ptp(travel) < STILL_MM:  # a body that stays where it is
        axes.set_ylim(travel.mean() - STILL_MM, travel.mean() + STILL_MM)
    axes.set_ylabel("travel [m]" if far else "travel [mm]")


def label_time(axes: Axes, times: Numbers) -> None:
    """Write the time below the lowest of several panels, from the first of these times to the last."""
    axes.tick_params(labelbottom=True)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=10, steps=[1, 2, 5, 10]))
    axes.set_xlabel("time [s]", labelpad=1)
    axes.set_xlim(float(times[0]), float(times[-1]))


def _peak(times: Numbers, estimate: Numbers, highest_degc: float, colour: str) -> Place | None:
    """Return time and height of a coil's first peak, if it was warmed at all, and its colour."""
    if estimate.max() <= estimate[0] + WARMED_K:
        return None
    first = int((estimate > estimate.max() - 1.0).argmax())
    return float(times[first]), max(highest_degc, float(estimate.max())), colour


def _write_letters(axes: Axes, letters: dict[Place, list[str]]) -> None:
    """Write each coil's letter above its first peak; of several that peak together the first, and how many more."""
    groups: list[list[tuple[Place, str]]] = []
    for place, label in sorted((place, label) for place, labels in letters.items() for label in labels):
        if groups and place[0] - groups[-1][0][0][0] < TOGETHER_S:
            groups[-1].append((place, label))
        else:
            groups.append([(place, label)])
    for group in groups:
        (t, _, colour), label = group[0]
        text = label if len(group) == 1 else f"{label} +{len(group) - 1}"
        highest = max(place[1] for place, _ in group)
        style: Style = {"ha": "center", "color": colour, "fontsize": 7 if len(label) == 1 else 6}
        axes.annotate(text, (t, highest), (0, 2), textcoords="offset points", **style)
