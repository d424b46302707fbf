r"""Steps in float64: how far a Taylor series may be trusted, sums that keep what they round, angles that are wrapped.

The step is ``h = rho tol**(1/(p+1))`` with ``rho = min |w_m|**(-1/(m+1))`` over the last four coefficients of the
rates, m = p-3, ..., p; a single coefficient may vanish by symmetry, as for a chain released from horizontal.  The
truncation error of an angle in one step is then about ``tol``.  No rod turns by more than 1.5 rad in a step.

Angles are held as ``turns * 2 pi + high + low`` with ``|high| <= pi``, rates and the time as ``high + low``, so that
a step loses no more than the rounding of its own increment.
"""

from __future__ import annotations

from math import exp, log
from typing import Any

import numpy as np

from .angles import TURN, TURN_LOW, difference, revolved, sines
from .machine import inlined
from .taylor import FACTORS, expand, factor, series_shape

__all__ = ["DONE", "MORE", "STUCK", "advance", "room"]

MORE, DONE, STUCK = 0, 1, 2
PI = float.fromhex("0x1.921fb54442d18p+1")
FARTHEST = 1.5  # rad, for a rod in a step: the series of its sine and cosine lose exp(1.5) in rounding


@inlined
def total(a: Any, b: Any) -> tuple[Any, Any]:
    """``a + b`` as the nearest float and the exact remainder."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


def joints(state: Any, s: Any, c: Any, delta: Any) -> None:
    """Sine and cosine of every joint angle, and the angle itself, from the state (5, n), see :func:`advance`."""
    for k in range(state.shape[1]):
        if k == 0:
            d, e = state[0, 0], state[1, 0]
            turns = state[2, 0]
        else:
            d, e = difference(state[0, k], state[0, k - 1])
            e = e + (state[1, k] - state[1, k - 1])
            turns = state[2, k] - state[2, k - 1]
        s[k], c[k] = sines(d, e)
        delta[k] = d + turns * TURN


def shake(waves: Any, clock: Any, pull: Any) -> None:
    """Taylor coefficients about the time ``clock`` of the acceleration of the first joint; rows as in Shaking."""
    order = pull.shape[1]
    for j in range(order):
        pull[0, j] = 0.0
        pull[1, j] = 0.0
    for i in range(waves.shape[0]):
        q = waves[i, 0]
        s, c = revolved(waves[i, 1], waves[i, 2], clock[0], clock[1])
        for j in range(order):
            pull[0, j] += waves[i, 3] * c + waves[i, 4] * s
            pull[1, j] += waves[i, 5] * c + waves[i, 6] * s
            s, c = c * q / (j + 1), -s * q / (j + 1)


def reach(series: Any, order: int, tolerance: float) -> float:
    """The length of the step; infinite at rest."""
    rho = np.inf
    for m in range(order - 3, order + 1):
        largest = 0.0
        for k in range(series.shape[0]):
            size = abs(series[k, 2, order - m])
            largest = size if size > largest else largest
        if largest > 0.0:
            here = exp(-log(largest) / (m + 1))
            rho = here if here < rho else rho
    return rho * exp(log(tolerance) / (order + 1))


@inlined
def increments(series: Any, k: int, order: int, h: float) -> tuple[float, float]:
    """How far angle and rate of rod k move in the time h."""
    rate = series[k, 2, 0]
    angle = rate / (order + 1)
    for m in range(1, order):
        angle = angle * h + series[k, 2, m] / (order + 1 - m)
        rate = rate * h + series[k, 2, m]
    return (angle * h + series[k, 2, order]) * h, rate * h


def move(series: Any, order: int, h: float, state: Any) -> None:
    """Add the increments to the state, wrap the angles, count the turns."""
    for k in range(state.shape[1]):
        angle, rate = increments(series, k, order, h)
        high, low = total(state[0, k], angle)
        low += state[1, k]
        if abs(high) > PI:
            turn = 1.0 if high > 0.0 else -1.0
            high, extra = difference(high, turn * TURN)
            low += extra - turn * TURN_LOW
            state[2, k] += turn
        state[0, k], state[1, k] = total(high, low)
        high, low = total(state[3, k], rate)
        state[3, k], state[4, k] = total(high, low + state[4, k])


def room(n: int, order: int) -> tuple[Any, ...]:
    """The arrays that :func:`advance` works in: for joints, factors, intermediate values and series."""
    return np.empty((3, n)), np.empty((n, FACTORS)), np.empty((n, 6)), np.empty(series_shape(n, order))


def advance(rods: Any, damping: Any, springs: Any, pull: Any, waves: Any, tolerance: float, state: Any, clock: Any,
            times: Any, found: int, out: Any, most: int, record: Any, space: Any) -> Any:
    """Step until ``most`` steps are made or all times are reached.  Returns the outcome, steps and times found.

    Shapes: rods (n, 8); damping, springs (n,) or None; pull (2, order), Taylor coefficients of the acceleration of
    the first joint, written at every step where there are waves, (w, 7) or None; state (5, n): angle high, low, turns,
    rate high, low; clock (2,), the time high, low; times (m, 2) likewise, of which ``found`` are done; out (m, 3, n):
    angle, turns, rate; record (most, 2 + n (order + 4)) or None: start and length of each step, state and rates'
    series of each rod; space as :func:`room` gives it.
    """
    n, order = rods.shape[0], pull.shape[1]
    joint, factors, held, series = space
    s, c, delta = joint[0], joint[1], joint[2]
    end, end_low = times[times.shape[0] - 1]
    for step in range(most):
        joints(state, s, c, delta)
        factor(rods, s, c, 1.0, factors)
        if waves is not None:
            shake(waves, clock, pull)
        series[:] = 0.0
        expand(factors, damping, springs, delta, state[3], pull[0], pull[1], order, 1.0, held, series)
        remaining = (end - clock[0]) + (end_low - clock[1])
        h = reach(series, order, tolerance)
        longest = 2.0 * abs(remaining) + 1e-14 * abs(clock[0]) + 1e-300
        for k in range(n):
            if longest * abs(state[3, k]) > FARTHEST:
                longest = FARTHEST / abs(state[3, k])
        h = h if h < longest else longest
        if remaining != 0.0 and not h > 1e-15 * abs(clock[0]):
            return STUCK, step, found
        if remaining < 0.0:
            h = -h
        if record is not None:
            row = record[step]
            row[0], row[1] = clock[0] + clock[1], h
            for k in range(n):
                at = 2 + k * (order + 4)
                row[at], row[at + 1], row[at + 2] = state[0, k], state[1, k], state[2, k]
                for j in range(order + 1):
                    row[at + 3 + j] = series[k, 2, order - j]
        while found < times.shape[0]:
            ahead = (times[found, 0] - clock[0]) + (times[found, 1] - clock[1])
            if abs(ahead) > abs(h):
                break
            for k in range(n):
                angle, rate = increments(series, k, order, ahead)
                out[found, 0, k] = state[0, k] + (state[1, k] + angle)
                out[found, 1, k] = state[2, k]
                out[found, 2, k] = state[3, k] + (state[4, k] + rate)
            found += 1
        if found == times.shape[0]:
            return DONE, step + 1, found
        move(series, order, h, state)
        now, low = total(clock[0], h)
        clock[0], clock[1] = total(now, low + clock[1])
    return MORE, most, found
