"""Troubles of line and bus: what they do to the bytes, and that who looks, and how often, changes nothing."""

from random import Random

import pytest

from hil_sim.devices.i2c import Bus
from hil_sim.devices.trouble import BusTrouble, Noise
from hil_sim.devices.uart import Uart
from hil_sim.devices.wire import Wire

SENT = bytes(range(256)) * 20
BYTE_US = 87


class Memory:
    """A chip of sixteen bytes behind a pointer."""

    def __init__(self):
        self.registers = bytearray(16)
        self.pointer = 0
        self.heard = []

    def answers(self, address):
        return address == 0x60

    def write(self, address, data):
        self.heard.append(data)
        self.pointer = data[0] & 0x0F
        self.registers[self.pointer : self.pointer + len(data) - 1] = data[1:]
        return len(data)

    def read(self, count):
        return bytes(self.registers[self.pointer : self.pointer + count])


def test_a_line_that_flips_changes_one_bit_of_some_bytes():
    heard = Noise(Random("1"), flip_permille=50).heard(SENT)

    wrong = [a ^ b for a, b in zip(SENT, heard, strict=True) if a != b]
    assert len(wrong) == pytest.approx(0.05 * len(SENT), rel=0.2)
    assert {bin(bits).count("1") for bits in wrong} == {1}


@pytest.mark.parametrize(("rate", "share"), [({"lose_permille": 100}, 0.9), ({"double_permille": 100}, 1.1)])
def test_a_line_loses_or_doubles_whole_bytes(rate, share):
    heard = Noise(Random("1"), **rate).heard(SENT)

    assert len(heard) == pytest.approx(share * len(SENT), rel=0.02)
    assert heard != SENT


def test_noise_does_not_depend_on_how_often_the_line_is_read():
    seen = []
    for period_us in (BYTE_US, 1000, 100_000):
        wire = Wire(115_200)
        wire.noises.append(Noise(Random("7"), lose_permille=100))
        wire.send(SENT, 0)
        seen.append(b"".join(wire.take(now_us) for now_us in range(0, 600_000, period_us)))

    assert seen[0] == seen[1] == seen[2] != SENT


def test_a_delayed_byte_arrives_later_and_leaves_the_buffer_in_time():
    wire = Wire(115_200)
    wire.delay_us = 30_000

    assert wire.send(b"ab", 0) == 30_000 + 174
    assert wire.waiting(174) == 0
    assert wire.take(30_000 + 173) == b"a"
    assert wire.next_us() == 30_000 + 174
    assert wire.take(30_000 + 174) == b"b"


def test_troubles_stay_on_the_line_when_the_device_starts_anew():
    uart = Uart(115_200)
    uart.outward.noises.append(Noise(Random("1"), lose_permille=1000))

    uart.open(115_200, 0)
    uart.write(b"hello", 0)

    assert uart.host_read(10_000) == b""


def test_a_dead_host_hears_and_says_nothing_and_a_new_one_does():
    uart = Uart(115_200)
    uart.open(115_200, 0)
    uart.desert(True, 0)
    uart.host_write(b"a", 0)
    uart.write(b"b", 0)
    assert (uart.any(1000), uart.host_wake_us()) == (0, None)

    uart.desert(False, 1000)
    uart.host_write(b"c", 1000)

    assert uart.read(9, 2000) == b"c"
    assert uart.host_read(2000) == b""


def test_a_host_at_another_rate_reads_and_sends_noise():
    uart = Uart(115_200)
    uart.open(115_200, 0)

    uart.retune(57_600, 0)
    uart.host_write(b"stop", 0)

    assert uart.read(9, 10_000) not in (b"", b"stop")


def test_a_bus_finds_nobody_for_so_many_transfers():
    bus = Bus([Memory()])
    bus.troubles.append(BusTrouble(Random("1"), nacks=2))

    assert [bus.write(0x60, b"\x00\x01") for _ in range(3)] == [-1, -1, 2]


def test_a_bus_flips_one_bit_in_so_many_messages():
    chip = Memory()
    bus = Bus([chip])
    bus.troubles.append(BusTrouble(Random("3"), flips=2))

    for _ in range(3):
        bus.write(0x60, b"\x00\xff")

    wrong_bits = [bin(int.from_bytes(data, "big") ^ 0xFF).count("1") for data in chip.heard]
    assert wrong_bits == [1, 1, 0]


def test_a_flipped_reading_leaves_the_chip_as_it_is():
    chip = Memory()
    bus = Bus([chip])
    bus.troubles.append(BusTrouble(Random("1"), flips=1))

    first, second = bus.read(0x60, 4), bus.read(0x60, 4)

    assert bin(int.from_bytes(first, "big")).count("1") == 1
    assert second == bytes(4)


def test_a_trap_is_called_at_the_next_transfer_and_only_then():
    called = []
    bus = Bus([Memory()])
    bus.troubles.append(BusTrouble(Random("1"), trap=lambda: called.append(True)))

    bus.read(0x60, 1)
    bus.read(0x60, 1)

    assert called == [True]
