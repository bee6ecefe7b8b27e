"""Quantities of the gait language: exact numbers with a kind, and the units they are written in.

Base units are the robot's own integers: ms, permille, 0.1 C, mA, mV, mJ, 0.01 deg, 0.01 mm, mN, Pa, mohm.
Arithmetic is exact (fractions) and is rounded once, when a value becomes an order.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

LARGEST = 10**12


class Unit(NamedTuple):
    """A unit: the kind of quantity it measures and its size in that kind's base unit."""

    kind: str
    factor: int


NUMBER = "number"
TIME = "time"
SHARE = "share"
TEMPERATURE = "temperature"
CURRENT = "current"
VOLTAGE = "voltage"
ENERGY = "energy"
ANGLE = "angle"
LENGTH = "length"
FORCE = "force"
PRESSURE = "pressure"
RESISTANCE = "resistance"

UNITS = {
    "ms": Unit(TIME, 1),
    "s": Unit(TIME, 1000),
    "%": Unit(SHARE, 10),
    "C": Unit(TEMPERATURE, 10),
    "mA": Unit(CURRENT, 1),
    "mV": Unit(VOLTAGE, 1),
    "mJ": Unit(ENERGY, 1),
    "deg": Unit(ANGLE, 100),
    "mm": Unit(LENGTH, 100),
    "N": Unit(FORCE, 1000),
    "mN": Unit(FORCE, 1),
    "kPa": Unit(PRESSURE, 1000),
    "Pa": Unit(PRESSURE, 1),
    "ohm": Unit(RESISTANCE, 1000),
    "mohm": Unit(RESISTANCE, 1),
}
OF_KIND = {
    kind: [name for name, unit in UNITS.items() if unit.kind == kind] for kind in {u.kind for u in UNITS.values()}
}
# What people write for a unit when they do not know ours.
ALIASES = {
    "percent": "%", "pct": "%", "permille": "%", "sec": "s", "secs": "s", "second": "s", "seconds": "s",
    "msec": "ms", "millis": "ms", "milliseconds": "ms", "min": "s", "us": "ms", "degC": "C", "c": "C",
    "celsius": "C", "K": "C", "F": "C", "A": "mA", "ma": "mA", "V": "mV", "mv": "mV", "S": "s", "MS": "ms", "Ms": "ms",
    "degree": "deg", "degrees": "deg", "rad": "deg", "J": "mJ", "mj": "mJ",
    "millimetre": "mm", "millimetres": "mm", "millimeter": "mm", "millimeters": "mm", "um": "mm", "cm": "mm", "m": "mm",
    "n": "N", "newton": "N", "newtons": "N", "kN": "N", "mn": "mN",
    "kpa": "kPa", "pa": "Pa", "MPa": "kPa", "hPa": "kPa", "mbar": "kPa", "bar": "kPa",
    "Ohm": "ohm", "ohms": "ohm", "Ohms": "ohm", "mOhm": "mohm", "kohm": "ohm",
}  # fmt: skip


class UnitError(ValueError):
    """Two quantities that cannot be calculated with each other; `code` is the row of the table of mistakes."""

    def __init__(self, code: str, text: str) -> None:
        super().__init__(text)
        self.code = code


@dataclass(frozen=True, slots=True)
class Quantity:
    """A value in the base unit of its kind."""

    value: Fraction
    kind: str

    def __str__(self) -> str:
        if self.kind == NUMBER:
            return decimal(self.value)
        unit = "s" if self.kind == TIME and self.value >= 1000 else OF_KIND[self.kind][0]
        return f"{decimal(self.value / UNITS[unit].factor)} {unit}"

    def __neg__(self) -> Quantity:
        return Quantity(-self.value, self.kind)

    def combine(self, operator: str, other: Quantity) -> Quantity:
        """Return `self operator other`, or raise UnitError."""
        if operator in "+-":
            return self._sum(-other if operator == "-" else other, operator)
        return _bounded(self._times(other) if operator == "*" else self._over(other))

    def rounded(self) -> int:
        """Return the nearest whole number of base units."""
        return round(self.value)

    def _sum(self, other: Quantity, operator: str) -> Quantity:
        if self.kind != other.kind:
            raise UnitError("E123", f"{called(self.kind)} `{operator}` {called(other.kind)} makes no sense")
        return _bounded(Quantity(self.value + other.value, self.kind))

    def _times(self, other: Quantity) -> Quantity:
        if NUMBER not in (self.kind, other.kind):
            raise UnitError("E123", f"{called(self.kind)} times {called(other.kind)} makes no sense")
        return Quantity(self.value * other.value, other.kind if self.kind == NUMBER else self.kind)

    def _over(self, other: Quantity) -> Quantity:
        if other.value == 0:
            raise UnitError("E124", "division by zero")
        if other.kind not in (NUMBER, self.kind):
            raise UnitError("E123", f"{called(self.kind)} over {called(other.kind)} makes no sense")
        return Quantity(self.value / other.value, NUMBER if self.kind == other.kind else self.kind)


def called(kind: str) -> str:
    """Return the kind with its article."""
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def decimal(value: Fraction) -> str:
    """Return the value with at most three decimals and no needless zero."""
    text = f"{float(value):.3f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _bounded(quantity: Quantity) -> Quantity:
    if abs(quantity.value) > LARGEST:
        raise UnitError("E125", f"the value is beyond {LARGEST:.0e}")
    if quantity.value.denominator > LARGEST:
        return Quantity(quantity.value.limit_denominator(LARGEST), quantity.kind)
    return quantity
