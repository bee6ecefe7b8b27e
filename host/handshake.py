"""The start of a session: hello until somebody answers, then the robot's dictionary, page by page.

Hello and dictionary travel in frames that need no dictionary, and are asked again until they are answered. The time
runs from the last progress, so that a slow line is not taken for a dead one.
"""

from __future__ import annotations

from binascii import crc32
from typing import Any

from host.errors import Mismatch, Silent, SoftrigError
from protocol import frames, messages

ASK_MS = 250  # a question without an answer is asked again after this long
GIVE_UP_MS = 3000  # without any progress
PAGE = 200  # bytes of the dictionary in an answer
PAGES_AHEAD = 4
READINGS = 3  # of a dictionary that does not fit its checksum

Question = tuple[int, bytes]


class Handshake:
    """Finds out who the robot is. `complete` once `dictionary` holds the whole text."""

    def __init__(self, session: int, now_ms: int) -> None:
        self.dictionary = b""
        self.complete = False
        self.trouble: SoftrigError | None = None
        self._session = session
        self._readings = 0
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

    def poll(self, now_ms: int) -> list[Question]:
        """Return the questions to ask now; raises what makes a session impossible."""
        if self.trouble:
            raise self.trouble
        if now_ms - self._progress_ms >= GIVE_UP_MS:
            raise Silent("nobody answers: is the robot switched on, and is this its port?")
        due = [place for place in self._wanted() if now_ms - self._asked.get(place, now_ms - ASK_MS) >= ASK_MS]
        self._asked.update(dict.fromkeys(due, now_ms))
        return [self._question(place) for place in due]

    def due_ms(self) -> int:
        """Return when `poll` next has something to say."""
        asked = [self._asked.get(place, self._progress_ms - ASK_MS) + ASK_MS for place in self._wanted()]
        return min([*asked, self._progress_ms + GIVE_UP_MS])

    def _begin(self, now_ms: int) -> None:
        self.identity: Any = None
        self._progress_ms = now_ms
        self._asked: dict[int, int] = {}  # offset of a page, -1: hello -> when it was asked last
        self._pages: dict[int, bytes] = {}

    def _wanted(self) -> list[int]:
        if self.identity is None:
            return [-1]
        missing = [at for at in self._asked if at >= 0 and at not in self._pages]
        return missing[:PAGES_AHEAD]

    def _question(self, place: int) -> Question:
        if place < 0:
            return messages.HELLO.number, hello(self._session)
        return messages.DICTIONARY.number, messages.DICTIONARY.pack(part=messages.DEFINITIONS, offset=place, count=PAGE)

    def _identify(self, identity: Any, now_ms: int) -> None:
        if self.identity is not None or identity.session != self._session:
            return
        if identity.version != frames.VERSION:
            self.trouble = _other_version(identity.version)
        self.identity = identity
        self._progress_ms = now_ms
        self._asked = {0: now_ms - ASK_MS}

    def _turn_page(self, page: Any, now_ms: int) -> None:
        """Keep a page; the first one tells how long pages are, and so where all the others begin."""
        if self.identity is None or page.offset not in self._asked or page.offset in self._pages:
            return
        self._pages[page.offset] = page.text
        self._progress_ms = now_ms
        if page.offset == 0 and page.text:
            rest = range(len(page.text), self.identity.dictionary_bytes, len(page.text))
            self._asked.update(dict.fromkeys(rest, now_ms - ASK_MS))
        if len(self._pages) == len(self._asked):
            self._finish(now_ms)

    def _finish(self, now_ms: int) -> None:
        text = b"".join(self._pages[at] for at in sorted(self._pages))
        self._readings += 1
        if crc32(text) == self.identity.dictionary_crc:
            self.dictionary, self.complete = text, True
        elif self._readings == READINGS:
            self.trouble = Mismatch("the robot's dictionary does not fit its checksum: put its firmware on it again")
        else:  # the robot was given another firmware between two pages
            self._begin(now_ms)

    def _denied(self, nak: Any) -> None:
        if nak.version != frames.VERSION:
            self.trouble = _other_version(nak.version)


def hello(session: int, attach: int = 0) -> bytes:
    """Return the payload that opens a session, or asks whether it is still there."""
    payload: bytes = messages.HELLO.pack(version=frames.VERSION, session=session, attach=attach, nonce_a=0, nonce_b=0)
    return payload


def differing_lines(dictionary: bytes) -> list[str]:
    """Return the rows of the robot's table of messages that are not ours: `-` ours only, `+` the robot's only."""
    theirs = dictionary.split(b"\n\n", 1)[0].decode("utf-8", "replace").splitlines()
    ours = [message.line() for message in messages.MESSAGES]
    return [f"- {line}" for line in ours if line not in theirs] + [f"+ {line}" for line in theirs if line not in ours]


def profile_text(dictionary: bytes) -> bytes:
    """Return the profile that ends the dictionary, as it stands in the robot's flash."""
    return dictionary.split(b"\n\n", 1)[-1]


def _other_version(version: int) -> Mismatch:
    older = "robot's firmware" if version < frames.VERSION else "softrig on this host"
    return Mismatch(
        f"the robot speaks version {version} of the protocol, this host {frames.VERSION}: update the {older}"
    )
