"""The reliable session: exactly once and in order over a line that loses, repeats, damages and delays."""

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol import link as links
from protocol.messages import FIRE, TELEMETRY

SEED = 99
PAYLOADS = [bytes((i,)) * (i % 7) for i in range(40)]


class Weather:
    """A line in virtual time that treats each write by seeded chance."""

    def __init__(self, seed: int, share: float) -> None:
        self.chance = random.Random(seed)
        self.share = share
        self.flying = []

    def carry(self, data: bytes, now_ms: int) -> None:
        """Lose, repeat, damage or delay the frames of one write."""
        for frame in data.split(b"\x00")[:-1]:
            copies = 0 if self._hit() else 2 if self._hit() else 1
            for _ in range(copies):
                body = bytearray(frame + b"\x00")
                if self._hit():
                    body[self.chance.randrange(len(body))] ^= 1 << self.chance.randrange(8)
                late_ms = self.chance.randrange(30) if self._hit() else 2
                self.flying.append((now_ms + late_ms, bytes(body)))

    def land(self, now_ms: int) -> bytes:
        """Return what arrives by now."""
        due = [data for at_ms, data in self.flying if at_ms <= now_ms]
        self.flying = [(at_ms, data) for at_ms, data in self.flying if at_ms > now_ms]
        return b"".join(due)

    def _hit(self) -> bool:
        return self.chance.random() < self.share


def talk(seed: int, share: float, until_ms: int = 60_000):
    """Send PAYLOADS both ways; return what each end got and the two ends."""
    a, b = links.Link(SEED), links.Link(SEED)
    there, back = Weather(seed, share), Weather(seed + 1, share)
    got_a, got_b = [], []
    to_send = {a: list(PAYLOADS), b: list(PAYLOADS)}
    for now_ms in range(0, until_ms, 5):
        for end in (a, b):
            if to_send[end] and end.room() > links.QUEUE_MAX - 6:
                end.send(FIRE.number, to_send[end].pop(0), now_ms)
        there.carry(a.poll(now_ms), now_ms)
        back.carry(b.poll(now_ms), now_ms)
        got_b += [received.payload for received in b.receive(there.land(now_ms), now_ms)]
        got_a += [received.payload for received in a.receive(back.land(now_ms), now_ms)]
        if not to_send[a] and not to_send[b] and a.idle() and b.idle():
            break
    return got_a, got_b, a, b


def test_a_clean_line_needs_no_resend_and_measures_its_round_trip():
    got_a, got_b, a, _ = talk(seed=1, share=0.0)

    assert got_a == got_b == PAYLOADS
    assert a.resent == 0
    assert 2 <= a.rtt_ms <= 20


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32))
def test_commands_arrive_exactly_once_and_in_order_over_a_bad_line(seed):
    got_a, got_b, a, b = talk(seed, share=0.2)

    assert got_a == PAYLOADS
    assert got_b == PAYLOADS
    assert a.resent + b.resent > 0


def test_a_frame_that_nobody_acknowledges_breaks_the_link_and_is_still_sent_again():
    """A cable that is put back after a minute finds the event that was waiting; the host gives up by itself."""
    link = links.Link(SEED)
    link.send(FIRE.number, b"", 0)

    sent = [now_ms for now_ms in range(0, 60_000, 5) if link.poll(now_ms)]

    assert link.broken
    assert sent[:3] == [0, 250, 650]  # the first time-out, then doubled as far as RTO_MAX_MS
    assert sent[-1] - sent[-2] == links.RTO_MAX_MS
    assert sent[-1] > 58_000


def test_an_unseeded_answer_does_not_carry_an_acknowledgement():
    a, b = links.Link(SEED), links.Link(SEED)
    a.send(FIRE.number, b"", 0)
    b.receive(a.poll(0), 1)
    b.post(0x02, b"identity")

    a.receive(b.poll(1), 2)

    assert a.idle()


def test_posted_frames_are_not_resent_and_their_gaps_are_counted():
    a, b = links.Link(SEED), links.Link(SEED)
    for number in range(5):
        a.post(TELEMETRY.number, bytes((number,)))
        data = a.poll(0)
        if number in (1, 2):
            continue
        b.receive(data, 0)

    assert b.missed == 2
    assert a.poll(10_000) == b""


def test_a_full_queue_is_an_error_of_the_caller_and_posts_give_way():
    link = links.Link(SEED)
    for _ in range(links.QUEUE_MAX):
        link.send(FIRE.number, b"", 0)
        link.post(TELEMETRY.number, b"")
    link.post(TELEMETRY.number, b"")

    assert link.room() == 0
    with pytest.raises(links.LinkFull, match="64 frames"):
        link.send(FIRE.number, b"", 0)


def test_an_acknowledgement_is_sent_even_when_there_is_nothing_to_say():
    a, b = links.Link(SEED), links.Link(SEED)
    a.send(FIRE.number, b"", 0)
    b.receive(a.poll(0), 1)

    a.receive(b.poll(1), 2)

    assert a.idle()


def test_a_reset_link_starts_from_zero():
    a, b = links.Link(SEED), links.Link(SEED)
    a.send(FIRE.number, b"old", 0)
    b.receive(a.poll(0), 0)
    a.reset(SEED)
    b.reset(SEED)

    a.send(FIRE.number, b"new", 0)

    assert [received.payload for received in b.receive(a.poll(0), 0)] == [b"new"]


def test_unseeded_frames_do_not_touch_the_session():
    a, b = links.Link(SEED), links.Link(SEED + 1)
    a.post(0x01, b"hi")

    (received,) = b.receive(a.poll(0), 5)

    assert received.payload == b"hi"
    assert b.heard_ms is None


def test_no_more_is_written_than_there_is_room_and_nothing_is_lost():
    a, b = links.Link(SEED), links.Link(SEED)
    for number in range(6):
        a.send(FIRE.number, bytes((number,)) * 200, 0)
        a.post(TELEMETRY.number, bytes((number,)) * 200)
    got = []

    for now_ms in range(0, 1000, 5):
        data = a.poll(now_ms, room=300)
        assert len(data) <= 300
        got += [received.payload[0] for received in b.receive(data, now_ms)]
        a.receive(b.poll(now_ms), now_ms)

    assert got == [0, 1, 2, 3, 4, 5] * 2
    assert (b.missed, a.resent) == (0, 0)
