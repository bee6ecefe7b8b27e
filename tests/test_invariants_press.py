"""The invariants of a press see what they are for: each is shown firmware that has lost the very line that holds it."""

import re

import pytest

from host.run import run
from protocol import frames, program
from tests.hil_rig import HilRig
from tests.sabotage import reproaches, sabotage

COARSE = "set=block.columns_count:16&set=block.rows_count:8"
HARD = f"sim:press?{COARSE}&set=material.youngs_modulus_kpa:120&set=axis.stall_force_n:80"
SOFT = f"sim:press?{COARSE}&set=material.youngs_modulus_kpa:6&set=material.damping_kpa_s:1"


def moved(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["P"], 300, over_ms=400, hold_ms=300)
    rig.run(seconds=1.5)


def pressed(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.press(3000, over_ms=300, time_ms=800, hold_ms=200)
    rig.run(seconds=2)


def released(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["P"], 500, over_ms=600, hold_ms=300)
    rig.run(seconds=0.7)
    rig.robot.press(0, over_ms=0, time_ms=500, hold_ms=200)
    rig.run(seconds=1.5)


def sunk(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.press(10_000, over_ms=0, time_ms=4000, hold_ms=0)
    rig.run(seconds=4.5)


def overloaded(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["P"], 1000, over_ms=1200, hold_ms=2000)
    rig.run(seconds=2)


def saved(rig: HilRig) -> None:
    overloaded(rig)
    rig.robot.clear()
    rig.robot.arm()
    rig.robot.move(["P"], 0, over_ms=3000, hold_ms=100)
    rig.run(seconds=3.5)


def deserted(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.press(3000, over_ms=300, time_ms=9000, hold_ms=100)
    rig.run_alone(seconds=2)


def stopped(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.press(3000, over_ms=300, time_ms=9000, hold_ms=100)
    rig.run(seconds=0.5)
    rig.link.write(frames.STOP)
    rig.run(seconds=0.3)


def disarmed(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.press(3000, over_ms=300, time_ms=9000, hold_ms=100)
    rig.run(seconds=0.6)
    rig.robot.disarm()
    rig.run(seconds=0.3)


def played(rig: HilRig) -> None:
    code = program.press(2000, 200, 600) + program.delay(700) + program.move(1, -100, 600) + program.halt()
    run(rig.robot, program.header(code, rig.robot.profile.crc) + code, lambda stage, done: None)


LEFT, LIVES = "def lease_left_ms(self) -> int:", " return self.lease_ms\n    def _(self):"
HOLDS = "order.over_ms, order.time_ms, order.hold_ms,"
STEP = "self._nm + self._rate_um_per_s * passed_ms))"
LOSSES = [
    (HARD, "load.py", "if self._over >= OVER_READS:", "if False:", overloaded, "driven for 1.* ms at 2.* N"),
    (HARD, "load.py", "abs(self.force_mn) > self._limits.trip_mn", "False", overloaded, "driven for 1.* ms at 2.* N"),
    (HARD, "control.py", "self.limbs.all_off()", "pass", overloaded, "no order allows"),
    (HARD, "press.py", "self._end_ms = self._until_ms + hold_ms", "self._end_ms = now_ms + 9000", pressed, "no order"),
    (HARD, "commands.py", HOLDS, HOLDS.replace("hold_ms", "hold_ms + 90"), pressed, "no order"),
    (HARD, "press.py", STEP, STEP.replace("passed_ms", "passed_ms * 20"), released, "told to move by .* mm"),
    (SOFT, "press.py", STEP, STEP.replace("))", ")) + 500000"), sunk, "its range is -5 to 10"),
    (HARD, "joints.py", "if passed_ms < over_ms:", "if False:", moved, "told to move by [23].* mm"),
    (HARD, "core.py", "self.trip(codes.STOP)", "pass", stopped, "no order allows"),
    (HARD, "commands.py", "self._core.disarm()", "pass", disarmed, "no order allows"),
    (HARD, "core.py", LEFT, LEFT + LIVES, deserted, "beyond the lease"),
]
DEEDS = (moved, pressed, released, overloaded, saved, deserted, stopped, disarmed, played)


@pytest.mark.parametrize(("address", "file", "line", "instead", "deed", "told"), LOSSES)
def test_an_invariant_is_missed_where_the_firmware_has_lost_it(monkeypatch, address, file, line, instead, deed, told):
    sabotage(monkeypatch, file, line, instead)

    assert re.search(told, reproaches(address, deed))


@pytest.mark.parametrize(("address", "deed"), [(SOFT, sunk), *((HARD, deed) for deed in DEEDS)])
def test_whole_firmware_does_the_same_deeds_without_reproach(address, deed):
    assert reproaches(address, deed) == ""
