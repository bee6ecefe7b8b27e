"""Robots of the bench on a CAN bus in this process, as hosts reach them."""

from collections.abc import Iterator
from contextlib import contextmanager

from host.canbus import CanBus


@contextmanager
def opened(address: str) -> Iterator[CanBus]:
    """Open a bus; at the end every line to it is closed."""
    bus = CanBus.open(address)
    try:
        yield bus
    finally:
        for line in list(bus._lines):
            line.close()
