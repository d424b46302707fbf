r"""Poisson series: finite sums of modes ``c t**r cos(q t + phi)``, ``c t**r sin(q t + phi)``.

They form the family F of [Neves], section 3, closed under sums, products,
derivatives and integrals.  This is the face of :mod:`fastpicard.modes`.
"""

from __future__ import annotations

import numbers
from typing import Any

import sympy
from flint import fmpq_poly
from sympy import Expr, Symbol

from fastpicard import modes as algebra
from fastpicard.equality import support, vanishes
from fastpicard.errors import BadInputError, BadTypeError, printed
from fastpicard.evaluate import evaluate, free_symbols
from fastpicard.latex import sentence, shown
from fastpicard.modes import Modes
from fastpicard.origin import at_time
from fastpicard.reading import as_expression, as_finite, as_time, read, read_constant
from fastpicard.values import Values
from fastpicard.writing import dyadic, write

SHORT = 12  # terms printed before the rest is counted


class PoissonSeries:
    """A finite sum of modes ``c t**r cos(q t + phi)``, ``c t**r sin(q t + phi)`` with exact coefficients.

    Immutable and canonical: arithmetic returns new series, also with an
    expression or number on the left, and ``f == x`` is mathematical equality with
    a series, expression or number ``x`` (``x == f`` is SymPy's, of trees).  What
    SymPy cannot show to be equal, ``gamma(a + 1)`` and ``a gamma(a)``, counts as
    different.  No operation rounds; a float is the dyadic rational it stands for.

    Parameters
    ----------
    expression : Expr or number
        any expression of the family: sums and products of constants, ``t**r``,
        ``sin`` and ``cos`` of ``q t + phi``, and ``exp(I (q t + phi))``.
    t : Symbol
        the time; everything free of it may be a coefficient, frequency or phase.

    Raises
    ------
    NotInFamilyError
        if the expression is not of the family, with the part that is not.
    BadTypeError
        for text, which is never evaluated.

    Notes
    -----
    Results with symbolic frequencies hold where no frequency that is divided by vanishes.  An expression or a number
    that is equal to a series has a hash of its own: ``3 in {PoissonSeries(3, t)}`` is False.

    Examples
    --------
    >>> from sympy import Symbol, cos, sin
    >>> t, a = Symbol('t'), Symbol('a')
    >>> f = PoissonSeries(a*cos(t)**2, t)
    >>> print(f)
    a*cos(2*t)/2 + a/2
    >>> print(f.integrate())
    a*t/2 + a*sin(2*t)/4
    >>> f.integrate().diff() == f
    True
    """

    _op_priority = 20.0  # SymPy then leaves a*f and cos(t) - f to this class

    __slots__ = ("_hash", "_modes", "_t")

    def __init__(self, expression: Any, t: Symbol) -> None:
        self._t = as_time(t)
        self._modes = read(expression, self._t)
        self._hash: int | None = None

    @classmethod
    def from_modes(cls, modes: Modes, t: Symbol) -> PoissonSeries:
        """The series of modes that are canonical already."""
        series = object.__new__(cls)
        series._t, series._modes, series._hash = t, modes, None
        return series

    # -- what it holds -------------------------------------------------------

    @property
    def t(self) -> Symbol:
        """The time symbol."""
        return self._t

    @property
    def modes(self) -> Modes:
        """A copy of the modes, polynomials included, see :mod:`fastpicard.modes`."""
        return {key: fmpq_poly(f) for key, f in self._modes.items()}

    @property
    def free_symbols(self) -> set[Symbol]:
        """The parameters: every symbol but the time."""
        return free_symbols(self._modes)

    def __len__(self) -> int:
        """The number of terms."""
        return sum(1 for f in self._modes.values() for c in f.coeffs() if c)

    def __bool__(self) -> bool:
        """False for the series that is identically zero."""
        return not vanishes(self._modes)

    # -- ring operations -----------------------------------------------------

    def _other(self, value: Any) -> Modes | None:
        """The modes of an operand, or None where the operation is not ours."""
        if isinstance(value, PoissonSeries):
            if value._t != self._t:
                raise BadInputError(f"both series must have the same time, but they have {self._t} and {value._t}.  "
                                    "Substitute one for the other.")
            return value._modes
        if isinstance(value, sympy.MatrixBase):
            return None
        return read(as_expression(value), self._t)

    def _make(self, modes: Modes) -> PoissonSeries:
        return PoissonSeries.from_modes(modes, self._t)

    def __add__(self, other: Any) -> PoissonSeries:
        modes = self._other(other)
        return NotImplemented if modes is None else self._make(algebra.total(self._modes, modes))

    def __pos__(self) -> PoissonSeries:
        return self

    def __neg__(self) -> PoissonSeries:
        return self._make(algebra.negative(self._modes))

    def __sub__(self, other: Any) -> PoissonSeries:
        modes = self._other(other)
        return NotImplemented if modes is None else self._make(algebra.total(self._modes, algebra.negative(modes)))

    def __rsub__(self, other: Any) -> PoissonSeries:
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, sympy.MatrixBase):
            return self.as_expr() * other
        modes = self._other(other)
        return NotImplemented if modes is None else self._make(algebra.product(self._modes, modes))

    __radd__ = __add__
    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> PoissonSeries:
        divisor = dyadic(as_finite(other, "the divisor"))
        if divisor == 0:
            raise BadInputError(f"the divisor must not be 0, but {self!r} is divided by {other!r}.  Use another.")
        return self._make(algebra.product(self._modes, read_constant(1 / divisor, self._t, "1 over the divisor")))

    def __rtruediv__(self, other: Any) -> PoissonSeries:
        return PoissonSeries(other, self._t) / self

    def __pow__(self, exponent: int) -> PoissonSeries:
        if isinstance(exponent, bool) or not isinstance(exponent, numbers.Integral):
            raise BadTypeError(f"the exponent must be an int, but it is {printed(exponent)}.  Use an integer "
                               "from 0 up.")
        if exponent < 0:
            raise BadInputError("a power of a series is a series for exponents from 0 up, but the exponent is "
                                f"{printed(exponent)}.  Negative powers leave the family.")
        return self._make(algebra.power(self._modes, int(exponent)))

    def scale(self, factor: Any) -> PoissonSeries:
        """The series times a constant: a number or an expression free of the time."""
        return self._make(algebra.product(self._modes, read_constant(factor, self._t, "the factor")))

    def __eq__(self, other: object) -> bool:
        if isinstance(other, PoissonSeries):
            return self._t == other._t and vanishes((self - other)._modes)
        if isinstance(other, bool) or not isinstance(other, Expr | numbers.Number):
            return NotImplemented
        try:
            return vanishes((self - other)._modes)
        except (BadInputError, BadTypeError):  # not of the family
            return False

    def __hash__(self) -> int:
        """Of the functions of time that occur: their coefficients have many forms, ``b/(b + c) + c/(b + c) = 1``.

        Equal series have equal hashes.  An expression or a number equal to a series has a hash of its own.
        """
        if self._hash is None:
            self._hash = hash((self._t, support(self._modes)))
        return self._hash

    def __reduce__(self) -> tuple[Any, ...]:
        return PoissonSeries, (self.as_expr(), self._t)

    # -- calculus ------------------------------------------------------------

    def diff(self, t: Symbol | None = None) -> PoissonSeries:
        """The derivative with respect to the time, which may be given as to SymPy's ``diff``.

        Raises BadInputError for another variable.
        """
        if t is not None and t != self._t:
            raise BadInputError(f"the derivative of a series is that by its time {self._t}, but the variable is {t}.  "
                                f"Use as_expr().diff({t}) for a parameter.")
        return self._make(algebra.derivative(self._modes))

    def integrate(self) -> PoissonSeries:
        """The antiderivative that is zero at time 0 ([Neves] (8) and (9) and the constant after them)."""
        return self._make(algebra.antiderivative(self._modes))

    # -- values --------------------------------------------------------------

    def __call__(self, time: Any) -> Expr:
        """The exact value at a time, a SymPy expression in the parameters, powers of sums multiplied out."""
        return at_time(self._modes, time, self._t)

    def evaluate(self, time: Any, values: Values | None = None, digits: int | None = None) -> Any:
        """The value at a time as a number: float64, or an mpf with ``digits`` correct digits.

        Computed in balls, so no digit returned is wrong by more than the rounding of the last.

        Raises
        ------
        MissingParameterError
            if a parameter has no value.
        """
        return evaluate([self._modes], self._t, time, values, digits)[0]

    # -- printing ------------------------------------------------------------

    def as_expr(self) -> Expr:
        """The series as a canonical, expanded SymPy expression."""
        return write(self._modes, self._t)

    _sympy_ = as_expr

    def _latex(self, printer: Any) -> str:
        return str(printer.doprint(self.as_expr()))

    def __str__(self) -> str:
        return str(self.as_expr())

    def __repr__(self) -> str:
        count = len(self)
        body = str(self) if count <= SHORT else f"<{count} terms>"
        return f"PoissonSeries({body}, {self._t})"

    def _repr_latex_(self) -> str:
        if len(self) <= 4 * SHORT:
            return shown(sympy.latex(self.as_expr()))
        return shown(sentence(f"Poisson series in {self._t} with {len(self)} terms"))
