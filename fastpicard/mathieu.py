r"""Characteristic numbers of Mathieu's equation ``y'' + (a - 2 q cos 2z) y = 0``, every digit proved.

``a_r(q)`` and ``b_r(q)`` are the values of ``a`` at which the equation has an even, respectively an odd,
solution of period pi (r even) or antiperiod pi (r odd); ``a_r(0) = b_r(0) = r**2``.  They bound the stable
regions.  Nothing here uses Picard iteration, so this file and the Floquet matrix check each other.

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

**The digits.**  ``g`` falls with slope ``-(1 + sum of (z_k / z_m)**2)`` (z the eigenvector), so Newton's
step is Rayleigh's quotient and doubles the digits.  Bisection in float64, Newton and the size N are
guesses; the two counts alone are the proof.

**The parameter.**  ``2 cos 2z`` has norm 2, so ``|a_r(p) - a_r(q)| <= 2 |p - q|`` (Weyl), and the same for
b: a q that is not a binary number is replaced by one that is, and the enclosure widened by that much.
"""

import math
import operator
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import MAX_EMAX, MIN_EMIN, ROUND_HALF_EVEN, Context, Decimal
from typing import Any

import mpmath
from flint import arb, ctx
from mpmath.libmp import dps_to_prec, from_rational

from fastpicard.errors import BadInputError, BadTypeError
from fastpicard.evaluate import ball, exact_number

MAX_ROWS = 1_000_000
_TINY = 1e-300


def mathieu_a(r: int, q: Any, digits: int = 15) -> Any:
    r"""The characteristic number ``a_r(q)`` of ``y'' + (a - 2 q cos 2z) y = 0``, to ``digits`` significant digits.

    ``a_r(q)`` belongs to the even solution ``ce_r(z, q)`` (DLMF 28.2(v)); in the article's form
    ``y'' + (a + b cos t) y = 0`` it is the boundary ``a = a_r(-2b)/4``.

    Parameters
    ----------
    r : int >= 0
    q : int, Fraction, float, mpf, SymPy number, python-flint fmpz, fmpq or arb; real, of either sign.
        float and mpf are taken as the exact binary numbers they are.
    digits : int >= 1

    Returns an mpmath ``mpf``: the decimal number of ``digits`` significant digits nearest to ``a_r(q)``,
    ties excluded by proof, stored with a few bits more than it takes to print it back (``mpmath.nstr(x,
    digits)``).  Both the digits and the index r are proved.  At ``q = 0`` it is ``r**2`` itself, exact.
    For the nearest float64 take ``float`` of 20 digits. mpmath's global precision is neither read nor
    changed.

    Raises BadTypeError (q is text, complex or symbolic; r or digits is not an integer) and BadInputError (r
    negative, q infinite or nan, digits < 1, a ball q too wide for ``digits``, a matrix of more than a
    million rows).

    Speed and accuracy: see `mathieu_a_enclosure`, which does the work and gives the ball itself.

    >>> mpmath.nstr(mathieu_a(0, 25, digits=30), 30)
    '-40.2567795465667872758017193249'
    """
    return _rounded("a", r, q, digits)


def mathieu_b(r: int, q: Any, digits: int = 15) -> Any:
    r"""The characteristic number ``b_r(q)`` of ``y'' + (a - 2 q cos 2z) y = 0``, to ``digits`` significant digits.

    ``b_r(q)``, ``r >= 1``, belongs to the odd solution ``se_r(z, q)`` (DLMF 28.2(v)); in the article's form
    it is the boundary ``a = b_r(-2b)/4``.  Arguments, result, guarantee and errors are those of
    `mathieu_a`.

    >>> mpmath.nstr(mathieu_b(1, 25, digits=30), 30)
    '-40.2567789846841592832950489197'
    """
    return _rounded("b", r, q, digits)


def mathieu_a_enclosure(r: int, q: Any, digits: int = 15) -> Any:
    r"""A python-flint ball that contains ``a_r(q)``, of radius at most ``10**-digits |a_r(q)|``.

    If q is itself a ball of radius s, the result contains ``a_r`` of every point of it and is wider by ``2
    s``.  Arguments and errors are those of `mathieu_a`.

    Speed and accuracy: one call, measured on one core of a small server, for 15, 30, 100 and 1000 digits:
    at (r, q) = (0, 5) 0.6, 0.6, 1.2 and 8 ms; (3, 1000) 1, 1.4, 2 and 15 ms; (0, 1e6) 4, 5, 9 and 50 ms;
    (300, 1) 3, 4, 5 and 16 ms; (300, 1e6) 12, 13, 18 and 70 ms.  Time grows as the number of rows, about
    ``max(r/2, 10 |q|**(1/4))`` plus a third of the digits.

    >>> mathieu_a_enclosure(0, 25, digits=12).contains(mathieu_a_enclosure(0, 25, digits=40))
    True
    """
    return _enclosure(_matrix("a", r), exact_number(q, "q"), _positive(digits))


def mathieu_b_enclosure(r: int, q: Any, digits: int = 15) -> Any:
    r"""A python-flint ball that contains ``b_r(q)``; see `mathieu_a_enclosure`.

    >>> mathieu_b_enclosure(2, 0)
    4.00000000000000
    """
    return _enclosure(_matrix("b", r), exact_number(q, "q"), _positive(digits))


# --- what was asked ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Matrix:
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
        one = q * 0 + 1
        entries = [one * (self.lowest + 2 * k) ** 2 for k in range(rows)]
        return [entries[0] + self.corner * q, *entries[1:]]

    def couplings(self, q: Any, rows: int) -> list[Any]:
        """``e_k`` joins rows k - 1 and k; ``e_0 = 0``."""
        first = 2 if self.lowest == 0 else 1
        return [q * 0, first * q * q, *[q * q] * (rows - 2)]


def _matrix(name: str, r: Any) -> _Matrix:
    r = _integer(r, f"r in {name}_r(q)")
    least = 0 if name == "a" else 1
    if r < least:
        raise BadInputError(f"{name}_r(q) needs an integer r >= {least}, got r = {r}: r counts the zeros of an "
                            f"{'even' if name == 'a' else 'odd'} solution.  Take r = {least} for the lowest.")
    if r % 2:
        return _Matrix(name, r, 1, 1 if name == "a" else -1)
    return _Matrix(name, r, 0 if name == "a" else 2, 0)


def _integer(value: Any, what: str) -> int:
    if isinstance(value, (bool, str)) or not hasattr(value, "__index__"):
        raise BadTypeError(f"{what} must be an integer, got {value!r} of type {type(value).__name__}.  Pass an int.")
    return int(operator.index(value))


def _positive(digits: Any) -> int:
    count = _integer(digits, "digits")
    if count < 1:
        raise BadInputError(f"digits counts significant decimal digits, at least 1; got {digits}.  Try digits=15.")
    return count


def _is_wide(q: Any) -> bool:
    return isinstance(q, arb) and not q.is_exact()


# --- the answer -------------------------------------------------------------------------------------------------------


def _rounded(name: str, r: Any, q: Any, digits: Any) -> Any:
    """Narrow the ball until both its ends round to one decimal number (Ziv's strategy)."""
    matrix, q, digits = _matrix(name, r), exact_number(q, "q"), _positive(digits)
    if q == 0:
        return mpmath.mp.make_mpf(mpmath.libmp.from_int(matrix.r**2))
    for extra in (4, 40, 400, 4000):
        found = _enclosure(matrix, q, digits + extra)
        nearest, other = (_decimal(end, digits) for end in _ends(found))
        if nearest == other:
            return mpmath.mp.make_mpf(from_rational(*nearest.as_integer_ratio(), dps_to_prec(digits) + 10, "n"))
    known = f"{name}_{matrix.r} lies in {found.str(20)}, which does not fix {digits} digits"
    if _is_wide(q):
        raise BadInputError(f"q is the ball {q!r}; {known}.  Ask for fewer digits, give a narrower q, or take the "
                            f"ball from mathieu_{name}_enclosure.")
    raise BadInputError(f"{known}, for q = {q!r}: it cannot be told from a tie.  Change digits by one.")


def _ends(ball: Any) -> tuple[Any, Any]:
    with ctx.workprec(ball.bits() + 64):
        return ball.lower(), ball.upper()


def _decimal(x: Any, digits: int) -> Decimal:
    """The decimal number of ``digits`` significant digits nearest to the exact binary number x."""
    context = Context(prec=digits, rounding=ROUND_HALF_EVEN, Emax=MAX_EMAX, Emin=MIN_EMIN)
    mantissa, exponent = (int(part) for part in x.man_exp())
    top, bottom = mantissa << max(exponent, 0), 1 << max(-exponent, 0)
    return context.divide(Decimal(top), Decimal(bottom))


def _enclosure(matrix: _Matrix, parameter: Any, digits: int) -> Any:
    """Raise the absolute accuracy until the relative one suffices, or until q's own radius is what limits it."""
    wanted = math.ceil(digits * math.log2(10)) + 2
    bits = wanted + 8
    while bits < 8 * wanted + 100_000:
        with ctx.workprec(bits + 64):
            q = ball(parameter)
            if q.is_zero():
                return arb(matrix.r**2)
            middle = q.mid()
            spread = 2 * abs(q - middle).upper()
            found = _certified(matrix, middle, bits) + arb(0, spread)
            accurate = found.rel_accuracy_bits()
            if accurate >= wanted or (_is_wide(parameter) and spread > arb((8, -bits))):
                return found
        bits += wanted - accurate + 8 if accurate > 0 else bits
    raise BadInputError(f"{matrix.name}_{matrix.r}({parameter!r}) cannot be told from 0 with {bits // 2} bits, so no "
                        "significant digit is known.  If q is an expression equal to 0, pass 0.")


def _certified(matrix: _Matrix, q: Any, bits: int) -> Any:
    """The ball of radius ``2**-bits`` around a guess, after two counts have proved that it holds the eigenvalue."""
    start = _float_start(matrix, q)
    for guard in (32, 128, 512, 2048):
        section, scale = start.section(q, bits + guard)
        with ctx.workprec(bits + scale + guard):
            guess = section.refine(start.eigenvalue, bits + scale, guard)
            low, high = guess - arb((1, -bits)), guess + arb((1, -bits))
            if section.count_below(low) == matrix.index and section.count_below(high) == matrix.index + 1:
                return low.union(high)
    raise BadInputError(f"{matrix.name}_{matrix.r}({q.str(20)}) was not isolated to 2**-{bits}.  Ask for fewer digits.")


# --- the guess, in float64 --------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Start:
    """A float64 guess of the eigenvalue, and the row where its eigenvector is largest."""

    matrix: _Matrix
    size: float  # |q|
    eigenvalue: float
    peak: int

    def section(self, q: Any, bits: int) -> tuple["_Section", int]:
        """The rows that matter for ``bits`` binary digits after the point, and the binary digits before it."""
        rows = max(_rows(self.matrix, self.size, self.eigenvalue, bits), self.peak + 2)
        largest = (self.matrix.lowest + 2.0 * rows) ** 2 + 4 * self.size
        with ctx.workprec(2 * bits + 64):
            section = _Section(self.matrix.diagonal(q, rows + 1), self.matrix.couplings(q, rows + 1), self.peak, abs(q))
        return section, math.frexp(largest)[1]


def _float_start(matrix: _Matrix, ball: Any) -> _Start:
    """Bisect ``|a - r**2| <= 2|q|`` (Weyl) by counting negative pivots; the peak has the least residual."""
    q = math.copysign(max(abs(float(ball)), 1e-150), float(ball))
    size = abs(q)
    if matrix.r > 2 * MAX_ROWS or size > 1e100:
        raise _too_large(matrix, size)
    shallow = matrix.r < math.sqrt(size)
    top = -2 * size + 2 * (2 * matrix.r + 1) * math.sqrt(size) if shallow else matrix.r**2 + 2 * size
    rows = _rows(matrix, size, top, 64)
    diagonal, couplings = matrix.diagonal(q, rows), matrix.couplings(q, rows)
    low, high = matrix.r**2 - 2 * size, matrix.r**2 + 2 * size
    while high - low > 1e-15 * max(matrix.r**2, size):
        middle = (low + high) / 2
        if _negatives(diagonal, couplings, middle) > matrix.index:
            high = middle
        else:
            low = middle
    down = _pivots(diagonal, couplings, low)
    up = _pivots(diagonal[::-1], [0.0, *couplings[:0:-1]], low)[::-1]
    residual = [abs(u + v - (d - low)) for u, v, d in zip(down, up, diagonal)]
    return _Start(matrix, size, low, residual.index(min(residual)))


def _negatives(diagonal: list[float], couplings: list[float], x: float) -> int:
    negatives, pivot = 0, 1.0
    for d, e in zip(diagonal, couplings):
        pivot = (d - x - e / pivot) or _TINY
        if pivot < 0:
            negatives += 1
    return negatives


def _pivots(diagonal: list[float], couplings: list[float], x: float) -> list[float]:
    pivots, pivot = [], 1.0
    for d, e in zip(diagonal, couplings):
        pivot = (d - x - e / pivot) or _TINY
        pivots.append(pivot)
    return pivots


def _rows(matrix: _Matrix, size: float, x: float, bits: int) -> int:
    """Rows until the tail's interval, narrowed by ``(q / v_k)**2`` in every row, is below ``2**-bits``."""
    turn = math.sqrt(max(x + 2 * size, 0))
    rows = max((int(turn) - matrix.lowest) // 2 + 1, matrix.index + 1)
    gain = -math.log2(size + 1)
    while gain < bits and rows < MAX_ROWS:
        rows += 1
        gain += 2 * math.acosh(max(((matrix.lowest + 2 * rows) ** 2 - x) / (2 * size), 1)) / math.log(2)
    if rows >= MAX_ROWS:
        raise _too_large(matrix, size)
    return rows + 1


def _too_large(matrix: _Matrix, size: float) -> BadInputError:
    return BadInputError(f"{matrix.name}_r(q) at r = {matrix.r}, |q| = {size:.6g} needs a matrix of more than "
                         f"{MAX_ROWS} rows.  Use the asymptotic series: DLMF 28.8.1 (large q), 28.6.14 (large r).")


# --- the proof, in balls ----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Section:
    """Rows 0 .. N - 1 of ``T``, the diagonal of row N, and the row m at which the eliminations meet."""

    diagonal: list[Any]
    couplings: list[Any]
    peak: int
    size: Any  # |q|

    def count_below(self, x: Any) -> int | None:
        """How many eigenvalues of the infinite matrix lie below x, any point of a ball; None if a sign is hidden."""
        if not self.diagonal[-1] - x > 2 * self.size:
            return None
        pivots, _ = self._pivots(x)
        if not all(pivot > 0 or pivot < 0 for pivot in pivots):
            return None
        return sum(bool(pivot < 0) for pivot in pivots)

    def refine(self, x: float, bits: int, guard: int) -> Any:
        """Newton's method on ``g``, at twice as many bits from step to step."""
        guess, known = arb(x), 40
        while known < bits:
            known = min(2 * known - 4, bits)
            with ctx.workprec(known + guard):
                pivots, slope = self._pivots(guess)
                guess = (guess + pivots[-1] / slope).mid()
        return guess

    def _pivots(self, x: Any) -> tuple[list[Any], Any]:
        """All pivots of ``T - x``, ``g`` last, and the slope ``-dg/dx``."""
        m, d, e = self.peak, self.diagonal, self.couplings
        tail = d[-1] - x - self.size * arb(0.5, 0.5)
        down, slope_down = _eliminate(zip(d[:m], e[:m]), x, arb(1))
        up, slope_up = _eliminate(zip(d[-2:m:-1], e[:m + 1:-1]), x, tail)
        left, right = e[m] / down[-1], e[m + 1] / up[-1]
        slope = 1 + left / down[-1] * slope_down + right / up[-1] * slope_up
        return [*down, *up, d[m] - x - left - right], slope


def _eliminate(rows: Iterable[tuple[Any, Any]], x: Any, pivot: Any) -> tuple[list[Any], Any]:
    """The pivots from the given one on, and minus the derivative of the last by x."""
    pivots, slope = [pivot], arb(1)
    for d, e in rows:
        ratio = e / pivot
        slope = 1 + ratio / pivot * slope
        pivot = d - x - ratio
        pivots.append(pivot)
    return pivots, slope
