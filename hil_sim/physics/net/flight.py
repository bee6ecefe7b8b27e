"""Watches for jumps: what was stored before one, when and how fast the body left the ground, and how high it came.

The energy that counts as released is the elastic energy at its greatest before the flight less that at take-off; what
of it is neither speed nor height of the centre of mass at take-off was lost or is left as vibration.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.net.gauge import centre, rise_rate
from hil_sim.physics.net.mesh import Net
from hil_sim.physics.net.state import CONTACTS, ELASTIC, TIME, Motion

# Entries of `flight`: greatest elastic energy since the last landing and height of the centre of mass then; the same
# for the present flight and its take-off; the highest flight so far.
STORED, STORED_Z, FLYING, NOW, BEST, ROW = 0, 1, 2, 3, 9, 6
# Entries of a flight: energy stored, height then, energy at take-off, height, time and speed of take-off; then apex.
E_0, Z_0, E_1, Z_1, T_1, V_1 = range(6)
APEX = 15
FLIGHT_ENTRIES = 16


def no_flight() -> Array:
    """Return the record of a body that has not jumped."""
    flight = np.zeros(FLIGHT_ENTRIES)
    flight[APEX] = -np.inf
    return flight


@lean
def follow(net: Net, m: Motion, flight: Array) -> None:
    """Bring the record up to date after an accepted step."""
    z = centre(net, m.now.x, 2)
    if m.tally[CONTACTS] > 0.0:
        if flight[FLYING] > 0.0:
            flight[FLYING] = flight[STORED] = 0.0
        if m.tally[ELASTIC] > flight[STORED]:
            flight[STORED], flight[STORED_Z] = m.tally[ELASTIC], z
        return
    if flight[FLYING] == 0.0:
        flight[FLYING] = 1.0
        take_off(net, m, flight, z)
    if z > flight[APEX]:
        flight[APEX] = z
        for i in range(ROW):
            flight[BEST + i] = flight[NOW + i]


@lean
def take_off(net: Net, m: Motion, flight: Array, z: float) -> None:
    """Note where a flight begins."""
    flight[NOW + E_0], flight[NOW + Z_0] = flight[STORED], flight[STORED_Z]
    flight[NOW + E_1], flight[NOW + Z_1] = m.tally[ELASTIC], z
    flight[NOW + T_1], flight[NOW + V_1] = m.tally[TIME], rise_rate(net, m.now.v)
