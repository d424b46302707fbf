"""Our objects among those of SymPy, NumPy and python-flint: what goes in, what comes out, what cannot be changed."""

import operator
import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy
from flint import fmpq, fmpz
from sympy import Matrix, Rational, Symbol, cos, latex, pi, sin

from fastpicard import (
    BadInputError,
    BadTypeError,
    FastPicardError,
    FloquetMatrix,
    FundamentalMatrix,
    MissingParameterError,
    PoissonSeries,
    SeriesMatrix,
    ShapeError,
    Verdict,
    boundaries,
    certify,
    chart,
    fast_picard,
    gather,
    mathieu_a,
    new_integrate,
    picard,
    tabulate,
    tubes,
)

t, a, b, c = map(Symbol, "tabc")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])
PHI = FundamentalMatrix(P, t, 4)
F = FloquetMatrix(P, t, 4)
EXACT = [PHI, F, PHI.series]
HUGE = 10**5000
OTHER = Symbol("a", positive=True)


# -- in -----------------------------------------------------------------------


@pytest.mark.parametrize("x0", [
    [1.5, a], np.array([1.5, a]), np.array([[1.5], [a]]), np.array([[1.5, a]]), [[1.5], [a]], [[1.5, a]],
    [np.array(1.5), a], Matrix([1.5, a]), Matrix([[1.5, a]])])
def test_vectors_are_lists_columns_and_arrays(x0):
    """The same components in any of these shapes are the same vector."""
    expected = [Rational(3, 2), a]

    assert fast_picard(P, t, x0, 3).as_matrix() == fast_picard(P, t, expected, 3).as_matrix()
    assert picard(lambda time, x: [x[1], -x[0]], t, x0, 3) == picard(lambda time, x: [x[1], -x[0]], t, expected, 3)


def test_arrays_are_matrices():
    """NumPy's arrays hold expressions as well as floats, which are the dyadic numbers they are."""
    assert FloquetMatrix(np.array([[0, 1], [-a - 0.5 * cos(t), 0]]), t, 3).as_matrix() == FloquetMatrix(
        P.subs(b, Rational(1, 2)), t, 3).as_matrix()
    assert picard(lambda time, x: np.array([x[1], -x[0]]), t, [1, 0], 2) == Matrix([1 - t**2 / 2, -t])
    assert FloquetMatrix([np.array([0, 1]), np.array([-1, 0])], t, 2).shape == (2, 2)
    assert F.trace_at({a: np.array(0.25), b: 1}) == F.trace_at({a: Rational(1, 4), b: 1})


@pytest.mark.parametrize("third", [fmpq(1, 3), Fraction(1, 3)])
def test_rational_numbers_are_those_of_any_library(third):
    """python-flint's too: as constants, limits, initial times and values."""
    assert gather(third, t) == Rational(1, 3)
    assert new_integrate(cos(t), (t, 0, third)) == sin(Rational(1, 3))
    assert FundamentalMatrix(P, t, 2, t0=third).t0 == Rational(1, 3)
    assert FundamentalMatrix(P, t, 2, t0=fmpz(3)).t0 == 3


def test_matrices_of_series_are_made_of_expressions():
    """As a series is; rows of different lengths are no matrix."""
    assert SeriesMatrix([[cos(t), a]], t)[0, 0] == PoissonSeries(cos(t), t)
    assert SeriesMatrix(Matrix([[cos(t), a]]), t) == SeriesMatrix([[cos(t), a]], t)
    for ragged in ([[1, 2], [3]], [[1, 2], []], [[], [1, 2]], [], ()):
        with pytest.raises(ShapeError, match="one length"):
            SeriesMatrix(ragged, t)
    with pytest.raises(BadTypeError, match="SymPy Matrix"):
        SeriesMatrix(1, t)


@pytest.mark.parametrize("cosine", [np.cos, mpmath.cos, lambda time: time.cosine()])
def test_functions_of_numbers_are_no_functions_of_the_time(cosine):
    """P is asked for at a Symbol, of which only SymPy knows the cosine."""
    with pytest.raises(BadTypeError, match=r"sympy\.cos"):
        FloquetMatrix(lambda time: [[0, 1], [-cosine(time), 0]], t, 3)


def test_what_a_function_of_the_time_refuses_itself_is_passed_on():
    """Its own message says more."""
    with pytest.raises(BadTypeError, match="integer"):
        FloquetMatrix(lambda time: FundamentalMatrix(P, t, "3").series, t, 3)


@pytest.mark.parametrize("value", [
    np.ma.masked, np.ma.array(5.0, mask=True), np.datetime64(3, "ns"), np.timedelta64(3, "ns"), sympy.Array(5),
    np.array([1.0]), np.array("1"), np.bool_(True)])
def test_what_is_missing_or_a_time_is_no_number(value):
    """Its bits are one."""
    with pytest.raises(BadTypeError):
        F.evaluate({a: value, b: 1})
    with pytest.raises(BadTypeError):
        gather(value, t)


@pytest.mark.parametrize("x", [FloquetMatrix(P, t, 60), PHI.series])
@pytest.mark.parametrize("ask", [
    lambda x: gather(x, t), lambda x: PoissonSeries(x, t), lambda x: PoissonSeries(cos(t), t) * x, PHI,
    lambda x: FundamentalMatrix(P, t, 2, t0=x), lambda x: fast_picard(P, t, [x, 1], 2),
    lambda x: FloquetMatrix([[0, x], [1, 0]], t, 2), lambda x: FloquetMatrix(P, t, 2, x)])
def test_matrices_are_no_scalars(ask, x):
    """And are not expanded to say so."""
    with pytest.raises(BadTypeError) as caught:
        ask(x)
    assert len(str(caught.value)) < 1000


# -- out ----------------------------------------------------------------------


@pytest.mark.parametrize("x", EXACT)
def test_they_are_matrices_to_sympy_and_numpy(x):
    """Products with SymPy's matrices, arrays, LaTeX: those of as_matrix()."""
    exact = x.as_matrix()

    assert x * Matrix([1, 2]) == exact * Matrix([1, 2])
    assert Matrix([[1, 2]]) * x == Matrix([[1, 2]]) * exact
    assert sympy.sympify(x) == exact
    assert np.array(x).tolist() == exact.tolist()
    assert latex(x) == latex(exact)
    assert Matrix.eye(2) - x == Matrix.eye(2) - exact
    assert x @ exact == exact @ x == exact * exact
    with pytest.raises(TypeError, match="iterable"):
        list(x)


def test_series_have_their_latex():
    """That of their expressions."""
    assert latex(PoissonSeries(a * cos(t), t)) == latex(a * cos(t))


def test_parameters_are_the_free_symbols():
    """Every symbol but the time, those of the initial values and of the period too."""
    assert all(x.free_symbols == {a, b} for x in EXACT)
    assert fast_picard(P, t, [c, 0], 2).free_symbols == {a, b, c}
    assert FundamentalMatrix(P, t, 2, t0=c).free_symbols == {a, b, c}
    assert FloquetMatrix(P.subs(t, c * t), t, 2, 2 * pi / c).free_symbols == {a, b, c}


# -- what cannot be changed ---------------------------------------------------


@pytest.mark.parametrize("look", [lambda: F.P.rows[1][0], lambda: F.entry(0, 0), lambda: F.length,
                                  lambda: PHI.series.rows[0][0]])
def test_what_is_looked_at_cannot_be_changed(look):
    """A verdict is proved of the P that was given."""
    terms = look()

    with pytest.raises(TypeError):
        operator.delitem(terms, next(iter(terms)))
    with pytest.raises(AttributeError):
        terms.clear()


def test_the_cells_of_a_certified_chart_cannot_be_changed():
    """Nor those of a copy that was pickled."""
    found = certify(F, (a, 0, 1), (b, 0, 1), undecided=1)

    for proved in (found, pickle.loads(pickle.dumps(found))):
        for array in (proved.codes, proved.cells):
            with pytest.raises(ValueError, match="read-only"):
                array[:] = 1


def test_verdicts_have_three_names_and_roots_a_place_in_sets():
    """No fourth outcome can be made up."""
    with pytest.raises(BadInputError, match="'stable'"):
        Verdict("stable")
    assert len({boundaries(F)[0].root(a, (-1, 0.1), {b: Rational(1, 10)})}) == 1


# -- what is said -------------------------------------------------------------


@pytest.mark.parametrize("ask", [
    lambda: F.verdict({OTHER: 1, b: 1}),
    lambda: F.lambdify([OTHER, b]),
    lambda: certify(F, (OTHER, 0, 1), (b, 0, 1)),
    lambda: boundaries(F)[0].root(OTHER, (0, 1), {b: 1}),
])
def test_a_namesake_is_named(ask):
    """Symbols that print alike and are not equal: the message would contradict itself without that sentence."""
    with pytest.raises((MissingParameterError, BadInputError), match="not the assumptions"):
        ask()


@pytest.mark.parametrize("ask", [
    lambda x: PHI.to_order(x),
    lambda x: PHI.increment(-x),
    lambda x: picard(lambda time, y: y, t, [1], x),
    lambda x: F[x, 0],
    lambda x: FloquetMatrix(P, t, 2, -x),
    lambda x: FloquetMatrix(P, t, 2, x * pi + 1),
    lambda x: F.evaluate({a: 1, b: 1}, digits=x),
    lambda x: F.evaluate({a: 1, x: 1}),
    lambda x: F.evaluate({a: x}),
    lambda x: F.evaluate(x),
    lambda x: F.enclosure({a: (x, 0), b: 1}),
    lambda x: FloquetMatrix.for_accuracy(P, t, {a: 1, b: 1}, -x),
    lambda x: PoissonSeries(cos(t), t) ** -x,
    lambda x: new_integrate(t**x * cos(t), t),
    lambda x: mathieu_a(-x, 1),
    lambda x: chart(F, (a, 0, x), (b, 0, 1)),
    lambda x: chart(F, (a, 0, 1), (b, 0, 1), points=(x, 2)),
    lambda x: certify(F, (a, x, 1), (b, 0, 1)),
    lambda x: certify(F, (a, 0, 1), (b, 0, 1), seconds=-x),
    lambda x: tubes(F, (a, 0, 1), (b, 0, 1), radius=x),
    lambda x: tabulate(F, {a: x, b: 1}),
])
@pytest.mark.parametrize("huge", [HUGE, sympy.Integer(HUGE)], ids=["int", "Integer"])
def test_integers_too_long_to_print_are_refused_by_name(ask, huge):
    """Python prints none of more than 4300 digits, and the message must not end in that."""
    with pytest.raises(FastPicardError) as caught:
        ask(huge)
    assert "Exceeds the limit" not in str(caught.value)
    assert len(str(caught.value)) < 1000


def test_a_limit_beyond_floats_is_none():
    """Seconds and parts of the area without end."""
    assert certify(F, (a, 0, 1), (b, 0, 1), seconds=HUGE, undecided=1).order > 0


def test_the_reason_shows_what_it_claims():
    """A trace beside the end of stability is printed by its distance from there."""
    inside = F.verdict({a: 0, b: Rational(1, 10**45)})
    outside = F.verdict({a: Rational(1, 4), b: Rational(1, 10**40)})
    undecided = F.verdict({a: 1, b: Rational(1, 10**30)})

    assert (inside, "trace 2 - [1.97" in inside.reason) == (Verdict.STABLE, True)
    assert (outside, "trace -2 - [9.86" in outside.reason) == (Verdict.UNSTABLE, True)
    assert (undecided, "differs from 2 by [+/- " in undecided.reason) == (Verdict.UNDECIDED, True)


@pytest.mark.parametrize("frequency, period", [(0.1, 20 * pi), (2 * np.pi, 1)])
def test_floats_that_are_no_frequency_are_seen_through(frequency, period):
    """Their binary fractions repeat after no period that anyone means."""
    with pytest.raises(FastPicardError, match=r"Rational\(1, 10\), or sympy\.pi"):
        FloquetMatrix(P.subs(t, frequency * t), t, 3, period)
    assert FloquetMatrix(P.subs(t, 0.5 * t), t, 3, 4 * pi).n == 3


def test_messages_speak_of_what_was_given():
    """The digits asked for, not those of an intermediate step; the values, not those put in."""
    with pytest.raises(BadInputError, match="15 were asked for"):
        F.multipliers({a: (-0.2, -0.1), b: 0.55}, digits=15)
    with pytest.raises(MissingParameterError, match=r"among \{\}"):
        boundaries(F)[0].root(a, (-1, 0.1))
    with pytest.raises(BadTypeError, match="'a'"):
        boundaries(F)[0].root("a", (-1, 0.1), {b: 1})
    with pytest.raises(BadTypeError, match="pair"):
        F.verdict({a: [-0.2, -0.1], b: 1})
    with pytest.raises(BadInputError, match="order 300"):
        tabulate(F, {a: (0, 1000), b: 1})


def test_tables_without_parameters_have_any_order(monkeypatch):
    """What fills the memory are the terms in parameters."""
    monkeypatch.setattr("fastpicard.tables.HIGHEST", 3)
    numbers = FloquetMatrix(P.subs({a: 1, b: 1}), t, 4)

    assert tabulate(numbers, {}).enclosure({}).overlaps(numbers.enclosure({}))
    with pytest.raises(BadInputError, match="order 3 at most"):
        tabulate(F, {a: 1, b: 1})
