r"""Rows: for one wave and one monomial the coefficients over all powers of time, as one polynomial.

In the basis of :mod:`fastpicard.modes` a row is ``f(x)``, with ``x**r`` for ``s**r / r!``.  Products to sums only add
rows, and integration ``q G_r = f_r + G_{r+1}`` is one exact division,

    G = quotient of  x f(x)  by  q x - 1,

all of it inside python-flint.  Two integrals are one division too, of ``x**2 f(x)`` by ``-(q x - 1)**2``, and
differentiation is a product, ``(1 - q x) G / x``.  Rows are found by one integer, twice the packed angle plus the
kind: moving by ``2 k`` moves the angle by ``k``.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from flint import fmpq, fmpq_poly

from fastpicard.coordinates import Problem
from fastpicard.modes import COS, SIN, mask, rational_sum

Rows = dict[int, Any]  # 2 * angle + kind -> fmpq_poly
Entry = dict[int, Rows]  # monomial -> rows

_FLIP = fmpq_poly([0, -1])


# -- products to sums ---------------------------------------------------------


def multiple(rows: Rows, c: Any) -> Rows:
    """Rows times a number."""
    inverse = fmpq(1) / c  # python-flint divides a polynomial by a number faster than it multiplies by one
    return {key: row / inverse for key, row in rows.items()}


def add_rows(target: Rows, rows: Rows) -> None:
    """Add rows in place."""
    for key, row in rows.items():
        old = target.get(key)
        target[key] = row if old is None else old + row


def multiply_cosine(target: Rows, rows: Rows, k: int) -> None:
    """Add ``2 cos(k) rows``: every row moves up by ``k`` and down by ``k`` ([Neves], section 4: product to sum)."""
    get, step = target.get, 2 * k
    for key, row in rows.items():
        if key < 2:
            row = row + row
        else:
            lower, below = key - step, row
            if lower < 0:
                lower, below = reflection(lower, row)
            old = get(lower)
            target[lower] = below if old is None else old + below
        upper = key + step
        old = get(upper)
        target[upper] = row if old is None else old + row


def multiply_sine(target: Rows, rows: Rows, k: int) -> None:
    """Add ``2 sin(k) rows``: the kind changes, and one of the two directions its sign."""
    for key, row in rows.items():
        outer, inner = (-row, row) if key & 1 else (row, -row)
        other = key ^ 1
        lower = other - 2 * k
        if lower < 0:
            lower, inner = reflection(lower, inner)
        add_rows(target, {other + 2 * k: outer})
        add_rows(target, {lower: inner})


def reflection(key: int, row: Any) -> tuple[int, Any]:
    """The place and the row of the same function where the angle is negative."""
    kind = key & 1
    return 2 * kind - key, reflected(kind, row)


def reflected(kind: int, row: Any) -> Any:
    """``c_r(-x) = (-1)**r c_r(x)``, ``s_r(-x) = -(-1)**r s_r(x)``."""
    return row(_FLIP) if kind == COS else -row(_FLIP)


# -- calculus -----------------------------------------------------------------


class Divisors(dict[int, Any]):
    """For places of rows ``(divisor, place of the integral, q, 1 - q x, value, slope)``.

    The divisors are ``q x - 1`` of cosines, ``1 - q x`` of sines, for two integrals the product of both; where the
    integrand has the number ``common`` as a factor, over it.  ``value`` and ``slope`` are the places, where the
    frequency is gone, of the constant and of the multiple of ``t`` that let the integral and its derivative vanish at
    0, or None where they do anyhow.
    """

    def __init__(self, p: Problem, times: int, common: Any = 1) -> None:
        self.coordinates, self.times, self.common = p.coordinates, times, common

    def __missing__(self, key: int) -> tuple[Any, int, int, Any, int | None, int | None]:
        angle = key >> 1
        q = self.coordinates.frequency(angle)
        cosine, sine = fmpq_poly([-1, q]), fmpq_poly([1, -q])
        divisor = cosine * sine if self.times == 2 else sine if key & 1 else cosine
        target = key if self.times == 2 else key ^ 1
        start, kind = self.coordinates.without_frequency(angle), target & 1
        place = 2 * start + kind
        value = place if start or kind == COS else None
        slope = place if self.times == 2 and (start or kind == SIN) else None
        found = self[key] = divisor / self.common, target, q, sine, value, slope
        return found


def integral(product: Iterable[tuple[int, Rows]], divisors: Divisors) -> Entry:
    """The antiderivative that is zero at 0, and its derivative too, if it is the second one."""
    found = {monomial: _integrated(rows, divisors) for monomial, rows in product}
    return {monomial: rows for monomial, rows in found.items() if rows}


def _integrated(rows: Rows, divisors: Divisors) -> Rows:
    result: Rows = {}
    values: dict[int, list[Any]] = {}
    slopes: dict[int, list[Any]] = {}
    times = divisors.times
    for key, row in rows.items():
        if key < 2:
            row = mask(key, row)
        if not row:
            continue
        divisor, target, q, factor, value, slope = divisors[key]
        row = row.left_shift(times) // divisor
        if not q:
            add_rows(result, {target: row})
            continue
        result[target] = row
        if value is not None:
            values.setdefault(value, []).append(row[0])
        if slope is not None:
            slopes.setdefault(slope, []).append(row.mul_low(factor, 2)[1])
    for starts, r in ((values, 0), (slopes, 1)):
        for place, numbers in starts.items():
            row = fmpq_poly([0] * r + [-rational_sum(numbers)])
            if place < 0:
                place, row = reflection(place, row)
            add_rows(result, {place: row})
    return result


def derivative(rows: Rows, divisors: Divisors) -> Rows:
    """The inverse of integration: ``(1 - q x) G / x``."""
    result: Rows = {}
    for key, row in rows.items():
        result[key ^ 1] = (row * divisors[key ^ 1][0]).right_shift(1)
    return result
