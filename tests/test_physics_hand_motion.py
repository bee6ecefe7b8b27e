"""An object in motion between two soft fingers: energy, damping, steps, falling, and what is too light."""

from math import nan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.physics.hand.fingertip import HandError
from hil_sim.physics.hand.grasp_tangential import carry
from hil_sim.physics.hand.hand import advance, hand_of
from hil_sim.physics.hand.state import PSI, RATES, X, Y
from tests.hand_samples import CUBE, FIRM, joints

FREE = CUBE._replace(motion="dynamic", tau=0.0, tau_t=0.0)
DAMPED = FIRM._replace(motion="dynamic")
LIMP = (nan, nan)


def kicked(numbers, spin=2.0, step_s=250e-6, push=(0.0, 0.0)):
    """Return a hand whose joints are fixed at 2.5 deg inward and whose object has just been kicked."""
    hand = hand_of(numbers, joints(2.5, 0))
    hand.step = step_s
    hand.jam(0)
    hand.jam(1)
    hand.state[RATES + PSI] = spin
    hand.state[[RATES + X, RATES + Y]] = push
    return hand


def total(hand):
    """Return elastic, kinetic and gravity energy [J]."""
    return hand.elastic + hand.kinetic + hand.gravity


def drift(contact, step_s):
    """Return the greatest change of the energy over a second, of the whole [1]."""
    hand = kicked(FREE._replace(contact=contact), step_s=step_s)
    start, worst = total(hand), 0.0
    for _ in range(200):
        advance(hand, LIMP, 0.005)
        worst = max(worst, abs(total(hand) - start))
    return worst / start


@pytest.mark.parametrize("contact", ["stick", "frictionless"])
def test_without_damping_a_kicked_object_keeps_its_energy(contact):
    coarse, fine = drift(contact, 250e-6), drift(contact, 125e-6)

    assert coarse < 1e-5
    assert fine < coarse / 10


def test_with_gravity_the_energy_is_kept_too():
    hand = kicked(FREE._replace(g=9.81))
    start = total(hand)
    advance(hand, LIMP, 0.5)

    assert total(hand) == pytest.approx(start, rel=1e-5)


@settings(deadline=None)
@given(spin=st.floats(-8, 8), x=st.floats(-0.3, 0.3), y=st.floats(-0.3, 0.3), mu=st.floats(0.1, 0.8))
def test_damping_and_slip_only_take_energy(spin, x, y, mu):
    hand = kicked(DAMPED._replace(contact="coulomb", mu=mu), spin, push=(x, y))
    energies = []
    for _ in range(40):
        advance(hand, LIMP, 0.00025)
        energies.append(total(hand))

    assert (np.diff(energies) < 1e-7).all()


@pytest.mark.parametrize(
    ("contact", "mu", "h"), [("stick", 0, 0.037), ("coulomb", 0.05, 0.012), ("frictionless", 0, 0)]
)
def test_motors_do_all_the_work_that_is_stored_or_lost(contact, mu, h):
    """Over a grip, a swing and a release, also where the object slides out; within what a short step errs by."""
    hand = hand_of(CUBE._replace(motion="dynamic", contact=contact, mu=mu, h=h, g=9.81))
    hand.step, lost = 5e-5, []
    start, work, told = total(hand), 0.0, np.zeros(2)
    for share in np.linspace(0, 1, 12_000):
        before, motor, last = hand.q, hand.motor, told
        told = np.array(joints(2.5 * np.sin(6 * share), 8 * np.sin(15 * share)))
        advance(hand, told, hand.step)
        motor += hand.servo.J * hand.servo.omega**2 * (told - last)  # as the step begins
        work += float((0.5 * (motor + hand.motor) * (hand.q - before)).sum())
        lost.append(work - total(hand) + start - 0.5 * hand.servo.J * (hand.rates**2).sum())

    assert lost[-1] > 1e-3
    assert (np.maximum.accumulate(lost) - lost).max() < 3e-4


def test_a_damped_object_comes_to_rest_where_it_was():
    hand = kicked(DAMPED)
    before = hand.pose
    advance(hand, LIMP, 1.0)

    assert hand.pose == pytest.approx(before, abs=1e-9)
    assert hand.kinetic < 1e-20


def test_a_fast_transient_is_right_to_a_thousandth_at_its_step():
    paths = []
    for step_s in (250e-6, 31.25e-6):
        hand, path = kicked(DAMPED, step_s=step_s), []
        for _ in range(20):
            advance(hand, LIMP, 0.0005)
            path.append(hand.pose[2])
        paths.append(np.array(path))

    assert np.abs(paths[0] - paths[1]).max() < 1e-3 * np.abs(paths[1]).max()


def test_a_slow_swing_is_a_row_of_rests():
    hand = hand_of(DAMPED, joints(2.5, 0))
    for share in np.linspace(0, 1, 2000):
        advance(hand, joints(2.5, 5 * (1 - np.cos(np.pi * share))), 0.005)
    resting = carry(CUBE, *np.array([joints(2.5, 0), hand.q]).T)

    assert np.degrees(hand.pose[2]) == pytest.approx(np.degrees(resting.psi[1]), abs=1e-4)
    assert np.degrees(hand.pose[2]) == pytest.approx(-7.775, abs=2e-3)
    assert hand.K_psi == pytest.approx(resting.K_psi[1], rel=2e-3)


def test_without_friction_a_slow_swing_is_a_row_of_rests_too():
    still, moving = (
        hand_of(FIRM._replace(contact="frictionless", motion=motion), joints(2.5, 0))
        for motion in ("quasi-static", "dynamic")
    )
    for hand in (still, moving):
        for share in np.linspace(0, 1, 400):
            advance(hand, joints(2.5, 5 * (1 - np.cos(np.pi * share))), 0.005)

    assert moving.pose == pytest.approx(still.pose, abs=2e-5)
    assert moving.along == "undetermined"


@pytest.mark.parametrize("contact", ["stick", "coulomb", "frictionless"])
def test_the_object_moves_at_its_speed(contact):
    hand = hand_of(DAMPED._replace(contact=contact, mu=0.1), joints(2.5, 0))
    poses, speeds = [], []
    for share in np.linspace(0, 1, 300):
        advance(hand, joints(2.5, 10 * share), 0.0005)
        poses.append(hand.pose)
        speeds.append(hand.state[RATES + X : RATES + PSI + 1].copy())
    moved = (np.array(poses)[2:] - np.array(poses)[:-2]) / 0.001

    assert moved == pytest.approx(np.array(speeds)[1:-1], abs=0.02 * np.abs(moved).max())


def test_an_object_that_its_grip_does_not_carry_falls_and_the_stand_has_it_at_rest_again():
    hand = hand_of(DAMPED._replace(contact="coulomb", mu=0.6, g=9.81), joints(2.5, 0))
    heights = []
    for inward in np.linspace(2.5, -1, 60):
        advance(hand, joints(inward, 0), 0.005)
        heights.append(hand.pose[1])
    advance(hand, joints(-1, 0), 0.5)

    assert not hand.gripped
    assert min(heights) < heights[0] - 0.001
    assert hand.kinetic == 0.0


def test_what_is_too_light_for_motion_is_refused_with_its_step():
    with pytest.raises(HandError, match=r"of m = 1e-09 kg and .* is too light for motion 'dynamic'"):
        hand_of(DAMPED._replace(m=1e-9))


def test_motion_needs_mass_and_extent():
    with pytest.raises(HandError, match=r"motion 'dynamic' needs an object of some mass and extent: m = 0 kg"):
        hand_of(DAMPED._replace(m=0.0))
