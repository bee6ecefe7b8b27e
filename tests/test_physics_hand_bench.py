"""Fingers, servos and object over the ticks of a bench: gripping, phases, the loop of orientation, and its ends."""

from math import inf, nan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.physics.hand.fingertip import HandError, OutOfRange
from hil_sim.physics.hand.grasp import grasp
from hil_sim.physics.hand.hand import advance, hand_of
from hil_sim.physics.hand.numbers import CONTACTS
from hil_sim.physics.hand.numbers import MOTIONS as MOTION_NAMES
from tests.hand_samples import CUBE, FIRM, PAPER, joints, narrow

TICK = 0.005
REAL = CUBE._replace(contact="coulomb", mu=0.6, g=9.81, I_idle=0.1, I_stall=2.4)
MOTIONS = pytest.mark.parametrize("motion", ["quasi-static", "dynamic"])


def go(hand, start, end, seconds):
    """Move both joints from one (inward, swing) to another on a straight line [deg]."""
    for share in np.arange(1, round(seconds / TICK) + 1) * TICK / seconds:
        advance(hand, joints(*np.add(start, share * np.subtract(end, start))), TICK)


def oriented(hand, inward, targets_deg, gain, seconds):
    """Orient the object by du = -gain (target - psi) dt at 100 Hz; return its path and the swing for each target."""
    swing, runs = 0.0, []
    for target in targets_deg:
        path = []
        for _ in range(round(100 * seconds)):
            swing -= gain * (target - np.degrees(hand.pose[2])) * 0.01
            advance(hand, joints(inward, swing), 0.01)
            path.append(np.degrees(hand.pose[2]))
        runs.append((np.array(path), swing))
    return runs


def settling_s(path, target, start):
    """Return when the path is within 2 % of its way for good [s], and its overshoot [1]."""
    way = abs(target - start)
    late = np.flatnonzero(np.abs(path - target) > 0.02 * way)
    return 0.01 * (late[-1] + 2), ((path - target) * np.sign(target - start)).max() / way


def test_the_phases_of_figure_13_through_servos():
    hand, seen = hand_of(PAPER), []
    for start, end in (((0, 0), (8, 0)), ((8, 0), (8, 20)), ((8, 20), (8, -20))):
        go(hand, start, end, 1.0)
        go(hand, end, end, 0.5)
        seen.append((np.degrees(hand.pose[2]), hand.elastic, *hand.d))

    resting = grasp(PAPER, *joints(8, [0, 20, -20]))
    assert [row[0] for row in seen] == pytest.approx(np.degrees(resting.psi), abs=1e-6)
    assert [row[1] for row in seen] == pytest.approx(resting.U, rel=1e-6)
    assert seen[0][2] == pytest.approx(seen[0][3])
    assert seen[1][3] > seen[1][2]
    assert seen[2][2] > seen[2][3]


@MOTIONS
def test_an_object_is_taken_from_its_stand_swung_and_given_back(motion):
    hand = hand_of(REAL._replace(motion=motion))
    assert not hand.gripped

    go(hand, (0, 0), (2.5, 0), 1.0)
    assert hand.gripped
    go(hand, (2.5, 0), (2.5, 10), 1.0)
    go(hand, (2.5, 10), (2.5, 10), 0.3)
    assert np.degrees(hand.pose[2]) == pytest.approx(-7.78, abs=0.1)
    go(hand, (2.5, 10), (2.5, 0), 1.0)
    go(hand, (2.5, 0), (-1, 0), 1.0)
    assert not hand.gripped
    assert pytest.approx([0, 0]) == hand.N


@MOTIONS
def test_one_finger_alone_pushes_the_object_aside_on_its_stand(motion):
    hand = hand_of(REAL._replace(motion=motion))
    go(hand, (0, 0), (-0.5, 3), 0.5)
    go(hand, (-0.5, 3), (-0.5, 3), 0.3)

    assert not hand.gripped
    assert hand.pose == pytest.approx([-REAL.L * np.sin(np.radians(2.5)), REAL.L, 0], abs=2e-5)
    assert hand.d == pytest.approx([0, 0], abs=2e-5)
    assert np.abs(hand.motor).max() < 0.02


@MOTIONS
def test_an_object_that_was_let_go_aside_is_gripped_in_the_middle_again(motion):
    hand = hand_of(REAL._replace(motion=motion))
    go(hand, (0, 0), (2.5, 0), 1.0)
    go(hand, (2.5, 0), (2.5, 8), 1.0)
    go(hand, (2.5, 8), (-1, 8), 0.5)
    aside = hand.pose[0]
    go(hand, (-1, 8), (-1, 0), 1.0)
    go(hand, (-1, 0), (2.5, 0), 1.0)
    go(hand, (2.5, 0), (2.5, 0), 0.3)

    assert aside < -0.010
    assert hand.gripped
    assert hand.pose[0] == pytest.approx(0, abs=2e-3)
    assert np.abs(hand.motor).max() < 0.8 * REAL.stall


@MOTIONS
@pytest.mark.parametrize("contact", ["stick", "coulomb"])
def test_the_loop_of_orientation_settles_as_computed_before(motion, contact):
    hand = hand_of(FIRM._replace(motion=motion, contact=contact, mu=0.3), joints(2.5, 0))
    (up, swing), (down, back), (home, rest) = oriented(hand, 2.5, (5, -5, 0), 5, 4)

    assert settling_s(up, 5, 0) == (pytest.approx(0.90, rel=0.02), pytest.approx(0, abs=0.01))
    assert (swing, back, rest) == pytest.approx((-6.384, 6.384, 0), abs=2e-3)
    assert [up[-1], down[-1], home[-1]] == pytest.approx([5, -5, 0], abs=1e-4)


@pytest.mark.parametrize(("gain", "settling", "overshoot"), [(15, 0.19, 0.008), (20, 0.25, 0.052)])
def test_a_greater_gain_settles_sooner_and_overshoots(gain, settling, overshoot):
    hand = hand_of(FIRM, joints(2.5, 0))
    ((path, _),) = oriented(hand, 2.5, (5,), gain, 2)

    assert settling_s(path, 5, 0) == (pytest.approx(settling, abs=0.011), pytest.approx(overshoot, abs=3e-3))


def test_without_friction_the_authority_is_small_and_the_loop_slow():
    hand = hand_of(PAPER._replace(stall=1e3), joints(8, 0))
    (up, swing), _, _ = oriented(hand, 8, (2, -2, 0), 20, 5)

    assert settling_s(up, 2, 0)[0] == pytest.approx(1.40, abs=0.02)
    assert swing == pytest.approx(-15.22, abs=0.01)


@MOTIONS
def test_servos_that_are_too_weak_stall_at_the_object(motion):
    hand = hand_of(REAL._replace(motion=motion, stall=1.0))
    go(hand, (0, 0), (2.5, 0), 1.0)
    go(hand, (2.5, 0), (2.5, 0), 2.0)

    assert np.degrees(hand.q[0]) < 2.0
    assert hand.current == pytest.approx([2.4, 2.4], rel=1e-6)
    assert np.abs(hand.tau) == pytest.approx([1, 1], rel=1e-3)


@MOTIONS
def test_limp_fingers_are_pushed_back_until_they_bear_nothing(motion):
    hand = hand_of(REAL._replace(motion=motion), joints(2.5, 0))
    for _ in range(400):
        advance(hand, (nan, nan), TICK)

    assert not hand.gripped
    assert pytest.approx([0, 0]) == hand.N
    assert hand.current == pytest.approx([0.1, 0.1])
    assert hand.rates == pytest.approx([0, 0], abs=1e-6)


@MOTIONS
def test_a_jammed_joint_stands_and_its_current_rises_to_that_of_a_stalled_motor(motion):
    hand = hand_of(REAL._replace(motion=motion))
    hand.jam(0)
    go(hand, (0, 0), (0, -10), 0.5)
    assert hand.q[0] == 0.0
    assert hand.current[0] == pytest.approx(2.4)

    hand.jam(0, False)
    go(hand, (0, -10), (0, -10), 0.5)
    assert np.degrees(hand.q[0]) == pytest.approx(-10, abs=0.01)


@MOTIONS
def test_a_tip_pressed_to_its_edge_ends_the_run(motion):
    hand = hand_of(FIRM._replace(motion=motion))

    with pytest.raises(OutOfRange, match=r"finger [RL]: d = .* mm at theta = .* deg, at most"):
        go(hand, (0, 0), (12, 0), 1.0)


@MOTIONS
def test_the_length_of_a_tick_does_not_matter(motion):
    ends = []
    for tick in (0.001, 0.005, 0.0333):
        hand = hand_of(REAL._replace(motion=motion), joints(2.5, 0))
        for _ in range(round(0.999 / tick)):
            advance(hand, joints(2.5, 5), tick)
        ends.append(hand.pose)

    assert ends[0] == pytest.approx(ends[1], abs=1e-6)
    assert ends[2] == pytest.approx(ends[1], abs=1e-6)


@settings(deadline=None)
@given(
    inward=st.lists(st.floats(-1, 4), min_size=1, max_size=6),
    swing=st.floats(-15, 15),
    limp=st.integers(0, 12),
    contact=st.sampled_from(CONTACTS),
    motion=st.sampled_from(MOTION_NAMES),
    w=st.floats(0.005, 0.05),
)
def test_whatever_it_is_told_a_hand_says_numbers_or_out_of_range(inward, swing, limp, contact, motion, w):
    hand = hand_of(narrow(w, REAL)._replace(contact=contact, motion=motion))
    try:
        for i, turn in enumerate(inward):
            for _ in range(20):
                advance(hand, (nan, nan) if i == limp else joints(turn, swing * (i % 3 - 1)), TICK)
    except OutOfRange:
        return

    assert np.isfinite([*hand.pose, *hand.N, *hand.T, *hand.tau, *hand.motor, hand.elastic, hand.K_psi]).all()
    assert (np.abs(hand.slide) <= hand.d).all()
    assert np.abs(hand.motor).max() <= REAL.stall


def test_a_hand_is_a_function_of_its_commands_alone():
    poses = []
    for _ in range(2):
        hand = hand_of(REAL._replace(motion="dynamic"))
        go(hand, (0, 0), (2.5, 7), 0.7)
        poses.append((*hand.pose, *hand.q, *hand.motor))

    assert poses[0] == poses[1]


@pytest.mark.parametrize(
    ("commands", "dt", "text"),
    [
        ((inf, 0.0), TICK, r"finger R: command inf rad is not a finite number"),
        ((0.0, 0.0), -1.0, r"dt = -1\.0 s, must be a finite number of at least 0 s"),
        ((0.0, 0.0), nan, r"dt = nan s"),
    ],
)
def test_commands_and_times_that_cannot_be_are_refused(commands, dt, text):
    with pytest.raises(HandError, match=text):
        advance(hand_of(PAPER), commands, dt)
