"""Two hands of soft fingers for tests, and angles of their joints."""

import numpy as np

from hil_sim.physics.hand.numbers import HandNumbers

PAPER = HandNumbers(a=0.020, E=0.30e6, L=0.051, B=0.020)  # Hirai, section 3.3: 40 mm tips, an object without width
CUBE = HandNumbers(a=0.013, E=0.30e6, L=0.105, B=0.0315, w=0.037, h=0.037, m=0.030, contact="stick")  # section 3.4
FIRM = CUBE._replace(stall=1e3)  # servos that no load slows


def joints(inward_deg, swing_deg):
    """Return the angles R and L of fingers turned inward and swung together [rad]."""
    return np.radians(np.add(swing_deg, inward_deg)), np.radians(np.subtract(swing_deg, inward_deg))


def narrow(width_m, hand=CUBE):
    """Return a hand around an object of that width, its tips just touching it when upright."""
    return hand._replace(w=width_m, B=hand.a + 0.5 * width_m + hand.e)
