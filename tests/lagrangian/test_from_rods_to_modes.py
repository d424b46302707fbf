"""What a user meets on the way from rods to P, tau, period and to normal modes."""

from configparser import ConfigParser
from pathlib import Path

import mpmath
import pytest
from sympy import CRootOf, Matrix, Rational, Symbol, cancel, cos, count_ops, exp, expand, pi, sin, sqrt, symbols

import lagrangian
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes

m, l, g, k, t, epsilon, omega0, h, v = symbols("m l g k t epsilon omega0 h v")
driven = Support(eta=epsilon * cos(omega0 * t))
rod = Rod.uniform(m, l)


def linear(rods, support=driven, **options):
    """The linear equations of ``rods``, driven vertically unless said otherwise."""
    return linearize(euler_lagrange(Scene(rods, support, **options)))


def test_the_package_says_its_version():
    """That of the distribution."""
    settings = ConfigParser()
    settings.read(Path(__file__).parents[2] / "setup.cfg")

    assert lagrangian.__version__ == settings["metadata"]["version"]


def test_double_rod_has_the_articles_first_order_matrix():
    """P after Out[43] with a = -1/(7 v**2), b = h/7, and what h and v stand for."""
    system = linear([rod] * 2).first_order(omega0)
    P, tau, period = system
    assert (system[0], system[1], system[-1]) == (P, tau, period)
    wave = -1 / (7 * v**2) + h / 7 * cos(tau)
    expected = Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-18 * wave, 9 * wave, 0, 0], [27 * wave, -24 * wave, 0, 0]])

    assert (P - expected).applyfunc(expand).is_zero_matrix
    assert period == 2 * pi
    assert system.where == ((h, epsilon / l), (v, omega0 * sqrt(l / g)))


def test_double_rod_has_the_articles_matrices():
    """Out[38], Out[41], Out[42] and Out[43]."""
    lin = linear([rod] * 2).divided()
    modes = normal_modes(lin)

    assert lin.divided() == lin
    assert Matrix([[Rational(4, 3), Rational(1, 2)], [Rational(1, 2), Rational(1, 3)]]) == lin.A
    assert expand(lin.stiffness[1, 1] + g / (2 * l) - epsilon * omega0**2 * cos(omega0 * t) / (2 * l)) == 0
    assert Matrix.diag(Rational(3, 2), Rational(1, 2)) == modes.B
    assert modes.A.inv() * modes.B == Matrix([[18, -9], [-27, 24]]) / 7
    assert modes.mathieu(omega0) == tuple((expand(-mu / v**2), expand(mu * h)) for mu in modes.mu)


def test_modes_in_symbols_diagonalise_exactly():
    """Two rods with every quantity a Symbol: numbers put in afterwards satisfy the equation of U."""
    modes = normal_modes(linear([Rod(*symbols(f"m{i} l{i} H{i} R{i}")) for i in (1, 2)]))
    numbers = {Symbol(f"{name}{i}"): Rational(value, i + 1) for name, value in (("m", 3), ("l", 4), ("H", 2), ("R", 3))
               for i in (1, 2)}
    A, B, U = (x.subs(numbers) for x in (modes.A, modes.B, modes.U))
    residual = B * U - A * U * Matrix.diag(*(mu.subs(numbers) for mu in modes.mu))

    assert max(abs(x.evalf(40, chop=True)) for x in residual) < Rational(1, 10**30)
    assert abs((U.T * A * U)[0, 1].evalf(40, chop=True)) < Rational(1, 10**30)


@pytest.mark.parametrize("rods, options, mu", [
    ([Rod.bob(m, l), Rod(m, l, 0, l)], {}, {0, 1 / l}),
    ([Rod.bob(m, l), Rod(m, l, 0, l)], {"gravity": 0, "springs": [k, 0]}, {0, k / (2 * l**2 * m)}),
    ([Rod.bob(m, l), Rod(m, l, 0, l)], {"springs": [1, 0]}, {0, 1 / (2 * l**2 * m) - g / l}),
    ([Rod.bob(m, l), Rod(pi * m, l, l / 7, l)], {"gravity": 0, "springs": [k, 0]},
     {0, 49 * k / (l**2 * m * (49 + 48 * pi))}),
    ([Rod.bob(m, l)] * 2, {"gravity": 0, "springs": [k, 0]}, {0, k / (l**2 * m)}),
    ([Rod.bob(sqrt(2) * m, l), Rod(sqrt(3) * m, l, l / 7, l)], {"gravity": 0, "springs": [0, k]}, None),
    ([Rod.bob(1, 1), Rod(pi, 1, 0, 1)], {"gravity": 3}, {0, 1}),
    ([Rod.bob(1, 1), Rod(pi, 1, 0, 1)], {"gravity": 0, "springs": [1, 1]}, None),
], ids=str)
def test_modes_of_rods_that_come_apart_are_two(rods, options, mu):
    """U is regular and A-orthogonal, and B U = A U mu, where an entry of U is 0 for one of the two mu."""
    modes = normal_modes(linear(rods, Support(), **options))
    numbers = {m: Rational(2, 3), l: Rational(5, 7), g: 11, k: Rational(13, 17)}
    A, B, U = (x.xreplace(numbers).evalf(50) for x in (modes.A, modes.B, modes.U))
    residual = B * U - A * U * Matrix.diag(*(x.xreplace(numbers) for x in modes.mu))

    assert mu is None or all(any(expand(cancel(x - y)) == 0 for y in modes.mu) for x in mu)
    assert abs(U.det()) > Rational(1, 10)
    assert max(map(abs, (*residual.evalf(40), (U.T * A * U)[0, 1]))) < Rational(1, 10**30)


def test_linear_equations_print_every_term_they_have():
    """Damping and the remainder of horizontal driving too; without both, neither."""
    rod, e, w = Rod.uniform(1, 1), Symbol("e"), Symbol("w")
    full = linearize(euler_lagrange(Scene([rod], Support(xi=e * cos(w * t)), t=t, gravity=9, damping=[1])))
    assert "A theta'' + damping theta' + stiffness theta + remainder = 0" in repr(full)
    assert "A theta'' + damping theta' + stiffness theta = 0" in repr(full.homogeneous())
    assert "A theta'' + stiffness theta = 0" in repr(linearize(euler_lagrange(Scene([rod], t=t, gravity=9))))


def test_modes_are_exact_beyond_two_rods():
    """Five rods: roots of one irreducible polynomial; a common factor in symbols stays in front."""
    assert all(mu.has(CRootOf) for mu in normal_modes(linear([rod] * 5)).mu)
    unequal = normal_modes(linear([Rod.uniform(k * m, l) for k in (1, 2, 3)]))
    assert unequal.mu[0].free_symbols == {l} and len(unequal.equations) == 3


def test_springs_without_driving_have_modes():
    """At rest the stiffness is constant, springs included, and s(t) = 1."""
    modes = normal_modes(linear([rod] * 2, Support(), springs=symbols("k:2"), upright=False))

    assert modes.time_factor == 1
    assert expand(sum(modes.mu) - (modes.A.inv() * modes.B).trace()) == 0


def test_equal_modes_get_orthogonal_coordinates():
    """No weight and no springs: mu = 0 twice, and U still diagonalises A."""
    modes = normal_modes(linear([rod] * 2, Support(), gravity=0))
    product = modes.U.T * modes.A * modes.U

    assert modes.mu == (0, 0) and product[0, 1] == 0


def test_hanging_rest_of_an_upright_scene_equals_a_hanging_scene():
    """about = pi changes the angles, not the chain."""
    turned = linearize(euler_lagrange(Scene([rod] * 3, driven)), about=[pi] * 3)
    hanging = linear([rod] * 3, upright=False)

    assert turned.A == hanging.A and turned.stiffness == hanging.stiffness
    assert normal_modes(turned).mu == normal_modes(hanging).mu


def test_only_what_the_scene_holds_is_modelled():
    """No time, no horizontal terms, no H and R where there are none."""
    rest = euler_lagrange(Scene([rod, Rod.bob(m, l)]))
    angles = {x: Symbol(f"x{i}") for i, x in enumerate((*rest.scene.velocities, *rest.scene.coordinates))}

    assert rest.forcing.xreplace(angles).free_symbols == {m, l, g, *angles.values()}
    assert not linear([rod] * 2).remainder.free_symbols
    assert euler_lagrange(Scene([rod], gravity=0)).forcing.is_zero_matrix


@pytest.mark.parametrize("eta, period", [
    (epsilon * cos(omega0 * t), 2 * pi), (epsilon * cos(2 * omega0 * t), pi), (epsilon * sin(omega0 * t / 3), 6 * pi),
    (cos(omega0 * t) + cos(3 * omega0 * t / 2), 4 * pi), (epsilon * cos(omega0 * t) ** 2, pi), (0, 2 * pi),
    (epsilon * t, 2 * pi),
])
def test_period_is_the_smallest_common_one(eta, period):
    """2 pi for the article's drive; uniform motion of the support is no drive at all."""
    assert linear([rod], Support(eta=eta)).first_order(omega0).period == period


def test_constants_of_mpmath_are_those_numbers():
    """Not their roundings at the precision that mpmath happens to have."""
    constants = mpmath.pi, mpmath.e, mpmath.euler, mpmath.catalan, mpmath.phi, mpmath.degree, mpmath.ln2, mpmath.ln10
    found = [Rod.bob(1, constant).length for constant in constants]

    with mpmath.workdps(60):
        assert all(abs(x.evalf(60) - +c) < mpmath.mpf(10) ** -57 for x, c in zip(found, constants, strict=True))


def test_damped_rods_keep_their_damping():
    """The lower right block is -A^-1 damping / omega0, with v in the place of omega0."""
    c = symbols("c")
    P, _, _ = linear([rod], damping=[c]).first_order(omega0)

    assert expand(P[1, 1] + 3 * c * sqrt(l / g) / (m * l**2 * v)) == 0


@pytest.mark.parametrize("gravity", [9, -9])
@pytest.mark.parametrize("symbol", [g, g + 1, Symbol("g", real=True)], ids=str)
def test_v_means_the_same_for_gravity_of_either_sign(symbol, gravity):
    """What v stands for, put in, gives the P of the scene's symbols, the damping with it, not its negative."""
    lin = linear([rod] * 2, damping=[3, 5], gravity=symbol)
    system, plain = lin.first_order(omega0), lin.first_order(omega0, dimensionless=False)
    numbers = {m: 2, l: 3, epsilon: Rational(1, 7), omega0: 11, **dict.fromkeys(symbol.free_symbols, gravity)}
    difference = system.P.xreplace(dict(system.where)) - plain.P

    assert v in system.P.free_symbols
    assert difference.xreplace(numbers).applyfunc(expand).is_zero_matrix


def test_unequal_rods_keep_their_symbols():
    """General rods: P in the symbols of the scene, -A^-1 stiffness / omega0**2."""
    rods = [Rod(*symbols(f"m{i} l{i} H{i} R{i}")) for i in (1, 2)]
    lin = linear(rods)
    system = lin.first_order(omega0)
    difference = lin.A * system.P[2:, :2] + lin.stiffness.subs(t, system.tau / omega0) / omega0**2

    assert system.where == ()
    assert difference.applyfunc(lambda x: x.cancel()).is_zero_matrix


def test_every_public_object_has_a_short_text_and_a_formula():
    """repr stays short however long the chain; notebooks show mathematics."""
    scene = Scene([rod] * 12, driven)
    equations = euler_lagrange(scene)
    lin = linearize(equations)
    for thing in (rod, driven, scene, equations, lin, lin.first_order(omega0), normal_modes(lin, digits=8)):
        assert len(repr(thing)) < 400 and str(thing) == repr(thing)
        assert thing._repr_latex_().startswith("$")
    small = linear([rod], Support(xi=cos(t)), damping=[1])
    for thing in (Scene([rod]), euler_lagrange(Scene([rod])), small):
        assert "theta" in thing._repr_latex_()


@pytest.mark.parametrize("masses", [
    [1, 1, sqrt(2)], [1, 1, 1, 1, sqrt(2)], [1, 1, 1, pi], [1, pi, sqrt(3), sqrt(2), exp(2)], [1, 1 / (1 + sqrt(2)), 2],
    [m, 1, 1, sqrt(2)], [sqrt(2), sqrt(3), sqrt(5), sqrt(7)],
], ids=str)
def test_irrational_masses_leave_the_first_order_matrix_short(masses):
    """A times the block of P is minus the stiffness, to 50 digits; in a field that knows sqrt(2)**2 = 2 it is short."""
    lin = linear([Rod.uniform(mass, 1) for mass in masses], Support(), gravity=1)
    n = len(masses)
    block = lin.first_order(3).P[n:, :n]
    A, minus_block, stiffness = (x.xreplace({m: Rational(7, 5)}).evalf(60) for x in (lin.A, -9 * block, lin.stiffness))

    assert count_ops(block) < 4000
    assert max(map(abs, A * minus_block - stiffness)) < Rational(1, 10**50)
