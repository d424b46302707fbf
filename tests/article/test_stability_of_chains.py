"""Reference points and boundaries of stability: from the rods through normal modes to traces of Floquet matrices."""

import json
from functools import cache
from pathlib import Path

import mpmath
import pytest
from sympy import Matrix, Rational, cos, symbols

from fastpicard import FloquetMatrix
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes

a, b, t, m, l, epsilon, omega0 = symbols("a b t m l epsilon omega0")
CASES = json.loads((Path(__file__).parent / "cases" / "stability.json").read_text())["cases"]
POINTS = [case for case in CASES if "mode_traces" in case]
BOUNDARIES = [case for case in CASES if "v_lower" in case]
CONSTANTS = [case for case in CASES if "mu_min" in case]


@cache
def mathieu():
    """Sixty iterates: beyond 25 digits for |a| + |b| <= 2."""
    return FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 60)


@cache
def modes(rods):
    """The mu_i of equal uniform rods, to 40 digits."""
    scene = Scene([Rod.uniform(m, l)] * rods, Support(eta=epsilon * cos(omega0 * t)))
    return tuple(mu.evalf(40) for mu in normal_modes(linearize(euler_lagrange(scene)), digits=40).mu)


def mode_traces(case, v):
    """The trace of every mode at the amplitude of the case."""
    h, v = Rational(case["h"]), Rational(v)
    return [mathieu().trace_at({a: -mu / v**2, b: mu * h}, 25) for mu in modes(int(case["N"]))]


@pytest.mark.parametrize("case", POINTS, ids=lambda case: case["id"])
def test_points_are_classified_by_the_traces_of_their_modes(case):
    """Every trace to its digits; stable exactly where all of them lie between -2 and 2."""
    found = mode_traces(case, case["v"])

    with mpmath.workdps(30):
        assert all(abs(x - mpmath.mpf(y)) < 1e-20 * (1 + abs(x)) for x, y in zip(found, case["mode_traces"]))
    assert case["class"].startswith("stable" if all(abs(x) < 2 for x in found) else "unstable")


@pytest.mark.parametrize("case", BOUNDARIES, ids=lambda case: case["id"])
def test_boundaries_are_where_one_mode_has_the_trace_two(case):
    """The trace is 2 in the mode that leaves at the lower frequency, -2 or 2 at the upper one."""
    lower = mode_traces(case, case["v_lower"])[case["lower_mode_index"]]
    assert abs(lower - 2) < 1e-13
    if case["v_upper"]:
        upper = mode_traces(case, case["v_upper"])[case["upper_mode_index"]]
        assert abs(abs(upper) - 2) < 1e-13


@pytest.mark.parametrize("case", CONSTANTS, ids=lambda case: case["id"])
def test_extreme_modes_of_chains_have_their_known_values(case):
    """The smallest and the largest mu bound the wedge of stability (Acheson)."""
    found = modes(int(case["N"]))

    assert abs(min(found) - Rational(case["mu_min"])) < 1e-24
    assert abs(max(found) - Rational(case["mu_max"])) < 1e-22


def test_points_of_mathieus_equation_have_their_traces():
    """y'' + (a + b cos t) y = 0 at given a and b."""
    for case in CASES:
        if case["id"].startswith(("point-mathieu", "degenerate")) and {"a", "b", "trace"} <= case.keys():
            found = mathieu().trace_at({a: Rational(case["a"]), b: Rational(case["b"])}, 25)
            with mpmath.workdps(30):
                assert abs(found - mpmath.mpf(case["trace"])) < 1e-18 * (1 + abs(found)), case["id"]


def test_the_wedge_of_stability_opens_below_the_known_amplitude():
    """At a = 0 the trace first reaches -2 at b = 0.454023...: the limit of a quadrupole ion trap, q = 2 b."""
    (case,) = [case for case in CASES if case["id"] == "bstar"]
    found = mathieu().trace_at({a: 0, b: Rational(case["value"])}, 30)

    with mpmath.workdps(30):
        assert abs(found + 2) < mpmath.mpf(10) ** -26
