"""Boundaries and points of rods known to forty digits, through charts, roots and tubes."""

import pytest
from flint import arb, ctx
from sympy import Matrix, Rational, Symbol, cos, sqrt

from fastpicard import FloquetMatrix, boundaries, certify, tubes
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes
from tests.fastpicard.test_reference_cases import cases, read

t, a, b, h, v = map(Symbol, "tabhv")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])
MATHIEU = FloquetMatrix(P, t, 0)
CASES = cases("stability")
SPANS = [x for x in CASES if "v_lower" in x.values[0]]
CHARTED = [x for x in CASES if "class" in x.values[0] and "v" in x.values[0]]
MU = {}


def modes_of(count):
    """The exact mu of that many equal uniform rods."""
    if count not in MU:
        support = Support(eta=Symbol("epsilon") * cos(Symbol("w") * t))
        scene = Scene([Rod.uniform(*map(Symbol, "ml"))] * count, support, t=t)
        MU[count] = normal_modes(linearize(euler_lagrange(scene))).mu
    return MU[count]


@pytest.fixture(scope="module")
def plane():
    """All boundaries that rods can meet where h v**2 > 1 and mu h < 0.75."""
    return tubes(MATHIEU, (a, -0.75, 0), (b, 0, 0.75))


@pytest.mark.parametrize("case", SPANS)
def test_boundaries_of_rods_are_images_of_tubes(case, plane):
    """v = sqrt(-mu/a(mu h)): lower ends from a_0, upper ends from a_1, to 18 digits; N = 1 .. 4 from one set."""
    mu = modes_of(int(case["N"]))
    for end, label in (("v_lower", "+1"), ("v_upper", "-1")):
        if case.get(end) is None:
            continue
        which = mu[int(case["lower_mode_index" if end == "v_lower" else "upper_mode_index"])]
        x = Rational(case["h"]) * which
        with ctx.workprec(200):
            values = [value for name, _, value in plane.at(x.evalf(60)) if name == label]
            found = [(arb(str(which.evalf(60))) / -value).sqrt() for value in values]
            assert any(abs(z / arb(case[end]) - 1) < arb(10) ** -18 for z in found), (case["id"], found)


@pytest.mark.parametrize("count", sorted({int(x.values[0]["N"]) for x in CHARTED}))
def test_points_of_rods_lie_in_cells_of_their_class(count):
    """One chart for each number of rods, from one scalar matrix."""
    points = [x.values[0] for x in CHARTED if int(x.values[0]["N"]) == count]
    widest, fastest = (1.3 * max(float(Rational(p[k])) for p in points) for k in ("h", "v"))
    chart = certify(MATHIEU, (h, 0, widest), (v, 0.1, fastest), undecided=2e-5, seconds=600,
                    modes=[{a: -mu / v**2, b: mu * h} for mu in modes_of(count)])
    for p in points:
        assert chart.verdict(read(p["h"]), read(p["v"])).name.lower() == p["class"]


def test_the_limit_of_the_paul_trap():
    """b* = 0.454023166867288796935291288349769231900145: forty digits at order 60."""
    even = boundaries(FloquetMatrix(P, t, 60))[2]
    root = even.root(b, (0.3, 0.6), {a: 0}, digits=40)

    with ctx.workprec(160):
        assert abs(arb(str(root.value)) - arb("0.454023166867288796935291288349769231900145")) < 1e-15
    assert root.error < 1e-35 and root.evaluations < 12
    assert abs(2 * float(root.value) - 0.908046333734577594) < 1e-15


def test_two_rods_have_the_articles_mu():
    """3 -+ 6/sqrt(7), from which Out[56] follows."""
    assert [x - y for x, y in zip(modes_of(2), (3 - 6 / sqrt(7), 3 + 6 / sqrt(7)), strict=True)] == [0, 0]
