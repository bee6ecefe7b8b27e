r"""Steps of a block: equilibrium at the end of each, with the history of every triangle.

    state = rest(block)
    state = advance(block, state, hold((bottom, 0.0, 0.0), (punch, 0.0, -0.001)), 0.02)
    state.u, state.stress, state.force[punch].sum(axis=0)

The increment of displacement solves, with the matrix of (B3) and the stress that the past leaves,

.. math::  K \, \Delta u = f - V B^T \sigma_{past}, \qquad
           \sigma_{past} = E_0 C(\nu_0) \varepsilon + \sum_i a_i q_i                                              (B8)

Prescribed displacements move at a constant rate over the step, forces have their value at its end. Where the strain
moves at a constant rate in each step the stress is exact; where the block finds its shape by itself the dashpot c0
makes it of first order in dt. So `advance` cuts the steps after a release, which is when something that was held is
held no longer, into SUBSTEPS for SETTLING / k, with k the fastest rate of (B5).

Contact takes three calls instead of `advance`, for each of `substeps` of the step:

    tried = attempt(block, state, held, dt, forces)       # without the contact forces
    W = tried.stiffness.influence(dofs)                    # (m, 2 N) displacements for unit forces
    state = accept(tried, tried.du + contact_forces @ W)   # with them

and `release(block, state)` when it is lost. `state.force` is the force that holds each node, by whatever exerts it.

ASSUMED: with other viscosities in unloading (`material`), the block is unloaded from a release, or the end of a step
in which it did work on what moves it, until the end of a step in which work was done on it.
"""

from typing import NamedTuple

import numpy as np

from hil_sim.physics.block.block import Block, Held, Stiffness
from hil_sim.physics.block.history import carry, recall
from hil_sim.physics.block.mesh import Indices
from hil_sim.physics.compiled import Array

SUBSTEPS = 10
SETTLING = 5.0  # for how many of its fastest times the block's steps are cut after a release
ROUNDING = 1e-9  # share of the work of its parts, and of the forces on all their way, below which work is none [1]


class State(NamedTuple):
    """What a block is like at a moment; stress and strain have the rows x, y, z, xy."""

    t: float  # [s]
    u: Array  # (N, 2) displacements [m]
    strain: Array  # (4, T), the last engineering shear [1]
    q: Array  # (branches, 4, T) stresses of the Maxwell branches [Pa]
    stress: Array  # (4, T) [Pa]
    force: Array  # (N, 2) that holds each node: reactions of supports and forces from outside [N]
    held: Indices  # degrees of freedom that were held in the last step
    settled: float  # when the steps need not be cut any more [s]
    unloading: bool  # whether the viscosities of unloading hold


class Attempt(NamedTuple):
    """A step whose increment of displacement may still be corrected."""

    block: Block
    state: State  # at its beginning
    held: Held
    dt: float  # [s]
    stiffness: Stiffness
    past: Array  # (4, T) stress that the past leaves if nothing moves [Pa]
    du: Array  # (2 N,) increment of displacement by degree of freedom [m]


def rest(block: Block) -> State:
    """Return the state of a block that nothing has happened to."""
    nodes, triangles = block.mesh.nodes, block.mesh.area.size
    still = np.zeros((nodes, 2)), np.zeros((4, triangles)), np.zeros((len(block.material.branches), 4, triangles))
    return State(0.0, *still, np.zeros((4, triangles)), np.zeros((nodes, 2)), np.zeros(0, np.int64), 0.0, False)


def advance(block: Block, state: State, held: Held, dt: float, forces: Array | None = None) -> State:
    r"""Return the state after a step, cut into substeps where `substeps` says so.

    Parameters
    ----------
    block : Block
        Block [SI]
    state : State
        At the beginning [SI]
    held : Held
        What is held, with its displacements at the end of the step [SI]
    dt : float
        Length of the step [s]
    forces : array (N, 2), optional
        Forces from outside on the nodes that are free [N]

    Returns
    -------
    State
        At the end [SI]

    Raises
    ------
    BlockError
        dt not positive [s], or supports that leave the block free to move
    """
    if not np.isin(state.held, held.dofs, assume_unique=True).all():
        state = release(block, state)
    parts, begin = substeps(state), state.u.ravel()[held.dofs]
    for part in range(1, parts + 1):
        there = held._replace(u=begin + part / parts * (held.u - begin))
        state = accept(attempt(block, state, there, dt / parts, forces))
    return state


def substeps(state: State) -> int:
    """Return into how many substeps the next step is to be cut."""
    return SUBSTEPS if state.t < state.settled else 1


def release(block: Block, state: State) -> State:
    """Return the state of a block that is freed of something: its next steps are cut, and it is unloaded."""
    settling = SETTLING / block.fastest if block.fastest > 0.0 else 0.0
    return state._replace(settled=state.t + settling, unloading=True)


def attempt(block: Block, state: State, held: Held, dt: float, forces: Array | None = None) -> Attempt:
    """Return one step of that length, uncut, equation (B8); the parameters are those of `advance`."""
    stiffness = block.stiffness(held, dt, state.unloading)
    past, load = np.empty_like(state.strain), np.zeros_like(state.u)
    recall(block.triangles, stiffness.update, state.strain, state.q, past, load)
    load = -load if forces is None else forces - load
    du = stiffness.solve(load.ravel(), held.u - state.u.ravel()[held.dofs])
    return Attempt(block, state, held, dt, stiffness, past, du)


def accept(tried: Attempt, du: Array | None = None) -> State:
    r"""Return the state at the end of a step.

    Parameters
    ----------
    tried : Attempt
        The step [SI]
    du : array (2 N,), optional
        Its increment of displacement where it is not the attempt's own [m]

    Returns
    -------
    State
        With the stress and the forces that belong to the increment [SI]
    """
    block, before, past = tried.block, tried.state, tried.past
    move = np.ascontiguousarray(tried.du if du is None else du).reshape(-1, 2)
    strain, q, stress, force = before.strain.copy(), before.q.copy(), np.empty_like(past), np.zeros_like(move)
    carry(block.triangles, tried.stiffness.update, past, move, strain, q, stress, force)
    t, u = before.t + tried.dt, before.u + move
    unloading = block.material.dual and _unloading(tried, force, u, strain)
    return State(t, u, strain, q, stress, force, tried.held.dofs, before.settled, unloading)


def _unloading(tried: Attempt, force: Array, u: Array, strain: Array) -> bool:
    """Return whether the block did work in a step rather than have it done on it; as before if neither.

    What rounding moves is no work: of what holds still, beside the way it came; of what is free, beside the parts.
    """
    before, volume = tried.state, tried.block.triangles.volume
    work = float((force * (u - before.u)).sum())
    parts = float(np.abs(tried.past * (strain - before.strain)).sum(axis=0) @ volume)
    return work < 0.0 if abs(work) > ROUNDING * (parts + float(np.abs(force * u).sum())) else before.unloading
