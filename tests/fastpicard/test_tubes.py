"""Tubes: curves with a proved radius, beside characteristic numbers by tridiagonal matrices."""

import sys

import mpmath
import numpy as np
import pytest
from flint import arb, ctx
from sympy import Matrix, Rational, cos, sin
from sympy.abc import a, b, t

from fastpicard import BadInputError, FloquetMatrix, mathieu_a, mathieu_b
from fastpicard.tubes import tubes

tubes_module = sys.modules["fastpicard.tubes"]  # its name in the package is that of the function
MATHIEU = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0)


@pytest.fixture(scope="module")
def found():
    """The boundaries of Mathieu's equation near the origin."""
    return tubes(MATHIEU, (a, -0.5, 1.2), (b, 0, 0.9))


def characteristic(at):
    """(a, label, parity) of the boundaries near the origin at one b, ascending: a_r(-2b)/4 even, b_r(-2b)/4 odd."""
    with mpmath.workdps(40):
        found = [(mathieu_a(r, -2 * at, 30) / 4, "-1" if r % 2 else "+1", "even") for r in range(3)]
        found += [(mathieu_b(r, -2 * at, 30) / 4, "-1" if r % 2 else "+1", "odd") for r in (1, 2)]
    return sorted(found)


@pytest.mark.parametrize("at", [Rational(1, 3), Rational(1, 7), Rational(4, 5)])
def test_tubes_hold_the_characteristic_numbers(found, at):
    """By name and in order, to 25 digits."""
    numbers = [x for x in characteristic(at) if -0.5 <= x[0] <= 1.2]
    tubes_here = found.at(at)

    assert [x[:2] for x in tubes_here] == [x[1:] for x in numbers]
    for (*_, ball), (number, *_) in zip(tubes_here, numbers, strict=True):
        with ctx.workprec(200):
            assert abs(ball.mid() - arb(number)) < 1e-25
            assert float(ball.rad()) <= 1.01e-20


@pytest.mark.parametrize("drive", [b**2, b**3])
def test_the_drive_may_be_a_power_of_the_second_parameter(drive):
    """An even one on both sides of zero; beside the characteristic numbers at the value of the power."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - drive * cos(t), 0]]), t, 0)
    found = tubes(F, (a, -0.5, 0.9), (b, -0.9, 0.6))

    for at in (Rational(-4, 5), Rational(1, 3)):
        numbers = [x for x in characteristic(abs(drive.subs(b, at))) if -0.5 <= x[0] <= 0.9]
        assert [x[0] for x in found.at(at)] == [x[1] for x in numbers]
        for (*_, ball), (number, *_) in zip(found.at(at), numbers, strict=True):
            with ctx.workprec(200):
                assert abs(ball.mid() - arb(number)) < 1e-25


def test_what_leaves_the_rectangle_is_not_given_outside():
    """The lowest two curves are in it at b = -1.909 and not at -1.992, in a piece over both."""
    found = tubes(MATHIEU, (a, -1, 0.9), (b, -2, -1.85))

    for at in (Rational(-1909, 1000), Rational(-249, 125)):
        numbers = [x for x in characteristic(at) if -1 <= x[0] <= 0.9]
        assert [x[:2] for x in found.at(at)] == [x[1:] for x in numbers]


def test_beyond_the_rectangle_nothing_is_claimed():
    """Neither by a piece nor by all; pieces meet at their ends."""
    found = tubes(MATHIEU, (a, 0, 0.3), (b, 0, 0.2), radius=1e-8)

    for ask in (found.pieces[0], found.at):
        with pytest.raises(BadInputError, match=r"b (is|from) .* is 5\."):
            ask(5)
    assert found.at(Rational(1, 5)) and found.at(found.pieces[0].hi)


@pytest.mark.parametrize("terms, radius", [(2, 0.1), (3, 1e-2), (4, 1e-3), (6, 1e-4)])
def test_tubes_of_few_terms_hold_the_characteristic_numbers(terms, radius, monkeypatch):
    """Where the defect, not the remainder, makes the radius: it holds the truth, and is not ten times too large."""
    monkeypatch.setattr(tubes_module, "TERMS", terms)
    rough, shares = tubes(MATHIEU, (a, -0.5, 1.2), (b, 0, 0.9), radius=radius), []
    for at in [Rational(k, 17) for k in range(1, 15)]:
        numbers = [x for x, *_ in characteristic(at)]
        with ctx.workprec(150):
            for ball in (piece(at) for piece in rough.pieces if piece.lo <= at <= piece.hi):
                shares.append(float(min(abs(ball.mid() - arb(x)) for x in numbers)) / float(ball.rad()))

    assert len(shares) > 50
    assert 0.1 < max(shares) <= 1


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
