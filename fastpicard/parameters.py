r"""Values of the parameters, checked; and a problem, ``P`` and its period ``T``, at these values, in balls.

A value is an exact number, a ball, or an interval ``(lo, hi)``, which becomes a ball: what holds of the balls holds
for every point of the box.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from flint import arb
from sympy import Expr

from fastpicard.errors import BadInputError, BadTypeError, printed
from fastpicard.evaluate import Point, ball, free_symbols
from fastpicard.harmonics import Harmonics, harmonics
from fastpicard.matrix import SeriesMatrix
from fastpicard.precision import working
from fastpicard.ring import Polynomial
from fastpicard.values import Values, exact_number, exact_values

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
    return exact_values(values, needed, P.t, _number_or_interval)


def _number_or_interval(value: Any, what: str) -> Any:
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
    def once() -> tuple[Harmonics, Any]:
        return harmonics(P, exact), Point(arb(0), exact).polynomial(length)

    found = once()
    if not _is_proper(*found):
        with working(BOUND_BITS):
            found = once()
    if _is_proper(*found):
        return found
    where = ", ".join(f"{s} = {v}" for s, v in sorted(exact.items(), key=str)) or "no parameters"
    if not found[0].is_finite or not found[1].is_finite():
        raise BadInputError(f"P and its period must be finite and real, but one of them is not at {where}: a pole, "
                            "or a root of a negative number.  Keep away from there.")
    raise BadInputError(f"the period must be positive, but {period} is {found[1].str(5)} at {where}.  "
                        "Choose the sign of the parameters so that it is.")


def _is_proper(P: Harmonics, period: Any) -> bool:
    """Whether ``P`` and the period are finite, and the period is positive, whatever the balls stand for."""
    return P.is_finite and bool(period.is_finite()) and bool(period > 0)
