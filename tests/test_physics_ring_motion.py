"""How the ring moves when nothing touches it: order, energy, momentum and repeatability of the time steps."""

import numpy as np
import pytest

from hil_sim.physics.gauge import centre, rim_energy
from hil_sim.physics.motion import begin
from hil_sim.physics.tally import BEND_LOSS, COIL_WORK, DRAG_LOSS, REJECTED, STEPS
from tests.ring_samples import floating, lossless, oval, ring, run, squashed


def energy(body, m):
    return rim_energy(body, m.now[0]) + 0.5 * body.mass @ m.now[1] ** 2


def test_a_released_ring_converges_with_second_order_in_time():
    """Backward Euler, of first order, loses 28 % of a jump at 0.5 ms."""
    body = lossless()
    truth, *coarse = (run(body, oval(body), 0.02, step=h).now[0] for h in (1e-5, 5e-4, 2.5e-4, 1.25e-4))

    errors = [np.abs(q - truth).max() for q in coarse]

    assert errors[0] < 2e-5
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.2)


def test_a_free_ring_without_damping_keeps_its_energy_to_2_percent_in_a_second():
    body = lossless()
    m = squashed(body)
    start = energy(body, m)

    run(body, m, 1.0)

    assert start > 1e-4
    assert 0.98 < energy(body, m) / start <= 1.0001


def test_the_losses_of_bending_and_air_account_for_the_energy():
    body = ring(tau_v=1e-4, drag=1.0, damping=0.0)
    m = squashed(body)
    start = energy(body, m)
    m.tally[[BEND_LOSS, DRAG_LOSS]] = 0.0

    run(body, m, 0.1)

    lost = m.tally[BEND_LOSS] + m.tally[DRAG_LOSS]
    assert m.tally[COIL_WORK] != 0  # done while it was squashed
    assert lost > 0.5 * (start - energy(body, m))
    assert lost == pytest.approx(start - energy(body, m), rel=0.03)  # the rest is the method's own damping


def test_a_thrown_ring_keeps_its_momentum_and_spin():
    body = lossless()
    m = squashed(body)
    r = m.now[0, :-1].reshape(-1, 2) - centre(body, m.now[0])
    m.now[1, 0:-1:2] = 0.3 - 20.0 * r[:, 1]
    m.now[1, 1:-1:2] = -0.2 + 20.0 * r[:, 0]
    begin(body, 0.0, 0.0, m)
    before = momenta(body, m)

    run(body, m, 0.1)

    assert momenta(body, m)[:2] == pytest.approx(before[:2], rel=1e-6)
    assert momenta(body, m)[2] == pytest.approx(before[2], rel=1e-3)  # of second order in the step


def momenta(body, m):
    x, y = centre(body, m.now[0])
    p = (body.mass * m.now[1])[:-1].reshape(-1, 2)
    r = m.now[0, :-1].reshape(-1, 2) - [x, y]
    return *p.sum(axis=0), (r[:, 0] * p[:, 1] - r[:, 1] * p[:, 0]).sum()


def test_a_ring_in_free_fall_falls_by_half_g_t_squared():
    body = lossless()
    m = floating(body)
    begin(body, 0.0, -9.81, m)

    run(body, m, 0.2, gravity=(0.0, -9.81))

    assert centre(body, m.now[0])[1] == pytest.approx(1.0 - 0.5 * 9.81 * 0.2**2, abs=1e-9)


def test_a_run_repeats_to_the_last_bit():
    body = lossless()

    first, second = (run(body, squashed(body), 0.1) for _ in range(2))

    assert first.now.tobytes() == second.now.tobytes()
    assert first.tally.tobytes() == second.tally.tobytes()


def test_steps_are_long_at_rest_and_short_in_motion():
    body = lossless()

    rest, motion = floating(body), squashed(body)
    steps = motion.tally[STEPS]
    run(body, rest, 0.5)
    run(body, motion, 0.5)

    assert rest.tally[STEPS] < 120  # 5 ms each
    assert rest.tally[REJECTED] == 0
    assert 500 < motion.tally[STEPS] - steps < 5000  # 0.1 to 1 ms


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.9])
def test_the_method_is_stable_for_any_damping_of_its_highest_frequency(rho):
    body = lossless()
    m = squashed(body)
    start = energy(body, m)

    run(body, m, 0.1, rho=rho)

    assert 0.5 * start < energy(body, m) < 1.001 * start
