"""Programs: the op-codes that a host compiles and the robot's sequencer runs.

A program is a 16-byte header and its code. Each op is one byte followed by little-endian arguments; all times are
bounded, so a program always ends. The robot verifies the whole before it runs any of it.

    code = fire(0b1, 1000, 700) + delay(700) + halt()
    verify.check_code(code, channels=8, bytes_max=4096)
"""

from binascii import crc32
from collections import namedtuple

HALT, FIRE, RAMP, DELAY, REPEAT, NEXT, WAIT, GUARD, STEP, OFF, AIM, AIMED = 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11
MOVE, ORIENT, PRESS, LABEL, NOTE = 12, 13, 14, 15, 16
NAMES = (
    "halt", "fire", "ramp", "delay", "repeat", "next", "wait", "guard", "step", "off", "aim", "aimed", "move", "orient",
    "press", "label", "note",
)  # fmt: skip
SIZES = (1, 11, 13, 5, 3, 1, 14, 9, 3, 5, 11, 10, 9, 5, 9, 2, 3)

# Bytes of each argument, below 0 where it is signed, of the ops that hold nothing but numbers.
ARGUMENTS = {
    FIRE: (4, 2, 2, 2), RAMP: (4, 2, 2, 2, 2), DELAY: (4,), REPEAT: (2,), STEP: (2,), OFF: (4,),
    AIMED: (1, 2, 2, 2, 2), MOVE: (4, -2, 2), ORIENT: (-2, 2),
    PRESS: (2, 2, 4), LABEL: (1,), NOTE: (2,),
}  # fmt: skip

TEMPERATURE, CURRENT, VOLTAGE, BOARD, HEAT, ROLL, PITCH, DOWN = 1, 2, 3, 4, 5, 6, 7, 8  # sources of a condition
POSITION, JOINT_CURRENT, ORIENTATION, FORCE, PRESSURE, RESISTANCE, MARTENSITE, TIME = 9, 10, 11, 12, 13, 14, 15, 16
OF_COILS = (TEMPERATURE, HEAT, DOWN, RESISTANCE, MARTENSITE)  # those that ask about the coils of the mask
OF_JOINTS = (POSITION, JOINT_CURRENT)  # and about the joints of the mask
OF_CELLS = (PRESSURE,)  # and about the force cells of the mask, in the order of the profile
OF_ATTITUDE = (ROLL, PITCH, DOWN)
ANY, ALL, CHOSEN = 0, 1, 2  # CHOSEN: the mask is the number of the place that holds an aimed coil
BELOW, ABOVE = 0, 1
IS_NOT, IS = 0, 1  # how DOWN compares
ABORT, CONTINUE, JUMP = 0, 1, 2  # what a wait does when its time is over; JUMP + n: goes on at label n

FORMAT = 2
HEADER_BYTES = 16
OUTLIVES_HOST = 1  # header flag: keeps running when the lease runs out
STREAMED = 2  # header flag: the code comes while it runs; it has no length and no loops
CATCHES = 4  # header flag of a streamed code: an ON_FAULT will come
DEPTH_MAX = 8
GUARDS_MAX = 8
AIMS_MAX = 4  # places for coils that the robot chose
CIRCLE_MAX = 8  # coils of a circle
NO_COIL = 255  # fills a circle that has fewer
KEEP = 0x8000  # bit of a cut-off: the coil is kept near that temperature instead of ended
TIME_MAX_MS = (1 << 30) - 1  # of a delay, a time-out, a condition
LABELS_MAX = 8
ON_FAULT = 255  # label of what runs when the program is aborted; it stands behind a halt

Header = namedtuple("Header", ("flags", "robot_crc", "length", "crc"))
Condition = namedtuple("Condition", ("source", "quantifier", "compare", "value", "mask"))


class BadProgram(ValueError):
    """A header or code that no robot may run; `at` is the offset of the op."""

    def __init__(self, text: str, at: int = 0) -> None:
        super().__init__(text)
        self.at = at


def fire(mask: int, duty_permille: int, time_ms: int, cutoff_decidegc: int = 0) -> bytes:
    """Heat these coils for that long, or until the estimate reaches the cut-off (0: none, see KEEP); does not wait."""
    return _op(FIRE, (mask, 4), (duty_permille, 2), (time_ms, 2), (cutoff_decidegc, 2))


def ramp(mask: int, duty_permille: int, time_ms: int, cutoff_decidegc: int, ramp_ms: int) -> bytes:
    """As `fire`, but the duty rises from 0 to its value within `ramp_ms`."""
    return _op(RAMP, (mask, 4), (duty_permille, 2), (time_ms, 2), (cutoff_decidegc, 2), (ramp_ms, 2))


def delay(time_ms: int) -> bytes:
    """Go on after that long."""
    return _op(DELAY, (time_ms, 4))


def repeat(count: int) -> bytes:
    """Begin a body that runs `count` times, up to the matching `next`."""
    return _op(REPEAT, (count, 2))


def next_() -> bytes:
    """End the body of the innermost `repeat`."""
    return _op(NEXT)


def wait(condition: Condition, timeout_ms: int, otherwise: int) -> bytes:
    """Go on when the condition holds; after the time-out ABORT the program, CONTINUE, or go on at label n: JUMP + n."""
    return _op(WAIT) + _condition(condition) + timeout_ms.to_bytes(4, "little") + bytes((otherwise,))


def guard(condition: Condition) -> bytes:
    """From here on, trip as soon as the condition holds."""
    return _op(GUARD) + _condition(condition)


def step(number: int) -> bytes:
    """Name the step that begins here, for events and reports."""
    return _op(STEP, (number, 2))


def off(mask: int) -> bytes:
    """Switch these coils off."""
    return _op(OFF, (mask, 4))


def aim(place: int, ahead: int, circle: list) -> bytes:
    """Choose the coil that stands `ahead` places after the one nearest to down in `circle`, and keep it in `place`."""
    rest = [NO_COIL] * (CIRCLE_MAX - len(circle))
    return _op(AIM, (place, 1), (ahead % len(circle), 1)) + bytes(circle + rest)


def aimed(place: int, duty_permille: int, time_ms: int, cutoff_decidegc: int = 0, ramp_ms: int = 0) -> bytes:
    """As `ramp`, for the coil that `aim` chose and kept in `place`."""
    return _op(AIMED, (place, 1), (duty_permille, 2), (time_ms, 2), (cutoff_decidegc, 2), (ramp_ms, 2))


def move(mask: int, target_centi: int, over_ms: int) -> bytes:
    """Bring these joints to a position within that time and hold them there; does not wait."""
    return _op(MOVE, (mask, 4), (target_centi & 0xFFFF, 2), (over_ms, 2))


def orient(target_centideg: int, time_ms: int) -> bytes:
    """Regulate the angle of the gripped object for that time, then hold; does not wait."""
    return _op(ORIENT, (target_centideg & 0xFFFF, 2), (time_ms, 2))


def press(target_mn: int, over_ms: int, time_ms: int) -> bytes:
    """Regulate the force of the press, which reaches its target within `over_ms`, for that time; does not wait."""
    return _op(PRESS, (target_mn, 2), (over_ms, 2), (time_ms, 4))


def label(number: int) -> bytes:
    """Mark a place that waits further up may go on at, or ON_FAULT: what follows runs when the program is aborted."""
    return _op(LABEL, (number, 1))


def note(step: int) -> bytes:
    """Tell the host that the program has come to the note of that step."""
    return _op(NOTE, (step, 2))


def halt() -> bytes:
    """End the program once every coil it fired has ended and every joint it moved has arrived."""
    return _op(HALT)


def header(code: bytes, robot_crc: int, flags: int = 0) -> bytes:
    """Return the header of `code` for the robot whose profile, with all its limits, has that CRC-32."""
    numbers = (robot_crc, 0, 0) if flags & STREAMED else (robot_crc, len(code), crc32(code))
    return b"SG" + bytes((FORMAT, flags)) + b"".join([number.to_bytes(4, "little") for number in numbers])


def read_header(data: bytes) -> Header:
    """Return the header's fields, or raise BadProgram."""
    if len(data) != HEADER_BYTES or data[:2] != b"SG":
        raise BadProgram("not a program header")
    if data[2] != FORMAT:
        raise BadProgram(f"program format {data[2]}, this robot reads {FORMAT}")
    return Header(data[3], number(data, 4, 4), number(data, 8, 4), number(data, 12, 4))


def number(code: bytes, at: int, size: int) -> int:
    """Return the little-endian unsigned number of `size` bytes at `at`."""
    value = 0
    for i in range(size - 1, -1, -1):
        value = value << 8 | code[at + i]
    return value


def signed(code: bytes, at: int) -> int:
    """Return the little-endian signed number of two bytes at `at`."""
    value = code[at] | code[at + 1] << 8
    return value - 0x10000 if value & 0x8000 else value


def read_condition(code: bytes, at: int) -> Condition:
    """Return the condition that stands at `at`."""
    return Condition(code[at], code[at + 1] & 15, code[at + 1] >> 4, signed(code, at + 2), number(code, at + 4, 4))


def read_circle(code: bytes, at: int) -> list:
    """Return the channels of the circle in the `aim` that stands at `at`."""
    return [channel for channel in code[at + 3 : at + 3 + CIRCLE_MAX] if channel != NO_COIL]


def disassemble(code: bytes) -> list[tuple]:
    """Return (offset, name, arguments...) of each op of a code that `verify.check_code` takes."""
    rows = []
    at = 0
    while at < len(code):
        rows.append((at, NAMES[code[at]]) + _arguments(code, at))
        at += SIZES[code[at]]
    return rows


def _arguments(code: bytes, at: int) -> tuple:
    op = code[at]
    if op == WAIT:
        return (read_condition(code, at + 1), number(code, at + 9, 4), code[at + 13])
    if op == GUARD:
        return (read_condition(code, at + 1),)
    if op == AIM:
        return (code[at + 1], code[at + 2], read_circle(code, at))
    if op not in ARGUMENTS:
        return ()
    found = []
    at += 1
    for size in ARGUMENTS[op]:
        found.append(signed(code, at) if size < 0 else number(code, at, size))
        at += abs(size)
    return tuple(found)


def _condition(condition: Condition) -> bytes:
    head = bytes((condition.source, condition.quantifier | condition.compare << 4))
    return head + (condition.value & 0xFFFF).to_bytes(2, "little") + condition.mask.to_bytes(4, "little")


def _op(op: int, *arguments) -> bytes:
    return bytes((op,)) + b"".join([value.to_bytes(size, "little") for value, size in arguments])
