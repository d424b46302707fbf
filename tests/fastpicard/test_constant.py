"""Verdicts on constant coefficients, against matrices made from Jordan blocks that are known."""

from __future__ import annotations

import pytest
from flint import fmpq, fmpq_mat
from hypothesis import given, settings, strategies as st
from sympy import Matrix, Rational, cos, pi, sqrt, symbols

from fastpicard import FloquetMatrix, Verdict
from fastpicard.constant import by_minimal_polynomial

a, b, t = symbols("a b t")

RATES = st.tuples(st.sampled_from([Rational(-1, 3), -1, 0, 0, 0, 0, Rational(1, 3)]), st.sampled_from([0, 1, 1, 2]))
BLOCKS = st.lists(st.tuples(RATES, st.integers(1, 2)), min_size=1, max_size=3)


def jordan(blocks):
    """A real matrix whose Jordan blocks belong to ``alpha`` or the pair ``alpha +- i omega``."""
    parts = []
    for (alpha, omega), length in blocks:
        cell = Matrix([[alpha, -omega], [omega, alpha]]) if omega else Matrix([[alpha]])
        part = Matrix.zeros(length * cell.rows, length * cell.rows)
        for k in range(length):
            part[k * cell.rows, k * cell.rows] = cell
            if k + 1 < length:
                part[k * cell.rows, (k + 1) * cell.rows] = Matrix.eye(cell.rows)
        parts.append(part)
    return Matrix.diag(*parts)


def as_flint(A):
    """A rational matrix of SymPy's as python-flint's."""
    return fmpq_mat([[fmpq(int(x.p), int(x.q)) for x in A.row(i)] for i in range(A.rows)])


@settings(max_examples=60)
@given(BLOCKS, st.lists(st.integers(-2, 2), min_size=36, max_size=36))
def test_known_jordan_blocks_are_judged_right(blocks, entries):
    """Bounded exactly if nothing is to the right of the axis and no block on it is longer than 1; in any basis."""
    J = jordan(blocks)
    lower = Matrix(J.rows, J.rows, lambda i, j: entries[(6 * i + j) % 36] if i > j else int(i == j))
    bounded = all(alpha < 0 or alpha == 0 and length == 1 for (alpha, _), length in blocks)

    verdict = by_minimal_polynomial(as_flint(lower * lower.T * J * (lower * lower.T).inv()))

    assert verdict == (Verdict.STABLE if bounded else Verdict.UNSTABLE)
    assert "minimal polynomial" in verdict.reason


@pytest.mark.parametrize(("P", "values", "expected"), [
    (Matrix([[0, 1], [-a - b * cos(t), 0]]), {a: Rational(9, 4), b: 0}, Verdict.STABLE),
    (Matrix([[0, 1], [-a - b * cos(t), 0]]), {a: Rational(-1, 10**40), b: 0}, Verdict.UNSTABLE),
    (Matrix([[0, 1], [-a - b * sqrt(2) * cos(t), -b * pi]]), {a: 4, b: 0}, Verdict.STABLE),
    (Matrix([[0, 1], [-a - b * cos(t), Rational(-1, 10**40)]]), {a: 1, b: 0}, Verdict.STABLE),
    (Matrix([[0, 1], [-a - b * cos(t), Rational(1, 10**40)]]), {a: 1, b: 0}, Verdict.UNSTABLE),
    (Matrix([[0]]), {}, Verdict.STABLE),
    (Matrix([[0, 1], [0, 0]]), {}, Verdict.UNSTABLE),
    (Matrix([[0, 1, 0, 0], [-1, 0, 0, 0], [a, b, 0, 1], [0, 0, -1, 0]]), {a: 0, b: 0}, Verdict.STABLE),
    (Matrix([[0, 1, 0, 0], [-1, 0, 0, 0], [a, b, 0, 1], [0, 0, -1, 0]]), {a: 1, b: 0}, Verdict.UNSTABLE),
    (Matrix([[a, 1, 0, 0], [-1, a, 0, 0], [0, 0, -a, 1], [0, 0, -1, -a]]), {a: Rational(1, 3)}, Verdict.UNSTABLE),
])
def test_undriven_equations_are_decided_exactly(P, values, expected):
    """Zero amplitudes leave a constant matrix, whatever factors they have; 1e-40 from a boundary is not on it."""
    verdict = FloquetMatrix(P, t, 0).verdict(values)

    assert verdict == expected and "constant" in verdict.reason


def test_a_phase_or_an_irrational_entry_leaves_it_to_the_balls():
    """cos(1) is constant and irrational, sqrt(2) too: decided by the trace."""
    for P in (Matrix([[0, 1], [-(2 + cos(a)) / 10, 0]]), Matrix([[0, 1], [-sqrt(2) / 10, 0]])):
        verdict = FloquetMatrix(P, t, 0).verdict({a: 1} if P.has(a) else {})
        assert verdict == Verdict.STABLE and "trace" in verdict.reason
