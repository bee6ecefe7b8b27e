"""What a press feels while it presses, kept up to date on the terminal; silent in pipes."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from host.cli.output import printable
from host.profile import Parts
from host.records import Telemetry

DRAWN_EVERY_MS = 100

Show = Callable[[Telemetry], None]


@contextmanager
def gauge(target_n: float, parts: Parts, quiet: bool = False) -> Iterator[Show]:
    """Show on stderr, within the block, the force of each record beside the one that was asked for."""
    if quiet or not sys.stderr.isatty():
        yield lambda record: None
        return
    from rich.console import Console  # noqa: PLC0415
    from rich.live import Live  # noqa: PLC0415
    from rich.text import Text  # noqa: PLC0415

    drawn_ms = -DRAWN_EVERY_MS
    with Live(console=Console(stderr=True), auto_refresh=False, transient=True) as live:

        def show(record: Telemetry) -> None:
            nonlocal drawn_ms
            if record.host_ms - drawn_ms >= DRAWN_EVERY_MS:
                drawn_ms = record.host_ms
                live.update(Text(printable(reading(record, parts, target_n))), refresh=True)

        yield show


def reading(record: Telemetry, parts: Parts, target_n: float) -> str:
    """Return a record as a line: force, positions, pressures."""
    force = "-" if record.load_n is None else f"{record.load_n:.2f} N"
    told = [f"{force} of {target_n:g} N"]
    told += [
        f"{label} {position:.2f} {parts.unit}"
        for label, position in zip(parts.joints, record.joint_position, strict=False)
    ]
    cells = [f"{label} {kpa:.2f}" for label, kpa in zip(parts.cells, record.cell_kpa, strict=False)]
    told += [f"{' '.join(cells)} kPa"] if cells else []
    return "   ".join(told)
