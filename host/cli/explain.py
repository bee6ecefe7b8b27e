"""`softrig explain`: a row of the tables of codes."""

from __future__ import annotations

import click

from host.cli.options import json_option
from host.cli.output import emit
from host.errors import BadRequest, unit_of
from host.gait import errors
from protocol import causes

JOINTS = "of the joint's unit"


@click.command("explain")
@click.argument("code", required=False)
@json_option
def command(code: str | None, as_json: bool) -> None:
    """Explain an error (E141), refusal (R04) or fault (F05) code: cause, what the robot did, what to do.

    Without a code, list them all.
    """
    rows = _rows()
    if code is None:
        emit(as_json, list(rows.values()), [f"{name}  {row['cause']}" for name, row in rows.items()])
        return
    row = rows.get(code.upper())
    if row is None:
        raise BadRequest(f"no code {code}: `softrig explain` lists them all")
    shown = {"cause": "cause", "did": "the robot", "todo": "to do"}
    lines = [f"{row['code']}", *(f"  {label:<10} {row[key]}" for key, label in shown.items() if row.get(key))]
    emit(as_json, row, lines)


def _rows() -> dict[str, dict[str, str]]:
    """Return all rows of both tables by their code."""
    scripts = [{"code": row.code, "cause": row.cause, "todo": row.todo} for row in errors.ROWS]
    robots = [
        {"code": row.name, "cause": row.cause, "did": row.did, "todo": row.todo, "unit": unit_of(row, JOINTS)}
        for row in causes.CODES
    ]
    return {row["code"]: row for row in [*scripts, *robots]}
