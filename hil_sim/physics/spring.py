r"""Force of a shape-memory coil spring between two attachments, and its tangent.

.. math::  F = k(\xi) \max(0, L - L_A - \xi \, \Delta L) - k_s \max(0, L_s - L), \quad k = k_A + \xi (k_M - k_A)  (S1)

The coil pulls (F > 0), hangs slack (F = 0) or, pressed below its solid height, pushes (F < 0). The tangent dF/dL is
exact on each side of the two kinks. In a guide the closed winding pushes like a rod. A free one buckles under

.. math::  F_b = \frac{\pi^2 B}{L_s^2}, \quad B = \frac{4 L_s E I G}{L_w (2 G + E)}, \quad I = \frac{\pi d^4}{64}  (S2)

which is 3 mN for austenite and 1 mN for martensite in the circular robot, whose coils pull 100 to 400 mN; `k_s` is
then so small that the push stays of this order over the few millimetres that occur. Source: two-state spring of the
locomotion prototype; buckling load of a pinned helix by its bending rigidity, standard result. ASSUMED: turns do not
rub, and a buckled coil keeps to its line. The resistance follows phase and stretch:

.. math::  R = [R_A + \xi (R_M - R_A)] \, [1 + k_R \max(L - L_A, \xi \, \Delta L)]                                (S3)

with k_R = k_e d / (pi D^2 n), k_e per unit of shear strain. Source: ratio R_A / R_M of 0.92 measured on BMX150
(scientific.net/MSF.978.421). Checked in tests/test_physics_coil_spring.py.
"""

from hil_sim.physics.coilset import Coils
from hil_sim.physics.compiled import lean


@lean
def tension(i: int, L: float, xi: float, coils: Coils) -> tuple[float, float]:
    r"""Return the pull of coil i's wire and its derivative by the martensite fraction, first term of (S1).

    Parameters
    ----------
    i : int
        Number of the coil [1]
    L : float
        Length between the attachments [m]
    xi : float
        Martensite fraction, 0 <= xi <= 1 [1]
    coils : Coils
        Constants of the coils [SI]

    Returns
    -------
    tuple of float
        Pull, at least 0 [N], and its derivative by xi [N]
    """
    k = coils.k_A[i] + xi * (coils.k_M[i] - coils.k_A[i])
    x = L - coils.L_A[i] - xi * coils.dL[i]
    if x <= 0.0:
        return 0.0, 0.0
    return k * x, (coils.k_M[i] - coils.k_A[i]) * x - k * coils.dL[i]


@lean
def force_and_tangent(i: int, L: float, xi: float, coils: Coils) -> tuple[float, float]:
    r"""Return the force of coil i and its tangent, equation (S1).

    Parameters
    ----------
    i : int
        Number of the coil [1]
    L : float
        Length between the attachments [m]
    xi : float
        Martensite fraction, 0 <= xi <= 1 [1]
    coils : Coils
        Constants of the coils [SI]

    Returns
    -------
    tuple of float
        Force, positive when the coil pulls its ends together [N], and dF/dL [N/m]
    """
    k = coils.k_A[i] + xi * (coils.k_M[i] - coils.k_A[i])
    x = L - coils.L_A[i] - xi * coils.dL[i]
    y = coils.L_s[i] - L
    F = 0.0
    tangent = 0.0
    if x > 0.0:
        F += k * x
        tangent += k
    if y > 0.0:
        F -= coils.k_s[i] * y
        tangent += coils.k_s[i]
    return F, tangent


@lean
def resistance(i: int, L: float, xi: float, coils: Coils) -> float:
    r"""Return the resistance of coil i, equation (S3).

    Parameters
    ----------
    i : int
        Number of the coil [1]
    L : float
        Length between the attachments [m]
    xi : float
        Martensite fraction, 0 <= xi <= 1 [1]
    coils : Coils
        Constants of the coils [SI]

    Returns
    -------
    float
        Resistance [ohm]
    """
    # A slack coil hangs at its own length: only wire that is pulled beyond it is strained.
    free = coils.L_A[i] + xi * coils.dL[i]
    stretch: float = 1.0 + coils.k_R[i] * (max(L, free) - coils.L_A[i])
    R: float = coils.R_A[i] + xi * (coils.R_M[i] - coils.R_A[i])
    return R * stretch
