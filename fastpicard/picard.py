r"""Picard iteration of ``x' = P(t) x``, exactly and fast; of any other equation in :mod:`fastpicard.definition`.

The operator is affine, so the iterate is the sum of increments,

    x_n = I_0 + ... + I_n,    I_0 = x0,    I_{k+1}(t) = integral from t0 to t of P I_k,

and ``x_{n+k}`` costs only the ``k`` increments that are new.  Inside, time is
counted from ``t0``: ``P(t0 + u)`` has ``t0`` in its phases, and every integral
starts at ``u = 0``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self

from sympy import Expr, ImmutableMatrix, Symbol

from fastpicard.collapsed import Collapsed
from fastpicard.definition import picard
from fastpicard.errors import BadInputError
from fastpicard.evaluate import count_of_digits
from fastpicard.iteration import Increments, first_increments, identity_columns
from fastpicard.latex import summary
from fastpicard.matrix import AsMatrix, SeriesMatrix, latex_or_summary, read_matrix, read_vector
from fastpicard.reading import as_polynomial, read_constant
from fastpicard.remainder import reported, tolerance
from fastpicard.ring import Polynomial, to_expression
from fastpicard.series import PoissonSeries
from fastpicard.solution import InitialValueProblem
from fastpicard.values import Values, check_order
from fastpicard.vectorise import vectorise
from fastpicard.writing import write


@dataclass(frozen=True, eq=False, repr=False)
class PicardIterate(AsMatrix):
    """The exact n-th Picard iterate of ``x' = P(t) x``, one column for each initial vector.

    Immutable.  Coefficients are exact rationals times parameters; nothing is
    rounded.  The iterate stays in the engine's own form until it is asked for.

    Attributes
    ----------
    t : Symbol              the time
    n : int                 the order
    shape : (rows, columns)
    P : SeriesMatrix
    t0 : Expr               the initial time
    x0 : the initial vector as expressions, or None for the identity matrix

    Notes
    -----
    ``X[i, j]`` is an entry as :class:`PoissonSeries`, ``X.as_matrix()`` exact SymPy,
    ``X(time)`` the exact value at a time and ``X.evaluate(time, values, digits)``
    numbers.  ``X.to_order(m)`` goes on from here.  Where a frequency is symbolic
    the result holds wherever no frequency that is divided by vanishes.
    """

    t: Symbol
    n: int
    shape: tuple[int, int]
    increments: Increments = field(repr=False)
    origin: Polynomial = field(repr=False)
    P: SeriesMatrix = field(repr=False)
    x0: tuple[Expr, ...] | None = field(repr=False, default=None)

    def __reduce__(self) -> tuple[Any, ...]:
        """The arguments: the iterate is computed again."""
        if self.x0 is None:
            return FundamentalMatrix, (self.P, self.t, self.n, self.t0)
        return fast_picard, (self.P, self.t, self.x0, self.n, self.t0)

    @property
    def t0(self) -> Expr:
        """The initial time."""
        return to_expression(self.origin)

    @property
    def free_symbols(self) -> set[Symbol]:
        """The parameters, those of ``t0`` and ``x0`` too."""
        return self.P.free_symbols.union(self.t0.free_symbols, *(x.free_symbols for x in self.x0 or ()))

    def to_order(self, n: int) -> Self:
        """The iterate of order ``n``, at the cost of the increments that are new; a lower one is computed anew."""
        n = check_order(n)
        new = object.__new__(type(self))
        for name, value in (("t", self.t), ("n", n), ("shape", self.shape),
                            ("increments", self.increments.to_order(n)), ("origin", self.origin),
                            ("P", self.P), ("x0", self.x0)):
            object.__setattr__(new, name, value)
        return new

    def increment(self, k: int) -> SeriesMatrix:
        """``I_k``, for ``k`` from 0 to ``n``: the difference of the iterates of order ``k`` and ``k - 1``.

        Only the last increment is kept, so that memory grows as the terms of the iterate; others are computed anew.
        """
        if not 0 <= check_order(k) <= self.n:
            raise BadInputError(f"the increments go from 0 to {self.n}, but k is {k}.  Use to_order({k}) first.")
        rows, columns = self.shape
        found = self.increments.to_order(k)
        return SeriesMatrix(tuple(tuple(found.newest(i, j) for j in range(columns)) for i in range(rows)),
                            self.t).shifted(self._back())

    def _back(self) -> Polynomial:
        return {m: -c for m, c in self.origin.items()}

    @cached_property
    def series(self) -> SeriesMatrix:
        """The iterate as a matrix of Poisson series."""
        rows, columns = self.shape
        entries = tuple(tuple(self.increments.total(i, j) for j in range(columns)) for i in range(rows))
        return SeriesMatrix(entries, self.t).shifted(self._back())

    def __getitem__(self, index: tuple[int, int]) -> PoissonSeries:
        """One entry, exact."""
        return self.series[index]

    def as_matrix(self) -> ImmutableMatrix:
        """The iterate as an exact SymPy matrix, entries expanded and canonical."""
        return self.series.as_matrix()

    def __call__(self, time: Any) -> ImmutableMatrix:
        """The exact iterate at a time: SymPy expressions in the parameters, expanded.

        At a sum of Symbols powers are multiplied out, so that the iterate at its origin is the initial value; a sum of
        three and more is better put in for a Symbol afterwards.
        With Symbols among the frequencies it is that of generic ones: at a resonance it is another, also where SymPy
        has made ``sin(2*pi*k)/k`` zero for an integer k.
        """
        return self.series(time)

    def evaluate(self, t_value: Any, values: Values | None = None, digits: int | None = None) -> Any:
        """The iterate at a time in numbers.

        Parameters
        ----------
        t_value : number        int, Fraction, float (the dyadic number it is), mpf, SymPy number, arb
        values : {Symbol: number} for every parameter
        digits : None for a float64 array, or the number of correct digits of an mpmath matrix

        Returns
        -------
        array or matrix of the iterate's shape; computed in balls, so that only the last digit is rounded.

        Raises
        ------
        MissingParameterError
            if a parameter has no value.
        """
        return self.series.evaluate(t_value, values, digits)

    def lambdify(self, t_value: Any, params: Sequence[Symbol], bound: bool = False) -> Callable[..., Any]:
        """A NumPy function of the parameters for the iterate at one time; arrays broadcast to (..., rows, columns).

        Every entry is right to 10 ulp of the largest, with ``bound=True`` beside its proved bound:
        see :meth:`fastpicard.FloquetMatrix.lambdify`.  ``t_value`` is a number as for :meth:`evaluate`.

        Raises
        ------
        MissingParameterError
            if a parameter is not among ``params``.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, t
        >>> Phi = FundamentalMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 20)
        >>> print(Phi.lambdify(0.5, [a, b])([0, 2.5], [0, 1.5])[:, 0, 0])
        [1.         0.54332602]
        """
        return vectorise(Collapsed([modes for row in self.series.rows for modes in row], self.t, t_value), params,
                         self.shape, bound)

    # -- the truth -----------------------------------------------------------

    @cached_property
    def _problem(self) -> InitialValueProblem:
        columns = None if self.x0 is None else (read_vector(self.x0, self.t, self.shape[0]),)
        return InitialValueProblem(self.P, self.origin, columns)

    def remainder(self, t_value: Any, values: Values | None = None, entrywise: bool = False) -> Any:
        """A rigorous upper bound of ``|x(t) - x_n(t)|``, the iterate's distance from the truth at a time.

        Parameters
        ----------
        t_value : number, ball, or interval (lo, hi)    before ``t0`` too; unit of time
        values, entrywise : as :meth:`fastpicard.FloquetMatrix.remainder`, those of ``t0`` and ``x0`` too

        Returns
        -------
        float, rounded up, the largest row sum; or an array of the iterate's shape.

        Raises
        ------
        MissingParameterError
            if a parameter has no value.
        BadInputError
            if something is not finite there, or if powers of the time occur in ``P``.

        Notes
        -----
        ``P`` need not be periodic; otherwise as :meth:`fastpicard.FloquetMatrix.remainder`, with the time since
        ``t0`` for the period.

        Examples
        --------
        >>> from sympy import Matrix, cos, sqrt
        >>> from sympy.abc import a, b, t
        >>> X = fast_picard(Matrix([[0, 1], [-a - b*cos(t) - b*cos(sqrt(2)*t), 0]]), t, [1, 0], 8)
        >>> [f"{X.remainder(s, {a: 1, b: 0.5}):.1e}" for s in (-1, 0, 1, 4)]
        ['4.5e-05', '0.0e+00', '4.5e-05', '2.1e-01']
        """
        return reported(self._problem.remainder(t_value, values, self.n), entrywise)

    def enclosure(self, t_value: Any, values: Values | None = None, digits: int = 15) -> Any:
        """A python-flint ``arb_mat``, shape (rows, columns), that contains the true solution at a time.

        Arguments as :meth:`remainder`; every radius is at most ``10**-digits`` of its entry, or for entries below
        ``10**-digits`` of the largest one, ``10**-digits`` of that bound.

        Raises
        ------
        MissingParameterError
            if a parameter has no value.
        BadInputError
            if parameters or the time are balls too wide for the digits; as :meth:`remainder`.

        Notes
        -----
        As :meth:`fastpicard.FloquetMatrix.enclosure`: Taylor polynomials with a bound of their defect.  Independent of
        ``n``.  Where all frequencies have a common unit a long time costs no more than two periods.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, t
        >>> X = fast_picard(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, [1, 0], 0)
        >>> print(X.enclosure(10**6, {a: 1, b: 0.5}, digits=20)[0, 0].str(20))
        [-1.3461049157784645287e+10081 +/- 2.91e+10061]
        """
        return self._problem.enclosure(t_value, values, count_of_digits(digits))

    # -- printing ------------------------------------------------------------

    def __repr__(self) -> str:
        rows, columns = self.shape
        return f"<{type(self).__name__} of order {self.n}, shape {rows} x {columns}, in {self.t}>"

    def _repr_latex_(self) -> str:
        if self.n > 8:
            return summary(self)
        return latex_or_summary(self, sum(len(self[i, j]) for i in range(self.shape[0]) for j in range(self.shape[1])))


def _origin(t0: Any, t: Symbol) -> Polynomial:
    return as_polynomial(read_constant(t0, t, "t0"))


def fast_picard(P: Any, t: Symbol, x0: Any, n: int, t0: Any = 0) -> PicardIterate:
    """The exact n-th Picard iterate of ``x' = P(t) x``, ``x(t0) = x0`` ([Neves], section 4, ``FastPicard``).

    Parameters
    ----------
    P : Matrix, shape (m, m), or a function of one argument that returns it
        entries are sums of sines and cosines of linear functions of ``t`` with
        coefficients free of ``t`` ([Neves] (6)); powers of ``t`` are allowed too.
        Floats are taken as the exact dyadic numbers they are.
    t : Symbol
    x0 : list or Matrix, length m     numbers or expressions free of ``t``
    n : int, from 0 up                the number of integrations
    t0 : number or expression free of ``t``, default 0

    Returns
    -------
    PicardIterate, shape (m, 1)

    Raises
    ------
    NotInFamilyError
        if an entry of ``P`` is no trigonometric polynomial, with the entry.
    ShapeError
        if ``P`` is not square or ``x0`` does not fit.
    BadInputError, BadTypeError
        for ``n`` that is no integer from 0 up, ``t`` among ``x0`` or ``t0``, nan, text.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> fast_picard(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, [1, -2], 2).as_matrix()
    Matrix([
    [             -a*t**2/2 + b*cos(t) - b - 2*t + 1],
    [a*t**2 - a*t + 2*b*t*sin(t) - b*sin(t) + 2*b*cos(t) - 2*b - 2]])
    """
    matrix = read_matrix(P, t)
    order, origin = check_order(n), _origin(t0, t)
    start = read_vector(x0, t, matrix.shape[0])
    found = first_increments(matrix.shifted(origin), [start], order)
    return PicardIterate(t, order, (matrix.shape[0], 1), found, origin, matrix, tuple(write(x, t) for x in start))


@dataclass(frozen=True, eq=False, repr=False, init=False)
class FundamentalMatrix(PicardIterate):
    """``Phi_n``: the n-th exact Picard iterate of ``X' = P(t) X``, ``X(t0) = 1`` ([Neves], section 4).

    Parameters
    ----------
    P : Matrix, shape (m, m), or a function of one argument     as for :func:`fast_picard`
    t : Symbol
    n : int, from 0 up
    t0 : number or expression free of ``t``, default 0

    Attributes and methods are those of :class:`PicardIterate`; the shape is (m, m).

    Raises
    ------
    NotInFamilyError, ShapeError, BadInputError, BadTypeError
        as :func:`fast_picard`.

    Notes
    -----
    Speed: about n**4 / 30 terms for Mathieu's equation; see ``benchmarks/``.  Converting to SymPy costs far more
    than computing, so ask for :meth:`evaluate` or one entry where that is enough.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> Phi = FundamentalMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 20)
    >>> print(Phi.evaluate(1, {a: 0, b: 0}))
    [[1. 1.]
     [0. 1.]]
    """

    def __init__(self, P: Any, t: Symbol, n: int, t0: Any = 0) -> None:
        matrix = read_matrix(P, t)
        order, origin = check_order(n), _origin(t0, t)
        found = first_increments(matrix.shifted(origin), identity_columns(matrix.shape[0]), order)
        super().__init__(t, order, matrix.shape, found, origin, matrix)

    @classmethod
    def for_accuracy(cls, P: Any, t: Symbol, t_value: Any, values: Values | None, tol: Any,
                     t0: Any = 0) -> Self:
        """The iterate of the smallest order whose proved :meth:`remainder` at a time is at most ``tol``.

        ``t_value`` and ``values`` as there; every higher order meets ``tol`` as well.  Raises as
        :meth:`fastpicard.FloquetMatrix.for_accuracy`.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, t
        >>> P = Matrix([[0, 1], [-a - b*cos(t), 0]])
        >>> FundamentalMatrix.for_accuracy(P, t, 1, {a: 2.25, b: 0.1}, 1e-12).n
        17
        """
        first = cls(P, t, 0, t0)
        return first.to_order(first._problem.smallest_order(t_value, values, tolerance(tol)))


__all__ = ["FundamentalMatrix", "PicardIterate", "fast_picard", "picard"]
