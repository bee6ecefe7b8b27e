"""A text read from the robot page by page, over a line that may lose most of what is long.

Several pages are asked for at once. One that is lost (a later one has come, or none for twice the usual time) is asked
for again in smaller pieces, since short frames get through where long ones do not; when all goes well, pages grow.

    pages = Pages(size)
    for offset, count in pages.due(now_ms): ...    # ask for these
    pages.take(offset, text, now_ms)
    pages.complete, pages.text
"""

from __future__ import annotations

from typing import NamedTuple

PAGE_MAX, PAGE_MIN = 200, 32
AHEAD_BYTES, AHEAD_MAX = 800, 12  # that may be on their way at once
FIRST_WAIT_MS, WAIT_MAX_MS, WAIT_MARGIN_MS = 250, 2000, 20
GROW_AFTER = 8  # pages in a row without a loss
UNKNOWN_SIZE = 0xFFFF


class Question(NamedTuple):
    """A page that was asked for and has not come."""

    offset: int
    length: int
    at_ms: int


class Pages:
    """A text of `size` bytes; without a size it ends where the robot gives an empty page."""

    def __init__(self, size: int = UNKNOWN_SIZE) -> None:
        self._size = size
        self._bounded = size != UNKNOWN_SIZE
        self._text = bytearray(size)
        self._have = bytearray(size)  # 1 for each byte that has come
        self._open: list[Question] = []  # in the order in which they were asked
        self._count = PAGE_MAX
        self._in_a_row = 0
        self._wait_ms = FIRST_WAIT_MS

    @property
    def complete(self) -> bool:
        """Return whether all of the text has come."""
        return self._have.find(0, 0, self._size) < 0

    @property
    def text(self) -> bytes:
        """Return the text."""
        return bytes(self._text[: self._size])

    def due(self, now_ms: int) -> list[tuple[int, int]]:
        """Return offset and length of the pages to ask for now."""
        for late in [question for question in self._open if now_ms - question.at_ms >= self._wait_ms]:
            self._lose(late)
        asked = []
        while len(self._open) < min(AHEAD_MAX, AHEAD_BYTES // self._count) and (gap := self._gap()):
            self._open.append(Question(*gap, now_ms))
            asked.append(gap)
        return asked

    def due_ms(self) -> int | None:
        """Return when a page that does not come is asked for again; None: none is waited for."""
        return self._open[0].at_ms + self._wait_ms if self._open else None

    def take(self, offset: int, text: bytes, now_ms: int) -> bool:
        """Take a page; return whether it brought anything new."""
        end = offset + len(text)
        if end > self._size:
            return False
        if not text and not self._bounded:
            self._size = offset
        news = self._have.find(0, offset, end) >= 0
        self._text[offset:end] = text
        self._have[offset:end] = b"\x01" * len(text)
        self._answered(offset, now_ms)
        return news

    def _answered(self, offset: int, now_ms: int) -> None:
        """Close the question; those asked before it have lost theirs, or their answers, on the way."""
        answered = [question for question in self._open if question.offset == offset]
        if not answered:
            return
        self._wait_ms = min(max(FIRST_WAIT_MS, 2 * (now_ms - answered[0].at_ms) + WAIT_MARGIN_MS), WAIT_MAX_MS)
        for overtaken in self._open[: self._open.index(answered[0])]:
            self._lose(overtaken)
        self._open.remove(answered[0])
        self._in_a_row += 1
        if self._in_a_row >= GROW_AFTER:
            self._count, self._in_a_row = min(2 * self._count, PAGE_MAX), 0

    def _lose(self, question: Question) -> None:
        self._open.remove(question)
        self._count, self._in_a_row = max(min(self._count, question.length // 2), PAGE_MIN), 0

    def _gap(self) -> tuple[int, int] | None:
        """Return the first piece that has neither come nor been asked for."""
        taken = bytearray(self._have[: self._size])
        for offset, count, _ in self._open:
            end = min(offset + count, self._size)
            taken[offset:end] = b"\x01" * max(0, end - offset)
        start = taken.find(0)
        if start < 0:
            return None
        end = taken.find(1, start)
        return start, min(self._count, (self._size if end < 0 else end) - start)
