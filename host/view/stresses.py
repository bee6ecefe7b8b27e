"""The stress in a block that was pressed (the paper's Figure 16), at the instants of Figure 15, with one colour bar.

What is drawn is smoothed: stress is constant in each triangle, and shown are the means at the nodes over the triangles
around each, by area. The colours are even to the eye and their lightness falls all the way, so that they can be told
apart in grey print; lines between them help.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from host.errors import BadRequest
from host.fields import Mesh, Slice
from host.recording import Recording
from host.view.dents import draw_panels, panels_mm
from host.view.instants import Numbers
from host.view.meshes import block_box, deformed, draw_tool, edges_of, path_of, trails
from host.view.pressing import slices_of
from host.view.sheet import NAME_MM, TOP_MM, Sheet
from host.view.style import INK, PAGE_MM

STEPS = 12
SHADES = 0.02, 0.92  # of the map: lines are seen on the darkest
BAR_MM, UNDER_MM, BAR_WIDE_MM = 3.0, 9.0, 110.0
NOTHING_KPA = 1e-3  # below, stress is rounding


class Kind(NamedTuple):
    """One stress that can be drawn: what it is, its name at the bar, how its bands may lie, and its colours."""

    shows: str
    name: str
    steps: tuple[float, ...]
    first: float  # of a step: where the bands begin, so that the one of no stress has no edge at zero
    colours: str


KINDS = {
    "von Mises": Kind("von Mises stress", "von Mises stress [kPa]", (1, 2, 2.5, 5, 10), 0.0, "magma_r"),
    "sigma_y": Kind(r"stress $\sigma_y$, pressure negative", r"$\sigma_y$ [kPa]", (1, 2, 4, 6, 10), 0.5, "magma"),
}


def stresses_figure(recording: Recording, what: str = "von Mises") -> Figure:
    """Return the four states, of the von Mises stress or of sigma_y; BadRequest for others, or without a press."""
    if what not in KINDS:
        raise BadRequest(f"no picture of {what!r}: {', '.join(KINDS)}")
    kind, slices, mesh = KINDS[what], slices_of(recording), recording.mesh
    assert mesh is not None
    fields = {id(each): at_nodes(mesh, values_of(each, what)) for each in slices}
    levels = levels_of(kind, list(fields.values()))
    colours = colours_of(kind, len(levels) - 1)
    box = block_box(recording, slices)
    sheet = Sheet(panels_mm(box) + TOP_MM + NAME_MM + BAR_MM + UNDER_MM, recording.title)
    sheet.name("", f"{kind.shows}, means at the nodes; to scale, displacements as large as they are")

    def draw(axes: Axes, each: Slice) -> None:
        draw_field(axes, mesh, each, fields[id(each)], levels, colours)
        draw_tool(axes, recording, each)

    draw_panels(sheet, slices, box, draw, [told(fields[id(each)]) for each in slices], recording)
    draw_bar(sheet, levels, colours, kind.name)
    return sheet.figure


def values_of(each: Slice, what: str) -> Numbers:
    """Return the stress that is drawn, one a triangle, in kPa."""
    return np.asarray(each.von_mises_kpa if what == "von Mises" else each.stress_kpa[:, 1], dtype=float)


def at_nodes(mesh: Mesh, values: Numbers) -> Numbers:
    """Return values at the nodes: means over the triangles around each, by area."""
    corners = np.asarray(mesh.triangles, dtype=np.int64)
    a, b, c = (np.asarray(mesh.points_mm, dtype=float)[corners[:, i]] for i in range(3))
    area = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    nodes, count = corners.ravel(), len(mesh.points_mm)
    total = np.bincount(nodes, np.repeat(area * values, 3), count)
    mean: Numbers = total / np.bincount(nodes, np.repeat(area, 3), count)
    return mean


def levels_of(kind: Kind, fields: list[Numbers]) -> Numbers:
    """Return round levels around all values; the band of no stress among them."""
    least, most = min(0.0, *(float(each.min()) for each in fields)), max(0.0, *(float(each.max()) for each in fields))
    if most - least < NOTHING_KPA:
        least, most = -kind.first, 1.0
    ticks = MaxNLocator(STEPS, steps=list(kind.steps)).tick_values(least, most)
    step = ticks[1] - ticks[0]
    wide = np.append(ticks, ticks[-1] + step) - kind.first * step
    kept: Numbers = wide[int(np.searchsorted(wide, least, "right")) - 1 : int(np.searchsorted(wide, most)) + 1]
    return kept


def colours_of(kind: Kind, count: int) -> ListedColormap:
    """Return so many colours, the lightest for no stress."""
    shares = np.linspace(*SHADES, count) if kind.colours.endswith("_r") else 1.0 - np.linspace(*SHADES, count)[::-1]
    return ListedColormap([colormaps[kind.colours](share) for share in shares])


def draw_field(axes: Axes, mesh: Mesh, each: Slice, values: Numbers, levels: Numbers, colours: ListedColormap) -> None:
    """Draw a field on the deformed block: each colour over the one below, so that no gap shows between them."""
    points = deformed(mesh, each)
    rim = path_of(points, trails(edges_of(mesh)[1]))
    axes.add_patch(PathPatch(rim, fc=colours(0), ec=INK, lw=0.6, zorder=2))
    grid = Triangulation(points[:, 0], points[:, 1], mesh.triangles)
    bounded = np.clip(values, levels[0], levels[-1])
    for i in range(1, len(levels) - 1):
        if bounded.max() > levels[i]:
            axes.tricontourf(grid, bounded, levels=[levels[i], levels[-1] + 1.0], colors=[colours(i)], zorder=2.1)
    between = [level for level in levels[1:-1] if bounded.min() < level < bounded.max()]
    if between:
        axes.tricontour(grid, bounded, levels=between, colors=INK, linewidths=0.2, linestyles="-", zorder=2.2)
    axes.add_patch(PathPatch(rim, fc="none", ec=INK, lw=0.6, zorder=3))


def told(values: Numbers) -> str:
    """Return the range of a field in words."""
    least, most = float(values.min()), float(values.max())
    if max(-least, most) < NOTHING_KPA:
        return f"below {NOTHING_KPA:g} kPa"
    return f"{kilopascals(least)} to {kilopascals(most)} kPa" if least < 0.0 else f"at most {kilopascals(most)} kPa"


def kilopascals(kpa: float) -> str:
    """Return a stress as it is printed, a small one with one digit more."""
    return f"{kpa:.{2 if abs(kpa) >= 0.1 else 3}f}".replace("-", "\N{MINUS SIGN}")


def draw_bar(sheet: Sheet, levels: Numbers, colours: ListedColormap, name: str) -> None:
    """Draw the colour bar below the panels."""
    axes = sheet.axes((PAGE_MM - BAR_WIDE_MM) / 2, BAR_WIDE_MM, BAR_MM)
    shades = ScalarMappable(BoundaryNorm(levels, len(levels) - 1), colours)
    bar = sheet.figure.colorbar(shades, cax=axes, orientation="horizontal", ticks=levels)
    bar.outline.set_linewidth(0.4)
    axes.set_xlabel(name, labelpad=1.5)
