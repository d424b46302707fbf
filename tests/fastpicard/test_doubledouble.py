"""Errors that are floats, programs of Horner's rule, and the three bounds, against exact fractions."""

from fractions import Fraction
from math import isfinite, prod

import numpy as np
from hypothesis import assume, given, settings, strategies as st

from fastpicard.doubledouble import NEAR_ZERO, Polynomial, Variable, product, reciprocal, split, square
from fastpicard.horner import program, run, weights

U = Fraction(1, 2**53)
ordinary = st.floats(-(2.0**300), 2.0**300).filter(lambda x: x == 0 or abs(x) > 2.0**-300)
coefficients = st.fractions(max_denominator=10**6).filter(lambda c: abs(c) < 10**9)
exponent_sets = st.integers(0, 3).flatmap(
    lambda v: st.sets(st.tuples(*[st.integers(0, 5)] * v), min_size=1, max_size=12).map(sorted)
)


def array(*values):
    """One value or more as float64."""
    return np.array(values, dtype=float)


@given(ordinary, ordinary)
def test_a_product_and_its_error_are_the_exact_product(x, y):
    """Dekker's product, the halves of 26 bits, and squares."""
    p, d = product(array(x), array(y))
    high, low = split(array(x))

    assert p[0] == x * y
    assert Fraction(p[0]) + Fraction(d[0]) == Fraction(x) * Fraction(y)
    assert Fraction(high[0]) + Fraction(low[0]) == Fraction(x)
    assert sum(Fraction(float(part[0])) for part in square(array(x))) == Fraction(x) ** 2


@given(ordinary.filter(bool))
def test_a_reciprocal_is_a_pair_right_to_three_squares_of_the_unit(x):
    """|y + y' - 1/x| <= 3 u**2 |1/x|."""
    y, rest = reciprocal(array(x))

    assert abs((Fraction(float(y[0])) + Fraction(float(rest[0]))) * Fraction(x) - 1) <= 3 * U * U


@given(st.floats(5e-324, 1e-170))
def test_squares_and_scalings_that_underflow_are_no_number(x):
    """A zero that was none must not pass for one."""
    assert not (square(array(x))[0] == 0).any()
    assert not (Variable(array(x), None).scaled(-1000).x == 0).any()
    assert not Variable(array(x), None).inside(400).any()
    assert Variable(array(0, NEAR_ZERO, 2.0**400, -(2.0**401), np.nan), None).inside(400).tolist() == [
        True, True, True, False, False,
    ]  # fmt: skip


@given(exponent_sets, st.data())
def test_a_program_computes_the_sum_of_its_monomials(exponents, data):
    """Fractions, three variables at most; no monomial is visited twice."""
    c = [data.draw(coefficients) for _ in exponents]
    x = [data.draw(st.fractions(-3, 3, max_denominator=9)) for _ in exponents[0]]

    expected = sum(ci * prod(xi**e for xi, e in zip(x, m)) for ci, m in zip(c, exponents))
    assert run(program(exponents), c, x) == expected
    assert run(program([]), [], x) == 0


def test_programs_of_very_many_variables_are_found_at_once():
    """A thousand phases in a row, each in few monomials: no recursion through those that do not occur."""
    single = [tuple(int(i == j) for i in range(1200)) for j in range(1200)]
    steps = program([*single, tuple(2 * x for x in single[7]), (0,) * 1200])

    assert run(steps, [1] * 1202, list(range(1200))) == sum(range(1200)) + 49 + 1


class Counted:
    """A number that remembers for each monomial how many operations it went through."""

    def __init__(self, counts):
        self.counts = counts

    def __add__(self, other):
        return Counted({key: count + 1 for key, count in (self.counts | other.counts).items()})

    def __mul__(self, cost):
        return Counted({key: count + cost for key, count in self.counts.items()})


@given(exponent_sets, st.lists(st.sampled_from([1, 3]), min_size=3, max_size=3))
def test_weights_count_the_operations_on_the_way_of_every_coefficient(exponents, costs):
    """Read backwards, the program counts what numbers that count for themselves count."""
    steps = program(exponents)
    found = run(steps, [Counted({i: 2}) for i in range(len(exponents))], costs)

    assert weights(steps, 2, costs[: len(exponents[0])]) == [found.counts[i] for i in range(len(exponents))]


def pair_of(c):
    """A fraction as float and rest."""
    return float(c), float(c - Fraction(float(c)))


def magnitudes(low, high):
    """Floats of both signs whose size is a power of two between these, about."""
    sign = st.sampled_from([1, -1])
    return st.builds(lambda m, e, s: s * m * 2.0**e, st.floats(0.5, 1), st.integers(low, high), sign)


@settings(max_examples=300)
@given(exponent_sets, st.data())
def test_floats_and_pairs_keep_their_proved_bounds(exponents, data):
    """|r - v| <= u W and |r + e - v| <= u**2 K W, with parameters, squares and reciprocals as variables."""
    size = len(exponents[0])
    c = [data.draw(coefficients) for _ in exponents]
    kinds = data.draw(st.lists(st.sampled_from(["x", "square", "reciprocal"]), min_size=size, max_size=size))
    x = [data.draw(magnitudes(-20, 20)) for _ in range(size)]
    makers = {"x": lambda x: (x, None), "square": square, "reciprocal": reciprocal}
    exact = {"x": lambda x: x, "square": lambda x: x * x, "reciprocal": lambda x: 1 / x}
    variables = [Variable(*makers[kind](array(value))) for kind, value in zip(kinds, x)]
    values = [exact[kind](Fraction(value)) for kind, value in zip(kinds, x)]
    steps = program(exponents)
    p = Polynomial(steps, [pair_of(ci) for ci in c], [sum(m) for m in exponents], [kind != "x" for kind in kinds])
    assume(p.limit() >= 40)

    truth, largest = run(steps, c, values), max([1, *(float(abs(v)) for v in values)])
    W = Fraction(float(p.sizes(variables, 1)[0])) * (1 + Fraction(1, 2**18))
    lost = Fraction(p.underflow(largest))
    r, e = (Fraction(float(part[0])) for part in p.pairs(variables, 1))
    assert Fraction(float(p.floats(variables, 1)[0])) == r
    assert abs(r - truth) <= U * W + lost
    assert abs(r + e - truth) <= U * U * p.most * W + lost
    terms = [abs(ci) * prod((abs(v) ** e for v, e in zip(values, m)), start=Fraction(1)) for ci, m in zip(c, exponents)]
    counts = weights(steps, 2, [1 if kind == "x" else 3 for kind in kinds])
    assert sum(k * term for k, term in zip(counts, terms)) <= W + lost


@given(exponent_sets, st.data())
def test_below_the_limit_nothing_overflows_and_underflow_stays_within_its_bound(exponents, data):
    """Coefficients from denormal to huge, variables from tiny to the limit: finite, and right to the bound."""
    c = [Fraction(data.draw(magnitudes(-1074, 800))) / 3 for _ in exponents]
    p = Polynomial(program(exponents), [pair_of(ci) for ci in c], [sum(m) for m in exponents],
                   [False] * len(exponents[0]))  # fmt: skip
    assume(p.limit() >= 0)
    x = [data.draw(st.one_of(magnitudes(-399, p.limit()), st.just(0.0))) for _ in exponents[0]]
    variables = [Variable(array(value), None) for value in x]
    assert all(v.inside(p.limit()).all() for v in variables)

    r, e = (float(part[0]) for part in p.pairs(variables, 1))
    assert isfinite(r) and isfinite(e) and isfinite(p.sizes(variables, 1)[0])
    truth = run(p.steps, c, [Fraction(value) for value in x])
    W, lost = Fraction(float(p.sizes(variables, 1)[0])), Fraction(p.underflow(max(map(abs, x), default=1)))
    assert abs(Fraction(r) + Fraction(e) - truth) <= U * U * p.most * W * (1 + Fraction(1, 2**18)) + lost


def test_what_underflow_loses_grows_with_the_powers_that_follow():
    """A coefficient below all floats times 2**800: the value is lost, and the bound says so."""
    p, x = Polynomial(program([(20,)]), [(0.0, 0.0)], [20], [False]), 2.0**40

    assert p.limit() >= 40 and p.pairs([Variable(array(x), None)], 1)[0].tolist() == [0]
    assert Fraction(1, 3 * 2**1074) * Fraction(x) ** 20 <= Fraction(p.underflow(x))


def test_polynomials_out_of_range_have_no_limit():
    """A constant above the room, an infinite coefficient: to the balls; none at all: everything is 0."""
    for c in ((1e300, 0.0), (np.inf, 0.0)):
        assert Polynomial(program([(0,)]), [c], [0], [False]).limit() == -1
    empty = Polynomial(program([]), [], [], [])
    assert [part.tolist() for part in empty.pairs([], 2)] == [[0, 0], [0, 0]] and empty.limit() == 400
    assert empty.floats([], 2).tolist() == empty.sizes([], 2).tolist() == [0, 0]
