"""What a session must never take from another, and what two ends must never lose: each found by the model once."""

import pytest

from protocol import frames
from protocol import link as links
from protocol.messages import ALIVE, CLOCK_REQUEST, FIRE, SYNC

SEED, OLD, NEW = 99, 7, 8


def end(session, device=False, node=0):
    link = links.Link(node=node, device=device)
    link.begin(SEED, session)
    return link


def offered():
    """Return the host of a session, the host of the next, and a robot that may follow."""
    robot = end(OLD, device=True)
    robot.offer(NEW)
    robot.may_adopt = True
    return end(OLD), end(NEW), robot


def said(link, *payloads):
    """Return the line with these orders."""
    for payload in payloads:
        link.send(FIRE.number, payload, 0)
    return link.poll(0)


def kinds_of(line):
    return [frame.kind for frame in frames.Decoder(SEED, OLD).feed(line)]


def without_alive(line):
    return b"".join(each + b"\x00" for each in line.split(b"\x00")[:-1] if kinds_of(each + b"\x00") != [ALIVE.number])


def payloads(delivered):
    return [received.payload for received in delivered]


def test_a_session_may_begin_with_several_frames_at_once():
    _, new, robot = offered()

    assert payloads(robot.receive(said(new, b"first", b"second"), 0)) == [b"first", b"second"]


def test_an_order_of_the_last_session_is_none_of_the_next_though_it_comes_in_the_same_bytes():
    old, new, robot = offered()
    before, behind = said(old, b"before"), said(old, b"behind")

    got = robot.receive(before + said(new, b"first") + behind, 0)

    assert payloads(got) == [b"first"]
    assert robot.session == NEW


def test_a_start_for_all_robots_is_not_lost_where_a_session_begins():
    _, new, robot = offered()
    new.post(SYNC.number, b"")
    sync = new.poll(0)

    assert [received.kind for received in robot.receive(sync + said(new, b"first"), 0)] == [SYNC.number, FIRE.number]


def test_a_session_that_is_over_does_not_begin_again_with_its_late_hello_and_orders():
    old, new, robot = offered()
    late = said(old, b"late")
    robot.receive(said(new, b"first"), 0)

    assert not robot.offer(OLD)
    assert robot.receive(late, 0) == []
    assert robot.session == NEW


def test_only_so_many_sessions_are_remembered():
    robot = end(OLD, device=True)

    for session in range(100, 200):
        robot.begin(SEED, session)

    assert len(robot._past) == links.PAST_MAX


def test_credit_is_told_until_it_is_heard():
    """The `alive` that opens the credit again is lost, and every later acknowledgement travels with an answer."""
    host, robot = end(OLD), end(OLD, device=True)
    for _ in range(links.QUEUE_MAX):
        robot.send(FIRE.number, b"", 0)
    robot.acknowledge()
    host.receive(robot.poll(0), 0)
    while not robot.idle():
        robot.receive(host.poll(0), 0)
        host.receive(without_alive(robot.poll(0)), 0)
    robot.acknowledge()
    robot.poll(0)
    for _ in range(4):
        host.send(FIRE.number, b"", 0)
    assert FIRE.number not in kinds_of(host.poll(0))

    robot.receive(host.poll(500), 500)  # without credit: one frame, on trial
    robot.send(FIRE.number, b"answer", 500)
    host.receive(robot.poll(500), 500)

    assert kinds_of(host.poll(505)).count(FIRE.number) == 3


def test_credit_that_was_told_earlier_and_comes_late_does_not_count():
    host, robot = end(OLD), end(OLD, device=True)
    told = []
    for slots in (0, 16):
        payload = ALIVE.pack(have=0, slots=slots, bytes=1000)
        robot.post(ALIVE.number, payload)
        told.append(robot.poll(0))
    host.send(FIRE.number, b"", 0)

    host.receive(told[1] + told[0], 0)

    assert host.poll(0) != b""
    assert host.duplicates == 1


def test_a_posted_frame_that_comes_twice_renews_nothing():
    host, robot = end(OLD), end(OLD, device=True)
    host.acknowledge()
    line = host.poll(0)
    robot.receive(line, 0)

    robot.receive(line, 100)

    assert robot.heard_ms == 0


def test_opened_credit_is_due_at_once():
    host, robot = end(OLD), end(OLD, device=True)
    for _ in range(links.QUEUE_MAX - links.RESERVE):
        robot.send(FIRE.number, b"", 0)
    robot.acknowledge()
    host.receive(robot.poll(0).split(b"\x00")[0] + b"\x00", 0)
    host.post(ALIVE.number, ALIVE.pack(have=0, slots=0, bytes=1000))
    robot.receive(host.poll(0), 0)

    assert robot.due_ms(0) == 0
    assert kinds_of(robot.poll(0)) == [ALIVE.number]


def test_no_more_is_written_than_there_is_room_also_when_a_robot_learns_that_the_line_is_shared():
    robot, host = end(OLD, device=True, node=5), end(OLD, node=5)
    robot.send(FIRE.number, b"queued before", 0)
    host.post(CLOCK_REQUEST.number, bytes(4))
    robot.receive(host.poll(0), 0)

    line = robot.poll(0, room=len(b"queued before") + frames.BODY_MIN + frames.STUFFING)

    assert line == b""
    assert len(robot.poll(0)) == len(b"queued before") + frames.BODY_MIN + frames.STUFFING + 1


def test_a_payload_that_no_frame_can_carry_is_refused_when_it_is_handed_over():
    for call in (lambda: end(OLD).send(FIRE.number, bytes(237), 0), lambda: end(OLD).post(ALIVE.number, bytes(237))):
        with pytest.raises(ValueError, match="237 bytes, at most 236"):
            call()
