"""How a running bench is found by other programs of the same user, `softrig ports` among them.

with Announcement({"robot": "circular", "pty": "/dev/pts/3", "link": None}):
    ...
"""

import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self


class Announcement:
    """A small JSON file by which other programs of this user find a running bench; gone when it ends."""

    def __init__(self, fields: Mapping[str, Any]) -> None:
        folder = announcements()
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        for old in folder.glob("*.json"):
            if not _lives(old.stem):
                old.unlink(missing_ok=True)
        self._file = folder / f"{os.getpid()}.json"
        self._file.write_text(json.dumps({"pid": os.getpid(), **fields}) + "\n")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._file.unlink(missing_ok=True)


def announcements() -> Path:
    """Return the folder of this user's announcements, PID.json each."""
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    return Path(runtime) / "softrig" if runtime else Path(tempfile.gettempdir()) / f"softrig-{os.getuid()}"


def _lives(pid: str) -> bool:
    try:
        os.kill(int(pid), 0)
    except (ProcessLookupError, ValueError):
        return False
    except PermissionError:
        pass
    return True
