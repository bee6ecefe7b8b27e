"""A robot's profile as the robot itself sent it: labels, groups and limits.

The profile is the last part of the dictionary that every robot gives to every host; it is the authority on what may
be asked of the robot. Values keep the units of their names.

    profile = read_profile(text)
    mask = profile.mask(["A", "C"])
"""

from __future__ import annotations

import json
from binascii import crc32
from collections.abc import Iterable
from dataclasses import MISSING, dataclass, fields
from functools import cached_property
from typing import Any, TypeVar, get_type_hints

from host.errors import BadRequest, Mismatch
from protocol import program

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Channel:
    """One output of the robot and what hangs on it."""

    label: str
    kind: str
    chip: int
    output: int


@dataclass(frozen=True, slots=True)
class CoilLimits:
    """What the firmware allows each coil, and the figures its temperature estimate rests on."""

    duty_max_permille: int
    hold_max_ms: int
    on_max_ms: int
    rest_ms: int
    heat_budget_mj: int
    heat_leak_ms: int
    trip_degc: int
    resistance_mohm: int
    wiring_mohm: int
    heat_capacity_uj_per_k: int
    loss_uw_per_k: int
    latent_uj: int
    as_degc: int
    af_degc: int
    ms_degc: int
    mf_degc: int


@dataclass(frozen=True, slots=True)
class SupplyLimits:
    """What the coil supply can give."""

    current_max_ma: int
    at_once_max: int
    low_mv: int
    shunt_mohm: int


@dataclass(frozen=True, slots=True)
class SessionLimits:
    """How long the robot goes on without hearing its host."""

    lease_ms: int
    lease_max_ms: int


@dataclass(frozen=True, slots=True)
class ProgramLimits:
    """What the robot's sequencer holds."""

    bytes_max: int
    depth_max: int = program.DEPTH_MAX
    guards_max: int = program.GUARDS_MAX


@dataclass(frozen=True)
class Profile:
    """A robot: its channels in the order of the bit masks, its groups and its limits."""

    robot: str
    supply_mv: int
    channels: tuple[Channel, ...]
    groups: dict[str, tuple[str, ...]]
    coil: CoilLimits
    supply: SupplyLimits
    session: SessionLimits
    program: ProgramLimits
    crc: int
    imu: dict[str, int] | None = None  # address of the attitude sensor, where there is one

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Return the labels of all channels, in the order of the masks."""
        return tuple(channel.label for channel in self.channels)

    def mask(self, names: Iterable[str]) -> int:
        """Return the bit mask of these labels or groups; BadRequest lists the known ones."""
        mask = 0
        for name in names:
            for label in self.groups.get(name, (name,)):
                mask |= 1 << self._index(label)
        return mask

    def named(self, mask: int) -> tuple[str, ...]:
        """Return the labels whose bits are set."""
        return tuple(label for i, label in enumerate(self.labels) if mask >> i & 1)

    def label(self, channel: int) -> str | None:
        """Return the label of a channel number, or None when it names no channel."""
        return self.labels[channel] if channel < len(self.channels) else None

    def _index(self, label: str) -> int:
        if label not in self.labels:
            groups = f", groups {' '.join(self.groups)}" if self.groups else ""
            shown = label if label.isprintable() and label.strip() else repr(label)
            raise BadRequest(f"no coil {shown} on {self.robot}: it has {' '.join(self.labels)}{groups}")
        return self.labels.index(label)


def read_profile(text: bytes) -> Profile:
    """Return the profile that stands in `text`; Mismatch when a value that this version needs is not there."""
    try:
        data = json.loads(text)
        return Profile(
            robot=str(data["robot"]),
            supply_mv=int(data["supply_mv"]),
            channels=tuple(_taken(Channel, entry) for entry in data["channels"]),
            groups={name: tuple(labels.split()) for name, labels in data["groups"]},
            coil=_taken(CoilLimits, data["coil"]),
            supply=_taken(SupplyLimits, data["supply"]),
            session=_taken(SessionLimits, data["session"]),
            program=_taken(ProgramLimits, data["program"]),
            crc=crc32(text),
            imu=data.get("imu"),
        )
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError, RecursionError) as error:
        raise Mismatch(f"the robot's profile cannot be read ({error}): its firmware is of another version") from error


def _taken(kind: type[T], data: dict[str, Any]) -> T:
    """Return a `kind` made of the entries it knows; a newer robot may send more."""
    names = [field.name for field in fields(kind) if field.name in data or field.default is MISSING]  # type: ignore[arg-type]
    for name, wanted in get_type_hints(kind).items():
        if name in names and type(data[name]) is not wanted:
            raise TypeError(f"{name} is {data[name]!r}")
    return kind(**{name: data[name] for name in names})
