"""Scripts for tests: a robot with round numbers, and the shortest way from text to what is asked about it."""

import json
from pathlib import Path

import pytest

from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.diagnostics import GaitError
from host.gait.script import load, loads
from host.profile import read_profile
from protocol.program import disassemble

ROOT = Path(__file__).parents[1]
HEAD = "gait 1\nrobot round\n"

BALL = ["A00m1", "A10m1", "A100", "A101", "A001", "Am101", "Am100", "Am10m1"]
CIRCLE = "circle roll = " + " ".join(BALL) + "\n"
ROUND = {
    "format": 1,
    "robot": "round",
    "supply_mv": 2000,
    "channels": [{"label": label, "kind": "sma", "chip": 96, "output": i} for i, label in enumerate("ABCDEFGH")],
    "groups": [["front", "A B"], ["even", "A C E G"]],
    "coil": {
        "duty_max_permille": 900, "hold_max_ms": 4000, "on_max_ms": 6000, "rest_ms": 2000, "heat_budget_mj": 600,
        "heat_leak_ms": 3000, "trip_degc": 120, "resistance_mohm": 9500, "wiring_mohm": 500,
        "heat_capacity_uj_per_k": 2000, "loss_uw_per_k": 2000, "latent_uj": 90000,
        "as_degc": 68, "af_degc": 78, "ms_degc": 52, "mf_degc": 42,
    },
    "supply": {"current_max_ma": 400, "at_once_max": 4, "low_mv": 1500, "high_mv": 2600, "shunt_mohm": 100},
    "session": {"lease_ms": 500, "lease_max_ms": 5000},
    "program": {"bytes_max": 1024, "depth_max": 8, "guards_max": 8},
}  # fmt: skip

JOINTS = [
    {"label": label, "kind": "servo", "pin": 8 + i, "current": i, "position": 2 + i} for i, label in enumerate("RL")
]
SERVO = {
    "unit": "deg", "least_centi": -3000, "most_centi": 3000, "slew_centi_per_s": 10000, "hold_max_ms": 5000,
    "stall_ma": 2400, "stall_ms": 300, "astray_centi": 500, "astray_ms": 500,
    "pulse_hz": 200, "low_us": 500, "high_us": 2500, "span_centi": 18000,
    "ua_per_count": 1611, "low_counts": 410, "high_counts": 3686,
}  # fmt: skip
LOOP = json.loads((ROOT / "firmware" / "robots" / "press.json").read_text(encoding="utf-8"))["press"]


def round_robot(**coil):
    """Return a profile with round numbers: 200 mA and 380 mW at full duty; `coil` changes limits of its coils."""
    return read_profile(json.dumps({**ROUND, "coil": {**ROUND["coil"], **coil}}).encode())


def ball_robot(**coil):
    """Return the same robot with coils that have directions, eight of them in the rolling circle, and a sensor."""
    return read_profile(json.dumps(ball(**coil)).encode())


def ball(**coil):
    """Return the profile of `ball_robot` as it stands in the firmware."""
    channels = [{**row, "label": label} for row, label in zip(ROUND["channels"], BALL, strict=True)]
    limits = {**ROUND["coil"], **coil}
    return {**ROUND, "channels": channels, "groups": [["low", "A00m1 A10m1"]], "coil": limits, "imu": {"address": 106}}


def hand(**servo):
    """Return the profile of `hand_robot` as it stands in the firmware."""
    rest = {name: ROUND[name] for name in ROUND if name != "coil"}
    sees = {"camera": {"address": 51, "stale_ms": 100}}
    turns = {"orient": {"gain_permille_per_s": 5000, "swing_max_centideg": 2000}}
    return {**rest, "channels": JOINTS, "groups": [["both", "R L"]], "servo": {**SERVO, **servo}, **sees, **turns}


def hand_robot(**servo):
    """Return a robot of two joints and no coil: 30 deg to either side, 100 deg/s, 5 s of hold; it has a camera."""
    return read_profile(json.dumps(hand(**servo)).encode())


def mixed_robot():
    """Return a robot with two coils and two joints, and no camera."""
    rows = [*ROUND["channels"][:2], *JOINTS]
    groups = [["front", "A B"], ["odd", "A R"]]
    return read_profile(json.dumps({**ROUND, "channels": rows, "groups": groups, "servo": SERVO}).encode())


def block(**servo):
    """Return the profile of `press_robot` as it stands in the firmware."""
    rest = {name: ROUND[name] for name in ROUND if name not in ("coil", "groups")}
    axis = {"unit": "mm", "least_centi": -500, "most_centi": 1000, "slew_centi_per_s": 1000, "span_centi": 2000}
    return {
        **rest,
        "channels": [{"label": "P", "kind": "servo", "pin": 8, "current": 0, "position": 1}],
        "groups": [["axis", "P"]],
        "servo": {**SERVO, **axis, **servo},
        "load": {"input": 8, "zero_counts": 819, "full_mn": 32768, "most_mn": 18000, "trip_mn": 20000},
        "press": LOOP,
        "cells": [{"label": f"C{i}", "input": 1 + i} for i in range(1, 7)],
        "cell": {"full_pa": 20000},
    }


def press_robot(**servo):
    """Return a robot of one joint that goes from -5 to 10 mm, 10 mm/s, with a load cell and six force cells."""
    return read_profile(json.dumps(block(**servo)).encode())


def circular():
    """Return the profile of the circular robot, as its firmware sends it."""
    return profile_of("circular")


def profile_of(robot):
    """Return the profile of a robot by its name, as its firmware sends it."""
    return read_profile((ROOT / "firmware" / "robots" / f"{robot}.json").read_bytes())


def compiled(body, *overrides, profile=None, head=HEAD):
    """Return the compiled script that `body` makes below the two head lines."""
    return compile_script(loads(head + body + "\n"), profile or round_robot(), overrides)


def ops(body, *overrides, profile=None):
    """Return (name, arguments...) of each op of a script, without step marks and the halt."""
    rows = [row[1:] for row in disassemble(compiled(body, *overrides, profile=profile).code)]
    return [row for row in rows if row[0] not in ("step", "halt")]


def report(body, profile=None):
    """Return the checker's report on a script."""
    return check(compiled(body, profile=profile))


def mistakes(body, *overrides, head=HEAD, files=None, profile=None):
    """Return (code, line, column) of each mistake; lines count from the first line of `body`."""
    return [(item.code, item.place.line - head.count("\n"), item.place.column)
            for item in diagnostics(body, *overrides, head=head, files=files, profile=profile)]  # fmt: skip


def diagnostics(body, *overrides, head=HEAD, files=None, profile=None):
    """Return what is wrong with a script; `files` are texts by path for what it includes."""
    texts = {"script.gait": head + body + "\n", **(files or {})}
    with pytest.raises(GaitError) as caught:
        compile_script(load("script.gait", reader(texts)), profile or round_robot(), overrides)
    return caught.value.diagnostics


def reader(texts):
    """Return a reader of files that exist only here."""

    def read(path):
        if path not in texts:
            raise FileNotFoundError(2, "No such file or directory", path)
        return texts[path]

    return read
