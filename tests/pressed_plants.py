"""Presses driven by hand, without board or firmware: the servo is told every 5 ms where to go."""

import numpy as np

from hil_sim.address import parse
from hil_sim.bodies.press import PressPlant
from hil_sim.robots.file import load

TICK_US = 5_000
COARSE = "block.columns_count:16", "block.rows_count:8"
STIFF_SERVO = "axis.bandwidth_rad_per_s:1000", "axis.rate_mm_per_s:1000", "axis.stall_force_n:100000"


def plant_of(*numbers, options="", coarse=True):
    """Return the press with other numbers, section.key:value, and other options of an address."""
    rows = "&".join(f"set={number}" for number in ((*COARSE, *numbers) if coarse else numbers))
    address = parse(f"sim:press?{rows}{'&' if rows and options else ''}{options}")
    return PressPlant(load(address.robot, address.overrides))


def drive(plant, seconds, order):
    """Drive a plant for some time; `order` says where to go [mm] at each time from now on [s]. Yield it each 5 ms."""
    began_s = plant.t_s
    for tick in range(1, round(seconds * 1e6 / TICK_US) + 1):
        plant.command([order(tick * TICK_US * 1e-6) if callable(order) else order])
        plant.advance(TICK_US, np.zeros(0))
        yield plant.t_s - began_s


def driven(plant, seconds, order):
    """Drive a plant for some time and return it."""
    for _ in drive(plant, seconds, order):
        pass
    return plant


def push_hold_lift(t, lift=8.0):
    """Return the depth [mm] of scenario B."""
    return max(-3.0, min(2.0 * t, 4.0) - lift * max(0.0, t - 5.0))
