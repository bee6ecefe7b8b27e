"""The one family of errors of the host side, each with the exit status of the command line.

Every text is one line that says what is wrong and what to do next.
"""

from __future__ import annotations

from protocol import causes, codes

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

    `coil` is the label of the channel that it is about, of that `kind`: coil or joint.
    """

    exit_code = 4

    def __init__(
        self, request: str, code: int, value: int = 0, limit: int = 0, coil: str | None = None, kind: str = "coil"
    ) -> None:
        self.code, self.value, self.limit, self.coil = code, value, limit, coil
        self.row = causes.row(code)
        where = f" ({kind} {coil})" if coil else ""
        super().__init__(f"{request}{where} refused: {_told(code, value, limit)}")


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

    def __init__(self, code: int, value: int = 0, coil: str | None = None, kind: str = "coil") -> None:
        self.code, self.value, self.coil = code, value, coil
        self.row = causes.row(code)
        super().__init__(f"the robot tripped{f' ({kind} {coil})' if coil else ''}: {_told(code, value)}")


class LinkLost(SoftrigError):
    """The line broke, or the robot fell silent, in the middle of a session."""

    exit_code = 7


class Interrupted(SoftrigError):
    """The user broke off; the text says what the robot acknowledged."""

    exit_code = 130


def amount(value: int, unit: str) -> str:
    """Return a figure beside a code with its unit; degrees, which go over the wire in hundredths, in degrees."""
    return f"{_plain(value, unit)} {unit.removeprefix('centi')}"


def _told(code: int, value: int, limit: int = 0) -> str:
    """Return `F05 A coil's estimated temperature is above its limit. 1123 0.1 C. Lower duty ...`."""
    row = causes.row(code)
    if row is None:
        return f"code {code}, unknown to this version; update softrig"
    bound = "at least" if value < limit else "at most"
    beyond = f", {bound} {_plain(limit, row.unit)}" if limit or row.number == codes.RANGE_LIMIT else ""
    figures = f" {amount(value, row.unit)}{beyond}." if row.unit else ""
    return f"{row.name} {_cause(row, value)}{figures} {row.todo}"


def _plain(value: int, unit: str) -> str:
    return f"{value / 100:g}" if unit.startswith("centideg") else str(value)


def _cause(row: causes.Code, value: int) -> str:
    """Return the row's cause, and that of the fault behind it when a robot is latched."""
    fault = causes.row(value) if row.number == codes.TRIPPED else None
    return f"{row.cause[:-1]}: {fault.name} {fault.cause}" if fault else row.cause
