"""Whether a matrix repeats with a period, exactly: every frequency makes whole turns in that time."""

from __future__ import annotations

from functools import lru_cache
from math import gcd, lcm
from typing import Any

import sympy
from flint import fmpq
from sympy import Expr, pi

from fastpicard import modes as algebra
from fastpicard.errors import BadInputError, NotPeriodicError, printed
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import Modes
from fastpicard.reading import as_finite, as_polynomial, read_constant
from fastpicard.ring import ONE, Polynomial, generator, multiply, normal, rational_value, reciprocal, to_expression
from fastpicard.writing import write

FLOAT = 2**30  # a denominator that is a power of two and as large has come from a float


def check_period(matrix: SeriesMatrix, period: Any) -> Polynomial:
    """The period as a polynomial in its symbols, if every entry of the matrix repeats with it."""
    expression = as_finite(period, "the period")
    if expression.has(sympy.Float):
        raise BadInputError(f"the period must be exact, but {expression} is a float: its cosines are not exactly 1.  "
                            "Use an exact period such as 2*pi.")
    if expression.is_positive is False:
        raise BadInputError(f"the period must be positive, but it is {printed(expression)}.  Use 2*pi, say.")
    length = as_polynomial(read_constant(expression, matrix.t, "the period"))
    for i, row in enumerate(matrix.rows):
        for j, modes in enumerate(row):
            for (kind, angle, monomial), f in modes.items():
                _check_mode(matrix, (i, j), {(kind, angle, monomial): f}, length, expression)
    return length


def _check_mode(matrix: SeriesMatrix, place: tuple[int, int], mode: Modes, length: Polynomial, period: Expr) -> None:
    (((_, angle, _), f),) = mode.items()
    turns = to_expression(turns_of(angle[0], length))
    if f.degree() == 0 and turns.is_integer:
        return
    i, j = place
    if f.degree() > 0:
        evidence, remedy = "which is not periodic but grows with the time", "Only trigonometric polynomials repeat."
    else:
        evidence = f"which makes {printed(turns)} of a turn in that time"
        remedy = _remedy(matrix)
    raise NotPeriodicError(f"P does not repeat with period {printed(period)}: entry P[{i}, {j}] contains "
                           f"{write(mode, matrix.t)}, {evidence}.  {remedy}")


def turns_of(frequency: algebra.Linear, length: Polynomial) -> Polynomial:
    """``q T / (2 pi)``; what is always one number is that number."""
    return _turns_of(frequency, algebra.linear(length))


@lru_cache(maxsize=1 << 10)
def _turns_of(frequency: algebra.Linear, length: algebra.Linear) -> Polynomial:
    whole = multiply(algebra.as_polynomial(frequency), algebra.as_polynomial(length))
    turns = multiply(whole, {((generator(pi), -1),): fmpq(1, 2)})
    value = rational_value(turns)
    return normal(turns) if value is None else {ONE: value} if value else {}


def whole_turns(frequency: algebra.Linear, length: Polynomial) -> int | None:
    """``q T / (2 pi)``, or None where it is an integer that depends on symbols."""
    turns = turns_of(frequency, length)
    return int(turns.get(ONE, fmpq(0)).p) if turns.keys() <= {ONE} else None


def _remedy(matrix: SeriesMatrix) -> str:
    """The common period: all frequencies as rational multiples of one of them."""
    frequencies = sorted({angle[0] for row in matrix.rows for modes in row for _, angle, _ in modes if angle[0]})
    denominators = [int(c.q) for q in frequencies for c in algebra.as_polynomial(q).values()]
    if any(d >= FLOAT and d.bit_count() == 1 for d in denominators):
        return "A frequency looks like a float, which stands for a binary fraction: write Rational(1, 10), or sympy.pi."
    one = algebra.as_polynomial(frequencies[0])
    ratios = [rational_value(multiply(algebra.as_polynomial(q), reciprocal(one))) for q in frequencies]
    known = [ratio for ratio in ratios if ratio is not None]
    if len(known) < len(ratios):
        return "The frequencies have no common period."
    share = fmpq(gcd(*(int(x.p) for x in known)), lcm(*(int(x.q) for x in known)))
    unit = {m: c * share for m, c in one.items()}
    return f"All entries repeat together after period={2 * pi / to_expression(unit)}."
