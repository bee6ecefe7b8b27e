"""Runs the sphere in MuJoCo, as a chain of links and as flex rods: a jump out of a squash, and one spoke that tightens.

Set up for accuracy at long steps: constraints as hard as may be, within two steps or, for the integrator "discrete",
0.1 ms; elliptic cones; a floor with the stiffness and damping of the robot file, which MuJoCo wants per mass.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from time import process_time

import mujoco
import numpy as np

from benchmarks.chain_rest import Rest
from benchmarks.sphere_chain import AXES, THREE, TOE, sphere_chain
from benchmarks.sphere_flex import sphere_flex
from hil_sim.robots.file import load

ROBOT = load("sphere-b")
BODY, GROUND = replace(ROBOT.sphere, drag=0.0), ROBOT.ground
G = GROUND.gravity
# The last squashes the body by a quarter, whatever the stiffness of its strips.
RISING_N = tuple(load * BODY.EI / BODY.R**2 for load in (4.5, 9.0, 13.5, 15.3, 16.65))
JUMP_S, RAMP_S, LOOK_S = 0.04, 1.0, 0.01
END = 20  # looks that are averaged: the body vibrates a little
SPRING_N_PER_M, COLD_M, HOT_M = 30.0, BODY.R - 3e-4, 0.030  # a coil before and after it is heated
IMPLICITFAST, DISCRETE, EULER = (
    getattr(mujoco.mjtIntegrator, f"mjINT_{n}") for n in ("IMPLICITFAST", "DISCRETE", "EULER")
)
Figures = tuple[float, float]


@cache
def squashed(nodes: int) -> Rest:
    """Return the chain at rest between two loads on its poles; leave it as it is."""
    rest = Rest(sphere_chain(BODY, nodes))
    for load_n in RISING_N:
        rest.settle(load_n)
    return rest


def on_floor(spec: mujoco.MjSpec, nodes: int, step: float, integrator: mujoco.mjtIntegrator) -> mujoco.MjModel:
    """Put a floor below the body, and compile."""
    option, link = spec.option, BODY.m / 3 / nodes
    option.timestep, option.integrator, option.cone = step, integrator, mujoco.mjtCone.mjCONE_ELLIPTIC
    option.gravity = [0, 0, -G]
    floor = spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[1, 1, 0.1], conaffinity=1, contype=0)
    floor.solref, floor.priority = [-GROUND.k_n / link, -GROUND.c_n / link], 1
    floor.friction = [GROUND.mu, 0, 0]
    for equality in spec.equalities:
        equality.solref = [1e-4 if integrator == DISCRETE else 2 * step, 1]
    return spec.compile()


def jump(data: mujoco.MjData, model: mujoco.MjModel) -> tuple[float, float]:
    """Let go and return how far the centre of mass will rise [m], and the wall seconds a second."""
    steps = round(JUMP_S / model.opt.timestep)
    mujoco.mj_forward(model, data)
    low = data.subtree_com[0][2]
    start = process_time()
    mujoco.mj_step(model, data, steps)
    wall = process_time() - start
    mujoco.mj_forward(model, data)
    mujoco.mj_subtreeVel(model, data)
    rise = data.subtree_linvel[0][2]
    if any(warning.number for warning in data.warning):
        return np.nan, wall / JUMP_S
    return data.subtree_com[0][2] - low + rise * abs(rise) / (2 * G), wall / JUMP_S


def chain_jump(nodes: int, step: float, integrator: mujoco.mjtIntegrator) -> tuple[float, float]:
    """Jump as a chain."""
    model = on_floor(sphere_chain(BODY, nodes), nodes, step, integrator)
    data = mujoco.MjData(model)
    data.qpos[:] = squashed(nodes).data.qpos
    mujoco.mj_forward(model, data)
    data.qpos[2] -= data.xpos[1:, 2].min() - TOE
    return jump(data, model)


def flex_jump(nodes: int, step: float, integrator: mujoco.mjtIntegrator) -> tuple[float, float]:
    """Jump as flex rods, laid where the chain has its hinges and crossings."""
    model, rest = on_floor(sphere_flex(BODY, nodes), nodes, step, integrator), squashed(nodes)
    data, hinges = mujoco.MjData(model), rest.data.xanchor.copy()
    crossings = {name: rest.data.body(name).xpos.copy() for name in AXES}
    round_ones = Rest(sphere_chain(BODY, nodes)).data.xanchor
    low = hinges[:, 2].min() - TOE
    for number in range(1, model.nbody):
        body = model.body(number)
        place = data.qpos[model.jnt_qposadr[body.jntadr[0]] :]
        if body.name in AXES:
            place[:3] = crossings[body.name] - [0, 0, low]
        elif "twist" not in body.name:
            nearest = np.argmin(np.linalg.norm(round_ones - body.pos, axis=1))
            place[:3] = hinges[nearest] - body.pos - [0, 0, low]
    return jump(data, model)


def with_core(nodes: int) -> mujoco.MjSpec:
    """Return the chain with a core in eighteen cold springs that only pull; the first of them holds the bottom."""
    spec, ball = sphere_chain(BODY, nodes), 0.4 * BODY.m_core * BODY.r_core**2
    core = spec.worldbody.add_body(
        name="core", mass=BODY.m_core, inertia=[ball] * 3, ipos=[0, 0, 0], iquat=[1, 0, 0, 0]
    )
    core.explicitinertial = True
    core.add_freejoint()
    core.add_site(name="core")
    tree, cut = THREE
    ends = [
        "-z",
        *(name for name in AXES if name != "-z"),
        *(f"{a}{b}{nodes // 8}" for a, b in tree),
        *(a + b for a, b in cut),
    ]
    for end in ends:
        spec.body(end).add_site(name=end)
        coil = spec.add_tendon(
            name=end, stiffness=[SPRING_N_PER_M, 0, 0], damping=[BODY.damping, 0, 0], springlength=[0, COLD_M]
        )
        coil.wrap_site("core")
        coil.wrap_site(end)
    return spec


def chain_tighten(nodes: int, step: float, integrator: mujoco.mjtIntegrator) -> tuple[Figures, float]:
    """Tighten the spoke to the ground; return mean squash and height at the end [m], and the wall seconds a second."""
    model = on_floor(with_core(nodes), nodes, step, integrator)
    data, wall, seen = mujoco.MjData(model), 0.0, []
    data.qpos[[2, -5]] = TOE, BODY.R + TOE  # lowest crossing and core
    for now in np.arange(LOOK_S, RAMP_S + 1e-9, LOOK_S):
        model.tendon_lengthspring[0, 1] = COLD_M + (HOT_M - COLD_M) * now / RAMP_S
        wall += timed(lambda: mujoco.mj_step(model, data, round(LOOK_S / step)))
        mujoco.mj_forward(model, data)
        squash = 2 * BODY.R - np.linalg.norm(data.body("+z").xpos - data.body("-z").xpos)
        seen.append((squash, data.subtree_com[0][2]))
    if any(warning.number for warning in data.warning):
        return (np.nan, np.nan), wall / RAMP_S
    return tuple(np.mean(seen[-END:], axis=0)), wall / RAMP_S


def chain_step_ms(nodes: int, hoops: int) -> float:
    """Return the cost of one step of a chain of one or three hoops that touches nothing [ms]."""
    model = on_floor(sphere_chain(BODY, nodes, hoops=hoops), nodes, 2e-5, IMPLICITFAST)
    data = mujoco.MjData(model)
    data.qpos[2] += 0.1
    mujoco.mj_step(model, data, 5)
    return 1e3 * min(timed(lambda: mujoco.mj_step(model, data, 40)) for _ in range(3)) / 40


def timed(act: Callable[[], object]) -> float:
    """Return the seconds of processor time that it takes."""
    start = process_time()
    act()
    return process_time() - start
