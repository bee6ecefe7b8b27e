"""What the link costs in round trips, bytes and waiting, on virtual time, so that every machine prints the same.

Round trips of a connection; bytes of a coil order with all that answers it, on a serial line and on CAN, beside those
of a MAVLink command and of a Klipper-style one; orders and pieces of a program a second over a line with a delay.

    python benchmarks/bench_link.py
"""

from pymavlink.dialects.v20 import common as mavlink

from benchmarks.slow_line import SlowLine
from benchmarks.wire_codecs import KlipperStyle, Sink
from hil_sim.devices.canbits import bits_of
from hil_sim.devices.canframe import INTERMISSION_BITS, TAIL_BITS, Frame
from host.dictionaries import Unknown
from host.pairing import Opening
from host.session import Session
from protocol import canbus, secret
from protocol.flight import WINDOW
from protocol.frames import BODY_MIN, STUFFING
from protocol.link import Link
from protocol.messages import CODE, FIRE, OK
from tests.fake_robot import FakeRobot

DICTIONARY_CRC, SESSION = 0x12345678, 77
BAUD = 115200
BYTE_NS = 10 * 1_000_000_000 // BAUD
TICK_US = 100
STEP_MS = 5  # of the robot's control loop, in which it reads its line
CREDIT_BYTES = 960  # that a board gives, of a receive buffer of 1024
PIECE = 192  # bytes of a program in a message
SECONDS = 10
KLIPPER_TRIPS, GRBL_LINES = 102, "23 to 103"  # measured once, with their own firmware in C; not in this run
ORDER = FIRE.packed(0b101, 600, 500)


class Remembered(Unknown):
    """Knows one dictionary, once it was kept."""

    text = b""

    def find(self, crc: int, size: int) -> bytes | None:
        """Return what was kept."""
        return self.text or None

    def keep(self, text: bytes) -> None:
        """Keep it."""
        self.text = text


def trips(known: Unknown) -> tuple[int, int]:
    """Return how many round trips a connection takes, and how many bytes of a dictionary it reads.

    The line only delays, by far more than anything else takes, so that its time tells the trips.
    """
    delay_ms = 100
    robot, line, session = FakeRobot(), SlowLine(delay_ms=delay_ms), Session(Opening(SESSION), 0, known)
    now_us = 0
    while not session.open:
        line.out.carry(session.poll(now_us), now_us)
        line.back.carry(robot.step(now_us // 1000, line.out.landed(now_us)), now_us)
        session.receive(line.back.landed(now_us), now_us)
        now_us += 1000
    return round(now_us / (2000 * delay_ms)), len(robot.dictionary)


def ends(node: int = 0, key: bytes = b"") -> tuple[Link, Link]:
    """Return host and device of a session that has just begun."""
    both = Link(DICTIONARY_CRC, node), Link(DICTIONARY_CRC, node, device=True)
    for link in both:
        link.begin(DICTIONARY_CRC, SESSION, secret.prepared(key) if key else b"")
    return both


def exchanged(node: int = 0, key: bytes = b"") -> tuple[bytes, bytes, bytes]:
    """Return the bytes of an order, of its answer, and of what acknowledges that if nothing else is said."""
    host, device = ends(node, key)
    host.send(FIRE.number, ORDER, 0)
    order = host.poll(0)
    for received in device.receive(order, 0):
        device.send(OK.number, OK.packed(received.seq), 0)
    answer = device.poll(0)
    host.receive(answer, 0)
    return order, answer, host.poll(0)


def on_can() -> list[int]:
    """Return the frames, and the bits, of an order and of its answer on classic CAN."""
    order, answer, _ = exchanged()
    sent = canbus.Segmenter(3, canbus.HOST, False).feed(order) + canbus.Segmenter(3, canbus.HOST, True).feed(answer)
    around = TAIL_BITS + INTERMISSION_BITS
    return [len(sent), sum(len(bits_of(Frame(each.identifier, each.data, True)).sent) + around for each in sent)]


def mavlink_bytes() -> tuple[int, int]:
    """Return the bytes of a command with three numbers, and of its acknowledgement."""
    mav = mavlink.MAVLink(Sink())
    command = mav.command_long_encode(1, 1, mavlink.MAV_CMD_USER_1, 0, 5, 600, 500, 0, 0, 0, 0)
    return len(command.pack(mav)), len(mav.command_ack_encode(mavlink.MAV_CMD_USER_1, 0).pack(mav))


def klipper_bytes() -> tuple[int, int]:
    """Return the bytes of a command with the same numbers, and of the empty block that acknowledges it."""
    return len(KlipperStyle().block((20, 0b101, 600, 500))), len(KlipperStyle().block(()))


def delivered(kind: int, payload: bytes, delay_ms: float, loss: float, credit: int) -> tuple[float, float]:
    """Return how many such orders a second are carried out and answered, and which share of the line they fill."""
    (host, device), line = ends(), SlowLine(BAUD, delay_ms, loss)
    host.byte_ns = device.byte_ns = BYTE_NS
    device.grant_bytes = credit
    host.granted(WINDOW, credit)
    done = 0
    for now_us in range(0, SECONDS * 1_000_000, TICK_US):
        now_ms = now_us // 1000
        while host.room() > 32:
            host.send(kind, payload, now_ms)
        if line.out.busy_until_us <= now_us:
            line.out.carry(host.poll(now_ms), now_us)
        if now_us % (1000 * STEP_MS) == 0:
            for received in device.receive(line.out.landed(now_us), now_ms):
                device.send(OK.number, OK.packed(received.seq), now_ms)
            line.back.carry(device.poll(now_ms), now_us)
        done += len(host.receive(line.back.landed(now_us), now_ms))
    size = len(payload) + BODY_MIN + STUFFING
    return done / SECONDS, done * size * BYTE_NS / 1e9 / SECONDS


def main() -> None:
    """Print the tables."""
    known = Remembered()
    first, size = trips(known)
    again, _ = trips(known)
    print(f"round trips to connect: {first} with a dictionary of {size} bytes to read, {again} with a known one, aim 2")
    print(f"  Klipper, with its dictionary of 4006 bytes: {KLIPPER_TRIPS} (measured once, not in this run)\n")

    print("bytes of a coil order             order   answer   acknowledged alone   together")
    for name, options in (("plain", {}), ("with a node", {"node": 3}), ("with a tag", {"key": b"k" * 32})):
        order, answer, alone = (len(part) for part in exchanged(**options))
        print(f"  {name:30}{order:7}{answer:9}{alone:21}{order + answer:11} to {order + answer + alone}")
    for name, (order, answer) in (("MAVLink", mavlink_bytes()), ("Klipper-style, without answer", klipper_bytes())):
        print(f"  {name:30}{order:7}{answer:9}{'':21}{order + answer:11}")
    print("  on classic CAN: {} frames, {} bits\n".format(*on_can()))

    print(f"at {BAUD} baud            orders/s   of the line   pieces of {PIECE} bytes: of the line")
    piece = CODE.packed(0, bytes(PIECE))
    for delay_ms, loss in ((0, 0), (4, 0), (16, 0), (0, 0.01), (4, 0.01), (16, 0.01)):
        orders, filled = delivered(FIRE.number, ORDER, delay_ms, loss, CREDIT_BYTES)
        _, pieces = delivered(CODE.number, piece, delay_ms, loss, CREDIT_BYTES)
        print(f"  {delay_ms:2} ms each way, {loss:3.0%} lost{orders:9.0f}{filled:14.0%}{pieces:35.0%}")
    print(f"  aim: all of the line at 16 ms, with {WINDOW} frames on the way and {CREDIT_BYTES} bytes of credit")
    print(f"  grbl: {GRBL_LINES} lines a second at 16 ms (measured once, not in this run)")


if __name__ == "__main__":
    main()
