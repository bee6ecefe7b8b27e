"""A drawing in SVG, written as it is: shapes with classes, whose colours a style sheet gives for light and dark.

Nothing in it depends on the day or the machine. `auto` follows the reader's own setting where the viewer knows it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from math import ceil

THEMES = ("light", "dark", "auto")
FONT = "'Helvetica Neue', Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif"
LETTER = 0.58  # of the size of a letter: the width of most of them

LIGHT = {
    "paper": "#ffffff", "ink": "#222222", "quiet": "#5f6670", "faint": "#d5d8dd", "lane": "#f5f6f8",
    "duty": "#9cc7e6", "edge": "#0072b2", "heat": "#c9480c", "band": "#f2b894", "trip": "#7a0019",
    "wait": "#8a7a3a", "joint": "#00734f", "note": "#8d3f6f", "add": "#00734f", "drop": "#c9480c",
}  # fmt: skip
DARK = {
    "paper": "#15181d", "ink": "#e8e9eb", "quiet": "#a2a9b3", "faint": "#3a404a", "lane": "#1d2127",
    "duty": "#27587a", "edge": "#56b4e9", "heat": "#ffa266", "band": "#6b432c", "trip": "#ff7a8a",
    "wait": "#cdbb6d", "joint": "#3fc79a", "note": "#e0a0c8", "add": "#3fc79a", "drop": "#ffa266",
}  # fmt: skip
RULES = (
    ".paper{{fill:{paper}}} text{{fill:{ink}}} .quiet{{fill:{quiet}}} .lane{{fill:{lane}}}"
    " .faint{{stroke:{faint};stroke-width:.8;fill:none}} .axis{{stroke:{quiet};stroke-width:1;fill:none}}"
    " .duty{{fill:{duty}}} .edge{{stroke:{edge};stroke-width:1;fill:none;stroke-dasharray:3 2}}"
    " .kept{{stroke:{edge};stroke-width:1.6;fill:none}}"
    " .heat{{stroke:{heat};stroke-width:1.6;fill:none;stroke-linejoin:round}} .hot{{fill:{heat}}}"
    " .other{{stroke:{heat};stroke-width:1.2;fill:none;stroke-dasharray:4 2.5}} .band{{fill:{band};opacity:.65}}"
    " .trip{{stroke:{trip};stroke-width:1;stroke-dasharray:6 3;fill:none}} .tripped{{fill:{trip}}}"
    " .wait{{fill:{wait};opacity:.75}} .open{{fill:{wait};opacity:.11}} .waits{{fill:{wait}}}"
    " .range{{stroke:{wait};stroke-width:1.2;fill:none;stroke-dasharray:3 2}}"
    " .joint{{stroke:{joint};stroke-width:1.8;fill:none;stroke-linejoin:round}}"
    " .joint2{{stroke:{joint};stroke-width:1.2;fill:none;stroke-dasharray:4 2.5}} .held{{fill:{joint};opacity:.14}}"
    " .guess{{stroke:{joint};stroke-width:1.4;fill:none;stroke-dasharray:1 2.5}}"
    " .flag{{stroke:{note};stroke-width:1;fill:none}} .note{{fill:{note}}} .add{{fill:{add}}} .drop{{fill:{drop}}}"
)


class Drawing:
    """Shapes on paper of a width; its height is that of the lowest thing, when it is written."""

    def __init__(self, width: float) -> None:
        self.width = width
        self._shapes: list[str] = []

    def rect(self, kind: str, x: float, y: float, width: float, height: float, round: float = 0) -> None:
        """Draw a filled box."""
        corner = f' rx="{round:g}"' if round else ""
        box = f'x="{_n(x)}" y="{_n(y)}" width="{_n(max(width, 0))}" height="{_n(max(height, 0))}"'
        self._shapes.append(f'<rect class="{kind}" {box}{corner}/>')

    def line(self, kind: str, x1: float, y1: float, x2: float, y2: float) -> None:
        """Draw a straight line."""
        self._shapes.append(f'<path class="{kind}" d="M{_n(x1)} {_n(y1)}L{_n(x2)} {_n(y2)}"/>')

    def curve(self, kind: str, points: Iterable[tuple[float, float]], closed: bool = False) -> None:
        """Draw a line through points."""
        path = "L".join(f"{_n(x)} {_n(y)}" for x, y in points)
        if path:
            self._shapes.append(f'<path class="{kind}" d="M{path}{"Z" if closed else ""}"/>')

    def text(self, x: float, y: float, text: str, kind: str = "", size: float = 11, at: str = "start",
             bold: bool = False) -> None:  # fmt: skip
        """Write a text whose base line begins, ends or has its middle at a place."""
        look = f' class="{kind}"' if kind else ""
        look += f' text-anchor="{at}"' if at != "start" else ""
        look += ' font-weight="bold"' if bold else ""
        shown = escape("".join(sign if sign.isprintable() else "?" for sign in text), quote=False)
        self._shapes.append(f'<text x="{_n(x)}" y="{_n(y)}" font-size="{size:g}"{look}>{shown}</text>')

    def svg(self, height: float, theme: str = "auto") -> str:
        """Return the picture."""
        rules = RULES.format(**(DARK if theme == "dark" else LIGHT))
        if theme == "auto":
            rules += f" @media (prefers-color-scheme: dark) {{{RULES.format(**DARK)}}}"
        height = ceil(height)
        size = f'width="{_n(self.width)}" height="{_n(height)}" viewBox="0 0 {_n(self.width)} {_n(height)}"'
        head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="{FONT}">\n<style>{rules}</style>'
        paper = f'<rect class="paper" x="0" y="0" width="{_n(self.width)}" height="{_n(height)}"/>'
        return "\n".join([head, paper, *self._shapes, "</svg>\n"])


def wide(text: str, size: float = 11) -> float:
    """Return about how wide a text is."""
    return len(text) * size * LETTER


def shortened(text: str, width: float, size: float = 11) -> str:
    """Return as much of a text as there is room for."""
    most = max(1, int(width / (size * LETTER)))
    return text if len(text) <= most else text[: most - 1].rstrip() + "…"


def thinned(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the points of a curve that can be told apart on paper."""
    kept: list[tuple[float, float]] = []
    for i, (x, y) in enumerate(points):
        if kept and i + 1 < len(points) and x - kept[-1][0] < 1.2 and abs(y - kept[-1][1]) < 0.8:
            continue
        kept.append((x, y))
    return kept


def _n(value: float) -> str:
    """Return a coordinate to a tenth."""
    return f"{value:.1f}".removesuffix(".0")
