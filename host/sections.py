"""The sections of a robot's profile, each made into one of the classes of limits.py.

What is missing raises KeyError or TypeError, what is not as it must be TypeError or ValueError; what this version does
not know is passed over.

    supply = section(SupplyLimits, data["supply"])
    camera = optional(CameraLimits, data, "camera")
"""

from __future__ import annotations

from dataclasses import MISSING, fields
from typing import Any, TypeVar, get_type_hints

from host.limits import UNITS, Coil, Joint, ServoLimits

T = TypeVar("T")


def channel(entry: dict[str, Any]) -> Coil | Joint:
    """Return a channel of one of the kinds that there are."""
    if entry["kind"] == Coil.KIND:
        return section(Coil, entry)
    if entry["kind"] == Joint.KIND:
        return section(Joint, entry)
    raise ValueError(f"a channel of kind {entry['kind']!r}")


def servo(data: dict[str, Any], needed: bool) -> ServoLimits | None:
    """Return the limits of the joints, None when there are none and none are needed."""
    limits = optional(ServoLimits, data, "servo", needed)
    if limits is not None and limits.unit not in UNITS:
        raise ValueError(f"joints that count in {limits.unit!r}")
    return limits


def optional(kind: type[T], data: dict[str, Any], name: str, needed: bool = False) -> T | None:
    """Return the section of that name, None when there is none and none is needed."""
    return section(kind, data[name]) if needed or name in data else None


def section(kind: type[T], data: dict[str, Any]) -> T:
    """Return a `kind` made of the entries it knows; a newer robot may send more."""
    names = [field.name for field in fields(kind) if field.name in data or field.default is MISSING]  # type: ignore[arg-type]
    for name, wanted in get_type_hints(kind).items():
        if name in names and type(data[name]) is not wanted:
            raise TypeError(f"{name} is {data[name]!r}")
    return kind(**{name: data[name] for name in names})
