"""The C header: the prose and the codec of templates/softrig.h, with constants, structs and functions for each message.

A field with a range of its own is held against it when it is packed. What is left of a payload is not copied: it lies
where the payload lies.
"""

from pathlib import Path

from docs.definitions import Place, Row, enums, rows
from protocol import canbus, flight, frames, messages

TEMPLATE = Path(__file__).parent / "templates" / "softrig.h"
C_TYPES = {
    "B": "uint8_t", "b": "int8_t", "H": "uint16_t", "h": "int16_t", "I": "uint32_t", "i": "int32_t",
    "s": "softrig_bytes",
}  # fmt: skip
PRIORITIES = ("SYNCHRONISE", "ORDERS", "ANSWERS", "GREETINGS", "TELEMETRY")
CONSTANTS = (
    "VERSION", "RELIABLE", "NODE", "SEALED", "RESERVED", "HEAD_BYTES", "TAG_BYTES", "CRC_BYTES", "BODY_MIN", "BODY_MAX",
    "PAYLOAD_MAX", "FRAME_MAX", "GREETINGS_BELOW", "OPEN_FROM", "OPEN_BELOW",
)  # fmt: skip


def text() -> str:
    """Return the header."""
    numbers = {name: str(getattr(frames, name)) for name in CONSTANTS}
    filled = {
        **numbers,
        "WINDOW": str(flight.WINDOW),
        "AT_ONCE": str(messages.AT_ONCE),
        "AT_SYNC": str(messages.AT_SYNC),
        "STOP": "{" + ", ".join(f"0x{byte:02X}" for byte in frames.STOP) + "}",
        "STOP_BYTES": str(len(frames.STOP)),
        "CAN_ALL": str(canbus.ALL),
        "CAN_HOST": str(canbus.HOST),
        **{f"CAN_{name}": str(getattr(canbus, name)) for name in PRIORITIES},
        "SHA256_K": _words(_round_constants()),
        "ENUMS": "\n".join([_kinds(), *(_enum(name, names) for name, names in enums().items())]),
        "MESSAGES": "\n".join(message(row) for row in rows()),
    }
    page = TEMPLATE.read_text(encoding="utf-8")
    for name, value in filled.items():
        page = page.replace(f"@{name}@", value)
    return page


def message(row: Row) -> str:
    """Return the struct of a message with the functions that pack and unpack it; nothing for one without fields."""
    head = f"/* 0x{row.number:02X} {row.name}: {_comment(row.words)} */\n"
    if not row.fields:
        return f"{head}/* It has no payload. */\n"
    struct = "".join(
        f"    {C_TYPES[place.letter]} {place.name}; /* {_comment(_words_of(place))} */\n" for place in row.fields
    )
    name = f"softrig_{row.name}"
    return (
        f"{head}#define SOFTRIG_{row.name.upper()}_BYTES {row.size}u{' /* at least */' if row.is_open else ''}\n"
        f"typedef struct {name} {{\n{struct}}} {name};\n\n{_pack(row)}\n{_unpack(row)}"
    )


def _pack(row: Row) -> str:
    checks = [f"in->{place.name} {sign} {_literal(limit)}" for place in row.fields for sign, limit in _bounds(place)]
    last = row.fields[-1].name
    size = f"SOFTRIG_{row.name.upper()}_BYTES"
    room = (
        f"room < {size}"
        if not row.is_open
        else f"in->{last}.size > SOFTRIG_PAYLOAD_MAX - {size} || room < {size} + in->{last}.size"
    )
    lines = [f"    if ({' || '.join([room, *checks])})", "        return -1;"]
    lines += [f"    {_put(place)}" for place in row.fields if place.size]
    if row.is_open:
        lines += [
            f"    if (in->{last}.size)",
            f"        memcpy({_at('out', row.size)}, in->{last}.at, in->{last}.size);",
        ]
        lines += [f"    return (int)({size} + in->{last}.size);"]
    else:
        lines += [f"    return (int){size};"]
    head = f"static inline int softrig_pack_{row.name}(const softrig_{row.name} *in, uint8_t *out, size_t room)"
    return "\n".join([head, "{", *lines, "}", ""])


def _unpack(row: Row) -> str:
    size = f"SOFTRIG_{row.name.upper()}_BYTES"
    lines = [
        f"    if (payload.size {'<' if row.is_open else '!='} {size})" if row.size else "",
        "        return -1;" if row.size else "",
    ]
    lines += [f"    {_get(place)}" for place in row.fields if place.size]
    if row.is_open:
        last = row.fields[-1].name
        lines += [
            f"    out->{last}.at = {_at('payload.at', row.size)};",
            f"    out->{last}.size = payload.size - {size};",
        ]
    lines.append("    return 0;")
    head = f"static inline int softrig_unpack_{row.name}(softrig_{row.name} *out, softrig_bytes payload)"
    return "\n".join([head, "{", *filter(None, lines), "}", ""])


def _bounds(place: Place) -> list[tuple[str, int]]:
    """Return the comparisons that say a value is outside its range, where its type does not rule that out."""
    if not place.limit:
        return []
    kind = Place(place.name, place.letter, 0, "", None)
    sides = [("<", place.low, kind.low), (">", place.high, kind.high)]
    return [(sign, limit) for sign, limit, bound in sides if limit != bound]


def _put(place: Place) -> str:
    value = f"in->{place.name}"
    unsigned = value if place.letter.isupper() else f"(u{C_TYPES[place.letter]}){value}"
    if place.size == 1:
        return f"out[{place.offset}] = {unsigned};"
    return f"softrig_put{8 * place.size}({_at('out', place.offset)}, {unsigned});"


def _get(place: Place) -> str:
    at = _at("payload.at", place.offset)
    value = f"payload.at[{place.offset}]" if place.size == 1 else f"softrig_get{8 * place.size}({at})"
    return f"out->{place.name} = {value if place.letter.isupper() else f'softrig_signed{8 * place.size}({value})'};"


def _at(name: str, offset: int) -> str:
    return f"{name} + {offset}" if offset else name


def _literal(number: int) -> str:
    return f"{number}u" if number > 0x7FFF else str(number)


def _words_of(place: Place) -> str:
    if place.limit:
        return f"{place.words} {place.low} to {place.high}."
    inner = ", ".join(f"{part.name} {part.type}" for part in place.parts)
    return (
        f"{place.words} SOFTRIG_{place.enum}_..."
        if place.enum
        else f"{place.words} Each: {inner}."
        if inner
        else place.words
    )


def _comment(words: str) -> str:
    return words.replace("`", "")


def _kinds() -> str:
    rows_of = {row.number: row.name for row in rows()}
    return _enum("KIND", rows_of, "0x{:02X}")


def _enum(name: str, names: dict[int, str], form: str = "{}") -> str:
    lines = [
        f"    SOFTRIG_{name}_{word.upper().replace('-', '_')} = {form.format(number)}" for number, word in names.items()
    ]
    return "enum {\n" + ",\n".join(lines) + "\n};\n"


def _words(numbers: list[int]) -> str:
    rows_of = [numbers[at : at + 6] for at in range(0, len(numbers), 6)]
    return ",\n".join("        " + ", ".join(f"0x{number:08X}u" for number in row) for row in rows_of)


def _round_constants() -> list[int]:
    """Return SHA-256's 64 words: the first 32 bits of the fractional parts of the cube roots of the first primes."""
    primes = [n for n in range(2, 312) if all(n % d for d in range(2, int(n**0.5) + 1))]
    return [_cube_root(prime << 96) & 0xFFFFFFFF for prime in primes]


def _cube_root(number: int) -> int:
    low, high = 0, 1 << 48
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if middle**3 <= number else (low, middle - 1)
    return low
