r"""A press: a rigid shape on a vertical axis above a block, driven to a depth or to a force.

    block = Block(rectangle(0.080, 0.040, 64, 32), material, thickness=0.040)
    press = Press(block, hold((bottom, 0.0, 0.0)), Cylinder(R=0.015), Axis(at=0.040, rate=0.010))
    state = press.start()
    state = press.advance(state, 0.02, depth=1e-3)         # or force=5.0
    state.force, state.depth, state.block.stress

The shape begins with its lowest point at the height of the highest surface point below it, at depth 0, and its axis
goes no faster than its rate. A step is first tried without contact; the forces of (K1) in `contact`, on the compliance
that the step's stiffness has of the surface points, then put right what was tried, so that a step needs no more than
one small dense system. A point of the surface is a node on an edge that faces upwards.

A bonded punch is glued from the start to the nodes below it, along both axes, and pulls as it pushes; after `release`
the glue does not hold again and the punch presses as a frictionless one. A shape that no longer touches has released
the block, which then takes the substeps of `step`.

Small strain: surface points are met where they were before they moved, see `indenters`. DEVIATION: the axis is rigid
and goes exactly where it is told within its rate; what drives it, with its backlash, is not part of this model.
Checked in tests/test_physics_block_press.py and test_physics_block_press_cases.py.
"""

from math import inf, isfinite, isnan
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from hil_sim.physics.block.block import Block, Held, Stiffness
from hil_sim.physics.block.contact import Mask, Touch, touch, touch_with
from hil_sim.physics.block.indenters import Indenter, IndenterError, gap
from hil_sim.physics.block.mesh import Indices, Mesh
from hil_sim.physics.block.step import Attempt, State, accept, attempt, release, rest, substeps
from hil_sim.physics.compiled import Array

VERTICAL = 1e-9


class Axis(NamedTuple):
    """The axis of a press: where it stands, how fast and how far it goes."""

    at: float  # x of the shape's axis [m]
    rate: float = inf  # how fast it goes at most [m/s]
    least: float = -0.010  # depth at its upper end, negative above the block [m]
    most: float = inf  # depth at its lower end [m]


class Pressed(NamedTuple):
    """What a press and its block are like at a moment; arrays have an entry for each node of `Press.nodes`."""

    block: State
    depth: float  # of the shape's lowest point [m]
    force: float  # with which the shape presses on the block [N]
    forces: Array  # (n, 2) on the nodes along x and y [N]
    gap: Array  # (n,) that is left between shape and nodes, 0 where they touch [m]
    active: Mask  # (n,) which nodes touch
    glue: Array | None  # (n, 2) where the nodes are relative to the punch they are glued to [m]
    solves: int = 0  # how many sets of nodes were tried in the last step


class Press:
    """A shape above a block that stands on supports; raises IndenterError for what cannot press."""

    def __init__(self, block: Block, supports: Held, indenter: Indenter, axis: Axis) -> None:
        _check_axis(axis)
        self.block, self.supports, self.indenter, self.axis = block, supports, indenter, axis
        surface = surface_of(block.mesh)
        x, y = block.mesh.points[surface].T
        under = np.isfinite(indenter.height(x - axis.at))
        if not under.any():
            raise IndenterError(
                f"no surface node lies below the indenter, {indenter.width:g} m wide at x = {axis.at:g} m: the surface"
                f" has {surface.size} nodes from x = {x.min():g} to {x.max():g} m"
            )
        self.begin = float(y[under].max())  # height of the lowest point at depth 0 [m]
        free = under & ~np.isin(2 * surface + 1, supports.dofs)
        if not free.any():
            raise IndenterError("all surface nodes below the indenter are held: there is nothing to press")
        self.nodes: Indices = surface[free]  # that may touch, from left to right
        self._axes = (0, 1) if indenter.bonded else (1,)  # along which the shape exerts forces
        self._gap = gap(indenter, x[free] - axis.at, y[free], 0.0, self.begin)
        held = under & ~free
        stop = gap(indenter, x[held] - axis.at, y[held], 0.0, self.begin)
        lowest = self.begin - float(block.mesh.points[:, 1].min())
        self.floor = float(stop.min(initial=lowest))  # depth at which the shape meets what does not give way [m]
        self._kept: WeakKeyDictionary[Stiffness, tuple[Array, Array]] = WeakKeyDictionary()

    def start(self, depth: float = 0.0) -> Pressed:
        """Return a block at rest below the shape at a depth [m] at which it does not press: at 0 if it is bonded."""
        glued = self.indenter.bonded
        if not self.axis.least <= depth <= 0.0 or (glued and depth != 0.0):
            least = 0.0 if glued else self.axis.least
            raise IndenterError(f"begins at depth = {depth:g} m, must be from {least:g} to 0 m")
        n = self.nodes.size
        opening, glue = self._gap - depth, np.zeros((n, 2)) if glued else None
        return Pressed(rest(self.block), depth, 0.0, np.zeros((n, 2)), opening, np.full(n, glued), glue)

    def advance(self, state: Pressed, dt: float, depth: float | None = None, force: float | None = None) -> Pressed:
        r"""Return press and block after a step, cut into substeps where `step.substeps` says so.

        Parameters
        ----------
        state : Pressed
            At the beginning [SI]
        dt : float
            Length of the step [s]
        depth : float, optional
            Where the shape is to go at an even speed, as far as its rate lets it [m]
        force : float, optional
            With which it is to press; without contact it goes down until it touches [N]

        Returns
        -------
        Pressed
            At the end [SI]

        Raises
        ------
        IndenterError
            Not one of depth and force, one that is outside what the press can, or a support in the way
        ContactUnsettled
            No contact solves (K1) to rounding
        """
        self._check_order(state, depth, force)
        parts, begin = substeps(state.block), state.depth
        far = self.axis.rate * dt
        goal = None if depth is None else min(max(depth, begin - far), begin + far)
        for part in range(1, parts + 1):
            there = None if goal is None else begin + part / parts * (goal - begin)
            state = self._step(state, dt / parts, there, force or 0.0)
        return state

    def release(self, state: Pressed) -> Pressed:
        """Return press and block with the shape taken off at once, to the upper end of its axis, and the glue gone."""
        n, clear = self.nodes.size, self.axis.least
        opening = self._gap - clear - state.block.u[self.nodes, 1]
        freed = release(self.block, state.block)
        return Pressed(freed, clear, 0.0, np.zeros((n, 2)), opening, np.zeros(n, bool), None)

    def _step(self, state: Pressed, dt: float, depth: float | None, force: float) -> Pressed:
        """Return the state after an uncut step to a depth [m], or without one to a force [N]."""
        tried = attempt(self.block, state.block, self.supports, dt)
        if state.glue is None:
            depth, met = self._touch(state, tried, depth, force)
            forces = np.stack([np.zeros_like(met.force), -met.force], axis=1)
        else:
            depth, met, forces = self._pull(state, tried, depth, force)
        if depth > self.floor:
            raise IndenterError(f"depth = {depth:g} m: the indenter meets what the block stands on at {self.floor:g} m")
        block = accept(tried, self._moved(tried, forces))
        if state.active.any() and not met.active.any():
            block = release(self.block, block)
        total = float(-forces[:, 1].sum()) + 0.0
        return Pressed(block, depth, total, forces, met.gap, met.active, state.glue, met.solves)

    def _touch(self, state: Pressed, tried: Attempt, depth: float | None, force: float) -> tuple[float, Touch]:
        """Return depth [m] and contact of a shape that only presses."""
        g = self._gap - (state.block.u.ravel() + tried.du)[2 * self.nodes + 1]
        if depth is not None and (g > depth).all():
            return depth, Touch(np.zeros_like(g), g - depth, np.zeros(g.shape, bool), 0)
        every = len(self._axes)
        C = self._compliance(tried.stiffness)[1][every - 1 :: every, every - 1 :: every]
        if depth is not None:
            return depth, touch(C, g - depth, state.active)
        return touch_with(C, g, force, *self._reach(state, tried.dt), state.depth, state.active)

    def _pull(self, state: Pressed, tried: Attempt, depth: float | None, force: float) -> tuple[float, Touch, Array]:
        """Return depth [m], contact and forces (n, 2) [N] of a punch that is glued to its nodes."""
        C = self._compliance(tried.stiffness)[1]
        assert state.glue is not None
        moved = (state.block.u.ravel() + tried.du).reshape(-1, 2)[self.nodes]
        down = np.tile([0.0, -1.0], self.nodes.size)
        still, deeper = np.linalg.solve(C, np.stack([(state.glue - moved).ravel(), down], axis=1)).T
        if depth is None:
            least, most = self._reach(state, tried.dt)
            depth = min(max((force - down @ still) / (down @ deeper), least), most)
        forces = (still + depth * deeper).reshape(-1, 2)
        return depth, Touch(-forces[:, 1], np.zeros(self.nodes.size), state.active, 1), forces

    def _reach(self, state: Pressed, dt: float) -> tuple[float, float]:
        """Return the depths [m] that the axis gets to in a step."""
        far = self.axis.rate * dt
        return max(state.depth - far, self.axis.least), min(state.depth + far, self.axis.most)

    def _compliance(self, stiffness: Stiffness) -> tuple[Array, Array]:
        """Return what unit forces on the nodes do to everything, and to the nodes; once for each stiffness [m/N]."""
        if stiffness not in self._kept:
            dofs = (2 * self.nodes[:, None] + np.array(self._axes)).ravel()
            W = stiffness.influence(dofs)
            self._kept[stiffness] = W, 0.5 * (W[:, dofs] + W[:, dofs].T)
        return self._kept[stiffness]

    def _moved(self, tried: Attempt, forces: Array) -> Array:
        """Return the increment of displacement (2 N,) with the forces (n, 2) [N] on the nodes [m]."""
        exerted = forces[:, self._axes].ravel()
        pressing = np.flatnonzero(exerted)
        if not pressing.size:
            return tried.du
        some = slice(pressing[0], pressing[-1] + 1)
        moved: Array = tried.du + exerted[some] @ self._compliance(tried.stiffness)[0][some]
        return moved

    def _check_order(self, state: Pressed, depth: float | None, force: float | None) -> None:
        """Raise IndenterError unless the press is told one depth or one force that it can do."""
        if (depth is None) == (force is None):
            raise IndenterError("a press is driven to a depth or to a force: give one of them")
        if depth is not None and not self.axis.least <= depth <= self.axis.most:
            raise IndenterError(f"depth = {depth:g} m, must be from {self.axis.least:g} to {self.axis.most:g} m")
        if force is not None and not isfinite(force):
            raise IndenterError(f"force = {force:g} N is not a finite number")
        if force is not None and force < 0.0 and state.glue is None:
            raise IndenterError(f"force = {force:g} N, at least 0 N: what is not glued does not pull")


def surface_of(mesh: Mesh) -> Indices:
    r"""Return the nodes that can be pressed from above: those of the edges that face upwards, from left to right.

    Parameters
    ----------
    mesh : Mesh
        Mesh [SI]

    Returns
    -------
    array (n,)
        Nodes by x [1]
    """
    along = mesh.points[mesh.edges[:, 1]] - mesh.points[mesh.edges[:, 0]]
    upwards = -along[:, 0] > VERTICAL * np.abs(along).max(axis=1)
    nodes = np.unique(mesh.edges[upwards])
    return nodes[np.argsort(mesh.points[nodes, 0], kind="stable")]


def _check_axis(axis: Axis) -> None:
    """Raise IndenterError for an axis that does not move, or whose ends are not around depth 0."""
    if not isfinite(axis.at):
        raise IndenterError(f"at = {axis.at:g} m is not a finite number")
    if not axis.rate > 0.0:
        raise IndenterError(f"rate = {axis.rate:g} m/s, must be above 0 m/s")
    if not (isfinite(axis.least) and axis.least < 0.0):
        raise IndenterError(f"least = {axis.least:g} m, must be below 0 m and finite: the shape begins above the block")
    if isnan(axis.most) or axis.most <= 0.0:
        raise IndenterError(f"most = {axis.most:g} m, must be above 0 m")
