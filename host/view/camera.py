"""How space lies on paper: an oblique parallel projection, seen from the robot's right, a little ahead and above.

What lies along the direction of travel and what lies upward is true to scale, so that travel, heights and slopes can be
read off the paper; what is farther away is shifted by a share of its distance, to the upper right. Points are those of
the bench: x along the plane, y to the left of the robot, which is away from the reader, z away from the plane, in mm.
Points of two coordinates lie in the plane y = 0.

    on_paper([[10.0, 0.0, 0.0]], slope_deg=10.0)     # rises by ten degrees
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Points = NDArray[np.float64]
AWAY = (0.34, 0.22)  # on paper, of a millimetre away from the reader
SIGHT = np.array([-AWAY[0], 1.0, -AWAY[1]]) / np.hypot(1.0, np.hypot(*AWAY))  # points along it fall together on paper


def upright(points: ArrayLike, slope_deg: float) -> Points:
    """Return points in upright axes: the same y, and z against gravity."""
    slope = np.radians(slope_deg)
    turn = np.array([[np.cos(slope), 0.0, np.sin(slope)], [0.0, 1.0, 0.0], [-np.sin(slope), 0.0, np.cos(slope)]])
    turned: Points = spatial(points) @ turn
    return turned


def on_paper(points: ArrayLike, slope_deg: float) -> Points:
    """Return points of the bench as they lie on paper."""
    x, y, z = upright(points, slope_deg).T
    return np.column_stack([x + AWAY[0] * y, z + AWAY[1] * y])


def distance(points: ArrayLike, slope_deg: float) -> Points:
    """Return how far away points are along the line of sight, in mm from the origin."""
    away: Points = upright(points, slope_deg) @ SIGHT
    return away


def plumb(points: ArrayLike, slope_deg: float) -> Points:
    """Return the places of the plane z = 0 that lie straight below points."""
    x, y, z = spatial(points).T
    return np.column_stack([x - z * np.tan(np.radians(slope_deg)), y, np.zeros_like(z)])


def silhouette(centre: ArrayLike, radius: float, slope_deg: float, corners: int = 36) -> Points:
    """Return the outline on paper of a ball."""
    across = np.linalg.svd(SIGHT[None])[2][1:]
    angles = np.linspace(0.0, 2 * np.pi, corners, endpoint=False)
    circle = radius * np.column_stack([np.cos(angles), np.sin(angles)]) @ across
    outline: Points = on_paper(centre, slope_deg) + on_paper(circle, 0.0)
    return outline


def spatial(points: ArrayLike) -> Points:
    """Return points with three coordinates."""
    given = np.atleast_2d(np.asarray(points, dtype=float))
    return given if given.shape[1] == 3 else np.column_stack([given[:, 0], np.zeros(len(given)), given[:, 1]])
