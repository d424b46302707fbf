r"""The Floquet matrix: the iterate ``Phi_n`` after one period, exactly.

If ``P`` repeats with period ``T``, the solutions of ``x' = P x`` obey
``x(t + T) = Phi(T) x(t)`` at ``t = 0, T, 2 T, ...`` for the *Floquet* (or *monodromy*)
*matrix* ``Phi(T)``; its eigenvalues are the multipliers ([Neves], sections 4 and 5).
After a period all angles have made whole turns, so every cosine is 1 and every
sine 0, and what is left of the iterate is a polynomial in the parameters and ``T``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import mpmath
import sympy
from flint import fmpq
from sympy import Expr, ImmutableMatrix, Symbol, pi

from fastpicard import modes as algebra
from fastpicard.errors import BadInputError, NotPeriodicError
from fastpicard.evaluate import Values, check_digits, numpy
from fastpicard.matrix import SeriesMatrix, latex_or_summary, number_matrix, read_matrix
from fastpicard.modes import Modes
from fastpicard.picard import Increments, check_order, first_increments, identity_columns
from fastpicard.reading import as_expression, as_finite, as_polynomial, as_time, read_constant
from fastpicard.ring import ONE, Polynomial, generator, multiply, to_expression
from fastpicard.vectorise import Collapsed, vectorise
from fastpicard.writing import write


class FloquetMatrix:
    """``Phi_n(T)``: the n-th exact Picard iterate of the Floquet matrix, a polynomial in the parameters and ``T``.

    Immutable.  Exact for the n-th iterate; how far that is from the true Floquet
    matrix depends on the parameters and is not told by any number of digits.

    Parameters
    ----------
    P : Matrix, shape (m, m), or a function of one argument     as for :func:`fast_picard`
    t : Symbol
    n : int, from 0 up
    period : positive number or expression free of ``t``, default ``2*pi``
        a period of ``P``, not necessarily the least; exact, so no float.
        For constant ``P`` any positive time.

    Attributes
    ----------
    t : Symbol;  n : int;  period : Expr;  shape : (m, m)

    Raises
    ------
    NotPeriodicError
        if ``P`` does not repeat with this period, with the entry and a period that would do.
    NotInFamilyError, ShapeError, BadInputError, BadTypeError
        as :func:`fast_picard`.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 20)
    >>> print(F.evaluate({a: -0.1, b: 0.55}).round(7))
    [[-0.0397796 18.6577238]
     [-0.0535123 -0.0397796]]
    >>> FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 4).trace()
    4*pi**4*a**2/3 - 4*pi**2*a - 2*pi**2*b**2 + 2
    """

    def __init__(self, P: Any, t: Symbol, n: int, period: Any = 2 * pi) -> None:
        matrix = read_matrix(P, as_time(t))
        order = check_order(n)
        length = check_period(matrix, period)
        self._fill(t, order, as_expression(period), matrix.shape, length,
                   first_increments(matrix, identity_columns(matrix.shape[0]), order))

    def _fill(self, t: Symbol, n: int, period: Expr, shape: tuple[int, int], length: Polynomial,
              found: Increments) -> None:
        self._t, self._n, self._period, self._shape = t, n, period, shape
        self._length, self._increments = length, found
        self._powers: list[Polynomial] = [{ONE: fmpq(1)}]  # T**r / r!
        for r in range(1, n + 1):
            self._powers.append(multiply(self._powers[-1], {m: c / r for m, c in length.items()}))
        self._entries: dict[tuple[int, int], Modes] = {}

    @property
    def t(self) -> Symbol:
        """The time symbol of ``P``."""
        return self._t

    @property
    def n(self) -> int:
        """The order of the iterate."""
        return self._n

    @property
    def period(self) -> Expr:
        """The period ``T``."""
        return self._period

    @property
    def shape(self) -> tuple[int, int]:
        """(m, m)."""
        return self._shape

    def to_order(self, n: int) -> FloquetMatrix:
        """The same for order ``n``, at the cost of the increments that are new."""
        new = object.__new__(FloquetMatrix)
        new._fill(self._t, check_order(n), self._period, self._shape, self._length, self._increments.to_order(n))
        return new

    # -- exact ---------------------------------------------------------------

    def _entry(self, i: int, j: int) -> Modes:
        if (i, j) not in self._entries:
            result: Modes = {}
            for k in range(self._n + 1):
                algebra.add_modes(result, algebra.frozen(self._increments.whole_turns(k, i, j), self._powers))
            self._entries[i, j] = result
        return self._entries[i, j]

    def _all(self) -> list[Modes]:
        rows, columns = self._shape
        return [self._entry(i, j) for i in range(rows) for j in range(columns)]

    def _trace(self) -> Modes:
        result: Modes = {}
        for i in range(self._shape[0]):
            algebra.add_modes(result, self._entry(i, i))
        return result

    @cached_property
    def _collapsed(self) -> Collapsed:
        return Collapsed(self._all(), self._t)

    @cached_property
    def _collapsed_trace(self) -> Collapsed:
        return Collapsed([self._trace()], self._t)

    def __getitem__(self, index: tuple[int, int]) -> Expr:
        """One entry, exact."""
        return write(self._entry(*index), self._t)

    def as_matrix(self) -> ImmutableMatrix:
        """The exact matrix, entries expanded: polynomials in the parameters and the period."""
        rows, columns = self._shape
        return ImmutableMatrix([[self[i, j] for j in range(columns)] for i in range(rows)])

    def trace(self) -> Expr:
        """The exact trace, expanded; for 2 x 2 and determinant 1, ``trace = +-2`` bounds stability ([Neves] (15))."""
        return write(self._trace(), self._t)

    # -- numbers -------------------------------------------------------------

    def evaluate(self, values: Values | None = None, digits: int | None = None) -> Any:
        """The n-th iterate in numbers: a float64 array of shape (m, m), or an mpmath matrix with correct ``digits``.

        ``values`` maps every parameter to a number (int, Fraction, float as the
        dyadic number it is, mpf, SymPy number, arb).  Computed in balls, so only the last digit is rounded.

        Raises
        ------
        MissingParameterError
            if a parameter has no value.
        """
        return number_matrix(self._collapsed.at(values, digits), self._shape, check_digits(digits))

    def trace_at(self, values: Values | None = None, digits: int | None = None) -> Any:
        """The trace of the n-th iterate, float or mpf, every digit asked for correct."""
        return self._collapsed_trace.at(values, digits)[0]

    def multipliers(self, values: Values | None = None, digits: int | None = None) -> list[Any]:
        """The eigenvalues of the n-th iterate, complex numbers sorted by absolute value, largest first.

        Rounded, not bounded: of a double multiplier about half the digits are right.
        """
        if check_digits(digits) is None:
            found = numpy().linalg.eigvals(self.evaluate(values)).tolist()
        else:
            assert digits is not None
            context = mpmath.mp.clone()
            context.dps = 2 * digits + 10
            matrix = context.matrix(self.evaluate(values, 2 * digits + 10).tolist())
            found = context.eig(matrix, left=False, right=False)
            found = [context.mpc(x) for x in found]
        return sorted(found, key=abs, reverse=True)

    def lambdify(self, params: Sequence[Symbol], bound: bool = False) -> Callable[..., Any]:
        """A NumPy function of the parameters in this order; arrays broadcast to shape (..., m, m).

        Every entry is right to 10 ulp of the largest entry of the n-th iterate at its point.  The cheapest
        arithmetic that is proved to do it is taken point by point: float64, pairs of float64, balls.  Arguments are
        the doubles they round to.  Where the value is beyond the largest double it is infinite, where there is none,
        at a pole, it is nan.

        Parameters
        ----------
        params : the parameters, Symbols
        bound : whether the function returns ``(values, bounds)`` with ``|value - exact| <= bound`` proved for every
            entry; bounds are infinite where the value is not finite

        Raises
        ------
        MissingParameterError
            if a parameter is not among ``params``.

        Notes
        -----
        Speed and accuracy: for Mathieu's trace on one core some 2e6 points/s at n = 20 and 4e5 at n = 50, most of them
        in pairs; a point that needs balls takes some 50 microseconds.  See ``benchmarks/evaluation.py``.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, t
        >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 20)
        >>> value, error = F.lambdify_trace([a, b], bound=True)([-0.1, 0.1], 0.55)
        >>> print(value, error < 1e-15)
        [-0.07955916 -5.26098134] [ True  True]
        """
        return vectorise(self._collapsed, params, self._shape, bound)

    def lambdify_trace(self, params: Sequence[Symbol], bound: bool = False) -> Callable[..., Any]:
        """A NumPy function for the trace, right to 10 ulp of the trace itself; otherwise as :meth:`lambdify`."""
        return vectorise(self._collapsed_trace, params, (), bound)

    # -- printing ------------------------------------------------------------

    def __repr__(self) -> str:
        return f"<FloquetMatrix of order {self._n}, shape {self._shape[0]} x {self._shape[1]}, period {self._period}>"

    def _repr_latex_(self) -> str:
        if self._n > 8:
            return f"$\\displaystyle \\text{{{repr(self).strip('<>')}}}$"
        return latex_or_summary(self, sum(len(modes) for modes in self._all()))


# -- the period --------------------------------------------------------------


def check_period(matrix: SeriesMatrix, period: Any) -> Polynomial:
    """The period as a polynomial in its symbols, if every entry of the matrix repeats with it."""
    expression = as_finite(period, "the period")
    if expression.has(sympy.Float):
        raise BadInputError(f"the period must be exact, but {expression} is a float: its cosines are not exactly 1.  "
                            "Use an exact period such as 2*pi.")
    if expression.is_positive is False:
        raise BadInputError(f"the period must be positive, but it is {expression}.  Use 2*pi, say.")
    length = as_polynomial(read_constant(expression, matrix.t, "the period"), "the period")
    for i, row in enumerate(matrix.rows):
        for j, modes in enumerate(row):
            for (kind, angle, monomial), f in modes.items():
                _check_mode(matrix, (i, j), {(kind, angle, monomial): f}, length, expression)
    return length


def _check_mode(matrix: SeriesMatrix, place: tuple[int, int], mode: Modes, length: Polynomial, period: Expr) -> None:
    (((_, angle, _), f),) = mode.items()
    turns = _turns(angle[0], length)
    if f.degree() == 0 and (not turns or list(turns) == [ONE] and turns[ONE].q == 1):
        return
    i, j = place
    if f.degree() > 0:
        evidence, remedy = "which is not periodic but grows with the time", "Only trigonometric polynomials repeat."
    else:
        evidence = f"which makes {to_expression(turns)} of a turn in that time"
        remedy = _remedy(matrix)
    raise NotPeriodicError(f"P does not repeat with period {period}: entry P[{i}, {j}] contains "
                           f"{write(mode, matrix.t)}, {evidence}.  {remedy}")


def _turns(frequency: algebra.Linear, length: Polynomial) -> Polynomial:
    """``q T / (2 pi)``."""
    return multiply(multiply(algebra.as_polynomial(frequency), length), {((generator(pi), -1),): fmpq(1, 2)})


def _remedy(matrix: SeriesMatrix) -> str:
    frequencies = {angle[0] for row in matrix.rows for modes in row for _, angle, _ in modes if angle[0]}
    unit = algebra.common_unit(frequencies)
    if unit is None:
        return "The frequencies have no common period."
    return f"All entries repeat together after period={2 * pi / to_expression({unit[0]: unit[1]})}."
