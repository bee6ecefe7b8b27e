"""Converter, servos and camera behind the board's own drivers; the same in CPython and in real MicroPython."""

from pathlib import Path

import pytest

from hil_sim.bench import GRID_US
from hil_sim.board import CAMERA
from hil_sim.devices.anglecamera import AngleCamera, Optics
from hil_sim.journal import KINDS
from hil_sim.worlds import cpython, micropython
from hil_sim.worlds.costs import BOOT_US
from tests.bench_fakes import bench_of

ROOT = Path(__file__).parents[1]
WORLDS = {"cpython": cpython.execute, "micropython": micropython.execute}
BOARD = """
import micropython
from firmware.boards.pico import Board
board = Board()
adc, right, left, camera = board.adc(), board.servo(8, 200), board.servo(9, 200), board.camera(0x33)
counts = [0] * 16

def step(width_ns):
    micropython.heap_lock()
    for number in range(16):
        counts[number] = adc.counts(number)
    right.pulse(width_ns)
    fresh = camera.read()
    micropython.heap_unlock()
    board.feed()
    time.sleep_ms(5)
    return fresh
"""


class Rig:
    """A bench with firmware of a test's own on the board's drivers, and a camera over an object."""

    def __init__(self, folder, main, world="cpython", object_deg=4.2):
        sources = {str(path.relative_to(ROOT)): path.read_text() for path in (ROOT / "firmware").rglob("*.py")}
        sources |= {str(path.relative_to(ROOT)): path.read_text() for path in (ROOT / "protocol").rglob("*.py")}
        self.bench = bench_of(folder, BOARD + main, sources, execute=WORLDS[world], keep_journal=True)
        self.board = self.bench.board
        self.board.adc.inputs.update({number: lambda number=number: 0.2 * number for number in range(14)})
        self.camera = AngleCamera(CAMERA, self.bench.clock, Optics(), seed="1")
        self.board.bus.chips.append(self.camera)
        self._object_deg = object_deg
        self._expose()

    def _expose(self):
        self.camera.expose(self.bench.clock.now_us, self._object_deg)
        self.bench.clock.at(self.bench.clock.now_us + GRID_US, self._expose)

    def run(self, ms=100):
        self.bench.clock.run_until(BOOT_US + ms * 1000)
        return self

    def commanded(self):
        now_us = self.bench.clock.now_us
        return [self.board.servos[pin].commanded_deg(now_us) for pin in (8, 9)]

    def done(self):
        """Return what the firmware printed, line by line."""
        self.bench.close()
        return "".join(self.bench.world.console).split("\n")[:-1]


def test_the_firmware_reads_all_sixteen_inputs(tmp_path):
    said = Rig(tmp_path, "step(0)\nprint(counts)").run().done()

    assert said == [str([round(0.2 * number / 3.3 * 4096) for number in range(14)] + [0, 0])]


def test_pulses_turn_one_servo_and_leave_its_neighbour_limp(tmp_path):
    rig = Rig(tmp_path, "while True: step(1_600_000)").run()

    angle, other = rig.commanded()
    assert angle == pytest.approx(9.0, abs=0.004)  # half a count of 76.5 ns
    assert other is None


@pytest.mark.parametrize(("width_ns", "angle_deg"), [(500_000, -90.0), (2_500_000, 90.0)])
def test_the_ends_of_the_range_are_reached_200_times_a_second(tmp_path, width_ns, angle_deg):
    rig = Rig(tmp_path, f"while True: step({width_ns})").run()

    assert rig.commanded()[0] == pytest.approx(angle_deg, abs=0.004)


def test_a_servo_that_is_let_go_leaves_its_neighbour_its_pulses(tmp_path):
    rig = Rig(tmp_path, "left.pulse(1_400_000)\nstep(1_600_000)\nright.off()\nwhile True: step(0)")
    rig.run(ms=50)
    assert None not in rig.commanded()

    rig.run(ms=200)

    angle, other = rig.commanded()
    assert angle is None
    assert other == pytest.approx(-9.0, abs=0.004)


def test_a_frame_of_the_camera_is_new_once(tmp_path):
    main = (
        "step(0)\na = time.ticks_ms()\nfresh = sum([step(0) for _ in range(40)])\n"
        "late_ms = time.ticks_diff(time.ticks_ms(), a) - 10 * fresh\n"
        "print(abs(late_ms) <= 10, camera.seen, abs(camera.centideg - 420) < 10)"
    )

    assert Rig(tmp_path, main).run(ms=300).done() == ["True True True"]


@pytest.mark.parametrize("object_deg", [-4.2, 59.9])
def test_the_angle_has_its_sign_and_a_hidden_object_none(tmp_path, object_deg):
    main = "for _ in range(9): step(0)\nprint(camera.seen, camera.centideg)"
    said = Rig(tmp_path, main, object_deg=object_deg).run().done()[0].split()
    hidden = Rig(tmp_path / "hidden", main, object_deg=None).run().done()

    assert said[0] == "True"
    assert int(said[1]) == pytest.approx(100 * object_deg, abs=10)
    assert hidden == ["False 0"]


NOBODY = "try: camera.read()\nexcept OSError as error: print(error.args[0])"


def test_a_camera_that_is_gone_or_another_chip_is_an_error(tmp_path):
    rig = Rig(tmp_path, f"time.sleep_ms(20)\n{NOBODY}\ncamera.address = 0x40\n{NOBODY}")
    rig.camera.alive = False

    assert rig.run().done() == ["5", "19"]


def test_both_worlds_leave_the_same_trace_and_allocate_nothing(tmp_path):
    main = "for turn in range(30): step(1_000_000 + 33_333 * turn)\nright.off()\nprint(counts, camera.centideg)"
    here, there = (Rig(tmp_path / world, main, world).run(ms=300) for world in WORLDS)

    said = here.done()
    assert len(said) == 1
    assert said == there.done()
    assert here.bench.trace_sha256() == there.bench.trace_sha256()
    kinds = {KINDS[entry[1]] for entry in here.bench.journal.kept()}
    assert {"spi", "pwm", "i2c read"} <= kinds


@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize("width_ns", [50_000_000, 1 << 32])
def test_a_pulse_longer_than_its_period_is_refused_in_the_ports_words(tmp_path, world, width_ns):
    said = Rig(tmp_path, f"try: right.pulse({width_ns})\nexcept ValueError as error: print(error)", world).run().done()

    assert said == ["duty larger than period"]
