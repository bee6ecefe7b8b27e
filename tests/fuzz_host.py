"""Fuzz target: the host's session. Whatever a robot says, `receive` never raises, and `poll` only what is awaited."""

from binascii import crc32

from host.definitions import dictionary_of
from host.errors import SoftrigError
from host.pairing import Opening
from host.session import Session
from protocol import frames, messages
from protocol.link import LinkFull
from tests.firmware_bench import PROFILE
from tests.fuzz_script import SESSION, Script

DICTIONARY = dictionary_of(PROFILE.read_bytes())
DICTIONARY_CRC = crc32(DICTIONARY)
PAGE = 200
ORDERS = [
    (messages.STATUS_REQUEST, {}), (messages.ARM, {"session": SESSION, "lease_ms": 500, "without": 0}),
    (messages.FIRE, {"coils": 1, "duty_permille": 100, "hold_ms": 100}), (messages.COILS_REQUEST, {}),
    (messages.SUBSCRIBE, {"slot": 0, "period_ms": 50, "on_change": 0, "variables": b""}),
    (messages.FAULTS_REQUEST, {"skip": 0}), (messages.SETTINGS_REQUEST, {}),
]  # fmt: skip


class Known:
    """A cache that has the dictionary of this robot."""

    def find(self, crc: int, length: int) -> bytes | None:
        return DICTIONARY if crc == DICTIONARY_CRC else None

    def keep(self, text: bytes) -> None:
        """Keep nothing."""


def session(data: bytes) -> None:
    """A robot that says whatever the script wants, well sealed or not."""
    script = Script(data, DICTIONARY_CRC)
    mode = script.byte()
    now_us = 1_000_000
    opening = Opening(SESSION, mode & 2, 1, 2)
    talk = Session(opening, now_us, None if mode & 4 else Known(), bytes(32) if mode & 8 else b"")
    seq = posted = 0
    while script:
        act = script.byte()
        what = act & 7
        now_us += 1000 * (act >> 3)
        line = b""
        if what == 0:
            line = script.some()
        elif what == 1:
            line = script.sealed(messages.IDENTITY.number, identity(script.byte(), script.byte()))
        elif what == 2:
            at = PAGE * script.byte() % len(DICTIONARY)
            page = messages.DICTIONARY_PAGE.pack(part=0, offset=at, text=DICTIONARY[at : at + PAGE])
            line = script.sealed(messages.DICTIONARY_PAGE.number, page)
        elif what == 3:
            line = script.sealed(script.byte(), script.some(), seq & 255, script.byte(), frames.RELIABLE)
            seq += 1
        elif what == 4:
            line = script.sealed(script.byte(), script.some(), posted & 255, script.byte())
            posted += 1
        elif what == 5:
            _order(talk, script.byte(), now_us)
        elif what == 6:
            line = script.line()
        elif act & 0x80:
            talk.stop(now_us)
        talk.receive(line, now_us)
        try:
            talk.poll(now_us)
        except SoftrigError:
            return
        assert talk.wake_us(now_us) > now_us
        talk.statistics(now_us)


def identity(state: int, more: int) -> bytes:
    """Return the `identity` of a robot."""
    return messages.IDENTITY.pack(
        session=SESSION, boot=1, uptime_ms=1000 + more, dictionary_crc=DICTIONARY_CRC ^ (more >> 7),
        dictionary_bytes=len(DICTIONARY), version=frames.VERSION, state=state, role=more & 1, node=0,
        secured=more >> 1 & 3, slots=16, bytes=960, byte_ns=86_805, holder=0, step=0, nonce_a=3, nonce_b=4,
        proof_a=0, proof_b=0, firmware=b"0.1.0",
    )  # fmt: skip


def _order(talk: Session, which: int, now_us: int) -> None:
    message, fields = ORDERS[which % len(ORDERS)]
    try:
        talk.request(message, now_us, **fields)
    except (SoftrigError, LinkFull):
        return
