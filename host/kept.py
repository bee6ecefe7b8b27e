"""What a robot keeps over resets and power cuts, decoded: its last faults and its settings."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from host.records import channel_name, state_name
from protocol import messages


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault as the robot noted it: `start` is the number of the start of the firmware in which it happened."""

    start: int
    now_ms: int  # the robot's clock, which begins with each start
    code: int
    coil: str | None
    value: int  # in the unit of the code's row
    state: str  # in which it happened
    cause: str  # of that start


@dataclass(frozen=True, slots=True)
class FaultPage:
    """A part of the robot's faults, newest first; `start` is the number of the present start."""

    start: int
    count: int  # of all faults
    faults: tuple[Fault, ...]


@dataclass(frozen=True, slots=True)
class Settings:
    """The robot's settings; a resistance of 0 is the profile's."""

    source: str
    node: int
    board_offset_decidegc: int
    resistance_mohm: dict[str, int]


def faults_of(payload: bytes, labels: tuple[str, ...]) -> FaultPage:
    """Return the page of that payload; ValueError when it is none."""
    row = messages.FAULTS.unpack(payload)
    if len(row.records) % messages.FAULT_BYTES:
        raise ValueError(f"faults: {len(row.records)} bytes of records, must be a multiple of {messages.FAULT_BYTES}")
    rows = struct.iter_unpack(messages.FAULT, row.records)
    return FaultPage(row.start, row.count, tuple(_fault(fields, labels) for fields in rows))


def settings_of(payload: bytes, labels: tuple[str, ...]) -> Settings:
    """Return the settings of that payload; ValueError when it is none."""
    row = messages.SETTINGS.unpack(payload)
    if len(row.resistances) != 2 * len(labels):
        raise ValueError(f"settings: {len(row.resistances)} bytes of resistances for {len(labels)} coils")
    mohm = struct.unpack(f"<{len(labels)}H", row.resistances)
    source = _named(messages.SETTING_SOURCES, row.source)
    return Settings(source, row.node, row.board_offset_decidegc, dict(zip(labels, mohm, strict=True)))


def _fault(fields: tuple[int, ...], labels: tuple[str, ...]) -> Fault:
    start, now_ms, code, channel, value, state, cause = fields
    coil = channel_name(channel, labels)
    return Fault(start, now_ms, code, coil, value, state_name(state), _named(messages.CAUSES, cause))


def _named(names: tuple[str, ...], number: int) -> str:
    """Return the name of a number, or the number itself when this version has no name for it."""
    return names[number] if number < len(names) and names[number] else str(number)
