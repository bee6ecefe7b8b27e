"""What an observer says of the body, as a reader wants it: of one that travels, or of fingers and what they hold."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from host.recording import Recording

Fields = dict[str, Any]
SEEN = {
    "travel_mm": ("travel", "{:.1f} mm"),
    "lateral_mm": ("lateral", "{:.1f} mm"),
    "rotation_deg": ("rotation", "{:.1f} deg"),
    "apex_mm": ("apex", "{:.2f} mm"),
    "clearance_mm": ("clearance", "{:.2f} mm"),
    "peak_coil_degc": ("peak coil", "{:.1f} C"),
    "peak_coil_force_n": ("peak coil force", "{:.3f} N"),
    "energy_mj": ("energy", "{:.2f} mJ"),
    "stiffness_nmm_per_rad": ("stiffness", "{:.1f} N mm/rad"),
}
OF_FINGERS = {  # by label
    "displacement_mm": ("displacement", "{:.3f} mm"),
    "tip_deg": ("tip", "{:.2f} deg"),
    "normal_n": ("normal force", "{:.2f} N"),
    "friction_used": ("friction used", "{:.3f}"),
    "joint_torque_nm": ("joint torque", "{:.3f} N m"),
    "torque_peak_nm": ("peak torque", "{:.3f} N m"),
}


def observed(observer: Any, recording: Recording) -> Fields:
    """Return what `observer` sees; of joints, which go limp when all is over, what it saw when the program ended."""
    seen: Fields = observer.observe()
    return {**seen, **recording.at_end, **_whole_run(seen)} if recording.at_end else seen


def observed_lines(seen: Fields) -> Iterator[str]:
    """Yield what the observer saw."""
    if seen.get("kind") == "fingers":
        yield _line("object", _object_line(seen))
    for name, (words, form) in SEEN.items():
        if seen.get(name) is not None:
            yield _line(words, _told(form, seen[name]))
    for name, (words, form) in OF_FINGERS.items():
        told = [f"{label} {_told(form, value)}" for label, value in seen.get(name, {}).items() if value is not None]
        if told:
            yield _line(words, ", ".join(told))
    if seen.get("model"):
        yield _line("model", ", ".join(seen["model"].values()))
    if seen.get("down"):
        yield _line("down", seen["down"])
    if seen.get("jump"):
        yield _line("jump", _jump_line(seen["jump"]))


def _whole_run(seen: Fields) -> Fields:
    """Return what is told of the whole run, not of an instant."""
    return {name: seen[name] for name in ("trace_sha256", "torque_peak_nm") if name in seen}


def _told(form: str, value: float) -> str:
    """Return the value in that form, and a nothing without a sign."""
    told = form.format(value)
    return told.removeprefix("-") if float(told.split()[0]) == 0 else told


def _line(name: str, told: str) -> str:
    return f"  {name:<17}{told}"


def _object_line(seen: Fields) -> str:
    """Return the line about the object that fingers hold."""
    across, along = (_told("{:.2f} mm", value) for value in seen["object_mm"])
    place = f"at x {across}, y {along}"
    free = ", along its faces undetermined" if seen.get("along") == "undetermined" else ""
    return f"{_told('{:.3f} deg', seen['object_deg'])} {place}{free}{'' if seen.get('gripped') else ', not gripped'}"


def _jump_line(jump: Fields) -> str:
    """Return the line about a jump."""
    stored, released = f"stored {jump['stored_mj']:.1f} mJ", f"released {jump['released_mj']:.1f} mJ"
    takeoff = f"take-off {jump['takeoff_m_per_s']:.2f} m/s at {jump['takeoff_s']:.2f} s"
    return f"{stored}, {released}, {takeoff}, apex {jump['apex_mm']:.0f} mm, losses {jump['losses_mj']:.1f} mJ"
