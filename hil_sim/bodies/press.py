"""A press on a rheological block as a plant: where its servo is told to go in, depth, force and stress out.

Positions are depths: 0 where the indenter's lowest point is level with the undeformed top, positive into the block.
The block is advanced in steps of its own, 10 ms as it comes; between them the screw moves under the force that it met
at the last one. The glue of a bonded punch takes when that is first pressed on the block (ASSUMED: by 0.01 mm); pulled
with more than it holds it tears off, and the punch presses without it from then on.

    plant = PressPlant(load("press"))
    plant.command([4.0])
    plant.advance(5000, np.zeros(0))
    plant.load_n, plant.cell_pa, plant.observe()["dent_mm"], plant.fields()["von_mises_kpa"]

Small strain: see physics/block. What the model says nothing about ends the run with OutOfModel.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from hil_sim.bodies import pressview
from hil_sim.bodies.backlash import follow
from hil_sim.bodies.pressnumbers import cells_at, places_of, press_of, ratios, shape_of
from hil_sim.bodies.screw import Screw
from hil_sim.physics.block.material import BlockError
from hil_sim.physics.block.press import Pressed, surface_of
from hil_sim.physics.block.stress import von_mises
from hil_sim.physics.compiled import Array
from hil_sim.robots.file import RobotFile
from hil_sim.soundness import OutOfModel

TACK = 1e-5  # how deep a bonded punch is pressed when its glue takes [m]


class PressPlant:
    """Axis, indenter and block of one robot, at rest at time 0; a function of the commands and nothing else."""

    def __init__(self, robot: RobotFile) -> None:
        """Build the block and try a step; BlockError for numbers that cannot be."""
        assert robot.press is not None
        self.labels: list[str] = []
        self.temperature, self.resistance = np.zeros(0), np.zeros(0)
        self.joints = list(robot.joints)
        self.joint_unit, self.object_deg = "mm", None
        self.numbers = robot.press
        self.press = press_of(self.numbers)
        self.state = self._in_the_air(0.0)
        self.surface = surface_of(self.press.block.mesh)
        self.block_mm = pressview.block_mm(self.numbers, self.press.block.mesh)
        self.places = places_of(self.numbers, self.press.block.mesh)
        self.cells = cells_at(self.places, self.numbers.side, self.press.block.mesh)
        self.screw = Screw(self.numbers.screw)
        self.commanded_mm: float | None = None
        self.force_peak_n = self.von_mises_peak_pa = self.strain_peak = 0.0
        self.lost_contact_s: float | None = None
        self._dead = False
        self._now_us = 0
        self._step_us = round(1e6 * self.numbers.dt)
        self._felt: tuple[Pressed, Array] | None = None
        self.press.advance(self.press.start(), self.numbers.dt, depth=0.0)  # compiles and factors what it needs

    @property
    def t_s(self) -> float:
        """Time since the beginning."""
        return self._now_us / 1e6

    @property
    def joint_position(self) -> Array:
        """Position of the servo [mm]."""
        return np.array([self.screw.at_mm])

    @property
    def joint_current_a(self) -> Array:
        """Current of the servo while it has power [A]."""
        return np.array([self.screw.current_a])

    @property
    def load_n(self) -> float:
        """What the load cell feels: the force with which the indenter presses on the block."""
        return self.state.force

    @property
    def cell_pa(self) -> Array:
        """What the force cells feel: mean pressure along y, tension negative."""
        if self._felt is None or self._felt[0] is not self.state:
            self._felt = self.state, -self.cells.mean(self.state.block.stress[1])
        return self._felt[1]

    @property
    def cell_kpa(self) -> list[float]:
        """The same without the rounding of a block without stress."""
        return [round(1e-3 * pressure, 9) + 0.0 for pressure in self.cell_pa.tolist()]

    @property
    def touching(self) -> bool:
        """Whether the indenter touches the block."""
        return bool(self.state.active.any())

    @cached_property
    def shape_m(self) -> float | None:
        """Force per modulus and depth of an elastic block, where there is such a number."""
        return shape_of(self.numbers)

    def command(self, positions: Sequence[float | None]) -> None:
        """Tell the servo where to go from now on [mm]; None: it is limp."""
        (self.commanded_mm,) = positions

    def jam(self, label: str, jammed: bool = True) -> None:
        """Let the axis no longer move, whatever its servo does, or let it move again."""
        self.screw.jammed = jammed

    def kill(self, label: str, dead: bool = True) -> None:
        """Take all force from the servo, or give it back."""
        self._dead = dead

    def advance(self, duration_us: int, coil_power_w: Array) -> None:
        """Let time pass; OutOfModel when the block is pressed beyond what its model is valid for."""
        command_mm = None if self._dead else self.commanded_mm
        until_us = self._now_us + duration_us
        while self._now_us < until_us:
            next_us = min(until_us, self._now_us - self._now_us % self._step_us + self._step_us)
            self.screw.advance(command_mm, self.state.force, (next_us - self._now_us) * 1e-6)
            self._now_us = next_us
            if next_us % self._step_us == 0:
                self._press()

    def _press(self) -> None:
        """Advance the block by one of its steps."""
        before, at = self.state, 1e-3 * self.screw.at_mm
        if self._virgin and at <= (TACK if self.press.indenter.bonded else 0.0):
            self.state = self._in_the_air(at)
            return
        try:
            self.state = self._driven(self.press.start() if self._virgin else before, at)
        except BlockError as error:
            told = f"the press left what its model is valid for at {self.t_s:.2f} s, {error}"
            raise OutOfModel(told) from error
        if self.state.glue is not None and self.state.force < -self.numbers.pull_off:
            self.state = self.press.release(self.state)._replace(depth=self.state.depth)
        if before.active.any() and not self.touching:
            self.lost_contact_s = self.t_s
        self._remember()

    def _driven(self, before: Pressed, at: float) -> Pressed:
        """Return press and block after a step to there [m], or to where the servo has the force to get."""
        numbers = self.numbers
        there = follow(self.press, before, numbers.dt, at, numbers.backlash, numbers.tool_mass * numbers.g)
        sign = 1.0 if there.depth > before.depth else -1.0
        if there.depth == before.depth or sign * there.force <= numbers.screw.stall_n:
            return there
        there = self.press.advance(before, numbers.dt, force=sign * numbers.screw.stall_n)
        if sign * (there.depth - before.depth) < 0.0:  # the screw does not give way
            there = self.press.advance(before, numbers.dt, depth=before.depth)
        self.screw.at_mm = 1e3 * (there.depth + (numbers.backlash if sign > 0.0 else 0.0))  # pulled, it hangs
        return there

    @property
    def _virgin(self) -> bool:
        """Whether nothing has happened to the block yet."""
        return self.state.block.t == 0.0

    def _in_the_air(self, at: float) -> Pressed:
        """Return press and block before they first touch, with the press there [m]."""
        state = self.press.start()
        return state._replace(depth=at, active=np.zeros_like(state.active))

    def _remember(self) -> None:
        block = self.state.block
        self.force_peak_n = max(self.force_peak_n, self.state.force)
        self.von_mises_peak_pa = max(self.von_mises_peak_pa, float(von_mises(block.stress).max()))
        self.strain_peak = max(self.strain_peak, greatest(block.strain))

    def observe(self) -> dict[str, Any]:
        """Return what scales, rulers and the model itself would say."""
        return {
            "kind": "press",
            "depth_mm": 1e3 * self.state.depth,
            "axis_mm": self.screw.at_mm,
            "force_n": self.state.force,
            "force_peak_n": self.force_peak_n,
            "touching": self.touching,
            "dent_mm": 1e3 * max(0.0, -float(self.state.block.u[self.surface, 1].min())),
            "von_mises_peak_kpa": 1e-3 * self.von_mises_peak_pa,
            "strain_peak_percent": 100.0 * self.strain_peak,
            "cell_kpa": dict(zip(self.places, self.cell_kpa, strict=True)),
            "joint_mm": {self.joints[0]: self.screw.at_mm},
            "lost_contact_s": self.lost_contact_s,
            "shape_m": self.shape_m,
            "poisson_one": len(ratios(self.numbers.material)) == 1,
            "model": pressview.model(self),
        }

    def snapshot(self) -> dict[str, Any]:
        """Return block, surface, indenter and cells at this moment, mm."""
        return pressview.snapshot(self)

    def fields(self) -> dict[str, Any]:
        """Return the mesh, and displacement [mm], stress [kPa] and strain on it."""
        return pressview.fields(self)


def greatest(strain: Array) -> float:
    """Return the greatest principal strain in the plane, by its size, of strains (4, T) x, y, z, xy."""
    x, y, _, xy = strain
    mean, radius = 0.5 * (x + y), 0.5 * np.hypot(x - y, xy)
    return float((np.abs(mean) + radius).max())
