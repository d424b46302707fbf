"""A bare prototype of the engine, to time against in one run: plain Python integers, nothing else.

It builds every increment of the fundamental matrix over a common multiple ``N`` of
the frequencies, one dense list of coefficients of ``t**r/r!`` for each frequency
and monomial: no SymPy, no conversion, no reduction, no general frequencies, and no
increment is kept.  A time to beat, not a design.
"""

from __future__ import annotations

from math import lcm
from typing import Any

MATHIEU = {(0, 1): [(0, (0, 0), 1)], (1, 0): [(0, (1, 0), -1), (1, (0, 1), -1)]}
DOUBLE_ROD: dict[tuple[int, int], list[Any]] = {(0, 2): [(0, (0, 0), 1)], (1, 3): [(0, (0, 0), 1)]}
for i, j, v in ((2, 0, -18), (2, 1, 9), (3, 0, 27), (3, 1, -24)):
    DOUBLE_ROD[i, j] = [(0, (1, 0), v), (1, (0, 1), v)]


def axpy(y: Any, c: int, x: Any) -> Any:
    if x is None:
        return y
    if y is None:
        return [c * v for v in x]
    y.extend([0] * (len(x) - len(y)))
    for r, v in enumerate(x):
        y[r] += c * v
    return y


def add(z: dict[Any, Any], key: Any, c: int, C: Any, S: Any) -> None:
    pair = z.setdefault(key, [None, None])
    pair[:] = axpy(pair[0], c, C), axpy(pair[1], c, S)


def increments(P: dict[Any, Any], dim: int, n: int, column: int) -> Any:
    """Integer coefficients of t**r/r! in I_0 ... I_n, scaled by N**(m - r) 2**m."""
    N = lcm(*range(1, n // 2 + 2))
    x: list[dict[Any, Any]] = [{} for _ in range(dim)]
    x[column][0, (0, 0)] = ([1], None)
    for _ in range(n):
        y: list[dict[Any, Any]] = [{} for _ in range(dim)]
        for (i, j), terms in P.items():
            for (q, m), (C, S) in x[j].items():
                for k, dm, c in terms:
                    key = (m[0] + dm[0], m[1] + dm[1])
                    if k == 0 or q == 0:
                        add(y[i], (q + k, key), 2 * c, C, S)
                        continue
                    add(y[i], (q + k, key), c, C, S)
                    if q > k:
                        add(y[i], (q - k, key), c, C, S)
                    elif q == k:
                        add(y[i], (0, key), c, C, None)
                    else:
                        add(y[i], (k - q, key), c, C, None if S is None else [-v for v in S])
        x = [integral(z, N) for z in y]
        yield x


def integral(y: dict[Any, Any], N: int) -> dict[Any, Any]:
    z: dict[Any, Any] = {}
    constant: dict[Any, int] = {}
    for (q, m), (C, S) in y.items():
        if q == 0:
            z[0, m] = ([0, *C], None)
            continue
        M, n = N // q, max(len(C or ()), len(S or ()))
        A, B = [0] * n, [0] * n
        a = b = 0
        C, S = (C or []) + [0] * (n - len(C or ())), (S or []) + [0] * (n - len(S or ()))
        for r in range(n - 1, -1, -1):
            a, b = M * (b - S[r]), M * (C[r] - a)
            A[r], B[r] = a, b
        z[q, m] = (A, B)
        constant[m] = constant.get(m, 0) - A[0]
    for m, v in constant.items():
        if v:
            z.setdefault((0, m), ([0], None))[0][0] += v
    return z


def fundamental_matrix(P: dict[Any, Any], dim: int, n: int) -> None:
    """All increments of all columns, each thrown away when the next one is there."""
    for column in range(dim):
        for _ in increments(P, dim, n, column):
            pass
