"""What of a CAN bus's bit time messages of softrig fill, on the virtual clock of the plug-in bus, against the theory.

First host to host, back to back, classic and CAN FD: `of bit time` is what the bits of the frames take in theory
(fields, checksum, stuffed bits, three bits of intermission) over the time from the first bit to the last arrival: what
is missing to 100 % is rounding up to microseconds. `goodput` is payload, `bound` what the same bus carries if all of
every full frame were payload; between them lie segment bytes, the header and CRC-32 of a message, and frames that are
not full. Then a robot: what its firmware, with a controller that holds one frame, takes in and sends.

    python benchmarks/bench_can.py
"""

import time
from random import Random

import can

from hil_sim.can.messages import frame_of
from hil_sim.devices.canbits import bits_of
from hil_sim.devices.canframe import INTERMISSION_BITS, TAIL_BITS
from host.canbus import CanBus
from host.canlink import CanLink
from host.records import Telemetry
from host.robot import Robot
from protocol import frames, messages, program
from protocol.canbus import CLASSIC, FD, GAP_MS, Assembler, Segmenter

BIT_NS = 2_000
BUSES = {"classic 500 kbit/s": (CLASSIC, 2_000), "FD 500 k / 2 Mbit/s": (FD, 500), "FD 500 k / 5 Mbit/s": (FD, 200)}
PAYLOADS = (8, 42, 236)
COUNT = 60
PERIOD_MS, LISTEN_MS = 5, 2_000


def main() -> None:
    """Print a row for each bus and size of payload, and what a robot does."""
    print("host to host           payload  frames  of bit time     goodput       bound   share  wall")
    for name, (mtu, data_bit_ns) in BUSES.items():
        for size in PAYLOADS:
            count, filled, goodput, factor = measured(size, mtu, data_bit_ns)
            bound = bound_of(mtu, data_bit_ns)
            row = f"{name:20} {size:5} B {count:6.1f} {filled:10.1%} {goodput:10.0f} B/s {bound:7.0f} B/s"
            print(f"  {row} {goodput / bound:7.1%} {factor:5.2f}x")
    print("a robot, classic 500 kbit/s")
    for line in of_a_robot():
        print(f"  {line}")


def measured(size: int, mtu: int, data_bit_ns: int) -> tuple[float, float, float, float]:
    """Return frames a message, share of the bit time, payload bytes per second, and virtual over wall time."""
    cut = messages_of(size, mtu)
    fd = mtu == FD
    options = {"interface": "softrig", "channel": "", "fd": fd, "data_bitrate": 10**9 // data_bit_ns}
    with can.Bus(**options) as one, can.Bus(desk=one.desk, **options) as two:
        begun_s, wall_s, assembler, got = one.now_s(), time.perf_counter(), Assembler(False), 0
        for message in cut:
            one.send(message, timeout=1.0)
        while got < COUNT:
            message = two.recv(1.0)
            taken = assembler.feed(message.arbitration_id, True, bytes(message.data), 0, fd)
            got += taken is not None
        took_s, wall_s = one.now_s() - begun_s, time.perf_counter() - wall_s
    theory_ns = sum(bit_time_ns(message, data_bit_ns) for message in cut) - INTERMISSION_BITS * BIT_NS
    return len(cut) / COUNT, theory_ns / 1e9 / took_s, COUNT * size / took_s, took_s / wall_s


def bound_of(mtu: int, data_bit_ns: int) -> float:
    """Return how many bytes per second full frames carry."""
    full = [message for message in messages_of(max(PAYLOADS), mtu) if len(message.data) == mtu]
    return mtu * len(full) * 1e9 / sum(bit_time_ns(message, data_bit_ns) for message in full)


def messages_of(size: int, mtu: int) -> list[can.Message]:
    """Return the CAN messages of some bodies with random payloads."""
    draw, segmenter = Random(size), Segmenter(1, 1, False, mtu)
    head = bytes((frames.VERSION << 4, messages.FIRE.number, 0, 0))
    bodies = [head + draw.randbytes(size + frames.CRC_BYTES) for _ in range(COUNT)]
    cut = segmenter.feed(b"".join(frames.encode(body) for body in bodies))
    long = mtu == FD
    return [
        can.Message(arbitration_id=frame.identifier, data=frame.data, is_fd=long, bitrate_switch=long) for frame in cut
    ]


def bit_time_ns(message: can.Message, data_bit_ns: int) -> int:
    """Return what a frame takes in theory, with the intermission after it."""
    bits = bits_of(frame_of(message))
    return bits.duration_ns(len(bits.sent) + TAIL_BITS + INTERMISSION_BITS, BIT_NS, data_bit_ns)


def of_a_robot() -> list[str]:
    """Return what the firmware sends and takes in."""
    bus = CanBus.open("can:softrig:sphere-b?body=still")
    robot = Robot(CanLink(bus, 1))
    robot.connect()
    connected_s = bus.now_s() - 0.1
    robot.subscribe(PERIOD_MS)
    begun_s = bus.now_s()
    count = sum(isinstance(record, Telemetry) for record in robot.listen(LISTEN_MS))
    rate_hz = count / (bus.now_s() - begun_s)
    robot.subscribe(0)
    code = b"".join(program.fire(1, 500, 100 + n) + program.delay(100) for n in range(200))
    whole = program.header(code, robot.profile.crc, 0) + code
    begun_s = bus.now_s()
    robot.upload(whole[: program.HEADER_BYTES], whole[program.HEADER_BYTES :])
    rate = len(whole) / (bus.now_s() - begun_s)
    robot.link.close()
    fetched = 7 * 1000 / GAP_MS
    return [
        f"first hello to known, dictionary read: {connected_s:.3f} s",
        f"telemetry of 22 coils, asked for each {PERIOD_MS} ms: {rate_hz:.0f} Hz",
        f"upload of {len(whole)} B: {rate:.0f} B/s, {rate / fetched:.0%} of a segment each {GAP_MS} ms",
    ]


if __name__ == "__main__":
    main()
