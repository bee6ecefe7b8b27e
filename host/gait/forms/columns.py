"""Lines whose columns are aligned with those of their neighbours: params with params, comments with comments."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

INDENT = 4
APART = 2  # spaces before a comment beside a statement
NEAR = 3  # lines from one such comment to the next, to be aligned
UNEVEN = 12  # columns that statements with aligned comments may differ by


@dataclass
class Row:
    """A line of one block: columns that are aligned with those of its neighbours, and a comment beside them."""

    block: int
    depth: int
    cells: list[str]
    comment: str = ""
    apart: bool = False  # no statement: a comment of its own, or a blank line

    @property
    def code(self) -> str:
        """Return the line as it stands, without the comment beside it."""
        return " " * INDENT * self.depth * bool(self.cells) + " ".join(self.cells)


def aligned(rows: Sequence[Row]) -> Iterator[str]:
    """Yield the lines that the rows are."""
    for _, run in groupby(rows, _kind):
        _align(list(run))
    for row, gap in zip(rows, _gaps(rows), strict=True):
        yield f"{row.code}{' ' * gap}{row.comment}"


def _align(run: list[Row]) -> None:
    """Give the columns of neighbouring lines one width, but for the last column of each line."""
    for column in range(2):
        wider = [row for row in run if len(row.cells) > column + 1]
        width = max((len(row.cells[column]) for row in wider), default=0)
        for row in wider:
            row.cells[column] = row.cells[column].ljust(width)


@dataclass
class _Run:
    """Rows whose comments are aligned: their numbers, and the narrowest and the widest of them."""

    rows: list[int]
    least: int
    most: int

    def takes(self, rows: Sequence[Row], at: int, width: int) -> bool:
        """Return whether one more row goes on with the run."""
        last = self.rows[-1]
        near = at - last <= NEAR and not any(row.apart and row.cells for row in rows[last + 1 : at])
        even = len(rows[at].cells) > 1 or max(self.most, width) - min(self.least, width) <= UNEVEN
        return near and even and _kind(rows[at]) == _kind(rows[last])

    def add(self, at: int, width: int) -> None:
        """Add one more row."""
        self.rows.append(at)
        self.least, self.most = min(self.least, width), max(self.most, width)


def _gaps(rows: Sequence[Row]) -> list[int]:
    """Return how many blanks stand between the code of each row and the comment beside it."""
    runs: list[_Run] = []
    widths = [len(row.code) for row in rows]
    for at, width in enumerate(widths):
        if not rows[at].comment:
            continue
        if runs and runs[-1].takes(rows, at, width):
            runs[-1].add(at, width)
        else:
            runs.append(_Run([at], width, width))
    gaps = [0] * len(rows)
    for run in runs:
        for at in run.rows:
            gaps[at] = run.most + APART - widths[at]
    return gaps


def _kind(row: Row) -> tuple[int, bool]:
    return row.block, len(row.cells) > 1
