"""The tables of the reference of the gait language: from its grammar, its units and quantities, the op-codes.

Forms, clauses and op-codes stand here in words that people read; what the grammar has and they have not is an error,
so that no word of the language is left out.
"""

import re
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from docs.protocolpage import ARGUMENTS
from host.gait import script, units
from host.gait.reading import lines, parser
from host.gait.units import Quantity
from host.gait.working import clauses, expand, motions, sources
from host.gait.working.expand import COUNT_MAX
from host.gait.working.orders import CUTOFF_MAX_DECIDEGC
from protocol import program

GRAMMAR = (Path(__file__).parents[1] / "host" / "gait" / "reading" / "gait.lark").read_text(encoding="utf-8")
Table = Callable[[Sequence[str], Iterable[tuple[str, ...]]], str]
HIDDEN = ("broken", "broken_block")  # what a line that could not be read becomes
STATEMENTS = ("_line", "_order", "_block")  # the rules that list them


class Form(NamedTuple):
    """How a statement is written, where it may stand, and what it does."""

    text: str
    where: str
    meaning: str


TOP, ANY, MAIN = "top level", "anywhere", "top level of the main script"
FORMS = {
    "gait": Form("gait 1", "first line", "The version of the language."),
    "robot": Form("robot NAME", MAIN, "The robot that the script is for."),
    "param": Form("param NAME = VALUE [LEAST .. MOST]", TOP, "A value with a name; `-p NAME=VALUE` changes it."),
    "include": Form('include "FILE"', TOP, "Params, circles and defs of another file, named relative to this one."),
    "circle": Form("circle NAME = COIL ...", TOP, "Coils as they come down one after another while the robot rolls."),
    "define": Form("def NAME(NAME, ...):", TOP, "A statement of your own, with arguments."),
    "call": Form("NAME(ARGUMENT, ...)", ANY, "Runs a def; an argument is a value, coils, joints or force cells."),
    "let": Form("let NAME = CIRCLE[down + N]", ANY, "The robot chooses a coil; `$NAME` is that one."),
    "fire": Form(
        "fire COIL ... at DUTY for TIME until TEMPERATURE ramp TIME overlap TIME", ANY, "Heats coils for a time."
    ),
    "hold": Form(
        "hold COIL ... at TEMPERATURE with DUTY for TIME overlap TIME", ANY,
        "Keeps coils near a temperature: the duty below it, nothing above it.",
    ),
    "move": Form("move JOINT ... to POSITION over TIME overlap TIME", ANY, "Brings joints to an angle or a depth."),
    "orient": Form("orient ANGLE for TIME overlap TIME", ANY, "Turns what two joints hold, in a closed loop."),
    "press": Form("press to FORCE over TIME for TIME overlap TIME", ANY, "Keeps a force on the load cell."),
    "wait": Form("wait TIME", ANY, "Lets time pass."),
    "wait_until": Form(
        "wait until CONDITION timeout TIME else abort|continue|LABEL", ANY,
        "Goes on when the condition holds. After the time-out: fails, goes on, or goes on at a label.",
    ),
    "guard": Form("guard CONDITION", MAIN, "From here on, everything is switched off and latched when it holds."),
    "note": Form('note "TEXT"', ANY, "Kept in the log with the robot's time; `$NAME` in it is its value."),
    "label": Form("label NAME", MAIN, "A place that a wait further up may go on at."),
    "repeat": Form("repeat N:", ANY, "Runs a block N times, by a loop on the robot."),
    "for_each": Form(
        "for NAME in ITEM, ...:", ANY,
        "Runs a block once for each coil of a list or group, for each value, or for `FIRST .. LAST`, whole numbers.",
    ),
    "together": Form("together:", ANY, "Begins its statements at the same time; no wait for a condition, no let."),
    "sym": Form("sym AXIS ANGLE, ...:", ANY, "Takes other coils for those that are named, as if the body lay turned."),
    "on_fault": Form("on fault:", MAIN + ", last", "Runs when the program is aborted; it still ends as failed."),
}  # fmt: skip
LONG = (units.TIME, 1, clauses.LONG_MAX_MS)
ORDER = (units.TIME, 1, clauses.ORDER_MAX_MS)
PART = (units.TIME, 0, clauses.ORDER_MAX_MS)
DUTY = (units.SHARE, 1, 1000)
WARMTH = (units.TEMPERATURE, 1, CUTOFF_MAX_DECIDEGC)
# Of each statement its clauses: kind, least and most in the kind's base unit; what it means.
CLAUSES: dict[str, dict[str, tuple[tuple[str, int, int], str]]] = {
    "fire": {
        "at": (DUTY, "needed: share of the time that the coil is on"), "for": (ORDER, "needed: off after that"),
        "until": (WARMTH, "off earlier when the estimate is that high"), "ramp": (PART, "the duty rises from 0 within"),
        "overlap": (PART, "the next statement begins so much earlier"),
    },
    "hold": {
        "at": (WARMTH, "needed: to keep"), "with": (DUTY, "needed: below it"), "for": (ORDER, "needed: how long"),
        "overlap": (PART, "as of fire"),
    },
    "move": {
        "to": ((units.ANGLE, -motions.CENTI_MAX, motions.CENTI_MAX), "needed: where to; in mm where joints go by mm"),
        "over": (ORDER, "needed: on the way, in a straight line"), "overlap": (PART, "as of fire"),
    },
    "orient": {"for": (ORDER, "needed: how long"), "overlap": (PART, "as of fire")},
    "press": {
        "to": ((units.FORCE, 0, motions.FORCE_MAX_MN), "needed: which force"), "over": (ORDER, "needed: to get there"),
        "for": (LONG, "needed: the whole time"), "overlap": ((units.TIME, 0, clauses.LONG_MAX_MS), "as of fire"),
    },
    "wait_until": {"timeout": (LONG, "needed: how long at most")},
}  # fmt: skip
# Whose quantities can be asked, and how that is written.
ASKED = (
    ("of a coil, of `any` or `all` of several", "A.{}", sources.COIL),
    ("of a joint", "R.{}", sources.JOINT),
    ("of a force cell", "C1.{}", sources.CELL),
    ("of the whole robot", "{}", sources.WHOLE),
    ("of the supply of coils and joints", "supply.{}", sources.SUPPLY),
    ("of the board", "board.{}", sources.BOARD),
)
ABOUT = {
    "A.temperature": "an estimate", "board.temperature": "",
    "heat": "taken and not yet leaked away, as held against the heat budget",
    "resistance": "as measured last; does not hold before",
    "martensite": "share of martensite by the resistance; does not hold while that is not known",
    "angle": "where joints go by deg", "depth": "where they go by mm", "current": "", "voltage": "",
    "pressure": "inside the block", "roll": "how far the axle leans to the right; needs an attitude sensor",
    "pitch": "turned forward since upright; needs an attitude sensor", "orientation": "of the object; needs a camera",
    "force": "on the load cell", "time": "since the program began",
}  # fmt: skip
MADE_OF = {
    "halt": "the end", "fire": "fire, hold", "ramp": "fire ... ramp", "delay": "wait, and the time of an order",
    "repeat": "repeat", "next": "the end of a repeat", "wait": "wait until", "guard": "guard",
    "step": "each line that does something", "off": "nothing; for programs of other hosts", "aim": "let",
    "aimed": "fire and hold of `$NAME`", "move": "move", "orient": "orient", "press": "press",
    "label": "label; 255: on fault", "note": "note",
}  # fmt: skip


def fields(table: Table) -> dict[str, str]:
    """Return what the template of the page leaves open."""
    heads = ("statement", "where", "what it does")
    return {
        "statements": table(heads, [(f"`{form.text}`", form.where, form.meaning) for form in _forms()]),
        "clauses": table(("statement", "clause", "from", "to", "means"), list(_clauses())),
        "quantities": table(("asked", "is a", "in steps of", ""), list(_quantities())),
        "units": table(("kind", "units"), [(kind, _units(kind)) for kind in _kinds()]),
        "ops": table(("op", "bytes", "name", "arguments", "made of"), list(_ops())),
        "grammar": grammar(),
        "count_max": str(COUNT_MAX), "lines_max": str(lines.LINES_MAX), "line_max": str(lines.LINE_MAX),
        "blocks_max": str(parser.DEPTH_MAX), "includes_max": str(script.INCLUDES_MAX),
        "calls_max": str(expand.DEPTH_MAX),
        "depth_max": str(program.DEPTH_MAX), "guards_max": str(program.GUARDS_MAX), "aims_max": str(program.AIMS_MAX),
        "circle_max": str(program.CIRCLE_MAX), "labels_max": str(program.LABELS_MAX),
        "header_bytes": str(program.HEADER_BYTES), "format": str(program.FORMAT),
    }  # fmt: skip


def rules() -> dict[str, str]:
    """Return each rule of the grammar by its name, without those for lines that could not be read."""
    found = dict(re.findall(r"^\??(\w+): (.*(?:\n +\|.*)*)$", GRAMMAR, re.MULTILINE))
    return {name: text for name, text in found.items() if name not in HIDDEN and not name.isupper() and name != "_NL"}


def words() -> dict[str, str]:
    """Return what each terminal of the grammar that is one word or sign stands for."""
    return dict(re.findall(r'^([A-Z]+): "([^"\\]+)"$', GRAMMAR, re.MULTILINE))


def grammar() -> str:
    """Return the grammar with its words and signs put in."""
    spelled = words()
    text = "\n".join(f"{name}: {definition}" for name, definition in rules().items())
    text = re.sub(r"\b[A-Z]+\b", lambda match: f'"{spelled[match[0]]}"' if match[0] in spelled else match[0], text)
    return re.sub(r" \| broken(_block)?\b", "", text)


def statements() -> list[str]:
    """Return the rules that are statements, in the order of the grammar."""
    listed = rules()
    named = [name for rule in STATEMENTS for name in listed[rule].split(" | ")]
    return [name for name in named if name not in STATEMENTS and name not in HIDDEN]


def _forms() -> list[Form]:
    """Return the forms in the order of this file; ValueError names a statement that has none, or is none."""
    odd = set(FORMS) ^ set(statements())
    if odd:
        raise ValueError(f"the grammar and the forms differ: {sorted(odd)}")
    return list(FORMS.values())


def _clauses() -> Iterable[tuple[str, ...]]:
    for name, of in CLAUSES.items():
        for word, ((kind, least, most), meaning) in of.items():
            ends = [str(Quantity(Fraction(end), kind)) for end in (least, most)]
            yield name.replace("_", " "), f"`{word}`", *ends, meaning


def _quantities() -> Iterable[tuple[str, ...]]:
    for whose, form, known in ASKED:
        for name, source in known.items():
            step = str(Quantity(Fraction(source.size), source.kind))
            asked = form.format(name)
            about = ABOUT[asked if asked in ABOUT else name]
            yield f"`{asked}`", source.kind, step, "; ".join(filter(None, (whose, about)))
    yield (
        "`down is A`",
        "coil",
        "",
        "of the whole robot; whether this coil's direction is nearest to down",
    )


def _kinds() -> list[str]:
    return list(dict.fromkeys(unit.kind for unit in units.UNITS.values()))


def _units(kind: str) -> str:
    """Return the units of a kind, with what each is of the first."""
    names = units.OF_KIND[kind]
    first = units.UNITS[names[0]].factor
    sizes = [Fraction(units.UNITS[name].factor, first) for name in names]
    return ", ".join(
        f"`{name}`" + (f" = {units.decimal(size)} {names[0]}" if size != 1 else "")
        for name, size in zip(names, sizes, strict=True)
    )


def _ops() -> Iterable[tuple[str, ...]]:
    for number, (name, size) in enumerate(zip(program.NAMES, program.SIZES, strict=True)):
        yield f"0x{number:02X}", str(size), name, ARGUMENTS.get(name, ""), MADE_OF[name]
