"""MCP2515: instructions, registers, modes and interrupts against its data sheet."""

import pytest

from hil_sim.devices.canframe import Frame, length_bits
from hil_sim.devices.mcp2515 import Mcp2515
from tests.can_bench import (
    CANCTRL,
    CANINTE,
    CANINTF,
    CANSTAT,
    CNF3,
    CONFIGURATION,
    EFLG,
    LISTEN_ONLY,
    LOOPBACK,
    NORMAL,
    REC,
    SLEEP,
    TEC,
    CanRig,
)

FRAME = Frame(0x123, b"\x11\x22\x33")


@pytest.fixture
def rig() -> CanRig:
    return CanRig()


@pytest.fixture
def live() -> CanRig:
    return CanRig().start()


def test_after_a_reset_it_is_in_configuration_mode_with_the_registers_of_the_data_sheet(rig):
    rig.write(CANCTRL, 0x00)
    rig.say(0xC0)
    rig.run_us(16)

    assert rig.get(CANSTAT) == 0x80
    assert rig.get(CANCTRL) == 0x87
    assert [rig.get(register) for register in (TEC, REC, CNF3, 0x29, 0x2A, CANINTE, CANINTF, EFLG)] == [0] * 8
    assert [rig.get(register) for register in (0x30, 0x40, 0x50, 0x60, 0x70)] == [0] * 5
    assert rig.read(0x20, 8) == [0] * 8


def test_it_is_deaf_for_128_clocks_after_a_reset(rig):
    rig.say(0xC0)
    rig.run_us(15)
    assert rig.get(CANSTAT) == 0x00

    rig.run_us(1)

    assert rig.get(CANSTAT) == 0x80


def test_it_hears_nothing_while_it_is_not_selected(rig):
    for byte in (0x02, CANINTE, 0xFF):
        rig.chip.exchange(byte)

    assert rig.get(CANINTE) == 0


def test_reading_and_writing_go_on_through_the_addresses(rig):
    rig.write(0x20, 1, 2, 3, 4)

    assert rig.read(0x20, 4) == [1, 2, 3, 4]
    assert rig.read(0x7F, 2)[0] == 0x87  # CANCTRL in the last row, then address 0 again


def test_the_status_and_control_registers_show_in_every_row(rig):
    rows = [row << 4 for row in range(8)]

    assert [rig.get(row | 0x0E) for row in rows] == [0x80] * 8
    assert [rig.get(row | 0x0F) for row in rows] == [0x87] * 8


def test_an_instruction_is_over_with_the_chip_select(rig):
    rig.chip.select(True)
    rig.chip.exchange(0x02)
    rig.chip.exchange(CANINTE)
    rig.chip.select(False)

    assert rig.say(0x55) == [0]
    assert rig.get(CANINTE) == 0


def test_bit_modify_changes_the_bits_of_its_mask(rig):
    rig.write(CANINTE, 0xF0)

    rig.modify(CANINTE, 0x3C, 0x0F)

    assert rig.get(CANINTE) == 0xCC


def test_bit_modify_writes_the_whole_of_a_register_that_does_not_have_it(rig):
    rig.write(0x20, 0xF0)

    rig.modify(0x20, 0x01, 0x0F)

    assert rig.get(0x20) == 0x0F


@pytest.mark.parametrize("register", [0x00, 0x0B, 0x10, 0x1B, 0x20, 0x27, 0x0D, 0x28, 0x29, 0x2A])
def test_filters_masks_and_bit_timing_are_kept_outside_configuration_mode(live, register):
    before = live.get(register)

    live.write(register, before ^ 0x05)

    assert live.get(register) == before


@pytest.mark.parametrize("register", [CANSTAT, TEC, REC, 0x61, 0x6D, 0x71])
def test_what_is_read_only_stays(rig, register):
    before = rig.get(register)

    rig.write(register, before ^ 0xFF)

    assert rig.get(register) == before


def test_unimplemented_bits_read_zero(rig):
    for register, mask in ((0x0C, 0x3F), (CNF3, 0xC7), (EFLG, 0xC0), (0x01, 0xEB), (0x21, 0xE3), (0x35, 0x4F)):
        rig.write(register, 0xFF)
        assert rig.get(register) == mask, hex(register)
    rig.write(0x60, 0xFF)
    assert rig.get(0x60) == 0x66  # BUKT with its copy


@pytest.mark.parametrize("mode", [NORMAL, SLEEP, LOOPBACK, LISTEN_ONLY, CONFIGURATION])
def test_every_mode_is_reached_from_configuration(rig, mode):
    rig.start(mode)

    assert rig.mode() == mode


def test_a_mode_that_does_not_exist_is_not_reached(rig):
    rig.enter(0xA0)

    assert rig.mode() == CONFIGURATION


def test_normal_mode_is_left_only_when_nothing_is_pending(live):
    live.send(FRAME)

    live.enter(CONFIGURATION)
    assert live.mode() == NORMAL
    live.run_us(2 * length_bits(FRAME))

    assert live.mode() == CONFIGURATION


@pytest.mark.parametrize(
    ("crystal_hz", "cnf3", "cnf2", "cnf1", "bit_ns"),
    [
        (8_000_000, 0x02, 0x90, 0x00, 2_000),  # quanta of 250 ns: 1, 1 propagation, 3 and 3
        (8_000_000, 0x85, 0xB1, 0x01, 8_000),  # quanta of 500 ns: 1, 2, 7 and 6
        (16_000_000, 0x86, 0xF0, 0x00, 2_000),  # quanta of 125 ns: 1, 1, 7 and 7
        (16_000_000, 0x00, 0x11, 0x00, 1_125),  # without BTLMODE the second segment is as long as the first
        (16_000_000, 0x07, 0x00, 0x00, 625),  # and never shorter than 2 quanta
    ],
)
def test_the_bit_time_follows_from_crystal_and_configuration(crystal_hz, cnf3, cnf2, cnf1, bit_ns):
    rig = CanRig(crystal_hz)
    rig.write(CNF3, cnf3, cnf2, cnf1)

    rig.enter(NORMAL)

    assert rig.chip.can.bit_ns == bit_ns


def test_read_status_tells_requests_and_flags(live):
    live.stations[0].send(Frame(0x001))
    live.run_us(10)
    live.send(FRAME, buffer=0)
    live.send(FRAME, buffer=2)
    assert live.say(0xA0, 0, 0)[1:] == [0x44, 0x44]

    live.run_us(1000)

    assert live.say(0xA0, 0)[1] == 0x89  # RX0IF, TX0IF, TX2IF


def test_loopback_hears_itself_and_nobody_else(rig):
    rig.start(LOOPBACK)

    rig.send(FRAME)
    rig.run_us(2 * length_bits(FRAME))

    assert rig.get(CANINTF) == 0x05
    assert rig.say(0x90, *[0] * 8)[1:] == [0x24, 0x60, 0, 0, 3, 0x11, 0x22, 0x33]
    assert rig.stations[0].received == []


def test_listen_only_hears_without_acknowledging(rig):
    rig = CanRig(stations=2).start(LISTEN_ONLY)

    rig.stations[0].send(FRAME)
    rig.run_us(200)
    assert rig.get(CANINTF) & 0x01
    rig.wire.leave(rig.stations[1])
    rig.stations[0].send(FRAME)
    rig.run_us(1000)

    assert rig.stations[0].failures > 0
    assert rig.get(REC) == 0


def test_a_sleeping_chip_wakes_up_by_the_bus_into_listen_only(rig):
    rig.start(SLEEP)
    rig.write(CANINTE, 0x40)

    rig.stations[0].send(FRAME)
    rig.run_us(10)

    assert rig.mode() == LISTEN_ONLY
    assert rig.get(CANINTF) == 0x40
    assert rig.get(CANSTAT) >> 1 & 7 == 2
    assert rig.get(CANINTF) & 1 == 0


def test_a_sleeping_chip_does_not_wake_unless_that_is_enabled(rig):
    rig.start(SLEEP)

    rig.stations[0].send(FRAME)
    rig.run_us(10)
    rig.enter(NORMAL)
    assert rig.mode() == SLEEP
    rig.write(CANINTE, 0x40)
    rig.modify(CANINTF, 0x40, 0x40)

    assert rig.mode() == LISTEN_ONLY


def test_two_chips_acknowledge_each_other():
    one = CanRig(stations=0).start()
    other = Mcp2515(one.clock, one.wire)
    one.run_us(16)
    for data in ((0x02, CNF3, 0x02, 0x90, 0x00), (0x02, 0x60, 0x64), (0x02, CANCTRL, NORMAL)):
        other.select(True)
        for byte in data:
            other.exchange(byte)
        other.select(False)

    one.send(FRAME)
    one.run_us(1000)

    assert (one.get(TEC), one.get(CANINTF)) == (0, 0x04)
    assert other.can.flags.level() == 1
    assert other.can.load(CANINTF) == 0x01


def test_a_dead_chip_is_off_the_bus_and_silent(live):
    live.write(CANINTE, 0xFF)
    live.write(CANINTF, 0xFF)

    live.chip.alive = False
    live.stations[0].send(FRAME)
    live.run_us(5000)

    assert live.get(CANSTAT) == 0
    assert live.chip.int_level() == 1
    assert live.stations[0].errors.passive


def test_an_interrupt_may_be_raised_by_writing_its_flag(rig):
    rig.write(CANINTE, 0x10)
    rig.write(CANINTF, 0x10)
    rig.write(CANINTF, 0x00)

    assert rig.edges == [0, 1]


def test_the_code_of_the_highest_interrupt_is_told(rig):
    rig.write(CANINTE, 0x7F)
    codes = []
    for flag in (0x02, 0x01, 0x10, 0x08, 0x04, 0x40, 0x20):
        rig.modify(CANINTF, flag, flag)
        codes.append(rig.get(CANSTAT) >> 1 & 7)

    assert codes == [7, 6, 5, 4, 3, 2, 1]
