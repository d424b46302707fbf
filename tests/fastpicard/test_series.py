"""Poisson series: laws of a commutative differential ring, equality, values and pickles."""

import pickle
from decimal import Decimal
from fractions import Fraction

import mpmath
import pytest
import sympy
from hypothesis import given, strategies as st
from sympy import I, Matrix, Rational, S, Symbol, acos, asin, atan, atan2, cos, cosh, exp, pi, sin, sinh, sqrt, tan

from fastpicard import FloquetMatrix, PoissonSeries, new_integrate, product_to_sum
from tests.oracles import closeness, value_by_sympy, vanishes
from tests.strategies import (
    VALUES,
    a,
    b,
    c,
    expressions,
    modes,
    nonzero_rationals,
    phi,
    plain_constants,
    plain_expressions,
    plain_frequencies,
    plain_times,
    rationals,
    short_expressions,
    single_modes,
    sums,
    t,
    w,
)


def of(expression):
    """The series of an expression in t."""
    return PoissonSeries(expression, t)


series = expressions.map(of)
short = short_expressions.map(of)
single = single_modes.map(of)
plain_short = sums(modes(plain_constants, plain_frequencies, st.just(S.Zero)), most=2).map(of)
zero, one = of(0), of(1)


# -- ring ------------------------------------------------------------------------


@given(series, series, series)
def test_addition_is_associative_and_commutative(f, g, h):
    """(f + g) + h = f + (g + h), f + g = g + f, f + 0 = f, f - f = 0."""
    assert (f + g) + h == f + (g + h)
    assert f + g == g + f
    assert f + 0 == f
    assert not f - f


@given(series, series)
def test_multiplication_is_commutative_with_one(f, g):
    """f g = g f, 1 f = f, 0 f = 0."""
    assert f * g == g * f
    assert f * 1 == f
    assert f * zero == zero


@given(short, short, short)
def test_multiplication_is_associative(f, g, h):
    """(f g) h = f (g h): product to sum in either order."""
    assert (f * g) * h == f * (g * h)


@given(single, series, series)
def test_multiplication_distributes_over_addition(f, g, h):
    """f (g + h) = f g + f h."""
    assert f * (g + h) == f * g + f * h


@given(short_expressions, short_expressions)
def test_reading_is_a_homomorphism(x, y):
    """The series of a product or sum of expressions is that of the series, whichever side multiplies."""
    assert of(x * y) == of(x) * of(y)
    assert of(x + y) == of(x) + of(y)
    assert of(x) - y == of(x - y) == x - of(y)


@given(short, short)
def test_equal_series_have_equal_hashes_whatever_made_them(f, g):
    """f g and g f, f + g and g + f are one value, also as keys."""
    assert hash(f * g) == hash(g * f)
    assert hash(f + g) == hash(g + f)
    assert len({f * g, g * f}) == 1
    assert (f == g) == (not f - g)


KNOWN_PHASES = [  # SymPy writes their cosines otherwise
    (cos(t + atan(2)), (cos(t) - 2 * sin(t)) / sqrt(5)),
    (cos(t + acos(Rational(1, 3))), cos(t) / 3 - 2 * sqrt(2) / 3 * sin(t)),
    (cos(t + atan(a)), (cos(t) - a * sin(t)) / sqrt(1 + a**2)),
    (cos(w * t + asin(a)), cos(w * t) * sqrt(1 - a**2) - a * sin(w * t)),
    (t * cos(t + atan2(b, a)), t * (a * cos(t) - b * sin(t)) / sqrt(a**2 + b**2)),
    (cos(t + 2 * atan(2) + phi), (-3 * cos(t + phi) - 4 * sin(t + phi)) / 5),
    (cos(t + atan(a) + phi), (cos(t + phi) - a * sin(t + phi)) / sqrt(1 + a**2)),
    (cos(t + atan(2) + atan(Rational(1, 2))), -sin(t)),
    (cos(t + atan(a) + a * phi / (a + b) + b * phi / (a + b)), cos(t + atan(a) + phi)),
    ((cos(t + phi) * cos(t + atan(2))) ** 2, (cos(t + phi) * (cos(t) - 2 * sin(t))) ** 2 / 5),
    (cos(t + I * a), cos(t) * cosh(a) - I * sin(t) * sinh(a)),
]


@pytest.mark.parametrize(
    "left, right",
    [
        (b / (b + c) + c / (b + c), S.One),
        (8 * cos(pi / 7) ** 3 * cos(t), (4 * cos(pi / 7) ** 2 + 4 * cos(pi / 7) - 1) * cos(t)),
        (cos(t + pi / 5) / cos(pi / 5), cos(t) - (sqrt(5) - 1) * sin(pi / 5) * sin(t)),
        (cos(t * (cos(pi / 7) - cos(2 * pi / 7) + cos(3 * pi / 7))), cos(t / 2)),
        (t / sqrt(a + b), sqrt(a + b) * t / (a + b)),
        (cos(t * a / (a + b) + t * b / (a + b)), cos(t)),
        (cos(t + phi) / cos(phi), cos(t) - tan(phi) * sin(t)),
        *KNOWN_PHASES,
    ],
    ids=str,
)
def test_equal_series_have_equal_hashes_where_parameters_are_related(left, right):
    """One side may show relations that the other does not: they are one key all the same."""
    assert of(left) == of(right)
    assert {of(left): "found"}[of(right)] == "found"


@given(series, rationals, rationals)
def test_scaling_is_multiplication_by_a_constant(f, x, y):
    """(x + y) f = x f + y f; scale(x) = x f."""
    assert f.scale(x) + f.scale(y) == f.scale(x + y)
    assert f.scale(x) == f * x == x * f
    assert f.scale(a / b) == a / b * f


@given(short)
def test_powers_are_repeated_products(f):
    """f**0 = 1, f**2 = f f."""
    assert f**0 == one
    assert f**1 == f
    assert f**2 == f * f


# -- calculus ----------------------------------------------------------------------


@given(series, series)
def test_the_derivative_is_linear_and_obeys_the_product_rule(f, g):
    """(f + g)' = f' + g', (f g)' = f' g + f g'."""
    assert (f + g).diff() == f.diff() + g.diff()
    assert (f * g).diff() == f.diff() * g + f * g.diff()


@given(expressions)
def test_the_derivative_is_sympys(x):
    """SymPy differentiates the same expression to the same series."""
    assert of(x).diff() == of(sympy.diff(x, t))


@given(series)
def test_the_derivative_undoes_the_integral(f):
    """d/dt I[f] = f."""
    assert f.integrate().diff() == f


@given(series)
def test_the_integral_undoes_the_derivative_but_for_the_value_at_0(f):
    """I[f'] = f - f(0)."""
    assert f.diff().integrate() == f - f(0)


@given(series)
def test_the_integral_is_zero_at_0(f):
    """I[f](0) = 0: exactly, as a series."""
    assert not of(f.integrate()(0))


@given(series, series, rationals, rationals)
def test_the_integral_is_linear(f, g, x, y):
    """I[x f + y g] = x I[f] + y I[g]; equality, not closeness."""
    assert (f.scale(x) + g.scale(y)).integrate() == f.integrate().scale(x) + g.integrate().scale(y)


@given(single, single)
def test_integration_by_parts(f, g):
    """I[f g'] = f g - f(0) g(0) - I[f' g]."""
    assert (f * g.diff()).integrate() == f * g - of(f(0)) * of(g(0)) - (f.diff() * g).integrate()


# -- SymPy and back ------------------------------------------------------------------


@given(expressions)
def test_series_come_back_from_sympy_as_they_went(x):
    """PoissonSeries(f.as_expr()) = f, and the expression means what was read."""
    f = of(x)

    assert of(f.as_expr()) == f
    assert sympy.sympify(f) == f.as_expr()


@given(single_modes, plain_times)
def test_the_expression_has_the_value_of_what_was_read(x, time):
    """Forty digits of both at one time and set of parameters, through SymPy alone."""
    at = {t: time, **VALUES}

    assert abs(value_by_sympy(of(x).as_expr(), at) - value_by_sympy(x, at)) < Rational(1, 10**30)


@given(series)
def test_pickles_come_back_equal(f):
    """A series survives the way to another process."""
    again = pickle.loads(pickle.dumps(f))

    assert again == f
    assert again.t == f.t


# -- values --------------------------------------------------------------------------


@given(short_expressions, plain_times)
def test_digits_agree_with_evalf(x, time):
    """Thirty digits asked for, thirty digits as SymPy computes them."""
    f = of(x)
    expected = value_by_sympy(x, {t: time, **VALUES}, 45)

    assert closeness(f.evaluate(time, VALUES, 30), str(expected)) < mpmath.mpf(10) ** -29


@given(expressions, plain_times)
def test_floats_are_the_rounded_digits(x, time):
    """digits=None is the float nearest to the exact value."""
    f = of(x)

    assert f.evaluate(time, VALUES) == float(f.evaluate(time, VALUES, 40))


@given(plain_expressions, plain_times)
def test_the_value_at_a_time_is_substitution(x, time):
    """f(time) is the expression with the time put in; at 0 and at t itself too."""
    f = of(x)

    difference = f(time) - x.xreplace({t: sympy.sympify(time)})
    assert sympy.expand(difference) == 0 or vanishes(difference)
    assert f(t) == f.as_expr()


@given(series, nonzero_rationals)
def test_shifting_the_time_forth_and_back_changes_nothing(f, by):
    """f(t + s) as a series, read again and shifted by -s."""
    assert of(of(f(t + by))(t - by)) == f


# -- examples ------------------------------------------------------------------------


@pytest.mark.parametrize(
    "left, right",
    [
        (cos(t) ** 2 + sin(t) ** 2, 1),
        (exp(I * t) + exp(-I * t), 2 * cos(t)),
        ((exp(I * t) - exp(-I * t)) / (2 * I), sin(t)),
        (exp(I * (w * t + phi)) * exp(-I * w * t), cos(phi) + I * sin(phi)),
        (cos(t + pi / 2), -sin(t)),
        (sin(t - pi / 3), sin(t) / 2 - sqrt(3) * cos(t) / 2),
        (cos(-3 * t + phi), cos(3 * t - phi)),
        (sin(phi - w * t), -sin(w * t - phi)),
        (cos((w - 1) * t) - cos(t - w * t), 0),
        (cos(t * (1 + w)), cos(t) * cos(w * t) - sin(t) * sin(w * t)),
        (sin(2 * (t + phi)), 2 * sin(t + phi) * cos(t + phi)),
        (sqrt(2) * sqrt(6) * cos(t), 2 * sqrt(3) * cos(t)),
        (cos(sqrt(2) * t) * cos(sqrt(8) * t), cos(sqrt(2) * t) / 2 + cos(3 * sqrt(2) * t) / 2),
        ((b + c) / (b + c) * t, t),
        (t / (b + c) - t / (c + b), 0),
        (b * t / (b + c) + c * t / (b + c), t),
        (1 / (1 + sqrt(2)) * cos(t), (sqrt(2) - 1) * cos(t)),
        ((a + b * cos(t)) ** 3, sympy.expand((a + b * cos(t)) ** 3)),
        (t**2 * t**3 / t**0, t**5),
        (S(0.5) * cos(t), cos(t) / 2),
        (cos(0.1 * t), cos(Rational(0.1) * t)),
        (cos(t + 2 * pi), cos(t)),
        (sin(7 * pi / 2 - t), -cos(t)),
        (cos(t * a / (a + b) + t * b / (a + b)), cos(t)),
        (t * sin(t * b / (a - b) - t * a / (a - b)), -t * sin(t)),
        (sin(t + a * phi / (a + b) + b * phi / (a + b)), sin(t + phi)),
        (cos(t * (a**2 - b**2) / (a - b)), cos((a + b) * t)),
        (cos(t * exp(a) * exp(b)), cos(t * exp(a + b))),
        (cos(sympy.GoldenRatio * t), cos((1 + sqrt(5)) / 2 * t)),
        (cos(t) * cos(phi) * (1 / cos(phi)), cos(t)),
        (tan(phi) * cos(phi) * t, sin(phi) * t),
        (tan(1) * cos(1), sin(1)),
        (cos(t * exp(1000 * a) * exp(b)), cos(t * exp(1000 * a + b))),
        (cos(t + phi) / cos(phi), cos(t) - tan(phi) * sin(t)),
        *KNOWN_PHASES,
    ],
    ids=str,
)
def test_equal_expressions_are_equal_series(left, right):
    """Identities that ``==`` must see, for it is mathematical equality."""
    assert of(left) == of(right)
    assert of(left) == right
    assert not of(left) - of(right)


@pytest.mark.parametrize(
    "left, right",
    [
        (cos(t), sin(t)),
        (cos(t), cos(2 * t)),
        (a, b),
        (cos(w * t), cos(t)),
        (S(0.1), Rational(1, 10)),
        (t, t**2),
        (sqrt(2) * t, sqrt(3) * t),
        (cos(t + phi), cos(t)),
        (1 / (b + c), 1 / (b - c)),
        (cos(t * a / (a + b) + 2 * t * b / (a + b)), cos(t)),
        (sin(t * b / (a - b) - t * a / (a - b)), sin(t)),
        (cos(t * exp(a) * exp(b)), cos(t * exp(a - b))),
        (tan(phi) * cos(phi) * t, cos(phi) * t),
        (cos(t + atan(2)), (cos(t) + 2 * sin(t)) / sqrt(5)),
        (cos(t + atan(2)), cos(t + atan(3))),
        (cos(t + atan(a)), (cos(t) - b * sin(t)) / sqrt(1 + a**2)),
        (cos(t + asin(a)), cos(t) * sqrt(1 - a**2) + a * sin(t)),
        (cos(t + 2 * atan(2) + phi), (3 * cos(t + phi) - 4 * sin(t + phi)) / 5),
        (cos(t + atan(2) + phi), cos(t + atan(2))),
        (cos(t + I * a), cos(t) * cosh(a) + I * sin(t) * sinh(a)),
    ],
    ids=str,
)
def test_different_expressions_are_different_series(left, right):
    """And ``==`` says no where the functions differ, be it by a rounding error."""
    assert of(left) != of(right)
    assert of(left) - right


def test_series_are_immutable():
    """The modes one gets are a copy."""
    f = of(cos(t))
    f.modes.clear()

    assert f == of(cos(t))
    with pytest.raises(AttributeError):
        f.t = a


def test_parameters_are_all_symbols_but_the_time():
    """In coefficients, frequencies and phases."""
    assert of(a * t * cos(w * t + phi) / (b + c)).free_symbols == {a, w, phi, b, c}
    assert of(3 * t).free_symbols == set()


def test_a_series_scales_a_matrix_as_the_expression_it_is():
    """From either side."""
    assert of(cos(t)) * Matrix([a, t]) == Matrix([a, t]) * of(cos(t)) == Matrix([a * cos(t), t * cos(t)])


def test_printing_is_short_where_the_series_is_long():
    """A few terms are shown, many are counted; LaTeX likewise."""
    long = of(sum(Symbol(f"a{k}") * cos(k * t) for k in range(1, 80)))

    assert repr(of(a * cos(t) + t)) == "PoissonSeries(a*cos(t) + t, t)"
    assert str(of(a * cos(t) + t)) == "a*cos(t) + t"
    assert "79 terms" in repr(long) and len(repr(long)) < 100
    assert of(cos(t))._repr_latex_() == r"$\displaystyle \cos{\left(t \right)}$"
    assert "79 terms" in long._repr_latex_()


@pytest.mark.parametrize(
    "constant",
    [
        sqrt(2),
        pi,
        a / b,
        sqrt(a / b),
        1 / (b + c),
        sympy.E,
        sqrt(3) * pi,
        sympy.log(2),
        exp(a),
        sympy.Abs(a),
        sympy.Function("f")(a),
        2**a,
        sympy.GoldenRatio,
    ],
    ids=str,
)
def test_constants_come_back_as_what_they_were(constant):
    """Coefficients free of t pass through untouched, and integrate as constants."""
    assert of(constant * cos(t)).as_expr() == constant * cos(t)
    assert of(constant * t).integrate().as_expr() == constant * t**2 / 2


@pytest.mark.parametrize(
    "constant", [cos(phi), a * sin(phi) + b, cos(phi) ** 2, 1 / cos(phi), cos(1), tan(phi)], ids=str
)
def test_a_cosine_free_of_t_may_be_a_frequency_and_a_phase(constant):
    """Read, differentiated, integrated and evaluated as a symbol in its place would be."""
    values = {a: 2, b: 3, phi: Rational(1, 3)}
    f, named = of(t * sin(constant * t + constant)), of(t * sin(w * t + w))
    value = PoissonSeries(constant, t).evaluate(0, values, digits=40)

    for found, expected in ((f, named), (f.diff(), named.diff()), (f.integrate(), named.integrate())):
        difference = found.evaluate(2, values, digits=25) - expected.evaluate(2, {w: value}, digits=25)
        assert abs(difference) < mpmath.mpf(10) ** -22
    assert f.integrate().diff() == f
    assert of(cos(constant * t)).diff() == -constant * sin(constant * t)


def test_a_cosine_free_of_t_is_a_constant_and_also_a_phase():
    """It comes back as it was beside powers of t; beside a wave the two form a sum, so that phases compare equal."""
    assert of(cos(phi) * t**2).integrate().as_expr() == cos(phi) * t**3 / 3
    assert of(cos(phi) * cos(t) - sin(phi) * sin(t)) == of(cos(t + phi))


def test_a_series_cannot_be_altered_through_its_modes():
    """The polynomials are copies too: those read are remembered, and shared by all series with the same wave."""
    for polynomial in of(cos(7 * t)).modes.values():
        polynomial[0] = 5

    assert of(cos(7 * t)).as_expr() == cos(7 * t)


@given(short, short_expressions)
def test_an_expression_on_the_left_makes_a_series_too(f, x):
    """x + f, x - f and x f, as with the series of x."""
    for found, expected in [(x + f, of(x) + f), (x - f, of(x) - f), (x * f, of(x) * f)]:
        assert isinstance(found, PoissonSeries) and found == expected


@pytest.mark.parametrize("divisor", [2, Rational(2, 3), 0.1, a, 1 + a, pi], ids=str)
def test_a_series_is_divided_by_constants(divisor):
    """(f / c) c = f, floats exactly; and x / c for a series c that is constant."""
    f = of(t * cos(t) + b)

    assert isinstance(f / divisor, PoissonSeries)
    assert f / divisor * divisor == +f == f
    assert 1 / of(divisor) * divisor == one
    assert f**sympy.Integer(2) == f * f


def test_a_series_equals_numbers_and_nothing_that_is_no_series():
    """Of all types of numbers; what is outside the family, no number or text equals no series."""
    half = of(Rational(1, 2))
    for value in (0.5, Fraction(1, 2), sympy.Float(0.5), mpmath.mpf(0.5), Rational(1, 2), half):
        assert half == value
    outside = (sympy.tan(t), sympy.nan, sympy.oo, True, sympy.true, "1", "1/2", None, 1j, Symbol("t", real=True), [])
    for value in outside:
        assert half != value and one != value


@pytest.mark.parametrize("k", [Symbol("k", integer=True), sympy.floor(Symbol("x", real=True))], ids=str)
def test_half_turns_by_an_integer_are_signs_where_series_are_compared(k):
    """cos(2t + k pi) = cos(2t - k pi) = (-1)**k cos 2t, which is how SymPy writes it."""
    square, mirrored = of(cos(t + pi * k / 2) ** 2), of(cos(t - pi * k / 2) ** 2)

    for f in (square, mirrored, of(square.as_expr()), pickle.loads(pickle.dumps(square))):
        assert f == square and hash(f) == hash(square)
    assert square == ((-1) ** k * cos(2 * t) + 1) / 2 and square != (cos(2 * t) + 1) / 2


@pytest.mark.parametrize(
    "phase", [atan(2), acos(Rational(1, 3)), atan(a), asin(a), atan2(b, a), phi - atan(2), atan(a / (a + 1)), I * a],
    ids=str)
def test_phases_whose_cosine_sympy_knows_are_equal_to_what_it_writes(phase):
    """sin t sin(t + atan 2) has the constant 1/(2 sqrt(5)) where SymPy writes it: equal, pickled too, of equal hash."""
    f = of(sin(t) * sin(t + phase))

    expanded = sin(t) * (sin(t) * cos(phase) + cos(t) * sin(phase))
    for g in (of(f.as_expr()), pickle.loads(pickle.dumps(f)), of(expanded)):
        assert f == g and g == f and not f - g and hash(f) == hash(g)
    assert f != of(sin(t) * sin(t - phase)) and f - of(sin(t) * sin(2 * t + phase))


@pytest.mark.parametrize(
    "f", [lambda x: exp(x * a), lambda x: a ** (2 * x), lambda x: sqrt(x + a), lambda x: 3 ** (a * x)])
def test_a_float_inside_a_coefficient_is_the_dyadic_number_it_stands_for(f):
    """exp(0.5 a) is exp(a/2), and a**1.0 is a: whatever holds a float, no operation rounds."""
    assert of(f(0.5) * t) == f(Rational(1, 2)) * t
    assert of(f(0.1)) == f(Rational(0.1))


def test_floats_in_exponents_do_not_round_when_factors_are_joined():
    """SymPy would write exp(0.1 a) exp(0.2 a) as exp(0.30000000000000004 a)."""
    product = of(exp(0.1 * a)) * of(exp(0.2 * a))

    assert not product.as_expr().atoms(sympy.Float)
    assert product == exp((Rational(0.1) + Rational(0.2)) * a)
    assert of(t**2.0) == t**2


@pytest.mark.parametrize("phase", [sympy.acos(Rational(1, 3)), sympy.atan(2), -sympy.atan(Rational(3, 4)),
                                   sympy.asin(Rational(2, 7)), sympy.asin(a / 2), 2 * sympy.acos(Rational(1, 3))])
def test_phases_whose_cosine_sympy_knows_lose_nothing(phase):
    """cos(acos(1/3)) comes back as 1/3, sin(atan(2)) as 2/sqrt(5): products and integrals, against numbers."""
    value = {a: Rational(3, 5), t: Rational(7, 10)}
    for wave in (cos(3 * t + phase), sin(3 * t + phase)):
        integral = new_integrate(wave, t)
        assert abs((integral.diff(t) - wave).subs(value).evalf(30)) < 1e-25
        assert abs(integral.subs(t, 0).subs(value).evalf(30)) < 1e-25
        for other in (cos(3 * t), sin(3 * t + sympy.pi / 5), wave):
            apart = product_to_sum(wave * other, t) - wave * other
            assert abs(apart.subs(value).evalf(30)) < 1e-25
            assert abs((PoissonSeries(wave * other, t).as_expr() - wave * other).subs(value).evalf(30)) < 1e-25


def test_decimals_are_the_numbers_they_are():
    """As coefficients, limits and values, to their last digit."""
    number = Decimal("0.1234567890123456789012345678901")
    exact = Rational(1234567890123456789012345678901, 10**31)

    assert PoissonSeries(number, t) == exact
    assert new_integrate(cos(t), (t, 0, number)) == sin(exact)
    with mpmath.workdps(45):
        value = PoissonSeries(a * cos(t), t).evaluate(0, {a: number}, digits=40)
        assert abs(value - mpmath.mpf(exact.p) / exact.q) < 1e-40


def test_a_bound_below_all_floats_is_the_least_of_them():
    """(2 pi a)**4/24, 6e-399."""
    assert FloquetMatrix(Matrix([[a]]), t, 3).remainder({a: 1e-100}) == 5e-324


@pytest.mark.parametrize("factor", [exp(a), sqrt(a), 2**a, sympy.gamma(a), abs(a), sympy.Max(1, a), sqrt(a + 1)])
@pytest.mark.parametrize("zero", [
    sqrt(3 + 2 * sqrt(2)) - 1 - sqrt(2), 2 * sympy.GoldenRatio - 1 - sqrt(5),
    sympy.log(6) - sympy.log(2) - sympy.log(3),
    sympy.CRootOf(sympy.Symbol("x") ** 3 - 2, 0) - S(2) ** Rational(1, 3)])
def test_constants_that_cancel_do_so_before_functions_of_parameters(factor, zero):
    """A frequency that is one of two names of one number is one frequency."""
    assert of(factor * zero * cos(t)) == 0
    assert of(factor * (zero + 1) * cos(t)) == of(factor * cos(t)) != 0


def test_resonance_is_seen_behind_two_names_of_a_frequency():
    """cos(w t) cos(u t) with w = u has the mean 1/2, whatever factor both share."""
    g = Symbol("g")
    w, u = sqrt(g) * sympy.GoldenRatio, sqrt(g) * (1 + sqrt(5)) / 2
    P = Matrix([[0, 1], [-a - b * cos(w * t) * cos(u * t), 0]])
    found = FloquetMatrix(P, t, 1, 2 * pi / u).evaluate({a: 0, b: 1, g: 1})
    integral = new_integrate(cos(2 * w * t) * cos(2 * u * t), (t, 0, 1))

    assert abs(found[1, 0] + 2 * float(pi) / (1 + 5**0.5)) < 1e-14
    with mpmath.workdps(30):
        k = 2 * mpmath.sqrt(2) * mpmath.phi
        assert abs(sympy.N(integral.subs(g, 2), 25) - (mpmath.sin(2 * k) / (4 * k) + 0.5)) < 1e-20
