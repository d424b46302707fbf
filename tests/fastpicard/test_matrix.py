"""Matrices of series: laws of matrices, entry by entry."""

import operator

import mpmath
import pytest
import sympy
from hypothesis import given
from sympy import Matrix, Symbol, cos, sin

from fastpicard import BadInputError, BadTypeError, PoissonSeries, SeriesMatrix, ShapeError, fast_picard
from fastpicard.matrix import read_matrix
from tests.oracles import closeness
from tests.strategies import VALUES, a, b, matrices, plain_times, t

GENERAL = Matrix([[sin(t), a], [b * cos(2 * t), t]])


def of(matrix):
    """The matrix of series of a SymPy matrix."""
    return read_matrix(matrix, t)


@given(matrices(2), matrices(2), matrices(2))
def test_products_associate_and_distribute(P, Q, R):
    """(P Q) R = P (Q R), P (Q + R) = P Q + P R; nothing commutes."""
    x, y, z = map(of, (P, Q, R))

    assert (x @ y) @ z == x @ (y @ z)
    assert x @ (y + z) == x @ y + x @ z
    assert x + y == y + x


@given(matrices(2), matrices(2))
def test_products_are_those_of_sympy(P, Q):
    """Row by column, in this order."""
    assert of(P) @ of(Q) == of(P * Q)
    assert hash(of(P) @ of(Q)) == hash(of(P * Q))


@given(matrices(2), matrices(2))
def test_calculus_is_entry_by_entry(P, Q):
    """(P Q)' = P' Q + P Q', I[P]' = P, I[P](0) = 0."""
    x, y = of(P), of(Q)

    assert (x @ y).diff() == x.diff() @ y + x @ y.diff()
    assert x.integrate().diff() == x
    assert x.integrate()(0) == sympy.zeros(2)


@given(matrices(2), plain_times)
def test_entries_and_values_agree(P, time):
    """An entry is a series; numbers in rows and columns where they belong."""
    x = of(P)
    numbers, exact = x.evaluate(time, VALUES, 20), x(time)

    for i in range(2):
        for j in range(2):
            assert x[i, j] == PoissonSeries(P[i, j], t)
            assert closeness(numbers[i, j], str(sympy.N(exact[i, j].subs(VALUES), 30))) < mpmath.mpf(10) ** -18
            assert x.evaluate(time, VALUES)[i, j] == float(numbers[i, j])


def test_shapes_must_fit():
    """Sums want equal shapes, products equal inner sizes; rectangular ones may multiply."""
    square, column = of(GENERAL), SeriesMatrix(tuple((row[0],) for row in of(GENERAL).rows), t)

    assert (square @ column).shape == (2, 1)
    for wrong in (lambda: square + column, lambda: column @ square):
        with pytest.raises(ShapeError):
            wrong()


def test_a_matrix_is_equal_to_the_same_one():
    """That of SymPy too, in the canonical form; nothing else is."""
    assert of(GENERAL) == GENERAL
    assert of(GENERAL) != GENERAL + GENERAL
    assert of(GENERAL) != "matrix"
    assert of(GENERAL) != of(GENERAL + GENERAL)
    assert of(GENERAL) == of(GENERAL.copy())


def test_matrices_print_themselves():
    """A line in words; LaTeX while it is short."""
    assert repr(of(GENERAL)) == "<2 x 2 matrix of Poisson series in t>"
    assert r"\sin" in of(GENERAL)._repr_latex_()
    assert of(GENERAL).as_matrix() == GENERAL


@pytest.mark.parametrize("operation", [operator.add, operator.matmul])
def test_operands_are_matrices_of_series_in_the_same_time(operation):
    """A matrix in s taken for one in t would give a wrong sum without a word."""
    s = Symbol("s")
    left, right = (fast_picard([[cos(x)]], x, [1], 1).series for x in (t, s))

    with pytest.raises(BadInputError, match="same time, but they have t and s"):
        operation(left, right)
    for other in (2, [[1]], None):
        with pytest.raises(BadTypeError, match="matrices of series go with each other"):
            operation(left, other)
