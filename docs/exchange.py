"""A conversation as it goes over the wire, for the reference page: two real links talk, and every frame is taken down.

What the robot answers is told here; numbers, acknowledgements, resends and every byte are made by the code that robots
and hosts run.
"""

import textwrap
from binascii import crc32
from pathlib import Path

from docs import board, dictionary
from docs.definitions import enums, rows
from docs.vectors import message
from protocol import codes, flight, frames, messages
from protocol.link import Link

PROFILE = Path(__file__).parents[1] / "firmware" / "robots" / "circular.json"
SESSION = 0x5EED0001
WIDTH = 112
PAGE = 32
CREDIT_BYTES = board.constants()["CREDIT_BYTES"]


class Conversation:
    """A host and a robot on one line. What is said is written down in `lines`."""

    def __init__(self) -> None:
        self.text = dictionary.definition_text().encode() + PROFILE.read_bytes()
        self.crc = crc32(self.text)
        self.host, self.robot = Link(), Link(self.crc, device=True)
        self.robot.grant_bytes = CREDIT_BYTES
        self.now_ms = 0
        self.lines: list[str] = []
        self._listener = frames.Decoder(self.crc, SESSION)

    def say(self, words: str) -> None:
        """Write a line of explanation."""
        self.lines += ["", *textwrap.wrap(words, WIDTH)]

    def from_host(self, lost: int = -1) -> list[messages.Message]:
        """Carry what the host has to say; the frame at place `lost` does not arrive."""
        return self._carry(self.host, self.robot, "host ", lost)

    def from_robot(self, lost: int = -1) -> list[messages.Message]:
        """Carry what the robot has to say."""
        return self._carry(self.robot, self.host, "robot", lost)

    def order(self, asked: messages.Message, **values: int) -> int:
        """Have the host give an order; return its number."""
        return self.host.send(asked.number, asked.pack(**values), self.now_ms)

    def answer(self, said: messages.Message, **values: int) -> None:
        """Have the robot answer, or tell."""
        self.robot.send(said.number, said.pack(**values), self.now_ms)

    def note(self, who: str, wire: bytes, told: str) -> None:
        """Write down what is on the wire."""
        self.lines += textwrap.wrap(
            f"{who}  {wire.hex(' ')}", WIDTH, subsequent_indent=" " * 7, initial_indent="", break_long_words=False
        )
        self.lines += textwrap.wrap(told, WIDTH, initial_indent=" " * 7, subsequent_indent=" " * 9)

    def _carry(self, sender: Link, receiver: Link, who: str, lost: int) -> list[messages.Message]:
        self.now_ms += 5
        wire = sender.poll(self.now_ms)
        delivered = []
        for place, stuffed in enumerate(wire.split(b"\x00")[:-1]):
            (frame,) = self._listener.feed(stuffed + b"\x00")
            self.note(who, stuffed + b"\x00", described(frame) + (" -- lost" if place == lost else ""))
            if place != lost:
                delivered += receiver.receive(stuffed + b"\x00", self.now_ms)
        return delivered


def described(frame: frames.Frame) -> str:
    """Return what a frame says: name, numbers, fields."""
    row = next(row for row in rows() if row.number == frame.kind)
    values = message(row).unpack(frame.payload)
    told = [_told(place.name, place.enum, value) for place, value in zip(row.fields, values, strict=True)]
    number = "" if frame.kind < frames.GREETINGS_BELOW else f" seq {frame.seq} ack {frame.ack}"
    return f"{row.name}{number}" + (f": {', '.join(told)}" if told else "")


def text() -> str:
    """Return the conversation, frame by frame."""
    line = Conversation()
    _greet(line)
    _arm_and_fire(line)
    _lose_a_frame(line)
    _stop(line)
    return "\n".join(line.lines).strip("\n")


def _greet(line: Conversation) -> None:
    line.say("The host says hello, and reads the first bytes of a dictionary that it does not know.")
    hello = messages.HELLO.pack(version=frames.VERSION, session=SESSION, attach=0, nonce_a=0, nonce_b=0)
    line.host.post(messages.HELLO.number, hello)
    line.from_host()
    line.robot.offer(SESSION)
    line.robot.post(messages.IDENTITY.number, _identity(line))
    line.from_robot()
    line.host.post(messages.DICTIONARY.number, messages.DICTIONARY.pack(part=0, offset=0, count=PAGE))
    line.from_host()
    page = messages.DICTIONARY_PAGE.pack(part=0, offset=0, text=line.text[:PAGE])
    line.robot.post(messages.DICTIONARY_PAGE.number, page)
    line.from_robot()
    seed = frames.session_seed(line.crc, SESSION)
    line.say(
        f"It has read all of it, and its CRC-32 is 0x{line.crc:08X}. The seed of the session is 0x{seed:08X}. With its "
        "first frame the session begins."
    )
    line.host.begin(line.crc, SESSION)
    line.host.granted(flight.WINDOW, CREDIT_BYTES)
    line.host.acknowledge()
    line.robot.may_adopt = True
    line.from_host()


def _identity(line: Conversation) -> bytes:
    return messages.IDENTITY.pack(
        session=SESSION, boot=0xB007, uptime_ms=4000, dictionary_crc=line.crc, dictionary_bytes=len(line.text),
        version=frames.VERSION, state=messages.IDLE, role=messages.HOLDER, node=0, secured=0, slots=flight.WINDOW,
        bytes=CREDIT_BYTES, byte_ns=86_805, holder=0, step=0, nonce_a=0, nonce_b=0, proof_a=0, proof_b=0,
        firmware=b"0.1.0",
    )  # fmt: skip


def _arm_and_fire(line: Conversation) -> None:
    line.say("It arms; the answer comes when the self-test is done. Then coil 0 is heated at 60 % for half a second.")
    request = line.order(messages.ARM, session=SESSION, lease_ms=0, without=0)
    line.from_host()
    line.from_robot()
    line.answer(messages.OK, request=request)
    line.from_robot()
    request = line.order(messages.FIRE, coils=1, duty_permille=600, hold_ms=500)
    line.from_host()
    line.answer(messages.OK, request=request)
    line.from_robot()
    line.say("One order too many: the robot refuses it, with code, coil, what was asked and what is allowed.")
    request = line.order(messages.FIRE, coils=2, duty_permille=1000, hold_ms=60_000)
    line.from_host()
    line.answer(messages.REFUSED, request=request, code=codes.HOLD_LIMIT, channel=1, value=60_000, limit=10_000)
    line.from_robot()


def _lose_a_frame(line: Conversation) -> None:
    line.say(
        "The first of two orders is lost. The robot keeps the second and tells so by bit 0 of `have`; the "
        "host sends the lost one again at once, without waiting for a time-out. Both are then carried out in order."
    )
    first = line.order(messages.FIRE, coils=2, duty_permille=300, hold_ms=200)
    second = line.order(messages.FIRE, coils=4, duty_permille=300, hold_ms=200)
    line.from_host(lost=0)
    line.from_robot()
    line.from_host()
    for request in (first, second):
        line.answer(messages.OK, request=request)
    line.from_robot()
    line.from_host()


def _stop(line: Conversation) -> None:
    line.say("Somebody presses stop. The robot answers, and tells the session what happened.")
    line.note("host ", frames.STOP, "the stop pattern: no frame")
    stopped = messages.STOPPED.pack(state=messages.TRIPPED, code=codes.STOP, coils=1, now_ms=4200)
    line.robot.post(messages.STOPPED.number, stopped, first=True)
    line.answer(messages.EVENT, event=messages.TRIP, code=codes.STOP, step=0, channel=255, value=0, now_ms=4200)
    line.from_robot()
    line.from_host()


def _told(name: str, enum: str, value: int | bytes) -> str:
    if isinstance(value, bytes):
        return f"{name} {value.decode('ascii')!r}" if value.isascii() else f"{name} {value.hex(' ')}"
    if enum in enums():
        return f"{name} {value} ({enums()[enum].get(value, '?')})"
    return f"{name} 0x{value:08X}" if value > 0xFFFF else f"{name} {value}"
