"""`softrig fit`: what a material is, from what a robot felt of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from host.cli.options import json_option, length_m
from host.cli.output import emit, note, writing
from host.fit import check_scipy
from host.logbook import read_log
from host.view import check_pictures

if TYPE_CHECKING:
    from host.fit.estimate import Found, Value
    from host.fit.trace import Press

NAMES = {  # of the robot file's keys, and their units over SI
    "E": ("youngs_modulus_kpa", "Young's modulus E", "kPa", 1e-3),
    "c1": ("viscosity_kpa_s", "viscosity c1", "kPa s", 1e-3),
    "c2": ("damping_kpa_s", "damping c2", "kPa s", 1e-3),
    "E0": ("parallel_modulus_kpa", "parallel modulus E0", "kPa", 1e-3),
    "tau": ("relaxation_s", "relaxation c1/E", "s", 1.0),
}


@click.group("fit")
def command() -> None:
    """Estimate a material from a log: press."""


@command.command("press")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--shape", metavar="LENGTH", help="Force per modulus and depth. Default: what the log's observer told.")
@click.option("--spring", is_flag=True, help="Fit a spring E0 beside the dashpots, too.")
@click.option("--plot", "plot_path", type=click.Path(path_type=Path), metavar="FILE.svg", help="Draw force and fit.")
@json_option
def press(file: Path, shape: str | None, spring: bool, plot_path: Path | None, as_json: bool) -> None:
    """Estimate a block's moduli and viscosities from its first push and hold, with 95 % confidence.

    A flat or bonded punch, pushed at an even speed and held for as long as the block takes to relax, tells most.
    """
    check_scipy()
    if plot_path:
        check_pictures(plot_path)
    from host.fit.estimate import estimate, spring_beside  # noqa: PLC0415  (scipy)
    from host.fit.shape import shape_of  # noqa: PLC0415
    from host.fit.trace import press_of  # noqa: PLC0415

    log = read_log(file)
    shape_m = shape_of(log) if shape is None else length_m(shape)  # before its push and hold: it may be no such press
    pressed = press_of(log)
    found = estimate(pressed, shape_m, spring)
    beside = None if spring else spring_beside(pressed, shape_m)
    fields = _fields(file, pressed, shape_m, found, beside)
    emit(as_json, fields, _lines(fields, found))
    if plot_path:
        from host.fit.plot import draw_fit  # noqa: PLC0415  (matplotlib)

        with writing(plot_path):
            draw_fit(pressed, found, plot_path)
        note(f"picture: {plot_path}")


def _fields(file: Path, press: Press, shape_m: float, found: Found, beside: Value | None) -> dict[str, Any]:
    """Return the result by name."""
    material = {
        NAMES[name][0]: {part: number * NAMES[name][3] for part, number in value._asdict().items()}
        for name, value in found.values.items()
    }
    return {
        "log": str(file),
        "shape_m": shape_m,
        "readings": len(press.t),
        "period_ms": 1000 * press.period_s,
        "depth_mm": float(press.command.max()),
        "push_s": press.push_s,
        "hold_s": press.hold_s,
        **material,
        "correlation": {f"{one} {other}": share for (one, other), share in found.correlation.items()},
        "residual_rms_n": found.rms_n,
        "noise_n": found.noise_n,
        "touch_mm": found.touch_mm,
        "zero_n": found.zero_n,
        "notes": list(_notes(press, found, beside)),
    }


def _lines(fields: dict[str, Any], found: Found) -> Iterator[str]:
    yield (
        f"press of {fields['depth_mm']:.2f} mm in {fields['push_s']:.2f} s, held for {fields['hold_s']:.2f} s:"
        f" {fields['readings']} readings, {1000 * fields['shape_m']:.2f} mm of shape"
    )
    for name in found.values:
        key, words, unit, _ = NAMES[name]
        value = fields[key]
        span = f"95 %: {value['low']:.4g} to {value['high']:.4g}"
        yield f"  {words:<22}{value['value']:.4g} {unit}, +- {value['error']:.2g}, {span}"
    told = ", ".join(f"{pair} {share:.2f}" for pair, share in fields["correlation"].items())
    yield f"  {'correlation':<22}{told}"
    yield f"  {'left over':<22}{fields['residual_rms_n']:.3f} N (load cell's noise {fields['noise_n']:.3f} N)"
    for text in fields["notes"]:
        yield f"  note: {text}"


def _notes(press: Press, found: Found, beside: Value | None) -> Iterator[str]:
    """Yield what makes the numbers less worth than they look."""
    from host.fit.estimate import MISFIT  # noqa: PLC0415

    tau, c2 = found.values["tau"], found.values["c2"]
    if found.misfit > MISFIT:
        yield "the force does not follow this law, so the errors are too small: try --spring, or another material"
    elif beside:
        spring = f"a spring of {1e-3 * beside.value:.3g} kPa beside the dashpots fits better"
        yield f"{spring} (95 %: {1e-3 * beside.low:.3g} to {1e-3 * beside.high:.3g}): try --spring, or another material"
    if press.hold_s < 0.5 * tau.value:
        yield f"the hold is short beside the relaxation of {tau.value:.3g} s: hold for longer"
    if c2.low <= 0.0:
        yield "the damping cannot be told from none: push faster"
