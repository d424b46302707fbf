"""Picard iterates: the definition, the increments, another origin of time, and the true solution."""

import copy
import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy
from hypothesis import given, strategies as st
from sympy import I, Matrix, Rational, S, Symbol, cos, exp, pi, sin, sqrt

from fastpicard import FloquetMatrix, FundamentalMatrix, PicardIterate, PoissonSeries, fast_picard, picard, tabulate
from fastpicard.iteration import PackedIncrements, first_increments, identity_columns, in_series
from fastpicard.matrix import read_matrix
from fastpicard.ring import expression_of
from tests.oracles import (
    distance,
    plain_expression,
    plain_picard,
    same_tree,
    true_fundamental_matrix,
    truncation_bound,
    vanishes,
    within,
)
from tests.strategies import (
    VALUES,
    a,
    b,
    c,
    frequencies,
    matrices,
    phases,
    plain_matrices,
    plain_times,
    small_integers,
    t,
    t0,
    vectors,
    w,
)

MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
# No symmetry: sines and cosines, rational frequencies, a phase, damping.
GENERAL = Matrix(
    [[Rational(1, 3) * sin(t), 1, 0], [a * cos(t / 2) - b, 2, sin(3 * t / 2)], [b, cos(t + Rational(1, 3)), -1]]
)
orders = st.integers(0, 3)


# -- the definition ------------------------------------------------------------------


@given(plain_matrices(2), st.lists(small_integers, min_size=2, max_size=2), orders)
def test_iterates_are_those_of_the_definition_on_plain_dictionaries(P, x0, n):
    """x0 + I[P x_{n-1}] with Fractions, no increments, no common denominators: the same trees."""
    system = Matrix([[plain_expression(entry) for entry in row] for row in P])
    found = fast_picard(system, t, x0, n).as_matrix()
    expected = [plain_expression(entry) for entry in plain_picard(P, list(map(Fraction, x0)), n)]

    assert all(same_tree(x, y) for x, y in zip(found, expected))


@given(matrices(2), vectors, st.integers(1, 4))
def test_the_derivative_of_an_iterate_is_p_times_the_one_before(P, x0, n):
    """X_n' = P X_{n-1} exactly, and X_n(0) = x0; P X is not X P for matrices without symmetry."""
    now, before = fast_picard(P, t, x0, n), fast_picard(P, t, x0, n - 1)

    assert now.series.diff() == read_matrix(P, t) @ before.series
    assert now(0) == Matrix(x0)


@given(matrices(2, rates=frequencies, angles=phases), st.integers(1, 2))
def test_the_law_holds_for_every_kind_of_frequency_and_phase(P, n):
    """Irrational and symbolic frequencies, phases: Phi_n' = P Phi_{n-1}, Phi_n(0) = 1."""
    now, before = FundamentalMatrix(P, t, n), FundamentalMatrix(P, t, n - 1)

    assert now.series.diff() == read_matrix(P, t) @ before.series
    assert all(PoissonSeries(now[i, j](0), t) == int(i == j) for i in range(2) for j in range(2))


@given(matrices(3), st.integers(1, 2))
def test_the_law_holds_for_three_unknowns(P, n):
    """Nine entries, no two alike."""
    now, before = FundamentalMatrix(P, t, n), FundamentalMatrix(P, t, n - 1)

    assert now.series.diff() == read_matrix(P, t) @ before.series


@given(matrices(2), vectors, orders)
def test_iterates_are_columns_of_the_fundamental_matrix(P, x0, n):
    """x_n = Phi_n x0."""
    assert (
        Matrix(fast_picard(P, t, x0, n).as_matrix()) == (FundamentalMatrix(P, t, n).as_matrix() * Matrix(x0)).expand()
    )


@given(matrices(1, most=2), st.integers(0, 5))
def test_scalar_iterates_are_sections_of_the_exponential_series(P, n):
    """x' = p x: X_n = sum_{k<=n} I[p]**k / k!."""
    exponent = PoissonSeries(P[0, 0], t).integrate()
    series = sum((exponent**k * Rational(1, sympy.factorial(k)) for k in range(n + 1)), PoissonSeries(0, t))

    assert fast_picard(P, t, [1], n)[0, 0] == series


# -- increments -------------------------------------------------------------------------


@given(matrices(2), st.integers(0, 4))
def test_increments_add_up_to_the_iterate(P, n):
    """Phi_n = I_0 + ... + I_n, I_0 = 1, I_{k+1}' = P I_k."""
    Phi, system = FundamentalMatrix(P, t, n), read_matrix(P, t)
    total = Phi.increment(0)
    for k in range(1, n + 1):
        total = total + Phi.increment(k)
        assert Phi.increment(k).diff() == system @ Phi.increment(k - 1)

    assert Phi.series == total
    assert Phi.increment(0).as_matrix() == sympy.eye(2)


@given(matrices(2), st.integers(0, 5), st.integers(0, 5))
def test_going_on_from_an_iterate_gives_what_a_fresh_start_gives(P, n, m):
    """to_order up and down, with common multiples of the frequencies that change on the way."""
    there = FundamentalMatrix(P, t, n).to_order(m)

    assert there.series == FundamentalMatrix(P, t, m).series
    assert (there.n, there.shape) == (m, (2, 2))


@given(matrices(2), vectors, st.lists(st.integers(0, 6), min_size=1, max_size=3))
def test_any_way_to_an_order_ends_in_the_same_iterate(P, x0, way):
    """Several changes of order in a row; trees, not only values."""
    iterate = fast_picard(P, t, x0, 2)
    for n in way:
        iterate = iterate.to_order(n)

    assert iterate.as_matrix() == fast_picard(P, t, x0, way[-1]).as_matrix()


def same_increments(packed, plain, size):
    """Whether sums and last increments in packed integers equal those in series, and those of all lower orders."""
    return isinstance(packed, PackedIncrements) and all(
        PoissonSeries.from_modes(mine(i, j), t) == PoissonSeries.from_modes(other(i, j), t)
        for k in reversed(range(plain.order + 1))
        for here, there in ((packed.to_order(k), plain.to_order(k)),)
        for mine, other in ((here.newest, there.newest), (here.total, there.total))
        for i in range(size)
        for j in range(size)
    )


@given(matrices(2), st.integers(0, 4))
def test_the_engine_in_integers_agrees_with_the_engine_in_series(P, n):
    """Two routes to every increment: packed integers, and products and integrals of series."""
    system = read_matrix(P, t)
    packed = first_increments(system, identity_columns(2), n)
    plain = in_series(system, FundamentalMatrix(P, t, 0).series, n)

    assert same_increments(packed, plain, 2)


@pytest.mark.parametrize("n", [12, 40])
@pytest.mark.parametrize("drive", [2 + cos(t), 2 + b * cos(t), a + b * cos(t)], ids=str)
def test_memory_is_that_of_the_terms(drive, n):
    """Not of all increments, where their terms are like: they would be several times as many numbers."""
    Phi = FundamentalMatrix(Matrix([[0, 1], [-drive, 0]]), t, n)
    found = Phi.increments.iterate
    held = {id(row): row.length() for columns in (found.sums, found.newest) for column in columns
            for entries in (column.entries, column.integrals) for entry in entries.values()
            for rows in entry.values() for row in rows.values()}
    terms = sum(row.length() for entries in Phi.series.rows for modes in entries for row in modes.values())

    assert sum(held.values()) < 2 * terms


numbers = st.sampled_from([S.One, S.One, Rational(-2, 3), a, -2 * b])
constant_rows = st.one_of(
    st.builds(lambda c, d: {0: [0, c, d]}, numbers, numbers),
    st.builds(lambda c, d: {0: [0, c, 0], 2: [0, d, 0]}, numbers, numbers),
    st.builds(lambda c, d: {0: [0, c, 0], 2: [d, 0, 0]}, numbers, numbers),
    st.builds(lambda c, d: {0: [d, c, 0]}, numbers, numbers),
)


@given(matrices(3, angles=phases), constant_rows, st.integers(0, 3))
def test_a_row_of_constants_commutes_with_the_integral(P, rows, m):
    """x_0' = c x_1 + d x_2: integrals found before, and derivatives, against the engine in series; X_n' = P X_(n-1)."""
    for i, row in rows.items():
        P[i, :] = [row]
    system = read_matrix(P, t)
    packed = first_increments(system, identity_columns(3), m).to_order(3)
    plain = in_series(system, FundamentalMatrix(P, t, 0).series, 3)

    assert same_increments(packed, plain, 3)
    assert FundamentalMatrix(P, t, 3).series.diff() == system @ FundamentalMatrix(P, t, 2).series


drives = st.sampled_from([a + b * cos(t), b * sin(2 * t) - a * cos(t) / 3, 2 * cos(t + c) - b])


@given(st.lists(st.sampled_from([-9, -1, 0, 1, 2, Rational(3, 4)]), min_size=6, max_size=6), drives, drives)
def test_columns_in_proportion_are_added_first(K, first, second):
    """x_0'' = k_0 f x_0 + k_1 f x_1 + .., and x_1 with another function at one place, against the engine in series."""
    P = Matrix([[0, 0, 1, 0], [0, 0, 0, 2], [K[0] * first, K[1] * first, 0, K[2] * first],
                [K[3] * first, K[4] * second, K[5] * first, 0]])
    system = read_matrix(P, t)
    packed = first_increments(system, identity_columns(4), 2).to_order(4)
    plain = in_series(system, FundamentalMatrix(P, t, 0).series, 4)

    assert same_increments(packed, plain, 4)


@pytest.mark.parametrize(
    "drive, degree",
    [
        (a + b * cos(t + pi / 5), 4),
        (b * cos(t + pi / 8) + sqrt(2), 8),
        (sin(pi / 5) * cos(sqrt(5) * t) - 1, 4),
        (sqrt(1 + sqrt(2 + sqrt(3))) * cos(t), 8),
        (Rational(2, 3) * 2 ** Rational(1, 3) * exp(I * t), 6),
        (sqrt(a + 1) * cos(t) + a * sin(2 * t) / cos(pi / 5), 2),
    ],
    ids=str,
)
def test_powers_of_roots_are_multiplied_out_as_they_arise(drive, degree):
    """Against the engine in series, which lets them be; as many products are left as the degrees of the roots make."""
    P = Matrix([[0, 1], [-drive, 0]])
    system = read_matrix(P, t)
    packed = first_increments(system, identity_columns(2), 3).to_order(7)
    plain = in_series(system, FundamentalMatrix(P, t, 0).series, 7)

    assert same_increments(packed, plain, 2)
    monomials = {m for k in range(8) for _, _, m in packed.to_order(k).newest(1, 0)}
    roots = {tuple((g, e) for g, e in m if not expression_of(g).free_symbols) for m in monomials}
    assert len(roots) <= degree and all(e < 1 for root in roots for g, e in root if expression_of(g) != I)


@pytest.mark.parametrize(
    "P",
    [
        GENERAL,
        GENERAL.subs(t, 3 * w * t),
        GENERAL.subs(t, sqrt(2) * t),
        GENERAL.subs({a: a / b, b: pi}),
        GENERAL.subs(a, sqrt(a)),
        GENERAL.subs({a: sqrt(2), b: sqrt(6)}),
        GENERAL.subs(b, 1 / (a + b)),
    ],
    ids=str,
)
def test_both_engines_agree_where_coefficients_are_unusual(P):
    """A symbolic or irrational unit of frequency, roots, quotients, negative powers."""
    system = read_matrix(P, t)
    packed = first_increments(system, identity_columns(3), 3)
    plain = in_series(system, FundamentalMatrix(P, t, 0).series, 3)

    assert same_increments(packed, plain, 3)


# -- another origin of time ----------------------------------------------------------------


origins = st.sampled_from([S.One, pi, t0, Rational(-3, 2), t0 + pi, 2 * t0])


@pytest.mark.parametrize(
    "f, origin",
    [(cos(t), 0.1), (cos(t + 0.1) + a, 0), (cos(2 * t + 0.3 * a), Rational(1, 10**12)), (cos(0.1 * t) - cos(2 * t), 0),
     (cos(a * t) + cos(0.7 * a * t), 0.3), (a**0.1 * cos(t) + a ** Rational(1, 3), 0), (cos(10**12 * t) + sin(t), pi)],
    ids=str)
def test_phases_frequencies_and_exponents_may_be_any_dyadic_numbers(f, origin):
    """The integers that stand for 0.1 have 55 bits, and are as good as small ones."""
    P = [[0, 1], [f, 0]]
    Phi = FundamentalMatrix(P, t, 4, origin)

    assert Phi.series.diff() == read_matrix(P, t) @ Phi.to_order(3).series
    assert all(PoissonSeries(x, t) == y for x, y in zip(Phi(origin), (1, 0, 0, 1), strict=True))


@given(matrices(2), vectors, origins, st.integers(0, 1))
def test_iterates_from_another_time_start_there_and_obey_the_law(P, x0, origin, n):
    """X_{n+1}' = P X_n and X_n(t0) = x0, for numbers, multiples of pi and symbols."""
    before, now = fast_picard(P, t, x0, n, origin), fast_picard(P, t, x0, n + 1, origin)

    assert now.series.diff() == read_matrix(P, t) @ before.series
    assert all(PoissonSeries(now[i, 0](origin), t) == x0[i] for i in range(2))


@pytest.mark.parametrize("origin", [t0, t0 + 1, 1 + sqrt(2), pi / 3 + 1 / (a + 1), sqrt(t0) + pi * c], ids=str)
@pytest.mark.parametrize(
    "P",
    [[[0, cos((1 + c) * t)], [sin((a - c) * t), cos(t) * sin(c * t)]],
     [[cos(sqrt(2) * t) * cos(t), t], [cos(t + a), sin((1 + sqrt(3)) * t)]],
     [[0, 1], [-a - b * cos(t), -c]]],
    ids=["sums of symbols", "sums of roots", "one unit"])
def test_at_the_origin_of_time_the_iterate_is_identically_the_initial_value(P, origin):
    """Sums in frequencies and times are multiplied out before they meet."""
    assert FundamentalMatrix(P, t, 3, origin)(origin) == sympy.eye(2)


def test_values_at_sums_are_expanded():
    """As all that is written is, so that they meet others."""
    f = PoissonSeries(t**3 + t * cos((a - b) * t), t)

    assert f(t0 - 1) - (t0 - 1) ** 3 - (t0 - 1) * cos((a - b) * (t0 - 1)) != 0
    assert f(t0 - 1) == sympy.expand((t0 - 1) ** 3 + (t0 - 1) * cos((a - b) * (t0 - 1)))
    assert f(2 * t + 1).subs(t, 0) == 1 + cos(a - b)


@given(matrices(2, rates=st.just(S.Zero)), st.integers(0, 4))
def test_autonomous_systems_know_only_the_time_since_the_start(P, n):
    """Phi_n(t; t0) = Phi_n(t - t0) for constant P."""
    shifted, plain = FundamentalMatrix(P, t, n, t0), FundamentalMatrix(P, t, n)

    assert (shifted.as_matrix() - plain(t - t0)).expand() == sympy.zeros(2)


@given(matrices(2), plain_times, st.sampled_from([Rational(1, 2), Rational(-2), pi]))
def test_shifting_the_system_shifts_the_iterate(P, time, origin):
    """Phi_n(t; t0) of P(t) is Phi_n(t - t0; 0) of P(t + t0), in thirty digits."""
    here = FundamentalMatrix(P, t, 2, origin).evaluate(time, VALUES, 30)
    there = FundamentalMatrix(P.xreplace({t: t + origin}), t, 2).evaluate(time - origin, VALUES, 30)

    assert distance(here, there) <= mpmath.mpf(10) ** -25 * (1 + mpmath.mnorm(here, 1))


@pytest.mark.parametrize("origin", [1, pi, t0, Rational(-7, 3)], ids=str)
def test_the_symbolic_origin_may_be_replaced_by_its_value(origin):
    """Phi_n(t; t0) with t0 put in is Phi_n(t; value)."""
    symbolic = FundamentalMatrix(GENERAL, t, 2, t0).as_matrix().subs(t0, origin)

    assert all(vanishes(x - y) for x, y in zip(symbolic, FundamentalMatrix(GENERAL, t, 2, origin).as_matrix()))


# -- the true solution -----------------------------------------------------------------------


@given(matrices(2), st.sampled_from([Rational(1, 2), Rational(-1, 3), Rational(1)]))
def test_the_determinant_obeys_liouville_to_the_order_of_truncation(P, time):
    """det Phi_n = exp(I[tr P]) but for terms of the order n + 1 in P: exactly none of lower order.

    P is scaled by a symbol e, so the order in P is the degree in e.
    """
    e, n = Symbol("e"), 2
    determinant = FundamentalMatrix(P * e, t, n).series
    found = determinant[0, 0] * determinant[1, 1] - determinant[0, 1] * determinant[1, 0]
    exponent = PoissonSeries(P.trace() * e, t).integrate()
    expected = sum((exponent**k * Rational(1, sympy.factorial(k)) for k in range(n + 1)), PoissonSeries(0, t))
    difference = (found - expected)(time)

    assert all(sympy.expand(difference).coeff(e, k).expand() == 0 for k in range(n + 1))


TRUE = {
    "general": (GENERAL, Rational(3, 2)),
    "mathieu": (MATHIEU, pi),
    "backwards": (GENERAL, Rational(-1)),
    "symbolic unit": (GENERAL.subs(t, w * t), Rational(1, 2)),
    "incommensurate": (Matrix([[cos(t), sin(sqrt(2) * t)], [a, b * t]]), S.One),
    "phases": (Matrix([[0, sin(2 * t + 1)], [cos(pi * t) - 1, a]]), Rational(4, 3)),
}


@pytest.mark.parametrize("name", TRUE)
@pytest.mark.parametrize("n", [3, 7])
def test_iterates_approach_the_solution_as_the_classical_bound_says(name, n):
    """|Phi - Phi_n| <= sum_{k>n} (Pbar T)**k / k! entrywise; Phi from Taylor's method in balls."""
    P, end = TRUE[name]
    P = P.subs(VALUES)
    found = FundamentalMatrix(P, t, n).evaluate(end, digits=40)
    truth, bound = true_fundamental_matrix(P, t, 0, end, digits=40), truncation_bound(P, t, end, n)

    assert within(found, truth, bound, mpmath.mpf(10) ** -28)


def test_a_high_order_reaches_the_solution_of_an_unsymmetric_system():
    """Twenty digits of a 3 x 3 matrix at n = 28, and from another start at n = 16 what the bound allows."""
    P = GENERAL.subs(VALUES).subs(cos(t + Rational(1, 3)), cos(t))
    found, truth = (
        FundamentalMatrix(P, t, 28).evaluate(S.One / 2, digits=30),
        true_fundamental_matrix(P, t, 0, S.One / 2),
    )
    later, there = FundamentalMatrix(P, t, 12, 1).evaluate(2, digits=30), true_fundamental_matrix(P, t, 1, 2)
    bound = truncation_bound(P, t, 1, 12)

    assert distance(found, truth) < mpmath.mpf(10) ** -20
    assert within(later, there, bound, mpmath.mpf(10) ** -20)


# -- the plain definition by SymPy ---------------------------------------------------------------


@pytest.mark.parametrize(
    "P, x0, n",
    [(MATHIEU, [1, -2], 2), (Matrix([[sin(t)]]), [1], 3), (Matrix([[a, 1], [0, cos(t)]]), [1, b], 2)],
    ids=str,
)
@pytest.mark.parametrize("origin", [0, 1, t0], ids=str)
def test_the_plain_definition_agrees_with_the_fast_route(P, x0, n, origin):
    """SymPy's own integrals, for orders that they reach."""
    slow = picard(lambda s, x: P.subs(t, s) * x, t, x0, n, origin)

    assert all(vanishes(x - y) for x, y in zip(slow, fast_picard(P, t, x0, n, origin).as_matrix()))


def test_the_plain_definition_takes_any_right_hand_side():
    """x' = x**2: 1, 1 + t, 1 + t + t**2 + t**3/3; and an integral that SymPy cannot do stays one."""
    assert picard(lambda s, x: [x[0] ** 2], t, [1], 2) == Matrix([1 + t + t**2 + t**3 / 3])
    assert picard(lambda s, x: [x[0] ** 2], t, [1], 0) == Matrix([1])
    kept = picard(lambda s, x: [sin(x[0] ** s + s)], t, [2], 1)
    assert kept.has(sympy.Integral)


def test_the_plain_definition_takes_floats_as_the_dyadic_numbers_they_are():
    """In x0, t0 and f alike, so the iterate from 0.5 is that from 1/2."""
    found = picard(lambda s, x: [0.1 * x[0] * s], t, [0.5], 1, 0.5)

    assert found == picard(lambda s, x: Matrix([Rational(0.1) * x[0] * s]), t, [Rational(1, 2)], 1,
                           Rational(1, 2))
    assert not found.has(sympy.Float)


def test_the_plain_definition_passes_conditions_and_sums_without_end():
    """An infinity in the condition of a piece or as the limit of a sum makes nothing infinite."""
    found = picard(lambda s, x: [x[0] * cos(a * s)], t, [1], 2)

    assert found.has(sympy.oo) and found.subs({a: 2, t: pi}) == Matrix([1])
    assert picard(lambda s, x: [sympy.Sum(b**c, (c, 0, sympy.oo))], t, [1], 1).has(sympy.Sum)


# -- what one can do with it -----------------------------------------------------------------------


@given(matrices(2), plain_times)
def test_numbers_are_those_of_the_exact_matrix(P, time):
    """Digits against evalf of the exact value, and floats are the digits rounded."""
    Phi = FundamentalMatrix(P, t, 2)
    exact = Phi(time).subs(VALUES)
    found = Phi.evaluate(time, VALUES, 30)

    assert all(
        abs(found[i, j] - mpmath.mpf(str(sympy.N(exact[i, j], 25)))) < 1e-14 * (1 + abs(found[i, j]))
        for i in range(2)
        for j in range(2)
    )
    assert Phi.evaluate(time, VALUES).tolist() == [[float(found[i, j]) for j in range(2)] for i in range(2)]


def test_the_exact_matrix_at_a_float_is_that_at_the_dyadic_number():
    """Phi(0.5) = Phi(1/2), though 0.5 in floats would lose nine digits of it."""
    Phi = FundamentalMatrix([[0, 1], [-1 - cos(t), 0]], t, 12)

    assert Phi(0.5) == Phi(Rational(1, 2))
    assert Phi(np.float64(0.5)) == Phi.series(sympy.Float(0.5)) == Phi(Rational(1, 2))


def test_a_matrix_may_be_a_function_lists_or_any_matrix():
    """A callable of one argument as in the article; nested lists; immutable and sparse matrices."""
    expected = FundamentalMatrix(MATHIEU, t, 3).as_matrix()
    for P in (
        lambda s: MATHIEU.subs(t, s),
        MATHIEU.tolist(),
        MATHIEU.as_immutable(),
        sympy.SparseMatrix(MATHIEU),
        read_matrix(MATHIEU, t),
    ):
        assert FundamentalMatrix(P, t, 3).as_matrix() == expected


def test_floats_in_the_matrix_are_the_dyadic_numbers_they_are():
    """0.5 is 1/2; 0.1 is not 1/10."""
    assert fast_picard([[0.5]], t, [1], 2).as_matrix() == fast_picard([[Rational(1, 2)]], t, [1], 2).as_matrix()
    assert fast_picard([[0.1]], t, [1], 2).as_matrix() == fast_picard([[Rational(0.1)]], t, [1], 2).as_matrix()
    assert fast_picard([[0.1]], t, [1], 2).as_matrix() != fast_picard([[Rational(1, 10)]], t, [1], 2).as_matrix()


@pytest.mark.parametrize(
    "name", ["s", "tau", "x", "y", "u", "r", "n", "pi", "I", "E", "S", "_s", "t0", "lambda", "cos"]
)
def test_parameters_may_have_any_name(name):
    """Also those a program might use inside."""
    p = Symbol(name)
    found = fast_picard([[p * cos(t), p], [0, sin(t)]], t, [p, 1], 3)

    assert found.series.diff() == read_matrix([[p * cos(t), p], [0, sin(t)]], t) @ found.to_order(2).series
    assert np.isfinite(found.evaluate(1, {p: 2})).all()


def test_zero_systems_and_order_zero_stay_where_they_start():
    """P = 0 and n = 0 give x0; so does a system that never reaches an unknown."""
    assert fast_picard(sympy.zeros(2), t, [a, 1], 7).as_matrix() == Matrix([a, 1])
    assert fast_picard(MATHIEU, t, [a, 1], 0).as_matrix() == Matrix([a, 1])
    assert fast_picard(MATHIEU, t, [0, 0], 5).as_matrix() == sympy.zeros(2, 1)
    assert FundamentalMatrix([[0, cos(t)], [0, 0]], t, 9).as_matrix() == Matrix([[1, sin(t)], [0, 1]])


def test_powers_of_the_time_in_the_matrix_are_allowed():
    """Airy's equation: y'' = t y by the series route."""
    found = FundamentalMatrix([[0, 1], [t, 0]], t, 6).as_matrix()

    assert found[0, 0] == 1 + t**3 / 6 + t**6 / 180 + t**9 / 12960
    assert found[0, 1] == t + t**4 / 12 + t**7 / 504


def test_iterates_print_themselves_short():
    """One line; LaTeX while a person could read it."""
    Phi = FundamentalMatrix(MATHIEU, t, 20)

    assert repr(Phi) == "<FundamentalMatrix of order 20, shape 2 x 2, in t>"
    assert isinstance(Phi.to_order(2), PicardIterate)
    assert "order 20" in Phi._repr_latex_()
    assert r"\begin{matrix}" in Phi.to_order(2)._repr_latex_()


@pytest.mark.parametrize("copied", [copy.deepcopy, copy.copy, lambda x: pickle.loads(pickle.dumps(x))])
def test_iterates_have_copies_and_pickles(copied):
    """Computed again from the arguments, t0 among them, and their order kept."""
    P = [[sqrt(2), 1], [-a - b * cos(w * t), 0]]
    for X in (
        FundamentalMatrix(P, t, 3, t0),
        fast_picard(P, t, [a, 1], 2, 1).to_order(3),
        FloquetMatrix(P, t, 2, 2 * pi / w).to_order(3),
        FundamentalMatrix(P, t, 3).series,
        fast_picard(P, t, [a, 1], 2).series,
    ):
        other = copied(X)
        assert type(other) is type(X) and other.t == X.t
        assert other.as_matrix() == X.as_matrix()


def test_matrices_are_immutable():
    """Rows and time cannot be replaced."""
    X = read_matrix([[cos(t)]], t)
    for name in ("rows", "t"):
        with pytest.raises(AttributeError):
            setattr(X, name, ())


def test_negative_indices_count_from_the_end():
    """Of an iterate, its series and the Floquet matrix."""
    for X in (FundamentalMatrix(MATHIEU, t, 2), FundamentalMatrix(MATHIEU, t, 2).series, FloquetMatrix(MATHIEU, t, 2)):
        assert X[-1, 0] == X[1, 0] == X[np.int64(1), -2]


@pytest.mark.parametrize("iterate", [
    FundamentalMatrix(MATHIEU, t, 2), fast_picard(MATHIEU, t, [1, 0], 2), FloquetMatrix(MATHIEU, t, 2),
    tabulate(FloquetMatrix(MATHIEU, t, 2), {a: (0, 1), b: (0, 1)}, 3),
], ids=["matrix", "vector", "over a period", "with a table"])
@pytest.mark.parametrize("name", ["n", "anything"])
def test_iterates_take_no_attribute(iterate, name):
    """Immutable: neither the attributes there are nor others can be set."""
    with pytest.raises(AttributeError, match=name):
        setattr(iterate, name, 3)
    assert iterate.n == 2 and not hasattr(iterate, "anything")
