r"""Picard iteration: any equation by the definition, linear periodic ones exactly and fast.

The iterates of ``x' = f(t, x)``, ``x(t0) = x0`` are ([Neves] (2))

    x_0 = x0,    x_{n+1}(t) = x0 + integral from t0 to t of f(s, x_n(s)) ds.

For ``f = P(t) x`` the operator is affine, so ``x_n`` is the sum of increments,

    x_n = I_0 + ... + I_n,    I_0 = x0,    I_{k+1}(t) = integral from t0 to t of P I_k,

and ``x_{n+k}`` costs only the ``k`` increments that are new.  Inside, time is
counted from ``t0``: ``P(t0 + u)`` has ``t0`` in its phases, and every integral
starts at ``u = 0``.
"""

from __future__ import annotations

import numbers
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import sympy
from sympy import Basic, Expr, ImmutableMatrix, Matrix, Symbol
from sympy.logic.boolalg import Boolean

from fastpicard.collapsed import Collapsed
from fastpicard.errors import BadInputError, BadTypeError, ShapeError, printed
from fastpicard.iteration import Increments, first_increments, identity_columns
from fastpicard.latex import summary
from fastpicard.matrix import AsMatrix, SeriesMatrix, as_list, latex_or_summary, read_matrix, read_vector
from fastpicard.reading import as_expression, as_finite, as_polynomial, as_time, check_same_time, plain, read_constant
from fastpicard.ring import Polynomial, to_expression
from fastpicard.series import PoissonSeries
from fastpicard.values import Values
from fastpicard.vectorise import vectorise
from fastpicard.writing import dyadic, write

LARGEST_ORDER = 100_000
# Of an elementary function of one of these SymPy knows no antiderivative, and searches many minutes to find that out.
SPECIAL = (sympy.fresnels, sympy.fresnelc, sympy.erf, sympy.erfi, sympy.Si, sympy.Ci, sympy.Ei, sympy.li)


def check_order(n: Any) -> int:
    """The order of an iterate, an integer from 0 to LARGEST_ORDER."""
    if isinstance(n, bool) or not isinstance(n, numbers.Integral):
        raise BadTypeError(f"the order n must be an integer, but it is {printed(n)}, a {type(n).__name__}.  Use "
                           "n=20, say.")
    if n < 0:
        raise BadInputError(f"the order n must be an integer from 0 up, but it is {printed(n)}.  n counts the "
                            "integrations.")
    if int(n) > LARGEST_ORDER:
        raise BadInputError(f"an iterate is made of all orders before it, and the order n is {printed(n)}.  Use "
                            f"at most {LARGEST_ORDER}; iterates rarely gain anything beyond 100.")
    return int(n)


# -- any equation ------------------------------------------------------------


def picard(f: Callable[[Any, Matrix], Any], t: Symbol, x0: Any, n: int, t0: Any = 0) -> ImmutableMatrix:
    """The n-th Picard iterate of any ``x' = f(t, x)``, by the definition ([Neves] (2), In[1] and In[2]).

    Parameters
    ----------
    f : function of (t, x)
        returns the right-hand side, a list or column Matrix as long as ``x``, a column Matrix of shape (m, 1).
    t : Symbol
    x0 : list or Matrix, length m     the value at ``t0``, free of ``t``
    n : int, from 0 up
    t0 : number or expression free of ``t``

    Returns
    -------
    ImmutableMatrix, shape (m, 1)
        exact; a float is the dyadic number it is.  Integrals come from SymPy's ``integrate``; one that SymPy cannot
        do stays an unevaluated ``Integral``, which is a correct answer (Out[3]).

    Raises
    ------
    BadInputError, BadTypeError
        for an order that is no integer from 0 up, ``x0``, ``t0`` that contain ``t`` or text, and where nan or an
        infinity occurs.

    Examples
    --------
    >>> from sympy.abc import t
    >>> picard(lambda t, x: [x[1], -x[0]], t, [1, 0], 3)
    Matrix([
    [1 - t**2/2],
    [t**3/6 - t]])
    """
    if not callable(f):
        raise BadTypeError(f"f must be a function of (t, x), but it is {f!r}.  Use lambda t, x: [...].")
    t = as_time(t)
    start = _plain_vector(x0, t)
    t0 = _plain_constant(t0, t, "t0")
    s = sympy.Dummy("s")
    x = Matrix(start)
    for _ in range(check_order(n)):
        slope = _slope(f(t, x), t)
        if slope.shape != x.shape:
            raise BadInputError(f"f(t, x) must have the shape {x.shape} of x0, but its shape is {slope.shape}.  "
                                "Return one component for each unknown.")
        x = Matrix([_proper(start[i] + _integral(slope[i].subs(t, s), s, t0, t), f"the integral of component {i} of "
                            f"f(t, x) from {t0} to {t}") for i in range(len(start))])
    return ImmutableMatrix(x)


def _integral(integrand: Expr, s: Symbol, lower: Expr, upper: Expr) -> Expr:
    """SymPy's integral; left unevaluated where a function of a special function occurs, as in Out[3]."""
    compositions = (f for f in integrand.atoms(sympy.Function) if s in f.free_symbols)
    if any(argument.has(*SPECIAL) for f in compositions for argument in f.args):
        return sympy.Integral(integrand, (s, lower, upper))
    return sympy.integrate(integrand, (s, lower, upper))


def _slope(value: Any, t: Symbol) -> Matrix:
    value = value.tolist() if isinstance(value, sympy.MatrixBase) else plain(value)
    if isinstance(value, str) or not isinstance(value, list | tuple):
        raise BadTypeError(f"f(t, x) must be a list or a column vector, but it is {value!r}.  Return its components.")
    rows = [row if isinstance(row, list | tuple) else [row] for row in value]
    if len({len(row) for row in rows}) > 1:
        raise ShapeError(f"f(t, x) must be a list or a column vector, but its rows have the lengths "
                         f"{[len(row) for row in rows]}.  Return its components.")
    return Matrix([[_component(entry, t) for entry in row] for row in rows])


def _component(value: Any, t: Symbol) -> Expr:
    what = "every component of f(t, x)"
    expression = dyadic(as_expression(value, what))
    check_same_time(expression, t)
    if not expression.is_commutative:
        raise BadInputError(f"{what} must commute, but it is {expression}.  Use a commutative Symbol.")
    return _proper(expression, what)


def _proper(expression: Expr, what: str) -> Expr:
    if _is_infinite(expression):
        raise BadInputError(f"{what} must be finite, but it is {expression}.  Start at a t0 and x0 where f(t, x) is "
                            "regular.")
    return expression


def _is_infinite(e: Basic) -> bool:
    """Whether nan or an infinity occurs, not counting conditions of pieces and limits of sums and integrals."""
    if not e.args:
        return e is sympy.nan or e.is_finite is False
    return not isinstance(e, Boolean) and type(e) is not sympy.Tuple and (
        isinstance(e, sympy.AccumBounds) or any(map(_is_infinite, e.args)))


def _plain_constant(value: Any, t: Symbol, what: str) -> Expr:
    expression = dyadic(as_finite(value, what))
    check_same_time(expression, t)
    if t in expression.free_symbols:
        raise BadInputError(f"{what} must not depend on {t}, but it is {expression}.  Use another symbol.")
    return expression


def _plain_vector(x0: Any, t: Symbol) -> list[Expr]:
    x0 = as_list(x0)
    if isinstance(x0, str) or not isinstance(x0, list | tuple | sympy.MatrixBase):
        raise BadTypeError(f"x0 must be a list or a column vector, but it is {x0!r}.  Give its components.")
    return [_plain_constant(value, t, f"x0[{i}]") for i, value in enumerate(x0)]


# -- iterates ----------------------------------------------------------------


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

    def to_order(self, n: int) -> PicardIterate:
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
        """The exact iterate at a time: SymPy expressions in the parameters.

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
