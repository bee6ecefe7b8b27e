"""Decides which looks at a body are worth keeping: the release of a jump lasts some 20 ms, a rest many seconds.

A look is kept when the body's energies have changed by a share of the greatest that it ever held.

    attention = Attention()
    if attention.stirs(snapshot):
        attention.keep(snapshot)
"""

from __future__ import annotations

from typing import Any

SHARE = 0.03
KINDS = ("kinetic", "elastic", "gravity")


class Attention:
    """Says whether a body has changed since it was last kept."""

    def __init__(self) -> None:
        self._kept: dict[str, float] | None = None
        self._greatest = 0.0

    def stirs(self, snapshot: dict[str, Any]) -> bool:
        """Return whether the body's energies are other than those last kept; never without energies."""
        energies = snapshot.get("energy_j")
        if energies is None:
            return False
        self._greatest = max(self._greatest, energies["elastic"], energies["kinetic"])
        if self._kept is None:
            return True
        changed = sum(abs(energies[kind] - self._kept[kind]) for kind in KINDS)
        return bool(changed > SHARE * self._greatest)

    def keep(self, snapshot: dict[str, Any]) -> None:
        """Take note of what was kept."""
        self._kept = snapshot.get("energy_j")
