"""Boundaries: exact functions, their roots beside published and independent numbers, curves with tangents."""

import numpy as np
import pytest
from flint import arb
from hypothesis import given, settings, strategies as st
from sympy import Matrix, Rational, cos, diff, expand, eye, pi, sin, sqrt, zeros
from sympy.abc import a, b, c, h, t, v

from fastpicard import BadInputError, BadTypeError, FloquetMatrix, boundaries, crossing, mathieu_a, mathieu_b
from fastpicard.determinants import determinant, hermite, hermite_from_zero, power_sums, sums_of_rho

MATHIEU_P = Matrix([[0, 1], [-a - b * cos(t), 0]])
MATHIEU = FloquetMatrix(MATHIEU_P, t, 40)
TWO_RODS = Matrix([[Rational(18, 7), Rational(-9, 7)], [Rational(-27, 7), Rational(24, 7)]])


def rods(order):
    """The article's two equal rods, after Out[43]."""
    block = -TWO_RODS * (-1 / v**2 + h * cos(t))
    P = Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [*block.row(0), 0, 0], [*block.row(1), 0, 0]])
    return FloquetMatrix(P, t, order)


def test_the_articles_point_takes_less_than_ten_evaluations():
    """Out[56]: v = 27.5568 at h = 0.06; to forty digits 27.55675633877244909154703026299860855435."""
    root = boundaries(rods(30))[0].root(v, (20.1, 30.1), {h: Rational(3, 50)})

    assert abs(root.value - 27.55675633877244909) <= root.error < 1e-12
    assert root.evaluations < 10


@pytest.mark.parametrize("place, number", [(0, mathieu_a(0, -3)), (2, mathieu_a(1, -3)), (3, mathieu_b(1, -3))])
def test_roots_are_characteristic_numbers(place, number):
    """y'' + (a + b cos t) y with b = 3/2: a = a_r(-3)/4, b_r(-3)/4 by tridiagonal matrices."""
    near = float(number) / 4
    root = boundaries(MATHIEU)[place].root(a, (near - 0.006, near + 0.1), {b: 1.5})

    assert abs(root.value - near) <= root.error + 1e-15 < 1e-12


@pytest.mark.parametrize("order", [8, 10, 12, 14, 16])
def test_errors_of_rough_roots_hold_the_truth(order):
    """a_0, a_1 and b_1 of b = 1 from few iterates: the claimed distance holds the true one, and is not wild."""
    functions = boundaries(FloquetMatrix(MATHIEU_P, t, order))
    for place, number in ((0, mathieu_a(0, -2)), (2, mathieu_a(1, -2)), (3, mathieu_b(1, -2))):
        true = float(number) / 4
        root = functions[place].root(a, (true - 0.1, true + 0.1), {b: 1}, digits=25)

        assert abs(float(root.value) - true) <= root.error + 1e-15
        assert root.error < 1e4 * abs(float(root.value) - true) + 1e-13


def steep(power, c, waves, rest):
    """x'' grows with a high power of a, so that the remainder of a low order does."""
    return Matrix([[0, c * a**power + 1], [-waves * a**power * cos(2 * t) + rest, 0]])


Q = Rational(99, 100) - (a - Rational(1, 5)) ** 2
UNPROVED = [
    (Matrix([[0, 1 / a], [-a / 4, 0]]), 12, 1, (-1, 2)),  # sin(pi/2) 2/a: no zero, but a pole
    (Matrix([[0, 1 / a], [-expand(a * Q), 0]]), 7, 1, (Rational(3, 10), Rational(2, 5))),
    (steep(6, Rational(19, 10), Rational(19, 10), a**2 - 2 * a / 5 - Rational(3957, 1000)), 9, 0, (1.1, 1.2)),
    (steep(12, 1, Rational(33, 10), 5 * a**2 - 11 * a + Rational(3801, 1000)), 7, 0, (1.0, 1.1)),
    (steep(12, 1, Rational(1, 500), a**2 / 2 - 3 * a / 10 - Rational(477, 500)), 4, 1, (-0.6, -0.5)),
]


@pytest.mark.parametrize("P, order, place, bracket", UNPROVED, ids=range(5))
def test_a_root_of_the_iterate_alone_is_not_proved(P, order, place, bracket):
    """The true function has one sign in the bracket and a pole or none near it: no distance may be claimed."""
    F = FloquetMatrix(P, t, order)
    root = boundaries(F)[place].root(a, bracket)
    ends = {boundaries(F.to_order(30))[place]({a: end}) > 0 for end in bracket}

    assert root.error == float("inf")
    assert len(ends) == (2 if bracket[0] == -1 else 1)


def test_a_root_at_zero_is_proved():
    """y'' + a y: the function of the even solution is 0 at a = 0, exactly."""
    root = boundaries(MATHIEU.to_order(30))[0].root(a, (-1, 1), {b: 0})

    assert root.value == 0 and root.error < 1e-30


def test_a_low_order_needs_all_parameters_for_its_error():
    """Three iterates: one of the polynomials is free of b, and the true function is not."""
    B = boundaries(FloquetMatrix(MATHIEU_P, t, 3))[1]

    assert b not in B.symbols
    assert B.root(a, (-2, 2), {b: Rational(1, 2)}).error == float("inf")
    with pytest.raises(BadInputError, match="a is fixed at 3.  Leave it out"):
        B.root(a, (-2, 2), {b: Rational(1, 2), a: 3})


def test_half_period_factors_multiply_to_the_trace():
    """4 B C = trace - 2 and 4 A D = trace + 2 for the true matrix; here to what forty iterates leave."""
    even, odd, even_minus, odd_minus = boundaries(MATHIEU)
    for at in ({a: 0.3, b: 0.7}, {a: -0.5, b: 1.2}, {a: 0, b: 0.1}):
        trace = MATHIEU.trace_at(at)

        assert abs(4 * even(at) * odd(at) - (trace - 2)) < 1e-10
        assert abs(4 * even_minus(at) * odd_minus(at) - (trace + 2)) < 1e-10


def test_gradients_are_those_of_the_exact_expression():
    """SymPy differentiates the polynomial; the dual numbers differentiate the program."""
    at = {h: Rational(1, 20), v: 20}
    for f in boundaries(rods(6)):
        expression = f.expression()
        for symbol, value in f.gradient(at).items():
            assert value == pytest.approx(float(diff(expression, symbol).subs(at)), rel=1e-12)
        assert f(at) == pytest.approx(float(expression.subs(at)), rel=1e-12)


PHASED = Matrix([[0, 1], [-a - b * cos(t + c) - cos(2 * t) / 3, 0]])
SINE = Matrix([[0, 1], [-Rational(1, 4) - 5 * a + Rational(499, 100) * sin(a) - b * cos(t), 0]])


@pytest.mark.parametrize("P", [PHASED, SINE, PHASED.subs(c, c**2 * a + 1), SINE.subs(a, 2 * a)], ids=str)
def test_gradients_know_phases_and_waves_of_parameters(P):
    """cos(t + c), sin a: beside differences of the exact values."""
    at, step = {a: Rational(1, 3), b: Rational(1, 2), c: Rational(7, 10)}, Rational(1, 10**8)
    for B in boundaries(FloquetMatrix(P, t, 10)):
        gradient = B.gradient({s: at[s] for s in B.symbols})
        for s in B.symbols:
            ends = [B({**at, s: at[s] + sign * step}, digits=40) for sign in (1, -1)]
            assert gradient[s] == pytest.approx(float((ends[0] - ends[1]) / (2 * step)), rel=1e-9, abs=1e-12)


def test_roots_and_curves_in_a_phase():
    """The root in the phase is the crossing of the curve with the line; slopes are not 0."""
    B = boundaries(FloquetMatrix(PHASED, t, 24))[0]
    root = B.root(c, (0.3, 0.6), {a: 1, b: 1})
    points, _ = B.follow((c, 0, 3), (a, 0.5, 1.5), (0.3, 1.0), {b: 1})

    assert root.error < 1e-5 and abs(root.slopes[a]) > 1
    assert len(points) > 20 and np.hypot(points[:, 0] - root.value, points[:, 1] - 1).min() < 0.03


def test_slopes_are_those_of_the_curve():
    """The derivative of the root by the other parameter, against two roots."""
    f = boundaries(MATHIEU)[0]
    middle, left, right = (f.root(a, (-0.75, -0.5), {b: x}, 25) for x in (1.4, Rational(7, 5) - Rational(1, 10**8),
                                                                         Rational(7, 5) + Rational(1, 10**8)))

    assert middle.slopes[b] == pytest.approx(float((right.value - left.value) * 10**8 / 2), rel=1e-7)


def curve_of(coefficient, label, *arguments, **more):
    """A boundary of y'' + coefficient y, the even one of its label, followed; tangents checked on the way."""
    F = FloquetMatrix(Matrix([[0, 1], [-coefficient, 0]]), t, 24)
    (x, *sides), (y, *others), *start = arguments
    points, tangents = boundaries(F)[{"+1": 0, "-1": 2}[label]].follow((x, *sides), (y, *others), *start, **more)
    chords = np.diff(points / [sides[1] - sides[0], others[1] - others[0]], axis=0)
    assert np.all((chords * tangents[:-1]).sum(axis=1) > 0.95 * np.hypot(*chords.T))
    return points


def turned(points, scale=1):
    """How often a closed curve goes around, and whether it does close."""
    directions = np.unwrap(np.angle(np.diff(points @ np.array([1, 1j * scale]))))
    assert (points[0] == points[-1]).all()
    return round(abs(directions[-1] - directions[0]) / (2 * np.pi))


@pytest.mark.parametrize("gap", [Rational(1, 10**k) for k in (3, 5, 6, 8, 11, 12)])
def test_a_curve_keeps_to_its_branch(gap):
    """x**2 - y**2 = gap: the step is shortened where the other branch is near, however near."""
    points = curve_of(Rational(1, 4) + a**2 - b**2 - gap, "-1", (a, -1, 1), (b, -1, 1), (0.5, 0.5))

    assert abs(points[:, 0] ** 2 - points[:, 1] ** 2 - float(gap)).max() < 4e-12 and (points[:, 0] > 0).all()
    assert (points[[0, -1], 0] == 1).all() and points[0, 1] * points[-1, 1] < -0.9


def test_a_curve_goes_straight_on_where_it_crosses_another():
    """x**2 = y**2: along the diagonal, from corner to corner."""
    points = curve_of(Rational(1, 4) + a**2 - b**2, "-1", (a, -1, 1), (b, -1, 1), (0.5, 0.5))

    assert abs(points[:, 0] - points[:, 1]).max() < 4e-12
    assert (points[[0, -1]] ** 2 == 1).all() and points[0, 0] == -points[-1, 0]


def test_a_curve_does_not_start_where_others_cross_it():
    """(0, 0) of two coupled rods, on an edge: the gradient vanishes, so that there is no direction."""
    P = Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-a - b * cos(t), -b / 4, 0, 0], [-b / 4, -2 * a - b * cos(t) / 3, 0, 0]])
    B = boundaries(FloquetMatrix(P, t, 24))[0]

    with pytest.raises(BadInputError, match="none leaves.*Start elsewhere on the curve"):
        B.follow((a, -0.5, 1), (b, 0, 1), (0, 0.0))
    assert len(B.follow((a, -0.5, 1), (b, 0, 1), (-0.02, 0.2))[0]) > 20


@pytest.mark.parametrize("thin", [1, 100, 10**4, 10**6, 10**8])
def test_a_closed_curve_is_followed_once(thin):
    """The ellipse x**2 + thin y**2 = a_1/4: its ends bend sharply, and a larger one lies just beyond."""
    edge = float(mathieu_a(1, Rational(-1, 5))) / 4
    points = curve_of(a**2 + thin * b**2 + cos(t) / 10, "-1", (a, -0.9, 0.9), (b, -0.9, 0.9), (edge**0.5, 0))

    assert abs(points[:, 0] ** 2 + thin * points[:, 1] ** 2 - edge).max() < 1e-11 * max(1, thin**0.5)
    assert turned(points, thin**0.5) == 1


@pytest.mark.parametrize("half", [1e-5, 3e-6, 1e-8, 1e-170])
def test_a_curve_in_a_narrow_rectangle_comes_to_its_edges(half):
    """a_2(-2b)/4 = 1 + 5 b**2/12 + ..., and at 0, where floats are so narrow, a_0(-2b)/4 = -b**2/2 + ..."""
    middle = 1 if half > 1e-100 else 0
    points, _ = boundaries(MATHIEU)[0].follow((a, middle - half, middle + half), (b, -half, half), (middle, 0))
    y = points[:, 1]

    assert sorted(y[[0, -1]]) == pytest.approx([-half, half], rel=2e-10, abs=0) and len(points) > 40
    assert abs(points[:, 0] - (1 + 5 * y**2 / 12 if middle else -(y**2) / 2)).max() < 1e-12 * half + 3e-16 * middle


def test_a_hairpin_between_close_boundaries_is_followed():
    """Two boundaries that nearly touch near (1/10, 0): each turns back, at the default step too, and trace = -2."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t) - cos(2 * t) - sin(3 * t) / 10, 0]]), t, 26)
    points, _ = boundaries(F)[1].follow((a, -0.6, 1), (b, -1, 1), (0.2, 0.2))

    assert sorted(points[[0, -1], 1]) == [-1, 1] and points[:, 0].min() > 0.09
    for x, y in points[::12]:
        M = F.enclosure({a: x, b: y}, 15)
        assert abs(float((M[0, 0] + M[1, 1]).mid()) + 2) < 1e-9


def test_what_leaves_the_rectangle_or_is_no_number_is_not_followed():
    """The nearest curve is outside; an axis twice, or fixed as well; a ball."""
    f = boundaries(MATHIEU)[0]
    for arguments, words in ((((a, -1, 3), (b, -1.9, 1.9), (3, 0)), "in the rectangle near"),
                             (((a, -1, 3), (a, -1, 3), (0, 0), {b: 0}), "different parameters"),
                             (((a, -1, 3), (b, -1, 1), (0, 0), {b: 0}), "also on an axis")):
        with pytest.raises(BadInputError, match=words):
            f.follow(*arguments)
    with pytest.raises(BadTypeError, match="c is the ball"):
        boundaries(FloquetMatrix(MATHIEU_P.subs(b, b * c), t, 10))[0].follow(
            (a, -1, 3), (b, -1, 1), (0, 0), {c: arb(1, 0.1)})


def test_a_curve_is_followed_with_its_tangents():
    """Every point of the curve through (0, 0) is a_0(-2b)/4, and tangents join neighbours."""
    points, tangents = boundaries(MATHIEU)[0].follow((a, -1, 1), (b, 0, 1), (0, 0.01))
    chords = np.diff(points / [2, 1], axis=0)
    chords /= np.hypot(*chords.T)[:, None]

    assert len(points) > 40
    for x, y in points[::10]:
        assert abs(x - float(mathieu_a(0, -2 * y)) / 4) < 2e-12
    assert np.all((chords * tangents[:-1]).sum(axis=1) > 0.99)


def test_collisions_of_coupled_modes():
    """Two oscillators coupled with opposite energies: p has a double root exactly where disc p changes its sign."""
    H = Matrix([[1, 0], [0, -1]])  # q'' = -H S q with S symmetric: Hamiltonian of mixed signature
    S = Matrix([[a, b], [b, Rational(-1, 3)]])
    block = -H * S
    P = Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [*block.row(0), 0, 0], [*block.row(1), 0, 0]])
    F = FloquetMatrix(P, t, 40, period=2)
    collision = boundaries(F)[-1]
    root = collision.root(b, (0.01, 0.3), {a: Rational(2, 3)})

    assert collision.label == "collision"
    assert root.value == pytest.approx(1 / 6, abs=1e-10)  # (a - 1/3)**2 = 4 b**2


def test_without_reversal_the_boundaries_are_whole():
    """A sine beside the cosine: no factors, but the same zeros as the trace."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t) - sin(2 * t) / 5, 0]]), t, 30)
    plus, minus = boundaries(F)

    assert (plus.label, minus.label) == ("+1", "-1")
    at = {a: 0.3, b: 0.4}
    assert plus(at) == pytest.approx(2 - F.trace_at(at), abs=1e-6)
    assert minus(at) == pytest.approx(2 + F.trace_at(at), abs=1e-6)


def test_pockets_close_where_ince_says():
    """y'' + (a + b cos t + cos 2t) y: even and odd boundaries cross at b = k sqrt(2), by the theory of Ince's equation.

    (Whittaker-Hill: ``b**2 = 2 k**2 eps``, odd k for +1, even k for -1.)  And a start that leads nowhere.
    """
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t) - cos(2 * t), 0]]), t, 44)
    even, odd, even_minus, odd_minus = boundaries(F)
    plus = crossing(even, odd, a, b, (1.25, 1.4))
    minus = crossing(even_minus, odd_minus, a, b, (2.7, 2.8))

    assert (plus[b] ** 2).contains(2) and float(plus[b].rad()) < 1e-12
    assert (minus[b] ** 2).contains(8) and float(minus[b].rad()) < 1e-11
    with pytest.raises(BadInputError, match="cross"):
        crossing(even, odd, a, b, (-40, 0.1))


def test_crossings_are_proved_beside_poles_and_in_waves_of_parameters():
    """a = 1/v**2 in the pocket of Ince's equation; a - sin(a)/2 in place of a, where the crossing is a = b = 0."""
    F = FloquetMatrix(Matrix([[0, 1], [-1 / v**2 - b * cos(t) - cos(2 * t), 0]]), t, 40)
    found = crossing(*boundaries(F)[:2], v, b, (0.9, 1.4))
    same = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t) - cos(2 * t), 0]]), t, 40)
    expected = crossing(*boundaries(same)[:2], a, b, (1.25, 1.4))
    assert (1 / found[v] ** 2).overlaps(expected[a]) and found[b].overlaps(expected[b])
    assert float(found[v].rad()) < 1e-9

    waves = FloquetMatrix(Matrix([[0, 1], [-Rational(1, 4) - a + sin(a) / 2 - b * cos(t), 0]]), t, 40)
    found = crossing(*boundaries(waves)[2:], a, b, (0.01, 0.01))
    assert found[a].contains(0) and found[b].contains(0) and float(found[a].rad()) < 1e-15


def test_no_crossing_is_proved_of_the_rods_pole():
    """Two equal rods, 1/v**2, from a place without one."""
    B = boundaries(rods(12))
    with pytest.raises(BadInputError, match="no crossing is proved there"):
        crossing(B[0], B[1], h, v, (0.05, 25))
    with pytest.raises(BadInputError, match="v is fixed at 1 and is also on an axis"):
        crossing(B[0], B[1], h, v, (0.05, 25), {v: 1})


@pytest.mark.parametrize("order", [12, 24])
def test_a_crossing_of_rough_iterates_is_not_proved(order):
    """The iterate's curves cross, but its remainder leaves open whether the true ones do; at order 26 it does not.

    At 24 the operator's image is small, 2e-7, yet larger than the box it comes from, 2**-24: that proves nothing.
    """
    _, _, even, odd = boundaries(FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t) - cos(2 * t), 0]]), t, order))

    with pytest.raises(BadInputError, match="higher order"):
        crossing(even, odd, a, b, (0.4, 1.4))


@pytest.mark.parametrize(("order", "height", "truth"), [(36, 4.95, 5.013156507316), (40, 3.05, 3.0611278340877),
                                                        (60, 3.05, 3.0611278340877)])
def test_a_crossing_counts_the_remainders_of_both_functions(order, height, truth):
    """Collisions take the whole period, -1 even half of it, whose remainder is far smaller.

    The truth is a zero of the discriminant of the coupled pair, integrated numerically (Runge-Kutta 8, 1e-13).
    """
    K = Matrix([[c + cos(t), Rational(1, 2), 0], [-Rational(1, 2), 4, 0], [0, 0, a]])
    found = boundaries(FloquetMatrix(Matrix([[zeros(3), eye(3)], [-K, zeros(3)]]), t, order))

    for f, g in ((found[2], found[4]), (found[4], found[2])):
        try:
            place = crossing(f, g, a, c, (0.25, height))
        except BadInputError:
            assert order < 60
        else:
            assert abs(place[c] - truth) < 1e-9 and place[a].overlaps(arb(1) / 4)


@pytest.mark.parametrize("order", [14, 26])
def test_boundaries_of_two_iterates_cross_with_a_remainder_each(order):
    """At b = 0, where the equation has period pi; the rougher one decides whether that is proved."""
    P = Matrix([[0, 1], [-a - b * cos(t) - cos(2 * t), 0]])
    even, odd = boundaries(FloquetMatrix(P, t, 40))[2], boundaries(FloquetMatrix(P, t, order))[3]

    for f, g in ((even, odd), (odd, even)):
        try:
            assert crossing(f, g, a, b, (0.1, 0.1))[b].contains(0)
        except BadInputError:
            assert order == 14


def test_damping_has_no_such_boundaries():
    """The message says what to do instead."""
    with pytest.raises(BadInputError, match="certify"):
        boundaries(FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), -c]]), t, 2))


def test_a_bracket_without_a_change_of_sign_is_refused():
    """With the two values."""
    with pytest.raises(BadInputError, match="sign"):
        boundaries(MATHIEU)[0].root(a, (0.1, 0.2), {b: 0.1})


@pytest.mark.parametrize("bracket", [0.2, (0.2,), (0, 1, 2), None, "01"])
def test_a_bracket_has_two_ends(bracket):
    """A guess is not enough."""
    with pytest.raises(BadTypeError, match="two numbers"):
        boundaries(MATHIEU)[0].root(a, bracket, {b: 0.1})


numbers = st.integers(-5, 5)


@settings(max_examples=100)
@given(st.integers(1, 4).flatmap(lambda n: st.lists(st.lists(numbers, min_size=n, max_size=n), min_size=n, max_size=n)))
def test_determinant_is_that_of_sympy(rows):
    """Two routes, exactly; the discriminant is Hermite's determinant."""
    n = len(rows)
    sums = power_sums(rows, 2 * n)

    assert determinant(rows) == Matrix(rows).det()
    assert sums == [(Matrix(rows) ** k).trace() for k in range(1, 2 * n + 1)]
    x = a
    assert determinant(hermite(sums, n, False)) == Matrix(rows).charpoly(x).discriminant()


@settings(max_examples=50)
@given(st.lists(st.fractions(-3, 3, max_denominator=7).filter(bool), min_size=1, max_size=3))
def test_sums_of_rho_from_traces(multipliers):
    """The sums of (lambda + 1/lambda)**k from the traces of powers."""
    n = len(multipliers)
    traces = [sum(x**k + x**-k for x in multipliers) for k in range(1, 7)]

    assert sums_of_rho(traces, 6, 2 * n) == [sum((x + 1 / x) ** k for x in multipliers) for k in range(1, 7)]


@settings(max_examples=50)
@given(st.lists(st.fractions(-5, 5, max_denominator=7), min_size=1, max_size=3))
def test_hermites_second_matrices_are_congruences(sigma):
    """G = V' diag(g) V with V_ij = sigma_i**j and g = 4 - sigma**2, or g = sigma (4 - sigma), exactly."""
    n = len(sigma)
    sums = [sum(x**k for x in sigma) for k in range(1, 2 * n + 1)]
    for g, found in ((lambda x: 4 - x**2, hermite(sums, n, True)), (lambda x: x * (4 - x), hermite_from_zero(sums, n))):
        assert found == [[sum(x ** (j + k) * g(x) for x in sigma) for k in range(n)] for j in range(n)]


def hill(S):
    """y'' + S(t) y = 0."""
    return Matrix([[0, 1], [-S, 0]])


def test_a_bracket_with_a_pole_is_refused():
    """The period is 2 pi / v, and v = 0 between the ends."""
    F = FloquetMatrix(hill(a + cos(v * t)), t, 12, 2 * pi / v)
    for boundary in boundaries(F)[:2]:
        with pytest.raises(BadInputError, match="finite between the ends -1.0 and 3.0, but it is not at 0"):
            boundary.root(v, (-1, 3), {a: Rational(1, 5)})


def test_a_function_that_vanishes_everywhere_has_no_root():
    """a c = 0 for c = 0: the sign does not change."""
    with pytest.raises(BadInputError, match="must change its sign"):
        boundaries(FloquetMatrix(hill(a * c), t, 9))[0].root(a, (-1, 1), {c: 0})


def test_a_multiple_root_has_its_digits_but_no_slope():
    """(a - c)**3 = 0 has the root c, thrice; that there is one of the true boundary is not proved."""
    F = FloquetMatrix(hill((a - c) ** 3 + b * cos(t)), t, 20)
    root = boundaries(F)[0].root(a, (Rational(1, 20), Rational(1, 5)), {b: 0, c: Rational(1, 10)})

    assert abs(root.value - 0.1) < 1e-15
    assert root.error == float("inf")


def test_a_root_does_not_leave_its_bracket():
    """sqrt(a) = 0 at an end, beyond which nothing is real."""
    root = boundaries(FloquetMatrix(hill(sqrt(a)), t, 9))[0].root(a, (0, 1))

    assert 0 <= root.value < 1e-20


def test_a_root_at_an_end_is_found_at_once():
    """a = 0 at b = 0, from both sides."""
    boundary = boundaries(FloquetMatrix(hill(a + b * cos(t)), t, 20))[0]
    for bracket in ((0, 1), (-1, 0)):
        root = boundary.root(a, bracket, {b: 0})
        assert root.value == 0 and root.evaluations < 5


def test_curves_end_at_poles_and_branch_points():
    """Not with an error of the arithmetic: at v = 0 there is no P, left of a = 0 no sqrt(a)."""
    rod = FloquetMatrix(hill(-Rational(3, 2) / v**2 + Rational(3, 2) * h * cos(t)), t, 20)
    with pytest.raises(BadInputError, match="followed from a point near it"):
        boundaries(rod)[2].follow((h, 0, 1), (v, 0, 30), (0.3, 0))

    boundary = boundaries(FloquetMatrix(hill(sqrt(a) - b + cos(t) / 2), t, 24))[0]
    start = boundary.root(b, (-0.5, 1), {a: Rational(1, 10)}).value
    points, _ = boundary.follow((a, 0, 1), (b, -1, 1), (0.1, start))
    assert points.min(axis=0)[0] < 1e-3


def test_no_crossing_is_proved_across_a_pole_that_is_nearer_than_a_box():
    """b = 1e-10/v: the boxes around v = 2e-10 would hold v = 0.  With b itself the crossing is at -0.00133044702989."""
    def boundary(y, n, k):
        S = Matrix([[a + y * cos(t), 0], [0, -a + Rational(83, 10) * y * cos(t)]])
        return boundaries(FloquetMatrix(zeros(2).row_join(eye(2)).col_join((-S).row_join(zeros(2))), t, n))[k]

    tiny = Rational(1, 10**10)
    true = crossing(boundary(b, 60, 1), boundary(b, 60, 2), a, b, (-0.00133, 0.456))
    try:
        found = crossing(boundary(tiny / v, 18, 1), boundary(tiny / v, 18, 2), a, v, (-0.00133, 2.1917e-10))
    except BadInputError:
        return
    assert found[a].overlaps(true[a])
