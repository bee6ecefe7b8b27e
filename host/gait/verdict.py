"""What the checker proves of a script: its worst case, for people and for JSON."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass

from host.gait.diagnostics import Diagnostic, exit_code
from host.gait.working.jointunits import UNITS
from host.profile import Profile


@dataclass(frozen=True, slots=True)
class CoilReport:
    """The most that one coil can come to."""

    label: str
    orders: int
    on_ms: int
    energy_mj: int
    heat_peak_mj: int


@dataclass(frozen=True, slots=True)
class JointReport:
    """The most that one joint can come to; the positions are None when it is never moved."""

    label: str
    orders: int
    least_centi: int | None
    most_centi: int | None
    fastest_centi_per_s: int
    held_ms: int
    driven_ms: int


@dataclass(frozen=True, slots=True)
class Report:
    """The worst case of a script, and where it breaks a limit."""

    script: str
    profile: Profile
    longest_ms: int
    shortest_ms: int
    coils: tuple[CoilReport, ...]
    joints: tuple[JointReport, ...]
    force_mn: int  # the greatest that is asked for
    at_once: int
    current_ma: int
    program_bytes: int
    depth: int
    guards: int
    steps: int
    diagnostics: tuple[Diagnostic, ...]

    @property
    def sound(self) -> bool:
        """Return whether the script keeps every limit."""
        return not self.diagnostics

    @property
    def exit_code(self) -> int:
        """Return 0, or 4 when a limit would be broken."""
        return exit_code(self.diagnostics)

    def as_dict(self) -> dict[str, object]:
        """Return the fields for JSON; what the robot has none of is not told."""
        return {
            "script": self.script,
            "robot": self.profile.robot,
            "sound": self.sound,
            "longest_ms": self.longest_ms,
            "shortest_ms": self.shortest_ms,
            **(self._coil_fields() if self.coils else {}),
            **(self._joint_fields() if self.joints else {}),
            **(self._force_fields() if self.profile.press else {}),
            "program_bytes": {"most": self.program_bytes, "limit": self.profile.program.bytes_max},
            "depth": self.depth,
            "guards": self.guards,
            "steps": self.steps,
            "coils": {coil.label: _fields(coil) for coil in self.coils},
            "joints": {joint.label: _fields(joint) for joint in self.joints},
            "diagnostics": [item.as_dict() for item in self.diagnostics],
        }

    def lines(self) -> Iterator[str]:
        """Yield the report as a user reads it."""
        supply = self.profile.supply
        verdict = "keeps" if self.sound else "does not keep"
        yield f"{self.script} {verdict} the limits of {self.profile.robot}"
        yield f"  time      {self.shortest_ms / 1000:.1f} s at least, {self.longest_ms / 1000:.1f} s at most"
        if self.coils:
            yield f"  at once   {self.at_once} of {supply.at_once_max} coils"
            yield f"  supply    {self.current_ma} of {supply.current_max_ma} mA"
        steps = f"{self.steps} step{'s' * (self.steps != 1)}"
        yield f"  program   {self.program_bytes} of {self.profile.program.bytes_max} bytes, {steps}"
        if self.force_mn and self.profile.load:
            yield f"  force     {self.force_mn / 1000:g} of {self.profile.load.most_mn / 1000:g} N"
        yield from self._coil_lines()
        yield from self._joint_lines()

    def _coil_fields(self) -> dict[str, object]:
        supply, heat_mj = self.profile.supply, max(coil.heat_peak_mj for coil in self.coils)
        return {
            "at_once": {"most": self.at_once, "limit": supply.at_once_max},
            "supply_current_ma": {"most": self.current_ma, "limit": supply.current_max_ma},
            "heat_mj": {"most": heat_mj, "limit": self.profile.coil.heat_budget_mj},
        }

    def _joint_fields(self) -> dict[str, object]:
        limits = self.profile.servo
        speed = max(joint.fastest_centi_per_s for joint in self.joints)
        held_ms = max(joint.held_ms for joint in self.joints)
        return {
            "speed_centi_per_s": {"most": speed, "limit": limits.slew_centi_per_s},
            "held_ms": {"most": held_ms, "limit": limits.hold_max_ms},
        }

    def _force_fields(self) -> dict[str, object]:
        assert self.profile.load is not None
        return {"force_mn": {"most": self.force_mn, "limit": self.profile.load.most_mn}}

    def _coil_lines(self) -> Iterator[str]:
        if self.coils and (not self.joints or any(coil.orders for coil in self.coils)):
            yield f"  coil  orders   on time    energy   heat (of {self.profile.coil.heat_budget_mj} mJ)"
        for coil in self.coils:
            figures = f"{coil.on_ms / 1000:7.2f} s {coil.energy_mj:6d} mJ {coil.heat_peak_mj:6d} mJ"
            if coil.orders:
                yield f"  {coil.label:<6}{coil.orders:6d} {figures}"

    def _joint_lines(self) -> Iterator[str]:
        if not any(joint.orders for joint in self.joints):
            return
        limits, unit = self.profile.servo, UNITS[self.profile.unit]
        speed, hold = f"speed (of {limits.slew_centi_per_s / 100:g})", f"held (of {limits.hold_max_ms / 1000:g})"
        yield f"  joint orders   {unit.quantity + 's':<20}{speed:>18}{hold:>18}{'driven':>12}"
        for joint in self.joints:
            if joint.least_centi is None or joint.most_centi is None:
                continue
            speed = f"{joint.fastest_centi_per_s / 100:.1f} {unit.name}/s"
            times = f"{joint.held_ms / 1000:16.2f} s{joint.driven_ms / 1000:10.2f} s"
            way = unit.way(joint.least_centi, joint.most_centi)
            yield f"  {joint.label:<6}{joint.orders:6d}   {way:<20}{speed:>18}{times}"


def _fields(row: CoilReport | JointReport) -> dict[str, object]:
    return {name: value for name, value in asdict(row).items() if name != "label"}
