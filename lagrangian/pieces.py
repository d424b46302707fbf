r"""A motion as pieces, the steps that were made: in each, every angle is a polynomial of the time since its start.

The polynomials are the Taylor series that the steps were made with, so that nothing is interpolated: between the
times asked for a state has the digits that it has at them.  There are two kinds of numbers:

    float64    an angle is ``high + low`` and whole turns, its polynomial rows of coefficients
    balls      an angle with its turns is one python-flint polynomial, evaluated with the bits of the motion; results
               are mpmath numbers.  They serve double-double too, whose pairs are exact in them

What is done with pieces is written once: which of them holds a time, here, and when an angle passes a value, in
:mod:`lagrangian.crossings`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import flint
import numpy as np
from sympy import pi

from .angles import TURN, TURN_LOW
from .arithmetic import Balls
from .digits import Piece, bits_for, magnitude, middle, numbers, whole_turns
from .errors import QuantityError, printed
from .floats import split
from .precision import working
from .quantities import quantity, refuse_text
from .stepper import total

__all__ = ["BallPieces", "FloatPieces", "Pieces"]


class Pieces:
    """The motion at any time between the first and the last that were asked for.

    Attributes
    ----------
    start, length : shape (steps,), numbers of the motion; length is negative in motions backwards; s
    forward : 1 or, in motions backwards, -1
    span : the least and the largest time that were asked for, numbers of the motion; the last step may lead beyond; s
    bits : of the numbers' mantissas
    """

    start: Any
    length: Any
    span: tuple[Any, Any]
    bits: int

    @property
    def forward(self) -> int:
        return 1 if self.length[0] >= 0 else -1

    def __call__(self, t: Any) -> tuple[Any, Any]:
        """Angles with turns, rad, and rates, rad/s, at one time, shape (n,), or at k, shape (k, n).

        Raises QuantityError where a time is none, or lies outside the span; TextError for text.
        """
        refuse_text(t, "t")
        if (axes := _axes(t)) > 1:
            raise QuantityError(f"t has shape {np.shape(t)}: give one time, or a list of times.")
        with working(self.bits):
            times = self.given(t)
            steps = self.holding(times)
            theta, omega = self.states(steps, times - self.start[steps])
        return (theta[0], omega[0]) if axes == 0 else (theta, omega)

    def holding(self, times: Any) -> Any:
        """The step that each time lies in; shape (k,)."""
        least, largest = self.span
        inside = (times >= least) & (times <= largest)
        if not inside.all():
            first, last, beyond = self.shown([least, largest, times[~inside][0]])
            raise QuantityError(f"the motion is known from t = {first} to {last}, and t is {beyond}: simulate it up to "
                                f"there.")
        return np.maximum(np.searchsorted(self.forward * self.start, self.forward * times, side="right") - 1, 0)

    def until(self, end: Any) -> Any:
        """The length of every step, cut off at ``end``; shape (steps,)."""
        left = self.plain(end - self.start)
        return np.where(self.forward * self.length <= self.forward * left, self.length, left)

    def given(self, t: Any) -> Any:
        """One time or many as numbers of the motion; shape (k,)."""
        raise NotImplementedError

    def shown(self, found: Sequence[Any]) -> Any:
        """Numbers of the motion as the user is given them; shape (k,)."""
        raise NotImplementedError

    def plain(self, x: Any) -> Any:
        """Numbers without the radius that arithmetic may have given them; any shape."""
        return x

    def states(self, steps: Any, h: Any) -> tuple[Any, Any]:
        """Angles with turns and rates the time ``h`` after the start of each step; shape (k, n) each."""
        raise NotImplementedError

    def goal(self, angle: Any, turn: int) -> Any:
        """The exact number ``angle + 2 pi turn`` as :meth:`beyond` takes it."""
        raise NotImplementedError

    def beyond(self, step: int, rod: int, goal: Any, h: Any) -> Any:
        """How far an angle is beyond a goal, modulo a turn, ``h`` after the start of a step; shape of h; rad."""
        raise NotImplementedError

    def whole_turns(self, angle: Any) -> int:
        """The turns nearest to an angle; exact, however many they are."""
        raise NotImplementedError

    def rate(self, step: int, rod: int, h: Any) -> Any:
        """The rate of a rod ``h`` after the start of a step; rad/s."""
        raise NotImplementedError


def _axes(t: Any) -> int:
    try:
        return np.ndim(t)
    except ValueError:  # lists of unequal length
        raise QuantityError(f"t is {printed(t, repr)}: give one time, or a list of times.") from None


def _exact(t: Any) -> list[Any]:
    """One time or many as exact SymPy numbers."""
    found = [quantity(x, "t") for x in np.atleast_1d(np.asarray(t, dtype=object))]
    for x in found:
        if not x.is_number:
            raise QuantityError(f"t holds {x}, which is no number: give numbers, such as 1/2 or pi.")
    return found


class FloatPieces(Pieces):
    """The steps of :func:`lagrangian.floats.integrate_floats` to ``times``, from its record."""

    bits = 53

    def __init__(self, record: Any, n: int, order: int, times: Any) -> None:
        self.span = times.min(), times.max()
        self.start, self.length = record[:, 0], record[:, 1]
        rows = record[:, 2:].reshape(-1, n, order + 4)
        self.high, self.low, self.turns, self.rates = rows[..., 0], rows[..., 1], rows[..., 2], rows[..., 3:]
        self.powers = self.rates / np.arange(1, order + 2)

    def given(self, t: Any) -> Any:
        found = np.atleast_1d(np.asarray(t))
        return found.astype(float) if found.dtype.kind in "fiu" else np.array([float(x) for x in _exact(t)])

    def shown(self, found: Sequence[Any]) -> Any:
        return np.array(found)

    def states(self, steps: Any, h: Any) -> tuple[Any, Any]:
        moved = _horner(self.powers[steps], h[:, None]) * h[:, None]
        theta = self.high[steps] + (self.low[steps] + moved) + self.turns[steps] * TURN
        return theta, _horner(self.rates[steps], h[:, None])

    def goal(self, angle: Any, turn: int) -> Any:
        high, low = split([angle], True)[:2, 0]
        high, rest = total(high, turn * TURN)
        return high, rest + (low + turn * TURN_LOW)

    def beyond(self, step: int, rod: int, goal: Any, h: Any) -> Any:
        high, rest = total(self.high[step, rod], -goal[0])
        return high + (rest + (self.low[step, rod] - goal[1]) + _horner(self.powers[step, rod], h) * h)

    def whole_turns(self, angle: Any) -> int:
        return round(float(angle) / TURN)

    def rate(self, step: int, rod: int, h: Any) -> Any:
        return _horner(self.rates[step, rod], h)


def _horner(coefficients: Any, h: Any) -> Any:
    """The polynomial with these ``coefficients[..., m]`` of ``h**m``."""
    value = 0.0 * h
    for m in range(coefficients.shape[-1] - 1, -1, -1):
        value = value * h + coefficients[..., m]
    return value


class BallPieces(Pieces):
    """The steps of :func:`lagrangian.digits.integrate_digits` to ``times``; results are numbers of ``context``.

    The floats next to the first and the last of the times, which are exact, count as within the span.  Every rod has
    ``halves`` half turns beyond its polynomials.
    """

    def __init__(self, pieces: Sequence[Piece], context: Any, times: Sequence[Any], halves: Sequence[int]) -> None:
        large = max(magnitude(x) for p in pieces for x in (p.start, *(angle[0] for angle in p.angles)))
        large += max(abs(half).bit_length() for half in halves)
        self.context, self.bits, self.halves = context, bits_for(context.dps) + large, halves
        with working(self.bits):
            ends = self.given([x for end in (times[0], times[-1]) for x in (end, float(end))])
        self.times, self.span = [times[0], times[-1]], (ends.min(), ends.max())
        self.start, self.length = (np.array(part, dtype=object) for part in ([p.start for p in pieces],
                                                                             [p.length for p in pieces]))
        self.angles = [p.angles for p in pieces]

    def __reduce__(self) -> Any:
        pieces = list(map(Piece, self.start, self.length, self.angles))
        return BallPieces, (pieces, self.context, self.times, self.halves)

    def given(self, t: Any) -> Any:
        return self.plain(Balls().array(Balls().number(x) for x in _exact(t)))

    def shown(self, found: Sequence[Any]) -> Any:
        return numbers(np.array(found, dtype=object), self.context)

    def plain(self, x: Any) -> Any:
        return middle(x)

    def states(self, steps: Any, h: Any) -> tuple[Any, Any]:
        shape = len(h), len(self.angles[0])
        more = [half * flint.arb.pi() for half in self.halves]
        theta = [angle(x) + half for step, x in zip(steps, h) for angle, half in zip(self.angles[step], more)]
        omega = [angle.derivative()(x) for step, x in zip(steps, h) for angle in self.angles[step]]
        return self.shown(theta).reshape(shape), self.shown(omega).reshape(shape)

    def goal(self, angle: Any, turn: int) -> Any:
        return {half: Balls().number(angle + (2 * turn - half) * pi).mid() for half in set(self.halves)}

    def beyond(self, step: int, rod: int, goal: Any, h: Any) -> Any:
        return middle(np.frompyfunc(self.angles[step][rod], 1, 1)(h) - goal[self.halves[rod]])

    def whole_turns(self, angle: Any) -> int:
        return whole_turns(angle)

    def rate(self, step: int, rod: int, h: Any) -> Any:
        return self.angles[step][rod].derivative()(h).mid()
