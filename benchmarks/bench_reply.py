"""How long the answer to an order takes over a pty, against a bare echo of as many bytes, by turns in one run.

Both peers are processes of their own. One reads and writes bytes, no more; in the other a link, the device's end, takes
the order and answers it, and here the host's end sends and takes. What a busy machine held up is in p99. Beside it is
told what the two ends cost without a line between them, and what `Robot.fire` takes, with all that watches over it.

    python benchmarks/bench_reply.py
"""

import os
import pty
import tempfile
import time
import tty
from collections.abc import Callable

from host.link import open_serial
from host.robot import Robot
from protocol.link import Link
from protocol.messages import FIRE, OK
from tests.fake_robot import FakeRobot

DICTIONARY_CRC, SESSION = 0x12345678, 77
WARM, EXCHANGES = 500, 10_000
AIM = 3.0
ORDER_BYTES, ANSWER_BYTES = 18, 11


def now_ms() -> int:
    """Return the clock of both ends."""
    return time.monotonic_ns() // 1_000_000


def fresh_link(device: bool) -> Link:
    """Return one end of a session."""
    link = Link(DICTIONARY_CRC, device=device)
    link.begin(DICTIONARY_CRC, SESSION)
    return link


def echo(port: int) -> None:
    """Answer whatever comes with so many bytes."""
    answer = bytes(ANSWER_BYTES)
    while os.read(port, 4096):
        os.write(port, answer)


def robot(port: int) -> None:
    """Answer every order with ok."""
    link = fresh_link(device=True)
    while data := os.read(port, 4096):
        os.write(port, answered(link, data, now_ms()))


def answered(link: Link, data: bytes, time_ms: int) -> bytes:
    """Take an order at the device's end and return the bytes of its answer."""
    for received in link.receive(data, time_ms):
        FIRE.unpack(received.payload)
        link.send(OK.number, OK.packed(received.seq), time_ms)
    return link.poll(time_ms)


def whole_robot(port: int) -> None:
    """Be the robot of the tests, which does all that a robot does."""
    made = FakeRobot()
    while data := os.read(port, 4096):
        os.write(port, made.step(now_ms(), data))


def started(work: Callable[[int], None]) -> int:
    """Start a process that works at one end of a pty and ends with this one; return the other end."""
    theirs, ours = pty.openpty()
    tty.setraw(ours)
    if os.fork() == 0:
        os.close(ours)
        try:
            work(theirs)
        finally:
            os._exit(0)
    os.close(theirs)
    return ours


def ask_echo(port: int) -> None:
    """Send so many bytes and wait for those of the answer."""
    os.write(port, bytes(ORDER_BYTES))
    missing = ANSWER_BYTES
    while missing > 0:
        missing -= len(os.read(port, 4096))


def ask_robot(link: Link, port: int) -> None:
    """Send an order and wait for its ok."""
    os.write(port, ordered(link, now_ms()))
    while not link.receive(os.read(port, 4096), now_ms()):
        pass


def ordered(link: Link, time_ms: int) -> bytes:
    """Return the bytes of an order."""
    link.send(FIRE.number, FIRE.packed(1, 600, 500), time_ms)
    return link.poll(time_ms)


def by_turns(*works: Callable[[], None]) -> list[list[float]]:
    """Return how long each call of each took, sorted [us]; they go one after the other, so load strikes all alike."""
    took: list[list[float]] = [[] for _ in works]
    for turn in range(WARM + EXCHANGES):
        for work, times in zip(works, took, strict=True):
            begun_ns = time.perf_counter_ns()
            work()
            if turn >= WARM:
                times.append((time.perf_counter_ns() - begun_ns) / 1000)
    return [sorted(times) for times in took]


def both_ends() -> Callable[[], None]:
    """Return an exchange of two links in this process."""
    host, device = fresh_link(device=False), fresh_link(device=True)

    def exchange() -> None:
        for received in host.receive(answered(device, ordered(host, 5), 5), 5):
            OK.unpack(received.payload)

    return exchange


def told(raw: list[float], rows: dict[str, list[float]]) -> None:
    """Print percentiles, and how many times the bare bytes they are."""
    print(f"{'us':34}p10     p50     p99   x bare p10    p50    p99")
    for name, times in {"bare bytes over a pty": raw, **rows}.items():
        shares = [(times[int(len(times) * share)], raw[int(len(raw) * share)]) for share in (0.1, 0.5, 0.99)]
        took = "".join(f"{time_us:8.1f}" for time_us, _ in shares)
        print(f"{name:31}{took}    " + "".join(f"{time_us / bare_us:7.1f}" for time_us, bare_us in shares))
    print(f"aim: the order takes at most {AIM:.0f} times as long")


def main() -> None:
    """Measure and print."""
    raw_port, robot_port, link = started(echo), started(robot), fresh_link(device=False)
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        user = Robot(open_serial(os.ttyname(started(whole_robot))))
        user.connect()
    raw, ours = by_turns(lambda: ask_echo(raw_port), lambda: ask_robot(link, robot_port))
    (bare,), (whole,) = by_turns(both_ends()), by_turns(lambda: user.fire(["A"], 600, 500))
    told(raw, {"an order and its ok over a pty": ours, "the same without a pty": bare, "Robot.fire over a pty": whole})


if __name__ == "__main__":
    main()
