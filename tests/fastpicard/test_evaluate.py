"""Numbers from exact results: every digit asked for, and refusal where there is none."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy
from flint import arb, ctx
from hypothesis import given, strategies as st
from sympy import Matrix, Rational, Symbol, cos, exp, pi, sin, sqrt

from fastpicard import BadInputError, BadTypeError, FloquetMatrix, FundamentalMatrix, PoissonSeries, fast_picard
from fastpicard.evaluate import upper_float
from tests.oracles import closeness
from tests.strategies import a, b, phi, t, w


@given(st.floats(-50, 50), st.floats(-3, 3), st.integers(1, 60))
def test_values_at_floats_are_values_at_the_dyadic_numbers_they_are(time, value, digits):
    """The series at a float is the series at its exact fraction, to every digit."""
    f = PoissonSeries(a * t * cos(w * t + 1) + a**2, t)
    exact = {a: Rational(*value.as_integer_ratio()), w: 2}

    assert f.evaluate(time, {a: value, w: 2}, digits) == f.evaluate(Rational(*time.as_integer_ratio()), exact, digits)


@given(st.integers(0, 60), st.fractions(-5, 5, max_denominator=50), st.integers(1, 40))
def test_sums_that_cancel_keep_every_digit(n, x, digits):
    """The sections of exp(-30 x ...) written as powers: terms larger than the sum by many orders."""
    section = sympy.Add(*(Rational((-30) ** k, sympy.factorial(k)) * t**k for k in range(n + 1)))
    exact = section.subs(t, Rational(x))

    found = PoissonSeries(section, t).evaluate(x, {}, digits)
    with mpmath.workdps(120):
        truth = mpmath.mpf(int(exact.p)) / int(exact.q)
        assert abs(found - truth) <= abs(truth) * mpmath.mpf(10) ** (1 - digits)


@given(st.integers(1, 300))
def test_digits_are_the_beginning_of_one_number(digits):
    """cos(1) to any number of digits."""
    found = PoissonSeries(cos(t), t).evaluate(1, {}, digits)

    with mpmath.workdps(320):
        assert abs(found / mpmath.cos(1) - 1) <= mpmath.mpf(10) ** (1 - digits)


@pytest.mark.parametrize(
    "expression",
    [
        cos(phi) * t,
        exp(phi),
        sympy.log(2 + phi),
        sympy.tan(phi),
        sympy.atan(phi),
        sympy.sinh(phi),
        sympy.cosh(phi),
        sympy.tanh(phi),
        sympy.Abs(-phi),
        sympy.asin(phi),
        sympy.acos(phi),
        sympy.E**phi,
        sympy.E + t,
        2**phi,
        phi ** Rational(2, 3),
        phi ** -Rational(1, 2),
        sqrt(1 + phi),
        sympy.GoldenRatio * t,
        sympy.EulerGamma,
        sympy.Catalan,
    ],
    ids=str,
)
def test_functions_of_parameters_have_values_in_balls(expression):
    """Coefficients may hold them; thirty digits against SymPy, or a refusal that names the function."""
    f = PoissonSeries(expression, t)
    try:
        found = f.evaluate(1, {phi: Rational(2, 5)}, 30)
    except BadInputError as error:
        assert "no rigorous value" in str(error)
        return

    assert closeness(found, str(sympy.N(expression.subs({phi: Rational(2, 5), t: 1}), 40))) < mpmath.mpf(10) ** -29


def test_an_exact_zero_is_zero_and_not_an_endless_search():
    """sin(pi) and cos(pi/2) are computed in balls that contain 0 however small."""
    assert PoissonSeries(sin(t), t).evaluate(pi) == 0
    assert PoissonSeries(cos(t), t).evaluate(pi / 2, {}, 50) == 0
    assert PoissonSeries(a - b, t).evaluate(1, {a: sqrt(2), b: 1 / sqrt(2) * 2}) == 0


def test_balls_with_a_radius_give_no_digits_beyond_it():
    """A parameter known to 3 digits cannot give 15."""
    with pytest.raises(BadInputError, match="digits"):
        PoissonSeries(a * t, t).evaluate(1, {a: arb(1, 1e-3)})
    assert PoissonSeries(a * t, t).evaluate(2, {a: arb(0.75)}) == 1.5


def test_the_global_precision_of_others_neither_matters_nor_changes():
    """mpmath's and flint's own precision stay what they were and change no digit."""
    f = PoissonSeries(cos(t) / 3, t)
    expected = f.evaluate(1, {}, 40)
    with mpmath.workdps(5), ctx.workprec(20):
        assert f.evaluate(1, {}, 40) == expected
        assert (mpmath.mp.dps, ctx.prec) == (5, 20)


def test_floats_lose_nothing_where_terms_exceed_the_sum_by_twenty_digits():
    """Order 40 at t = 1/2, (a, b) = (5/2, 3/2): term by term in floats no digit is right; here all are."""
    Phi = FundamentalMatrix(sympy.Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 40)[0, 0]
    values = {a: Rational(5, 2), b: Rational(3, 2)}

    assert Phi.evaluate(0.5, values) == float(Phi.evaluate(Rational(1, 2), values, 40))
    assert 0.5 < Phi.evaluate(0.5, values) < 0.7


@pytest.mark.parametrize(
    "value, kind", [(1e300, float), (1e-300, float), (5e-324, float), (-0.0, float), (2**1023, int)]
)
def test_floats_at_the_ends_of_their_range_go_through(value, kind):
    """The largest, the smallest and the denormal ones; zero has one sign."""
    assert PoissonSeries(a, t).evaluate(0, {a: value}) == kind(value)
    assert isinstance(PoissonSeries(a, t).evaluate(0, {a: value}), float)


def test_results_have_the_types_promised():
    """float and mpf; arrays and mpmath matrices."""
    Phi = FundamentalMatrix([[cos(t)]], t, 2)

    assert type(PoissonSeries(t, t).evaluate(1)) is float
    assert isinstance(PoissonSeries(t, t).evaluate(1, {}, 20), mpmath.mpf)
    assert (
        isinstance(Phi.evaluate(1), np.ndarray) and Phi.evaluate(1).dtype == float and Phi.evaluate(1).shape == (1, 1)
    )
    assert isinstance(Phi.evaluate(1, {}, 20), mpmath.matrix)


@pytest.mark.parametrize("name", ["a", "lambda", "x y", "1", "", "__class__", "\\omega"])
def test_parameters_with_strange_names_have_values_too(name):
    """A name is only a name."""
    p = Symbol(name)

    assert PoissonSeries(p * t, t).evaluate(2, {p: 3}) == 6


@pytest.mark.parametrize("constant", [pi, sympy.E, sympy.GoldenRatio, sympy.Catalan, sympy.EulerGamma], ids=str)
def test_known_constants_have_every_digit(constant):
    """As SymPy gives them, fifty digits and more."""
    found = PoissonSeries(constant * cos(t), t).evaluate(0, digits=60)

    with mpmath.workdps(80):
        assert abs(found - mpmath.mpf(constant.evalf(80)._mpf_)) < mpmath.mpf(10) ** -59


CONSTANTS = pytest.mark.parametrize(("constant", "exact"), [
    (mpmath.pi, pi), (mpmath.e, sympy.E), (mpmath.euler, sympy.EulerGamma), (mpmath.catalan, sympy.Catalan),
    (mpmath.phi, sympy.GoldenRatio), (mpmath.degree, pi / 180), (mpmath.ln2, sympy.log(2)),
    (mpmath.ln10, sympy.log(10))], ids=str)


@CONSTANTS
def test_constants_of_mpmath_are_those_numbers_at_any_precision(constant, exact):
    """Not their roundings at the precision that mpmath happens to have."""
    found = PoissonSeries(a * cos(t), t).evaluate(0, {a: constant}, digits=60)

    with mpmath.workdps(80):
        assert abs(found - mpmath.mpf(exact.evalf(80)._mpf_)) < mpmath.mpf(10) ** -59


@CONSTANTS
def test_constants_of_mpmath_are_read_as_those_numbers(constant, exact):
    """As times, origins, initial values, entries, periods, factors and operands: equal to SymPy's, not near."""
    P, Q = [[a * cos(t), constant], [1, 0]], [[a * cos(t), exact], [1, 0]]
    found, expected = fast_picard(P, t, [1, constant], 3, constant), fast_picard(Q, t, [1, exact], 3, exact)

    assert found.as_matrix() == expected.as_matrix()
    assert found(constant) == expected(exact) == expected(constant) and found.P(constant) == expected.P(exact)
    traces = [FloquetMatrix([[0, 1], [-a, 0]], t, 3, period).trace() for period in (constant, exact)]
    assert traces[0] == traces[1]
    f = PoissonSeries(cos(t), t)
    assert (f * constant + constant, f / constant, f.scale(constant)) == (f * exact + exact, f / exact, f.scale(exact))


def test_constants_of_mpmath_without_a_name_here_are_refused():
    """A rounding would have no digits beyond its own; as a value, a time and an entry."""
    f = PoissonSeries(a * cos(t), t)

    for refused in (lambda: f.evaluate(0, {a: mpmath.apery}), lambda: f(mpmath.apery), lambda: f + mpmath.apery,
                    lambda: fast_picard([[mpmath.apery]], t, [1], 2)):
        with pytest.raises(BadTypeError, match="Apery"):
            refused()


@pytest.mark.parametrize("constant", [sympy.zeta(3), sympy.TribonacciConstant], ids=str)
def test_constants_without_balls_are_refused_by_name(constant):
    """The sentence speaks of the constant, not of a class."""
    with pytest.raises(BadInputError, match=r"no rigorous value of (zeta\(3\)|\w+) is known: \w+ has no ball"):
        PoissonSeries(constant * cos(t), t).evaluate(1)


@pytest.mark.parametrize("base", [-1, -2, Rational(-3, 2), 3])
@pytest.mark.parametrize("k", [-3, 0, 2, 5])
def test_a_power_of_a_negative_number_has_a_value_where_its_exponent_is_an_integer(base, k):
    """(-2)**k, and (-2)**a at an a that happens to be one; at 1/2 it is not real."""
    n = Symbol("n", integer=True)

    for exponent in (n, a):
        assert PoissonSeries(Rational(base) ** exponent * t, t).evaluate(1, {exponent: k}) == float(Rational(base) ** k)


@pytest.mark.parametrize("value", [10**400, Fraction(10**400, 3), Fraction(3, 10**400), -(10**400)],
                         ids=["large", "large fraction", "small fraction", "large and negative"])
def test_integers_and_fractions_have_no_largest_one(value):
    """They are exact, and need not pass through a float."""
    with mpmath.workdps(30):
        expected = mpmath.mpf(value.numerator) / value.denominator
        assert abs(PoissonSeries(a * t, t).evaluate(1, {a: value}, 20) / expected - 1) < 1e-19


@pytest.mark.parametrize("constant", [sympy.Product(1 + a / b**2, (b, 1, 3)), sympy.Sum(a / b**2, (b, 1, 3))])
def test_what_binds_a_symbol_is_refused_by_its_own_name(constant):
    """The bound b is no parameter, and has no value."""
    with pytest.raises(BadInputError, match=f"{type(constant).__name__} has no ball arithmetic here"):
        PoissonSeries(constant * t, t).evaluate(1, {a: 2})


midpoints = st.builds(lambda n, least: n + least + Fraction(1, 2), st.integers(0, 2**52), st.sampled_from([0, 2**52]))
ends = st.sampled_from([-1074, -1073, 0, 970, 971])
halves = st.builds(lambda sign, middle, e, rest, bits: sign * (middle + Fraction(rest, 2**bits)) * Fraction(2) ** e,
                   st.sampled_from([1, -1]), midpoints, ends | st.integers(-1074, 971), st.integers(-3, 3),
                   st.integers(1, 300))  # fmt: skip


def nearest(x):
    """The float nearest to a fraction, by Python; infinite beyond the largest."""
    try:
        return float(x)
    except OverflowError:
        return np.inf if x > 0 else -np.inf


@given(halves)
def test_floats_are_the_nearest_ones_however_near_the_middle_of_two(x):
    """Near ties, normal, denormal and at the end of the range: 1 + (x - 1), whose digits are not all in 120 bits."""
    assert fast_picard(Matrix([[0]]), t, [a], 0).evaluate(0, {a: x})[0, 0] == nearest(x)
    assert FundamentalMatrix(Matrix([[a]]), t, 1).evaluate(1, {a: x - 1})[0, 0] == nearest(x)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("x", "value"), [
    (1 + Fraction(1, 2**53) + Fraction(1, 2**130), 1 + 2.0**-52),
    (1 + Fraction(1, 2**53) + Fraction(1, 2**3000), 1 + 2.0**-52),
    (1 + Fraction(1, 2**53) - Fraction(1, 2**3000), 1.0),
    (Fraction(5, 2) / 2**1074 * (1 + Fraction(1, 2**60)), 15e-324),
    (Fraction(1, 2**1075), 0.0),
    (Fraction(1, 2**1075) * (1 + Fraction(1, 2**200)), 5e-324),
    (Fraction(2**1024 - 2**970), np.inf),
    (Fraction(2**1024 - 2**970) - Fraction(1, 3), 2.0**1023 * (2 - 2.0**-52)),
], ids=["above a tie", "just above", "just below", "denormal", "tie with 0", "above it", "overflow", "no overflow"])
def test_values_beside_the_middle_of_two_floats_are_on_their_side(x, value, sign):
    """As long as 4096 bits tell; denormals are not rounded to 53 bits first."""
    assert fast_picard(Matrix([[0]]), t, [a], 0).evaluate(0, {a: sign * x})[0, 0] == sign * value
    assert FundamentalMatrix(Matrix([[a]]), t, 1).evaluate(1, {a: sign * x - 1})[0, 0] == sign * value


def test_a_value_in_the_middle_of_two_floats_that_no_precision_shows_is_one_of_them():
    """sqrt(2)**2 (1 + 2**-53)/2 as a product of balls: the search ends, and both floats are as near."""
    halfway = Rational(2**53 + 1, 2**53)

    assert PoissonSeries(a * b * t, t).evaluate(1, {a: sqrt(2) * halfway, b: sqrt(2) / 2}) in (1.0, 1 + 2.0**-52)


@given(halves)
def test_upper_floats_are_the_least_above(x):
    """Denormals too; beyond all floats it is infinite, and below all of them the least."""
    with ctx.workprec(3000):
        found = upper_float(arb(x.numerator) / x.denominator)
    assert found == np.inf or Fraction(found) >= x
    below = np.nextafter(found, -np.inf)
    assert np.isinf(below) or Fraction(float(below)) < x


LAGUERRE = b**3 - 9 * b**2 + 18 * b - 6  # the squares of the frequencies of three hanging bobs
CLOSE = b**3 - 3 * b + 2 - Rational(1, 10**40)


@pytest.mark.parametrize("polynomial", [LAGUERRE, 3 * b**4 - 7 * b + 1, CLOSE], ids=str)
def test_roots_of_polynomials_have_every_digit(polynomial):
    """Each real CRootOf against mpmath's roots; two of CLOSE are equal as floats."""
    with mpmath.workdps(90):
        coefficients = [mpmath.mpf(int(x.p)) / int(x.q) for x in sympy.Poly(polynomial, b).all_coeffs()]
        roots = mpmath.polyroots(coefficients, maxsteps=500, extraprec=800)
        real = sorted(mpmath.re(x) for x in roots if abs(mpmath.im(x)) < mpmath.mpf(10) ** -60)
        assert len(real) == sympy.Poly(polynomial, b).count_roots()
        for i, root in enumerate(real):
            found = PoissonSeries(sympy.CRootOf(polynomial, i) * t, t).evaluate(1, {}, 50)
            assert abs(found - root) <= abs(root) * mpmath.mpf(10) ** -49


def test_roots_of_polynomials_are_values_of_parameters():
    """As a value, inside a function and in P alike: sin(r) = 2 sin(r/2) cos(r/2)."""
    root = sympy.CRootOf(LAGUERRE, 1)
    twice = PoissonSeries(2 * sin(root / 2) * cos(root / 2) * t, t)

    assert PoissonSeries(sin(a) * t, t).evaluate(1, {a: root}, 40) == twice.evaluate(1, {}, 40)


def test_roots_that_are_not_real_are_refused():
    """b**5 - b - 1 has one real root, which SymPy counts first."""
    with pytest.raises(BadInputError, match="real roots of its polynomial are those with an index below 1"):
        PoissonSeries(sympy.CRootOf(b**5 - b - 1, 1) * t, t).evaluate(1, {})
