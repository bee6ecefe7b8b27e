r"""What theory says of three equal thin hoops at right angles that are joined where they cross; derived here.

Two opposite crossings under loads P along their axis: symmetry leaves bending of each hoop in its own plane, without
turn of any crossing. Each of the two hoops through the poles bears P/2 and an inward pair Q at the equator, where the
third hoop holds it at four points. With a and b the shortening along and the lengthening across of a ring per load,

.. math:: \delta = \frac P2 \Big(a - \frac{b^2}{2a - b}\Big), \quad
          a = \Big(\frac\pi4 - \frac2\pi\Big)\frac{R^3}{EI} + \frac\pi4 \frac R{EA}, \quad
          b = \Big(\frac2\pi - \frac12\Big)\frac{R^3}{EI} - \frac12\frac R{EA}    (S1)

Without stretch this is 0.016402 P R^3/EI: a ninth of one ring. The squash mode has the same symmetry, with the dynamic
flexibility of a ring without stretch, a sum over its modes n = 2, 4, 6, ... with stiffness pi EI (n^2 - 1)^2/R^3 and
mass m/2 (1 + 1/n^2).
"""

import numpy as np
from scipy.optimize import brentq

from hil_sim.physics.bodies import SphereNumbers

MODES = 2.0 * np.arange(1, 400)


def pole_compliance(numbers: SphereNumbers) -> float:
    """Return shortening of the axis per small load on its poles, equation (S1) [m/N]."""
    bend, stretch = numbers.R**3 / numbers.EI, numbers.R / numbers.EA
    a = (np.pi / 4 - 2 / np.pi) * bend + np.pi / 4 * stretch
    b = (2 / np.pi - 1 / 2) * bend - stretch / 2
    return (a - b**2 / (2 * a - b)) / 2


def squash_frequency(numbers: SphereNumbers) -> float:
    """Return the lowest frequency at which one axis shortens while the two others lengthen [Hz]."""
    first = np.sqrt(numbers.EI / (numbers.m / 3 / (2 * np.pi * numbers.R))) / numbers.R**2
    return float(brentq(imbalance, first, 8 * first, args=(numbers,))) / (2 * np.pi)


def imbalance(omega: float, numbers: SphereNumbers) -> float:
    """Return the determinant of the balance of forces at the crossings; it is zero at a frequency [rad/s]."""
    stiff = np.pi * numbers.EI * (MODES**2 - 1) ** 2 / numbers.R**3
    heavy = numbers.m / 3 / 2 * (1 + 1 / MODES**2)
    own = np.sum(2 / (stiff - omega**2 * heavy))
    across = np.sum(2 * np.cos(MODES * np.pi / 2) / (stiff - omega**2 * heavy))
    inert = omega**2 * numbers.m_joints / 6
    hoop = np.linalg.inv([[own, across], [across, own]])  # forces at pole and equator for their radial places
    return float(np.linalg.det([
        [2 * hoop[0, 0] - inert, 2 * hoop[0, 1]],
        [hoop[1, 0], hoop[1, 1] + 1 / (own + across) - inert],
    ]))  # fmt: skip
