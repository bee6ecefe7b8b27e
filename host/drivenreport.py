"""What each coil was given, each joint did and each cell felt during a run, by its telemetry, as fields and as lines.

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
    """Return the fields about coils, joints, load cell and force cells; nothing about what the robot has not."""
    fields: Fields = {}
    if profile.coil_labels:
        fields = {"coils": coils(recording, profile), "energy_is": ENERGY}
    if profile.joint_labels:
        fields["joints"] = joints(recording, profile)
    if profile.load:
        forces = [record.load_n for record in recording.telemetry if record.load_n is not None]
        fields["force"] = {"most_n": max(forces, default=None), "least_n": min(forces, default=None)}
    if profile.cells:
        pressures = list(zip(*(record.cell_kpa for record in recording.telemetry), strict=True))
        fields["cells"] = {
            label: {"most_kpa": max(pressures[i]) if pressures else None} for i, label in enumerate(profile.cell_labels)
        }
    return fields


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
    """Return of each joint for how long it was driven, between which positions it was, and its largest current."""
    driven_s = [0.0] * len(profile.joint_labels)
    for held_s, record in _held(recording.telemetry):
        for i, commanded in enumerate(record.commanded_position):
            driven_s[i] += 0.0 if commanded is None else held_s
    positions = list(zip(*(record.joint_position for record in recording.telemetry), strict=True))
    currents = list(zip(*(record.joint_ma for record in recording.telemetry), strict=True))
    return {
        label: {
            "driven_s": round(driven_s[i], 3),
            f"least_{profile.unit}": min(positions[i]) if positions else None,
            f"most_{profile.unit}": max(positions[i]) if positions else None,
            "peak_ma": max(currents[i]) if currents else None,
        }
        for i, label in enumerate(profile.joint_labels)
    }


def driven_lines(fields: Fields) -> Iterator[str]:
    """Yield a table of the coils that were on, one of all joints, and a line of each sort of cell."""
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
            unit = "mm" if "least_mm" in joint else "deg"
            least, most = (f"{joint[f'{side}_{unit}']:.2f} {unit}" for side in ("least", "most"))
            row += f"{least:>12}{most:>12}{joint['peak_ma'] / 1000:13.2f} A"
        yield row
    yield from _felt_lines(fields.get("force", {}), fields.get("cells", {}))


def _felt_lines(force: Fields, cells: Fields) -> Iterator[str]:
    """Yield what load cell and force cells felt, and what was asked for."""
    if force.get("most_n") is not None:
        asked = f", asked for {force['asked_n']:g} N" if force.get("asked_n") is not None else ""
        yield f"  force            {force['least_n']:.2f} to {force['most_n']:.2f} N{asked}"
    told = [f"{label} {cell['most_kpa']:.2f}" for label, cell in cells.items() if cell["most_kpa"] is not None]
    if told:
        yield f"  cells at most    {', '.join(told)} kPa"


def _held(records: list[Telemetry]) -> Iterator[tuple[float, Telemetry]]:
    """Yield each record with the seconds of the robot's clock until the next one."""
    for record, following in pairwise(records):
        yield (following.now_ms - record.now_ms) % (1 << 32) / 1000, record


def _power_w(supply_mv: int, profile: Profile) -> float:
    """Return the power of one coil that is fully on."""
    coil_ohm = profile.coil.resistance_mohm / 1000
    current_a = supply_mv / 1000 / (coil_ohm + profile.coil.wiring_mohm / 1000)
    return current_a * current_a * coil_ohm
