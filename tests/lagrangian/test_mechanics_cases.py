"""Equations, small motions and modes against reference cases derived without this package."""

import json
from pathlib import Path

import mpmath
import pytest
from sympy import Derivative, Function, Matrix, Rational, Symbol, cos, expand, expand_trig, pi, symbols, sympify

from lagrangian import LagrangianError, Rod, Scene, Support, euler_lagrange, linearize, normal_modes

CASES = json.loads((Path(__file__).parent / "cases" / "mechanics.json").read_text())
MECHANICS = CASES["mechanics"]
t, g, l, m = symbols("t g l m")
xi, eta = Function("xi")(t), Function("eta")(t)
DRIVE = {Symbol("dxi"): xi.diff(t), Symbol("deta"): eta.diff(t), Symbol("ddxi"): xi.diff(t, 2),
         Symbol("ddeta"): eta.diff(t, 2), Symbol("eta"): eta}


def of(prefix, cases=MECHANICS):
    """Parametrise by the cases whose id begins with ``prefix``."""
    return pytest.mark.parametrize("case", [c for c in cases if c["id"].startswith(prefix)], ids=lambda c: c["id"])


def read(text):
    """The exact expression that a reference string holds."""
    return sympify(text, rational=True)


def moving(text, n, angle="theta"):
    """A reference expression with its symbols theta1, dtheta1, ddtheta1, ddxi, ... made functions of t."""
    names = dict(DRIVE)
    for i in range(1, n + 1):
        theta = Function(f"theta{i}")(t)
        names |= {Symbol(f"{angle}{i}"): theta, Symbol(f"d{angle}{i}"): theta.diff(t),
                  Symbol(f"dd{angle}{i}"): theta.diff(t, 2)}
    return read(text).xreplace(names)


def rods_of(case):
    """The rods of a reference chain."""
    return [Rod(*map(read, quadruple)) for quadruple in zip(case["masses"], case["lengths"], case["H"], case["R"])]


def same(expression, text, n):
    """Whether an expression equals the reference text, exactly."""
    return expand(expression - moving(text, n)) == 0


@of("eom-")
def test_equations_and_linear_parts_equal_the_reference(case):
    """lhs, V, A, stiffness and remainder of every reference chain, term by term."""
    n = case["N"]
    scene = Scene(rods_of(case), Support(xi, eta))
    equations = euler_lagrange(scene)
    lin = linearize(equations)

    assert all(same(side, text, n) for side, text in zip(equations.lhs, case["euler_lagrange_lhs"]))
    assert same(scene.potential, case["potential_energy"], n)
    for i in range(n):
        assert same(lin.remainder[i], case["linear_remainder"][i], n)
        for j in range(n):
            assert same(lin.A[i, j], case["linear_A (coefficient of ddtheta)"][i][j], n)
            assert same(lin.stiffness[i, j], case["linear_K (coefficient of theta)"][i][j], n)


@of("eom-", [c for c in MECHANICS if c.get("kinetic_energy")])
def test_kinetic_energy_equals_the_reference(case):
    """K of the reference, whose sums of squares of sin and cos are not reduced: compared as polynomials."""
    difference = Scene(rods_of(case), Support(xi, eta)).kinetic - moving(case["kinetic_energy"], case["N"])

    for i in range(1, case["N"] + 1):
        theta = Function(f"theta{i}")(t)
        difference = difference.subs(Derivative(theta, t), Symbol(f"w{i}"))
    assert expand(expand_trig(expand(difference)).rewrite(cos).trigsimp()) == 0


@of("modes-uniform")
def test_uniform_modes_equal_the_reference(case):
    """A, B, A^-1 B and all mu of N equal uniform rods, inverted."""
    n = case["N"]
    modes = normal_modes(linearize(euler_lagrange(Scene([Rod.uniform(m, l)] * n))))

    assert Matrix(n, n, lambda i, j: read(case["A"][i][j])) == modes.A
    assert Matrix.diag(*map(read, case["B_diag"])) == modes.B
    assert modes.A.inv() * modes.B == Matrix(n, n, lambda i, j: read(case["AinvB"][i][j]))
    assert all(abs(mu.evalf(50) - read(value)) < Rational(1, 10**40) * abs(mu.evalf(20)) for mu, value in zip(
        modes.mu, case["mu (eigenvalues of A^-1 B, ascending)"]))


@of("modes-pointmass")
def test_hanging_bobs_have_the_zeros_of_the_laguerre_polynomial(case):
    """omega**2 l/g of N equal hanging bobs, to 20 digits."""
    n = case["N"]
    modes = normal_modes(linearize(euler_lagrange(Scene([Rod.bob(m, l)] * n, upright=False))), digits=20)

    assert modes.time_factor == g / l
    assert all(abs(mu - read(value)) < Rational(1, 10**19) * mu for mu, value in zip(modes.mu, case["omega2_l_over_g"]))


@of("", CASES["mode_extremes"])
def test_extreme_modes_equal_the_reference(case):
    """The smallest and the largest mu of N equal uniform rods."""
    mu = normal_modes(linearize(euler_lagrange(Scene([Rod.uniform(m, l)] * case["N"])))).mu

    assert abs(mu[0].evalf(40) - read(case["mu_min"])) < Rational(1, 10**35)
    assert abs(mu[-1].evalf(40) - read(case["mu_max"])) < Rational(1, 10**35)


def accelerations(scene, theta, omega):
    """M^-1 f at a state, with 60 digits."""
    equations = euler_lagrange(scene)
    state = dict(zip((*scene.velocities, *scene.coordinates), (*omega, *theta)))
    M, f = (matrix.xreplace(state).doit().evalf(60).tolist() for matrix in (equations.mass_matrix, equations.forcing))
    with mpmath.workdps(60):
        return list(mpmath.lu_solve(mpmath.matrix(M), mpmath.matrix(f)))


def close(values, texts, digits):
    """Whether numbers agree with decimal strings, relative to the larger of themselves and 1."""
    with mpmath.workdps(60):
        return all(abs(x - mpmath.mpf(y)) < mpmath.mpf(10) ** -digits * max(1, abs(x)) for x, y in zip(values, texts))


@of("rhs-")
def test_accelerations_equal_newtons(case):
    """theta'' at a random state against a solver for the joint forces, 38 digits."""
    support = Support(read(case["ddxi"]) * t**2 / 2, read(case["ddeta"]) * t**2 / 2)
    rods = [Rod(*map(read, row)) for row in zip(case["m"], case["l"], case["H"], case["R"])]
    scene = Scene(rods, support, gravity=read(case["g"]))
    found = accelerations(scene, map(read, case["theta"]), map(read, case["dtheta"]))

    assert close(found, case["ddtheta"], 38)


@of("published-rhs")
def test_accelerations_equal_published_ones(case):
    """Hanging bobs of mass and length 1, the notes' angles."""
    phi, dphi = ([read(x) for x in case[key]] for key in ("phi", "dphi"))
    scene = Scene([Rod.bob(1, 1)] * len(phi), gravity=Rational(981, 100), upright=False)

    assert close(accelerations(scene, phi, dphi), case["ddphi"], 38)
    assert close(accelerations(scene, phi, dphi), case["ddphi_published"], 8)


@of("notes-Z")
def test_mass_matrix_of_bobs_is_the_real_part_of_the_notes_z(case):
    """The inverse of M, for lengths 1, is Re(Z)^-1."""
    n = len(case["m"])
    scene = Scene([Rod.bob(read(x), 1) for x in case["m"]], upright=False)
    M = euler_lagrange(scene).mass_matrix.xreplace(dict(zip(scene.coordinates, map(read, case["phi"]))))
    with mpmath.workdps(60):
        inverse = mpmath.inverse(mpmath.matrix(M.evalf(60).tolist()))
        for i, row in enumerate(case["ReZ_inverse"]):
            assert close([inverse[i, j] for j in range(n)], row, 38)


@of("", CASES["hanging_bobs"])
def test_hanging_bobs_have_the_equations_of_the_notes(case):
    """The notes' left-hand sides, which are ours divided by l_k."""
    n = case["N"]
    scene = Scene([Rod.bob(*symbols(f"m{i} l{i}")) for i in range(1, n + 1)], upright=False)
    lhs, M = euler_lagrange(scene).lhs, euler_lagrange(scene).mass_matrix

    for k, rod in enumerate(scene.rods):
        assert expand(lhs[k] - rod.length * moving(case["lhs"][k], n, "phi")) == 0
        assert all(expand(M[k, j] - rod.length * moving(case["mass_matrix"][k][j], n, "phi")) == 0 for j in range(n))


@of("", CASES["cart"])
def test_a_bob_on_a_cart_has_the_row_known_from_kane(case):
    """One bob on a support with acceleration a0, its angle anticlockwise: theta = -q."""
    a0, a1, q1 = symbols("a0 a1 q1")
    m1, l0 = symbols("m1 l0")
    scene = Scene([Rod.bob(m1, l0)], Support(xi=a0 * t**2 / 2))
    theta = scene.coordinates[0]
    lhs = euler_lagrange(scene).lhs[0].xreplace({Derivative(theta, (t, 2)): -a1, theta: -q1})
    row = read(case["row"][0]) * a0 + read(case["row"][1]) * a1

    assert expand(lhs + row - read(case["forcing"])) == 0


@of("article-Out")
def test_two_equal_uniform_rods_give_the_articles_output(case):
    """Out[32] and Out[40]."""
    equations = euler_lagrange(Scene([Rod.uniform(m, l)] * 2, Support(xi, eta)))
    found = {"article-Out32": equations.lhs, "article-Out40": linearize(equations).divided().remainder}

    assert all(same(x, text, 2) for x, text in zip(found[case["id"]], case["expected"]))


@of("article-P4")
def test_first_order_matrix_of_the_double_rod_is_the_articles(case):
    """P(tau) entry by entry, in the article's symbols."""
    epsilon, omega0 = symbols("epsilon omega0")
    lin = linearize(euler_lagrange(Scene([Rod.uniform(m, l)] * 2, Support(eta=epsilon * cos(omega0 * t)))))
    P, _, period = lin.first_order(omega0, dimensionless=False)

    assert period == 2 * pi
    assert all(expand(P[i, j] - read(case["expected"][i][j])) == 0 for i in range(4) for j in range(4))


@of("", CASES["first_order"])
def test_first_order_matrix_holds_only_h_and_v(case):
    """P of two and three rods at given h and v equals the reference P(t; a, b)."""
    epsilon, omega0, h, v = symbols("epsilon omega0 h v")
    expected = Matrix(read(case["P"])).subs({Symbol(k): read(x) for k, x in case["params"].items()})
    n = expected.rows // 2
    lin = linearize(euler_lagrange(Scene([Rod.uniform(m, l)] * n, Support(eta=epsilon * cos(omega0 * t)))))
    P, tau, _ = lin.first_order(omega0)
    difference = P.subs({h: read(case["h"]), v: read(case["v"]), tau: t}) - expected

    assert difference.applyfunc(expand).is_zero_matrix


def build(inputs):
    """The scene that a case of bad input describes, linearised if it asks for that."""
    n = inputs["N"]
    masses, lengths = (inputs.get(k, [name] * max(n, 0)) for k, name in (("m", "m"), ("l", "l")))
    rods = [Rod.uniform(read(a), read(b)) for a, b in zip(masses, lengths)]
    scene = Scene(rods, Support(eta=read(inputs.get("eta", "0"))))
    return linearize(euler_lagrange(scene), about=[read(x) for x in inputs["linearize_at"]])


@of("", CASES["bad_inputs"])
def test_bad_input_is_refused_with_its_reason(case):
    """A named exception whose message holds one of the words."""
    with pytest.raises(LagrangianError) as refused:
        build(case["inputs"])

    assert any(word in str(refused.value) for word in case["message_should_mention"])
