"""The constant matrices that ``P`` is made of, at exact values of parameters, and the vectors that they send to 0."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flint import fmpq, fmpq_mat

from fastpicard.matrix import SeriesMatrix
from fastpicard.ring import expression_of


def coefficients(P: SeriesMatrix, values: Mapping[Any, Any]) -> dict[Any, dict[tuple[int, int], Any]]:
    """The constant matrices that multiply independent functions in ``P``, by (kind, angle, monomial) of these."""
    found: dict[Any, dict[tuple[int, int], Any]] = {}
    for i, row in enumerate(P.rows):
        for j, modes in enumerate(row):
            for (kind, angle, monomial), f in modes.items():
                value, rest = f[0], []
                for g, e in monomial:
                    given = values.get(expression_of(g))
                    if isinstance(given, fmpq) and e == int(e) and (given != 0 or e > 0):
                        value *= given ** int(e)
                    else:
                        rest.append((g, e))
                matrix = found.setdefault((kind, angle, tuple(rest)), {})
                matrix[i, j] = matrix.get((i, j), fmpq(0)) + value
    return found


def dense(entries: Mapping[tuple[int, int], Any], size: int) -> Any:
    """One of them, shape (size, size), as an ``fmpq_mat``."""
    return fmpq_mat([[entries.get((i, j), fmpq(0)) for j in range(size)] for i in range(size)])


def kernel(blocks: list[list[list[Any]]], unknowns: int) -> list[list[Any]]:
    """A basis of the vectors with so many entries that all rows of all blocks send to 0."""
    rows = [row for block in blocks for row in block if any(row)]
    if not rows:
        return [[fmpq(int(i == j)) for i in range(unknowns)] for j in range(unknowns)]
    reduced, rank = fmpq_mat(rows).rref()
    pivots = [next(k for k in range(unknowns) if reduced[r, k] != 0) for r in range(rank)]
    basis = []
    for free in sorted(set(range(unknowns)) - set(pivots)):
        vector = [fmpq(0)] * unknowns
        vector[free] = fmpq(1)
        for r, pivot in enumerate(pivots):
            vector[pivot] = -reduced[r, free]
        basis.append(vector)
    return basis
