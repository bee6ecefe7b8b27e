"""What is fuzzed: each target takes bytes, reads in them what is to happen, and raises when something does not hold.

An input is a row of acts; what it says of frames is sealed here, so that the fuzzer need not guess a CRC-32.

    TARGETS["decoder"](data)
"""

from protocol import frames, messages, secret
from protocol.canbus import CLASSIC, FD, UNDER_WAY_MAX, Assembler, Segmenter
from protocol.link import PAST_MAX, QUEUE_MAX, WINDOW, Link
from tests.fuzz_gait import gait
from tests.fuzz_host import session
from tests.fuzz_robot import core, hand, press
from tests.fuzz_script import CRC, SESSION, Script
from tests.fuzz_terminals import slcan, socketcand

KEY = secret.prepared(b"a key of some length")


def decoder(data: bytes) -> None:
    """However a stream is cut, the same frames come out of it, and each is one that could be sent."""
    script = Script(data)
    whole, pieces = frames.Decoder(CRC, SESSION), frames.Decoder(CRC, SESSION)
    got, stream = [], b""
    while script:
        piece = script.line() if script.byte() & 1 else script.some()
        stream += piece
        got += pieces.feed(piece)
        assert len(pieces._tail) <= frames.BODY_MAX + 1
    assert whole.feed(stream) == got
    assert whole.dropped == pieces.dropped
    for frame in got:
        assert frame.kind < frames.GREETINGS_BELOW or frame.body[0] >> 4 == frames.VERSION
        assert len(frame.body) + frames.CRC_BYTES <= frames.BODY_MAX


class Talk:
    """Two ends, what is on its way between them, and what each has said."""

    def __init__(self, mode: int) -> None:
        self.key = KEY if mode & 1 else b""
        self.ends = [Link(node=mode >> 1 & 3, device=device) for device in (False, True)]
        for end in self.ends:
            end.begin(CRC, SESSION, self.key)
        self.ends[1].may_adopt = mode & 8 != 0
        self.said, self.got = ([], []), [0, 0]
        self.flying, self.heard = [b"", b""], []
        self.now_ms = 0

    def say(self, who: int, payload: bytes) -> None:
        """Queue an order."""
        if self.ends[who].room():
            self.ends[who].send(messages.FIRE.number, payload, self.now_ms)
            self.said[who].append(payload)

    def write(self, who: int, room: int) -> None:
        """Let an end write."""
        line = self.ends[who].poll(self.now_ms, room)
        assert len(line) <= room
        self.heard = [*self.heard[-50:], line]
        self.flying[1 - who] += line

    def read(self, who: int, line: bytes) -> None:
        """Let an end read; with a key each order is the next one, for nobody else could have made it."""
        end = self.ends[who]
        for received in end.receive(line, self.now_ms):
            if self.key and received.kind == messages.FIRE.number and end.session == SESSION:
                assert received.payload == self.said[1 - who][self.got[who]]
                self.got[who] += 1
        assert len(end._ahead) < WINDOW
        assert len(end._posts) <= QUEUE_MAX
        assert len(end._past) <= PAST_MAX


def link(data: bytes) -> None:
    """Two ends: with a key orders come once and in order; without one whoever has the seed may add his own."""
    script = Script(data)
    talk = Talk(script.byte())
    while script:
        act, who = script.byte(), script.byte() & 1
        talk.now_ms += act >> 4
        end = talk.ends[who]
        if act & 7 == 0:
            talk.say(who, script.some())
        elif act & 7 == 1:
            end.post(0x80 | script.byte(), script.some())
        elif act & 7 == 2:
            talk.write(who, 20 * script.byte())
        elif act & 7 == 3:
            line, talk.flying[who] = talk.flying[who], b""
            talk.read(who, line[script.byte() :] if act & 8 else line)
        elif act & 7 == 4 and talk.heard:
            talk.read(who, talk.heard[script.byte() % len(talk.heard)])
        elif act & 7 == 5:
            talk.read(who, script.line() if act & 8 else script.some())
        elif act & 7 == 6:
            script.session = script.byte()
            talk.ends[1].offer(script.session, KEY if act & 8 else b"")
        else:
            end.granted(script.byte(), script.byte() * 20)
            due_ms = end.due_ms(talk.now_ms)
            assert due_ms is None or due_ms >= talk.now_ms


def canbus(data: bytes) -> None:
    """Bodies on CAN between frames of anybody: nothing raises, nothing grows, a body is a body."""
    script = Script(data)
    mode = script.byte()
    fd, from_robot = mode & 1 != 0, mode & 2 != 0
    assembler, segmenter = Assembler(from_robot), Segmenter(3, 1, from_robot, FD if fd else CLASSIC)
    waiting, now_ms = [], 0
    while script:
        act = script.byte()
        now_ms += act >> 3
        if act & 3 == 0:
            waiting += segmenter.feed(script.line() if act & 4 else script.some())
        elif act & 3 == 1 and waiting:
            _assembled(assembler.feed(*waiting.pop(script.byte() % len(waiting) if act & 4 else 0), now_ms, fd))
        elif act & 3 == 2:
            number = int.from_bytes(script.some(4), "little") & 0x1FFFFFFF
            _assembled(assembler.feed(number, act & 4 != 0, script.some()[:64], now_ms, fd))
        elif waiting:
            waiting.pop(0)
        assert len(assembler._under_way) <= UNDER_WAY_MAX
        assert all(each.length < frames.BODY_MAX + FD for each in assembler._under_way)
        assert len(segmenter._tail) <= frames.BODY_MAX + 1


def _assembled(taken) -> None:
    if taken is not None and taken.line != frames.STOP:
        body = frames.decode(taken.line[:-1])
        assert frames.BODY_MIN <= len(body) <= frames.BODY_MAX
        assert body[1] == taken.kind
        assert frames.STOP not in b"\x00" + taken.line


TARGETS = {
    "decoder": decoder, "link": link, "core": core, "hand": hand, "press": press, "session": session, "canbus": canbus,
    "slcan": slcan, "socketcand": socketcand, "gait": gait,
}  # fmt: skip
