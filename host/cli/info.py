"""`softrig info`: who a robot is and what it allows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.definitions import explained
from host.profile import Profile

OF_COILS = ("duty_max_permille", "hold_max_ms", "on_max_ms", "rest_ms", "heat_budget_mj", "trip_degc")
OF_JOINTS = (
    "unit", "least_centi", "most_centi", "slew_centi_per_s", "hold_max_ms", "stall_ma", "stall_ms", "astray_centi",
    "astray_ms",
)  # fmt: skip


@click.command("info")
@robot_option()
@click.option("--dictionary", "with_dictionary", is_flag=True, help="Print its messages, ranges and words, too.")
@json_option
def command(robot: str, with_dictionary: bool, as_json: bool) -> None:
    """Say who a robot is and what it allows.

    Labels, groups, limits and what its messages mean come from the robot itself.
    """
    with connected(robot, watch_only=True) as face:
        profile = face.profile
        explanations = explained(face.dictionary, face.help_texts()) if with_dictionary else []
        fields = {
            "address": robot,
            **face.info(),
            "cells": list(profile.cell_labels),
            "groups": {name: list(labels) for name, labels in profile.groups.items()},
            "supply_mv": profile.supply_mv,
            "limits": _limits(profile),
        }
    if with_dictionary:
        fields["definitions"] = explanations
    emit(as_json, fields, [*_lines(fields), *explanations])


def _limits(profile: Profile) -> dict[str, Any]:
    """Return what the robot allows; nothing of coils or joints where there are none."""
    limits: dict[str, Any] = {}
    if profile.coil_limits:
        limits = {name: getattr(profile.coil_limits, name) for name in OF_COILS}
    if profile.servo_limits:
        limits["joint"] = {name: getattr(profile.servo_limits, name) for name in OF_JOINTS}
    for name in ("orient", "load", "press", "cell"):
        section = getattr(profile, name)
        if section:
            limits[name] = asdict(section)
    return {
        **limits,
        "current_max_ma": profile.supply.current_max_ma,
        "at_once_max": profile.supply.at_once_max,
        "lease_ms": profile.session.lease_ms,
        "program_bytes_max": profile.program.bytes_max,
    }


def _lines(fields: dict[str, Any]) -> Iterator[str]:
    limits = fields["limits"]
    yield f"{fields['robot']} at {fields['address']}: {fields['firmware']}, protocol {fields['protocol']}"
    yield f"  state       {fields['state']}{'' if fields['may_arm'] else ', this host may only watch and stop'}"
    if fields["paired"]:
        yield "  paired      takes orders only with its pairing key"
    yield f"  dictionary  {fields['dictionary']}, start number {fields['boot']}"
    yield f"  coils       {' '.join(fields['coils']) or 'none'}"
    if fields["joints"]:
        yield f"  joints      {' '.join(fields['joints'])}"
    for name, labels in fields["groups"].items():
        yield f"  group       {name}: {' '.join(labels)}"
    if fields["coils"]:
        yield from _coil_lines(limits)
    if fields["joints"]:
        yield from _joint_lines(limits["joint"], limits.get("orient"))
    yield from _force_lines(limits, fields["cells"])
    at_once = f", {limits['at_once_max']} coils at once" if fields["coils"] else ""
    yield f"  supply      {fields['supply_mv'] / 1000:g} V, {limits['current_max_ma']} mA{at_once}"
    yield f"  lease       {limits['lease_ms']} ms"
    yield f"  program     {limits['program_bytes_max']} bytes"


def _coil_lines(limits: dict[str, Any]) -> Iterator[str]:
    yield f"  one order   at most {limits['duty_max_permille'] / 10:g} % for {limits['hold_max_ms'] / 1000:g} s"
    yield f"  one coil    {limits['on_max_ms'] / 1000:g} s without a pause, then {limits['rest_ms'] / 1000:g} s of rest"
    yield f"  heat        {limits['heat_budget_mj']} mJ a coil, trips at {limits['trip_degc']} C"


def _joint_lines(joint: dict[str, Any], orient: dict[str, Any] | None) -> Iterator[str]:
    least, most, slew = (joint[name] / 100 for name in ("least_centi", "most_centi", "slew_centi_per_s"))
    hold_s, unit = joint["hold_max_ms"] / 1000, joint["unit"]
    yield f"  one move    {least:g} to {most:g} {unit}, at most {slew:g} {unit}/s, then held for {hold_s:g} s"
    yield f"  stall       trips at {joint['stall_ma']} mA for {joint['stall_ms']} ms"
    yield f"  astray      trips {joint['astray_centi'] / 100:g} {unit} beside its order for {joint['astray_ms']} ms"
    if orient:
        gain, swing = orient["gain_permille_per_s"] / 1000, orient["swing_max_centideg"] / 100
        yield f"  orient      turns what the joints hold: gain {gain:g} /s, swing at most {swing:g} deg"


def _force_lines(limits: dict[str, Any], cells: list[str]) -> Iterator[str]:
    """Yield what load cell, press and force cells are good for, of a robot that has them."""
    if "load" in limits:
        load = limits["load"]
        yield f"  force       at most {load['most_mn'] / 1000:g} N, trips at {load['trip_mn'] / 1000:g} N"
    if "press" in limits:
        press = limits["press"]
        gain, reset = press["gain_um_per_s_per_n"] / 1000, press["reset_permille_per_s"] / 1000
        yield f"  press       regulates the force: gain {gain:g} mm/s per N, reset {reset:g} /s"
    if cells:
        yield f"  cells       {' '.join(cells)}, up to {limits['cell']['full_pa'] / 1000:g} kPa"
