"""What a press looks like: its model by name, its outline for pictures, and the fields in its block."""

from math import cos, pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from hil_sim.bodies.pressnumbers import PressNumbers
from hil_sim.physics.block.mesh import Mesh
from hil_sim.physics.block.stress import von_mises

if TYPE_CHECKING:
    from hil_sim.bodies.press import PressPlant

ROUND = 48  # corners of a drawn cylinder
TALL_MM = 10.0  # height of a drawn punch
Outline = list[list[float]]


def model(plant: "PressPlant") -> dict[str, Any]:
    """Return which parts the model has."""
    material = plant.numbers.material
    return {
        "indenter": plant.numbers.kind,
        "plane": material.plane,
        "branches": len(material.branches),
        "dual": material.dual,
        "triangles": plant.press.block.mesh.area.size,
        "backlash_mm": 1e3 * plant.numbers.backlash,
    }


def snapshot(plant: "PressPlant") -> dict[str, Any]:
    """Return block, surface, indenter and cells at this moment, mm."""
    mesh, state = plant.press.block.mesh, plant.state
    top = mesh.points[plant.surface] + state.block.u[plant.surface]
    return {
        "kind": "press",
        "t_s": plant.t_s,
        "coils": {},
        "depth_mm": 1e3 * state.depth,
        "axis_mm": plant.screw.at_mm,
        "commanded_mm": plant.commanded_mm,
        "limp": plant.commanded_mm is None,
        "force_n": state.force,
        "current_a": plant.screw.current_a,
        "touching": plant.touching,
        "block": dict(plant.block_mm),
        "surface_mm": (1e3 * top).tolist(),
        "indenter": {"kind": plant.numbers.kind, "outline_mm": _placed(plant)},
        "cells": _cells(plant),
        "model": model(plant),
    }


def block_mm(numbers: PressNumbers, mesh: Mesh) -> dict[str, Any]:
    """Return the size of a block before it is pressed, and where its lowest corner on the left is."""
    width_mm, height_mm = (1e3 * np.ptp(mesh.points, axis=0)).tolist()
    return {
        "width_mm": width_mm,
        "height_mm": height_mm,
        "thickness_mm": 1e3 * numbers.thickness,
        "corner_mm": (1e3 * mesh.points.min(axis=0)).tolist(),
    }


def fields(plant: "PressPlant") -> dict[str, Any]:
    """Return the mesh, and displacement [mm], stress [kPa] and strain on it."""
    mesh, block = plant.press.block.mesh, plant.state.block
    return {
        "points_mm": 1e3 * mesh.points,
        "triangles": mesh.triangles.T.copy(),
        "displacement_mm": 1e3 * block.u,
        "stress_kpa": 1e-3 * block.stress.T,
        "von_mises_kpa": 1e-3 * von_mises(block.stress),
        "strain": block.strain[[0, 1, 3]].T.copy(),
    }


def _cells(plant: "PressPlant") -> dict[str, dict[str, Any]]:
    side_mm = 1e3 * plant.numbers.side
    return {
        label: {"centre_mm": [1e3 * x, 1e3 * y], "side_mm": side_mm, "pressure_kpa": pressure}
        for (label, (x, y)), pressure in zip(plant.places.items(), plant.cell_kpa, strict=True)
    }


def _placed(plant: "PressPlant") -> Outline:
    """Return the outline of the indenter where it is now."""
    x_mm, y_mm = 1e3 * plant.press.axis.at, 1e3 * (plant.press.begin - plant.state.depth)
    return [[x_mm + x, y_mm + y] for x, y in _outline(plant.numbers)]


def _outline(numbers: PressNumbers) -> Outline:
    """Return the outline of an indenter, mm from its lowest point."""
    if numbers.kind == "cylinder":
        radius, turns = 1e3 * numbers.R, [2 * pi * i / ROUND for i in range(ROUND)]
        return [[radius * sin(turn), radius * (1.0 - cos(turn))] for turn in turns]
    if numbers.kind == "polygon":
        lowest = min(y for _, y in numbers.corners)
        return [[1e3 * x, 1e3 * (y - lowest)] for x, y in numbers.corners]
    half = 500.0 * numbers.w
    return [[-half, 0.0], [half, 0.0], [half, TALL_MM], [-half, TALL_MM]]
