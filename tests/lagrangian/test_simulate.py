"""Motions of chains: against references to 30 digits, against laws, and against their own estimate of their error."""

import json
import math
import re
from itertools import pairwise
from pathlib import Path

import flint
import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings, strategies as st
from sympy import Rational, Symbol, cos, cosh, log, pi, sin, sinh, sqrt, symbols, sympify, tanh

from lagrangian import (
    CompiledChain,
    Crossing,
    DriveError,
    NotAnEquilibriumError,
    NotASceneError,
    NotInstalledError,
    QuantityError,
    Rod,
    Scene,
    SceneError,
    Support,
    TextError,
    euler_lagrange,
    flips,
    simulate,
)
from lagrangian.animation import timing
from tests.conftest import hide

t = Symbol("t")
CASES = json.loads((Path(__file__).parent / "cases" / "trajectories.json").read_text())["cases"]
# An example follows a motion two or three times, some milliseconds each.
measured = settings(max_examples=min(150, settings.default.max_examples), deadline=None)
slow = settings(max_examples=min(20, settings.default.max_examples), deadline=None)
each_case = pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])


def read(text):
    """The exact number that a reference string holds."""
    return sympify(text, rational=True)


def scene_of(case):
    """The scene of a reference motion."""
    columns = (case[name] for name in ("m", "l", "H", "R2"))
    rods = [Rod(read(m), read(l), read(H), sqrt(read(RR))) for m, l, H, RR in zip(*columns)]

    def waves(terms):
        return sum((read(a) * {"cos": cos, "sin": sin}[f](read(q) * t) for a, q, f in terms), Rational(0))

    return Scene(rods, Support(waves(case["xi"]), waves(case["eta"])), read(case["g"]), t=t)


def motion_of(case, **options):
    """The reference motion, simulated."""
    times = [read(case["t0"]), *(read(point["t"]) for point in case["points"])]
    state = [[read(x) for x in case[name]] for name in ("theta0", "omega0")]
    return simulate(scene_of(case).compile(), *state, times, **options)


def worst(motion, case):
    """The largest error of any angle or rate."""
    with mpmath.workdps(40):
        n, errors = case["N"], []
        for i, point in enumerate(case["points"], 1):
            exact = [mpmath.mpf(x) for x in point["state"]]
            for k in range(n):
                angle = mpmath.mpf(motion.wrapped[i, k]) + 2 * mpmath.pi * int(motion.turns[i, k])
                errors += [abs(angle - exact[k]), abs(mpmath.mpf(motion.omega[i, k]) - exact[n + k])]
        return max(errors)


@st.composite
def chains(draw, damped=False, gravity=9.81, most=4):
    """Random rods, in both conventions."""
    rng = np.random.default_rng(draw(st.integers(0, 10**9)))
    n = draw(st.integers(1, most))
    length = rng.uniform(0.3, 2.0, n)
    center = rng.uniform(-0.2, 1.0, n) * length
    gyration = np.sqrt(center**2 + rng.uniform(0.05, 0.5, n) * length**2)
    damping = rng.uniform(0.0, 0.2, n) if damped else None
    springs = rng.uniform(0.0, 2.0, n) if draw(st.booleans()) else None
    return CompiledChain(rng.uniform(0.3, 2.0, n), length, center, gyration, gravity, (0, 0), damping, springs,
                         draw(st.booleans()))


def state_of(draw, n):
    """Angles and rates."""
    rng = np.random.default_rng(draw(st.integers(0, 10**9)))
    return rng.uniform(-3.0, 3.0, n), rng.normal(size=n)


@each_case
def test_reference_motions_to_12_digits_in_floats(case):
    """Eight motions, driven and free, of one to ten rods, known to 30 digits."""
    motion = motion_of(case, accuracy=1e-13)

    assert worst(motion, case) < 1e-12


@pytest.mark.parametrize("case", [c for c in CASES if c["N"] <= 3], ids=lambda case: case["id"])
def test_reference_motions_to_all_their_digits(case):
    """The same stepper with 36 digits gives the 30 digits of the references."""
    assert worst(motion_of(case, digits=36), case) < mpmath.mpf(10) ** -(case["ok_digits"] - 3)


@slow
@given(st.data())
def test_estimated_error_is_honest(data):
    """No angle is farther than the estimate from a run with 22 digits, whatever accuracy was asked for."""
    chain = data.draw(chains())
    state = state_of(data.draw, len(chain))
    times = [0.0, 0.7, 1.4]
    mine = simulate(chain, *state, times, accuracy=10.0 ** -data.draw(st.integers(5, 13)))
    true = simulate(chain, *state, times, digits=22)

    error = abs((true.theta - mine.theta.astype(object)).astype(float)).max(axis=1)
    assert (error <= mine.error + 4e-16 * abs(mine.theta).max()).all()


@measured
@given(st.data())
def test_energy_is_conserved(data):
    """Without dampers, on a support at rest, to 1e-12 of M g L over ten seconds."""
    chain = data.draw(chains())
    motion = simulate(chain, *state_of(data.draw, len(chain)), np.linspace(0, 10, 21), accuracy=1e-12)

    assert chain.conserves_energy
    assert motion.energy_drift < 1e-12 * max(1.0, float(abs(motion.energy).max()) / chain.energy_scale)


@measured
@given(st.data())
def test_dampers_take_energy_out(data):
    """With dampers on every joint energy never grows, and dE/dt = -sum c delta'**2 over a short time."""
    chain = data.draw(chains(damped=True))
    motion = simulate(chain, *state_of(data.draw, len(chain)), np.linspace(0, 3, 301), accuracy=1e-11)
    rates = np.diff(motion.omega, axis=1, prepend=0.0)
    loss = (chain.damping * rates**2).sum(axis=1)
    spent = np.concatenate([[0.0], np.cumsum((loss[1:] + loss[:-1]) / 2 * 0.01)])
    scale = max(1.0, float(abs(motion.energy).max()))

    assert (np.diff(motion.energy) <= 1e-12 * scale).all()
    assert abs(motion.energy[0] - motion.energy - spent).max() < 2e-2 * max(scale, loss.max())


@measured
@given(st.data())
def test_angular_momentum_about_the_support_is_conserved_without_gravity(data):
    """No gravity, no springs to the ground: the support pushes, and it has no lever about itself."""
    drawn = data.draw(chains(gravity=0))
    chain = CompiledChain(*drawn.rods[:, :2].T, drawn.rods[:, 6] / drawn.rods[:, 0],
                          np.sqrt(drawn.rods[:, 2] / drawn.rods[:, 0]), 0)
    motion = simulate(chain, *state_of(data.draw, len(chain)), [0, 1, 5], accuracy=1e-12)
    m, l, I, _, _, _, mH, _ = chain.rods.T
    x, y = motion.positions()
    theta, omega = motion.theta, motion.omega
    vx, vy = (np.concatenate([np.zeros((3, 1)), np.cumsum(part, axis=1)], axis=1)[:, :-1] for part in
              (l * np.cos(theta) * omega, -l * np.sin(theta) * omega))
    x, y = x[:, :-1], y[:, :-1]
    cx, cy = mH * np.sin(theta), mH * np.cos(theta)
    ux, uy = mH * np.cos(theta) * omega, -mH * np.sin(theta) * omega
    # clockwise, as theta: sum over rods of (y vx - x vy) for the near end, the centre, and the spin
    momentum = (m * (y * vx - x * vy) + (y * ux - x * uy) + (cy * vx - cx * vy) + I * omega).sum(axis=1)

    assert abs(momentum - momentum[0]).max() < 1e-11 * max(1.0, abs(momentum).max())


@measured
@given(st.data())
def test_a_motion_followed_back_returns_to_its_start(data):
    """Times that shrink: from the end to the beginning, also under a driven support."""
    free = data.draw(chains())
    chain = CompiledChain(*free.rods[:, :2].T, free.rods[:, 6] / free.rods[:, 0],
                          np.sqrt(free.rods[:, 2] / free.rods[:, 0]), 9.81,
                          lambda time: (np.cos(time), np.sin(2 * time)))
    state = state_of(data.draw, len(chain))
    there = simulate(chain, *state, [0, 1.5], accuracy=1e-11)
    back = simulate(chain, there.theta[-1], there.omega[-1], [1.5, 0], accuracy=1e-11)
    allowed = 100 * (there.error[-1] + back.error[-1]) + 1e-11

    assert abs(back.theta[-1] - state[0]).max() < allowed
    assert abs(back.omega[-1] - state[1]).max() < 30 * allowed


@measured
@given(st.data())
def test_reversed_rates_run_the_motion_backwards(data):
    """Without dampers, -omega at the end leads back to the start."""
    chain = data.draw(chains(most=3))
    theta, omega = state_of(data.draw, len(chain))
    there = simulate(chain, theta, omega, [0, 1.5], accuracy=1e-11)
    back = simulate(chain, there.theta[-1], -there.omega[-1], [0, 1.5], accuracy=1e-11)

    assert abs(back.theta[-1] - theta).max() < 100 * (there.error[-1] + back.error[-1]) + 1e-11


@measured
@given(st.data())
def test_upright_and_hanging_angles_describe_one_motion(data):
    """theta = pi - phi along the whole motion."""
    up = data.draw(chains(most=3))
    rods = (*up.rods[:, :2].T, up.rods[:, 6] / up.rods[:, 0], np.sqrt(up.rods[:, 2] / up.rods[:, 0]))
    theta, omega = state_of(data.draw, len(up))
    times = [0, 1.0, 2.0]
    one = simulate(CompiledChain(*rods), theta, omega, times, accuracy=1e-11)
    exact = [pi - Rational(x) for x in theta]
    other = simulate(CompiledChain(*rods, upright=False), exact, -omega, times, accuracy=1e-11)

    assert abs(one.theta + other.theta - np.pi).max() < one.error[-1] + other.error[-1] + 1e-14
    assert abs(one.energy - other.energy).max() < 1e-11 * one.chain.energy_scale


@pytest.mark.parametrize("springs", [None, [1, 2]])
@pytest.mark.parametrize("rates", [[1, 2], [0, 0]])
def test_energy_without_weight_is_measured_by_itself(springs, rates):
    """No gravity: drift is a fraction of the largest energy; 0 for a chain that rests."""
    chain = CompiledChain([1, 1], [1, 1], [0.5, 0.5], [0.6, 0.6], gravity=0, springs=springs)
    motion = simulate(chain, [0, 1], rates, [0, 1, 2])

    assert chain.energy_scale == 0 and motion.energy_drift < 1e-11
    changes = abs(motion.energy - motion.energy[0])
    assert abs(motion.energy_changes * abs(motion.energy).max() - changes).max() <= 1e-15 * changes.max()


def test_dense_output_passes_through_every_time():
    """trajectory.at(t) between the times is what a run with those times gives."""
    chain = CompiledChain([1, 2], [1, 1], [0.5, 0.5], [0.6, 0.6], 9.81, lambda time: (0, np.cos(5 * time)))
    times = np.linspace(0, 4, 41)
    sparse, full = simulate(chain, [2, 1], [0, 0], [0, 4], dense=True), simulate(chain, [2, 1], [0, 0], times)
    theta, omega = sparse.at(times)

    assert abs(theta - full.theta).max() < 1e-9 and abs(omega - full.omega).max() < 1e-8
    assert sparse.at(1.0)[0].shape == (2,)
    with pytest.raises(QuantityError, match="known from"):
        sparse.at(4.5)
    with pytest.raises(QuantityError, match="dense=True"):
        full.at(1.0)


def test_crossings_of_a_pendulum_are_half_periods_apart():
    """T = 4 sqrt(l/g) K(sin(theta_0/2)), from the arithmetic-geometric mean."""
    chain = CompiledChain([1], [1], [1], [1], 9.81, upright=False)
    events = {"down": Crossing(1, 0.0), "to the left": Crossing(1, 0.0, -1)}
    motion = simulate(chain, [2], [0], [0, 20], accuracy=1e-12, events=events)
    period = 2 * math.pi / math.sqrt(9.81) / float(mpmath.agm(1, mpmath.cos(1)))
    down, left = motion.events["down"], motion.events["to the left"]

    assert len(down) > 10 and abs(np.diff(down) - period / 2).max() < 1e-11
    assert abs(down[0] - period / 4) < 1e-12
    assert abs(left - down[::2]).max() == 0


def test_flips_are_counted_where_turns_change():
    """A fast pendulum passes the top once a turn."""
    chain = CompiledChain([1], [1], [1], [1], 1, upright=False)
    motion = simulate(chain, [0], [5], [0, 10], events=flips(chain))
    turns = motion.theta[-1, 0] / (2 * math.pi)

    assert len(motion.events["flip 1"]) == round(turns)
    assert (np.diff(motion.events["flip 1"]) > 0).all()
    assert motion.turns[-1, 0] == round(turns) and abs(motion.wrapped).max() <= math.pi


@pytest.mark.parametrize("method", ["RK45", "DOP853", "Radau", "LSODA"])
def test_other_methods_give_the_same_motion_and_say_how_wrong_they_are(method):
    """SciPy's solvers on the same chain, and on the symbolic equations."""
    scene = Scene([Rod.uniform(1, 1)] * 2, Support(eta=cos(3 * t) / 10), Rational("9.81"))
    times = np.linspace(0, 2, 5)
    mine = simulate(scene.compile(), [1, 2], [0, 0], times, accuracy=1e-12)
    for system in (scene.compile(), euler_lagrange(scene)):
        other = simulate(system, [1, 2], [0, 0], times, accuracy=1e-6, method=method)

        assert abs(other.theta - mine.theta).max() <= other.error[-1] < 1e-3


def test_heyoka_gives_the_same_motion_where_it_is_installed():
    """The recursion run on heyoka's expressions: a driven, damped triple rod."""
    pytest.importorskip("heyoka")
    drive = Support(sin(2 * t) / 5, cos(3 * t) / 10)
    scene = Scene([Rod.uniform(1, 1)] * 3, drive, 10, False, [Rational(1, 10)] * 3, None, t)
    mine, other = (simulate(scene.compile(), [1, 2, 1], [0, 0, 0], [0, 1, 2], accuracy=1e-10, method=method)
                   for method in ("taylor", "heyoka"))

    assert abs(mine.theta - other.theta).max() <= mine.error[-1] + other.error[-1] < 1e-9


@measured
@given(st.data())
def test_small_swings_follow_the_linear_model_to_third_order(data):
    """The linear model's error is stated, honest, and shrinks with the square of relative amplitude."""
    drawn = data.draw(chains(most=4))
    chain = CompiledChain(*drawn.rods[:, :2].T, drawn.rods[:, 6] / drawn.rods[:, 0],
                          np.sqrt(drawn.rods[:, 2] / drawn.rods[:, 0]), upright=False, springs=drawn.springs)
    theta, omega = state_of(data.draw, len(chain))
    assume((chain.rods[:, 6] + chain.rods[:, 1] * (chain.rods[::-1, 0].cumsum()[::-1] - chain.rods[:, 0]) > 0.05).all())
    times = np.linspace(0, 1, 11)
    errors = []
    for size in (1e-2, 1e-3):
        linear = simulate(chain, size * theta, size * omega, times, method="linear", accuracy=1e-3)
        true = simulate(chain, size * theta, size * omega, times, accuracy=1e-13)
        errors.append(abs(linear.theta - true.theta).max())
        assert errors[-1] <= linear.error[-1] and linear.method == "linear"

    assert errors[1] < 5e-3 * errors[0] + 1e-13


def test_the_linear_model_is_refused_where_it_does_not_hold():
    """A shaken support, dampers, no weight."""
    one = [1.0]
    for options in ({"support_acceleration": (1, 0)}, {"damping": [1]}, {"gravity": 0}):
        with pytest.raises(NotAnEquilibriumError, match="taylor"):
            simulate(CompiledChain(one, one, one, one, **options), [0.1], [0], [0, 1], method="linear")


@pytest.mark.parametrize(("chain", "allowed"), [
    (CompiledChain([1], [1], [0], [0.5], upright=False), 1e-13),
    (CompiledChain([1], [1], [-0.3], [0.5], upright=False), 1e-3),
    (CompiledChain([1, 1], [1, 1], [0.5, -0.3], [0.6, 0.6], upright=False), 1e-3),
    (CompiledChain([1], [1], [0.5], [0.6], springs=[-10], upright=False), 1e-3),
], ids=["balanced", "heavy behind the joint", "one of two", "a spring that pushes"])
def test_modes_without_a_restoring_force_grow_as_the_motion_does(chain, allowed):
    """t, or sinh and cosh, in place of sines: right but for the cube of the angle."""
    n = len(chain)
    linear, true = (simulate(chain, [1e-3] * n, [1e-3] * n, [0, 0.5, 0.7], 1e-3, method)
                    for method in ("linear", "taylor"))

    assert abs(linear.theta - true.theta).max() < allowed * abs(true.theta).max()
    assert abs(linear.omega - true.omega).max() < allowed * abs(true.omega).max()
    assert abs(linear.theta - true.theta).max() <= linear.error[-1] + true.error[-1]


def test_a_verdict_advises_what_the_method_takes():
    """Digits for Taylor steps, Taylor steps for the others."""
    for method in ("linear", "RK23"):
        verdict = simulate(CHAIN, [2, 2], [0, 0], [0, 4], 1e-5, method).verdict
        assert "is lost" in verdict and "method='taylor'" in verdict


def test_digits_are_whole_numbers_of_any_type():
    """numpy's and SymPy's too."""
    found = [simulate(CHAIN, [1, 2], [0, 0], [0, 1], digits=digits).theta[-1, 0] for digits in
             (20, np.int64(20), Rational(20))]

    assert found[0] == found[1] == found[2]


def test_chaos_is_reported():
    """Ten rods from 2 rad: float64 loses the motion before 10 s, and says when."""
    ones = [1.0] * 10
    motion = simulate(CompiledChain(ones, ones, ones, ones, upright=False), [2] * 10, [0] * 10, np.linspace(0, 20, 41))

    assert not motion.accurate
    assert 2 < motion.predictable_until < 15
    assert "is lost" in motion.verdict and "digits" in motion.verdict
    assert motion.energy_drift < 1e-12
    assert (np.diff(motion.error) >= 0).all()


def test_finer_accuracy_than_float64_takes_more_digits():
    """accuracy=1e-25 gives mpmath numbers; energy and repr still work."""
    chain = CompiledChain([1], [1], [1], [1], 9.81, upright=False)
    motion = simulate(chain, [Rational(1, 2)], [0], [0, 1], accuracy=1e-25)
    finer = simulate(chain, [Rational(1, 2)], [0], [0, 1], digits=40)

    assert motion.accurate and abs(motion.theta[-1, 0] - finer.theta[-1, 0]) < mpmath.mpf(10) ** -25
    assert "digits" in repr(motion) and motion.energy_drift < 1e-14


def test_rates_whose_series_leave_the_range_of_floats():
    """At 1e8 rad/s the 52nd Taylor coefficient is beyond 1e400; without gravity the angle is omega t."""
    chain = CompiledChain([1], [1], [1], [1], 0)
    motion = simulate(chain, [Rational(1, 2)], [10**8], [0, Rational(1, 10**8)], digits=45)
    shaken = CompiledChain([1], [1], [1], [1], 9)
    fast = simulate(shaken, [Rational(1, 2)], [10**8], [0, Rational(1, 10**8)], digits=45)

    assert abs(motion.theta[-1, 0] - mpmath.mpf("1.5")) < mpmath.mpf(10) ** -40
    assert 1e-17 < abs(fast.theta[-1, 0] - mpmath.mpf("1.5")) < 1e-15


def test_a_support_that_follows_any_smooth_function_of_time():
    """A function of numpy's functions has a Taylor series; one of math's has not, and SciPy still takes it."""
    ones = [1.0]
    smooth = CompiledChain(ones, ones, ones, ones, 9.81, lambda x: (np.exp(-x) * np.sin(x), np.sqrt(1 + x**2)))
    rough = CompiledChain(ones, ones, ones, ones, 9.81, lambda x: (math.exp(-x) * math.sin(x), math.hypot(1, x)))
    mine = simulate(smooth, [0.3], [0.1], [0, 2])
    assert mine.accurate
    with pytest.raises(DriveError, match="power series"):
        simulate(rough, [0.3], [0.1], [0, 2])
    fine = simulate(smooth, [0.3], [0.1], [0, 2], method="DOP853", accuracy=1e-8)
    assert abs(fine.theta - mine.theta).max() < 1e-7


def shaken(eta):
    """A hanging rod on a support that moves up and down by ``eta``, or accelerates so."""
    if callable(eta):
        return CompiledChain([1], [1], [1], [1], support_acceleration=lambda x: (0, eta(x)))
    return Scene([Rod.uniform(1, 1)], Support(eta=eta), 9.81, t=t, upright=False).compile()


@pytest.mark.parametrize(("eta", "start"), [(tanh(t), 360), (1 / cosh(t), 900), (sinh(t) / cosh(t)**2, 800)])
def test_a_support_that_has_come_to_rest_does_not_overflow(eta, start):
    """tanh and 1/cosh have recurrences of their own, in which nothing exceeds the function."""
    moving, still = (simulate(shaken(x), [1], [0], [start, start + 1]) for x in (eta, Rational(0)))

    assert abs(moving.theta - still.theta).max() < 1e-13


@pytest.mark.parametrize("digits", [None, 20])
@pytest.mark.parametrize("power", [2.0, np.float64(2), np.int64(2)])
def test_whole_numbers_are_integer_powers_of_whatever_type(power, digits):
    """s**2.0 at s = 0 is a polynomial."""
    mine, other = (simulate(shaken(lambda s, p=p: s**p), [1], [0], [0, 1], digits=digits) for p in (power, 2))

    assert (mine.theta == other.theta).all()


@pytest.mark.parametrize("digits", [None, 20])
@pytest.mark.parametrize(("eta", "times", "error", "words"), [
    (t**Rational(5, 2), [0, 1], DriveError, ["no Taylor series about t = 0", "DOP853"]),
    ((1 - t)**Rational(7, 2), [0, 2], DriveError, ["no finite real value at t = 2", "(1 - t)**(3/2)"]),
    (t * log(1 - t), [2, 3], DriveError, ["no finite real value at t = 2"]),
    (1 / (1 - t), [1, 2], DriveError, ["no finite real value at t = 1"]),
    (1 / (1 - t), [0, 2], QuantityError, ["cannot be followed beyond t = 0.9999", "step shrinks"]),
    ((-2)**t, [0, 1], DriveError, ["log(2) + I*pi", "not real"]),
    (lambda s: None, [0, 1], DriveError, ["support_acceleration", "t = 0", "None"]),
    (lambda s: 1 / s, [0, 1], DriveError, ["support_acceleration", "t = 0"]),
    (lambda s: np.log(s - 1), [0, 2], DriveError, ["support_acceleration", "t = 0"]),
    (lambda s: math.sqrt(1 - s), [0, 2], DriveError, ["support_acceleration", "t = 2", "ValueError"]),
    (lambda s: 1 / (1 - s)**3, [0, 2], QuantityError, ["cannot be followed beyond t = 0.9999"]),
])
def test_a_support_that_is_nowhere_or_not_smooth_is_refused(eta, times, error, words, digits):
    """With a sentence that names the drive and the time, in floats and in digits."""
    with pytest.raises(error) as refusal:
        simulate(shaken(eta), [1], [0], times, digits=digits)

    assert all(word in str(refusal.value) for word in words)


@pytest.mark.parametrize(("given", "same"), [
    (lambda s: np.cos(3 * s) / 3, lambda s: np.cos(3 * s) * Rational(1, 3)),
    (lambda s: s / np.int64(7) + np.divide(s, np.float64(0.1)), lambda s: s * Rational(1, 7) + s * (1 / Rational(0.1))),
    (lambda s: (2 + s)**0.3, lambda s: (2 + s)**Rational(0.3)),
    (lambda s: (2 + s)**-1.1, lambda s: (2 + s)**Rational(-1.1)),
])
def test_numbers_in_a_function_of_time_are_exact(given, same):
    """Divisors and exponents are the numbers that they are, in balls and with digits, as SymPy's are."""
    chains_ = [CompiledChain([1], [1], [1], [1], 1, lambda s, eta=eta: (0, eta(s))) for eta in (given, same)]
    with flint.ctx.workprec(200):
        one, other = (chain.acceleration(flint.arb(1), [flint.arb(1)], [flint.arb(0)])[0] for chain in chains_)
        assert one.overlaps(other) and one.rad() < 1e-55

    first, second = (simulate(chain, [1], [0], [0, 1], digits=40) for chain in chains_)
    assert first.error[-1] < 1e-38 and abs(first.theta[-1, 0] - second.theta[-1, 0]) <= first.error[-1]


@pytest.mark.parametrize("digits", [None, 20])
def test_places_and_energies_after_many_turns_lose_nothing(digits):
    """159 million turns: theta has eight digits behind the point, sines are of what is left of it."""
    chain = CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], 9.81, springs=[1, 0], upright=False)
    motion = simulate(chain, [0.3, 1e9], [0, 1], [0, 1, 2], digits=digits)
    x, _ = motion.positions()

    assert motion.energy_drift < 1e-14
    assert abs(np.diff(x[:, 1:]) - np.sin(motion.wrapped.astype(float))[:, 1:]).max() < 1e-15


def test_springs_count_whole_turns():
    """The energy of springs that are wound up, from the numbers of the motion and from its angles."""
    chain = CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], 9.81, springs=[1, 0.5], upright=False)
    motion = simulate(chain, [30, 100], [0, 1], [0, 1])

    assert abs(motion.energy - chain.energy(motion.theta.T, motion.omega.T)).max() < 1e-11 * abs(motion.energy[0])
    assert motion.energy[0] > 30**2 / 2 + 70**2 / 4 - 40


@pytest.mark.parametrize("drive", [lambda: (0, 1), lambda t, x: (0, 1), lambda *, t: (0, 1)])
def test_a_support_that_does_not_take_the_time_is_refused_at_once(drive):
    """Without an argument, with two, with one that must be named."""
    with pytest.raises(DriveError, match="does not take one argument: write it as lambda t"):
        CompiledChain([1], [1], [1], [1], support_acceleration=drive)


def test_accelerations_where_the_support_is_nowhere_are_refused():
    """A pole, the end of a root, and a logarithm that only the motion has; floats and mpmath numbers."""
    for eta, time in ((1 / (1 - t), 1), ((1 - t)**Rational(7, 2), 2), (t * log(1 - t), 2)):
        for number in (float, mpmath.mpf):
            with pytest.raises(DriveError, match=f"no finite real value at t = {time}"):
                shaken(eta).acceleration(number(time), [number(1)], [number(0)])


def test_only_rods_without_mass_snap_taut():
    """What overflows is told to take more digits."""
    with pytest.raises(QuantityError, match="digits=20") as refusal:
        simulate(CHAIN, [1, 2], [0, 1e200], [0, 1])
    assert "mass" not in str(refusal.value) and "nan" not in str(refusal.value)


TABLE = np.linspace(0, 3, 20)


@pytest.mark.parametrize("accuracy", [1e-5, 1e-8, 1e-12])
@pytest.mark.parametrize("drive", [math.cos, lambda x: np.interp(x, TABLE, np.sin(TABLE)), lambda x: abs(x - 0.5),
                                   lambda x: x % 1], ids=["math", "table", "kink", "jumps"])
def test_a_support_without_a_taylor_series_moves_by_the_methods_of_scipy(drive, accuracy):
    """And the error is that against the same solver with another tolerance: honest against a run cut where it jumps."""
    chain = CompiledChain([1, 1], [1, 1], [0.5, 0.5], [0.6, 0.6], support_acceleration=lambda x: (0, drive(x)))
    with pytest.raises(DriveError, match="DOP853"):
        simulate(chain, [1, 2], [0, 0], [0, 1.2])
    mine = simulate(chain, [1, 2], [0, 0], [0, 1.2], accuracy, "DOP853")
    state = [np.array([1.0, 2.0]), np.zeros(2)]
    for start, end in pairwise(sorted({0.0, 0.5, 1.0 - 1e-16, 1.2, *TABLE[TABLE < 1.2]})):
        cut = simulate(chain, *state, [start, end], 1e-11, "DOP853")
        state = [cut.theta[-1], cut.omega[-1]]

    assert abs(mine.theta[-1] - state[0]).max() <= mine.error[-1] + 1e-11
    assert mine.error[-1] < max(1e2 * accuracy, 1e-8)


@pytest.mark.parametrize("times", [[0, 0, 1, 1], [0, 0, 0], [1, 0, 0, -1, -1]])
def test_times_may_repeat_whatever_the_method(times):
    """The states of equal times are equal."""
    taylor, scipy = (simulate(CHAIN, [1, 2], [0, 0], times, method=method) for method in ("taylor", "DOP853"))

    assert abs(taylor.theta - scipy.theta).max() < 1e-10
    for motion in (taylor, scipy):
        assert (np.diff(motion.theta, axis=0)[np.diff(times) == 0] == 0).all()


@pytest.mark.parametrize("method", ["taylor", "RK45"])
def test_progress_is_reported_to_the_end(method, capsys):
    """The last time is reported, and the line on the screen is closed."""
    seen = []
    simulate(CHAIN, [1, 2], [0, 0], [0, 1], 1e-6, method, progress=seen.append)
    simulate(CHAIN, [1, 2], [0, 0], [0, 1], 1e-6, method, progress=True)

    assert seen[-1] == 1 and seen == sorted(seen)
    assert capsys.readouterr().err.endswith("t = 1 of 1 (100 %), 0 s\n")


def test_angles_of_a_million_lose_what_their_float_does_not_hold_and_no_more():
    """theta0 = 1e6 as a float and the same reduced by hand with 30 digits are one motion."""
    chain = CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], upright=False)
    reduced = Rational(10**6) - 2 * pi * round(10**6 / (2 * math.pi))
    far = simulate(chain, [1e6, 1e6], [0, 0], [0, 3])
    near = simulate(chain, [reduced, reduced], [0, 0], [0, 3])

    assert abs(far.wrapped - near.wrapped).max() < 1e-13


@pytest.mark.parametrize("digits", [None, 20, 30, 35], ids=["float64", "pairs", "more pairs", "balls"])
@pytest.mark.parametrize("halves", [[1], [-3], [1, 0], [1, 2, -1]], ids=str)
def test_whole_half_turns_are_exact_so_that_an_equilibrium_is_never_left(halves, digits):
    """Rods at rest upon each other, upwards and downwards; from 1e-30 rad they would fall in 25 s."""
    n = len(halves)
    chain = CompiledChain([1.0, 2.0, 1.0][:n], [1.0, 0.7, 0.1][:n], [0.5, 0.3, 0.1][:n], [0.6, 0.4, 0.1][:n],
                          upright=False)
    motion = simulate(chain, [half * pi for half in halves], [0] * n, [0, 40, 50], digits=digits, events=flips(chain))

    assert not motion.omega.any() and motion.accurate and not any(map(len, motion.events.values()))
    with mpmath.workdps(digits or 15):
        unit = mpmath.mpf(10) ** -(digits or 15)
        assert all(abs(x - half * mpmath.pi) < 10 * unit for row in motion.theta for x, half in zip(row, halves))


@pytest.mark.parametrize("end", [25, 28, 31, 34])
@pytest.mark.parametrize("digits", [None, 20, 30])
def test_an_equilibrium_that_is_no_number_of_half_turns_is_left_by_rounding_and_the_estimate_says_so(end, digits):
    """A rod against a sideways pull falls, turns, and is back near its place, where nothing is seen of that."""
    chain = CompiledChain([1], [1], [0.5], [0.6], gravity=0, support_acceleration=(-9.81, 0))
    motion = simulate(chain, [-pi / 2], [0], [0, end], digits=digits)

    assert abs(float(motion.theta[-1, 0]) + math.pi / 2) <= motion.error[-1]


@pytest.mark.parametrize("rod, theta0, end, digits", [
    ((0.7673225739657772, 0.8692116708822373, 0.8758358274106289, 0.9634194101516919), 2.3450381905984994, 1000, None),
    ((0.740480100555906, 0.8848321912221966, 0.34460444218245867, 0.6984715483327355), 2.907975061590567, 1000, None),
    ((0.6548679485592322, 0.36775492891605777, 0.1122347703099625, 0.18433368246336865), 2.782156803979176, 1000, None),
    ((0.15438475760381065, 0.2931863123828503, 0.4758882872873448, 0.6414132081156557), 3.0506796052167156, 10, 31),
])
def test_the_estimate_for_a_single_rod_sees_the_rounding_of_its_data(rod, theta0, end, digits):
    """theta = 2 asin(k cd(wt, k)), w**2 = g H/R**2: to a single rod only the ratio of m H and I matters."""
    m, l, H, R = rod
    motion = simulate(CompiledChain([m], [l], [H], [R], upright=False), [theta0], [0], [0, end], digits=digits)
    with mpmath.workdps(50):
        k, w = mpmath.sin(mpmath.mpf(theta0) / 2), mpmath.sqrt(mpmath.mpf(9.81) * H) / R
        true = 2 * mpmath.asin(k * mpmath.ellipfun("cd", w * end, k=k))

        assert abs(mpmath.mpf(motion.wrapped[-1, 0]) - true) <= motion.error[-1]


@pytest.mark.parametrize("mass", [0.822603788636584, 0.822603788637, 0.8226037886387])
def test_rounding_takes_a_single_rod_no_energy_at_every_step(mass):
    """7000 steps move it to and fro within 3e-14 of m g H; whatever I and 1/I do not multiply to 1 by, is no torque."""
    chain = CompiledChain([mass], [1], [0.17624381837171277], [0.19386820020888407], upright=False)
    motion = simulate(chain, [2.5], [0], [0, 333], accuracy=1e-9)

    assert abs(motion.energy[1] - motion.energy[0]) < 3e-14 * chain.rods[0, 6] * 9.81


def test_a_constant_support_that_nearly_holds_the_weight_costs_no_digits():
    """1e-10 m/s**2 is left of the weight, exactly; a float of the difference of two floats has seven digits of it."""
    left = Rational(1, 10**10)
    chain = CompiledChain([1], [1], [0.5], [0.6], Rational(1, 3), (0, left - Rational(1, 3)))
    rough, fine = (simulate(chain, [0.5], [0], [0, 1e5], digits=digits) for digits in (None, 25))

    assert abs(float(rough.theta[-1, 0] - fine.theta[-1, 0])) <= rough.error[-1] < 1e-11


@pytest.mark.parametrize("g", [Rational(3, 37), Rational(1, 3)], ids=str)
def test_the_estimate_sees_the_rounding_of_weight_and_waves_that_nearly_cancel(g):
    """1e-9 of the weight is left of it and of a wave so slow that it is all but constant."""
    w = Rational(1, 10**9)
    eta = g * cos(w * t) / w**2 * (1 - Rational(1, 10**9))
    chain = Scene([Rod(1, 1, Rational(1, 2), Rational(3, 5))], Support(0, eta), g, t=t).compile()
    rough, fine = (simulate(chain, [0.5], [0], [0, 1e5], digits=digits) for digits in (None, 25))

    assert abs(float(rough.theta[-1, 0] - fine.theta[-1, 0])) <= rough.error[-1]


def test_an_equilibrium_between_weight_and_a_sideways_pull_is_left_by_rounding_and_the_estimate_says_so():
    """At 45 degrees, where both are alike; times at which a rod that fell is back on its place."""
    chain = CompiledChain([1], [1], [0.5], [0.6], gravity=9.81, support_acceleration=(-9.81, 0))
    for end in (13, 16, 40):
        motion = simulate(chain, [-pi / 4], [0], [0, end])
        assert abs(motion.theta[-1, 0] + math.pi / 4) <= motion.error[-1]


@pytest.mark.parametrize("digits", [20, 35], ids=["pairs", "balls"])
def test_springs_know_of_half_turns(digits):
    """Joints bent by half a turn and more, all of it taken out before rounding, bend as they do in float64."""
    chain = CompiledChain([1, 2], [1, 1], [0.5, 0.3], [0.6, 0.4], springs=[2, 3], upright=False)
    rough, fine = (simulate(chain, [pi, 4 * pi], [0.1, 0], [0, 0.5, 1], digits=given) for given in (None, digits))

    assert (abs(rough.theta - fine.theta.astype(float)).max(axis=1) <= rough.error).all() and rough.error[-1] < 1e-10


def test_progress_is_reported_in_order():
    """progress may be a function of the time reached."""
    seen = []
    ones = [1.0] * 3
    simulate(CompiledChain(ones, ones, ones, ones, upright=False), [2] * 3, [0] * 3, np.linspace(0, 5, 6),
             progress=seen.append)

    assert seen and all(0 <= x <= 5.5 for x in seen)


def test_a_trajectory_becomes_a_dataset_and_pictures(tmp_path):
    """to_xarray, plot, animate to GIF and HTML."""
    xarray = pytest.importorskip("xarray")
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("Agg")
    ones = [1.0] * 2
    motion = simulate(CompiledChain(ones, ones, ones, ones, upright=False), [2, 2], [0, 0], np.linspace(0, 1, 21))
    data = motion.to_xarray()
    for name in ("film.gif", "film.html"):
        motion.animate(tmp_path / name, frames=5)
    figure = motion.plot()
    figure.savefig(tmp_path / "picture.png")
    pyplot.close(figure)

    assert isinstance(data, xarray.Dataset) and data.theta.sel(rod=2).shape == (21,)
    assert all((tmp_path / name).stat().st_size > 1000 for name in ("film.gif", "film.html", "picture.png"))
    with pytest.raises(QuantityError, match=r"\.gif or \.html"):
        motion.animate(tmp_path / "film.avi")


CHAIN = CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], upright=False)
SWING = simulate(CHAIN, [1, 1], [0, 0], np.linspace(0, 1, 21))


@given(st.fractions(Rational(1, 50), 10**6), st.integers(1, 500))
def test_a_film_runs_the_seconds_asked_to_half_a_frame(seconds, most):
    """Frames last whole hundredths of a second, which GIF counts in, and two at least: browsers slow down less."""
    count, each = timing(seconds, most)

    assert 1 <= count <= most and each % 10 == 0 and each >= 20
    assert abs(count * each - 1000 * seconds) <= each / 2


@pytest.mark.parametrize(("seconds", "frames", "length"), [(None, 5, 1000), (1, 3, 1020), (100, 4, 100_000),
                                                           (0.1, 150, 100)])
def test_written_films_last_as_long_as_asked(tmp_path, seconds, frames, length):
    """The times written in the files; the ending may be in capitals."""
    pytest.importorskip("matplotlib.pyplot").switch_backend("Agg")
    image = pytest.importorskip("PIL.Image")
    SWING.animate(tmp_path / "film.GIF", seconds, frames)
    SWING.animate(tmp_path / "film.html", seconds, frames)
    page, total = (tmp_path / "film.html").read_text(), 0
    with image.open(tmp_path / "film.GIF") as film:
        for k in range(film.n_frames):
            film.seek(k)
            total += film.info["duration"]
    interval = re.search(r"new Animation\(frames, img_id, slider_id, ([0-9.]+),", page)

    assert total == length == float(interval[1]) * len(re.findall(r"frames\[\d+\] = ", page))


@pytest.mark.parametrize(("arguments", "words"), [
    ({"seconds": 0}, ["0.02 s at least", "is 0"]),
    ({"seconds": -1}, ["-1"]),
    ({"seconds": math.nan}, ["nan"]),
    ({"seconds": symbols("x")}, ["x"]),
    ({"frames": 0}, ["frames is 0", "from 1 on"]),
    ({"frames": -1}, ["frames is -1"]),
    ({"frames": 2.5}, ["2.5"]),
    ({"trail": -3}, ["trail is -3", "from 0 on"]),
    ({"trail": True}, ["True"]),
    ({"path": 5}, [".gif or .html", "5"]),
])
def test_what_makes_no_film_is_refused(arguments, words):
    """Before anything is drawn."""
    with pytest.raises(QuantityError) as refusal:
        SWING.animate(**arguments)

    assert all(word in str(refusal.value) for word in words)


def test_a_motion_of_one_time_is_no_film():
    """It has a state, and no motion."""
    with pytest.raises(QuantityError, match=r"single time 0\.0"):
        simulate(CHAIN, [1, 1], [0, 0], [0]).animate()


def test_one_axes_are_not_the_two_of_a_picture():
    """Angles are drawn above their error."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("Agg")
    figure, axes = pyplot.subplots()
    for wrong in (axes, [axes], 3):
        with pytest.raises(QuantityError, match="a pair of axes"):
            SWING.plot(wrong)
    pyplot.close(figure)


@pytest.mark.parametrize(("package", "ask"), [
    ("matplotlib", SWING.plot), ("matplotlib", SWING.animate), ("xarray", SWING.to_xarray),
    ("scipy", lambda: simulate(SWING.chain, [1, 2], [0, 0], [0, 1], method="DOP853")),
    ("heyoka", lambda: simulate(SWING.chain, [1, 2], [0, 0], [0, 1], method="heyoka"))])
def test_a_package_that_is_not_installed_is_named(monkeypatch, package, ask):
    """With what to do; it is an ImportError too."""
    hide(monkeypatch, package)
    with pytest.raises(NotInstalledError, match=f"needs {package}, which is not installed: pip install {package}"):
        ask()

    assert issubclass(NotInstalledError, ImportError)


@pytest.mark.parametrize(("arguments", "options", "error", "words"), [
    ((CHAIN, [1], [0, 0], [0, 1]), {}, SceneError, ["2 rods", "theta0"]),
    ((CHAIN, "12", [0, 0], [0, 1]), {}, TextError, ["theta0"]),
    ((CHAIN, ["1", 1], [0, 0], [0, 1]), {}, TextError, ["theta0[0]"]),
    ((CHAIN, [symbols("x"), 1], [0, 0], [0, 1]), {}, QuantityError, ["x", "number"]),
    ((CHAIN, [float("nan"), 1], [0, 0], [0, 1]), {}, QuantityError, ["finite"]),
    ((CHAIN, [1, 1], [0, 0], [0, 2, 1]), {}, SceneError, ["[0.0, 2.0, 1.0]", "order"]),
    ((CHAIN, [1, 1], [0, 0], []), {}, SceneError, ["at least one"]),
    ((CHAIN, [1, 1], [0, 0], 3), {}, SceneError, ["list of times"]),
    ((CHAIN, [1, 1], [0, 0], ["0", "1"]), {}, TextError, ["times[0]"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"method": "euler"}, SceneError, ["'euler'", "taylor"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"accuracy": 0}, QuantityError, ["positive"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"accuracy": Rational(1, 10**400)}, QuantityError, ["1e-400", "digits=405"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"accuracy": symbols("x")}, QuantityError, ["x", "positive number"]),
    ((CHAIN, np.array(1.0), [0, 0], [0, 1]), {}, SceneError, ["2 rods", "theta0"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"digits": 20, "method": "DOP853"}, SceneError, ["20 digits", "taylor"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"digits": True}, QuantityError, ["True"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"digits": 0}, QuantityError, ["digits"]),
    ((CompiledChain([1, 0, 1], *[[1] * 3] * 3, upright=False), [1] * 3, [0] * 3, [0, 1]), {"method": "linear"},
     SceneError, ["1e-90", "taylor"]),
    ((CompiledChain([1], [1], [-0.5], [0.6], upright=False), [1], [0], [0, 999]), {"method": "linear"}, QuantityError,
     ["grows as exp(", "taylor"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"digits": 30, "method": "RK45"}, SceneError, ["float64"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"dense": True, "method": "RK45"}, SceneError, ["Taylor"]),
    ((CHAIN, [1, 1], [0, 0], [0, 1]), {"events": {"x": Crossing(3, 0.0)}}, SceneError, ["rods 1 to 2"]),
    ((7, [1, 1], [0, 0], [0, 1]), {}, NotASceneError, ["CompiledChain"]),
    (("chain", [1, 1], [0, 0], [0, 1]), {}, TextError, ["'chain'"]),
])
def test_what_cannot_be_simulated_is_refused(arguments, options, error, words):
    """A named error with the claim, the value and the remedy; text is never evaluated."""
    with pytest.raises(error) as refusal:
        simulate(*arguments, **options)

    assert all(word in str(refusal.value) for word in words)


def test_the_verdict_on_small_swings_names_what_is_enough():
    """Taylor steps in float64 first: the error of the linear model is not one of rounding."""
    linear, taylor = (simulate(CHAIN, [0.1, 0.1], [0, 0], [0, 1], method=method) for method in ("linear", "taylor"))

    assert "method='taylor', and digits=40 with it where that is not enough" in linear.verdict
    assert taylor.accurate and not linear.accurate
