"""Whether a body still holds together: a solver driven beyond its range gives numbers, but no robot.

Looked at twice in a second of virtual time; what is told names the time and the limit that was passed.

    watch = Soundness()
    watch.look(plant.snapshot(), t_s)      # CameApart when nodes fly off or numbers are none
"""

from collections.abc import Mapping
from itertools import chain
from math import dist, isfinite
from typing import Any

EVERY_US = 500_000
REACH_MM = 100_000.0  # from the hub to any node
SPEED_MM_PER_S = 340_000.0  # of the hub: that of sound


class CameApart(OSError):
    """A body whose numbers are beyond what its solver bears."""


class OutOfModel(CameApart):
    """A body in a state for which its model says nothing, as a fingertip pressed to the edge of its plate."""


class Soundness:
    """Remembers where the hub was when it was last looked at."""

    def __init__(self) -> None:
        self._t_s = 0.0
        self._hub: tuple[float, ...] | None = None

    def look(self, snapshot: Mapping[str, Any], t_s: float) -> None:
        """Raise CameApart when the shape of that time is none that a robot can have."""
        nodes = snapshot.get("nodes")
        if not nodes:
            return
        hub = tuple(snapshot["hub"][: len(nodes[0])])
        degrees = [coil.get("degc", 0.0) for coil in snapshot["coils"].values()]
        if not all(map(isfinite, chain(hub, degrees, *nodes))):
            raise CameApart(_told(t_s, "its numbers are none any more"))
        reach_mm = max(dist(hub, node) for node in nodes)
        if reach_mm > REACH_MM:
            raise CameApart(_told(t_s, f"a node is {reach_mm:.3g} mm from the hub, at most {REACH_MM:g}"))
        passed_s, moved_mm = t_s - self._t_s, dist(hub, self._hub or hub)
        if moved_mm > SPEED_MM_PER_S * passed_s:
            raise CameApart(_told(t_s, f"its hub went {moved_mm:.3g} mm in {passed_s:g} s"))
        self._t_s, self._hub = t_s, hub


def _told(t_s: float, what: str) -> str:
    return f"the body of the bench came apart by {t_s:.2f} s, {what}: its robot file or set= is beyond the solver"
