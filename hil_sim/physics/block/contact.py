r"""Contact without friction between a rigid shape and a solid of constant stiffness: it presses and never pulls.

Of the solid only the compliance C of the points that may touch is left: how much each gives way to a unit force on
each. With the gaps g that the shape would have above the points without any contact (negative inside the solid), the
forces f and the gaps w that remain solve the linear complementarity problem

.. math::  w = g + C f, \quad w \ge 0, \quad f \ge 0, \quad w^T f = 0                                              (K1)

whose solution is the only one, and the least of f C f / 2 + g f over f >= 0, as C is positive definite.

The set that touches is corrected by all points at once that pull or are inside, beginning with the one that touched
before: between steps of a press one or two times. That may come back to a set it has seen, which is detected; then
the energy is brought down one point after the other, so that no set can come twice and the end is certain.
Should rounding prevent even that, `ContactUnsettled` says so: nothing that violates (K1) is ever returned.

The shape may be driven by its force instead of its depth. The sum of the forces grows with the depth, along a line as
long as the same points touch, so Newton's method from line to line finds the depth of a force; where it would leave
what is known to hold the answer, that is halved.

Source: standard; the first correction is known as primal-dual active set or block principal pivoting, the second is
the active-set method of non-negative least squares. Checked in tests/test_physics_block_contact.py.
"""

from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hil_sim.physics.block.material import BlockError
from hil_sim.physics.compiled import Array

Mask = NDArray[np.bool_]

NEAR = 1e-14  # of the largest gap, below which a gap is none [1]
WEAK = 1e-11  # of the largest force, below which a pull is none [1]
BLOCKS = 30  # corrections of all points at once before one goes after the other [1]
SEARCH = 100  # depths that are tried for a force [1]
SHARE = 1e-12  # of a force, to which it is met [1]
TINY = 1e-300  # [N]


class ContactUnsettled(BlockError):
    """The set of points that touch could not be found: the compliance is not positive definite to rounding."""


class Touch(NamedTuple):
    """Forces on the points, the gaps that remain and the set that touches."""

    force: Array  # towards the solid [N]
    gap: Array  # that remain [m]
    active: Mask
    solves: int  # how many sets were tried


def touch(C: Array, g: Array, active: Mask | None = None) -> Touch:
    r"""Return forces and gaps of a contact that only presses, equation (K1).

    Parameters
    ----------
    C : array (n, n)
        Compliance of the points, symmetric and positive definite [m/N]
    g : array (n,)
        Gaps without contact, negative inside the solid, infinite where there is no shape [m]
    active : array (n,) of bool
        Points that are likely to touch [1]

    Returns
    -------
    Touch
        Forces [N], gaps [m], points that touch [1] and how many sets were tried [1]

    Raises
    ------
    ContactUnsettled
        No set of points solves (K1) to rounding
    """
    if np.isnan(g).any() or np.isneginf(g).any():
        raise ContactUnsettled("a gap is not a number")
    tried: set[bytes] = set()
    now = g < 0.0 if active is None else active & np.isfinite(g)
    while now.tobytes() not in tried and len(tried) < BLOCKS:
        tried.add(now.tobytes())
        found = _assume(C, g, now, len(tried))
        wrong = _wrong(C, g, found)
        if not wrong.any():
            return found._replace(force=np.maximum(found.force, 0.0))
        now = now ^ wrong
    return _descend(C, g, len(tried))


def touch_with(
    C: Array, g: Array, force: float, least: float, most: float, depth: float, active: Mask | None = None
) -> tuple[float, Touch]:
    r"""Return the depth at which a shape presses with a force, and its contact there.

    Parameters
    ----------
    C : array (n, n)
        Compliance of the points [m/N]
    g : array (n,)
        Gaps without contact of the shape at depth 0 [m]
    force : float
        Sum of the forces; at 0 the shape just touches [N]
    least : float
        Where the shape can get up to; the depth is this if it presses harder even there [m]
    most : float
        Where the shape can get down to; the depth is this if it presses less even there [m]
    depth : float
        Where to begin [m]
    active : array (n,) of bool
        Points that are likely to touch [1]

    Returns
    -------
    tuple of float and Touch
        Depth [m] and contact there

    Raises
    ------
    ContactUnsettled
        As `touch` does, or the depth is not found to rounding
    """
    first, near = int(np.argmin(g)), _near(g)
    depth = min(max(depth if force > 0.0 else float(g[first]), least), most)
    low, high = -inf, inf  # depths that press less and more
    for _ in range(SEARCH):
        found = touch(C, g - depth, active)
        active, excess = found.active, float(found.force.sum()) - force
        low, high = (low, depth) if excess > 0.0 else (depth, high)
        stiffness = slope(C, active)
        target = depth - excess / stiffness if stiffness > 0.0 else float(g[first] + force * C[first, first])
        target = min(max(target, least), most)
        if target == depth or abs(excess) <= max(SHARE * force, near * stiffness) or high - low <= near:
            return depth, found
        depth = target if low < target < high else 0.5 * (max(low, least) + min(high, most))
    raise ContactUnsettled(f"no depth from {least:g} to {most:g} m is found for {force:g} N")


def slope(C: Array, active: Mask) -> float:
    r"""Return how much the sum of the forces grows with the depth of the shape while the same points touch.

    Parameters
    ----------
    C : array (n, n)
        Compliance of the points [m/N]
    active : array (n,) of bool
        Points that touch [1]

    Returns
    -------
    float
        Stiffness, 0 where nothing touches [N/m]
    """
    return float(np.linalg.solve(C[np.ix_(active, active)], np.ones(int(active.sum()))).sum())


def _assume(C: Array, g: Array, active: Mask, solves: int) -> Touch:
    """Return forces [N] and gaps [m] with the gaps [m] of one set closed."""
    force, opening = np.zeros_like(g), g.copy()
    if active.any():
        columns = C[:, active]
        force[active] = np.linalg.solve(columns[active], -g[active])
        opening = g + columns @ force[active]
        opening[active] = 0.0
    return Touch(force, opening, active, solves)


def _wrong(C: Array, g: Array, found: Touch) -> Mask:
    """Return the points that pull, or are inside the shape, by more than rounding."""
    near = _near(g)
    weak = np.maximum(WEAK * np.abs(found.force).max(initial=0.0), near / np.diag(C))
    return np.where(found.active, found.force < -weak, found.gap < -near)


def _near(g: Array) -> float:
    """Return the gap that rounding makes [m]."""
    return NEAR * float(np.abs(g[np.isfinite(g)]).max(initial=0.0))


def _descend(C: Array, g: Array, solves: int) -> Touch:
    """Return what `touch` does by adding the point furthest inside and dropping those that would pull on the way."""
    force, active = np.zeros_like(g), np.zeros(g.shape, bool)
    for count in range(solves + 1, solves + 1 + 10 * g.size):
        found = _assume(C, g, active, count)
        pulling = active & (found.force <= 0.0)
        if pulling.any():
            share = np.min(force[pulling] / np.maximum(force[pulling] - found.force[pulling], TINY))
            force = force + share * (found.force - force)
            stopped = pulling & (force <= WEAK * np.abs(found.force).max())
            force[stopped], active = 0.0, active & ~stopped
            continue
        force, wrong = found.force, _wrong(C, g, found)
        if not wrong.any():
            return found._replace(force=np.maximum(found.force, 0.0))
        active = active.copy()
        active[int(np.argmin(np.where(wrong, found.gap, np.inf)))] = True
    raise ContactUnsettled(f"{g.size} points: no set that touches after {10 * g.size} more, {solves} at once before")
