r"""The true solution of ``x' = P(t) x``, ``x(t0) = x0``, at any time, and how far an iterate is from it there.

Time is counted from ``t0``, as in the iterates: ``Q(s) = P(t0 + s)``.  ``P`` need not be periodic, and the time may be
before ``t0``.  Where the frequencies have a common unit there is a period, and a long way is a power of that over one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from flint import arb, arb_mat

from fastpicard import modes as algebra
from fastpicard.enclosure import over_time, to_digits
from fastpicard.errors import BadInputError
from fastpicard.evaluate import Point, ball, check_time, free_symbols
from fastpicard.harmonics import Harmonics, harmonics
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import Modes
from fastpicard.parameters import BOUND_BITS, is_box, not_finite, number_or_interval, numbers_in, proved
from fastpicard.precision import working
from fastpicard.remainder import a_posteriori, identity, smallest_order
from fastpicard.ring import Polynomial, symbols_of
from fastpicard.values import Values
from fastpicard.writing import write


class Way(NamedTuple):
    """A problem at numbers, in balls.

    Attributes
    ----------
    P : ``P(t0 + s)``
    length : ``t - t0``, of any sign
    start : arb_mat, one column for each initial vector
    period : of ``P``, or None where none is known
    """

    P: Harmonics
    length: Any
    start: Any
    period: Any | None

    @property
    def is_finite(self) -> bool:
        """Whether no ball contains a pole."""
        return self.P.is_finite and all(x.is_finite() for x in (self.length, *self.start.entries()))


@dataclass(frozen=True)
class InitialValueProblem:
    """``x' = P(t) x`` from ``t0`` on.

    Attributes
    ----------
    P : SeriesMatrix
    origin : ``t0``
    columns : the initial vectors, or None for the unit matrix
    """

    P: SeriesMatrix
    origin: Polynomial
    columns: tuple[tuple[Modes, ...], ...] | None

    @cached_property
    def unit(self) -> Any:
        """The unit of all frequencies, a monomial and a number, or None."""
        for i, row in enumerate(self.P.rows):
            for j, modes in enumerate(row):
                for key, f in modes.items():
                    if f.degree() > 0:
                        raise BadInputError(f"bounds are known where P is a sum of sines and cosines, but entry P[{i}, "
                                            f"{j}] contains {write({key: f}, self.P.t)}, with a power of the time.  "
                                            "Exact iterates are all there is.")
        return algebra.common_unit({angle[0] for row in self.P.rows for modes in row for _, angle, _ in modes
                                    if angle[0]})

    def numbers(self, values: Values | None) -> dict[Any, Any]:
        """The values of all parameters as exact numbers or balls, checked."""
        others = symbols_of(self.origin).union(*(free_symbols(x) for column in self.columns or () for x in column))
        return numbers_in(self.P, values, others)

    def way(self, time: Any, exact: Mapping[Any, Any]) -> Way:
        """All of it at :meth:`numbers` and a time, in balls of the working precision, or of more where it is in doubt.

        Raises BadInputError where it is not finite, and if powers of the time occur in ``P``.
        """
        unit = self.unit

        def build() -> Way:
            point = Point(arb(0), exact)
            origin = point.polynomial(self.origin)
            P, length = harmonics(self.P, exact).shifted(origin), ball(time) - origin
            period = None if unit is None else abs(2 * arb.pi() / (point.monomial(unit[0]) * unit[1]))
            start = identity(P.size) if self.columns is None else arb_mat(list(zip(*(
                [point(x) for x in column] for column in self.columns), strict=True)))
            return Way(P, length, start, period if period is not None and period.is_finite() else None)

        found = proved(build, lambda way: way.is_finite)
        if not found.is_finite:
            raise not_finite("P, t0 and x0", exact)
        return found

    def remainder(self, time: Any, values: Values | None, n: int) -> Any:
        """Upper bounds of ``|x(t) - x_n(t)|``, an ``arb_mat``, in balls of few bits."""
        when, exact = check_time(time, number_or_interval), self.numbers(values)
        with working(BOUND_BITS):
            way = self.way(when, exact)
            return a_posteriori(way.P, way.length, n, way.start)

    def smallest_order(self, time: Any, values: Values | None, tol: Any) -> int:
        """The smallest order from which on the bound of the fundamental matrix meets ``tol``: largest row sum."""
        when, exact = check_time(time, number_or_interval), self.numbers(values)
        with working(BOUND_BITS):
            way = self.way(when, exact)
            return smallest_order(way.P, way.length, ball(tol))

    def enclosure(self, time: Any, values: Values | None, digits: int) -> Any:
        """An ``arb_mat`` that contains the true solution, with these digits."""
        when, exact = check_time(time, number_or_interval), self.numbers(values)

        def compute() -> Any:
            way = self.way(when, exact)
            return over_time(way.P, way.length, way.period) * way.start

        return to_digits(compute, digits, is_box({**exact, self.P.t: when}))
