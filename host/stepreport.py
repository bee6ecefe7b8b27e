"""What a report says of the steps of its script: its notes, what it caught, and the step that it ended in."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from host.gait.compiler import Compiled
from host.recording import Recording
from host.records import Event
from host.robot import ENDS
from protocol import causes

Fields = dict[str, Any]
CAUGHT = "caught"  # the event that what runs on a fault begins


def steps(recording: Recording, compiled: Compiled, is_done: bool) -> Fields:
    """Return the notes, what was caught, and where a script ended that did not run to its end."""
    return {
        "notes": [_note(event, recording, compiled) for event in recording.events if event.event == "noted"],
        "caught": next((_caught(event, recording) for event in recording.events if event.event == CAUGHT), None),
        "ended_in": None if is_done else _ended_in(recording, compiled),
    }


def step_lines(fields: Fields) -> Iterator[str]:
    """Yield the notes in their order, what was caught, and how to go on from where the script ended."""
    for note in fields["notes"]:
        yield f"  note             {note['text']} (at {note['t_s']:.2f} s, {note['where']})"
    caught, ended = fields["caught"], fields["ended_in"]
    if caught:
        yield f"  on fault         from {caught['at_s']:.2f} s on: {caught['code']} {caught['cause']}"
    if ended:
        yield f"  ended in         step {ended['step']}: {ended['text']}; `--from {ended['step']}` begins there"


def _note(event: Event, recording: Recording, compiled: Compiled) -> Fields:
    step = compiled.step(event.step)
    fields = {"t_s": recording.seconds(event.host_ms), "step": event.step}
    if step is None:
        return {**fields, "file": None, "line": None, "where": f"step {event.step}", "text": ""}
    return {**fields, "file": step.place.file, "line": step.place.line, "where": step.where, "text": step.note}


def _caught(event: Event, recording: Recording) -> Fields:
    row = causes.row(event.code)
    known = {"code": row.name, "cause": row.cause} if row else {"code": str(event.code), "cause": "unknown"}
    return {**known, "at_s": recording.seconds(event.host_ms), "step": event.step}


def _ended_in(recording: Recording, compiled: Compiled) -> Fields | None:
    """Return the step that ran last, before anything that ran because of a fault; None when it is not known."""
    last = next((event for event in recording.events if event.event in (CAUGHT, *ENDS)), None)
    begun = [event.step for event in recording.events if event.event == "step"]
    number = last.step if last and last.step else begun[-1] if begun else 0
    step = compiled.step(number)
    return {"step": number, "file": step.place.file, "line": step.place.line, "text": str(step)} if step else None
