"""`softrig lsp`: the language server for gait scripts, on stdin and stdout."""

from __future__ import annotations

import os
import sys

import click

from host.cli.options import given_key, robot_option
from host.lsp import open_server


@click.command("lsp")
@robot_option(required=False)
@click.option("--stdio", is_flag=True, hidden=True, expose_value=False)  # some editors add it
def command(robot: str | None) -> None:
    """Serve an editor: mistakes, completion, hover and more for gait scripts, while they are written.

    Editors start this by themselves, see docs/editors.md. Limits are asked of each script's robot.
    """
    server = open_server(robot, given_key())
    with os.fdopen(os.dup(1), "wb") as line:
        os.dup2(2, 1)  # whatever else is printed must not come between the messages
        server.start_io(sys.stdin.buffer, line)
