"""The command line `softrig`: a group whose commands are imported only when they are run.

Own commands stand in the table below, those of other packages among the entry points `softrig.commands`; so `--help`
imports none of them. This is the one place where an exception becomes a line on stderr and an exit status.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from errno import ENOSPC
from importlib import import_module
from typing import Any

import click

from host.cli.plugins import load, names, summary
from host.errors import SoftrigError

COMMANDS = {
    "ports": "List serial ports and running benches.",
    "info": "Say who a robot is and what it allows.",
    "status": "Ask a robot for its state.",
    "watch": "Watch variables of a robot as they change.",
    "arm": "Take a robot's lease, so that it takes orders.",
    "disarm": "Switch everything off and return the lease.",
    "fire": "Heat coils for a limited time.",
    "move": "Bring joints to a position and hold them for a limited time.",
    "orient": "Turn an object that two joints grip, by what the camera sees.",
    "press": "Press with a force that the robot regulates by its load cell.",
    "stop": "Switch everything off at once, from any state.",
    "sync": "Start the robots that wait for one word, together.",
    "clear": "Leave the tripped state after a stop or a fault.",
    "faults": "List the faults that a robot has kept.",
    "settings": "List or change what a robot keeps of itself.",
    "calibrate": "Measure and keep the resistance of every coil.",
    "check": "Prove a script against the limits of its robot.",
    "fmt": "Bring scripts into their one form.",
    "gait": "Scripts as JSON: export, import, schema.",
    "preview": "Show what a script will do, and how warm its coils get.",
    "run": "Check a script, run it, watch and report.",
    "key": "Make pairing keys.",
    "attach": "Take over the program that runs: watch it to its end, or stop it.",
    "lsp": "Serve an editor: mistakes, completion and hover for scripts.",
    "pause": "Have the program that runs stand still.",
    "resume": "Have a paused program go on.",
    "step": "Have a paused program go on by one step.",
    "explain": "Explain an error, refusal or fault code.",
    "deploy": "Put the firmware on a board and keep it once it is healthy.",
    "log": "Look into logs: info, export, plot.",
    "fit": "Estimate a material from the log of a press.",
    "figure": "Draw a figure of the paper from the bench.",
}
INTERRUPTED = 130
ENDS = [number for number in signal.Signals if number.name in ("SIGTERM", "SIGHUP")]


class Softrig(click.Group):
    """The group of all commands."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands, own and added."""
        return [*COMMANDS, *(name for name in names() if name not in COMMANDS)]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command, imported now; None when there is none of that name."""
        if cmd_name in COMMANDS:
            command: click.Command = import_module(f"host.cli.{cmd_name}").command
            return command
        return load(cmd_name)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands without importing any."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, COMMANDS.get(name) or summary(name)) for name in self.list_commands(ctx)])

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        """Return the command that `args` begin with; an unknown one is answered with the nearest."""
        if args and args[0] not in self.list_commands(ctx) and not args[0].startswith("-"):
            ctx.fail(f"no command {args[0]!r}{_nearest(args[0], self.list_commands(ctx))}")
        return super().resolve_command(ctx, args)

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        **extra: Any,
    ) -> Any:
        """Run a command and leave with its exit status."""
        if not standalone_mode:
            return super().main(args, prog_name, complete_var, standalone_mode=False, **extra)
        state: dict[str, Any] = {}
        try:
            with _every_end_heard():
                status = super().main(args, prog_name, complete_var, standalone_mode=False, obj=state, **extra)
        except (Exception, KeyboardInterrupt) as error:
            status = _told(error, bool(state.get("json")))
        sys.exit(status if isinstance(status, int) else 0)


@click.group(cls=Softrig, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(package_name="softrig", prog_name="softrig")
def main() -> None:
    """Run soft robots with shape-memory coils, finger joints or a press, on the bench and on the table.

    A robot is named by its address: sim:circular (a bench in this process), /dev/ttyACM0, socket://127.0.0.1:7000.
    Exit status: 0 done, 1 script failed, 2 usage, 3 no robot, 4 refused, 5 other protocol, 6 robot fault, 7 link lost,
    130 interrupted.
    """


def _told(error: BaseException, as_json: bool) -> int:
    """Say what happened and return the exit status; what is not foreseen is raised again."""
    if isinstance(error, click.exceptions.Exit):
        return error.exit_code
    if isinstance(error, click.ClickException):
        error.show()
        return error.exit_code
    if isinstance(error, (click.Abort, KeyboardInterrupt)):
        click.echo("softrig: interrupted; no robot was connected", err=True)
        return INTERRUPTED
    if isinstance(error, BrokenPipeError):
        sys.stderr.close()  # whoever read our output has gone; nothing is left to tell
        return 1
    if isinstance(error, OSError) and error.errno == ENOSPC:
        click.echo(f"softrig: the output cannot be written: {error.strerror}", err=True)
        with suppress(OSError):
            sys.stdout.close()  # else what is left in it is tried again, and told about, at the very end
        return 1
    if not isinstance(error, SoftrigError):
        raise error
    from host.cli.output import error_line, note  # noqa: PLC0415

    if as_json:
        click.echo(error_line(error))
    prefix = "" if getattr(error, "diagnostics", None) else "softrig: "
    note(f"{prefix}{error}")
    return error.exit_code


@contextmanager
def _every_end_heard() -> Iterator[None]:
    """Let every polite way of ending a program send stop first, also in the background of a shell."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, *ENDS)}
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        for number in ENDS:
            if before[number] is signal.SIG_DFL:
                signal.signal(number, lambda *_: signal.raise_signal(signal.SIGINT))
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler or signal.SIG_DFL)


def _nearest(word: str, known: list[str]) -> str:
    from difflib import get_close_matches  # noqa: PLC0415

    near = get_close_matches(word, known, n=1)
    return f"; did you mean {near[0]!r}?" if near else "; `softrig --help` lists them"
