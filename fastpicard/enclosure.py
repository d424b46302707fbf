r"""Enclosures of the true transition matrix: what the equation does, not what an iterate does.

A polynomial ``F`` in ``u = (t - start)/h`` with ``F(0) = 1`` need not be trusted, it is proved
by its defect.  With ``R = h P F - F'`` the error ``E = Phi - F`` obeys ``E' = h P E + R``,
``E(0) = 0``, and Picard's own argument bounds it entry by entry,

    |E(u)|  <=  exp(h Pbar) * sup over [0, 1] of |R|,      Pbar = sup |P|.

``F`` is the Taylor polynomial, computed in integers (units of ``2**-bits``) from
``(k + 1) F_{k+1} = sum_m P_m F_{k-m}``; its defect is an exact product of integer
polynomials plus what the Taylor polynomial of ``P`` leaves out, which is bounded.  So
no rounding has to be followed, and every number type of the parameters is one case: a
ball's radius only widens ``P``.

Over a period the symmetries of ``P`` are used: a shorter period ``T/k`` (then
``Phi(T) = Phi(T/k)**k``), and reversal, ``s P(-t) s = -P(t)`` with signs ``s``
(then ``Phi(T) = s Phi(T/2)**-1 s Phi(T/2)``: half the way).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from operator import mul
from typing import Any

from flint import arb, arb_mat, ctx, fmpz, fmpz_poly
from mpmath.libmp import dps_to_prec

from fastpicard.errors import BadInputError
from fastpicard.harmonics import Harmonics

MOST_PIECES, MOST_ORDERS = 1 << 20, 1 << 14
Rows = list[list[Any]]


def over_period(build: Callable[[], tuple[Harmonics, Any]], turns: int, digits: int, is_box: bool = False,
                strict: bool = True) -> Any:
    """An ``arb_mat`` that contains ``Phi(T)``, with the digits asked for.

    Parameters
    ----------
    build : function without arguments that gives ``P`` and ``T`` in balls of the working precision
    turns : int     ``T/turns`` is a period too
    digits : int    every radius is at most ``10**-digits`` of its entry, or ``10**-2digits`` of the largest
    is_box : bool   whether parameters are balls with a radius, which may not allow the digits
    strict : bool   False to take what they allow

    Raises
    ------
    BadInputError
        if the parameters are balls too wide for the digits, or the system too stiff for any precision.
    """
    def once() -> Any:
        P, period = build()
        part = period / turns
        signs = P.reversal
        if signs is None:
            return transition(P, arb(0), part) ** turns
        half = transition(P, arb(0), part / 2)
        mirror = diagonal(signs)
        try:
            return (mirror * half.inv() * mirror * half) ** turns
        except ZeroDivisionError:  # too wide to be known as invertible
            return transition(P, arb(0), part) ** turns

    return to_digits(once, digits, is_box, strict)


def to_digits(compute: Callable[[], Any], digits: int, is_box: bool = False, strict: bool = True) -> Any:
    """A matrix of balls, computed with more and more bits until it has the digits asked for."""
    wanted = dps_to_prec(digits)
    bits, before = wanted + 32, None
    while True:
        with ctx.workprec(bits):
            found = compute()
            missing = shortfall(found, wanted)
        if missing <= 0:
            return found
        if is_box and before is not None and not missing < before - 8:
            if not strict:
                return found
            raise BadInputError(f"the digits asked for cannot be had: {digits} were asked for, and {bits} bits leave "
                                f"{max(wanted - missing, 0) / math.log2(10):.0f}: the parameters are balls with a "
                                f"radius.  Give numbers, narrower balls, or fewer digits.")
        if bits > 64 * wanted + 100_000:
            raise BadInputError(f"the matrix is not enclosed with {bits} bits.  Its entries are beyond reach: "
                                "take a smaller period or smaller coefficients.")
        before = missing
        bits += int(missing) + 16 if math.isfinite(missing) else bits


def shortfall(matrix: Any, wanted: int) -> float:
    """How many bits are missing until every radius is below ``2**-wanted`` of its entry or ``4**-wanted`` of all."""
    entries = matrix.entries()
    if not all(x.is_finite() for x in entries):
        return math.inf
    largest = max(_exponent(abs(x).upper()) for x in entries)
    worst = -math.inf
    for x in entries:
        if x.rad() == 0:
            continue
        scale = max(_exponent(abs(x).lower()), largest - wanted)
        worst = max(worst, _exponent(x.rad()) - scale + wanted + 1)
    return worst


def _exponent(x: Any) -> float:
    """``e`` with ``2**(e-1) <= x < 2**e``."""
    mantissa, exponent = x.mid().man_exp()
    return int(exponent) + int(mantissa).bit_length() if mantissa != 0 else -math.inf


def diagonal(signs: Any) -> Any:
    """``diag(signs)``."""
    n = len(signs)
    return arb_mat(n, n, [signs[i] if i == j else 0 for i in range(n) for j in range(n)])


# -- many steps --------------------------------------------------------------


def transition(P: Harmonics, start: Any, end: Any) -> Any:
    """An ``arb_mat`` that contains ``Phi(end, start)``, at the working precision."""
    length = end - start
    scales = _balance(P)
    speed, turn = _speed(P, scales) * _upper(abs(length)), P.highest * _upper(abs(length))
    # Found by trial: more digits, longer strides; but Taylor coefficients of waves fall slowly in long ones.
    pieces = max(1, math.ceil(speed / 0.25) if P.is_wide else math.ceil(max(speed / (5 + ctx.prec / 50), turn / 3.2)))
    if pieces > MOST_PIECES:
        raise BadInputError(f"the way from {start.str(5)} to {end.str(5)} takes more than {MOST_PIECES} steps: the "
                            f"coefficients reach {_upper(P.bound.det()):.3g}.  Take a smaller period.")
    step = length / pieces
    result = None
    for k in range(pieces):
        if result is None or not P.is_constant:
            guard = int(1.5 * speed / pieces) + pieces.bit_length() + 8  # what exp(h Pbar) costs
            once = _step(P.shifted(start + step * k), step, scales, ctx.prec + guard)
        result = once if result is None else once * result
    return result


def _upper(x: Any) -> float:
    return float(x.upper())


def _speed(P: Harmonics, scales: list[int]) -> float:
    """The norm of the balanced ``P``."""
    bound = P.bound
    rows = [sum(_upper(bound[i, j]) * 2.0 ** (scales[j] - scales[i]) for j in range(P.size)) for i in range(P.size)]
    return max(rows)


def _balance(P: Harmonics) -> list[int]:
    """Exponents ``d`` such that ``2**(d_j - d_i) Pbar_ij`` has rows and columns of like size (Osborne)."""
    size = P.size
    logs = {(i, j): _exponent(P.bound[i, j]) for i in range(size) for j in range(size)
            if i != j and not P.bound[i, j].is_zero()}
    d = [0] * size
    for _ in range(2 * size + 2):
        for k in range(size):
            row = max((x + d[j] - d[i] for (i, j), x in logs.items() if i == k), default=None)
            column = max((x + d[j] - d[i] for (i, j), x in logs.items() if j == k), default=None)
            if row is not None and column is not None:
                d[k] += round((row - column) / 2)
    return d


# -- one step ----------------------------------------------------------------


def _step(P: Harmonics, h: Any, scales: list[int], bits: int) -> Any:
    """``Phi(h, 0)`` by one Taylor polynomial and its defect."""
    size = P.size
    taylor = {(i, j): _taylor(waves, h * arb(2) ** (scales[j] - scales[i]), h, bits)
              for (i, j), waves in P.waves.items()}
    rows = [[(j, taylor[i, j][0]) for j in range(size) if (i, j) in taylor] for i in range(size)]
    columns = _solve(rows, bits)
    defect = _defect(rows, columns, {place: slack for place, (_, slack) in taylor.items()}, bits)
    growth = arb_mat([[P.bound[i, j] * abs(h) * arb(2) ** (scales[j] - scales[i]) for j in range(size)]
                      for i in range(size)]).exp()
    error = growth * defect
    return arb_mat([[(arb(sum(columns[j][i])) * arb(2) ** -bits + arb(0, error[i, j].upper()))
                     * arb(2) ** (scales[i] - scales[j]) for j in range(size)] for i in range(size)])


def _taylor(waves: list[Any], scale: Any, h: Any, bits: int) -> tuple[list[Any], Any]:
    """The Taylor coefficients of ``scale * entry(h u)`` in units of ``2**-bits``, and what they leave out on [0, 1]."""
    balls: list[Any] = [arb(0)]
    slack = arb(0)
    small = arb(2) ** -bits
    for q, c, s in waves:
        even, odd = c * scale, s * scale
        if q == 0:
            balls[0] += even
            continue
        size, turn = abs(even) + abs(odd), q * h
        power, k = arb(1), 0
        while k == 0 or not size * abs(power) < small:
            if k == len(balls):
                balls.append(arb(0))
            balls[k] += power * (odd if k % 2 else even)
            k += 1
            power = (power if k % 2 else -power) * turn / k
        slack += size * abs(power) * abs(turn).exp()  # the rest of both series, term by term below those of exp
    unit = arb(2) ** bits
    numbers = []
    for x in balls:
        scaled = x * unit
        nearest = _integer(scaled)
        slack += abs(scaled - nearest) / unit
        numbers.append(_number(nearest, bits))
    return numbers, slack.upper()


def _integer(x: Any) -> int:
    """An integer near the midpoint of a ball."""
    mantissa, exponent = x.mid().man_exp()
    return int(mantissa) << int(exponent) if exponent >= 0 else int(mantissa) >> -int(exponent)


def _number(x: int, bits: int) -> Any:
    """An integer in the arithmetic that is the faster one for its size."""
    return fmpz(x) if bits > 800 else x


def _solve(rows: list[list[tuple[int, list[Any]]]], bits: int) -> list[Rows]:
    """The Taylor polynomial, a list of integers for each entry of each column, until four orders add nothing."""
    size = len(rows)
    sparse = [[(j, *_without_zeros(coefficients)) for j, coefficients in row] for row in rows]
    one = _number(1 << bits, bits)
    columns: list[Rows] = [[[one if i == j else 0 * one] for i in range(size)] for j in range(size)]
    k, quiet = 0, 0
    while quiet < 4 and k < MOST_ORDERS:
        largest = 0
        for found in columns:
            new = [(_next(row, found, k) >> bits) // (k + 1) for row in sparse]
            largest = max(largest, *map(abs, new))
            for entry, value in zip(found, new, strict=True):
                entry.append(value)
        quiet = quiet + 1 if largest <= 1 else 0
        k += 1
    return columns


def _without_zeros(coefficients: list[Any]) -> tuple[int, int, list[Any]]:
    """``(first, step, coefficients[first::step])``: even and odd functions have every second coefficient only."""
    for first, other in ((0, 1), (1, 0)):
        if not any(coefficients[other::2]):
            return first, 2, coefficients[first::2]
    return 0, 1, coefficients


def _next(row: list[tuple[int, int, int, list[Any]]], found: Rows, k: int) -> Any:
    """Coefficient ``k`` of one entry of ``P F``, times ``4**bits``."""
    total = 0
    for j, first, step, coefficients in row:
        if len(coefficients) == 1 and first <= k:
            total += coefficients[0] * found[j][k - first]
        elif first <= k:
            total += sum(map(mul, coefficients, found[j][k - first::-step]))
    return total


def _defect(rows: list[list[tuple[int, list[int]]]], columns: list[Rows], slack: dict[tuple[int, int], Any],
            bits: int) -> Any:
    """``sup |h P F - F'|`` on [0, 1], entry by entry."""
    size, unit = len(rows), arb(2) ** -bits
    polynomials = [[fmpz_poly(entry) for entry in column] for column in columns]
    sizes = [[sum(map(abs, entry)) for entry in column] for column in columns]
    one = fmpz_poly([1 << bits])
    P = [[(j, fmpz_poly(coefficients)) for j, coefficients in row] for row in rows]
    result = []
    for i in range(size):
        result.append([
            arb(sum(map(abs, (sum((p * polynomials[j][k] for k, p in P[i]), -one * polynomials[j][i].derivative()))
                        .coeffs()))) * unit * unit
            + sum((slack[i, k] * sizes[j][k] * unit for k, _ in P[i]), arb(0))
            for j in range(size)])
    return arb_mat(result)
