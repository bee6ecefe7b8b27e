"""The steps of a deployment: plan, copy, prove, flip, wait.

The program goes into the slot that does not run, so that a board whose cable is pulled at any moment still starts the
program it had. What is there already with the right hash is not copied again. The files at the root change last, each
in one step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from hashlib import sha256

from host.deploy.bootrecord import COPIES, NOWHERE, SLOTS, BootRecord
from host.deploy.console import Console, lines
from host.deploy.image import Image
from host.errors import LinkLost, ScriptFailed

HEALTHY_S = 90.0  # three tries, each 8 s to start and 10 s to be healthy, and the port's way back
HEALTHY = [f"softrig: slot {slot} is healthy" for slot in SLOTS]  # what firmware/start.py says
Progress = Callable[[str, int], None]  # the path that is being copied, the bytes copied in all


@dataclass(frozen=True)
class Plan:
    """What is to be done to a board: `write` and `remove` name paths on its flash."""

    target: int
    record: BootRecord  # before
    write: dict[str, bytes]
    remove: list[str]
    root: dict[str, bytes]
    done: bool  # the image runs already, and is confirmed


def planned(console: Console, image: Image) -> Plan:
    """Look at a board and return what is to be done."""
    on_root = {path: console.read(f"/{path}") for path in image.root}
    root = {path: data for path, data in image.root.items() if on_root[path] != data}
    record = BootRecord.newest(map(console.read, COPIES)) or _unrecorded(console, on_root)
    wanted = {path: sha256(data).hexdigest() for path, data in image.slot.items()}
    runs = record.slot if record.confirmed else record.fallback
    if record.confirmed and not root and runs != NOWHERE and console.hashes(f"/{SLOTS[runs]}") == wanted:
        return Plan(runs, record, {}, [], {}, done=True)
    target = 1 - runs if runs != NOWHERE else 0
    folder = f"/{SLOTS[target]}"
    there = console.hashes(folder)
    write = {f"{folder}/{path}": data for path, data in image.slot.items() if there.get(path) != wanted[path]}
    remove = [f"{folder}/{path}" for path in there if path not in wanted]
    return Plan(target, record, write, remove, root, done=False)


def _unrecorded(console: Console, on_root: dict[str, bytes | None]) -> BootRecord:
    """Return what a board without a record does: main.py runs slot a, if there are both."""
    runs_a = on_root["main.py"] is not None and console.hashes(f"/{SLOTS[0]}")
    return BootRecord(0, 0 if runs_a else NOWHERE)


def carried_out(console: Console, image: Image, plan: Plan, progress: Progress = lambda path, done: None) -> None:
    """Copy, prove and flip; LinkLost when a file on the board is not what was sent."""
    copied = 0
    for path, data in plan.write.items():
        console.write(path, data, lambda done, path=path, before=copied: progress(path, before + done))  # type: ignore[misc]
        copied += len(data)
    for path in plan.remove:
        console.remove(path)
    _prove(console.hashes(f"/{SLOTS[plan.target]}"), image.slot)
    for path, data in plan.root.items():
        console.write(f"/{path}.new", data)
        if console.read(f"/{path}.new") != data:
            raise LinkLost(f"{path} on the board is not what was sent: deploy again")
        console.rename(f"/{path}.new", f"/{path}")
    fallback = plan.record.slot if plan.record.confirmed else plan.record.fallback
    record = plan.record.trying(plan.target, fallback)
    console.write(record.path, record.packed())
    if console.read(record.path) != record.packed():
        raise LinkLost("the boot record was not written; the board still starts the program it had: deploy again")


def watched(port: str, target: int) -> None:
    """Wait until the new program is healthy; ScriptFailed when the board rolled back or has nothing to run."""
    slot, confirmed = _heard(port)
    if slot != target:
        raise ScriptFailed(f"the new program was never healthy: the board is back in slot {SLOTS[slot]} by itself")
    if not confirmed:
        raise ScriptFailed("the new program was never healthy, and there is none to fall back to: see docs/hardware.md")


def _heard(port: str) -> tuple[int, bool]:
    """Return which slot the board is in, and whether it stays there: from what it says, else from its record."""
    for line in lines(port, HEALTHY_S):
        if line in HEALTHY:
            return HEALTHY.index(line), True
        if line == "softrig: service":
            break
    with Console(port) as console:
        record = BootRecord.newest(map(console.read, COPIES))
        console.reset()
    if record is None:
        raise LinkLost(f"{port}: the boot record is gone: deploy again")
    return record.slot, record.confirmed


def _prove(there: dict[str, str], sent: dict[str, bytes]) -> None:
    wrong = [path for path, data in sent.items() if there.get(path) != sha256(data).hexdigest()]
    if wrong or len(there) != len(sent):
        raise LinkLost(f"{', '.join(wrong) or 'the slot'} on the board is not what was sent: deploy again")
