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


def texts_of(help_text: bytes) -> dict[str, str]:
    """Return the help texts by the name that each line begins with: `fire`, `fire.coils`."""
    lines = help_text.decode("utf-8", "replace").splitlines()
    return {name: text for name, _, text in (line.partition(" ") for line in lines) if name}


def explained(dictionary: bytes, texts: dict[str, str]) -> list[str]:
    """Return the definitions as a reader wants them: each line, and below it what the robot says of its names."""
    told: list[str] = []
    for line in dictionary.split(b"\n\n", 1)[0].decode("utf-8", "replace").splitlines():
        told.append(line)
        told += [f"    {name.rpartition('.')[2]}: {texts[name]}" for name in _names(line.split()) if name in texts]
    return told


def _names(words: list[str]) -> list[str]:
    """Return the names that a definition defines, as the help texts have them."""
    if words[0] == "var":
        return [f"var.{words[2].partition(':')[0]}"]
    if not words[0].isdigit():
        return []
    return [words[1], *(f"{words[1]}.{field.partition(':')[0]}" for field in words[2:])]
