"""What strangers may say: hello, questions for the dictionary, and the words that answer a stop.

These frames are unseeded, so that a host of any version and any dictionary is answered. Answers are never answered:
a line that echoes stays quiet.
"""

from protocol import codes, frames, messages
from protocol.flight import WINDOW

PAGE = 200  # bytes of dictionary text in an answer


class Greetings:
    """Serves unseeded frames for one core."""

    def __init__(self, core) -> None:
        self._core = core

    def serve(self, received) -> None:
        """Serve one unseeded frame."""
        try:
            if received.kind == messages.HELLO.number:
                self._hello(received.payload)
            elif received.kind == messages.DICTIONARY.number:
                self._dictionary(messages.DICTIONARY.unpack(received.payload))
            elif received.kind == messages.SYNC.number:
                self._core.commands.sync()
            elif received.kind == messages.WATCH.number:
                core = self._core
                core.reports.subscriptions.watch(messages.WATCH.unpack(received.payload).period_ms, core.now_ms)
            elif received.kind > messages.WATCH.number:
                self._nak(received.kind, codes.UNKNOWN_MESSAGE)
        except ValueError:
            self._nak(received.kind, codes.BAD_PAYLOAD)

    def stopped(self, coils: int) -> None:
        """Say, before all else, that the stop pattern arrived and everything is off."""
        core = self._core
        now = core.now_ms & 0xFFFFFFFF
        payload = messages.STOPPED.pack(state=core.state, code=core.code, coils=coils, now_ms=now)
        core.link.post(messages.STOPPED.number, payload, first=True)

    def _hello(self, payload: bytes) -> None:
        """Answer a hello; its first byte is the version, in every version."""
        core = self._core
        if payload and payload[0] != frames.VERSION:
            self._nak(messages.HELLO.number, codes.OTHER_VERSION)
            return
        hello = messages.HELLO.unpack(payload)
        if hello.session == 0:
            raise ValueError("session 0 is none")
        free = core.offer(hello)
        pairing = core.pairing
        identity = messages.IDENTITY.pack(
            session=hello.session, boot=core.boot, uptime_ms=core.now_ms & 0xFFFFFFFF,
            dictionary_crc=core.link.decoder.dictionary_crc, dictionary_bytes=core.dictionary.size,
            version=frames.VERSION, state=core.state, role=messages.HOLDER if free else messages.VIEWER,
            node=core.link.node, secured=pairing.secured, slots=WINDOW, bytes=core.link.grant_bytes,
            byte_ns=core.link.byte_ns, holder=core.holder(), step=core.player.step, nonce_a=pairing.nonce[0],
            nonce_b=pairing.nonce[1], proof_a=pairing.proof[0], proof_b=pairing.proof[1], firmware=core.version,
        )  # fmt: skip
        core.link.post(messages.IDENTITY.number, identity)

    def _dictionary(self, asked) -> None:
        page = self._core.dictionary.page(asked.part, asked.offset, min(asked.count, PAGE))
        payload = messages.DICTIONARY_PAGE.pack(part=asked.part, offset=asked.offset, text=page)
        self._core.link.post(messages.DICTIONARY_PAGE.number, payload)

    def _nak(self, kind: int, code: int) -> None:
        payload = messages.NAK.pack(kind=kind, code=code, version=frames.VERSION)
        self._core.link.post(messages.NAK.number, payload)
