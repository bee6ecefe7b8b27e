r"""What each triangle remembers over a step, equations (B2) and (B8), and the nodal forces of its stress.

All matrices here are isotropic: lambda = C[0, 1] and mu = C[3, 3] say it all. Compiled, as one pass over the triangles
without arrays in between: in numpy the products with C go to a BLAS of several threads, which on a machine with other
work waits for a core for longer than the whole step takes (measured: 8 instead of 1.7 ms at 9,216 triangles).

Held against scikit-fem and the closed forms in tests/test_physics_block_peers.py and test_physics_block_step.py.
"""

from hil_sim.physics.block.mesh import Indices
from hil_sim.physics.compiled import Array, lean

X, Y, Z, XY = range(4)


@lean
def recall(
    triangles: Indices,
    slope: Array,
    volume: Array,
    flat: bool,
    C: Array,
    C0: Array,
    keep: Array,
    strain: Array,
    q: Array,
    past: Array,
    forces: Array,
) -> None:
    """Write the stress that the past leaves if nothing moves, and add the forces that hold the nodes against it.

    Parameters
    ----------
    triangles : array (3, T)
        Nodes of each triangle [1]
    slope : array (2, 3, T)
        Derivatives of the shape functions [1/m]
    volume : array (T,)
        Area times thickness [m^3]
    flat : bool
        Whether the stress along z is none, rather than the strain [1]
    C : array (4, 4)
        Stress of an increment of strain [Pa]
    C0 : array (4, 4)
        Of the Voigt element's spring [Pa]
    keep : array (branches,)
        What is left of the stresses of the branches [1]
    strain : array (4, T)
        At the beginning of the step [1]
    q : array (branches, 4, T)
        Stresses of the branches then [Pa]
    past : array (4, T)
        Stress, written [Pa]
    forces : array (N, 2)
        Forces, added to [N]
    """
    swell, shear = C0[X, Y], C0[XY, XY]
    share = C[X, Z] / C[Z, Z] if flat else 0.0
    for t in range(volume.size):
        bulk = swell * (strain[X, t] + strain[Y, t] + strain[Z, t])
        x, y = bulk + 2.0 * shear * strain[X, t], bulk + 2.0 * shear * strain[Y, t]
        z, xy = bulk + 2.0 * shear * strain[Z, t], shear * strain[XY, t]
        for i in range(keep.size):
            x += keep[i] * q[i, X, t]
            y += keep[i] * q[i, Y, t]
            z += keep[i] * q[i, Z, t]
            xy += keep[i] * q[i, XY, t]
        past[X, t], past[Y, t], past[Z, t], past[XY, t] = x, y, z, xy
        spread(triangles, slope, volume, t, x - share * z, y - share * z, xy, forces)


@lean
def carry(
    triangles: Indices,
    slope: Array,
    volume: Array,
    flat: bool,
    C: Array,
    keep: Array,
    gain: Array,
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
    triangles : array (3, T)
        Nodes of each triangle [1]
    slope : array (2, 3, T)
        Derivatives of the shape functions [1/m]
    volume : array (T,)
        Area times thickness [m^3]
    flat : bool
        Whether the stress along z is none, rather than the strain [1]
    C : array (4, 4)
        Stress of an increment of strain [Pa]
    keep : array (branches,)
        What is left of the stresses of the branches [1]
    gain : array (branches, 4, 4)
        Their stress of an increment of strain [Pa]
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
    swell, shear = C[X, Y], C[XY, XY]
    for t in range(volume.size):
        x = y = z = xy = 0.0
        for a in range(3):
            node, b, c = triangles[a, t], slope[0, a, t], slope[1, a, t]
            x += b * du[node, 0]
            y += c * du[node, 1]
            xy += c * du[node, 0] + b * du[node, 1]
        if flat:
            z = -(past[Z, t] + swell * (x + y)) / C[Z, Z]
        bulk = swell * (x + y + z)
        stress[X, t], stress[Y, t] = past[X, t] + bulk + 2.0 * shear * x, past[Y, t] + bulk + 2.0 * shear * y
        stress[Z, t] = 0.0 if flat else past[Z, t] + bulk + 2.0 * shear * z
        stress[XY, t] = past[XY, t] + shear * xy
        spread(triangles, slope, volume, t, stress[X, t], stress[Y, t], stress[XY, t], forces)
        for i in range(keep.size):
            mu, part = gain[i, XY, XY], gain[i, X, Y] * (x + y + z)
            q[i, X, t] = keep[i] * q[i, X, t] + part + 2.0 * mu * x
            q[i, Y, t] = keep[i] * q[i, Y, t] + part + 2.0 * mu * y
            q[i, Z, t] = keep[i] * q[i, Z, t] + part + 2.0 * mu * z
            q[i, XY, t] = keep[i] * q[i, XY, t] + mu * xy
        strain[X, t] += x
        strain[Y, t] += y
        strain[Z, t] += z
        strain[XY, t] += xy


@lean
def spread(
    triangles: Indices, slope: Array, volume: Array, t: int, x: float, y: float, xy: float, forces: Array
) -> None:
    """Add the forces that hold the nodes of triangle t against a stress x, y, xy [Pa], equation (B7)."""
    for a in range(3):
        node, b, c = triangles[a, t], slope[0, a, t], slope[1, a, t]
        forces[node, 0] += volume[t] * (b * x + c * xy)
        forces[node, 1] += volume[t] * (c * y + b * xy)
