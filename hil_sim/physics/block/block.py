r"""A block: mesh, material and thickness, with the factors of the stiffness that its steps need.

    block = Block(rectangle(0.080, 0.040, 64, 32), Material((Maxwell(60e3, 300e3),), c0=6e3), thickness=0.040)
    held = hold((bottom, 0.0, 0.0), (punch, 0.0, -0.001))      # nodes, along x, along y; None: free
    stiffness = block.stiffness(held, dt)

A degree of freedom is 2 node + axis. The stiffness, equation (B3), is the same in all steps of one length and one set
of supports: `Block.stiffness` factors it once and keeps the last few. `Stiffness.influence` is the displacement of all
nodes for unit forces at some, by which contact finds its forces without another factor.
"""

from collections import OrderedDict
from typing import Any, NamedTuple

import numpy as np

from hil_sim.physics.block import skyline
from hil_sim.physics.block.elements import stiffness_of
from hil_sim.physics.block.history import Triangles, carry
from hil_sim.physics.block.law import fastest
from hil_sim.physics.block.material import BlockError, Material, Update, checked, update_of
from hil_sim.physics.block.mesh import Indices, Mesh
from hil_sim.physics.block.order import order_of, pairs_of
from hil_sim.physics.compiled import Array, prepare

KEPT = 6  # factors, of 7 MB at 9,216 triangles
IN_PLANE, Z = [0, 1, 3], 2
SINGULAR = 1e-11  # share of a diagonal entry that is left of it when the matrix is singular, by rounding [1]


class Held(NamedTuple):
    """Degrees of freedom whose displacement is prescribed, ascending, and what it is at the end of a step."""

    dofs: Indices
    u: Array  # [m]


def hold(*parts: tuple[Any, float | None, float | None]) -> Held:
    r"""Return what holds nodes.

    Parameters
    ----------
    parts : tuple (nodes, float or None, float or None)
        Nodes with their displacements along x and y; None leaves them free along it [m]

    Returns
    -------
    Held
        All parts together [SI]

    Raises
    ------
    BlockError
        A displacement that is no finite number, or two different ones for one node along one axis
    """
    dofs, values = [np.zeros(0, np.int64)], [np.zeros(0)]
    for nodes, *along in parts:
        for axis, value in enumerate(along):
            if value is not None:
                dofs.append(2 * np.ravel(np.asarray(nodes, np.int64)) + axis)
                values.append(np.full(dofs[-1].size, float(value)))
    all_dofs, u = np.concatenate(dofs), np.concatenate(values)
    found, first, inverse = np.unique(all_dofs, return_index=True, return_inverse=True)
    for wrong in np.flatnonzero(~np.isfinite(u) | (u != u[first][inverse]))[:1]:
        node, axis = divmod(int(all_dofs[wrong]), 2)
        other = u[first][inverse][wrong]
        raise BlockError(f"node {node} is held at {u[wrong]:g} m along {'xy'[axis]}, and at {other:g} m")
    return Held(found, u[first])


class Stiffness:
    """The stiffness of a block for one length of step and one set of supports, factored."""

    def __init__(self, block: "Block", dofs: Indices, update: Update) -> None:
        self.update = update
        self.block, self.dofs = block, dofs
        self.D = condensed(update.C, block.material.plane)
        blocks = stiffness_of(block.mesh, self.D, block.triangles.volume, block.pair, block.i.size)
        self.entries = self._filled(blocks)
        self._couple(blocks)
        row = skyline.factor(self.entries, block.start, block.first, SINGULAR)
        if row >= 0:
            node, axis = divmod(int(np.flatnonzero(block.place == row)[0]), 2)
            raise BlockError(f"the supports leave node {node} free to move along {'xy'[axis]} without strain")
        self._influence: dict[int, Array] = {}

    def solve(self, forces: Array, held: Array) -> Array:
        r"""Return the displacements for forces at the free and displacements of the held degrees of freedom.

        Parameters
        ----------
        forces : array (2 N,)
            Forces; those on what is held do nothing [N]
        held : array (held,)
            Displacements of `dofs` [m]

        Returns
        -------
        array (2 N,)
            Displacements [m]
        """
        rows, columns, values = self.coupling
        right = forces - np.bincount(rows, values * held[columns], forces.size)
        right[self.dofs] = held
        du: Array = self._solved(right[None])[0]
        return du

    def influence(self, dofs: Indices) -> Array:
        r"""Return the displacements of everything for a unit force at each of some degrees of freedom.

        Parameters
        ----------
        dofs : array (m,)
            Degrees of freedom 2 node + axis; one that is held gives 0 [1]

        Returns
        -------
        array (m, 2 N)
            Displacements of all degrees of freedom, 0 where they are held [m/N]
        """
        missing = np.array([dof for dof in dofs.tolist() if dof not in self._influence], np.int64)
        units = np.zeros((missing.size, 2 * self.block.mesh.nodes))
        units[np.arange(missing.size), missing] = 1.0
        units[:, self.dofs] = 0.0
        self._influence.update(zip(missing.tolist(), self._solved(units), strict=True))
        return np.array([self._influence[dof] for dof in dofs.tolist()]).reshape(dofs.size, units.shape[1])

    def _solved(self, right: Array) -> Array:
        """Return the solutions for right-hand sides (m, 2 N) whose held entries are the displacements there."""
        block = self.block
        x = np.ascontiguousarray(right[:, block.at])
        skyline.solve(self.entries, block.start, block.first, x)
        solved: Array = x[:, block.place]
        return solved

    def _filled(self, blocks: Array) -> Array:
        """Return the rows of the skyline, with 1 alone in those that are held."""
        block = self.block
        free = np.ones(2 * block.mesh.nodes, bool)
        free[self.dofs] = False
        entries = np.zeros(block.start[-1])
        entries[block.slot] = np.where(free[block.row] & free[block.column], blocks.ravel()[block.lower], 0.0)
        entries[block.start[1:][block.place[self.dofs]] - 1] = 1.0
        return entries

    def _couple(self, blocks: Array) -> None:
        """Keep what displacements of the held degrees of freedom do to the free ones."""
        block = self.block
        number = np.full(2 * block.mesh.nodes, -1)
        number[self.dofs] = np.arange(self.dofs.size)
        rows = 2 * block.i[:, None, None] + np.array([[0, 0], [1, 1]])
        columns = 2 * block.j[:, None, None] + np.array([[0, 1], [0, 1]])
        chosen = (number[rows] < 0) & (number[columns] >= 0)
        self.coupling = rows[chosen], number[columns[chosen]], blocks[chosen]


class Block:
    """What does not change while a block is deformed, and the last few factors of its stiffness."""

    def __init__(self, mesh: Mesh, material: Material, thickness: float = 1.0) -> None:
        """Order the nodes; raise BlockError for a material or a thickness [m] that cannot be."""
        if not 0.0 < thickness < np.inf:
            raise BlockError(f"thickness = {thickness:g} m, must be above 0 m and finite")
        self.mesh, self.material, self.thickness = mesh, checked(material), thickness
        self.triangles = Triangles(mesh.triangles, mesh.slope, thickness * mesh.area, material.plane == "stress")
        self.fastest = fastest(material)  # [1/s]
        self.i, self.j = pairs_of(mesh)
        keys = np.repeat(mesh.triangles[:, None], 3, axis=1) * mesh.nodes + mesh.triangles
        self.pair = np.searchsorted(self.i * mesh.nodes + self.j, keys)
        self._lay_out(order_of(mesh.points, self.i, self.j))
        self._kept: OrderedDict[tuple[bytes, float, bool], Stiffness] = OrderedDict()
        prepare(carry)

    def stiffness(self, held: Held, dt: float, unloading: bool = False) -> Stiffness:
        r"""Return the factored stiffness of a step.

        Parameters
        ----------
        held : Held
            What is held [SI]
        dt : float
            Length of the step [s]
        unloading : bool
            Whether the viscosities of unloading hold [1]

        Returns
        -------
        Stiffness
            A kept one where there is one [SI]

        Raises
        ------
        BlockError
            dt not positive [s], a node that the mesh has not, or supports that leave the block free to move
        """
        key = (held.dofs.tobytes(), dt, unloading and self.material.dual)
        if key not in self._kept:
            for wrong in held.dofs[(held.dofs < 0) | (held.dofs >= 2 * self.mesh.nodes)][:1]:
                raise BlockError(f"node {wrong // 2} is held, the mesh has 0 to {self.mesh.nodes - 1}")
            self._kept[key] = Stiffness(self, held.dofs, update_of(self.material, dt, unloading))
            if len(self._kept) > KEPT:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return self._kept[key]

    def _lay_out(self, order: Indices) -> None:
        """Lay out the rows of the skyline: where each entry of the lower triangle comes from and goes to."""
        self.place = (2 * order[:, None] + np.arange(2)).ravel()
        self.at = np.argsort(self.place)
        rows = (2 * self.i[:, None, None] + np.array([[0, 0], [1, 1]])).ravel()
        columns = (2 * self.j[:, None, None] + np.array([[0, 1], [0, 1]])).ravel()
        self.lower = np.flatnonzero(self.place[columns] <= self.place[rows])
        self.row, self.column = rows[self.lower], columns[self.lower]
        self.first = np.arange(self.place.size)
        np.minimum.at(self.first, self.place[self.row], self.place[self.column])
        self.start = np.r_[0, np.cumsum(np.arange(self.place.size) - self.first + 1)]
        self.slot = self.start[self.place[self.row]] + self.place[self.column] - self.first[self.place[self.row]]


def condensed(C: Array, plane: str) -> Array:
    """Return the stress x, y, xy of strain x, y, xy [Pa]: no strain along z, or no stress."""
    D = C[np.ix_(IN_PLANE, IN_PLANE)]
    return D if plane == "strain" else D - np.outer(C[IN_PLANE, Z], C[Z, IN_PLANE]) / C[Z, Z]
