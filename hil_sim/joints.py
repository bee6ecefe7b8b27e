"""The wires between joints and board: pulses to the servos, their current on the rail, what converter and camera see.

A servo turns its joint, in degrees, or drives a screw, in millimetres. Its range, which pulses of 0.5 to 2.5 ms cover,
is -90 to 90 deg or -10 to 10 mm. Its current goes through an amplifier of 0.5 V/A, its position through its own
potentiometer; both are read by the board's converter, in the order of the joints: currents on its first channels,
positions on those that follow. ASSUMED: the potentiometer has its middle at 0 and covers 5/3 of the range, as one of
300 degrees does on a servo of 180, so the ends of the range are 410 and 3686 counts.

    joints = Joints(plant, board, pins=[8, 9])
    joints.drive(now_us)            # pass on what the pulses command
    supply.load_a = joints.load_a
"""

from collections.abc import Callable, Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from hil_sim.board import Board
from hil_sim.record import JointRecord

CURRENT_V_PER_A = 0.5
REFERENCE_V = 3.3
MIDDLE_V = 2048 / 4096 * REFERENCE_V
END_V = 1638 / 4096 * REFERENCE_V  # from the middle to an end of the range
HORN_DEG = 90.0  # to which a servo's own pulses send it at the end of its range
RANGE = {"deg": 90.0, "mm": 10.0}  # from the middle to an end, in the joints' unit


@runtime_checkable
class Jointed(Protocol):
    """A body with joints, in the order of the firmware's channels."""

    @property
    def joints(self) -> Sequence[str]:
        """The joints."""

    @property
    def joint_unit(self) -> str:
        """What their positions are counted in: "deg" or "mm"."""

    @property
    def joint_position(self) -> NDArray[np.float64]:
        """Their positions, in their unit."""

    @property
    def joint_current_a(self) -> NDArray[np.float64]:
        """The currents of their servos [A]."""

    @property
    def object_deg(self) -> float | None:
        """The angle of the object that the camera looks at [deg], or None when there is none to be seen."""

    def command(self, positions: Sequence[float | None]) -> None:
        """Tell each servo where to go from now on, in the joints' unit; None: it is limp."""

    def snapshot(self) -> dict[str, Any]:
        """Return the shape, for pictures."""


class Joints:
    """Joints of a body on a board. `records` say what was done to each."""

    def __init__(self, plant: Jointed, board: Board, pins: Sequence[int]) -> None:
        self.records = [JointRecord(label) for label in plant.joints]
        self._plant = plant
        self._board = board
        self._servos = [board.servos[pin] for pin in pins]
        self._range = RANGE[plant.joint_unit]
        self._per_deg = self._range / HORN_DEG
        for index in range(len(pins)):
            board.adc.inputs[index] = self._current_v(index)
            board.adc.inputs[position_input(index, len(pins))] = self._position_v(index)

    @property
    def load_a(self) -> float:
        """Return what the servos take from the rail together."""
        return sum(map(self._current_a, range(len(self.records))))

    def drive(self, now_us: int) -> None:
        """Pass on where the pulses tell the servos to go; without power they are limp."""
        degrees = [servo.commanded_deg(now_us) if self._fed else None for servo in self._servos]
        positions = [None if degree is None else degree * self._per_deg for degree in degrees]
        self._plant.command(positions)
        for index, (record, position) in enumerate(zip(self.records, positions, strict=True)):
            record.command(position, now_us)
            record.peak_a = max(record.peak_a, self._current_a(index))

    def look(self, now_us: int) -> None:
        """Let the camera see the object."""
        if self._board.camera is not None:
            self._board.camera.expose(now_us, self._plant.object_deg)

    @property
    def _fed(self) -> bool:
        """Whether the servos have power: PWR_EN is closed, and the second contact of the emergency stop."""
        return self._board.powered and self._board.estop_closed

    def _current_a(self, index: int) -> float:
        return float(self._plant.joint_current_a[index]) if self._fed else 0.0

    def _current_v(self, index: int) -> Callable[[], float]:
        return lambda: CURRENT_V_PER_A * self._current_a(index)

    def _position_v(self, index: int) -> Callable[[], float]:
        return lambda: MIDDLE_V + END_V * float(self._plant.joint_position[index]) / self._range


def position_input(joint: int, joints: int) -> int:
    """Return the converter's input that reads the position of one of so many joints."""
    return joints + joint
