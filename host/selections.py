"""What this host has subscribed to, and how many records of each subscription it did not get.

The robot numbers the records of a slot, those included that found no room on the line. A record names the form of its
values, so that one that was on its way when a subscription changed is still read as what it is.

    selections.ask(seq, Selection(slot=0, numbers=variables.USUAL, period_ms=10, on_change=False))
    record = selections.take(payload, parts, host_ms)
    selections.missed()
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any, NamedTuple

from host.errors import BadRequest
from host.profile import Parts
from host.records import Sample, Telemetry, sample_of, telemetry_of
from host.robotclock import since
from protocol import messages, variables

STILL_MS = 1000  # a robot repeats a record on change that often
LATE_MS = 1000  # a record may come so much after a later one; older ones are those of a clock that has begun anew
USUAL_FORM = 0
FORMS_KEPT = 4  # of a slot


class Selection(NamedTuple):
    """Variables of a slot, and how often they come."""

    slot: int
    numbers: tuple[int, ...]
    period_ms: int
    on_change: bool

    @property
    def silence_ms(self) -> int:
        """Return how long nothing may come of it; 0: nothing is due at all."""
        return max(self.period_ms, STILL_MS) if self.on_change and self.period_ms else self.period_ms


def selection_of(values: dict[str, Any]) -> Selection:
    """Return what the fields of a `subscribe` ask for."""
    numbers = tuple(values["variables"]) or variables.USUAL
    return Selection(values["slot"], numbers, values["period_ms"], bool(values["on_change"]))


def numbers_of(names: Iterable[str]) -> bytes:
    """Return the numbers of variables; BadRequest names one that there is not, and what was perhaps meant."""
    found = []
    for name in names:
        number = variables.number(name)
        if number < 0:
            raise BadRequest(f"no variable {name!r}{_nearest(name)}")
        found.append(number)
    if not found:
        raise BadRequest("no variable was named: `softrig watch --list` lists them")
    return bytes(found)


class Selections:
    """The subscriptions of one session."""

    def __init__(self) -> None:
        self._slots: defaultdict[int, _Slot] = defaultdict(_Slot)

    def ask(self, seq: int, selection: Selection, robot_ms: int | None = None) -> None:
        """Note what an order of that number asks for: records of it may come before the answer.

        The robot's clock shows at least `robot_ms` now, None: not known; what was told before is of another session.
        """
        slot = self._slots[selection.slot]
        if not slot.forms:
            slot.begin(robot_ms)
        form = USUAL_FORM if selection.numbers == variables.USUAL else 1 + seq % 255
        slot.forms.pop(form, None)
        slot.forms[form] = selection
        if len(slot.forms) > FORMS_KEPT:
            del slot.forms[next(iter(slot.forms))]

    def take(self, payload: bytes, parts: Parts, host_ms: int) -> Telemetry | Sample | None:
        """Return the record of that payload, None when it came before or is of nobody's asking; ValueError: damaged."""
        row = messages.TELEMETRY.unpack(payload)
        slot = self._slots[row.slot]
        asked = slot.forms.get(row.form)
        if asked is None and row.form != USUAL_FORM:
            return None
        numbers = asked.numbers if asked else variables.USUAL
        values = variables.unpack(numbers, variables.veiled(row.values), _counts(parts))
        if not slot.counted(row.count, row.now_ms, asked.period_ms if asked and not asked.on_change else 0):
            return None
        if numbers == variables.USUAL:
            return telemetry_of(values, parts, host_ms, row.now_ms)
        return sample_of(row.slot, numbers, values, parts, host_ms, row.now_ms)

    def missed(self) -> dict[int, int]:
        """Return how many records did not come, by slot."""
        return {number: slot.missed for number, slot in sorted(self._slots.items())}


class _Slot:
    """The records of one slot, as they come."""

    def __init__(self) -> None:
        self.missed = 0
        self.forms: dict[int, Selection] = {}
        self.due: int | None = None  # number of the next record, None: whichever comes
        self._now_ms: int | None = None  # of the newest record
        self._begun_ms: int | None = None  # the robot's clock when this session first asked, or less

    def begin(self, robot_ms: int | None) -> None:
        """Count from the first record on, whatever another session was told."""
        self.missed, self.due, self._now_ms, self._begun_ms = 0, 0, None, robot_ms

    def counted(self, count: int, now_ms: int, period_ms: int) -> bool:
        """Count what is missing before a record; False when it is one that came already, or out of its order.

        One that another session was told is only told.
        """
        if self._begun_ms is not None and since(now_ms, self._begun_ms) < 0:
            return True
        gap = 0 if self.due is None else (count - self.due) & 255
        passed_ms = 0 if self._now_ms is None else since(now_ms, self._now_ms)
        if self._now_ms is not None and -LATE_MS < passed_ms <= 0 and gap > 127:
            return False
        if period_ms and passed_ms > 0:
            gap += 256 * max(0, round((passed_ms / period_ms - 1 - gap) / 256))
        self.missed += gap
        self.due, self._now_ms = (count + 1) & 255, now_ms
        return True


def _counts(parts: Parts) -> variables.Counts:
    """Return of how many of what a robot has a record tells."""
    return variables.Counts(len(parts.coils), len(parts.joints), parts.cameras, parts.loads, len(parts.cells))


def _nearest(name: str) -> str:
    near = get_close_matches(name, [variable.name for variable in variables.VARIABLES], n=1)
    return f"; did you mean {near[0]!r}?" if near else "; `softrig watch --list` lists them"
