"""LSM6DS3TR-C against the register description of its data sheet."""

import math

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.i2c import Bus
from hil_sim.devices.lsm6ds3tr import G, Lsm6ds3tr

ADDRESS = 0x6A
CTRL1_XL, CTRL2_G, CTRL3_C, STATUS, GYRO, ACCEL = 0x10, 0x11, 0x12, 0x1E, 0x22, 0x28


class Moved:
    """A body that does what a test says."""

    def __init__(self) -> None:
        self.force = (0.0, 0.0, G)
        self.rate = (0.0, 0.0, 0.0)

    def specific_force(self):
        return self.force

    def angular_rate(self):
        return self.rate


class Rig:
    """One chip on a bus; ideal unless it is given a seed."""

    def __init__(self, seed: str | None = None) -> None:
        self.clock = Clock()
        self.body = Moved()
        self.chip = Lsm6ds3tr(ADDRESS, self.clock, self.body, seed)
        self.bus = Bus([self.chip])

    def set(self, register: int, *values: int) -> None:
        self.bus.write(ADDRESS, bytes((register, *values)))

    def get(self, register: int, count: int = 1) -> bytes:
        self.bus.write(ADDRESS, bytes((register,)))
        return self.bus.read(ADDRESS, count)

    def words(self, register: int, count: int = 3) -> list[int]:
        data = self.get(register, 2 * count)
        return [int.from_bytes(data[2 * i : 2 * i + 2], "little", signed=True) for i in range(count)]

    def put(self, force=None, rate=None) -> None:
        self.chip.before_change()
        self.body.force, self.body.rate = force or self.body.force, rate or self.body.rate

    def wait_ms(self, ms: float) -> None:
        self.clock.run_until(self.clock.now_us + round(ms * 1000))


@pytest.fixture
def rig() -> Rig:
    return Rig()


@pytest.fixture
def awake(rig) -> Rig:
    """Both sensors at 104 Hz, 4 g and 1000 deg/s, with their first sample taken."""
    rig.set(CTRL1_XL, 0x48, 0x48)
    rig.wait_ms(35)
    return rig


def test_registers_after_power_on_are_those_of_the_data_sheet(rig):
    assert rig.get(0x0F) == b"\x6a"
    assert rig.get(0x10, 10) == bytes((0, 0, 4, 0, 0, 0, 0, 0, 0, 0))
    assert rig.get(0x1E, 16) == bytes(16)


def test_it_answers_only_at_its_address(rig):
    assert rig.bus.write(0x6B, b"\x0f") == -1
    rig.chip.alive = False
    assert rig.bus.read(ADDRESS, 1) is None


def test_in_power_down_nothing_is_sampled(rig):
    rig.wait_ms(1000)

    assert rig.get(STATUS) == b"\x00"
    assert rig.words(ACCEL) == [0, 0, 0]


def test_the_first_sample_comes_when_the_sensor_has_woken_up(rig):
    rig.set(CTRL1_XL, 0x48)

    rig.wait_ms(34.9)
    assert rig.get(STATUS) == b"\x00"
    rig.wait_ms(0.1)

    assert rig.get(STATUS)[0] & 3 == 1
    assert rig.words(ACCEL) == [0, 0, round(1000 / 0.122)]


@pytest.mark.parametrize(("scale", "mg"), [(0x0, 0.061), (0x4, 0.488), (0x8, 0.122), (0xC, 0.244)])
def test_acceleration_has_the_sensitivity_of_its_scale(rig, scale, mg):
    rig.put(force=(G, -G / 2, 0.0))

    rig.set(CTRL1_XL, 0x40 | scale)
    rig.wait_ms(40)

    assert rig.words(ACCEL) == [round(1000 / mg), -round(500 / mg), 0]


@pytest.mark.parametrize(("scale", "mdps"), [(0x0, 8.75), (0x4, 17.5), (0x8, 35), (0xC, 70), (0x2, 4.375)])
def test_turn_rate_has_the_sensitivity_of_its_scale(rig, scale, mdps):
    rig.put(rate=(math.radians(100), math.radians(-50), 0.0))

    rig.set(CTRL2_G, 0x40 | scale)
    rig.wait_ms(40)

    assert rig.words(GYRO) == [round(100_000 / mdps), -round(50_000 / mdps), 0]


def test_what_is_beyond_the_scale_stays_at_its_end(awake):
    awake.put(force=(10 * G, -10 * G, 0.0), rate=(100.0, -100.0, 0.0))
    awake.wait_ms(20)

    assert awake.words(ACCEL)[:2] == [0x7FFF, -0x8000]
    assert awake.words(GYRO)[:2] == [0x7FFF, -0x8000]


def test_one_burst_reads_status_temperature_and_all_outputs(awake):
    awake.chip.degc = 26.5
    awake.wait_ms(10)

    data = awake.get(STATUS, 16)

    assert data == bytes((3, 0)) + (384).to_bytes(2, "little") + bytes(6) + bytes(4) + (8197).to_bytes(2, "little")


def test_a_new_sample_is_flagged_until_a_high_byte_of_it_is_read(awake):
    assert awake.get(STATUS) == b"\x03"
    awake.get(ACCEL)
    assert awake.get(STATUS) == b"\x03"

    awake.get(ACCEL + 1)
    assert awake.get(STATUS) == b"\x02"
    awake.get(GYRO, 6)
    assert awake.get(STATUS) == b"\x00"

    awake.wait_ms(9.7)
    assert awake.get(STATUS) == b"\x03"


@pytest.mark.parametrize(("code", "hertz"), [(1, 12.5), (2, 26), (3, 52), (4, 104), (5, 208), (6, 416), (8, 1666)])
def test_samples_come_at_the_rate_that_was_set(rig, code, hertz):
    rig.set(CTRL1_XL, code << 4)
    rig.wait_ms(36)
    rig.words(ACCEL)
    fresh = 0

    for _ in range(20_000):
        rig.wait_ms(0.1)
        if rig.get(STATUS)[0] & 1:
            fresh += 1
            rig.words(ACCEL)

    assert fresh == pytest.approx(2 * hertz, abs=1)


def test_a_sample_is_of_the_motion_before_the_change(awake):
    awake.wait_ms(9.7)

    awake.put(force=(G, 0.0, 0.0))

    assert awake.words(ACCEL) == [0, 0, 8197]
    awake.wait_ms(9.7)
    assert awake.words(ACCEL) == [8197, 0, 0]


def test_with_block_data_update_a_word_half_read_does_not_change(awake):
    awake.set(CTRL3_C, 0x44)
    awake.put(force=(0.0, 0.0, 0.0))
    assert awake.get(ACCEL + 4) == bytes((8197 & 0xFF,))

    awake.wait_ms(20)

    assert awake.get(ACCEL + 5) == bytes((8197 >> 8,))
    assert awake.words(ACCEL) == [0, 0, 0]


def test_without_it_the_two_halves_may_be_of_two_samples(awake):
    awake.put(force=(0.0, 0.0, 0.0))
    awake.get(ACCEL + 4)

    awake.wait_ms(20)

    assert awake.get(ACCEL + 5) == b"\x00"


def test_addresses_count_up_unless_that_is_switched_off(awake):
    awake.set(CTRL3_C, 0x00)

    assert awake.get(0x0F, 3) == b"\x6a\x6a\x6a"


def test_big_endian_swaps_the_bytes_of_the_outputs_only(awake):
    awake.set(CTRL3_C, 0x06)

    assert awake.get(ACCEL + 4, 2) == (8197).to_bytes(2, "big")
    assert awake.get(CTRL1_XL, 2) == b"\x48\x48"


def test_a_software_reset_takes_its_time_and_forgets_everything(awake):
    awake.set(CTRL3_C, 0x45)

    assert awake.get(CTRL3_C)[0] & 1
    awake.wait_ms(0.05)
    assert awake.get(CTRL1_XL, 3) == b"\x00\x00\x04"
    awake.wait_ms(100)
    assert awake.get(STATUS) == b"\x00"


def test_identity_and_outputs_cannot_be_written(rig):
    rig.set(0x0F, 0x55)
    rig.set(ACCEL, 0x55)

    assert rig.get(0x0F) == b"\x6a"
    assert rig.get(ACCEL) == b"\x00"


def test_the_gyroscope_sleeps_while_the_accelerometer_goes_on(awake):
    awake.set(0x13, 0x40)
    awake.get(GYRO, 12)

    awake.wait_ms(100)

    assert awake.get(STATUS) == b"\x01"


def test_zero_levels_and_noise_are_those_of_the_data_sheet_and_follow_from_the_seed():
    rows = {seed: sampled(Rig(seed)) for seed in ("a", "b", "c")}

    assert rows["a"] == sampled(Rig("a")) != rows["b"]
    for samples in rows.values():
        for axis, (typical, noise) in enumerate([(3 / 0.035, 0.005 * 52**0.5 / 0.035)] * 3 + [(40 / 0.122, 5.3)] * 3):
            column = [row[axis] - (8197 if axis == 5 else 0) for row in samples]
            mean = sum(column) / len(column)
            spread = (sum((value - mean) ** 2 for value in column) / len(column)) ** 0.5
            assert abs(mean) < typical + 1
            assert spread == pytest.approx(noise, rel=0.25)


def test_looking_often_changes_nothing():
    seldom, often = Rig("a"), Rig("a")
    for rig in (seldom, often):
        rig.set(CTRL1_XL, 0x48, 0x48)
    for _ in range(500):
        often.wait_ms(0.4)
        often.get(STATUS, 16)
    seldom.wait_ms(200)

    assert seldom.words(GYRO, 6) == often.words(GYRO, 6)


def test_a_stuck_sensor_gives_its_last_sample_as_a_new_one():
    rig = Rig("a")
    rig.set(CTRL1_XL, 0x48, 0x48)
    rig.wait_ms(40)
    before = rig.words(GYRO, 6)

    rig.chip.stuck = True
    rig.wait_ms(50)

    assert rig.get(STATUS) == b"\x03"
    assert rig.words(GYRO, 6) == before


def sampled(rig) -> list[list[int]]:
    """Return 200 samples of both sensors."""
    rig.set(CTRL1_XL, 0x48, 0x48)
    rig.wait_ms(35)
    rows = []
    for _ in range(200):
        rig.wait_ms(9.7)
        rows.append(rig.words(GYRO, 6))
    return rows
