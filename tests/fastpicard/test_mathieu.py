"""Characteristic numbers of Mathieu's equation, against tables, series, laws and three routes of other kinds."""

import json
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy
from flint import acb, arb, ctx, fmpq, fmpz
from hypothesis import assume, given, strategies as st

from fastpicard import mathieu
from fastpicard.errors import BadInputError, BadTypeError
from fastpicard.mathieu import mathieu_a, mathieu_a_enclosure, mathieu_b, mathieu_b_enclosure
from fastpicard.mathieu_matrices import Section

CASES = json.loads((Path(__file__).parent / "cases" / "mathieu_characteristic.json").read_text())["cases"]
VALUES = [case for case in CASES if "value" in case]
BOUNDARIES = [case for case in CASES if "a_article" in case]
CHARACTERISTIC = {"a": mathieu_a, "b": mathieu_b}
ENCLOSURE = {"a": mathieu_a_enclosure, "b": mathieu_b_enclosure}

orders = st.integers(1, 60)
parameters = st.fractions(-3000, 3000, max_denominator=1000).filter(bool)
digit_counts = st.integers(1, 60)


def named(case):
    """The name of a reference case, for pytest's report."""
    return case["id"]


def ball_of(x):
    """A ball around a Fraction at the working precision."""
    return arb(fmpq(x.numerator, x.denominator))


def solutions_at(turn, a, q, terms):
    """(y, y') at ``turn`` of the even and the odd solution of y'' + (a - 2 q cos 2z) y = 0, by Taylor steps."""
    step, steps = turn / 64, 64
    rows = [(arb(1), arb(0)), (arb(0), arb(1))]
    for k in range(steps):
        angle = 2 * step * k
        c, s = angle.cos(), angle.sin()
        # 2 cos 2(z + h) = sum of w_j h**j
        w = [2 * (c, -s, -c, s)[j % 4] * arb(2) ** j / arb(j).fac() for j in range(terms)]
        rows = [taylor_step(y, dy, a, q, w, step) for y, dy in rows]
    return rows


def taylor_step(y, dy, a, q, w, h):
    """One step of length h.  The remainder is not bounded, only far below the tolerance of the tests that use this."""
    series = [y, dy]
    for j in range(len(w) - 2):
        product = sum((w[i] * series[j - i] for i in range(j + 1)), arb(0))
        series.append((q * product - a * series[j]) / ((j + 1) * (j + 2)))
    value = sum((c * h**j for j, c in enumerate(series)), arb(0))
    slope = sum((j * c * h ** (j - 1) for j, c in enumerate(series) if j), arb(0))
    return value, slope


def hill_spectrum(q, odd, size):
    """All a_r and b_r of one parity of r in order, in float64: the full matrix in exp(imz), not split."""
    m = 2 * np.arange(-size, size + 1) + (1 if odd else 0)
    off = np.full(len(m) - 1, float(q))
    return np.linalg.eigvalsh(np.diag(m.astype(float) ** 2) + np.diag(off, 1) + np.diag(off, -1))


def continued_fraction(kind, r, q, a, depth=400):
    """The function of a that vanishes at the characteristic numbers of one family, mpmath, DLMF 28.4.5 to 28.4.8."""
    lowest = 1 if r % 2 else (0 if kind == "a" else 2)
    tail = mpmath.mpf(0)
    for m in range(lowest + 2 * depth, lowest, -2):
        tail = q**2 / (a - m**2 - tail)
    if lowest == 0:
        return a - 2 * tail
    return a - lowest**2 - tail - (0 if lowest == 2 else q if kind == "a" else -q)


# --- tables and series ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", VALUES, ids=named)
def test_reference_value_is_met_in_all_its_digits(case):
    """Every tabulated number to 44 of its own 45 digits."""
    value = CHARACTERISTIC[case["kind"]](case["r"], Fraction(case["q"]), digits=50)

    with mpmath.workdps(60):
        expected = mpmath.mpf(case["value"]) * (4 if "quantity" in case else 1)
        assert abs(value - expected) <= abs(expected) * mpmath.mpf(10) ** -43


@pytest.mark.parametrize("case", BOUNDARIES, ids=named)
def test_article_form_is_a_quarter_at_minus_two_b(case):
    """y'' + (a + b cos t) y = 0 has its boundaries at a = a_r(-2b)/4 and b_r(-2b)/4."""
    value = CHARACTERISTIC[case["kind"]](case["r"], -2 * Fraction(case["b_article"]), digits=55)

    with mpmath.workdps(70):
        assert abs(value / 4 - mpmath.mpf(case["a_article"])) < mpmath.mpf(10) ** -47


def test_power_series_of_b_1_has_the_published_coefficients():
    """The series in the reference cases is met up to a remainder of order q**9, at three small q."""
    (case,) = (case for case in CASES if "series_in_q" in case)
    series = sympy.Poly(sympy.sympify(case["series_in_q"]), sympy.Symbol("q"))
    coefficients = [Fraction(c.p, c.q) for c in reversed(series.all_coeffs())]
    assert len(coefficients) == 9

    for small in (Fraction(1, 50), Fraction(-1, 1000), Fraction(1, 10**6)):
        partial = sum(c * small**k for k, c in enumerate(coefficients))
        with ctx.workprec(400):
            difference = mathieu_b_enclosure(1, small, digits=80) - ball_of(partial)
            assert abs(difference) < abs(ball_of(small)) ** 9


@pytest.mark.parametrize("twice_b, printed", [
    (Fraction(1, 5), ["-0.00497832", "0.198781", "0.298719", "0.999167", "1.00414", "2.25059"]),
    (Fraction(3), ["-0.708598", "-0.696345", "0.62976", "0.81923", "1.5113", "2.30578"]),
])
def test_article_out_28_and_29_reproduce_as_printed(twice_b, printed):
    """Six boundaries each at b = 0.1 and b = 1.5, in the article's order and to its six digits."""
    values = sorted([mathieu_a(r, twice_b) for r in range(3)] + [mathieu_b(r, twice_b) for r in range(1, 4)])

    assert [mpmath.nstr(v / 4, 6) for v in values] == printed


def test_article_out_56_reproduces_as_printed():
    """Two uniform rods, h = 3/50: the slower mode mu = 3 - 6/sqrt(7) leaves a_0 at v = 27.556756338772..."""
    mu = 3 - 6 / sympy.sqrt(7)
    value = mathieu_a(0, 2 * mu * sympy.Rational(3, 50), digits=30)

    with mpmath.workdps(40):
        v = mpmath.sqrt(-4 * (3 - 6 / mpmath.sqrt(7)) / value)
        assert abs(v - mpmath.mpf("27.556756338772449091547030263")) < mpmath.mpf(10) ** -26


@pytest.mark.parametrize("r, b", [
    (1, "0.454023166867288796935291288349769231900145"),
    (2, "10.64931560607100381427488831865676343424"),
])
def test_characteristic_number_vanishes_where_the_boundary_crosses_the_axis(r, b):
    """Near a zero of a_r the digits are still significant digits; the crossing of a = 0 is met to 36 decimals."""
    value = mathieu_a(r, -2 * Fraction(b), digits=10)

    assert abs(value) < mpmath.mpf(10) ** -36


# --- routes of other kinds --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind, r, q", [("a", 0, 5), ("b", 3, -40), ("a", 1, 5000), ("a", 4, 5000), ("b", 8, 300)])
def test_continued_fraction_changes_sign_within_one_unit(kind, r, q):
    """mpmath's continued fraction has opposite signs half a unit of the 40th digit below and above our number."""
    value = CHARACTERISTIC[kind](r, q, digits=40)

    with mpmath.workdps(80):
        unit = abs(value) * mpmath.mpf(10) ** -39
        below, above = (continued_fraction(kind, r, mpmath.mpf(q), value + s * unit) for s in (-1, 1))
        assert below * above < 0
        # a zero and not a pole: the function is as small as the step
        assert abs(below) + abs(above) < mpmath.mpf(10) ** -20


@pytest.mark.parametrize("q", [0.3, 25.0, -7.5, 500.0, 5000.0])
@pytest.mark.parametrize("odd", [False, True])
def test_index_is_the_place_in_the_spectrum_of_hill_matrix(q, odd):
    """Order of the full Hill matrix: a_0 b_2 a_2 b_4 ... and, for q > 0, b_1 a_1 b_3 a_3 ..."""
    spectrum = hill_spectrum(q, odd, size=150)[:17]

    if odd:
        pairs = [v for r in range(1, 18, 2) for v in sorted([mathieu_a(r, q), mathieu_b(r, q)])]
    else:
        pairs = [mathieu_a(0, q)] + [v for r in range(2, 18, 2) for v in (mathieu_b(r, q), mathieu_a(r, q))]
    np.testing.assert_allclose([float(v) for v in pairs[:17]], spectrum, rtol=1e-11, atol=1e-9)


@pytest.mark.parametrize("kind, r, q, scipy_says", [
    ("a", 21, 100, 375.2563997038456), ("a", 14, 140, 302.0492846744463), ("a", 16, 160, 368.3684560112401),
    ("a", 24, 200, 358.9949172809389), ("a", 1, 5000, 9796.652548135782), ("a", 4, 5000, -9296.158884752638),
])
def test_branches_that_scipy_confuses_are_right(kind, r, q, scipy_says):
    """SciPy 1.17.1 is off by whole branches; Hill's matrix and the continued fraction agree with us."""
    value = CHARACTERISTIC[kind](r, q, digits=40)
    # q > 0: b_1 a_1 b_3 a_3 ..., a_0 b_2 a_2 b_4 a_4 ...
    place = r - 1 + (kind == "a") if r % 2 else r - (kind == "b")

    np.testing.assert_allclose(float(value), hill_spectrum(q, r % 2 == 1, 200)[place], rtol=1e-10)
    assert abs(float(value) - scipy_says) > 30
    with mpmath.workdps(80):
        assert abs(continued_fraction(kind, r, mpmath.mpf(q), value)) < mpmath.mpf(10) ** -25


@pytest.mark.parametrize("q", [400, 10000])
def test_index_is_right_where_neither_expansion_holds(q):
    """Around r = 4 sqrt(q)/pi, where large q goes over into large r, against Hill's matrix; both kinds, all r."""
    spectra = hill_spectrum(q, False, 200), hill_spectrum(q, True, 200)
    root = int(q**0.5)
    for r in range(root // 2, 2 * root, 1 + root // 10):
        for kind in "ab":
            place = r - 1 + (kind == "a") if r % 2 else r - (kind == "b")
            expected = spectra[r % 2][place]
            assert abs(float(CHARACTERISTIC[kind](r, q)) - expected) < 1e-9 * q


@pytest.mark.parametrize("kind, r, q", [("a", 0, 1), ("a", 1, -5), ("b", 2, 10), ("b", 7, 3), ("a", 8, 25)])
def test_solution_by_taylor_steps_is_periodic_where_the_number_says(kind, r, q):
    """At a_r the even solution has slope 0 at pi/2 (r even) or value 0; at b_r the odd one value 0 or slope 0."""
    with ctx.workprec(400):
        a = ENCLOSURE[kind](r, q, digits=60)
        even, odd = solutions_at(arb.pi() / 2, a, arb(q), terms=60)
        y, slope = even if kind == "a" else odd
        vanishing = (slope if r % 2 == 0 else y) if kind == "a" else (y if r % 2 == 0 else slope)
        assert abs(vanishing) < arb(10) ** -45


@pytest.mark.parametrize("kind, r, s", [("a", 0, 1), ("b", 1, 1), ("a", 3, 7), ("b", 4, 7), ("a", 20, 41)])
@pytest.mark.parametrize("q", [10**6, -(10**6) - 0.5])
def test_large_q_follows_the_asymptotic_series(kind, r, s, q):
    """DLMF 28.8.1: a_r, b_(r+1) ~ -2q + 2 s sqrt(q) - (s**2 + 1)/8 - (s**3 + 3 s)/(2**7 sqrt(q)), s = 2r + 1."""
    size = abs(q)
    if q < 0 and r % 2:
        kind = "b" if kind == "a" else "a"
    h = size**0.5
    expected = -2 * size + 2 * s * h - (s**2 + 1) / 8 - (s**3 + 3 * s) / (128 * h)
    next_term = (5 * s**4 + 34 * s**2 + 9) / (4096 * size)

    assert abs(float(CHARACTERISTIC[kind](r, q, digits=20)) - expected) < 2 * next_term + 1e-8


# --- the proof itself -------------------------------------------------------------------------------------------------


@given(st.sampled_from("ab"), st.integers(1, 9), st.fractions(-30, 30, max_denominator=8), st.integers(2, 9),
       st.integers(0, 60), st.sampled_from([-1, 1]))
def test_count_of_a_short_section_is_undecided_or_that_of_the_infinite_matrix(kind, r, q, extra, decimals, side):
    """Beside a_r, by 10**-decimals, sections of any length never miscount: what they cannot see they call undecided."""
    matrix = mathieu._matrix(kind, r)
    with ctx.workprec(400):
        x = (ENCLOSURE[kind](r, q, digits=80) + side * arb(10) ** -decimals).mid()
        near = abs(x - ENCLOSURE[kind](r, q, digits=80)) < 1
        rows = matrix.index + extra
        for peak in range(rows - 1):
            section = Section(matrix.diagonal(ball_of(q), rows + 1), matrix.couplings(ball_of(q), rows + 1),
                              peak, abs(ball_of(q)))
            assert not near or section.count_below(x) in (None, matrix.index + (side > 0))


def test_long_section_decides_on_both_sides_of_a_number():
    """Not everything is undecided: forty rows see 60 decimals of b_4(7)."""
    matrix = mathieu._matrix("b", 4)
    with ctx.workprec(400):
        section = Section(matrix.diagonal(arb(7), 41), matrix.couplings(arb(7), 41), 1, arb(7))
        x = mathieu_b_enclosure(4, 7, digits=80).mid()
        assert [section.count_below(x + side * arb(10) ** -60) for side in (-1, 1)] == [1, 2]


def test_section_is_undecided_above_its_tail():
    """Two rows, x = 60 above 1, 9, 25, 49: the tail is not positive, so its eigenvalues must not be left uncounted."""
    matrix = mathieu._matrix("a", 1)
    q = arb(0.125)
    section = Section(matrix.diagonal(q, 3), matrix.couplings(q, 3), 0, q)

    assert section.count_below(arb(60)) is None
    assert section.count_below(arb(5)) == 1


@pytest.mark.parametrize("shift", [-1e-9, 1e-9, -5.0, 5.0])
def test_wrong_guess_is_never_certified(monkeypatch, shift):
    """Newton led astray, by a little or to a neighbour, ends in a refusal and not in a number."""
    refine = Section.refine
    monkeypatch.setattr(Section, "refine", lambda *args: refine(*args) + arb(shift))

    with pytest.raises(BadInputError, match="not isolated"):
        mathieu_a(4, 3)


# --- laws -------------------------------------------------------------------------------------------------------------


@given(orders, parameters, digit_counts)
def test_characteristic_numbers_interlace(r, q, digits):
    """a_0 < b_1 < a_1 < b_2 ... for q > 0: no ball contradicts it; a_(r-1) < a_r shows from 12 digits on."""
    q = abs(q)
    a_before, b, a = (ball(k, q, digits) for ball, k in
                      ((mathieu_a_enclosure, r - 1), (mathieu_b_enclosure, r), (mathieu_a_enclosure, r)))

    assert not a_before > b
    assert not b > a
    assert a_before < a or digits < 12


@pytest.mark.parametrize("r, q, digits", [(0, 25, 30), (5, 1000, 60), (0, 10**6, 1760)])
def test_nearly_equal_a_and_next_b_are_separated_at_large_q(r, q, digits):
    """b_(r+1) - a_r is positive and near exp(-4 sqrt(q)) 2**(4r + 5) sqrt(2/pi) q**(r/2 + 3/4) / r! (DLMF 28.8.2)."""
    with ctx.workprec(4 * digits + 64):
        gap = mathieu_b_enclosure(r + 1, q, digits) - mathieu_a_enclosure(r, q, digits)

    with mpmath.workdps(30):
        size = mpmath.mpf(q)
        factor = 2 ** (4 * r + 5) / mpmath.factorial(r) * mpmath.sqrt(2 / mpmath.pi)
        leading = factor * size ** (mpmath.mpf(r) / 2 + 0.75) * mpmath.exp(-4 * mpmath.sqrt(size))
        ratio = gap / arb(leading)
    assert gap > 0
    assert 0.2 < ratio < 1.05


@pytest.mark.parametrize("r, q", [(5, Fraction(1, 1000)), (9, Fraction(1, 10**4)), (3, Fraction(1, 10**22))])
def test_nearly_equal_a_and_b_are_separated_at_small_q(r, q):
    """a_r - b_r = 2 q**r / (2**(r-1) (r-1)!)**2 (1 + O(q)), DLMF 28.6.15: at 1e-22, r = 3, the 66th decimal."""
    with ctx.workprec(500):
        gap = mathieu_a_enclosure(r, q, digits=110) - mathieu_b_enclosure(r, q, digits=110)
    leading = 2 * q**r / (2 ** (r - 1) * sympy.factorial(r - 1).p) ** 2

    assert abs(gap / arb(fmpq(leading.numerator, leading.denominator)) - 1) < 0.01


@given(orders, parameters, digit_counts)
def test_sign_of_q_exchanges_a_and_b_of_odd_order_only(r, q, digits):
    """a_2n(-q) = a_2n(q), b_2n(-q) = b_2n(q), a_(2n+1)(-q) = b_(2n+1)(q): DLMF 28.2.26-28; equality."""
    a, b = mathieu_a(r, q, digits), mathieu_b(r, q, digits)

    assert (mathieu_a(r, -q, digits), mathieu_b(r, -q, digits)) == ((b, a) if r % 2 else (a, b))


@given(st.sampled_from("ab"), orders, parameters, digit_counts)
def test_digits_are_those_of_twice_as_many_rounded(kind, r, q, digits):
    """Rounding d digits of 2d + 5 gives the d digits asked for: the result is correctly rounded, not just close."""
    short, long = CHARACTERISTIC[kind](r, q, digits), CHARACTERISTIC[kind](r, q, 2 * digits + 5)

    with mpmath.workdps(200):
        assert mpmath.nstr(long, digits) == mpmath.nstr(short, digits)


@given(st.sampled_from("ab"), orders, parameters, digit_counts)
def test_enclosure_is_as_narrow_as_asked_and_contains_the_number(kind, r, q, digits):
    """The radius is at most 10**-digits of the number, and finer balls overlap it."""
    ball, finer = ENCLOSURE[kind](r, q, digits), ENCLOSURE[kind](r, q, digits + 20)

    assert ball.contains(finer.mid())
    assert ball.rad() <= abs(ball) / arb(10) ** digits


@given(st.sampled_from("ab"), st.integers(0, 40))
def test_zero_q_gives_the_square_of_r_exactly(kind, r):
    """a_r(0) = b_r(0) = r**2, whatever the digits."""
    assume(kind == "a" or r > 0)

    assert CHARACTERISTIC[kind](r, 0, digits=1) == r**2
    assert ENCLOSURE[kind](r, sympy.Integer(0)).unique_fmpz() == r**2


@given(st.integers(1, 300), st.floats(-1e6, 1e6, allow_nan=False).filter(lambda q: abs(q) > 1e-9))
def test_weyl_bounds_the_distance_from_r_squared(r, q):
    """|a_r - r**2| <= 2|q|, also for r of a few hundred and |q| up to a million."""
    for enclosure in ENCLOSURE.values():
        assert not abs(enclosure(r, q) - r**2) > 2 * arb(abs(q))


# --- kinds of q, digits and r -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("q", [
    3, Fraction(3), 3.0, mpmath.mpf(3), sympy.Integer(3), fmpz(3), fmpq(3), arb(3), np.int64(3), np.float64(3),
    np.float32(3), arb(3, 1e-40)])
def test_every_kind_of_number_means_the_same_q(q):
    """q = 3 in twelve guises."""
    assert mathieu_a(2, q, 20) == mathieu_a(2, 3, 20)


def test_float_is_the_binary_number_it_is():
    """0.1 is not 1/10: 40 digits tell them apart, and the float's answer is that of its exact value."""
    assert mathieu_b(1, 0.1, 40) == mathieu_b(1, Fraction(0.1), 40) != mathieu_b(1, Fraction(1, 10), 40)


@pytest.mark.parametrize("q, close", [
    (sympy.pi - sympy.E, mpmath.pi - mpmath.e), (sympy.cos(1) * sympy.exp(2), mpmath.cos(1) * mpmath.exp(2)),
    (sympy.log(sympy.Rational(7, 3)) + sympy.sin(2), mpmath.log(mpmath.mpf(7) / 3) + mpmath.sin(2)),
    (2 ** sympy.Rational(1, 3) - sympy.tan(1) ** 3, mpmath.mpf(2) ** (mpmath.mpf(1) / 3) - mpmath.tan(1) ** 3),
], ids=str)
def test_exact_sympy_numbers_keep_all_digits(q, close):
    """A SymPy number is enclosed at the precision the digits need: it is not its float."""
    value = mathieu_a(3, q, digits=60)

    assert abs(value - mathieu_a(3, close)) < 1e-12
    with mpmath.workdps(80):
        assert abs(value - mathieu_a(3, mpmath.mpf(sympy.N(q, 80)._mpf_), digits=60)) < mpmath.mpf(10) ** -57


def test_ball_contains_the_number_of_every_point_of_q():
    """A wide q gives a ball that holds a_3 at its ends and middle, no wider than twice q beyond rounding."""
    ball = mathieu_a_enclosure(3, arb(2, 0.001), digits=30)

    for q in (Fraction(1999, 1000), 2, Fraction(2001, 1000)):
        assert ball.contains(mathieu_a_enclosure(3, q, digits=30))
    assert ball.rad() < 0.0021


def test_global_precisions_are_left_alone():
    """mpmath's and python-flint's working precisions neither change nor matter."""
    before = mpmath.mp.prec, ctx.prec
    value = mathieu_a(5, 20, digits=100)
    assert (mpmath.mp.prec, ctx.prec) == before

    with mpmath.workdps(3), ctx.workprec(10):
        assert mathieu_a(5, 20, digits=100) == value


def test_import_needs_no_scipy():
    """Characteristic numbers are there without SciPy."""
    program = "import sys, fastpicard.mathieu; sys.exit('scipy' in sys.modules)"
    root = Path(__file__).resolve().parents[2]

    assert subprocess.run([sys.executable, "-c", program], cwd=root, check=False).returncode == 0


def test_tie_broken_only_in_the_31st_decimal_is_rounded_right():
    """b_1(q) = 1 - q - q**2/8 ... at q = 5e-16 lies below the tie 0.9999999999999995 of 15 digits by 3e-32."""
    assert mpmath.nstr(mathieu_b(1, Fraction(5, 10**16), 15), 15) == "0.999999999999999"


@pytest.mark.parametrize("r, q, digits, word", [
    (-1, 1, 15, "-1"), (0, float("nan"), 15, "nan"), (0, float("inf"), 15, "inf"), (0, sympy.oo, 15, "oo"),
    (0, mpmath.nan, 15, "nan"), (0, 1, 0, "0"), (0, 1, -3, "-3"), (0, 1, 10**9, "at most 10000000"),
    (0, 10**40, 15, "rows"), (10**160, 1, 15, "rows"), (3, arb(2, 0.001), 15, "ball"), (0, arb(0, 1e-30), 15, "ball"),
])
def test_question_without_an_answer_is_refused_with_its_value(r, q, digits, word):
    """The value at fault stands in the message."""
    with pytest.raises(BadInputError, match=word):
        mathieu_a(r, q, digits)


def test_order_zero_has_no_odd_solution():
    """b_0 does not exist."""
    with pytest.raises(BadInputError, match=r"r >= 1.*r = 0"):
        mathieu_b(0, 1)


@pytest.mark.parametrize("q", [
    "1", "__import__('os')", 1j, mpmath.mpc(1), acb(1), sympy.Symbol("q"), sympy.I, None, True, [1], np.array([1.0]),
], ids=repr)
def test_q_that_is_no_real_number_is_refused_by_kind(q):
    """Text, complex and symbolic values and containers are not numbers q."""
    with pytest.raises(BadTypeError, match="text is never evaluated" if isinstance(q, str) else "real number"):
        mathieu_a(0, q)


@pytest.mark.parametrize("r, digits", [(1.0, 15), ("1", 15), (True, 15), (None, 15), (1, 15.0), (1, "15"), (1, True)])
def test_counts_must_be_integers(r, digits):
    """r and digits count something."""
    with pytest.raises(BadTypeError, match="must be an integer"):
        mathieu_b(r, 1, digits)


@pytest.mark.parametrize("r, q, digits", [(0, 10**6, 1), (0, 10**9, 2), (2, -(10**12), 3), (1, 10**15, 5)])
def test_few_digits_are_as_good_as_many(r, q, digits):
    """The next eigenvalue is much nearer than the last of so few digits."""
    few, many = mathieu_a_enclosure(r, q, digits), mathieu_a_enclosure(r, q, 60)

    assert few.overlaps(many) and few.rel_accuracy_bits() > 3.32 * digits


def test_very_large_q_against_the_asymptotic_series():
    """DLMF 28.8.1 with s = 2 r + 1: -2 q + 2 s sqrt(q) - (s**2 + 1)/8 - (s**3 + 3 s)/(128 sqrt(q)) - ..."""
    for r in (0, 3):
        s, root = 2 * r + 1, 10**9
        with mpmath.workdps(40):
            series = -2 * root**2 + 2 * s * root - mpmath.mpf(s**2 + 1) / 8 - mpmath.mpf(s**3 + 3 * s) / (128 * root)
            assert abs(mathieu_a(r, root**2, 35) - series) < mpmath.mpf(10) ** -14
