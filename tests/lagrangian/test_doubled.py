"""Taylor steps in double-double against the same steps in balls of 40 and more digits, and against laws."""

import json
import subprocess
import sys
from fractions import Fraction
from functools import partial
from pathlib import Path

import flint
import mpmath
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from sympy import Integer, Rational, Symbol, cos, sin, sqrt

from lagrangian import CompiledChain, Crossing, Rod, Scene, Support, flips, simulate
from lagrangian.angles import product
from lagrangian.arithmetic import Balls
from lagrangian.digits import Steps, integrate_digits
from lagrangian.doubled import UNIT, DoubledSteps
from lagrangian.machine import as_written
from lagrangian.pairs import added, divided, multiplied, subtracted

pytest.importorskip("numba")
pairtype = pytest.importorskip("lagrangian.pairtype")
pair, pairs, fused_product = pairtype.pair, pairtype.pairs, pairtype.fused_product

# An example steps balls of 45 digits, some tenths of a second.
slow = settings(max_examples=min(12, settings.default.max_examples), deadline=None)
measured = settings(max_examples=min(150, settings.default.max_examples), deadline=None)
floats = st.floats(-1e60, 1e60).filter(lambda x: abs(x) > 1e-60)
t = Symbol("t")


def operations(x, y, n, out):
    """Every operator of pairs, with pairs and with numbers."""
    a, b, c = pairs(x), pairs(y), pairs(out)
    p, q = a[0], b[0]
    c[0], c[1], c[2], c[3], c[4] = p + q, p - q, p * q, p / q, -p
    c[5], c[6], c[7], c[8], c[9] = p / n, 1 / q, n * p, p - 0.5, 2.5 * q


def fused(a, b, out):
    """What stands in for Dekker's product."""
    out[0], out[1] = fused_product(a, b)


@measured
@given(floats, floats, st.floats(-1, 1), st.floats(-1, 1), st.integers(1, 50))
def test_translated_operators_are_the_functions_of_pairs_to_the_bit(a, b, d, e, n):
    """Nothing is contracted, reordered or left out in translation."""
    x, y = (a, a * d * 2.0**-54), (b, b * e * 2.0**-54)
    out = np.zeros(10, complex)
    as_written(operations)(
        np.array([complex(*x)]), np.array([complex(*y)]), n, out)
    expected = [added(*x, *y), subtracted(*x, *y), multiplied(*x, *y), divided(*x, *y), (-x[0], -x[1]),
                divided(*x, float(n), 0.0), divided(1.0, 0.0, *y), multiplied(float(n), 0.0, *x),
                subtracted(*x, 0.5, 0.0), multiplied(2.5, 0.0, *y)]

    assert [(z.real, z.imag) for z in out] == expected


@measured
@given(floats, floats)
def test_the_fused_product_is_dekkers(a, b):
    """One instruction in place of seventeen, and the same two floats."""
    out = np.zeros(2)
    as_written(fused)(a, b, out)

    assert tuple(out) == product(a, b) and Fraction(out[0]) + Fraction(out[1]) == Fraction(a) * Fraction(b)


def chain_of(rng, n, ratio=1.0, **options):
    """Random rods, every constant a float."""
    length = rng.uniform(0.3, 2.0, n)
    center = rng.uniform(-0.2, 1.0, n) * length
    gyration = np.sqrt(center**2 + rng.uniform(0.05, 0.5, n) * length**2)
    mass = rng.uniform(0.3, 2.0, n) * ratio ** rng.integers(0, 2, n)
    return CompiledChain(mass, length, center, gyration, **options)


@st.composite
def motions(draw, most=6):
    """A chain, with any of dampers, springs, support in waves or in any function, and a state."""
    rng = np.random.default_rng(draw(st.integers(0, 10**9)))
    n = draw(st.integers(1, most))
    options = {"damping": rng.uniform(0.0, 0.2, n) if draw(st.booleans()) else None,
               "springs": rng.uniform(0.0, 2.0, n) if draw(st.booleans()) else None, "upright": draw(st.booleans())}
    drive = draw(st.sampled_from(["rest", "waves", "function"]))
    chain = chain_of(rng, n, support_acceleration=(
        (lambda x: (np.sin(2 * x), 1 / (1 + x * x))) if drive == "function" else (0, 0)), **options)
    if drive == "waves":
        m, l, I, _, _, _, mH, _ = chain.rods.T
        rods = [Rod(*map(Rational, row)) for row in zip(m, l, mH / m, np.sqrt(I / m) * (1 + 1e-9), strict=True)]
        chain = Scene(rods, Support(sin(3 * t) / 5, cos(sqrt(2) * t) / 7), Rational("9.81"), False,
                      options["damping"], options["springs"], t).compile()
    state = [[Rational(x) for x in part] for part in (rng.uniform(-3.0, 3.0, n), rng.normal(size=n))]
    return chain, state


@slow
@given(motions())
def test_the_translated_recursion_gives_31_digits_of_every_series(motion):
    """Against balls of 45 digits, every order weighed by the step: sum_j |error_j| h**j <= 1e-30 sum_j |c_j| h**j."""
    chain, state = motion
    with flint.ctx.workprec(180):
        start = [[Balls().number(x).mid() for x in part] for part in state]
        mine, true = (kind(chain, start, 31, 37) for kind in (DoubledSteps, Steps))
        for steps in (mine, true):
            steps.state_at(flint.arb(3) / 10, flint.arb(2))
        h, error, size = abs(float(true.length)), 0.0, 0.0
        for j in range(38):
            for k in range(len(chain)):
                x, y = mine.series[k, 2, 37 - j], true.series[k, 2, 37 - j].mid()
                error += abs(float(flint.arb(x.real) + flint.arb(x.imag) - y)) * h**j
                size += abs(float(y)) * h**j

        assert abs(float(mine.length) / float(true.length) - 1) < 1e-12
    assert error <= 1e-30 * size


@slow
@given(motions(most=3), st.integers(17, 31))
def test_estimated_errors_are_honest(motion, digits):
    """Against 42 digits in balls: no angle is farther than the estimate."""
    chain, state = motion
    times = [0, Rational(1, 2), 1]
    mine, true = simulate(chain, *state, times, digits=digits), simulate(chain, *state, times, digits=42)

    assert mine.method == f"taylor, {digits} digits in double-double" and true.method == "taylor, 42 digits in balls"
    for row, exact, error in zip(mine.theta, true.theta, mine.error, strict=True):
        assert max(abs(true.theta[0, 0].context.convert(x) - y) for x, y in zip(row, exact, strict=True)) <= error
    assert mine.error[-1] < 1e4 * 10.0**-digits


def test_a_long_motion_keeps_its_digits():
    """Ten seconds of a damped, driven double rod with 30 digits, against 40 in balls."""
    scene = Scene([Rod.uniform(1, 1)] * 2, Support(eta=cos(3 * t) / 10), Rational("9.81"), False, [Rational(1, 5)] * 2,
                  None, t)
    times = [Integer(x) for x in (0, 5, 10)]
    mine, true = (simulate(scene.compile(), [1, Rational(1, 2)], [0, 0], times, digits=d) for d in (30, 40))

    assert abs(mine.theta - true.theta).max() <= mine.error[-1] < 1e-26


def energy_of(chain, theta, omega):
    """The energy to the precision of the state, from the positions of the centres of mass."""
    context, total, x, y, vx, vy = theta[0].context, 0, 0, 0, 0, 0
    for k in range(len(chain)):
        m, l, _, Ic, _, _, mH, _ = (context.mpf(v) for v in chain.rods[k])
        s, c, H = context.sin(theta[k]), context.cos(theta[k]), mH / m
        total += m * ((vx + H * c * omega[k]) ** 2 + (vy - H * s * omega[k]) ** 2) / 2 + Ic * omega[k] ** 2 / 2
        total += m * 10 * (y + H * c)
        x, y, vx, vy = x + l * s, y + l * c, vx + l * c * omega[k], vy - l * s * omega[k]
    return total


def test_energy_is_conserved_to_28_digits():
    """Three rods from rest near upright, 10 s and some three hundred steps, by exact constants."""
    half, one = Rational(1, 2), Integer(1)
    chain = CompiledChain([one] * 3, [one] * 3, [half] * 3, [Rational(5, 8)] * 3, 10)
    motion = simulate(chain, [half, one, 2], [0, 0, 0], [0, 2, 5, 10], digits=31)
    energies = [energy_of(chain, *row) for row in zip(motion.theta, motion.omega, strict=True)]

    assert motion.method == "taylor, 31 digits in double-double" and motion.steps > 200
    assert max(abs(e - energies[0]) for e in energies) < mpmath.mpf(10) ** -28 * chain.energy_scale


@pytest.mark.parametrize("n", [2, 5, 10, 30])
def test_masses_1e12_and_lengths_1e6_apart_lose_what_their_constants_do_not_determine_and_no_more(n):
    """One step against balls of 1500 digits: 1e-31, or what a move of the constants by 2**-105 changes."""
    rng = np.random.default_rng(n)
    length = 10.0 ** rng.uniform(-3, 3, n)
    chains = [chain_of(rng, n, 1e12), chain_of(rng, n, 1e-12), CompiledChain([1.0] * n, length, length, length)]
    for chain in chains:
        with flint.ctx.workprec(5000):
            state = [[flint.arb(x) for x in part] for part in (rng.uniform(-3, 3, n), 0.01 * rng.normal(size=n))]
            kinds = Steps, DoubledSteps, partial(DoubledSteps, unsettled=UNIT)
            true, mine, moved = (kind(chain, state, 31, 37) for kind in kinds)
            for steps in (true, mine, moved):
                steps.state_at(flint.arb(0), flint.arb(2))
            exact, found, other = (steps.increments(true.length)[0] for steps in (true, mine, moved))
            error, change = (max(abs(float(x)) for x in found - part) for part in (exact, other))

            assert error <= 1e-31 * max(abs(float(x)) for x in exact) + 200 * change
            assert error < 1e-24


def test_times_between_the_steps_and_backwards():
    """Many times in one run are what runs to each of them give, and shrinking times lead back to the start."""
    half, gyration = [Rational(1, 2)] * 2, [Rational(3, 5)] * 2
    chain = CompiledChain([1, 2], [1, 1], half, gyration, 9.81, lambda x: (0, np.cos(5 * x)))
    times = [Rational(k, 100) for k in range(0, 101, 10)]
    all_at_once = simulate(chain, [2, 1], [0, 0], times, digits=29)
    for i in (1, 5, 10):
        single = simulate(chain, [2, 1], [0, 0], [0, times[i]], digits=29)
        assert abs(single.theta[-1] - all_at_once.theta[i]).max() < 1e-27
    end = [[Rational(str(x)) for x in part[-1]] for part in (all_at_once.theta, all_at_once.omega)]
    back = simulate(chain, *end, [1, 0], digits=29)

    assert max(abs(back.theta[-1, k] - (2, 1)[k]) for k in range(2)) < 1e-25


def test_an_accuracy_beyond_floats_is_met_in_double_double_and_beyond_that_in_balls():
    """1e-20 needs 26 digits, 1e-30 needs 36."""
    chain = CompiledChain([1], [1], [1], [1], 9.81, upright=False)
    for accuracy, kind in ((1e-20, "double-double"), (1e-30, "balls")):
        motion = simulate(chain, [1], [0], [0, 1], accuracy=accuracy)
        assert motion.accurate and motion.method.endswith(f"digits in {kind}") and kind in repr(motion)


@pytest.mark.parametrize(("chain", "omega"), [
    (CompiledChain([1, 0, 1], [1, 1, 1], [1, 1, 1], [1, 1, 1]), 1),  # no mass: a limit, of 1e-400
    (CompiledChain([10**60, 1], [1, 1], [1, 1], [1, 1]), 1),
    (CompiledChain([1, 1], [1, 1], [1, 1], [1, 1]), 10**12),  # coefficients of 1e400
    (CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], Rational(1, 10**12)), Rational(1, 10**6)),  # steps of days
], ids=["massless", "heavy", "fast", "slow"])
def test_what_leaves_the_range_of_floats_is_computed_in_balls(chain, omega):
    """The answer is right, and says how it was found; nothing is kept of the steps that left the range."""
    n, end = len(chain), Rational(1, 10) / omega
    motion = simulate(chain, [Rational(k, 3) for k in range(n)], [omega] * n, [0, end], digits=25, dense=True)

    assert motion.method == "taylor, 25 digits in balls" and motion.error[-1] < 1e-20
    assert abs(motion.at([0, end])[0] - motion.theta).max() < 1e-23


def test_states_between_the_times_and_flips_are_those_of_balls():
    """30 digits against 38 of a double pendulum that turns over."""
    half, gyration = [Rational(1, 2)] * 2, [Rational(3, 5)] * 2
    chain = CompiledChain([1, 2], [1, 1], half, gyration, 9.81, upright=False)
    mine, true = (simulate(chain, [0, 0], [12, 9], [0, 1], digits=d, dense=True, events=flips(chain)) for d in (30, 38))
    times = [Rational(k, 7) for k in range(8)]

    assert mine.method.endswith("double-double") and true.method.endswith("balls")
    for x, y in zip(mine.at(times), true.at(times), strict=True):
        assert abs(x - y).max() < 1e-26
    for name in flips(chain):
        assert len(mine.events[name]) == len(true.events[name]) > 0
        assert abs(mine.events[name] - true.events[name]).max() < 1e-27


def test_a_crossing_where_two_steps_of_pairs_meet_belongs_to_one_of_them():
    """Increments in pairs round otherwise than the polynomials in balls that crossings are sought in."""
    chain = CompiledChain([1], [1], [Rational(1, 2)], [Rational(3, 5)], 9.81, upright=False)
    run = partial(simulate, chain, [2], [3], [0, 2], digits=31)
    pieces = run(dense=True).interpolant
    exact = [angle[0].man_exp() for (angle,) in pieces.angles]
    events = {str(k): Crossing(1, Rational(int(m)) * Rational(2) ** int(e)) for k, (m, e) in enumerate(exact)}
    found = run(events=events).events

    for k, start in enumerate(pieces.shown(pieces.start)):
        assert [x for x in found[str(k)] if abs(x - start) < 1e-9] == [start]


WITHOUT_NUMBA = """
import json, sys
sys.modules["numba"] = None
from lagrangian import CompiledChain, simulate
motion = simulate(CompiledChain([1, 2], [1, 1], [1, 1], [1, 1]), [1, 2], [0, 0], [0, 1], digits=28)
print(json.dumps([motion.method, str(motion.theta[-1, 0])]))
"""


def test_without_numba_the_same_digits_come_from_balls():
    """A new process that has no numba."""
    code = [sys.executable, "-W", "error", "-c", WITHOUT_NUMBA]
    done = subprocess.run(code, cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    method, angle = json.loads(done.stdout)
    mine = integrate_digits(CompiledChain([1, 2], [1, 1], [1, 1], [1, 1]), [Integer(1), Integer(2)], [Integer(0)] * 2,
                            [Integer(0), Integer(1)], 28, None, None, DoubledSteps).theta

    assert method == "taylor, 28 digits in balls"
    assert abs(mine[-1, 0].context.mpf(angle) - mine[-1, 0]) < 1e-26
