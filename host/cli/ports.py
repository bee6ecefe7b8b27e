"""`softrig ports`: where a robot may be."""

from __future__ import annotations

from dataclasses import asdict

import click

from host.cli.options import json_option
from host.cli.output import emit, note
from host.ports import places


@click.command("ports")
@json_option
def command(as_json: bool) -> None:
    """List serial ports and running benches; none of them is opened."""
    found = places()
    if as_json:
        for place in found:
            emit(True, asdict(place), ())
        return
    emit(False, None, [f"{place.address}  {place.kind}: {place.about}" for place in found])
    if not found:
        note("no serial port and no running bench; `softrig sim circular` starts one, sim:circular needs no port")
