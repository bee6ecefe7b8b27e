r"""The law of one dimension that the whole block follows where all its parts have one Poisson ratio.

Then every matrix of (B1) is a number times C(nu), so that supports that stay where they are and displacements
prescribed all in one proportion s(t) leave the field in its elastic shape, of the modulus

.. math::  S(t) = E_0 s + c_0 \dot s + \sum_i q_i, \qquad \dot q_i = E_i \dot s - q_i / \tau_i                    (B4)

instead of E: the force is S(t) times the force of an elastic block of modulus 1 at s = 1. For s rising to 1 in t_push
and then held, each branch is c_i / t_push (1 - exp(-t / tau_i)), and decays with tau_i from t_push on.

Freed of the force at once, with the strains v_i of the branches' dashpots, the block obeys

.. math::  c_0 \dot s = -E_0 s - \sum_i E_i (s - v_i), \qquad c_i \dot v_i = E_i (s - v_i)                        (B5)

a symmetric system, as stiffness and viscosities are, whose rates are real and not negative. With c_0 = 0 the strain
jumps to where the springs balance. One branch and E0 = 0 have the rates 0, the residual deformation, and

.. math::  k = E_1 / c_0 + E_1 / c_1                                                                              (B6)

Source: derived here from (B1). Checked against a fine integration in tests/test_physics_block_law.py.
"""

from typing import Any

import numpy as np

from hil_sim.physics.block.material import BlockError, Material, viscosities
from hil_sim.physics.compiled import Array


def push_and_hold(material: Material, t: Any, t_push: float) -> Array:
    r"""Return the modulus S(t), equation (B4), while the strain rises to 1 in t_push and while it is held there.

    Parameters
    ----------
    material : Material
        Whose Poisson ratios are taken as one, with its viscosities of loading [SI]
    t : array_like
        Time since the push began; at t_push the push still lasts [s]
    t_push : float
        How long the push lasts [s]

    Returns
    -------
    array
        Modulus, of the shape of t [Pa]

    Raises
    ------
    BlockError
        t_push not positive [s]
    """
    if not t_push > 0.0:
        raise BlockError(f"t_push = {t_push:g} s, must be above 0 s")
    t = np.asarray(t, float)
    pushed, moving = np.clip(t, 0.0, t_push), (t > 0.0) & (t <= t_push)
    c0, c = viscosities(material)
    modulus: Array = material.E0 * pushed / t_push + c0 / t_push * moving
    for branch, c_i in zip(material.branches, c, strict=True):
        rate = branch.E / c_i
        modulus = modulus - c_i / t_push * np.expm1(-rate * pushed) * np.exp(-rate * (np.maximum(t, 0.0) - pushed))
    return modulus


def recovery(material: Material, t: Any, t_push: float, t_hold: float) -> Array:
    r"""Return the strain, equation (B5), of a block that was pushed to 1 in t_push, held there and freed.

    Parameters
    ----------
    material : Material
        Whose Poisson ratios are taken as one, with its viscosities of unloading after the release [SI]
    t : array_like
        Time since the release, at least 0 [s]
    t_push : float
        How long the push lasted [s]
    t_hold : float
        How long the strain was held [s]

    Returns
    -------
    array
        Strain, of the shape of t [1]
    """
    E = np.array([branch.E for branch in material.branches])
    _, c_loading = viscosities(material)
    relaxed = np.exp(-E / c_loading * t_hold) * -np.expm1(-E / c_loading * t_push) * c_loading / t_push
    v = 1.0 - relaxed / E
    rates, shapes, root = _modes(material, unloading=True)
    whole = np.r_[1.0, v] if shapes.shape[0] > E.size else v
    parts = (shapes.T @ (root * whole))[:, None] * np.exp(-rates[:, None] * np.ravel(np.asarray(t, float)))
    y = shapes @ parts / root[:, None]
    s = y[0] if shapes.shape[0] > E.size else E @ y / (material.E0 + E.sum())
    return np.asarray(s).reshape(np.shape(t))


def fastest(material: Material, unloading: bool = True) -> float:
    r"""Return the greatest of the rates at which a block without forces finds its shape, (B6) for three elements.

    Parameters
    ----------
    material : Material
        Whose Poisson ratios are taken as one [SI]
    unloading : bool
        Whether the viscosities of unloading hold [1]

    Returns
    -------
    float
        Rate, 0 for a material that stays as it is [1/s]
    """
    rates, _, _ = _modes(material, unloading)
    return float(max(rates, default=0.0))


def _modes(material: Material, unloading: bool) -> tuple[Array, Array, Array]:
    """Return rates [1/s], shapes and roots of the viscosities of (B5); the strain comes first, unless c0 is 0."""
    c0, c = viscosities(material, unloading)
    E = np.array([branch.E for branch in material.branches])
    A = np.diag(np.r_[material.E0 + E.sum(), E])
    A[0, 1:] = A[1:, 0] = -E
    if c0 > 0.0:
        c = np.r_[c0, c]
    else:
        A = A[1:, 1:] - np.outer(E, E) / A[0, 0]
    root = np.sqrt(c)
    rates, shapes = np.linalg.eigh(A / np.outer(root, root))
    return np.maximum(rates, 0.0), shapes, root
