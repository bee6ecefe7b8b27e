"""Two ends of a line in virtual time, and a line that loses, repeats, delays and flips what it carries.

Every order says which session it belongs to and which of that session's it is, so that whoever is handed one knows
whether it comes once, in order and where it belongs. `Ends` asserts that of all that is delivered.

    ends = Ends(seed=1, share=0.2)
    ends.host_says(5)
    ends.run(100)
    ends.clear_up()       # the line becomes good: all must arrive
"""

import random
import struct

from protocol import frames, secret
from protocol import link as links
from protocol.messages import EVENT, FIRE, HELLO, IDENTITY

STEP_MS = 5
HELLO_MS = 250  # between two hellos of a host that was not answered
SILENT_MS = 2000  # after which a host whose orders are not acknowledged gives up and comes anew
ARRIVES_MS = 2000  # within which all arrives over a line that has become good, for a host that was not given up
KEPT = 400  # frames that may come back from the dead
CRC = 0x12345678


class Line:
    """One direction. `share` of all frames are lost, so many repeated, so many late and so many damaged."""

    def __init__(self, chance: random.Random, share: float) -> None:
        self.chance = chance
        self.share = share
        self.cut = False
        self.heard = []  # that went over it, damaged or not: an ear's ammunition
        self._flying = []
        self._rest = b""  # of bytes that a read has left

    def carry(self, data: bytes, now_ms: int) -> None:
        """Take the bytes of one write."""
        for piece in data.split(b"\x00")[:-1]:
            frame = piece + b"\x00"
            self.heard = [*self.heard[1 - KEPT :], frame]
            copies = 0 if self.cut or self._hit() else 2 if self._hit() else 1
            for _ in range(copies):
                late_ms = self.chance.randrange(1, 60) if self._hit() else 2
                self._flying.append((now_ms + late_ms, self._damaged(frame) if self._hit() else frame))

    def land(self, now_ms: int) -> bytes:
        """Return what a read gives: on a bad line it may end anywhere."""
        due = [data for at_ms, data in self._flying if at_ms <= now_ms]
        self._flying = [(at_ms, data) for at_ms, data in self._flying if at_ms > now_ms]
        data = self._rest + b"".join(due)
        end = self.chance.randrange(len(data) + 1) if data and self._hit() else len(data)
        self._rest = data[end:]
        return data[:end]

    def _hit(self) -> bool:
        return self.chance.random() < self.share

    def _damaged(self, frame: bytes) -> bytes:
        data = bytearray(frame)
        for _ in range(self.chance.randrange(1, 4)):
            data[self.chance.randrange(len(data))] ^= 1 << self.chance.randrange(8)
        return bytes(data)


class Host:
    """A host and its one session; it says hello until it is known, then gives orders."""

    def __init__(self, session: int, node: int) -> None:
        self.session = session
        self.link = links.Link(node=node)
        self.open = False
        self.said = self.got = 0
        self.asked_ms = -HELLO_MS
        self.heard_ms = 0  # the last time that nothing waited, or the robot was heard


class Ends:
    """A robot, the host that speaks to it now and one that did before; `keyed`: frames carry tags."""

    def __init__(self, seed: int, share: float, node: int = 0, keyed: bool = False) -> None:
        self.chance = random.Random(seed)
        self.there, self.back = Line(self.chance, share), Line(self.chance, share)
        self.robot = links.Link(CRC, node, device=True)
        self.robot.may_adopt = True
        self.now_ms = 0
        self.said = {}  # by the robot, in each session
        self.taken = {}  # from the host, in each session
        self._node, self._keyed = node, keyed
        self._begun = 0
        self.former = None
        self.host = Host(1, node)

    def new_session(self) -> None:
        """Let another host come; the one before goes on for itself, with a few last orders."""
        self.host_says(6)
        self.former, self.host = self.host, Host(self.host.session + 1, self._node)

    def host_says(self, count: int) -> None:
        """Queue orders, as many as there is room for."""
        for _ in range(min(count, self.host.link.room()) if self.host.open else 0):
            self.host.link.send(FIRE.number, self._order(self.host.session, self.host.said), self.now_ms)
            self.host.said += 1

    def robot_says(self, count: int) -> None:
        """Queue events, as many as there is room for."""
        session = self.robot.session
        for _ in range(min(count, self.robot.room()) if session else 0):
            self.robot.send(EVENT.number, self._order(session, self.said.get(session, 0)), self.now_ms)
            self.said[session] = self.said.get(session, 0) + 1

    def replay(self, count: int) -> None:
        """Bring frames back that were heard before: of former sessions; where there are tags, of this one too."""
        for line in (self.there, self.back):
            lines = [frame for frame in line.heard if self._keyed or not self._is_of(frame, self.robot.session)]
            if lines:
                begin = self.chance.randrange(len(lines))
                line._rest += b"".join(lines[begin : begin + count])

    def run(self, ms: int) -> None:
        """Let time pass."""
        for _ in range(0, ms, STEP_MS):
            for host in (self.host, self.former):
                if host is not None:
                    self.there.carry(self._host_polls(host), self.now_ms)
            self.back.carry(self.robot.poll(self.now_ms), self.now_ms)
            self.now_ms += STEP_MS
            self._robot_hears(self.there.land(self.now_ms))
            if self.host.open and self.now_ms - self.host.heard_ms > SILENT_MS:
                self.new_session()
            data = self.back.land(self.now_ms)
            for host in (self.host, self.former):
                if host is not None:
                    self._host_hears(host, data)
            self.stay_bounded()

    def clear_up(self) -> int:
        """Make the line good and wait until all has arrived: what was said is what came. Return how long it took."""
        begun_ms = self.now_ms
        self.robot.may_adopt = True
        self.former = None
        for line in (self.there, self.back):
            line.share, line.cut = 0.0, False
        until_ms = self.now_ms + SILENT_MS + ARRIVES_MS
        while not self._done():
            assert self.now_ms < until_ms, self.story()
            self.run(STEP_MS)
        return self.now_ms - begun_ms

    def stay_bounded(self) -> None:
        """Assert that nothing has grown beyond its bound."""
        for link in (self.robot, self.host.link):
            assert len(link._ahead) < links.WINDOW
            assert len(link.flight.waiting) <= links.QUEUE_MAX
            assert len(link._posts) <= links.QUEUE_MAX
            assert len(link._past) <= links.PAST_MAX
            assert len(link.decoder._tail) <= frames.BODY_MAX + 1

    def story(self) -> str:
        """Return how far both have come, for whoever must find out why."""
        host, session = self.host, self.robot.session
        return (
            f"host {host.session} open {host.open}: said {host.said}, got {host.got}, idle {host.link.idle()}"
            f"; robot {session}: said {self.said.get(session)}, took {self.taken.get(session)}"
        )

    def _done(self) -> bool:
        host, session = self.host, self.host.session
        together = host.open and self.robot.session == session
        if not (together and host.link.idle() and self.robot.idle()):
            return False
        assert self.taken.get(session, 0) == host.said, self.story()
        assert self.said.get(session, 0) == host.got, self.story()
        return True

    def _host_polls(self, host: Host) -> bytes:
        if not host.open or (host.link.idle() and host.link.heard_ms is not None):
            host.heard_ms = self.now_ms
        elif host.link.heard_ms is not None:
            host.heard_ms = max(host.heard_ms, host.link.heard_ms)
        silent = not host.open or host.link.heard_ms is None
        if silent and self.now_ms - host.asked_ms >= HELLO_MS:
            host.asked_ms = self.now_ms
            host.link.post(HELLO.number, struct.pack("<I", host.session))
            if host.open:
                host.link.acknowledge()  # the first frame, with which the session begins, may be lost
        return host.link.poll(self.now_ms)

    def _robot_hears(self, data: bytes) -> None:
        before = self.robot.session
        delivered = self.robot.receive(data, self.now_ms)
        if self.robot.session != before:
            assert self.robot.may_adopt
            self._begun += 1
        for received in delivered:
            if received.kind == HELLO.number:
                self._greeted(struct.unpack("<I", received.payload)[0])
            else:
                session = self.robot.session
                self.taken[session] = self._follows(received.payload, session, self.taken.get(session, 0))

    def _greeted(self, session: int) -> None:
        self.robot.offer(session, self._key(session, self._begun))
        self.robot.post(IDENTITY.number, struct.pack("<II", session, self._begun))

    def _host_hears(self, host: Host, data: bytes) -> None:
        for received in host.link.receive(data, self.now_ms):
            if received.kind != IDENTITY.number:
                host.got = self._follows(received.payload, host.session, host.got)
                continue
            session, begun = struct.unpack("<II", received.payload)
            if session == host.session and not host.open:
                host.open = True
                host.link.begin(CRC, session, self._key(session, begun))
                host.link.acknowledge()

    def _follows(self, order: bytes, session: int, count: int) -> int:
        assert struct.unpack("<II", order[:8]) == (session, count)
        return count + 1

    def _order(self, session: int, number: int) -> bytes:
        return struct.pack("<II", session, number) + bytes(self.chance.choice((0, 0, 5, 60, 228)))

    def _key(self, session: int, begun: int) -> bytes:
        if not self._keyed:
            return b""
        return secret.prepared(secret.hmac(secret.prepared(b"pairing key"), struct.pack("<II", session, begun)))

    def _is_of(self, frame: bytes, session: int) -> bool:
        taken = frames.Decoder(CRC, session).feed(frame)
        return any(each.kind >= frames.GREETINGS_BELOW for each in taken)
