"""Chains where digits are lost: masses 1e12 apart, rods in line, huge rates and angles, a thousand rods, long times."""

import pickle

import flint
import mpmath
import numpy as np
import pytest
from sympy import Rational, Symbol, cos, exp, pi, sin, sqrt

from lagrangian import (
    CompiledChain,
    Ensemble,
    QuantityError,
    Rod,
    Scene,
    SceneError,
    Support,
    chain as chains,
    redone,
    simulate,
)
from lagrangian.digits import integrate_digits
from lagrangian.floats import split
from lagrangian.stepper import move


def arb(x):
    """A float as the exact number it is."""
    return flint.arb(flint.fmpq(*float(x).as_integer_ratio()))


def dense(m, l, H, R, g, theta, omega, damping=None, springs=None):
    """M(theta)^-1 f in balls of 300 digits, formed and solved densely; angles from the upward vertical."""
    with flint.ctx.workdps(300):
        n = len(m)
        m, l, H, R, theta, omega = ([arb(x) for x in part] for part in (m, l, H, R, theta, omega))
        beyond = [sum(m[i + 1:], flint.arb(0)) for i in range(n)]
        p = [m[i] * H[i] + l[i] * beyond[i] for i in range(n)]
        rows = [[l[min(i, j)] * p[max(i, j)] * (theta[i] - theta[j]).cos() if i != j else
                 m[i] * R[i] ** 2 + l[i] ** 2 * beyond[i] for j in range(n)] for i in range(n)]
        f = [p[i] * arb(g) * theta[i].sin() - sum((l[min(i, j)] * p[max(i, j)] * (theta[i] - theta[j]).sin()
                                                   * omega[j] ** 2 for j in range(n)), flint.arb(0)) for i in range(n)]
        for constants, angle in ((damping, omega), (springs, theta)):
            for i, constant in enumerate(() if constants is None else constants):
                moment = arb(constant) * (angle[i] - angle[i - 1] if i else angle[i])
                f[i] -= moment
                if i:
                    f[i - 1] += moment
        solved = flint.arb_mat(rows).solve(flint.arb_mat([[x] for x in f]))
        return [solved[i, 0] for i in range(n)]


def error(mine, exact):
    """The largest difference over the largest entry."""
    with flint.ctx.workdps(300):
        scale = max(float(abs(x).mid().str(20, radius=False)) for x in exact)
        gaps = [abs(arb(x) - y) for x, y in zip(mine, exact)]
        assert all(float(y.rad()) < 1e-30 * max(scale, 1e-100) for y in exact)
        return max(float(gap.mid().str(20, radius=False)) for gap in gaps) / max(scale, 1e-100)


def hard_chain(kind, n, rng):
    """Masses, lengths, centres, gyrations, angles and rates of one kind of difficulty."""
    m, l = rng.uniform(0.5, 2, n), rng.uniform(0.5, 2, n)
    theta, omega = rng.uniform(-3, 3, n), rng.normal(size=n)
    if kind == "a heavy end":
        m[-1] = 1e12
    elif kind == "a light end":
        m[-1] = 1e-12
    elif kind == "masses in turn":
        m[::2] *= 1e12
    elif kind == "random masses":
        m = 10.0 ** rng.uniform(-12, 12, n)
    elif kind == "lengths from 1e6 to 1e-6":
        l = 10.0 ** np.linspace(6, -6, n)
    elif kind == "random lengths":
        l = 10.0 ** rng.uniform(-6, 6, n)
    elif kind == "aligned to 1e-9":
        theta = rng.uniform(-3, 3) + 1e-9 * rng.normal(size=n)
        m[::2] *= 1e12
    elif kind == "right angles":
        theta = np.arange(n) * np.pi / 2
    elif kind == "rates of 1e8":
        omega = 1e8 * rng.normal(size=n)
    H = rng.uniform(0.0, 1.0, n) * l
    return m, l, H, np.sqrt(H**2 + rng.uniform(0.02, 0.3, n) * l**2), theta, omega


def sprung_chain(seed):
    """A chain with stiff springs and dampers, that in every other state all but balance each other."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 9))
    m, l, H, R, theta, omega = hard_chain("nothing" if seed % 2 else "random lengths", n, rng)
    damping, springs = 10.0 ** rng.uniform(-3, 5, (2, n))
    if seed % 4 < 2:
        damping, springs = np.full(n, damping[0]), np.full(n, springs[0])
        omega = -theta * (springs[0] / damping[0]) * (1 + 1e-8 * rng.normal(size=n))
    return (m, l, H, R), (theta, omega), (damping, springs)


@pytest.mark.parametrize("seed", range(60))
def test_springs_that_balance_dampers_lose_no_digits(seed):
    """4e-15 of the largest theta'', alone and in a batch."""
    rods, (theta, omega), (damping, springs) = sprung_chain(seed)
    chain = CompiledChain(*rods, gravity=9.81, damping=damping, springs=springs)
    exact = dense(*rods, 9.81, theta, omega, damping, springs)
    batch = chain.acceleration(0, np.stack([theta] * 3, axis=1), np.stack([omega] * 3, axis=1))

    assert error(chain.acceleration(0, theta, omega), exact) < 4e-15
    assert error(batch[:, 1], exact) < 4e-15


def test_even_rods_whose_joints_balance_are_asked_for_their_doubt_in_a_batch():
    """The slowest of 3000 states of one rod, whose damper, spring and weight cancel: 1e-12 if nobody asks."""
    rng = np.random.default_rng(0)
    rods, joints = ([1.0], [1.0], [0.5], [0.6]), ([2.0], [3.0])
    theta, omega = rng.uniform(-9, 9, (1, 3000)), rng.normal(size=(1, 3000))
    found = CompiledChain(*rods, damping=joints[0], springs=joints[1]).acceleration(0, theta, omega)
    for j in abs(found[0]).argsort()[:10]:
        assert error(found[:, j], dense(*rods, 9.81, theta[:, j], omega[:, j], *joints)) < 4e-15


def balanced_chain(seed):
    """A slow chain whose springs all but carry its weight."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 7))
    kind = ["nothing", "random lengths", "random masses"][seed % 3]
    m, l, H, R, theta, omega = hard_chain(kind, n, rng)
    omega *= 10.0 ** rng.uniform(-9, 0)
    weights = 9.81 * (m * H + l * (m[::-1].cumsum()[::-1] - m)) * np.sin(theta)
    springs = weights[::-1].cumsum()[::-1] / np.diff(theta, prepend=0.0)
    return (m, l, H, R), (theta, omega), springs * (1 + rng.normal(size=n) * 10.0 ** rng.uniform(-12, 0))


@pytest.mark.parametrize("seed", [*range(40), 721, 1426, 2389, 2821])
def test_springs_that_carry_the_weight_lose_no_digits(seed):
    """The last four are wrong by 4e-15 to 7e-15 if their doubt leaves out the torques."""
    rods, state, springs = balanced_chain(seed)

    found = CompiledChain(*rods, springs=springs).acceleration(0, *state)
    assert error(found, dense(*rods, 9.81, *state, None, springs)) < 4e-15


def moved(chain, exact):
    """The largest change of the exact answer over eight ways to go to next floats."""
    largest = 0.0
    for turn in range(8):
        up = np.where(np.random.default_rng(turn).integers(0, 2, (6, len(chain[0]))), np.inf, -np.inf)
        m, l, H, R, theta, omega = np.nextafter(chain, up)
        answer = dense(m, l, H, np.maximum(R, H), 9.81, theta, omega)
        largest = max(largest, error([float(x.mid()) for x in answer], exact))
    return largest


KINDS = ["a heavy end", "a light end", "masses in turn", "random masses", "lengths from 1e6 to 1e-6", "random lengths",
         "aligned to 1e-9", "right angles", "rates of 1e8", "nothing"]


@pytest.mark.parametrize("gravity", [9.81, 0.0])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("n", [1, 2, 3, 6, 30])
def test_accelerations_are_within_4e15_of_300_digits(n, kind, gravity):
    """Rods and bobs, each kind of difficulty: the largest error over the largest acceleration."""
    rng = np.random.default_rng(n)
    for _ in range(3):
        m, l, H, R, theta, omega = hard_chain(kind, n, rng)
        rods, bobs = CompiledChain(m, l, H, R, gravity), CompiledChain(m, l, l, l, gravity)

        assert error(rods.acceleration(0, theta, omega), dense(m, l, H, R, gravity, theta, omega)) < 4e-15
        exact = dense(m, l, l, l, gravity, theta, omega)
        assert bobs.model == "bobs" and error(bobs.acceleration(0, theta, omega), exact) < 4e-15
        many = bobs.acceleration(0, np.tile(theta[:, None], 5), np.tile(omega[:, None], 5))
        assert error(many[:, 3], exact) < 4e-15


def seeded(seed):
    """One of the random hard chains of benchmarks/hard_chains.py."""
    rng = np.random.default_rng(seed)
    return hard_chain(KINDS[seed % len(KINDS)], int(rng.integers(1, 13)), rng)


def test_random_hard_chains_are_within_4e15_where_joints_pull_against_each_other_too():
    """A thousand chains, the same on every run, rods and in turn the same rods as bobs; hardly one loses a digit."""
    losses = []
    for seed in range(1000):
        m, l, H, R, *state = seeded(seed)
        H, R = (H, R) if seed % 3 else (l, l)
        losses.append(error(CompiledChain(m, l, H, R).acceleration(0, *state), dense(m, l, H, R, 9.81, *state)))

    assert max(losses) < 4e-15 and np.median(losses) < 2e-16 and np.quantile(losses, 0.99) < 2e-15


WORST_RODS = [3620, 4134, 964, 3264, 5594, 5363, 224, 5474, 5224, 2514, 4660, 3530, 1720, 2185, 4383]
WORST_BOBS = [4255, 1384, 636, 5906, 165, 4825, 1926]


@pytest.mark.parametrize(("seed", "bobs"), [*((x, False) for x in WORST_RODS), *((x, True) for x in WORST_BOBS)])
@pytest.mark.parametrize("has_numba", [True, False])
def test_the_chains_that_float64_loses_are_right_alone_and_among_others(seed, bobs, has_numba, monkeypatch):
    """The worst seeds of the recursion in float64 alone, 4e-15 to 2e-13 from the truth; with and without numba."""
    if not has_numba:
        for module in (chains, redone):
            monkeypatch.setattr(module, "has_numba", lambda: False)
    m, l, H, R, theta, omega = seeded(seed)
    H, R = (l, l) if bobs else (H, R)
    chain, exact = CompiledChain(m, l, H, R), dense(m, l, H, R, 9.81, theta, omega)
    many = chain.acceleration(0, np.stack([0 * theta, theta], axis=1), np.stack([0 * omega, omega], axis=1))

    assert error(chain.acceleration(0, theta, omega), exact) < 4e-15
    assert error(many[:, 1], exact) < 4e-15


def test_two_ordinary_rods_whose_accelerations_nearly_vanish_keep_their_digits():
    """Rates of 1e8, the inertia beyond the joint nearly the same in all directions: float64 alone is off by 1e-14."""
    m, l, H, R, theta, omega = hard_chain("rates of 1e8", 2, skipped(12359))

    assert error(CompiledChain(m, l, H, R).acceleration(0, theta, omega), dense(m, l, H, R, 9.81, theta, omega)) < 4e-15


def skipped(seed):
    """A generator that has given one number."""
    rng = np.random.default_rng(seed)
    rng.integers(1, 13)
    return rng


def test_a_chain_that_was_in_doubt_still_travels():
    """Pickled after its constants were formed anew, it gives the same accelerations."""
    m, l, H, R, *state = seeded(3620)
    chain = CompiledChain(m, l, H, R)
    found = chain.acceleration(0, *state)

    assert (pickle.loads(pickle.dumps(chain)).acceleration(0, *state) == found).all()


@pytest.mark.parametrize("size", [1.0, 1e7])
def test_dampers_and_springs_are_formed_anew_in_pairs(size):
    """Angles small and beyond 1e6, in pairs and in mpmath: equal to the recursion at 60 digits."""
    m, l, H, R, theta, omega = seeded(3620)
    joints = {"damping": np.full(len(m), 0.3), "springs": np.linspace(1, 2, len(m))}
    chain = CompiledChain(m, l, H, R, **joints)
    context = mpmath.mp.clone()
    context.dps = 60
    theta = theta + size - 1
    exact = chain.acceleration(0, *([context.mpf(float(x)) for x in part] for part in (theta, omega)))
    again = chain._again(0, theta[:, None], omega[:, None])[:, 0]

    scale = max(abs(x) for x in exact)
    assert max(abs(context.mpf(float(x)) - y) for x, y in zip(again, exact)) < 2e-16 * scale


def test_sines_in_pairs_have_thirty_digits():
    """In all quarters, next to their borders and at 1e5 rad, through one rod: theta'' = g m H sin(theta) / I."""
    theta = np.concatenate([np.linspace(-7, 7, 29), np.arange(-5, 6) * np.pi / 2, [1e5, -12345.678, 1e-9]])
    chain = CompiledChain([1.0], [1.0], [1.0], [1.0], 1.0, model="rods")
    with mpmath.workdps(60):
        exact = np.array([float(mpmath.sin(mpmath.mpf(float(x)))) for x in theta])

    assert (chain._again(0, theta[None], 0 * theta[None])[0] == exact).all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_thousand_rods_keep_their_digits(kind):
    """n = 1000 against the recursion on 60 digits, which the dense equations have confirmed for short chains."""
    m, l, H, R, theta, omega = hard_chain(kind, 1000, np.random.default_rng(7))
    context = mpmath.mp.clone()
    context.dps = 60
    for chain in (CompiledChain(m, l, H, R), CompiledChain(m, l, l, l)):
        exact = chain.acceleration(0, *([context.mpf(float(x)) for x in part] for part in (theta, omega)))
        mine = chain.acceleration(0, theta, omega)
        scale = max(abs(x) for x in exact)

        assert max(abs(context.mpf(float(x)) - y) for x, y in zip(mine, exact)) < 4e-15 * scale


def test_a_million_rods_have_an_acceleration():
    """n = 1e6, and the sum of moments about the support agrees with the equation of rod 1's whole chain."""
    n = 10**6
    rng = np.random.default_rng(1)
    ones, theta = np.ones(n), rng.uniform(-0.1, 0.1, n)
    chain = CompiledChain(ones, ones / n, ones / (2 * n), ones / (np.sqrt(3) * n))
    out = chain.acceleration(0, theta, np.zeros(n))

    assert np.isfinite(out).all() and out.shape == (n,)


def test_huge_angles_lose_nothing_of_the_float_they_are():
    """Angles of 7e5 to 1e15 beside small ones, taken as exact numbers."""
    for size in (7e5, 1e6, 1e9, 1e15):
        theta = np.array([size + 0.1, 0.3, -size, 1.7])
        ones = np.ones(4)
        exact = dense(ones, ones, ones / 2, ones * 0.6, 9.81, theta, ones)

        assert error(CompiledChain(ones, ones, ones / 2, ones * 0.6).acceleration(0, theta, ones), exact) < 4e-15


@pytest.mark.parametrize("massless", [[0], [1], [3], [1, 2], [0, 3]])
def test_rods_without_mass_are_the_limit_of_ever_lighter_rods(massless):
    """Zero masses, bobs and rods, ends and middles: equal to masses of 1e-100 at 300 digits."""
    rng = np.random.default_rng(3)
    for bobs in (True, False):
        m, l, H, R, theta, omega = hard_chain("nothing", 4, rng)
        H, R = (l, l) if bobs else (H, R)
        light = m.copy()
        m[massless], light[massless] = 0.0, 1e-100
        exact = dense(light, l, H, R, 9.81, theta, omega)

        assert error(CompiledChain(m, l, H, R).acceleration(0, theta, omega), exact) < 4e-15


@pytest.mark.parametrize("m", [[1, 0, 1], [1e6, 0, 1e-6], [1e-3, 0, 0, 1e3]])
def test_rods_without_mass_that_fold_back_are_the_limit_too(m):
    """Folded to the 1e-16 that pi lacks as a float, one chain, many and an ensemble: masses of 1e-110 at 300 digits."""
    n, m = len(m), np.array(m, dtype=float)
    theta, omega, ones = np.pi * (np.arange(n) % 2), np.arange(1.0, n + 1), np.ones(n)
    exact = dense(np.where(m == 0, 1e-110, m), ones, ones, ones, 9.81, theta, omega)
    chain = CompiledChain(m, ones, ones, ones)

    assert error(chain.acceleration(0, theta, omega), exact) < 4e-15
    assert error(chain.acceleration(0, theta[:, None], omega[:, None])[:, 0], exact) < 4e-15
    assert error(Ensemble([m], ones, ones, ones).acceleration(0, [theta], [omega])[0], exact) < 4e-15


@pytest.mark.parametrize("theta", [[0.3, 0.3, 0.3 + np.pi, 0.3 + np.pi], [0.3 + np.pi, 0.3, 0.3 + np.pi, 0.3]])
def test_a_torque_on_rods_without_mass_that_fold_back_is_answered_or_refused(theta):
    """Where angles are folded exactly there is no limit; where pi as a float leaves 1e-16 there is one, at 1e31."""
    m, ones, springs = np.array([0.0, 1, 1, 1]), np.ones(4), np.array([0, 0, 1.0, 1.5])
    theta, omega = np.array(theta), np.array([0.0, 0.3, 0.2, 0.6])
    chain = CompiledChain(m, ones, ones, ones, springs=springs)
    ensemble = Ensemble([ones, m], ones, ones, ones, springs=springs)
    exact, lighter = (dense(np.where(m == 0, light, m), ones, ones, ones, 9.81, theta, omega, springs=springs)
                      for light in (1e-110, 1e-120))
    if abs(float(exact[0])) < 1e60:
        assert error([float(x) for x in lighter], exact) < 1e-15
        assert error(chain.acceleration(0, theta, omega), exact) < 4e-15
        assert error(ensemble.acceleration(0, [theta] * 2, [omega] * 2)[1], exact) < 4e-15
        return
    assert abs(float(lighter[0])) > 1e110
    for number in (float, mpmath.mpf, flint.arb):
        state = [np.array([number(x) for x in part]) for part in (theta, omega)]
        with pytest.raises(QuantityError, match="no limit at t = 0.*without mass lie folded"):
            chain.acceleration(0, *state)
        with pytest.raises(QuantityError, match="no limit at t = 0"):
            ensemble.acceleration(0, *([x, x] for x in state))


@pytest.mark.parametrize("H", [-0.9, -1.001, -1.0000001, -1.00000000001, -1.0])
@pytest.mark.parametrize("folded", [0.0, 1.5])
def test_rods_balanced_by_counterweights(H, folded):
    """A beam whose weights all but balance, one, many and an ensemble; only H < 0 lets these sums cancel."""
    rods = np.array([1.0, 1.0]), np.array([1.0, 1.0]), np.array([H, 0.5]), np.array([1.5, 0.6])
    theta, omega = np.array([np.pi / 2, np.pi - folded]), np.array([0.0, folded])
    exact, chain = dense(*rods, 9.81, theta, omega), CompiledChain(*rods)

    assert error(chain.acceleration(0, theta, omega), exact) < 4e-15
    assert error(chain.acceleration(0, *(np.stack([x, x + 1], axis=1) for x in (theta, omega)))[:, 0], exact) < 4e-15
    ensemble = Ensemble([rods[0]] * 3, *rods[1:])
    assert error(ensemble.acceleration(0, [theta] * 3, [omega] * 3)[1], exact) < 4e-15


def test_random_chains_with_counterweights():
    """Hard and ordinary ones, most with one rod that balances what hangs on it."""
    for seed in range(400):
        rng = np.random.default_rng(seed)
        n = int(rng.integers(1, 6))
        m, l, H, R, theta, omega = hard_chain(KINDS[seed % len(KINDS)] if seed % 2 else "nothing", n, rng)
        width, k = np.sqrt(R**2 - H**2), int(rng.integers(n))
        H = np.where(rng.random(n) < 0.6, -H, H)
        if k + 1 < n:
            H[k] = -l[k] * m[k + 1:].sum() / m[k] * (1 + rng.choice([0, 1e-3, 1e-6, 1e-9]) * rng.normal())
            theta = np.where(rng.random(n) < 0.4, np.pi / 2 * rng.integers(-2, 3, n), theta)
        R = np.sqrt(H**2 + width**2) * (1 + 1e-15)
        chain = CompiledChain(m, l, H, R)

        assert error(chain.acceleration(0, theta, omega), dense(m, l, H, R, 9.81, theta, omega)) < 4e-15, seed


@pytest.mark.parametrize(("springs", "angle"), [(9.379316412639021, 0.5166775995398224), (9.81, 1e-5)])
def test_a_spring_that_balances_the_weight_is_weighed_with_more_than_pairs(springs, angle):
    """1e-20 is left of 10: pairs of floats would leave eleven digits of it."""
    theta, one = np.array([angle]), np.ones(1)
    exact = dense(one, one, one, one, 9.81, theta, 0 * one, springs=[springs])
    chain, ensemble = (kind(x, one, one, one, springs=[springs])
                       for kind, x in ((CompiledChain, one), (Ensemble, [one, one])))

    assert error(chain.acceleration(0, theta, 0 * one), exact) < 4e-15
    assert error(ensemble.acceleration(0, [theta] * 2, np.zeros((2, 1)))[1], exact) < 4e-15


def test_a_massless_rod_with_a_spring_has_no_answer():
    """It would turn infinitely fast, and the error says so."""
    with pytest.raises(SceneError, match="rod 1 has no mass, and the springs"):
        CompiledChain([0, 1], [1, 1], [1, 1], [1, 1], springs=[1, 0])


def test_a_massless_joint_that_snaps_taut_is_not_followed_silently():
    """Two heavy bobs on a massless middle joint: when the string snaps taut the motion ends with a named error."""
    chain = CompiledChain([1, 0, 1], [1, 1, 1], [1, 1, 1], [1, 1, 1], upright=False)
    with pytest.raises(QuantityError, match="cannot be followed"):
        simulate(chain, [0.0, 2.0, -2.0], [0, 0, 0], [0, 10])


def test_energy_of_the_double_pendulum_over_ten_thousand_seconds():
    """From 2 rad, 1e4 s, some 300 thousand steps: drift below 1e-12 of M g L."""
    ones = [1.0, 1.0]
    motion = simulate(CompiledChain(ones, ones, ones, ones, upright=False), [2, 2], [0, 0], np.linspace(0, 1e4, 101),
                      accuracy=1e-10)

    assert motion.energy_drift < 1e-12
    assert not motion.accurate


def test_a_free_rotation_keeps_count_of_its_turns():
    """Without gravity theta = 50 t: after 796 turns, 3333 steps, the angle within the turn is known to 1e-11."""
    motion = simulate(CompiledChain([1], [1], [1], [1], 0), [0], [50], [0, 100], accuracy=1e-12)
    with mpmath.workdps(40):
        turns = mpmath.nint(5000 / (2 * mpmath.pi))
        rest = 5000 - 2 * mpmath.pi * turns

        assert motion.turns[-1, 0] == turns
        assert abs(motion.wrapped[-1, 0] - rest) < 1e-11


def test_wrapping_an_angle_loses_nothing():
    """high + low + 2 pi turns is the same number to 30 digits, entering and after a step across the cut."""
    series = np.zeros((1, 5, 12))
    series[0, 2, 2] = 1.0
    with mpmath.workdps(40):
        for start in (0.3, 3.0, -3.0, 1e3, -12345.678, 7e5):
            high, low, turns = split(np.array([start]), True)[:, 0]
            assert abs(high) <= np.pi and abs(mpmath.mpf(high) + low + 2 * mpmath.pi * turns - start) < 1e-25
            for side in (1.0, -1.0):
                state = np.array([[high], [low], [turns], [1.0], [0.0]])
                move(series, 2, side, state)
                high_, low_, turns_ = state[:3, 0]
                assert abs(high_) <= np.pi
                assert abs(mpmath.mpf(high_) + low_ + 2 * mpmath.pi * turns_ - start - side) < 1e-25


@pytest.mark.parametrize("start", [1e13, -1e15, 1e22])
def test_an_angle_of_any_size_is_the_same_in_an_array_and_in_a_list(start):
    """The float is the exact number that it is: within the turn the motion has the digits of one that starts there."""
    chain = CompiledChain([1], [1], [1], [1], upright=False)
    array, listed = (simulate(chain, values, [0], [0, 1]) for values in (np.array([start]), [start]))
    exact = simulate(chain, [start], [0], [0, 1], digits=40)

    for motion in (array, listed):
        assert abs(motion.wrapped[-1, 0] - float(exact.wrapped[-1, 0])) < motion.error[-1] < 1e-12
        assert abs(motion.turns[-1, 0] - exact.turns[-1, 0]) <= 1e-16 * abs(start)


@pytest.mark.parametrize("q", [2 * pi, 1000 * sqrt(2), Rational("28.7")])
@pytest.mark.parametrize("time", [0.1, 10.1, -1e6 + 0.3, 1e9])
def test_accelerations_of_a_shaken_support_keep_their_digits_at_all_times(q, time):
    """4e-15 of 60 digits: q t has whole turns left out before it is rounded."""
    t = Symbol("t")
    chain = Scene([Rod.uniform(1, 1)] * 2, Support(sin(q * t), cos(q * t) / 10), t=t, gravity=9.81).compile()
    context = mpmath.mp.clone()
    context.dps = 60
    exact = chain.acceleration(context.mpf(time), [context.mpf(1), context.mpf(2)], [context.mpf(0)] * 2)

    scale = max(abs(x) for x in exact)
    assert max(abs(x - y) for x, y in zip(exact, chain.acceleration(time, [1.0, 2.0], [0, 0]))) < 4e-15 * scale


@pytest.mark.parametrize("start", [0, 10**6 + Rational(1, 3), 10**9])
def test_a_shaken_chain_is_followed_as_well_far_from_zero(start):
    """The phase of the support is right at 1e9 s, and the exact initial time is kept: against 25 digits."""
    t = Symbol("t")
    drive = Support(cos(2 * pi * t) / 2, sin(sqrt(2) * 10 * t) / 10)
    chain = Scene([Rod.uniform(1, 1)], drive, gravity=9.81, t=t, upright=False).compile()
    motion, exact = (simulate(chain, [1], [0], [start, start + 2], digits=digits) for digits in (None, 25))

    assert abs(motion.theta[-1, 0] - float(exact.theta[-1, 0])) <= motion.error[-1] < 1e-10


def test_functions_of_time_far_from_zero_lose_what_is_said():
    """A drive that is no sum of waves gets its time as a float, and the estimate shows what its rounding takes."""
    t, start = Symbol("t"), 10**7
    support = Support(eta=exp(cos(2 * pi * t)) / 10)
    chain = Scene([Rod.uniform(1, 1)], support, gravity=9.81, t=t, upright=False).compile()
    motion, exact = (simulate(chain, [1], [0], [start, start + 1.5], digits=digits) for digits in (None, 25))

    assert abs(motion.theta[-1, 0] - float(exact.theta[-1, 0])) <= motion.error[-1] < 1e-7


def test_released_from_horizontal_no_step_is_too_long():
    """Coefficients that vanish by symmetry do not mislead the step: five bobs from pi/2, to 30 digits and in floats."""
    fifth = [Rational(1, 5)] * 5
    chain = CompiledChain([1] * 5, fifth, fifth, fifth, Rational("9.81"), upright=False)
    motion = simulate(chain, [pi / 2] * 5, [0] * 5, [0, 1], accuracy=1e-12)
    exact = simulate(chain, [pi / 2] * 5, [0] * 5, [0, 1], digits=30)

    assert abs((exact.theta - motion.theta).astype(float)).max() < 1e-12


def test_a_long_chain_swings_and_keeps_its_energy():
    """A thousand rods for half a second."""
    n = 1000
    ones = np.ones(n)
    chain = CompiledChain(ones / n, ones / n, ones / (2 * n), ones / (np.sqrt(3) * n), upright=False)
    motion = simulate(chain, np.full(n, 0.5), np.zeros(n), [0, 0.25, 0.5], accuracy=1e-8)

    assert motion.energy_drift < 1e-11


def hard_motion(seed):
    """A random hard chain of one to six rods, a start and a few times within which it turns some three radians."""
    rng = np.random.default_rng(seed)
    m, l, H, R, theta, omega = hard_chain(KINDS[seed % len(KINDS)], int(rng.integers(1, 7)), rng)
    end = 3 * min(np.sqrt(l.min() / 9.81), 1 / abs(omega).max())
    return CompiledChain(m, l, H, R), theta, omega, np.linspace(0, end, 4)


def part_of_the_stated_error(motion, true):
    """How large the error is, of the error that is stated, at the worst time."""
    wrong = abs((motion.wrapped - true.wrapped) + 2 * np.pi * (motion.turns - true.turns)).max(axis=1)
    return max(float(x) for x in wrong / motion.error)


@pytest.mark.parametrize("seed", [375, 0, 1, 2, 4, 5, 6, 7, 8, 9, 13])
def test_estimated_errors_of_hard_motions_are_honest(seed):
    """Against 26 digits.  At 375 one finer run happens to agree where both are wrong by three times the estimate."""
    motion, true = (simulate(*hard_motion(seed), digits=digits) for digits in (None, 26))

    assert part_of_the_stated_error(motion, true) < 0.5


def nearly_straight(n, count, rng):
    """States of even chains that lose most: straight or folded but for little, turning together or not."""
    theta = np.pi * rng.integers(0, 2, (n, count)) + 10.0 ** rng.uniform(-9, -1, count) * rng.normal(size=(n, count))
    omega = 10.0 ** rng.uniform(-3, 4, count) * rng.normal(size=(n, count))
    return theta, np.where(rng.random(count) < 0.5, omega[:1], omega)


def partly_straight(n, count, rng):
    """Angles of chains that are nearly straight from the support to somewhere, and bent beyond."""
    bent = np.cumsum(rng.normal(size=(n, count)) * rng.uniform(0.2, 1, count), axis=0)
    straight = 1e-3 * rng.normal(size=(n, count))
    return np.where(np.arange(n)[:, None] < rng.uniform(0, 0.9, count) * n, straight, bent)


@pytest.mark.parametrize("gravity", [9.81, 0])
@pytest.mark.parametrize(("n", "count"), [(3, 200), (100, 30)])
def test_even_chains_that_are_nearly_straight(n, count, gravity):
    """Alone and together; nothing was asked of their doubt before, and up to 1.5e-14 was lost."""
    rng = np.random.default_rng(n)
    mass, length = rng.uniform(0.5, 1.5, (2, n))
    center = length * rng.uniform(0.3, 0.7, n)
    chain = CompiledChain(mass, length, center, np.sqrt(center**2 + rng.uniform(0.05, 0.15, n) * length**2), gravity)
    theta, omega = nearly_straight(n, count, rng)
    theta[:, ::3] = partly_straight(n, len(theta[0, ::3]), rng)
    together = chain.acceleration(0, theta, omega)
    with mpmath.workdps(50):
        for j in range(count):
            state = theta[:, j].copy(), omega[:, j].copy()
            true = chain.acceleration(mpmath.mpf(0), *([mpmath.mpf(x) for x in numbers] for numbers in state))
            for found in (chain.acceleration(0, *state), together[:, j]):
                assert max(abs(found - true)) <= 4e-15 * max(abs(true))


@pytest.mark.parametrize(("n", "digits"), [(100, 60), (300, 300)])
def test_balls_of_many_rods_stay_narrow(n, digits):
    """A digit is lost for every rod or two, bobs lose none: the form of the recursion decides that."""
    rng, ones = np.random.default_rng(n), np.ones(n)
    theta, omega = rng.uniform(-3, 3, n), rng.normal(size=n)
    for end, lost in ((1.0, 5), (0.5, 0.4 * n)):
        chain = CompiledChain(ones, ones, ones * end, ones * (0.6 if end < 1 else 1), model="rods")
        with flint.ctx.workdps(digits):
            found = chain.acceleration(0, *([flint.arb(x) for x in part] for part in (theta, omega)))
            assert max(x.rad() for x in found) < flint.arb(10) ** (lost - digits)


def test_motions_of_many_rods_have_the_digits_asked_for():
    """300 rods, whose balls hold everything with 40 digits and 30 bits more; against 60 digits."""
    n = 300
    chain = CompiledChain(np.ones(n), np.ones(n), np.ones(n) / 2, np.ones(n) * 0.6)
    theta = np.random.default_rng(n).uniform(-3, 3, n)
    state = [Rational(x) for x in theta], [Rational(0)] * n, [Rational(0), Rational(1, 1000)]
    asked, finer = (integrate_digits(chain, *state, digits).theta[-1] for digits in (40, 60))

    with mpmath.workdps(70):
        assert 0 < max(abs(mpmath.mpf(x) - mpmath.mpf(y)) for x, y in zip(asked, finer, strict=True)) < 1e-38
    assert simulate(CompiledChain([1, 1], [1, 1], [1, 1], [1, 1]), [1, 2], [0, 0], [0, 0.001], digits=330).error[-1] > 0
