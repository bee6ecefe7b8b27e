"""`softrig deploy`: puts the firmware on a board."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import PurePosixPath

import click

from host.cli.connection import connected
from host.cli.options import json_option
from host.cli.output import emit
from host.deploy.bootrecord import SLOTS
from host.deploy.console import Console
from host.deploy.image import Image
from host.deploy.pairing import ask_for_console, chosen, settled
from host.deploy.steps import Progress, carried_out, planned, watched
from protocol import causes


@click.command("deploy")
@click.option("--port", metavar="PATH", help="The board's console: a Pico's own USB port, such as /dev/ttyACM0.")
@click.option("--robot-name", required=True, metavar="NAME", help="Whose profile, or the path of one (.json).")
@click.option("--robot", metavar="ADDRESS", help="The robot's own line: ordered to open its console, asked in the end.")
@click.option("--key", metavar="FILE", help="Give the robot this pairing key; it takes orders only with it then.")
@click.option("--unpair", is_flag=True, help="Take its pairing key away; it takes orders from everybody then.")
@click.option("--old-key", metavar="FILE", envvar="SOFTRIG_KEY", show_envvar=True, help="The key that it has now.")
@click.option("--dry-run", is_flag=True, help="List what belongs on the board; without a port, nothing is touched.")
@json_option
def command(
    port: str | None,
    robot_name: str,
    robot: str | None,
    key: str | None,
    unpair: bool,
    old_key: str | None,
    dry_run: bool,
    as_json: bool,
) -> None:
    """Put the firmware on a board, and keep it only once it is healthy.

    Copies into the slot that does not run, proves every file by its hash, starts it, and waits until it has been
    healthy for five seconds; if it never is, the board goes back to the program it had. Switches the robot off. May be
    broken off and begun again at any moment. With a port, --dry-run looks at the board, which resets it.

    A robot with a pairing key opens its console only when it is asked with that key on its own line, --robot, or when
    GP22 is bridged to ground at its reset.
    """
    image, keys = Image(robot_name), chosen(key, old_key, unpair)
    if port is None:
        if not dry_run:
            raise click.UsageError("name the board's console by --port; `softrig ports` lists them")
        _tell_dry(as_json, {**image.root, **{f"SLOT/{path}": data for path, data in image.slot.items()}})
        return
    if robot:
        ask_for_console(robot, keys)
    with Console(port) as console:
        plan = planned(console, image)
        if dry_run:
            _tell_dry(as_json, {**plan.root, **plan.write})
        elif not plan.done:
            with _shown(sum(map(len, plan.write.values()))) as progress:
                carried_out(console, image, plan, progress)
        pairing = "" if dry_run else settled(console, keys)
        console.reset()
    if dry_run:
        return
    if not plan.done:
        watched(port, plan.target)
    fields = {"slot": SLOTS[plan.target], "files": len(image.slot), "copied": len(plan.write), "healthy": True}
    answer = _answered(robot, keys.then) if robot else {}
    told = f"slot {SLOTS[plan.target]} runs the firmware of {robot_name}: {len(image.slot)} files, all hashes right"
    copied = f", {len(plan.write)} copied" if not plan.done else "; nothing was to be done"
    says = [f"{robot} answers: {answer['state']}, code {answer['code'] or 'none'}"] if robot else []
    emit(as_json, {**fields, "pairing": pairing or None, **answer}, [told + copied, *filter(None, [pairing]), *says])


def _answered(address: str, key: bytes) -> dict[str, str | None]:
    """Return what the robot says on its own line; SoftrigError when it does not answer or speaks another version."""
    with connected(address, watch_only=True, key=key) as face:
        status = face.status()
    row = causes.row(status.code)
    return {"state": status.state, "code": row.name if row else None}


def _tell_dry(as_json: bool, files: dict[str, bytes]) -> None:
    rows = [f"{len(data):7d}  {path}" for path, data in files.items()]
    told = f"{len(files)} files of {sum(map(len, files.values()))} bytes would be copied"
    emit(as_json, {"files": {path: len(data) for path, data in files.items()}}, [*rows, told])


@contextmanager
def _shown(total_bytes: int) -> Iterator[Progress]:
    """Show a bar on stderr within the block; silent in pipes."""
    if not sys.stderr.isatty():
        yield lambda path, done: None
        return
    from rich.console import Console as Terminal  # noqa: PLC0415
    from rich.progress import Progress as Bars  # noqa: PLC0415

    with Bars(console=Terminal(stderr=True), transient=True) as bars:
        task = bars.add_task("copy", total=total_bytes)
        yield lambda path, done: bars.update(task, completed=done, description=PurePosixPath(path).name)
