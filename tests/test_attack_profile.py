"""A robot whose profile or identity is nonsense is told so in one line, whatever the nonsense."""

import json

import pytest

from host.errors import Mismatch
from host.profile import read_profile
from tests.fake_robot import PROFILE
from tests.test_cli_commands import line, peer  # noqa: F401  (fixtures)

WHOLE = json.loads(PROFILE)
CELL = {"cell": {"full_pa": 20000}}


def with_coil(**changes) -> bytes:
    """Return the profile with other limits of its coils."""
    return json.dumps(WHOLE | {"coil": WHOLE["coil"] | changes}).encode()


@pytest.mark.parametrize(
    "text",
    [
        b"[" * 30_000,
        PROFILE.replace(b'"supply_mv": ', b'"supply_mv": 1e999, "was": ', 1),
        with_coil(duty_max_permille="many"),
        with_coil(trip_degc=None),
        with_coil(on_max_ms=[1]),
        json.dumps(WHOLE | {"channels": [{**WHOLE["channels"][0], "label": 7}]}).encode(),
        json.dumps(WHOLE | {"channels": [{**WHOLE["channels"][0], "label": f"K{i}"} for i in range(33)]}).encode(),
        json.dumps(WHOLE | {"cells": [{"label": f"C{i}", "input": 2} for i in range(33)]} | CELL).encode(),
        json.dumps(WHOLE | {"cells": [{"label": WHOLE["channels"][0]["label"], "input": 2}]} | CELL).encode(),
    ],
    ids=["deep", "endless", "word", "nothing", "list", "label", "channels", "cells", "twice"],
)
def test_a_profile_that_makes_no_sense_is_a_mismatch(text):
    with pytest.raises(Mismatch, match="profile cannot be read"):
        read_profile(text)


def test_the_profile_itself_makes_sense():
    assert read_profile(PROFILE).coil.trip_degc == WHOLE["coil"]["trip_degc"]


def test_a_state_that_this_version_does_not_know_is_told_by_its_number(softrig, line, peer):  # noqa: F811
    peer.state = 200

    told = softrig("info")

    assert told.status == 0
    assert "state 200" in told.out
