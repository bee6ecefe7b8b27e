"""The start of a session: hello until somebody answers, then the robot's dictionary, unless it is known already.

Hello and dictionary travel in frames that need no dictionary, and are asked again until they are answered. The time
runs from the last progress, so that a slow line is not taken for a dead one.

    handshake = Handshake(opening, now_ms, known)
    for kind, payload in handshake.poll(now_ms, noise): ...
    handshake.take(kind, payload, now_ms)
    handshake.profile    # once the robot is known
"""

from __future__ import annotations

from binascii import crc32
from typing import Any

from host.definitions import profile_of
from host.dictionaries import Known
from host.errors import Mismatch, NotOurs, Silent, SoftrigError
from host.pages import Pages
from host.pairing import Opening
from host.profile import Profile
from protocol import frames, messages

ASK_MS = 250  # a hello without an answer is said again after this long
GIVE_UP_MS = 3000  # without any progress
READINGS = 3  # of a dictionary that does not fit its checksum

Question = tuple[int, bytes]


class Handshake:
    """Finds out who the robot is that `opening` is said to."""

    def __init__(self, opening: Opening, now_ms: int, known: Known) -> None:
        self.dictionary = b""
        self.profile: Profile | None = None
        self.trouble: SoftrigError | None = None
        self.begun_ms = now_ms  # no answer was made before
        self._opening = opening
        self._known = known
        self._readings = 0
        self._asked_ms: int | None = None
        self._pages = Pages(0)
        self._begin(now_ms)

    def take(self, kind: int, payload: bytes, now_ms: int) -> None:
        """Take a frame's payload; what is no answer to an open question changes nothing."""
        try:
            if kind == messages.IDENTITY.number:
                self._identify(messages.IDENTITY.unpack(payload), now_ms)
            elif kind == messages.DICTIONARY_PAGE.number:
                self._turn_page(messages.DICTIONARY_PAGE.unpack(payload), now_ms)
            elif kind == messages.NAK.number:
                self._denied(messages.NAK.unpack(payload))
        except ValueError:
            return

    def poll(self, now_ms: int, noise: bool) -> list[Question]:
        """Return the questions to ask now; raises what makes a session impossible. `noise`: something has come."""
        if self.trouble:
            raise self.trouble
        if now_ms - self._progress_ms >= GIVE_UP_MS:
            if noise and self.identity is None:
                raise NotOurs("something answers, but no robot of ours: check the port and its baud rate")
            raise Silent("nobody answers: is the robot switched on, and is this its port?")
        if self.identity is not None:
            return [page_question(messages.DEFINITIONS, *place) for place in self._pages.due(now_ms)]
        if self._asked_ms is not None and now_ms - self._asked_ms < ASK_MS:
            return []
        self._asked_ms = now_ms
        return [(messages.HELLO.number, self._opening.payload())]

    def due_ms(self) -> int:
        """Return when `poll` next has something to say."""
        again_ms = self._asked_ms + ASK_MS if self._asked_ms is not None else self._progress_ms
        if self.identity is not None:
            again_ms = self._pages.due_ms() or self._progress_ms
        return min(again_ms, self._progress_ms + GIVE_UP_MS)

    def _begin(self, now_ms: int) -> None:
        self.identity: Any = None
        self._progress_ms = now_ms
        self._asked_ms = None

    def _identify(self, identity: Any, now_ms: int) -> None:
        if self.identity is not None or identity.session != self._opening.session:
            return
        if identity.version != frames.VERSION:
            self.trouble = _other_version(identity.version)
            return
        self.identity = identity
        self._progress_ms = now_ms
        self._pages = Pages(identity.dictionary_bytes)
        text = self._known.find(identity.dictionary_crc, identity.dictionary_bytes)
        if text is not None:
            self._finish(text)

    def _turn_page(self, page: Any, now_ms: int) -> None:
        if self.identity is None or self.profile or page.part != messages.DEFINITIONS:
            return
        if self._pages.take(page.offset, page.text, now_ms):
            self._progress_ms = now_ms
        if self._pages.complete:
            self._check(self._pages.text, now_ms)

    def _check(self, text: bytes, now_ms: int) -> None:
        self._readings += 1
        if crc32(text) == self.identity.dictionary_crc:
            self._known.keep(text)
            self._finish(text)
        elif self._readings == READINGS:
            self.trouble = Mismatch("the robot's dictionary does not fit its checksum: put its firmware on it again")
        else:  # the robot was given another firmware between two pages
            self._begin(now_ms)

    def _finish(self, text: bytes) -> None:
        """Check that the robot means by every message what we mean, and that its profile is whole."""
        self.dictionary = text
        try:
            self.profile = profile_of(text)
        except Mismatch as mismatch:
            self.trouble = mismatch

    def _denied(self, nak: Any) -> None:
        if nak.version != frames.VERSION:
            self.trouble = _other_version(nak.version)


def page_question(part: int, offset: int, count: int) -> Question:
    """Return what asks for a page of a part of the dictionary."""
    return messages.DICTIONARY.number, messages.DICTIONARY.pack(part=part, offset=offset, count=count)


def _other_version(version: int) -> Mismatch:
    older = "robot's firmware" if version < frames.VERSION else "softrig on this host"
    return Mismatch(
        f"the robot speaks version {version} of the protocol, this host {frames.VERSION}: update the {older}"
    )
