"""A page that is filled from the top down, in mm: a title, named panels, a colour bar to the right."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable

from host.recording import Recording
from host.view.style import PAGE_MM, heat_scale, page

LEFT_MM, RIGHT_MM, TOP_MM, BOTTOM_MM = 14.0, 3.0, 9.0, 9.0
BAR_MM = 14.0  # to the right, for the colour bar
GAP_MM = 5.0
TITLE_LETTERS = 84  # a longer title is written smaller
NAME_MM = 4.5  # a panel's letter and what it shows


class Sheet:
    """Hands out axes from the top of the page down, in mm; `y_mm` is where the next ones begin."""

    def __init__(self, height_mm: float, title: str) -> None:
        self.figure = page(height_mm)
        self._height = height_mm
        self.y_mm = height_mm - TOP_MM
        size = 8.5 * min(1.0, TITLE_LETTERS / max(1, len(title)))
        self.figure.text(LEFT_MM / PAGE_MM, 1 - 3.5 / height_mm, title, va="center", fontsize=size, weight="bold")

    def axes(self, left_mm: float, width_mm: float, height_mm: float, share: Axes | None = None) -> Axes:
        """Return axes below the present height, which stays."""
        box = (left_mm / PAGE_MM, (self.y_mm - height_mm) / self._height, width_mm / PAGE_MM, height_mm / self._height)
        return self.figure.add_axes(box, sharex=share)

    def name(self, letter: str, what: str) -> None:
        """Write the panel's letter and what it shows, and go on below them."""
        self.names(letter or " ", [what], 0.0)

    def names(self, letters: str, whats: Sequence[str], every_mm: float) -> None:
        """Write letters and what is shown of panels side by side, so far apart, and go on below them."""
        for i, (letter, what) in enumerate(zip(letters, whats, strict=True)):
            self.write(3.0 + i * every_mm, 0.0, letter.strip(), va="top", fontsize=8.5, weight="bold")
            self.write(7.0 + i * every_mm, 0.3, what, va="top", fontsize=7)
        self.y_mm -= NAME_MM

    def write(self, x_mm: float, below_mm: float, text: str, **style: Any) -> None:
        """Write text at a place so far below the present height, which stays."""
        self.figure.text(x_mm / PAGE_MM, (self.y_mm - below_mm) / self._height, text, **style)

    def bar(self, heat: ScalarMappable, height_mm: float) -> None:
        """Draw the colour bar of the coils beside a panel of that height."""
        box = self.axes(PAGE_MM - RIGHT_MM - BAR_MM + 4.0, 2.2, min(height_mm - 4.0, 34.0))
        self.figure.colorbar(heat, cax=box).outline.set_linewidth(0.4)
        box.set_title("coil [°C]", fontsize=6.5, pad=6)


def heat_of(film: Recording) -> ScalarMappable:
    """Return the colours of the coils' temperatures, up to the hottest of these scenes."""
    return heat_scale(max(coil["degc"] for scene in film.scenes for coil in scene["coils"].values()))
