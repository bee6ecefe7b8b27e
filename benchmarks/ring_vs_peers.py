"""Times the ring's own solver against a MuJoCo link chain and a PyElastica ring at equal accuracy, in one run.

All three get the same rubber ring of 40 mm (32 nodes, no hub, no coils) in the same oval, squashed by 20 %. Each runs
at the coarsest of its steps at which the frequency of the free ring and the apex of the jump stay within 1 % of its own
limit for fine steps; ours is the tolerance of the step control, with no step above 1 ms. The table gives real-time
factors of the jump and their ratios; looking at the ring is not timed. Absolute apexes differ by some percent with the
contact law. PyElastica's plane contact does not take closed rods: it gets the same damped penalty by a few numpy lines.

    python benchmarks/ring_vs_peers.py
"""

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import NamedTuple

import numpy as np

from hil_sim.physics.compiled import bound
from hil_sim.physics.gauge import centre
from hil_sim.physics.motion import begin, march
from hil_sim.physics.ring import ring_of, round_pose
from hil_sim.physics.state import method_of, motion_of
from hil_sim.physics.tally import STEP
from hil_sim.robots.file import load

N, R, MASS, EI = 32, 0.02, 1.6e-3, 0.92e-5
RADIUS = R / 20  # of a round section with this EI that is as stiff in stretch as in the robot file
EA = 4 * EI / RADIUS**2
EDGE = 2 * R * np.sin(np.pi / N)
K_N, C_N, G = 500.0, 0.1, 9.81
JUMP_S, FREE_S, JUMP_GRID_S, FREE_GRID_S = 0.30, 0.15, 5e-3, 1e-3
ROUND = 2 * np.pi * (np.arange(N) + 0.5) / N  # course of the edges of the round ring
ACCURACY = 0.01


class Tool(NamedTuple):
    """A solver: its steps from coarse to fine, the last of them its limit, and a run at one of them."""

    name: str
    steps: list[float]
    run: Callable[[float, float, float], tuple[np.ndarray, np.ndarray, float]]


def courses(bend: float) -> np.ndarray:
    """Return the direction of each edge of an oval without stretch, wider than high."""
    return ROUND - bend * np.sin(2 * ROUND)


def corners(bend: float) -> np.ndarray:
    """Return the corners (2, N) of that oval, the lowest at height 0."""
    edges = EDGE * np.array([np.cos(courses(bend)), np.sin(courses(bend))])
    xy = np.cumsum(np.roll(edges, 1, axis=1), axis=1)
    return xy - [[xy[0].mean()], [xy[1].min()]]


def squash() -> float:
    """Return the bend at which the oval is a fifth lower than the circle."""
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.ptp(corners(middle)[1]) > 0.8 * 2 * R else (low, middle)
    return low


def own(tolerance: float, bend: float, gravity: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Run the ring's own solver; its step follows this tolerance [m]."""
    robot = load("circular")
    numbers = replace(robot.ring, m=MASS, EI=EI, EA=EA, tau_v=0.0, drag=0.0, damping=0.0, r_hub=1e-9, nodes=N)
    ring = ring_of(numbers, replace(robot.ground, k_n=K_N, c_n=C_N), 8)
    m, method = motion_of(ring, round_pose(ring, R, R)), method_of(tolerance=tolerance, longest=FREE_GRID_S)
    m.now[0, :-3] = corners(bend).T.ravel() + np.tile([0.0, 1.0 if gravity == 0 else 0.0], N)
    ring.mass[-3:] = 1e-9  # the hub is not there, and meets nothing
    m.now[0, -2] = m.now[0, 1:-3:2].mean()
    begin(ring, 0.0, -gravity, m)
    m.tally[STEP] = 1e-4

    parts = (ring, 0.0, -gravity, method, m, grid_s(gravity))
    step = bound(march, *parts)

    def look() -> tuple[float, float]:
        return centre(ring, m.now[0])[1], np.ptp(m.now[0, 0:-3:2]) - np.ptp(m.now[0, 1:-3:2])

    return timed(lambda: step(*parts), look, gravity)


def grid_s(gravity: float) -> float:
    """Return the time between two looks: fine where an oscillation is timed, coarse in a jump."""
    return JUMP_GRID_S if gravity else FREE_GRID_S


def timed(
    advance: Callable[[], object], look: Callable[[], tuple[float, float]], gravity: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return heights of the centre, ovalities, and seconds of wall time per second of virtual time without looking."""
    seconds = JUMP_S if gravity else FREE_S
    seen, wall = [], 0.0
    for _ in range(round(seconds / grid_s(gravity))):
        start = perf_counter()
        advance()
        wall += perf_counter() - start
        seen.append(look())
    heights, ovalities = np.array(seen).T
    return heights, ovalities, wall / seconds


def chain(step: float) -> str:
    """Return a ring of links with springs for MuJoCo, its last link tied to its first."""
    inertia = 0.25 * MASS / N * EDGE**2
    opened, bodies = "", ""
    for i in range(N):
        turn = ROUND[0] if i == 0 else 2 * np.pi / N
        where = "0 0 0" if i == 0 else f"{EDGE} 0 0"
        spring = f'stiffness="{EI / EDGE}"' if i else ""
        bodies += (
            f'<body name="b{i}" pos="{where}" quat="{np.cos(turn / 2)} 0 {-np.sin(turn / 2)} 0">{{}}'
            f'<joint name="h{i}" type="hinge" axis="0 -1 0" {spring}/>'
            f'<inertial pos="{EDGE / 2} 0 0" mass="{MASS / N}" diaginertia="{inertia} {inertia} {inertia}"/>'
            f'<geom type="sphere" size="1e-4" mass="0" contype="1" conaffinity="0"/>'
        ).format('<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>' if i == 0 else "")
        opened += "</body>"
    floor = f"{-K_N / MASS * N} {-C_N / MASS * N}"  # it wants both per mass
    joints = "".join(f'<joint joint="h{i}" coef="1"/>' for i in range(1, N))
    return f"""<mujoco><option timestep="{step}" integrator="implicitfast" cone="elliptic"/><worldbody>
        <geom type="plane" size="1 1 .1" contype="0" conaffinity="1" pos="0 0 -1e-4" solref="{floor}"/>
        {bodies}{opened}</worldbody>
        <tendon><fixed stiffness="{EI / EDGE}" springlength="0">{joints}</fixed></tendon>
        <equality><connect body1="b{N - 1}" body2="b0" anchor="{EDGE} 0 0" solref="{2 * step} 1"/></equality>
        </mujoco>"""


def mujoco_chain(step: float, bend: float, gravity: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Run the link chain at a fixed step [s]."""
    import mujoco  # noqa: PLC0415

    model = mujoco.MjModel.from_xml_string(chain(step))
    model.opt.gravity[:] = 0, 0, -gravity
    data, turns = mujoco.MjData(model), courses(bend) - ROUND
    x, y = corners(bend)
    data.qpos[:2] = x[0], y[0] + (0.0 if gravity else 1.0)
    data.qpos[2:] = np.diff(turns, prepend=0.0)
    substeps = round(grid_s(gravity) / step)

    def look() -> tuple[float, float]:
        return float(data.subtree_com[1][2]), float(np.ptp(data.xpos[1:, 0]) - np.ptp(data.xpos[1:, 2]))

    return timed(lambda: mujoco.mj_step(model, data, substeps), look, gravity)


def elastica_ring(step: float, bend: float, gravity: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Run PyElastica's ring rod at a fixed step [s]."""
    import elastica as ea  # noqa: PLC0415

    class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing):
        pass

    class Floor(ea.NoForces):
        def apply_forces(self, system, time=0.0):
            height = system.position_collection[1]
            damped = C_N * np.minimum(1.0, np.maximum(0.0, -height) / 1e-5) * system.velocity_collection[1]
            push = np.where(height < 0, np.maximum(0.0, -K_N * height - damped), 0.0)
            system.external_forces[1] += push - gravity * system.mass

    area = np.pi * RADIUS**2
    simulator = Simulator()
    rod = ea.CosseratRod.ring_rod(
        N, np.zeros(3), np.array([1.0, 0, 0]), np.array([0, 0, 1.0]), N * EDGE, RADIUS, MASS / (N * EDGE) / area,
        youngs_modulus=EI / (0.25 * np.pi * RADIUS**4),
    )  # fmt: skip
    simulator.append(rod)
    simulator.add_forcing_to(rod).using(Floor)
    simulator.finalize()
    shape_rod(rod, bend, 0.0 if gravity else 1.0)
    stepper = ea.PositionVerlet()
    substeps, now = round(grid_s(gravity) / step), np.float64(0.0)

    def advance() -> None:
        nonlocal now
        for _ in range(substeps):
            now = stepper.step(simulator, now, np.float64(step))

    def look() -> tuple[float, float]:
        x, y = rod.position_collection[:2]
        return float(y.mean()), float(np.ptp(x) - np.ptp(y))

    return timed(advance, look, gravity)


def shape_rod(rod, bend: float, height: float) -> None:
    """Lay the rod into the oval, its directors along the edges; it keeps its round rest shape."""
    x, y = corners(bend)
    rod.position_collection[:] = x, y + height, 0 * x
    tangent = np.array([np.cos(courses(bend)), np.sin(courses(bend)), np.zeros(N)])
    up = np.tile(np.array([[0.0], [0], [1]]), (1, N))
    rod.director_collection[:] = np.array([up, np.cross(tangent, up, axis=0), tangent])


def frequency(ovality: np.ndarray) -> float:
    """Return the frequency of an oscillation from the times of its first and last upward zero [Hz]."""
    signal = ovality - 0.5 * (ovality.max() + ovality.min())
    ups = np.flatnonzero((signal[:-1] < 0) & (signal[1:] >= 0))
    if len(ups) < 2:
        return 0.0
    times = FREE_GRID_S * (ups - signal[ups] / (signal[ups + 1] - signal[ups]))
    return float((len(times) - 1) / (times[-1] - times[0]))


def figures(tool: Tool, step: float, bend: float) -> tuple[float, float, float]:
    """Return frequency [Hz], apex of the centre [m] and wall seconds per second of the jump at one step."""
    _, free, _ = tool.run(step, 0.05, 0.0)
    heights, _, cost = tool.run(step, bend, G)
    return frequency(free), float(heights.max()), cost


def race(tool: Tool, bend: float) -> tuple[float, float, float, float]:
    """Return the coarsest step within the accuracy, and its frequency, apex and cost."""
    tool.run(tool.steps[0], bend, G)  # compiles what compiles
    limit = figures(tool, tool.steps[-1], bend)
    for step in tool.steps[:-1]:
        found = figures(tool, step, bend)
        if all(abs(a / b - 1) < ACCURACY for a, b in zip(found[:2], limit[:2], strict=True)):
            return step, found[0], found[1], min(tool.run(step, bend, G)[2] for _ in range(3))
    return tool.steps[-1], *limit


TOOLS = [
    Tool("softrig", [3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-8], own),
    Tool("MuJoCo link chain", [5e-4, 2.5e-4, 1e-4, 5e-5, 2e-5], mujoco_chain),
    Tool("PyElastica ring", [5e-5, 2.5e-5, 2e-5, 1.25e-5, 1e-5, 5e-6], elastica_ring),
]


def main() -> None:
    """Print the table."""
    bend, first = squash(), 0.0
    print(f"{'tool':20} {'step':>9} {'f2 Hz':>7} {'apex mm':>8} {'x real time':>11} {'own is':>7}")
    for tool in TOOLS:
        step, hertz, apex, cost = race(tool, bend)
        first = first or cost
        unit = f"{step * 1e6:.2g} um" if tool.run is own else f"{step * 1e6:.3g} us"
        print(
            f"{tool.name:20} {unit:>9} {hertz:7.2f} {1e3 * apex:8.1f} {1 / cost:11.2f} {cost / first:6.1f}x", flush=True
        )


if __name__ == "__main__":
    main()
