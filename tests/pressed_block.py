"""A made-up run for tests of pictures: a small block of true physics below a cylinder, pushed, held and left alone.

Scenes and fields are those of the bench's observer; the servo is ideal, the load cell exact.
"""

import numpy as np

from hil_sim.physics.block.stress import Cells, von_mises
from host.fields import mesh_of, slice_of
from host.recording import Recording
from host.records import Event, Telemetry
from tests.block_samples import HEIGHT, THICK, THREE, WIDTH
from tests.press_samples import press_of

STEP_S, EVERY = 0.05, 4  # from record to record; records from slice to slice
CELLS_MM = ((40, 30), (20, 30), (60, 30), (40, 15), (20, 15), (60, 15))
LABELS = ("C1", "C2", "C3", "C4", "C5", "C6")
SCENARIO_B = ((2.0, 4.0), (3.0, 4.0), (1.25, -6.0), (1.75, -6.0))  # seconds, to depth [mm]


class PressedBlock:
    """An observer of a block below a cylinder, which goes where `push` says."""

    def __init__(self, columns=16, material=THREE):
        self.press = press_of(columns=columns, material=material)
        self.state = self.press.start()
        self.cells = Cells(self.press.block.mesh, [(x / 1000, y / 1000) for x, y in CELLS_MM], 0.005)

    def push(self, depth_mm):
        """Go to a depth within a step."""
        self.state = self.press.advance(self.state, STEP_S, depth=depth_mm / 1000)

    def cell_kpa(self):
        """Return what presses on each cell."""
        return dict(zip(LABELS, (-self.cells.mean(self.state.block.stress[1]) / 1000).tolist(), strict=True))

    def observe(self):
        """Return what the bench's observer measures."""
        return {
            "kind": "press", "force_n": self.state.force, "depth_mm": 1000 * self.state.depth,
            "touching": bool(self.state.active.any()), "dent_mm": -1000 * float(self.state.block.u[:, 1].min()),
        }  # fmt: skip

    def snapshot(self):
        """Return the scene, as the bench's observer does."""
        mesh, state = self.press.block.mesh, self.state
        top = mesh.points[:, 1] == HEIGHT
        turn, depth_mm = np.linspace(0.0, 2 * np.pi, 61), 1000 * state.depth
        circle = np.column_stack([40 + 15 * np.sin(turn), 40 - depth_mm + 15 - 15 * np.cos(turn)])
        kpa = self.cell_kpa()
        return {
            "kind": "press", "t_s": state.block.t, "coils": {}, "depth_mm": depth_mm, "axis_mm": depth_mm,
            "commanded_mm": depth_mm, "limp": False, "force_n": state.force, "current_a": 0.1 + 0.05 * state.force,
            "touching": bool(state.active.any()),
            "block": {"width_mm": 1000 * WIDTH, "height_mm": 1000 * HEIGHT, "thickness_mm": 1000 * THICK},
            "surface_mm": (1000 * (mesh.points + state.block.u)[top]).tolist(),
            "indenter": {"kind": "cylinder", "outline_mm": circle.tolist()},
            "cells": {
                label: {"centre_mm": list(centre), "side_mm": 5.0, "pressure_kpa": kpa[label]}
                for label, centre in zip(LABELS, CELLS_MM, strict=True)
            },
        }  # fmt: skip

    def fields(self):
        """Return its fields, as the bench's observer does."""
        mesh, block = self.press.block.mesh, self.state.block
        return {
            "points_mm": 1000 * mesh.points, "triangles": mesh.triangles.T, "displacement_mm": 1000 * block.u,
            "stress_kpa": block.stress.T / 1000, "von_mises_kpa": von_mises(block.stress) / 1000,
            "strain": block.strain.T[:, [0, 1, 3]],
        }  # fmt: skip


def recorded_press(moves=SCENARIO_B, observed=True, **block):
    """Return the Recording of a press that makes these moves (seconds, to depth), a record each 50 ms."""
    seen = PressedBlock(**block)
    recording = Recording((), "press-hold-release.gait on sim:press", joints=("P",), unit="mm", cells=LABELS)
    recording.note(Event(1000, 0, "started", 0, 0, None, 0))
    recording.mesh = mesh_of(seen.fields()) if observed else None
    depth, count = 0.0, 0
    for seconds, to_depth in moves:
        steps = round(seconds / STEP_S)
        for i in range(1, steps + 1):
            now_ms = round(1000 * STEP_S) * count
            recording.note(_telemetry(seen, now_ms))
            if observed:
                recording.look(seen, 1000 + now_ms)
            if observed and count % EVERY == 0:
                recording.slices.append(slice_of(seen.fields(), now_ms / 1000, 1000 + now_ms))
            seen.push(depth + (to_depth - depth) * i / steps)
            count += 1
        depth = to_depth
    return recording


def _telemetry(seen, now_ms):
    force, depth_mm = seen.state.force, 1000 * seen.state.depth
    return Telemetry(
        host_ms=1000 + now_ms, now_ms=now_ms, state="running", step=1, supply_mv=6000,
        current_ma=round(100 + 50 * force), board_degc=26.5, duty_permille=(), temperature_degc=(),
        joint_position=(round(depth_mm, 2),),
        commanded_position=(depth_mm,), joint_ma=(round(100 + 50 * force),), load_n=round(force / 0.008) * 0.008,
        cell_kpa=tuple(round(kpa / 0.00488) * 0.00488 for kpa in seen.cell_kpa().values()),
    )  # fmt: skip
