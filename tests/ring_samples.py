"""Rings and drives that the tests of the ring share, made from the numbers of the circular robot."""

from dataclasses import replace
from functools import cache

import numpy as np

from hil_sim.bodies.ring import RingPlant
from hil_sim.physics.bodies import GroundNumbers, RingNumbers
from hil_sim.physics.motion import begin, march
from hil_sim.physics.ring import ring_of, round_pose
from hil_sim.physics.spokes import FREE, SOFT
from hil_sim.physics.state import method_of, motion_of
from hil_sim.physics.tally import STEP
from hil_sim.robots.file import load

GRID_US = 5000
VOLT, SERIES_OHM = 2.0, 0.5
CRAWL_EI = "0.97e-5"  # of the acceptance rows of the crawl [N m2]


@cache
def robot(**overrides):
    """Return the circular robot with some numbers changed, `group__key=value`."""
    return load("circular", {key.replace("__", "."): str(value) for key, value in overrides.items()})


def ring_numbers(**changes) -> RingNumbers:
    return replace(robot().ring, **changes)


def lossless(**changes):
    """Return a ring without damping, air or taut coils; `changes` are numbers of the ring."""
    return ring(tau_v=0.0, drag=0.0, damping=0.0, **changes)


def ring(ground: GroundNumbers | None = None, **changes):
    return ring_of(ring_numbers(**changes), ground or robot().ground, 8)


def floating(body, turn=0.0):
    """Return the motion of a round ring at rest 1 m above the ground, with coils that pull at nothing."""
    return motion_of(body, round_pose(body, 0.02, 1.0, turn))


def squashed(body, depth=0.2):
    """Return the motion of a ring that two spokes had pulled flat by `depth` of its radius and have just let go."""
    m = floating(body)
    m.spokes[SOFT, [0, 4]], m.spokes[FREE, [0, 4]] = 5e3, 0.02 * (1 - depth)
    march(body._replace(drag=300.0), 0.0, 0.0, method_of(), m, 1.0)
    m.spokes[SOFT] = 0.0
    m.now[1] = 0.0
    begin(body, 0.0, 0.0, m)
    return m


def oval(body, bend=0.3):
    """Return the motion of a ring let go from a smooth oval of unstretched edges, twice bent by `bend` (rad)."""
    m = floating(body)
    angle = np.arctan2(body.compass[1], body.compass[0]) + np.pi / body.nodes
    course = angle + 0.5 * np.pi + bend * np.sin(2 * angle)
    edges = body.l0 * np.array([np.cos(course), np.sin(course)])
    corners = np.cumsum(np.roll(edges, 1, axis=1), axis=1)
    m.now[0, :-3] = (corners - corners.mean(axis=1, keepdims=True)).T.ravel()
    m.now[0, 1:-3:2] += 1.0
    begin(body, 0.0, 0.0, m)
    return m


def run(body, m, seconds, gravity=(0.0, 0.0), step=None, rho=0.8):
    """Move for some seconds, in steps of a given length or as the error allows."""
    method = method_of(rho) if step is None else method_of(rho, np.inf, step, share=0.0)
    m.tally[STEP] = step or 1e-4
    march(body, *gravity, method, m, seconds)
    return m


def powers(plant, duty):
    """Return the power of each coil at its duty, from 2 V through 0.5 ohm."""
    return np.asarray(duty) * VOLT**2 * plant.resistance / (plant.resistance + SERIES_OHM) ** 2


def drive(plant, seconds, duty):
    """Hold the duties of all coils for some seconds."""
    for _ in range(round(seconds * 1e6) // GRID_US):
        plant.advance(GRID_US, powers(plant, duty))


def duties(*coils, duty=1.0):
    """Return the duties of eight coils of which some are on."""
    return np.where(np.isin(np.arange(8), [coil % 8 for coil in coils]), duty, 0.0)


def take_hold(plant, seconds=2.0, pair=()):
    """Fire coil A and hold it: the robot comes to stand on its dent."""
    drive(plant, 0.7, duties(0, *pair))
    drive(plant, seconds - 0.7, duties(0, *pair, duty=0.32))


def crawl(plant, steps, forward=1, boost=0.7, step=2.0, hold=0.32, offsets=(0,)):
    """Let coil after coil go and fire the next one, open loop; `offsets` adds coils to each."""
    for k in range(1, steps + 1):
        coils = [forward * k + offset for offset in offsets]
        drive(plant, boost, duties(*coils))
        drive(plant, step - boost, duties(*coils, duty=hold))


def new_plant(**overrides) -> RingPlant:
    return RingPlant(robot(**overrides))
