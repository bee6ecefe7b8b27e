"""Blocks, meshes and materials that several tests of the rheological block use."""

import numpy as np
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.material import Material, Maxwell
from hil_sim.physics.block.mesh import mesh_of, rectangle
from hil_sim.physics.block.step import advance, rest

WIDTH, HEIGHT, THICK, DEPTH = 0.080, 0.040, 0.040, 0.004
PUSH_S, HOLD_S = 2.0, 3.0
THREE = Material((Maxwell(60e3, 300e3),), c0=6e3)  # facts, scenario A
FIVE = Material((Maxwell(60e3, 300e3), Maxwell(20e3, 8e3)), c0=6e3)
MIXED = Material((Maxwell(60e3, 300e3, 0.2), Maxwell(20e3, 8e3, 0.4)), 1e3, 6e3, 0.3, 0.1)

moduli = st.floats(1e3, 1e6)
times = st.floats(0.1, 100.0)


@st.composite
def materials(draw, one_nu=True, dashpot=True):
    """Draw a material of up to three branches; its dashpot's time is not far below the branches'."""
    common = draw(st.floats(-0.3, 0.45))
    ratios = st.just(common) if one_nu else st.floats(-0.3, 0.45)
    branches = [Maxwell(E, E * draw(times), draw(ratios)) for E in draw(st.lists(moduli, min_size=1, max_size=3))]
    c0 = draw(times) * draw(moduli) * 0.1 if dashpot else 0.0
    E0 = draw(st.one_of(st.just(0.0), moduli))
    return Material(
        tuple(branches), E0, c0, draw(ratios), draw(ratios), plane=draw(st.sampled_from(["strain", "stress"]))
    )


def distorted(columns, rows, seed=0, width=WIDTH, height=HEIGHT, share=0.25):
    """Return a rectangle whose inner nodes are shifted by up to a share of their cell."""
    even = rectangle(width, height, columns, rows)
    shift = np.random.default_rng(seed).uniform(-share, share, even.points.shape) * [width / columns, height / rows]
    shift[even.boundary] = 0.0
    return mesh_of(even.points + shift, even.triangles.T)


def scattered(nodes, seed=0):
    """Return a mesh of random triangles in the rectangle, without any structure."""
    rng = np.random.default_rng(seed)
    x, y = np.linspace(0.0, WIDTH, 9), np.linspace(0.0, HEIGHT, 5)
    rim = [(a, b) for a in x for b in (0.0, HEIGHT)] + [(a, b) for a in (0.0, WIDTH) for b in y[1:-1]]
    points = np.r_[rim, rng.uniform([0.003, 0.003], [WIDTH - 0.003, HEIGHT - 0.003], (nodes, 2))]
    corners = Delaunay(points).simplices.astype(np.int64)
    legs = points[corners[:, 1:]] - points[corners[:, :1]]
    turn = legs[:, 0, 0] * legs[:, 1, 1] - legs[:, 0, 1] * legs[:, 1, 0]
    return mesh_of(points, np.where(turn[:, None] < 0.0, corners[:, ::-1], corners))


def ends(mesh, width=0.020):
    """Return the nodes at the bottom and those under a flat punch in the middle of the top."""
    x, y = mesh.points.T
    under = (y > y.max() - 1e-9) & (np.abs(x - 0.5 * x.max()) < 0.5 * width + 1e-9)
    return mesh.where(y == 0.0), mesh.where(under)


def pressed(block, times_s, dt, depth=DEPTH, width=0.020):
    """Return the states at some times of a bonded flat punch: down in PUSH_S, held for HOLD_S, then gone."""
    (bottom, punch), state, states = ends(block.mesh, width), rest(block), []
    for step in range(1, round(max(times_s) / dt) + 1):
        t = step * dt
        parts = [(bottom, 0.0, 0.0)]
        if t < PUSH_S + HOLD_S + 1e-9:
            parts.append((punch, 0.0, -depth * min(1.0, t / PUSH_S)))
        state = advance(block, state, hold(*parts), dt)
        states += [state] * (np.abs(np.array(times_s) - t) < 1e-9).sum()
    return states


def block_of(columns, rows, material=THREE):
    """Return the block of scenario A."""
    return Block(rectangle(WIDTH, HEIGHT, columns, rows), material, THICK)
