"""What the checker passes of a press, the robot runs: the same programs on the firmware's own sequencer and loop."""

import json

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from firmware.attitude import Blind
from firmware.channels import Channels, Refused
from firmware.limbs import Limbs
from firmware.player import FINISHED, GUARDED, RUNNING, TIMED_OUT, Player
from firmware.profile import Profile
from firmware.sense import Sense
from host.gait.checker import check
from protocol import codes
from tests.firmware_bench import Table
from tests.firmware_press import Axis
from tests.gait_scripts import block, compiled, press_robot, report
from tests.loaded import Loaded
from tests.press_scripts import HOME, bodies

STEP_MS = 5
READY_MS = 50  # until the load cell has been read
LIMP = -32768
PA_PER_N = 1300  # under the indenter


class Bare:
    """The firmware's sequencer, axis and press loop on a table top, over a block of one dimension."""

    def __init__(self, code: bytes, rest_mm: float = 3.0, scale: float = 1.0) -> None:
        board, profile = Table(), Profile(json.dumps(block()).encode())
        self.axis = board.converter = Axis(board, scale)
        self.axis.mm, self.axis.surface_mm = rest_mm, max(rest_mm, 0.0)
        sense = Sense(board, board.supply, 0, profile)
        self.limbs = Limbs(board, profile)
        self.player = Player(Channels([], [], profile.coil, 1), sense, Blind(), self.limbs)
        self.code, self.now_ms = code, 0
        self.fallen = False
        self.busy_ms = 0
        self.fastest_centi_per_s = 0
        self.told, self.felt_n = [], []

    def run(self) -> int:
        """Run to the end and return the outcome; Refused passes through."""
        outcome = RUNNING
        while outcome == RUNNING:
            self.axis.pass_time()
            felt_pa = max(0, round(self.axis.force_n * PA_PER_N))
            self.axis.cell_counts = [min(4095, felt_pa * 4096 // 20_000)] * 6
            self.limbs.look(self.now_ms)
            if self.now_ms == READY_MS:
                self.player.load(Loaded(self.code, 0, 1, 6), self.now_ms)
            if self.now_ms >= READY_MS:
                outcome = self.player.run(self.now_ms)
            before, was_on = self.limbs.joints.commanded_centi[0], self.limbs.joints.on_mask
            self.limbs.drive(self.now_ms, True)
            self._look(before, was_on)
            self.now_ms += STEP_MS
        self.now_ms -= READY_MS + STEP_MS
        return outcome

    def _look(self, before: int, was_on: int) -> None:
        joints = self.limbs.joints
        self.busy_ms += STEP_MS * self.limbs.busy(self.now_ms)
        self.fallen |= was_on & ~joints.on_mask != 0
        told = joints.commanded_centi[0]
        if LIMP not in (before, told):
            self.told.append(told)
            self.felt_n.append(self.axis.force_n)
            self.fastest_centi_per_s = max(self.fastest_centi_per_s, abs(told - before) * 1000 // STEP_MS)


def bare(body: str, **where) -> Bare:
    """Return a press that is about to run this script."""
    return Bare(compiled(body, profile=press_robot()).code, **where)


def test_a_script_that_presses_runs_for_as_long_as_its_text_says():
    turn = "    press to 3 N over 500 ms for 3 s overlap 500 ms\n    move P to 0 mm over 1500 ms\n"
    body = f"{HOME}\nrepeat 2:\n{turn}wait 1 s"
    press = bare(body)

    assert press.run() == FINISHED
    assert press.now_ms == report(body, profile=press_robot()).shortest_ms == 1500 + 2 * 4000 + 1000


def test_a_program_waits_for_a_press_that_has_not_ended():
    body = f"{HOME}\npress to 3 N over 500 ms for 4 s overlap 4 s\nwait 300 ms"
    press = bare(body)

    press.run()

    assert press.now_ms == report(body, profile=press_robot()).shortest_ms == 1500 + 4000


def test_a_force_is_reached_in_its_time_and_kept():
    press = bare("move P to 0 mm over 1500 ms\npress to 5 N over 1 s for 4 s", rest_mm=-2)

    press.run()

    assert press.felt_n[-1] == pytest.approx(5, abs=0.1)
    assert max(press.felt_n) < 5.5


def test_waits_for_force_pressure_and_depth_end_when_it_is_so():
    down = "move P to 4 mm over 2 s overlap 2 s\nwait until {} timeout 2 s else abort\nmove P to -2 mm over 1500 ms"
    for asked, told in (("force > 2 N", 75), ("any.pressure > 2.6 kPa", 75), ("P.depth > 3 mm", 300)):
        press = bare(f"move P to 0 mm over 1500 ms\n{down.format(asked)}", rest_mm=-2)

        assert press.run() == FINISHED
        assert max(press.told) == pytest.approx(told, abs=25)


def test_a_guard_of_force_or_pressure_ends_the_script():
    for guard in ("force > 3 N", "C6.pressure > 4 kPa"):
        press = bare(f"guard {guard}\nmove P to 0 mm over 1500 ms\npress to 5 N over 1 s for 4 s", rest_mm=-2)

        assert press.run() == GUARDED
        assert max(press.felt_n) < 3.3


@pytest.mark.parametrize(("hold_ms", "sound", "falls"), [(4995, True, False), (5005, False, True)])
def test_the_checker_knows_how_long_the_axis_holds_after_a_press(hold_ms, sound, falls):
    made = compiled(f"{HOME}\npress to 1 N over 1 s for 2 s\nwait {hold_ms} ms\n{HOME}", profile=press_robot())
    press = Bare(made.code)

    press.run()

    assert (check(made).sound, press.fallen) == (sound, falls)


@pytest.mark.parametrize(
    ("order", "code"),
    [
        ("press to 18.001 N over 1 s for 2 s", codes.FORCE_LIMIT),
        ("press to 5 N over 1 s for 5001 ms", codes.HOLD_LIMIT),
        ("press to 5 N over 1 s for 2 s\nmove P to 10 mm over 100 ms", codes.SLEW_LIMIT),
    ],
)
def test_what_the_checker_refuses_of_a_press_the_robot_refuses_too(order, code):
    made = compiled(f"{HOME}\n{order}", profile=press_robot())

    assert not check(made).sound
    with pytest.raises(Refused) as caught:
        Bare(made.code).run()
    assert caught.value.code == code


@settings(max_examples=100, deadline=None)
@given(bodies, st.floats(-10, 10), st.sampled_from([0.0, 0.2, 1.0]))
def test_what_the_checker_passes_of_a_press_is_never_refused_and_never_beyond_its_worst_case(body, rest_mm, scale):
    worst = report(body, profile=press_robot())
    assume(worst.sound and worst.longest_ms < 40_000)
    press = bare(body, rest_mm=rest_mm, scale=scale)

    assert press.run() in (FINISHED, TIMED_OUT)

    assert not press.fallen
    assert press.fastest_centi_per_s <= 1000 + 1000 // STEP_MS  # a rounded hundredth in one step
    assert press.now_ms <= worst.longest_ms
    assert all(-500 <= centi <= 1000 for centi in press.told)
    (row,) = worst.joints
    assert all(row.least_centi <= centi <= row.most_centi for centi in press.told[1500 // STEP_MS :])
    assert press.busy_ms <= row.driven_ms + STEP_MS * row.orders
