"""Whether the robot that answers now is the one that answered before, as it was."""

from __future__ import annotations

from typing import Any

from host.errors import LinkLost, RobotFault, SoftrigError, TakenOver
from host.records import state_name
from protocol import codes


def changed(before: Any, now: Any) -> SoftrigError | None:
    """Return what must have happened between two identities, or None when the session can go on."""
    if now.dictionary_crc != before.dictionary_crc:
        return LinkLost("another robot answers at this address now; the one of this session switches everything off")
    if now.boot != before.boot:
        return restarted(state_name(now.state))
    if now.holder not in (0, before.session):
        return TakenOver("another host has taken the robot over")
    return None


def restarted(state: str) -> SoftrigError:
    """Return what the restart of a robot in that state, or with an event of that name, means."""
    if state == "tripped":
        return RobotFault(codes.WATCHDOG)
    return LinkLost("the robot restarted in the middle of the session; everything is off")
