"""Numbers in: every kind of number as the exact one it is, and the values of the parameters, checked."""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Iterable, Mapping
from decimal import Decimal
from typing import Any

import mpmath
import sympy
from flint import arb, fmpq, fmpz
from sympy import Expr, Symbol

from fastpicard.constants import exact_constant
from fastpicard.errors import BadInputError, BadTypeError, MissingParameterError, namesake, printed
from fastpicard.reading import plain
from fastpicard.ring import rational

Values = Mapping[Any, Any]
LARGEST_ORDER = 100_000


def exact_number(value: Any, what: str) -> Any:
    """A number as ``fmpq``, ``arb`` or real SymPy constant: the exact number the argument is.

    A float is the dyadic rational it stands for, ``mpmath.pi`` is pi.

    Raises
    ------
    BadTypeError
        for text, complex numbers and anything that is no number.
    BadInputError
        for nan and infinities.
    """
    value = plain(value)
    if isinstance(value, mpmath.mp.constant):
        return exact_constant(value, what)
    if isinstance(value, arb):
        return _finite(value, value.is_finite(), what)
    if isinstance(value, fmpq | fmpz):
        return fmpq(value)
    if isinstance(value, Expr):
        return _sympy_number(value, what)
    if isinstance(value, mpmath.mpf):
        return rational(sympy.Float(_finite(value, mpmath.isfinite(value), what), precision=max(value._mpf_[3], 53)))
    if isinstance(value, Decimal):
        return fmpq(*map(int, _finite(value, value.is_finite(), what).as_integer_ratio()))
    if isinstance(value, bool) or not isinstance(value, numbers.Real) or isinstance(value, type(mpmath.iv.one)):
        remedy = "Give an int, Fraction, SymPy number, mpf, float or arb; text is never evaluated."
        if isinstance(value, list):
            remedy = "Functions that lambdify makes take arrays, others one number at a time."
        raise BadTypeError(f"{what} must be a real number, but it is {value!r}, a {type(value).__name__}.  {remedy}")
    if isinstance(value, numbers.Rational):  # of any size, floats are not
        return fmpq(int(value.numerator), int(value.denominator))
    return fmpq(*map(int, _finite(value, math.isfinite(value), what).as_integer_ratio()))


def _finite(value: Any, finite: bool, what: str) -> Any:
    if not finite:
        raise BadInputError(f"{what} must be finite, but it is {value}.  Give a finite number.")
    return value


def _sympy_number(value: Expr, what: str) -> Any:
    if value.is_Rational or value.is_Float:
        return rational(_finite(value, value.is_finite is True, what))
    if value.free_symbols or not value.is_number or value.is_extended_real is False:
        raise BadTypeError(f"{what} must be a real number, but it is the expression {value}.  Substitute real numbers.")
    if value.is_finite is False or value is sympy.nan:
        raise BadInputError(f"{what} must be finite, but it is {value}.  Give a finite real number.")
    if value.is_finite is None:
        raise BadInputError(f"{what} must be finite, and SymPy does not tell whether {value} is.  Give its digits, as "
                            f"in ({value}).evalf(50).")
    return value


def exact_values(values: Values | None, needed: Iterable[Symbol], t: Symbol,
                 number: Callable[[Any, str], Any] | None = None) -> dict[Symbol, Any]:
    """The values of the parameters that occur, each read by ``number``, as a rule :func:`exact_number`.

    Raises
    ------
    MissingParameterError
        if one of them has none.
    BadInputError
        if the time ``t`` is among them, or a Symbol that is an integer is given another number.
    """
    if values is not None and not isinstance(values, Mapping):
        raise BadTypeError(f"values must map SymPy Symbols to numbers, but they are {printed(values)}, "
                           f"a {type(values).__name__}.  Use a dictionary: {{a: 2}}.")
    given = values or {}
    if t in given:
        raise BadInputError(f"the time {t} is no parameter, but the values give it: {printed(given)}.  "
                            "The time is an argument of its own.")
    for key in given:
        if not isinstance(key, Symbol):
            raise BadTypeError(f"values must map SymPy Symbols to numbers, but a key is {printed(key)}, "
                               f"a {type(key).__name__}.  Use the Symbol itself: {{a: 2}}.")
    missing = sorted((s for s in needed if s not in given), key=str)
    if missing:
        names = ", ".join(map(str, missing))
        raise MissingParameterError(f"every parameter needs a value, but {names} got none among {printed(given)}.  "
                                    f"Add {names} to the values.{namesake(missing, given)}")
    exact = {s: (number or exact_number)(value, f"the value of {s}") for s, value in given.items()}
    for s, value in exact.items():
        check_assumptions(s, value)
    return {s: exact[s] for s in needed}


def check_assumptions(s: Symbol, value: Any) -> None:
    """Raise BadInputError for a value that the assumptions of a Symbol exclude: SymPy has made use of them.

    Of a ball one number in it must be allowed.  Zero is let pass where they say positive or negative: it is the end of
    what they allow.
    """
    if isinstance(value, arb):
        integer, even, odd = (_holds_integer(value), _holds_integer(value / 2), _holds_integer((value - 1) / 2))
        low, high = value < 0, value > 0
    else:
        exact = value if isinstance(value, Expr) else sympy.Rational(int(value.p), int(value.q))
        integer, even, odd = exact.is_integer, not exact.is_odd, not exact.is_even
        low, high = exact.is_negative, exact.is_positive
    wrong = {"an integer": s.is_integer and not integer,
             "even": s.is_even and not even,
             "odd": s.is_odd and not odd,
             "positive": s.is_positive and low, "not negative": s.is_nonnegative and low,
             "negative": s.is_negative and high, "not positive": s.is_nonpositive and high}
    for what, excluded in wrong.items():
        if excluded:
            raise BadInputError(f"{s} is {what} by its assumptions, which SymPy has made use of, but its value is "
                                f"{printed(value)}.  Give another value, or use a Symbol without that assumption.")


def _holds_integer(x: Any) -> bool:
    return bool(x.contains_integer()) if x.is_finite() else True


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
