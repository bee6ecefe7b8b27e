"""The table of variables: what a subscription may ask for, and a record of telemetry carries.

A variable is a name, whose end is the unit, and a struct letter; behind it a `*` stands for one value for each coil, a
`+` for one for each joint, in the order of the robot's channels, an `@` for one where the robot has a camera and none
where it has not, a `!` for one where it has a load cell, and a `#` for one for each force cell. Its number is its place
in the table. A record holds the values one after the other
in the order in which they were asked for, little endian, no padding; what one means is the comment beside it. On the
line they are veiled: a coil that is off is all zeros, and on a small board each zero costs more to stuff than the rest.

    numbers = [number("state"), number("coil_decidegc")]
    size(numbers, counts(coils=8))
    state, coil_decidegc = unpack(numbers, veiled(values), counts(coils=8))
"""

import struct
from collections import namedtuple

Variable = namedtuple("Variable", ("name", "letter"))
Counts = namedtuple("Counts", ("coils", "joints", "cameras", "loads", "cells"))  # how many of each a robot has
MARKS = "*+@!#"  # behind the letter of a variable of each of them

VARIABLES = (
    Variable("state", "B"),  # State of the robot. [STATES]
    Variable("code", "H"),  # Last fault, 0: none since boot. [CODES]
    Variable("step", "H"),  # Step of the program, 0: none.
    Variable("coils_on", "I"),  # Bit mask of the coils that are on.
    Variable("without", "I"),  # Bit mask of the coils known to be broken.
    Variable("lease_left_ms", "H"),  # What is left of the lease, 0: none.
    Variable("supply_mv", "H"),  # Supply voltage at the coils' rail.
    Variable("current_ma", "H"),  # Supply current.
    Variable("board_decidegc", "h"),  # Temperature of the board.
    Variable("roll_decideg", "h"),  # Lean to the right; 0 when the attitude is not known. [-900..900]
    Variable("pitch_decideg", "h"),  # Turn forward since upright; 0 when the attitude is not known. [-1800..1800]
    Variable("down", "B"),  # Channel of the coil whose direction is nearest to down; 255: the attitude is not known.
    Variable("dropped", "H"),  # Damaged frames since boot, modulo 65536.
    Variable("resent", "H"),  # Frames that the robot had to send again in this session, modulo 65536.
    Variable("overruns", "H"),  # Control steps that came late, modulo 65536.
    Variable("duty_permille", "H*"),  # Share of the PWM period that the coil is on. [0..1000]
    Variable("coil_decidegc", "h*"),  # Estimated temperature of the coil.
    Variable("heat_permille", "H*"),  # Share of the coil's heat budget that is spent.
    Variable("resistance_mohm", "I*"),  # Resistance of the coil as measured last, 0: not measured.
    Variable("martensite_permille", "H*"),  # Share of martensite by that resistance, 65535: not known.
    Variable("least_decidegc", "h*"),  # What the coil's temperature was at least by that resistance, -32768: no bound.
    Variable("most_decidegc", "h*"),  # What the coil's temperature was at most by that resistance, 32767: no bound.
    Variable("can_state", "B"),  # 0: no CAN, or its controller is stopped; 1: in order, 2: warning, 3: passive, 4: off.
    Variable("can_overflows", "H"),  # Times that CAN frames to the robot were lost unread, modulo 65536.
    Variable("can_refused", "H"),  # Frames of the robot for which CAN had no room, modulo 65536.
    Variable("can_bus_offs", "H"),  # Looks, ten a second, that found the robot off the bus by errors, modulo 65536.
    Variable("joint_centi", "h+"),  # Position of the joint as measured, in hundredths of its unit.
    Variable("commanded_centi", "h+"),  # Position that it is told to go to, -32768: it is limp.
    Variable("joint_ma", "H+"),  # Current of the joint's servo.
    Variable("object_centideg", "h@"),  # Angle of the gripped object as the camera sees it, -32768: not known.
    Variable("load_mn", "i!"),  # Force on the load cell, positive where it is pressed.
    Variable("cell_pa", "H#"),  # Pressure on the force cell.
    Variable("program_at", "I"),  # Bytes of the program that its sequencer has passed.
)


def number(name: str) -> int:
    """Return the number of the variable of that name, or -1."""
    for place in range(len(VARIABLES)):
        if VARIABLES[place].name == name:
            return place
    return -1


def counts(coils: int, joints: int = 0, cameras: int = 0, loads: int = 0, cells: int = 0) -> Counts:
    """Return how many coils, joints, cameras, load cells and force cells a robot has."""
    return Counts(coils, joints, cameras, loads, cells)


def layout(numbers, counts: Counts) -> str:
    """Return the struct format of a record of these variables of a robot that has so many of each."""
    form = ["<"]
    for place in numbers:
        letter = VARIABLES[place].letter
        count = _count(letter, counts)
        form.append(letter if count < 0 else f"{count}{letter[0]}" if count else "")
    return "".join(form)


def size(numbers, counts: Counts) -> int:
    """Return how many bytes the values of these variables take."""
    return struct.calcsize(layout(numbers, counts))


def unpack(numbers, values: bytes, counts: Counts) -> list:
    """Return the value of each variable, a tuple where there are several or none; ValueError when they do not fit."""
    form = layout(numbers, counts)
    if struct.calcsize(form) != len(values):
        raise ValueError(f"{len(values)} bytes of values, expected {struct.calcsize(form)}")
    flat = struct.unpack(form, values)
    found, at = [], 0
    for place in numbers:
        count = _count(VARIABLES[place].letter, counts)
        if count < 0:
            found.append(flat[at])
            at += 1
        else:
            found.append(flat[at : at + count])
            at += count
    return found


def _count(letter: str, counts: Counts) -> int:
    """Return how many values a variable of that letter has, or -1 for a single one that every robot has."""
    return counts[MARKS.index(letter[1])] if len(letter) == 2 else -1


def veiled(values: bytes) -> bytes:
    """Return every byte exclusive-ored with 0x55: values as they go on the line, or what came from it as values."""
    count = len(values)
    return (int.from_bytes(values, "little") ^ int.from_bytes(b"\x55" * count, "little")).to_bytes(count, "little")


UNKNOWN_CENTI = -0x8000  # of a joint that is limp, of an object that nobody sees

# What a host that asks for nothing else is told, and what every listener can read.
USUAL = tuple([
    number(name)
    for name in (
        "state", "step", "supply_mv", "current_ma", "board_decidegc", "roll_decideg", "pitch_decideg", "down",
        "duty_permille", "coil_decidegc", "joint_centi", "commanded_centi", "joint_ma", "object_centideg",
        "load_mn", "cell_pa",
    )
])  # fmt: skip
