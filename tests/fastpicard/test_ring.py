"""Exact coefficients: Laurent polynomials with roots, and the zero test that knows their relations."""

import pytest
import sympy
from hypothesis import given, strategies as st
from sympy import I, Rational, Symbol, cbrt, pi, root, sqrt

from fastpicard import BadInputError, PoissonSeries, ring
from tests.conftest import in_threads
from tests.strategies import a, b, c, g, l, rationals, t

atoms = st.sampled_from([a, b, 1 / a, sqrt(2), sqrt(3), sqrt(6), cbrt(4), pi, I, sqrt(a), g / l])
constants = st.lists(st.builds(lambda x, y, z: x * y * z, rationals, atoms, atoms), max_size=3).map(
    lambda found: sympy.Add(*found)
)


def of(expression):
    """The coefficient as a series without time."""
    return PoissonSeries(expression, t)


@given(constants, constants)
def test_coefficients_multiply_as_sympy_multiplies(x, y):
    """sqrt(2) sqrt(6) = 2 sqrt(3), 4**(1/3) 4**(1/3) = 2 2**(1/3), I I = -1: expanded, both are one expression."""
    assert of(x * y) == of(x) * of(y) == of(sympy.expand(x * y))
    assert sympy.expand((of(x) * of(y)).as_expr() - x * y) == 0


@given(
    st.lists(
        st.tuples(st.sampled_from([1, sqrt(2), sqrt(3), sqrt(6), sqrt(5)]), st.integers(-4, 4)), min_size=1, max_size=4
    )
)
def test_the_reciprocal_of_a_sum_of_square_roots_is_one_too(terms):
    """1/(x + y sqrt(2) + ...) is rationalised: times the sum it is 1, identically."""
    total = sympy.Add(*(x * k for x, k in terms))
    if total:
        assert of(1 / total) * of(total) == 1


@pytest.mark.parametrize(
    "denominator", [b + c, a**2 - b, 2 * a + 2 * b, a + sqrt(2), 1 + a * b * c, (a + b) * (a - b), a + pi], ids=str
)
def test_reciprocals_of_sums_cancel_against_them(denominator):
    """x/x = 1 and 1/x - 1/x = 0 where x is a sum of parameters."""
    assert of(1 / denominator) * of(denominator) == 1
    assert not of(a / denominator) - of(1 / denominator) * a
    assert of(1 / denominator**2) == of(1 / denominator) ** 2
    assert of(1 / denominator) != of(2 / denominator)


@pytest.mark.parametrize("names", ["first_x first_y", "then_y then_x"])
def test_reciprocals_come_back_as_they_went_whichever_symbol_was_met_first(names):
    """1/(2 x + 3 y), 1/(x - 2 y) and 1/(x**2 - 1) themselves; of others the multiple that has no common factor."""
    met = [Symbol(name) for name in names.split()]
    for symbol in met:
        of(symbol)
    x, y = sorted(met, key=lambda symbol: str(symbol)[-1])

    for e in (1 / (2 * x + 3 * y), 1 / (x - 2 * y), 1 / (x**2 - 1), sympy.pi / (x + y)):
        assert of(e).as_expr() == e
    assert of(1 / (2 * y - x)).as_expr() == -1 / (x - 2 * y)
    assert of(1 / (x / 2 - y / 3)).as_expr() == 6 / (3 * x - 2 * y)
    assert of(1 / (4 * x + 6 * y)).as_expr() == Rational(1, 2) / (2 * x + 3 * y)


def test_the_reciprocal_of_nothing_does_not_exist():
    """1/0 is refused, also where the zero is hidden."""
    with pytest.raises(BadInputError):
        ring.reciprocal({})
    with pytest.raises(BadInputError):
        of(sympy.Pow(sqrt(2) * sqrt(3) - sqrt(6), -1, evaluate=False))


@pytest.mark.parametrize(
    "zero",
    [
        sqrt(6) - sqrt(2) * sqrt(3),
        root(8, 3) - 2,
        (1 + sqrt(2)) * (sqrt(2) - 1) - 1,
        a / (a + b) + b / (a + b) - 1,
        1 / (a - b) + 1 / (b - a),
        sqrt(a) ** 2 - a,
        (a + b) ** 2 / (a + b) - a - b,
        sqrt(Rational(1, 2)) - sqrt(2) / 2,
        1 / sqrt(3) - sqrt(3) / 3,
        I**3 + I,
        sympy.cos(a) ** 2 + sympy.sin(a) ** 2 - 1,
        sympy.sin(2 * a) - 2 * sympy.sin(a) * sympy.cos(a),
        sympy.cosh(a) ** 2 - sympy.sinh(a) ** 2 - 1,
        sympy.log(6) - sympy.log(2) - sympy.log(3),
        cbrt(2 + sqrt(5)) - (1 + sqrt(5)) / 2,
        a / (b + cbrt(2)) * (b + cbrt(2)) / a - 1,
    ],
    ids=str,
)
def test_what_is_zero_is_known_to_be_zero(zero):
    """With roots, quotients, the imaginary unit and phases."""
    assert not of(zero)
    assert of(zero) == 0
    assert hash(of(zero) + of(1 / (a + b))) == hash(of(1 / (a + b)))


def test_threads_that_meet_the_same_symbols_first_give_each_a_number_of_its_own():
    """Four threads, interrupted often, and two hundred new symbols."""
    for attempt in range(5):
        symbols = [Symbol(f"new{attempt}_{k}") for k in range(200)]
        found = in_threads(lambda _, of=symbols: [ring.generator(s) for s in of], range(4))

        assert found[0] == found[1] == found[2] == found[3]
        assert [ring.expression_of(k) for k in found[0]] == symbols


def test_negative_bases_keep_their_sign():
    """(-2)**(1/2) = I sqrt(2), -sqrt(2) is not sqrt(2), (-8)**(1/3) stays SymPy's principal root."""
    assert of(sqrt(-2) * sqrt(-2)) == -2
    assert of(-sqrt(2)) != of(sqrt(2))
    assert of(root(-8, 3)).as_expr().equals(root(-8, 3))


def test_a_symbol_positive_or_not_gives_what_sympy_gives():
    """sqrt(x**2) is x for positive x only."""
    x, p = Symbol("x"), Symbol("p", positive=True)

    assert of(sqrt(p**2)) == of(p)
    assert of(sqrt(x**2)) != of(x)
