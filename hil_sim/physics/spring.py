r"""Force of a shape-memory coil spring between two attachments, and its tangent.

.. math::  F = k(\xi) \max(0, L - L_A - \xi \, \Delta L) - k_s \max(0, L_s - L), \quad k = k_A + \xi (k_M - k_A)  (S1)

The coil pulls (F > 0), hangs slack (F = 0) or, pressed below its solid height `L_s = (n + 1) d`, pushes like a rod (F
< 0). The tangent dF/dL is exact on each side of the two kinks. Source: two-state spring of the locomotion prototype;
(S1) second term derived here, ASSUMED: a closed winding neither buckles nor rubs. Shear strain for the resistance:
gamma = d (L - L_A)/(pi D^2 n).

.. math::  R = [R_A + \xi (R_M - R_A)] \, [1 + k_R \max(L - L_A, \xi \, \Delta L)]                                (S2)

Source: resistance ratio 0.92 measured on BMX150 (scientific.net/MSF.978.421). Checked in
tests/test_physics_coil_spring.py.
"""

from hil_sim.physics.coilset import Coils
from hil_sim.physics.compiled import kernel


@kernel
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


@kernel
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


@kernel
def resistance(i: int, L: float, xi: float, coils: Coils) -> float:
    r"""Return the resistance of coil i, equation (S2).

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
