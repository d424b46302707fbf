"""Whether a matrix repeats with a period, exactly: every frequency makes whole turns in that time."""

from __future__ import annotations

from typing import Any

import sympy
from flint import fmpq
from sympy import Expr, pi

from fastpicard import modes as algebra
from fastpicard.errors import BadInputError, NotPeriodicError
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import Modes
from fastpicard.reading import as_finite, as_polynomial, read_constant
from fastpicard.ring import ONE, Polynomial, generator, multiply, normal, to_expression
from fastpicard.writing import write


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
    turns = turns_of(angle[0], length)
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


def turns_of(frequency: algebra.Linear, length: Polynomial) -> Polynomial:
    """``q T / (2 pi)``."""
    return normal(multiply(multiply(algebra.as_polynomial(frequency), length), {((generator(pi), -1),): fmpq(1, 2)}))


def _remedy(matrix: SeriesMatrix) -> str:
    frequencies = {angle[0] for row in matrix.rows for modes in row for _, angle, _ in modes if angle[0]}
    unit = algebra.common_unit(frequencies)
    if unit is None:
        return "The frequencies have no common period."
    return f"All entries repeat together after period={2 * pi / to_expression({unit[0]: unit[1]})}."
