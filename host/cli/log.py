"""`softrig log`: what is in a log, as table or as picture; also in one whose writer was killed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click

from host.cli.options import json_option, time_ms
from host.cli.output import emit, note, writing
from host.errors import BadRequest
from host.logbook import read_log
from host.view import draw_run


@click.group("log")
def command() -> None:
    """Look into logs: info, export, plot."""


@command.command("info")
@click.argument("file", type=click.Path(path_type=Path))
@json_option
def info(file: Path, as_json: bool) -> None:
    """Say what is in a log."""
    fields = read_log(file).info()
    emit(as_json, fields, _lines(fields))


@command.command("export")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--topic", default="telemetry", show_default=True, help="telemetry, events, stops, scenes or bytes.")
@click.option("--fields", metavar="NAME,...", help="displacement, stress, von_mises, strain: as .vtu for ParaView.")
@click.option("--at", metavar="TIME", help="Since the program began: of the nearest slice; or all: each, and a .pvd.")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="A table's default: stdout.")
def export(file: Path, topic: str, fields: str | None, at: str | None, output: Path | None) -> None:
    """Write one topic of a log as CSV, or fields inside a body (mm, kPa) as .vtu, which ParaView opens."""
    if fields is not None or at is not None:
        _export_fields(file, fields or "", at or "", output)
        return
    log = read_log(file)
    if output is None:
        log.write_csv(sys.stdout, topic)
        return
    with writing(output), output.open("w", encoding="utf-8", newline="") as table:
        rows = log.write_csv(table, topic)
    note(f"{rows} rows: {output}")


def _export_fields(file: Path, fields: str, at: str, output: Path | None) -> None:
    """Write the slice of a time, or all of them, and say which it was."""
    if not fields or not at or output is None or output.suffix != ".vtu":
        raise BadRequest("fields are exported with --fields NAME,... --at TIME (or all) -o FILE.vtu")
    from host.fieldfile import write_series, write_slice  # noqa: PLC0415  (numpy, which a table does not need)

    names = [name.strip() for name in fields.split(",")]
    at_s = None if at == "all" else _seconds(at)
    recording = read_log(file).recording()
    with writing(output):
        if at_s is None:
            written = write_series(recording, names, output)
            note(f"{written.slices} slices from {written.t_s:.3f} s on: {written.path}")
        else:
            written = write_slice(recording, at_s, names, output)
            unchanged = f", as at {at_s:g} s: nothing changed between" if written.still else ""
            note(f"slice at {written.t_s:.3f} s{unchanged}: {written.path}")


def _seconds(at: str) -> float:
    """Return a time that an operator wrote; BadRequest names the word that stands for all of them."""
    try:
        return time_ms(at) / 1000
    except click.BadParameter as error:
        raise BadRequest(f"--at {at}: write a time, as 2s, or all") from error


@command.command("plot")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, metavar="FILE.svg")
def plot(file: Path, output: Path) -> None:
    """Draw the run that a log holds."""
    recording = read_log(file).recording()
    with writing(output):
        draw_run(recording, output)
    note(f"picture: {output}")


def _lines(fields: dict[str, Any]) -> Iterator[str]:
    whole = "complete" if fields["complete"] else "cut off; what is whole was read"
    yield f"{fields['file']}: {fields['duration_s']:.2f} s, {whole}"
    for topic, rows in fields["rows"].items():
        yield f"  {topic:<12}{rows} rows"
    yield f"  {'events':<12}{', '.join(f'{count} {name}' for name, count in fields['events'].items()) or 'none'}"
    for name, size in fields["attachments"].items():
        yield f"  attached    {name}, {size} bytes"
