r"""Enclosures of the true transition matrix: what the equation does, not what an iterate does.

A polynomial ``F`` in ``u = (t - start)/h`` with ``F(0) = 1`` need not be trusted, it is proved
by its defect.  With ``R = h P F - F'`` the error ``E = Phi - F`` obeys ``E' = h P E + R``,
``E(0) = 0``, and Picard's own argument bounds it entry by entry,

    |E(u)|  <=  exp(h Pbar) * sup over [0, 1] of |R|,      Pbar = sup |P|.

``F`` is the Taylor polynomial, computed in integers (units of ``2**-bits``) from
``k F_k = sum_m P_m F_{k-1-m}``.  The defect is what rounding down leaves of these
equations, less than ``k`` units each, what they leave out beyond the last ``F_k``, and
what the Taylor polynomial of ``P`` leaves out.  So no rounding has to be followed, and
every number type of the parameters is one case: a ball's radius only widens ``P``.

Over a period the symmetries of ``P`` are used: a shorter period ``T/k`` (then
``Phi(T) = Phi(T/k)**k``), and reversal, ``s P(-t) s = -P(t)`` with signs ``s``
(then ``Phi(T) = s Phi(T/2)**-1 s Phi(T/2)``: half the way).
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from itertools import accumulate, chain, cycle, repeat, zip_longest
from operator import mul
from typing import Any

from flint import arb, arb_mat, ctx, fmpz
from mpmath.libmp import dps_to_prec

from fastpicard.errors import BadInputError
from fastpicard.harmonics import Harmonics
from fastpicard.precision import working

MOST_PIECES, MOST_ORDERS = 1 << 20, 1 << 14
MOST_POWERS = 1 << 60  # of one step, where P is constant
MOST_TURNS = 2**63 - 1  # of a period


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
    def compute() -> Any:
        P, period = build()
        part = period / turns
        signs = P.reversal
        if signs is None:
            return transition(P, arb(0), part) ** turns
        half = transition(P, arb(0), part / 2)
        try:
            return mirrored(half, signs) ** turns
        except ZeroDivisionError:  # too wide to be known as invertible
            return transition(P, arb(0), part) ** turns

    return to_digits(compute, digits, is_box, strict)


def mirrored(half: Any, signs: Any) -> Any:
    """``s X**-1 s X``, the whole way from the half."""
    mirror = diagonal(signs)
    return mirror * half.inv() * mirror * half


def over_time(P: Harmonics, length: Any, period: Any | None) -> Any:
    """``Phi(length, 0)`` at the working precision, for a length of any sign: whole periods are one power.

    ``Phi(t) = Phi(t - m T) Phi(T)**m`` holds for every integer ``m``, so that the one next to ``t/T`` need not be
    proved to be that.  What a length is known to lies within is the last step, so that others are not widened by it.
    """
    if length.rel_accuracy_bits() < ctx.prec - 16 and length.mid() != 0:
        middle = arb(length.mid())
        return transition(P, middle, length) * over_time(P, middle, period)
    if period is None:
        return transition(P, arb(0), length)
    turn = period if length.mid() >= 0 else -period
    turns = int((length.mid() / turn.mid()).mid().floor().unique_fmpz())
    if turns > MOST_TURNS:
        raise BadInputError(f"a time can be {MOST_TURNS} periods at most, but it is {length.str(5)}.  Take a "
                            "smaller one.")
    rest = transition(P, arb(0), length - turn * turns)
    return rest * transition(P, arb(0), turn) ** turns if turns else rest


def to_digits(compute: Callable[[], Any], digits: int, is_box: bool = False, strict: bool = True) -> Any:
    """A matrix of balls, computed with more and more bits until it has the digits asked for."""
    wanted = dps_to_prec(digits)
    bits, before = wanted + 32, None
    while True:
        with working(bits):
            try:
                found = compute()
            except OverflowError:
                raise BadInputError("the coefficients of P must be floats in size, but they are beyond them.  Measure "
                                    "the time in other units.") from None
            missing = shortfall(found, wanted)
        if missing <= 0:
            return found
        if is_box and before is not None and not missing < before - 8:
            if not strict:
                return found
            raise BadInputError(f"the digits asked for cannot be had: {digits} were asked for, and {bits} bits leave "
                                f"{_digits(wanted - missing)}: something given is a ball with a radius.  Give numbers, "
                                "narrower balls, or fewer digits.")
        if bits > 64 * wanted + 100_000:
            raise BadInputError(f"the matrix is not enclosed with {bits} bits.  Its entries are beyond reach: "
                                "take a smaller period or smaller coefficients.")
        before = missing
        bits += int(missing) + 16 if math.isfinite(missing) else bits


def _digits(bits: float) -> int:
    """The largest number of digits for which so many bits are enough (mpmath's rule), from 0 up."""
    return max(math.floor((math.floor(max(bits, 0)) + 0.5) / math.log2(10)) - 1, 0)


def shortfall(matrix: Any, wanted: int) -> float:
    """How many bits are missing until every radius is below ``2**-wanted`` of its entry or ``4**-wanted`` of all.

    Infinity where nothing is known: no entry is told from 0.
    """
    entries = matrix.entries()
    if not all(x.is_finite() for x in entries):
        return math.inf
    largest = max(_exponent(x.abs_lower()) for x in entries)
    worst = -math.inf
    for x in entries:
        if x.rad() == 0:
            continue
        scale = max(_exponent(x.abs_lower()), largest - wanted)
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
    # Found by trial: more digits, longer strides; but Taylor coefficients of waves fall slowly in long ones, and what
    # is no rounding in P grows in each by the bound of the growth.
    strides = speed / 0.25 if P.accuracy < ctx.prec - 16 else max(speed / (9 + ctx.prec / 50), turn / 3.2)
    most = MOST_POWERS if P.is_constant else MOST_PIECES
    if not strides <= most:
        largest = max(P.bound.entries())
        raise BadInputError(f"the way from {start.str(5)} to {end.str(5)} can take {most} steps at most, but "
                            f"the coefficients reach {largest.str(3, radius=False)}.  Take smaller ones or a smaller "
                            "period.")
    pieces = max(1, math.ceil(strides))
    step, bits = length / pieces, ctx.prec + pieces.bit_length() + 4

    def between(low: int, high: int) -> Any:
        """The steps from low to high, as a tree: each product that a rotation passes through may cost half a bit."""
        if high - low == 1:
            return _step(P.shifted(start + step * low), step, scales, bits)
        middle = (low + high) // 2
        return between(middle, high) * between(low, middle)

    return between(0, 1) ** pieces if P.is_constant else between(0, pieces)


def _upper(x: Any) -> float:
    return float(x.upper())


def _speed(P: Harmonics, scales: list[int]) -> float:
    """The norm of the balanced ``P``."""
    bound = P.bound
    return max(sum(_upper(bound[i, j] * arb(2) ** (scales[j] - scales[i])) for j in range(P.size))
               for i in range(P.size))


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
#
# Entries of P and F are split into their even and odd powers of u: where P is even or odd, half of them vanish.

Parts = tuple[Sequence[Any], Sequence[Any]]  # coefficients of even and of odd powers, integers
Taylor = dict[tuple[int, int], tuple[Parts, Any]]  # the entries of h P, with a bound of what they leave out, in units


def _step(P: Harmonics, h: Any, scales: list[int], bits: int) -> Any:
    """``Phi(h, 0)`` by one Taylor polynomial and its defect."""
    size, unit = P.size, arb(2) ** -bits
    taylor = {(i, j): _taylor(waves, h * arb(2) ** (scales[j] - scales[i]), h, bits)
              for (i, j), waves in P.waves.items()}
    columns = [_column(taylor, size, j, bits) for j in range(size)]
    defect = arb_mat([[_defect(taylor, column, i, unit) for column in columns] for i in range(size)])
    growth = arb_mat([[P.bound[i, j] * abs(h) * arb(2) ** (scales[j] - scales[i]) for j in range(size)]
                      for i in range(size)]).exp()
    error = growth * defect
    return arb_mat([[arb(sum(map(sum, columns[j][i])), error[i, j].upper()) * unit
                     * arb(2) ** (scales[i] - scales[j]) for j in range(size)] for i in range(size)])


def _taylor(waves: list[Any], scale: Any, h: Any, bits: int) -> tuple[Parts, Any]:
    """The Taylor coefficients of ``scale * entry(h u)``, and what they leave out on [0, 1]."""
    parts: tuple[list[Any], list[Any]] = [], []
    slack = arb(0)
    for q, *amplitudes in waves:
        powers, lost, growth = _powers(q * h, bits)
        for parity, (part, amplitude) in enumerate(zip(parts, amplitudes, strict=True)):
            if not (scaled := amplitude * scale).is_zero():
                c, error = _in_units(scaled, bits)
                terms = [x * p >> bits for x, p in zip(cycle((c, -c)), powers[parity::2], strict=False)]
                part[:] = [x + y for x, y in zip_longest(part, terms, fillvalue=0)]
                slack += abs(arb(c)) * lost + error * growth + len(terms)
    return parts, slack.upper()


def _powers(x: Any, bits: int) -> tuple[list[Any], Any, Any]:
    """``x**k / k!`` until nothing is left, a bound of all errors together (a number, not in units), and ``exp |x|``."""
    unit = arb(2) ** -bits
    y, error = _in_units(x, bits)
    powers = [_number(1 << bits, bits)]
    while abs(powers[-1]) > 1:
        powers.append((powers[-1] * y >> bits) // len(powers))
    n, size = len(powers), (abs(x) + error * unit).upper()
    # One rounding, less than a unit, changes the later powers by no more than exp.
    return powers, ((n + error) * unit + size ** n / arb.fac_ui(n)) * size.exp(), size.exp()


def _in_units(x: Any, bits: int) -> tuple[Any, Any]:
    """An integer near a ball, and how far from it the ball reaches."""
    scaled = x * arb(2) ** bits
    mantissa, exponent = scaled.mid().man_exp()
    nearest = int(mantissa) << int(exponent) if exponent >= 0 else int(mantissa) >> -int(exponent)
    return _number(nearest, bits), abs(scaled - nearest).upper()


def _number(x: int, bits: int) -> Any:
    """An integer in the arithmetic that is the faster one for its size."""
    return fmpz(x) if bits > 800 else x


def _column(taylor: Taylor, size: int, start: int, bits: int) -> list[Parts]:
    """The Taylor polynomials of one column, entry by entry, the highest power first.

    So ``sum_m P_m F_{k-m}`` multiplies two sequences from their beginnings on.  Parts that vanish are empty.
    """
    links = [(i, j, r, part) for (i, j), (parts, _) in taylor.items() for r, part in enumerate(parts) if part]
    alive = {(start, 0)}
    while more := {(i, (p + r + 1) % 2) for i, j, r, _ in links for p in (0, 1) if (j, p) in alive} - alive:
        alive |= more
    one = _number(1 << bits, bits)
    column: list[tuple[deque[Any], deque[Any]]] = [
        (deque([one * (i == start)] if (i, 0) in alive else []), deque()) for i in range(size)]
    sums = [[(column[i][p], [(part, column[j][(p + r + 1) % 2]) for k, j, r, part in links if k == i])
             for i, q in alive if q == p] for p in (0, 1)]
    k, quiet, least = 0, 0, 2 * max((len(part) for *_, part in links), default=0)
    while (quiet < 4 or k < least) and k < MOST_ORDERS:  # four orders that add nothing, and not those before P begins
        k += 1
        new = [(sum([sum(map(mul, part, found)) for part, found in terms]) >> bits) // k for _, terms in sums[k % 2]]
        for (found, _), x in zip(sums[k % 2], new, strict=True):
            found.appendleft(x)
        quiet = quiet + 1 if all(-2 < x < 2 for x in new) else 0
    return list(column)


def _defect(taylor: Taylor, column: list[Parts], i: int, unit: Any) -> Any:
    """``sup |h P F - F'|`` on [0, 1] for one entry, in units.

    Beyond the last order are the products of the m-th coefficient of a part of ``P`` with the last ``m`` of ``F``.
    """
    orders = sum(map(len, column[i]))
    total = arb(orders * (orders + 1))
    for (k, j), (parts, slack) in taylor.items():
        if k == i:
            for found in column[j]:
                sizes = list(map(abs, found))
                beyond = [sum(map(mul, map(abs, part), accumulate(chain(sizes, repeat(0))))) for part in parts]
                total += (slack * sum(sizes) + sum(beyond)) * unit
    return total
