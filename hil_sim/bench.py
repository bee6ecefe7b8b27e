"""The bench: core board, body and firmware in lock-step on one clock.

The body is advanced on a fixed grid of 5 ms and whenever a gate changes, so what happens does not depend on who looks,
how often, or how fast. The bench moves bytes, switches coils and passes pulses on; it can read neither messages nor
coil orders. Where the pulses of a servo send it at a point of the grid, it goes until the next.

    bench = Bench(parts, plant, image)
    bench.run(seconds=2)
    bench.coil_gate("A"), bench.coil("A").on_us(bench.clock.now_us)
    bench.close()

Several robots live in lock-step on one clock, and on one CAN bus, when each bench is given both (can/desk.py).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hil_sim.board import Board
from hil_sim.clock import Clock
from hil_sim.devices.anglecamera import Optics
from hil_sim.devices.canwire import CanWire
from hil_sim.devices.flash import Flash
from hil_sim.devices.lsm6ds3tr import Motion
from hil_sim.devices.ntc import Ntc
from hil_sim.devices.servo import DEAD_BAND_US
from hil_sim.joints import Jointed, Joints
from hil_sim.journal import Journal
from hil_sim.loadcells import ForceCells, LoadCell, Loaded, connect
from hil_sim.plant import Meshed, Plant
from hil_sim.record import CoilRecord, JointRecord
from hil_sim.soundness import EVERY_US, Soundness
from hil_sim.supply import Battery, Supply
from hil_sim.worlds import cpython
from hil_sim.worlds.image import Image
from hil_sim.worlds.world import Crash, Interpreter, World

GRID_US = 5_000


@dataclass(frozen=True)
class Parts:
    """The electrical parts around the chips, in the order of the plant's coils and joints."""

    outputs: Sequence[tuple[int, int]]  # PWM chip and output of each coil
    series_ohm: Sequence[float]  # wiring and switch of each coil
    source_ohm: float = 0.02  # shared by all coils, the shunt included
    shunt_ohm: float = 0.02
    supply_v: float = 2.0
    battery: Battery | None = None  # on board, in place of the bench supply
    ambient_degc: float = 25.0
    ntc: Ntc | None = None
    imu: bool = False  # an attitude sensor rides on the core, if the plant says how that moves
    servos: Sequence[int] = ()  # the processor's pin of each joint
    servo_dead_band_us: float = DEAD_BAND_US
    camera: Optics | None = None  # looks at the object, if the plant has one
    load_cell: LoadCell | None = None  # if the plant is pressed with a force
    force_cells: ForceCells | None = None  # inside the plant


class Bench:
    """One robot on the bench, powered on as it is made; a body that comes apart ends it with CameApart."""

    def __init__(
        self,
        parts: Parts,
        plant: Plant,
        image: Image,
        execute: Interpreter = cpython.execute,
        *,
        baud: int = 115_200,
        identity: str = "softrig",
        ticks_start_us: int = 0,
        keep_journal: bool = False,
        clock: Clock | None = None,
        can_wire: CanWire | None = None,
    ) -> None:
        self.closed = False
        self._shares = clock is not None
        self.clock = clock or Clock()
        self.journal = Journal(keep_journal)
        self.plant = plant
        series_ohm = np.array(parts.series_ohm, float)
        self.supply = Supply(series_ohm, parts.source_ohm, parts.shunt_ohm, parts.supply_v, parts.battery)
        motion = plant if parts.imu and isinstance(plant, Motion) else None
        ntc = parts.ntc or Ntc()
        self.board = Board(
            self.clock, self.journal, self.supply, parts.outputs, ntc, baud, identity, motion, can_wire, parts.camera,
            parts.servo_dead_band_us,
        )  # fmt: skip
        self.board.flash = Flash({path: image.read(path) for path in image.paths()})
        self.board.degc = parts.ambient_degc
        self.board.changed = self._gates_changed
        self.coils = [CoilRecord(label) for label in plant.labels]
        self._joints = Joints(plant, self.board, parts.servos) if isinstance(plant, Jointed) else None
        if isinstance(plant, Loaded) and parts.load_cell and parts.force_cells:
            connect(plant, self.board, len(parts.servos), parts.load_cell, parts.force_cells)
        self.world = World(self.board, image, execute, ticks_start_us)
        self._by_label = {coil.label: coil for coil in self.coils}
        self._began_us = self._advanced_us = self.clock.now_us
        self._hot = False
        self._soundness = Soundness()
        self._soundness.look(plant.snapshot(), self.clock.now_us / 1e6)
        self._peak_degc = plant.temperature.copy()
        self._energy_j = np.zeros(len(self.coils))
        self._glance: Callable[[int], None] | None = None
        self._grid_at = self.clock.at(self.clock.now_us + GRID_US, self._grid)
        self.world.power_on()

    def run(self, seconds: float) -> None:
        """Let virtual time pass."""
        self.clock.run_until(self.clock.now_us + round(seconds * 1e6))

    def coil_gate(self, label: str) -> float:
        """Return the share of the PWM period for which a coil is heated now."""
        return self._by_label[label].duty

    def coil(self, label: str) -> CoilRecord:
        """Return what was done to a coil; its peak and energy as of the last grid point or change."""
        record = self._by_label[label]
        index = self.coils.index(record)
        record.peak_degc = float(self._peak_degc[index])
        record.energy_j = float(self._energy_j[index])
        return record

    @property
    def joints(self) -> list[JointRecord]:
        """Return what was done to each joint, as of the last grid point or change."""
        return self._joints.records if self._joints else []

    def joint(self, label: str) -> JointRecord:
        """Return what was done to a joint."""
        return next(joint for joint in self.joints if joint.label == label)

    def break_coil(self, label: str, broken: bool = True) -> None:
        """Open the wire of a coil, or mend it."""
        self.supply.break_coil(self.coils.index(self._by_label[label]), broken)
        self._gates_changed()

    @property
    def any_coil_on(self) -> bool:
        """Whether any coil is being heated."""
        return self._hot

    @property
    def any_joint_driven(self) -> bool:
        """Whether any joint is told to go anywhere: it is limp else."""
        return any(joint.position is not None for joint in self.joints)

    @property
    def crashes(self) -> list[Crash]:
        """What has escaped the firmware."""
        return self.world.crashes

    def trace_sha256(self) -> str:
        """Return the hash over all that crossed the edge of a chip or came from outside."""
        return self.journal.trace_sha256()

    def observe(self) -> dict[str, Any]:
        """Return what a motion capture system would see, and what was done to each coil and joint."""
        now_us = self.clock.now_us
        coils = {coil.label: self.coil(coil.label) for coil in self.coils}
        driven_s = {joint.label: joint.driven_us(now_us) / 1e6 for joint in self.joints}
        battery = self.supply.battery
        return {
            **self.plant.observe(),
            **({"battery_percent": 100.0 * battery.charge} if battery else {}),
            **({"joint_driven_s": driven_s} if driven_s else {}),
            "t_s": now_us / 1e6,
            "coil_on_s": {label: coil.on_us(now_us) / 1e6 for label, coil in coils.items()},
            "coil_energy_j": {label: coil.energy_j for label, coil in coils.items()},
            "coil_peak_degc": {label: coil.peak_degc for label, coil in coils.items()},
            "firmware_resets": self.world.resets,
            "firmware_crashes": [crash.error for crash in self.crashes],
            "trace_sha256": self.trace_sha256(),
        }

    def snapshot(self) -> dict[str, Any]:
        """Return the shape for pictures, with each coil's duty."""
        seen = self.plant.snapshot()
        coils: Mapping[str, dict[str, Any]] = seen["coils"]
        for label, coil in coils.items():
            coil["duty"] = self.coil_gate(label)
        return seen

    def fields(self) -> dict[str, Any] | None:
        """Return displacement, strain and stress of a body that is a mesh, None of one that is not."""
        return self.plant.fields() if isinstance(self.plant, Meshed) else None

    def watch(self, glance: Callable[[int], None]) -> None:
        """Have `glance` called with virtual time in ms whenever the body has reached a point of its grid."""
        self._glance = glance

    def close(self) -> None:
        """End the firmware; a closed bench cannot be run again. On a shared clock all its power goes off, too."""
        if self.closed:
            return
        self.closed = True
        self._grid_at.cancel()
        self.world.close()
        self.board.unplug()
        if self._shares:
            self.world.power_off()
            self._advance()
            for coil in self.coils:
                coil.switch(0.0, self.clock.now_us)

    def _grid(self) -> None:
        self._advance()
        if self._joints is not None:
            self._joints.look(self.clock.now_us)
        if self._hot or self.supply.stale:  # resistances have changed, or the source, or the load
            self.board.monitor.before_change()
            self.supply.solve(self.plant.resistance)
            self.board.monitor.after_change()
        if (self.clock.now_us - self._began_us) % EVERY_US == 0:
            self._soundness.look(self.plant.snapshot(), self.clock.now_us / 1e6)
        self._grid_at = self.clock.at(self.clock.now_us + GRID_US, self._grid)
        if self._glance is not None:
            self._glance(self.clock.now_us // 1000)
        if self.world.running and self.supply.battery is not None and self.supply.battery.cut:
            self.world.power_off()

    def _gates_changed(self) -> None:
        self._advance()
        self.board.monitor.before_change()
        if self._joints is not None:
            self._take_up(self._joints)
        gates = self.board.gates()
        self.supply.drive(gates, self.board.pwm_period_us())
        self.supply.solve(self.plant.resistance)
        self.board.monitor.after_change()
        for coil, (_, width) in zip(self.coils, gates, strict=True):
            coil.switch(width, self.clock.now_us)
        self._hot = any(coil.duty for coil in self.coils)

    def _advance(self) -> None:
        """Bring the body up to now with the powers that have held since the last time."""
        duration_us = self.clock.now_us - self._advanced_us
        if not duration_us:
            return
        self._advanced_us = self.clock.now_us
        if self.board.imu is not None:
            self.board.imu.before_change()
        self.plant.advance(duration_us, self.supply.power_w)
        if self._joints is not None:
            self._take_up(self._joints)
        self.supply.spend(duration_us)
        if self._hot:
            self._energy_j += self.supply.power_w * (duration_us * 1e-6)
            np.maximum(self._peak_degc, self.plant.temperature, out=self._peak_degc)

    def _take_up(self, joints: Joints) -> None:
        """Have the servos go where the pulses say from now on, and take their current from the rail."""
        joints.drive(self.clock.now_us)
        self.supply.load_a = joints.load_a
