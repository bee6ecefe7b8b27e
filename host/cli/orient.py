"""`softrig orient`: turns an object that two joints grip."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import click

from host.cli.connection import connected
from host.cli.motion import PERIOD_MS, Motion, lines, watched
from host.cli.options import angle_centideg, json_option, robot_option, time_ms
from host.cli.output import emit
from host.errors import BadRequest
from host.robot import Robot

CLOSE_MS = 1000
SETTLE_MS = 300  # between the grip and the turn
SPARE_MS = 2000  # for the order to turn to arrive
NEAR_DEG = 0.1  # of the limit of the swing: the dead band of a servo


@click.command("orient", context_settings={"ignore_unknown_options": True})  # the angle may begin with a minus
@click.argument("angle", type=angle_centideg, metavar="ANGLE")
@robot_option()
@click.option("--grip", type=angle_centideg, required=True, metavar="ANGLE", help="How far both close inward first.")
@click.option(
    "--swing", type=angle_centideg, default="0deg", show_default=True, metavar="ANGLE",
    help="Where both close: an object that was let go stands where the last turn swung it.",
)  # fmt: skip
@click.option(
    "--for", "lasting", type=time_ms, default="3s", show_default=True, metavar="TIME", help="Regulate so long."
)
@click.option("--hold", type=time_ms, default="1s", show_default=True, metavar="TIME", help="Hold so long, then limp.")
@json_option
def command(angle: int, robot: str, grip: int, swing: int, lasting: int, hold: int, as_json: bool) -> None:
    """Turn an object to an angle: arms, closes both joints on it, has the robot regulate it by its camera, disarms.

    The robot swings both joints together until the camera sees the angle, and leaves their grip alone; then it holds.
    """
    if grip <= 0:
        raise BadRequest(f"--grip {grip / 100:g}deg: both joints close inward, so write an angle above 0")
    with connected(robot) as face:
        face.subscribe(PERIOD_MS)
        face.arm()
        labels = _grip(face, grip, swing)
        face.orient(angle, lasting, hold)
        motion = watched(face, lasting + hold)
        face.disarm()
    swing_deg = _swing_deg(motion, labels)
    fields = {
        "target_deg": angle / 100,
        "reached_deg": motion.object_deg,
        "grip_deg": grip / 100,
        "swing_deg": swing_deg,
        "swing_max_deg": _swing_max_deg(face, grip, swing_deg or 0.0),
        "for_ms": lasting,
        "hold_ms": hold,
        "joints": motion.of(labels),
    }
    emit(as_json, fields, _lines(fields))


def _grip(face: Robot, grip_centideg: int, swing_centideg: int) -> tuple[str, ...]:
    """Close the first two joints inward from that swing and return their labels; BadRequest when there are no two."""
    limits, labels = face.profile.servo, face.profile.joint_labels[:2]
    if len(labels) < 2:
        raise BadRequest(f"{face.profile.robot} has no two joints that could hold an object")
    hold_ms = min(SETTLE_MS + SPARE_MS, limits.hold_max_ms)
    face.move(labels[:1], swing_centideg + grip_centideg, CLOSE_MS, hold_ms)
    face.move(labels[1:], swing_centideg - grip_centideg, CLOSE_MS, hold_ms)
    watched(face, CLOSE_MS + SETTLE_MS)
    return labels


def _swing_deg(motion: Motion, labels: tuple[str, ...]) -> float | None:
    """Return how far both joints have swung together, or None when nothing was heard of them."""
    angles = [motion.commanded[label] for label in labels if label in motion.commanded]
    return round(sum(angles) / 2, 2) if len(angles) == 2 else None


def _swing_max_deg(face: Robot, grip_centideg: int, swing_deg: float) -> float | None:
    """Return how far both joints may swing to that side with that grip, or None where the robot does not say."""
    limits, orient = face.profile.servo, face.profile.orient
    room_centi = (limits.most_centi if swing_deg > 0 else -limits.least_centi) - grip_centideg
    return min(orient.swing_max_centideg, room_centi) / 100 if orient else None


def _lines(fields: dict[str, Any]) -> Iterator[str]:
    reached = fields["reached_deg"]
    seen = "was not seen" if reached is None else f"at {reached:.2f} deg"
    swing = fields["swing_deg"]
    swung = "" if swing is None else f"; swing {swing:.2f} deg, grip {fields['grip_deg']:g} deg"
    yield f"object {seen}, told {fields['target_deg']:g} deg{swung}"
    most = fields["swing_max_deg"]
    if swing is not None and most is not None and abs(swing) > most - NEAR_DEG:
        yield f"the swing is at its limit of {most:g} deg: it turns the object no further"
    yield from lines(fields["joints"], "deg")
