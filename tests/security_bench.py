"""A paired robot on the table top of firmware_bench.py, its host, and an attacker who hears and says what he likes.

rig = PairedRig()
rig.arm()
rig.attack(rig.said[-1])     # a frame that the host said, once more
rig.served                   # the names of the orders that the robot has acted on
"""

from firmware.core import Core
from firmware.profile import Profile
from host.keys import packed
from host.pairing import Opening, session_key
from protocol import frames, messages, secret
from protocol.link import Link
from tests.firmware_bench import PROFILE, SESSION, Rig, Table

KEY = bytes(range(32))


class PairedRig(Rig):
    """A core with a key, and a host that has it. `said` and `heard` are the frames to the robot, and from it."""

    def __init__(
        self, key_file: bytes = packed(KEY), files: dict[str, bytes] | None = None, begin: bool = True
    ) -> None:
        self.board = Table()
        self.board.flash.files.update(files or {})
        self.board.flash.files["/key"] = key_file
        self.profile = Profile(PROFILE.read_bytes())
        self.board.supply.mv = self.profile.supply.nominal_mv
        self.now_ms = 0
        self.host = Link()
        self.got, self.said, self.heard = [], [], []
        self.restart()
        if begin:
            self.begin()

    @property
    def crc(self) -> int:
        """The robot's dictionary, which is no secret."""
        return self.core.link.decoder.dictionary_crc

    def restart(self) -> None:
        """Switch the robot off and on: what stands on its flash is all that is left."""
        self.core = Core(self.board, self.profile, boot=1)
        self.now_ms = 0
        self.served = []
        serve = self.core.commands.serve
        self.core.commands.serve = lambda received: (self.served.append(name_of(received.kind)), serve(received))

    def greet(self, session: int = SESSION, attach: int = 0, nonce: tuple[int, int] = (8, 9)):
        """Say hello; return it and the robot's identity."""
        opening = Opening(session, attach, *nonce)
        hello = frames.encode(frames.seal(messages.HELLO.number, 0, 0, opening.payload(), 0, 0))
        self.said.append(hello)
        identity = next(body for name, body in greetings(self.attack(hello)) if name == "identity")
        return opening, identity

    def begin(self, session: int = SESSION, attach: int = 0, nonce: tuple[int, int] = (8, 9), key: bytes = KEY) -> None:
        """Begin a session as a host with that key does."""
        opening, identity = self.greet(session, attach, nonce)
        self.host.begin(self.crc, session, session_key(key, opening, identity))
        self.host.acknowledge()
        self.run(10)

    def run(self, ms: int, silent: bool = False, line: bytes = b""):
        """Let time pass as Rig does, and keep what crossed the wire."""
        fresh = []
        for _ in range(0, ms, 5):
            if not silent:
                self.host.acknowledge()
                out = self.host.poll(self.now_ms)
                self.said += pieces(out)
                line += out
            answer = self.core.step(self.now_ms, line, 4096)
            line = b""
            self.heard += pieces(answer)
            self.now_ms += 5
            for received in self.host.receive(answer, self.now_ms):
                fresh.append((name_of(received.kind), messages.by_number(received.kind).unpack(received.payload)))
        self.got += fresh
        return fresh

    def attack(self, line: bytes, ms: int = 5) -> bytes:
        """Say something while the host says nothing; return what the robot says to it."""
        answer = self.core.step(self.now_ms, line, 4096)
        self.heard += pieces(answer)
        self.now_ms += 5
        for _ in range(5, ms, 5):
            answer += self.core.step(self.now_ms, b"", 4096)
            self.now_ms += 5
        return answer

    def sealed(
        self, message, number: int, key: bytes, session: int | None = None, device: bool = False, **fields
    ) -> bytes:
        """Return an order as whoever has a session's key would make it."""
        body = frames.head(message.number, number & 255, 0, frames.RELIABLE | frames.SEALED) + message.pack(**fields)
        body += secret.tag(key, device, number, body)
        return self.closed(body, session)

    def closed(self, body: bytes, session: int | None = None) -> bytes:
        """Return a body with the check of a session, which needs no key."""
        seed = frames.session_seed(self.crc, self.core.session if session is None else session)
        return frames.encode(frames.close(body, seed))

    @property
    def refused(self) -> int:
        """How many frames the robot has counted as anything but good."""
        link = self.core.link
        return link.forged + link.foreign + link.duplicates + link.decoder.dropped

    @property
    def forged(self) -> int:
        """How many frames the robot has counted as forged."""
        return self.core.link.forged


def pieces(line: bytes) -> list[bytes]:
    """Return the frames of a line, each with the zero that ends it."""
    return [piece + b"\x00" for piece in line.split(b"\x00")[:-1] if piece]


def name_of(kind: int) -> str:
    """Return the name of a kind of frame."""
    return messages.by_number(kind).name


def body_of(line: bytes) -> bytes:
    """Return the body of a frame on the wire, without its check."""
    return frames.decode(line[:-1])[:-4]


def greetings(line: bytes) -> list[tuple]:
    """Return the greetings among what a robot said."""
    return [
        (name_of(received.kind), messages.by_number(received.kind).unpack(received.payload))
        for received in Link().receive(line, 0)
    ]


def of_kind(lines: list[bytes], message) -> list[bytes]:
    """Return those of the frames that carry that message."""
    return [line for line in lines if body_of(line)[1] == message.number]
