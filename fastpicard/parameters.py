r"""Values of the parameters, checked; and a problem, ``P`` and its period ``T``, at these values, in balls.

A value is an exact number, a ball, or an interval ``(lo, hi)``, which becomes a ball: what holds of the balls holds
for every point of the box.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from flint import arb
from sympy import Expr

from fastpicard.errors import BadInputError, BadTypeError, printed
from fastpicard.evaluate import Point, ball, free_symbols
from fastpicard.harmonics import Harmonics, harmonics
from fastpicard.matrix import SeriesMatrix
from fastpicard.precision import working
from fastpicard.ring import Polynomial
from fastpicard.values import Values, exact_number, exact_values

T = TypeVar("T")
BOUND_BITS = 8192  # the precision of P and T where a bound is asked for, or where less leaves them in doubt


def numbers_in(P: SeriesMatrix, values: Values | None, others: Iterable[Any] = ()) -> dict[Any, Any]:
    """The values of the parameters of ``P`` and of other symbols: exact numbers, or for ``(lo, hi)`` a ball.

    Raises
    ------
    MissingParameterError
        if a parameter has no value.
    BadInputError
        if ``lo > hi``.
    """
    needed = set(others).union(*(free_symbols(modes) for row in P.rows for modes in row))
    return exact_values(values, needed, P.t, number_or_interval)


def number_or_interval(value: Any, what: str) -> Any:
    """An exact number, or for ``(lo, hi)`` a ball; raises as :func:`numbers_in`, or BadTypeError."""
    if not isinstance(value, tuple):
        try:
            return exact_number(value, what)
        except BadTypeError as error:
            raise BadTypeError(f"{error}  For an interval, give the pair (lo, hi), or a ball.") from None
    if len(value) != 2:
        raise BadInputError(f"an interval is a pair (lo, hi), but {what} is {printed(value)}.  Give two numbers.")
    with working(256):
        lo, hi = (ball(exact_number(end, f"an end of {what}")) for end in value)
        if lo > hi:
            raise BadInputError(f"an interval is a pair (lo, hi) with lo <= hi, but {what} is {printed(value)}.  "
                                "Exchange the two.")
        return lo.union(hi)


def is_box(values: Mapping[Any, Any]) -> bool:
    """Whether a value is a ball with a radius, that is more than one point."""
    return any(isinstance(value, arb) and not value.is_exact() for value in values.values())


def problem_at(P: SeriesMatrix, period: Expr, length: Polynomial, exact: Mapping[Any, Any]) -> tuple[Harmonics, Any]:
    """``P`` and ``T`` at :func:`numbers_in`, in balls of the working precision, or of more where that is in doubt.

    ``length`` is the period as a polynomial.

    Raises
    ------
    BadInputError
        if ``P`` or ``T`` is not finite there, or ``T`` not positive; in a box, everywhere.
    """
    at, time = proved(lambda: (harmonics(P, exact), Point(arb(0), exact).polynomial(length)), _is_proper)
    if _is_proper((at, time)):
        return at, time
    if not at.is_finite or not time.is_finite():
        raise not_finite("P and its period", exact)
    raise BadInputError(f"the period must be positive, but {period} is {time.str(5)} at {_where(exact)}.  "
                        "Choose the sign of the parameters so that it is.")


def _is_proper(found: tuple[Harmonics, Any]) -> bool:
    """Whether ``P`` and the period are finite, and the period is positive, whatever the balls stand for."""
    P, period = found
    return P.is_finite and bool(period.is_finite()) and bool(period > 0)


def proved(build: Callable[[], T], suffices: Callable[[T], bool]) -> T:
    """What is built in balls of the working precision, or of ``BOUND_BITS`` where these do not suffice."""
    found = build()
    if not suffices(found):
        with working(BOUND_BITS):
            found = build()
    return found


def not_finite(what: str, exact: Mapping[Any, Any]) -> BadInputError:
    """The exception for a pole."""
    return BadInputError(f"{what} must be finite and real, but one of them is not at {_where(exact)}: a pole, or a "
                         "root of a negative number.  Keep away from there.")


def _where(exact: Mapping[Any, Any]) -> str:
    return ", ".join(f"{s} = {v}" for s, v in sorted(exact.items(), key=str)) or "no parameters"
