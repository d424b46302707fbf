"""Enclosures from tables: the same numbers as by integration, inside the box, at its edge and outside."""

from fractions import Fraction
from functools import cache

import pytest
from flint import arb, ctx
from hypothesis import given, settings, strategies as st
from sympy import Matrix, Rational, Symbol, cos, pi, sin

from fastpicard import BadInputError, BadTypeError, FloquetMatrix, MissingParameterError, floquet, tabulate
from tests.fastpicard.test_enclosure import reference_ball
from tests.fastpicard.test_reference_cases import cases, numbers

t, a, b, c, w = map(Symbol, "tabcw")
BOX = {a: (-1, 1), b: (-1, 1), c: (0, Fraction(1, 4)), w: (1, 2)}
SYSTEMS = {
    "Mathieu": FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0),
    "two periods": FloquetMatrix(Matrix([[0, 1], [-a - b * cos(2 * t), 0]]), t, 3),
    "damped": FloquetMatrix(Matrix([[0, 1], [-a / 9 - cos(t) / 9, -c]]), t, 0),
    "phase": FloquetMatrix(Matrix([[0, 1], [-a - b * cos(2 * t + 1), 0]]), t, 0, pi),
    "no symmetry": FloquetMatrix(Matrix([[a / 16, sin(t) / 9], [cos(t) / 9 - b / 9, Rational(1, 16)]]), t, 0),
    "a frequency": FloquetMatrix(Matrix([[0, 1], [-a / 2 - cos(w * t) / 3, 0]]), t, 0, 2 * pi / w),
    "coupled": FloquetMatrix(
        Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-a / 2 - cos(t) / 4, b / 9, 0, 0], [b / 9, -a / 4, 0, 0]]), t, 0
    ),
    "constant": FloquetMatrix(Matrix([[0, 1], [-1, 0]]), t, 0, 1),
}
DIGITS = 6


def of_system(name, values):
    """The values of the parameters that occur."""
    return {s: values[s] for s in SYSTEMS[name].P.as_matrix().free_symbols - {t}}


@cache
def tabulated(name):
    """Tables are built once."""
    return tabulate(SYSTEMS[name], of_system(name, BOX), DIGITS)


def pairs(left, right):
    """Entries side by side."""
    return zip(left.entries(), right.entries(), strict=True)


around = st.fractions(Fraction(-3, 2), Fraction(3, 2), max_denominator=100)


@pytest.mark.parametrize("name", SYSTEMS)
@settings(max_examples=20)
@given(x=around, y=around, u=st.fractions(0, 1, max_denominator=50), digits=st.integers(3, DIGITS))
def test_a_table_agrees_with_integration(name, x, y, u, digits):
    """Two routes, inside the box and outside: the integrated matrix with more digits lies in the table's balls."""
    values = of_system(name, {a: x, b: y, c: u, w: 1 + u})
    found, true = (F.enclosure(values, d) for F, d in ((tabulated(name), digits), (SYSTEMS[name], 25)))

    assert all(wide.contains(narrow.mid()) for wide, narrow in pairs(found, true))
    largest = max(abs(x).upper() for x in found.entries())
    assert all(x.rad() <= arb(10) ** -digits * largest for x in found.entries())


@pytest.mark.parametrize("name", SYSTEMS)
@settings(max_examples=10)
@given(x=st.fractions(-6, 6, max_denominator=9), y=st.fractions(-6, 6, max_denominator=9))
def test_a_table_has_no_edge(name, x, y):
    """Far away the table itself has few digits or none, but it holds the truth."""
    values = of_system(name, {a: x, b: y, c: 1 + y / 6, w: 2 + x / 6})
    table = tabulated(name)._table
    with ctx.workprec(table.bits):
        found = table.over_period(SYSTEMS[name].numbers(values))

    true = SYSTEMS[name].enclosure(values, 25)
    assert found is None or all(wide.contains(narrow.mid()) for wide, narrow in pairs(found, true))


@pytest.mark.parametrize("name", SYSTEMS)
def test_inside_its_box_a_table_needs_no_integration(name, monkeypatch):
    """Corners and the middle of the box."""
    G = tabulated(name)
    monkeypatch.setattr(floquet, "over_period", None)

    points = [{s: ends[k] for s, ends in BOX.items()} for k in (0, 1)]
    points.append({a: Rational(1, 3), b: 0.25, c: Fraction(1, 7), w: arb(1.5)})
    assert all(x.is_finite() for point in points for x in G.enclosure(of_system(name, point), DIGITS).entries())


def test_more_digits_than_the_table_has_are_integrated():
    """Forty digits beside a table of six."""
    values = {a: Rational(1, 3), b: -1}
    found, true = tabulated("Mathieu").enclosure(values, 40), SYSTEMS["Mathieu"].enclosure(values, 50)

    assert all(wide.contains(narrow.mid()) and wide.rad() < arb(10) ** -38 for wide, narrow in pairs(found, true))


@settings(max_examples=10)
@given(around, around, st.floats(-1, 1), st.floats(-1, 1))
def test_a_ball_holds_the_matrices_of_its_points(x, y, u, v):
    """Also where the table's ball is too wide and integration helps."""
    r = Fraction(1, 10**12)
    ball = tabulated("Mathieu").enclosure({a: (x - r, x + r), b: (y - r, y + r)}, 4)
    point = SYSTEMS["Mathieu"].enclosure({a: x + Fraction(u) * r, b: y + Fraction(v) * r}, 20)

    assert all(wide.overlaps(narrow) for wide, narrow in pairs(ball, point))


@cache
def to_thirty_digits():
    """The table of the benchmark."""
    return tabulate(SYSTEMS["Mathieu"], {a: (-2.5, 2.5), b: (-1.5, 1.5)}, 30)


@pytest.mark.parametrize("case", [x for x in cases("floquet_mathieu") if x.values[0].get("t1", "2*pi") == "2*pi"])
def test_a_table_holds_the_reference_matrices(case):
    """Thirty digits of numbers found elsewhere, in the box and beyond."""
    found = to_thirty_digits().enclosure(numbers(case["params"]), 30)

    for i, row in enumerate(case["fundamental_matrix"]):
        for j, text in enumerate(row):
            assert found[i, j].overlaps(reference_ball(text, int(case["digits"])))


def test_verdicts_and_multipliers_follow():
    """The same verdict and multipliers; all else, as the order, is that of the matrix."""
    F, G = SYSTEMS["two periods"], tabulated("two periods")
    for values in ({a: 0.25, b: 0.2}, {a: -0.1, b: 0.3}, {a: -0.5, b: 0.1}, {a: 1, b: 0.5}):
        assert F.verdict(values) == G.verdict(values)
        assert F.multipliers(values) == pytest.approx(G.multipliers(values), rel=1e-14)
    assert G.n == F.n and G.as_matrix() == F.as_matrix() and G.period == F.period


@pytest.mark.parametrize(
    "arguments, error",
    [
        ((SYSTEMS["Mathieu"], {a: (0, 1), b: 0}, None), BadTypeError),
        ((SYSTEMS["Mathieu"], {a: (0, 1), b: 0}, 0), BadInputError),
        ((SYSTEMS["Mathieu"], {a: (1, 0), b: 0}, 9), BadInputError),
        ((SYSTEMS["Mathieu"], {a: (0, 1)}, 9), MissingParameterError),
        ((Matrix([[0]]), {}, 9), BadTypeError),
    ],
)
def test_what_makes_no_table_is_refused(arguments, error):
    """Digits that are no number, an interval upside down, a parameter without one, what is no Floquet matrix."""
    with pytest.raises(error):
        tabulate(*arguments)


def test_message_shows_an_interval_as_it_was_typed():
    """Not as the ball that it becomes."""
    with pytest.raises(MissingParameterError, match=r"among \{a: \(0, 1/3\)\}"):
        tabulate(SYSTEMS["Mathieu"], {a: (0, Rational(1, 3))}, 9)
