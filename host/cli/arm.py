"""`softrig arm`: takes the lease."""

from __future__ import annotations

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option, time_ms, without_option
from host.cli.output import emit


@click.command("arm")
@robot_option()
@click.option("--lease", type=time_ms, default="0", metavar="TIME", help="Lease to ask for. Default: the robot's own.")
@click.option(
    "--for", "hold_ms", type=time_ms, default="0", metavar="TIME", help="Stay, hold the lease this long, disarm."
)
@without_option
@json_option
def command(robot: str, lease: int, hold_ms: int, without: tuple[str, ...], as_json: bool) -> None:
    """Take a robot's lease, once it has tested every coil and joint, so that it takes orders.

    The robot disarms by itself when the lease runs out; `run`, `fire` and `move` arm it themselves.
    """
    with connected(robot) as face:
        face.arm(lease, without)
        status = face.status()
        for _ in face.listen(hold_ms):
            pass
        if hold_ms:
            face.disarm()
        face.leave_armed()
    lease_ms = lease or face.profile.session.lease_ms
    told = f"was armed for {hold_ms} ms" if hold_ms else f"armed; disarms itself in {lease_ms} ms"
    emit(as_json, {"state": status.state, "lease_ms": lease_ms, "held_ms": hold_ms}, [told])
