"""A forecast as JSON: every order, curve, joint order and wait of each way through a script."""

from __future__ import annotations

from typing import Any

from host.gait.forecast import Forecast
from host.gait.model.course import Course, Track


def fields(forecast: Forecast) -> dict[str, Any]:
    """Return the fields of `softrig preview --json`."""
    compiled = forecast.compiled
    return {
        "script": compiled.script.main.name,
        "robot": compiled.profile.robot,
        "forecast": forecast.as_dict(),
        "ways": {way or "only": _way(course, forecast) for way, course in forecast.ways.items()},
    }


def _way(course: Course, forecast: Forecast) -> dict[str, Any]:
    compiled = forecast.compiled

    def place(number: int) -> dict[str, object]:
        step = compiled.step(number)
        return {"file": step.place.file, "line": step.place.line} if step else {"file": None, "line": None}

    return {
        "end_ms": course.end_ms,
        "coils": {track.label: _coil(track) for track in course.driven},
        "steps": [{"at_ms": mark.at_ms, "step": mark.step, **place(mark.step)} for mark in course.marks],
        "waits": [
            {"begin_ms": pause.begin_ms, "end_ms": pause.end_ms, "met": pause.met, "known": pause.known,
             **place(pause.step)}
            for pause in course.pauses
        ],
        "motions": [
            {"kind": motion.kind, "joints": list(compiled.profile.named(motion.mask)), "begin_ms": motion.begin_ms,
             "arrive_ms": motion.arrive_ms, "end_ms": motion.end_ms, "target": motion.target}
            for motion in course.motions
        ],
        "gaps": [gap._asdict() for gap in course.gaps],
    }  # fmt: skip


def _coil(track: Track) -> dict[str, Any]:
    return {
        "orders": [bar._asdict() for bar in track.bars],
        "curve": [[ms, round(degc, 2)] for ms, degc in track.curve],
    }
