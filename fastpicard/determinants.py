r"""Determinants and power sums in any commutative ring: floats, balls, polynomials, Taylor models.

Nothing is divided, so what holds for numbers holds for functions:

- ``det`` by Laplace along the rows, every minor once: ``N 2**N`` products;
- the power sums ``s_k = tr M**k`` of the eigenvalues;
- Hermite's matrices.  For the N numbers ``rho_i`` with power sums ``s_k`` put
  ``H_jk = s_{j+k}`` and ``G_jk = 4 s_{j+k} - s_{j+k+2}``, ``0 <= j, k < N``.
  With ``V_ij = rho_i**j``, ``H = V' V`` and ``G = V' diag(4 - rho_i**2) V``, so

      all rho_i real, distinct and in (-2, 2)   <=>   H and G positive definite,
      all rho_i real and in [-2, 2]              =>   H and G positive semidefinite, every principal minor >= 0.

  (Real rho: read off.  A pair of complex ones makes the quadratic form of H indefinite, Hermite 1856.)
  The same for ``sigma_i = 2 - rho_i`` in (0, 4) has ``G_jk = 4 s_{j+k+1} - s_{j+k+2}``: where all rho are near 2
  (slow motions) the sigma are small numbers, of which no digits are lost.
  ``det H`` is the discriminant and ``det G = det H p(2) p(-2) (-1)**N``.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from math import comb
from typing import Any

Rows = Sequence[Sequence[Any]]


def determinant(rows: Rows) -> Any:
    """The determinant, without a division."""
    minors: dict[tuple[int, ...], Any] = {(j,): x for j, x in enumerate(rows[-1])}
    for size, row in enumerate(reversed(rows[:-1]), 2):
        minors = {columns: _expanded(row, columns, minors) for columns in combinations(range(len(row)), size)}
    return minors[tuple(range(len(rows)))]


def _expanded(row: Sequence[Any], columns: tuple[int, ...], minors: dict[tuple[int, ...], Any]) -> Any:
    total = None
    for k, j in enumerate(columns):
        term = row[j] * minors[columns[:k] + columns[k + 1:]]
        total = term if total is None else total - term if k % 2 else total + term
    return total


def product(left: Rows, right: Rows) -> list[list[Any]]:
    """The product of two matrices."""
    columns = list(zip(*right, strict=True))
    return [[_dot(row, column) for column in columns] for row in left]


def _dot(row: Sequence[Any], column: Sequence[Any]) -> Any:
    terms = [x * y for x, y in zip(row, column, strict=True)]
    total = terms[0]
    for term in terms[1:]:
        total = total + term
    return total


def trace(rows: Rows) -> Any:
    """The sum of the diagonal."""
    total = rows[0][0]
    for i in range(1, len(rows)):
        total = total + rows[i][i]
    return total


def power_sums(rows: Rows, last: int) -> list[Any]:
    """``tr M, tr M**2, ..., tr M**last``."""
    powers = [rows]
    while 2 * len(powers) < last:
        powers.append(product(powers[-1], rows))
    sums = [trace(power) for power in powers[:last]]
    while len(sums) < last:
        k = len(sums) + 1
        sums.append(_trace_of_product(powers[-1], powers[k - len(powers) - 1]))
    return sums


def _trace_of_product(left: Rows, right: Rows) -> Any:
    columns = list(zip(*right, strict=True))
    total = _dot(left[0], columns[0])
    for i in range(1, len(left)):
        total = total + _dot(left[i], columns[i])
    return total


def sums_of_rho(traces: Sequence[Any], last: int, size: int) -> list[Any]:
    """``sum over pairs of (lambda + 1/lambda)**k`` for k = 1 .. last, from ``tr M, tr M**2, ...`` of reciprocal pairs.

    ``size`` is the number of multipliers, twice that of the pairs.
    """
    result = []
    for k in range(1, last + 1):
        total = traces[k - 1]
        for j in range(1, k // 2 + 1):
            if 2 * j == k:
                total = total + comb(k, j) // 2 * size
            else:
                total = total + traces[k - 2 * j - 1] * comb(k, j)
        result.append(total)
    return result


def hermite(sums: Sequence[Any], size: int, beyond: bool) -> list[list[Any]]:
    """``H`` with entries ``s_{j+k}``, or where ``beyond`` ``G`` with ``4 s_{j+k} - s_{j+k+2}``; ``s_0 = size``."""
    s = [size, *sums]
    if beyond:
        return [[s[j + k + 2] * -1 + (s[j + k] * 4) for k in range(size)] for j in range(size)]
    return [[s[j + k] for k in range(size)] for j in range(size)]


def hermite_from_zero(sums: Sequence[Any], size: int) -> list[list[Any]]:
    """``G`` with entries ``4 s_{j+k+1} - s_{j+k+2}``: positive definite with ``H`` if all numbers are in (0, 4)."""
    s = [size, *sums]
    return [[s[j + k + 2] * -1 + (s[j + k + 1] * 4) for k in range(size)] for j in range(size)]
