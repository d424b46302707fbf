"""The loop closes: nonlinear driven rods stay up, or fall, where the exact Floquet matrix proves that they must.

The two packages share nothing but the rods: ``fastpicard`` has exact Picard iterates of the linearised equations,
``lagrangian`` the Taylor steps of the nonlinear ones.
"""

import mpmath
import numpy as np
import pytest
from scipy.optimize import brentq
from sympy import Rational, cos, symbols

from fastpicard import FloquetMatrix, Verdict
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, simulate

t, omega0, epsilon = symbols("t omega0 epsilon")
ITERATES = 40


def scene_of(n):
    """``n`` uniform rods, l = g = 1, on a support that moves by epsilon cos(omega0 t): v = omega0, h = epsilon."""
    return Scene([Rod.uniform(1, 1)] * n, Support(eta=epsilon * cos(omega0 * t)), gravity=1, t=t)


@pytest.fixture(scope="module", params=[2, 3], ids=["two rods", "three rods"])
def problem(request):
    """The number of rods, the Floquet matrix and its parameters h and v."""
    n = request.param
    P, tau, period = linearize(euler_lagrange(scene_of(n))).first_order(omega0)
    names = {x.name: x for x in P.free_symbols}
    return n, FloquetMatrix(P, tau, ITERATES, period), names["h"], names["v"]


POINTS = {2: (Rational(6, 100), [24, 26, 27, 28, 30, 40]), 3: (Rational(3, 100), [40, 50, 60, 72, 80, 100])}


def test_rods_near_upright_stay_up_where_the_floquet_matrix_is_stable_and_fall_where_it_is_not(problem):
    """From 1e-3 rad, 300 periods: |theta| stays below 0.03 or passes 0.3."""
    n, F, h, v = problem
    depth, speeds = POINTS[n]
    verdicts = {speed: F.verdict({h: depth, v: speed}) for speed in speeds}
    for speed, verdict in verdicts.items():
        chain = scene_of(n).compile({epsilon: depth, omega0: speed})
        start = np.full(n, 1e-3) * (-1.0) ** np.arange(n)
        times = np.linspace(0, 2 * np.pi * 300 / speed, 301)
        motion = simulate(chain, start, np.zeros(n), times, accuracy=1e-3)
        highest = abs(motion.theta).max()

        assert highest < 0.03 if verdict == Verdict.STABLE else highest > 0.3, (speed, verdict, highest)
    assert all(wanted in verdicts.values() for wanted in (Verdict.STABLE, Verdict.UNSTABLE))


def nonlinear_map(n, depth, speed, step=1e-5):
    """The derivative at upright of the nonlinear motion over one period, by central differences; shape (2n, 2n)."""
    chain = scene_of(n).compile({epsilon: depth, omega0: Rational(speed)})
    period = 2 * np.pi / speed
    columns = []
    for k in range(2 * n):
        ends = []
        for side in (step, -step):
            state = np.zeros(2 * n)
            state[k] = side if k < n else side * speed
            motion = simulate(chain, state[:n], state[n:], [0.0, period], accuracy=1e-14)
            ends.append(np.concatenate([motion.theta[-1], motion.omega[-1] / speed]))
        columns.append((ends[0] - ends[1]) / (2 * step))
    return np.array(columns).T


def test_the_boundary_of_the_nonlinear_rods_is_the_floquet_boundary(problem):
    """det(Phi - 1) = 0 from exact iterates, and from differences of nonlinear motions: one v to 1e-6."""
    n, F, h, v = problem
    depth, (low, high) = {2: (Rational(6, 100), (27.2, 28.0)), 3: (Rational(3, 100), (66.0, 72.0))}[n]

    def from_motions(speed):
        return np.linalg.det(nonlinear_map(n, depth, speed) - np.eye(2 * n))

    def from_iterates(speed):
        with mpmath.workdps(30):
            phi = F.evaluate({h: depth, v: speed}, digits=30)
            return mpmath.det(mpmath.matrix(phi.tolist()) - mpmath.eye(2 * n))

    mine = brentq(from_motions, low, high, xtol=1e-9)
    with mpmath.workdps(30):
        exact = mpmath.findroot(from_iterates, (mpmath.mpf(low), mpmath.mpf(high)), solver="anderson", tol=1e-20)

    assert abs(mine - exact) < 1e-6
    if n == 2:
        assert abs(exact - mpmath.mpf("27.556756338772")) < 1e-11
