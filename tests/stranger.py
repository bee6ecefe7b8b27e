"""A client for a robot, written by a stranger: from docs/protocol.md alone, with nothing but Python's own library.

It is the smallest that the page describes: one order at a time, no pairing key, no shared line. What it needs to say
hello is in FIRST_WORDS; every other message it learns from the robot's dictionary. An order that the robot refuses
raises Refused, and what it does not answer in time raises TimeoutError. Between its calls nothing is sent: one that
holds the lease must call `wait` for something, or `turn`, every 100 ms.

    robot = Stranger("/dev/ttyACM0")
    robot.open()
    robot.order("arm", session=robot.session, lease_ms=0, without=0)
    robot.order("fire", coils=1, duty_permille=300, hold_ms=200)
"""

import json
import os
import re
import select
import struct
import termios
import time
import tty
from collections.abc import Callable
from contextlib import suppress
from itertools import islice
from zlib import crc32

FIRST_WORDS = """
1 hello version:B session:I attach:I nonce_a:I nonce_b:I
2 identity session:I boot:I uptime_ms:I dictionary_crc:I dictionary_bytes:H version:B state:B role:B node:B secured:B \
slots:B bytes:H byte_ns:I holder:I step:H nonce_a:I nonce_b:I proof_a:I proof_b:I firmware:s
3 dictionary part:B offset:H count:B
4 dictionary_page part:B offset:H text:s
"""
VERSION, RELIABLE, NODE, SEALED, RESERVED = 2, 1, 2, 4, 8
STOP = b"\0STOP\0"
PIECE_BYTES = 200
FRAME_MAX, WINDOW = 255, 32
HEARD_MAX = 100
PATIENCE_S = 5.0
HALT = b"\x00"


class Refused(Exception):
    """The robot has refused an order; the argument holds the fields of its answer."""


def stuff(body: bytes) -> bytes:
    """Return `body` as it goes over the wire: without zeros, but for the one that ends it."""
    return b"".join(bytes((len(run) + 1,)) + run for run in body.split(b"\0")) + b"\0"


def unstuff(frame: bytes) -> bytes:
    """Return the body in `frame`, which stood between two zeros; empty when it is damaged."""
    runs = []
    while frame:
        count = frame[0]
        if count == 0 or count > len(frame):
            return b""
        runs.append(frame[1:count])
        frame = frame[count:]
    return b"\0".join(runs)


def is_of_session(kind: int) -> bool:
    """Return whether frames of this kind are numbered: no greetings, nor what all may hear."""
    return kind >= 0x10 and not 0x50 <= kind <= 0x5F


def fire(coils: int, duty_permille: int, time_ms: int) -> bytes:
    """Return the step of a program that heats coils and does not wait."""
    return struct.pack("<BIHHH", 0x01, coils, duty_permille, time_ms, 0)


def delay(time_ms: int) -> bytes:
    """Return the step of a program that goes on after that long."""
    return struct.pack("<BI", 0x03, time_ms)


class Words:
    """The messages and variables that a dictionary defines."""

    def __init__(self, text: str):
        self.kinds, self.fields, self.variables = {}, {}, {}
        for number, name, fields in re.findall(r"^(\d+) (\w+)(.*)$", text, re.MULTILINE):
            self.kinds[name] = int(number)
            self.fields[name] = re.findall(r"(\w+):(\w)", re.sub(r"\[.*?\]", "", fields))
        for number, name, letter, each in re.findall(r"^var (\d+) (\w+):(\w)([*+@!#]?)", text, re.MULTILINE):
            self.variables[name] = int(number), letter, each
        self.names = {kind: name for name, kind in self.kinds.items()}

    def pack(self, name: str, values: dict) -> bytes:
        """Return the payload of a message: the values of its fields one after the other."""
        fields = self.fields[name]
        layout = [f"{len(values[field])}s" if letter == "s" else letter for field, letter in fields]
        return struct.pack("<" + "".join(layout), *(values[field] for field, _ in fields))

    def unpack(self, name: str, payload: bytes) -> dict:
        """Return the values in a payload by the names of their fields; struct.error when it does not fit."""
        layout = "<" + "".join(letter for _, letter in self.fields[name])
        if layout.endswith("s"):
            layout = layout[:-1] + f"{len(payload) - struct.calcsize(layout[:-1])}s"
        return dict(zip((field for field, _ in self.fields[name]), struct.unpack(layout, payload), strict=True))

    def unpack_record(self, values: bytes, names: list[str], profile: dict) -> dict:
        """Return the variables in a record of telemetry; one of which there may be several, or none, is a list."""
        channels = [channel["kind"] for channel in profile["channels"]]
        counts = {
            "": 1, "*": channels.count("sma"), "+": channels.count("servo"), "@": int("camera" in profile),
            "!": int("load" in profile), "#": len(profile.get("cells", ())),
        }  # fmt: skip
        kinds = [self.variables[name] for name in names]
        layout = "<" + "".join(letter * counts[each] for _, letter, each in kinds)
        flat = iter(struct.unpack(layout, bytes(byte ^ 0x55 for byte in values)))
        found = [(name, list(islice(flat, counts[self.variables[name][2]]))) for name in names]
        return {name: several if self.variables[name][2] else several[0] for name, several in found}


class Frames:
    """Makes frames and finds them in what arrives; damage, and what is for others, is passed over."""

    def __init__(self):
        self.tail = b""
        self.learn(dictionary_crc=0, session=0)

    def learn(self, dictionary_crc: int, session: int) -> None:
        """Draw the seeds from dictionary and session."""
        self.open_seed = dictionary_crc
        self.session_seed = crc32(struct.pack("<I", session), dictionary_crc)

    def sealed(self, body: bytes) -> bytes:
        """Return a body with its CRC, which is continued from the seed of its kind."""
        kind = body[1]
        seed = self.session_seed if is_of_session(kind) else self.open_seed if kind >= 0x10 else 0
        return body + struct.pack("<I", crc32(body, seed))

    def make(self, kind: int, payload: bytes, flags: int = 0, seq: int = 0, ack: int = 0) -> bytes:
        """Return the bytes of a frame for the wire."""
        return stuff(self.sealed(bytes((VERSION << 4 | flags, kind, seq, ack)) + payload))

    def feed(self, data: bytes) -> list[tuple[int, int, int, int, bytes]]:
        """Take what has arrived; return flags, kind, seq, ack and payload of each frame that it completes."""
        *chunks, tail = (self.tail + data).split(b"\0")
        self.tail = tail[:FRAME_MAX]  # longer than any frame: enough to see that it is none
        bodies = [unstuff(chunk) for chunk in chunks]
        return [(body[0] & 15, *body[1:4], body[4:-4]) for body in bodies if self.is_ours(body)]

    def is_ours(self, body: bytes) -> bool:
        """Return whether a body is whole, made for this session, and without the node or tag of a greater client."""
        if not 8 <= len(body) <= 253 or body != self.sealed(body[:-4]) or body[0] & (NODE | SEALED):
            return False
        return body[1] < 0x10 or (body[0] >> 4 == VERSION and not body[0] & RESERVED)


class Stranger:
    """A session with the robot behind the terminal at `path`."""

    def __init__(self, path: str, now_s: Callable[[], float] = time.monotonic):
        self.now_s = now_s
        self.line = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.line)
        settings = termios.tcgetattr(self.line)
        settings[4] = settings[5] = termios.B115200
        termios.tcsetattr(self.line, termios.TCSANOW, settings)
        self.frames, self.words = Frames(), Words(FIRST_WORDS)
        self.session = struct.unpack("<I", os.urandom(4))[0] or 1
        self.is_open = self.owes_ack = False
        self.seq = self.posted = self.expected = self.acknowledged = 0
        self.sent_s, self.heard = now_s(), []

    def open(self) -> None:
        """Say hello, read the dictionary and begin the session; raise PermissionError when another has the lease."""
        self.write(b"\0")
        hello = {"version": VERSION, "session": self.session, "attach": 0, "nonce_a": 0, "nonce_b": 0}
        self.identity = self.ask("hello", hello, "identity", session=self.session)
        if self.identity["role"] != 1 or self.identity["secured"]:
            raise PermissionError(f"no orders from this client: {self.identity}")

        definitions, _, self.profile = self.read_dictionary().partition(b"\n\n")
        self.limits = json.loads(self.profile)
        self.words = Words(definitions.decode())
        self.frames.learn(self.identity["dictionary_crc"], self.session)
        self.is_open = True
        self.order("status_request")

    def read_dictionary(self) -> bytes:
        """Return the dictionary, or raise ValueError when its CRC is not the one that the robot has named."""
        text = b""
        while len(text) < self.identity["dictionary_bytes"]:
            page = {"part": 0, "offset": len(text), "count": PIECE_BYTES}
            text += self.ask("dictionary", page, "dictionary_page", part=0, offset=len(text))["text"]
        if crc32(text) != self.identity["dictionary_crc"]:
            raise ValueError(f"a dictionary with the CRC {crc32(text):#010x}")
        return text

    def upload(self, code: bytes) -> None:
        """Send a program, ready for `start`."""
        header = struct.pack("<2sBBIII", b"SG", 2, 0, crc32(self.profile), len(code), crc32(code))
        self.order("program", header=header)
        for offset in range(0, len(code), PIECE_BYTES):
            self.order("code", offset=offset, code=code[offset : offset + PIECE_BYTES])

    def subscribe(self, slot: int, period_ms: int, names: list[str]) -> None:
        """Have the robot send these variables."""
        numbers = bytes(self.words.variables[name][0] for name in names)
        self.order("subscribe", slot=slot, period_ms=period_ms, on_change=0, variables=numbers)

    def stop(self) -> dict:
        """Switch every coil off, and return what the robot says then."""
        self.heard = [(name, values) for name, values in self.heard if name != "stopped"]
        return self.wait("stopped", again=lambda: self.write(3 * STOP), again_s=0.1)

    def order(self, name: str, **values) -> dict:
        """Give an order, again and again until it has arrived; return its answer, or raise Refused."""
        seq, self.seq = self.seq, (self.seq + 1) % 256

        def again() -> None:
            if self.acknowledged != self.seq:
                self.send(name, values, RELIABLE, seq)

        answer = self.wait(again=again, request=seq)
        if "limit" in answer:
            raise Refused(answer)
        return answer

    def ask(self, name: str, values: dict, answer: str, **wanted) -> dict:
        """Say a greeting, again and again until its answer comes, and return that."""
        return self.wait(answer, again=lambda: self.send(name, values), **wanted)

    def wait(self, name: str = "", again: Callable = bool, again_s: float = 0.25, **wanted) -> dict:
        """Return the next message of that name, or of any, with the fields `wanted`; do `again` until it comes."""
        next_s = self.now_s()
        end_s = next_s + PATIENCE_S
        while (now_s := self.now_s()) < end_s:
            for index, (heard, values) in enumerate(self.heard):
                if name in ("", heard) and wanted.items() <= values.items():
                    return self.heard.pop(index)[1]
            if now_s >= next_s:
                again()
                next_s = now_s + again_s
            self.turn()
        raise TimeoutError(f"{name} {wanted} did not come within {PATIENCE_S} s")

    def turn(self) -> None:
        """Hear what comes within 20 ms, and send `alive` when it is due."""
        if select.select([self.line], [], [], 0.02)[0]:
            for frame in self.frames.feed(os.read(self.line, 4096)):
                self.hear(*frame)
        if self.is_open and (self.owes_ack or self.now_s() - self.sent_s > 0.1):
            self.send_alive()

    def hear(self, flags: int, kind: int, seq: int, ack: int, payload: bytes) -> None:
        """Keep what a frame says: once and in order if it is reliable; pass over what the dictionary does not name."""
        if is_of_session(kind):
            self.owes_ack |= bool(flags & RELIABLE)
            if flags & RELIABLE and seq != self.expected:
                return
            self.expected = (self.expected + (flags & RELIABLE)) % 256
            self.acknowledged = ack
        if name := self.words.names.get(kind):
            with suppress(struct.error):
                self.heard = [*self.heard, (name, self.words.unpack(name, payload))][-HEARD_MAX:]

    def send_alive(self) -> None:
        """Tell the robot what has arrived and that its host lives."""
        self.send("alive", {"have": 0, "slots": WINDOW, "bytes": 65535}, seq=self.posted)
        self.posted = (self.posted + 1) % 256

    def send(self, name: str, values: dict, flags: int = 0, seq: int = 0) -> None:
        """Put a message on the line."""
        kind, ack = self.words.kinds[name], 0
        if is_of_session(kind):
            ack, self.owes_ack, self.sent_s = self.expected, False, self.now_s()
        self.write(self.frames.make(kind, self.words.pack(name, values), flags, seq, ack))

    def write(self, data: bytes) -> None:
        """Put bytes on the line."""
        os.write(self.line, data)

    def close(self) -> None:
        """Leave the line; what is armed then goes off by itself when the lease is over."""
        os.close(self.line)
