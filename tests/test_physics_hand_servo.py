"""The position servo: how it goes, what it bears, and what turns it while it is limp."""

from math import exp, nan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil_sim.physics.hand.fingertip import HandError
from hil_sim.physics.hand.hand import advance, hand_of
from hil_sim.physics.hand.numbers import HandNumbers, servo_of
from hil_sim.physics.hand.servo import current, drive
from tests.hand_samples import CUBE, PAPER, joints

SERVO = servo_of(PAPER)  # 60 rad/s, 7 rad/s, stalls at 3 N m
H = 1e-4


def path(c, load, seconds, q=0.0, servo=SERVO):
    """Return angle and motor torque over a time, in steps of H; load is a function of the angle."""
    v, angles, motors = 0.0, [], []
    for _ in range(round(seconds / H)):
        acceleration, motor = drive(servo, c, q, v, load(q))
        v += H * acceleration
        q += H * v
        angles.append(q)
        motors.append(motor)
    return np.array(angles), np.array(motors)


def free(q):
    """Load nothing."""
    return 0.0


def test_a_small_step_is_that_of_a_critically_damped_system_of_the_second_order():
    angles, _ = path(0.01, free, 0.1)
    t = 0.05

    assert angles[round(t / H) - 1] == pytest.approx(0.01 * (1 - (1 + 60 * t) * exp(-60 * t)), rel=0.01)
    assert angles.max() <= 0.01


def test_a_large_step_goes_at_the_rate_of_the_servo_and_does_not_overshoot():
    angles, _ = path(1.5, free, 0.6)

    assert np.diff(angles).max() / H == pytest.approx(7, rel=0.02)
    assert np.diff(angles).max() / H <= 7
    assert angles.max() <= 1.5
    assert angles[-1] == pytest.approx(1.5, abs=1e-5)


def test_a_load_below_the_stall_torque_is_borne_without_giving_way():
    angles, motors = path(0.1, lambda q: -2.4, 0.5)

    assert angles[-1] == pytest.approx(0.1, abs=1e-9)
    assert motors[-1] == pytest.approx(2.4)


def test_a_load_slows_the_servo():
    times = [np.argmax(path(0.5, lambda q, load=load: load, 1.0)[0] > 0.4) * H for load in (0.0, -1.5, -2.5)]

    assert times[0] < times[1] < times[2]


def test_against_a_spring_it_stops_where_the_load_is_its_stall_torque():
    angles, motors = path(1.0, lambda q: -20 * q, 2.0)

    assert angles[-1] == pytest.approx(3 / 20, rel=1e-6)
    assert motors[-1] == pytest.approx(3)


def test_more_load_than_the_stall_torque_drives_it_back():
    angles, motors = path(0.0, lambda q: -4.0, 0.05)

    assert (np.diff(angles) < 0).all()
    assert motors[-1] == pytest.approx(3)


@given(c=st.floats(-2, 2), q=st.floats(-2, 2), v=st.floats(-20, 20), load=st.floats(-10, 10))
def test_the_motor_never_gives_more_than_its_stall_torque(c, q, v, load):
    acceleration, motor = drive(SERVO, c, q, v, load)

    assert abs(motor) <= 3
    assert acceleration == pytest.approx((motor + load) / SERVO.J)


def test_a_limp_joint_is_driven_back_against_the_rub_of_its_gear_and_stands_without_a_load():
    driven, motors = path(nan, lambda q: 0.1, 2.0)
    left, _ = path(nan, free, 1.0, q=0.3)

    assert (np.diff(driven)[-100:] / H).mean() == pytest.approx(0.1 / SERVO.rub, rel=1e-3)
    assert (motors == 0).all()
    assert (left == 0.3).all()


def test_the_current_grows_with_the_torque_up_to_that_of_a_stalled_motor():
    assert current(0.0, 3.0, 0.1, 2.5) == pytest.approx(0.1)
    assert current(-1.5, 3.0, 0.1, 2.5) == pytest.approx(1.3)
    assert current(3.0, 3.0, 0.1, 2.5) == pytest.approx(2.5)


def test_the_servos_of_a_hand_are_as_its_numbers_say():
    servo = servo_of(HandNumbers(a=0.02, E=3e5, L=0.05, B=0.02, omega=50.0, rate=5.0, stall=2.0, J=0.004, rub=0.02))

    assert servo == (50.0, 5.0, 2.0, 0.004, 0.02)


@pytest.mark.parametrize("J", [1e-4, 1e-3, 1e-2])
def test_light_and_heavy_joints_stop_at_the_same_place_of_a_stiff_object(J):
    hand = hand_of(CUBE._replace(J=J, stall=1.0))
    for _ in range(400):
        advance(hand, joints(2.5, 0), 0.005)

    assert np.abs(hand.tau) == pytest.approx([1, 1], rel=1e-2)


def test_a_joint_that_is_too_light_is_refused_with_its_step():
    with pytest.raises(HandError, match=r"J = 1e-07 kg m\^2 is too light: it would take steps of"):
        hand_of(PAPER._replace(J=1e-7))
