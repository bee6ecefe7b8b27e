"""Profiles of robots with joints: the fingers, and one that has coils and joints."""

import json
from pathlib import Path

from tests.fake_robot import PROFILE

FINGERS = (Path(__file__).parents[1] / "firmware/robots/fingers.json").read_bytes()
ROUND, PINCH = json.loads(PROFILE), json.loads(FINGERS)
HAND = json.dumps(
    {
        **ROUND,
        "robot": "hand",
        "channels": [*ROUND["channels"][:2], *PINCH["channels"]],
        "groups": [["all", "A B R L"]],
        **{name: PINCH[name] for name in ("servo", "camera", "orient")},
    }
).encode()
