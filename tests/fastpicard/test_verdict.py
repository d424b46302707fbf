"""Verdicts and multipliers of the true equation: reference points, laws, and what must never be claimed."""

import cmath
import math
import pickle

import mpmath
import numpy as np
import pytest
import sympy
from flint import acb, arb, arb_mat, arb_poly, ctx, fmpq, fmpq_mat
from hypothesis import assume, given, settings, strategies as st
from sympy import CRootOf, Matrix, Rational, Symbol, cos, pi, sin, sqrt

from fastpicard import (
    BadInputError,
    FloquetMatrix,
    MissingParameterError,
    Verdict,
    boundaries,
    certify,
    chart,
    mathieu_exponent,
    tabulate,
)
from fastpicard.halfway import known_structure
from fastpicard.spectrum import in_rho, root_discs
from fastpicard.stability import judge, schur_cohn
from fastpicard.structure import Structure, is_definite
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize
from tests.fastpicard.test_reference_cases import cases, numbers, read, system
from tests.oracles import true_fundamental_matrix

t, a, b, c, h, v = map(Symbol, "tabchv")
MATHIEU = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0)
DAMPED = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), -c]]), t, 0)
TWO_ALIKE = FloquetMatrix(
    Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-a - b * cos(t), 0, 0, 0], [0, -a - b * cos(t), 0, 0]]), t, 0
)
POINTS = [x for x in cases("stability") if "class" in x.values[0]]


@pytest.mark.parametrize("case", [x for x in POINTS if "a" in x.values[0] and not x.id.startswith("degenerate")])
def test_points_of_mathieus_equation_have_their_class(case):
    """Stable or unstable as another rigorous computation found; the enclosed trace holds its 30 digits."""
    values = {a: read(case["a"]), b: read(case["b"])}

    assert MATHIEU.verdict(values).name.lower() == case["class"]
    with ctx.workprec(140):
        assert abs(MATHIEU.enclosure(values, 35).trace() - arb(case["trace"])) < arb(10) ** -33 * abs(
            arb(case["trace"])
        )


def rods(count):
    """The Floquet matrix of that many uniform rods upside down, driven vertically, in h and v."""
    g, length, amplitude, omega = Symbol("g"), Symbol("l"), Symbol("epsilon"), Symbol("omega0")
    scene = Scene(
        [Rod.uniform(1, length)] * count, support=Support(eta=amplitude * cos(omega * t)), gravity=g, upright=True, t=t
    )
    P, tau, period = linearize(euler_lagrange(scene)).first_order(omega)
    return FloquetMatrix(P, tau, 0, period)


RODS = {}


@pytest.mark.parametrize("case", [x for x in POINTS if "v" in x.values[0]])
def test_rods_upside_down_have_their_class_from_the_full_matrix(case):
    """Up to six coupled rods, without normal modes: stable where the reference says so, next to the margin too."""
    count = int(case["N"])
    F = RODS.setdefault(count, rods(count))
    names = {s.name: s for s in F.P.as_matrix().free_symbols}
    verdict = F.verdict({names["h"]: read(case["h"]), names["v"]: read(case["v"])})

    assert verdict.name.lower() == case["class"]
    assert verdict.reason


@settings(max_examples=40)
@given(st.fractions(-3, 3, max_denominator=99), st.fractions(-3, 3, max_denominator=99))
def test_the_trace_decides_and_the_general_routes_never_contradict_it(x, y):
    """(15) on the enclosed trace; the same point as two uncoupled copies, through rho and the invariant form."""
    values = {a: x, b: y}
    trace, verdict = MATHIEU.enclosure(values, 20).trace(), MATHIEU.verdict(values)
    assume(verdict != Verdict.UNDECIDED and (y or abs(trace) < 2 or abs(trace) > 2))

    assert (verdict == Verdict.STABLE) == bool(abs(trace) < 2)
    assert TWO_ALIKE.verdict(values) == verdict


def test_the_corners_of_the_tongues_are_decided():
    """At a = b = 0 solutions grow linearly, at a = 1/4, b = 0 they do not: exact algebra tells what balls cannot."""
    assert MATHIEU.verdict({a: 0, b: 0}) == Verdict.UNSTABLE
    assert "x^2" in MATHIEU.verdict({a: 0, b: 0}).reason
    assert MATHIEU.verdict({a: Rational(1, 4), b: 0}) == Verdict.STABLE
    assert TWO_ALIKE.verdict({a: Rational(1, 4), b: 0}) == Verdict.STABLE


def test_points_on_a_boundary_that_no_exact_route_reaches_are_undecided():
    """(pi/2)**2 is irrational: the trace 2 cannot be told from 2, whatever the digits, and nothing pretends to."""
    F = FloquetMatrix(Matrix([[0, 1], [-a, 0]]), t, 0, 4)
    verdict = F.verdict({a: pi**2 / 4})
    assert verdict == Verdict.UNDECIDED and "cannot be told from" in verdict.reason


def test_a_millionth_beside_a_boundary_is_decided():
    """Beside b* = q*/2 of the Paul trap, on both sides, at 1e-20 too."""
    star = Rational("0.454023166867288796935291288349769231900145")
    for distance in (Rational(1, 10**6), Rational(1, 10**20)):
        assert MATHIEU.verdict({a: 0, b: star - distance}) == Verdict.STABLE
        assert MATHIEU.verdict({a: 0, b: star + distance}) == Verdict.UNSTABLE


@pytest.mark.parametrize("power", [30, 58, 60])
def test_the_sentence_tells_the_trace_from_the_end_of_stability(power):
    """However near: what is printed does not contain -2, also where only the sign of the difference is known."""
    reason = MATHIEU.verdict({a: Rational(1, 4), b: Rational(1, 10**power)}).reason
    told = reason.split("the trace ")[1].split(" exceeds")[0]

    assert told.startswith("-2 - d, 0 < d < 1.2e-119") if power == 60 else not (arb(told.removeprefix("-2 - ")) <= 0)


def test_damped_systems_are_judged_without_the_trace():
    """|trace| < 2 proves nothing there: a negatively damped oscillator has a small trace and is unstable."""
    growing = {a: Rational(1, 3), b: Rational(1, 10), c: Rational(-1, 50)}

    assert abs(DAMPED.enclosure(growing).trace()) < 2
    assert DAMPED.verdict(growing) == Verdict.UNSTABLE
    assert "Schur" in DAMPED.verdict(growing).reason
    assert DAMPED.verdict({**growing, c: Rational(1, 50)}) == Verdict.STABLE
    assert "asymptotically" in DAMPED.verdict({**growing, c: Rational(1, 50)}).reason


FROM_ZERO = [x for x in cases("floquet_other") if x.values[0]["t0"] == "0"]


@pytest.mark.parametrize("case", [x for x in FROM_ZERO if "multipliers" in x.values[0]])
def test_multipliers_agree_with_the_reference(case):
    """Every reference multiplier lies near one of ours; verdicts agree with the spectral radius where it is clear."""
    F = FloquetMatrix(system(case), t, 0, read(case["t1"]))
    values = numbers(case["params"])
    found = F.multipliers(values, 4 if case["id"] == "nilpotent3" else 20)
    for real, imag in case["multipliers"]:
        target = mpmath.mpc(real, imag)
        nearest = min(abs(x - target) for x in found)
        assert nearest < (1e-4 if case["id"] == "nilpotent3" else 1e-9) * max(1, abs(target))
    radius = mpmath.mpf(case["spectral_radius"])
    if abs(radius - 1) > 1e-6:
        assert F.verdict(values) == (Verdict.UNSTABLE if radius > 1 else Verdict.STABLE)


@settings(max_examples=40)
@given(st.fractions(-3, 3, max_denominator=99), st.fractions(-3, 3, max_denominator=99))
def test_multipliers_come_in_reciprocal_pairs_on_or_off_the_circle(x, y):
    """Number k from the front times number k from the back is 1; what is on the circle is proved to be there."""
    for F in (MATHIEU, TWO_ALIKE):
        found = F.multiplier_enclosures({a: x, b: y}, 20)
        for one, other in zip(found, reversed(found), strict=True):
            product = one.ball * other.ball
            assert product.real.contains(1) and product.imag.contains(0)
            assert one.on_unit_circle == other.on_unit_circle
    verdict = MATHIEU.verdict({a: x, b: y})
    circle = [m.on_unit_circle for m in MATHIEU.multiplier_enclosures({a: x, b: y}, 20)]
    if verdict != Verdict.UNDECIDED and y:
        assert circle == [verdict == Verdict.STABLE] * 2


def test_stable_multipliers_are_reported_on_the_circle():
    """cos + i sin, correctly rounded: the modulus is 1 to the last digit, also for four coupled ones at 40 digits."""
    P = Matrix(
        [[0, 0, 1, 0], [0, 0, 0, 1], [-1 - cos(t) / 9, Rational(1, 5), 0, 0], [Rational(1, 5), -2 - cos(t) / 9, 0, 0]]
    )
    found = FloquetMatrix(P, t, 0).multipliers(digits=40)

    with mpmath.workdps(60):
        assert all(abs(abs(x) - 1) < mpmath.mpf(10) ** -40 for x in found)
    assert all(abs(abs(x) - 1) <= 4e-16 for x in FloquetMatrix(P, t, 0).multipliers())
    assert all(isinstance(x, complex) for x in FloquetMatrix(P, t, 0).multipliers())


def test_double_multipliers_have_their_digits_too():
    """The free particle (both 1, a Jordan block), and two copies of one oscillator."""
    free = FloquetMatrix(Matrix([[0, 1], [0, 0]]), t, 0)

    assert [complex(x) for x in free.multipliers(digits=20)] == [1, 1]
    assert free.verdict() == Verdict.UNSTABLE
    assert len(TWO_ALIKE.multipliers({a: -0.1, b: 0.55})) == 4


def test_sum_resonance_is_unstable_and_difference_resonance_stable():
    """Krein: two oscillators coupled through cos((w1 + w2) t) collide with opposite signs, through the difference with
    equal ones."""
    first, second, eps = Rational(1), Rational(3), Rational(1, 10)
    for frequency, expected in ((4, Verdict.UNSTABLE), (2, Verdict.STABLE)):
        coupling = eps * cos(frequency * t)
        P = Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-(first**2), coupling, 0, 0], [coupling, -(second**2), 0, 0]])
        F = FloquetMatrix(P, t, 0, 2 * pi / frequency)
        assert F.verdict() == expected


# -- other invariants, and odd sizes ---------------------------------------------


def precession(x, y, z):
    """A spin in a magnetic field: x' = field cross x."""
    return Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])


@pytest.mark.parametrize("P", [
    precession(b * cos(t), b * sin(t), a),
    precession(a + cos(t), sin(2 * t) + b, 3),
    sympy.diag(precession(a, b, sin(t)), precession(cos(t), 1, b)),
    sympy.diag(1, 2, Rational(1, 3)).inv() * precession(a * cos(t), b, 1 + sin(t)),
    Matrix([[0, a + b * cos(t)], [-2 * a - 2 * b * cos(t), 0]]),
    Matrix([[a * sin(t) + b * sin(2 * t)]]),
], ids=["about an axis", "not reversing", "two", "in other axes", "in the plane", "one by one"])
def test_solutions_on_ellipsoids_are_stable_everywhere(P):
    """Also where multipliers coincide or are 1; the multipliers are those of the matrix, and on the circle."""
    F = FloquetMatrix(P, t, 8)
    for values in ({a: 0, b: 0}, {a: Rational(1, 3), b: Rational(-2, 7)}, {a: arb(1, 0.1), b: sqrt(2)}):
        assert F.verdict(values) == Verdict.STABLE
    found = F.multiplier_enclosures({a: Rational(1, 3), b: Rational(-2, 7)}, 20)
    M = F.enclosure({a: Rational(1, 3), b: Rational(-2, 7)}, 30)

    assert all(m.on_unit_circle and abs(abs(complex(m)) - 1) < 1e-15 for m in found)
    assert abs(sum(complex(m) for m in found) - float(M.trace())) < 1e-13
    assert certify(F, (a, 0, 1), (b, 0, 1)).fraction(Verdict.STABLE) == 1
    assert (chart(F, (a, 0, 1), (b, 0, 1), points=(5, 4))["verdict"] == 1).all()


def test_an_indefinite_form_bounds_nothing():
    """x1**2 - x2**2 is constant, and solutions grow; so they do where the form has two signs and size three."""
    assert FloquetMatrix(Matrix([[0, cos(t) + 1], [cos(t) + 1, 0]]), t, 0).verdict() == Verdict.UNSTABLE
    boost = Matrix([[0, 1 + cos(t), 0], [1 + cos(t), 0, sin(t) / 9], [0, -sin(t) / 9, 0]])
    assert FloquetMatrix(boost, t, 0).verdict() == Verdict.UNSTABLE
    assert not known_structure(FloquetMatrix(boost, t, 0)).bounded


# -- exponents -------------------------------------------------------------------


@settings(max_examples=40)
@given(st.fractions(-2, 12, max_denominator=99), st.fractions(-3, 3, max_denominator=99))
def test_exponents_of_mathieus_equation_are_its_characteristic_exponent(x, q):
    """mu = i nu up to signs, and up to 2 i where nu is 1 + i s: another route, to 20 digits."""
    nu = mathieu_exponent(x, q, 25)
    P = Matrix([[0, 1], [-a + 2 * b * cos(2 * t), 0]])
    found = FloquetMatrix(P, t, 0, pi).exponents({a: x, b: q}, 20)

    with mpmath.workdps(25):
        for mu in found:
            apart = min(abs(mu - sign * z - turn) for z in (1j * nu, 1j * mpmath.conj(nu)) for sign in (1, -1)
                        for turn in (0, 2j, -2j))
            assert apart < 1e-19
        assert abs((found[0] + found[1]).real) < 1e-19


@pytest.mark.parametrize("A", [[[0, 1], [-1, -Rational(1, 2)]], [[-1, 2], [0, Rational(1, 3)]],
                               [[0, 1, 0], [-4, 0, 0], [1, 0, -1]]], ids=str)
def test_exponents_of_constant_systems_are_their_eigenvalues(A):
    """Whatever the period, up to multiples of 2 pi i / T; a smaller one leaves them as they are."""
    expected = [complex(z) for z, count in Matrix(A).eigenvals().items() for _ in range(count)]
    found = FloquetMatrix(Matrix(A), t, 0, 1).exponents()

    for z in expected:
        assert min(abs(z - mu) for mu in found) < 1e-14
    assert [mu.real for mu in found] == sorted((mu.real for mu in found), reverse=True)


def test_exponents_have_the_mean_trace_for_their_sum_and_the_digits_asked_for():
    """Liouville; exp(mu T) is the multiplier; on the circle nothing is left of the real part."""
    values = {a: Rational(1, 3), b: Rational(1, 4), c: Rational(1, 7)}
    mu, multipliers = DAMPED.exponents(values, 40), DAMPED.multipliers(values, 40)
    with mpmath.workdps(45):
        assert abs(sum(x.real for x in mu) + mpmath.mpf(1) / 7) < mpmath.mpf(10) ** -40
        assert all(abs(mpmath.exp(x * 2 * mpmath.pi) - z) < mpmath.mpf(10) ** -38
                   for x, z in zip(mu, multipliers, strict=True))
    assert all(x.real == 0 for x in MATHIEU.exponents({a: -0.1, b: 0.55}))
    assert FloquetMatrix(Matrix([[cos(t)]]), t, 0).exponents() == [0]


# -- what drifts -------------------------------------------------------------------

FREE = a * (2 + cos(t)) + b * sin(3 * t)
DRIFTING = {
    "two masses": Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-FREE, FREE, 0, 0], [FREE / 3, -FREE / 3, 0, 0]]),
    "driven by a constant": Matrix([[0, a * sin(t) + 2], [0, 0]]),
    "in oblique axes": Matrix([[1, 1], [1, 2]]) * Matrix([[0, b * cos(t) - 1], [0, 0]]) * Matrix([[2, -1], [-1, 1]]),
}


@pytest.mark.parametrize("name", DRIFTING)
def test_what_is_free_to_move_drifts_away(name):
    """Whatever the values: in verdicts and on charts; powers of the true matrix grow in proportion."""
    F = FloquetMatrix(DRIFTING[name], t, 6)
    for values in ({a: 0, b: 0}, {a: Rational(1, 3), b: Rational(2, 7)}, {a: arb(1, 0.1), b: sqrt(2)}):
        assert F.verdict(values) == Verdict.UNSTABLE
    M = true_fundamental_matrix(DRIFTING[name].subs({a: Rational(1, 99), b: 0}), t, 0, 2 * pi, 25)
    first, second = (mpmath.mnorm(M**k, mpmath.inf) for k in (1000, 2000))

    assert 1.5 < second / first < 2.5
    assert certify(F, (a, 0, 1), (b, 0, 1)).fraction(Verdict.UNSTABLE) == 1
    assert (chart(F, (a, 0, 1), (b, 0, 1), points=(5, 4))["verdict"] == -1).all()


@pytest.mark.parametrize("P", [
    [[0, a * sin(t) - b * cos(2 * t + 1)], [0, 0]],
    [[a * cos(t)]],
    [[0, 0, cos(t)], [0, 0, b * sin(t)], [0, 0, 0]],
    [[0, 0], [0, 0]],
], ids=str)
def test_waves_of_constants_of_motion_stay_bounded(P):
    """As integrals of waves do."""
    F = FloquetMatrix(Matrix(P), t, 2)

    assert F.verdict({a: 2, b: Rational(1, 3)}) == F.verdict({a: arb(1, 0.1), b: sqrt(2)}) == Verdict.STABLE


k, m = Symbol("k", integer=True), Symbol("m", integer=True)


@pytest.mark.parametrize("P, values, expected", [
    ([[0, cos(k * t) * cos(m * t)], [0, 0]], {k: 3, m: 2}, Verdict.STABLE),
    ([[0, cos(k * t) * cos(m * t)], [0, 0]], {k: 3, m: 3}, Verdict.UNDECIDED),
    ([[0, cos(a) + cos(t)], [0, 0]], {a: 1}, Verdict.UNDECIDED),
    ([[0, a + cos(t)], [0, 0]], {a: (-1, 1)}, Verdict.UNDECIDED),
    ([[0, a + cos(t)], [0, 0]], {a: 0}, Verdict.STABLE),
    ([[0, a + cos(t)], [0, 0]], {a: Rational(1, 10**9)}, Verdict.UNSTABLE),
], ids=str)
def test_a_mean_counts_only_where_it_is_known(P, values, expected):
    """Not that of waves that may stand still, of functions of parameters, and of boxes."""
    assert FloquetMatrix(Matrix(P), t, 2).verdict(values) == expected


SQUARES = FloquetMatrix(Matrix([[0, 1, 0], [0, 0, 1], [2 * b * sin(t), -4 * a - 4 * b * cos(t), 0]]), t, 0)


@settings(max_examples=40)
@given(st.fractions(-1, 3, max_denominator=99), st.fractions(-2, 2, max_denominator=99))
def test_products_of_mathieu_functions_have_the_products_of_their_multipliers(x, y):
    """Products z of two solutions of y'' + q y = 0 solve one equation of third order, (z'' + 4 q z)' = 2 q' z."""
    values = {a: x, b: y}
    single, squares = MATHIEU.multiplier_enclosures(values, 25), SQUARES.multiplier_enclosures(values, 20)
    expected = [single[0].ball ** 2, acb(1), single[1].ball ** 2]

    assert all(any(m.ball.overlaps(z) for m in squares) for z in expected)
    assert SQUARES.verdict(values) in (MATHIEU.verdict(values), Verdict.UNDECIDED)
    trace = MATHIEU.enclosure(values, 25).trace()
    if min(abs(trace), abs(trace - 2), abs(trace + 2)) > 1e-6:
        assert SQUARES.verdict(values) == MATHIEU.verdict(values)


def test_a_chart_of_odd_size_is_that_of_the_equation_it_is_made_of():
    """By points and by rectangles; where both decide they agree, and not all is left open."""
    data = [chart(F.to_order(42), (a, 0.15, 0.3), (b, 0, 0.1), points=(15, 9))["verdict"] for F in (SQUARES, MATHIEU)]
    proved = [certify(F, (a, 0.15, 0.3), (b, 0, 0.1), undecided=0.1, seconds=600) for F in (SQUARES, MATHIEU)]

    assert (data[0] * data[1] >= 0).all() and float((data[0] == 0).mean()) < 0.2
    assert proved[0].undecided <= 0.1
    for x, _, y, _ in proved[0].cells[::7]:
        assert int(proved[0].verdict(x, y)) * int(proved[1].verdict(x, y)) >= 0


# -- resonances ------------------------------------------------------------------

WAVES = FloquetMatrix(Matrix([[a * cos(k * t) * cos(m * t), 1], [-b, 0]]), t, 0)


@pytest.mark.parametrize("at", [{k: 3, m: 3}, {k: 3, m: -3}, {k: 0, m: 0}, {k: (0, 0), m: 0}, {k: 3, m: 2},
                                {k: 0, m: 1}], ids=str)
def test_a_wave_that_stands_still_has_a_mean(at):
    """Frequencies whose sum or difference vanishes: the determinant is that with the numbers put in before."""
    values = {a: Rational(1, 5), b: Rational(1, 16), **at}
    plain = {s: x[0] if isinstance(x, tuple) else x for s, x in at.items()}
    alone = FloquetMatrix(WAVES.P.as_matrix().subs(plain), t, 0)

    assert WAVES.verdict(values) == alone.verdict({a: Rational(1, 5), b: Rational(1, 16)})
    assert ("determinant is 1" in WAVES.verdict(values).reason) == (plain[k] ** 2 != plain[m] ** 2)
    for found, true in zip(WAVES.multipliers(values, 10), alone.multipliers(values, 10), strict=True):
        assert abs(found - true) < 1e-9


@pytest.mark.parametrize("order", [0, 1, 4])
def test_an_iterate_has_no_value_where_it_was_divided_by_zero(order):
    """And where it has one it is that of the iterate with the numbers put in before."""
    F = FloquetMatrix(Matrix([[a * cos(k * t) * cos(m * t), b], [-cos(2 * t), 0]]), t, order)
    for x in range(-3, 4):
        for y in range(-3, 4):
            values = {a: Rational(1, 5), b: Rational(3, 4), k: x, m: y}
            plain = FloquetMatrix(F.P.as_matrix().subs({k: x, m: y}), t, order).evaluate(values, 20)
            many, error = F.lambdify([a, b, k, m], bound=True)(0.2, 0.75, [x, x], y)
            try:
                found = F.evaluate(values, 20)
            except BadInputError as refused:
                assert "resonance" in str(refused)
                assert np.isnan(many).all() and np.isinf(error).all()
            else:
                with mpmath.workdps(30):
                    assert max(abs(z) for z in found - plain) < 1e-18
                assert abs(many[0] - np.array(plain.tolist(), dtype=float)).max() < 1e-14


def test_a_table_is_not_read_at_a_resonance():
    """The iterate it holds is not that of the equation there."""
    F = FloquetMatrix(Matrix([[c * cos(k * t)]]), t, 0)
    G = tabulate(F, {c: (0, Rational(1, 10)), k: (0, 2)}, 4)

    for x in (0, 1):
        inside = G.enclosure({c: Rational(1, 10), k: x}, 4)[0, 0]
        assert inside.overlaps(arb(1) if x else (arb.pi() / 5).exp())


# -- the pieces ------------------------------------------------------------------


def test_the_symplectic_form_is_found_where_there_is_one():
    """Second-order systems whose mass matrix is not the identity; not for damping; for any Hamiltonian in x and p."""
    mass, stiff = Matrix([[2, 1], [1, 3]]), Matrix([[5, 1], [1, 4]])
    zero, one = Matrix.zeros(2), Matrix.eye(2)
    second = Matrix([[zero, one], [-(mass.inv()) * (a * stiff + b * stiff * mass * stiff * cos(t)), zero]])
    hamiltonian = Matrix(
        [[a * sin(t), 1, cos(t), 0], [1, b, 0, 2], [-3, cos(2 * t), -a * sin(t), -1], [cos(2 * t), 1, -1, -b]]
    )
    damped = second - Matrix([[zero, zero], [zero, one / 7]])

    for P, exists in ((second, True), (hamiltonian, True), (damped, False)):
        forms = known_structure(FloquetMatrix(P, t, 0)).forms
        assert bool(forms) == exists
        for form in forms[:1]:
            W = Matrix(4, 4, [Rational(int(x.p), int(x.q)) for x in form.entries()])
            product = (W * P).expand()
            assert W.T == -W and W.det() != 0 and (product - product.T).expand().is_zero_matrix


@given(st.lists(st.complex_numbers(max_magnitude=3, min_magnitude=0.1), min_size=1, max_size=4))
@settings(max_examples=60)
def test_discs_hold_the_roots(roots):
    """Real polynomials from conjugate pairs: every root is in a disc, every cluster has as many roots as discs."""
    with ctx.workprec(120):
        p = arb_poly([1])
        for z in roots:
            p = p * arb_poly([arb(z.real) ** 2 + arb(z.imag) ** 2, -2 * arb(z.real), 1])
        discs = root_discs(p)
        for z in roots:
            assert any(not abs(acb(z.real, z.imag) - d.center) > d.radius for d in discs)
        assert all(not d.real or any(z.imag == 0 for z in roots) for d in discs if d.alone)


@pytest.mark.parametrize("count", [2, 3, 4])
@given(st.integers(-(2**40), 2**40))
@settings(max_examples=8)
def test_the_square_of_every_disc_holds_a_root_that_coincides_with_others(count, numerator):
    """Of (x - r)**n in balls single discs may miss r; their squares hold the whole cluster."""
    with ctx.workprec(997):
        r = arb(numerator) / 2**40
        p = arb_poly([-r, 1]) ** count
        p = arb_poly([*(c + arb(0, arb(2) ** -960) for c in p.coeffs()[:-1]), 1])
        assert all(d.ball.contains(acb(r)) for d in root_discs(p))


def test_equal_oscillators_that_are_stable_have_no_multiplier_proved_off_the_circle():
    """Three multipliers coincide; that they are on the circle is not proved, but nor is the contrary."""
    S = sympy.eye(3) * (Rational(11, 6) + cos(t) / 7)
    F = FloquetMatrix(sympy.zeros(3).row_join(sympy.eye(3)).col_join((-S).row_join(sympy.zeros(3))), t, 0)
    single = FloquetMatrix(Matrix([[0, 1], [-S[0, 0], 0]]), t, 0)
    true = [m.ball for m in single.multiplier_enclosures({}, 60)]

    assert F.verdict() == Verdict.STABLE
    for digits in (15, 30):
        found = F.multiplier_enclosures({}, digits)
        assert not any(m.on_unit_circle is False for m in found)
        assert all(any(m.ball.overlaps(z) for z in true) for m in found)


@given(st.lists(st.floats(-0.95, 0.95), min_size=2, max_size=4), st.floats(1.1, 3))
@settings(max_examples=60)
def test_schur_and_cohn_count_what_is_outside(inside, outside):
    """Triangular matrices show their multipliers."""
    size = len(inside)
    lower = [[inside[i] if i == j else (0.5 if j < i else 0) for j in range(size)] for i in range(size)]

    assert schur_cohn(arb_mat(lower)) == Verdict.STABLE
    lower[0][0] = outside
    assert schur_cohn(arb_mat(lower)) == Verdict.UNSTABLE
    lower[0][0] = 1.0
    assert schur_cohn(arb_mat(lower)) == Verdict.UNDECIDED


def test_the_polynomial_in_rho_has_the_sums_of_reciprocal_pairs_as_roots():
    """diag(2, 1/2, 3, 1/3): rho = 5/2 and 10/3."""
    with ctx.workprec(100):
        diagonal = [arb(2), arb(1) / 2, arb(3), arb(1) / 3]
        p = in_rho(arb_mat([[diagonal[i] if i == j else 0 for j in range(4)] for i in range(4)]))
        assert p(arb(5) / 2).contains(0) and p(arb(10) / 3).contains(0) and p.degree() == 2


def rotations(*angles):
    """A symplectic matrix that turns one plane after another, in balls, and its form."""
    m = len(angles)
    rows = [[arb(0)] * (2 * m) for _ in range(2 * m)]
    form = fmpq_mat(2 * m, 2 * m)
    for k, angle in enumerate(angles):
        rows[k][k] = rows[k + m][k + m] = arb(angle).cos()
        rows[k][k + m], rows[k + m][k] = arb(angle).sin(), -arb(angle).sin()
        form[k, k + m], form[k + m, k] = fmpq(1), fmpq(-1)
    return arb_mat(rows), [form, form]


def test_a_rotation_by_equal_angles_is_stable_by_its_invariant_form():
    """Multipliers that coincide: with one sign a definite form proves stability, f = 1 or not; with two signs nothing
    does, and without the form nothing is claimed."""
    with ctx.workprec(100):
        for angles in ((1.0, 1.0), (1.0, 1.0, -2.0)):
            matrix, forms = rotations(*angles)
            assert judge(matrix, Structure(True, forms, "")) == Verdict.STABLE
            assert judge(matrix, Structure(True, [], "")) == Verdict.UNDECIDED
        matrix, forms = rotations(1.0, -1.0)
        assert judge(matrix, Structure(True, forms, "")) == Verdict.UNDECIDED


@given(st.lists(st.floats(0.1, 5), min_size=3, max_size=3), st.floats(-1, 1))
@settings(max_examples=40)
def test_definite_forms_are_found_definite(diagonal, x):
    """L D L' with positive D is; with a negative entry it is not."""
    with ctx.workprec(100):
        lower = arb_mat([[1, 0, 0], [x, 1, 0], [x * x, -x, 1]])

        def form(d):
            return lower * arb_mat([[d[0], 0, 0], [0, d[1], 0], [0, 0, d[2]]]) * lower.transpose()

        assert is_definite(form(diagonal))
        assert not is_definite(form([diagonal[0], -diagonal[1], diagonal[2]]))


def test_a_verdict_is_a_value_with_three_outcomes():
    """Equality by outcome, numbers 1, -1, 0 for charts, a sentence, no truth value, pickling."""
    verdict = MATHIEU.verdict({a: -0.1, b: 0.55})

    assert verdict == Verdict.STABLE != Verdict.UNSTABLE and hash(verdict) == hash(Verdict.STABLE)
    assert (int(Verdict.STABLE), int(Verdict.UNSTABLE), int(Verdict.UNDECIDED)) == (1, -1, 0)
    assert str(verdict).startswith("STABLE: the determinant is 1") and repr(verdict) == "Verdict.STABLE"
    assert pickle.loads(pickle.dumps(verdict)).reason == verdict.reason
    with pytest.raises(TypeError, match="three outcomes"):
        bool(verdict)
    assert verdict != "STABLE"


def test_verdicts_need_every_parameter():
    """A missing value is named."""
    with pytest.raises(MissingParameterError, match="b"):
        MATHIEU.verdict({a: 1})
    with pytest.raises(BadInputError):
        MATHIEU.multipliers({a: (0, 1), b: 1})


def test_irrational_coefficients_do_not_hide_the_structure():
    """sqrt(2), pi: the form is found with the parameters as symbols."""
    F = FloquetMatrix(Matrix([[0, sqrt(2)], [-a / pi - b * cos(t), 0]]), t, 0)

    assert F.verdict({a: 1, b: fmpq(1, 10)}) in (Verdict.STABLE, Verdict.UNSTABLE)
    assert abs(cmath.phase(complex(F.multiplier_enclosures({a: 1, b: 0.1})[0]))) <= cmath.pi


QUESTIONS = [
    FloquetMatrix.verdict,
    FloquetMatrix.multipliers,
    FloquetMatrix.exponents,
    FloquetMatrix.enclosure,
    FloquetMatrix.remainder,
    lambda F, values: FloquetMatrix.for_accuracy(F.P, t, values, Rational(1, 10), F.period),
    lambda F, values: tabulate(F, values, digits=10),
]


@pytest.mark.parametrize("ask", QUESTIONS)
@pytest.mark.parametrize("sign, value", [(1, -1), (-1, 1), (1, -Rational(1, 3)), (1, (-2, -1))])
def test_values_that_make_the_period_negative_are_refused(ask, sign, value):
    """The damped equation is stable; its matrix over -T would be that of growing solutions."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(h * t), -c]]), t, 2, sign * 2 * pi / h)
    values = {a: Rational(3, 10), b: Rational(1, 100), c: Rational(1, 10)}

    assert F.verdict({**values, h: sign}) == Verdict.STABLE
    with pytest.raises(BadInputError, match=r"period must be positive, but -?2\*pi/h is .* at a = 3/10, b = 1/100"):
        ask(F, {**values, h: value})


@pytest.mark.parametrize("ask", QUESTIONS)
@pytest.mark.parametrize(
    "coefficient, period, value",
    [(cos(h * t), 2 * pi / h, 0), (cos(h * t), 2 * pi / h, (-1, 1)), (1 / h, 2 * pi, 0), (1 / h, 2 * pi, (-1, 1)),
     (sqrt(h), 2 * pi, -1)],
)
def test_values_at_a_pole_are_refused(ask, coefficient, period, value):
    """Of the coefficients or of the period, on a box too; and roots of negative numbers."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - coefficient, 0]]), t, 2, period)

    with pytest.raises(BadInputError, match="must be finite and real, but one of them is not at a = 1, h = "):
        ask(F, {a: 1, h: value})


def test_a_value_close_to_a_pole_is_none():
    """a = pi to fifty digits, where few bits cannot tell 1/(a - pi) from a pole."""
    F = FloquetMatrix(Matrix([[0, 1], [-b / (a - pi) - cos(t), 0]]), t, 0)
    near = Rational(str(pi.evalf(50)))
    found = F.enclosure({a: near, b: Rational((near - pi).evalf(60)) / 5}, 5)

    assert found.overlaps(MATHIEU.enclosure({a: Rational(1, 5), b: 1}, 5))


AREA = FloquetMatrix(Matrix([[b * cos(2 * t), 1 + sin(t)], [-a - b * cos(t), cos(t)]]), t, 0)


@pytest.mark.parametrize("constant", [Rational(-1, 4), Rational(1, 4), Rational(3, 4)])
def test_a_trace_of_mean_zero_is_enough_for_the_determinant_to_be_one(constant):
    """P is neither Hamiltonian nor reversible, but det Phi = exp(integral of trace P) = 1: the trace decides."""
    values = {a: constant, b: Rational(1, 3)}
    verdict, trace = AREA.verdict(values), float(AREA.enclosure(values).trace().mid())

    assert verdict == (Verdict.STABLE if abs(trace) < 2 else Verdict.UNSTABLE)
    assert abs(math.prod(AREA.multipliers(values)) - 1) < 1e-15
    assert {m.on_unit_circle for m in AREA.multiplier_enclosures(values)} == {abs(trace) < 2}


def test_the_mean_of_the_trace_may_vanish_at_some_values_only():
    """With c = 0 the determinant is 1 and the trace decides; with c > 0 it is damped."""
    F = FloquetMatrix(Matrix([[cos(t), 1], [-a - b * sin(2 * t), -c]]), t, 0)
    values = {a: Rational(1, 3), b: Rational(1, 10)}

    assert "determinant is 1" in F.verdict({**values, c: 0}).reason
    assert "Schur and Cohn" in F.verdict({**values, c: Rational(1, 10)}).reason


def test_a_product_of_multipliers_of_modulus_one_does_not_hide_one_outside():
    """Mathieu's unstable equation beside a third multiplier 1: Schur and Cohn's first step is 1 against 1."""
    P = Matrix([[0, 1, cos(t)], [-a - b * cos(t), 0, 1], [0, 0, cos(t)]])

    assert FloquetMatrix(P, t, 0).verdict({a: Rational(1, 4), b: Rational(1, 5)}) == Verdict.UNSTABLE
    assert FloquetMatrix(P, t, 0).verdict({a: Rational(1, 3), b: Rational(1, 10)}) == Verdict.UNDECIDED


@pytest.mark.parametrize("entries", [[cos(t), 0, sin(t)], [cos(t), 1, sin(2 * t)], [cos(t) - 1, 0, sin(t) - 1]])
def test_multipliers_that_coincide_exactly_have_digits(entries):
    """The approximations of a double root fall together, on the root itself; the disc around them need not be huge."""
    P = Matrix([[entries[0], entries[1]], [0, entries[2]]])
    expected = mpmath.exp(2 * mpmath.pi * entries[0].subs(t, pi / 2))

    for found in FloquetMatrix(P, t, 0).multipliers({}, digits=12):
        assert abs(found - expected) < 1e-11 * expected


@pytest.mark.parametrize("index, verdict", [(0, Verdict.UNSTABLE), (1, Verdict.STABLE), (2, Verdict.STABLE)])
def test_modes_of_hanging_bobs_have_a_verdict_as_they_are(index, verdict):
    """Exact mu of three bobs are roots of a cubic: x'' + mu (1 + cos t) x = 0, as with mu's value to 40 digits."""
    mu = CRootOf(a**3 - 9 * a**2 + 18 * a - 6, index)
    F = FloquetMatrix(Matrix([[0, 1], [-mu - mu * cos(t), 0]]), t, 10)
    value = mu.evalf(40)

    assert F.verdict() == MATHIEU.verdict({a: value, b: value}) == verdict
    assert F.remainder() == pytest.approx(MATHIEU.to_order(10).remainder({a: value, b: value}), rel=1e-9)
    assert F.enclosure({}, 20)[0, 0].overlaps(MATHIEU.enclosure({a: value, b: value}, 20)[0, 0])


def test_boundaries_take_roots_of_polynomials():
    """The boundary trace = 2 in a, at b a tenth of the least mu of three bobs: a = -b**2 / 2 to second order."""
    mu = CRootOf(a**3 - 9 * a**2 + 18 * a - 6, 0)
    above, value = boundaries(MATHIEU.to_order(12))[0], mu.evalf(40)

    found = above.root(a, (-1, Rational(1, 10)), {b: mu / 10})
    assert found.value == above.root(a, (-1, Rational(1, 10)), {b: value / 10}).value
    assert found.value == pytest.approx(-(value / 10) ** 2 / 2, rel=1e-2)
