"""Solutions and exponents of Mathieu's equation: against SciPy where it is right, mpmath and closed forms."""

from fractions import Fraction

import mpmath
import pytest
from flint import arb
from hypothesis import example, given, settings, strategies as st
from scipy.special import mathieu_cem, mathieu_sem
from sympy import Rational, Symbol, cos, pi, sin, sqrt

from fastpicard import BadInputError, BadTypeError, mathieu_a, mathieu_b, mathieu_c, mathieu_exponent, mathieu_s


@pytest.mark.parametrize("r, q, z", [(0, 1.0, 0.7), (1, 3.0, 2.0), (2, 5.0, -1.2), (4, 10.0, 5.5)])
def test_periodic_solutions_are_those_of_scipy(r, q, z):
    """ce_r(z)/ce_r(0) and se_r(z)/se_r'(0), SciPy's angles in degrees, its slopes by z."""
    degrees = float(mpmath.degrees(z))
    even = mathieu_cem(r, q, degrees)[0] / mathieu_cem(r, q, 0)[0]
    assert float(mathieu_c(mathieu_a(r, q, 30), q, z)) == pytest.approx(even, abs=1e-8)
    if r > 0:
        odd = mathieu_sem(r, q, degrees)[0] / mathieu_sem(r, q, 0)[1]
        assert float(mathieu_s(mathieu_b(r, q, 30), q, z)) == pytest.approx(odd, abs=1e-8)


@settings(max_examples=8)
@given(st.floats(-3, 9), st.floats(-4, 4), st.floats(-3, 3))
def test_solutions_agree_with_an_integrator_of_another_house(a, q, z):
    """mpmath's Taylor integrator, 20 digits."""
    with mpmath.workdps(25):
        for start, found in (([1, 0], mathieu_c(a, q, z, 20)), ([0, 1], mathieu_s(a, q, z, 20))):
            f = mpmath.odefun(lambda x, u: [u[1], -(a - 2 * q * mpmath.cos(2 * x)) * u[0]], 0, start)
            # The integrator goes forward; solutions are even and odd.
            value = f(abs(mpmath.mpf(z)))[0] * (1 if start[0] or z > 0 else -1)
            assert abs(found - value) < 1e-15 * max(1, abs(value))


@pytest.mark.parametrize("z", [1000, -1e6, 10**12])
def test_far_away_they_cost_what_they_cost_over_one_period(z):
    """Where q = 0 cos and sin of sqrt(2) z; elsewhere y(z + pi) + y(z - pi) = 2 w_I(pi) y(z)."""
    with mpmath.workdps(40):
        assert abs(mathieu_c(2, 0, z, 20) - mpmath.cos(mpmath.sqrt(2) * z)) < 1e-19
        for a, q in ((2, 0.3), (-0.1, 0.4)):
            for y in (mathieu_c, mathieu_s):
                before, here, after = (y(a, q, z + k * mpmath.pi, 30) for k in (-1, 0, 1))
                cosine = mathieu_c(a, q, +mpmath.pi, 35)
                assert abs(before + after - 2 * cosine * here) < 1e-20 * max(1, abs(here))


def test_too_far_away_is_refused():
    """Powers of a matrix go to 2**63."""
    with pytest.raises(BadInputError, match="periods at most"):
        mathieu_c(2, 1, 10**30)


def test_at_zero_they_are_one_and_nothing():
    """Exactly, not a ball around 0."""
    assert mathieu_c(2, 3, 0) == 1 and mathieu_s(2, 3, 0) == 0


@pytest.mark.parametrize(
    "value, a, z",
    [
        (mathieu_c, 1, pi / 2),
        (mathieu_c, pi**2 / 4, -1),
        (mathieu_c, mpmath.pi, sqrt(pi) / 2),
        (mathieu_s, 1, pi),
        (mathieu_s, 100, -(10**6) * pi),
        (mathieu_s, 1, sin(1) ** 2 + cos(1) ** 2 - 1),
    ],
)
@pytest.mark.parametrize("digits", [1, 30])
def test_zeros_are_zero(value, a, z, digits):
    """No digits tell cos(pi/2) from 0; 4096 bits beyond them settle it, also for an argument SymPy leaves as it is."""
    assert value(a, 0, z, digits) == 0


@pytest.mark.parametrize("exponent", [20, 2000])
def test_a_small_value_is_not_taken_to_be_zero(exponent):
    """w_II(z) = z + O(z**3) at 1e-2000, though that is more than 4096 bits below 1; 1e-900 from a zero of w_I."""
    small = Fraction(1, 10**exponent)
    assert mathieu_s(1, 1, small) == mpmath.mpf(small.numerator) / small.denominator
    near = mathieu_c(1, 0, pi / 2 - Rational(1, 10**900), 5)
    assert mpmath.nstr(near, 5) == "1.0e-900"


@settings(max_examples=30)
@given(st.floats(0.1, 30))
@example(1.0)  # squares are on a boundary
@example(4.0)
@example(9.0)
def test_without_q_they_are_circular(a):
    """cos sqrt(a) z, sin(sqrt(a) z)/sqrt(a), nu the distance of sqrt(a) from an even number."""
    root = mpmath.sqrt(mpmath.mpf(a))
    assert abs(mathieu_c(a, 0, 2) - mpmath.cos(2 * root)) < 1e-13
    assert abs(mathieu_s(a, 0, 2) - mpmath.sin(2 * root) / root) < 1e-13
    nu = mathieu_exponent(a, 0)
    assert nu.imag == 0 and abs(nu.real - abs(root - 2 * mpmath.nint(root / 2))) < 1e-13


@pytest.mark.parametrize("a, nu", [(0, 0), (10**40 + 1, "5e-21"), (-10**30, 10**15 * 1j), (10**40, 0)])
def test_without_q_exponents_have_all_their_digits(a, nu):
    """sqrt(10**40 + 1) is 10**20 + 5e-21."""
    assert mpmath.nstr(mathieu_exponent(a, 0), 15) == mpmath.nstr(mpmath.mpc(nu), 15)


@pytest.mark.parametrize("a, z", [(10**10, 3), (10**20, Fraction(1, 3)), (-10**10, 1), (10**8, 10**9)])
def test_without_q_fast_solutions_take_few_steps(a, z):
    """One step and powers of it, for the equation is autonomous; cos(sqrt(a) z)."""
    with mpmath.workdps(60):
        expected = mpmath.cos(mpmath.sqrt(a) * mpmath.mpf(z.numerator) / z.denominator).real
        assert abs(mathieu_c(a, 0, z, 20) / expected - 1) < 1e-19


@settings(max_examples=30)
@given(st.fractions(-2, 9, max_denominator=50), st.fractions(0, 5, max_denominator=50), st.integers(15, 40))
def test_the_exponent_is_the_period_of_the_solution(a, q, digits):
    """cos(pi nu) = w_I(pi), in the digits asked for; real exactly where w_I(pi) is within [-1, 1]."""
    nu = mathieu_exponent(a, q, digits)
    value = mathieu_c(a, q, mpmath_pi(digits + 30), digits + 10)
    with mpmath.workdps(digits + 10):
        assert abs(mpmath.cos(mpmath.pi * nu) - value) < mpmath.mpf(10) ** (2 - digits) * max(1, abs(value))
        assert (nu.imag == 0) == (abs(value) < 1) or q == 0 and abs(value) == 1
        assert 0 <= nu.real <= 1 and nu.imag >= 0


def mpmath_pi(digits):
    """pi as a number with so many digits."""
    with mpmath.workdps(digits):
        return +mpmath.pi


@pytest.mark.parametrize("a, q, about", [(-(10**6), 1, 1000j), (10**6 + 1, 1, None), (0, 10**5, None)])
def test_the_exponent_is_found_where_solutions_grow_or_turn_fast(a, q, about):
    """cos(pi nu) = w_I(pi); deep in the first zone nu is near i sqrt(-a)."""
    nu = mathieu_exponent(a, q, 12)
    value = mathieu_c(a, q, pi, 12)
    with mpmath.workdps(12):
        assert about is None or abs(nu - about) < 1e-3
        assert abs(mpmath.cospi(nu) - value) < 1e-5 * abs(value)


def test_balls_with_a_radius_have_the_digits_that_they_fix():
    """nu of every point of a ball to 5 digits, or a refusal that shows what is known."""
    for narrow in ((arb(1, 1e-10), 1), (1, arb(1, 1e-10))):
        assert mpmath.nstr(mathieu_exponent(*narrow, 5), 5) == "(1.0 + 0.45345j)"
    for wide in ((arb(1, 1e-2), 1), (1, arb(1, 1e-2)), (arb(4, 1e-2), 0), (arb(3, 10), 1)):
        with pytest.raises(BadInputError, match=r"5 digits of nu cannot be had: at a = .* lies in .*narrower balls"):
            mathieu_exponent(*wide, 5)


@pytest.mark.parametrize("huge", [10**100000, mpmath.mpf("-1e100000")], ids=["int", "mpf"])
def test_parameters_beyond_floats_are_named(huge):
    """They would take too many steps."""
    for ask in (lambda: mathieu_c(huge, 1, 1), lambda: mathieu_s(1, huge, 1), lambda: mathieu_exponent(1, huge)):
        with pytest.raises(BadInputError, match=r"\d+ steps at most, but the coefficients reach \d.00e\+100000"):
            ask()


def test_digits_that_are_none_are_refused_with_digits_that_would_do():
    """None is no answer here, so that no message may say so."""
    for digits, error in ((0, BadInputError), (None, BadTypeError), ("15", BadTypeError)):
        for ask in (lambda d: mathieu_c(1, 1, 1, d), lambda d: mathieu_exponent(1, 1, d)):
            with pytest.raises(error, match=f"^digits must be .* but it is {digits!r}.  Use digits=(15|50, say)."):
                ask(digits)


def test_a_boundary_has_no_exponent_of_its_own():
    """a_2(1) to 700 digits: no ball can say on which side of it."""
    with pytest.raises(BadInputError, match="characteristic number"):
        mathieu_exponent(mathieu_a(2, 1, 700), 1)


@pytest.mark.parametrize(
    "arguments, error",
    [
        (("1", 1, 1), BadTypeError),
        ((1, 1j, 1), BadTypeError),
        ((1, Symbol("q"), 1), BadTypeError),
        ((1, float("inf"), 1), BadInputError),
        ((1, arb(1, 0.1), 1), BadInputError),
        ((1, 1, 1, 0), BadInputError),
        ((1, 1, 1, None), BadTypeError),
    ],
)
def test_bad_arguments_are_refused(arguments, error):
    """Text, complex numbers, symbols, infinities, balls too wide, digits that are none."""
    with pytest.raises(error):
        mathieu_c(*arguments)
