r"""What a set of shape-memory coils is made of, and the state each of them is in.

`CoilNumbers` holds the material and the winding of one kind of coil; `coils_of` turns it into the arrays that the
kernels read:

.. math::  k = \frac{G d^4}{8 D^3 n}, \quad \Delta L = \frac{\pi D^2 n \gamma}{d}, \quad L_A = n d, \quad
           L_s = L_A + d                                                                                          (C1)

.. math::  c_F = \frac{\pi d^3}{8 D} \, c_\tau, \quad m = \rho \frac{\pi d^2}{4} L_w, \quad L_w = \pi D n         (C2)

.. math::  R_A = \rho_A L_w / A_w, \quad R_M = \rho_M L_w / A_w, \quad A_w = \pi d^2 / 4                          (C3)

Sources: spring and shear stress of a helical coil, standard result; transformation stretch and stress shift derived
from the coil measured by Kolyvas et al., JIMSS 2018; wire figures from the Flexinol sheets. Temperatures are in
degrees Celsius throughout: only differences occur, there is no radiation term. ASSUMED: the wire is as long as its
closed winding, L_w = pi D n. Checked in tests/test_physics_coil_spring.py and tests/test_physics_coil_heat.py.
"""

from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np

from hil_sim.physics.compiled import Array


@dataclass(frozen=True)
class CoilNumbers:
    """One kind of coil, in SI units: winding, mechanics, phase change, heat and resistance."""

    d: float  # wire diameter [m]
    D: float  # mean diameter of the winding [m]
    n: float  # active turns [1]
    G_A: float  # shear modulus, austenite [Pa]
    G_M: float  # shear modulus, martensite (secant) [Pa]
    gamma: float  # transformation shear strain [1]
    k_s: float  # stiffness of the closed winding, one-sided, see spring.py [N/m]
    A_s: float  # austenite begins on heating, unloaded [degC]
    A_f: float  # austenite complete [degC]
    M_s: float  # martensite begins on cooling [degC]
    M_f: float  # martensite complete [degC]
    c_tau: float  # shear stress that shifts them by one kelvin [Pa/K]
    rho: float  # density [kg/m3]
    c: float  # specific heat [J/(kg K)]
    H: float  # latent heat of the phase change [J/kg]
    h: float  # heat transfer coefficient on the wire surface [W/(m2 K)]
    rho_A: float  # resistivity, austenite [ohm m]
    rho_M: float  # resistivity, martensite [ohm m]
    k_e: float  # relative rise of resistance per unit of shear strain [1]

    @property
    def L_w(self) -> float:
        """Length of wire in the winding [m]."""
        return pi * self.D * self.n

    @property
    def m(self) -> float:
        """Mass of the wire [kg], equation (C2)."""
        return self.rho * 0.25 * pi * self.d**2 * self.L_w


class Coils(NamedTuple):
    """The constants of n coils as arrays (n,), SI units, read by the kernels."""

    k_A: Array  # spring rate, austenite [N/m]
    k_M: Array  # spring rate, martensite [N/m]
    L_A: Array  # length without load, austenite [m]
    dL: Array  # transformation stretch [m]
    L_s: Array  # solid height [m]
    k_s: Array  # stiffness below the solid height [N/m]
    c_F: Array  # force that shifts the transformation by one kelvin [N/K]
    A_s: Array  # [degC]
    A_f: Array  # [degC]
    M_s: Array  # [degC]
    M_f: Array  # [degC]
    C: Array  # heat capacity m c [J/K]
    Q: Array  # latent heat m H [J]
    hA: Array  # heat loss [W/K]
    T_amb: Array  # temperature of the air [degC]
    R_A: Array  # resistance, austenite, not stretched [ohm]
    R_M: Array  # resistance, martensite, not stretched [ohm]
    k_R: Array  # relative rise of resistance per metre of stretch [1/m]


class CoilState(NamedTuple):
    """The state of n coils as arrays (n,), SI units, changed in place by `coil.advance`."""

    T: Array  # temperature [degC]
    xi: Array  # martensite fraction, 1 cold .. 0 hot [1]
    L: Array  # length at the last step [m]
    F: Array  # force at the last step, positive when the coil pulls [N]
    R: Array  # resistance [ohm]
    E_in: Array  # electrical energy taken up since the start [J]
    E_lost: Array  # heat given to the air since the start [J]
    W: Array  # work done on the body since the start [J]


def coils_of(numbers: CoilNumbers, count: int, T_amb: float = 25.0) -> Coils:
    r"""Return the constants of coils of one kind, equations (C1) to (C3).

    Parameters
    ----------
    numbers : CoilNumbers
        Material and winding [SI]
    count : int
        Number of coils [1]
    T_amb : float
        Temperature of the air [degC]

    Returns
    -------
    Coils
        Constants of the coils [SI]
    """
    p = numbers
    rate = p.d**4 / (8 * p.D**3 * p.n)
    stretch = pi * p.D**2 * p.n / p.d
    area = 0.25 * pi * p.d**2
    values = {
        "k_A": p.G_A * rate, "k_M": p.G_M * rate, "L_A": p.n * p.d, "dL": p.gamma * stretch,
        "L_s": (p.n + 1) * p.d, "k_s": p.k_s, "c_F": pi * p.d**3 / (8 * p.D) * p.c_tau,
        "A_s": p.A_s, "A_f": p.A_f, "M_s": p.M_s, "M_f": p.M_f,
        "C": p.m * p.c, "Q": p.m * p.H, "hA": p.h * pi * p.d * p.L_w, "T_amb": T_amb,
        "R_A": p.rho_A * p.L_w / area, "R_M": p.rho_M * p.L_w / area, "k_R": p.k_e / stretch,
    }  # fmt: skip
    return Coils(**{name: np.full(count, value) for name, value in values.items()})


def joined(*sets: Coils) -> Coils:
    r"""Return one set of coils that holds those of all the others in their order.

    Parameters
    ----------
    sets : Coils
        Constants of coils of different kinds [SI]

    Returns
    -------
    Coils
        Constants of all coils [SI]
    """
    return Coils(*(np.concatenate(columns) for columns in zip(*sets, strict=True)))


def cold(coils: Coils, L: Array) -> CoilState:
    r"""Return the state of coils that have lain at ambient temperature, all martensite; `coil.measure` completes it.

    Parameters
    ----------
    coils : Coils
        Constants of the coils [SI]
    L : array (n,)
        Length between the attachments [m]

    Returns
    -------
    CoilState
        State with force and resistance still 0 [SI]
    """
    count = coils.T_amb.size
    zeros = [np.zeros(count) for _ in range(5)]
    return CoilState(coils.T_amb.copy(), np.ones(count), np.array(L, dtype=float), *zeros)
