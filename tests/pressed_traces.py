"""Made-up logs of a press on a block of one dimension: a servo that lags, readings in steps, a noisy load cell.

The block is advanced as the bench's is, in steps of its own with the constant-rate update of physics/block/material.py;
the rest are the numbers of hil_sim/robots/press.toml.
"""

from math import floor
from pathlib import Path

import numpy as np

from hil_sim.physics.block.material import Material, Maxwell, update_of
from host.logbook import Log

STEP_S, BLOCK_S, READ_S = 0.005, 0.010, 0.010
LAG_S = 1.0 / 60.0
SHAPE_M = 0.0459
PUSH = ((0.5, 0.0), (2.0, 4.0), (3.0, 4.0), (0.75, -2.0), (0.5, -2.0))  # seconds, to depth [mm]


def rheological(E=60e3, c1=300e3, c2=6e3, E0=0.0):
    """Return a material of three or four elements."""
    return Material((Maxwell(E, c1),), E0=E0, c0=c2)


def commands(moves):
    """Return what the servo is told in each step, hundredths of a millimetre, from 0 on."""
    told, at = [], 0.0
    for seconds, to in moves:
        count = round(seconds / STEP_S)
        told += [at + (to - at) * k / count for k in range(1, count + 1)]
        at = to
    return [floor(100 * each + 0.5) for each in told]


def pressed(material, told, shape_m=SHAPE_M):
    """Return axis [mm] and force [N] at each step of a servo that is told so, from 0 on."""
    update = update_of(material, BLOCK_S)
    keep, gain, elastic = update.keep[0], update.gain[0, 0, 0], update.C0[0, 0]
    scale = material.branches[0].E / (update_of(material, 1e-9).gain[0, 0, 0])  # from the confined modulus to Young's
    axis = depth = q = force = 0.0
    rows = []
    for k, target in enumerate(told):
        axis = target / 100 + (axis - target / 100) * np.exp(-STEP_S / LAG_S)
        if k % round(BLOCK_S / STEP_S) == 1:
            moved, depth = max(axis, 0.0) - depth, max(axis, 0.0)
            q = keep * q + scale * gain * moved
            rate = moved / BLOCK_S
            force = 1e-3 * shape_m * (scale * elastic * depth + material.c0 * rate + q) if axis > 0 else 0.0
            force = max(force, 0.0)
        rows.append((axis, force))
    return rows


def log_of(material, moves=PUSH, noise_n=0.02, seed=0, every=2, shape_m=SHAPE_M):
    """Return a log of that press, with a reading each `every` steps; the block is as the robot's file has it."""
    noise = np.random.default_rng(seed)
    told = commands(moves)
    log = Log(Path("press.mcap"))
    log.rows["telemetry"] = [{"joint_mm": {"P": 0.0}}]
    log.rows["samples"] = [
        {
            "host_ms": 5 * k + 30, "now_ms": 5 * k, "slot": 1,
            "values": {
                "load_mn": 8 * floor((1000 * force + 1000 * noise_n * noise.standard_normal()) / 8),
                "joint_centi": {"P": floor(100 * axis + 0.5)}, "commanded_centi": {"P": target},
            },
        }
        for k, ((axis, force), target) in enumerate(zip(pressed(material, told, shape_m), told, strict=True))
        if k % every == 0
    ]  # fmt: skip
    return log
