"""What each coil was given and each joint did during a run, worked out of its telemetry, as fields and as lines.

On-time and energy are summed over the telemetry, each record holding until the next one; the energy is that of the coil
itself: duty x (measured supply voltage / (coil + wiring))^2 x coil, with the resistances of the robot's profile.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from host.profile import Profile
from host.recording import Recording
from host.records import Telemetry

ENERGY = "duty x (measured supply / (coil + wiring))^2 x coil, resistances of the profile"
Fields = dict[str, Any]


def driven(recording: Recording, profile: Profile) -> Fields:
    """Return the fields about coils and joints; nothing about what the robot has not."""
    fields: Fields = {}
    if profile.coil_labels:
        fields = {"coils": coils(recording, profile), "energy_is": ENERGY}
    return {**fields, "joints": joints(recording, profile)} if profile.joint_labels else fields


def coils(recording: Recording, profile: Profile) -> dict[str, Fields]:
    """Return on-time, energy and highest estimated temperature of each coil."""
    on_s = [0.0] * len(profile.coil_labels)
    energy_j = [0.0] * len(profile.coil_labels)
    for held_s, record in _held(recording.telemetry):
        for i, duty_permille in enumerate(record.duty_permille):
            on_s[i] += held_s if duty_permille else 0.0
            energy_j[i] += held_s * duty_permille / 1000 * _power_w(record.supply_mv, profile)
    peaks = [max(degc) for degc in zip(*(record.temperature_degc for record in recording.telemetry), strict=True)]
    return {
        label: {
            "on_s": round(on_s[i], 3),
            "energy_j": round(energy_j[i], 4),
            "peak_estimated_degc": peaks[i] if peaks else None,
        }
        for i, label in enumerate(profile.coil_labels)
    }


def joints(recording: Recording, profile: Profile) -> dict[str, Fields]:
    """Return of each joint for how long it was driven, between which angles it was, and its largest current."""
    driven_s = [0.0] * len(profile.joint_labels)
    for held_s, record in _held(recording.telemetry):
        for i, commanded_deg in enumerate(record.commanded_deg):
            driven_s[i] += 0.0 if commanded_deg is None else held_s
    angles = list(zip(*(record.joint_deg for record in recording.telemetry), strict=True))
    currents = list(zip(*(record.joint_ma for record in recording.telemetry), strict=True))
    return {
        label: {
            "driven_s": round(driven_s[i], 3),
            "least_deg": min(angles[i]) if angles else None,
            "most_deg": max(angles[i]) if angles else None,
            "peak_ma": max(currents[i]) if currents else None,
        }
        for i, label in enumerate(profile.joint_labels)
    }


def driven_lines(fields: Fields) -> Iterator[str]:
    """Yield a table of the coils that were on, and one of all joints."""
    if "coils" in fields:
        yield "  coil    on time   energy   peak (estimate)"
    for label, coil in fields.get("coils", {}).items():
        if coil["on_s"]:
            peak = f"{coil['peak_estimated_degc']:7.1f} C" if coil["peak_estimated_degc"] is not None else ""
            yield f"  {label:<6}{coil['on_s']:7.2f} s {coil['energy_j']:6.3f} J {peak}"
    if "joints" in fields:
        yield f"  {'joint':<6}{'driven':>9}{'least':>12}{'most':>12}{'peak current':>15}"
    for label, joint in fields.get("joints", {}).items():
        row = f"  {label:<6}{joint['driven_s']:7.2f} s"
        if joint["peak_ma"] is not None:
            row += f"{joint['least_deg']:8.2f} deg{joint['most_deg']:8.2f} deg{joint['peak_ma'] / 1000:13.2f} A"
        yield row


def _held(records: list[Telemetry]) -> Iterator[tuple[float, Telemetry]]:
    """Yield each record with the seconds of the robot's clock until the next one."""
    for record, following in pairwise(records):
        yield (following.now_ms - record.now_ms) % (1 << 32) / 1000, record


def _power_w(supply_mv: int, profile: Profile) -> float:
    """Return the power of one coil that is fully on."""
    coil_ohm = profile.coil.resistance_mohm / 1000
    current_a = supply_mv / 1000 / (coil_ohm + profile.coil.wiring_mohm / 1000)
    return current_a * current_a * coil_ohm
