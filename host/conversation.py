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
from host.link import Link
from host.pairing import opened
from host.records import Record, Stopped
from host.session import Session
from protocol import messages


class Recorder(Protocol):
    """Whoever keeps what passes between host and robot."""

    def line(self, direction: str, data: bytes, host_ms: int, robot_ms: int | None) -> None:
        """Keep bytes that went "out" or came "in"."""

    def record(self, record: Record) -> None:
        """Keep what the robot told."""


class Conversation:
    """One session after another over `link`, one at a time."""

    def __init__(self, link: Link, recorder: Recorder | None = None, key: bytes = b"") -> None:
        self.link = link
        self.stopped: Stopped | None = None  # the last answer to a stop
        self._recorder = recorder
        self._news: list[Record] = []
        self._key = key
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
        self.session = self._fresh(attach)

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
            raise LinkLost(f"the line broke ({error}); the robot switches its coils off by itself") from error
        now_us = self.now_us()
        news = self.session.receive(data, now_us)
        if data:
            self._keep("in", data, now_us)
        for record in news:
            self._notice(record)

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

    def _keep(self, direction: str, data: bytes, now_us: int) -> None:
        if self._recorder:
            self._recorder.line(direction, data, now_us // 1000, self.session.robot_ms(now_us))

    def _fresh(self, attach: int) -> Session:
        return Session(opened(self.link, attach), self.now_us(), self._known, self._key)
