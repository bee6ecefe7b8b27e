"""Two converters on one bus, and what the firmware's driver of both asks each of."""

import pytest

from firmware.drivers.mcp3208 import Mcp3208
from hil_sim.devices.converters import Converters
from hil_sim.devices.spi import SpiBus

SELECTS = (13, 11)
STEP_V = 3.3 / 4096


class Pin:
    """A chip select that the firmware's driver pulls."""

    level = 1

    def value(self, level):
        self.level = level


class Rig:
    """Both chips behind both drivers; input n is at 100 (n + 1) counts."""

    def __init__(self):
        self.devices = Converters()
        self.devices.inputs.update({n: lambda n=n: 100 * (n + 1) * STEP_V for n in range(16)})
        self.pins = {number: Pin() for number in SELECTS}
        wired = dict(zip(SELECTS, self.devices.chips, strict=True))
        self.bus = SpiBus(wired, lambda number: not self.pins[number].level)
        self.driver = Mcp3208(self, *self.pins.values())

    def write_readinto(self, sent, read):
        read[:] = self.bus.transfer(bytes(sent), 1_000_000, 0)
        self.bus.look()

    def counts(self):
        found = []
        for number in range(16):
            found.append(self.driver.counts(number))
            self.bus.look()
        return found


@pytest.fixture
def rig():
    return Rig()


def test_the_driver_reads_sixteen_inputs_of_two_chips(rig):
    assert rig.counts() == [100 * (n + 1) for n in range(16)]
    assert [chip.conversions for chip in rig.devices.chips] == [8, 8]


def test_nobody_is_selected_between_two_readings(rig):
    rig.counts()

    assert [pin.level for pin in rig.pins.values()] == [1, 1]


def test_an_input_whose_wire_breaks_reads_0_and_its_namesake_on_the_other_chip_what_it_did(rig):
    rig.devices.opened.add(8)

    counts = rig.counts()

    assert (counts[0], counts[8]) == (100, 0)


def test_an_input_that_is_not_connected_reads_0(rig):
    del rig.devices.inputs[3]

    assert rig.counts()[3] == 0


@pytest.mark.parametrize(("dead", "left"), [(0, range(8, 16)), (1, range(8))])
def test_a_dead_chip_takes_its_own_inputs_along_and_no_other(rig, dead, left):
    rig.devices.chips[dead].alive = False

    assert rig.counts() == [100 * (n + 1) if n in left else 0 for n in range(16)]


def test_both_chips_selected_at_once_speak_over_each_other(rig):
    for pin in rig.pins.values():
        pin.level = 0

    came = rig.bus.transfer(b"\x06\x00\x00", 1_000_000, 0)

    assert (came[1] & 0x0F) << 8 | came[2] == 100 | 900


def test_an_input_counts_alike_for_the_bench_and_for_the_firmware(rig):
    assert [rig.devices.counts(n) for n in range(16)] == rig.counts()


def test_a_chip_that_begins_while_selected_waits_until_it_was_not(rig):
    rig.pins[11].level = 0
    rig.bus.look()
    rig.devices.reset()

    assert rig.bus.transfer(b"\x06\x00\x00", 1_000_000, 0) == bytes(3)
