"""The angle camera against its own description."""

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.anglecamera import AngleCamera, Optics
from hil_sim.devices.i2c import Bus

ADDRESS = 0x33
GRID_US = 5_000


class Rig:
    """A camera over an object at `degrees`, exposed on the bench's grid; ideal unless it is given a seed."""

    def __init__(self, seed: str | None = None, **optics) -> None:
        self.clock = Clock()
        self.camera = AngleCamera(ADDRESS, self.clock, Optics(**optics), seed)
        self.bus = Bus([self.camera])
        self.degrees: float | None = 0.0
        self._tick()

    def _tick(self) -> None:
        self.camera.expose(self.clock.now_us, self.degrees)
        self.clock.at(self.clock.now_us + GRID_US, self._tick)

    def wait_ms(self, ms: float) -> None:
        self.clock.run_until(self.clock.now_us + round(ms * 1000))

    def read(self, register: int = 0, count: int = 5) -> bytes:
        self.bus.write(ADDRESS, bytes((register,)))
        return self.bus.read(ADDRESS, count)

    def frame(self) -> int:
        return self.read()[2]

    def centideg(self) -> int:
        return int.from_bytes(self.read()[3:], "little", signed=True)


@pytest.fixture
def rig() -> Rig:
    return Rig()


def test_its_five_registers_are_read_in_one_transfer(rig):
    rig.degrees = -1.23
    rig.wait_ms(20)

    assert rig.read() == bytes((0x5A, 1, 2, 0x85, 0xFF))
    assert rig.read(2, 3) == bytes((2, 0x85, 0xFF))


def test_before_the_first_frame_nothing_is_seen(rig):
    rig.wait_ms(9)

    assert rig.read() == bytes((0x5A, 0, 0, 0, 0))


def test_a_hundred_frames_come_in_a_second(rig):
    rig.wait_ms(10)
    first = rig.frame()
    rig.wait_ms(1000)

    assert rig.frame() - first == 100


def test_a_frame_can_be_read_10_ms_after_its_exposure(rig):
    rig.wait_ms(18)
    rig.degrees = 5.0
    rig.wait_ms(11.9)
    assert rig.centideg() == 0

    rig.wait_ms(0.1)

    assert rig.centideg() == 500


def test_the_frame_counter_starts_anew_after_255(rig):
    rig.wait_ms(2570)

    assert rig.frame() == 257 & 0xFF


@pytest.mark.parametrize("degrees", [None, 60.01, -60.01, 200.0])
def test_an_object_out_of_its_sight_is_not_seen_and_has_no_angle(rig, degrees):
    rig.degrees = 30.0
    rig.wait_ms(30)
    rig.degrees = degrees
    rig.wait_ms(30)

    assert (rig.read()[1], rig.centideg()) == (0, 0)


@pytest.mark.parametrize("degrees", [60.0, -60.0])
def test_it_sees_60_degrees_to_either_side(rig, degrees):
    rig.degrees = degrees
    rig.wait_ms(30)

    assert (rig.read()[1], rig.centideg()) == (1, round(degrees * 100))


def test_what_one_transfer_reads_is_of_one_frame(rig):
    rig.wait_ms(20)
    rig.bus.write(ADDRESS, b"\x00")
    head = rig.bus.read(ADDRESS, 3)
    rig.degrees = 5.0
    rig.wait_ms(30)

    assert rig.bus.read(ADDRESS, 2) == b"\xf4\x01"  # the rest, read by itself, is of a later one
    assert rig.read()[2] != head[2]


def test_behind_the_last_register_there_is_nothing(rig):
    assert rig.read(4, 4) == bytes(4)
    assert rig.read(0xFF, 2) == bytes(2)


def test_there_is_nothing_to_be_written(rig):
    assert rig.bus.write(ADDRESS, b"\x00\x11\x22") == 1
    assert rig.read()[0] == 0x5A


def test_its_noise_is_as_stated_and_the_same_for_a_seed():
    one, again, other = (angles(Rig(seed)) for seed in ("1", "1", "2"))

    mean = sum(one) / len(one)
    rms = (sum((angle - mean) ** 2 for angle in one) / len(one)) ** 0.5
    assert one == again != other
    assert mean == pytest.approx(300, abs=0.4)  # 2 / sqrt(400) is 0.1
    assert rms == pytest.approx(2.0, rel=0.15)  # of 400 samples, 4 times the error that is to be expected


def angles(rig: Rig) -> list[int]:
    """Return 400 angles of an object at 3 degrees [centidegrees]."""
    rig.degrees = 3.0
    rig.wait_ms(20)
    found = []
    for _ in range(400):
        rig.wait_ms(10)
        found.append(rig.centideg())
    return found


def test_looking_changes_nothing():
    seldom, often = Rig("1"), Rig("1")
    for _ in range(99):
        often.wait_ms(1)
        often.read()
    often.wait_ms(1)
    seldom.wait_ms(100)

    assert seldom.read() == often.read()


@pytest.mark.parametrize(("rate_hz", "frames"), [(30, 30), (50, 50), (200, 200)])
def test_rate_and_latency_are_the_makers_choice(rate_hz, frames):
    rig = Rig(rate_hz=rate_hz, latency_ms=0)
    rig.wait_ms(999)

    assert rig.frame() == frames


def test_a_frozen_one_keeps_its_frame_and_goes_on_when_it_thaws(rig):
    rig.wait_ms(100)
    rig.camera.frozen = True
    rig.wait_ms(20)
    frame = rig.frame()
    rig.degrees = 7.0
    rig.wait_ms(200)
    assert (rig.frame(), rig.centideg()) == (frame, 0)

    rig.camera.frozen = False
    rig.wait_ms(30)

    assert (rig.frame(), rig.centideg()) == (frame + 2, 700)


def test_a_hidden_object_is_not_seen_but_frames_go_on(rig):
    rig.camera.hidden = True
    rig.wait_ms(100)
    frame = rig.frame()
    rig.wait_ms(10)

    assert (rig.read()[1], rig.frame()) == (0, frame + 1)


def test_one_that_is_gone_does_not_answer(rig):
    rig.camera.alive = False

    assert rig.bus.read(ADDRESS, 5) is None


def test_a_power_cycle_forgets_every_frame(rig):
    rig.wait_ms(100)

    rig.camera.reset()

    assert rig.read() == bytes((0x5A, 0, 0, 0, 0))
