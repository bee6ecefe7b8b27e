"""The robot's dictionary as it is read: definitions of messages, a blank line, the robot's profile.

Ours are those of protocol/dictionary.txt, which every robot of this version has on its flash.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

from host.errors import DictionaryMismatch
from host.profile import Profile, read_profile
from protocol import frames


def profile_of(dictionary: bytes) -> Profile:
    """Return the robot's profile; Mismatch when its messages are not ours, or its profile lacks what we need."""
    differing = differing_lines(dictionary)
    if differing:
        raise DictionaryMismatch(differing)
    return read_profile(profile_text(dictionary))


def differing_lines(dictionary: bytes) -> list[str]:
    """Return the rows of the robot's table of messages that are not ours: `-` ours only, `+` the robot's only."""
    theirs = dictionary.split(b"\n\n", 1)[0].decode("utf-8", "replace").splitlines()
    ours = definitions().decode().splitlines()[:-1]
    return [f"- {line}" for line in ours if line not in theirs] + [f"+ {line}" for line in theirs if line not in ours]


@cache
def definitions() -> bytes:
    """Return what we mean by every message, up to the blank line."""
    return Path(frames.__file__).with_name("dictionary.txt").read_bytes()


def dictionary_of(profile: bytes) -> bytes:
    """Return the dictionary of a robot of this version that has that profile."""
    return definitions() + profile


def profile_text(dictionary: bytes) -> bytes:
    """Return the profile that ends the dictionary, as it stands in the robot's flash."""
    return dictionary.split(b"\n\n", 1)[-1]
