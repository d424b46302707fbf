"""Certified charts: no rectangle contradicts the truth at a point, whatever the criterion."""

import pickle
from copy import deepcopy
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from flint import arb
from hypothesis import given, settings, strategies as st
from sympy import Matrix, Rational, cos, pi, sin, sqrt
from sympy.abc import a, b, c, h, t, v

from fastpicard import (
    BadInputError,
    BadTypeError,
    FloquetMatrix,
    MissingParameterError,
    Verdict,
    boundaries,
    certify,
    tubes,
)
from fastpicard.local import LocalMap
from fastpicard.rectangles import Rectangles
from fastpicard.taylormodels import Models, exponents, size
from tests.conftest import CHECKS

MATHIEU = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0)
ONE_ROD = FloquetMatrix(Matrix([[0, 1], [Rational(3, 2) / v**2 - Rational(3, 2) * h * cos(t), 0]]), t, 0)
GENERATOR = np.random.default_rng(20)
units = st.fractions(-1, 1, max_denominator=64)


def second_order(S, D=None):
    """x'' + D x' + S x = 0 as a system of first order."""
    n = S.rows
    D = Matrix.zeros(n) if D is None else D
    return Matrix.zeros(n).row_join(Matrix.eye(n)).col_join((-S).row_join(-D))


def disagreements(chart, F, count, fixed=None, matrix=None):
    """Random decided cells, a random point in each, and whether ball Taylor contradicts the verdict there."""
    decided = np.flatnonzero(chart.codes)
    weights = chart.areas[decided] ** 0.5
    chosen = GENERATOR.choice(decided, size=count, p=weights / weights.sum())
    found = []
    for k in chosen:
        x0, x1, y0, y1 = chart.cells[k]
        at = {chart.x.symbol: float(GENERATOR.uniform(x0, x1)), chart.y.symbol: float(GENERATOR.uniform(y0, y1))}
        true = F.verdict({**at, **(fixed or {})})
        if int(true) * chart.codes[k] < 0:
            found.append((at, int(true), chart.codes[k]))
    return found


def joint_springs(rods):
    """Equal upright rods, springs of m g l/5 in the joints: no normal modes decouple them."""
    if rods == 2:
        A = Matrix([[Rational(4, 3), Rational(1, 2)], [Rational(1, 2), Rational(1, 3)]])
        B, K = Matrix.diag(Rational(3, 2), Rational(1, 2)), Matrix([[2, -1], [-1, 1]])
    else:
        A = Matrix([[Rational(7, 3), Rational(3, 2), Rational(1, 2)], [Rational(3, 2), Rational(4, 3), Rational(1, 2)],
                    [Rational(1, 2), Rational(1, 2), Rational(1, 3)]])
        B = Matrix.diag(Rational(5, 2), Rational(3, 2), Rational(1, 2))
        K = Matrix([[2, -1, 0], [-1, 2, -1], [0, -1, 1]])
    return FloquetMatrix(second_order(A.inv() * (B * (h * cos(t) - 1 / v**2) + K / (5 * v**2))), t, 0)


def resonance(signature):
    """Two oscillators of frequencies 1 and w coupled by h cos(t); signature -1: energies of opposite signs."""
    S = Matrix([[1, h * cos(t)], [h * cos(t), Rational(9, 16)]])
    return FloquetMatrix(second_order(Matrix.diag(1, signature) * c * S), t, 0)


def hill(*entries):
    """A system of two from the lower row of P."""
    return FloquetMatrix(Matrix([[0, 1], entries]), t, 0)


EQUATIONS = {
    "Mathieu": (MATHIEU, (a, -1, 5), (b, 0, 6), {}),
    "Mathieu of many bits": (MATHIEU, (a, 8, 12), (b, 9, 12), {}),
    "one rod": (ONE_ROD, (h, 0, 0.5), (v, 0.1, 100), {}),
    "two waves": (hill(-a - b * cos(t) - c * cos(2 * t), 0), (a, -1, 2), (b, -1, 2), {c: 1}),
    "not reversible": (hill(-a - b * cos(t) - sin(2 * t) / 3, 0), (a, -0.5, 1), (b, 0, 1), {}),
    "damped": (hill(-a - b * cos(t), -c), (a, -0.5, 1), (b, 0, 1), {c: Rational(1, 5)}),
    "damping as axis": (hill(-a - b * cos(t), -c), (c, -0.1, 0.5), (b, 0, 1), {a: Rational(1, 4)}),
    "joint springs": (joint_springs(2), (h, 0, 0.2), (v, 4, 40), {}),
    "sum resonance": (resonance(1), (c, 0.3, 0.36), (h, 0.02, 0.12), {}),
    "difference resonance": (resonance(-1), (c, 0.3, 0.36), (h, 0.02, 0.12), {}),
}


@cache
def chart_of(name):
    """The certified chart of an equation, all but half a percent of its area."""
    F, x, y, fixed = EQUATIONS[name]
    return certify(F, x, y, fixed=fixed, undecided=2e-3 if F.shape == (2, 2) else 5e-3, seconds=600)


@pytest.mark.parametrize("name", EQUATIONS)
def test_certified_cells_never_contradict_ball_taylor(name):
    """The verdict on random points in random cells, by the true equation integrated in balls."""
    F, _, _, fixed = EQUATIONS[name]
    chart = chart_of(name)

    assert chart.undecided < (2e-3 if F.shape == (2, 2) else 5e-3)
    assert not disagreements(chart, F, 60, fixed)


@settings(max_examples=max(25, CHECKS // 10))
@given(st.sampled_from(sorted(EQUATIONS)), st.integers(0, 2**40), units, units)
def test_no_certified_cell_contradicts_ball_taylor(name, k, s, u):
    """Random cells, most of them small and beside a boundary; corners and edges too.  10000 in the nightly profile."""
    F, _, _, fixed = EQUATIONS[name]
    chart = chart_of(name)
    decided = np.flatnonzero(chart.codes)
    place = decided[k * 2654435761 % len(decided)]  # neighbouring integers, distant cells
    x0, x1, y0, y1 = map(Fraction, map(float, chart.cells[place]))
    at = {chart.x.symbol: (x0 + x1 + s * (x1 - x0)) / 2, chart.y.symbol: (y0 + y1 + u * (y1 - y0)) / 2}

    assert int(F.verdict({**at, **fixed})) * chart.codes[place] >= 0


def test_cells_tile_the_chart():
    """Areas add up, and a random point lies in one cell."""
    chart = certify(ONE_ROD, (h, 0, 0.5), (v, 0.1, 100), undecided=1e-2, seconds=600)
    points = np.stack([GENERATOR.uniform(0, 0.5, 200), GENERATOR.uniform(0.1, 100, 200)])
    cells = chart.cells
    inside = ((cells[:, 0] <= points[0][:, None]) & (points[0][:, None] <= cells[:, 1])
              & (cells[:, 2] <= points[1][:, None]) & (points[1][:, None] <= cells[:, 3]))

    parts = [chart.fraction(verdict) for verdict in (Verdict.STABLE, Verdict.UNSTABLE, Verdict.UNDECIDED)]
    assert sum(parts) == pytest.approx(1, abs=1e-12)
    assert (inside.sum(axis=1) == 1).all()


@pytest.mark.parametrize("hh, vv, verdict", [
    ("1/10", "12", 1), ("3/10", "3", -1), ("2/5", "5", -1), ("1/100", "100", -1), ("1/5", "40", 1),
    ("3/20", "42339/5000", 1),
])
def test_reference_points_of_one_rod(hh, vv, verdict):
    """Points whose traces are known to thirty digits; the article's (0.2, 40) among them."""
    chart = certify(ONE_ROD, (h, 0, 0.5), (v, 0.1, 100), undecided=1e-3, seconds=600)

    assert int(chart.verdict(Fraction(hh), Fraction(vv))) == verdict


@pytest.mark.parametrize("power", [2, 3])
@pytest.mark.parametrize("high", [0.7, 1, 2.5])
def test_an_axis_from_zero_may_enter_as_a_power(power, high):
    """Rectangles at its end are rounded down, and a negative number has no root."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - v**power * cos(t), 0]]), t, 0)
    chart = certify(F, (a, -0.5, 1), (v, 0, high), undecided=1e-2, seconds=600)

    parts = [chart.fraction(verdict) for verdict in (Verdict.STABLE, Verdict.UNSTABLE, Verdict.UNDECIDED)]
    assert sum(parts) == pytest.approx(1, abs=1e-12) and chart.undecided <= 1e-2
    assert (chart.verdict(0.6, 0), chart.verdict(0.6, 0.01)) == (Verdict.STABLE, Verdict.STABLE)
    assert chart.verdict(-0.4, 0.01) == Verdict.UNSTABLE


def test_a_mode_may_lack_a_parameter():
    """A mode that nothing drives is stable where a is positive, but for the touching point a = 1/4 of a driven one."""
    driven = certify(MATHIEU, (a, -1, 1), (v, 0.1, 1), modes=[{a: a, b: v}], undecided=1e-2, seconds=600)
    both = certify(MATHIEU, (a, -1, 1), (v, 0.1, 1), modes=[{a: a, b: v}, {a: a, b: 0}], undecided=1e-2, seconds=600)
    points = GENERATOR.uniform((-1, 0.1), (1, 1), (200, 2)).tolist()

    verdicts = [(int(driven.verdict(*point)), int(both.verdict(*point)), point[0]) for point in points]
    assert all(two == (one if place > 0 else -1) for one, two, place in verdicts if one and two)
    assert len({two for _, two, _ in verdicts}) > 1


def test_two_rods_from_one_scalar_matrix():
    """mu = 3 -+ 6/sqrt(7): points of the reference set, and the two-rod system itself at random points."""
    modes = [{a: -mu / v**2, b: mu * h} for mu in (3 - 6 / sqrt(7), 3 + 6 / sqrt(7))]
    chart = certify(MATHIEU, (h, 0, 0.1), (v, 0.1, 100), modes=modes, undecided=5e-4, seconds=600)
    S = Matrix([[18, -9], [-27, 24]]) / 7 * (-1 / v**2 + h * cos(t))
    coupled = FloquetMatrix(second_order(S), t, 0)

    for hh, vv, verdict in (("1/50", "901/10", 1), ("3/50", "28", 1), ("9/100", "301/10", -1), ("2/25", "30", 1)):
        assert int(chart.verdict(Fraction(hh), Fraction(vv))) == verdict
    assert not disagreements(chart, coupled, 15)


def test_three_coupled_rods():
    """Hermite's minors and the invariant form, against the verdicts of balls."""
    F = joint_springs(3)
    chart = certify(F, (h, 0, 0.06), (v, 20, 100), undecided=5e-3, seconds=600)

    assert chart.undecided < 5e-3 and chart.fraction(Verdict.STABLE) > 0.05
    assert not disagreements(chart, F, 15)


def test_krein_collisions():
    """Sum resonance of equal signatures is unstable, difference resonance stable; p(2), p(-2) > 0 > disc in between.

    Frequencies are sqrt(c) and 3 sqrt(c)/4: their sum is 1 at c = 16/49, their difference 1 at c = 16.
    """
    F = resonance(1)
    assert F.verdict({c: Rational(16, 49), h: Rational(1, 10)}) == Verdict.UNSTABLE
    assert F.verdict({c: 16, h: Rational(1, 100)}) == Verdict.STABLE
    chart = chart_of("sum resonance")
    half = boundaries(F.to_order(40))

    assert chart.verdict(Fraction(16, 49), Fraction(1, 10)) == Verdict.UNSTABLE
    assert chart.verdict(0.301, 0.021) == Verdict.STABLE
    inside, outside = {c: Rational(16, 49), h: Rational(1, 10)}, {c: 0.301, h: 0.021}
    for plus, minus in ((half[0], half[1]), (half[2], half[3])):  # p(2) and p(-2) keep their signs
        assert plus(inside) * minus(inside) * plus(outside) * minus(outside) > 0
    assert half[-1](inside) < 0 < half[-1](outside)


def test_achesons_bounds_are_stable():
    """h < 0.450/mu_max and h v > sqrt(2/mu_min), approximate both, for N = 1 .. 6: a tenth inside they are proved."""
    for n in range(1, 7):
        A, B = _chain(n)
        mu = np.sort(np.linalg.eigvals(np.linalg.solve(A, B)).real)
        at_h, at_v = 0.449 / mu[-1], 1.1 * np.sqrt(2 / mu[0]) * mu[-1] / 0.449
        modes = [{a: -Rational(float(x)) / v**2, b: Rational(float(x)) * h} for x in mu]
        x, y = (h, 0.9 * at_h, at_h), (v, at_v / 0.9, 1.5 * at_v)
        chart = certify(MATHIEU, x, y, modes=modes, undecided=1e-3, seconds=600)

        assert chart.fraction(Verdict.STABLE) > 0.999 and chart.fraction(Verdict.UNSTABLE) == 0, n


def _chain(n):
    """A and B of n equal uniform rods, [Neves] (19), (20), for any n."""
    A = np.array([[n - i - Rational(2, 3) if i == j else n - max(i, j) - Rational(1, 2) for j in range(n)]
                  for i in range(n)], dtype=float)
    return A, np.diag([n - i - 0.5 for i in range(n)])


def test_below_one_everything_is_unstable_by_convexity():
    """h v**2 < 1: no iterate is needed."""
    chart = certify(ONE_ROD, (h, 0, 0.5), (v, 0.01, 1.4))

    assert (chart.fraction(Verdict.UNSTABLE), chart.order) == (pytest.approx(1), 0)


def test_time_is_kept_to():
    """What no time was left for is undecided, and still tiles the chart."""
    chart = certify(MATHIEU, (a, -2, 4), (b, 0, 6), seconds=0)

    assert chart.areas.sum() == pytest.approx(36)
    assert int(chart.verdict(-1.9, 0.1)) == -1 and int(chart.verdict(3.5, 1)) == 0  # by convexity alone


def test_memory_is_kept_to(monkeypatch):
    """Where nothing is decided (all multipliers on the circle, by a criterion for damping) halving ends by itself."""
    monkeypatch.setattr("fastpicard.halving.MOST", 1 << 16)
    F = FloquetMatrix(Matrix([[0, 1, 0], [-a - b * cos(t), 0, 0], [cos(t) + sin(t), 0, 0]]), t, 0)
    chart = certify(F, (a, 0.3, 0.6), (b, 0, 0.1), seconds=600)

    assert chart.areas.sum() == pytest.approx(0.03) and chart.undecided == pytest.approx(1)
    assert len(chart.codes) < 1 << 16


def test_the_remainder_of_the_iterate_is_in_every_verdict(monkeypatch):
    """With an iterate that may be wrong by 0.1 a wide strip stays open: |entry| < 0.1 is no sign."""
    monkeypatch.setattr("fastpicard.quarters.REMAINDER", 0.1)
    monkeypatch.setattr("fastpicard.halving.MOST", 1 << 18)
    chart = certify(MATHIEU, (a, -0.5, 1), (b, 0, 1), undecided=1e-3, seconds=600)

    assert chart.remainder > 1e-3 and 0.01 < chart.undecided < 0.5
    assert not disagreements(chart, MATHIEU, 25)


def test_progress_is_reported():
    """A function is called with the time and the part that is undecided."""
    seen = []
    certify(MATHIEU, (a, 0, 1), (b, 0, 1), undecided=1e-3, progress=lambda *report: seen.append(report))

    assert all(0 <= part <= 1 for _, part in seen)


@pytest.mark.parametrize("x, y, more, error, words", [
    ((a, 1, 0), (b, 0, 1), {}, BadInputError, "lo < hi"),
    ((a, 0, 1), (a, 0, 1), {}, BadInputError, "different"),
    (("a", 0, 1), (b, 0, 1), {}, BadTypeError, "Symbol"),
    ((a, 0, 1), (h, 0, 1), {}, MissingParameterError, "fixed"),
    ((h, 0, 1), (v, 0, 1), {"modes": [{a: -1 / v**2, b: h}]}, BadInputError, "positive"),
    ((h, 0, 1), (v, 1, 2), {"modes": [{a: -1 / v**2 + h, b: h}]}, BadInputError, "powers"),
    ((a, 0, 1), (b, 0, 1), {"modes": [{b: b / 2}]}, MissingParameterError, "every mode gives all .* Add a"),
    ((a, 0, 1), (b, 0, 1), {"fixed": {a: 3}}, BadInputError, "fixed at 3 and is also on an axis"),
    ((h, 0, 1), (v, 1, 2), {"modes": [{a: -1 / v**2, b: h}], "fixed": {b: 1}}, BadInputError, "given by the modes"),
    ((a, 0, 1), (b, 0, 1), {"seconds": None}, BadTypeError, "seconds must be a number"),
    ((a, 0, 1), (b, 0, 1), {"seconds": -1}, BadInputError, "seconds must be 0 or more"),
    ((a, 0, 1), (b, 0, 1), {"undecided": float("nan")}, BadInputError, "undecided must be 0 or more"),
])
def test_what_is_no_chart_is_refused(x, y, more, error, words):
    """With what would do."""
    with pytest.raises(error, match=words):
        certify(MATHIEU, x, y, **more)


def test_a_mode_without_a_parameter_that_divides_is_refused():
    """1/0 is no coefficient."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - cos(t) / b, 0]]), t, 0)

    with pytest.raises(BadInputError, match="negative power of b, which is 0"):
        certify(F, (a, 0, 1), (v, 0, 1), modes=[{a: a, b: 0}])


# -- Taylor models ---------------------------------------------------------------

dyadic = st.integers(-256, 256).map(lambda k: Fraction(k, 64))
coefficients = st.lists(dyadic, min_size=size(3), max_size=size(3))


def model(numbers):
    """A model of degree 3 whose coefficients are exact floats."""
    return Models(3, np.array([float(x) for x in numbers])[:, None], np.zeros(1))


def exact(numbers, s, u):
    """The polynomial's value in fractions."""
    return sum(x * s**k * u**l for x, (k, l) in zip(numbers, exponents(3), strict=True))


def enclosed(m, s, u, value):
    """Whether a value of the function is within the model's error."""
    numbers = [Fraction(float(x)) for x in m.c[:, 0]]
    return abs(exact(numbers, s, u) - value) <= Fraction(float(m.e[0]))


@settings(max_examples=200)
@given(coefficients, coefficients, units, units)
def test_models_contain_sums_and_products(f, g, s, u):
    """In exact fractions."""
    x, y = exact(f, s, u), exact(g, s, u)

    assert enclosed(model(f) + model(g), s, u, x + y)
    assert enclosed(model(f) - model(g), s, u, x - y)
    assert enclosed(model(f) * model(g), s, u, x * y)
    assert enclosed(model(f) * 0.3, s, u, x * Fraction(0.3))
    assert enclosed(model(f).truncated(3), s, u, x)


@settings(max_examples=200)
@given(coefficients, units, units, st.booleans(), st.booleans())
def test_halves_are_the_same_function(f, s, u, along_y, upper):
    """On a half the function is that of the whole at the point."""
    half = model(f).halved(along_y, upper)
    sign = 1 if upper else -1
    where = (s, (u + sign) / 2) if along_y else ((s + sign) / 2, u)

    assert enclosed(half, s, u, exact(f, *where))


@settings(max_examples=100)
@given(coefficients, units, units)
def test_a_sign_is_the_sign(f, s, u):
    """What signs() proves holds at every point."""
    assert int(model(f).signs()[0]) * exact(f, s, u) >= 0


@settings(max_examples=100)
@given(coefficients, st.fractions(0, 4, max_denominator=64), units, units)
def test_a_sign_is_that_of_every_function_within_the_error(f, e, s, u):
    """The model stands for all functions that differ from it by e at most."""
    sign = int(Models(3, model(f).c, np.array([float(e)])).signs()[0])

    assert sign == 0 or sign * exact(f, s, u) >= Fraction(float(e))


@settings(max_examples=50)
@given(st.lists(st.integers(-9, 9), min_size=16, max_size=16), st.fractions(-2, 2, max_denominator=8),
       st.fractions(-2, 2, max_denominator=8), units, units)
def test_local_models_contain_the_polynomial(numbers, x, y, s, u):
    """Recentred on [x, x + 1/2] x [y, y + 1/4]; degrees 3 and 3, of which the model keeps three in all."""
    terms = {(i, j): arb(numbers[4 * i + j]) for i in range(4) for j in range(4)}
    lower = np.array([[float(x)], [float(y)]])
    boxes = Rectangles(lower, lower + np.array([[0.5], [0.25]]))
    found = LocalMap([terms], [0.0]).models(boxes, 3)
    at = [Fraction(float(boxes.center[k, 0])) + z * Fraction(float(boxes.half[k, 0])) for k, z in ((0, s), (1, u))]
    value = sum(numbers[4 * i + j] * at[0]**i * at[1]**j for i in range(4) for j in range(4))

    assert enclosed(Models(3, found.c[:, 0], found.e[0]), s, u, value)


def test_a_trace_of_mean_zero_is_certified_by_the_trace():
    """Neither Hamiltonian nor reversible, but of determinant 1: there are stable areas, which no damping makes."""
    w = 2 * pi
    F = FloquetMatrix(Matrix([[b * cos(w * t), 1], [-a - b * cos(w * t), sin(w * t) / 2]]), t, 0, 1)
    chart = certify(F, (a, -0.5, 0.5), (b, 0, 1), seconds=60, undecided=0.02)

    assert chart.undecided < 0.02
    assert chart.fraction(Verdict.STABLE) > 0.3 and chart.fraction(Verdict.UNSTABLE) > 0.3
    assert not disagreements(chart, F, 30)


def test_a_chart_may_be_asked_to_decide_all_and_at_any_real_point():
    """undecided=0 ends with the time; sqrt(2)/2 is a coordinate."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0)
    chart = certify(F, (a, 0, 1), (b, 0, 1), undecided=0, seconds=1)

    assert 0 < chart.undecided < 0.01
    assert chart.verdict(Rational(1, 3), sqrt(2) / 2) == Verdict.UNSTABLE
    with pytest.raises(BadTypeError, match="verdict"):
        chart.fraction("STABLE")


def test_boundaries_tubes_and_multipliers_can_be_pickled_and_copied():
    """Python-flint's balls themselves cannot; a chart is itself and no other."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 20)
    found = tubes(F, (a, -0.5, 1), (b, 0, 0.5), radius=1e-8)
    mine, other = (x.at(0.25)[0][2] for x in (found, pickle.loads(pickle.dumps(found))))
    assert other.contains(mine) and other.rad() < 1.00001 * mine.rad()
    for curve, other in zip(boundaries(F), pickle.loads(pickle.dumps(boundaries(F))), strict=True):
        assert repr(other) == repr(curve) == repr(deepcopy(curve))
        assert other({a: 0.3, b: 0.4}) == curve({a: 0.3, b: 0.4}) == deepcopy(curve)({a: 0.3, b: 0.4})
    for multiplier in F.multiplier_enclosures({a: 0.3, b: 0.4}):
        other = pickle.loads(pickle.dumps(multiplier))
        assert other.ball.contains(multiplier.ball) and abs(other.digits - multiplier.digits) < 1e-6
        assert hash(multiplier) == hash(multiplier) and multiplier == multiplier
    chart = certify(F, (a, 0, 1), (b, 0, 1), undecided=0.1)
    assert chart == chart and chart != pickle.loads(pickle.dumps(chart)) and hash(chart) == hash(chart)


def test_phases_need_numbers():
    """cos(t + c): refused before an iterate is computed, which would take minutes here; with a number it is proved."""
    system = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t + c) - cos(2 * t) / 3, 0]]), t, 0)

    with pytest.raises(BadInputError, match="P has a phase with c.  Give it a number"):
        certify(system, (a, -5, 5), (c, 0, 5), fixed={b: 1})
    with pytest.raises(BadInputError, match="neither for c"):
        certify(system, (a, -5, 5), (b, 0, 5))
    assert certify(system, (a, 0.1, 0.12), (b, 0, 0.02), fixed={c: Rational(1, 3)}).undecided < 1


NOT_REVERSIBLE = Matrix([[0, 1], [-a - b * (cos(t) + sin(2 * t) / 3), -Rational(1, 10)]])


@pytest.mark.parametrize("P", [NOT_REVERSIBLE], ids=["damped"])
def test_what_is_damped_and_does_not_reverse_is_proved_over_quarters(P):
    """Neither half a period nor a determinant of 1: the trace against Liouville's determinant."""
    F = FloquetMatrix(P, t, 0)
    chart = certify(F, (a, -0.5, 1), (b, 0, 1), undecided=1e-3, seconds=600)

    assert chart.criterion == "trace and determinant" and chart.undecided < 1e-3
    assert not disagreements(chart, F, 25)
