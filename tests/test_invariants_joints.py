"""The invariants of joints see what they are for: each is shown firmware that has lost the very line that holds it."""

import re

import pytest

from host.run import run
from protocol import frames, program
from tests.hil_rig import HilRig
from tests.sabotage import reproaches, sabotage


def moved(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["R"], 300, over_ms=100, hold_ms=300)
    rig.run(seconds=1)


def opened(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["R"], -300, over_ms=100, hold_ms=300)
    rig.run(seconds=1)


def swung(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["R", "L"], 1500, over_ms=200, hold_ms=300)
    rig.run(seconds=0.4)


def deserted(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["R", "L"], 300, over_ms=100, hold_ms=5000)
    rig.run_alone(seconds=2)


def stopped(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["R", "L"], 300, over_ms=100, hold_ms=5000)
    rig.link.write(frames.STOP)
    rig.run(seconds=0.2)


def disarmed(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["R", "L"], 300, over_ms=100, hold_ms=5000)
    rig.robot.disarm()
    rig.run(seconds=0.2)


def turned(rig: HilRig) -> None:
    rig.robot.arm()
    rig.robot.move(["R"], 400, over_ms=200, hold_ms=5000)
    rig.robot.move(["L"], -400, over_ms=200, hold_ms=5000)
    rig.run(seconds=0.3)
    rig.robot.orient(500, time_ms=500, hold_ms=200)
    rig.run(seconds=1.5)


def played(rig: HilRig) -> None:
    code = program.move(0b01, 400, 200) + program.delay(250) + program.move(0b01, 0, 200) + program.halt()
    run(rig.robot, program.header(code, rig.robot.profile.crc) + code, lambda stage, done: None)


ENDS = "if now_ms - self._end_ms[joint] >= 0:"
ORDER_END = "self._end_ms[joint] = now_ms + over_ms + hold_ms"
LEFT, LIVES = "def lease_left_ms(self) -> int:", " return self.lease_ms\n    def _(self):"
LOSSES = [
    ("joints.py", ENDS, "if False:", moved, "joint R was on for 37.* ms that no order allows"),
    ("joints.py", ORDER_END, ORDER_END + " + 250", moved, "no order allows"),
    ("commands.py", "limbs.move(order.joints,", "limbs.move(order.joints << 1,", moved, "joint L .* no order allows"),
    ("core.py", "self.trip(codes.STOP)", "pass", stopped, "no order allows"),
    ("control.py", "self.limbs.all_off()", "pass", stopped, "no order allows"),
    ("commands.py", "self._core.disarm()", "pass", disarmed, "no order allows"),
    ("core.py", LEFT, LEFT + LIVES, deserted, "beyond the lease"),
    (
        "orient.py",
        "self._end_ms = self._until_ms + hold_ms",
        "self._end_ms = now_ms + 60000",
        turned,
        "no order allows",
    ),
    ("joints.py", "if passed_ms < over_ms:", "if False:", swung, "told to move by 1[45].* deg"),
    ("jointlimits.py", "from_low = centi + self", "from_low = 20 * centi + self", opened, "its range is -30 to 30"),
    ("player.py", "self._limbs.play_move(mask,", "self._limbs.play_move(3,", played, "joint L .* no order allows"),
]


@pytest.mark.parametrize(("file", "line", "instead", "deed", "told"), LOSSES)
def test_an_invariant_is_missed_where_the_firmware_has_lost_it(monkeypatch, file, line, instead, deed, told):
    sabotage(monkeypatch, file, line, instead)

    assert re.search(told, reproaches("sim:fingers", deed))


@pytest.mark.parametrize("deed", sorted({row[3] for row in LOSSES}, key=lambda deed: deed.__name__))
def test_whole_firmware_does_the_same_deeds_without_reproach(deed):
    assert reproaches("sim:fingers", deed) == ""
