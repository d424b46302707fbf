r"""An eigenvalue of one of Mathieu's matrices in float64: a guess, which :mod:`fastpicard.mathieu_matrices` proves.

Eliminate ``T - x`` from both ends, meet in the row m where ``|g|`` is least, and take Newton's step on ``g``, which
doubles the digits.  It starts from the expansions for large q or large r (DLMF 28.8.1, 28.6.14), and from bisection
where they lead to another eigenvalue, as they may around ``r = 4 sqrt(q)/pi``.
"""

import math
from dataclasses import dataclass
from typing import Any

from fastpicard.errors import BadInputError, printed
from fastpicard.mathieu_matrices import Matrix, Section, norm
from fastpicard.precision import working

MAX_ROWS = 1_000_000
_TINY = 1e-300


@dataclass(frozen=True)
class Guess:
    """A float64 guess of the eigenvalue, the row where its eigenvector is largest, and the slope of ``-g`` there."""

    matrix: Matrix
    size: float  # |q|
    eigenvalue: float
    peak: int
    slope: float
    exponent: int  # the binary digits before the point of the eigenvalue

    def section(self, q: Any, bits: int) -> tuple[Section, int]:
        """The rows that matter for ``bits`` binary digits after the point, and the binary digits before it."""
        rows = max(_rows(self.matrix, self.size, self.eigenvalue, bits), self.peak + 2)
        largest = (self.matrix.lowest + 2.0 * rows) ** 2 + 4 * self.size
        scale = math.frexp(largest)[1]
        with working(2 * (bits + scale) + 64):
            section = Section(self.matrix.diagonal(q, rows + 1), self.matrix.couplings(q, rows + 1), self.peak, abs(q))
        return section, scale


def float_guess(matrix: Matrix, middle: Any) -> Guess:
    """The eigenvalue that is meant, to about 15 digits of the largest entries; ``middle`` is q, an exact ball.

    Raises BadInputError for a matrix of more than ``MAX_ROWS`` rows.
    """
    q = math.copysign(max(abs(float(middle)), 1e-150), float(middle))
    size = abs(q)
    if matrix.r > 2 * MAX_ROWS or size > 1e100:
        raise _too_large(matrix, size)
    largest = max(matrix.r**2, size)
    top = -2 * size + 2 * (2 * matrix.r + 1) * math.sqrt(size) if matrix.r < math.sqrt(size) else matrix.r**2 + 2 * size
    rows = _rows(matrix, size, top, 64 - math.frexp(largest)[1])
    diagonal, couplings = matrix.diagonal(q, rows), matrix.couplings(q, rows)
    near = math.sqrt(largest)  # about the distance of neighbours
    for width in (math.inf, 0.03 * near, 1e-15 * largest):
        first = _bisection(matrix, q, diagonal, couplings, width) if width < math.inf else _expansion(matrix, q)
        x, peak, slope, index = _newton(diagonal, couplings, first, 1e-8 * near)
        if index == matrix.index:
            break
    return Guess(matrix, size, x, peak, slope, math.frexp(max(abs(x), 1e-12 * largest))[1])


def _expansion(matrix: Matrix, q: float) -> float:
    """The expansions for large q (DLMF 28.8.1; for q < 0 by 28.2(v)) and for large r (28.6.14)."""
    r, h = matrix.r, math.sqrt(abs(q))
    if r < 1.2 * h:
        even = (matrix.name == "a") == (q > 0 or r % 2 == 0)
        s = 2 * r + 1 if even else 2 * r - 1
        return (-2 * h * h + 2 * s * h - (s**2 + 1) / 8 - (s**3 + 3 * s) / (128 * h)
                - (5 * s**4 + 34 * s**2 + 9) / (4096 * h * h))
    if r < 3:
        return r**2 + matrix.corner * q
    return r**2 + q**2 / (2 * (r**2 - 1)) + (5 * r**2 + 7) * q**4 / (32 * (r**2 - 1) ** 3 * (r**2 - 4))


def _bisection(matrix: Matrix, q: float, diagonal: list[float], couplings: list[float], width: float) -> float:
    """Bisect ``|a - r**2| <= 2|q|`` (Weyl) by counting negative pivots."""
    low, high = matrix.r**2 - 2 * abs(q), matrix.r**2 + 2 * abs(q)
    while high - low > width:
        middle = (low + high) / 2
        if _negatives(diagonal, couplings, middle) > matrix.index:
            high = middle
        else:
            low = middle
    return (low + high) / 2


def _newton(diagonal: list[float], couplings: list[float], x: float, small: float) -> tuple[float, int, float, int]:
    """An eigenvalue near x, the row where its eigenvector is largest, the slope, and how many eigenvalues are smaller.

    ``small`` is far below the distance of eigenvalues: the error after such a step, about its square, is rounding.
    """
    for _ in range(12):
        down = _pivots(diagonal, couplings, x)
        up = _pivots(diagonal[::-1], [0.0, *couplings[:0:-1]], x)[::-1]
        residual = [abs(u + v - (d - x)) for u, v, d in zip(down, up, diagonal)]
        peak = residual.index(min(residual))
        slope = norm(down[:peak], couplings[1:]) + norm(up[:peak:-1], couplings[:peak:-1]) - 1
        step = (down[peak] + up[peak] - (diagonal[peak] - x)) / slope
        x += step
        if abs(step) <= small:
            break
    return x, peak, slope, sum(pivot < 0 for pivot in (*down[:peak], *up[peak + 1:]))


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


def _rows(matrix: Matrix, size: float, x: float, bits: int) -> int:
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


def _too_large(matrix: Matrix, size: float) -> BadInputError:
    return BadInputError(f"{matrix.name}_r(q) at r = {printed(matrix.r)}, |q| = {size:.6g} needs a matrix of more than "
                         f"{MAX_ROWS} rows.  Use the asymptotic series: DLMF 28.8.1 (large q), 28.6.14 (large r).")
