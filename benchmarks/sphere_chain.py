"""Builds a sphere of three elastic hoops as a MuJoCo chain of links.

Each hoop has as many rigid links as nodes. Two links meet where their tangents do, in three hinges: twist, edgewise and
flatwise bending, each with stiffness over the length of arc between nodes and at rest at the angle of the round hoop. A
crossing is one body with four arms. A tree of arcs joins the crossings; the seven other arcs are cut at a middle node,
which is then two bodies tied by a weld. A slide stretches the strip where wanted: it is stiff, and steps are short.

    model = sphere_chain(load("sphere-b").sphere, nodes=24).compile()
"""

import mujoco
import numpy as np

from hil_sim.physics.bodies import SphereNumbers

Arcs = tuple[tuple[str, str], ...]
AXES = {sign + axis: float(sign + "1") * np.eye(3)[i] for i, axis in enumerate("xyz") for sign in "+-"}
ONE = (("-z", "+x"), ("-z", "-x"), ("+x", "+z")), (("+z", "-x"),)  # the tree in the order of building, and what is cut
THREE = (
    (("-z", "+x"), ("-z", "+y"), ("-z", "-x"), ("-z", "-y"), ("+x", "+z")),
    (("+z", "+y"), ("+z", "-x"), ("+z", "-y"), ("+x", "+y"), ("+y", "-x"), ("-x", "-y"), ("-y", "+x")),
)
STIFF = [0.9999, 0.9999, 1e-3, 0.5, 2]  # as hard as a constraint may be
TOE = 1e-4  # radius of what touches the ground at a node [m]


def sphere_chain(numbers: SphereNumbers, nodes: int, stretch: bool = False, hoops: int = 3) -> mujoco.MjSpec:
    """Return the free sphere, its centre at the origin; its crossings are the bodies "-x", "+x", ... "+z".

    With 1 hoop for 3 it has the masses of a third of a sphere, to compare the cost.
    """
    return Weaver(numbers, nodes, stretch).weave(*(ONE if hoops == 1 else THREE))


class Weaver:
    """Lays links from crossing to crossing."""

    def __init__(self, numbers: SphereNumbers, nodes: int, stretch: bool) -> None:
        if nodes % 4 or nodes < 12:
            raise ValueError(f"{nodes} nodes per hoop, not a multiple of 4 from 12 on")
        self.spec, self.numbers, self.stretch = mujoco.MjSpec(), numbers, stretch
        self.angle, self.steps = 2 * np.pi / nodes, nodes // 4
        self.arm = numbers.R * np.tan(self.angle / 2)  # from a node to its hinges
        self.link = numbers.m / 3 / nodes  # mass of a link [kg]
        self.rest = {"-z": self.node(AXES["-z"], AXES["+x"], 0)}  # place and axes of a body in the round sphere

    def weave(self, tree: Arcs, cut: Arcs) -> mujoco.MjSpec:
        """Lay all arcs and return the specification."""
        crossing = 2 * self.link + self.numbers.m_joints / 6
        root = self.spec.worldbody.add_body(name="-z", pos=self.rest["-z"][0], quat=turn(self.rest["-z"][1]))
        root.add_freejoint()
        self.load(root, crossing)
        for start, end in tree:
            self.lay(start, end, self.steps, end, crossing)
        for start, end in cut:
            middle = self.steps // 2
            self.lay(start, end, middle, start + end, self.link / 2)
            self.lay(end, start, self.steps - middle, end + start, self.link / 2)
            self.tie(start + end, end + start)
        return self.spec

    def lay(self, start: str, towards: str, steps: int, end: str, last: float) -> None:
        """Lay an arc of so many steps, its last body with this name and mass."""
        for step in range(1, steps + 1):
            name = end if step == steps else f"{start}{towards}{step}"
            before = start if step == 1 else f"{start}{towards}{step - 1}"
            self.rest[name] = self.node(AXES[start], AXES[towards], step)
            body = self.spec.body(before).add_body(name=name, **self.seen_from(before, name))
            self.load(body, last if step == steps else self.link)
            self.hinge(body)

    def node(self, u: np.ndarray, v: np.ndarray, step: int) -> tuple[np.ndarray, np.ndarray]:
        """Return place and axes (tangent, inward, normal of the hoop) of the node so many steps from u towards v."""
        c, s = np.cos(step * self.angle), np.sin(step * self.angle)
        return self.numbers.R * (c * u + s * v), np.column_stack([c * v - s * u, -c * u - s * v, np.cross(u, v)])

    def seen_from(self, parent: str, child: str) -> dict[str, np.ndarray]:
        """Return place and quaternion of one body in the axes of another."""
        (p, a), (q, b) = self.rest[parent], self.rest[child]
        return {"pos": a.T @ (q - p), "quat": turn(a.T @ b)}

    def hinge(self, body: "mujoco.MjsBody") -> None:
        """Hinge a link to the one before, with axes midway between the two."""
        along, across = (
            (np.cos(self.angle / 2), -np.sin(self.angle / 2), 0.0),
            (np.sin(self.angle / 2), np.cos(self.angle / 2), 0.0),
        )
        turn, slide = mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE
        own, at = self.numbers, [-self.arm, 0, 0]
        if self.stretch:
            body.add_joint(type=slide, axis=along, stiffness=self.spring(own.EA))
        for axis, k in ((along, own.twist * own.EI), (across, own.edgewise * own.EI), ((0, 0, 1), own.EI)):
            body.add_joint(type=turn, pos=at, axis=axis, stiffness=self.spring(k), damping=self.spring(k * own.tau_v))

    def spring(self, k: float) -> list[float]:
        """Return a stiffness over the length of arc between nodes; MuJoCo wants two more powers."""
        return [k / (self.numbers.R * self.angle), 0, 0]

    def load(self, body: "mujoco.MjsBody", kilograms: float) -> None:
        """Give a body mass and the moments of inertia of a strip as long as a link, and toes on its edges."""
        along, across = kilograms * self.arm**2 / 3, kilograms * self.numbers.width**2 / 12
        body.mass, body.inertia, body.explicitinertial = kilograms, [across, along + across, along], True
        body.ipos, body.iquat = [0, 0, 0], [1, 0, 0, 0]  # unset, they would be the place of the body itself
        edge = self.numbers.width / 2
        sides = [(0, 0, edge), (0, 0, -edge), (edge, 0, 0), (-edge, 0, 0)][: 4 if kilograms > self.link else 2]
        for side in sides:  # a crossing has the edges of both hoops
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[TOE, 0, 0], pos=side, contype=1, conaffinity=0)

    def tie(self, one: str, other: str) -> None:
        """Weld two bodies as they lie now."""
        weld = self.spec.add_equality(
            type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY, name1=one, name2=other
        )
        weld.data[1] = 0.0  # of the anchor: unset, it would be 1 m away
        weld.data[10] = 1.0  # its rotation is as stiff as MuJoCo means it only where a radian counts as a metre
        weld.solimp = STIFF


def turn(axes: np.ndarray) -> np.ndarray:
    """Return the quaternion of these axes."""
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, axes.ravel())
    return quat
