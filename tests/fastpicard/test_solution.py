"""The true solution at any time, and the iterate's distance from it: no period, times before t0, any initial vector."""

import mpmath
import pytest
from flint import arb, ctx
from hypothesis import assume, example, given, settings, strategies as st
from sympy import I, Matrix, Rational, Symbol, cos, pi, sin, sqrt

from fastpicard import (
    BadInputError,
    BadTypeError,
    FloquetMatrix,
    FundamentalMatrix,
    MissingParameterError,
    fast_picard,
)
from tests.oracles import true_fundamental_matrix

t, a, b, w, s = map(Symbol, ["t", "a", "b", "w", "s"])
MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
TWO_WAVES = Matrix([[0, 1], [-a - b * cos(t) - sin(sqrt(2) * t) / 3, Rational(-1, 5)]])
GENERAL = Matrix([[a / 3, sin(t), 0], [cos(2 * t + 1) - b, 0, Rational(1, 2)], [0, a * sin(t), -Rational(1, 5)]])
SYSTEMS = [MATHIEU, TWO_WAVES, GENERAL]

values_drawn = st.fractions(-2, 2, max_denominator=20)
times_drawn = st.fractions(-3, 3, max_denominator=12)
slow = settings(max_examples=25)


def truth(P, start, end, values, digits=30):
    """Taylor's method of the tests, which shares no code."""
    return true_fundamental_matrix(P.subs(values), t, start, end, digits)


def row_sum(matrix):
    """The largest sum of absolute values in a row."""
    return mpmath.mnorm(matrix, mpmath.inf)


@slow
@given(st.sampled_from(SYSTEMS), values_drawn, values_drawn, times_drawn, times_drawn)
@example(TWO_WAVES, Rational(3, 2), Rational(1), Rational(0), Rational(-3))
def test_an_enclosure_holds_the_solution_at_any_time(P, x, y, start, end):
    """Also before t0, and where no period is."""
    assume(start != end)
    values = {a: Rational(x), b: Rational(y)}
    found = FundamentalMatrix(P, t, 0, Rational(start)).enclosure(end, values, 20)
    wanted = truth(P, Rational(start), Rational(end), values)

    with ctx.workdps(30):
        assert all(
            (ball + arb(0, 1e-24)).contains(arb(mpmath.nstr(wanted[i, j], 28)))
            for i, row in enumerate(found.tolist())
            for j, ball in enumerate(row)
        )
    largest = max(abs(x).upper() for x in found.entries())
    assert all(x.rad() <= arb(10) ** -20 * largest for x in found.entries())


@slow
@given(st.sampled_from(SYSTEMS), values_drawn, values_drawn, times_drawn, times_drawn, st.integers(1, 8))
def test_the_bound_holds_at_any_time_and_is_sharp(P, x, y, start, end, n):
    """At least the true error, at most a few percent more."""
    assume(start != end)
    values = {a: Rational(x), b: Rational(y)}
    X = FundamentalMatrix(P, t, n, Rational(start))
    bound, entries = X.remainder(end, values), X.remainder(end, values, entrywise=True)

    with mpmath.workdps(35):
        wanted = truth(P, Rational(start), Rational(end), values)
        error = wanted - X.evaluate(end, values, 35)
        slack = mpmath.mpf(10) ** -26
        assert row_sum(error) - slack <= bound <= mpmath.mpf("1.03") * row_sum(error) + slack
        assert all(abs(e) <= mpmath.mpf(found) + slack for e, found in zip(error, entries.flat, strict=True))


@slow
@given(values_drawn, values_drawn, times_drawn, values_drawn, values_drawn, st.integers(0, 6))
def test_single_solutions_have_bounds_of_their_own(x, y, end, position, speed, n):
    """The vector's error, not the matrix's; x0 in symbols."""
    assume(end)
    values = {a: Rational(x), b: Rational(y), s: Rational(position), w: Rational(speed)}
    X = fast_picard(TWO_WAVES, t, (s, w / 2), n)
    wanted = truth(TWO_WAVES, 0, Rational(end), values) * mpmath.matrix([values[s], values[w] / 2])
    with mpmath.workdps(35):
        error = row_sum(wanted - X.evaluate(end, values, 35))
        slack = mpmath.mpf(10) ** -26
        assert error - slack <= X.remainder(end, values) <= mpmath.mpf("1.03") * error + slack
    assert X.remainder(end, values, entrywise=True).shape == (2, 1)


def test_after_a_period_it_is_the_floquet_matrix():
    """The same numbers as those of the class that knows the period."""
    values = {a: Rational(-1, 10), b: Rational(11, 20)}
    X, F = FundamentalMatrix(MATHIEU, t, 20), FloquetMatrix(MATHIEU, t, 20)

    assert X.remainder(2 * pi, values) == pytest.approx(F.remainder(values), rel=1e-9)
    for here, there in zip(X.enclosure(2 * pi, values, 30).entries(), F.enclosure(values, 30).entries(), strict=True):
        assert here.overlaps(there)


@given(st.integers(-(10**6), 10**6), st.sampled_from([Rational(1), Rational(3, 7), Symbol("k")]))
@settings(max_examples=20)
def test_a_long_way_is_a_power_of_a_period(turns, unit):
    """A rotation by angles up to a million turns; the frequency a number or a symbol, forwards and backwards."""
    k = {symbol: Rational(5, 3) for symbol in unit.free_symbols}
    P = Matrix([[0, 1 + cos(unit * t)], [-1 - cos(unit * t), 0]])
    end = 1 + 2 * pi * turns / unit.subs(k)
    found = FundamentalMatrix(P, t, 0).enclosure(end, k, 25)

    with ctx.workdps(60):
        q = arb(str(unit.subs(k).p)) / int(unit.subs(k).q)
        angle = 1 + q.sin() / q + 2 * arb.pi() * turns / q  # t + sin(q t)/q
        assert found[0, 0].overlaps(angle.cos()) and found[0, 1].overlaps(angle.sin())


@slow
@given(values_drawn, values_drawn, st.fractions(0, 1), st.fractions(0, 1))
def test_intervals_hold_at_every_time_in_them(x, y, u, v):
    """A bound for all times of an interval, and an enclosure for a narrow one."""
    values = {a: x, b: y}
    X = FundamentalMatrix(MATHIEU, t, 9)
    width = Rational(1, 10**12)

    assert X.remainder((-1, 1), values) >= X.remainder(2 * u - 1, values) * 0.999
    wide = X.enclosure((1, 1 + width), values, 5)
    narrow = X.enclosure(1 + Rational(v) * width, values, 20)
    assert all(x.contains(y) for x, y in zip(wide.entries(), narrow.entries(), strict=True))


def test_at_its_origin_an_iterate_is_the_truth():
    """x(t0) = x0: no error, and no radius beyond that of the numbers."""
    X = fast_picard(MATHIEU, t, (1, s), 3, t0=w)

    assert X.remainder(2, {a: 1, b: 1, s: 3, w: 2}) == 0
    found = X.enclosure(2, {a: 1, b: 1, s: 3, w: 2}).entries()
    assert all(x.contains(y) and x.rad() < 1e-15 for x, y in zip(found, (1, 3), strict=True))


@pytest.mark.parametrize("end", [1, -2, Rational(7, 2)])
def test_the_order_for_an_accuracy_is_the_least_one(end):
    """The next lower one misses it."""
    values = {a: Rational(9, 4), b: Rational(1, 10)}
    X = FundamentalMatrix.for_accuracy(MATHIEU, t, end, values, 1e-12)

    assert X.remainder(end, values) <= 1e-12 < X.to_order(X.n - 1).remainder(end, values)


def test_the_order_for_an_accuracy_counts_from_the_origin():
    """From t0 = 5 to 6, of an equation without waves, as from 0 to 1."""
    P = Matrix([[0, 1], [-a, 0]])
    orders = {FundamentalMatrix.for_accuracy(P, t, 1 + start, {a: 2}, 1e-9, start).n for start in (0, 5, -5)}

    assert len(orders) == 1


@pytest.mark.parametrize(
    "ask, error, message",
    [
        (lambda X: X.remainder({a: 1, b: 1}), BadTypeError, "before the values"),
        (lambda X: X.enclosure("1", {a: 1, b: 1}), BadTypeError, "text is never evaluated"),
        (lambda X: X.remainder(1), MissingParameterError, "a, b got none"),
        (lambda X: X.remainder(1, {a: 1, b: 1, t: 1}), BadInputError, "an argument of its own"),
        (lambda X: X.enclosure((1, 2), {a: 1, b: 1}), BadInputError, "digits asked for cannot be had"),
        (lambda X: X.remainder((2, 1), {a: 1, b: 1}), BadInputError, "lo <= hi"),
        (lambda X: X.enclosure(10**30, {a: 1, b: 1}), BadInputError, "periods at most"),
        (lambda X: X.enclosure(1, {a: 1, b: 1}, 0), BadInputError, "digits must be at least 1"),
        (lambda X: FundamentalMatrix(Matrix([[t]]), t, 2).enclosure(1), BadInputError, r"P\[0, 0\] contains t, with a"),
        (lambda X: FundamentalMatrix(Matrix([[t * a]]), t, 2).remainder(1, {a: 0}), BadInputError, "a power of the"),
        (lambda X: FundamentalMatrix(Matrix([[1 / a]]), t, 2).remainder(1, {a: 0}), BadInputError, "P, t0 and x0"),
        (lambda X: FundamentalMatrix(Matrix([[I]]), t, 2).enclosure(1), BadInputError, "must be real"),
        (lambda X: FundamentalMatrix.for_accuracy(MATHIEU, t, 1, {a: 1, b: 1}, 0), BadInputError, "tol must be"),
        (lambda X: FundamentalMatrix.for_accuracy(MATHIEU, t, 1, {a: 1, b: 1}, "1"), BadTypeError, "tol must be"),
    ],
)
def test_what_has_no_bound_is_refused(ask, error, message):
    """A dictionary for the time, text, missing values, wide times, powers of time, poles, complex numbers."""
    with pytest.raises(error, match=message):
        ask(FundamentalMatrix(MATHIEU, t, 4))
