"""Integrals, iterates and Floquet matrices against reference cases derived without this package."""

import json
from pathlib import Path

import mpmath
import pytest
import sympy
from sympy import Matrix, Symbol, sympify

from fastpicard import FloquetMatrix, FundamentalMatrix, PoissonSeries, fast_picard, new_integrate, picard
from tests.oracles import closeness, truncation_bound, vanishes

t = Symbol("t")


def cases(name):
    """The cases of one file, as a parametrisation by their ids."""
    path = Path(__file__).parent / "cases" / f"{name}.json"
    return [pytest.param(case, id=case["id"]) for case in json.loads(path.read_text())["cases"]]


def truncation_errors():
    """Every case and order of ``truncation_errors.json``, as a parametrisation."""
    return [pytest.param(case.values[0], row, id=f"{case.id}-n{row['n']}")
            for case in cases("truncation_errors") for row in case.values[0]["rows"]]


def read(text):
    """The exact expression that a reference string holds; its variable is named ``t``."""
    return sympify(text, rational=True)


def numbers(table):
    """Parameter values of a case as {Symbol: exact number}."""
    return {Symbol(name): read(value) for name, value in table.items()}


def system(case):
    """``P`` of a case."""
    return Matrix(read(case["P"]))


# -- integrals -------------------------------------------------------------------


@pytest.mark.parametrize("case", [c for c in cases("integrals") if "expected_zero_at_0" in c.values[0]])
def test_indefinite_integrals_equal_the_closed_form_with_its_constant(case):
    """The antiderivative that vanishes at 0, term by term, and its derivative is the integrand."""
    integrand = read(case["integrand"]).subs(numbers(case.get("subs", {})))
    found = new_integrate(integrand, t)

    assert vanishes(found - read(case["expected_zero_at_0"]))
    assert PoissonSeries(integrand, t).integrate().diff() == PoissonSeries(integrand, t)


@pytest.mark.parametrize("case", [c for c in cases("integrals") if c.values[0]["type"] == "definite"])
def test_definite_integrals_equal_the_closed_form(case):
    """Limits in either order, numbers or symbols."""
    found = new_integrate(read(case["integrand"]), (t, read(case["lower"]), read(case["upper"])))

    assert vanishes(found - read(case["expected"]))


@pytest.mark.parametrize("case", [c for c in cases("integrals") if "numeric" in c.values[0]])
def test_integrals_have_the_value_that_quadrature_gives(case):
    """Forty digits at the values of the parameters, through the series and not through SymPy."""
    numeric = case["numeric"]
    values = numbers(numeric["subs"])
    antiderivative = PoissonSeries(read(case["integrand"]), t).integrate()
    lower, upper = (read(numeric[side]).subs(values) for side in ("lower", "upper"))
    with mpmath.workdps(60):
        found = antiderivative.evaluate(upper, values, 60) - antiderivative.evaluate(lower, values, 60)

    assert closeness(found, numeric["value"]) < mpmath.mpf(10) ** -38


# -- iterates --------------------------------------------------------------------


@pytest.mark.parametrize("case", [c for c in cases("picard") if "expected" in c.values[0]])
def test_iterates_equal_the_reference_term_by_term(case):
    """Every component, exactly; expanded the same terms are there, no more and no fewer."""
    found = fast_picard(system(case), t, list(map(read, case["x0"])), case["n"], read(case["t0"]))
    expected = list(map(read, case["expected"]))
    if case["t0"] == "0":
        assert [sympy.expand(e) for e in expected] == list(found.as_matrix()) or all(
            PoissonSeries(e, t) == found[i, 0] for i, e in enumerate(expected)
        )
    else:
        assert all(vanishes(e - f) for e, f in zip(expected, found.as_matrix()))
    if "monomials" in case:
        assert sum(len(found[i, 0]) for i in range(len(expected))) == case["monomials"]


@pytest.mark.parametrize("case", [c for c in cases("picard") if "samples" in c.values[0]])
def test_iterates_have_the_reference_values(case):
    """Fifty digits at several times and parameters."""
    iterate = fast_picard(system(case), t, list(map(read, case["x0"])), case["n"], read(case["t0"]))
    for sample in case["samples"]:
        values = numbers(sample["params"])
        found = iterate.evaluate(read(sample["t"]), values, 50)
        assert all(closeness(x, y) < mpmath.mpf(10) ** -47 for x, y in zip(found, sample["value"]))


@pytest.mark.parametrize("case", [c for c in cases("picard") if "expected" in c.values[0] and c.values[0]["n"] <= 2])
def test_the_plain_definition_agrees_with_the_fast_route(case):
    """`picard` with SymPy's integrals, for orders that it reaches quickly."""
    P = system(case)
    x0, t0 = list(map(read, case["x0"])), read(case["t0"])
    slow = picard(lambda s, x: P.subs(t, s) * x, t, x0, case["n"], t0)
    fast = fast_picard(P, t, x0, case["n"], t0).as_matrix()

    assert all(vanishes(x - y) for x, y in zip(slow, fast))


# -- Floquet matrices --------------------------------------------------------------


def agrees(found, case, P, length, n):
    """Whether every entry has the reference digits but for what the classical bound allows at this order."""
    bound = truncation_bound(P, t, length, n)
    digits = case["digits"]
    for i, row in enumerate(case["fundamental_matrix"]):
        for j, text in enumerate(row):
            with mpmath.workdps(digits + 20):
                exact = mpmath.mpf(text)
                slack = (1 + abs(exact)) * mpmath.mpf(10) ** (1 - digits)
                if abs(found[i, j] - exact) > bound[i, j] + slack:
                    return False
    return True


@pytest.fixture(scope="module")
def mathieu():
    """The Floquet matrix of Mathieu's equation with both parameters, order 60."""
    a, b = sympy.symbols("a b")
    return FloquetMatrix(Matrix([[0, 1], [-a - b * sympy.cos(t), 0]]), t, 60)


@pytest.mark.parametrize("case", cases("floquet_mathieu"))
def test_mathieu_floquet_matrices_agree_to_the_order_of_truncation(case, mathieu):
    """One exact matrix of order 60 at every reference point; off by no more than the rest of the exponential series."""
    values = numbers(case["params"])
    found = mathieu.evaluate(values, case["digits"])

    assert agrees(found, case, system(case).subs(values), 2 * sympy.pi, 60)
    assert found[0, 0] == found[1, 1]


# Orders at which the rest is below the last digit given, for the points where that takes no minutes.
DEEP = {
    "mathieu-01": 60,
    "mathieu-33": 40,
    "mathieu-45": 50,
    "mathieu-05": 60,
    "mathieu-09": 78,
    "mathieu-13": 56,
    "mathieu-100digits-a=1-b=1": 116,
    "mathieu-41": 76,
}


@pytest.mark.parametrize("case", [c for c in cases("floquet_mathieu") if c.id in DEEP])
def test_mathieu_floquet_matrices_reach_every_reference_digit(case):
    """With numbers in ``P`` and an order high enough all 50 (or 100) digits of the true matrix are there."""
    P = system(case).subs(numbers(case["params"]))
    found = FloquetMatrix(P, t, DEEP[case["id"]]).evaluate(digits=case["digits"])
    worst = max(closeness(found[i, j], case["fundamental_matrix"][i][j]) for i in range(2) for j in range(2))

    assert worst < mpmath.mpf(10) ** (2 - case["digits"])


ORDERS = {
    "hill3-100digits": 48,
    "hill3-4": 54,
    "rod3-h=1/50-v=150": 24,
    "approxfun-4x4": 40,
    "ten-periods": 30,
    "zhou-hagiwara": 40,
    "mathieu-period1": 50,
    "article2x2-a=2": 44,
    "article2x2-a=3/2": 44,
}


@pytest.mark.parametrize("case", cases("floquet_other"))
def test_other_fundamental_matrices_agree_to_the_order_of_truncation(case):
    """Phi(t1, t0) for any period and start, 1 to 6 unknowns, damped, nilpotent, with sines."""
    values = numbers(case["params"])
    P, n = system(case).subs(values), ORDERS.get(case["id"], 36)
    start, end = read(case["t0"]), read(case["t1"])
    if start == 0:
        found = FloquetMatrix(P, t, n, end).evaluate(digits=case["digits"])
    else:
        found = FundamentalMatrix(P, t, n, start).evaluate(end, digits=case["digits"])

    assert agrees(found, case, P, end - start, n)


EXACT = {"nilpotent3": 3, "free-particle": 1}


@pytest.mark.parametrize("case", [c for c in cases("floquet_other") if c.id in EXACT])
def test_systems_that_stop_are_exact_at_the_order_where_they_stop(case):
    """A nilpotent system ends after as many integrations as it has unknowns, with the closed form."""
    found = FloquetMatrix(system(case), t, EXACT[case["id"]]).as_matrix()

    assert found == Matrix(read(str(case["exact"]).replace("'", "")))


@pytest.mark.parametrize("case", [c for c in cases("floquet_other") if c.id.startswith("scalar")])
def test_a_scalar_equation_gives_the_exponential_series(case):
    """Phi_n(T) = sum_{k<=n} (a T)**k / k!: the waves in ``a + 3 sin 5t + cos t`` integrate to zero over the period."""
    a = Symbol("a")
    series = sum((2 * sympy.pi * a) ** k / sympy.factorial(k) for k in range(9))

    assert FloquetMatrix(system(case), t, 8).as_matrix()[0, 0] == sympy.expand(series)


@pytest.mark.parametrize("case, row", truncation_errors())
def test_traces_of_iterates_equal_the_reference_at_every_order(case, row):
    """The n-th iterate's own trace: forty digits whatever its distance from the truth."""
    F = FloquetMatrix(system(case).subs(numbers(case["params"])), t, row["n"])

    assert closeness(F.trace_at(digits=45), row["trace_n"]) < mpmath.mpf(10) ** -37
