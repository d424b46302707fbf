r"""How far the n-th iterate is from the truth: a rigorous bound on ``Phi - Phi_n``.

The true matrix is the sum of all increments, ``Phi = I_0 + I_1 + ...``, so

    Phi - Phi_n  =  I_{n+1} + ... + I_{n+m}  +  (Phi - Phi_{n+m}).

*A priori*, with ``Pbar = sup |P|`` entry by entry, induction on
``I_{k+1} = integral of P I_k`` gives ``|I_k(t)| <= (Pbar t)**k / k!``, hence

    |Phi - Phi_n|  <=  sum over k > n of (Pbar T)**k / k!.

*A posteriori*, the next ``m`` increments are computed at the parameters in question,
and the a-priori sum bounds only what follows them: cancellation inside an increment,
which the first bound cannot see, is then seen.  ``m`` grows until the rest is below a
hundredth of the sum, or where increments vanish below the last digit computed with, so the bound is the true error to a
few percent; ``m`` is not searched for where increments grow up to an order beyond n and ``MOST_INCREMENTS``.

Each increment is kept on pieces of the period as a polynomial in balls (a Taylor model
in time): for ``u`` in [0, 1] a term ``c u**j`` of degree ``j > d`` lies in ``[-|c|, |c|] u**d``,
so what a product has beyond degree ``d`` widens its last ball, and is divided by ``d`` at
the next integration.  A parameter that is an interval is a wide ball.  For wide boxes the
a-priori bound may be the smaller one: each entry is the smaller of both.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from flint import arb, arb_mat, arb_poly

from fastpicard.errors import BadInputError, printed
from fastpicard.evaluate import ball, upper_float
from fastpicard.harmonics import Harmonics
from fastpicard.matrix import number_matrix
from fastpicard.precision import working
from fastpicard.values import exact_number

BITS = 64  # for bounds, whose own digits matter little
MOST_INCREMENTS, LEVELS = 300, 6  # how far to go for a sharp bound
LARGEST_PEAK = 1000  # where increments grow up to an order beyond it, no iterate that is worth having comes to an end


def a_priori(P: Harmonics, period: Any, n: int) -> Any:
    """``sum over k > n of (Pbar T)**k / k!`` as an ``arb_mat``, entries rounded up."""
    with working(BITS):
        X, peak = P.bound * abs(period), _peak(P, period)
        if peak > 2 * n + MOST_INCREMENTS:  # the terms up to n are nothing beside the largest ones
            return _upper(X.exp())
        # From `last` on two orders more make a term at least four times smaller in norm, as |X X| < k k / 4:
        # all that follow are less than half of the last two.
        last = max(n + 1, math.ceil(2 * peak)) + BITS
        before = total = arb_mat(P.size, P.size)
        term = identity(P.size)
        for k in range(1, last + 1):
            before, term = term, term * X / k
            if k > n:
                total = total + term
        if _is_zero(term):
            return total
        tail = (largest_row_sum(before) + largest_row_sum(term)) / 2
        return arb_mat(P.size, P.size, [(x + tail).upper() for x in total.entries()])


def a_posteriori(P: Harmonics, period: Any, n: int, start: Any = None) -> Any:
    """The bound from increments computed at these parameters, as an ``arb_mat`` of upper bounds.

    Of the fundamental matrix, or of the solutions with the columns of ``start`` as initial values; the period is any
    length of time, of any sign.  If increments grow up to an order beyond ``MOST_INCREMENTS``, the a-priori sum is the
    bound.
    """
    start = identity(P.size) if start is None else start
    sizes = _upper(start)
    first = _upper(a_priori(P, period, n) * sizes)
    if _is_zero(first) or _peak(P, period) > max(n, MOST_INCREMENTS):
        return first
    wide = P.is_wide or any(x.rel_accuracy_bits() < 32 for x in (period, *start.entries()))
    for level in range(0, LEVELS, 2):
        rest, total, k = first, 0 * start, n
        least = largest_row_sum(first) * arb(2) ** -_bits(level)  # where increments vanish, as if P P = 0
        source = increments_at_end(P, period, n, level, start)
        for _ in range(n + 1):
            next(source)
        while 100 * largest_row_sum(rest) > max(largest_row_sum(_upper(total)), least):
            k += 1
            with working(_bits(level)):
                total = total + next(source)
            rest = a_priori(P, period, k) * sizes
        if _is_sharp(total) or wide:
            break
    return _least(_upper(total) + rest, first)


def _is_sharp(total: Any) -> bool:
    """Whether it is not the radii of the balls that make the sum what it is."""
    radii = arb_mat(total.nrows(), total.ncols(), [x.rad() for x in total.entries()])
    return bool(20 * largest_row_sum(radii) <= largest_row_sum(_upper(total)))


def _peak(P: Harmonics, period: Any) -> float:
    """About the order up to which the terms of the a-priori sum grow."""
    with working(BITS):
        X = P.bound * abs(period)
        return math.sqrt(float(largest_row_sum(X * X)))


def smallest_order(P: Harmonics, period: Any, tol: Any) -> int:
    """The smallest ``n`` from which on the bound meets ``tol``: largest row sum; raises as :func:`a_priori_order`."""
    last = a_priori_order(P, period, tol / 100)
    rest = a_priori(P, period, last)
    for level in range(0, LEVELS, 2):
        source = increments_at_end(P, period, last, level)
        increments = [next(source) for _ in range(last + 1)]
        total, n = arb_mat(P.size, P.size), last
        while n > 0:
            total = total + increments[n]
            if not largest_row_sum(_least(_upper(total) + rest, a_priori(P, period, n - 1))) <= tol:
                break
            n -= 1
        if n == 0 or _is_sharp(total) or P.is_wide:
            break
    return n


def a_priori_order(P: Harmonics, period: Any, tol: Any) -> int:
    """The smallest ``n`` from 1 up whose a-priori bound meets ``tol``: largest row sum.

    Raises BadInputError where increments grow up to an order beyond ``LARGEST_PEAK``.
    """
    peak = _peak(P, period)
    if not peak <= LARGEST_PEAK:
        raise BadInputError(f"increments grow up to the order Pbar T, which is about {peak:.3g} here, and an iterate "
                            f"is of no use before.  Use enclosure(values), which needs none, a shorter period, or "
                            f"smaller parameters.")
    return least_order(lambda n: bool(largest_row_sum(a_priori(P, period, n)) <= tol))


def tolerance(tol: Any) -> Any:
    """``tol`` as an exact number; BadInputError if it is not positive."""
    limit = exact_number(tol, "tol")
    if not ball(limit) > 0:
        raise BadInputError(f"tol must be positive, but it is {printed(tol)}.  Use 1e-12, say.")
    return limit


def reported(bound: Any, entrywise: bool) -> Any:
    """A matrix of upper bounds as the user gets it: the largest row sum as a float, or all of them as an array."""
    if entrywise:
        return number_matrix([upper_float(x) for x in bound.entries()], (bound.nrows(), bound.ncols()), None)
    return upper_float(largest_row_sum(bound))


def least_order(suffices: Callable[[int], bool], start: int = 1) -> int:
    """The smallest ``n`` above ``start/2`` that suffices, as all beyond it do: by doubling and bisection."""
    high = start
    while not suffices(high):
        high *= 2
    low = high // 2
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if suffices(middle) else (middle, high)
    return high


def _upper(matrix: Any) -> Any:
    return arb_mat(matrix.nrows(), matrix.ncols(), [abs(x).upper() for x in matrix.entries()])


def _least(left: Any, right: Any) -> Any:
    return arb_mat(left.nrows(), left.ncols(),
                   [min(x.upper(), y.upper()) for x, y in zip(left.entries(), right.entries(), strict=True)])


def identity(size: int) -> Any:
    """The unit matrix, exact."""
    return arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])


def _is_zero(matrix: Any) -> bool:
    return all(x == 0 for x in matrix.entries())


def largest_row_sum(matrix: Any) -> Any:
    """The largest sum of absolute values in a row, rounded up."""
    return max((sum(map(abs, row), arb(0)).upper() for row in matrix.tolist()), default=arb(0))


# -- increments as Taylor models in time -------------------------------------


def _bits(level: int) -> int:
    return 192 << level


def increments_at_end(P: Harmonics, period: Any, n: int, level: int = 0, start: Any = None) -> Iterator[Any]:
    """``I_0(T), I_1(T), ...`` as ``arb_mat``; orders around n keep many digits, more at a higher level."""
    end = identity(P.size) if start is None else start
    fastest = float((abs(period) * P.highest).upper()) / 2
    pieces = max(8, n // 6, math.ceil(fastest), math.ceil(_peak(P, period) / 4))
    degree, bits = 36 + 20 * level, _bits(level)
    with working(bits):
        step = period / pieces
        models = [{place: _model(waves, step, degree) for place, waves in P.shifted(step * m).waves.items()}
                  for m in range(pieces)]
        current = [[[arb_poly([x]) for x in row] for row in end.tolist()]] * pieces
    while True:
        yield end
        with working(bits):
            current, end = _next_increment(models, current, degree)


def _model(waves: list[Any], step: Any, degree: int) -> Any:
    """An entry of ``P`` times the step, on a piece."""
    coefficients = [arb(0)] * (degree + 1)
    for q, c, s in waves:
        if q == 0:
            coefficients[0] += c * step
            continue
        turn, power = q * step, step
        for k in range(degree + 1):
            coefficients[k] += power * (s if k % 2 else c)
            power = (-power if k % 2 else power) * turn / (k + 1)
        coefficients[degree] += arb(0, ((abs(c) + abs(s)) * abs(power) * abs(turn).exp()).upper())
    return arb_poly(coefficients)


def _next_increment(models: list[Any], current: list[Any], degree: int) -> tuple[list[Any], Any]:
    """From ``I_k`` on all pieces to ``I_{k+1}``, with its value at the end."""
    size, columns = len(current[0]), len(current[0][0])
    start = [[arb(0)] * columns for _ in range(size)]
    result = []
    for P, rows in zip(models, current, strict=True):
        new = [[arb_poly()] * columns for _ in range(size)]
        for i in range(size):
            for j in range(columns):
                product = sum((P[i, k] * rows[k][j] for k in range(size) if (i, k) in P and rows[k][j].length()),
                              arb_poly())
                new[i][j] = _folded(product, degree - 1).integral() + start[i][j]
                start[i][j] = new[i][j](arb(1))
        result.append(new)
    return result, arb_mat(start)


def _folded(polynomial: Any, degree: int) -> Any:
    """The same on [0, 1], with everything beyond the degree in the last coefficient's ball."""
    if polynomial.degree() <= degree:
        return polynomial
    coefficients = polynomial.coeffs()
    beyond = sum((abs(c).upper() for c in coefficients[degree + 1:]), arb(0)).upper()
    return arb_poly([*coefficients[:degree], coefficients[degree] + arb(0, beyond)])
