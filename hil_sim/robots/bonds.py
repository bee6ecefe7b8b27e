"""What numbers and choices of a robot file must be to each other, each by itself allowed.

for name, what in odd(values, choices): ...

`name` is the section.key of what is to blame; numbers that are missing are in no bond.
"""

from collections.abc import Iterator, Mapping

INSIDE = ("hub.radius_mm", "hub.attach_mm", "core.radius_mm", "core.attach_mm")  # the shell
RISING = tuple(
    f"coils.{end}_degc" for end in ("martensite_finish", "martensite_start", "austenite_start", "austenite_finish")
)
NEEDS = (  # a choice, the words of it that need one of some numbers, and why
    ("fingers.contact", ("stick", "coulomb"), ("object.width_mm",), "two tips on one line are over-constrained"),
    ("fingers.motion", ("dynamic",), ("object.mass_g",), "what has no mass is moved by no dynamics"),
    ("fingers.motion", ("dynamic",), ("object.width_mm", "object.height_mm"), "without extent it has no inertia"),
)
PAIRS = (
    ("material.youngs_modulus_kpa", "material.viscosity_kpa_s"),
    ("material.youngs_modulus_2_kpa", "material.viscosity_2_kpa_s"),
)  # springs with the dashpots in series
Values = Mapping[str, float]
Odd = Iterator[tuple[str, str]]


def odd(values: Values, choices: Mapping[str, str]) -> Odd:
    """Yield section.key and what is wrong with it beside the others."""
    yield from _inside(values)
    yield from _rising(values)
    yield from _needs(values, choices)
    yield from _pairs(values)


def _inside(values: Values) -> Odd:
    shell_mm = values.get("shell.radius_mm")
    for name in INSIDE:
        if shell_mm is not None and name in values and values[name] >= shell_mm:
            yield name, f"{name} is {values[name]:g}, it must be below shell.radius_mm, {shell_mm:g}"


def _rising(values: Values) -> Odd:
    degc = [values[name] for name in RISING if name in values]
    if len(degc) == len(RISING) and not degc[0] < degc[1] <= degc[2] < degc[3]:
        yield RISING[0], f"the temperatures must rise: {', '.join(RISING)}"


def _needs(values: Values, choices: Mapping[str, str]) -> Odd:
    for name, words, needed, why in NEEDS:
        if choices.get(name) in words and all(values.get(key, 1.0) <= 0.0 for key in needed):
            yield name, f"needs {' or '.join(needed)} above 0: {why}"


def _pairs(values: Values) -> Odd:
    """Yield springs without the dashpot that is in series with them, and the other way round."""
    for pair in PAIRS:
        none, other = sorted(pair, key=lambda name: values.get(name, 0.0))
        if values.get(none, 0.0) == 0.0 < values.get(other, 0.0):
            what = f"{other} is {values[other]:g} and {none} 0: a branch has both, or neither"
            yield none if none in values else other, what
