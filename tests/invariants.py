"""What holds on every bench that any test makes, whatever the test is about; told in sentences.

No coil is on without an order, beyond its order's end or the lease, longer than `on_max_ms`, above its heat budget or
hotter than its trip; no joint has pulses without an order, beyond its order's end or the lease, outside its range or
faster than its slew limit, and none pushes on beyond the force that trips (ways.py); each with the margin stated here.
Orders are read off the line (orders.py), what the coils and joints did off the bench (witness.py). A fault that breaks
the very part that holds an invariant excuses what it must, see LATE_US.

MARGINS. A step is 5 ms, and the step that switches off spends up to 2.5 ms on its buses before it does. The robot
reckons a coil's heat with its profile's resistance and without stress, the bench from what is there: the true
temperature runs ahead of the estimate while a stretched coil transforms, most in a body that does not move.
"""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import exp, inf

from host.profile import Profile
from tests.claims import Claim
from tests.orders import Ledger
from tests.ways import STEP_US, Spell, Way, path, pushed

WITHIN_US = STEP_US + 2_500
SLOT_US = 4_000  # a pause shorter than this is the firmware measuring, no pause
TRIP_MARGIN_K = 10.0
HEAT_MARGIN = 0.05


@dataclass(frozen=True)
class Excuse:
    """What a fault makes of the invariants from its time on.

    Coils may go off so much later, and joints go limp; the one `coil` that it names, or any, may be on so long without
    an order.
    """

    late_us: int = 0
    limp_us: int = 0
    coil: str = ""
    stray_us: int = 0


LATE_US = {
    "hang": 50_000,  # the monostable's window, from the last heartbeat on
    "i2c-bit-error": 325_000,  # until a write that went astray is put right, see firmware/control.py
}
LIMP_US = {"hang": 205_000}  # pulses need no program: they go on until the watchdog resets
STRAY_US = {
    "mosfet-stuck": 155_000,  # until it is found, see tests/fault_table.py
    "i2c-bit-error": 325_000,
}


@dataclass
class Run:
    """One run of one robot as the invariants see it; times in us of the bench's clock."""

    profile: Profile
    ledger: Ledger
    spells: Sequence[Sequence[Spell]]  # of each channel: from when until when it was on
    peaks_degc: Sequence[float]
    energy_j: Sequence[tuple[int, Sequence[float]]]  # of each channel up to that time
    excuses: Sequence[tuple[int, Excuse]] = field(default_factory=tuple)  # each from its time on
    ways: Sequence[Way] = ()  # of each joint
    forces: Sequence[tuple[int, float]] = ()  # on the load cell [N], by the time


def broken(run: Run) -> Iterator[str]:
    """Yield a sentence for each invariant that did not hold."""
    coils = len(run.profile.coil_labels)
    for channel, label in enumerate(run.profile.labels):
        ordered = (*_orders(run, channel), *_lease(run, channel))
        own = (*_length(run, channel), *_heat(run, channel)) if channel < coils else _way(run, channel)
        for what in (*ordered, *own):
            yield f"{'coil' if channel < coils else 'joint'} {label} was {what}"


def _orders(run: Run, channel: int) -> Iterator[str]:
    claims = sorted((claim for claim in run.ledger.claims if claim.mask >> channel & 1), key=_begin)
    begins = [claim.from_us for claim in claims]
    for spell in run.spells[channel]:
        near = claims[: bisect_left(begins, spell[1])]
        left = [spell]
        for claim in near:
            if not claim.limited:
                left = list(_without(left, claim.from_us, claim.until_us + _late(run, channel, claim.until_us)))
        for begin, end in left:
            over_us = _charged(run, channel, [claim for claim in near if claim.limited], begin, end)
            if over_us > _stray(run, channel, end):
                yield f"on for {over_us / 1e3:.1f} ms that no order allows, up to {end / 1e6:.4f} s"


def _charged(run: Run, channel: int, claims: Sequence[Claim], begin: int, end: int) -> float:
    """Take a stretch of time from the budgets of claims; return what none of them has left."""
    due_us: float = end - begin
    late_us = _late(run, channel, end)
    for claim in claims:
        left_us = claim.budget_us.get(channel, 0.0)
        if left_us and claim.from_us <= begin and end <= claim.until_us + _late(run, channel, claim.until_us):
            due_us, late_us = due_us - late_us, 0  # an order may end late, once
            paid_us = min(left_us, max(0.0, due_us))
            claim.budget_us[channel] = left_us - paid_us
            due_us -= paid_us
    return due_us


def _lease(run: Run, channel: int) -> Iterator[str]:
    alive = [*run.ledger.alive, (inf, inf)]
    times = [time_us for time_us, _ in alive]
    for begin, end in run.spells[channel]:
        first = max(0, bisect_left(times, begin) - 1)
        for (_, until), (then, _) in zip(alive[first:], alive[first + 1 :], strict=False):
            if until >= end:
                break
            over_us = min(end, then) - max(begin, until + _late(run, channel, until))
            if over_us > 0:
                yield f"on for {over_us / 1e3:.1f} ms beyond the lease, that ended at {until / 1e6:.4f} s"


def _length(run: Run, channel: int) -> Iterator[str]:
    for begin, end in run.spells[channel]:
        limit_us = 1000 * run.profile.coil.on_max_ms + _late(run, channel, end)
        if end - begin > limit_us:
            yield f"on for {(end - begin) / 1e3:.1f} ms without a pause, up to {end / 1e6:.4f} s"


def _heat(run: Run, channel: int) -> Iterator[str]:
    coil, peak = run.profile.coil, run.peaks_degc[channel]
    if peak > coil.trip_degc + TRIP_MARGIN_K:
        yield f"at {peak:.1f} C, its trip is {coil.trip_degc} C"
    most_mj = most_heat_mj(run, channel)
    if most_mj > coil.heat_budget_mj * (1.0 + HEAT_MARGIN):
        yield f"given {most_mj:.0f} mJ, its heat budget is {coil.heat_budget_mj} mJ"


def _way(run: Run, channel: int) -> Iterator[str]:
    way = run.ways[channel - len(run.profile.coil_labels)]
    yield from path(way, run.profile.servo)
    if run.profile.load:
        yield from pushed(way, run.forces, run.profile.load, lambda at_us: _late(run, channel, at_us))


def excuse_of(fault: str) -> Excuse:
    """Return what a fault excuses."""
    name, _, argument = fault.partition(":")
    late_us = LATE_US.get(name, 0)
    coil = "" if argument.isdigit() else argument
    return Excuse(late_us, LIMP_US.get(name, late_us), coil, STRAY_US.get(name, 0))


def most_heat_mj(run: Run, channel: int) -> float:
    """Return the most that the true energy of a coil, less its leak, ever came to."""
    heat = most = 0.0
    before_us, before_j = 0, 0.0
    for time_us, energies in run.energy_j:
        passed_s, leak_s = (time_us - before_us) * 1e-6, run.profile.coil.heat_leak_ms * 1e-3
        given_j = energies[channel] - before_j
        share = exp(-passed_s / leak_s)
        heat = heat * share + (given_j * leak_s / passed_s * (1.0 - share) if passed_s else given_j)
        most = max(most, heat)
        before_us, before_j = time_us, energies[channel]
    return 1e3 * most


def spells_of(history: Sequence[tuple[int, float]], now_us: int) -> list[Spell]:
    """Return from when until when a coil was on, pauses for a measurement passed over."""
    spells: list[Spell] = []
    for (begin, duty), (end, _) in pairwise([*history, (now_us, 0.0)]):
        if not duty:
            continue
        if spells and begin - spells[-1][1] < SLOT_US:
            spells[-1] = (spells[-1][0], end)
        else:
            spells.append((begin, end))
    return spells


def _late(run: Run, channel: int, at_us: float) -> int:
    """Return how much later than its end a coil may go off at that time, or a joint go limp."""
    is_coil = channel < len(run.profile.coil_labels)
    excused = (each.late_us if is_coil else each.limp_us for since_us, each in run.excuses if since_us <= at_us)
    return WITHIN_US + max(excused, default=0)


def _stray(run: Run, channel: int, at_us: int) -> int:
    """Return for how long a coil may be on without an order at that time."""
    label = run.profile.labels[channel]
    return max(
        (excuse.stray_us for since, excuse in run.excuses if since <= at_us and excuse.coil in ("", label)), default=0
    )


def _without(spells: list[Spell], begin: float, end: float) -> Iterator[Spell]:
    for spell in spells:
        if spell[0] < min(spell[1], begin):
            yield spell[0], int(min(spell[1], begin))
        if max(spell[0], end) < spell[1]:
            yield int(max(spell[0], end)), spell[1]


def _begin(claim: Claim) -> int:
    return claim.from_us
