"""How a session is opened with a pairing key, and how each end knows that the other has it.

Host and robot each bring a number of their own into the session's key; the robot proves in its `identity` that it has
made the same one. So a wrong key is told at once, a robot without one is never taken for a robot that has it, and
nothing that was recorded in one session opens another.

    opening = opened(link, attach=0)
    line.write(... opening.payload() ...)
    link.begin(identity.dictionary_crc, opening.session, session_key(key, opening, identity))
"""

from __future__ import annotations

import os
import struct
from typing import Any, NamedTuple

from host.errors import NotPaired
from protocol import causes, codes, frames, messages, secret

SESSION_MAX = 0xFFFFFFFF
SPREAD = 2654435761  # Knuth's multiplier: neighbouring times become numbers far apart


class Opening(NamedTuple):
    """What a host says to begin a session; `session` is not 0, and best never used before."""

    session: int
    attach: int = 0
    nonce_a: int = 0
    nonce_b: int = 0

    def payload(self) -> bytes:
        """Return it as `hello` carries it."""
        said: bytes = messages.HELLO.pack(version=frames.VERSION, **self._asdict())
        return said


def opened(line: Any, attach: int = 0) -> Opening:
    """Return an opening that nobody foretells; where the line's runs are to be repeatable, one made of its clock."""
    if getattr(line, "repeatable", False):
        drawn = [round(line.now_s() * 1e6 + place) * SPREAD for place in range(3)]
    else:
        drawn = list(struct.unpack("<III", os.urandom(12)))
    session, nonce_a, nonce_b = drawn
    return Opening(session % SESSION_MAX + 1, attach, nonce_a % SESSION_MAX, nonce_b % SESSION_MAX)


def session_key(key: bytes, opening: Opening, identity: Any) -> bytes:
    """Return the key of the session, b"" where there is none to be; NotPaired when only one end has the pairing key.

    A host without a key may watch a robot that has one: `may_order` says no then.
    """
    if identity.secured == messages.KEY_DAMAGED:
        raise NotPaired(_damaged())
    if not key:
        return b""
    if identity.secured != messages.PAIRED:
        raise NotPaired("this robot has no pairing key, but a key was given: is it the right one? Orders were not sent")
    made = secret.session_key(
        secret.prepared(key), opening, identity.nonce_a, identity.nonce_b, identity.dictionary_crc
    )
    if secret.proof(made) != (identity.proof_a, identity.proof_b):
        raise NotPaired("wrong key: this robot was paired with another; `softrig deploy --key FILE` gives it this one")
    return made


def may_order(key: bytes, identity: Any) -> bool:
    """Return whether the robot would take an order from this host."""
    return bool(key) or identity.secured == messages.UNPAIRED


def keyless(request: str) -> NotPaired:
    """Return the error of an order to a robot whose key this host does not have."""
    return NotPaired(f"{request} refused: this robot takes orders only with its pairing key: --key FILE or SOFTRIG_KEY")


def _damaged() -> str:
    row = causes.row(codes.KEY)
    return "the robot's pairing key is damaged" if row is None else f"{row.name} {row.cause} {row.todo}"
