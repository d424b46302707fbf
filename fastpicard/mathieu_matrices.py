r"""Mathieu's four matrices, and how many of their eigenvalues lie below a number, proved.

**Four matrices.**  Put ``y = sum A_m cos mz`` or ``y = sum B_m sin mz``.  Parity of y and of m separates
four families (DLMF 28.4.5-28.4.8), each an infinite symmetric tridiagonal matrix ``T`` with simple
eigenvalues:

    a_0, a_2, ...   diagonal 0, 4, 16, ...       off-diagonal sqrt(2) q, q, q, ...
    a_1, a_3, ...   diagonal 1 + q, 9, 25, ...   off-diagonal q, q, q, ...
    b_1, b_3, ...   diagonal 1 - q, 9, 25, ...   off-diagonal q, q, q, ...
    b_2, b_4, ...   diagonal 4, 16, 36, ...      off-diagonal q, q, q, ...

So ``a_r`` and ``b_r`` (close for small q), or ``a_r`` and ``b_(r+1)`` (close for large q), are never in one
matrix, and the index r is the place in an ordered list of simple numbers.

**The index.**  Eliminate ``T - x`` from both ends towards row m.  With diagonal ``d_k`` and squared couplings ``e_k``,

    down:  u_0 = d_0 - x,   u_k = d_k - x - e_k / u_(k-1)
    up:                     v_k = d_k - x - e_(k+1) / v_(k+1)
    g = d_m - x - e_m / u_(m-1) - e_(m+1) / v_(m+1)

By Sylvester's law of inertia the number of negative ones among ``u_0 .. u_(m-1), g, v_(m+1), ...`` is the
number of eigenvalues below x.  If it is n at ``lo`` and n + 1 at ``hi``, eigenvalue number n (from 0) lies
between them.

**The infinite tail.**  Suppose ``d_k - x >= 2|q|`` from row N on.  Starting from ``v_M = d_M - x`` for any
M > N, induction downwards keeps ``v_k >= d_k - x - |q| >= |q|``; and ``v_k <= d_k - x``.  The bounds do not
depend on M, hence hold in the limit: the tail has no negative pivot and ``v_N`` lies in ``[d_N - x - |q|,
d_N - x]``.  Started from that interval, balls carry the truncation to ``g``, and a sign that a ball decides
is the sign of the infinite problem.

**The digits.**  ``g`` falls with slope ``-(1 + sum of (z_k / z_m)**2)``, z the eigenvector, so Newton's step is
Rayleigh's quotient and doubles the digits.  It need not be rigorous: the counts are.
"""

from dataclasses import dataclass
from typing import Any

from flint import arb

from fastpicard.precision import working

FLOAT_BITS = 48  # that a guess in float64 has, of the largest entry
SLOPE_BITS = 36  # and its slope
WIDE = 30  # bits of a pivot that an interval has reached


@dataclass(frozen=True)
class Matrix:
    """One of the four matrices, and which of its eigenvalues is meant."""

    name: str
    r: int
    lowest: int  # the frequency of row 0
    corner: int  # what multiple of q is added to the diagonal of row 0

    @property
    def index(self) -> int:
        return (self.r - self.lowest) // 2

    def diagonal(self, q: Any, rows: int) -> list[Any]:
        """``d_0 .. d_(rows-1)`` in the arithmetic of q."""
        number = type(q)
        entries = [number((self.lowest + 2 * k) ** 2) for k in range(rows)]
        return [entries[0] + self.corner * q, *entries[1:]]

    def couplings(self, q: Any, rows: int) -> list[Any]:
        """``e_k`` joins rows k - 1 and k; ``e_0 = 0``."""
        first = 2 if self.lowest == 0 else 1
        return [q * 0, first * q * q, *[q * q] * (rows - 2)]


@dataclass(frozen=True)
class Section:
    """Rows 0 .. N - 1 of ``T``, the diagonal of row N, and the row m at which the eliminations meet."""

    diagonal: list[Any]
    couplings: list[Any]
    peak: int
    size: Any  # |q|

    def count_below(self, x: Any) -> int | None:
        """How many eigenvalues of the infinite matrix lie below x, any point of a ball; None if a sign is hidden."""
        if not self.diagonal[-1] - x > 2 * self.size:
            return None
        down, up, g = self._pivots(x)
        negatives = 0
        for pivot in (*down, *up, g):
            if pivot < 0:
                negatives += 1
            elif not pivot > 0:
                return None
        return negatives

    def refine(self, x: float, slope: float | None, bits: int, guard: int) -> Any:
        """Newton's method on ``g``, twice as many bits a step; by the float64 slope, if any, where two will do."""
        guess, known = arb(x), FLOAT_BITS
        if bits > FLOAT_BITS + 2 * SLOPE_BITS:
            slope = None
        while known < bits:
            known = min(known + SLOPE_BITS if slope else 2 * known - 4, bits)
            with working(known + guard):
                down, up, g = self._pivots(guess)
                guess = (guess + g / (slope or self._slope(down, up))).mid()
        return guess

    def _pivots(self, x: Any) -> tuple[list[Any], list[Any], Any]:
        """The pivots of ``T - x`` from above and from below down to the row beside m, and ``g``."""
        m, d, e = self.peak, self.diagonal, self.couplings
        down = _eliminate(d[:m], e[:m], x, arb(1))
        up = _eliminate(d[-2:m:-1], e[:m + 1:-1], x, d[-1] - x - self.size * arb(0.5, 0.5))
        return down, up, d[m] - x - e[m] / down[-1] - e[m + 1] / up[-1]

    def _slope(self, down: list[Any], up: list[Any]) -> Any:
        """``-dg/dx``."""
        m, e = self.peak, self.couplings
        above, below = norm(down[1:], e[1:]), norm(up, e[:m:-1])
        return above + below - 1


def _eliminate(diagonal: list[Any], couplings: list[Any], x: Any, pivot: Any) -> list[Any]:
    """The pivots from the given one on."""
    pivots, is_wide = [pivot], True
    for d, e in zip(diagonal, couplings):
        is_wide = is_wide and pivot.rel_accuracy_bits() < WIDE
        pivot = d - x - (_over_wide(e, pivot) if is_wide else e / pivot)
        pivots.append(pivot)
    return pivots


def _over_wide(e: Any, pivot: Any) -> Any:
    """``e / pivot`` about its value in the middle: Arb rounds a wide quotient out by more than a tail narrows it."""
    middle, radius = pivot.mid(), pivot.rad()
    if not radius < abs(middle):
        return e / pivot
    value = e / middle
    return value + arb(0, (abs(value) * radius / (abs(middle) - radius)).upper())


def norm(pivots: list[Any], couplings: list[Any]) -> Any:
    """``1 + sum of (z_k / z_m)**2`` over the rows of the pivots, from the farthest to the one beside row m."""
    total = 1
    for pivot, e in zip(pivots, couplings):
        total = 1 + total * (e / pivot / pivot)
    return total
