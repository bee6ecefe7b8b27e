"""Both ends of a link whose session has a key: what is lost, repeated or said by somebody else on its way."""

import random

import pytest

from protocol import frames, messages, secret
from protocol.link import LAPS, Link

CRC, SESSION = 0x1234, 77
KEY, OTHER = secret.prepared(bytes(range(32))), secret.prepared(bytes(32))
FIRE = messages.FIRE.pack(coils=1, duty_permille=100, hold_ms=100)
CLOCK = messages.CLOCK_REQUEST.pack(host_us=7)


def ends(key=KEY, robots_key=KEY):
    """Return a host and a robot in session."""
    host, robot = Link(), Link(CRC, device=True)
    host.begin(CRC, SESSION, key)
    robot.begin(CRC, SESSION, robots_key)
    return host, robot


def kinds(received) -> list[int]:
    return [frame.kind for frame in received]


def test_thousands_of_frames_pass_a_line_that_loses_repeats_and_reorders():
    host, robot = ends()
    generator = random.Random(3)
    sent = taken = 0
    for now_ms in range(0, 60_000, 5):
        while host.room() > 48 and sent < 1500:
            host.send(messages.CODE.number, messages.CODE.pack(offset=sent, code=b""), now_ms)
            sent += 1
        for here, there in ((host, robot), (robot, host)):
            lines = [line + b"\x00" for line in here.poll(now_ms).split(b"\x00") if line]
            lines = [line for line in lines for _ in range(generator.choice((0, 1, 1, 1, 2)))]
            generator.shuffle(lines)
            for received in there.receive(b"".join(lines), now_ms):
                assert messages.CODE.unpack(received.payload).offset == taken
                taken += 1
        if taken == 1500:
            break

    assert taken == 1500
    assert host.forged == 0
    assert robot.duplicates > 100


@pytest.mark.parametrize("lost", [1, 255, 256, 257, 256 * LAPS - 1])
def test_a_posted_frame_is_taken_after_many_were_lost(lost):
    host, robot = ends()
    for _ in range(lost):
        host.acknowledge()
        host.poll(0)

    host.post(messages.CLOCK_REQUEST.number, CLOCK)

    assert kinds(robot.receive(host.poll(0), 0)) == [messages.CLOCK_REQUEST.number]
    assert robot.forged == 0


def test_a_posted_frame_is_taken_once():
    host, robot = ends()
    host.post(messages.CLOCK_REQUEST.number, CLOCK)
    line = host.poll(0)

    first, again = robot.receive(line, 0), robot.receive(line, 500)

    assert (len(first), len(again), robot.duplicates, robot.heard_ms) == (1, 0, 1, 0)


def test_a_posted_frame_that_comes_again_after_its_numbers_wrapped_is_forged():
    host, robot = ends()
    host.acknowledge()
    line = host.poll(0)
    robot.receive(line, 0)
    for _ in range(256):
        host.acknowledge()
        robot.receive(host.poll(0), 0)

    robot.receive(line, 500)

    assert (robot.forged, robot.duplicates, robot.heard_ms) == (1, 0, 0)


@pytest.mark.parametrize("key", [OTHER, b""], ids=["another key", "no key"])
def test_a_robots_answer_is_nothing_to_its_host_without_the_hosts_key(key):
    host, robot = ends(robots_key=key)
    robot.send(messages.OK.number, messages.OK.pack(request=0), 0)

    assert host.receive(robot.poll(0), 0) == []
    assert host.forged == 1
    assert host.heard_ms is None


def test_a_host_does_not_take_its_own_orders_for_answers():
    host, _ = ends()
    host.send(messages.FIRE.number, FIRE, 0)
    host.acknowledge()
    line = host.poll(0)

    assert host.receive(line, 0) == []
    assert host.forged == line.count(0) > 0


def test_a_false_acknowledgement_drops_nothing():
    host, _ = ends()
    host.send(messages.FIRE.number, FIRE, 0)
    host.poll(0)
    alive = messages.ALIVE.pack(have=0xFFFF, slots=16, bytes=0xFFFF)
    seed = frames.session_seed(CRC, SESSION)

    for flags in (0, frames.SEALED):
        body = frames.head(messages.ALIVE.number, 0, 1, flags) + alive + bytes(8 if flags else 0)
        host.receive(frames.encode(frames.close(body, seed)), 1)

    assert not host.idle()
    assert host.forged == 2


def test_telemetry_and_greetings_need_no_key():
    host, robot = ends(robots_key=OTHER)
    robot.post(messages.CLOCK.number, messages.CLOCK.pack(host_us=7, received_ms=1, sent_ms=1))
    robot.post(messages.STOPPED.number, messages.STOPPED.pack(state=1, code=0, coils=0, now_ms=1))

    assert kinds(host.receive(robot.poll(0), 0)) == [messages.CLOCK.number, messages.STOPPED.number]
    assert host.forged == 0


def test_the_longest_payload_fits_with_its_tag():
    host, robot = ends()
    host.send(messages.CODE.number, bytes(frames.PAYLOAD_MAX), 0)

    (received,) = robot.receive(host.poll(0), 0)

    assert len(received.payload) == frames.PAYLOAD_MAX
