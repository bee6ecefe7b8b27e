"""How pictures look: sized for a page of a paper, colours that the colour-blind tell apart, the same bytes again."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from io import StringIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

INCH = 25.4  # [mm]
PAGE_MM = 180.0
INK = "#222222"
FAINT = "#b8bcc2"
GROUND = "#6b6258"
AMBIENT_DEGC, HOT_DEGC = 25.0, 100.0

# Okabe and Ito's eight, the yellow darkened for white paper; lines beyond the eighth coil are dashed.
COILS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#a08a00", "#000000", "#56b4e9", "#e69f00")
DASHES = ("-", "--", ":")

# From a grey-blue that is seen on white to a dark red: lightness falls all the way, so hot is also dark in grey print.
HEAT = LinearSegmentedColormap.from_list("heat", ("#a3b4c6", "#e9a23b", "#d8481f", "#7a0019"))

SETTINGS: dict[Any, Any] = {
    "svg.hashsalt": "softrig",
    "svg.fonttype": "path",
    "font.family": "DejaVu Sans",
    "font.size": 7.0,
    "axes.linewidth": 0.6,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.titlesize": 7.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.labelsize": 6.5,
    "ytick.labelsize": 6.5,
}


Style = dict[str, Any]  # keywords of a text


@contextmanager
def settings() -> Iterator[None]:
    """Draw in this style within the block, whatever the user's own settings are."""
    with mpl.rc_context():
        mpl.rcdefaults()
        for name, value in SETTINGS.items():
            mpl.rcParams[name] = value
        yield


def page(height_mm: float) -> Figure:
    """Return an empty figure as wide as a page."""
    return Figure(figsize=(PAGE_MM / INCH, height_mm / INCH), facecolor="white")


def save(figure: Figure, path: Path) -> None:
    """Write the figure in the format of the path's suffix, without a date."""
    metadata = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": {"Software": None}}[path.suffix]
    if path.suffix != ".svg":
        figure.savefig(path, dpi=200, metadata=metadata)
        return
    drawn = StringIO()
    figure.savefig(drawn, format="svg", metadata=metadata)
    path.write_text(rounded(drawn.getvalue()), encoding="utf-8")


def rounded(svg: str) -> str:
    """Return a picture with the coordinates of its lines to a hundredth of a point, which is half as long."""
    return re.sub(r' d="[^"]*"', lambda found: re.sub(r"(\.\d\d)\d+", r"\1", found[0]).replace(" \n", " "), svg)


def coil_colour(i: int) -> str:
    """Return the colour of the i-th coil's curves."""
    return COILS[i % len(COILS)]


def coil_dash(i: int) -> str:
    """Return the dash of the i-th coil's curves."""
    return DASHES[i // len(COILS) % len(DASHES)]


def heat_scale(highest_degc: float) -> ScalarMappable:
    """Return the colours of coil temperatures, from ambient to at least HOT_DEGC."""
    return ScalarMappable(Normalize(AMBIENT_DEGC, max(HOT_DEGC, highest_degc)), HEAT)
