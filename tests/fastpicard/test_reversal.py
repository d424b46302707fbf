"""Reversal in time, of a matrix with symbols and of the same at numbers."""

from __future__ import annotations

import pytest
from hypothesis import given, settings, strategies as st
from sympy import Matrix, Rational, cos, sin, symbols

from fastpicard import FloquetMatrix
from fastpicard.halfway import reversal
from fastpicard.matrix import read_matrix

a, b, t, phi = symbols("a b t phi")


@pytest.mark.parametrize(("P", "expected"), [
    ([[0, 1], [-a - b * cos(t), 0]], (1, -1)),
    ([[0, 1], [-a - b * sin(t), 0]], None),
    ([[0, 1], [-a - b * cos(t) - (a - Rational(1009, 997)) * (b - Rational(1011, 998)) * sin(t), 0]], None),
    ([[b * sin(t), 1], [-a, -b * sin(t)]], (1, -1)),
    ([[0, 1], [-a, -b]], None),
    ([[0, 1], [-a - b * cos(t + phi) - b * cos(t - phi), 0]], (1, -1)),
    ([[0, 1], [-a - cos(phi) * cos(t), 0]], (1, -1)),
    ([[0, 1], [-a - b * cos(t + phi), 0]], None),
    ([[0, sin(t)], [b * sin(2 * t), 0]], (1, 1)),
    ([[0, cos(t), sin(t)], [b, 0, cos(2 * t)], [sin(t), a, 0]], (1, -1, 1)),
    ([[0, cos(t), cos(t)], [b, 0, cos(2 * t)], [sin(t), a, 0]], None),
])
def test_reversal_holds_at_all_parameters_or_is_not_claimed(P, expected):
    """Even entries join opposite signs, odd ones equal signs; no single value of a parameter may hide a sine."""
    assert reversal(read_matrix(Matrix(P), t)) == expected


WAVES = st.sampled_from([0, 1, a, cos(t), b * cos(2 * t), sin(t), a * sin(3 * t), cos(t + phi)])


def test_an_entry_that_vanishes_at_numbers_joins_nothing():
    """Without b cos 2t between them, rows 0 and 2 have opposite signs."""
    F = FloquetMatrix(Matrix([[0, cos(t), b * cos(2 * t)], [0, sin(t), 0], [cos(t), 0, 0]]), t, 0)
    assert F.at(F.numbers({b: 0}))[0].reversal == F.at(F.numbers({b: 1}))[0].reversal == (1, -1, -1)


@settings(max_examples=60)
@given(st.lists(WAVES, min_size=9, max_size=9), st.fractions(-3, 3), st.fractions(-3, 3), st.fractions(-3, 3))
def test_what_holds_for_symbols_holds_at_numbers(entries, x, y, z):
    """Symbols can only know less: signs found for them reverse the matrix at every value."""
    P = Matrix(3, 3, entries)
    signs = reversal(read_matrix(P, t))
    if signs is not None:
        S = Matrix.diag(*signs)
        assert (S * P.subs(t, -t) * S + P).is_zero_matrix
        F = FloquetMatrix(P, t, 0)
        assert F.at(F.numbers({a: x, b: y, phi: z}))[0].reversal is not None
