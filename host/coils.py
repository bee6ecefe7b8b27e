"""What the resistances of a robot's coils say, decoded: are they whole, how much martensite, how warm."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from protocol import messages

ROW = "<HHhh"
NOT_MEASURED, NOT_KNOWN = 0, 0xFFFF
COLDEST, HOTTEST = -0x8000, 0x7FFF  # no bound


@dataclass(frozen=True, slots=True)
class CoilState:
    """One coil as it was measured last; None: not measured, not known, or no bound."""

    resistance_ohm: float | None
    martensite_percent: float | None
    at_least_degc: float | None
    at_most_degc: float | None

    def __str__(self) -> str:
        if self.resistance_ohm is None:
            return "not measured yet"
        told = f"{self.resistance_ohm:.2f} ohm"
        if self.martensite_percent is not None:
            told += f", martensite about {self.martensite_percent:.0f} %"
        low = "" if self.at_least_degc is None else f" at least {self.at_least_degc:.0f} C"
        high = "" if self.at_most_degc is None else f" at most {self.at_most_degc:.0f} C"
        return told + (f", was{low}{' and' if low and high else ''}{high}" if low or high else "")


def coils_of(payload: bytes, labels: tuple[str, ...]) -> dict[str, CoilState]:
    """Return the state of each coil by its label; ValueError when the payload is none of this robot's."""
    row = messages.COILS.unpack(payload)
    if len(row.channels) != len(labels) * struct.calcsize(ROW):
        raise ValueError(f"coils: {len(row.channels)} bytes, expected {struct.calcsize(ROW)} for each coil")
    return {
        label: CoilState(
            None if resistance == NOT_MEASURED else resistance / 100,
            None if martensite == NOT_KNOWN else martensite / 10,
            None if least == COLDEST else least / 10,
            None if most == HOTTEST else most / 10,
        )
        for label, (resistance, martensite, least, most) in zip(
            labels, struct.iter_unpack(ROW, row.channels), strict=True
        )
    }
