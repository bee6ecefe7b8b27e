"""PCA9685 against the register description of its data sheet."""

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.i2c import Bus
from hil_sim.devices.pca9685 import Pca9685

OFF, ON = (0.0, 0.0), (0.0, 1.0)


class Rig:
    """One chip on a bus, with its OE pin low."""

    def __init__(self) -> None:
        self.clock = Clock()
        self.changes = 0
        self.chip = Pca9685(0x60, self.clock, self.count)
        self.bus = Bus([self.chip])
        self.chip.enable(True)

    def count(self) -> None:
        self.changes += 1

    def write(self, *data: int) -> int:
        return self.bus.write(0x60, bytes(data))

    def read(self, register: int, count: int = 1) -> list[int]:
        self.write(register)
        return list(self.bus.read(0x60, count))

    def wake(self, mode1: int = 0x20) -> None:
        self.write(0x00, mode1)
        self.clock.run_until(self.clock.now_us + 500)


@pytest.fixture
def rig() -> Rig:
    return Rig()


def test_registers_after_power_on_are_those_of_the_data_sheet(rig):
    assert rig.read(0x00) == [0x11]
    assert rig.read(0x01) == [0x04]
    assert [rig.read(register)[0] for register in range(2, 6)] == [0xE2, 0xE4, 0xE8, 0xE0]
    assert [rig.read(6 + offset)[0] for offset in range(4)] == [0, 0, 0, 0x10]
    assert rig.read(0xFE) == [0x1E]


def test_without_auto_increment_the_pointer_stays(rig):
    rig.write(0x06, 1, 2, 3)

    assert rig.read(0x06, 2) == [3, 3]
    assert rig.read(0x07) == [0]


def test_auto_increment_runs_through_the_channels_and_wraps_after_the_last(rig):
    rig.write(0x00, 0x30)

    rig.write(0x42, 1, 2, 3, 4, 0x31)

    assert rig.read(0x42, 5) == [1, 2, 3, 4, 0x31]


def test_auto_increment_wraps_after_the_prescaler_too(rig):
    rig.write(0x00, 0x30)

    rig.write(0xFA, 0, 0, 0, 0x10, 5, 0x31)

    assert rig.read(0xFE) == [5]
    assert rig.read(0x00) == [0x31]


def test_a_reserved_register_is_not_acknowledged(rig):
    assert rig.write(0x46) == 0
    assert rig.write(0xFF, 1) == 0
    assert rig.write(0x00, 0x20) == 2


def test_the_high_bits_of_a_count_read_zero_and_all_led_reads_zero(rig):
    rig.write(0x07, 0xFF)
    rig.write(0xFD, 0xFF)

    assert rig.read(0x07) == [0x1F]
    assert rig.read(0xFD) == [0]
    assert rig.read(0x09) == [0x1F]


def test_the_prescaler_changes_only_in_sleep_and_never_below_three(rig):
    rig.write(0xFE, 1)
    assert rig.read(0xFE) == [3]
    assert rig.chip.pwm_period_us == pytest.approx(655.36)

    rig.wake()
    rig.write(0xFE, 100)

    assert rig.read(0xFE) == [3]


def test_an_output_drives_its_share_of_the_period_once_awake(rig):
    rig.write(0x00, 0x30)
    rig.write(0x06, 0x00, 0x01, 0x00, 0x05)
    assert rig.chip.outputs[0] == OFF

    rig.wake()

    assert rig.chip.outputs[0] == (256 / 4096, 0.25)


def test_a_pulse_may_wrap_around_the_end_of_the_period(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x0C, 0x00, 0x04)

    assert rig.chip.outputs[0] == (0.75, 0.5)


def test_equal_counts_give_no_output_and_full_off_beats_full_on(rig):
    rig.wake()
    rig.write(0x06, 0x10, 0x00, 0x10, 0x00)
    assert rig.chip.outputs[0] == OFF
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)
    assert rig.chip.outputs[0] == ON

    rig.write(0x06, 0x00, 0x10, 0x00, 0x10)

    assert rig.chip.outputs[0] == OFF


def test_all_led_sets_every_channel_at_once(rig):
    rig.wake()

    rig.write(0xFA, 0x00, 0x10, 0x00, 0x00)

    assert rig.chip.outputs == [ON] * 16


def test_outputs_resume_after_sleep_only_when_told_after_500_us(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)
    rig.write(0x00, 0x30)
    assert rig.read(0x00) == [0xB0]

    rig.write(0x00, 0x20)
    rig.write(0x00, 0xA0)
    assert rig.chip.outputs[0] == OFF  # too early: the oscillator has not settled
    rig.clock.run_until(rig.clock.now_us + 500)
    rig.write(0x00, 0xA0)

    assert rig.read(0x00) == [0x20]
    assert rig.chip.outputs[0] == ON


def test_sleep_with_everything_off_asks_for_no_restart(rig):
    rig.wake()
    rig.write(0xFD, 0x10)

    rig.write(0x00, 0x30)

    assert rig.read(0x00) == [0x30]


def test_writing_a_count_clears_restart(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)
    rig.write(0x00, 0x30)
    rig.wake()

    rig.write(0x0A, 0x00, 0x10, 0x00, 0x00)

    assert rig.read(0x00) == [0x20]
    assert rig.chip.outputs[:2] == [ON, ON]


def test_the_external_clock_stays_chosen_until_a_reset(rig):
    rig.write(0x00, 0x70)
    rig.write(0x00, 0x20)
    assert rig.read(0x00) == [0x60]

    rig.bus.write(0, b"\x06")

    assert rig.read(0x00) == [0x11]


def test_oe_high_switches_off_unless_outne_says_otherwise(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)

    rig.chip.enable(False)
    assert rig.chip.outputs == [OFF] * 16
    rig.write(0x01, 0x05)

    assert rig.chip.outputs == [ON] * 16  # OUTNE = 01 with totem-pole outputs: a trap


def test_inverted_outputs_are_on_when_their_channel_is_off(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x00, 0x00, 0x04)

    rig.write(0x01, 0x14)

    assert rig.chip.outputs[0] == (0.25, 0.75)
    assert rig.chip.outputs[1] == ON


def test_open_drain_outputs_cannot_lift_a_gate(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)

    rig.write(0x01, 0x00)

    assert rig.chip.outputs == [OFF] * 16


def test_allcall_answers_at_0x70_until_it_is_cleared(rig):
    assert rig.bus.at(0x70)

    rig.write(0x00, 0x20)

    assert not rig.bus.at(0x70)


def test_sub_addresses_answer_once_their_bits_are_set(rig):
    assert not rig.bus.at(0x71)

    rig.write(0x00, 0x28)

    assert rig.bus.at(0x71)


def test_the_general_call_resets_the_chip_and_takes_nothing_else(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)

    assert rig.bus.write(0, b"\x05") == 0
    assert rig.chip.outputs[0] == ON
    assert rig.bus.write(0, b"\x06") == 1

    assert rig.chip.outputs == [OFF] * 16


def test_only_a_change_of_an_output_is_reported(rig):
    rig.wake()
    rig.changes = 0

    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)
    rig.write(0x02, 0xC2)

    assert rig.changes == 1


@pytest.mark.parametrize(
    ("mode2", "gate"),
    [(0x04, OFF), (0x05, ON), (0x06, OFF), (0x07, OFF), (0x00, OFF), (0x01, OFF), (0x02, OFF), (0x03, OFF)],
)
def test_outputs_that_are_not_enabled_follow_the_table_of_outne(rig, mode2, gate):
    """Table 10 of the data sheet: 0; 1 if totem-pole, else high impedance; high impedance, which leaves a gate low."""
    rig.wake()
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)
    rig.write(0x01, mode2)

    rig.chip.enable(False)

    assert rig.chip.outputs == [gate] * 16


def test_polarity_does_not_touch_outputs_that_are_not_enabled(rig):
    rig.write(0x01, 0x14)

    rig.chip.enable(False)

    assert rig.chip.outputs == [OFF] * 16


def test_only_five_bits_of_mode2_and_seven_of_an_address_are_kept(rig):
    rig.write(0x01, 0xFF)
    rig.write(0x02, 0xFF)

    assert rig.read(0x01) == [0x1F]
    assert rig.read(0x02) == [0xFE]


def test_reading_with_auto_increment_wraps_as_writing_does(rig):
    rig.write(0x00, 0x30)

    assert rig.read(0x45, 3) == [0x10, 0x30, 0x04]
    assert rig.read(0xFD, 3) == [0x00, 0x1E, 0x30]


def test_a_write_into_the_reserved_registers_is_cut_short_there(rig):
    assert rig.write(0xFF, 0x55) == 0
    assert rig.write(0x46, 0x55) == 0
    assert rig.write(0xFA, 0x00, 0x10) == 3  # without auto-increment the pointer stays where it may


def test_the_prescaler_gives_the_frequencies_of_the_data_sheet(rig):
    for prescale, hz in ((3, 1526), (30, 197), (255, 24)):
        rig.write(0xFE, prescale)
        assert round(1e6 / rig.chip.pwm_period_us) == hz


def test_the_prescaler_set_by_a_burst_while_awake_is_ignored(rig):
    rig.wake()

    rig.write(0xFA, 0, 0, 0, 0x10, 5)

    assert rig.read(0xFE) == [0x1E]


def test_all_led_on_is_beaten_by_one_channel_that_is_full_off(rig):
    rig.wake()
    rig.write(0xFA, 0x00, 0x10, 0x00, 0x00)

    rig.write(0x09, 0x10)

    assert rig.chip.outputs == [OFF, *[ON] * 15]


def test_a_full_off_bit_leaves_the_counts_as_they_were(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x00, 0x00, 0x08)
    rig.write(0x09, 0x18)
    assert rig.chip.outputs[0] == OFF

    rig.write(0x09, 0x08)

    assert rig.chip.outputs[0] == (0.0, 0.5)


def test_all_call_and_sub_addresses_may_be_moved(rig):
    rig.write(0x05, 0x6A << 1)
    assert rig.bus.at(0x6A)
    assert not rig.bus.at(0x70)

    for register, bit, address in ((0x02, 0x08, 0x51), (0x03, 0x04, 0x52), (0x04, 0x02, 0x53)):
        rig.write(register, address << 1)
        assert not rig.bus.at(address)
        rig.write(0x00, 0x10 | bit)
        assert rig.bus.at(address)


def test_two_chips_take_an_all_call_at_once(rig):
    other = Pca9685(0x61, rig.clock, lambda: None)
    bus = Bus([rig.chip, other])
    for chip in (rig.chip, other):
        chip.enable(True)
    bus.write(0x70, bytes((0x00, 0x21)))

    bus.write(0x70, bytes((0xFA, 0x00, 0x10, 0x00, 0x00)))

    assert rig.chip.outputs == other.outputs == [ON] * 16


def test_a_software_reset_reaches_every_chip_and_takes_one_byte_alone(rig):
    other = Pca9685(0x61, rig.clock, lambda: None)
    bus = Bus([rig.chip, other])
    for address in (0x60, 0x61):
        bus.write(address, bytes((0x00, 0x20)))

    assert bus.write(0, b"\x06\x06") == 1

    assert rig.chip.registers[0] == other.registers[0] == 0x11


def test_restart_is_told_while_awake_until_it_is_carried_out(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)
    rig.write(0x00, 0x30)
    rig.wake()
    assert rig.read(0x00) == [0xA0]
    assert rig.chip.outputs[0] == OFF

    rig.write(0x00, 0xA0)

    assert rig.read(0x00) == [0x20]
    assert rig.chip.outputs[0] == ON


def test_writing_zero_to_restart_does_nothing(rig):
    rig.wake()
    rig.write(0x06, 0x00, 0x10, 0x00, 0x00)
    rig.write(0x00, 0x30)
    rig.wake()

    rig.write(0x00, 0x20)

    assert rig.read(0x00) == [0xA0]
