"""Integrals of Poisson series: against SymPy, quadrature and the article's recursion."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy
from hypothesis import given, settings, strategies as st
from sympy import I, Matrix, Rational, Symbol, cos, exp, pi, sin, sqrt

from fastpicard import FundamentalMatrix, PoissonSeries, new_integrate
from tests.oracles import closeness, plain_expression, plain_integral, quadrature, same_tree, vanishes
from tests.strategies import VALUES, a, b, c, expressions, phi, plain_expressions, plain_series, rationals, t, t0, w


@given(plain_series(most_power=6, most=4))
def test_integrals_are_those_of_the_articles_recursion(series):
    """(8) and (9) on a plain dictionary of Fractions, with the constant that makes them vanish at 0."""
    assert same_tree(new_integrate(plain_expression(series), t), plain_expression(plain_integral(series)))


@given(
    st.integers(0, 100),
    st.sampled_from([Fraction(1), Fraction(-3), Fraction(7, 5), Fraction(1, 9), Fraction(20)]),
    st.sampled_from(["cos", "sin"]),
)
def test_powers_up_to_a_hundred_are_integrated_exactly(r, q, kind):
    """t**100 cos(q t): every coefficient by the recursion, for frequencies of either sign."""
    function = {"cos": cos, "sin": sin}[kind]
    sign = -1 if q < 0 and kind == "sin" else 1
    expected = plain_expression(plain_integral({(r, abs(q), kind, (0, 0)): Fraction(sign)}))

    assert new_integrate(t**r * function(Rational(q) * t), t) == expected


ROOTS = [sqrt(6), 1 - sqrt(2), sqrt(2) + sqrt(6), sqrt(8) - 3, 1 + sqrt(2) + sqrt(3) - sqrt(5) / 2, sqrt(15) - sqrt(3)]


@pytest.mark.parametrize("frequency", ROOTS, ids=str)
@given(st.integers(0, 12), st.booleans(), rationals)
@settings(max_examples=30)
def test_frequencies_with_roots_are_divided_by_through_their_conjugates(frequency, r, even, phase):
    """One root to three, and products of them: the derivative gives the integrand back, and the value at 0 is 0."""
    x = PoissonSeries(sqrt(3) * t**r * (cos if even else sin)(frequency * t + phase) + a * t**2, t)
    found = x.integrate()

    assert found.diff() == x
    assert found(0) == 0


@pytest.mark.parametrize("frequency", ROOTS, ids=str)
def test_integrals_with_roots_in_the_frequency_are_those_of_quadrature(frequency):
    """To 30 digits, from 0 to 3."""
    x = t**4 * cos(frequency * t + 1)
    assert closeness(PoissonSeries(x, t).integrate().evaluate(3, {}, 30), quadrature(x, t, 0, 3)) < 1e-25


@given(expressions, rationals, rationals)
def test_definite_integrals_add_up(x, lower, upper):
    """From lower to upper = from 0 to upper less from 0 to lower; reversed limits change the sign."""
    there, back = new_integrate(x, (t, lower, upper)), new_integrate(x, (t, upper, lower))
    primitive = PoissonSeries(x, t).integrate()

    assert sympy.expand(there + back) == 0
    assert PoissonSeries(there, t) == PoissonSeries(primitive(upper), t) - primitive(lower)


@given(plain_expressions, rationals)
def test_a_symbolic_limit_may_be_replaced_by_its_value(x, value):
    """Integrating up to u and then putting u = value is integrating up to the value."""
    u = Symbol("u")
    found = new_integrate(x, (t, t0, u)).xreplace({u: value, t0: sympy.Integer(1)})

    assert sympy.expand(found - new_integrate(x, (t, 1, value))) == 0


@pytest.mark.parametrize(
    "x",
    [
        t**3 * cos(2 * t),
        t * sin(t / 2),
        a * t + b * cos(t),
        sin(t) * cos(3 * t),
        t**2 * exp(I * t) + t**2 * exp(-I * t),
        sin(t + 1),
        cos(pi * t),
        t * cos(sqrt(2) * t),
    ],
    ids=str,
)
def test_integrals_differ_from_sympys_by_no_more_than_a_constant(x):
    """SymPy integrates the small ones; ours is its primitive less the value at 0."""
    theirs = sympy.integrate(sympy.expand(x), t)

    assert vanishes(new_integrate(x, t) - theirs + theirs.subs(t, 0))


@pytest.mark.parametrize(
    "x, lower, upper",
    [
        (t**4 * cos(3 * t), 0, 2 * pi),
        (t**2 * sin(w * t + phi), Rational(-1, 2), 3),
        (a * t * cos(t) ** 3, 3, 1),
        (cos(sqrt(2) * t) * cos(t), 0, 10),
        (t**3 * cos(t * (w - 1)) / (b + c), -2, 2),
        (sin(100 * t), 0, 1),
        (t**9 * sin(t / 7), 0, 5),
        (cos(t - t0) * t, t0, pi),
        (exp(I * t) + exp(-I * t), -1, 1),
    ],
    ids=str,
)
def test_definite_integrals_agree_with_quadrature(x, lower, upper):
    """Thirty digits by mpmath."""
    found = new_integrate(x, (t, lower, upper)).subs(VALUES)
    expected = quadrature(
        sympy.expand(x.subs(VALUES)).rewrite(cos).simplify() if x.has(I) else x.subs(VALUES),
        t,
        sympy.S(lower).subs(VALUES),
        sympy.S(upper).subs(VALUES),
    )

    assert closeness(str(sympy.N(found, 40, maxn=1000)), expected) < mpmath.mpf(10) ** -28


def test_a_frequency_that_becomes_zero_afterwards_is_the_limit():
    """I[t**r cos(q t)] at q -> 0: the generic result tends to the special one; put in first it is exact."""
    q = Symbol("q")
    for r in range(4):
        generic = new_integrate(t**r * cos(q * t), t)
        assert sympy.limit(generic.subs(t, 2), q, 0) == new_integrate(t**r, (t, 0, 2))
        assert new_integrate((t**r * cos(q * t)).subs(q, 0), t) == t ** (r + 1) / (r + 1)
        assert new_integrate((t**r * sin(q * t)).subs(q, 0), t) == 0


@pytest.mark.parametrize(
    "nothing",
    [
        w / (w + 1) + 1 / (w + 1) - 1,
        sympy.GoldenRatio - (1 + sqrt(5)) / 2,
        sqrt(3 + 2 * sqrt(2)) - 1 - sqrt(2),
        sympy.log(6) - sympy.log(2) - sympy.log(3),
        sympy.cosh(a) ** 2 - sympy.sinh(a) ** 2 - 1,
    ],
    ids=str,
)
def test_a_frequency_that_vanishes_identically_is_no_frequency(nothing):
    """Read as one or met as a sum: the power of t rises, and nothing is divided by."""
    assert new_integrate(t * cos(nothing * t + phi), t) == t**2 * cos(phi) / 2
    assert new_integrate(sin(nothing * t), t) == 0
    left, *others = nothing.args
    wave = PoissonSeries(cos(left * t), t) * PoissonSeries(cos(sympy.Add(*others) * t), t)
    assert t / 2 in wave.integrate().as_expr().args


def test_a_symbol_that_is_zero_is_zero():
    """As a frequency, a phase and a coefficient."""
    nothing = Symbol("o", zero=True)

    assert new_integrate(cos(nothing * t + nothing), t) == t
    assert PoissonSeries(a * nothing * t + b, t) == b


def test_resonance_by_a_relation_between_parameters_is_resonance():
    """w/(w + 1) + 1/(w + 1) = 1: the iterate with the symbol is, at w = 17/5, that of the system with the number."""
    value = Rational(17, 5)
    P = Matrix([[cos(w * t / (w + 1)) + cos(t / (w + 1)) + cos(t)]])
    found = FundamentalMatrix(P, t, 3)[0, 0].evaluate(3, {w: value}, digits=30)
    expected = FundamentalMatrix(P.subs(w, value), t, 3)[0, 0].evaluate(3, digits=30)

    assert closeness(found, expected) < mpmath.mpf(10) ** -28


def test_the_antiderivative_of_sin_holds_the_constant_of_the_article():
    """I[sin 2t] = 1/2 - cos(2t)/2; the constant makes it vanish at 0."""
    assert new_integrate(sin(2 * t), t) == Rational(1, 2) - cos(2 * t) / 2
    assert new_integrate(t * sin(t), t) == sin(t) - t * cos(t)
    assert new_integrate(0, t) == 0
    assert new_integrate(3, t) == 3 * t


@pytest.mark.parametrize("upper", [t, pi, 0, w, t0 + 1, Rational(7, 3), sqrt(2), 2 * pi * w], ids=str)
def test_limits_may_be_numbers_symbols_and_the_variable_itself(upper):
    """The variable of integration is bound: as a limit t is another t."""
    assert vanishes(new_integrate(a * cos(t) + t, (t, 0, upper)) - a * sin(upper) - upper**2 / 2)
    assert vanishes(new_integrate(a * cos(t) + t, (t, upper, upper)))


def test_matrices_are_integrated_entry_by_entry():
    """The shape and the type of the matrix stay."""
    M = Matrix([[cos(t), a], [t, 0]])

    assert new_integrate(M, t) == Matrix([[sin(t), a * t], [t**2 / 2, 0]])
    assert new_integrate(M.as_immutable(), (t, 0, pi)) == Matrix([[0, pi * a], [pi**2 / 2, 0]])


@given(st.integers(1, 6), st.integers(0, 5))
def test_the_same_integral_twice_is_the_same(q, r):
    """What is remembered does not change: exact and dyadic frequencies have keys of their own."""
    exact, dyadic = t**r * cos(q * t / 10), t**r * cos(q * 0.1 * t)

    assert new_integrate(exact, t) == new_integrate(exact, t)
    assert PoissonSeries(dyadic, t).integrate().diff() == PoissonSeries(t**r * cos(Rational(q * 0.1) * t), t)


@pytest.mark.parametrize("half", [0.5, np.float64(0.5), np.float32(0.5), mpmath.mpf(0.5), sympy.Float(0.5)])
def test_a_float_as_a_limit_or_a_time_is_the_dyadic_number_it_is(half):
    """Exactly the result for 1/2; in floats t**20 cos(t) loses every digit."""
    f = PoissonSeries(t**20 * cos(t), t)

    assert new_integrate(t**20 * cos(t), (t, 0, half)) == f.integrate()(Rational(1, 2))
    assert new_integrate(t**20 * cos(t), (t, -half, a)) == f.integrate()(a) - f.integrate()(Rational(-1, 2))
    assert f.integrate()(half) == f.integrate()(Rational(1, 2))
    assert f(a * half) == f(a / 2)
