r"""Taylor steps in double-double: the state in balls, the series in pairs of floats, translated by numba.

The increments of a step, at most 1.5 rad, round by some 1e-33 rad; they are added up in balls, so that nothing else
is lost, and the sines of the joint angles, a few in a step, are those of balls too.  Truncation is what remains, up to
31 digits.  Light rods between others 1e12 times heavier lose more, as they would if their constants were moved by
``2**-105``: up to 1e-26 a step was seen, and the estimated error of the motion shows it.

Pairs have the range of float64.  Where constants lie beyond ``1e-40 ... 1e40``, or a step beyond ``1e4 s``, low
halves might underflow, and where a series overflows it has no answer: ``OutOfRange`` then says that balls are
needed.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
from math import inf, isfinite, log
from typing import Any

import flint
import numpy as np

from .chain import CompiledChain
from .constants import signs
from .digits import Steps
from .machine import has_numba
from .pairs import to_pairs
from .taylor import FACTORS, series_shape

__all__ = ["UNIT", "DoubledSteps", "OutOfRange", "has_doubled"]

MOST_DIGITS = 31
UNIT = 2.0**-105  # of a pair
LARGEST = 1e40  # of a constant, and its inverse the smallest: five of them multiplied stay far within float64
LONGEST = 1e4  # s


class OutOfRange(ArithmeticError):
    """Double-double has not the range for this motion."""


def has_doubled(digits: int) -> bool:
    """Whether so many digits can be computed here in double-double."""
    return digits <= MOST_DIGITS and has_numba()


@cache
def _translated(name: str) -> Callable[..., None]:
    found: Callable[..., None] = getattr(import_module(f"{__package__}.pairtype"), name)
    return found


def to_balls(pairs: Any) -> Any:
    """Pairs, complex128, as balls; same shape."""
    return np.frompyfunc(lambda x: flint.arb(x.real) + flint.arb(x.imag), 1, 1)(pairs)


class DoubledSteps(Steps):
    """:class:`lagrangian.digits.Steps` with series in pairs.

    ``unsettled`` moves every constant, and the weight, by that part of itself, up and down as
    :func:`lagrangian.constants.signs` says.
    """

    def __init__(self, chain: CompiledChain, state: list[Any], digits: int, order: int | None,
                 unsettled: float = 0.0) -> None:
        super().__init__(chain, state, digits, order)
        n = len(chain)
        self.unsettled = unsettled
        self.rods, *self.joints = (None if part is None else _moved(_constants(part), unsettled)
                                   for part in (self.rods, *self.joints))
        self.work = [np.zeros(shape, complex) for shape in ((n, FACTORS), (n, 6), series_shape(n, self.order))]

    def pulled(self) -> tuple[Any, Any]:
        ax, ay = _moved(to_pairs(super().pulled()), -self.unsettled)
        return ax, ay

    def expanded(self, s: Any, c: Any, delta: Any) -> Any:
        series = self.work[-1]
        series[:] = 0
        s, c, delta, omega = to_pairs([s, c, delta, self.omega])
        _translated("pair_series")(self.rods, s, c, *self.joints, delta, omega, *self.pull, self.order, *self.work)
        return series

    def magnitudes(self) -> list[float]:
        sizes = abs(self.series.real[:, 2, :min(4, self.order)]).max(axis=0).tolist()
        if not isfinite(sum(sizes)):  # what is not finite in one order is not in the next
            raise OutOfRange
        return [log(size) if size > 0 else -inf for size in sizes]

    def increments(self, h: Any) -> tuple[Any, Any]:
        high = float(h)
        if abs(high) > LONGEST:
            raise OutOfRange
        out = np.empty((2, len(self.chain)), complex)
        _translated("pair_increments")(self.series, self.order, high, float(h - high), out)
        angle, rate = to_balls(out)
        return angle, rate

    def rates(self) -> Any:
        return to_balls(super().rates())


def _moved(pairs: Any, part: float) -> Any:
    return pairs + 1j * (pairs.real * (part * signs(pairs.shape)))


def _constants(numbers: Any) -> Any:
    high = abs(numbers.astype(float))
    if not ((numbers == 0) | ((high > 1 / LARGEST) & (high < LARGEST))).all():
        raise OutOfRange
    return to_pairs(numbers)
