"""Floquet matrices: the fundamental matrix after a period, its laws and its numbers."""

import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy
from flint import arb
from hypothesis import given, strategies as st
from sympy import Matrix, Rational, S, Symbol, cos, exp, log, pi, sin, sqrt

from fastpicard import BadInputError, FloquetMatrix, FundamentalMatrix, PoissonSeries
from fastpicard.halfway import half_period
from fastpicard.writing import write
from tests.oracles import distance, true_fundamental_matrix, truncation_bound, within
from tests.strategies import VALUES, a, b, c, matrices, phi, t, w

MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
whole = st.sampled_from([S(k) for k in (1, 2, 3, -1, 5)])
F20 = FloquetMatrix(MATHIEU, t, 20)


@given(matrices(2, rates=whole, angles=st.sampled_from([S.Zero, S.Zero, phi, pi / 2, S.One])), st.integers(0, 3))
def test_the_floquet_matrix_is_the_fundamental_matrix_at_the_period(P, n):
    """Exactly, entry by entry, phases included."""
    found, at_period = FloquetMatrix(P, t, n).as_matrix(), FundamentalMatrix(P, t, n)(2 * pi)

    assert all(PoissonSeries(x, t) == PoissonSeries(y, t) for x, y in zip(found, at_period))


@pytest.mark.parametrize(
    "scale, period",
    [
        (2, pi),
        (2 * pi, 1),
        (4, pi / 2),
        (6 * pi / 7, Rational(7, 3)),
        (w, 2 * pi / w),
        (sqrt(2), sqrt(2) * pi),
        (1, 4 * pi),
        (Rational(1, 2), 4 * pi),
        (pi * w, 2 / w),
    ],
    ids=str,
)
def test_any_period_will_do(scale, period):
    """pi, 1, pi/2, 7/3, 2 pi/w, sqrt(2) pi and multiples: always the fundamental matrix at that time."""
    P = Matrix([[sin(t), 1], [a + b * cos(2 * t), -c]]).subs(t, scale * t)
    found, at_period = FloquetMatrix(P, t, 4, period).as_matrix(), FundamentalMatrix(P, t, 4)(period)

    assert all(PoissonSeries(x, t) == PoissonSeries(y, t) for x, y in zip(found, at_period))


@pytest.mark.parametrize(
    "rate, period",
    [
        (w - 1, 2 * pi / (w - 1)),
        (1 / (1 + w), 2 * pi * (1 + w)),
        (2 * pi / (a + b), a + b),
        (exp(a), 2 * pi * exp(-a)),
        (2**a, 2 * pi / 2**a),
        (a - b, 4 * pi / (a - b)),
        (w + w**2, 2 * pi / (w + w**2)),
        (1 + pi, 2 * pi / (1 + pi)),
        (1 + cos(pi / 7), 2 * pi / (1 + cos(pi / 7))),
        (log(4), 2 * pi / log(2)),
        (cos(phi), 2 * pi / cos(phi)),
        (1 / cos(phi), 2 * pi * cos(phi)),
        (Symbol("n", integer=True), 2 * pi),
    ],
    ids=str,
)
def test_a_period_may_be_any_expression_of_which_the_frequency_makes_whole_turns(rate, period):
    """Whatever form the quotient has; the mean of 1 + cos(rate t) is 1, so the first iterate is 1 + T."""
    F = FloquetMatrix([[1 + c * cos(rate * t)]], t, 1, period)

    assert PoissonSeries(F.trace(), t) == 1 + period


def test_turns_are_counted_whatever_form_the_frequency_has():
    """log(4) t makes one turn in pi/log(2): after half of that its cosine is -1, as that of w t after pi/w."""
    found = FloquetMatrix([[0, 1], [-a - b * cos(log(4) * t), 0]], t, 3, pi / log(2))
    named = FloquetMatrix([[0, 1], [-a - b * cos(w * t), 0]], t, 3, 2 * pi / w)
    pairs = [(write(x, t), write(y, t)) for left, right in zip(half_period(found), half_period(named))
             for x, y in zip(left, right)]

    assert found.turns == 1 and found.over(1, 3).turns == 1
    assert FloquetMatrix([[cos(log(4) * t)]], t, 1, 2 * pi / log(2)).turns == 2
    assert all(PoissonSeries(x, t) == y.subs(w, log(4)) for x, y in pairs)


def test_a_number_of_turns_that_depends_on_a_symbol_is_whole_but_not_even_or_odd():
    """n whole turns are a period; half of it is refused by name."""
    n = Symbol("n", integer=True)
    F = FloquetMatrix([[0, 1], [-a - b * cos(n * t), 0]], t, 3)

    assert F.turns == 1
    with pytest.raises(BadInputError, match="made n of them"):
        half_period(F)


@given(matrices(2, rates=whole), st.integers(0, 4), st.integers(0, 4))
def test_going_on_from_a_floquet_matrix_gives_what_a_fresh_start_gives(P, n, m):
    """to_order up and down."""
    assert FloquetMatrix(P, t, n).to_order(m).as_matrix() == FloquetMatrix(P, t, m).as_matrix()


@given(matrices(2, rates=whole), st.integers(0, 4))
def test_the_trace_is_the_sum_of_the_diagonal(P, n):
    """Exact, in digits and as a function."""
    F = FloquetMatrix(P, t, n)

    assert F.trace() == sympy.expand(F[0, 0] + F[1, 1])
    matrix = F.evaluate(VALUES, 40)
    with mpmath.workdps(60):
        assert abs(F.trace_at(VALUES, 30) - matrix[0, 0] - matrix[1, 1]) <= mpmath.mpf(10) ** -28 * (
            1 + mpmath.mnorm(matrix, 1)
        )


@given(matrices(2, rates=whole), st.integers(0, 4))
def test_functions_of_the_parameters_agree_with_evaluation(P, n):
    """lambdify and lambdify_trace at one point; the loss of digits stays below that of the monomials' sum."""
    F = FloquetMatrix(P, t, n)
    found, expected = F.lambdify([a, b])(0.75, -1.25), F.evaluate({a: 0.75, b: -1.25})

    scale = 1 + np.abs(F.lambdify([a, b])(-0.75, -1.25)).max() + np.abs(expected).max() + 1e4
    assert np.abs(found - expected).max() <= 1e-13 * scale
    assert F.lambdify_trace([b, a])(-1.25, 0.75) == pytest.approx(found.trace(), rel=1e-12, abs=1e-10)


def test_arrays_of_parameters_broadcast():
    """Shapes (3, 1) and (4,) give (3, 4) traces and (3, 4, 2, 2) matrices."""
    x, y = np.linspace(-0.2, 1, 3)[:, None], np.linspace(0, 1, 4)
    traces, matrices_ = F20.lambdify_trace([a, b])(x, y), F20.lambdify([a, b])(x, y)

    assert traces.shape == (3, 4) and matrices_.shape == (3, 4, 2, 2)
    for i in range(3):
        for j in range(4):
            expected = F20.evaluate({a: float(x[i, 0]), b: float(y[j])})
            assert matrices_[i, j] == pytest.approx(expected, rel=1e-9, abs=1e-9)
            assert traces[i, j] == pytest.approx(expected.trace(), rel=1e-9, abs=1e-9)


def test_functions_of_constants_phases_and_quotients():
    """Laurent monomials, roots, phases and generators that are sums, as arrays."""
    P = Matrix([[a / b + sqrt(a), cos(t + phi)], [1 / (a + b), sin(t - 2 * phi) * pi]])
    F = FloquetMatrix(P, t, 3)
    x = np.array([0.5, 1.0, 2.5])

    found = F.lambdify([phi, b, a])(0.3, 1.5, x)
    for k in range(3):
        assert found[k] == pytest.approx(F.evaluate({phi: 0.3, b: 1.5, a: float(x[k])}), rel=1e-12, abs=1e-12)
    assert FloquetMatrix([[1]], t, 3).lambdify([])() == pytest.approx(FloquetMatrix([[1]], t, 3).evaluate())
    assert FloquetMatrix([[1]], t, 3).lambdify_trace([a])(x) == pytest.approx(FloquetMatrix([[1]], t, 3).trace_at())
    assert F.lambdify([phi, b, a])(x, x, x).shape == (3, 2, 2)


@pytest.mark.parametrize(
    "value",
    [
        Fraction(-1, 10),
        Rational(-1, 10),
        mpmath.mpf(-0.1),
        -0.1,
        np.float64(-0.1),
        np.float32(-0.1),
        arb(-0.1),
        sympy.Float(-0.1),
        -sqrt(2) / 10,
        pi,
        3,
        np.int64(3),
        sympy.Integer(3),
        -sympy.cos(1),
        sympy.E,
    ],
    ids=repr,
)
def test_values_of_every_exact_kind_are_accepted(value):
    """int, Fraction, float, mpf, SymPy numbers, NumPy scalars and balls: the exact number each is."""
    number = Rational(*value.as_integer_ratio()) if isinstance(value, float | np.floating) else value
    expected = F20.trace().subs(b, Rational(1, 2))
    if isinstance(value, arb):
        number = Rational(-0.1)
    elif isinstance(value, mpmath.mpf | sympy.Float):
        number = Rational(float(value))
    expected = sympy.N(expected.subs(a, sympy.sympify(number)), 40, maxn=500)

    with mpmath.workdps(50):
        assert abs(F20.trace_at({a: value, b: Rational(1, 2)}, 30) - mpmath.mpf(str(expected))) < mpmath.mpf(
            10
        ) ** -26 * (1 + abs(expected))


def test_digits_are_correct_where_floats_lose_them_all():
    """At (a, b) = (30, 25) the trace at n = 30 is a difference of numbers larger by many digits."""
    F = F20.to_order(30)
    exact = F.trace().subs({a: 30, b: 25})

    assert abs(F.trace_at({a: 30, b: 25}, 40) / mpmath.mpf(str(sympy.N(exact, 60, maxn=1000))) - 1) < 1e-14
    with mpmath.workdps(60):
        assert (
            abs(F.trace_at({a: 30, b: 25}, 40) / mpmath.mpf(str(sympy.N(exact, 60, maxn=1000))) - 1)
            < mpmath.mpf(10) ** -38
        )


@pytest.mark.parametrize("digits", [None, 1, 5, 16, 50, 300])
def test_any_number_of_digits_may_be_asked_for(digits):
    """They are the first digits of one number."""
    found, more = F20.trace_at({a: 1, b: 1}, digits), F20.trace_at({a: 1, b: 1}, 400)

    with mpmath.workdps(400):
        assert abs(found / more - 1) <= mpmath.mpf(10) ** (1 - (digits or 16))


def test_multipliers_are_the_eigenvalues_largest_first():
    """Of the true matrix at a point where they are real, and complex where they are not; an iterate of order 50
    is as good as the truth there."""
    F50 = F20.to_order(50)
    real, turning = F20.multipliers({a: -1, b: 0.5}), F20.multipliers({a: -0.1, b: 0.55}, 20)

    assert abs(real[0]) > 1 > abs(real[1])
    assert sum(real) == pytest.approx(F50.trace_at({a: -1, b: 0.5}), rel=1e-14) and np.prod(real) == pytest.approx(1)
    assert turning[0].imag > 0 > turning[1].imag
    with mpmath.workdps(30):
        assert abs(sum(turning) - F50.trace_at({a: -0.1, b: 0.55}, 30)) < 1e-19


@pytest.mark.parametrize(
    "P, period",
    [
        (Matrix([[Rational(1, 5), sin(t)], [cos(t) - Rational(1, 2), 0]]), 2 * pi),
        (Matrix([[0, 1], [-1 - cos(2 * pi * t) / 3, -Rational(1, 10)]]), S.One),
        (Matrix([[0, 1, 0], [0, 0, cos(4 * t)], [Rational(1, 3), sin(8 * t), 0]]), pi / 2),
        (Matrix([[0, 1], [-4, 0]]), Rational(7, 3)),
    ],
    ids=str,
)
def test_floquet_matrices_approach_the_truth(P, period):
    """Against Taylor's method in balls, as close as the classical bound allows."""
    n = 24
    found, truth = FloquetMatrix(P, t, n, period).evaluate(digits=30), true_fundamental_matrix(P, t, 0, period)
    bound = truncation_bound(P, t, period, n)

    assert within(found, truth, bound, mpmath.mpf(10) ** -25)


def test_the_matrix_over_two_periods_is_the_square():
    """Phi(2T) = Phi(T)**2 for the truth, hence for high orders in all digits that the order has."""
    P = Matrix([[0, 1], [-Rational(1, 3) - sin(2 * t) / 4, Rational(1, 7)]])
    once, twice = FloquetMatrix(P, t, 50, pi).evaluate(digits=25), FloquetMatrix(P, t, 50).evaluate(digits=25)

    with mpmath.workdps(40):
        assert distance(twice, once * once) < mpmath.mpf(10) ** -20


def test_low_orders_are_what_one_finds_by_hand():
    """Order 4 by hand: cosines of sqrt(a) 2 pi, cut off; order 20 at (-0.1, 0.55)."""
    assert F20.to_order(4).trace() == 4 * pi**4 * a**2 / 3 - 4 * pi**2 * a - 2 * pi**2 * b**2 + 2
    assert F20.evaluate({a: -0.1, b: 0.55})[0, 0] == pytest.approx(-0.0397796, abs=1e-7)


def test_floquet_matrices_print_themselves_short():
    """Order, shape and period; LaTeX while a person could read it."""
    assert repr(F20) == "<FloquetMatrix of order 20, shape 2 x 2, period 2*pi>"
    assert "order 20" in F20._repr_latex_()
    assert r"\begin{matrix}" in F20.to_order(2)._repr_latex_()
    assert (F20.n, F20.shape, F20.period, F20.t) == (20, (2, 2), 2 * pi, t)


def test_exact_matrices_travel_between_processes():
    """What SymPy holds can be pickled."""
    matrix = F20.to_order(6).as_matrix()

    assert pickle.loads(pickle.dumps(matrix)) == matrix
