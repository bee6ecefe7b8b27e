"""The picture of a fit: (a) measured and modelled force over time, (b) what is left between them."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from host.fit.estimate import Found
from host.fit.trace import Press
from host.view.style import COILS, FAINT, INCH, INK, PAGE_MM, save, settings

HEIGHT_MM = 80.0


def draw_fit(press: Press, found: Found, path: Path) -> None:
    """Write the picture of a fit."""
    with settings():
        figure = Figure(figsize=(PAGE_MM / INCH, HEIGHT_MM / INCH), layout="constrained")
        whole, rest = figure.subplots(2, 1, sharex=True, height_ratios=[3, 1])
        t = press.t - press.touched_s
        whole.plot(t, press.force, ".", color=FAINT, markersize=2.0, label="load cell")
        whole.plot(t, found.modelled, color=COILS[0], linewidth=1.0, label="closed form")
        whole.set_ylabel("force [N]")
        whole.legend(frameon=False)
        middles = press.means(t)
        rest.plot(t, press.force - found.modelled, ".", color=FAINT, markersize=2.0)
        rest.plot(middles, press.means(press.force - found.modelled), color=INK, linewidth=0.8)
        rest.set_ylabel("left over [N]")
        rest.set_xlabel("time since contact [s]")
        save(figure, path)
