"""Times the sphere's own solver against MuJoCo, as a chain of links and as flex rods, at equal accuracy, in one run.

All get prototype B without drag or electricity. Jump: the bare hoops, squashed by a quarter between the poles, are let
go on the ground; timed are the 40 ms of release and take-off. Crawl: the body with its core in eighteen springs stands
while the spoke to the ground tightens within 1 s. Each runs at the coarsest of its steps from which on all finer ones
stay within 1 % of its own limit, in the rise of the centre of mass, or in squash and height; ours is the tolerance of
the step control. A last table: what a step costs with nodes and hoops. With --full also a chain whose mesh is fine
enough to be right to 1 % at a squash of a sixth.

    python benchmarks/sphere_vs_peers.py [--full]
"""

import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import mujoco
import numpy as np

from benchmarks import sphere_own as own
from benchmarks import sphere_peers as peers
from benchmarks.sphere_peers import BODY, DISCRETE, EULER, IMPLICITFAST

ACCURACY, NODES = 0.01, 24
Run = Callable[[float], tuple[float | tuple[float, float], float]]


class Tool(NamedTuple):
    """A solver: its steps from coarse to fine, the last of them its limit, and a run at one of them."""

    name: str
    steps: Sequence[float]
    run: Run


def squash_m() -> float:
    """Return by how much the chain is squashed before its jump [m]; ours is squashed as much."""
    bodies = peers.squashed(NODES).data
    return 2 * BODY.R - float(bodies.body("+z").xpos[2] - bodies.body("-z").xpos[2])


def jumpers(nodes: int) -> list[Tool]:
    """Return the tools that jump."""
    chain, flex = partial(peers.chain_jump, nodes), partial(peers.flex_jump, nodes)
    return [
        Tool("softrig", [1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-8], lambda t: own.own_jump(nodes, t, squash_m())),
        Tool("MuJoCo chain, implicitfast", [4e-4, 2e-4, 1e-4, 5e-5, 2e-5], lambda h: chain(h, IMPLICITFAST)),
        Tool("MuJoCo chain, discrete", [5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 5e-6], lambda h: chain(h, DISCRETE)),
        Tool("MuJoCo flex, Euler", [1e-4, 5e-5, 4e-5, 2e-5, 1e-5], lambda h: flex(h, EULER)),
        Tool("MuJoCo flex, discrete", [5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 5e-6], lambda h: flex(h, DISCRETE)),
    ]


def crawlers(nodes: int) -> list[Tool]:
    """Return the tools that tighten a spoke."""
    chain = partial(peers.chain_tighten, nodes)
    return [
        Tool("softrig", [1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-7], lambda t: own.own_tighten(nodes, t)),
        Tool("MuJoCo chain, implicitfast", [4e-4, 2e-4, 1e-4, 5e-5], lambda h: chain(h, IMPLICITFAST)),
        Tool("MuJoCo chain, discrete", [1e-2, 5e-3, 2e-3, 1e-3, 2e-4], lambda h: chain(h, DISCRETE)),
    ]


def race(tool: Tool) -> tuple[float, np.ndarray, float]:
    """Return the coarsest step from which on all are accurate, what it found, and the wall seconds a second."""
    limit, best = np.atleast_1d(tool.run(tool.steps[-1])[0]), None
    for step in tool.steps[-2::-1]:
        found, cost = tool.run(step)
        if not (abs(np.atleast_1d(found) / limit - 1) < ACCURACY).all():
            break
        best = step, np.atleast_1d(found), min(cost, tool.run(step)[1])
    if best is None:
        raise RuntimeError(f"{tool.name} reaches {ACCURACY:.0%} at none of its steps")
    return best


def table(title: str, tools: list[Tool]) -> None:
    """Print a race; the first tool is ours."""
    print(f"\n{title}\n{'tool':28} {'step':>8} {'found mm':>14} {'x real time':>12} {'own is':>7}")
    first = 0.0
    for tool in tools:
        step, found, cost = race(tool)
        first = first or cost
        unit = f"{step * 1e6:.3g} {'um' if tool.name == 'softrig' else 'us'}"
        figures = " ".join(f"{1e3 * value:.2f}" for value in found)
        print(f"{tool.name:28} {unit:>8} {figures:>14} {1 / cost:12.3f} {cost / first:6.1f}x", flush=True)


def costs(sizes: Sequence[int]) -> None:
    """Print what a step costs against nodes and hoops."""
    print(f"\nfree flight, per step: {'1 hoop':>22} {'3 hoops':>22}")
    print(f"{'nodes a hoop':>12} {'own us':>20} {'MuJoCo us':>10} {'own us':>11} {'MuJoCo us':>10}")
    for nodes in sizes:
        cells = [(own.own_step_us(nodes, hoops)[0], 1e3 * peers.chain_step_ms(nodes, hoops)) for hoops in (1, 3)]
        print(f"{nodes:12} {cells[0][0]:20.0f} {cells[0][1]:10.0f} {cells[1][0]:11.0f} {cells[1][1]:10.0f}", flush=True)


def main() -> None:
    """Print the tables."""
    mujoco.set_mju_user_warning(lambda message: None)  # a run that goes wrong is seen by its figures
    table(f"jump, {NODES} nodes a hoop, rise of the centre of mass", jumpers(NODES))
    table(f"crawl, {NODES} nodes a hoop, squash and height of the centre of mass", crawlers(NODES))
    if "--full" in sys.argv:
        fine = Tool("MuJoCo chain, 64 nodes", [1e-4, 5e-5, 2e-5, 1e-5], lambda h: peers.chain_jump(64, h, IMPLICITFAST))
        table("jump, the chain with a mesh that is right to 1 %", [jumpers(NODES)[0], fine])
    costs((16, 24, 32, 48, 64, 96) if "--full" in sys.argv else (16, 24, 32, 48))


if __name__ == "__main__":
    main()
