"""What the nail does: the same script with the paper's tip and with one whose energy depends on the displacement alone.

(a) is one tip by itself: what turns it back, against its angle to the object. (b) to (d) are both fingers with what
they hold. Thin lines are not fitted: the closed form in (a), the line of the tips' centres in (b).
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from host.errors import BadRequest
from host.recording import Recording
from host.view.energy import energies_mj
from host.view.instants import Numbers
from host.view.sheet import BOTTOM_MM, GAP_MM, LEFT_MM, NAME_MM, RIGHT_MM, TOP_MM, Sheet
from host.view.style import COILS, INK, PAGE_MM, Style
from host.view.swings import grip_deg, gripping, held, object_deg, of_fingers, parallel, swing_deg

PANEL_MM, BETWEEN_MM = 46.0, 16.0
PRESSED = 0.2  # of the greatest displacement: below, a moment by its cube is mostly rounding
EVERY_DEG = 2.5  # from dot to dot
KINDS = ("nail", COILS[1], "o"), ("radial", COILS[0], "s")
LEGEND: Style = {"frameon": False, "fontsize": 6.5, "borderaxespad": 0.2}
NAMES = {"nail": "nail (the paper's tip)", "radial": "displacement alone"}


def nail_figure(nail: Recording, radial: Recording) -> Figure:
    """Return the four panels; BadRequest when one of the runs had the other's tip."""
    runs = {name: recording for (name, _, _), recording in zip(KINDS, (nail, radial), strict=True)}
    for name, recording in runs.items():
        if recording.scenes[0]["model"]["tip"] != name:
            raise BadRequest(f"this figure needs a run of fingers with tip={name}")
    title = f"{nail.title} and {radial.title.split(' on ')[-1]}"
    sheet = Sheet(TOP_MM + 2 * (NAME_MM + PANEL_MM) + GAP_MM + 2 * BOTTOM_MM, title)
    wide = (PAGE_MM - LEFT_MM - RIGHT_MM - BETWEEN_MM) / 2
    panels = (
        (("moment of one tip", draw_moment), ("turn of the object as the fingers swing", draw_turns)),
        (
            ("stiffness against turning, as the grip closes", draw_stiffness),
            ("energy as the fingers swing", draw_energy),
        ),
    )
    for letters, row in zip(("ab", "cd"), panels, strict=True):
        sheet.names(letters, [what for what, _ in row], wide + BETWEEN_MM)
        for i, (_, draw) in enumerate(row):
            draw(sheet.axes(LEFT_MM + i * (wide + BETWEEN_MM), wide, PANEL_MM), runs)
        sheet.y_mm -= PANEL_MM + BOTTOM_MM + GAP_MM
    return sheet.figure


def normalised_moment(recording: Recording) -> tuple[Numbers, Numbers]:
    """Return angle to the object in degrees, and moment by 2 pi E d^3 / 3, of each tip wherever it is pressed."""
    depth, moment = of_fingers(recording, "d_mm"), of_fingers(recording, "moment_nmm")
    pressed = depth > PRESSED * depth.max()
    modulus = float(recording.scenes[0]["youngs_modulus_mpa"])
    scaled = 3 * moment[pressed] / (2 * np.pi * modulus * depth[pressed] ** 3)
    return of_fingers(recording, "theta_deg")[pressed], scaled


def centre_line_deg(recording: Recording) -> Numbers:
    """Return the angle of the line from the left tip's centre to the right one's, at each scene."""
    tips = of_fingers(recording, "tip")
    across = tips[:, 0] - tips[:, 1]
    turned: Numbers = np.degrees(np.arctan2(across[:, 1], across[:, 0]))
    return turned


def draw_moment(axes: Axes, runs: dict[str, Recording]) -> None:
    """Draw the moment of one tip over its angle to the object, with the closed form."""
    widest = 0.0
    for name, colour, marker in KINDS:
        angle, moment = normalised_moment(runs[name])
        chosen = thinned(angle, EVERY_DEG)
        dots: Style = {"ls": "", "marker": marker, "ms": 3, "mfc": "none", "mew": 0.8}
        axes.plot(angle[chosen], moment[chosen], color=colour, label=NAMES[name], **dots)
        widest = max(widest, float(np.abs(angle).max()))
    angles = np.radians(np.linspace(-widest, widest, 121))
    law = np.sin(angles) / np.cos(angles) ** 3
    axes.plot(np.degrees(angles), law, color=INK, lw=0.6, label=r"$\sin\theta / \cos^3\theta$", zorder=1)
    axes.set_xlabel(r"angle to the object, $\theta$ [°]", labelpad=1)
    axes.set_ylabel(r"$M \,/\, (2 \pi E d^3 / 3)$", labelpad=2)
    axes.legend(loc="upper left", **LEGEND)


def draw_turns(axes: Axes, runs: dict[str, Recording]) -> None:
    """Draw the object's angle over the swing, with the line of the tips' centres."""
    for name, colour, _ in KINDS:
        shown = held(runs[name])
        swing = swing_deg(runs[name])[shown]
        axes.plot(swing, object_deg(runs[name])[shown], color=colour, lw=1.2, label=NAMES[name])
        if name == "radial":
            order = np.argsort(swing)
            line = centre_line_deg(runs[name])[shown][order]
            axes.plot(swing[order], line, color=INK, lw=0.6, ls=(0, (5, 3)), label="line of the tips' centres")
    axes.set_xlabel("swing of both fingers [°]", labelpad=1)
    axes.set_ylabel("object [°]", labelpad=2)
    axes.legend(loc="upper right", **LEGEND)


def draw_stiffness(axes: Axes, runs: dict[str, Recording]) -> None:
    """Draw the rotational stiffness of the held object over the grip, until the fingers swing."""
    for name, colour, _ in KINDS:
        closing = slice(parallel(runs[name]), gripping(runs[name]) + 1)
        stiffness = [scene["stiffness_nmm_per_rad"] for scene in runs[name].scenes[closing]]
        axes.plot(grip_deg(runs[name])[closing], np.array(stiffness) / 1000, color=colour, lw=1.2, label=NAMES[name])
        last = float(grip_deg(runs[name])[closing][-1]), stiffness[-1] / 1000
        style: Style = {"ha": "right", "fontsize": 6.5, "color": colour}
        axes.annotate(f"{last[1]:.3f}", last, (-2, 3), textcoords="offset points", **style)
    axes.set_xlabel("both fingers inward [°]", labelpad=1)
    axes.set_ylabel(r"$K_\psi$ [N m/rad]", labelpad=2)
    axes.legend(loc="upper left", **LEGEND)


def draw_energy(axes: Axes, runs: dict[str, Recording]) -> None:
    """Draw the elastic energy over the swing, by that of the grip."""
    for name, colour, _ in KINDS:
        shown = held(runs[name])
        energy = energies_mj(runs[name], "elastic")[shown]
        axes.plot(swing_deg(runs[name])[shown], energy / energy[0], color=colour, lw=1.2, label=NAMES[name])
    axes.set_xlabel("swing of both fingers [°]", labelpad=1)
    axes.set_ylabel("energy, of that of the grip", labelpad=2)
    axes.legend(loc="lower center", **LEGEND)


def thinned(values: Numbers, step: float) -> list[int]:
    """Return places of values that are at least so far apart."""
    chosen: list[int] = []
    for i in np.argsort(values, kind="stable"):
        if not chosen or values[i] - values[chosen[-1]] >= step:
            chosen.append(int(i))
    return chosen
