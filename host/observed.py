"""What an observer says of the body, as a reader wants it: one that travels, fingers, or a press and its block."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from host.recording import Recording

Fields = dict[str, Any]
SAME_MM = 0.005  # as shown
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
    "dent_mm": ("dent", "{:.2f} mm"),
    "von_mises_peak_kpa": ("von Mises stress", "{:.2f} kPa at most"),
    "strain_peak_percent": ("strain", "{:.1f} % at most"),
}
WHOLE_RUN = ("trace_sha256", "torque_peak_nm", "force_peak_n", "lost_contact_s")  # what is told of no instant
BY_LABEL = {
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
    if seen.get("kind") == "press":
        yield _line("indenter", _indenter_line(seen))
        yield _line("cells", ", ".join(f"{label} {kpa:.2f}" for label, kpa in seen["cell_kpa"].items()) + " kPa")
    for name, (words, form) in SEEN.items():
        if seen.get(name) is not None:
            yield _line(words, _told(form, seen[name]))
    for name, (words, form) in BY_LABEL.items():
        told = [f"{label} {_told(form, value)}" for label, value in seen.get(name, {}).items() if value is not None]
        if told:
            yield _line(words, ", ".join(told))
    if seen.get("model"):
        yield _line("model", ", ".join(_model(seen["model"])))
    if seen.get("down"):
        yield _line("down", seen["down"])
    if seen.get("jump"):
        yield _line("jump", _jump_line(seen["jump"]))


def _whole_run(seen: Fields) -> Fields:
    """Return what is told of the whole run, not of an instant."""
    return {name: seen[name] for name in WHOLE_RUN if name in seen}


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


def _indenter_line(seen: Fields) -> str:
    """Return the line about the indenter of a press."""
    place, force = _told("{:.2f} mm", seen["depth_mm"]), _told("{:.2f} N", seen["force_n"])
    axis = "" if abs(seen["axis_mm"] - seen["depth_mm"]) < SAME_MM else f", axis {_told('{:.2f} mm', seen['axis_mm'])}"
    lost_s = seen.get("lost_contact_s")
    lost = "" if lost_s is None else f", contact lost at {lost_s:.2f} s of the bench"
    touching = "" if seen["touching"] else ", not touching"
    return f"depth {place}{axis}, force {force}, {seen['force_peak_n']:.2f} N at most{touching}{lost}"


def _model(model: Fields) -> Iterator[str]:
    """Yield what a model is said to be: words as they are, what holds by its name, figures after theirs."""
    for name, value in model.items():
        what, _, unit = name.rpartition("_")
        if isinstance(value, str):
            yield f"plane {value}" if name == "plane" else value
        elif value and isinstance(value, bool):
            yield name
        elif value:
            yield f"{what} {value:g} {unit}" if what else f"{name} {value:g}"


def _jump_line(jump: Fields) -> str:
    """Return the line about a jump."""
    stored, released = f"stored {jump['stored_mj']:.1f} mJ", f"released {jump['released_mj']:.1f} mJ"
    takeoff = f"take-off {jump['takeoff_m_per_s']:.2f} m/s at {jump['takeoff_s']:.2f} s"
    return f"{stored}, {released}, {takeoff}, apex {jump['apex_mm']:.0f} mm, losses {jump['losses_mj']:.1f} mJ"
