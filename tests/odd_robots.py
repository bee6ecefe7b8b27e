"""Profiles of robots with joints that nobody has built, for what must hold whatever a robot is made of."""

import json
from pathlib import Path

from tests.firmware_bench import FINGERS, PROFILE, Rig

ROUND, PINCH = json.loads(PROFILE.read_bytes()), json.loads(FINGERS.read_bytes())
THIRD = {"label": "M", "kind": "servo", "pin": 10, "current": 4, "position": 5}


def without(data: dict, *names: str) -> dict:
    """Return a profile that lacks these sections."""
    return {name: value for name, value in data.items() if name not in names}


def fingers(channels: list | None = None, **servo) -> dict:
    """Return the fingers' profile with other channels and other limits of its servos."""
    rows = PINCH["channels"] if channels is None else channels
    groups = [["all", " ".join(row["label"] for row in rows)]]
    return PINCH | {"channels": rows, "groups": groups, "servo": PINCH["servo"] | servo}


MIXED = {
    **ROUND, "robot": "hand", "channels": [*ROUND["channels"][:2], *PINCH["channels"]],
    "groups": [["all", "A B R L"]], **{name: PINCH[name] for name in ("servo", "camera", "orient")},
}  # fmt: skip
ODD = {
    "mixed": MIXED,
    "one joint": without(fingers(PINCH["channels"][:1]), "orient"),
    "three joints": fingers([*PINCH["channels"], THIRD]),
    "no camera": without(PINCH, "camera", "orient"),
    "no loop": without(PINCH, "orient"),
    "bent inward": fingers(least_centi=-5000, most_centi=-1000),
    "half turn": fingers(least_centi=-9000, most_centi=9000),
    "slow": fingers(slew_centi_per_s=100),
}


def rig_of(folder: Path, data: dict) -> Rig:
    """Return a rig of the robot that has that profile."""
    path = folder / "robot.json"
    path.write_text(json.dumps(data))
    return Rig(path)
