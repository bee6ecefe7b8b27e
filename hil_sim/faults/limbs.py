"""What faults of joints and of the camera do to a bench; see parts.py for how they are written.

A joint fails from the body's last step on, at most a point of the grid ago.
"""

from collections.abc import Callable
from random import Random
from typing import Protocol, runtime_checkable

from hil_sim.bench import Bench
from hil_sim.devices.anglecamera import AngleCamera
from hil_sim.faults.parts import Mend, Mishap, Value
from hil_sim.joints import Jointed, position_input


@runtime_checkable
class Breakable(Jointed, Protocol):
    """A body whose joints can fail."""

    def jam(self, label: str, jammed: bool = True) -> None:
        """Let a joint no longer turn, or let it turn again."""

    def kill(self, label: str, dead: bool = True) -> None:
        """Take all torque from a servo, or give it back."""


def of_a_joint(switch: Callable[[Bench, Breakable, str, bool], None]) -> Mishap:
    """Return what lasts on one joint, whose label is the argument."""

    def happen(bench: Bench, label: Value, _draw: Random) -> Mend | None:
        body = bench.plant
        if not isinstance(body, Breakable):
            return None
        switch(bench, body, str(label), True)
        return lambda: switch(bench, body, str(label), False)

    return happen


def joint_jam(_bench: Bench, body: Breakable, label: str, jammed: bool) -> None:
    """Keep a joint where it is, whatever its servo does."""
    body.jam(label, jammed)


def servo_dead(_bench: Bench, body: Breakable, label: str, dead: bool) -> None:
    """Take all torque from a servo."""
    body.kill(label, dead)


def pot_open(bench: Bench, body: Breakable, label: str, broken: bool) -> None:
    """Break the wire of a joint's potentiometer: its input is pulled to ground."""
    channel = position_input(list(body.joints).index(label), len(body.joints))
    (bench.board.adc.opened.add if broken else bench.board.adc.opened.discard)(channel)


def camera(change: Callable[[AngleCamera, bool], None]) -> Callable[[Bench, bool], None]:
    """Return what does that to the camera of a robot that has one."""

    def switch(bench: Bench, on: bool) -> None:
        if bench.board.camera is not None:
            change(bench.board.camera, on)

    return switch


def camera_lost(camera: AngleCamera, lost: bool) -> None:
    """Let the camera fall silent."""
    camera.alive = not lost


def camera_frozen(camera: AngleCamera, frozen: bool) -> None:
    """Have the camera give its last frame for ever."""
    camera.frozen = frozen


def object_hidden(camera: AngleCamera, hidden: bool) -> None:
    """Put something between the camera and the object."""
    camera.hidden = hidden
