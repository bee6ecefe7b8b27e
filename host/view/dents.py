"""A block that was pressed (the paper's Figure 15): its mesh at push, after the hold, after release, long after."""

from __future__ import annotations

from collections.abc import Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from host.fields import Slice
from host.recording import Recording
from host.view.film import Box, frame
from host.view.meshes import block_box, dent_mm, draw_before, draw_dent, draw_mesh, draw_ruler, draw_tool, height_of
from host.view.pressing import NAMES, at_slice, slices_of
from host.view.sheet import NAME_MM, TOP_MM, Sheet
from host.view.style import PAGE_MM

SIDE_MM, BETWEEN_MM = 5.0, 4.0
EACH_MM = (PAGE_MM - 2 * SIDE_MM - BETWEEN_MM) / 2
WORDS_MM, END_MM = 5.0, 2.0
Draw = Callable[[Axes, Slice], None]


def dents_figure(recording: Recording) -> Figure:
    """Return the four states of the mesh; BadRequest when the press did not press, or was not lifted."""
    slices, mesh = slices_of(recording), recording.mesh
    assert mesh is not None
    box = block_box(recording, slices)
    sheet = Sheet(panels_mm(box) + TOP_MM + NAME_MM, recording.title)
    count = f"{len(mesh.triangles):,} triangles"
    sheet.name("", f"to scale, displacements as large as they are; dashed: the block before; {count}")

    def draw(axes: Axes, each: Slice) -> None:
        draw_mesh(axes, mesh, each)
        draw_before(axes, mesh)
        draw_tool(axes, recording, each)
        if not at_slice(recording, each, "touching"):
            draw_dent(axes, mesh, each)

    draw_panels(sheet, slices, box, draw, [told(recording, each) for each in slices], recording)
    return sheet.figure


def panels_mm(box: Box) -> float:
    """Return the height of four panels, two in a row."""
    return 2 * (height_of(box, EACH_MM) + WORDS_MM) + END_MM


def told(recording: Recording, each: Slice) -> str:
    """Return what is said of an instant: how the press stands while it presses, else what is left."""
    if at_slice(recording, each, "touching"):
        return f"depth {at_slice(recording, each, 'depth_mm'):.2f} mm, {at_slice(recording, each, 'force_n'):.2f} N"
    return f"dent {dent_mm(each):.2f} mm"


def draw_panels(
    sheet: Sheet, slices: list[Slice], box: Box, draw: Draw, words: list[str], recording: Recording
) -> None:
    """Draw the four instants two in a row, each with letter, name, time and words above it, and go on below them."""
    high = height_of(box, EACH_MM)
    for i, (letter, name, each, said) in enumerate(zip("abcd", NAMES, slices, words, strict=True)):
        left = SIDE_MM + i % 2 * (EACH_MM + BETWEEN_MM)
        sheet.write(left, 0.0, letter, va="top", fontsize=8.5, weight="bold")
        time = f"{max(0.0, recording.seconds(each.host_ms)):.2f} s"
        sheet.write(left + 4.0, 0.3, f"{name}, {time}: {said}", va="top", fontsize=7)
        sheet.y_mm -= WORDS_MM
        axes = sheet.axes(left, EACH_MM, high)
        draw(axes, each)
        if i == 0:
            draw_ruler(axes, box)
        frame(axes, box)
        sheet.y_mm += WORDS_MM if i % 2 == 0 else -high
