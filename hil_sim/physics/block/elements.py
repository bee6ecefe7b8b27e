r"""The stiffness of triangles of constant strain.

With the derivatives (b, c) of the shape functions of corner a and the displacements u and v along x and y,

.. math::  \varepsilon_x = \sum_a b_a u_a, \quad \varepsilon_y = \sum_a c_a v_a, \quad
           \gamma_{xy} = \sum_a (c_a u_a + b_a v_a), \qquad f = V B^T \sigma, \quad K = V B^T D B                 (B7)

with V the volume of the triangle, its area times the thickness of the block. Standard result; checked by a patch test
in tests/test_physics_block_step.py. Stress and strain in the plane are x, y, xy.
"""

import numpy as np

from hil_sim.physics.block.mesh import Indices, Mesh
from hil_sim.physics.compiled import Array


def stiffness_of(mesh: Mesh, D: Array, volume: Array, pair: Indices, pairs: int) -> Array:
    r"""Return the blocks of the stiffness, equation (B7), one for each pair of nodes that share a triangle.

    Parameters
    ----------
    mesh : Mesh
        Mesh [SI]
    D : array (3, 3)
        Stress of strain in the plane [Pa]
    volume : array (T,)
        Area times thickness [m^3]
    pair : array (3, 3, T)
        Number of the pair of corners a and b [1]
    pairs : int
        How many pairs there are [1]

    Returns
    -------
    array (pairs, 2, 2)
        Force on the first along an axis for a displacement of the second along another [N/m]
    """
    (b, c), none = mesh.slope, np.zeros_like(mesh.slope[0])
    B = np.array([[b, none], [none, c], [c, b]])  # component, axis, corner, triangle
    DB = np.einsum("pr,rdbt->pdbt", D, B * volume)
    blocks = np.empty((pairs, 2, 2))
    for first in range(2):
        for second in range(2):
            values = np.einsum("pat,pbt->abt", B[:, first], DB[:, second])
            blocks[:, first, second] = np.bincount(pair.ravel(), values.ravel(), pairs)
    return blocks
