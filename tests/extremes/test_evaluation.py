"""Numbers at the extremes: orders to 120, parameters from denormal to 1e4, a thousand periods, ten thousand digits.

The truth is mpmath's, on the exact SymPy expressions, with hundreds of digits; the engine's own balls have no part in
it.
"""

from fractions import Fraction
from functools import cache
from pathlib import Path
from runpy import run_path

import mpmath
import numpy as np
import pytest
import sympy
from hypothesis import given, settings, strategies as st
from sympy import Matrix, Rational, cos, lambdify, pi, symbols

from fastpicard import FloquetMatrix, FundamentalMatrix, PoissonSeries
from fastpicard.vectorise import BALL, FLOAT, PAIR, Evaluator

a, b, t = symbols("a b t")
MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
UNIT = 2.0**-53


@cache
def floquet(n):
    """Mathieu's Floquet matrix."""
    return FloquetMatrix(MATHIEU, t, n)


@cache
def written(n):
    """The same in SymPy: the trace and the matrix."""
    return floquet(n).trace(), floquet(n).as_matrix()


@cache
def entry(n):
    """The first entry of Mathieu's fundamental matrix, and its terms as functions in float64 and in mpmath."""
    X = FundamentalMatrix(MATHIEU, t, n)[0, 0]
    terms = list(X.as_expr().args)
    return X, lambdify([t, a, b], terms), lambdify([t, a, b], terms, "mpmath")


@cache
def terms_of(expression, names):
    """The terms as one function in mpmath."""
    return lambdify(names, list(sympy.Add.make_args(expression)), "mpmath")


def in_mpmath(expression, names, values, digits):
    """An exact expression term by term with so many digits."""
    with mpmath.workdps(digits):
        return mpmath.fsum(terms_of(expression, tuple(names))(*map(exactly, values)))


def exactly(value):
    """A number in mpmath without rounding, at the working precision where it is no float."""
    return mpmath.mpf(value) if isinstance(value, float) else sympy.N(value, mpmath.mp.dps)._to_mpmath(mpmath.mp.prec)


def error(found, truth):
    """``|found / truth - 1|``."""
    with mpmath.workdps(60):
        return float(abs(mpmath.mpf(found) / truth - 1))


# -- the trace and the matrix after a period --------------------------------------------


@pytest.mark.parametrize("n", [20, 50])
@pytest.mark.parametrize(
    "x, y",
    [
        (2.5, 1.5), (-0.1, 0.55), (1e4, 1e3), (-1e4, 1e3), (50.0, -12.0), (0.25, 0.0), (0.0, 1e-12), (5e-324, 5e-324),
        (1e-320, 1e3), (1e-160, -1e-200), (-1e4, 0.0), (1e150, 2.0), (9.0, 1e-9),
    ],
)  # fmt: skip
def test_the_trace_is_right_to_ten_ulp_of_itself_and_the_matrix_of_its_largest_entry(n, x, y):
    """Each way to the same number, against a thousand digits of mpmath."""
    F, (trace, matrix) = floquet(n), written(n)
    truth = in_mpmath(trace, [a, b], [x, y], 1000)
    value, bound = F.lambdify_trace([a, b], bound=True)(x, y)
    with mpmath.workdps(1000):
        assert abs(mpmath.mpf(float(value)) - truth) <= min(bound, 10 * np.spacing(abs(value))) or np.isinf(value)
        assert np.isinf(value) == (abs(truth) > np.finfo(float).max)
    assert np.isinf(value) or error(F.trace_at({a: x, b: y}), truth) <= 1.01 * UNIT

    found, bounds = F.lambdify([a, b], bound=True)(x, y)
    truths = [in_mpmath(exact, [a, b], [x, y], 1000) for exact in matrix]
    if np.isfinite(found).all():
        largest = float(max(map(abs, truths)))
        with mpmath.workdps(1000):
            for value, bound, truth in zip(found.ravel(), bounds.ravel(), truths):
                assert abs(mpmath.mpf(float(value)) - truth) <= min(bound, 10 * np.spacing(largest))


def test_order_120_needs_balls_where_terms_exceed_the_sum_by_seventeen_digits():
    """b = a/10: some values are right in pairs, in the middle only balls are; all to 10 ulp."""
    F = FloquetMatrix(MATHIEU.subs(b, a / 10), t, 120)
    trace = F.trace()
    x = np.array([1e-3, 0.5, 4.0, 20.0, 45.0, 60.0, 100.0, 1e3, 1e4, -45.0, -1e4])
    evaluator = Evaluator(F.collapsed_trace, (a,))
    values, bounds, route = evaluator([x])

    assert BALL in route and PAIR in route and FLOAT in route
    for value, bound, point in zip(values[0], bounds[0], x):
        truth = in_mpmath(trace, [a], [float(point)], 800)
        with mpmath.workdps(800):
            assert abs(mpmath.mpf(float(value)) - truth) <= min(bound, 10 * np.spacing(abs(value)))


@pytest.mark.parametrize("length", [Rational(1, 10**6), Rational(10**6), 10**6 * pi], ids=str)
def test_periods_from_a_microsecond_to_a_million(length):
    """x'' + (a + b cos(2 pi t/T)) x = 0 with T**2 (a, b) near (2.5, 1.5)."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(2 * pi * t / length), 0]]), t, 30, period=length)
    x, y = (float(value / length**2) for value in (98, 60))
    truths = [in_mpmath(F[i, j], [a, b], [x, y], 200) for i in range(2) for j in range(2)]

    found, bounds = F.lambdify([a, b], bound=True)([x, x / 3], [y, -y])
    largest = float(max(map(abs, truths)))
    singles = F.evaluate({a: x, b: y})
    for value, bound, single, truth in zip(found[0].ravel(), bounds[0].ravel(), singles.ravel(), truths):
        with mpmath.workdps(200):
            assert abs(mpmath.mpf(float(value)) - truth) <= min(bound, 10 * np.spacing(largest))
        assert error(float(single), truth) <= 1.01 * UNIT
    route = Evaluator(F.collapsed, (a, b))([np.array([x, x / 3]), np.array([y, -y])])[2]
    assert (route == PAIR).all()


@pytest.mark.parametrize("factor", [5e-324, 1e-310, 1e-200, 1e200, 1e300])
def test_coefficients_from_denormal_to_huge(factor):
    """P with an entry that is a float at the end of the range, and its reciprocal's power of two elsewhere."""
    P = Matrix([[0, sympy.Float(factor) * (1 + cos(t))], [-a * 2 ** Rational(round(-np.log2(factor))) - b, 0]])
    F = FloquetMatrix(P, t, 12)
    x, y = 0.3, 0.7
    found, bounds = F.lambdify([a, b], bound=True)(x, y)
    truths = [in_mpmath(F[i, j], [a, b], [x, y], 1500) for i in range(2) for j in range(2)]

    largest = float(max(map(abs, truths)))
    for value, bound, single, truth in zip(found.ravel(), bounds.ravel(), F.evaluate({a: x, b: y}).ravel(), truths):
        with mpmath.workdps(1500):
            if np.isfinite(value) and np.isfinite(largest):
                assert abs(mpmath.mpf(float(value)) - truth) <= min(bound, 10 * np.spacing(largest))
                assert abs(mpmath.mpf(float(single)) - truth) <= np.spacing(abs(single))
            else:
                assert largest == np.inf


# -- other times ----------------------------------------------------------------------


@pytest.mark.parametrize("time", [2000 * pi, -2000 * pi, 6283.1, -6283.1, 1e-9, -0.75, Rational(22, 7)], ids=str)
def test_an_iterate_of_order_24_at_any_time(time):
    """A thousand periods forwards and backwards, and next to nothing: float and fifty digits."""
    X, _, terms = entry(24)
    x, y = 2.5, -1.5
    with mpmath.workdps(400):
        truth = mpmath.fsum(terms(exactly(time), mpmath.mpf(x), mpmath.mpf(y)))

    assert error(X.evaluate(time, {a: x, b: y}), truth) <= 1.01 * UNIT
    assert error(X.evaluate(time, {a: x, b: y}, 50), truth) <= 1e-49


def test_order_120_with_numbers_for_parameters_at_any_time():
    """Against SymPy's expressions in mpmath; at t = 1/2 the terms exceed the sum by 1e65."""
    X = FundamentalMatrix(MATHIEU.subs({a: Rational(5, 2), b: Rational(3, 2)}), t, 120)
    column = [X[0, 1].as_expr(), X[1, 1].as_expr()]

    for i, time in ((0, 2000 * pi), (1, -6283.1), (0, 0.5), (1, 0.5)):
        truth = in_mpmath(column[i], [t], [time], 600)
        assert error(float(X.evaluate(time)[i, 1]), truth) <= 1.01 * UNIT
        assert error(X.evaluate(time, {}, 40)[i, 1], truth) <= 1e-39


def test_nearly_resonant_frequencies():
    """cos t and cos((1 + 1e-12) t): the iterate divides by 1e-12 again and again, and is right at t = 1000."""
    P = Matrix([[0, 1], [-a - b * cos(t) - cos((1 + Rational(1, 10**12)) * t), 0]])
    X = FundamentalMatrix(P, t, 8)

    for time in (1000, -1e3, 1e12, 1e-3):
        found, digits = X.evaluate(time, {a: 0.25, b: -1}), X.evaluate(time, {a: 0.25, b: -1}, 30)
        for i in range(2):
            truth = in_mpmath(X[i, 0].as_expr(), [t, a, b], [time, 0.25, -1.0], 400)
            assert error(float(found[i, 0]), truth) <= 1.01 * UNIT
            assert error(digits[i, 0], truth) <= 1e-29


@pytest.mark.parametrize("digits", [15, 100, 1000, 10000])
def test_ten_thousand_digits_are_right(digits):
    """A Floquet matrix, its trace, and an iterate at another time; to the last digit."""
    F, (X, _, terms) = floquet(12), entry(6)
    at = {a: Rational(5, 2), b: Rational(-3, 7)}
    found, trace, other = F.evaluate(at, digits), F.trace_at(at, digits), X.evaluate(Rational(-7, 3), at, digits)

    with mpmath.workdps(digits + 60):
        values = [exactly(value) for value in at.values()]
        truth = [in_mpmath(F[i, j], [a, b], at.values(), digits + 60) for i in range(2) for j in range(2)]
        for value, true in [*zip(found, truth), (trace, truth[0] + truth[3]),
                            (other, mpmath.fsum(terms(exactly(Rational(-7, 3)), *values)))]:  # fmt: skip
            assert abs(value / true - 1) <= mpmath.mpf(10) ** (1 - digits)


# -- the naive route --------------------------------------------------------------------


@settings(max_examples=40)
@given(st.sampled_from([6, 9, 12, 16]), st.floats(-3, 3), st.floats(-2, 2), st.floats(0.02, 3), st.booleans())
def test_term_by_term_loses_the_digits_that_the_condition_number_says(n, x, y, time, backwards):
    """Error / value is between cond u / 50 and 4 n cond u, over a few points nearby; evaluate() has all digits."""
    X, naive, terms = entry(n)
    worst = predicted = 0.0
    for k in range(8):
        near = ((-time if backwards else time) * (1 + k / 64), x * (1 + k / 128), y * (1 + k / 256))
        with mpmath.workdps(80):
            exact = terms(*map(mpmath.mpf, near))
            truth, size = mpmath.fsum(exact), mpmath.fsum(exact, absolute=True)
        worst = max(worst, float(abs(sum(naive(*near)) - truth) / abs(truth)))
        predicted = max(predicted, float(size / abs(truth)) * UNIT)
        assert error(X.evaluate(near[0], {a: near[1], b: near[2]}), truth) <= 1.01 * UNIT

    assert worst <= 4 * n * predicted
    assert worst >= predicted / 50 or predicted < 50 * UNIT


def test_term_by_term_is_nonsense_where_evaluation_is_right():
    """Order 40 at t = 1/2, (a, b) = (2.5, 1.5): the value is 0.54, the sum of the terms is not."""
    X = FundamentalMatrix(MATHIEU.subs({a: Rational(5, 2), b: Rational(3, 2)}), t, 40)[0, 0]
    naive = sum(lambdify(t, list(X.as_expr().args))(0.5))
    truth = in_mpmath(X.as_expr(), [t], [0.5], 200)

    assert error(naive, truth) > 1
    assert error(X.evaluate(0.5), truth) <= 1.01 * UNIT


def test_sums_of_any_size_are_fractions_to_the_last_digit():
    """A series without waves is rational at rational times: the balls against Fractions, at 1e-300 and 1e300."""
    f = PoissonSeries(sum(Rational((-1) ** k, k + 1) * a**k * t**k for k in range(40)), t)
    for time, x in ((1e-300, 1e300), (1e10, 1e-10 * 0.999), (-3.0, 1e-320)):
        truth = sum(Fraction((-1) ** k, k + 1) * (Fraction(x) * Fraction(time)) ** k for k in range(40))
        found = Fraction(f.evaluate(time, {a: x}))
        assert abs(found - truth) <= abs(truth) * Fraction(101, 100) * Fraction(UNIT)


def test_the_table_of_digits_lost_is_what_the_code_gives():
    """Rows of order 20 of the page on accuracy, computed again by the example that wrote them."""
    root = Path(__file__).parents[2]
    example = run_path(str(root / "examples" / "05_accuracy.py"), run_name="table")
    printed = (root / "docs" / "accuracy_table.txt").read_text().split("   * - ")
    trace = floquet(20).trace()
    for n, x, y in example["AT_THE_PERIOD"]:
        if n == 20:
            row = [str(n), x, y, *example["cells"](trace, x, y)]
            (found,) = (cells for cells in (text.split("\n     - ") for text in printed) if cells[:3] == row[:3]
                        and len(cells) == 9)  # fmt: skip
            assert found[3] == row[3] and found[6:8] == row[6:8] == ["0.0", "0.0"] and found[8].strip() == row[8]
            assert [float(cell) for cell in found[4:6]] == pytest.approx([float(cell) for cell in row[4:6]], abs=1)
