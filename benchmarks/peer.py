"""The best peer: Picard increments by hand on python-flint's ``fmpq_mpoly``, one pair of polynomials a harmonic.

For every harmonic ``q`` of Mathieu's equation two polynomials in ``(t, a, b)``
multiply ``cos qt`` and ``sin qt``.  They are exact, merged over all increments and
reduced (one content each), as python-flint keeps them.
"""

from __future__ import annotations

from typing import Any

from flint import Ordering, fmpq, fmpq_mpoly_ctx

CONTEXT = fmpq_mpoly_ctx.get(["t", "a", "b"], Ordering.lex)
T, A, B = CONTEXT.gens()
ZERO = CONTEXT.from_dict({})
MATHIEU = {(0, 1): [(0, ZERO + 1)], (1, 0): [(0, -A), (1, -B)]}


def add(target: dict[int, Any], q: int, C: Any, S: Any) -> None:
    if q < 0:
        q, S = -q, -S
    if q == 0:
        S = ZERO
    old = target.get(q)
    target[q] = (C, S) if old is None else (old[0] + C, old[1] + S)


def multiply(terms: list[Any], x: dict[int, Any], target: dict[int, Any]) -> None:
    for k, c in terms:
        for q, (C, S) in x.items():
            if k == 0:
                add(target, q, c * C, c * S)
            else:
                half = fmpq(1, 2) * c
                add(target, q + k, half * C, half * S)
                add(target, q - k, half * C, half * S)


def integral(y: dict[int, Any]) -> dict[int, Any]:
    z: dict[int, Any] = {}
    constant = ZERO
    for q, (C, S) in y.items():
        if q == 0:
            add(z, 0, C.integral(0), ZERO)
            continue
        per = fmpq(1, q)
        a, b = ZERO, ZERO
        next_a, next_b = -S * per, C * per
        while next_a or next_b:
            a, b = a + next_a, b + next_b
            next_a, next_b = next_b.derivative(0) * per, -next_a.derivative(0) * per
        add(z, q, a, b)
        constant -= a.subs({"t": 0}) if a else ZERO
    add(z, 0, constant, ZERO)
    return z


def fundamental_matrix(P: dict[Any, Any], dim: int, n: int) -> list[list[dict[int, Any]]]:
    """Phi_n, columns of entries: {harmonic: (C, S)}."""
    columns = []
    for column in range(dim):
        x: list[dict[int, Any]] = [{0: (ZERO + 1, ZERO)} if i == column else {} for i in range(dim)]
        merged = [dict(entry) for entry in x]
        for _ in range(n):
            y: list[dict[int, Any]] = [{} for _ in range(dim)]
            for (i, j), terms in P.items():
                multiply(terms, x[j], y[i])
            x = [integral(entry) for entry in y]
            for total, entry in zip(merged, x):
                for q, (C, S) in entry.items():
                    add(total, q, C, S)
        columns.append(merged)
    return columns


def terms(columns: list[list[dict[int, Any]]]) -> int:
    """How many terms there are."""
    return sum(len(C) + len(S) for column in columns for entry in column for C, S in entry.values())
