"""The fault campaign: many random trials (trials.py) and killed hosts (deaths.py), on all cores, resumable.

    python -m tests.campaign                 # 1000 of each; goes on where one of the same tree was interrupted
    python -m tests.campaign --only trial:17 # one of them, told in full

Results are kept a line each in out/campaign.jsonl, under a hash of all sources that they depend on; results of
another tree are dropped. Ends with a table by fault and, for each violation, the command that shows it again.
"""

import argparse
import hashlib
import json
import os
import signal
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from tests import deaths, trials

ROOT = Path(__file__).parents[1]
SOURCES = ("firmware", "protocol", "hil_sim", "host", "gaits", "tests")
SUFFIXES = (".py", ".json", ".toml", ".gait")
KINDS: dict[str, Callable[[int], dict[str, Any]]] = {"trial": trials.row_of, "death": deaths.row_of}
Key = tuple[str, int]


def main(arguments: list[str] | None = None) -> int:
    """Run what is missing of a campaign, tell all of it, and return 1 when anything was wrong."""
    asked = _asked(arguments)
    if asked.only:
        kind, number = asked.only.split(":")
        row = KINDS[kind](int(number))
        print(json.dumps(row, indent=2))
        return 1 if row["wrong"] else 0
    wanted = [("trial", number) for number in range(asked.trials)] + [
        ("death", number) for number in range(asked.deaths)
    ]
    done = kept(asked.out)
    try:
        with asked.out.open("a") as file:
            for row in _run([key for key in wanted if key not in done], asked.jobs):
                done[row["kind"], row["number"]] = row
                file.write(json.dumps(row) + "\n")
                file.flush()
    except KeyboardInterrupt:
        print(f"interrupted with {len(done)} done: the same command goes on from here", file=sys.stderr)
        return 130
    return told([done[key] for key in wanted], Console())


def kept(path: Path) -> dict[Key, dict[str, Any]]:
    """Return the results that a file holds of this tree; a file of another tree is begun anew."""
    path.parent.mkdir(parents=True, exist_ok=True)
    head = json.dumps({"tree": tree_sha256()})
    lines = path.read_text().splitlines() if path.exists() else []
    if not lines or lines[0] != head:
        path.write_text(head + "\n")
        return {}
    whole = path.read_text().rpartition("\n")[0]  # a line that an interrupt tore is done again
    path.write_text(whole + "\n")
    rows = [json.loads(line) for line in whole.splitlines()[1:]]
    return {(row["kind"], row["number"]): row for row in rows}


def told(rows: list[dict[str, Any]], console: Console) -> int:
    """Print a table of the results by fault and each violation; return 1 when there is one."""
    table = Table("fault", "runs", "wrong", "told", "all off after [ms]")
    for name in sorted({_fault(row) for row in rows}):
        of = [row for row in rows if _fault(row) == name]
        wrong = sum(bool(row["wrong"]) for row in of)
        words = sorted({row["told"] for row in of if row["told"]})
        most = max((row["off_ms"] for row in of if row["off_ms"] is not None), default=None)
        table.add_row(name, str(len(of)), str(wrong or ""), ", ".join(words), "" if most is None else f"{most:.0f}")
    console.print(table)
    violations = [row for row in rows if row["wrong"]]
    for row in violations:
        console.print(f"{_fault(row)}: {row['wrong'][0]}", markup=False, highlight=False)
        console.print(f"    python -m tests.campaign --only {row['kind']}:{row['number']}", markup=False)
    console.print(f"{len(rows)} runs, {len(violations)} with a violation")
    return 1 if violations else 0


def tree_sha256() -> str:
    """Return the hash over every source that a result depends on."""
    digest = hashlib.sha256()
    for path in sorted(path for folder in SOURCES for path in (ROOT / folder).rglob("*") if path.suffix in SUFFIXES):
        digest.update(f"{path.relative_to(ROOT)}\0".encode() + path.read_bytes() + b"\0")
    return digest.hexdigest()


def _run(keys: list[Key], jobs: int) -> Iterator[dict[str, Any]]:
    """Yield the row of each as it is done, with a progress bar."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True)) as progress, _pool(jobs) as pool:
        task = progress.add_task("campaign", total=len(keys))
        waiting = {pool.submit(_one, key) for key in keys}
        try:
            for future in as_completed(waiting):
                row = future.result()
                progress.update(task, advance=1, description=f"campaign {row['wrong'][0]}" if row["wrong"] else None)
                yield row
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _pool(jobs: int) -> ProcessPoolExecutor:
    """Return processes that leave Ctrl-C to their parent."""
    return ProcessPoolExecutor(jobs, initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN))


def _one(key: Key) -> dict[str, Any]:
    kind, number = key
    return {"kind": kind, "number": number, **KINDS[kind](number)}


def _fault(row: dict[str, Any]) -> str:
    return str(row["fault"]).partition(":")[0]


def _asked(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.campaign", description="Run the fault campaign.")
    parser.add_argument("--trials", type=int, default=1000, help="random (script, fault, instant) triples")
    parser.add_argument("--deaths", type=int, default=1000, help="hosts killed at random instants")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes at once")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "campaign.jsonl", help="where results are kept")
    parser.add_argument("--only", metavar="KIND:NUMBER", help="run one of them and tell all about it")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
