r"""From exact initial values to float64 states at the times asked, by Taylor steps, some thousands at a go.

An angle enters as ``turns * 2 pi + high + low``, exact to 32 digits, so that a start at ``pi/2`` is a start at
``pi/2`` and not at the float next to it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from sympy import N, Rational, pi

from .chain import CompiledChain
from .errors import QuantityError
from .machine import machine
from .stepper import DONE, STUCK, TURN, TURN_LOW, advance

__all__ = ["FloatRun", "integrate_floats", "split", "wrapped"]

ORDER = 20  # and beyond it float64 gains nothing
FINEST = 3e-17  # truncation a step that is lost in rounding


@dataclass(frozen=True)
class FloatRun:
    """Angles within one turn, whole turns and rates, shape (times, n) each; steps made; and the steps, where kept."""

    angle: Any
    turns: Any
    omega: Any
    steps: int
    order: int
    record: Any = field(repr=False, default=None)

    @property
    def theta(self) -> Any:
        """Angles with their turns; rad."""
        return self.angle + TURN * self.turns


def split(values: Any, angles: bool) -> Any:
    """Exact numbers, or floats, as rows high, low, turns; shape (3, n); turns are 0 unless they are angles."""
    if isinstance(values, np.ndarray) and values.dtype != object:
        turns = np.rint(values / TURN) if angles else np.zeros_like(values)
        high = turns * TURN
        # the low half of turns * TURN, by Dekker's product
        split_turn = 134217729.0 * TURN - (134217729.0 * TURN - TURN)
        a = 134217729.0 * turns
        a = a - (a - turns)
        b, rest = turns - a, TURN - split_turn
        low = ((a * split_turn - high) + a * rest + b * split_turn) + b * rest
        return np.stack([values - high, -low - turns * TURN_LOW, turns])
    out = np.zeros((3, len(values)))
    for k, x in enumerate(values):
        whole = round(float(N(x / (2 * pi), 20))) if angles else 0
        rest = x - 2 * pi * whole
        nearest = float(N(rest, 40))
        out[:, k] = nearest, float(N(rest - Rational(nearest), 40)), whole
    return out


def wrapped(angle: Any, turns: Any) -> tuple[Any, Any]:
    """The same angles with ``|angle| <= pi``."""
    more = np.rint(angle / TURN)
    return (angle - more * TURN) - more * TURN_LOW, turns + more


def integrate_floats(chain: CompiledChain, theta: Any, omega: Any, times: Any, order: int, tolerance: float,
                     rods: Any = None, keep: bool = False, progress: Callable[[float], None] | None = None) -> FloatRun:
    """The motion at ``times``, float64, monotone, from the state at the first of them.

    ``theta`` and ``omega`` as :func:`split` takes them; ``rods`` replaces the chain's constants; ``keep`` keeps every
    step's series.  Raises DriveError where the support has no Taylor series, QuantityError where steps shrink to
    nothing.
    """
    n = len(chain)
    state, clock = np.zeros((5, n)), np.array([times[0], 0.0])
    state[:3], state[3:] = split(theta, True), split(omega, False)[:2]
    out, record, kept = np.empty((len(times), 3, n)), np.empty((0, 0)), []
    most = max(1, 100_000 // n)
    given = chain.support.function is not None
    found = steps = 0
    while True:
        constant, waves = _shaking(chain, clock, order, given)
        if keep:
            record = np.empty((min(most, 4096), 2 + n * (order + 4)))
        outcome, made, found = machine(advance)(
            chain.rods if rods is None else rods, chain.damping, chain.springs, constant, waves, order, tolerance,
            state, clock, times, found, out, 1 if given else record.shape[0] or most, record)
        steps += made
        if keep:
            kept.append(record[:made])
        if outcome == STUCK or not np.isfinite(state).all():
            raise QuantityError(
                f"the motion cannot be followed beyond t = {clock[0]:.6g}: the step shrinks to nothing there, at "
                f"rates up to "
                f"{abs(state[3]).max():.3g} rad/s.  Rods without mass between others snap taut; give them a mass.")
        if progress is not None:
            progress(float(clock[0]))
        if outcome == DONE:
            angle, turns = wrapped(out[:, 0], out[:, 1])
            return FloatRun(angle, turns, out[:, 2], steps, order, np.concatenate(kept) if keep else None)


def _shaking(chain: CompiledChain, clock: Any, order: int, given: bool) -> tuple[Any, Any]:
    """The acceleration of the first joint: its steady part, or its series about now, and its waves."""
    g = float(chain.gravity.evalf(30))
    if given:
        ax, ay = chain.support.series(float(clock[0] + clock[1]), order, None)
        constant, waves = np.array([ax, ay], dtype=float), np.zeros((0, 5))
    else:
        steady, waves = chain.support.floats
        constant, waves = steady.reshape(2, 1).copy(), waves.copy()
    constant[1, 0] += g
    constant[1] *= chain.up
    waves[:, 3:] *= chain.up
    return constant, waves
