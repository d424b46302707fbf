"""Axes of a plane of two parameters, and the numbers that are fixed beside them, checked."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from sys import float_info
from typing import Any

import sympy
from flint import arb, fmpq
from sympy import Expr, Symbol

from fastpicard.errors import BadInputError, BadTypeError, printed
from fastpicard.evaluate import numpy
from fastpicard.values import Values, check_assumptions, exact_number

Array = Any
LARGEST = 1e150  # of what is on a chart: its square is a float still


@dataclass(frozen=True)
class Axis:
    """A parameter of a chart: ``lo <= symbol <= hi``; inside, ``u = symbol**power``."""

    symbol: Symbol
    lo: float
    hi: float
    power: int = 1

    def inner(self, x: Array) -> Array:
        """``x**power``, to four ulp."""
        array = numpy().asarray(x, dtype=float)
        return array if self.power == 1 else array**self.power

    def outer(self, u: Array) -> Array:
        """The parameter that belongs to ``u``, to four ulp and inside the chart."""
        np = numpy()
        if self.power == 1:
            return np.clip(u, self.lo, self.hi)
        inside = np.maximum(u, 0.0)  # edges of rectangles that begin at 0 are rounded down
        return np.clip(inside ** (1.0 / self.power), self.lo, self.hi)

    def edges(self, count: int) -> Array:
        """Equal parts of the parameter's interval."""
        np = numpy()
        edges = np.linspace(self.lo, self.hi, count + 1)
        edges[0], edges[-1] = self.lo, self.hi
        return edges


def axes_of(x: Any, y: Any) -> tuple[Axis, Axis]:
    """Two axes; raises as :func:`axis_of`, and where both are of one parameter."""
    first, second = axis_of(x, "x"), axis_of(y, "y")
    for axis in (first, second):
        refuse_integer(axis.symbol)
        for end in (axis.lo, axis.hi):
            check_assumptions(axis.symbol, arb(end))
    if first.symbol.name == second.symbol.name:
        raise BadInputError(f"the axes must be different parameters, but both are {first.symbol}.  Choose two, of "
                            "different names.")
    return first, second


def axis_of(given: Any, name: str) -> Axis:
    """An axis from ``(Symbol, lo, hi)``; raises BadTypeError, BadInputError."""
    if not isinstance(given, tuple | list) or len(given) != 3 or not isinstance(given[0], Symbol):
        raise BadTypeError(f"{name} must be (Symbol, lo, hi), but it is {given!r}.  Use {name}=(a, -1, 5), say.")
    symbol, lo, hi = given[0], *(end_of_axis(end, f"an end of {given[0]}") for end in given[1:])
    if not lo < hi:
        raise BadInputError(f"{name} must be an interval with lo < hi, but it is {printed(given)}.  Give the smaller "
                            "end first.")
    return Axis(symbol, lo, hi)


def point_of(start: Any) -> tuple[float, float]:
    """The point (x, y) to start from; raises BadTypeError, BadInputError."""
    if not isinstance(start, tuple | list) or len(start) != 2:
        raise BadTypeError(f"start must be a pair of numbers (x, y), but it is {start!r}.  Give a point near the "
                           "curve.")
    first, second = (end_of_axis(z, "a coordinate of start") for z in start)
    return first, second


def end_of_axis(value: Any, what: str) -> float:
    """The float nearest to one number; raises BadTypeError for a ball, BadInputError for what is no float."""
    number = exact_number(value, what)
    if isinstance(number, arb):
        raise BadTypeError(f"{what} must be one number, but it is the ball {number}.  Give its ends.")
    try:
        found = int(number.p) / int(number.q) if isinstance(number, fmpq) else float(number)
    except OverflowError:
        found = math.inf
    if not (abs(found) < LARGEST and (number == 0 or abs(found) >= float_info.min)):
        raise BadInputError(f"{what} must be 0 or a float between {float_info.min:.3g} and {LARGEST:g} in size, but "
                            f"it is {printed(value)}.  Measure the parameter in other units.")
    return found


def refuse_integer(symbol: Symbol) -> None:
    """Raise BadInputError for a parameter that goes through all numbers, but is an integer by its assumptions."""
    if symbol.is_integer:
        raise BadInputError(f"a curve goes through all numbers between its ends, but {symbol} is an integer by its "
                            "assumptions, which SymPy has made use of.  Use a Symbol without that assumption.")


def mapping_of(fixed: Values | None) -> Values:
    """The numbers that are fixed, none for None; raises BadTypeError for what is no mapping."""
    if fixed is not None and not isinstance(fixed, Mapping):
        raise BadTypeError(f"fixed must map Symbols to numbers, but it is {fixed!r}.  Use fixed={{c: 1}}.")
    return fixed or {}


def fixed_numbers(fixed: Values | None, free: Iterable[Symbol]) -> dict[Symbol, Expr]:
    """The numbers that are fixed, exactly; raises for balls, and for what is on an axis or given by modes."""
    for s in mapping_of(fixed):
        if not isinstance(s, Symbol):
            raise BadTypeError(f"fixed must map SymPy Symbols to numbers, but a key is {printed(s)}, a "
                               f"{type(s).__name__}.  Use the Symbol itself: {{c: 1}}.")
    numbers = {s: _exact_expression(value, s) for s, value in mapping_of(fixed).items()}
    for s, number in numbers.items():
        check_assumptions(s, number)
    for s in free:
        if s in numbers:
            raise BadInputError(f"a parameter has one value, but {s} is fixed at {printed(numbers[s])} and is "
                                "also on an axis or given by the modes.  Leave it out of fixed.")
    return numbers


def _exact_expression(value: Any, symbol: Symbol) -> Expr:
    if isinstance(value, Expr) and not value.has(sympy.Float):
        exact_number(value, f"the value of {symbol}")
        return value
    number = exact_number(value, f"the value of {symbol}")
    if isinstance(number, arb):
        raise BadTypeError(f"a fixed parameter must be one number, but {symbol} is the ball {number}.  Put it on an "
                           "axis, or give a number.")
    return sympy.Rational(int(number.p), int(number.q))
