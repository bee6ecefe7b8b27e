"""How joints are spoken of: some turn by degrees, others go by millimetres; the robot's profile says which."""

from __future__ import annotations

from typing import NamedTuple

from host.gait import units


class JointUnit(NamedTuple):
    """A unit of joints: its kind of quantity, what a condition calls that, what such a joint does, how it looks."""

    name: str
    kind: str
    quantity: str
    verb: str
    example: str
    decimals: int  # of a position in a table

    def written(self, centi: float) -> str:
        """Return a position, given in hundredths, as a script writes it."""
        return f"{centi / 100:g} {self.name}"

    def speed(self, centi_per_s: float) -> str:
        """Return a speed, given in hundredths a second, as a person reads it."""
        return f"{centi_per_s / 100:g} {self.name}/s"

    def way(self, least_centi: int, most_centi: int) -> str:
        """Return the range between two positions."""
        return f"{least_centi / 100:.{self.decimals}f} .. {most_centi / 100:.{self.decimals}f} {self.name}"


UNITS = {
    "deg": JointUnit("deg", units.ANGLE, "angle", "turn", "8 deg", 1),
    "mm": JointUnit("mm", units.LENGTH, "depth", "move", "4 mm", 2),
}
