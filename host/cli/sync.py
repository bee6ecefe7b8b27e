"""`softrig sync`: the word for which robots wait that were told to start together."""

from __future__ import annotations

from contextlib import closing

import click

from host.cli.options import robot_option
from host.link import open_link
from protocol import frames, messages


@click.command("sync")
@robot_option(ordered=False)
def command(robot: str) -> None:
    """Start the programs that wait for this word: on CAN those of all robots on the bus, unless one is named."""
    with closing(open_link(robot)) as link:
        link.write(frames.encode(frames.seal(messages.SYNC.number, 0, 0, b"", 0, 0)))
