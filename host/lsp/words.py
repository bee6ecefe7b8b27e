"""What the words of the language mean, and how far a robot lets each go: the texts of hover and completion."""

from __future__ import annotations

from fractions import Fraction

from host.gait import units
from host.gait.units import Quantity
from host.gait.working.jointunits import UNITS
from host.limits import CoilLimits, ServoLimits
from host.profile import Profile
from protocol import program

STATEMENTS = {
    "gait": "The version of the language; the first statement.",
    "robot": "The robot that the script is written for.",
    "param": "A value that `-p NAME=VALUE` may change, within its range.",
    "include": "Params and defs of another file, named relative to this one.",
    "circle": "Coils that come down one after another while the robot rolls.",
    "let": "The robot chooses a coil of a circle and keeps it under a name.",
    "def": "A block with arguments, run where it is called.",
    "fire": "Heats coils; the order carries its own end.",
    "hold": "Keeps coils near a temperature: the duty below it, nothing above it.",
    "move": "Brings joints to a position within a time.",
    "orient": "Turns the object that the joints hold, by what the camera sees.",
    "press": "Regulates the force of the press.",
    "repeat": "Runs its block a counted number of times.",
    "for": "Runs its block once for each coil, value or number.",
    "together": "All statements of its block start at once.",
    "sym": "Turns its block over the robot's body: the coils are those in the turned places.",
    "wait": "Lets time pass, or waits for a condition, for a bounded time.",
    "guard": "The robot switches everything off when the condition holds.",
    "note": "A text that is kept in the log with the robot's time; `$names` are put in.",
    "label": "A place further down that a wait may go on at.",
    "on": "What runs, once, when the program is aborted.",
}
CLAUSES = {
    "at": "How strongly.",
    "with": "The duty below the temperature that is held.",
    "for": "How long.",
    "until": "Ends the order early at this temperature.",
    "overlap": "The next statement begins by this much before the end.",
    "ramp": "The duty rises within this time.",
    "to": "Where to, or which force.",
    "over": "Within which time.",
    "timeout": "How long a wait may take at most.",
    "else": "When the time is over: `continue`, `abort`, or on at a label further down.",
    "is": "Compares with a coil or a group.",
    "in": "What the block runs for.",
    "fault": "The program was aborted: a wait ran out with `else abort`, or the camera was lost.",
}
WITHIN = {  # what a word means in one statement only
    ("hold", "at"): "The temperature that is kept.",
    ("wait", "until"): "Waits for a condition, which the robot looks at in every control step.",
    ("press", "to"): "The force to reach.",
    ("press", "over"): "Within which time the force is reached.",
}
QUANTITIES = {
    "temperature": "estimated temperature of a coil, or that of the board",
    "heat": "energy that a coil holds",
    "resistance": "resistance of a coil, as it was measured last",
    "martensite": "share of martensite in a coil, by its resistance",
    "angle": "angle of a joint",
    "depth": "position of an axis that goes by mm",
    "current": "current of a joint, or of the supply",
    "voltage": "voltage of the supply",
    "pressure": "pressure on a force cell",
    "roll": "how far the body has turned about its axis",
    "pitch": "how far the body is tilted",
    "orientation": "angle of the object, as the camera sees it",
    "force": "force on the load cell",
    "time": "time since the program began",
    "down": "the coil that is nearest to down",
}
EXPECTED = {  # the kind of quantity behind a word of a statement
    ("fire", "at"): units.SHARE,
    ("fire", "until"): units.TEMPERATURE,
    ("hold", "at"): units.TEMPERATURE,
    ("hold", "with"): units.SHARE,
    ("press", "to"): units.FORCE,
    ("orient", "orient"): units.ANGLE,
    ("wait", "wait"): units.TIME,
    ("repeat", "repeat"): units.NUMBER,
}
TIMES = ("for", "over", "overlap", "ramp", "timeout")


def kind_behind(statement: str, clause: str, profile: Profile | None) -> str | None:
    """Return the kind of quantity that stands behind a word of a statement, or None where several may."""
    if (statement, clause) == ("move", "to"):
        return UNITS[profile.unit].kind if profile else None
    if clause in TIMES and statement != "for":
        return units.TIME
    return EXPECTED.get((statement, clause))


def clause(statement: str, word: str) -> str:
    """Return what a word means within a statement."""
    return WITHIN.get((statement, word)) or CLAUSES.get(word, "")


def limit(statement: str, word: str, profile: Profile) -> str:
    """Return how far the robot lets a word of a statement go, or an empty text."""
    if profile.coil_limits and statement in ("fire", "hold"):
        return _of_coils(statement, word, profile.coil_limits)
    if profile.servo_limits and statement == "move":
        return _of_moves(word, profile.servo_limits)
    if statement == "press":
        return _of_presses(word, profile)
    counts = {
        ("guard", "guard"): f"at most {profile.program.guards_max} guards",
        ("repeat", "repeat"): f"1 .. 65535 times, at most {profile.program.depth_max} deep",
        ("label", "label"): f"at most {program.LABELS_MAX} labels",
    }
    return counts.get((statement, word), "")


def channel(label: str, profile: Profile) -> str:
    """Return what a coil, joint, group or force cell is and how far it may be driven, or an empty text."""
    groups = ", ".join(f"`{name}`" for name, labels in profile.groups.items() if label in labels)
    among = f", in {groups}" if groups else ""
    if label in profile.coil_labels:
        return f"coil `{label}`: channel {profile.labels.index(label)}{among}\n\n{_coil_limits(profile)}"
    if label in profile.joint_labels:
        return f"joint `{label}`: channel {profile.labels.index(label)}{among}\n\n{_joint_limits(profile)}"
    if label in profile.cell_labels:
        most = f"reads up to {profile.cell.full_pa / 1000:g} kPa" if profile.cell else ""
        return f"force cell `{label}`: {most}"
    if label in profile.groups:
        return f"group `{label}`: {' '.join(profile.groups[label])}"
    if label == "all":
        return f"all of {profile.robot}: {' '.join(profile.labels)}"
    return ""


def robot(profile: Profile) -> str:
    """Return what a robot has and allows."""
    parts = (("coils", profile.coil_labels), ("joints", profile.joint_labels), ("force cells", profile.cell_labels))
    lines = [f"robot `{profile.robot}`", *(f"{word}: {' '.join(labels)}" for word, labels in parts if labels)]
    lines += [f"group `{name}`: {' '.join(labels)}" for name, labels in profile.groups.items()]
    lines += [_coil_limits(profile)] if profile.coil_limits else []
    lines += [_joint_limits(profile)] if profile.servo_limits else []
    supply = profile.supply
    lines.append(f"at most {supply.at_once_max} at once and {supply.current_max_ma} mA")
    return "\n\n".join(lines)


def unit(name: str) -> str:
    """Return what a unit measures, or an empty text."""
    known = units.UNITS.get(name)
    return f"`{name}`: {known.kind}" if known else ""


def _coil_limits(profile: Profile) -> str:
    duty, times, trip = (limit("fire", word, profile) for word in ("at", "for", "until"))
    budget = f"heat budget {profile.coil.heat_budget_mj} mJ" if profile.coil_limits else ""
    return "\n\n".join(part for part in (duty, times, budget, trip and f"trips at {profile.coil.trip_degc} C") if part)


def _joint_limits(profile: Profile) -> str:
    return "\n\n".join(limit("move", word, profile) for word in ("to", "over", "move"))


def _of_coils(statement: str, word: str, coil: CoilLimits) -> str:
    if (statement, word) in (("fire", "at"), ("hold", "with")):
        return f"duty 0.1 .. {coil.duty_max_permille / 10:g} %"
    if (statement, word) in (("fire", "until"), ("hold", "at")):
        return f"below the robot's own trip at {coil.trip_degc} C"
    if word == "for":
        rest = f"on without a pause at most {_time(coil.on_max_ms)}, then {_time(coil.rest_ms)} rest"
        return f"one order at most {_time(coil.hold_max_ms)}; {rest}"
    return ""


def _of_moves(word: str, limits: ServoLimits) -> str:
    joint = UNITS[limits.unit]
    if word == "to":
        return f"{joint.written(limits.least_centi)} .. {joint.written(limits.most_centi)}"
    if word == "over":
        return f"at most {joint.speed(limits.slew_centi_per_s)}"
    return f"held for at most {_time(limits.hold_max_ms)} after it" if word == "move" else ""


def _of_presses(word: str, profile: Profile) -> str:
    if word == "to" and profile.load:
        return f"0 .. {profile.load.most_mn / 1000:g} N; the robot trips at {profile.load.trip_mn / 1000:g} N"
    if word == "for" and profile.servo_limits:
        return f"at most {_time(profile.servo.hold_max_ms)}"
    return ""


def _time(time_ms: int) -> str:
    return str(Quantity(Fraction(time_ms), units.TIME))
