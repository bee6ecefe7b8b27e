"""The host and a robot with joints: its profile, its telemetry, its orders."""

import json

import pytest

from host.errors import BadRequest, Mismatch
from host.profile import read_profile
from tests.joint_samples import FINGERS, HAND

FINGER, BOTH = read_profile(FINGERS), read_profile(HAND)


def test_a_robot_of_joints_alone_has_no_coils():
    assert FINGER.labels == FINGER.joint_labels == ("R", "L")
    assert FINGER.coil_labels == ()
    assert FINGER.servo.most_centideg == 3000
    with pytest.raises(BadRequest, match="fingers has no coils"):
        _ = FINGER.coil


def test_a_mask_counts_all_channels_whatever_their_kind():
    assert BOTH.labels == ("A", "B", "R", "L")
    assert BOTH.coil_mask(["B"]) == 0b10
    assert BOTH.joint_mask(["L"]) == 0b1000
    assert BOTH.mask(["all"]) == 0b1111


def test_who_fires_a_joint_is_told_to_move_it():
    with pytest.raises(BadRequest, match="R is a joint, no coil: `softrig move R --to 8deg` turns it"):
        BOTH.coil_mask(["A", "R"])


def test_who_moves_a_coil_is_told_to_fire_it():
    with pytest.raises(BadRequest, match="B is a coil, no joint: `softrig fire B` heats it"):
        BOTH.joint_mask(["R", "B"])


@pytest.mark.parametrize(("profile", "what"), [(FINGER, "joint"), (BOTH, "channel")])
def test_a_label_that_there_is_not_is_named_for_what_the_robot_has(profile, what):
    with pytest.raises(BadRequest, match=f"no {what} Z on {profile.robot}: it has "):
        profile.mask(["Z"])


@pytest.mark.parametrize("section", ["servo", "channels"])
def test_joints_without_their_limits_are_a_mismatch(section):
    data = json.loads(FINGERS)
    del data[section]

    with pytest.raises(Mismatch, match=f"profile cannot be read .*{section}"):
        read_profile(json.dumps(data).encode())


def test_a_channel_of_an_unknown_kind_is_a_mismatch():
    with pytest.raises(Mismatch, match="a channel of kind 'valve'"):
        read_profile(FINGERS.replace(b'"servo", "pin": 8', b'"valve", "pin": 8'))
