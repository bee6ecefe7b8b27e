"""Profiles of robots with a load cell and force cells: the press, and odd ones that have only some of it."""

import json
from pathlib import Path

PRESS = (Path(__file__).parents[1] / "firmware/robots/press.json").read_bytes()
MADE = json.loads(PRESS)


def without(*names: str) -> bytes:
    """Return the press's profile without some of its sections."""
    return json.dumps({name: value for name, value in MADE.items() if name not in names}).encode()


def weighed(profile: bytes) -> bytes:
    """Return a profile of degrees with the load cell and the force cells of the press, and no press loop."""
    return json.dumps(json.loads(profile) | {name: MADE[name] for name in ("load", "cells", "cell")}).encode()
