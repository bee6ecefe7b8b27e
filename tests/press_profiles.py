"""Profiles of robots with a load cell and force cells: the press, and odd ones that have only some of it."""

import json

from tests.joint_samples import FINGERS

PINCH = json.loads(FINGERS)
MADE = {
    "format": 1,
    "robot": "press",
    "supply_mv": 6000,
    "channels": [{"label": "P", "kind": "servo", "pin": 8, "current": 0, "position": 1}],
    "groups": [],
    "servo": PINCH["servo"]
    | {
        "unit": "mm", "least_centi": -500, "most_centi": 1000, "slew_centi_per_s": 1000, "hold_max_ms": 600000,
        "stall_ma": 900, "astray_centi": 50, "span_centi": 2000,
    },
    "load": {"input": 8, "zero_counts": 819, "full_mn": 32768, "most_mn": 18000, "trip_mn": 20000},
    "press": {"gain_um_per_s_per_n": 500, "reset_permille_per_s": 2000, "touch_mn": 50},
    "cells": [{"label": f"C{place + 1}", "input": 2 + place} for place in range(6)],
    "cell": {"full_pa": 20000},
    "supply": {"current_max_ma": 2000, "at_once_max": 1, "low_mv": 4800, "high_mv": 7400, "shunt_mohm": 10},
    "session": PINCH["session"],
    "program": PINCH["program"],
}  # fmt: skip
PRESS = json.dumps(MADE).encode()


def without(*names: str) -> bytes:
    """Return the press's profile without some of its sections."""
    return json.dumps({name: value for name, value in MADE.items() if name not in names}).encode()


def weighed(profile: bytes) -> bytes:
    """Return a profile of degrees with the load cell and the force cells of the press, and no press loop."""
    return json.dumps(json.loads(profile) | {name: MADE[name] for name in ("load", "cells", "cell")}).encode()
