"""What the checker passes of joints, the robot runs: the same programs on the firmware's own sequencer and joints."""

import json

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from firmware.attitude import Blind
from firmware.channels import Channels, Refused
from firmware.limbs import Limbs
from firmware.player import FINISHED, RUNNING, TIMED_OUT, Player
from firmware.profile import Profile
from firmware.sense import Sense
from host.gait.checker import check
from tests.firmware_bench import Table
from tests.gait_scripts import compiled, hand, hand_robot, report
from tests.joint_scripts import HOME, bodies
from tests.loaded import Loaded

STEP_MS = 5
READY_MS = 50  # until the camera has been looked at
LIMP = -32768
GAIN = -0.5  # of the object's angle over the swing


class Bare:
    """The firmware's sequencer and joints on a table top, which follow at once; the object follows their swing."""

    def __init__(self, code: bytes, rest_centi=(0, 0)) -> None:
        self.board, profile = Table(), Profile(json.dumps(hand()).encode())
        sense = Sense(self.board, self.board.supply, 0, profile)
        self.limbs = Limbs(self.board, profile)
        self.player = Player(Channels([], [], profile.coil, 2), sense, Blind(), self.limbs)
        self.board.converter.rest_centi = list(rest_centi)
        self.code, self.now_ms = code, 0
        self.fallen = False
        self.fastest_centi_per_s = 0
        self.told = ([], [])

    def run(self) -> int:
        """Run to the end and return the outcome; Refused passes through."""
        outcome = RUNNING
        while outcome == RUNNING:
            self.limbs.look(self.now_ms)
            if self.now_ms == READY_MS:
                self.player.load(Loaded(self.code, 0, 2), self.now_ms)
            if self.now_ms >= READY_MS:
                outcome = self.player.run(self.now_ms)
            before, were_on = list(self.limbs.joints.commanded_centi), self.limbs.joints.on_mask
            self.limbs.drive(self.now_ms, True)
            self._look(before, were_on)
            self.now_ms += STEP_MS
        self.now_ms -= READY_MS + STEP_MS
        return outcome

    def _look(self, before, were_on) -> None:
        joints = self.limbs.joints
        self.fallen |= were_on & ~joints.on_mask != 0
        for old, new, told in zip(before, joints.commanded_centi, self.told, strict=True):
            if LIMP in (old, new):
                continue
            told.append(new)
            if not self.limbs.orient.active:  # it turns them a whole frame's way at once
                self.fastest_centi_per_s = max(self.fastest_centi_per_s, abs(new - old) * 1000 // STEP_MS)
        if joints.on_mask == 0b11:
            self.board.watcher.centideg = round(GAIN * sum(joints.commanded_centi) / 2)


rests = st.tuples(st.integers(-6000, 6000), st.integers(-6000, 6000))


def test_a_script_of_moves_runs_for_as_long_as_its_text_says():
    made = compiled(
        "move R L to 8 deg over 1 s\nrepeat 2:\n    move R to -8 deg over 500 ms overlap 100 ms\nwait 1 s",
        profile=hand_robot(),
    )
    bare = Bare(made.code)

    assert bare.run() == FINISHED
    assert bare.now_ms == check(made).shortest_ms == 2800


def test_a_program_waits_for_joints_that_are_still_on_their_way():
    made = compiled("move R to 8 deg over 2 s overlap 2 s\nwait 300 ms", profile=hand_robot())
    bare = Bare(made.code)

    bare.run()

    assert bare.now_ms == check(made).shortest_ms == 2000
    assert bare.told[0][-1] == 800


def test_a_wait_for_an_angle_ends_when_the_joint_has_come_by():
    made = compiled(
        "move R to 20 deg over 2 s overlap 2 s\n"
        "wait until R.angle > 10 deg timeout 2 s else abort\n"
        "move R to 0 deg over 1 s",
        profile=hand_robot(),
    )
    bare = Bare(made.code)

    assert bare.run() == FINISHED
    assert max(bare.told[0]) == pytest.approx(1000, abs=30)  # a count of the potentiometer, and two steps


def test_moves_that_follow_each_other_make_one_line():
    made = compiled(f"{HOME}\nmove R to 10 deg over 500 ms\nmove R to 20 deg over 500 ms", profile=hand_robot())
    bare = Bare(made.code)

    bare.run()

    assert bare.told[0][-200:] == list(range(10, 2001, 10))


@pytest.mark.parametrize(("hold_ms", "sound", "falls"), [(4995, True, False), (5005, False, True)])
def test_the_checker_knows_how_long_a_joint_holds(hold_ms, sound, falls):
    made = compiled(f"{HOME}\nwait {hold_ms} ms\n{HOME}", profile=hand_robot())
    bare = Bare(made.code)

    bare.run()

    assert (check(made).sound, bare.fallen) == (sound, falls)


def test_a_script_that_the_checker_refuses_for_its_speed_the_robot_refuses_too():
    body = "move R to -20 deg over 1 s\nmove R to {} deg over 300 ms"
    made = [compiled(body.format(angle), profile=hand_robot()) for angle in (9, 11)]

    assert [check(each).sound for each in made] == [True, False]
    Bare(made[0].code).run()
    with pytest.raises(Refused):
        Bare(made[1].code).run()


@settings(max_examples=100, deadline=None)
@given(bodies, rests)
def test_what_the_checker_passes_of_joints_is_never_refused_and_never_beyond_its_worst_case(body, rest):
    worst = report(body, profile=hand_robot())
    assume(worst.sound and worst.longest_ms < 60_000)
    bare = Bare(compiled(body, profile=hand_robot()).code, rest)

    assert bare.run() in (FINISHED, TIMED_OUT)

    assert not bare.fallen
    assert bare.fastest_centi_per_s <= 10_000 + 1000 // STEP_MS  # a rounded hundredth in one step
    assert bare.now_ms <= worst.longest_ms
    for told, joint in zip(bare.told, worst.joints, strict=True):
        assert all(-3000 <= angle <= 3000 for angle in told)
        later = told[1000 // STEP_MS :]  # from the first move's end on
        assert all(joint.least_centi <= angle <= joint.most_centi for angle in later)
