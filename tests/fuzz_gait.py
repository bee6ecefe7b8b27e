"""Fuzz target: gait scripts. Whatever a text says, it is refused with places in it, or a robot may run what it gives.

An input is the number of a robot and a text, as characters or, what a fuzzer gets further with, as words of the
language, a byte each.
"""

from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.diagnostics import GaitError
from host.gait.forms.layout import layout, same
from host.gait.forms.writer import written
from host.gait.reading.parser import parse_file
from host.gait.reading.syntax import KEYWORDS
from host.gait.script import loads
from host.gait.units import UNITS
from protocol import verify
from tests.gait_scripts import profile_of

NAME = "script.gait"
ROBOTS = ("circular", "sphere-b", "fingers-experiment", "press")
WORDS = (
    *KEYWORDS, *UNITS, "\n", "\n    ", "\n        ", "\n\t", "\n  ", " ", ":", "(", ")", ",", "[", "]", "=", "..", "+",
    "-", "*", "/", "<", ">", "is", "#", '"', "$c", "$d", "c", "d", "A", "B", "all", "any", "A100", "A00m1", "B10m1",
    "x", "y", "z", "R", "L", "P", "C1", "temperature", "heat", "resistance", "martensite", "angle", "depth", "current",
    "pressure", "force", "roll", "pitch", "down", "orientation", "time", "abort", "continue", ".", "0", "1", "2", "5",
    "8", "45", "90", "360", "60", "600", "99999999999", "0.5", "gait 1\nrobot circular\n", "gait 1\nrobot press\n",
)  # fmt: skip


def text_of(data: bytes) -> str:
    """Return the text that an input stands for."""
    if data[:1] and data[0] & 0x80:
        return " ".join(WORDS[byte % len(WORDS)] for byte in data[1:])
    return data[1:].decode("utf-8", "replace")


def coded(text: str, robot: str) -> bytes:
    """Return the input that stands for a text as it is written, for that robot."""
    return bytes((ROBOTS.index(robot),)) + text.encode()


def gait(data: bytes) -> None:
    """Read, write, compile and check a text; all that may be raised is GaitError."""
    text, profile = text_of(data), profile_of(ROBOTS[(data[0] if data else 0) & 3])
    file, found = parse_file(text, NAME)
    if not found:
        again, none = parse_file(written(layout(file)), NAME)
        assert none == []
        assert same(file.statements, again.statements)
    try:
        made = compile_script(loads(text, NAME, read=_nothing), profile)
    except GaitError as error:
        _placed(error, text)
        return
    for item in check(made).diagnostics:
        assert item.code.startswith("E3"), item
    if len(made.code) <= profile.program.bytes_max:
        counts = len(profile.joint_labels), len(profile.cells)
        verify.check_code(made.code, len(profile.coil_labels), profile.program.bytes_max, *counts)


def _placed(error: GaitError, text: str) -> None:
    """Hold that each mistake stands at a place of the text and says what it is."""
    lines = text.count("\n") + 1
    for item in error.diagnostics:
        assert item.place.file == NAME, item
        assert 1 <= item.place.line <= lines, item
        assert 1 <= item.place.column < item.place.end_column, item
        assert item.message, item


def _nothing(path: str) -> str:
    raise FileNotFoundError(2, "No such file or directory", path)
