r"""From one exact polynomial to a Taylor model on every rectangle of a chart.

On a rectangle with centre ``(c, c')`` and half sides ``(r, r')`` the polynomial ``f = sum F_ij u**i w**j`` is

    f(c + r s, c' + r' t) = sum L_kl s**k t**l,        L = S(c, r) F S(c', r')^T,
    S(c, r)_ki = binomial(i, k) c**(i-k) r**k,

two products of matrices.  They are computed in balls of many bits, since the terms of F cancel, and each of the few
L_kl kept is rounded to a float; what is rounded, and the balls' radii, go into the error.  The same with absolute
values everywhere,

    |L| <= S(|c|, r) |F| S(|c'|, r')^T    entry by entry,

has positive terms only, so float64 is enough, and its entries beyond the degree kept bound what is left out.

The true Floquet matrix differs from the iterate by at most the a-priori remainder ``sum over k > n of
(Pbar T)**k / k!`` (module ``remainder``), with Pbar the largest amplitudes on all rectangles together.
"""

from __future__ import annotations

import math
from typing import Any

from flint import arb, arb_mat

from fastpicard.charted import Charted, Exponents, Member
from fastpicard.collapsed import Collapsed
from fastpicard.errors import BadInputError
from fastpicard.evaluate import numpy, upper_float
from fastpicard.harmonics import Harmonics
from fastpicard.precision import working
from fastpicard.rectangles import Rectangles
from fastpicard.remainder import a_priori, largest_row_sum, least_order
from fastpicard.taylormodels import SLACK, UNIT, Models, exponents

Array = Any
Polynomials = list[dict[Exponents, Any]]
HIGHEST = 200  # order of an iterate: its terms in two parameters grow as the fourth power, and fill the memory
BITS = 160  # of the polynomials to begin with: what cancels in them, and float64


# -- ranges --------------------------------------------------------------------


def span(terms: dict[Exponents, Any], boxes: Rectangles) -> tuple[Array, Array]:
    """Bounds from below and above of a polynomial of few terms on rectangles: interval arithmetic."""
    np = numpy()
    low, high, size = (np.zeros(len(boxes)) for _ in range(3))
    for (i, j), c in terms.items():
        value = float(c.mid())
        ends = _product(_power(boxes.lower[0], boxes.upper[0], i), _power(boxes.lower[1], boxes.upper[1], j))
        ends = _product(ends, (np.full(len(boxes), value), np.full(len(boxes), value)))
        low, high = low + ends[0], high + ends[1]
        size = size + np.maximum(abs(ends[0]), abs(ends[1]))
    lost = size * 2.0**-40 + 2.0**-1000
    return low - lost, high + lost


def span_at(chart: Charted, terms: dict[Exponents, Any], grid: list[Array]) -> Array:
    """The value of a polynomial of few terms at points of the chart, to some ulp of its largest term."""
    np = numpy()
    u, w = (axis.inner(z) for axis, z in zip(chart.axes, grid, strict=True))
    return sum((float(c.mid()) * u**i * w**j for (i, j), c in terms.items()), np.zeros(len(u)))


def _power(lower: Array, upper: Array, k: int) -> tuple[Array, Array]:
    np = numpy()
    if k == 0:
        return np.ones_like(lower), np.ones_like(lower)
    low, high = lower**k, upper**k
    if k % 2:
        return low, high
    least = np.where((lower < 0) & (upper > 0), 0.0, np.minimum(low, high))
    return least, np.maximum(low, high)


def _product(x: tuple[Array, Array], y: tuple[Array, Array]) -> tuple[Array, Array]:
    np = numpy()
    ends = [x[i] * y[j] for i in (0, 1) for j in (0, 1)]
    return np.minimum.reduce(ends), np.maximum.reduce(ends)


def amplitudes(chart: Charted, member: Member, boxes: Rectangles) -> Array:
    """``sup |P_ij|`` on every rectangle: shape (size, size, m)."""
    np = numpy()
    bound = np.zeros((*chart.F.shape, len(boxes)))
    for (i, j), waves in chart.waves(member).items():
        for terms in waves.values():
            low, high = span(terms, boxes)
            bound[i, j] += np.maximum(abs(low), abs(high))
    return bound * SLACK


def convex(chart: Charted, member: Member, boxes: Rectangles) -> Array:
    """Where ``y'' = q(t) y`` has ``q > 0`` at all times: unstable.

    The solution with y(0) = 1, y'(0) = 0 has ``y'' > 0`` while y > 0, so y' grows and y stays above 1 for good.
    """
    np = numpy()
    waves = chart.waves(member)
    one = waves.get((0, 1), {})
    plain = len(one) == 1 and next(iter(one))[1] == ((), ()) and all(
        set(terms) == {(0, 0)} and bool(terms[0, 0] > 0) for terms in one.values())
    if chart.F.shape != (2, 2) or (0, 0) in waves or (1, 1) in waves or not plain or (1, 0) not in waves:
        return np.zeros(len(boxes), dtype=bool)
    low = np.zeros(len(boxes))
    for (_, angle), terms in waves[1, 0].items():
        least, most = span(terms, boxes)
        low += least if angle == ((), ()) else -np.maximum(abs(least), abs(most))
    return low > 0


def common_bound(bounds: list[Array]) -> Harmonics:
    """A constant system that majorises all members on all rectangles."""
    np = numpy()
    largest = np.max([b.max(axis=-1) for b in bounds], axis=0)
    size = largest.shape[0]
    return Harmonics(size, {(i, j): [(arb(0), arb(float(largest[i, j])), arb(0))]
                            for i in range(size) for j in range(size) if largest[i, j]})


def order_for(majorant: Harmonics, period: Any, tol: float, highest: int = HIGHEST) -> int:
    """The smallest order from 5 up whose a-priori remainder is at most ``tol`` in every entry.

    Raises BadInputError for rectangles that need one beyond the highest.
    """
    def suffices(n: int) -> bool:
        return all(upper_float(x.upper()) <= tol for x in a_priori(majorant, period, n).entries())

    if not suffices(highest):
        size = float(largest_row_sum(majorant.bound))
        raise BadInputError(f"a chart takes an iterate of order {highest} at most, but where sup |P| is {size:.3g}, as "
                            "in this rectangle, a higher one is needed.  Take one nearer to 0, or F.enclosure.")
    return least_order(suffices, 8)


# -- models --------------------------------------------------------------------


def shift(c: Any, r: Any, degree: int, n: int) -> Any:
    """``S(c, r)`` in balls: shape (degree + 1, n)."""
    powers = [c**i if i else arb(1) for i in range(n)]
    sides = [r**k if k else arb(1) for k in range(degree + 1)]
    return arb_mat([[powers[i - k] * math.comb(i, k) * sides[k] if i >= k else arb(0) for i in range(n)]
                    for k in range(degree + 1)])


def polynomials(chart: Charted, collapsed: Collapsed, boxes: Rectangles, tol: float) -> tuple[list[Polynomials], int]:
    """The constants as polynomials in ``(u, w)``, member by member, and how many bits keep them sharp.

    In the coefficients powers of pi cancel, in the polynomials their terms do; both grow with the order.  With so many
    bits what is lost by both is at most ``tol`` on all rectangles.
    """
    reach = [arb(float(numpy().maximum(abs(boxes.lower[k]), abs(boxes.upper[k])).max())) for k in (0, 1)]
    bits = BITS
    while True:
        with working(bits):
            found = [chart.polynomials(collapsed, member) for member in chart.members]
            if all(_lost(terms, reach, bits) <= tol for member in found for terms in member):
                return found, bits
        bits *= 2


def _lost(terms: dict[Exponents, Any], reach: list[Any], bits: int) -> Any:
    """What the radii of the coefficients, and the rounding of terms, make of a polynomial at most, roughly."""
    return sum(((c.rad() + abs(c) * arb(2) ** (10 - bits)) * reach[0] ** i * reach[1] ** j
                for (i, j), c in terms.items()), arb(0)).upper()


class LocalMap:
    """Several polynomials in ``(u, w)``, recentred on rectangles.

    Parameters
    ----------
    polynomials : list of {(i, j): ball}
    errors : list of floats      how far each may be from the function it stands for
    bits : int                   the working precision
    """

    def __init__(self, polynomials: Polynomials, errors: list[float], bits: int = BITS) -> None:
        np = numpy()
        self.bits = bits
        self.shape = tuple(1 + max((e[k] for terms in polynomials for e in terms), default=0) for k in (0, 1))
        self.errors = errors
        with working(bits):
            self.matrices = [arb_mat([[terms.get((i, j), arb(0)) for j in range(self.shape[1])]
                                      for i in range(self.shape[0])]) for terms in polynomials]
        self.sizes = np.zeros((len(polynomials), *self.shape))
        for e, terms in enumerate(polynomials):
            for (i, j), c in terms.items():
                self.sizes[e, i, j] = upper_float(abs(c).upper())
        self._shifts: dict[tuple[float, float, int, int], Any] = {}

    def models(self, boxes: Rectangles, degree: int) -> Models:
        """Taylor models: shape (size, polynomials, m)."""
        np = numpy()
        terms = exponents(degree)
        c = np.zeros((len(terms), len(self.matrices), len(boxes)))
        radii = np.zeros((len(self.matrices), len(boxes)))
        with working(self.bits):
            rows: dict[tuple[float, float], list[Any]] = {}
            for m in range(len(boxes)):
                (x, y), (r, q) = boxes.center[:, m].tolist(), boxes.half[:, m].tolist()
                if (x, r) not in rows:
                    rows[x, r] = [self._shift(x, r, degree, 0) * matrix for matrix in self.matrices]
                right = self._shift(y, q, degree, 1).transpose()
                for e, left in enumerate(rows[x, r]):
                    table = (left * right).tolist()
                    kept = [table[k][l] for k, l in terms]
                    c[:, e, m] = [float(z) for z in kept]
                    radii[e, m] = float(sum(map(abs, kept), arb(0)).rad()) * 2
        beyond = self.beyond(boxes, degree)
        e = beyond + radii + 2 * UNIT * abs(c).sum(axis=0) + np.array(self.errors)[:, None]
        return Models(degree, c, e * SLACK)

    def _shift(self, c: float, r: float, degree: int, axis: int) -> Any:
        key = c, r, degree, axis
        if key not in self._shifts:
            self._shifts[key] = shift(arb(c), arb(r), degree, self.shape[axis])
        return self._shifts[key]

    def beyond(self, boxes: Rectangles, degree: int) -> Array:
        """``sum over k + l > degree of |L_kl|``, from above: shape (polynomials, m)."""
        np = numpy()
        result = np.zeros((len(self.matrices), len(boxes)))
        for start in range(0, len(boxes), 256):
            part = slice(start, start + 256)
            left, right = (self._majorants(boxes.center[k, part], boxes.half[k, part], k) for k in (0, 1))
            total = np.add.outer(np.arange(self.shape[0]), np.arange(self.shape[1]))
            for e, sizes in enumerate(self.sizes):
                table = np.matmul(np.matmul(left, sizes), right.transpose(0, 2, 1))
                result[e, part] = np.where(total > degree, table, 0.0).sum(axis=(1, 2))
        return result * (1 + 2.0**-30)

    def _majorants(self, c: Array, r: Array, axis: int) -> Array:
        """``binomial(i, k) |c|**(i-k) r**k``: shape (m, n, n)."""
        np = numpy()
        n = self.shape[axis]
        table = np.zeros((len(c), n, n))
        table[:, 0, 0] = 1.0
        for i in range(1, n):
            table[:, :, i] = abs(c)[:, None] * table[:, :, i - 1]
            table[:, 1:, i] += r[:, None] * table[:, :-1, i - 1]
        return table
