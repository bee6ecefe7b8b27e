"""The invariants see what they are for: each is shown firmware that has lost the very line that holds it.

A run that holds them all shows that they do not cry wolf; every other test of the suite does so, too.
"""

import re

import pytest

from host.run import run
from protocol import frames, messages, program
from tests.hil_rig import HilRig
from tests.sabotage import reproaches, sabotage


def long_order(rig: HilRig) -> None:
    rig.fire("A", duty_percent=30, hold_s=0.3)
    rig.run(seconds=1)


def deserted(rig: HilRig) -> None:
    rig.fire("A", duty_percent=30, hold_s=5)
    rig.run_alone(seconds=2)


def glowing(rig: HilRig) -> None:
    rig.fire("A", duty_percent=100, hold_s=3)
    rig.run(seconds=3)


def ordered_anew(rig: HilRig) -> None:
    rig.fire("A", duty_percent=10, hold_s=8)
    rig.run(seconds=7)
    rig.fire("A", duty_percent=10, hold_s=8)
    rig.run(seconds=5)


def stopped(rig: HilRig) -> None:
    rig.fire("A", duty_percent=30, hold_s=2)
    rig.link.write(frames.STOP)
    rig.run(seconds=0.2)


def disarmed(rig: HilRig) -> None:
    rig.fire("A", duty_percent=30, hold_s=2)
    rig.robot.disarm()
    rig.run(seconds=0.2)


def shortened(rig: HilRig) -> None:
    rig.fire("A", duty_percent=30, hold_s=2)
    rig.fire("A", duty_percent=30, hold_s=0.1)
    rig.run(seconds=0.5)


def played(rig: HilRig) -> None:
    code = program.repeat(2) + program.fire(1, 300, 200) + program.delay(250) + program.next_() + program.halt()
    run(rig.robot, program.header(code, rig.robot.profile.crc) + code, lambda stage, done: None)


ENDS = "if now_ms - self._end_ms[channel] >= 0:"
LEASE_LEFT, LIVES = "def lease_left_ms(self) -> int:", " return self.lease_ms\n    def _(self):"
LOOKS = "hottest, fullest = sense.hottest, sense.fullest"
ORDER_END = "self._end_ms[channel] = now_ms + hold_ms"
LOSSES = [
    ("channels.py", ENDS, "if False:", long_order, "on for 6.* ms that no order allows"),
    ("channels.py", ORDER_END, ORDER_END + " + 20", long_order, "on for 1.* ms that no order allows"),
    ("channels.py", ORDER_END, ORDER_END.replace("= n", "= self._end_ms[channel] or n"), shortened, "no order allows"),
    (
        "commands.py",
        "core.channels.fire(order.coils,",
        "core.channels.fire(order.coils << 1,",
        long_order,
        "coil B .* no",
    ),
    ("core.py", "self.trip(codes.STOP)", "pass", stopped, "no order allows"),
    ("commands.py", "self._core.disarm()", "pass", disarmed, "no order allows"),
    (
        "core.py",
        LEASE_LEFT,
        LEASE_LEFT + LIVES,
        deserted,
        "on for 1.* ms beyond the lease",
    ),
    ("guard.py", LOOKS, "return 0", glowing, "its trip is 120 C"),
    ("guard.py", LOOKS, "return 0", glowing, "its heat budget is 520 mJ"),
    (
        "channels.py",
        "elif now_ms - self._since_ms[channel] > self._on_max_ms:",
        "elif False:",
        ordered_anew,
        "a pause",
    ),
    (
        "player.py",
        "program.number(code, at + 7, 2),",
        "program.number(code, at + 7, 2) + 20,",
        played,
        "no order allows",
    ),
]


@pytest.mark.parametrize(("file", "line", "instead", "deed", "told"), LOSSES)
def test_an_invariant_is_missed_where_the_firmware_has_lost_it(monkeypatch, file, line, instead, deed, told):
    sabotage(monkeypatch, file, line, instead)

    assert re.search(told, reproaches("sim:circular?body=still", deed))


@pytest.mark.parametrize("deed", sorted({row[3] for row in LOSSES}, key=lambda deed: deed.__name__))
def test_whole_firmware_does_the_same_deeds_without_reproach(deed):
    assert reproaches("sim:circular?body=still", deed) == ""


@pytest.mark.parametrize("duty_permille", [0, 200])
def test_an_order_that_was_on_its_way_before_the_last_was_answered_still_allows(rig, duty_permille):
    rig.robot.arm()
    begun_s = rig.now_s
    for each_permille in (300, duty_permille, 300, duty_permille, 300, duty_permille, 100):
        rig.robot.talk.ask(messages.FIRE, coils=1, duty_permille=each_permille, hold_ms=1000)
    rig.run(seconds=1.5)

    assert rig.coil("A").off_at_s > begun_s + 0.9
