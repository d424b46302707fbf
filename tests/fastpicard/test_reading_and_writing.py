"""From SymPy and back: expressions are built exactly as SymPy itself would build them."""

import pytest
import sympy
from hypothesis import given, strategies as st
from sympy import Add, Mul, Rational, S, Symbol, cos, pi, sin, sqrt

from fastpicard import PoissonSeries, gather, new_integrate, product_to_sum
from tests.oracles import plain_expression, rebuilt, same_tree, vanishes
from tests.strategies import a, b, c, expressions, modes, phi, plain_series, sums, t, w

ORDERED = [
    Symbol(name, **assumptions)
    for name, assumptions in (
        ("A", {}),
        ("Z", {"positive": True}),
        ("_x", {}),
        ("alpha", {"real": True}),
        ("t1", {}),
        ("z", {}),
        ("tau", {"integer": True}),
    )
]


def of(expression):
    """The series of an expression in t."""
    return PoissonSeries(expression, t)


@given(expressions)
def test_expressions_are_those_that_sympy_would_build(x):
    """Equal by ==, equal hash, equal arguments in equal order, at every node."""
    written = of(x).as_expr()

    assert same_tree(written, rebuilt(written))


@given(expressions)
def test_integrals_are_those_that_sympy_would_build(x):
    """Also where many terms with large coefficients meet."""
    written = new_integrate(x, t)

    assert same_tree(written, rebuilt(written))


@given(
    st.lists(
        st.tuples(
            st.sampled_from(ORDERED),
            st.sampled_from(ORDERED),
            st.integers(-2, 3),
            st.integers(0, 3),
            st.sampled_from([1, 2, Rational(3, 2), w, sqrt(3), pi]),
        ),
        max_size=4,
    )
)
def test_the_order_of_factors_and_terms_is_sympys_for_all_names_and_assumptions(drawn):
    """Symbols with capital letters, underscores, assumptions; negative powers; any frequency."""
    x = Add(
        *(Mul(Rational(k + 4, 3), y, z**k, t**r, f(q * t)) for (y, z, k, r, q), f in zip(drawn, (cos, sin, cos, sin)))
    )
    written = of(x).integrate().as_expr()

    assert same_tree(written, rebuilt(written))


@given(plain_series(most_power=3, most=4))
def test_plain_series_are_written_term_by_term(series):
    """Add(*(Mul(...))) of the terms is the expression, tree by tree."""
    expected = plain_expression(series)

    assert same_tree(of(expected).as_expr(), expected)


@given(expressions)
def test_product_to_sum_is_idempotent_and_keeps_the_value(x):
    """Once is enough, and the difference is zero by exponentials."""
    once = product_to_sum(x, t)

    assert product_to_sum(once, t) == once
    assert of(once) == of(x)


@given(expressions)
def test_gather_keeps_the_value_and_collects(x):
    """One term for each t**r cos(q t + phi), whatever its coefficient."""
    found = gather(x, t)

    assert of(found) == of(x)
    waves = [term.as_independent(t, as_Add=False)[1] for term in Add.make_args(found) if found]
    waves = [wave for wave in waves if wave != 1]  # constants form one sum
    assert len(waves) == len(set(waves))


@given(sums(modes(rates=st.sampled_from([S.One, w]), angles=st.sampled_from([S.Zero, phi])), most=2))
def test_products_become_sums_without_products_of_waves(x):
    """No term holds two functions of t."""
    found = product_to_sum(x * (1 + cos(t)), t)

    assert all(
        sum(1 for f in Mul.make_args(term) if f.has(cos, sin) and f.has(t)) <= 1 for term in Add.make_args(found)
    )


@pytest.mark.parametrize(
    "x, expected",
    [
        (a * t * cos(2 * t) + b * t * cos(2 * t) + 3, t * (a + b) * cos(2 * t) + 3),
        (t * cos(t) - t * cos(t), 0),
        (a * cos(-t) + b * cos(t), (a + b) * cos(t)),
        (a * sin(-t) + b * sin(t), (b - a) * sin(t)),
        (a * t + b * t + c, (a + b) * t + c),
        (0, 0),
    ],
    ids=str,
)
def test_gather_collects_like_terms(x, expected):
    """The article's GatherTerms: cos(-t) and cos(t) are one."""
    assert sympy.expand(gather(x, t) - expected) == 0
    assert len(Add.make_args(gather(x, t))) == len(Add.make_args(S(expected)))


@pytest.mark.parametrize(
    "x, expected",
    [
        (sin(t) * cos(t) ** 2, sin(t) / 4 + sin(3 * t) / 4),
        (cos(t) ** 2, S.Half + cos(2 * t) / 2),
        (cos(w * t) * cos(t), cos((w + 1) * t) / 2 + cos((w - 1) * t) / 2),
        (cos(t) * cos(phi), cos(t + phi) / 2 + cos(t - phi) / 2),
        (sin(t) ** 3, 3 * sin(t) / 4 - sin(3 * t) / 4),
        (cos(t) ** 7, sympy.expand(cos(t).rewrite(sympy.exp) ** 7).rewrite(cos)),
    ],
    ids=str,
)
def test_products_turn_into_the_sums_of_the_tables(x, expected):
    """Textbook identities."""
    assert vanishes(product_to_sum(x, t) - expected)


def test_coefficients_of_any_size_survive_the_way_through_sympy():
    """Integers of three hundred digits, and their reciprocals."""
    x = Rational(3**700, 7**300) * t**3 * cos(t * Rational(5**40, 3**41)) + 11**400

    assert of(x).as_expr() == x
    assert of(x).integrate().diff() == of(x)


def test_symbols_with_equal_names_stay_apart():
    """Two parameters that print alike are two parameters."""
    one, other = Symbol("a"), Symbol("a", positive=True)
    x = one * cos(t) + other * cos(t)

    assert len(of(x)) == 2
    assert same_tree(of(x).as_expr(), rebuilt(of(x).as_expr()))
    assert of(x).as_expr() == x


@pytest.mark.parametrize(
    "time",
    [
        Symbol("t", real=True),
        Symbol("t", positive=True),
        Symbol("x"),
        sympy.Dummy("t"),
        Symbol("omega_0 t"),
        Symbol("t", integer=True),
    ],
    ids=repr,
)
def test_the_time_may_be_any_symbol(time):
    """With assumptions, a Dummy, or with a strange name."""
    x = a * time**2 * cos(3 * time + phi) + sin(time)

    assert PoissonSeries(x, time).as_expr() == sympy.expand(x)
    assert PoissonSeries(x, time).integrate().diff() == PoissonSeries(x, time)
