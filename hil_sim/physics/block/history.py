r"""What each triangle remembers over a step, equations (B2) and (B8), and the nodal forces of its stress.

All matrices here are isotropic: lambda = C[0, 1] and mu = C[3, 3] say it all. Compiled, as one pass over the triangles
without arrays in between: in numpy the products with C go to a BLAS of several threads, which on a machine with other
work waits for a core for longer than the whole step takes (measured: 8 instead of 1.7 ms at 9,216 triangles).

Held against scikit-fem and the closed forms in tests/test_physics_block_peers.py and test_physics_block_step.py.
"""

from typing import NamedTuple

from hil_sim.physics.block.material import Update
from hil_sim.physics.block.mesh import Indices
from hil_sim.physics.compiled import Array, lean

X, Y, Z, XY = range(4)


class Triangles(NamedTuple):
    """The triangles of a block as the kernels take them."""

    corners: Indices  # (3, T) nodes of each
    slope: Array  # (2, 3, T) derivatives of the shape functions [1/m]
    volume: Array  # (T,) area times thickness [m^3]
    flat: bool  # whether the stress along z is none, rather than the strain


@lean
def recall(triangles: Triangles, update: Update, strain: Array, q: Array, past: Array, forces: Array) -> None:
    """Write the stress that the past leaves if nothing moves, and add the forces that hold the nodes against it.

    Parameters
    ----------
    triangles : Triangles
        Triangles [SI]
    update : Update
        What the step does [SI]
    strain : array (4, T)
        At the beginning of the step [1]
    q : array (branches, 4, T)
        Stresses of the branches then [Pa]
    past : array (4, T)
        Stress, written [Pa]
    forces : array (N, 2)
        Forces, added to [N]
    """
    swell, shear, keep = update.C0[X, Y], update.C0[XY, XY], update.keep
    share = update.C[X, Z] / update.C[Z, Z] if triangles.flat else 0.0
    for t in range(triangles.volume.size):
        bulk = swell * (strain[X, t] + strain[Y, t] + strain[Z, t])
        x, y = bulk + 2.0 * shear * strain[X, t], bulk + 2.0 * shear * strain[Y, t]
        z, xy = bulk + 2.0 * shear * strain[Z, t], shear * strain[XY, t]
        for i in range(keep.size):
            x += keep[i] * q[i, X, t]
            y += keep[i] * q[i, Y, t]
            z += keep[i] * q[i, Z, t]
            xy += keep[i] * q[i, XY, t]
        past[X, t], past[Y, t], past[Z, t], past[XY, t] = x, y, z, xy
        _spread(triangles, t, x - share * z, y - share * z, xy, forces)


@lean
def carry(
    triangles: Triangles,
    update: Update,
    past: Array,
    du: Array,
    strain: Array,
    q: Array,
    stress: Array,
    forces: Array,
) -> None:
    """Carry strain and stresses of the branches over a step; write the stress and add the forces at its end.

    Parameters
    ----------
    triangles : Triangles
        Triangles [SI]
    update : Update
        What the step does [SI]
    past : array (4, T)
        Stress that the past leaves [Pa]
    du : array (N, 2)
        Increment of displacement [m]
    strain : array (4, T)
        Strain, changed to that at the end [1]
    q : array (branches, 4, T)
        Stresses of the branches, changed likewise [Pa]
    stress : array (4, T)
        Stress, written [Pa]
    forces : array (N, 2)
        Forces, added to [N]
    """
    swell, shear, stiff = update.C[X, Y], update.C[XY, XY], update.C[Z, Z]
    for t in range(triangles.volume.size):
        x, y, xy = _stretched(triangles, t, du)
        z = -(past[Z, t] + swell * (x + y)) / stiff if triangles.flat else 0.0
        bulk = swell * (x + y + z)
        stress[X, t], stress[Y, t] = past[X, t] + bulk + 2.0 * shear * x, past[Y, t] + bulk + 2.0 * shear * y
        stress[Z, t] = 0.0 if triangles.flat else past[Z, t] + bulk + 2.0 * shear * z
        stress[XY, t] = past[XY, t] + shear * xy
        _spread(triangles, t, stress[X, t], stress[Y, t], stress[XY, t], forces)
        _grow(update, t, x, y, z, xy, q)
        strain[X, t] += x
        strain[Y, t] += y
        strain[Z, t] += z
        strain[XY, t] += xy


@lean
def _stretched(triangles: Triangles, t: int, du: Array) -> tuple[float, float, float]:
    """Return the increment of strain x, y, xy of triangle t, equation (B7)."""
    x = y = xy = 0.0
    for a in range(3):
        node, b, c = triangles.corners[a, t], triangles.slope[0, a, t], triangles.slope[1, a, t]
        x += b * du[node, 0]
        y += c * du[node, 1]
        xy += c * du[node, 0] + b * du[node, 1]
    return x, y, xy


@lean
def _grow(update: Update, t: int, x: float, y: float, z: float, xy: float, q: Array) -> None:
    """Carry the stresses of the branches in triangle t over an increment of strain, equation (B2)."""
    for i in range(update.keep.size):
        keep, shear, bulk = update.keep[i], update.gain[i, XY, XY], update.gain[i, X, Y] * (x + y + z)
        q[i, X, t] = keep * q[i, X, t] + bulk + 2.0 * shear * x
        q[i, Y, t] = keep * q[i, Y, t] + bulk + 2.0 * shear * y
        q[i, Z, t] = keep * q[i, Z, t] + bulk + 2.0 * shear * z
        q[i, XY, t] = keep * q[i, XY, t] + shear * xy


@lean
def _spread(triangles: Triangles, t: int, x: float, y: float, xy: float, forces: Array) -> None:
    """Add the forces that hold the nodes of triangle t against a stress x, y, xy [Pa], equation (B7)."""
    for a in range(3):
        node, b, c = triangles.corners[a, t], triangles.slope[0, a, t], triangles.slope[1, a, t]
        forces[node, 0] += triangles.volume[t] * (b * x + c * xy)
        forces[node, 1] += triangles.volume[t] * (c * y + b * xy)
