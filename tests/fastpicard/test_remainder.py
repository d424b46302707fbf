"""Bounds of the remainder: never below the true error, and hardly above it."""

import mpmath
import numpy as np
import pytest
from flint import arb
from hypothesis import given, settings, strategies as st
from sympy import Matrix, Rational, Symbol, cos, integrate, pi, sin, sqrt

from fastpicard import BadInputError, BadTypeError, FloquetMatrix, FundamentalMatrix, MissingParameterError
from tests.fastpicard.test_reference_cases import numbers, system, truncation_errors
from tests.oracles import true_fundamental_matrix, truncation_bound

t, a, b, c = map(Symbol, "tabc")
MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
DAMPED = Matrix([[0, 1], [-a - b * cos(t), -c]])
GENERAL = Matrix(
    [[a / 3, sin(t), 0], [cos(2 * t) - b, 0, Rational(1, 2)], [0, a * sin(t) + cos(t) / 4, -Rational(1, 5)]]
)


def error_norm(F, values, digits=40):
    """The largest row sum of |Phi - Phi_n|, by Taylor's method of the test's own."""
    truth = true_fundamental_matrix(F.P.as_matrix().subs(values), t, 0, F.period, digits)
    with mpmath.workdps(digits):
        return mpmath.mnorm(truth - F.evaluate(values, digits), mpmath.inf)


@pytest.mark.parametrize("case, row", truncation_errors())
def test_the_bound_holds_and_is_sharp_on_the_reference_errors(case, row):
    """At least the true error; where iterates converge, at most a few percent more, and below the classical bound."""
    F = FloquetMatrix(system(case), t, row["n"])
    bound = F.remainder(numbers(case["params"]))
    if row["true_error_inf_norm"].startswith("<"):
        pytest.skip("the reference gives no number here")
    error = mpmath.mpf(row["true_error_inf_norm"])
    # The reference is printed with 15 digits.
    assert bound >= error * (1 - mpmath.mpf(10) ** -13)
    assert bound <= 1.03 * error
    classical = next(value for key, value in row.items() if key.startswith("classical"))
    assert bound <= mpmath.mpf(classical) * (1 + mpmath.mpf(10) ** -8)


@pytest.mark.parametrize("a_value, b_value, order", [("-1/10", "11/20", 39), ("5/2", "3/2", 69)])
def test_the_order_for_thirty_digits_is_that_of_the_true_error(a_value, b_value, order):
    """The smallest order whose proved remainder is 1e-30: the true error itself allows no smaller one."""
    values = {a: Rational(a_value), b: Rational(b_value)}
    F = FloquetMatrix.for_accuracy(MATHIEU, t, values, Rational(1, 10**30))

    assert F.n == order
    assert F.remainder(values) <= 1e-30
    with mpmath.workdps(50):
        assert error_norm(F.to_order(order - 1), values, 50) > mpmath.mpf(10) ** -30


@settings(max_examples=6)
@given(
    st.fractions(-2, 2, max_denominator=20),
    st.fractions(-2, 2, max_denominator=20),
    st.fractions(-1, 1, max_denominator=9),
)
@pytest.mark.parametrize("P, n", [(MATHIEU, 22), (DAMPED, 22), (GENERAL, 16)])
def test_the_bound_is_never_below_the_true_error(P, n, x, y, z):
    """Damped and 3 x 3 systems as well; the truth comes from a route that shares nothing."""
    values = {a: Rational(x), b: Rational(y), c: Rational(z)}
    F = ORDERS.setdefault((id(P), n), FloquetMatrix(P, t, n))
    bound = F.remainder(values, entrywise=True)
    truth = true_fundamental_matrix(P.subs(values), t, 0, 2 * pi, 25)
    with mpmath.workdps(25):
        error = truth - F.evaluate(values, 25)
        assert all(
            abs(error[i, j]) <= mpmath.mpf(bound[i, j]) + mpmath.mpf(10) ** -20
            for i in range(P.rows)
            for j in range(P.rows)
        )


ORDERS = {}


def test_no_bound_exceeds_the_sum_of_the_majorant():
    """Entry by entry at most sum (Pbar T)**k / k!, by the test's own summation."""
    values = {a: Rational(9, 4), b: Rational(1, 10)}
    found = FloquetMatrix(MATHIEU, t, 20).remainder(values, entrywise=True)
    majorant = truncation_bound(MATHIEU.subs(values), t, 2 * pi, 20)

    assert all(found[i, j] <= float(majorant[i, j]) * (1 + 1e-12) for i in range(2) for j in range(2))


@given(st.floats(-0.5, 2), st.floats(0, 1.5), st.floats(0, 1), st.floats(0, 1))
@settings(max_examples=12)
def test_the_bound_of_a_box_holds_at_every_point_of_it(x, y, u, v):
    """Intervals as pairs and as balls."""
    F = FloquetMatrix(MATHIEU, t, 24)
    box = {a: (x, x + 0.25), b: (y, y + 0.125)}
    inside = {a: x + 0.25 * u, b: y + 0.125 * v}

    assert F.remainder(box) >= 0.999 * F.remainder(inside)
    assert F.remainder({a: arb(x, 0.25), b: arb(y, 0.125)}) >= 0.999 * F.remainder({a: x - 0.25 * u, b: y + 0.125 * v})


def test_a_system_that_stops_has_no_remainder():
    """A nilpotent P ends with the iterate of its size: the bound is 0, exactly."""
    P = Matrix([[0, cos(t), sin(2 * t)], [0, 0, a + sin(t)], [0, 0, 0]])

    assert FloquetMatrix(P, t, 2).remainder({a: Rational(1, 2)}) == 0
    assert FloquetMatrix(P, t, 1).remainder({a: Rational(1, 2)}) == pytest.approx(np.pi)


def test_bounds_reach_as_far_as_floats_and_are_infinite_beyond():
    """A remainder of e**(628) is a number; of e**(2000 pi), infinity."""
    F = FloquetMatrix(MATHIEU, t, 20)

    assert 1e100 < F.remainder({a: 4000, b: 1}) < 1e300
    assert F.remainder({a: 10**6, b: 1}) == np.inf


def test_orders_for_a_box_meet_the_tolerance_on_all_of_it():
    """The order for a box is at least the one for each of its corners."""
    box = FloquetMatrix.for_accuracy(MATHIEU, t, {a: (-1, 1), b: (0, 1)}, 1e-12)
    corners = [FloquetMatrix.for_accuracy(MATHIEU, t, {a: x, b: y}, 1e-12).n for x in (-1, 1) for y in (0, 1)]

    assert box.n >= max(corners)
    assert box.remainder({a: (-1, 1), b: (0, 1)}) <= 1e-12


def test_irrational_numbers_in_P_and_period_are_bounded_as_well():
    """sqrt(2) and pi in the coefficients, a period of sqrt(2) pi."""
    P = Matrix([[0, 1], [-sqrt(2) / 7 - pi * cos(sqrt(2) * t) / 9, 0]])
    F = FloquetMatrix(P, t, 24, sqrt(2) * pi)

    assert float(error_norm(F, {})) <= F.remainder() <= 1.2 * float(error_norm(F, {}))


@pytest.mark.parametrize("height", [5, 15])
@pytest.mark.parametrize("n", [5, 30])
def test_increments_that_cancel_over_the_period_are_bounded_sharply(height, n):
    """Of x' = (h cos t - 1) x they are (-2 pi)**k / k! at the end, and up to e**(4 h) on the way."""
    bound = FloquetMatrix(Matrix([[height * cos(t) - 1]]), t, n).remainder()
    with mpmath.workdps(40):
        turn = -2 * mpmath.pi
        error = abs(mpmath.exp(turn) - sum(turn**k / mpmath.factorial(k) for k in range(n + 1)))

    assert error <= bound <= 1.02 * error


def test_increments_that_cancel_each_other_are_bounded_sharply():
    """Of x' = -20 x the sum has terms of 1e53, and what is left of it is 3e23."""
    with mpmath.workdps(80):
        turns = -40 * mpmath.pi
        error = abs(mpmath.exp(turns) - sum(turns**k / mpmath.factorial(k) for k in range(21)))

    assert error <= FloquetMatrix(Matrix([[-20]]), t, 20).remainder() <= 1.02 * error


NULL = Matrix([[1, -1], [1, -1]])


@pytest.mark.parametrize(("P", "slope"), [(NULL, 1), (cos(t) * NULL, cos(t)), (NULL + sin(a * t) * NULL, 1)])
def test_where_increments_vanish_the_bound_comes_to_an_end(P, slope):
    """``P(t) P(s) = 0``, which ``sup |P|`` cannot know: the first iterate is the truth, its bound next to nothing."""
    for time in (1, Rational(1, 3), -2):
        X = FundamentalMatrix(P, t, 1)
        assert X.remainder(time, {a: 0}) < 1e-50
        below = FundamentalMatrix(P, t, 0).remainder(time, {a: 0})
        error = 2 * abs(integrate(slope, (t, 0, time)))
        assert error <= below * (1 + 1e-15) and below <= 1.02 * error
    assert FloquetMatrix(NULL, t, 1, period=2).remainder() < 1e-50


@pytest.mark.parametrize(
    "values, error",
    [
        ({a: 1}, MissingParameterError),
        ({a: 1, b: (2, 1)}, BadInputError),
        ({a: 1, b: (1, 2, 3)}, BadInputError),
        ({a: 1, b: ("1", 2)}, BadTypeError),
        ({a: "1", b: 2}, BadTypeError),
        ({a: float("nan"), b: 2}, BadInputError),
    ],
)
def test_bad_values_are_refused(values, error):
    """No value, an interval the wrong way round, three ends, text."""
    with pytest.raises(error):
        FloquetMatrix(MATHIEU, t, 2).remainder(values)


@pytest.mark.parametrize("tol, error", [(0, BadInputError), (-1, BadInputError), ("1e-9", BadTypeError)])
def test_tolerances_must_be_positive_numbers(tol, error):
    """Zero, negative, text."""
    with pytest.raises(error):
        FloquetMatrix.for_accuracy(MATHIEU, t, {a: 1, b: 1}, tol)
