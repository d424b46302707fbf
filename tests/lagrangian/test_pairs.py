"""Double-double arithmetic against exact fractions: every operation within its stated bound, remainders exact."""

import math
from fractions import Fraction

from hypothesis import assume, example, given, strategies as st

from lagrangian.angles import product
from lagrangian.pairs import added, divided, multiplied, normal, subtracted, summed
from lagrangian.stepper import total

U2 = Fraction(1, 2**106)
SLACK = 1 + Fraction(1, 2**40)  # for the terms in u**3
floats = st.floats(-1e60, 1e60).filter(lambda x: x == 0 or abs(x) > 1e-60)


@st.composite
def pairs(draw):
    """A float and at most half a unit in its last place, of any sign."""
    h = draw(floats)
    l = h * draw(st.floats(-1, 1)) * 2.0**-54
    return normal(h, l)


@st.composite
def neighbours(draw):
    """Two pairs that agree in most digits, with equal or opposite signs."""
    h, l = draw(pairs())
    k = draw(st.integers(-3, 3))
    near = normal(h * (1 + k * 2.0**-52), l * (1 + draw(st.floats(-1, 1))))
    sign = draw(st.sampled_from([1, -1]))
    return (h, l), (sign * near[0], sign * near[1])


anything = st.one_of(st.tuples(pairs(), pairs()), neighbours())


def exact(pair):
    """The number that a pair is."""
    return Fraction(pair[0]) + Fraction(pair[1])


def within(found, true, units):
    """|found - true| <= units u**2 |true|, and found is a pair: its high half is its nearest float."""
    return abs(exact(found) - true) <= units * U2 * SLACK * abs(true) and found[0] + found[1] == found[0]


@given(floats, floats)
def test_remainders_of_sums_and_products_are_exact(a, b):
    """fl(a + b) and fl(a b), and all that was rounded off."""
    assert exact(total(a, b)) == Fraction(a) + Fraction(b) and total(a, b)[0] == a + b
    assert exact(product(a, b)) == Fraction(a) * Fraction(b) and product(a, b)[0] == a * b


@given(anything)
@example(((1.0, -(2.0**-54)), (-1.0, -(2.0**-54))))
def test_sums_and_differences_are_right_whatever_the_signs(both):
    """3 u**2/(1 - 4u): Joldes, Muller, Popescu (2017), theorem 3.1; the sloppy sum fails here."""
    x, y = both

    assert within(added(*x, *y), exact(x) + exact(y), 3)
    assert within(subtracted(*x, *y), exact(x) - exact(y), 3)


@given(anything)
def test_products_are_right(both):
    """7 u**2: Joldes, Muller, Popescu (2017), theorem 5.1."""
    x, y = both

    assert within(multiplied(*x, *y), exact(x) * exact(y), 7)


@given(anything)
def test_quotients_are_right(both):
    """12 u**2, as lagrangian/pairs.py counts."""
    x, y = both
    assume(y[0] != 0)

    assert within(divided(*x, *y), exact(x) / exact(y), 12)


@given(st.lists(st.tuples(pairs(), pairs()), min_size=1, max_size=40))
def test_sums_of_products_are_right_for_the_size_of_their_terms(terms):
    """2 count**2 u**2 sum |terms|, however much they cancel."""
    scaled = [tuple((math.ldexp(h, -e), math.ldexp(l, -e)) for (h, l) in term for e in [math.frexp(h)[1]])
              for term in terms]
    h = l = 0.0
    for x, y in scaled:
        h, l = summed(h, l, *x, *y)
    true = sum(exact(x) * exact(y) for x, y in scaled)
    size = sum(abs(exact(x) * exact(y)) for x, y in scaled)

    assert abs(exact(normal(h, l)) - true) <= (2 * len(terms) ** 2 + 8) * U2 * size
