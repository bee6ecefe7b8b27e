"""On a clean line of any speed nothing is sent twice, however full it is both ways: what is late is not lost."""

from itertools import pairwise

import pytest

from protocol import link as links
from protocol.flight import Flight
from protocol.messages import EVENT, FIRE

LATENCY_MS = 2
STEP_MS = 5  # of a robot
ROOM = 256  # bytes that wait to leave a robot
CREDIT = 960  # bytes that a robot takes


class Pipe:
    """One direction of a line of a given speed, in virtual time."""

    def __init__(self, byte_ns: int) -> None:
        self._byte_ns = byte_ns
        self._free_ns = 0  # when the last byte has left
        self._flying = []

    def waiting(self, now_ms: int) -> int:
        """Return how many bytes have not left yet."""
        return max(0, self._free_ns - now_ms * 1_000_000) // self._byte_ns

    def write(self, data: bytes, now_ms: int) -> None:
        for frame in data.split(b"\x00")[:-1]:
            self._free_ns = max(self._free_ns, now_ms * 1_000_000) + self._byte_ns * (len(frame) + 1)
            self._flying.append((self._free_ns // 1_000_000 + LATENCY_MS, frame + b"\x00"))

    def read(self, now_ms: int) -> bytes:
        due = [frame for at_ms, frame in self._flying if at_ms <= now_ms]
        del self._flying[: len(due)]
        return b"".join(due)


def saturate(baud: int, order_bytes: int, event_bytes: int, until_ms: int = 3000):
    """Keep both ends' queues filled; return host, robot and how many frames arrived."""
    byte_ns = 10_000_000_000 // baud
    host, robot = links.Link(), links.Link(device=True)
    for end in (host, robot):
        end.begin(1, 2)
        end.byte_ns = byte_ns
    robot.grant_bytes = CREDIT
    host.granted(16, CREDIT)
    there, back = Pipe(byte_ns), Pipe(byte_ns)
    count = 0
    for now_ms in range(until_ms):
        while host.room() > 20:
            host.send(FIRE.number, bytes(order_bytes), now_ms)
        there.write(host.poll(now_ms), now_ms)
        count += len(host.receive(back.read(now_ms), now_ms))
        if now_ms % STEP_MS == 0:
            count += len(robot.receive(there.read(now_ms), now_ms))
            while event_bytes and robot.room() > 20:
                robot.send(EVENT.number, bytes(event_bytes), now_ms)
            back.write(robot.poll(now_ms, ROOM - back.waiting(now_ms)), now_ms)
    return host, robot, count


@pytest.mark.parametrize("baud", [38_400, 115_200, 921_600])
@pytest.mark.parametrize(("order_bytes", "event_bytes"), [(9, 0), (9, 17), (228, 17), (228, 228)])
def test_a_clean_line_that_is_full_both_ways_needs_no_resend(baud, order_bytes, event_bytes):
    host, robot, count = saturate(baud, order_bytes, event_bytes)

    assert count > 15
    assert (host.resent, robot.resent) == (0, 0)


def test_the_time_out_does_not_sink_below_a_round_trip_that_varies():
    """The mean of 4 and 8 ms is 6 ms; in whole milliseconds it once fell to 4, and every other answer was late."""
    flight = Flight()
    times = []
    for place, rtt_ms in enumerate([4, 8] * 100):
        flight.add(FIRE.number, place, b"", 20)
        flight.sent(flight.waiting[0], 100 * place, 0)
        flight.acknowledged(place + 1 & 255, 0, 100 * place + rtt_ms)
        times.append(flight.rtt_ms)

    assert times[-1] in (5, 6)
    assert all(abs(later - earlier) <= 1 for earlier, later in pairwise(times[10:]))
