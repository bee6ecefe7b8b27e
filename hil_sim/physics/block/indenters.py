r"""Rigid shapes that are pressed from above on a block of small strain.

An indenter is its underside: the height z(x) above its lowest point, over the distance x from its axis, and infinite
where the shape does not reach. With its lowest point at the depth d below the height Y at which it is to begin, its
gap above a surface point that was at (x, y) and has moved by u is

.. math::  g = Y - d + z(x) - y - u_y                                                                              (I1)

    Punch(width=0.020)               flat; bonded=True: what it touches is glued to it
    Cylinder(R=0.015)                z = R - (R^2 - x^2)^1/2 exactly, no parabola
    Polygon(((-5e-3, 5e-3), (0, 0), (5e-3, 5e-3)))       convex; the axis is x = 0 of its corners

DEVIATION: the normal is the vertical. Gaps are vertical, over the x where the point was before it was loaded, and the
force of a face acts vertically however it is inclined. That is what small strain means here: an error of first order
in the slope of the face where it touches, x / R for a cylinder, and none for a flat punch. Derived here; checked in
tests/test_physics_block_contact_indenters.py.
"""

from dataclasses import dataclass
from math import isfinite
from typing import Protocol

import numpy as np

from hil_sim.physics.block.material import BlockError
from hil_sim.physics.compiled import Array

EDGE = 1e-9


class IndenterError(BlockError):
    """An indenter that cannot be, or that does not meet the block."""


class Indenter(Protocol):
    """A rigid shape: whether it is glued to what it touches, its width and its underside."""

    @property
    def bonded(self) -> bool:
        """Whether what it touches is glued to it."""

    @property
    def width(self) -> float:
        """How wide it is [m]."""

    @property
    def lowest(self) -> tuple[float, ...]:
        """Where it is lowest, or where it begins and ends to be so, from its axis [m]: a mesh wants nodes there."""

    def height(self, x: Array) -> Array:
        """Return how high its underside is above its lowest point at x from its axis, inf where it is not [m]."""


@dataclass(frozen=True)
class Punch:
    """A flat punch of a width [m], frictionless or bonded to what it touches."""

    width: float
    bonded: bool = False

    def __post_init__(self) -> None:
        """Raise IndenterError for a width that is not positive."""
        _check_length("width", self.width)

    @property
    def lowest(self) -> tuple[float, ...]:
        """Its edges [m]."""
        return -0.5 * self.width, 0.5 * self.width

    def height(self, x: Array) -> Array:
        """Return 0 within half the width from the axis, edges included [m]."""
        return np.where(np.abs(x) <= 0.5 * self.width * (1.0 + EDGE), 0.0, np.inf)


@dataclass(frozen=True)
class Cylinder:
    """A cylinder of radius R [m] that lies on the block, without friction."""

    R: float
    bonded: bool = False

    def __post_init__(self) -> None:
        """Raise IndenterError for a radius that is not positive, or for a bonded cylinder."""
        _check_length("R", self.R)
        _check_free(self)

    @property
    def width(self) -> float:
        """Its diameter [m]."""
        return 2.0 * self.R

    @property
    def lowest(self) -> tuple[float, ...]:
        """Its middle [m]."""
        return (0.0,)

    def height(self, x: Array) -> Array:
        """Return the height of the lower half of the circle, free of cancellation near the axis [m]."""
        under = np.abs(x) <= self.R * (1.0 + EDGE)
        across = np.where(under, np.minimum(np.abs(x), self.R), 0.0)
        return np.where(under, across**2 / (self.R + np.sqrt(self.R**2 - across**2)), np.inf)


@dataclass(frozen=True)
class Polygon:
    """A convex polygon of corners (x, y) [m] around the axis x = 0, in either sense, without friction."""

    corners: tuple[tuple[float, float], ...]
    bonded: bool = False

    def __post_init__(self) -> None:
        """Raise IndenterError for corners that are no convex polygon."""
        _check_free(self)
        points = np.asarray(self.corners, float)
        if points.ndim != 2 or points.shape[0] < 3 or points.shape[1] != 2:
            raise IndenterError("a polygon is at least 3 corners of x and y [m]")
        if not np.isfinite(points).all():
            raise IndenterError(f"corner {int(np.argmin(np.isfinite(points).all(1)))} of the polygon is not finite")
        _check_convex(points)

    @property
    def width(self) -> float:
        """From its leftmost to its rightmost corner [m]."""
        return float(np.ptp([x for x, _ in self.corners]))

    @property
    def lowest(self) -> tuple[float, ...]:
        """Its lowest corner or corners [m]."""
        least = min(y for _, y in self.corners)
        low = [x for x, y in self.corners if y <= least + EDGE * self.width]
        return tuple(sorted({min(low), max(low)}))

    def height(self, x: Array) -> Array:
        """Return the height of the lower hull, edges included [m]."""
        points = np.asarray(self.corners, float)
        lowest, slack = points[:, 1].min(), EDGE * self.width
        inside = (x >= points[:, 0].min() - slack) & (x <= points[:, 0].max() + slack)
        under = _underside(points)
        return np.where(inside, np.interp(x, under[:, 0], under[:, 1]) - lowest, np.inf)


def gap(indenter: Indenter, x: Array, y: Array, depth: float, begin: float) -> Array:
    r"""Return the gap between an indenter and surface points, equation (I1) without their displacement.

    Parameters
    ----------
    indenter : Indenter
        Its shape
    x : array (n,)
        Position of the points from its axis, unloaded [m]
    y : array (n,)
        Their height, unloaded [m]
    depth : float
        How far its lowest point is below where it begins, negative above [m]
    begin : float
        Height of its lowest point at depth 0 [m]

    Returns
    -------
    array (n,)
        Gap, negative where the points would be inside the shape, infinite where they are not below it [m]
    """
    return begin - depth + indenter.height(x) - y


def _underside(points: Array) -> Array:
    """Return the corners of the lower hull of a convex polygon from left to right; of a wall its lower end."""
    area = _turns(points).sum()
    ordered = points if area > 0.0 else points[::-1]
    order = np.roll(ordered, -int(np.lexsort((ordered[:, 1], ordered[:, 0]))[0]), axis=0)
    last = int(np.lexsort((order[:, 1], -order[:, 0]))[0])
    return order[: last + 1]


def _turns(points: Array) -> Array:
    """Return twice the signed area of the triangle at each corner [m^2]."""
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    return np.asarray(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])


def _check_convex(points: Array) -> None:
    """Raise IndenterError unless the corners go once round a convex shape of some area."""
    turns = _turns(points)
    scale = float(np.ptp(points, axis=0).max()) ** 2
    if not np.abs(turns).max() > EDGE * scale:
        raise IndenterError("the corners of the polygon enclose no area")
    steps = np.roll(points, -1, axis=0) - points
    angles = np.arctan2(*steps[np.abs(steps).max(axis=1) > 0.0].T[::-1])
    turned = (np.diff(np.append(angles, angles[0])) + np.pi) % (2.0 * np.pi) - np.pi
    once = abs(abs(float(turned.sum())) - 2.0 * np.pi) < 0.1
    if not once or min(turns.max(), -turns.min()) > EDGE * scale:
        raise IndenterError("the polygon is not convex: its corners do not go round it once, turning one way")


def _check_length(name: str, value: float) -> None:
    """Raise IndenterError for a length that is not positive and finite."""
    if not (isfinite(value) and value > 0.0):
        raise IndenterError(f"{name} = {value:g} m, must be above 0 m and finite")


def _check_free(indenter: Indenter) -> None:
    """Raise IndenterError for a shape that is bonded and not a flat punch."""
    if indenter.bonded:
        raise IndenterError(f"a bonded {type(indenter).__name__.lower()} is not modelled: only a flat punch is glued")
