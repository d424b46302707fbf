r"""From exact initial values to float64 states at the times asked, by Taylor steps, some thousands at a go.

An angle enters as ``turns * 2 pi + high + low``, exact to 32 digits, so that a start at ``pi/2`` is a start at
``pi/2`` and not at the float next to it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import mpmath
import numpy as np
from sympy import Rational, floor, pi

from .angles import TURN, TURN_LOW, product
from .chain import CompiledChain
from .constants import EPSILON, unsettled
from .errors import QuantityError
from .frozen import locked
from .machine import machine
from .pace import Pace
from .quantities import high_low, quantity
from .states import within_floats
from .stepper import DONE, STUCK, advance, room, total

__all__ = ["FloatRun", "integrate_floats", "split", "wrapped"]

LARGEST = 1e15  # rad: larger angles turn more often than floats count
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
    """Exact numbers, or floats, as rows high, low, turns; shape (3, n); turns are 0 unless they are angles.

    What is split already, (3, n), stays as it is.
    """
    if np.ndim(values) == 2:
        return values
    if isinstance(values, np.ndarray) and values.dtype != object:
        if not angles:
            return np.stack([values, 0 * values, 0 * values])
        if (abs(values) < LARGEST).all():
            turns = np.rint(values / TURN)
            whole, rest = product(turns, TURN)
            return np.stack([*total(values - whole, -rest - turns * TURN_LOW), turns])
    out = np.zeros((3, len(values)))
    for k, x in enumerate(values):
        exact = quantity(x, "a state")
        whole = _nearest_turns(exact) if angles and abs(exact) > 3 else 0
        within_floats(exact, "a state")
        out[:, k] = *high_low(exact - 2 * pi * whole if whole else exact), whole
    return out


def _nearest_turns(exact: Any) -> int:
    digits = 20 + max(0, int(0.302 * mpmath.mag(exact.evalf(5))))  # of them 20 after the point
    return int(floor((exact / (2 * pi)).evalf(digits) + Rational(1, 2)))


def wrapped(angle: Any, turns: Any) -> tuple[Any, Any]:
    """The same angles with ``|angle| <= pi``."""
    more = np.rint(angle / TURN)
    return (angle - more * TURN) - more * TURN_LOW, turns + more


def integrate_floats(chain: CompiledChain, theta: Any, omega: Any, times: Any, order: int, tolerance: float,
                     moved: int = 0, keep: bool = False, progress: Callable[[float], None] | None = None) -> FloatRun:
    """The motion at ``times``, monotone, from the state at the first of them.

    ``theta``, ``omega`` and ``times`` as :func:`split` takes them; ``moved``, 1 or -1, moves whatever has been rounded,
    constants, weight and waves, this way or that; ``keep`` keeps every step's series.  Raises DriveError where the
    support has no Taylor series, QuantityError where steps shrink to nothing.
    """
    n, rods = len(chain), unsettled(chain.rods.copy(), moved)  # what is read only would be translated again
    damping, springs = (None if x is None else locked(unsettled(x, moved)) for x in (chain.damping, chain.springs))
    marks = np.ascontiguousarray(split(times, False)[:2].T)
    state, clock = np.zeros((5, n)), marks[0].copy()
    state[:3], state[3:] = split(theta, True), split(omega, False)[:2]
    out, kept = np.empty((len(marks), 3, n)), []
    record: Any = None
    most = 1 if chain.support.function is not None else max(1, 100_000 // n)
    most = min(most, 4096) if keep else most
    found, steps, space, pace = 0, 0, room(n, order), Pace()
    while True:
        pull, waves = _shaking(chain, clock, order, moved)
        if keep:
            record = np.empty((most, 2 + n * (order + 4)))
        outcome, made, found = machine(advance)(
            rods, damping, springs, pull, waves, tolerance, state,
            clock, marks, found, out, most, record, space)
        steps += made
        if keep:
            kept.append(record[:made])
        crawls = most == 1 and pace.crawls(clock[0], marks[-1, 0])
        if outcome == STUCK or crawls or not np.isfinite(out if outcome == DONE else state).all():
            raise QuantityError(
                f"the motion cannot be followed beyond t = {clock[0]:.6g}: the step shrinks to nothing there, at "
                f"{_rates(state[3])} rad/s.  {_reason(chain)}")
        if progress is not None:
            progress(float(marks[-1, 0] if outcome == DONE else clock[0]))
        if outcome == DONE:
            angle, turns = wrapped(out[:, 0], out[:, 1])
            return FloatRun(angle, turns, out[:, 2], steps, order, np.concatenate(kept) if keep else None)


def _rates(omega: Any) -> str:
    fastest = abs(omega).max()
    return f"rates up to {fastest:.3g}" if np.isfinite(fastest) else "rates beyond any float in"


def _reason(chain: CompiledChain) -> str:
    mass = chain.rods[:, 0]
    if mass.min() < 1e-12 * mass.max():
        return "Rods without mass between others snap taut; give them a mass."
    if chain.support.function is not None:
        return "End before it, if the support's motion is not smooth there."
    return "Numbers beyond the range of floats need digits, such as simulate(..., digits=20)."


def _shaking(chain: CompiledChain, clock: Any, order: int, moved: int) -> tuple[Any, Any]:
    """The series about now of the acceleration of the first joint, shape (2, order), and its waves or None.

    Where there are waves its steady part is one of them, of frequency 0, and the series is left to them.  A function
    of time is given a float, whose rounding it may amplify, and what it gives is exact unless an expression stands for
    it.  ``moved`` moves all that is rounded: the sum of weight and support, and what that is the sum of.
    """
    up, pull = chain.up, np.zeros((2, order))
    if chain.support.function is not None:
        now = float(clock[0] + clock[1]) * (1.0 + moved * EPSILON)
        pull[:] = np.array(chain.support.series(now, order, None), dtype=float)[:, :order]
        if chain.support.is_exact:
            pull = unsettled(pull, moved)
        pull[1, 0] = chain.add_weight(pull[1, 0])
        pull[1] *= up
        return unsettled(pull, -moved), None
    pull[:, 0], waves = unsettled(np.array(chain.steady_pull), -moved), chain.support.floats[1]
    if not len(waves):
        return pull, None
    waves = waves * np.array([1.0, 1.0, 1.0, 1.0, 1.0, up, up])
    waves[:, [0, 3, 4, 5, 6]] = unsettled(waves[:, [0, 3, 4, 5, 6]], -moved)  # the first against the weight
    return pull, np.concatenate([[[0.0, 0.0, 0.0, pull[0, 0], 0.0, pull[1, 0], 0.0]], waves])
