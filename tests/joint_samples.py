"""Profiles of robots with joints: the fingers, and one that has coils and joints."""

import json

from tests.fake_robot import PROFILE

ROUND = json.loads(PROFILE)
JOINTS = {
    "servo": {
        "least_centideg": -3000,
        "most_centideg": 3000,
        "slew_centideg_per_s": 36000,
        "hold_max_ms": 60000,
        "stall_ma": 2400,
        "stall_ms": 300,
        "pulse_hz": 200,
        "low_us": 500,
        "high_us": 2500,
        "span_centideg": 18000,
        "ua_per_count": 1611,
        "low_counts": 410,
        "high_counts": 3686,
    },
    "camera": {"address": 51, "stale_ms": 100},
    "orient": {"gain_permille_per_s": 5000, "swing_max_centideg": 2000},
}
SERVOS = [
    {"label": "R", "kind": "servo", "pin": 8, "current": 0, "angle": 2},
    {"label": "L", "kind": "servo", "pin": 9, "current": 1, "angle": 3},
]
FINGERS = json.dumps(
    {
        "format": 1,
        "robot": "fingers",
        "supply_mv": 6000,
        "channels": SERVOS,
        "groups": [["all", "R L"]],
        **JOINTS,
        "supply": {"current_max_ma": 6000, "at_once_max": 2, "low_mv": 4800, "high_mv": 7400, "shunt_mohm": 10},
        "session": ROUND["session"],
        "program": ROUND["program"],
    }
).encode()
HAND = json.dumps(
    {**ROUND, "robot": "hand", "channels": [*ROUND["channels"][:2], *SERVOS], "groups": [["all", "A B R L"]], **JOINTS}
).encode()
