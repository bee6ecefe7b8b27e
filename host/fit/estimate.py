"""Estimates of a material from the force of one press, by least squares on the closed form, with their confidence.

Beside the material four numbers of the apparatus are fitted: the depth at which it touches, the load cell's zero, the
delay of force against command, and the axis' lag near that of its measured depth. What is compared are means over a
tenth of a second, measured and modelled alike: the small steps of a servo between two readings are nobody's to know.
They count by the noise of their kind, while the axis moves and while it stands. Errors are those of linear theory,
widened where residuals go together from mean to mean.

    found = estimate(press, shape_m=0.0459)
    found.values["E"].value, found.values["E"].low, found.values["E"].high     # [Pa], 95 %
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, least_squares
from scipy.stats import t as student

from host.errors import BadRequest
from host.fit.drive import Lag, lag_of, lagged
from host.fit.law import Material, force
from host.fit.trace import Press

Floats = NDArray[np.float64]
CONFIDENCE = 0.95
ROUNDS = 4  # of fitting and weighing
STILL_MM_PER_S = 0.05
LAGS_MAX = 10  # means apart that residuals may go together
LAG_KNOWN_S = 0.01  # ASSUMED: how well readings of 0.01 mm tell the lag of an axis
BELOW_MM = 0.02  # the least depth that the axis had: where it touches is not told apart from there
MATERIAL = ("E", "c1", "c2", "E0")
UNTOLD = 10.0  # error over value beyond which nothing was found
MISFIT = 1.5  # residual over noise beyond which another law is at work


class Value(NamedTuple):
    """An estimate with its standard error and the bounds of its confidence interval, in SI units."""

    value: float
    error: float
    low: float
    high: float


@dataclass(frozen=True)
class Found:
    """What a press tells of its block, and how well."""

    values: dict[str, Value]  # E, c1, c2, E0 where it was fitted, and tau = c1 / E
    correlation: dict[tuple[str, str], float]
    rms_n: float  # of the residual
    noise_n: float  # of the load cell, by the differences from reading to reading while the axis stands
    misfit: float  # residual over noise while the axis stands: 1 where the law holds
    touch_mm: float
    zero_n: float
    lag: Lag
    modelled: Floats  # force at the readings [N]


def estimate(press: Press, shape_m: float, spring: bool = False) -> Found:
    """Return the material; with `spring` also the modulus E0 of a spring beside the dashpots. BadRequest: no fit."""
    lag = lag_of(press)
    problem = _Problem(press, shape_m, lag, spring)
    weights = np.ones(len(press.stretches))
    start = problem.guess()
    for _ in range(ROUNDS):
        solved = least_squares(problem.off, start, bounds=problem.bounds, x_scale=problem.scale, args=(weights,))
        start = solved.x
        weights = problem.weights(problem.off(solved.x, np.ones_like(weights))[:-1])
    if not solved.success:
        raise BadRequest("the fit does not settle: the force is not that of a block that is pushed and held")
    return _told(press, problem, solved, lag)


def spring_beside(press: Press, shape_m: float) -> Value | None:
    """Return the modulus [Pa] of a spring beside the dashpots if the force tells one that is there, None if not."""
    try:
        found = estimate(press, shape_m, spring=True).values["E0"]
    except BadRequest:
        return None
    return found if found.low > 0.0 else None


class _Problem:
    """The force of a press as a function of what is fitted, scaled to kPa, mm and N."""

    def __init__(self, press: Press, shape_m: float, lag: Lag, spring: bool) -> None:
        self.press, self.shape_m, self.lag = press, shape_m, lag
        self.names = MATERIAL[: 4 if spring else 3]
        axis = lagged(press.t, press.command, lag.delay_s, lag.lag_s)
        self.moves = np.abs(np.gradient(axis, press.t)) > STILL_MM_PER_S
        self.deepest_mm = float(axis.max())
        self.still = press.means(self.moves.astype(float)) == 0.0
        low, high = [1e-6, 1e-6, 0.0, 0.0][: len(self.names)], [np.inf] * len(self.names)
        least, most = [float(axis.min()) - BELOW_MM, -5.0, -0.1, 1e-4], [self.deepest_mm, 5.0, 0.3, 1.0]
        self.bounds = [*low, *least], [*high, *most]
        self.scale = [*self.guess()[:2], *[0.1 * self.guess()[0]] * (len(self.names) - 2), 0.01, 0.01, 0.01, 0.01]

    def guess(self) -> list[float]:
        """Return a beginning: a spring that gives the greatest force, and relaxes as the hold shows."""
        press = self.press
        held = press.force[press.t >= press.held_from_s]
        few = max(1, len(held) // 10)
        first, last = float(np.mean(held[:few])), float(np.mean(held[-few:]))
        tau = press.hold_s / max(0.02, np.log(max(first, 1e-3) / max(last, 1e-3 * abs(first), 1e-3)))
        touch_mm = float(np.interp(press.touched_s, press.t, press.depth))
        E = 1.3 * max(first, 1e-3) / (self.shape_m * max(0.01, self.deepest_mm - touch_mm))
        guessed = [E, E * tau, 0.1 * E, 0.02 * E][: len(self.names)]
        return [*guessed, min(touch_mm, 0.9 * self.deepest_mm), 0.0, self.lag.delay_s, self.lag.lag_s]

    def modelled(self, p: Floats) -> Floats:
        """Return the force at the readings [N]."""
        press, count = self.press, len(self.names)
        touch_mm, zero_n, delay_s, lag_s = p[count:]
        axis = lagged(press.t, press.command, delay_s, lag_s)
        into = np.maximum(axis - touch_mm, 0.0)
        block: Floats = force(Material(*(1e3 * p[:count])), press.t, 1e-3 * into, self.shape_m)
        return block + float(zero_n)

    def off(self, p: Floats, weights: Floats) -> Floats:
        """Return the weighted residuals of the means, and at last that of the lag, by the measured depth."""
        residuals = self.press.means(self.press.force - self.modelled(p)) * weights
        return np.append(residuals, (p[-1] - self.lag.lag_s) / LAG_KNOWN_S)

    def weights(self, off: Floats) -> Floats:
        """Return what means count by the noise of their kind."""
        found = np.ones_like(off)
        for kind in (self.still, ~self.still):
            if kind.any():
                found[kind] = 1.0 / max(float(np.sqrt(np.mean(off[kind] ** 2))), 1e-9)
        return found


def _told(press: Press, problem: _Problem, solved: OptimizeResult, lag: Lag) -> Found:
    """Return what was found, with its confidence."""
    count = len(problem.names)
    free = max(1.0, len(solved.fun) / _together(solved.fun[:-1]) - len(solved.x))
    covariance, p = _covariance(solved.jac)[:count, :count] * float(solved.fun @ solved.fun) / free, solved.x[:count]
    reach = float(student.ppf(0.5 + 0.5 * CONFIDENCE, free))
    errors = np.sqrt(np.diag(covariance))
    if not (errors[:2] < UNTOLD * p[:2]).all():
        raise BadRequest("the press does not tell the parts of the material apart: push more, and hold it for longer")
    values = {name: _value(1e3 * v, 1e3 * e, reach) for name, v, e in zip(problem.names, p, errors, strict=True)}
    slope = np.array([-p[1] / p[0] ** 2, 1.0 / p[0]])
    values["tau"] = _value(p[1] / p[0], float(np.sqrt(slope @ covariance[:2, :2] @ slope)), reach)
    pairs = [(i, j) for i in range(count) for j in range(i)]
    correlation = {
        (problem.names[j], problem.names[i]): float(covariance[i, j] / (errors[i] * errors[j])) for i, j in pairs
    }
    modelled = problem.modelled(solved.x)
    off, stands = press.force - modelled, ~problem.moves & (press.t > press.held_from_s)
    noise = float(np.std(np.diff(off[stands])) / np.sqrt(2.0))
    misfit = float(np.std(off[stands])) / max(noise, 1e-9)
    rms = float(np.sqrt(np.mean(off**2)))
    touch_mm, zero_n = (float(each) for each in solved.x[count : count + 2])
    return Found(values, correlation, rms, noise, misfit, touch_mm, zero_n, lag, modelled)


def _covariance(jacobian: Floats) -> Floats:
    """Return the covariance for residuals of variance 1; what they do not depend on has none."""
    size = np.linalg.norm(jacobian, axis=0)
    size[size == 0.0] = 1.0
    spread: Floats = np.linalg.pinv((jacobian / size).T @ (jacobian / size), hermitian=True)
    return spread / np.outer(size, size)


def _together(off: Floats) -> float:
    """Return how many means tell as much as one would whose error were its own: 1 where errors are independent."""
    off = off - off.mean()
    whole, total = float(off @ off), 1.0
    for apart in range(1, min(LAGS_MAX, len(off) // 4)):
        share = float(off[:-apart] @ off[apart:]) / whole if whole else 0.0
        if share <= 0.0:
            break
        total += 2.0 * share
    return total


def _value(value: float, error: float, reach: float) -> Value:
    return Value(float(value), float(error), float(value - reach * error), float(value + reach * error))
