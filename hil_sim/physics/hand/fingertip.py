r"""Energy of a hemispherical soft tip on a rigid plate, pressed by d on a face tilted by theta.

The tip is a bed of springs along the finger, each of natural length l (the height of the hemisphere above the plate)
and of stiffness E / l per area; at the height h above the cut the face shortens it by h / cos(theta). On a sphere
dS / l = dA / a, and by Archimedes dA = 2 pi a dh, so the integral of the source is exactly

.. math::  U = \int_S \tfrac12 E \lambda \, dS = \frac{E}{2 a \cos^2 \theta} \int_0^d h^2 \, 2 \pi a \, dh
             = \frac{\pi E d^3}{3 \cos^2 \theta}                                                                  (F1)

independent of a: the nail effect is its growth with theta. Springs that all point to the centre of the sphere, the
contrast of the source, know d alone:

.. math::  U = \tfrac13 \pi E d^3                                                                                 (F2)

Where the tip sticks to the face, which has moved along itself by d_t since they touched, every spring is stretched by
the vector sum of h / cos(theta) along the finger and d_t along the face. The same integral gives

.. math::  U = \pi E \{ \tfrac13 d^3 (1 + b \tan^2 \theta) + b \, d^2 d_t \tan \theta + k \, d \, d_t^2 \}        (F3)

with b = 1 for the nail tip, b = 0 for the radial one, and k the ratio of shear to normal stiffness, 1 for springs
that are equally stiff in all directions. At d_t = 0 it is (F1) or (F2). Two facts follow. At T = 0, where a tip that
sticks relaxes to, the energy of (F3) is pi E d^3 (3 + 1 / cos^2 theta) / 12 and not (F1): the springs of the source
are guided, as if infinitely stiff sideways, so frictionless and sticking are two models and not one with a parameter.
And the energy grows with d_t also where d = 0: only slip brings it there.

Valid for d <= a (1 - |sin theta|): further in, the cut reaches the edge of the plate, some spring has no length left,
and the formula overstates the energy. Source: Hirai, section 3.2, first display, for (F1); the closed form, (F2) and
(F3) are derived here. ASSUMED: k = 1. Checked against the integral in tests/test_physics_hand_fingertip.py.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from hil_sim.physics.compiled import Array, lean

FINGERS = ("R", "L")


class HandError(ValueError):
    """Something about the fingers that the model does not cover or that cannot be."""


class OutOfRange(HandError):
    """A tip is pressed further, or tilted more, than the model is valid for."""


class ContactLost(HandError):
    """A tip does not touch the object."""


class NoEquilibrium(HandError):
    """The object finds no rest between the tips."""


class Tip(NamedTuple):
    """What a tip stores and does: each an array of the shape of d and theta, or a number."""

    U: Any  # energy [J]
    N: Any  # normal force on the face, dU/dd [N]
    M: Any  # moment, dU/dtheta, towards theta = 0 where positive with theta [N m]
    T: Any  # force along the face, dU/dd_t [N]
    N_d: Any  # [N/m]
    N_theta: Any  # [N]
    N_t: Any  # [N/m]
    M_theta: Any  # [N m]
    M_t: Any  # [N]
    T_t: Any  # [N/m]


@lean
def springs(b: float, E: float, k: float, d: float, theta: float, d_t: float) -> tuple[float, ...]:
    r"""Return energy, gradient and Hessian of a tip, equation (F3), in the order of `Tip`.

    Parameters
    ----------
    b : float
        1 for the nail tip, 0 for the radial one [1]
    E : float
        Young's modulus of the rubber [Pa]
    k : float
        Shear stiffness of the springs over their normal stiffness [1]
    d : float
        Greatest displacement of the tip [m]
    theta : float
        Orientation of the face relative to the tip [rad]
    d_t : float
        Displacement of the face along itself since it was touched [m]

    Returns
    -------
    tuple of float
        U [J], U_d [N], U_theta [N m], U_t [N], U_dd [N/m], U_dtheta [N], U_dt [N/m], U_thetatheta [N m],
        U_thetat [N], U_tt [N/m]
    """
    c, t = np.pi * E, np.tan(theta)
    s = 1.0 + t * t
    lift, bulk, shear = d * d * t / 1.5 + d * d_t, 1.0 + b * t * t, k * d_t
    return (
        c * d * (d * d * bulk / 3.0 + b * d * d_t * t + shear * d_t),
        c * (d * d * bulk + 2.0 * b * d * d_t * t + shear * d_t),
        c * b * s * d * lift,
        c * d * (b * d * t + 2.0 * shear),
        2.0 * c * (d * bulk + b * d_t * t),
        2.0 * c * b * s * d * (d * t + d_t),
        2.0 * c * (b * d * t + shear),
        2.0 * c * b * s * d * (t * lift + s * d * d / 3.0),
        c * b * s * d * d,
        2.0 * c * k * d,
    )


@lean
def deepest(a: float, theta: float) -> float:
    r"""Return the greatest displacement that the model is valid for.

    Parameters
    ----------
    a : float
        Radius of the tip [m]
    theta : float
        Orientation of the face relative to the tip [rad]

    Returns
    -------
    float
        a (1 - |sin theta|), for |theta| below a right angle, else 0 [m]
    """
    limit: float = a * (1.0 - np.abs(np.sin(theta))) * (np.cos(theta) > 0.0)
    return limit


def pressed(d: Any, theta: Any, a: float, E: float, d_t: Any = 0.0, nail: bool = True, k: float = 1.0) -> Tip:
    r"""Return what a tip stores and does, equations (F1) to (F3); numbers and arrays alike.

    Parameters
    ----------
    d : array_like
        Greatest displacement of the tip [m]
    theta : array_like
        Orientation of the face relative to the tip [rad]
    a : float
        Radius of the tip [m]
    E : float
        Young's modulus [Pa]
    d_t : array_like
        Displacement of the face along itself [m]
    nail : bool
        Whether the springs are guided by a plate, (F1), or point to the centre, (F2) [1]
    k : float
        Shear stiffness over normal stiffness [1]

    Returns
    -------
    Tip
        Energy, forces and stiffnesses [SI]

    Raises
    ------
    ContactLost
        d below 0 [m]
    OutOfRange
        d above a (1 - |sin theta|) [m]
    HandError
        A number that is none, or a radius or modulus that is not positive
    """
    d, theta = np.asarray(d, float)[()], np.asarray(theta, float)[()]
    for name, value, unit in (("a", a, "m"), ("E", E, "Pa"), ("k", k, "")):
        if not 0.0 < value < np.inf:
            raise HandError(f"{quantity(name, value, unit)}, must be positive and finite")
    for name, values in (("d", d), ("theta", theta), ("d_t", d_t)):
        if not np.isfinite(values).all():
            raise HandError(f"{name} = {values} is not a finite number")
    within(d, theta, a)
    values = (float(nail), E, k, d, theta, d_t)
    return Tip(*_plain(springs)(*values))


def within(d: Any, theta: Any, a: float, finger: str = "tip") -> None:
    """Raise ContactLost or OutOfRange for the first d [m] outside 0 .. a (1 - |sin theta|) of that finger."""
    limit: Array = _plain(deepest)(a, theta)
    wrong = np.flatnonzero(~((d >= 0.0) & (d <= limit)))
    if wrong.size:
        shape = np.broadcast_shapes(np.shape(d), np.shape(theta))
        values = (np.broadcast_to(each, shape).flat[wrong[0]] for each in (d, theta, limit))
        raise refusal(finger, *(float(value) for value in values))


def quantity(name: str, value: float, unit: str) -> str:
    """Return a number as errors name it."""
    return f"{name} = {value:g} {unit}".rstrip()


def refusal(finger: str, d: float, theta: float, limit: float) -> HandError:
    """Return the error that says why a finger pressed by d [m] at theta [rad] is outside the model."""
    if not d > 0.0:
        return ContactLost(f"{finger}: d = {1e3 * d:.4g} mm, must be above 0 mm: the tip does not touch the object")
    return OutOfRange(
        f"{finger}: d = {1e3 * d:.4f} mm at theta = {np.degrees(theta):.3f} deg,"
        f" at most a (1 - |sin theta|) = {1e3 * limit:.4f} mm: the tip is pressed to the edge of its plate;"
        " press or tilt it less"
    )


def _plain(kernel: Any) -> Callable[..., Any]:
    """Return the very source of a kernel, which works on whole arrays, too."""
    source: Callable[..., Any] = kernel.py_func
    return source
