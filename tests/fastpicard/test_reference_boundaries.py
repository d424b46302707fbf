"""Every point and boundary of stability that is known to forty digits, through charts, roots and tubes.

The cases are read by what they hold, so any number of them of these kinds may stand in the file.
"""

import math
from functools import cache

import pytest
from flint import arb, ctx
from sympy import Matrix, Rational, Symbol, cos, sqrt

from fastpicard import FloquetMatrix, Verdict, boundaries, certify, tubes
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes
from tests.fastpicard.test_reference_cases import cases, read

t, a, b, h, v = map(Symbol, "tabhv")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])
MATHIEU = FloquetMatrix(P, t, 0)
CASES = [x.values[0] for x in cases("stability")]
ARTICLE = [{**x, "N": 2, "v_lower": x["v_exact"], "lower_mode_index": 0} for x in CASES if "v_exact" in x]
ENDS = [(x, end) for x in [y for y in CASES if "v_lower" in y] + ARTICLE for end in ("lower", "upper")
        if x.get(f"v_{end}") is not None]
RODS = [x for x in CASES if {"class", "N", "h", "v"} <= x.keys()]
MATHIEUS = [x for x in CASES if {"class", "a", "b"} <= x.keys()]
CROSSINGS = [x for x in CASES if {"b", "trace"} <= x.keys() and "a" not in x]
CONSTANTS = [x for x in CASES if "mu_max" in x]
NEAR = Rational(3, 1000)  # how far beside a boundary, relatively, the class is asked for


def named(items):
    """Parametrised by ids."""
    return [pytest.param(*x, id=f"{x[0]['id']} {x[1]}") if isinstance(x, tuple) else pytest.param(x, id=x["id"])
            for x in items]


@cache
def modes_of(count):
    """The exact mu of that many equal uniform rods, ascending."""
    support = Support(eta=Symbol("epsilon") * cos(Symbol("w") * t))
    scene = Scene([Rod.uniform(*map(Symbol, "ml"))] * count, support, t=t)
    return normal_modes(linearize(euler_lagrange(scene))).mu


def place(case, end):
    """mu of the mode that leaves at this end, b = mu h, and a = -mu/v**2 to fifty digits."""
    mu = modes_of(int(case["N"]))[int(case[f"{end}_mode_index"])]
    return mu, (Rational(case["h"]) * mu).evalf(60), (-mu / Rational(case[f"v_{end}"]) ** 2).evalf(60)


@cache
def plane():
    """All boundaries of the part of Mathieu's plane that the rods of the cases reach."""
    reached = [place(case, end) for case, end in ENDS]
    return tubes(MATHIEU, (a, 1.05 * min(float(x) for *_, x in reached) - 0.05, 0),
                 (b, 0, 1.05 * max(float(y) for _, y, _ in reached)))


@cache
def chart_of(count):
    """One chart for each number of rods, from one scalar matrix; it holds every point and boundary of the cases."""
    points = [(x["h"], x["v"]) for x in RODS if int(x["N"]) == count]
    points += [(x["h"], x[f"v_{end}"]) for x, end in ENDS if int(x["N"]) == count]
    widest, fastest = (1.3 * max(float(Rational(p[k])) for p in points) for k in (0, 1))
    return certify(MATHIEU, (h, 0, widest), (v, 0.1, fastest), undecided=2e-5, seconds=600,
                   modes=[{a: -mu / v**2, b: mu * h} for mu in modes_of(count)])


@cache
def boundaries_of(order):
    """All four, of that order."""
    return boundaries(FloquetMatrix(P, t, order))


def order_for(size):
    """The least multiple of ten whose remainder after half a period is below 1e-37 where ``|a| + |b| <= size``."""
    z = float(size) ** 0.5 * math.pi
    return next(n for n in range(30, 1000, 10) if n * math.log(z) - math.lgamma(n + 1) < -37 * math.log(10))


@pytest.mark.parametrize("case, end", named(ENDS))
def test_boundaries_of_rods_are_images_of_tubes(case, end):
    """v = sqrt(-mu/a(mu h)): lower ends from a_0, upper ends from a_1, to 18 digits; one set for all N."""
    mu, x, _ = place(case, end)
    with ctx.workprec(200):
        values = [value for name, _, value in plane().at(x) if name == {"lower": "+1", "upper": "-1"}[end]]
        found = [(arb(str(mu.evalf(60))) / -value).sqrt() for value in values if value < 0]
        assert any(abs(z / arb(case[f"v_{end}"]) - 1) < arb(10) ** -18 for z in found), found


@pytest.mark.parametrize("case, end", named(ENDS))
def test_boundaries_of_rods_are_roots(case, end):
    """To 30 digits, and the error that is claimed holds the truth; by ``boundaries`` in a and b."""
    _, x, expected = place(case, end)
    label = {"lower": "+1", "upper": "-1"}[end]
    kinds = [f for f in boundaries_of(order_for(abs(x) + abs(expected))) if f.label == label]
    bracket = (expected * (1 - NEAR), expected * (1 + NEAR))
    (f,) = [f for f in kinds if f({a: bracket[0], b: x}) * f({a: bracket[1], b: x}) < 0]
    root = f.root(a, bracket, {b: x}, digits=38)

    with ctx.workprec(200):
        distance = abs(arb(root.value) - arb(str(expected)))
        assert distance < arb(10) ** -30 * abs(arb(str(expected)))
        assert distance <= arb(root.error) + arb(10) ** -36  # the expected number has some 40 digits itself


@pytest.mark.parametrize("case, end", named(ENDS))
def test_charts_turn_at_the_boundaries_of_rods(case, end):
    """Undecided at the boundary; 0.3 % beside it proved: stable inside the zone, unstable outside."""
    chart, at = chart_of(int(case["N"])), Rational(case[f"v_{end}"])
    left, middle, right = (chart.verdict(read(case["h"]), at * (1 + k * NEAR)).name for k in (-1, 0, 1))

    assert (left, middle, right) == (("UNSTABLE", "UNDECIDED", "STABLE") if end == "lower" else
                                     ("STABLE", "UNDECIDED", "UNSTABLE"))


@pytest.mark.parametrize("case", named(RODS))
def test_points_of_rods_lie_in_cells_of_their_class(case):
    """Never in one of the other class; undecided only where a trace comes within 1e-6 of 2 or -2."""
    found = chart_of(int(case["N"])).verdict(read(case["h"]), read(case["v"])).name.lower()
    margin = min(abs(2 - abs(float(x))) for x in case["mode_traces"])

    assert found == case["class"].split()[0] or found == "undecided" and margin < 1e-6


@pytest.mark.parametrize("case", named(MATHIEUS))
def test_points_of_mathieus_equation_lie_in_cells_of_their_class(case):
    """In charts around them, the point off the centre; those on a boundary are undecided."""
    x, y = (float(Rational(case[k])) for k in "ab")
    chart = certify(MATHIEU, (a, x - 0.11, x + 0.2), (b, y - 0.13, y + 0.17), undecided=1e-3, seconds=600)
    found = chart.verdict(read(case["a"]), read(case["b"])).name.lower()
    margin = abs(2 - abs(float(case["trace"])))

    assert found == (case["class"].split()[0] if margin > 1e-6 else "undecided")


@pytest.mark.parametrize("case", named(CROSSINGS))
def test_crossings_of_the_axis_are_roots(case):
    """The b at which a boundary crosses a = 0, to 30 digits; at order 80, where fixed precision would lose all."""
    expected = Rational(case["b"])
    label = "+1" if Rational(case["trace"]) == 2 else "-1"
    roots = [f.root(b, (expected - NEAR, expected + NEAR), {a: 0}, digits=38)
             for f in boundaries_of(order_for(expected)) if f.label == label
             and f({a: 0, b: expected - NEAR}) * f({a: 0, b: expected + NEAR}) < 0]
    with ctx.workprec(200):
        assert any(abs(arb(root.value) - arb(str(expected.evalf(60)))) < arb(10) ** -30 for root in roots)
        assert all(root.error < 1e-25 for root in roots)


def limit_of_the_trap():
    """b* where the boundary -1 even crosses a = 0, to 40 digits: the limit q = 2 b of the Paul trap."""
    return boundaries_of(60)[2].root(b, (0.3, 0.6), {a: 0}, digits=40)


def test_the_limit_of_the_paul_trap():
    """b* = 0.454023166867288796935291288349769231900145: forty digits at order 60."""
    (case,) = [x for x in CASES if x["id"] == "bstar"]
    root = limit_of_the_trap()

    with ctx.workprec(160):
        assert abs(arb(root.value) - arb(case["value"])) < arb(10) ** -38
    assert root.error < 1e-35 and root.evaluations < 12
    assert abs(2 * float(root.value) - float(case["q_star"])) < 1e-15


@pytest.mark.parametrize("case", named(CONSTANTS))
def test_no_upper_frequency_below_the_limit(case):
    """h* = b*/mu_max: below it every high frequency is stable, above it none, as charts prove."""
    (limit,) = [float(x) for key, x in case.items() if key.startswith("h_limit")]
    mu = modes_of(int(case["N"]))
    root = limit_of_the_trap()
    with ctx.workprec(160):
        assert abs(arb(root.value) / arb(str(mu[-1].evalf(50))) - limit) < 1e-15

    modes = [{a: -x / v**2, b: x * h} for x in mu]
    slow = 60 * float(Rational(case["mu_max"]) / Rational(case["mu_min"])) ** 0.5
    below, above = (certify(MATHIEU, (h, limit * lo, limit * hi), (v, slow, 100 * slow), modes=modes, undecided=1e-9)
                    for lo, hi in ((0.9, 0.998), (1.002, 1.05)))
    assert below.fraction(Verdict.STABLE) == pytest.approx(1) and above.fraction(Verdict.UNSTABLE) == pytest.approx(1)


def test_two_rods_have_the_articles_mu():
    """3 -+ 6/sqrt(7), from which Out[56] follows."""
    assert [x - y for x, y in zip(modes_of(2), (3 - 6 / sqrt(7), 3 + 6 / sqrt(7)), strict=True)] == [0, 0]
