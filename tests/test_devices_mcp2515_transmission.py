"""MCP2515: transmission against its data sheet: requests, priorities, aborts, one shot."""

import pytest

from hil_sim.devices.canframe import Frame, length_bits
from tests.can_bench import (
    CANCTRL,
    CANINTE,
    CANINTF,
    CANSTAT,
    NORMAL,
    CanRig,
)

FRAME = Frame(0x123, b"\x11\x22\x33")


@pytest.fixture
def rig() -> CanRig:
    return CanRig()


@pytest.fixture
def live() -> CanRig:
    return CanRig().start()


def test_a_frame_is_sent_interrupts_and_frees_its_buffer(live):
    live.write(CANINTE, 0x04)

    live.send(FRAME)
    assert live.get(0x30) == 0x08
    live.run_us(2 * length_bits(FRAME))

    assert live.stations[0].received == [FRAME]
    assert live.get(0x30) == 0x00
    assert live.get(CANINTF) == 0x04
    assert live.get(CANSTAT) == NORMAL | 3 << 1
    assert live.chip.int_level() == 0


def test_an_extended_remote_frame_is_sent_as_it_was_loaded(live):
    number = 0x1234_5678 & 0x1FFF_FFFF
    base, low = number >> 18, number & 0x3FFFF

    live.say(0x40, base >> 3, base << 5 & 0xE0 | 0x08 | low >> 16, low >> 8 & 0xFF, low & 0xFF, 0x44)
    live.say(0x81)
    live.run_us(1000)

    assert live.stations[0].received == [Frame(number, extended=True, remote=True, length=4)]


def test_a_length_beyond_eight_sends_eight_bytes(live):
    live.say(0x40, 0x20, 0, 0, 0, 0x0F, *range(8))
    live.say(0x81)
    live.run_us(1000)

    assert live.stations[0].received == [Frame(0x100, bytes(range(8)), length=15)]


def test_a_request_may_also_be_written_into_the_control_register(live):
    live.load(1, FRAME)

    live.write(0x40, 0x0B)
    assert live.get(0x40) == 0x0B
    live.run_us(1000)

    assert live.stations[0].received == [FRAME]
    assert live.get(0x40) == 0x03


def test_a_request_that_is_taken_back_while_on_the_wire_is_still_sent_but_not_repeated(live):
    live.send(FRAME)
    live.run_us(10)
    live.write(0x30, 0x00)
    live.run_us(1000)
    assert live.stations[0].received == [FRAME]

    live.wire.spoil(1)
    live.send(FRAME)
    live.run_us(10)
    live.write(0x30, 0x00)
    live.run_us(1000)

    assert live.stations[0].received == [FRAME]
    assert live.get(0x30) == 0x10


def test_abat_keeps_back_what_is_requested_until_it_is_cleared(live):
    live.modify(CANCTRL, 0x10, 0x10)
    live.send(FRAME)
    live.run_us(1000)
    assert live.stations[0].received == []

    live.modify(CANCTRL, 0x10, 0x00)
    live.run_us(1000)

    assert live.stations[0].received == [FRAME]


def test_one_shot_gives_up_when_it_loses_arbitration(live):
    live.modify(CANCTRL, 0x08, 0x08)
    live.load(0, Frame(0x200))
    live.stations[0].send(Frame(0x100))

    live.say(0x81)
    live.run_us(2000)

    assert live.get(0x30) == 0x20
    assert live.stations[0].received == []


def test_load_tx_buffer_begins_at_the_identifier_or_at_the_data(live):
    for buffer in range(3):
        live.say(0x40 | buffer << 1, 0x20 + buffer, 0, 0, 0, 1)
        live.say(0x41 | buffer << 1, 0x50 + buffer)

    live.say(0x87)
    live.run_us(2000)

    assert {(frame.id, frame.data[0]) for frame in live.stations[0].received} == {
        (0x100, 0x50), (0x108, 0x51), (0x110, 0x52),
    }  # fmt: skip


def test_the_buffers_are_at_the_addresses_of_the_register_map(rig):
    for buffer, at in enumerate((0x31, 0x41, 0x51)):
        rig.load(buffer, Frame(0x100 + buffer, bytes(range(buffer, buffer + 8))))
        assert rig.read(at, 5) == [0x20, buffer << 5, 0, 0, 8]
        assert rig.read(at + 5, 8) == list(range(buffer, buffer + 8))


@pytest.mark.parametrize("bit", range(29))
def test_every_bit_of_an_extended_identifier_is_sent(live, bit):
    number = 1 << bit
    base, low = number >> 18, number & 0x3FFFF

    live.say(0x40, base >> 3, base << 5 & 0xE0 | 0x08 | low >> 16, low >> 8 & 0xFF, low & 0xFF, 0)
    live.say(0x81)
    live.run_us(400)

    assert live.stations[0].received == [Frame(number, extended=True)]


def test_priority_decides_the_order_and_then_the_buffers_number(live):
    live.stations[0].send(Frame(0x001))  # keeps the wire busy while the requests are made
    live.run_us(10)
    live.write(0x40, 0x00)
    live.write(0x30, 0x01)
    for buffer in range(3):
        live.load(buffer, Frame(0x100 + buffer))

    live.say(0x87)
    live.run_us(2000)

    assert [frame.id for frame in live.stations[0].received] == [0x100, 0x102, 0x101]


def test_a_pending_buffer_cannot_be_written(live):
    live.send(FRAME)

    live.write(0x31, 0xFF)

    assert live.get(0x31) == FRAME.id >> 3


def test_lost_arbitration_is_told_and_the_frame_follows(live):
    live.load(0, Frame(0x200))
    live.stations[0].send(Frame(0x100))
    live.say(0x81)

    live.run_us(20)
    assert live.get(0x30) == 0x28  # MLOA and still requested
    live.run_us(1000)

    assert live.stations[0].received == [Frame(0x200)]


def test_abat_aborts_what_is_not_on_the_wire(live):
    live.load(0, Frame(0x100))
    live.load(1, Frame(0x101))
    live.say(0x82)
    live.run_us(10)
    live.say(0x81)

    live.modify(CANCTRL, 0x10, 0x10)
    live.run_us(1000)

    assert (live.get(0x30), live.get(0x40)) == (0x40, 0x00)
    assert live.stations[0].received == [Frame(0x101)]


def test_a_request_that_is_taken_back_is_not_flagged_as_aborted(live):
    live.stations[0].send(Frame(0x001))
    live.run_us(10)
    live.send(FRAME)

    live.write(0x30, 0x00)
    live.run_us(1000)

    assert live.get(0x30) == 0x00
    assert live.stations[0].received == []


def test_one_shot_tries_once(live):
    live.modify(CANCTRL, 0x08, 0x08)
    live.wire.spoil(1)

    live.send(FRAME)
    live.run_us(2000)

    assert live.get(0x30) == 0x10
    assert live.stations[0].received == []
