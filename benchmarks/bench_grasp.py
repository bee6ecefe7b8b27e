"""Times the grasp of two soft fingers against scipy on the same energy, and hands in motion against the clock.

The object's rest is sought for poses all over Figure 13: ours for all at once, scipy.optimize.minimize for a part of
them, from a start at the line of the tips' centres, with and without the gradient, and each must find the same angle.
scipy asks a function in Python for every value, so one of our calls for one pose, with all that is around it, is a row
too: it is what a caller gains who has one pose. Then the experiment's hand grips and swings its cube on ticks of the
bench. Times are those of this process alone.

    python benchmarks/bench_grasp.py
"""

from collections.abc import Callable
from math import cos, pi, sin
from time import process_time

import numpy as np
from scipy.optimize import minimize

from hil_sim.physics.hand.grasp import Grasp, grasp
from hil_sim.physics.hand.grasp_tangential import carry
from hil_sim.physics.hand.hand import Hand, advance, hand_of
from hil_sim.physics.hand.numbers import CONTACTS, MOTIONS, HandNumbers

PAPER = HandNumbers(a=0.020, E=0.30e6, L=0.051, B=0.020)
CUBE = HandNumbers(a=0.013, E=0.30e6, L=0.105, B=0.0315, w=0.037, h=0.037, m=0.030, mu=0.6, g=9.81)
POSES, SOUGHT = 20_000, 200
AIM, AIM_TIMES = 20.0, 20.0  # times as fast as scipy, and as real time
TICK_S, RUN_S = 0.005, 5.0
Energy = Callable[[np.ndarray, float, float], tuple[float, np.ndarray]]


def energy(u: np.ndarray, q_r: float, q_l: float) -> tuple[float, np.ndarray]:
    """Return the energy [J] of PAPER's tips and its gradient by p, in tens of millimetres, and psi."""
    p, psi = 0.01 * u[0], u[1]
    total, slope = 0.0, np.zeros(2)
    for s, q in ((1.0, q_r), (-1.0, q_l)):
        x, y = s * PAPER.B - PAPER.L * sin(q), PAPER.L * cos(q)
        d, theta = PAPER.a - s * (cos(psi) * x + sin(psi) * y - p), psi - q
        d = max(d, 0.0)
        c, k = cos(theta), pi * PAPER.E
        N, M = k * d * d / c**2, 2 * k * d**3 * sin(theta) / (3 * c**3)
        total += k * d**3 / (3 * c**2)
        slope += 0.01 * s * N, -N * s * (cos(psi) * y - sin(psi) * x) + M
    return total, slope


def value(u: np.ndarray, q_r: float, q_l: float) -> float:
    """Return the energy alone [J]."""
    return energy(u, q_r, q_l)[0]


def angles(poses: int) -> tuple[np.ndarray, np.ndarray]:
    """Return joint angles R and L: inward from 2 to 9 degrees, swung by up to 20 [rad]."""
    inward, swing = np.linspace(2, 9, poses), 20 * np.sin(np.arange(poses))
    return np.radians(swing + inward), np.radians(swing - inward)


def timed(run: Callable[[], object], repeats: int = 5) -> tuple[float, object]:
    """Return the least processor time of some runs [s], and what the last one returned."""
    took, result = [], None
    for _ in range(repeats):
        start = process_time()
        result = run()
        took.append(process_time() - start)
    return min(took), result


def sought(q_r: np.ndarray, q_l: np.ndarray, method: str, gradient: bool) -> np.ndarray:
    """Return psi for each pose as scipy finds it [rad]."""
    found = []
    for r, left in zip(q_r, q_l, strict=True):
        along = (2 * PAPER.B - PAPER.L * (sin(r) - sin(left)), PAPER.L * (cos(r) - cos(left)))
        beta = np.arctan2(along[1], along[0])
        middle = (-0.5 * PAPER.L * (sin(r) + sin(left)), 0.5 * PAPER.L * (cos(r) + cos(left)))
        start = (100 * (cos(beta) * middle[0] + sin(beta) * middle[1]), beta)
        options = {"gtol": 1e-9} if method == "BFGS" else {"xatol": 1e-9, "fatol": 1e-14}
        best = minimize(energy if gradient else value, start, (r, left), method, gradient, options=options)
        found.append(best.x[1])
    return np.array(found)


def table() -> None:
    """Print the times of a pose, ours and scipy's."""
    q_r, q_l = angles(POSES)
    grasp(PAPER, q_r, q_l)
    own_s, result = timed(lambda: grasp(PAPER, q_r, q_l))
    assert isinstance(result, Grasp)
    own_us = 1e6 * own_s / POSES
    single_s, _ = timed(lambda: [grasp(PAPER, r, left) for r, left in zip(q_r[:SOUGHT], q_l[:SOUGHT], strict=True)])
    single_us = 1e6 * single_s / SOUGHT
    print(f"{'rest of a pose':36}{'us':>10}{'at once':>10}{'one by one':>12}{'apart deg':>12}   (ours: times as fast)")
    print(f"{f'own, {POSES} poses at once':36}{own_us:10.3f}")
    print(f"{'own, one pose a call':36}{single_us:10.1f}{single_us / own_us:9.0f}x")
    few = slice(None, None, POSES // SOUGHT)
    for name, method, gradient in (
        ("scipy BFGS, gradient given", "BFGS", True),
        ("scipy BFGS", "BFGS", False),
        ("scipy Nelder-Mead", "Nelder-Mead", False),
    ):
        scipy_s, psi = timed(lambda m=method, g=gradient: sought(q_r[few], q_l[few], m, g), 2)
        us = 1e6 * scipy_s / SOUGHT
        apart = np.degrees(np.abs(np.asarray(psi) - result.psi[few])).max()
        print(f"{name:36}{us:10.1f}{us / own_us:9.0f}x{us / single_us:11.0f}x{apart:12.1e}")
    counts = np.bincount(result.iterations)
    print(
        "Newton steps a pose: " + ", ".join(f"{n} for {share:.1%}" for n, share in enumerate(counts / POSES) if share)
    )
    print(f"aim: at least {AIM:.0f} times as fast as scipy, one by one too")


def followed() -> None:
    """Print what a step of a grip with friction takes."""
    swing = 10 * np.sin(np.linspace(0, 12 * pi, 4001))
    q = np.radians(swing + 2.5), np.radians(swing - 2.5)
    for contact in ("stick", "coulomb"):
        hand = CUBE._replace(contact=contact, mu=0.15)
        carry(hand, *q)
        took_s, held = timed(lambda hand=hand: carry(hand, *q))
        steps = f"{held.iterations.mean():.1f} Newton steps"
        print(f"{f'a step with friction, {contact}':36}{1e6 * took_s / 4001:10.3f}    {steps}")


def runs() -> None:
    """Print how much faster than real time hands are advanced, tick by tick."""
    print(f"\n{'a hand on ticks of 5 ms':36}{'x real time':>12}")
    for motion in MOTIONS:
        for contact in CONTACTS:
            hand = hand_of(CUBE._replace(contact=contact, motion=motion))
            advance(hand, (0.0, 0.0), TICK_S)
            took_s, _ = timed(lambda hand=hand: swung(hand), 3)
            print(f"{f'{motion}, {contact}':36}{RUN_S / took_s:12.0f}")
    print(f"aim: at least {AIM_TIMES:.0f} times real time")


def swung(hand: Hand) -> None:
    """Grip within a second, or hold, and swing by 10 degrees at a hertz."""
    for i in range(round(RUN_S / TICK_S)):
        t = (i + 1) * TICK_S
        inward, swing = 2.5 * min(1.0, t), 10 * sin(2 * pi * max(0.0, t - 1.0)) if t > 1 else 0.0
        advance(hand, (np.radians(swing + inward), np.radians(swing - inward)), TICK_S)


def main() -> None:
    """Print the tables."""
    table()
    followed()
    runs()


if __name__ == "__main__":
    main()
