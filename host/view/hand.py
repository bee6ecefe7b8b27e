"""Draws one scene of two soft fingers and the object between them, in mm and to scale.

A finger is its joint, its link and the rigid plate (the nail) that carries a hemisphere; the hemisphere is drawn as the
object's face leaves it: what lies beyond the face is cut off. An object without width is drawn as a line.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon, Wedge
from numpy.typing import ArrayLike, NDArray

from host.recording import Scene
from host.view.style import COILS, FAINT, GROUND, INK, Style

Points = NDArray[np.float64]
Box = tuple[float, float, float, float]  # left, right, bottom, top [mm]
TINTS = ("#f6c79d", "#a9cfe8")  # of the soft tips, in the order of the fingers
SOLID, OBJECT = "#e7dcc6", COILS[2]  # what an object is filled with, and the colour of its angle
LINE_LENGTH = 3.0  # of an object without height, of the tips' radius
LINK_WIDTH, NAIL_WIDTH, JOINT_RADIUS = 0.14, 0.10, 0.13  # of the tips' radius
WEDGE, OF_CUBE = 1.65, 0.9  # how far the wedge of its turn reaches beyond half its height, of the tips' radius
BASE_DROP = 0.30  # of the base below the joints, of the tips' radius
ARROW_MM_PER_N, LEAST_N = 0.25, 2.0  # a smaller force is no longer than the head of its arrow
ARC = 60  # points of a hemisphere


def finger_colour(i: int) -> str:
    """Return the colour of the i-th finger's curves."""
    return (COILS[1], COILS[0])[i % 2]


def unit(deg: float) -> Points:
    """Return the direction at that angle from x, counter-clockwise."""
    return np.array([np.cos(np.radians(deg)), np.sin(np.radians(deg))])


def side_of(scene: Scene, label: str) -> float:
    """Return 1 for the finger to the right, -1 for the one to the left."""
    middle = np.mean([finger["joint"][0] for finger in scene["fingers"].values()])
    return 1.0 if scene["fingers"][label]["joint"][0] > middle else -1.0


def tip_outline(scene: Scene, label: str) -> Points:
    """Return the soft tip as the object's face leaves it: from one end of its plate around to the other."""
    finger, radius = scene["fingers"][label], float(scene["tip_radius_mm"])
    axis, bare = _inward(scene, label), _flattened(scene, label)
    angles = np.radians(np.linspace(-90.0, 90.0, ARC))
    if bare:
        first, last = np.radians(bare)
        few = np.linspace(-np.pi / 2, first, ARC // 2), np.linspace(last, np.pi / 2, ARC // 2)
        angles = np.concatenate(few)
    around = np.radians(axis) + angles
    outline: Points = np.array(finger["tip"]) + radius * np.column_stack([np.cos(around), np.sin(around)])
    return outline


def object_corners(scene: Scene) -> Points:
    """Return the corners of the object; those of one without width fall together in pairs."""
    body = scene["object"]
    wide, high = body["width_mm"] / 2, (body["height_mm"] or LINE_LENGTH * scene["tip_radius_mm"]) / 2
    across, along = unit(body["deg"]), unit(body["deg"] + 90.0)
    corners = [i * wide * across + j * high * along for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    placed: Points = np.array(body["centre"]) + np.array(corners)
    return placed


def push(scene: Scene, label: str) -> tuple[Points, Points]:
    """Return where on the object's face the force of a finger acts, and that force in N.

    Normal force and moment of a tip together are one force, whose line passes its centre at moment / force.
    """
    finger, side, psi = scene["fingers"][label], side_of(scene, label), scene["object"]["deg"]
    across, along = unit(psi), unit(psi + 90.0)
    normal, body = finger["normal_n"], scene["object"]
    lever = side * finger["moment_nmm"] / normal if normal else 0.0
    up = along @ (np.array(finger["tip"]) - np.array(body["centre"])) - lever
    place: Points = np.array(body["centre"]) + side * body["width_mm"] / 2 * across + up * along
    force: Points = -side * (normal * across - finger["tangential_n"] * along)
    return place, force


def room(scene: Scene) -> Box:
    """Return left, right, bottom and top of all that is drawn of a scene."""
    radius = float(scene["tip_radius_mm"])
    edge = [object_corners(scene)] if scene["object"]["gripped"] else []
    for label, finger in scene["fingers"].items():
        foot = np.array(finger["joint"]) + np.array([[-0.6, -0.6], [0.6, -0.6]]) * radius
        edge += [foot, tip_outline(scene, label), _nail(scene, label)]
    points = np.vstack(edge)
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    return float(left), float(right), float(bottom), float(top)


def draw_hand(axes: Axes, scene: Scene, forces: bool = False) -> None:
    """Draw base, fingers and object; with the forces on the object as arrows when asked for."""
    _draw_base(axes, scene)
    for i, label in enumerate(scene["fingers"]):
        _draw_finger(axes, scene, label, TINTS[i % 2], finger_colour(i))
    _draw_object(axes, scene)
    if forces and scene["object"]["gripped"]:
        for label in scene["fingers"]:
            _draw_push(axes, scene, label)


def draw_turn(axes: Axes, scene: Scene, times: float = 1.0) -> None:
    """Draw the object's turn from the upright as a wedge, so many times as large as it is."""
    body, radius = scene["object"], float(scene["tip_radius_mm"])
    wide, deg = body["width_mm"] > 0, times * float(body["deg"])
    reach = body["height_mm"] / 2 + (OF_CUBE if wide else WEDGE) * radius
    over = 6.0 if wide else 1.5  # a plate stands before its wedge, a cube would hide it
    foot, upright, turned = np.array(body["centre"]), unit(90.0), unit(90.0 + deg)
    axes.add_patch(Wedge(tuple(foot), reach, *sorted((90.0, 90.0 + deg)), fc=OBJECT, alpha=0.30, lw=0, zorder=over))
    axes.plot(*np.array([foot, foot + reach * upright]).T, color=INK, lw=0.5, ls=(0, (4, 2)), zorder=over + 0.1)
    axes.plot(*np.array([foot, foot + reach * turned]).T, color=OBJECT, lw=0.8, zorder=over + 0.2)


def _inward(scene: Scene, label: str) -> float:
    """Return the direction of a tip's axis, from its plate towards the object, in degrees."""
    return float(scene["fingers"][label]["deg"]) + (180.0 if side_of(scene, label) > 0 else 0.0)


def _flattened(scene: Scene, label: str) -> tuple[float, float] | None:
    """Return between which angles from its axis the tip lies on the object's face, or None when it does not."""
    finger, radius = scene["fingers"][label], scene["tip_radius_mm"]
    if finger["d_mm"] <= 0 or not scene["object"]["gripped"]:
        return None
    half = float(np.degrees(np.arccos(max(0.0, 1 - finger["d_mm"] / radius))))
    tilt = float(scene["object"]["deg"]) - float(finger["deg"])
    return max(-90.0, tilt - half), min(90.0, tilt + half)


def _nail(scene: Scene, label: str) -> Points:
    """Return the corners of the plate behind a tip."""
    finger, radius = scene["fingers"][label], float(scene["tip_radius_mm"])
    along, back = unit(finger["deg"] + 90.0), -unit(_inward(scene, label))
    corners = [i * radius * along + j * NAIL_WIDTH * radius * back for i, j in ((-1, 0), (1, 0), (1, 1), (-1, 1))]
    return np.array(finger["tip"]) + np.array(corners)


def _bar(start: ArrayLike, end: ArrayLike, width_mm: float) -> Points:
    """Return the corners of a straight bar."""
    from_, to = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    along = (to - from_) / max(float(np.hypot(*(to - from_))), 1e-9)
    across = np.array([-along[1], along[0]]) * width_mm / 2
    return np.array([from_ - across, to - across, to + across, from_ + across])


def _draw_finger(axes: Axes, scene: Scene, label: str, tint: str, colour: str) -> None:
    finger, radius = scene["fingers"][label], float(scene["tip_radius_mm"])
    solid: dict[str, Any] = {"fc": "#8d9299", "ec": INK, "lw": 0.5}
    axes.add_patch(Polygon(_bar(finger["joint"], finger["elbow"], LINK_WIDTH * radius), **solid, zorder=3))
    axes.add_patch(Polygon(_bar(finger["elbow"], finger["tip"], LINK_WIDTH * radius), **solid, zorder=3))
    axes.add_patch(Polygon(tip_outline(scene, label), fc=tint, ec=colour, lw=0.8, joinstyle="round", zorder=4))
    axes.add_patch(Polygon(_nail(scene, label), fc=INK, ec=INK, lw=0.4, zorder=4.5))
    x, y = finger["joint"]
    axes.add_patch(Wedge((x, y), JOINT_RADIUS * radius, 0, 360, fc="white", ec=INK, lw=0.8, zorder=5))


def _draw_base(axes: Axes, scene: Scene) -> None:
    """Draw what both joints are fixed to."""
    radius = float(scene["tip_radius_mm"])
    feet = sorted(float(finger["joint"][0]) for finger in scene["fingers"].values())
    low = min(float(finger["joint"][1]) for finger in scene["fingers"].values()) - BASE_DROP * radius
    axes.plot([feet[0] - 0.6 * radius, feet[-1] + 0.6 * radius], [low, low], color=GROUND, lw=1.6, zorder=2)
    for finger in scene["fingers"].values():
        x, y = finger["joint"]
        stand = np.array([[x - 0.3 * radius, low], [x + 0.3 * radius, low], [x, y]])
        axes.add_patch(Polygon(stand, fc=FAINT, ec=GROUND, lw=0.5, zorder=2))


def _draw_object(axes: Axes, scene: Scene) -> None:
    corners = object_corners(scene)
    if scene["object"]["width_mm"] > 0:
        axes.add_patch(Polygon(corners, fc=SOLID, ec=INK, lw=0.9, joinstyle="round", zorder=3.5))
    else:
        axes.plot(*corners[[0, 3]].T, color=INK, lw=1.4, zorder=5.5, solid_capstyle="butt")


def _draw_push(axes: Axes, scene: Scene, label: str) -> None:
    place, force = push(scene, label)
    if np.hypot(*force) < LEAST_N:
        return
    tail = place - ARROW_MM_PER_N * force
    style: Style = {"arrowstyle": "-|>", "mutation_scale": 5, "lw": 1.0, "color": INK, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", tuple(place), tuple(tail), arrowprops=style, zorder=7)
