"""A session at work on a line: gives it bytes and times, writes what it says, and waits for what is asked.

No threads and no sleeps: all waiting is the line's own, on the line's own clock.

    talk = Conversation(link)
    talk.wait(lambda: talk.session.open)
    answer = talk.order(messages.STATUS_REQUEST)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from host.answers import Answer
from host.dictionaries import Dictionaries, Known, Unknown, cache_folder
from host.errors import LinkLost, Refused
from host.lasting import LastingLink, can_last
from host.link import Link
from host.outages import LinkNews, Outages
from host.pairing import opened
from host.records import Record, Stopped
from host.session import Session
from host.silence import PROBE_MS, SILENT_MS
from protocol import messages


class Recorder(Protocol):
    """Whoever keeps what passes between host and robot."""

    def line(self, direction: str, data: bytes, host_ms: int, robot_ms: int | None) -> None:
        """Keep bytes that went "out" or came "in"."""

    def record(self, record: Record) -> None:
        """Keep what the robot told."""

    def link(self, news: LinkNews) -> None:
        """Keep what became of the line."""


class Conversation:
    """One session after another over `link`, one at a time."""

    def __init__(self, link: Link, recorder: Recorder | None = None, key: bytes = b"") -> None:
        self.link = link
        self.stopped: Stopped | None = None  # the last answer to a stop
        self._recorder = recorder
        self._news: list[Record] = []
        self._key = key
        self.outages = Outages()
        self._patience_ms = 0
        self._stops = False
        self._told = False  # the recorder knows of this session
        self._known: Known = Unknown() if getattr(link, "repeatable", False) else Dictionaries(cache_folder())
        self.session = self._fresh(0)

    def now_us(self) -> int:
        """Return the line's clock."""
        return round(self.link.now_s() * 1e6)

    def now_ms(self) -> int:
        """Return the line's clock in whole milliseconds."""
        return self.now_us() // 1000

    def renew(self, attach: int = 0) -> None:
        """Begin a new session; `attach` is the one whose lease and program it takes over."""
        self._told = False
        self.session = self._fresh(attach)

    def endure(self, patience_ms: int, stops: bool = False) -> None:
        """Go on in this session over a line that breaks for up to that long; with `stops`, only to stop the robot."""
        if can_last(self.link):
            self.link = LastingLink(self.link, patience_ms / 1000)
        self.session.hearing.silence.patience_ms = self._patience_ms = patience_ms
        self._stops = stops

    def end(self) -> None:
        """Say that the session ends, and let go of the line."""
        if self._told:
            self._tell("ends", "")
        self.link.close()

    def order(self, message: messages.Message, **values: Any) -> Answer | None:
        """Give an order and wait for its answer; Refused when the robot refuses it."""
        return self.answer(self.ask(message, **values))

    def ask(self, message: messages.Message, **values: Any) -> int:
        """Give an order and return its number."""
        self.wait(lambda: self.session.room() > 0)
        return self.session.request(message, self.now_us(), **values)

    def answer(self, seq: int) -> Answer | None:
        """Wait for the answer to an order; Refused when the robot refuses it."""
        said = self.session.hearing.answers.said
        self.wait(lambda: seq in said)
        answer = said.pop(seq)
        if isinstance(answer, Refused):
            raise answer
        return answer

    def wait(self, done: Callable[[], bool], until_ms: int | None = None) -> None:
        """Serve the line until `done`, or until that time; the session itself raises when nothing comes any more."""
        while not done() and (until_ms is None or self.now_ms() < until_ms):
            self.turn(until_ms)

    def turn(self, until_ms: int | None = None) -> None:
        """Write what is due, then wait for bytes until something is due again."""
        now_us = self.now_us()
        out = self.session.poll(now_us)
        wake_us = self.session.wake_us(now_us)
        try:
            if out:
                self._keep("out", out, now_us)
                self.link.write(out)
            data = self.link.read((wake_us if until_ms is None else min(wake_us, 1000 * until_ms)) / 1e6)
        except OSError as error:
            raise LinkLost(f"the line ended: {error}; the robot switches everything off by itself") from error
        now_us = self.now_us()
        if data or self._break() is None:  # a broken line was not read: what it still holds may be old
            for record in self.session.receive(data, now_us):
                self._notice(record)
        if data:
            self._keep("in", data, now_us)
        if self.session.open and not self._told:
            self._told = True
            self._tell("begins", "")
        if self._patience_ms:
            self._look_at_the_line(now_us // 1000)

    def taken(self) -> list[Record]:
        """Return the records that have come since this was asked last."""
        news, self._news = self._news, []
        return news

    def _notice(self, record: Record) -> None:
        self._news.append(record)
        if isinstance(record, Stopped):
            self.stopped = record
        if self._recorder:
            self._recorder.record(record)

    def _look_at_the_line(self, now_ms: int) -> None:
        """Note an interruption and its end; LinkLost when it lasts for too long."""
        hearing = self.session.hearing
        heard_ms = hearing.told_ms if hearing.silence.expects else hearing.silence.heard_ms
        news = self.outages.note(now_ms, self._interruption(), heard_ms, hearing.missed())
        if news:
            self._tell(news, self.outages.cause())
        if news == "interrupted" and self._stops:
            self.session.stop(self.now_us())
        if self.outages.lasting_ms(now_ms) >= self._patience_ms + SILENT_MS:
            raise LinkLost(f"{self.outages.cause()}; it switches everything off by itself")

    def _interruption(self) -> str | None:
        """Return why the line is interrupted now, or None."""
        cause = self._break()
        if cause is None and self.session.hearing.overdue_ms() < PROBE_MS:
            return None
        return str(cause or "the robot has fallen silent")

    def _break(self) -> LinkLost | None:
        """Return why the line is broken now, or None."""
        return self.link.cause if isinstance(self.link, LastingLink) else None

    def _tell(self, what: str, cause: str) -> None:
        if self._recorder:
            now_us = self.now_us()
            figures = self.session.hearing.clock_figures(now_us)
            times = now_us // 1000, self.session.robot_ms(now_us)
            self._recorder.link(LinkNews(*times, self.session.number, what, cause, *figures.values()))

    def _keep(self, direction: str, data: bytes, now_us: int) -> None:
        if self._recorder:
            self._recorder.line(direction, data, now_us // 1000, self.session.robot_ms(now_us))

    def _fresh(self, attach: int) -> Session:
        return Session(opened(self.link, attach), self.now_us(), self._known, self._key)
