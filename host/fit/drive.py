"""How the axis of a press follows what it is told: with a lag of first order, after a delay.

What it is told is known exactly, what is measured only to a hundredth of a millimetre, and a dashpot feels the speed.
So the depth that a fit uses is what the axis was told, lagged, and the measured one says how much. Means over a tenth
of a second are compared: single readings of 0.01 mm would fit the steps of the commands.

    lag = lag_of(press)                          # refuses an axis that did not follow
    lagged(press.t, press.command, lag.delay_s, lag.lag_s)
"""

from __future__ import annotations

from math import exp
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from host.errors import BadRequest
from host.fit.trace import Press

Floats = NDArray[np.float64]
FORGOTTEN_S = 0.3  # of the record's beginning, in which the axis still answers to what it was told before
ASTRAY_MM = 0.05  # root mean square
FIRST_S = (0.003, 0.02, 0.06)  # lags to begin from: there is more than one least


class Lag(NamedTuple):
    """How an axis follows."""

    delay_s: float
    lag_s: float
    offset_mm: float  # measured, where it should be 0
    rms_mm: float  # that the measured depth is elsewhere


def lagged(t: Floats, command: Floats, delay_s: float, lag_s: float) -> Floats:
    """Return where an axis is that was told `command` [mm], linear between times t [s], and was there at first."""
    told = np.interp(t - delay_s, t, command)
    at, found = float(told[0]), [float(told[0])]
    dt = np.diff(t)
    for step, begin, end in zip(dt.tolist(), told[:-1].tolist(), told[1:].tolist(), strict=True):
        behind = (end - begin) / step * lag_s
        at = end - behind + (at - begin + behind) * exp(-step / lag_s)
        found.append(at)
    return np.array(found)


def lag_of(press: Press) -> Lag:
    """Return how the axis followed; BadRequest when it did not."""
    seen = press.t[press.stretches] >= FORGOTTEN_S

    def off(p: Floats) -> Floats:
        return press.means(press.depth - lagged(press.t, press.command, p[0], p[1]))[seen] - float(p[2])

    limits = ([-0.1, 1e-4, -1.0], [0.3, 1.0, 1.0])
    tried = [least_squares(off, [0.0, first_s, 0.0], bounds=limits, x_scale=[0.01, 0.01, 0.01]) for first_s in FIRST_S]
    found = min(tried, key=lambda each: float(each.cost))
    rms_mm = float(np.sqrt(np.mean(found.fun**2)))
    if rms_mm > ASTRAY_MM:
        raise BadRequest(
            f"the axis was not where it was told to be, {rms_mm:.2f} mm off (root mean square): it stalled, or was too"
            " slow for the push; press more slowly or less deep"
        )
    delay_s, lag_s, offset_mm = (float(each) for each in found.x)
    return Lag(delay_s, lag_s, offset_mm, rms_mm)
