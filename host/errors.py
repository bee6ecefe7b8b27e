"""The one family of errors of the host side, each with the exit status of the command line.

Every text is one line that says what is wrong and what to do next.
"""

from __future__ import annotations

from protocol import causes, codes

WHOLE = (("0.01 ", "", 100), ("mN", "N", 1000))  # of units that are told in whole ones: which, how many parts
NONE = 255  # channel number of an answer that is about no channel


class SoftrigError(Exception):
    """Anything the host side reports to its caller; `exit_code` is the status of a command that ends with it."""

    exit_code = 1


class ScriptFailed(SoftrigError):
    """The script ended in failure: an abort, a guard, a wait that ran out of time."""


class BadRequest(SoftrigError):
    """What was asked makes no sense for this robot: an unknown coil, an address nobody serves."""

    exit_code = 2


class NoRobot(SoftrigError):
    """There is no robot to talk to at that address."""

    exit_code = 3


class PortAbsent(NoRobot):
    """The address names nothing that exists."""


class PortForbidden(NoRobot):
    """The port exists, but this user may not open it."""


class PortBusy(NoRobot):
    """Another program holds the port."""


class Silent(NoRobot):
    """The port is open and nobody answers."""


class NotOurs(NoRobot):
    """Something answers, but not in our protocol."""


class Refused(SoftrigError):
    """The robot refused an order; nothing changed. `row` is its row in the table of codes.

    `coil` is the label of the channel that it is about, of that `kind`: coil or joint; `unit` is that of joints.
    """

    exit_code = 4

    def __init__(
        self,
        request: str,
        code: int,
        value: int = 0,
        limit: int = 0,
        coil: str | None = None,
        kind: str = "coil",
        unit: str = "deg",
    ) -> None:
        self.code, self.value, self.limit, self.coil = code, value, limit, coil
        self.row = causes.row(code)
        where = f" ({kind} {coil})" if coil else ""
        super().__init__(f"{request}{where} refused: {_told(code, unit, value, limit)}")


class NotPaired(SoftrigError):
    """Robot and host do not share a pairing key: one of them has none, or another; nothing was ordered."""

    exit_code = 4


class Mismatch(SoftrigError):
    """Host and robot do not speak the same language."""

    exit_code = 5


class DictionaryMismatch(Mismatch):
    """The robot's table of messages is not ours; `lines` are the differing rows."""

    def __init__(self, lines: list[str]) -> None:
        self.lines = lines
        super().__init__(
            f"the robot's table of messages differs in {len(lines)} lines ({'; '.join(lines[:4])}): "
            "put the firmware of this version on the robot, or install the softrig of its version"
        )


class RobotFault(SoftrigError):
    """The robot tripped; `row` is the row of its fault in the table of codes, `coil` as with a refusal."""

    exit_code = 6

    def __init__(
        self, code: int, value: int = 0, coil: str | None = None, kind: str = "coil", unit: str = "deg"
    ) -> None:
        self.code, self.value, self.coil = code, value, coil
        self.row = causes.row(code)
        super().__init__(f"the robot tripped{f' ({kind} {coil})' if coil else ''}: {_told(code, unit, value)}")


class LinkLost(SoftrigError):
    """The line broke, or the robot fell silent, in the middle of a session."""

    exit_code = 7


class TakenOver(LinkLost):
    """Another host has taken over the lease and the program; the robot obeys this one no more."""


class Interrupted(SoftrigError):
    """The user broke off; the text says what the robot acknowledged."""

    exit_code = 130


def unit_of(row: causes.Code | None, joints: str) -> str:
    """Return the unit of the figures beside a code, "": none; `joints` is that of the robot's joints."""
    unit: str = row.unit if row else ""
    return unit.replace("centi", f"0.01 {joints}") if unit.startswith("centi") else unit


def amount(value: int, unit: str) -> str:
    """Return a figure beside a code with its unit; hundredths of a joint's unit in that unit, mN in N."""
    for told, whole, parts in WHOLE:
        if unit.startswith(told):
            return f"{value / parts:g} {unit.replace(told, whole)}"
    return f"{value} {unit}"


def _told(code: int, joints: str, value: int, limit: int = 0) -> str:
    """Return `F05 A coil's estimated temperature is above its limit. 1123 0.1 C. Lower duty ...`."""
    row = causes.row(code)
    if row is None:
        return f"code {code}, unknown to this version; update softrig"
    bound = "at least" if value < limit else "at most"
    unit = unit_of(row, joints)
    beyond = f", {bound} {amount(limit, unit).split()[0]}" if limit or row.number == codes.RANGE_LIMIT else ""
    figures = f" {amount(value, unit)}{beyond}." if unit else ""
    return f"{row.name} {_cause(row, value)}{figures} {row.todo}"


def _cause(row: causes.Code, value: int) -> str:
    """Return the row's cause, and that of the fault behind it when a robot is latched."""
    fault = causes.row(value) if row.number == codes.TRIPPED else None
    return f"{row.cause[:-1]}: {fault.name} {fault.cause}" if fault else row.cause
