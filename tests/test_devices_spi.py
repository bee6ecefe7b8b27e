"""SPI: the bus, its chip select, and `machine.SPI`."""

import pytest

from hil_sim.devices.spi import SpiBus, transfer_time_us
from hil_sim.journal import SPI
from hil_sim.worlds.costs import BOOT_US
from hil_sim.worlds.spi import rate_hz
from tests.bench_fakes import bench_of

MODULE = "from machine import SPI\ncs = Pin(17, Pin.OUT, value=1)\nspi = SPI(0, 8_000_000)\n"


class Echo:
    """A chip that answers with the byte before."""

    rate_max_hz = 1_000_000
    modes = (0, 3)

    def __init__(self) -> None:
        self.selections: list[bool] = []
        self.last = 0x11

    def select(self, selected: bool) -> None:
        self.selections.append(selected)

    def exchange(self, byte: int) -> int:
        said, self.last = self.last, byte
        return said


@pytest.fixture
def bus():
    low, chip = {17: False}, Echo()
    return SpiBus({17: chip}, low.get), low, chip


def test_only_a_selected_chip_hears(bus):
    bus, low, chip = bus
    assert bus.transfer(b"\x01\x02", 1_000_000, 0) == bytes(2)

    low[17] = True

    assert bus.transfer(b"\x01\x02", 1_000_000, 0) == b"\x11\x01"
    assert chip.selections == [True]


@pytest.mark.parametrize(("rate", "mode"), [(1_000_001, 0), (1_000_000, 1), (1_000_000, 2)])
def test_a_chip_that_is_clocked_wrongly_hears_nothing(bus, rate, mode):
    bus, low, chip = bus
    low[17] = True

    assert bus.transfer(b"\x01\x02", rate, mode) == bytes(2)
    assert chip.last == 0x11


def test_a_byte_takes_eight_bits():
    assert transfer_time_us(1, 8_000_000) == 1
    assert transfer_time_us(14, 1_000_000) == 112
    assert transfer_time_us(3, 7_000_000) == 4


@pytest.mark.parametrize(
    ("wanted", "reached"), [(10_000_000, 8_928_571), (1_000_000, 992_063), (62_500_000, 62_500_000), (100_000, 122_070)]
)
def test_the_divider_reaches_what_the_sdk_computes(wanted, reached):
    assert rate_hz(wanted) == reached


def run(tmp_path, main, **options):
    bench = bench_of(tmp_path, MODULE + main, **options)
    bench.clock.run_until(BOOT_US + 100_000)
    bench.close()
    return "".join(bench.world.console).split("\n")[:-1], bench


STATUS = """
cs.value(0)
spi.write(b'\\x03\\x0e')
got = spi.read(1)
cs.value(1)
print(got)
"""


def test_the_can_controller_answers_on_the_board(tmp_path):
    assert run(tmp_path, STATUS)[0] == ["b'\\x80'"]


def test_a_buffer_is_filled_in_place(tmp_path):
    main = "b = bytearray(b'\\x03\\x0e\\x00')\ncs.value(0)\nspi.write_readinto(b, b)\ncs.value(1)\nprint(b[2])"

    assert run(tmp_path, main)[0] == ["128"]


def test_without_chip_select_nothing_answers(tmp_path):
    assert run(tmp_path, "print(spi.read(2))")[0] == ["b'\\x00\\x00'"]


def test_on_other_pins_nothing_answers(tmp_path):
    main = "spi = SPI(0, 8_000_000, sck=Pin(2), mosi=Pin(3), miso=Pin(4))" + STATUS

    assert run(tmp_path, main)[0] == ["b'\\x00'"]


def test_a_reset_lets_go_of_the_chip(tmp_path):
    main = "if reset_cause() == 1:\n cs.value(0)\n spi.write(b'\\x02')\n reset()\n" + STATUS

    assert run(tmp_path, main)[0] == ["b'\\x80'"]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("SPI(2)", "SPI(2) doesn't exist"),
        ("SPI(0, sck=Pin(3))", "bad SCK pin"),
        ("SPI(0, mosi=Pin(11))", "bad MOSI pin"),
        ("SPI(1, miso=Pin(16))", "bad MISO pin"),
        ("spi.write_readinto(b'ab', bytearray(1))", "buffers must be the same length"),
    ],
)
def test_what_the_port_refuses_is_refused_in_its_words(tmp_path, call, message):
    assert run(tmp_path, f"try: {call}\nexcept ValueError as error: print(error)")[0] == [message]


def test_a_transfer_costs_its_bits(tmp_path):
    main = "a = time.ticks_us()\nspi.write(bytes(100))\nprint(time.ticks_diff(time.ticks_us(), a))"

    assert run(tmp_path, main)[0] == [str(1 + 2 + -(-100 * 8_000_000 // 7_812_500))]


def test_what_goes_out_and_what_comes_in_are_in_the_journal(tmp_path):
    _, bench = run(tmp_path, STATUS, keep_journal=True)

    entries = [entry[2:] for entry in bench.journal.kept() if entry[1] == SPI]
    assert entries == [(0, b"\x03\x0e\x00\x00"), (0, b"\x00\x80")]
