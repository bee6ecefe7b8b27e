"""The reliable session: exactly once and in order over a line that loses, repeats, damages and delays."""

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol import flight, frames
from protocol import link as links
from protocol.messages import FIRE, TELEMETRY

SEED, SESSION = 99, 7
PAYLOADS = [bytes((i,)) * (i % 7) for i in range(40)]


def ends():
    """Return host and robot of one session."""
    pair = links.Link(), links.Link(device=True)
    for end in pair:
        end.begin(SEED, SESSION)
    return pair


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
    a, b = ends()
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
    link, _ = ends()
    link.send(FIRE.number, b"", 0)

    sent = [now_ms for now_ms in range(0, 60_000, 5) if link.poll(now_ms)]

    assert link.broken
    assert sent[:3] == [0, 250, 650]  # the first time-out, then doubled as far as RTO_MAX_MS
    assert sent[-1] - sent[-2] == flight.RTO_MAX_MS
    assert sent[-1] > 58_000


def test_a_greeting_does_not_carry_an_acknowledgement():
    a, b = ends()
    a.send(FIRE.number, b"", 0)
    b.receive(a.poll(0), 1)
    b.post(0x02, b"identity")

    a.receive(b.poll(1), 2)

    assert a.idle()


def test_posted_frames_are_not_resent_and_their_gaps_are_counted():
    a, b = ends()
    for number in range(5):
        a.post(TELEMETRY.number, bytes((number,)))
        data = a.poll(0)
        if number in (1, 2):
            continue
        b.receive(data, 0)

    assert b.missed == 2
    assert a.poll(10_000) == b""


def test_a_full_queue_is_an_error_of_the_caller_and_posts_give_way():
    link, _ = ends()
    for _ in range(links.QUEUE_MAX):
        link.send(FIRE.number, b"", 0)
        link.post(TELEMETRY.number, b"")
    link.post(TELEMETRY.number, b"")

    assert link.room() == 0
    with pytest.raises(links.LinkFull, match="96 frames"):
        link.send(FIRE.number, b"", 0)


def test_an_acknowledgement_is_sent_even_when_there_is_nothing_to_say():
    a, b = ends()
    a.send(FIRE.number, b"", 0)
    b.receive(a.poll(0), 1)

    a.receive(b.poll(1), 2)

    assert a.idle()


def test_a_session_that_begins_anew_starts_from_zero():
    a, b = ends()
    a.send(FIRE.number, b"old", 0)
    b.receive(a.poll(0), 0)
    a.begin(SEED, SESSION)
    b.begin(SEED, SESSION)

    a.send(FIRE.number, b"new", 0)

    assert [received.payload for received in b.receive(a.poll(0), 0)] == [b"new"]


def test_greetings_do_not_touch_the_session():
    a, b = ends()
    b.begin(SEED + 1, SESSION)
    a.post(0x01, b"hi")

    (received,) = b.receive(a.poll(0), 5)

    assert received.payload == b"hi"
    assert b.heard_ms is None


def test_no_more_is_written_than_there_is_room_and_nothing_is_lost():
    a, b = ends()
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


def test_only_the_frame_that_is_missing_is_sent_again_and_before_its_time_is_over():
    a, b = ends()
    for number in range(6):
        a.send(FIRE.number, bytes((number,)), 0)
    pieces = a.poll(0).split(b"\x00")[:-1]
    b.receive(b"".join(piece + b"\x00" for piece in pieces[:2] + pieces[3:]), 5)
    a.receive(b.poll(5), 10)

    again = a.poll(10)

    assert again.count(b"\x00") == 1
    assert [received.payload[0] for received in b.receive(again, 15)] == [2, 3, 4, 5]
    assert a.resent == 1


def test_no_frame_leaves_beyond_the_credit_in_frames_or_in_bytes():
    a, _ = ends()
    a.granted(3, 1000)
    for _ in range(10):
        a.send(FIRE.number, bytes(20), 0)
    assert a.poll(0).count(b"\x00") == 3

    a, _ = ends()
    a.granted(16, 100)
    for _ in range(10):
        a.send(FIRE.number, b"x" * 20, 0)
    assert len(a.poll(0)) == 3 * 30


def test_without_credit_one_frame_is_tried_after_a_while_so_that_nothing_stands_still_for_ever():
    a, _ = ends()
    a.granted(0, 100)
    a.send(FIRE.number, b"", 0)
    a.send(FIRE.number, b"", 0)

    assert a.poll(0) == b""
    assert a.poll(a.due_ms(0)).count(b"\x00") == 1


def test_an_end_that_cannot_answer_gives_no_credit_until_it_can_again():
    a, b = ends()
    for _ in range(links.QUEUE_MAX):
        b.send(FIRE.number, b"", 0)
    b.acknowledge()
    told = b.poll(0)
    a.receive(told, 0)
    a.send(FIRE.number, b"", 0)

    a_said = a.poll(0)
    assert FIRE.number not in kinds_of(a_said)
    b.receive(a_said, 0)

    for now_ms in range(5, 60, 5):
        b.receive(a.poll(now_ms), now_ms)
        a.receive(b.poll(now_ms), now_ms)
    assert a.idle()


def test_a_session_on_offer_begins_with_its_first_frame_and_not_before():
    host, robot = ends()
    late = links.Link()
    late.begin(SEED, SESSION + 1)
    robot.offer(SESSION + 1)
    host.send(FIRE.number, b"old", 0)
    assert [received.payload for received in robot.receive(host.poll(0), 0)] == [b"old"]

    robot.may_adopt = True
    late.send(FIRE.number, b"new", 0)
    assert [received.payload for received in robot.receive(late.poll(0), 0)] == [b"new"]
    host.send(FIRE.number, b"old", 0)

    assert robot.receive(host.poll(0), 0) == []
    assert robot.session == SESSION + 1


def test_a_session_on_offer_waits_while_it_may_not_begin():
    host, robot = ends()
    late = links.Link()
    late.begin(SEED, SESSION + 1)
    robot.offer(SESSION + 1)
    late.send(FIRE.number, b"new", 0)

    assert robot.receive(late.poll(0), 0) == []
    assert (robot.foreign, robot.session) == (1, SESSION)
    host.send(FIRE.number, b"old", 0)
    assert [received.payload for received in robot.receive(host.poll(0), 0)] == [b"old"]


def test_the_time_out_follows_the_round_trip_down_to_what_the_line_can_do():
    """No floor but the step of the robot's clock: on a quick line a lost frame costs some ms, not a hundred."""
    a, b = ends()
    for now_ms in range(0, 500, 5):
        a.send(FIRE.number, b"", now_ms)
        b.receive(a.poll(now_ms), now_ms)
        a.receive(b.poll(now_ms), now_ms)
    a.send(FIRE.number, b"", 500)
    a.poll(500)

    assert a.due_ms(500) - 500 <= 10


def test_a_long_frame_on_a_slow_line_is_given_the_time_that_its_bytes_take():
    a, _ = ends()
    a.byte_ns = 8_333_333  # 1200 baud
    a.send(FIRE.number, bytes(200), 0)
    a.poll(0)

    assert a.due_ms(0) > 200 * 8


def test_a_frame_for_another_node_of_the_line_is_not_taken():
    host, robot = links.Link(node=4), links.Link(node=5, device=True)
    host.begin(SEED, SESSION)
    robot.begin(SEED, SESSION)
    host.send(FIRE.number, b"", 0)

    assert robot.receive(host.poll(0), 0) == []
    assert robot.heard_ms is None


def test_a_robot_of_a_shared_line_answers_with_its_number_when_it_is_called_by_it():
    host, robot = links.Link(node=5), links.Link(node=5, device=True)
    host.begin(SEED, SESSION)
    robot.begin(SEED, SESSION)
    host.send(FIRE.number, b"", 0)
    robot.receive(host.poll(0), 0)

    host.receive(robot.poll(0), 0)

    assert host.idle()


@settings(max_examples=30, deadline=None)
@given(st.lists(st.binary(max_size=300), max_size=30))
def test_what_arrives_never_raises_and_memory_stays_bounded(pieces):
    _, robot = ends()

    for piece in pieces:
        robot.receive(piece, 0)

    assert len(robot._ahead) < links.WINDOW


def kinds_of(line):
    """Return the kinds of the frames on a line."""
    decoder = frames.Decoder(SEED, SESSION)
    return [frame.kind for frame in decoder.feed(line)]
