"""`softrig run`: a script from check to report."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Any, NamedTuple

import click

from host.cli.asking import typed_lines
from host.cli.options import given_key, if_lost_options, json_option, robot_option, without_option
from host.cli.output import emit, json_line, note, writing
from host.cli.progress import shown
from host.cli.scripts import place, proven
from host.errors import BadRequest
from host.gait.compiler import Compiled
from host.gait.script import load
from host.keeper import Keeper
from host.link import open_link, wall_s
from host.log import LogWriter
from host.report import Facts, Took, lines, report
from host.robot import Robot
from host.run import Ending, IfLost, Progress, Take, announce, outliving, run
from host.stepping import Stepper
from host.view import check_pictures, draw_run


@click.command("run")
@click.argument("script", type=click.Path())
@robot_option(required=False)
@click.option("-p", "--param", "params", multiple=True, metavar="NAME=VALUE", help="Give a parameter another value.")
@click.option("--dry-run", is_flag=True, help="Check and upload, but do not arm: nothing moves.")
@click.option("--log", "log_path", type=click.Path(path_type=Path), metavar="FILE.mcap", help="Record everything.")
@click.option("--plot", "plot_path", type=click.Path(path_type=Path), metavar="FILE.svg", help="Draw the run.")
@click.option("--from", "begin", type=int, default=1, metavar="STEP", help="Begin with a step that a run told of.")
@click.option("--stream", is_flag=True, help="Send the program while it runs: it need not fit into the robot.")
@click.option("--step", "by_hand", is_flag=True, help="Stand still before each step until Enter is pressed.")
@if_lost_options
@click.option("--outlive", is_flag=True, help="The program goes on should this host die; `softrig attach` takes it up.")
@without_option
@json_option
def command(
    script: str,
    robot: str | None,
    params: tuple[str, ...],
    without: tuple[str, ...],
    dry_run: bool,
    log_path: Path | None,
    plot_path: Path | None,
    begin: int,
    stream: bool,
    by_hand: bool,
    if_lost: str,
    patience: int,
    outlive: bool,
    as_json: bool,
) -> None:
    """Check a script, upload it, arm, run, watch, disarm and report.

    Ctrl-C sends stop, waits for the robot's answer and says what it was.
    """
    if stream and outlive:
        raise BadRequest("--stream and --outlive: a program that is sent while it runs cannot outlive its host")
    tree = load(script)
    address, key = place(tree, robot), given_key()
    if plot_path:
        check_pictures(plot_path)
    with LogWriter(log_path) if log_path else nullcontext() as log:
        link = open_link(address)
        keeper = Keeper(log, link.observer, scenes=bool(log_path or plot_path), drawn=plot_path is not None)
        with Robot(link, keeper, key) as face:
            face.connect()
            keeper.know(face.profile.parts)
            keeper.recording.title = f"{Path(script).name} on {address}"
            compiled, worst = proven(tree, face.profile, params, begin, stream)
            keeper.steps = compiled.steps
            _attach(log, compiled, face, address)
            channels = len(face.profile.labels)
            stepper = _stepper(face, compiled, stream) if by_hand and not dry_run else None
            with shown(len(compiled.code), channels, worst.longest_ms / 1000, quiet=as_json or by_hand) as progress:
                if outlive:
                    note(f"session {face.talk.session.number}: `softrig attach` takes the program up again")
                code = outliving(compiled.program) if outlive else compiled.program
                lost = IfLost(if_lost == "stop", patience)
                orders = Orders(dry_run, without, lost, log is not None, stream, stepper)
                ending, took = _run(face, code, orders, progress)
            facts = Facts(compiled, address, face.info(), face.statistics(), link.observer, took, face.interruptions())
            fields = report(ending, keeper.recording, facts)
        if log:
            log.attach("report.json", json_line(fields).encode(), "application/json")
    emit(as_json, fields, lines(fields))
    if plot_path and keeper.recording.telemetry:
        with writing(plot_path):
            draw_run(keeper.recording, plot_path)
        note(f"picture: {plot_path}")
    error = ending.error() if ending else None
    if error:
        raise error


class Orders(NamedTuple):
    """How a program is to be run, if at all."""

    dry_run: bool
    without: tuple[str, ...]
    if_lost: IfLost
    finely: bool  # for the log
    streamed: bool
    stepper: Take | None


def _run(face: Robot, code: bytes, orders: Orders, progress: Progress) -> tuple[Ending | None, Took]:
    """Run the program, or only upload it; return how it ended and how long it took."""
    begun = wall_s(), face.link.now_s()
    ending = None
    if orders.dry_run:
        announce(face, code, progress, orders.streamed)
    else:
        ending = run(face, code, progress, *orders[1:])
    return ending, Took(wall_s() - begun[0], face.link.now_s() - begun[1])


def _stepper(face: Robot, compiled: Compiled, streamed: bool) -> Take:
    """Return what asks the operator about each step, in virtual time as long as it takes."""
    waits = bool(getattr(face.link, "repeatable", False))
    return Stepper(face, compiled, typed_lines(waits), note, streamed, waits).take


def _attach(log: LogWriter | None, compiled: Compiled, face: Robot, address: str) -> None:
    """Put into the log what the run can be understood and repeated from."""
    if log is None:
        return
    versions: dict[str, Any] = {
        "script": compiled.script.main.name,
        "address": address,
        "parameters": {name: str(value) for name, value in compiled.params.items()},
        **face.info(),
    }
    for file in compiled.script.files:
        log.attach(file.name, "\n".join(file.lines).encode())
    log.attach("dictionary.txt", face.dictionary)
    log.attach("versions.json", json_line(versions).encode(), "application/json")
