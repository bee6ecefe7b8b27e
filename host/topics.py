"""The topics of a log: the JSON schema of the named fields that a row of each may have.

A row has what the robot and its observer told, so fields of joints are in their unit, and what a robot has not is left
out.
"""

from __future__ import annotations

from typing import Any

NUMBER, TEXT, MAYBE = {"type": "number"}, {"type": "string"}, {"type": ["number", "null"]}
BOOLEAN, OBJECT = {"type": "boolean"}, {"type": "object"}
BY_LABEL = {"type": "object", "additionalProperties": NUMBER}
PACKED = {"type": "string", "contentEncoding": "base64"}
MAYBE_BY_LABEL = {"type": "object", "additionalProperties": MAYBE}
COORDINATES = {"type": "array", "items": {"type": "array", "items": NUMBER}}
TOPICS: dict[str, dict[str, Any]] = {
    "bytes": {
        "host_ms": NUMBER,
        "now_ms": MAYBE,
        "direction": {"type": "string", "enum": ["in", "out"]},
        "data": PACKED,
    },
    "telemetry": {
        **dict.fromkeys(("host_ms", "now_ms", "step", "supply_mv", "current_ma", "board_degc"), NUMBER),
        "state": TEXT,
        "duty_permille": BY_LABEL,
        "temperature_degc": BY_LABEL,
        "roll_deg": MAYBE,
        "pitch_deg": MAYBE,
        "down": {"type": ["string", "null"]},
        **dict.fromkeys(("joint_deg", "joint_mm", "joint_ma", "cell_kpa"), BY_LABEL),
        "commanded_deg": MAYBE_BY_LABEL,
        "commanded_mm": MAYBE_BY_LABEL,
        "object_deg": MAYBE,
        "load_n": NUMBER,
    },
    "samples": {**dict.fromkeys(("host_ms", "now_ms", "slot"), NUMBER), "values": {"type": "object"}},
    "events": {
        **dict.fromkeys(("host_ms", "now_ms", "code", "step", "value"), NUMBER),
        "event": TEXT,
        "coil": {"type": ["string", "null"]},
    },
    "notes": {**dict.fromkeys(("host_ms", "now_ms", "step", "line"), NUMBER), "file": TEXT, "text": TEXT},
    "stops": {
        **dict.fromkeys(("host_ms", "now_ms", "code"), NUMBER),
        "state": TEXT,
        "coils": {"type": "array", "items": TEXT},
    },
    "line": {
        "host_ms": NUMBER,
        "now_ms": MAYBE,
        "session": NUMBER,
        "what": {"type": "string", "enum": ["begins", "interrupted", "resumed", "ends"]},
        "cause": TEXT,
        "clock_offset_ms": MAYBE,
        "clock_drift_ppm": MAYBE,
        "clock_bound_ms": MAYBE,
    },
    "scenes": {
        "host_ms": NUMBER,
        "t_s": NUMBER,
        "hub": {"type": "array", "items": NUMBER},
        "nodes": COORDINATES,
        **dict.fromkeys(("coils", "energy_j", "fingers", "object", "block", "indenter", "cells", "observed"), OBJECT),
        **dict.fromkeys(("depth_mm", "axis_mm", "force_n", "current_a"), NUMBER),
        **dict.fromkeys(("touching", "limp"), BOOLEAN),
        "commanded_mm": MAYBE,
        "surface_mm": COORDINATES,
    },
    "mesh": {"host_ms": NUMBER, "points_mm": PACKED, "triangles": PACKED},
    "fields": {"host_ms": NUMBER, "t_s": NUMBER, "displacement_mm": PACKED, "stress_kpa": PACKED},
}
