"""What holds of every joint's way: within its range, no faster than its slew limit, not on beyond the force that trips.

Pulses are taken over at the end of a period: two of them may come with one step between, or with three.
"""

from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from host.limits import LoadLimits, ServoLimits

STEP_US = 5_000
MARGIN = 0.05  # rounding of the pulses' width, in degrees or millimetres
PUSHED_US = 100_000
PUSHED_MARGIN_N = 0.25

Spell = tuple[int, int]


@dataclass
class Way:
    """Where a joint was told to go, in its unit; times in us of the bench's clock."""

    told: Sequence[tuple[int, float]]  # from when on, and whereto
    found: dict[int, float]  # where it stood when it began to be driven, by the time
    spells: Sequence[Spell]  # from when until when it was driven


def path(way: Way, servo: ServoLimits) -> Iterator[str]:
    """Yield where a joint was told a position that it may not have, or one too far from the last."""
    low, high, speed = servo.least_centi / 100, servo.most_centi / 100, servo.slew_centi_per_s / 100
    for at_us, here in way.told:
        if not low - MARGIN <= here <= high + MARGIN:
            yield f"told {here:.2f} {servo.unit} at {at_us / 1e6:.4f} s, its range is {low:g} to {high:g}"
    for (before_us, before), (at_us, here) in pairwise([(0, 0.0), *way.told]):
        before_us, before = (at_us, way.found[at_us]) if at_us in way.found else (before_us, before)
        most = speed * (at_us - before_us + 2 * STEP_US) * 1e-6
        if abs(here - before) > most + MARGIN:
            off = f"{abs(here - before):.2f} {servo.unit}"
            yield f"told to move by {off} at {at_us / 1e6:.4f} s, at most {most:.2f}"


def pushed(
    way: Way, forces: Sequence[tuple[int, float]], load: LoadLimits, late_us: Callable[[int], int]
) -> Iterator[str]:
    """Yield where a joint was driven for long at more than the force that trips, and not told to go back.

    `forces` are what truly acts on the load cell [N], at times that follow each other closely.
    """
    most = load.trip_mn / 1000 + PUSHED_MARGIN_N
    backs = [at_us for (_, before), (at_us, here) in pairwise(way.told) if here < before and at_us not in way.found]
    over_us = None
    for at_us, force in forces:
        if abs(force) <= most:
            over_us = None
            continue
        over_us = at_us if over_us is None else over_us
        for begin, end in way.spells:
            if begin <= at_us < end:
                back_us = backs[bisect_right(backs, at_us) - 1] if backs and backs[0] <= at_us else 0
                over_ms = (at_us - max(over_us, begin, back_us) - late_us(at_us)) / 1000
                if over_ms > PUSHED_US / 1000:
                    yield f"driven for {over_ms:.1f} ms at {force:.2f} N, up to {at_us / 1e6:.4f} s"
                    return
