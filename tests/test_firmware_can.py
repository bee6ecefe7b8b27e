"""The CAN driver on the chip's model, through the bench's `machine`, in CPython and in real MicroPython."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from hil_sim.devices.canframe import Frame
from hil_sim.devices.canstation import CanStation
from hil_sim.worlds import cpython, micropython
from hil_sim.worlds.costs import BOOT_US
from tests.bench_fakes import bench_of

ROOT = Path(__file__).parents[1]
DRIVER = (ROOT / "firmware" / "drivers" / "mcp2515.py").read_text()
BEGIN = """
from machine import SPI
from firmware.drivers.mcp2515 import *
can = Mcp2515(SPI(0, 8_000_000), Pin(17, Pin.OUT, value=1), 8_000_000)
can.begin(500_000)
"""


@pytest.fixture(autouse=True, params=[cpython, micropython], ids=["cpython", "micropython"])
def world(request, monkeypatch):
    """Each test runs in both worlds."""
    monkeypatch.setattr("tests.bench_fakes.EXECUTE", request.param.execute)


class Rig:
    """A board with a station on its CAN bus."""

    def __init__(self, folder, main: str) -> None:
        files = {"firmware/drivers/mcp2515.py": DRIVER, "firmware/__init__.py": "", "firmware/drivers/__init__.py": ""}
        self.bench = bench_of(folder, BEGIN + main, files)
        self.wire = self.bench.board.can.can.wire
        self.station = CanStation(self.wire, 500_000)

    def run(self, ms: int = 100) -> list[str]:
        """Run to that time after the boot, close, and return what was printed."""
        self.bench.clock.run_until(BOOT_US + ms * 1000)
        self.bench.close()
        assert not self.bench.crashes or "ended" in self.bench.crashes[-1].error
        return "".join(self.bench.world.console).split("\n")[:-1]


def test_frames_leave_in_the_order_in_which_they_were_handed_over(tmp_path):
    main = """
data, sent = bytearray(8), 0
while sent < 10:
    data[0] = sent
    sent += can.send(0x100 + sent % 2, data, 1)
"""
    rig = Rig(tmp_path, main)

    rig.run()

    assert rig.station.received == [Frame(0x100 + n % 2, bytes((n,))) for n in range(10)]


def test_two_frames_find_room_and_a_third_does_not(tmp_path):
    rig = Rig(tmp_path, "print([can.send(0x100, bytes(8), 8) for _ in range(3)])")

    assert rig.run() == ["[True, True, False]"]


def test_an_urgent_frame_overtakes_those_that_wait(tmp_path):
    main = """
data = bytearray(range(8))
print([can.send(0x100, data, 1, at=1), can.send(0x100, data, 1, at=2)])
print([can.send(0x7FF, data, 1, urgent=True, at=3), can.send(0x7FF, data, 1, urgent=True, at=4)])
time.sleep_ms(2)
print(can.send(0x7FF, data, 1, urgent=True, at=5))
"""
    rig = Rig(tmp_path, main)

    assert rig.run() == ["[True, True]", "[True, False]", "True"]
    assert [frame.data[0] for frame in rig.station.received] == [1, 3, 2, 5]


def test_filters_keep_a_buffer_free_for_what_must_not_be_lost(tmp_path):
    main = """
can.accept(0, 0x7FF, (0,), False)
can.accept(1, 0x1FFFFC00, (0x1000, 0x2000), True)
can.begin(500_000)
time.sleep_ms(20)
print(can.overflowed())
while can.receive(): print(hex(can.identifier), can.extended, can.data[0])
"""
    rig = Rig(tmp_path, main)
    sent = [Frame(0x1003, b"\x01", True), Frame(0x2003, b"\x02", True), Frame(0x3003, b"\x03", True), Frame(0, b"\x04")]
    rig.bench.clock.at(BOOT_US + 5_000, lambda: [rig.station.send(frame) for frame in sent])

    assert rig.run() == ["True", "0x0 False 4", "0x1003 True 1"]


def test_a_chip_that_gives_up_tries_once_and_says_whether_anybody_heard(tmp_path):
    main = """
data = bytearray(8)
can.send(0x100, data, 0), can.send(0x101, data, 0)
time.sleep_us(500)
can.give_up()
time.sleep_ms(2)
can.count_errors()
before = can.transmit_errors
print(can.has_sent(), can.send(0x102, data, 0))
time.sleep_ms(10)
can.count_errors()
print(can.has_sent(), can.transmit_errors - before)
time.sleep_ms(20)
can.persist()
print(can.send(0x103, data, 0))
time.sleep_ms(2)
print(can.has_sent(), can.has_sent())
"""
    rig = Rig(tmp_path, main)
    rig.wire.leave(rig.station)
    rig.bench.clock.at(BOOT_US + 25_000, lambda: rig.wire.join(rig.station))

    assert rig.run() == ["False True", "False 8", "True", "True False"]
    assert rig.station.received == [Frame(0x103)]


def test_an_extended_identifier_goes_out_and_comes_in(tmp_path):
    main = """
can.send(0x1ABCDEF5, b"\\x07", 1, True)
while not can.receive(): time.sleep_us(100)
print(can.identifier, can.extended, can.remote, can.length, can.data[0])
"""
    rig = Rig(tmp_path, main)
    rig.bench.clock.at(BOOT_US + 20_000, lambda: rig.station.send(Frame(0x15555555, b"\x2a", extended=True)))

    assert rig.run() == [f"{0x15555555} True False 1 42"]
    assert rig.station.received == [Frame(0x1ABCDEF5, b"\x07", extended=True)]


def test_frames_come_in_the_order_of_their_arrival(tmp_path):
    main = """
got = []
while len(got) < 12:
    while can.receive(): got.append(can.data[0])
    time.sleep_us(150)
print(got, can.overflowed())
"""
    rig = Rig(tmp_path, main)

    def send():
        for number in range(12):
            rig.station.send(Frame(0x100, bytes((number,))))

    rig.bench.clock.at(BOOT_US + 5_000, send)

    assert rig.run() == [f"{list(range(12))} False"]


def test_an_overflow_is_told_once(tmp_path):
    rig = Rig(tmp_path, "time.sleep_ms(10)\nprint(can.overflowed(), can.overflowed())")
    rig.bench.clock.at(BOOT_US + 5_000, lambda: [rig.station.send(Frame(0x100 + n)) for n in range(3)])

    assert rig.run() == ["True False"]


def test_the_interrupt_pin_is_low_while_a_frame_waits(tmp_path):
    main = """
irq = Pin(20, Pin.IN)
print(irq.value())
time.sleep_ms(10)
print(irq.value())
can.receive()
print(irq.value())
"""
    rig = Rig(tmp_path, main)
    rig.bench.clock.at(BOOT_US + 5_000, lambda: rig.station.send(Frame(0x100)))

    assert rig.run() == ["1", "0", "1"]


def test_state_and_counters_follow_the_errors_up_to_bus_off_and_restart_begins_anew(tmp_path):
    main = """
seen = [can.state()]
can.send(0x100, b"", 0)
while seen[-1] != BUS_OFF:
    time.sleep_us(20)
    if can.state() != seen[-1]: seen.append(can.state())
can.count_errors()
print(seen, can.transmit_errors)
can.restart()
can.count_errors()
print(can.state(), can.transmit_errors, can.send(0x101, b"", 0))
time.sleep_ms(5)
"""
    rig = Rig(tmp_path, main)
    rig.wire.spoil(32)

    assert rig.run() == ["[1, 2, 3, 4] 255", "1 0 True"]
    assert rig.station.received == [Frame(0x101)]


def test_a_lost_configuration_is_seen(tmp_path):
    rig = Rig(tmp_path, "print(can.configured())\ntime.sleep_ms(10)\nprint(can.configured(), can.state())")
    rig.bench.clock.at(BOOT_US + 5_000, rig.bench.board.can.reset)

    assert rig.run() == ["True", "False 0"]


def test_a_missing_chip_is_told_at_the_beginning(tmp_path):
    rig = Rig(tmp_path, "")
    rig.bench.board.can.alive = False
    rig.bench.clock.run_until(BOOT_US + 10_000)
    rig.bench.close()

    assert "19" in rig.bench.crashes[0].error


@pytest.mark.parametrize("rate", [1_000_000, 300_000, 1_000])
def test_a_rate_that_the_crystal_does_not_give_is_refused(tmp_path, rate):
    rig = Rig(tmp_path, f"try: can.begin({rate})\nexcept ValueError as error: print(error)")

    assert rig.run() == [f"bit rate {rate} Hz, with a crystal of 8000000 Hz"]


def printed(interpreter, *arguments, trial="can_trial.py") -> list[str]:
    paths = {"MICROPYPATH": f"{ROOT}:.frozen", "PYTHONPATH": str(ROOT)}
    command = [interpreter, str(ROOT / "tests" / trial), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **paths}, check=False)
    assert done.returncode == 0, done.stdout[-500:] + done.stderr
    return done.stdout.splitlines()


def test_nothing_is_allocated_once_it_has_begun():
    assert printed(micropython.interpreter(), "lock")[-1].startswith("received")


def test_both_interpreters_tell_the_chip_the_same():
    assert printed(micropython.interpreter()) == printed(sys.executable)


def test_a_look_at_the_bus_allocates_nothing():
    locked = printed(micropython.interpreter(), "lock", trial="canport_trial.py")

    assert locked == printed(sys.executable, trial="canport_trial.py")
