"""Enclosures of the true Floquet matrix: every reference digit inside, nested, with the symmetries of the equation."""

from fractions import Fraction

import mpmath
import pytest
from flint import arb, arb_mat, ctx, fmpq
from hypothesis import given, settings, strategies as st
from sympy import Matrix, Rational, S, Symbol, cos, exp, pi, sin, sqrt

from fastpicard import BadInputError, BadTypeError, FloquetMatrix, MissingParameterError, enclosure
from tests.conftest import CHECKS, in_threads
from tests.fastpicard.test_reference_cases import cases, numbers, read, system
from tests.oracles import true_fundamental_matrix

t, a, b, c, w = map(Symbol, "tabcw")
MATHIEU = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0)
DAMPED = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), -c]]), t, 0)
GENERAL = FloquetMatrix(
    Matrix([[a / 3, sin(t), 0], [cos(2 * t) - b, 0, Rational(1, 2)], [0, a * sin(t) + cos(t) / 4, -Rational(1, 5)]]),
    t,
    0,
)
SHIFTED = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(2 * t + 1), 0]]), t, 0, pi)
SYSTEMS = [MATHIEU, DAMPED, GENERAL, SHIFTED]


def reference_ball(text, digits):
    """A printed number with an error of two units in its last digit."""
    with ctx.workprec(int(3.33 * digits) + 40):
        value = arb(text)
        return value + arb(0, 2 * (abs(value).upper() + arb(10) ** -digits) * arb(10) ** (1 - digits))


FROM_ZERO = [x for x in cases("floquet_other") if x.values[0]["t0"] == "0"]


@pytest.mark.parametrize("case", cases("floquet_mathieu") + FROM_ZERO)
def test_enclosures_hold_the_reference_matrices_with_all_their_digits(case):
    """Mathieu, Hill, Ince, damped, rods, any period, ten periods: 50 or 100 digits, from numbers found elsewhere."""
    values, digits = numbers(case["params"]), int(case["digits"])
    end = read(case.get("t1", "2*pi"))
    found = FloquetMatrix(system(case), t, 0, end).enclosure(values, digits)

    for i, row in enumerate(case["fundamental_matrix"]):
        for j, text in enumerate(row):
            assert found[i, j].overlaps(reference_ball(text, digits))
    largest = max(abs(x).upper() for x in found.entries())
    assert all(x.rad() <= arb(10) ** -digits * largest for x in found.entries())


numbers_drawn = st.fractions(-3, 3, max_denominator=1000)


@settings(max_examples=CHECKS)
@given(st.sampled_from(SYSTEMS), numbers_drawn, numbers_drawn, st.integers(6, 14))
def test_an_enclosure_holds_the_value_at_twice_the_digits(F, x, y, digits):
    """Random containment checks: 2000 in CI, 100000 in the nightly profile; no miss is allowed."""
    values = {a: x, b: y, c: fmpq(1, 7)}
    coarse, fine = F.enclosure(values, digits), F.enclosure(values, 2 * digits)

    assert all(wide.overlaps(narrow) and wide.contains(narrow.mid()) for wide, narrow in pairs(coarse, fine))


def pairs(left, right):
    """Entries side by side."""
    return zip(left.entries(), right.entries(), strict=True)


@settings(max_examples=30)
@given(st.sampled_from(SYSTEMS), numbers_drawn, numbers_drawn, st.integers(1, 40), st.integers(8, 60))
def test_a_step_that_ends_too_early_pays_with_its_radius(F, x, y, orders, bits):
    """The defect sees what is left out, by few orders as by few bits: one step over a quarter of the period."""
    values = F.numbers({a: x, b: y, c: fmpq(1, 7)})

    with ctx.workprec(200), pytest.MonkeyPatch.context() as patch:
        P, period = F.at(values)
        fine, rough = (enclosure._step(P.shifted(period / 7), period / 4, [0] * P.size, n) for n in (200, bits))
        patch.setattr(enclosure, "MOST_ORDERS", orders)
        short = enclosure._step(P.shifted(period / 7), period / 4, [0] * P.size, 200)

        assert all(wide.contains(narrow.mid()) for coarse in (rough, short) for wide, narrow in pairs(coarse, fine))


@settings(max_examples=10)
@given(st.sampled_from(SYSTEMS), numbers_drawn, numbers_drawn)
def test_an_enclosure_agrees_with_taylors_method_of_the_tests(F, x, y):
    """A route that shares no code: 25 digits."""
    values = {a: Rational(x), b: Rational(y), c: Rational(1, 7)}
    truth = true_fundamental_matrix(F.P.as_matrix().subs(values), t, 0, F.period, 25)
    found = F.enclosure(values, 20)

    size = F.shape[0]
    with mpmath.workdps(30):
        assert all(
            found[i, j].overlaps(reference_ball(mpmath.nstr(truth[i, j], 24), 20))
            for i in range(size)
            for j in range(size)
        )


def test_closed_forms_are_enclosed():
    """A constant oscillator, a scalar equation, a triangular one, and the article's example exp(2 pi (a - 1))."""
    oscillator = FloquetMatrix(Matrix([[0, 1], [-(w**2), 0]]), t, 0, 1).enclosure({w: 3}, 40)
    scalar = FloquetMatrix(Matrix([[a + 3 * sin(5 * t) + cos(t)]]), t, 0).enclosure({a: 2}, 40)
    article = FloquetMatrix(
        Matrix([[a * cos(t) ** 2 - 1, 1 - a * sin(t) * cos(t)], [-1 - a * sin(t) * cos(t), a * sin(t) ** 2 - 1]]),
        t,
        0,
        pi,
    ).enclosure({a: Rational(3, 2)}, 40)

    with ctx.workprec(200):
        assert oscillator[0, 0].overlaps(arb(3).cos()) and oscillator[1, 0].overlaps(-3 * arb(3).sin())
        assert scalar[0, 0].overlaps((4 * arb.pi()).exp())
        assert article[0, 0].overlaps(-(arb.pi() / 2).exp()) and article[1, 1].overlaps(-(-arb.pi()).exp())


@settings(max_examples=30)
@given(numbers_drawn, numbers_drawn)
def test_liouvilles_determinant_is_enclosed(x, y):
    """det Phi(T) = exp(integral of the trace of P)."""
    values = {a: x, b: y, c: fmpq(1, 3)}
    with ctx.workprec(120):
        assert MATHIEU.enclosure(values, 20).det().contains(1)
        assert DAMPED.enclosure(values, 20).det().overlaps((-2 * arb.pi() / 3).exp())


def test_many_steps_cost_few_bits():
    """Some 90 of them; one after the other, a rotation would lose more than half a bit in each."""
    P = MATHIEU.at(MATHIEU.numbers({a: 10**6, b: 1}))[0]
    with ctx.workprec(100):
        assert all(x.rad() < 1e-15 for x in enclosure.transition(P, arb(0), arb(1)).table()[0])


@settings(max_examples=20)
@given(numbers_drawn, numbers_drawn, st.integers(2, 5))
def test_many_periods_are_powers(x, y, k):
    """Phi(k T) = Phi(T)**k, also where the class is told the long period only."""
    values = {a: x, b: y}
    long = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0, 2 * k * pi).enclosure(values, 20)
    with ctx.workprec(200):
        power = MATHIEU.enclosure(values, 40) ** k

    assert all(x.overlaps(y) for x, y in pairs(long, power))


@pytest.mark.parametrize("x, y", [(4000, 1000), (-4000, 10), (10**4, 0), (1, 10**3), (0, 0), (10**-30, 10**-30)])
def test_enclosures_reach_the_extremes(x, y):
    """|a| to 1e4, b to 1e3: the digits asked for, and twice as many agree with them."""
    values = {a: Rational(x), b: y}
    coarse, fine = MATHIEU.enclosure(values, 15), MATHIEU.enclosure(values, 30)

    assert all(wide.contains(narrow.mid()) for wide, narrow in pairs(coarse, fine))
    assert all(x.rad() <= abs(x).upper() * arb(10) ** -14 or x.rad() < arb(10) ** -29 for x in coarse.entries())


@pytest.mark.parametrize("period", [Rational(1, 10**6), Rational(10**6)])
def test_extreme_periods_are_a_matter_of_units(period):
    """Time in other units: the trace of the same equation, period 1e-6 and 1e6."""
    turn = 2 * pi / period
    P = Matrix([[0, 1], [-(turn**2) * (a + b * cos(turn * t)), 0]])
    found = FloquetMatrix(P, t, 0, period).enclosure({a: Rational(1, 3), b: 1}, 20)
    with ctx.workprec(100):
        assert found.trace().overlaps(MATHIEU.enclosure({a: Rational(1, 3), b: 1}, 20).trace())


def test_a_thousand_digits_are_right():
    """1000 digits hold those of 1030."""
    wide, narrow = MATHIEU.enclosure({a: 1, b: 1}, 1000)[0, 0], MATHIEU.enclosure({a: 1, b: 1}, 1030)[0, 0]

    assert wide.contains(narrow) and wide.rad() < arb(10) ** -1000


@settings(max_examples=20)
@given(numbers_drawn, numbers_drawn, st.floats(-1, 1), st.floats(-1, 1))
def test_balls_and_intervals_of_parameters_hold_all_their_points(x, y, u, v):
    """The enclosure for a ball holds the matrix of every point of it."""
    r = Fraction(1, 10**15)
    ball = MATHIEU.enclosure({a: (x - r, x + r), b: (y - r, y + r)}, 4)
    point = MATHIEU.enclosure({a: x + Fraction(u) * r, b: y + Fraction(v) * r}, 20)

    assert all(wide.overlaps(narrow) for wide, narrow in pairs(ball, point))


@pytest.mark.parametrize("radius, digits", [(15, 4), (12, 4), (10, 2)])
def test_narrow_balls_keep_the_digits_that_they_fix(radius, digits):
    """Solutions that grow 1e6 times: the radius is far above rounding, however small it is."""
    r = Fraction(1, 10**radius)
    x, y = Fraction(-8, 3), Fraction(-11, 4)
    found = MATHIEU.enclosure({a: (x - r, x + r), b: (y - r, y + r)}, digits)

    assert all(ball.contains(point) for ball, point in pairs(found, MATHIEU.enclosure({a: x, b: y}, 30)))


def test_irrational_numbers_and_phases_are_balls_from_the_start():
    """sqrt(2), e, and a phase of 1: against the test's own Taylor method."""
    P = Matrix([[0, 1], [-sqrt(2) / 5 - exp(-1) * cos(t + 1), -pi * sin(t) / 7]])
    truth = true_fundamental_matrix(P, t, 0, 2 * pi, 25)
    found = FloquetMatrix(P, t, 0).enclosure({}, 20)

    with mpmath.workdps(30):
        assert all(
            found[i, j].overlaps(reference_ball(mpmath.nstr(truth[i, j], 24), 20)) for i in range(2) for j in range(2)
        )


@pytest.mark.parametrize(
    "values, digits, error",
    [
        ({a: 1}, 15, MissingParameterError),
        ({a: 1, b: arb(1, 0.1)}, 15, BadInputError),
        ({a: 1, b: (0, 1)}, 15, BadInputError),
        ({a: 1, b: 1}, 0, BadInputError),
        ({a: 1, b: 1}, "15", BadTypeError),
        ({a: 1, b: 1}, None, BadTypeError),
        ({a: "1", b: 1}, 15, BadTypeError),
        ({a: S.Infinity, b: 1}, 15, BadInputError),
    ],
)
def test_what_cannot_be_enclosed_is_refused(values, digits, error):
    """A parameter without value, balls too wide for the digits, digits that are no number, text, infinity."""
    with pytest.raises(error):
        MATHIEU.enclosure(values, digits)


def test_an_exact_matrix_is_a_ball_without_radius_or_nearly():
    """P = 0: the identity, whatever the digits."""
    found = FloquetMatrix(Matrix([[0, 0], [0, 0]]), t, 0).enclosure({}, 50)

    assert all(
        x.contains(int(i == j)) for (i, j), x in zip([(0, 0), (0, 1), (1, 0), (1, 1)], found.entries(), strict=True)
    )
    assert isinstance(found, arb_mat)


def test_threads_wait_for_each_other_and_change_no_digit():
    """python-flint has one precision for the whole process: 30 and 200 digits side by side, and as it was after."""
    values, wanted, before = {a: Rational(-1, 10), b: Rational(1, 2)}, [30, 200] * 3, ctx.prec

    def numbers_with(digits):
        balls = MATHIEU.enclosure(values, digits).entries()
        return MATHIEU.evaluate(values, digits=digits), [(x.mid().man_exp(), x.rad().man_exp()) for x in balls]

    assert in_threads(numbers_with, wanted) == [numbers_with(digits) for digits in wanted] and ctx.prec == before


@pytest.mark.parametrize("x", [-1e300, 10**400, 10**100000], ids=["a float", "beyond floats", "and their squares"])
def test_coefficients_too_large_for_any_number_of_steps_are_named(x):
    """Also where they are beyond all floats."""
    for ask in (MATHIEU.enclosure, MATHIEU.verdict, MATHIEU.multipliers):
        with pytest.raises(BadInputError, match=r"steps at most, but the coefficients reach 1\.00e\+(300|400|100000)"):
            ask({a: x, b: 1})
