r"""Taylor steps with as many digits as asked: the recursion of :mod:`lagrangian.taylor` on python-flint numbers.

Balls are used for their speed and precision, not for proof: after every step the radii are dropped, so that
errors do not compound as if they were always at their worst.  Within a step they grow, by a bit for every rod or two:
where that is more than there are, the motion begins again with more of them.  Orders and steps are chosen as in
float64: ``p = 1 + 1.16 digits`` balances the work of a step, O(n p**2), against its length.

A start at ``pi`` is a start at ``pi``, an unstable equilibrium say, with any number of digits: angles that are whole
multiples of it are held as that multiple and 0, and only what they move by is rounded.

Motions with digits in several threads wait for each other (:mod:`lagrangian.precision`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, exp, inf, log
from typing import Any, NamedTuple

import flint
import numpy as np
from sympy import Integer, pi

from .arithmetic import Balls
from .chain import CompiledChain
from .contexts import Context
from .errors import QuantityError
from .machine import rebound
from .pace import Pace
from .precision import working
from .stepper import FARTHEST
from .taylor import FACTORS, expand, factor, series_shape

__all__ = ["DigitRun", "Piece", "Steps", "apart_by_then", "best_order", "bits_for", "integrate_digits", "magnitude",
           "middle", "numbers", "whole_turns"]

GUARD = 30  # bits beyond those asked for
MORE = 128  # if they are too few, and then twice as many, up to 4096, or 16 for every rod and more


class TooFewBits(ArithmeticError):
    """The balls of a Taylor series have fewer digits than asked for, at a start."""

    def __init__(self, start: float) -> None:
        super().__init__(start)
        self.start = start


def _convolved(C: Any, S: Any, w: Any, Bu: Any, Bn: Any, count: int, none: Any) -> Any:
    """The three sums of :func:`lagrangian.taylor.convolved` by numpy's loops over objects."""
    C, S = C[:count], S[:count]
    return C.dot(w[:count]), S.dot(w[:count]), C.dot(Bn[:count]) - S.dot(Bu[:count])


_expand: Callable[..., None] = rebound(expand, convolved=_convolved)


def best_order(digits: float) -> int:
    """The order at which a given number of digits costs least: 10 for 8, 15 for 12, 20 for 16, 36 for 30."""
    return max(6, ceil(1.0 + 1.16 * digits))


def bits_for(digits: int) -> int:
    """The precision that so many decimal digits are computed with."""
    return int(digits * 3.3220) + GUARD


@dataclass(frozen=True)
class Piece:
    """One step: its start and length, s, and every angle as a python-flint polynomial of the time since its start.

    Angles are without the half turns that they have had from the first, see :class:`DigitRun`.
    """

    start: Any
    length: Any
    angles: tuple[Any, ...]

    def __reduce__(self) -> Any:
        numbers = [[self.start, self.length], *(angle.coeffs() for angle in self.angles)]
        return _read, ([[tuple(map(int, x.man_exp())) for x in part] for part in numbers],)


def _read(numbers: Any) -> Piece:
    """A piece from mantissas and exponents, exactly, since python-flint's numbers cannot be pickled."""
    (start, length), *angles = ([flint.arb(flint.arf(x)) for x in part] for part in numbers)
    return Piece(start, length, tuple(map(flint.arb_poly, angles)))


class Place(NamedTuple):
    """The angles, less the half turns of :class:`DigitRun`, at a time, in balls; whether that one was asked for."""

    time: Any
    theta: Any
    asked: bool


class DigitRun(NamedTuple):
    """Angles with turns, angles within one turn and rates, mpmath numbers, and whole turns, Python's integers; steps.

    The arrays have shape (times, n); ``steps`` is how many were made, ``pieces`` are they, where kept.  ``halves`` are
    the half turns of every rod at the start where they are all of its angle, else 0.  ``path`` is the motion at every
    step and every time, in order.
    """

    theta: Any
    angle: Any
    turns: Any
    omega: Any
    steps: int
    pieces: list[Piece] | None
    halves: list[int]
    path: list[Place]


def integrate_digits(chain: CompiledChain, theta: Any, omega: Any, times: Any, digits: int, order: int | None = None,
                     progress: Callable[[float], None] | None = None, steps: Callable[..., Steps] | None = None,
                     keep: bool = False) -> DigitRun:
    """The motion at ``times``, as mpmath numbers of ``digits`` digits.

    ``theta``, ``omega`` and ``times`` are exact SymPy numbers; ``steps`` makes the :class:`Steps`; ``keep`` keeps every
    step.  Truncation is below ``10**-digits`` a step, and in balls rounding too.  Raises DriveError where the support's
    motion has no Taylor series, QuantityError where a step shrinks to nothing.
    """
    bits, motion, found = _followed(chain, theta, omega, times, digits, order, progress, steps, keep)
    context = Context(digits)
    with working(bits):
        angles, rates = (np.array([state[part] for state in found], dtype=object) for part in (0, 1))
        angles = angles + np.array(motion.halves) * flint.arb.pi()
        turns = np.frompyfunc(whole_turns, 1, 1)(angles)
        within = angles - turns * (2 * flint.arb.pi())
        theta, within, omega = (numbers(x, context) for x in (angles, within, rates))
    return DigitRun(theta, within, turns, omega, motion.count, motion.pieces, motion.halves, motion.path)


def apart_by_then(run: DigitRun, chain: CompiledChain, theta: Any, omega: Any, digits: int, order: int | None = None,
                  steps: Callable[..., Steps] | None = None) -> Any:
    """The largest difference of any angle from that of another run, up to each of the times; float64, (times,); rad.

    The runs are compared at every step of the first: a rod that has fallen, and turned, comes back to where it was.
    """
    when = [place.time for place in run.path]
    found = _followed(chain, theta, omega, when, digits, order, None, steps, False)[2]
    apart = [max(float(abs(x - y)) for x, y in zip(place.theta, there)) for place, (there, _) in zip(run.path, found)]
    return np.maximum.accumulate(apart)[[place.asked for place in run.path]]


def _followed(chain: CompiledChain, theta: Any, omega: Any, times: Any, digits: int, order: int | None,
              progress: Callable[[float], None] | None, steps: Callable[..., Steps] | None,
              keep: bool) -> tuple[int, Steps, list[Any]]:
    """The bits that were enough, the steps, and the states in balls at ``times``, SymPy numbers or balls."""
    with working(64):
        bits = bits_for(digits) + max(magnitude(Balls().coerced(x)) for x in (*theta, *times))
    for more in (0, *(MORE << k for k in range(6 + (len(chain) // 256).bit_length()))):
        try:
            return bits + more, *_with_bits(bits + more, chain, theta, omega, times, digits, order, progress, steps,
                                            keep)
        except TooFewBits as refused:
            reached = refused.start
    raise QuantityError(f"the motion cannot be followed beyond t = {reached:.6g}: with {bits + more} bits theta'' "
                        f"has fewer digits than asked for.  End before it, or give masses to rods without.")


def _with_bits(bits: int, chain: CompiledChain, theta: Any, omega: Any, times: Any, digits: int, order: int | None,
               progress: Callable[[float], None] | None, steps: Callable[..., Steps] | None,
               keep: bool) -> tuple[Steps, list[Any]]:
    with working(bits):
        halves = [half_turns(x) for x in theta]
        rest = [Integer(0) if half else x for x, half in zip(theta, halves)]
        state = [[Balls().number(x).mid() for x in part] for part in (rest, omega)]
        motion = (steps or Steps)(chain, state, digits, order)
        motion.halves, motion.pieces = halves, [] if keep else None
        marks = [Balls().coerced(x).mid() for x in times]
        found = []
        for mark in marks:
            found.append(motion.state_at(mark, marks[-1]))
            motion.path.append(Place(mark, found[-1][0], True))
            if progress is not None:
                progress(float(mark))
        return motion, found


def half_turns(angle: Any) -> int:
    """The half turns that an exact angle is; 0 where it is no whole number of them."""
    halves = angle / pi
    return int(halves) if halves.is_Integer else 0


def magnitude(x: Any) -> int:
    """The bits of a ball before the point: with so many more, the digits after it are kept."""
    mantissa, exponent = map(int, x.mid().man_exp())
    return max(0, exponent + mantissa.bit_length())


def whole_turns(angle: Any) -> int:
    """The turns nearest to an angle, a ball of enough bits."""
    return int((angle / (2 * flint.arb.pi()) - 0.5).mid().ceil().unique_fmpz())


def numbers(balls: Any, context: Any) -> Any:
    """The middles of balls, rounded to mpmath numbers of a context; same shape."""
    def number(x: Any) -> Any:
        mantissa, exponent = (int(part) for part in x.mid().man_exp())
        return context.mpf((int(mantissa < 0), abs(mantissa), exponent, mantissa.bit_length()))
    return np.frompyfunc(number, 1, 1)(np.asarray(balls, dtype=object))


middle = np.frompyfunc(Balls().midpoint, 1, 1)  # of balls, in any shape


class Steps:
    """An integration: the state at the last expansion in balls, and the expansion, here in balls too."""

    def __init__(self, chain: CompiledChain, state: list[Any], digits: int, order: int | None) -> None:
        self.chain, self.arithmetic, self.count = chain, Balls(), 0
        self.order = order or best_order(digits)
        self.digits = digits
        self.rods = chain.rods_in(self.arithmetic)
        self.joints = chain.joints_in(self.arithmetic)
        self.theta, self.omega = (self.arithmetic.array(part) for part in state)
        self.gravity = self.arithmetic.number(chain.gravity)
        self.halves = [0] * len(chain)  # half turns, which the angles have beyond theta
        self.path: list[Place] = []
        self.pieces: list[Piece] | None = None  # where every step is added, if it shall be kept
        self.pace = Pace()
        self.pull: Any = None
        self.series: Any = None
        self.start: Any = None
        self.length: Any = None

    def state_at(self, t: Any, end: Any) -> tuple[Any, Any]:
        """Angles and rates at ``t``, stepping there."""
        if self.start is None:
            self.start = t
            self._expand(end)
            return self.theta, self.omega
        while abs(t - self.start) > abs(self.length):
            self.theta, self.omega = self._moved(self.length)
            self.start = (self.start + self.length).mid()
            self._expand(end)
        return self._moved(t - self.start)

    def pulled(self) -> tuple[Any, Any]:
        """The series of the acceleration of the first joint, gravity included."""
        ax, ay = self.chain.support.series(self.start, self.order, self.arithmetic)
        ay[0] = ay[0] + self.gravity
        return ax, [self.chain.up * a for a in ay]

    def expanded(self, s: Any, c: Any, delta: Any) -> Any:
        """The series of every rod."""
        n, order, one = len(self.chain), self.order, self.arithmetic.number(Integer(1))
        factors, held = self.arithmetic.zeros(n, FACTORS), self.arithmetic.zeros(n, 6)
        series = self.arithmetic.zeros(*series_shape(n, order))
        factor(self.rods, s, c, one, factors)
        _expand(factors, *self.joints, delta, self.omega, *self.pull, order, one, held, series)
        self._check(series[:, 2, order - 1])
        return series

    def _check(self, second: Any) -> None:
        """Raise TooFewBits where ``theta''``, in balls, have fewer digits than asked for beside what makes them up."""
        weight = max(abs(part[0]) for part in self.pull) / min(self.rods[:, 1])
        scale = max(abs(x) for x in second) + max(abs(x) for x in self.omega) ** 2 + weight
        if not max(x.rad() for x in second) * flint.arb(10) ** (self.digits + 1) <= scale.mid():
            raise TooFewBits(float(self.start))

    def magnitudes(self) -> list[float]:
        """Logarithms of the largest coefficient of any rate, for the last four orders, the last first."""
        sizes = [max(abs(x.mid()) for x in self.series[:, 2, i]) for i in range(min(4, self.order))]
        return [float(size.log()) if size != 0 else -inf for size in sizes]

    def increments(self, h: Any) -> tuple[Any, Any]:
        """How far angles and rates move in the time ``h``."""
        order, w = self.order, self.series[:, 2]
        rate, angle = w[:, 0], w[:, 0] / (order + 1)
        for m in range(1, order):
            angle = angle * h + w[:, m] / (order + 1 - m)
            rate = rate * h + w[:, m]
        return (angle * h + w[:, order]) * h, rate * h

    def rates(self) -> Any:
        """The series of the rates in balls, rising powers; shape (n, order + 1)."""
        return self.series[:, 2, self.order::-1]

    def piece(self) -> Piece:
        """The step from here; state and polynomials without their radii."""
        rates = middle(self.rates()).tolist()
        angles = ((flint.arb_poly(rate).integral() + theta).coeffs() for rate, theta in zip(rates, self.theta))
        return Piece(self.start, self.length, tuple(flint.arb_poly(middle(angle).tolist()) for angle in angles))

    def _expand(self, end: Any) -> None:
        n = len(self.chain)
        s, c = np.empty(n, dtype=object), np.empty(n, dtype=object)
        delta = self.theta.copy()
        delta[1:] = delta[1:] - self.theta[:-1]
        for k in range(n):
            s[k], c[k] = self.arithmetic.sines(delta[k])
            bend = self.halves[k] - self.halves[k - 1] if k else self.halves[0]
            if bend:
                s[k], c[k] = (-1) ** (bend % 2) * s[k], (-1) ** (bend % 2) * c[k]
                delta[k] = delta[k] + bend * flint.arb.pi()
        if self.pull is None or not self.chain.support.steady:
            self.pull = self.pulled()
        self.series = self.expanded(s, c, delta)
        self.length = self._length(end)
        self.count += 1
        self.path.append(Place(self.start, self.theta, False))
        if self.pieces is not None:
            self.pieces.append(self.piece())

    def _length(self, end: Any) -> Any:
        remaining = float(end - self.start)
        logs = [-size / (self.order + 1 - i) for i, size in enumerate(self.magnitudes()) if size > -inf]
        h = exp(min(logs) - log(10) * (self.digits + 1) / (self.order + 1)) if logs else 2 * abs(remaining) + 1
        h = min(h, 2 * abs(remaining) + 1e-29 * abs(float(self.start)) + 1e-300,
                FARTHEST / max(1e-300, *(abs(float(x)) for x in self.omega)))
        crawls = self.chain.support.function is not None and self.pace.crawls(float(self.start), float(end))
        if remaining != 0 and not h > 1e-30 * abs(float(self.start)) or h != h or crawls:
            raise QuantityError(f"the motion cannot be followed beyond t = {float(self.start):.6g}: the step shrinks "
                                f"to {h:.3g}.  End before it, or give masses to rods without.")
        return flint.arb(h if remaining >= 0 else -h)

    def _moved(self, h: Any) -> tuple[Any, Any]:
        angle, rate = self.increments(h)
        return middle(self.theta + angle), middle(self.omega + rate)
