"""The table of messages as every output of it needs it: words, offsets, units, ranges and enums beside each field.

Numbers, names and types are those of the code; words are those of the comments beside the fields in
protocol/messages.py, see meanings.py. What stands in brackets at their end is for machines: `[0..1000]` a range,
`[STATES]` an enum, `[* mohm:H used:B]` what `rest` holds again and again.

    fire = {row.name: row for row in rows()}["fire"]
    fire.fields[1].unit, fire.fields[1].high
"""

import re
from dataclasses import dataclass
from functools import cached_property

from docs import meanings
from protocol import causes, frames, messages
from protocol.variables import VARIABLES

TYPES = {
    "B": ("u8", 1), "b": ("i8", 1), "H": ("u16", 2), "h": ("i16", 2), "I": ("u32", 4), "i": ("i32", 4),
    "s": ("rest", 0),
}  # fmt: skip
UNITS = {
    "us": ("us", 1), "ms": ("ms", 1), "ns": ("ns", 1), "mv": ("mV", 1), "ma": ("mA", 1), "mohm": ("mohm", 1),
    "permille": ("permille", 1), "percent": ("%", 1), "degc": ("degC", 1), "decidegc": ("degC", 0.1),
    "decideg": ("deg", 0.1), "centideg": ("deg", 0.01), "centi": ("deg or mm", 0.01), "bytes": ("bytes", 1),
    "mj": ("mJ", 1), "mn": ("mN", 1), "pa": ("Pa", 1),
}  # fmt: skip
LIMIT = re.compile(r" ?\[(?:(-?\d+)\.\.(-?\d+)|([A-Z_]+)|\*((?: \w+:\w)+))\]$")
ANSWERS = ("identity", "dictionary_page", "stopped", "nak")  # of the unseeded kinds, those that come from the robot
BOTH_WAYS = ("alive",)
FROM_THE_ROBOT = 0x40


@dataclass(frozen=True)
class Place:
    """One field: where it stands, what it holds, what it means."""

    name: str
    letter: str
    offset: int
    words: str
    limit: tuple[int, int] | None  # narrower than the type's, or None
    enum: str = ""  # whose names its values have
    parts: tuple["Place", ...] = ()  # of the record that `rest` holds again and again

    @property
    def type(self) -> str:
        """Return its type in words, `rest` for what is left of the payload."""
        return TYPES[self.letter[0]][0]

    @property
    def size(self) -> int:
        """Return its bytes, 0 for `rest`."""
        return TYPES[self.letter[0]][1]

    @property
    def unit(self) -> str:
        """Return the unit that ends its name, or "": the physical value is the field's times `scale`."""
        return UNITS.get(self.name.rpartition("_")[2], ("", 1))[0]

    @property
    def scale(self) -> float:
        """Return the factor from the field's value to its unit."""
        return UNITS.get(self.name.rpartition("_")[2], ("", 1))[1]

    @property
    def signed(self) -> bool:
        """Return whether it is a signed number."""
        return self.letter[0] in "bhi"

    @property
    def low(self) -> int:
        """Return the least value that it may have."""
        if self.limit:
            return self.limit[0]
        return -(1 << 8 * self.size - 1) if self.signed else 0

    @property
    def high(self) -> int:
        """Return the greatest value that it may have."""
        return self.limit[1] if self.limit else (1 << 8 * self.size - self.signed) - 1

    @property
    def definition(self) -> str:
        """Return it as the dictionary prints it: `duty_permille:H[0..1000]`."""
        return f"{self.name}:{self.letter}{self._bounds()}"

    def _bounds(self) -> str:
        if self.limit:
            return f"[{self.limit[0]}..{self.limit[1]}]"
        inner = self.enum or ",".join(part.definition for part in self.parts)
        return f"[{inner}]" if inner else ""


@dataclass(frozen=True)
class Row:
    """One message."""

    number: int
    name: str
    words: str
    fields: tuple[Place, ...]

    @property
    def ways(self) -> str:
        """Return `to`, `from` or `both`: which way it goes, seen from the robot."""
        if self.name in BOTH_WAYS:
            return "both"
        answers = self.name in ANSWERS if self.number < frames.GREETINGS_BELOW else self.number >= FROM_THE_ROBOT
        return "from" if answers else "to"

    @property
    def size(self) -> int:
        """Return the bytes of its payload without what is left of it."""
        return sum(place.size for place in self.fields)

    @cached_property
    def is_open(self) -> bool:
        """Return whether its last field takes the rest of the payload."""
        return bool(self.fields) and self.fields[-1].letter == "s"

    @property
    def definition(self) -> str:
        """Return it as the dictionary prints it: `20 fire coils:I duty_permille:H[0..1000] hold_ms:H`."""
        return " ".join([str(self.number), self.name, *(place.definition for place in self.fields)])


def rows() -> list[Row]:
    """Return every message, in the order of the table; ValueError names a comment that does not fit its field."""
    words, names = meanings.read(), enums()
    found = []
    for message in messages.MESSAGES:
        fields, offset = [], 0
        for field in message.fields:
            fields.append(_place(f"{message.name}.{field.name}", field, offset, words, names))
            offset += fields[-1].size
        found.append(Row(message.number, message.name, words[message.name], tuple(fields)))
    return found


def variables() -> list[Place]:
    """Return every variable of telemetry, at its number; behind its letter stands what it has several values for."""
    words, names = meanings.read(), enums()
    return [_place(f"var.{row.name}", row, 0, words, names) for row in VARIABLES]


def enums() -> dict[str, dict[int, str]]:
    """Return the names of the values of every enum: tuples of words in messages.py, and the codes."""
    found = {}
    for name, words in vars(messages).items():
        if name.isupper() and isinstance(words, tuple) and words and all(isinstance(word, str) for word in words):
            found[name] = {number: word.replace(" ", "_") for number, word in enumerate(words) if word}
    return {**found, "CODES": {row.number: row.name for row in causes.CODES}}


def _place(name: str, field: messages.Field, offset: int, words: dict[str, str], names: dict[str, object]) -> Place:
    text = words[name]
    found = LIMIT.search(text)
    low, high, enum, record = found.groups() if found else (None,) * 4
    limit = None if low is None else (int(low), int(high))
    place = Place(field.name, field.letter, offset, LIMIT.sub("", text), limit, enum or "", _parts(record or ""))
    if enum and enum not in names:
        raise ValueError(f"{name}: there is no enum {enum}")
    kind = Place(field.name, field.letter, offset, "", None)
    if limit and not kind.low <= limit[0] <= limit[1] <= kind.high:
        raise ValueError(f"{name}: {limit[0]}..{limit[1]} does not fit a {place.type}")
    return place


def _parts(record: str) -> tuple[Place, ...]:
    parts, offset = [], 0
    for word in record.split():
        name, letter = word.split(":")
        parts.append(Place(name, letter, offset, "", None))
        offset += parts[-1].size
    return tuple(parts)
