"""Where predicted temperatures come from: models of robots that other packages bring, the entry points
`softrig.predictors`, each a function of an address or a robot's name and a number of spare coils.

    coils = predictor("sim:circular", profile)     # Unpredicted says in one line why there is none
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import entry_points
from typing import Any, NamedTuple, Protocol

from host.profile import Profile
from protocol import program


class Unpredicted(Exception):
    """There is no model of this robot; the text says why."""


class Passed(NamedTuple):
    """What came of a stretch of time; of `trace` each row is a time since its begin [ms] and all temperatures."""

    ms: int
    degc: Any
    peak_degc: Any
    peak_ms: Any
    trace: Any


class Coils(Protocol):
    """The coils of one robot, cold at first, and behind them spare ones that can stand for any of them."""

    labels: Sequence[str]

    @property
    def degc(self) -> Any:
        """Temperatures of all coils."""

    @property
    def energy_mj(self) -> Any:
        """What each coil has turned to heat so far."""

    def restart(self) -> None:
        """Let all coils be cold again."""

    def copy(self, place: int, index: int) -> None:
        """Let the coil at `place` be as the one at `index` is, in all but the energy that it has taken."""

    def advance(
        self,
        duty_permille: Sequence[int],
        time_ms: int,
        limit_degc: Sequence[float] | None = None,
        kept: int = 0,
        until: tuple[int, bool, float, bool] | None = None,
        every_ms: int = 0,
    ) -> Passed:
        """Let `time_ms` pass, or less: until a coil that is on reaches its limit, or what is asked for holds."""


def predictor(address: str, profile: Profile) -> Coils:
    """Return the model of the robot at an address, or of its name where the line leads to a real one."""
    if not profile.coil_labels:
        raise Unpredicted(f"{profile.robot} has no coils")
    points = {point.name: point for point in entry_points(group="softrig.predictors")}
    scheme = address.partition(":")[0]
    asked = [(points[scheme], address)] if scheme in points else [(point, profile.robot) for point in points.values()]
    for point, name in asked:
        try:
            found: Coils = point.load()(name, program.AIMS_MAX)
        except (LookupError, ValueError, OSError):
            continue
        if tuple(found.labels) == profile.coil_labels:
            return found
    raise Unpredicted(f"no model of the robot {profile.robot} is known: its temperatures are not predicted")
