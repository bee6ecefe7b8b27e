r"""The highest flight of a body: when it left the ground, how fast, and which elastic energy was let go for it.

Fed with every turn of body and coils of a ring, every step of a sphere, 0.1 ms apart in a snap. Take-off is the last
time that anything touches; what was released is the elastic energy at its greatest in the last 50 to 100 ms before,
less that at take-off,

.. math::  E_r = \max_{t_0 - \tau < t \le t_0} U(t) - U(t_0), \qquad E_l = E_r - m g (h - z_r)                  (J1)

and lost is what of it did not lift the centre of mass from its height z_r at that greatest energy to the top h of the
flight: it went to bending, vibration and the air. Coils that still pull take part in E_l. Derived here; checked in
tests/test_physics_ring_jump.py.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean

LEFT = 1e-3  # [m] how high the lowest point must rise for a flight to count
HALF = 0.05  # [s] the greatest energy is kept in two halves of this length
# Entries: this contact: greatest energy so far, and in this and the last half with the heights of the centre of mass;
STORED, HALF_BEGAN, NEW, NEW_HEIGHT, OLD, OLD_HEIGHT = range(6)
# this flight: time, speed and energy at take-off and the like of the store before it; the same of the highest flight.
HIGH, T, SPEED, LOADED, RELEASED, FROM = range(6, 12)
BEST_HIGH, BEST_T, BEST_SPEED, BEST_LOADED, BEST_RELEASED, BEST_FROM = range(12, 18)
FLIGHT_ROWS = 18


@lean
def watch_flight(flight: Array, t: float, touches: bool, lowest: float, z: float, v: float, U: float) -> None:
    r"""Bring the record of the highest flight up to date.

    Parameters
    ----------
    flight : array (18,)
        The record, zeros at first [SI]
    t : float
        Time [s]
    touches : bool
        Whether the ground pushes on anything [1]
    lowest : float
        Height of the lowest point above the ground [m]
    z, v : float
        Height of the centre of mass, and how fast it rises [m, m/s]
    U : float
        Elastic energy [J]
    """
    if touches:
        flight[STORED] = max(flight[STORED], U)
        if t - flight[HALF_BEGAN] > HALF:
            flight[OLD], flight[OLD_HEIGHT] = flight[NEW], flight[NEW_HEIGHT]
            flight[NEW], flight[HALF_BEGAN] = 0.0, t
        if flight[NEW] <= U:
            flight[NEW], flight[NEW_HEIGHT] = U, z
        newer = flight[NEW] > flight[OLD]
        flight[HIGH], flight[T], flight[SPEED], flight[LOADED] = z, t, v, flight[STORED]
        flight[RELEASED] = max(flight[NEW], flight[OLD]) - U
        flight[FROM] = flight[NEW_HEIGHT] if newer else flight[OLD_HEIGHT]
        return
    flight[HIGH] = max(flight[HIGH], z)
    if lowest > LEFT and flight[HIGH] > flight[BEST_HIGH]:
        for row in range(HIGH, BEST_HIGH):
            flight[BEST_HIGH + row - HIGH] = flight[row]


def jump_of(flight: Array, weight: float, standing: float) -> dict[str, float] | None:
    """Return the highest flight in the units of a report; None when the body never left the ground.

    `weight` is that of the body [N], `standing` the height of its centre of mass at the start [m].
    """
    if not flight[BEST_HIGH]:
        return None
    lifted = weight * (flight[BEST_HIGH] - flight[BEST_FROM])
    return {
        "stored_mj": 1e3 * float(flight[BEST_LOADED]),
        "released_mj": 1e3 * float(flight[BEST_RELEASED]),
        "takeoff_m_per_s": float(flight[BEST_SPEED]),
        "takeoff_s": float(flight[BEST_T]),
        "apex_mm": 1e3 * float(flight[BEST_HIGH] - standing),
        "losses_mj": 1e3 * float(flight[BEST_RELEASED] - lifted),
    }


def no_flight() -> Array:
    """Return the record of a body that has not flown yet."""
    return np.zeros(FLIGHT_ROWS)
