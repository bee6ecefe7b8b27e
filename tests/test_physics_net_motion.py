"""How a sphere moves when nothing touches it: order in time, energy, momentum and repeatability."""

import numpy as np
import pytest

from hil_sim.physics.flight import no_flight
from hil_sim.physics.net.gauge import attitude, centre, kinetic
from hil_sim.physics.net.motion import march
from hil_sim.physics.net.rotation import matrix, quaternion, straighten
from hil_sim.physics.state import method_of
from hil_sim.physics.tally import BEND_LOSS, DRAG_LOSS, ELASTIC, STEP
from tests.net_samples import PLANE, exponential, placed, ringing, run, sphere, started

HIGH = 1.0  # [m] above the ground
SPEED = 1.0  # [m/s] about half of what a jump takes off with


def energy(sample):
    """Return kinetic and elastic energy [J]."""
    return kinetic(sample.net, sample.m.now) + sample.m.tally[ELASTIC]


def momenta(sample):
    """Return momentum and angular momentum about the origin."""
    net, m = sample
    p = net.mass[:, None] * m.now.v[:, :3]
    turning = np.cross(m.now.x, p) + net.inertia[:, None] * m.now.v[:, 3:]
    return p.sum(axis=0), turning.sum(axis=0)


def thrown(net):
    """Return a ringing sphere that flies and spins."""
    sample = ringing(net, SPEED)
    v, spin = sample.m.now.v, np.array([3.0, -20.0, 8.0])
    v[:, :3] += np.cross(spin, sample.m.now.x - [0.0, 0.0, HIGH])
    v[:, :3] += [0.3, -0.2, 0.1]
    v[:, 3:] += spin
    return started(sample)


def test_a_released_sphere_converges_with_second_order_in_time():
    """Backward Euler, of first order, loses 28 % of a jump at 0.5 ms."""
    net = sphere()
    truth, coarse, fine = (run(ringing(net, SPEED), 8e-3, step=h).now.x for h in (5e-6, 8e-4, 5e-5))

    errors = [np.abs(x - truth).max() for x in (coarse, fine)]

    assert errors[0] < 2e-4
    assert np.log2(errors[0] / errors[1]) / 4.0 == pytest.approx(2.0, abs=0.25)  # the mean of four halvings


def test_a_free_sphere_without_damping_keeps_its_energy():
    sample = ringing(sphere(), SPEED)
    before = energy(sample)

    run(sample, 0.2)

    assert before > 1e-4
    assert 0.95 < energy(sample) / before <= 1.001  # the rest is the method's own damping of quick modes


def test_losses_of_bending_and_air_account_for_the_energy():
    sample = ringing(sphere(tau_v=3e-4, drag=1.0), SPEED)
    before = energy(sample)

    run(sample, 0.1, method=method_of(0.8, tolerance=1e-6, share=1e-6))

    lost = sample.m.tally[BEND_LOSS] + sample.m.tally[DRAG_LOSS]
    assert lost > 0.3 * (before - energy(sample))
    assert lost == pytest.approx(before - energy(sample), abs=0.01 * before)


def test_a_thrown_sphere_keeps_its_momentum_and_spin():
    sample = thrown(sphere())
    before = momenta(sample)

    run(sample, 0.1)

    after = momenta(sample)
    assert after[0] == pytest.approx(before[0], rel=1e-5)
    assert after[1] == pytest.approx(before[1], rel=2e-3, abs=2e-3 * np.abs(before[1]).max())  # of the second order


def test_a_falling_sphere_falls_as_a_stone():
    sample = placed(sphere(), HIGH)

    run(started(sample, (0.0, -9.81)), 0.2, g=(0.0, -9.81))

    assert centre(sample.net, sample.m.now.x, 2) == pytest.approx(HIGH - 0.5 * 9.81 * 0.2**2, abs=1e-6)


def test_a_run_repeats_bit_by_bit():
    first, second = (run(thrown(sphere()), 0.02) for _ in range(2))

    assert np.array_equal(first.now.x, second.now.x)
    assert np.array_equal(first.now.R, second.now.R)
    assert first.tally[STEP] == second.tally[STEP]


def test_a_march_ends_at_the_very_time_that_was_asked_for():
    sample = thrown(sphere())

    march(sample.net, PLANE, (0.0, 0.0), method_of(0.5, 4.5e-6), sample.m, no_flight(), 0.0123)

    assert sample.m.tally[0] == pytest.approx(0.0123, abs=1e-12)


def test_rotations_stay_orthogonal():
    sample = thrown(sphere())

    run(sample, 0.1)

    for R in sample.m.now.R:
        assert np.abs(R @ R.T - np.eye(3)).max() < 1e-12


def test_a_bent_matrix_is_made_a_rotation_again():
    R = np.array([matrix(0.3, -1.0, 2.0)]) * (1.0 + 1e-4)

    straighten(R)

    assert R[0] == pytest.approx(matrix(0.3, -1.0, 2.0), abs=1e-7)


def test_the_attitude_of_a_turned_and_squashed_sphere_is_its_turn():
    sample, turn, found = placed(sphere()), matrix(0.5, 0.2, -0.4), np.zeros((3, 3))

    attitude(sample.net, sample.m.now.x * [1.3, 1.3, 0.4] @ turn.T, found)

    assert found == pytest.approx(turn, abs=1e-9)


def test_yaw_turns_left_pitch_forward_down_and_roll_to_the_right():
    assert matrix(np.pi / 2, 0, 0) @ [1, 0, 0] == pytest.approx([0, 1, 0])
    assert matrix(0, np.pi / 2, 0) @ [1, 0, 0] == pytest.approx([0, 0, -1])
    assert matrix(0, 0, np.pi / 2) @ [0, 1, 0] == pytest.approx([0, 0, 1])


def test_a_quaternion_says_the_same_as_its_matrix():
    spin = np.array([0.4, -1.1, 0.7])

    w, x, y, z = quaternion(exponential(spin))

    t = np.linalg.norm(spin)
    assert w == pytest.approx(np.cos(t / 2))
    assert [x, y, z] == pytest.approx(np.sin(t / 2) * spin / t)
