"""Horizontal driving: where it is parametric, where it only pushes, and what the linear equations cannot see."""

import mpmath
import numpy as np
import pytest
from sympy import Function, Matrix, Rational, Symbol, atan, cos, expand, pi, sin, symbols, zeros

from fastpicard import FloquetMatrix, Verdict, certify
from lagrangian import (
    InhomogeneousError,
    NotAnEquilibriumError,
    Rod,
    Scene,
    Support,
    euler_lagrange,
    linearize,
    simulate,
)
from tests.oracles import true_fundamental_matrix

t, epsilon, omega0, ratio = symbols("t epsilon omega0 ratio")
SPRING = Rational(1, 5)


def scene(xi=0, eta=0, rods=2, gravity=1, springs=(SPRING, SPRING)):
    """Equal uniform rods of mass, length and gravity 1, with springs in their joints."""
    return Scene([Rod.uniform(1, 1)] * rods, Support(xi=xi, eta=eta), gravity=gravity, springs=springs, t=t)


def small(*args, about=None, **more):
    """The linear equations of such a scene."""
    return linearize(euler_lagrange(scene(*args, **more)), about)


SHAKEN = small(epsilon * cos(omega0 * t), gravity=0, springs=(0, SPRING), about=[pi / 2, pi / 2])


def test_rods_shaken_along_themselves_are_rods_driven_vertically():
    """Without weight every direction is alike: a quarter turn of the whole scene changes nothing."""
    upright = small(0, epsilon * cos(omega0 * t), gravity=0, springs=(0, SPRING))

    assert SHAKEN.remainder == zeros(2, 1)
    assert [SHAKEN.A, SHAKEN.stiffness] == [upright.A, upright.stiffness]
    assert SHAKEN.first_order(omega0).P == upright.first_order(omega0, dimensionless=False).P


def test_rods_shaken_along_themselves_are_certified_by_the_full_matrix():
    """Against ball Taylor at random points of cells, and against the nonlinear motion at two of them."""
    P, tau, period = SHAKEN.first_order(omega0)
    F = FloquetMatrix(P, tau, 0, period)
    chart = certify(F, (epsilon, 0.01, 0.3), (omega0, 0.5, 4), undecided=1e-2, seconds=600)
    generator = np.random.default_rng(3)
    decided = np.flatnonzero(chart.codes)

    assert chart.undecided < 1e-2 and chart.fraction(Verdict.STABLE) > 0.1 < chart.fraction(Verdict.UNSTABLE)
    for k in generator.choice(decided, 20):
        x0, x1, y0, y1 = chart.cells[k]
        at = {epsilon: float(generator.uniform(x0, x1)), omega0: float(generator.uniform(y0, y1))}
        assert int(F.verdict(at)) * chart.codes[k] >= 0
    moving = scene(epsilon * cos(omega0 * t), gravity=0, springs=(0, SPRING))
    for verdict in (Verdict.STABLE, Verdict.UNSTABLE):
        cell = chart.cells[np.flatnonzero(chart.codes == int(verdict))[
            np.argmax(chart.areas[chart.codes == int(verdict)])]]
        at = {epsilon: (cell[0] + cell[1]) / 2, omega0: (cell[2] + cell[3]) / 2}
        run = simulate(moving.compile(at), [np.pi / 2 + 1e-6, np.pi / 2], [0, 0],
                       np.linspace(0, 60 * 2 * np.pi / at[omega0], 400), accuracy=1e-9)
        spread = np.abs(np.asarray(run.theta) - np.pi / 2).max()
        assert spread < 1e-4 if verdict == Verdict.STABLE else spread > 1e-4


def expanded(equations, about):
    """Constant and linear parts of M theta'' - f at ``about + deviation``, by Taylor's formula in one scale."""
    scale = Symbol("scale")
    deviations = [Function(f"x{i}")(t) for i in range(len(about))]
    moved = dict(zip(equations.coordinates, (q + scale * x for q, x in zip(about, deviations))))
    side = equations.lhs.subs(moved).doit()
    return [side.diff(scale, k).subs(scale, 0).doit().applyfunc(expand) for k in (0, 1)], deviations


@pytest.mark.parametrize("chain, about", [
    (scene(cos(t), cos(t), rods=1, gravity=0, springs=None), [pi / 4]),
    (scene(cos(t), cos(t), gravity=0, springs=(0, SPRING)), [pi / 4, pi / 4]),
    (scene(3 * t**2 / 8, rods=1, springs=None), [atan(Rational(3, 4))]),
    (scene(3 * t**2 / 8, springs=None), [atan(Rational(3, 4)), pi + atan(Rational(3, 4))]),
], ids=["along the rod", "along two rods", "in a cart", "in a cart, folded"])
def test_a_chain_stays_where_the_horizontal_driving_is_balanced_too(chain, about):
    """The whole moment is 0 there, so no remainder is left; A and stiffness are those of Taylor's formula."""
    equations = euler_lagrange(chain)
    small = linearize(equations, about)
    (constant, linear), deviations = expanded(equations, about)
    x = Matrix(deviations)

    assert constant == small.remainder == zeros(len(about), 1)
    assert (small.A * x.diff(t, 2) + small.stiffness * x - linear).applyfunc(expand) == zeros(len(about), 1)


def test_what_turns_a_rod_is_the_moment_with_the_horizontal_driving():
    """At pi/4 in a cart of half the weight's acceleration: sin(pi/4)/2 (1 - 1/2), and sin(pi/4)/2 at rest."""
    with pytest.raises(NotAnEquilibriumError, match=r"sqrt\(2\)/8 turns rod 1, and sqrt\(2\)/4 rod 1 without"):
        small(t**2 / 4, rods=1, springs=None, about=[pi / 4])


def forced(xi, eta):
    """``x' = P x + f`` as one homogeneous system of one dimension more: [[P, f], [0, 0]]."""
    equations = small(xi, eta)
    P, tau, period = equations.homogeneous().first_order(omega0)
    values = {Symbol("h"): epsilon, Symbol("v"): omega0}  # lengths, masses and gravity are 1
    f = (-equations.A.inv() * equations.remainder / omega0**2).subs(t, tau / omega0)
    return P.xreplace(values).row_join(zeros(2, 1).col_join(f)).col_join(zeros(1, 5)), tau, period


def test_a_push_is_one_dimension_more():
    """An elliptic drive, two rods with springs: iterate against an independent integration, to 20 digits."""
    P, tau, period = forced(epsilon * sin(omega0 * t), epsilon * cos(omega0 * t))
    at = {epsilon: Rational(1, 10), omega0: 9}
    found = FloquetMatrix(P, tau, 40, period).evaluate(at, 25)
    true = true_fundamental_matrix(P.subs(at), tau, 0, period)

    with mpmath.workdps(30):
        assert mpmath.mnorm(found - true) < mpmath.mpf(10) ** -20


def test_the_forced_motion_of_the_linear_equations_is_that_of_the_chain():
    """x = (1 - M)**-1 m repeats: the nonlinear chain comes back to it after a period, to third order in epsilon."""
    P, tau, period = forced(epsilon * sin(omega0 * t), epsilon * cos(omega0 * t) / 2)
    at = {epsilon: Rational(1, 1000), omega0: 3}
    found = FloquetMatrix(P, tau, 40, period).evaluate(at)
    start = np.linalg.solve(np.eye(4) - found[:4, :4], found[:4, 4])
    run = simulate(scene(epsilon * sin(omega0 * t), epsilon * cos(omega0 * t) / 2).compile(at), start[:2],
                   3 * start[2:], [0, 2 * np.pi / 3], accuracy=1e-13)

    assert np.abs(start).max() > 1e-4
    assert np.abs(np.asarray(run.theta)[-1] - start[:2]).max() < 1e-7


def test_a_push_leaves_the_homogeneous_part_as_it_is():
    """Whatever the horizontal amplitude, P is that of the vertical drive; the message says what that means."""
    both, vertical = (small(xi, epsilon * cos(omega0 * t)) for xi in (ratio * sin(omega0 * t), 0))

    assert both.homogeneous().first_order(omega0).P == vertical.first_order(omega0).P
    with pytest.raises(InhomogeneousError, match="second order"):
        both.first_order(omega0)


@pytest.mark.parametrize("share, stays", [(Rational(1, 2), True), (Rational(9, 10), True), (Rational(11, 10), False)])
def test_what_the_linear_equations_cannot_see(share, stays):
    """A fast horizontal drive destabilises as much as a vertical one stabilises: mu h**2 v**2 (1 - r**2)/2 > 1.

    One rod, mu = 3/2, h = 1/20, v = 100, r the ratio of the amplitudes: the left side is 18.75 (1 - r**2).  The linear
    equations about the upright are the same for all r; the fast motion h r enters them in second order.
    """
    chain = scene(share * epsilon * sin(omega0 * t), epsilon * cos(omega0 * t), rods=1, springs=None)
    run = simulate(chain.compile({epsilon: Rational(1, 20), omega0: 100}), [0.05], [-7.5 * float(share)],
                   np.linspace(0, 20, 500), accuracy=1e-8)

    assert (np.abs(np.asarray(run.theta)).max() < 0.3) == stays
