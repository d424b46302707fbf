"""Vectorised values: within 10 ulp of the largest entry and within their own bounds, whatever the arithmetic."""

from fractions import Fraction
from functools import cache

import mpmath
import numpy as np
import pytest
import sympy
from flint import ctx
from hypothesis import given, settings, strategies as st
from sympy import Matrix, Mul, Rational, cos, exp, pi, sin, sqrt

from fastpicard import (
    BadInputError,
    FloquetMatrix,
    FundamentalMatrix,
    MissingParameterError,
    PoissonSeries,
    fast_picard,
)
from fastpicard.collapsed import REMEMBERED, Collapsed
from fastpicard.vectorise import BALL, BLOCK, FLOAT, PAIR, PRECISIONS, Evaluator, vectorise
from tests.strategies import a, b, c, phi, t, w

MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
LARGEST = Fraction(np.finfo(float).max)
F30 = FloquetMatrix(MATHIEU, t, 30)
values = st.one_of(st.floats(-4, 4), st.floats(-1e12, 1e12), st.floats(allow_nan=False, allow_infinity=False))
exponents = st.integers(-3, 6)
sizes = st.builds(lambda n, d, e: Rational(n, d) * Rational(10) ** e,
                  st.integers(-99, 99).filter(bool), st.integers(1, 7), st.integers(-30, 30))  # fmt: skip
laurent = st.dictionaries(st.tuples(exponents, exponents), sizes, max_size=8)


def collapsed(*expressions):
    """Constants as polynomials."""
    return Collapsed([PoissonSeries(sympy.sympify(e), t).modes for e in expressions], t)


def ulp(x):
    """The distance of the doubles around a fraction."""
    return Fraction(float(np.spacing(abs(float(x)))))


def fraction(x):
    """The dyadic number that an mpf is."""
    sign, mantissa, exponent, _ = x._mpf_
    return (-1) ** sign * int(mantissa) * Fraction(2) ** int(exponent)


def exact_value(terms, x, y):
    """A Laurent polynomial in fractions."""
    return sum((Fraction(int(v.p), int(v.q)) * x**i * y**j for (i, j), v in terms.items()), Fraction(0))


def is_kept(found, bounds, truths):
    """Whether values keep their bounds, and 10 ulp of the largest double; beyond the doubles they are infinite."""
    largest = max((abs(x) for x in truths if abs(x) <= LARGEST), default=Fraction(0))
    for value, bound, truth in zip(found, bounds, truths):
        if np.isinf(value):
            assert abs(truth) > LARGEST and (value > 0) == (truth > 0) and np.isinf(bound)
            continue
        error = abs(Fraction(float(value)) - truth)
        assert error <= Fraction(float(bound)), (value, bound, truth)
        assert error <= 10 * ulp(largest), (value, truth)
        assert bound <= 10.01 * ulp(largest), (value, bound)  # proved, not luck; the bound itself is rounded up
    return True


@settings(max_examples=200)
@given(st.lists(laurent, min_size=1, max_size=3), st.lists(st.tuples(values, values), min_size=1, max_size=6))
def test_laurent_polynomials_are_right_to_ten_ulp_of_the_largest_and_to_their_bounds(entries, points):
    """Coefficients and arguments of any size, against exact fractions; poles are nan."""
    polynomials = [sympy.Add(*(v * a**i * b**j for (i, j), v in terms.items())) for terms in entries]
    f = vectorise(collapsed(*polynomials), [a, b], (len(entries),), bound=True)

    found, bounds = f(*np.array(points).T)
    for (x, y), row, errors in zip(points, found, bounds):
        pole = any(x == 0 and i < 0 or y == 0 and j < 0 for terms in entries for i, j in terms)
        if pole:
            assert np.isnan(row).any() and np.isinf(errors[np.isnan(row)]).all()
        else:
            assert is_kept(row, errors, [exact_value(terms, Fraction(x), Fraction(y)) for terms in entries])


@cache
def mathieu_function(name):
    """The vectorised matrix or trace of order 30, made once."""
    return getattr(F30, name)([a, b], bound=True)


@given(st.floats(-40, 40), st.floats(-40, 40))
def test_the_trace_of_mathieu_is_right_to_ten_ulp_of_itself(x, y):
    """Against thirty digits of balls; order 30 loses up to 17 digits here."""
    value, bound = mathieu_function("lambdify_trace")(x, y)

    assert is_kept([value], [bound + 1e-36 * abs(value)], [fraction(F30.trace_at({a: x, b: y}, 40))])


@given(st.floats(-40, 40), st.floats(-40, 40))
def test_the_matrix_of_mathieu_is_right_to_ten_ulp_of_its_largest_entry(x, y):
    """Every entry, in the same units."""
    found, bounds = mathieu_function("lambdify")(x, y)
    truth = F30.evaluate({a: x, b: y}, 40)

    largest = max(abs(float(entry)) for entry in truth)
    for i in range(2):
        for j in range(2):
            error = abs(truth[i, j] - float(found[i, j]))
            assert error <= bounds[i, j] + 1e-38 * largest
            assert error <= 10 * np.spacing(largest)


@pytest.mark.parametrize(
    "entries",
    [
        [sqrt(a) * b - 1 / sqrt(a), a ** Rational(2, 3), b],
        [a * cos(phi) - b * sin(2 * phi + 1), a / b],
        [exp(phi) / (a + b) + pi, sqrt(2) * a - sympy.log(b)],
        [sympy.tanh(a) - sympy.atan(b), cos(phi) ** 3],
        [(a - b) / (a + b) ** 2, 1 / (a * b) ** 2],
        [sqrt(a / b), sympy.Abs(phi), sqrt(2) + 1],
    ],
    ids=str,
)
def test_functions_of_parameters_are_variables_with_pairs_of_their_own(entries):
    """Roots, quotients, phases, functions: against balls with forty digits at a hundred points."""
    constants = collapsed(*entries)
    rng = np.random.default_rng(3)
    points = rng.uniform(0.1, 5, (3, 100)) * 10.0 ** rng.integers(-2, 3, (3, 100))
    evaluator = Evaluator(constants, (a, b, phi))

    found, bounds, route = evaluator(list(points))
    assert np.isin(route, (FLOAT, PAIR)).mean() > 0.9
    for k, point in enumerate(points.T):
        truths = list(map(fraction, constants.at(dict(zip((a, b, phi), map(float, point))), 40)))
        slack = Fraction(max(map(abs, truths))) / 10**38
        assert is_kept(found[:, k], [float(Fraction(e) + slack) * (1 + 1e-15) for e in bounds[:, k]], truths)


def test_the_arithmetic_is_the_cheapest_that_is_proved_to_do():
    """One cancellation after the other: floats, then pairs, then balls."""
    evaluator = Evaluator(collapsed(a**2 - 2 * a * b + b**2), (a, b))
    x = np.array([3.0, 1.0, 1.0, 1e-320, 1.0])
    y = np.array([-1.0, 1 + 2.0**-10, 1 + 2.0**-52, 1.0, 1.0])

    found, bounds, route = evaluator([x, y])
    assert route.tolist() == [FLOAT, PAIR, BALL, BALL, BALL]
    assert found[0].tolist() == [16, 2.0**-20, 2.0**-104, 1, 0]
    assert (bounds[0][2:] <= [0, 1e-38, 0]).all() and (bounds[0] <= 10 * np.spacing(found[0])).all()


def test_balls_go_on_until_the_bound_is_there():
    """sqrt(2) (a - b)**3 written out, where 90 bits cancel and 128 are not enough."""
    f = vectorise(collapsed(sympy.expand(sqrt(2) * (a - b) ** 3)), [a, b], (), bound=True)
    value, bound = f(1 + 2.0**-30, 1)

    assert value == pytest.approx(2**0.5 * 2.0**-90, rel=1e-15) and bound <= np.spacing(value)


@pytest.mark.parametrize("value", [150.0, -60.0])
def test_a_pole_in_one_entry_costs_the_others_no_digit(value):
    """Beside 1/c at c = 0 Mathieu's entries at a = 150 cancel by 1e34, and are what they are without it."""
    P = sympy.diag(MATHIEU, sympy.Matrix([[1 / c]]))

    found, bounds = FloquetMatrix(P, t, 60).lambdify([a, b, c], bound=True)(value, 1.0, 0.0)
    truths = list(map(fraction, FloquetMatrix(MATHIEU, t, 60).evaluate({a: value, b: 1}, 40)))
    slack = float(max(map(abs, truths))) * 1e-38
    assert is_kept(found[:2, :2].ravel(), bounds[:2, :2].ravel() + slack, truths)
    assert np.isnan(found[2, 2]) and bounds[2, 2] == np.inf


@pytest.mark.parametrize(("expression", "at", "value"), [
    (a**2 / (1 - cos(a)), (1e-25, 0, 0), 2),
    (1 / (a**2 + b**2 - c**2), (1e20, 1e-10, 1e20), 1 / Fraction(1e-10) ** 2),
    (exp(a), (1e100, 0, 0), np.inf),
    (-exp(a), (1e100, 0, 0), -np.inf),
    (exp(-a), (1e100, 0, 0), 0),
    (1 / (a - b), (1.0, 1.0, 0), np.nan),
], ids=str)
def test_only_a_pole_is_nan(expression, at, value):
    """Where 128 bits see a division by 0 more bits see a number, or one beyond the doubles; at a pole no bits do."""
    found, bound = vectorise(collapsed(expression), [a, b, c], (), bound=True)(*at)

    assert found == pytest.approx(float(value), rel=1e-15, nan_ok=True)
    assert np.isinf(bound) if not np.isfinite(found) else bound <= 10 * np.spacing(found)


def test_coefficients_are_kept_for_the_precisions_last_used():
    """After many precisions a point in balls finds its coefficients again, and few are held."""
    constants = collapsed(sympy.expand(sqrt(2) * (a - b) ** 3))
    evaluator, at = Evaluator(constants, (a, b)), [np.array([1 + 2.0**-30]), np.array([1.0])]
    expected = evaluator(at)[0]
    for digits in range(20, 200, 20):
        constants.at({a: 2, b: 1}, digits)

    assert evaluator(at)[0] == expected and len(PRECISIONS) <= REMEMBERED
    kept = {precision: id(rows) for precision, rows in constants._balls.items()}
    assert evaluator(at)[0] == expected and len(kept) <= 6
    assert {precision: id(rows) for precision, rows in constants._balls.items()} == kept


def test_only_the_largest_entry_needs_its_last_digits():
    """1 and a vanishing sum are floats together; the sum alone is not."""
    at = [np.array([1.0]), np.array([1 + 2.0**-50])]

    assert Evaluator(collapsed(a - b, 1), (a, b))(at)[2].tolist() == [FLOAT]
    assert Evaluator(collapsed((a - b) ** 3), (a, b))(at)[2].tolist() == [BALL]


@pytest.mark.parametrize("size", [1, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK + 3])
def test_every_place_of_every_block_has_its_own_value(size):
    """Blocks, remainders of blocks, and single points among them that need balls."""
    x, y = np.linspace(-1, 1, size), np.linspace(2, 3, size) ** 2
    x[:: BLOCK // 2] = 1e200
    value, bound = vectorise(collapsed(a * b - 3 * b + 1), [b, a], (), bound=True)(y, x)

    assert value == pytest.approx(x * y - 3 * y + 1, rel=1e-13, abs=1e-13)
    assert (bound <= 10 * np.spacing(abs(value))).all()


def test_shapes_broadcast_and_scalars_stay_scalars():
    """(3, 1) and (4,) give (3, 4, 2, 2); numbers give a number; nothing gives nothing."""
    f, g = F30.lambdify([a, b], bound=True), F30.lambdify_trace((b, a))
    matrices, bounds = f(np.ones((3, 1)), [1, 2, 3, 4])

    assert matrices.shape == bounds.shape == (3, 4, 2, 2)
    assert isinstance(g(1, Fraction(1, 2)), float) and np.shape(g(sympy.Rational(1, 2), 1)) == ()
    assert g([], []).shape == (0,) and f(np.ones((0, 3)), 1.0)[0].shape == (0, 3, 2, 2)
    assert F30.lambdify([a, b])(1, 2).tolist() == matrices[0, 1].tolist()
    assert vectorise(collapsed(sqrt(2), 0), [], (2,))().tolist() == [2**0.5, 0]
    assert vectorise(collapsed(sqrt(2), 0), [a], (2,))([1, 2]).tolist() == [[2**0.5, 0]] * 2


def test_integers_and_fractions_are_the_doubles_they_round_to():
    """An array is float64 before anything else."""
    f = vectorise(collapsed(a), [a], ())

    assert f(Fraction(1, 3)) == 1 / 3 and f(2**53 + 1) == 2.0**53 and f(np.float32(0.1)) == np.float32(0.1)


def test_a_symbol_that_is_an_integer_takes_no_other_number():
    """SymPy has made use of sin(pi n) = 0; the first such number is named, in the words of evaluate."""
    n = sympy.Symbol("n", integer=True)
    F = FloquetMatrix(Matrix([[0, 1], [-a - cos(n * t), 0]]), t, 4)
    f = F.lambdify_trace([a, n])
    with pytest.raises(BadInputError, match=r"n is an integer by its assumptions.* its value is 1/2\.") as expected:
        F.trace_at({a: 1, n: 0.5})

    for values in (0.5, [[2, 0.5], [np.nan, 1.5]], Fraction(1, 2)):
        with pytest.raises(BadInputError) as found:
            f(1, values)
        assert str(found.value) == str(expected.value)
    assert f(0.25, [2, np.inf]) == pytest.approx([F.trace_at({a: 0.25, n: 2}), np.nan], nan_ok=True)


@pytest.mark.parametrize("value", [
    10**400, Fraction(10**400), Fraction(-(10**400), 7), sympy.Integer(10) ** 400, Rational(10**400, 7),
    sympy.Float("-1e400"), mpmath.mpf("1e400"), np.longdouble("1e400"),
], ids=lambda x: f"{type(x).__module__}.{type(x).__name__}")
def test_numbers_beyond_the_doubles_are_refused_whatever_their_kind(value):
    """Alone and among others; evaluate takes them.  None is taken for infinite."""
    f = vectorise(collapsed(1 / a), [a], ())

    for argument in (value, [1.0, value], np.array([[value]])):
        with pytest.raises(BadInputError, match="range of doubles"):
            f(argument)


@pytest.mark.parametrize("value", [
    np.inf, -np.inf, np.nan, sympy.oo, -sympy.oo, sympy.nan, mpmath.inf, mpmath.nan, np.longdouble("-inf"),
    np.float32("inf"),
], ids=lambda x: f"{type(x).__name__} {x}")
def test_infinities_and_nan_are_arguments_of_every_kind(value):
    """They were no number before; the others keep their values."""
    f = vectorise(collapsed(1 / a), [a], ())

    assert np.isnan(f(value)) and f([value, 2])[1] == 0.5


def test_where_there_is_no_value_there_is_nan_and_no_bound():
    """Poles, arguments that are no numbers, roots of what is negative; the other points keep theirs."""
    f = vectorise(collapsed(b / a + c), [a, b, c], (), bound=True)
    value, bound = f([0, 2, np.nan, 1, np.inf, 0], [1, 1, 1, 1, 1, 0], [0, 0, 0, -np.inf, 0, 1])

    assert np.isnan(value).tolist() == [True, False, True, True, True, True]
    assert np.isinf(bound).tolist() == [True, False, True, True, True, True]
    value, bound = vectorise(collapsed(sqrt(a)), [a], (), bound=True)([-1, 4, 0, -np.inf])
    assert np.isnan(value).tolist() == [True, False, False, True] and value[1:3].tolist() == [2, 0]
    assert np.isinf(bound[[0, 3]]).all()


@pytest.mark.parametrize("endless", [np.inf, -np.inf, np.nan])
@pytest.mark.parametrize("expression", [2 - 1 / a, 2 - b / a, exp(-a) + b, 1 / a**2 + 1, b / sqrt(a), cos(a)], ids=str)
def test_an_infinite_parameter_gives_nan_where_it_occurs_though_its_reciprocal_is_zero(expression, endless):
    """No limit is taken; beside it, and at a number that balls take over, the values are what they are."""
    f = vectorise(collapsed(expression), [a, b], (), bound=True)
    value, bound = f([endless, 2.0, endless], [1.0, 1.0, 1e-320])

    assert np.isnan(value).tolist() == [True, False, True] and np.isinf(bound).tolist() == [True, False, True]
    assert (value[1], bound[1]) == f(2.0, 1.0)


@pytest.mark.parametrize("size", [1.0, 1e300], ids=["floats", "balls"])
@pytest.mark.parametrize("idle", [np.nan, np.inf, 1.0])
def test_a_parameter_that_does_not_occur_makes_no_difference(idle, size):
    """Whatever it is, in whichever arithmetic; where none occurs the constant is everywhere."""
    expected = vectorise(collapsed(b**2 / 3, 1), [b], (2,), bound=True)(size)
    found = vectorise(collapsed(b**2 / 3, 1), [a, b], (2,), bound=True)([idle, 2.0], size)

    assert np.array_equal(found, np.stack([expected, expected], axis=1))
    for constant in (1 / 3, Rational(10) ** 400):
        assert len(set(vectorise(collapsed(constant), [a], ())([idle, 2.0]))) == 1


def test_numbers_beyond_the_doubles_are_infinite_with_an_infinite_bound():
    """a**2 at 1e200, both signs; the denormal end has its bound."""
    value, bound = vectorise(collapsed(-(a**2)), [a], (), bound=True)([1e200, 1e-200, 1e-160, -1e150])

    assert value[0] == -np.inf and bound[0] == np.inf
    assert 0 < bound[1] <= 5e-324 and abs(Fraction(value[2]) + Fraction(1e-160) ** 2) <= Fraction(bound[2]) <= 5e-324
    assert value[3] == pytest.approx(-1e300) and np.isfinite(bound[3])


def test_entries_beyond_the_doubles_cost_the_others_neither_digit_nor_sign():
    """From -1e270 to 1e679 at one point: the first is a double, the others are infinities with their own signs."""
    X = FundamentalMatrix(Matrix([[a * cos(t), b], [c * sin(2 * t), -a]]), t, 6)
    at = dict(zip((a, b, c), (-1.5391408670466593e113, -1.7713547830697434e-182, 0.9999999999999991)))

    found, bounds = X.lambdify(pi, list(at), bound=True)(*at.values())
    truths = list(map(fraction, X.evaluate(pi, at, 60)))
    assert is_kept(found.ravel(), bounds.ravel(), truths)
    assert found[0, 0] == float(truths[0]) and found[0, 1] == -np.inf and (found[1] == np.inf).all()


@pytest.mark.parametrize("scale", [Rational(10) ** e for e in (-310, 305, -400, 400)])
def test_coefficients_from_denormal_to_beyond_the_doubles(scale):
    """The sum scale (a + a**2 / scale): where coefficients leave the doubles, balls take over."""
    value, bound = vectorise(collapsed(scale * a + a**2), [a], (), bound=True)([1.5, -0.25, 0])

    for x, found, error in zip((Rational(3, 2), Rational(-1, 4), 0), value, bound):
        truth = Fraction(int((scale * x + x**2).p), int((scale * x + x**2).q))
        assert is_kept([found], [error], [truth])


def test_the_numbers_own_arithmetic_raises_no_warning_and_knows_no_global_precision():
    """Warnings are errors here: neither underflow nor a pole gives one, and flint's precision does not matter."""
    x, y = [1.1, 1e-300, 1e300, 1.0], [0.3, 1, 1, 0]
    expected = vectorise(collapsed(a**3 / b - sqrt(2)), [a, b], (), bound=True)(x, y)
    with ctx.workprec(10), np.errstate(all="raise"):
        again = vectorise(collapsed(a**3 / b - sqrt(2)), [a, b], (), bound=True)(x, y)

    assert np.array_equal(expected, again, equal_nan=True)
    assert expected[0][1] == -(2**0.5) and expected[0][2] == np.inf and np.isnan(expected[0][3])


@given(st.integers(1, 400))
def test_evaluation_of_a_floquet_matrix_has_every_digit(digits):
    """One point, exact rationals: the digits asked for are the beginning of those of the exact expression."""
    F = FloquetMatrix(Matrix([[a, cos(t)], [sin(t) - b, 1 / a]]), t, 5)
    at = {a: Rational(-3, 7), b: Rational(11, 5)}
    found, trace = F.evaluate(at, digits), F.trace_at(at, digits)

    exact = F.as_matrix().subs(at)
    for i in range(2):
        for j in range(2):
            truth = sympy.N(exact[i, j], digits + 30)
            assert abs(sympy.Float(found[i, j], digits + 30) - truth) <= abs(truth) * Rational(10) ** (1 - digits)
    truth = sympy.N(exact.trace(), digits + 30)
    assert abs(sympy.Float(trace, digits + 30) - truth) <= abs(truth) * Rational(10) ** (1 - digits)


def test_a_monomial_that_leaves_only_waves_and_a_product_of_generators_keeps_its_place():
    """Two waves of one phase, alone and with parameters; the coefficient of each is found again."""
    e = 3 * cos(phi) - 2 * sin(phi) * a + a * b**2 * cos(2 * phi) + 5
    found = vectorise(collapsed(e), [phi, a, b], ())(0.7, 2.0, 3.0)

    assert found == pytest.approx(float(e.subs({phi: 0.7, a: 2, b: 3})), rel=1e-14)
    assert Mul(1, found) == found


@pytest.mark.parametrize("time", [0, Rational(1, 2), -3.7, 2000 * pi, 6283.1, 1e-200], ids=str)
@pytest.mark.parametrize(
    "P, n",
    [
        (MATHIEU, 16),
        (Matrix([[0, 1], [-a - b * cos(w * t + phi), sin(t)]]), 3),
        (Matrix([[t * cos(phi - w * t), 1 / w], [-a, b * t * sin(w * t)]]), 2),
    ],
    ids=["Mathieu", "symbolic frequency and phase", "powers of time"],
)
def test_iterates_at_any_time_are_functions_of_their_parameters(P, n, time):
    """Forty points, frequencies among the parameters, against balls with forty digits."""
    X = FundamentalMatrix(P, t, n)
    names = sorted({a, b, phi, w}, key=str)
    points = np.random.default_rng(5).uniform(0.2, 3, (4, 40))

    found, bounds = X.lambdify(time, names, bound=True)(*points)
    assert found.shape == bounds.shape == (40, 2, 2)
    for k, point in enumerate(points.T):
        truths = [fraction(x) for x in X.evaluate(time, dict(zip(names, map(float, point))), 40)]
        slack = max(map(abs, truths)) / 10**38
        assert is_kept(found[k].ravel(), [float(Fraction(e) + slack) * (1 + 1e-15) for e in bounds[k].ravel()], truths)


def test_columns_at_a_time_have_their_shape_and_miss_no_parameter():
    """fast_picard gives (m, 1); a parameter that is not listed is named."""
    X = fast_picard(MATHIEU, t, [1, 0], 4)

    assert X.lambdify(1, [a, b])(np.ones((5, 1)), 0.5).shape == (5, 1, 2, 1)
    with pytest.raises(MissingParameterError, match="b is missing"):
        X.lambdify(1, [a])
