"""MCP2515: filters, receive buffers, rollover, overflow, error states against its data sheet."""

import pytest

from hil_sim.devices.canframe import Frame
from tests.can_bench import CANINTE, CANINTF, CANSTAT, CONFIGURATION, EFLG, NORMAL, REC, TEC, CanRig

STANDARD, EXTENDED = 0x00, 0x08  # in SIDL of a filter


@pytest.fixture
def live() -> CanRig:
    return CanRig().start()


def filtering(masks=((0xFF, 0xE0, 0, 0), (0xFF, 0xE0, 0, 0)), filters=(), rollover=False) -> CanRig:
    """Return a chip in normal mode with masks and (number, SIDH, SIDL, EID8, EID0) filters; the others match 7FFh."""
    rig = CanRig()
    for number, at in enumerate((0x00, 0x04, 0x08, 0x10, 0x14, 0x18)):
        rig.write(at, 0xFF, 0xE0, 0xFF, 0xFF)
        for wanted, *values in filters:
            if wanted == number:
                rig.write(at, *values)
    for at, mask in zip((0x20, 0x24), masks, strict=True):
        rig.write(at, *mask)
    rig.start(CONFIGURATION, any_message=False)
    rig.write(0x60, 0x04 if rollover else 0x00)
    rig.enter(NORMAL)
    return rig


def hear(rig, *frames) -> int:
    """Let the station send frames; return the flags of the receive buffers."""
    for frame in frames:
        rig.stations[0].send(frame)
    rig.run_us(400 * len(frames))
    return rig.get(CANINTF) & 3


def buffer(rig, number: int) -> list[int]:
    """Read a receive buffer from its identifier on, which frees it."""
    return rig.say(0x90 | number << 2, *[0] * 13)[1:]


def test_a_standard_frame_is_laid_out_in_the_buffer(live):
    assert hear(live, Frame(0x5A3, b"\x01\x02")) == 1

    assert buffer(live, 0)[:7] == [0xB4, 0x60, 0, 0, 2, 1, 2]


def test_both_buffers_are_at_the_addresses_of_the_register_map(live):
    hear(live, Frame(0x100, b"\x07"), Frame(0x101, b"\x08"))

    assert live.read(0x61, 6) == [0x20, 0x00, 0, 0, 1, 7]
    assert live.read(0x71, 6) == [0x20, 0x20, 0, 0, 1, 8]


def test_an_extended_remote_frame_is_laid_out_in_the_buffer(live):
    hear(live, Frame(0x1ABCDEF5, extended=True, remote=True, length=5))

    assert buffer(live, 0)[:5] == [0xD5, 0xE8, 0xDE, 0xF5, 0x45]
    assert live.get(0x60) & 0x08  # RXRTR


def test_a_standard_remote_frame_sets_its_own_flag(live):
    hear(live, Frame(0x100, remote=True, length=2))

    assert buffer(live, 0)[:5] == [0x20, 0x10, 0, 0, 2]


def test_the_flag_goes_with_the_rise_of_the_chip_select(live):
    hear(live, Frame(0x100, b"\x07"))
    live.chip.select(True)
    live.chip.exchange(0x92)
    assert live.chip.exchange(0) == 7
    assert live.chip.can.registers[CANINTF] & 1

    live.chip.select(False)

    assert live.get(CANINTF) & 1 == 0


def test_a_plain_read_leaves_the_flag(live):
    hear(live, Frame(0x100))

    live.read(0x61, 13)

    assert live.get(CANINTF) & 1


def test_the_second_buffer_is_used_when_the_first_may_roll_over(live):
    assert hear(live, Frame(0x100), Frame(0x101)) == 3

    assert live.get(EFLG) & 0xC0 == 0
    assert buffer(live, 0)[:2] == [0x20, 0x00]
    assert buffer(live, 1)[:2] == [0x20, 0x20]


def test_a_third_frame_overflows_the_second_buffer_and_is_lost(live):
    hear(live, Frame(0x100), Frame(0x101), Frame(0x102))

    assert live.get(EFLG) & 0xC0 == 0x80
    assert live.get(CANINTF) & 0x20
    assert buffer(live, 1)[:2] == [0x20, 0x20]


def test_without_rollover_the_first_buffer_overflows_even_if_the_second_is_free():
    rig = filtering(filters=((0, 0x20, 0, 0, 0), (2, 0x20, 0, 0, 0)))

    assert hear(rig, Frame(0x100), Frame(0x100)) == 1

    assert rig.get(EFLG) & 0xC0 == 0x40


def test_an_overflow_is_cleared_by_writing_the_flag_and_then_the_interrupt(live):
    hear(live, Frame(0x100), Frame(0x101), Frame(0x102))
    live.modify(CANINTF, 0x20, 0)
    assert live.get(CANINTF) & 0x20  # its cause is still there

    live.modify(EFLG, 0x80, 0)
    live.modify(CANINTF, 0x20, 0)

    assert live.get(CANINTF) & 0x20 == 0


@pytest.mark.parametrize("number", range(6))
def test_each_filter_lets_its_identifier_pass_into_its_buffer(number):
    rig = filtering(filters=((number, 0x24, 0x60, 0, 0),))

    assert hear(rig, Frame(0x122)) == 0
    assert hear(rig, Frame(0x123)) == (1 if number < 2 else 2)

    hit = rig.get(0x60) & 1 if number < 2 else rig.get(0x70) & 7
    assert hit == number
    assert rig.say(0xB0, 0)[1] & 7 == number


def test_of_several_matching_filters_the_lowest_is_told():
    rig = filtering(filters=((2, 0x24, 0x60, 0, 0), (4, 0x24, 0x60, 0, 0)))

    hear(rig, Frame(0x123))

    assert rig.get(0x70) & 7 == 2


def test_a_standard_filter_is_held_against_all_11_bits():
    rig = filtering(filters=((0, 0x24, 0x60, 0, 0),))

    for bit in range(11):
        assert hear(rig, Frame(0x123 ^ 1 << bit)) == 0, bit


def test_bits_that_are_not_masked_do_not_matter():
    rig = filtering(masks=((0xFF, 0x00, 0, 0), (0xFF, 0xE0, 0, 0)), filters=((0, 0x24, 0, 0, 0),))

    assert hear(rig, Frame(0x127)) == 1


def test_an_empty_mask_still_tells_standard_from_extended():
    rig = filtering(masks=((0, 0, 0, 0), (0, 0, 0, 0)))

    assert hear(rig, Frame(0x1234567, extended=True)) == 0
    assert hear(rig, Frame(0x123)) == 1


def test_an_extended_filter_is_held_against_all_29_bits():
    wanted = Frame(0x1ABCDEF5, extended=True)
    rig = filtering(masks=((0xFF, 0xE3, 0xFF, 0xFF), (0xFF, 0xE0, 0, 0)), filters=((0, 0xD5, 0xE8, 0xDE, 0xF5),))

    for bit in range(29):
        assert hear(rig, Frame(wanted.id ^ 1 << bit, extended=True)) == 0, bit
    assert hear(rig, wanted) == 1


def test_the_extended_part_of_a_filter_is_held_against_the_first_data_bytes_of_a_standard_frame():
    rig = filtering(masks=((0xFF, 0xE0, 0xFF, 0xFF), (0xFF, 0xE0, 0, 0)), filters=((0, 0x24, 0x60, 0xAB, 0xCD),))

    assert hear(rig, Frame(0x123, b"\xab\xce")) == 0
    assert hear(rig, Frame(0x123, b"\xab\xcd\x00")) == 1


@pytest.mark.parametrize(("data", "passes"), [(b"", 1), (b"\xab", 1), (b"\xac", 0), (b"\xab\xcd", 1), (b"\xaa\xcd", 0)])
def test_data_bytes_that_a_frame_does_not_have_are_not_compared(data, passes):
    rig = filtering(masks=((0xFF, 0xE0, 0xFF, 0xFF), (0xFF, 0xE0, 0, 0)), filters=((0, 0x24, 0x60, 0xAB, 0xCD),))

    assert hear(rig, Frame(0x123, data)) == passes


@pytest.mark.parametrize(("mode", "accepted"), [(0x20, [1, 0]), (0x40, [0, 1])])
def test_a_buffer_may_be_kept_for_one_kind_of_identifier(mode, accepted):
    rig = filtering(masks=((0, 0, 0, 0), (0xFF, 0xE0, 0, 0)), filters=((0, 0, STANDARD, 0, 0), (1, 0, EXTENDED, 0, 0)))
    rig.modify(0x60, 0x60, mode)

    heard = []
    for frame in (Frame(0x123), Frame(0x123, extended=True)):
        heard.append(hear(rig, frame))
        rig.modify(CANINTF, 1, 0)

    assert heard == accepted


def test_rx_status_tells_buffers_kind_and_filter(live):
    assert live.say(0xB0, 0)[1] == 0x00

    hear(live, Frame(0x100, extended=True, remote=True), Frame(0x101))
    assert live.say(0xB0, 0, 0)[1:] == [0xD8, 0xD8]
    buffer(live, 0)

    assert live.say(0xB0, 0)[1] == 0x86  # the second buffer alone, filter 0 by way of rollover


def test_own_errors_are_counted_and_told_up_to_bus_off(live):
    live.write(CANINTE, 0x20)
    live.wire.spoil(32)
    live.send(Frame(0x100))
    seen = []
    for _ in range(400):
        live.run_us(20)
        seen.append((live.get(TEC), live.get(EFLG)))

    flags = {eflg for _, eflg in seen}
    assert {0x00, 0x05, 0x15, 0x35} <= flags  # active, warning, passive, bus-off
    assert all(bool(eflg & 0x04) == (tec >= 96) and bool(eflg & 0x10) == (tec > 127) for tec, eflg in seen)
    assert live.chip.int_level() == 0


def test_bus_off_ends_after_128_quiet_times_and_the_request_is_served(live):
    live.wire.spoil(32)
    live.send(Frame(0x100))
    live.run_us(5_000)
    assert live.get(EFLG) & 0x20
    assert live.stations[0].received == []

    live.run_us(128 * 11 * 2 + 1_000)

    assert live.get(EFLG) == 0
    assert (live.get(TEC), live.get(REC)) == (0, 0)
    assert live.stations[0].received == [Frame(0x100)]


def test_a_lone_chip_stays_error_passive_and_is_not_put_off_the_bus():
    rig = CanRig(stations=0).start()

    rig.send(Frame(0x100))
    rig.run_us(100_000)

    assert rig.get(TEC) == 128
    assert rig.get(EFLG) == 0x15
    assert rig.get(0x30) == 0x18  # TXERR, still requested


def test_damaged_receptions_are_counted_and_taken_back_by_whole_ones(live):
    live.wire.spoil(3)

    live.stations[0].send(Frame(0x100))
    live.run_us(1_000)
    assert live.get(REC) == 2
    assert live.get(CANINTF) & 0x80  # MERRF

    hear(live, Frame(0x101), Frame(0x102))

    assert live.get(REC) == 0


def test_configuration_mode_and_a_reset_clear_the_counters(live):
    live.wire.spoil(3)
    live.stations[0].send(Frame(0x100))
    live.run_us(1_000)

    live.enter(CONFIGURATION)

    assert (live.get(REC), live.get(EFLG)) == (0, 0)
    assert live.get(CANSTAT) & 0xE0 == CONFIGURATION


def test_a_chip_at_another_bit_rate_hears_nothing_and_becomes_passive():
    rig = CanRig(stations=2)
    rig.write(0x28, 0x02, 0x90, 0x01)
    rig.write(0x60, 0x64)
    rig.enter(NORMAL)

    rig.stations[0].send(Frame(0x100))
    rig.run_us(10_000)

    assert rig.get(CANINTF) & 3 == 0
    assert rig.get(EFLG) & 0x08
    assert rig.stations[1].received == [Frame(0x100)]


def test_a_reset_in_the_middle_of_a_frame_leaves_it_damaged(live):
    live.send(Frame(0x100, bytes(8)))
    live.run_us(50)

    live.chip.reset()
    live.run_us(1_000)

    assert live.stations[0].received == []
    assert live.stations[0].damaged == 1
    assert live.get(0x30) == 0
