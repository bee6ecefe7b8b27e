"""Where a robot may be: serial ports of this machine, and benches that are running.

A bench announces itself by a file PID.json in the user's runtime folder; one whose process has ended is passed over.
Nothing is opened: looking for ports never disturbs a robot.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

MAKERS = {0x2E8A: "Raspberry Pi", 0x1A86: "CH340", 0x0403: "FTDI", 0x10C4: "CP210x"}


@dataclass(frozen=True, slots=True)
class Place:
    """An address to try, and what is known about it without asking."""

    address: str
    kind: str
    about: str


def places() -> list[Place]:
    """Return all serial ports and running benches."""
    return [*serial_ports(), *benches()]


def serial_ports() -> Iterator[Place]:
    """Yield the serial ports that the system lists, except those without any device behind them."""
    from serial.tools.list_ports import comports  # noqa: PLC0415

    for port in sorted(comports()):
        if port.hwid != "n/a":
            maker = MAKERS.get(port.vid or 0, "")
            number = f"serial number {port.serial_number}" if port.serial_number else ""
            yield Place(port.device, "serial", ", ".join(filter(None, (port.description, maker, number))))


def benches(folder: Path | None = None) -> Iterator[Place]:
    """Yield the addresses of the benches that run now, from their announcements."""
    for file in sorted((folder or runtime_folder()).glob("*.json")):
        try:
            fields = json.loads(file.read_text(encoding="utf-8"))
            others = list(fields.get("ptys", {}).values())[1:]  # of the robots after the first
            addresses = [fields.get("link") or fields.get("pty"), fields.get("tcp"), *others, *fields.get("can", [])]
            alive = lives(int(fields["pid"]))
        except (OSError, ValueError, KeyError, AttributeError, TypeError):
            continue
        for address in filter(None, addresses if alive else ()):
            yield Place(str(address), "bench", f"{fields.get('robot', '?')}, process {fields['pid']}")


def runtime_folder() -> Path:
    """Return the folder in which benches of this user announce themselves."""
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    return Path(runtime) / "softrig" if runtime else Path(tempfile.gettempdir()) / f"softrig-{os.getuid()}"


def lives(pid: int) -> bool:
    """Return whether that process is running."""
    try:
        os.kill(pid, 0)
    except PermissionError:
        return True
    except OSError:
        return False
    return True
