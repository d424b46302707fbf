r"""Numbers ``mu`` and vectors u with ``B u = mu A u``, A positive definite and B symmetric, every digit right.

``A^-1 B`` is formed in balls and diagonalised by python-flint, which proves that every ball it gives contains one
eigenvalue and its vector; the precision is doubled until the balls are small enough.  Equal eigenvalues cannot be
proved so.  Where some are not told apart by TRIES precisions, mpmath solves the symmetric problem with ``A = C C^T``,

    C^-1 B C^-T y = mu y,   u = C^-T y,

whose vectors stay A-orthogonal, and the digits are those on which two precisions agree.
"""

from __future__ import annotations

from typing import Any

import flint
import mpmath
from sympy import Float, ImmutableDenseMatrix, Integer

from .arithmetic import Balls
from .precision import working

__all__ = ["eigenpairs"]

TRIES = 5


def eigenpairs(A: Any, B: Any, digits: int) -> tuple[list[Any], Any]:
    """The eigenvalues, ascending, and their vectors in the columns of a Matrix, the last component of each 1.

    A and B are Matrices of exact numbers, shape (n, n); results are SymPy Floats of ``digits`` digits.  A number
    smaller than 10**-digits of the largest, of all mu or of its vector, is right to that fraction of the largest only.
    """
    bits = int(3.33 * digits) + 8 * A.rows + 64
    for _ in range(TRIES):
        with working(bits):
            found = _in_balls(A, B, digits)
        if found is not None:
            return found
        bits *= 2
    return _until_still(A, B, digits, bits)


def _in_balls(A: Any, B: Any, digits: int) -> tuple[list[Any], Any] | None:
    """None where the precision does not suffice."""
    n, number = A.rows, Balls().number
    a, b = (flint.arb_mat(n, n, [number(x) for x in matrix]) for matrix in (A, B))
    try:
        values, vectors = flint.acb_mat(a.solve(b)).eig(right=True)
    except (ValueError, ZeroDivisionError):  # two of them not told apart, or A not told from a singular matrix
        return None
    order = sorted(range(n), key=lambda j: values[j].real.mid())
    parts = [_rounded([values[j].real for j in order], digits)]
    for j in order:
        column = [vectors[i, j] for i in range(n)]
        last = next((x for x in reversed(column) if not x.contains(0)), column[0])
        parts.append(_rounded([(x / last).real for x in column], digits))
    found = [part for part in parts if part is not None]
    return (found[0], ImmutableDenseMatrix(n, n, lambda i, j: found[j + 1][i])) if len(found) > n else None


def _rounded(balls: list[Any], digits: int) -> list[Any] | None:
    """The middles of balls; None where one of them is too wide for that."""
    largest, least = max(abs(x.mid()) for x in balls), flint.arb(10) ** -digits
    found = []
    for x in balls:
        if not x.rad() < least / 10 * max(abs(x.mid()), least * largest):
            return None
        mantissa, exponent = x.mid().man_exp()
        exact = Integer(int(mantissa)) * Integer(2) ** int(exponent)
        found.append(Float(0 if x.contains(0) else exact, digits))
    return found


def _until_still(A: Any, B: Any, digits: int, bits: int) -> tuple[list[Any], Any]:
    """From ``bits`` on, the precision is raised until two computations agree."""
    dps = int(0.302 * bits)
    old = _symmetric(A, B, dps)
    while True:
        dps = dps + dps // 2
        new = _symmetric(A, B, dps)
        size = max(abs(x) for x in new[0])
        if all(abs(x - y) <= mpmath.mpf(10) ** (-digits - 2) * max(abs(y), size * mpmath.mpf(10) ** -digits)
               for x, y in zip(old[0], new[0], strict=True)):
            break
        old = new
    values, modes = new
    n = A.rows
    return ([Float(x, digits) for x in values],
            ImmutableDenseMatrix(n, n, [Float(modes[i, j], digits) for i in range(n) for j in range(n)]))


def _symmetric(A: Any, B: Any, dps: int) -> tuple[list[Any], Any]:
    """By mpmath, at one precision."""
    ctx = mpmath.mp.clone()
    ctx.dps = dps
    n = A.rows
    a, b = (ctx.matrix(n, n) for _ in range(2))
    for i in range(n):
        for j in range(n):
            a[i, j], b[i, j] = (ctx.mpmathify(M[i, j].evalf(dps)) for M in (A, B))
    inverse = ctx.inverse(ctx.cholesky(a))
    values, y = ctx.eigsy(inverse * b * inverse.T)
    modes = inverse.T * y
    for j in range(n):
        column = [modes[i, j] for i in range(n)]
        floor = max(abs(x) for x in column) * ctx.mpf(10) ** (-dps // 2)
        pivot = next(x for x in reversed(column) if abs(x) > floor)
        for i in range(n):
            modes[i, j] = modes[i, j] / pivot if abs(modes[i, j]) > floor else ctx.zero
    return list(values), modes
