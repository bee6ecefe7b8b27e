"""Who holds a port: the name and process id that /proc shows, where there is a /proc."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

PROC = Path("/proc")


def holder_of(path: str, proc: Path = PROC) -> str:
    """Return `NAME (process PID)` of the program that has locked or opened `path`, or "another program"."""
    own = os.getpid()
    for pid in (*_lockers(path, proc), *_openers(path, proc)):
        if pid != own:
            return f"{_name(pid, proc)} (process {pid})"
    return "this very program" if own in _lockers(path, proc) else "another program"


def _lockers(path: str, proc: Path) -> Iterator[int]:
    """Yield the processes that hold a lock on the file, from /proc/locks."""
    try:
        inode = os.stat(path).st_ino
        lines = (proc / "locks").read_text().splitlines()
    except OSError:
        return
    for line in lines:
        fields = line.split()
        if len(fields) > 5 and fields[1] == "FLOCK" and fields[5].endswith(f":{inode}") and int(fields[4]) > 0:
            yield int(fields[4])


def _openers(path: str, proc: Path) -> Iterator[int]:
    """Yield the processes that have the file open, as far as this user may see them."""
    target = os.path.realpath(path)
    for folder in proc.glob("[0-9]*/fd"):
        try:
            if any(os.readlink(entry) == target for entry in folder.iterdir()):
                yield int(folder.parent.name)
        except OSError:
            continue


def _name(pid: int, proc: Path) -> str:
    try:
        return (proc / str(pid) / "comm").read_text().strip()
    except OSError:
        return "a program"
