"""The progress of an upload and a run on the terminal; silent in pipes."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from host.run import Progress


@contextmanager
def shown(code_bytes: int, channels: int, longest_s: float, quiet: bool = False) -> Iterator[Progress]:
    """Show bars on stderr within the block: bytes uploaded, channels tested, seconds run of the longest it may take."""
    if quiet or not sys.stderr.isatty():
        yield lambda stage, done: None
        return
    from rich.console import Console  # noqa: PLC0415
    from rich.progress import BarColumn, TextColumn  # noqa: PLC0415
    from rich.progress import Progress as Bars  # noqa: PLC0415

    columns = (
        TextColumn("{task.description:>9}"),
        BarColumn(),
        TextColumn("{task.completed:.1f} of {task.total:.1f} {task.fields[unit]}"),
    )
    with Bars(*columns, console=Console(stderr=True), transient=True) as bars:
        stages = {
            "upload": bars.add_task("upload", total=code_bytes, unit="bytes"),
            "self-test": bars.add_task("self-test", total=channels, unit="channels"),
            "run": bars.add_task("run", total=longest_s, unit="s at most"),
        }
        yield lambda stage, done: bars.update(stages[stage], completed=done)
