"""`softrig lsp`: the language server for gait scripts, on stdin and stdout."""

from __future__ import annotations

import os
import sys

import click

from host.cli.options import given_key, robot_option
from host.errors import BadRequest


@click.command("lsp")
@robot_option(required=False)
def command(robot: str | None) -> None:
    """Serve an editor: mistakes, completion, hover and more for gait scripts, while they are written.

    Editors start this by themselves, see docs/editors.md. Limits are asked of each script's robot.
    """
    try:
        from host.lsp.desk import Desk  # noqa: PLC0415
        from host.lsp.robots import Robots  # noqa: PLC0415
        from host.lsp.server import make_server  # noqa: PLC0415
    except ImportError as error:
        raise BadRequest("softrig lsp needs pygls: pip install 'softrig[lsp]'") from error
    server = make_server(Desk(Robots(given_key()), robot))
    with os.fdopen(os.dup(1), "wb") as line:
        os.dup2(2, 1)  # whatever else is printed must not come between the messages
        server.start_io(sys.stdin.buffer, line)
