"""Where a grip ends: an object that slides out, what it takes to grip it again, and joints that stop at once."""

from math import nan

import numpy as np
import pytest

from hil_sim.physics.hand.hand import advance, hand_of
from hil_sim.physics.hand.state import Y
from tests.hand_samples import CUBE, FIRM, joints

TICK = 0.005
MOTIONS = pytest.mark.parametrize("motion", ["quasi-static", "dynamic"])
HEAVY = CUBE._replace(contact="coulomb", mu=0.15, m=0.5, g=9.81, I_stall=2.5)


def go(hand, start, end, seconds):
    """Move both joints from one (inward, swing) to another on a straight line [deg]."""
    for share in np.arange(1, round(seconds / TICK) + 1) * TICK / seconds:
        advance(hand, joints(*np.add(start, share * np.subtract(end, start))), TICK)


def dropped(motion):
    """Return a hand that has opened so far that its object slid out, its fingers still closed by a degree."""
    hand = hand_of(HEAVY._replace(motion=motion))
    go(hand, (0, 0), (3, 0), 0.6)
    assert hand.gripped
    go(hand, (3, 0), (1, 0), 0.6)
    return hand


@MOTIONS
def test_an_object_that_slides_out_is_no_wall_for_the_fingers(motion):
    hand = dropped(motion)
    assert not hand.gripped
    assert hand.pose[1] < HEAVY.L - 0.005

    go(hand, (1, 0), (2, 10), 0.5)
    go(hand, (2, 10), (2, 10), 0.2)

    assert pytest.approx([0, 0]) == hand.N
    assert np.degrees(hand.q) == pytest.approx([12, 8], abs=0.01)
    assert hand.current.max() < 0.1


@MOTIONS
def test_a_tip_comes_back_on_its_face_from_the_front(motion):
    hand = dropped(motion)
    go(hand, (1, 0), (-0.5, 0), 0.2)
    hand.state[Y] = HEAVY.L
    go(hand, (-0.5, 0), (2.5, 0), 0.5)

    assert hand.N.min() > 1
    assert hand.d.min() > 0.004


@MOTIONS
def test_no_load_appears_at_a_tip_that_went_over_the_end_and_comes_back_from_the_side(motion):
    hand = dropped(motion)
    hand.state[Y] = HEAVY.L
    go(hand, (1, 0), (1, 5), 0.2)

    assert pytest.approx([0, 0]) == hand.N
    assert hand.elastic == 0.0


@MOTIONS
def test_an_object_given_back_where_it_hangs_tilted_is_gripped_there_again(motion):
    hand = hand_of(FIRM._replace(motion=motion, contact="coulomb", mu=0.6, g=9.81))
    go(hand, (0, 0), (2.5, 0), 0.5)
    go(hand, (2.5, 0), (2.5, 10), 0.5)
    go(hand, (2.5, 10), (-2, 10), 0.1)
    assert not hand.gripped
    stood = hand.pose

    go(hand, (-2, 10), (-2, 10), 0.3)
    assert hand.pose == pytest.approx(stood)
    go(hand, (-2, 10), (2.5, 10), 0.5)
    assert hand.gripped
    assert hand.pose[:2] == pytest.approx(stood[:2], abs=2e-3)


@MOTIONS
def test_a_joint_that_jams_while_it_turns_stands_at_once_and_starts_from_rest(motion):
    hand = hand_of(CUBE._replace(motion=motion))
    go(hand, (0, 0), (-5, 0), 0.05)
    assert hand.rates[0] < -0.5
    hand.jam(0)
    stood = hand.q[0]

    advance(hand, joints(0, -20), TICK)
    assert (hand.q[0], hand.rates[0]) == (stood, 0.0)
    hand.jam(0, False)
    advance(hand, (nan, nan), TICK)
    assert hand.q[0] == stood
