"""Cosines of rational multiples of pi: the normal form, its dimension, and what it is used for."""

from fractions import Fraction

import pytest
import sympy
from flint import arb, ctx, fmpq
from hypothesis import given, strategies as st
from sympy import I, Integer, Matrix, Rational, cos, pi, root, sin, sqrt

from fastpicard import BadInputError, FloquetMatrix, NotPeriodicError, PoissonSeries, cosines
from tests.strategies import a, b, t

denominators = st.integers(1, 40)
turns = st.builds(Fraction, st.integers(-80, 80), denominators)
acute = turns.map(lambda x: cosines.folded(x)[1]).filter(lambda x: x != cosines.HALF)
small_numbers = st.builds(fmpq, st.integers(-5, 5).filter(bool), st.integers(1, 4))
sums = st.dictionaries(acute, small_numbers, max_size=3)


def of(expression):
    """The series of an expression."""
    return PoissonSeries(expression, t)


def value(basis):
    """A number in the basis as a ball."""
    total = arb(0)
    for parts, c in basis.items():
        factor = arb(c)
        for part in parts:
            factor *= arb(part).sqrt() if isinstance(part, int) else ball(part)
        total += factor
    return total


def ball(x):
    """cos(pi x)."""
    return arb.cos_pi_fmpq(fmpq(x.numerator, x.denominator))


def plus(left, right, sign=1):
    """The sum of two dictionaries of coefficients."""
    total = {k: left.get(k, 0) + sign * right.get(k, 0) for k in left.keys() | right.keys()}
    return {k: c for k, c in total.items() if c}


# -- the normal form ----------------------------------------------------------------------


@given(turns)
def test_folding_and_the_normal_form_keep_the_value(x):
    """Forty digits of the cosine before and after."""
    sign, y = cosines.folded(x)
    with ctx.workprec(140):
        assert abs(sign * ball(y) - ball(x)) < arb(10) ** -38
        if y != cosines.HALF:
            assert abs(value(cosines.normal({y: fmpq(sign)})) - ball(x)) < arb(10) ** -38


@given(sums, sums)
def test_the_normal_form_is_linear(x, y):
    """normal(x + y) = normal(x) + normal(y)."""
    assert cosines.normal(plus(x, y)) == plus(cosines.normal(x), cosines.normal(y))


@given(sums, sums, sums)
def test_products_do_not_depend_on_their_order(x, y, z):
    """(x y) z = x (y z) = z (y x), and x (y + z) = x y + x z, as normal forms."""
    first = cosines.normal(cosines.product(cosines.product(x, y), z))

    assert first == cosines.normal(cosines.product(x, cosines.product(y, z)))
    assert first == cosines.normal(cosines.product(z, cosines.product(y, x)))
    assert cosines.normal(cosines.product(x, plus(y, z))) == plus(
        cosines.normal(cosines.product(x, y)), cosines.normal(cosines.product(x, z))
    )


@given(acute, st.integers(-3, 3))
def test_powers_have_the_value_of_powers(x, exponent):
    """Negative ones too; times the opposite power they are 1."""
    power = cosines.power(x, exponent)
    with ctx.workprec(200):
        assert (value(cosines.normal(power)) / ball(x) ** exponent - 1).abs_upper() < arb(10) ** -40
    assert cosines.normal(cosines.product(power, cosines.power(x, -exponent))) == {(): 1}


@pytest.mark.parametrize("order", [*range(1, 46), 49, 63, 75, 81, 105])
def test_the_basis_is_no_larger_than_the_field(order):
    """All cosines of multiples of pi/2n need phi(4 n)/2 elements, the degree of the field: so they are independent."""
    found = set()
    for k in range(order):
        found |= set(cosines.normal({Fraction(k, 2 * order): fmpq(1)}))

    assert len(found) == sympy.totient(4 * order) / 2


@pytest.mark.parametrize("p", [2, 3, 5, 7, 11, 13, 17, 19, 101, 103])
def test_gauss_sums_are_square_roots(p):
    """In normal form the sum is sqrt(p) itself, and its square p."""
    assert cosines.normal(cosines.root(p)) == {(p,): 1}
    assert cosines.normal(cosines.product(cosines.root(p), cosines.root(p))) == {(): p}


@given(st.integers(1, 59), st.integers(2, 60), st.sampled_from([cos, sin]))
def test_the_names_that_sympy_gives_are_known(k, n, function):
    """cos and sin of k pi/n as SymPy writes them, nested roots or not, are the cosines they are."""
    x = Rational(k, n)
    turn = x if function is cos else Rational(1, 2) - x
    sign, y = cosines.folded(Fraction(int(turn.p), int(turn.q)))
    difference = of(function(pi * x)) - sum(
        (
            sympy.Rational(int(c.p), int(c.q)) * sympy.Mul(*map(cosines.expression_of, parts))
            for parts, c in cosines.normal({y: fmpq(sign)} if y != cosines.HALF else {}).items()
        ),
        Integer(0),
    )

    assert not difference


# -- equality of series --------------------------------------------------------------------


@pytest.mark.parametrize(
    "zero",
    [
        cos(pi / 7) - cos(2 * pi / 7) + cos(3 * pi / 7) - Rational(1, 2),
        sqrt(7) - 2 * (sin(2 * pi / 7) + sin(4 * pi / 7) - sin(6 * pi / 7)),
        cos(pi / 5) - (1 + sqrt(5)) / 4,
        sin(pi / 5) * sin(2 * pi / 5) - sqrt(5) / 4,
        root(5, 4) ** 2 * sin(pi / 5) * sin(2 * pi / 5) - Rational(5, 4),
        root(5, 4) ** 3 * cos(pi / 10) - root(5, 4) * (2 * cos(pi / 10) - cos(pi / 10) + 2 * cos(3 * pi / 10)),
        2 * cos(pi / 16) ** 2 - 1 - cos(pi / 8),
        8 * cos(pi / 9) ** 3 - 6 * cos(pi / 9) - 1,
        2 * cos(pi / 5) * cos(pi / 7) - cos(12 * pi / 35) - cos(2 * pi / 35),
        1 / (1 + cos(pi / 7)) - (1 - cos(pi / 7)) / sin(pi / 7) ** 2,
        1 / cos(pi / 7) + 4 * cos(2 * pi / 7) - 4 * cos(pi / 7),
        a / (b + cos(pi / 7)) + b / (b - cos(pi / 7)) - (a * (b - cos(pi / 7)) + b * (b + cos(pi / 7)))
        / (b**2 - Rational(1, 2) - cos(2 * pi / 7) / 2),
        root(-1, 7) - cos(pi / 7) - I * sin(pi / 7),
        root(-2, 3) - root(2, 3) * (1 + I * sqrt(3)) / 2,
        cos(t + pi / 20) - cos(pi / 20) * cos(t) + sin(pi / 20) * sin(t),
        cos(t + pi / 7) * cos(t + pi / 5) * 2 - cos(2 * t + 12 * pi / 35) - cos(2 * pi / 35),
    ],
    ids=str,
)
def test_relations_between_cosines_are_known(zero):
    """Minimal polynomials, Gauss sums, half angles, reciprocals, products with roots of every degree."""
    assert not of(zero)
    assert of(zero + Rational(1, 10**40))
    assert of(zero * a) == 0
    assert of(zero + a * t) == of(a * t)


def test_a_frequency_that_is_zero_is_never_divided_by():
    """cos(pi/7) - cos(2 pi/7) + cos(3 pi/7) = 1/2: the sum of the waves stands still."""
    still = cos(pi / 7) - cos(2 * pi / 7) + cos(3 * pi / 7) - Rational(1, 2)

    assert of(cos(still * t)) == 1
    assert of(cos(still * t)).integrate() == of(t)
    rate = cos(pi / 7) + cos(3 * pi / 7)
    square = of(cos(rate * t)) * of(cos((Rational(1, 2) + cos(2 * pi / 7)) * t))
    assert square.integrate() == of(t / 2 + sin(2 * rate * t) / (4 * rate))


def test_the_reciprocal_of_a_hidden_zero_is_refused():
    """The sum of three cosines is 1/2."""
    zero = cos(pi / 7) - cos(2 * pi / 7) + cos(3 * pi / 7) - Rational(1, 2)
    with pytest.raises(BadInputError):
        of(1 / zero)


def test_periods_cancel_frequencies_that_are_cosines():
    """cos(3 pi/7) is a sum of three numbers of the basis: over its period the angle makes one turn."""
    rate = cos(3 * pi / 7)
    F = FloquetMatrix(Matrix([[0, 1], [-a * cos(rate * t), 0]]), t, 2, 2 * pi / rate)

    assert of(F.trace()) == 2
    with pytest.raises(NotPeriodicError):
        FloquetMatrix(Matrix([[cos(rate * t)]]), t, 2, pi / rate)
