"""Tubes: curves with a proved radius, beside characteristic numbers by tridiagonal matrices."""

import numpy as np
import pytest
from flint import arb, ctx
from sympy import Matrix, Rational, cos, sin
from sympy.abc import a, b, t

from fastpicard import BadInputError, FloquetMatrix, mathieu_a, mathieu_b
from fastpicard.tubes import tubes

MATHIEU = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0)


@pytest.fixture(scope="module")
def found():
    """The boundaries of Mathieu's equation near the origin."""
    return tubes(MATHIEU, (a, -0.5, 1.2), (b, 0, 0.9))


@pytest.mark.parametrize("at", [Rational(1, 3), Rational(1, 7), Rational(4, 5)])
def test_tubes_hold_the_characteristic_numbers(found, at):
    """a_r(-2b)/4 and b_r(-2b)/4 in order, to thirty digits."""
    numbers = [mathieu_a(0, -2 * at, 30), mathieu_a(1, -2 * at, 30), mathieu_b(1, -2 * at, 30),
               mathieu_b(2, -2 * at, 30), mathieu_a(2, -2 * at, 30)]
    numbers = sorted(x / 4 for x in numbers if -0.5 <= x / 4 <= 1.2)
    tubes_here = [ball for _, _, ball in found.at(at) if -0.5 <= float(ball) <= 1.2]

    assert len(tubes_here) == len(numbers)
    for ball, number in zip(tubes_here, numbers, strict=True):
        with ctx.workprec(200):
            assert abs(ball.mid() - float(number)) < 1e-15
            assert float(ball.rad()) <= 1.01e-20


def test_every_radius_is_what_was_asked(found):
    """And the tubes are next to nothing of the area."""
    assert 0 < found.radius <= 1e-20
    assert found.area < 1e-19


def test_beside_a_tube_the_true_verdicts_differ(found):
    """1e-17 to the left and to the right of a boundary, by ball Taylor."""
    for _, _, ball in found.at(Rational(1, 2)):
        with ctx.workprec(200):
            sides = [ball.mid() + side * arb(10) ** -17 for side in (-1, 1)]
        left, right = (int(MATHIEU.verdict({a: side, b: Rational(1, 2)})) for side in sides)

        assert {left, right} == {1, -1}


def test_pieces_join(found):
    """At common ends two pieces of one curve contain one number."""
    for piece in found.pieces:
        for other in found.pieces:
            same = (piece.label, piece.parity) == (other.label, other.parity) and piece.hi == other.lo
            if same and abs(float(piece(piece.hi)) - float(other(piece.hi))) < 1e-6:
                assert piece(piece.hi).overlaps(other(piece.hi))
    a_line, b_line = found.pieces[0].points()
    assert a_line.shape == b_line.shape and np.isfinite(a_line).all()


def test_what_has_no_graphs_is_refused():
    """A sine beside the cosine is not even."""
    with pytest.raises(BadInputError, match="even"):
        tubes(FloquetMatrix(Matrix([[0, 1], [-a - b * sin(t) - b * cos(2 * t), 0]]), t, 0), (a, 0, 1), (b, 0, 1))


def test_the_first_axis_is_the_constant():
    """Cauchy's estimate of the derivative's remainder is for a + q."""
    with pytest.raises(BadInputError, match="added to q"):
        tubes(MATHIEU, (b, 0, 1), (a, 0, 1))
