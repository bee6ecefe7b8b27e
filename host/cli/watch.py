"""`softrig watch`: variables of a robot as they come, a table at a terminal and JSON lines in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib.resources import files
from typing import Any

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option, time_ms
from host.cli.output import json_line, note, printable
from host.errors import BadRequest
from host.profile import Parts
from host.records import Record, Sample, Telemetry, row_of
from host.robot import Robot
from host.selections import numbers_of
from protocol import variables

FOR_EVER_MS = 1 << 40
DRAWN_EVERY_MS = 100
OF = {
    "*": " One value per coil.", "+": " One value per joint.", "@": " Only where there is a camera.",
    "!": " Only where there is a load cell.", "#": " One value per force cell.",
}  # fmt: skip
WORDS = "var."  # before the name of a variable in protocol/help.txt

Show = Callable[[Record], None]


def _list(context: click.Context, option: click.Parameter, given: bool) -> None:
    """Print the variables and leave."""
    if not given:
        return
    width = max(len(variable.name) for variable in variables.VARIABLES)
    lines = (files("protocol") / "help.txt").read_text(encoding="utf-8").splitlines()
    for line in lines:
        if line.startswith(WORDS):
            name, _, words = line.removeprefix(WORDS).partition(" ")
            letter = variables.VARIABLES[variables.number(name)].letter
            click.echo(f"{name:{width}}  {words}{OF.get(letter[1:], '')}")
    context.exit()


@click.command("watch")
@click.argument("names", nargs=-1, metavar="[VARIABLE]...")
@robot_option()
@click.option("--every", type=time_ms, default="100ms", show_default=True, metavar="TIME", help="Between two records.")
@click.option("--on-change", is_flag=True, help="Only when one has changed, at that distance at least.")
@click.option("--for", "lasting", type=time_ms, metavar="TIME", help="So long; without it until Ctrl-C.")
@click.option("--list", is_flag=True, is_eager=True, expose_value=False, callback=_list, help="List the variables.")
@json_option
def command(
    names: tuple[str, ...], robot: str, every: int, on_change: bool, lasting: int | None, as_json: bool
) -> None:
    """Watch variables of a robot, the usual ones if none is named.

    A table at a terminal, one JSON object per line in a pipe. Ctrl-C ends the watching and stops nothing; `softrig
    stop` does.
    """
    asked = numbers_of(names) if names else variables.USUAL
    if not every:
        raise BadRequest("--every 0: write at least 5ms, a control step")
    with connected(robot, watch_only=True) as face:
        ours = face.info()["may_arm"]
        if ours:
            face.subscribe(every, names or None, on_change)
        else:
            note("this session may only watch: the usual variables, each 50 ms at most")
            face.overhear(every)
        time_ms = FOR_EVER_MS if lasting is None else lasting
        count = _watched(face, time_ms, as_json or not sys.stdout.isatty(), ours and asked != variables.USUAL)
        missed = sum(face.missed().values())
        if ours:
            face.subscribe(0)
    note(f"{count} records, {missed} missed")


def _watched(face: Robot, time_ms: int, as_lines: bool, named: bool) -> int:
    """Show what comes for that long, or until Ctrl-C, and return how many records of telemetry did.

    Where variables are `named`, the usual ones are left out: what the session before had asked for may still arrive.
    """
    count, parts = 0, face.profile.parts
    with suppress(KeyboardInterrupt), _lines(parts) if as_lines else _table(parts) as show:
        for record in face.listen(time_ms):
            if named and isinstance(record, Telemetry):
                continue
            count += isinstance(record, (Telemetry, Sample))
            show(record)
    return count


def fields_of(record: Record, parts: Parts) -> dict[str, Any]:
    """Return a record's fields, variables among them by their names."""
    row = row_of(record, parts)
    values = row.pop("values", {})
    return {**row, **values}


@contextmanager
def _lines(parts: Parts) -> Iterator[Show]:
    """Print each record on a line of its own."""
    yield lambda record: click.echo(json_line(fields_of(record, parts)))


@contextmanager
def _table(parts: Parts) -> Iterator[Show]:
    """Keep one table up to date; events pass above it."""
    from rich.live import Live  # noqa: PLC0415
    from rich.table import Table  # noqa: PLC0415

    drawn_ms = 0
    with Live(auto_refresh=False) as live:

        def show(record: Record) -> None:
            nonlocal drawn_ms
            if not isinstance(record, (Telemetry, Sample)):
                live.console.print(json_line(fields_of(record, parts)), markup=False, highlight=False)
            elif record.host_ms - drawn_ms >= DRAWN_EVERY_MS:
                drawn_ms = record.host_ms
                table = Table.grid("", "", padding=(0, 2))
                for name, value in fields_of(record, parts).items():
                    table.add_row(name, printable(_told(value)))
                live.update(table, refresh=True)

        yield show


def _told(value: Any) -> str:
    if isinstance(value, dict):
        return "  ".join(f"{label} {_told(each)}" for label, each in value.items()) or "-"
    return "-" if value is None else str(value)
