"""`softrig info`: who a robot is and what it allows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.definitions import explained


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
            "groups": {name: list(labels) for name, labels in profile.groups.items()},
            "supply_mv": profile.supply_mv,
            "limits": {
                "duty_max_permille": profile.coil.duty_max_permille,
                "hold_max_ms": profile.coil.hold_max_ms,
                "on_max_ms": profile.coil.on_max_ms,
                "rest_ms": profile.coil.rest_ms,
                "heat_budget_mj": profile.coil.heat_budget_mj,
                "trip_degc": profile.coil.trip_degc,
                "current_max_ma": profile.supply.current_max_ma,
                "at_once_max": profile.supply.at_once_max,
                "lease_ms": profile.session.lease_ms,
                "program_bytes_max": profile.program.bytes_max,
            },
        }
    if with_dictionary:
        fields["definitions"] = explanations
    emit(as_json, fields, [*_lines(fields), *explanations])


def _lines(fields: dict[str, Any]) -> Iterator[str]:
    limits = fields["limits"]
    yield f"{fields['robot']} at {fields['address']}: {fields['firmware']}, protocol {fields['protocol']}"
    yield f"  state       {fields['state']}{'' if fields['may_arm'] else ', this host may only watch and stop'}"
    if fields["paired"]:
        yield "  paired      takes orders only with its pairing key"
    yield f"  dictionary  {fields['dictionary']}, start number {fields['boot']}"
    yield f"  coils       {' '.join(fields['coils'])}"
    for name, labels in fields["groups"].items():
        yield f"  group       {name}: {' '.join(labels)}"
    yield f"  one order   at most {limits['duty_max_permille'] / 10:g} % for {limits['hold_max_ms'] / 1000:g} s"
    yield f"  one coil    {limits['on_max_ms'] / 1000:g} s without a pause, then {limits['rest_ms'] / 1000:g} s of rest"
    yield f"  heat        {limits['heat_budget_mj']} mJ a coil, trips at {limits['trip_degc']} C"
    volts, at_once = fields["supply_mv"] / 1000, limits["at_once_max"]
    yield f"  supply      {volts:g} V, {limits['current_max_ma']} mA, {at_once} coils at once"
    yield f"  lease       {limits['lease_ms']} ms"
    yield f"  program     {limits['program_bytes_max']} bytes"
