r"""Enclosures at many points: an iterate as a table, and its bound at the point.

At half a period ``h`` the n-th iterate is one polynomial in the parameters (module ``halfway``), and its distance
from the truth is bounded by the majorant ``X = h Pbar`` at the point itself,

    |Phi(h) - Phi_n(h)|  <=  sum over k > n of X**k / k!  <=  X**(n+1) / (n+1)! * (1 + (exp(X) - 1) / (n+2)),

as ``(n+1)! j! / (n+1+j)! <= 1/(n+2)`` for ``j > 0``.  So a table has no edge: near its box it has fewer digits, and
where they are too few the equation is integrated as without a table.

The coefficients are balls, one row for each entry and monomial in the other variables, one column for each power of
the last variable; an evaluation is two products of matrices.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate, repeat
from operator import mul
from typing import Any

from flint import arb, arb_mat
from mpmath.libmp import dps_to_prec

from fastpicard.enclosure import mirrored, shortfall
from fastpicard.errors import BadInputError, BadTypeError, printed
from fastpicard.evaluate import Point, check_digits, may_vanish, refine, upper_float
from fastpicard.floquet import FloquetMatrix
from fastpicard.halfway import half_period, reversal
from fastpicard.precision import working
from fastpicard.remainder import a_priori_order, largest_row_sum
from fastpicard.values import Values

SPARE_DIGITS = 5  # what entries lose to cancellation, mostly
HIGHEST = 300  # order of a table: beyond, the terms of an iterate in one parameter fill the memory


def tabulate(F: FloquetMatrix, box: Values | None, digits: int = 15) -> FloquetMatrix:
    """The same Floquet matrix with a table, so that its enclosures at many points cost less.

    Parameters
    ----------
    F : FloquetMatrix
    box : {Symbol: number, ball, or interval (lo, hi)} for every parameter
        where most points will be; outside, and where parameters are wide, nothing changes but the time.
    digits : int
        up to how many digits the table serves.

    Returns
    -------
    FloquetMatrix of the same order, whose ``enclosure``, ``multipliers`` and ``verdict`` use the table.

    Raises
    ------
    BadTypeError
        if ``F`` is no FloquetMatrix, or ``digits`` no positive integer.
    MissingParameterError
        if a parameter is not in the box.
    BadInputError
        if the box takes an iterate of an order above 300, or solutions in it may grow beyond floats.

    Notes
    -----
    Pickled, it comes back without its table.
    Speed and accuracy: the enclosures are as good, and as rigorous, as without.  For Mathieu's equation, 30 digits and
    ``|a| <= 2.5``, ``|b| <= 1.5`` the table takes some 2 s to build, and an enclosure 0.8 ms instead of 2.4 ms: it pays
    from about 1500 points on.  The work of building grows steeply with the order, the parameters and the size of P:
    with three parameters give some of them numbers, or do without a table.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 0)
    >>> G = tabulate(F, {a: (-1, 1), b: (-1, 1)}, digits=12)
    >>> print(G.enclosure({a: -0.1, b: 0.55}, digits=12)[0, 1].str(12))
    [18.6577238445 +/- ...]
    """
    wanted = check_digits(digits)
    if not isinstance(F, FloquetMatrix) or wanted is None:
        raise BadTypeError(f"a table is made of a FloquetMatrix for a number of digits, but these are {F!r} and "
                           f"{digits!r}.  Use tabulate(F, {{a: (0, 1)}}, digits=15).")
    table = Table(F, F.numbers(box), wanted)
    new = object.__new__(Tabulated)
    new._fill(F.P, F.n, F.period, F.length, F.increments)
    object.__setattr__(new, "_table", table)
    return new


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Tabulated(FloquetMatrix):
    """A Floquet matrix that looks enclosures up first; pickled, it comes back without its table."""

    _table: Table

    def _true(self, exact: Mapping[Any, Any], digits: int, strict: bool = True) -> Any:
        wanted = dps_to_prec(digits)
        if digits <= self._table.digits:
            with working(self._table.bits):
                found = self._table.over_period(exact)
                if found is not None and shortfall(found, wanted) <= 0:
                    return found
        return super()._true(exact, digits, strict)


class Table:
    """An iterate over a part of the period, in balls.

    Attributes
    ----------
    digits, bits, order : int   the digits it is made for, the precision of its coefficients, the order of the iterate
    signs : (+-1, ...) or None  those that reverse time; then it is the iterate at half of that part
    """

    def __init__(self, F: FloquetMatrix, box: Mapping[Any, Any], digits: int) -> None:
        self.turns, self.signs, self.digits = F.turns, reversal(F.P), digits
        self.part = F.over(F.turns, 0)
        with working(128):
            P, h = self._at(box)
            self.order = a_priori_order(P, h, arb(10) ** -(digits + SPARE_DIGITS))
            growth = upper_float(largest_row_sum((P.bound * h).exp()))
        if box and self.order > HIGHEST:
            raise BadInputError(f"a table is an iterate of order {HIGHEST} at most, but in {printed(dict(box))} "
                                f"{digits} digits take one of order {self.order}.  Take a box nearer to 0, "
                                "fewer digits, "
                                "or F.enclosure.")
        if growth == math.inf:
            raise BadInputError(f"a table covers a box of parameters in which solutions stay below 1e308, but in "
                                f"{printed(dict(box))} they may grow further.  Take smaller ones.")
        self.bits = dps_to_prec(digits + SPARE_DIGITS) + 8 + 2 * math.ceil(math.log2(growth))
        with working(self.bits):
            self._read(F.over(self.turns, self.order))

    def _at(self, values: Mapping[Any, Any]) -> Any:
        """``P`` and the time of the table, at numbers."""
        P, period = self.part.at(values)
        return P, period / 2 if self.signs else period

    def _read(self, F: FloquetMatrix) -> None:
        """The coefficients, in rows and columns."""
        constants = [entry for row in half_period(F) for entry in row] if self.signs else F._all()
        collapsed = F.collapse(constants)
        self.resonances = collapsed.resonances
        self.variables = collapsed.variables
        exponents = [[(m[:-1], m[-1] if m else 0) for m in row] for row in collapsed.exponents]
        self.rows = sorted({outer for row in exponents for outer, _ in row})
        self.degree = max((inner for row in exponents for _, inner in row), default=0)
        self.coefficients = arb_mat(len(constants) * len(self.rows), self.degree + 1)
        places = {outer: k for k, outer in enumerate(self.rows)}
        balls = iter(refine(lambda: [c for row in collapsed.coefficients() for c in row], math.ceil(self.bits * 0.302)))
        for e, row in enumerate(exponents):
            for outer, inner in row:
                self.coefficients[e * len(self.rows) + places[outer], inner] = next(balls) + 0  # rounded to the bits

    def over_period(self, values: Mapping[Any, Any]) -> Any:
        """An ``arb_mat`` that contains ``Phi(T)``, or None far from the box and at resonances."""
        if any(may_vanish(q, values) for q in self.resonances):
            return None
        found = self._iterate(values) + self._bound(values)
        try:
            return (mirrored(found, self.signs) if self.signs else found) ** self.turns
        except ZeroDivisionError:
            return None

    def _iterate(self, values: Mapping[Any, Any]) -> Any:
        point = Point(arb(0), values)
        *others, last = [v.ball(point) for v in self.variables] or [arb(1)]
        inner = arb_mat(self.degree + 1, 1, _powers(last, self.degree))
        powers = [_powers(x, max(m[j] for m in self.rows)) for j, x in enumerate(others)]
        outer = [math.prod((powers[j][e] for j, e in enumerate(m)), start=arb(1)) for m in self.rows]
        sums = (self.coefficients * inner).entries()
        size, columns = self.part.shape[0], len(self.rows)
        return arb_mat(size, size, (arb_mat(size * size, columns, sums) * arb_mat(columns, 1, outer)).entries())

    def _bound(self, values: Mapping[Any, Any]) -> Any:
        """How far the iterate is from the truth: balls around 0."""
        P, h = self._at(values)
        n, size = self.order, P.size
        one = arb_mat([[int(i == j) for j in range(size)] for i in range(size)])
        with working(64):
            X = P.bound * abs(h)
            bound = X ** (n + 1) / arb.fac_ui(n + 1) * (one + (X.exp() - one) / (n + 2))
            return arb_mat(size, size, [arb(0, x.upper()) for x in bound.entries()])


def _powers(x: Any, top: int) -> list[Any]:
    """``1, x, ..., x**top``."""
    return list(accumulate(repeat(x, top), mul, initial=arb(1)))
