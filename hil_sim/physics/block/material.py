r"""Rheological material: a Voigt element in parallel with any number of Maxwell branches.

Stress and strain have the components x, y, z, xy. With the isotropic matrix C(nu) of Young's modulus 1,

.. math::  \sigma = E_0 C(\nu_0) \varepsilon + c_0 C(\nu_c) \dot\varepsilon + \sum_i q_i, \qquad
           \dot q_i = E_i C(\nu_i) \dot\varepsilon - q_i / \tau_i, \qquad \tau_i = c_i / E_i                      (B1)

Over a step dt in which the strain changes at a constant rate, the branches obey exactly

.. math::  q_i \leftarrow a_i q_i + g_i E_i C(\nu_i) \Delta\varepsilon, \qquad
           a_i = e^{-dt/\tau_i}, \qquad g_i = \tau_i (1 - a_i) / dt                                               (B2)

and the dashpot c_0 has the stress c_0 C \Delta\varepsilon / dt. The stress at the end of the step is thus a known one
and one proportional to the increment of strain, with a matrix that depends on nothing but dt:

.. math::  C_{dt} = E_0 C(\nu_0) + \frac{c_0}{dt} C(\nu_c) + \sum_i g_i E_i C(\nu_i)                              (B3)

E0 = 0 and one branch is the three-element rheological model, which keeps a residual deformation for ever; two
branches the five-element model; E0 > 0 creeps back to its shape. Plane strain has no strain along z. Plane stress has
no stress along z: there the branches share one strain along z, which follows from the sum of their stresses, so it is
right also where their Poisson ratios differ.

Dual modulus: dashpots may have other viscosities while the block is unloaded. ASSUMED: all of the block changes over
at once, when work is no longer done on it but got from it (`step`), so that the stiffness stays constant in between.

Source: the three-element rheological model and the dual-moduli model of Wang and Hirai are known here by abstracts
only; (B1) is the usual generalised Maxwell model (standard result), (B2) follows from its integral. Small strain.
Checked in tests/test_physics_block_material.py.
"""

from math import inf, isfinite
from typing import NamedTuple

import numpy as np

from hil_sim.physics.compiled import Array

PLANES = ("strain", "stress")


class BlockError(ValueError):
    """Something about the block that the model does not cover or that cannot be."""


class Maxwell(NamedTuple):
    """A spring and a dashpot in series."""

    E: float  # Young's modulus of the spring [Pa]
    c: float  # viscosity of the dashpot [Pa s]
    nu: float = 0.35  # Poisson ratio of both [1]
    c_unloading: float | None = None  # viscosity while the block is unloaded, None: the same [Pa s]


class Material(NamedTuple):
    """A Voigt element, of spring E0 and dashpot c0, in parallel with Maxwell branches."""

    branches: tuple[Maxwell, ...] = ()
    E0: float = 0.0  # Young's modulus of the Voigt element's spring [Pa]
    c0: float = 0.0  # viscosity of the Voigt element's dashpot [Pa s]
    nu0: float = 0.35  # Poisson ratio of the spring [1]
    nu_c: float = 0.35  # Poisson ratio of the dashpot [1]
    c0_unloading: float | None = None  # viscosity while the block is unloaded, None: the same [Pa s]
    plane: str = "strain"

    @property
    def dual(self) -> bool:
        """Whether any viscosity is another one while the block is unloaded."""
        return self.c0_unloading is not None or any(branch.c_unloading is not None for branch in self.branches)


class Update(NamedTuple):
    """What a step of a given length does to stress and history, equations (B2) and (B3)."""

    C: Array  # (4, 4) stress of an increment of strain [Pa]
    C0: Array  # (4, 4) of the Voigt element's spring [Pa]
    keep: Array  # (branches,) what is left of their stresses [1]
    gain: Array  # (branches, 4, 4) their stress of an increment of strain [Pa]


def isotropic(nu: float) -> Array:
    r"""Return the matrix C(nu) of an isotropic material of Young's modulus 1.

    Parameters
    ----------
    nu : float
        Poisson ratio, -1 < nu < 0.5 [1]

    Returns
    -------
    array (4, 4)
        Stress x, y, z, xy of strain x, y, z, xy, the last one engineering shear [1]
    """
    C = np.full((4, 4), nu)
    C[range(3), range(3)] = 1.0 - nu
    C[3] = C[:, 3] = 0.0
    C[3, 3] = 0.5 - nu
    return C / ((1.0 + nu) * (1.0 - 2.0 * nu))


def viscosities(material: Material, unloading: bool = False) -> tuple[float, Array]:
    """Return the viscosity of the Voigt element and those of the branches [Pa s]."""
    c0 = material.c0 if material.c0_unloading is None or not unloading else material.c0_unloading
    own = (each.c if each.c_unloading is None or not unloading else each.c_unloading for each in material.branches)
    return c0, np.array(list(own))


def update_of(material: Material, dt: float, unloading: bool = False) -> Update:
    r"""Return what a step does to stress and history, equations (B2) and (B3).

    Parameters
    ----------
    material : Material
        A material that passed `checked` [SI]
    dt : float
        Length of the step [s]
    unloading : bool
        Whether the viscosities of unloading hold [1]

    Returns
    -------
    Update
        Matrices and factors [SI]

    Raises
    ------
    BlockError
        dt not positive [s]
    """
    if not 0.0 < dt < inf:
        raise BlockError(f"dt = {dt:g} s, must be above 0 s and finite")
    c0, c = viscosities(material, unloading)
    E = np.array([branch.E for branch in material.branches])
    past = -dt * E / c
    keep, share = np.exp(past), np.expm1(past) / past
    C0 = material.E0 * isotropic(material.nu0)
    gain = np.array([g * E * isotropic(nu) for g, (E, _, nu, _) in zip(share, material.branches, strict=True)])
    gain = gain.reshape(-1, 4, 4)
    return Update(C0 + c0 / dt * isotropic(material.nu_c) + gain.sum(axis=0), C0, keep, gain)


def checked(material: Material) -> Material:
    """Return the material; raise BlockError for the first number, by name, value, limit and unit, that cannot be."""
    if material.plane not in PLANES:
        raise BlockError(f"plane {material.plane!r} is not known: {', '.join(PLANES)}")
    _check_number("E0", material.E0, "Pa")
    _check_number("c0", material.c0, "Pa s")
    _check_number("c0_unloading", material.c0_unloading, "Pa s")
    _check_poisson("nu0", material.nu0)
    _check_poisson("nu_c", material.nu_c)
    for i, branch in enumerate(material.branches):
        _check_number(f"branches[{i}].E", branch.E, "Pa", positive=True)
        _check_number(f"branches[{i}].c", branch.c, "Pa s", positive=True)
        _check_number(f"branches[{i}].c_unloading", branch.c_unloading, "Pa s", positive=True)
        _check_poisson(f"branches[{i}].nu", branch.nu)
    _check_stiff(material)
    return material


def _check_number(name: str, value: float | None, unit: str, positive: bool = False) -> None:
    """Raise BlockError unless the value is None or finite and not negative, or positive."""
    if value is None:
        return
    if not isfinite(value):
        raise BlockError(f"{name} = {value:g} {unit} is not a finite number")
    if value < 0.0 or (positive and value == 0.0):
        raise BlockError(f"{name} = {value:g} {unit}, {'must be above' if positive else 'at least'} 0 {unit}")


def _check_poisson(name: str, nu: float) -> None:
    """Raise BlockError for a Poisson ratio that no stable material has, or that leaves it no change of volume."""
    if not -1.0 < nu < 0.5:
        raise BlockError(f"{name} = {nu:g}, must be above -1 and below 0.5 (triangles of constant strain want 0.45)")


def _check_stiff(material: Material) -> None:
    """Raise BlockError for a material that resists nothing, in loading or unloading."""
    for unloading in (False, True):
        c0, _ = viscosities(material, unloading)
        if not (material.branches or material.E0 > 0.0 or c0 > 0.0):
            raise BlockError("E0 = 0 Pa, c0 = 0 Pa s and no Maxwell branch: the material resists nothing")
