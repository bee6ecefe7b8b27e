"""What stands in a robot's profile: its channels, of one kind or the other, its cells, and what its firmware allows.

Values keep the units of their names; `sections.py` reads them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from protocol import program

UNITS = ("deg", "mm")  # of joints


@dataclass(frozen=True, slots=True)
class Coil:
    """A channel that heats a coil: the chip's address and its output."""

    KIND: ClassVar = "sma"

    label: str
    kind: str
    chip: int
    output: int


@dataclass(frozen=True, slots=True)
class Joint:
    """A channel that drives a joint: its pin, and the converter's inputs of its current and position."""

    KIND: ClassVar = "servo"

    label: str
    kind: str
    pin: int
    current: int
    position: int


@dataclass(frozen=True, slots=True)
class Cell:
    """A force cell: its label, and the converter's input that reads it."""

    label: str
    input: int


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

    def current_ma(self, supply_mv: int, duty_permille: int) -> int:
        """Return the mean current of a coil at that duty and supply, rounded up."""
        full_ma = -(-1000 * supply_mv // (self.resistance_mohm + self.wiring_mohm))
        return -(-full_ma * duty_permille // 1000)


@dataclass(frozen=True, slots=True)
class ServoLimits:
    """What the firmware allows each joint, and how its pulses and readings are to be understood.

    Positions are in hundredths of `unit`.
    """

    unit: str
    least_centi: int
    most_centi: int
    slew_centi_per_s: int
    hold_max_ms: int
    stall_ma: int
    stall_ms: int
    astray_centi: int
    astray_ms: int
    pulse_hz: int
    low_us: int
    high_us: int
    span_centi: int
    ua_per_count: int
    low_counts: int
    high_counts: int


@dataclass(frozen=True, slots=True)
class CameraLimits:
    """Where the camera answers, and how long the robot goes on without a new angle from it."""

    address: int
    stale_ms: int


@dataclass(frozen=True, slots=True)
class OrientLimits:
    """How the robot turns an object that its joints hold."""

    gain_permille_per_s: int
    swing_max_centideg: int


@dataclass(frozen=True, slots=True)
class LoadLimits:
    """How the load cell is read, the largest force that may be asked for, and the force that trips."""

    input: int
    zero_counts: int
    full_mn: int
    most_mn: int
    trip_mn: int


@dataclass(frozen=True, slots=True)
class PressLimits:
    """How the robot regulates the force of its only joint; up to `touch_mn` it takes it as touching nothing."""

    gain_um_per_s_per_n: int
    reset_permille_per_s: int
    smooth_ms: int
    approach_um_per_s: int
    touch_mn: int


@dataclass(frozen=True, slots=True)
class CellLimits:
    """The pressure that a force cell reads at the converter's full range."""

    full_pa: int


@dataclass(frozen=True, slots=True)
class SupplyLimits:
    """What the supply of coils and joints can give."""

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
