"""Accelerations of a chain in O(n) against the dense equations, in every arithmetic, for every feature of a scene."""

import json
import math
import pickle
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import flint
import mpmath
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from sympy import (
    Dummy,
    Function,
    I,
    Rational,
    cos,
    cosh,
    coth,
    csc,
    csch,
    diff,
    exp,
    factorial,
    lambdify,
    log,
    pi,
    sec,
    sin,
    sinh,
    sqrt,
    symbols,
    tan,
    tanh,
)

from lagrangian import (
    CompiledChain,
    DriveError,
    Ensemble,
    QuantityError,
    Rod,
    Scene,
    SceneError,
    Support,
    TextError,
    euler_lagrange,
    simulate,
)
from lagrangian.arithmetic import Balls, MPNumbers
from lagrangian.errors import NotAQuantityError

t = symbols("t")
DIGITS = 50
CASES = json.loads((Path(__file__).parent / "cases" / "mechanics.json").read_text())["mechanics"]
# An example derives equations and evaluates them at 50 digits, a tenth of a second for six rods.
measured = settings(max_examples=min(100, settings.default.max_examples), deadline=None)
fractions = st.builds(Rational, st.integers(-20, 20), st.integers(1, 9))
positive = st.builds(Rational, st.integers(1, 20), st.integers(1, 9))
MOTIONS = [Rational(0), 3 * t**2 / 2, cos(2 * t) / 3, sin(3 * t + 1) - cos(t) / 2, t * sin(t), exp(-t) * cos(t),
           sqrt(1 + t**2), 1 / (2 + t)]


@st.composite
def any_rods(draw):
    """Any rod, its centre on either side of the joint."""
    center = draw(fractions)
    return Rod(draw(positive), draw(positive), center, abs(center) + draw(positive))


@st.composite
def any_bobs(draw):
    """A point mass on a massless rod."""
    return Rod.bob(draw(positive), draw(positive))


rods, bobs = any_rods(), any_bobs()


@st.composite
def scenes(draw, rod=rods, joints=True):
    """One to six rods on any support, in both conventions, with and without dampers and springs."""
    chain = draw(st.lists(rod, min_size=1, max_size=6))
    n = len(chain)
    constants = st.none() | st.lists(positive, min_size=n, max_size=n) if joints else st.none()
    drive = st.sampled_from(MOTIONS)
    return Scene(chain, Support(draw(drive), draw(drive)), draw(fractions), draw(st.booleans()), draw(constants),
                 draw(constants), t)


def states(n):
    """Time, angles and rates."""
    return st.tuples(positive, *(st.lists(fractions, min_size=n, max_size=n) for _ in range(2)))


def dense(scene, time, theta, omega, digits=DIGITS):
    """M(theta)^-1 f from the symbolic equations, at 2 * digits digits and solved so, as mpmath numbers."""
    equations = euler_lagrange(scene)
    names = [Dummy() for _ in range(2 * len(scene))]
    plain = dict(zip(scene.velocities, names)), dict(zip(scene.coordinates, names[len(scene):]))
    sides = [matrix.xreplace(plain[0]).xreplace(plain[1]) for matrix in (equations.mass_matrix, equations.forcing)]
    with mpmath.workdps(2 * digits):
        numbers = [mpmath.mpf(int(x.p)) / int(x.q) for x in (time, *omega, *theta)]
        M, f = lambdify([t, *names], sides, modules="mpmath")(*numbers)
        return list(mpmath.lu_solve(M, f))


def contains(ball, number):
    """Whether a ball contains a number known to twice as many digits."""
    with mpmath.workdps(2 * DIGITS):
        middle, radius = (mpmath.mpf(x.str(90, radius=False, more=True)) for x in (ball.mid(), ball.rad()))
        return abs(middle - number) <= radius * (1 + mpmath.mpf(10) ** -15) + mpmath.mpf(10) ** -85


def close_in_floats(scene, state):
    """Against the dense equations at the very floats that the chain is given."""
    theta, omega = (np.array([float(x) for x in part]) for part in state[1:])
    rounded = [Rational(float(state[0])), [Rational(x) for x in theta], [Rational(x) for x in omega]]
    exact = dense(scene, *rounded, digits=20)
    mine = scene.compile().acceleration(float(state[0]), theta, omega)
    return max(abs(float(x) - y) for x, y in zip(mine, exact)) / max(1, *map(abs, exact), 1)


@measured
@given(st.data())
def test_rods_equal_the_dense_equations_to_12_digits_in_floats(data):
    """M(theta)^-1 f by SymPy, one to six rods, any drive, dampers, springs, both conventions."""
    scene = data.draw(scenes())

    assert close_in_floats(scene, data.draw(states(len(scene)))) < 1e-12


@measured
@given(st.data())
def test_bobs_equal_the_dense_equations_to_12_digits_in_floats(data):
    """The tensions' path, which is chosen by itself."""
    scene = data.draw(scenes(bobs, joints=False))

    assert scene.compile().model == "bobs"
    assert close_in_floats(scene, data.draw(states(len(scene)))) < 1e-12


@measured
@given(st.data())
def test_accelerations_equal_the_dense_equations_to_45_digits(data):
    """The same source on mpmath numbers of 50 digits, both models."""
    scene = data.draw(scenes() | scenes(bobs, joints=False))
    time, theta, omega = data.draw(states(len(scene)))
    context = mpmath.mp.clone()
    context.dps = DIGITS
    given_state = [[context.mpf(int(x.p)) / int(x.q) for x in part] for part in (theta, omega)]
    exact_state = [[Rational(*ratio(x)) for x in part] for part in given_state]
    exact = dense(scene, time, *exact_state)
    mine = scene.compile().acceleration(context.mpf(int(time.p)) / int(time.q), *given_state)
    scale = max([abs(x) for x in exact] + [1])

    assert max(abs(x - y) for x, y in zip(mine, exact)) < scale * context.mpf(10) ** -45


def ratio(x):
    """A binary number as numerator and denominator."""
    sign, mantissa, exponent, _ = x._mpf_
    value = Rational(int(mantissa)) * Rational(2) ** int(exponent) * (-1) ** int(sign)
    return int(value.p), int(value.q)


@measured
@given(st.data())
def test_balls_contain_the_accelerations(data):
    """Every ball contains the dense equations' number at 100 digits, and is narrow."""
    scene = data.draw(scenes() | scenes(bobs, joints=False))
    time, theta, omega = data.draw(states(len(scene)))
    exact = dense(scene, time, theta, omega)
    with flint.ctx.workdps(DIGITS):
        ball = [flint.arb(flint.fmpq(int(x.p), int(x.q))) for x in (time, *theta, *omega)]
        n = len(scene)
        mine = scene.compile().acceleration(ball[0], ball[1:n + 1], ball[n + 1:])

        assert all(contains(x, y) for x, y in zip(mine, exact))
        assert all(float(x.rad()) < 1e-30 * max(1, *(float(abs(y)) for y in exact), 1) for x in mine)


@measured
@given(st.data(), st.integers(1, 70))
def test_many_chains_move_as_each_alone(data, chains):
    """Shape (n, chains) is a loop over chains: the same numbers to a few units in the last place."""
    scene = data.draw(scenes())
    chain, n = scene.compile(), len(scene)
    rng = np.random.default_rng(data.draw(st.integers(0, 10**6)))
    theta, omega = rng.uniform(-9, 9, (n, chains)), rng.normal(size=(n, chains))
    together = chain.acceleration(0.5, theta, omega)
    alone = np.stack([chain.acceleration(0.5, theta[:, j], omega[:, j]) for j in range(chains)], axis=1)

    assert abs(together - alone).max() <= 1e-13 * max(1, abs(alone).max())


@measured
@given(st.data())
def test_the_rods_path_moves_bobs_too(data):
    """model="rods" on a chain of bobs gives what the bob path gives."""
    scene = data.draw(scenes(bobs, joints=False))
    _, theta, omega = data.draw(states(len(scene)))
    state = [[float(x) for x in part] for part in (theta, omega)]
    light, full = (scene.compile(model=model).acceleration(0.25, *state) for model in ("bobs", "rods"))

    assert abs(light - full).max() <= 1e-12 * max(1, abs(full).max())


@measured
@given(st.data())
def test_conventions_describe_one_motion(data):
    """theta = pi - phi: accelerations upright are those hanging, negated."""
    up = data.draw(scenes(joints=False))
    down = Scene(up.rods, up.support, up.gravity, not up.upright, t=t)
    context = mpmath.mp.clone()
    context.dps = DIGITS
    time, theta, omega = ([context.mpf(int(x.p)) / int(x.q) for x in part] for part in
                          ([data.draw(positive)], *data.draw(states(len(up)))[1:]))
    mine = up.compile().acceleration(time[0], theta, omega)
    other = down.compile().acceleration(time[0], [context.pi - x for x in theta], [-x for x in omega])

    assert max(abs(x + y) for x, y in zip(mine, other)) <= max(1, *map(abs, mine), 1) * context.mpf(10) ** -45


@pytest.mark.parametrize("case", [c for c in CASES if c["id"].startswith("rhs-")], ids=lambda c: c["id"])
def test_reference_accelerations(case):
    """Accelerations at random states, computed elsewhere: 14 digits in floats, 39 in mpmath numbers."""
    context = mpmath.mp.clone()
    context.dps = DIGITS
    rods = [[Rational(x) for x in case[name]] for name in ("m", "l", "H", "R")]
    chain = CompiledChain(*rods, Rational(case["g"]), (Rational(case["ddxi"]), Rational(case["ddeta"])))
    state = [[Rational(x) for x in case[name]] for name in ("theta", "dtheta")]
    exact = [context.mpf(x) for x in case["ddtheta"]]
    floats = chain.acceleration(0, *([float(x) for x in part] for part in state))
    many = chain.acceleration(context.mpf(0), *([context.mpf(int(x.p)) / int(x.q) for x in part] for part in state))
    scale = max(abs(x) for x in exact)

    assert max(abs(float(x) - y) for x, y in zip(floats, exact)) < 1e-14 * scale
    assert max(abs(x - y) for x, y in zip(many, exact)) < context.mpf(10) ** -39 * scale


def test_floats_in_lists_and_arrays_are_one_chain():
    """[0.1, 0.2] and np.array([0.1, 0.2]) and their exact ratios give one chain."""
    given_numbers = ([0.3, 1.7], [0.9, 1.1], [0.45, 0.2], [0.6, 0.77])
    state = ([0.4, 2.0], [1.0, -3.0])
    plain = CompiledChain(*given_numbers).acceleration(0, *state)
    arrays = CompiledChain(*(np.array(x) for x in given_numbers)).acceleration(0, *state)
    exact = CompiledChain(*([Rational(y) for y in x] for x in given_numbers)).acceleration(0, *state)

    assert (plain == arrays).all() and abs(plain - exact).max() < 1e-14


def test_support_acceleration_is_a_pair_or_a_function_of_time():
    """A function of t that gives the pair; the same as the scene's own drive."""
    chain = CompiledChain([1], [1], [1], [1], 9.81, lambda time: (0.1 * np.cos(3 * time), time**2))
    scene = Scene([Rod.bob(1, 1)], Support(-cos(3 * t) / 90, t**4 / 12), Rational("9.81"))
    mine, other = (c.acceleration(0.7, [0.3], [0.1]) for c in (chain, scene.compile()))

    assert abs(mine - other).max() < 1e-14


def hung(eta, gravity):
    """Two rods on a support that moves up and down."""
    return Scene([Rod(1, 1, Rational(1, 2), Rational(3, 5))] * 2, Support(0, eta), gravity, t=t).compile()


@pytest.mark.parametrize("chain", [
    CompiledChain([1], [1], [0.5], [0.6], Rational(1, 3), (0, Rational(1, 10**10) - Rational(1, 3))),
    CompiledChain([1], [1], [0.5], [0.6], sqrt(2), (0, Rational(1, 10**10) - sqrt(2)), upright=False),
    hung(cos(t), 1),
    hung(cos(t) / 3, Rational(1, 3)),
    hung(cos(t) + sin(2 * t) / 7, 1),
    hung(exp(-(t**2)) / 6, Rational(1, 3)),
], ids=["constant", "root", "wave", "third", "waves", "expression"])
@pytest.mark.parametrize("time", [1e-5, 1e-3, 0.1, 1.0])
def test_weight_and_support_that_nearly_cancel_are_added_before_they_round(chain, time):
    """Within 4e-15 of the accelerations in 60 digits; 1e-10 of the weight is left, or the square of the time."""
    context = mpmath.mp.clone()
    context.dps = 60
    theta = [0.5, 0.7][:len(chain)]
    rough = chain.acceleration(time, np.array(theta), np.zeros(len(chain)))
    fine = chain.acceleration(context.mpf(time), [context.mpf(x) for x in theta], [context.zero] * len(chain))

    assert max(abs(x - y) for x, y in zip(rough, fine)) <= 4e-15 * max(map(abs, fine))


@pytest.mark.parametrize("time", [0.0, 1e-3, 0.1])
def test_what_a_function_of_time_gives_is_exact(time):
    """Weight and support that nearly cancel, g = 1/3: the same as for a constant support of that very float."""
    def given(time):
        return 0, -np.cos(time) / 3

    shaken, steady = (CompiledChain([1], [1], [0.5], [0.6], Rational(1, 3), support)
                      for support in (given, tuple(map(float, given(time)))))
    found = shaken.acceleration(time, np.array([0.5]), np.zeros(1))
    with mpmath.workdps(50):
        true = steady.acceleration(mpmath.mpf(time), [mpmath.mpf(0.5)], [mpmath.mpf(0)])

        assert abs(found[0] - true[0]) <= 4e-15 * abs(true[0])


@pytest.mark.parametrize("motion", [*MOTIONS, log(2 + t) * cosh(t / 3), tan(t / 4) + tanh(t), t**Rational(3, 2),
                                    2**t + (1 + t)**t, 1 / cosh(t)**2 + sinh(t), sec(t) + csc(t), coth(t) * csch(t)],
                         ids=str)
def test_power_series_of_a_support_are_its_derivatives(motion):
    """Coefficients of xi'' about t = 0.7 against SymPy's derivatives, in floats and in mpmath numbers."""
    support = Scene([Rod.bob(1, 1)], Support(motion, 0), 1, t=t).compile().support
    expected = [diff(motion, (t, 2 + j)).subs(t, Rational(7, 10)).evalf(40) / factorial(j) for j in range(8)]
    context = mpmath.mp.clone()
    context.dps = 35
    floats = support.series(0.7, 7)[0]
    numbers = support.series(context.mpf(7) / 10, 7, MPNumbers(context))[0]

    assert all(abs(x - y) < 1e-12 * max(1, abs(y)) for x, y in zip(floats, expected))
    assert all(abs(Rational(*ratio(x)) - y) < Rational(1, 10**30) * max(1, abs(y)) if x else y == 0 or abs(y) < 1e-30
               for x, y in zip(numbers, expected))


def test_waves_are_recognised():
    """A support that moves in waves, in both directions or one, costs no power series in Python."""
    for xi, eta in ((0, cos(3 * t)), (sin(2 * t + 1), 0), (3 * t**2 / 2, cos(t) * 2 - sin(t)), (0, 0)):
        support = Scene([Rod.bob(1, 1)], Support(xi, eta), 1, t=t).compile().support

        assert support.function is None and support.at_rest == (xi == eta == 0)


def test_a_tension_free_fall_keeps_every_rod_from_turning():
    """Without gravity at the joint (eta'' = -g) a chain at rest stays at rest."""
    chain = CompiledChain([1, 2, 3], [1] * 3, [0.5] * 3, [0.6] * 3, 9.81, (0, -9.81))

    assert (chain.acceleration(0, [0.3, 1.1, 2.0], [0, 0, 0]) == 0).all()


def falling(time):
    """A support that falls with a part of g."""
    return 0, -time / (1 + time)


@pytest.mark.parametrize("chain", [
    Scene([Rod.uniform(1, 2)] * 3, Support(eta=cos(3 * t)), 10, t=t).compile(),
    Scene([Rod.uniform(1, 2)] * 3, Support(eta=tanh(t), xi=sinh(t)), 10, t=t).compile(),
    CompiledChain([1, 1, 1], [1, 1, 1], [1, 1, 1], [1, 1, 1], support_acceleration=falling)],
    ids=["waves", "expressions", "function"])
def test_a_chain_can_be_sent_to_another_process(chain):
    """pickle gives the same chain, its drive included."""
    copy = pickle.loads(pickle.dumps(chain))
    state = 0.4, [0.1, 0.2, 0.3], [1.0, 2.0, 3.0]

    assert (copy.acceleration(*state) == chain.acceleration(*state)).all()


def test_model_is_the_least_that_the_chain_requires():
    """Bobs where all rods are bobs with free joints, else rods; overridden on request."""
    ones = [1, 1]
    assert CompiledChain(ones, ones, ones, ones).model == "bobs"
    assert CompiledChain(ones, ones, ones, ones, model="rods").model == "rods"
    assert CompiledChain(ones, ones, ones, ones, springs=[0, 0]).model == "bobs"
    assert CompiledChain(ones, ones, ones, ones, springs=[0, 1]).model == "rods"
    assert CompiledChain(ones, ones, [1, 0.5], ones).model == "rods"


@pytest.mark.parametrize(("arguments", "error", "words"), [
    (([], [], [], []), SceneError, ["positive", "empty"]),
    (([1], [0], [0], [1]), QuantityError, ["length", "positive", "0"]),
    (([-1.0], [1.0], [0.0], [1.0]), QuantityError, ["mass", "-1.0"]),
    (([1], [1], [2], [1]), QuantityError, ["gyration", "2"]),
    (([1, 1], [1], [1], [1]), SceneError, ["2 x mass", "1 x length"]),
    ((np.ones((2, 3)), [1, 1], [1, 1], [1, 1]), SceneError, ["mass", "(2, 3)", "give Ensemble"]),
    (([0, 0], [1, 1], [1, 1], [1, 1]), SceneError, ["without any mass"]),
    (([float("nan")], [1], [1], [1]), QuantityError, ["finite"]),
    (([symbols("m")], [1], [1], [1]), QuantityError, ["Symbol m"]),
    (("1", [1], [1], [1]), TextError, ["'1'", "never evaluated"]),
    ((["__import__('os')"], [1], [1], [1]), TextError, ["never evaluated"]),
    ((1, [1], [1], [1]), NotAQuantityError, ["list"]),
    (([1], [1], [1], [1], "9.81"), TextError, ["gravity"]),
    (([1], [1], [1], [1], 9.81, (0, 0), [-1]), QuantityError, ["damping", "-1"]),
    (([1], [1], [1], [1], 9.81, (0, 0), [1, 1]), SceneError, ["2 values", "1 rods"]),
    (([1, 0], [1, 1], [1, 1], [1, 1], 9.81, (0, 0), None, [1, 1]), SceneError, ["rod 2", "springs"]),
    (([1], [1], [1], [1], 9.81, 7), Exception, ["pair"]),
    (([1], [1], [1], [1], symbols("g")), QuantityError, ["gravity", "Symbol g"]),
    (([1], [1], [1], [1], 9.81, (symbols("a"), 0)), QuantityError, ["support_acceleration[0]", "Symbol a"]),
])
def test_what_no_chain_can_be_is_refused(arguments, error, words):
    """A named error with the claim, the value and the remedy."""
    with pytest.raises(error) as refusal:
        CompiledChain(*arguments)

    assert all(word in str(refusal.value) for word in words)


@pytest.mark.parametrize(("state", "error", "words"), [
    (([0.0], [0.0, 0.0]), SceneError, ["2 rods", "(1,)"]),
    (([0.0, float("inf")], [0.0, 0.0]), QuantityError, ["theta", "inf"]),
    (([0.0, 0.0], [1e200, 0.0]), QuantityError, ["float64", "1e+200"]),
    ((["a", "b"], [0.0, 0.0]), Exception, ["theta"]),
    (("ab", [0.0, 0.0]), TextError, ["theta"]),
    ((np.zeros((2, 3)), np.zeros(2)), SceneError, ["(2, 3)"]),
    ((["1", "2"], [0.0, 0.0]), TextError, ["theta", "1"]),
    (([mpmath.mpf(1), "2"], [0, 0]), TextError, ["2", "never evaluated"]),
    (([flint.arb(1), "2"], [0, 0]), TextError, ["2", "never evaluated"]),
    ((np.ones(2) * 1j, [0, 0]), NotAQuantityError, ["theta", "1j"]),
    (([1, [2, 3]], [0, 0]), NotAQuantityError, ["theta", "[2, 3]"]),
    (([symbols("x"), 1], [0, 0]), QuantityError, ["theta", "Symbol x"]),
    (([mpmath.mpf("nan"), 1], [0, 0]), QuantityError, ["finite", "nan"]),
    (([flint.arb("nan"), 1], [0, 0]), QuantityError, ["finite", "nan"]),
    (([mpmath.mpf(1)] * 3, [0, 0]), SceneError, ["(3,)", "(2,)"]),
])
def test_a_state_without_an_answer_is_refused(state, error, words):
    """Shapes, infinities and overflow are named."""
    with pytest.raises(error) as refusal:
        CompiledChain([1, 1], [1, 1], [1, 1], [1, 1]).acceleration(0, *state)

    assert all(word in str(refusal.value) for word in words)


@pytest.mark.parametrize("time", ["1", None, 1j, symbols("s")])
def test_a_time_is_a_number(time):
    """Whether the support moves or not."""
    with pytest.raises((TextError, NotAQuantityError, QuantityError), match="t is"):
        CompiledChain([1, 1], [1, 1], [1, 1], [1, 1]).acceleration(time, np.ones(2), np.ones(2))


@pytest.mark.parametrize("time", [float("inf"), float("nan"), np.float64("-inf")])
def test_a_time_is_finite_where_the_support_moves(time):
    """Named, and without a warning, for one chain and many."""
    chain = Scene([Rod.uniform(1, 1)] * 2, Support(eta=cos(7 * t) / 10), gravity=10, t=t).compile()
    for state in (np.ones(2), np.ones((2, 3))):
        with pytest.raises(QuantityError, match="t holds -?(inf|nan), which is not finite"):
            chain.acceleration(time, state, state)


def test_numbers_of_all_kinds_stand_side_by_side():
    """The most precise kind decides, also that of the time, and many chains keep it as one does."""
    chain = Scene([Rod.uniform(1, 1)] * 2, Support(eta=cos(7 * t) / 10), gravity=10, t=t).compile()
    plain = chain.acceleration(1 / 3, [1.0, 0.5], [0.0, 2.0])
    third, half = mpmath.mpf(1) / 3, Fraction(1, 2)

    for time, theta, omega in (
            (third, [1, half], np.array([0.0, 2.0])), (third, np.array([1.0, 0.5]), [0.0, 2]),
            (Rational(1, 3), [mpmath.mpf(1), half], (0, 2)), (1 / 3, [flint.arb(1), half], [0, 2]),
            (Rational(1, 3), [sin(pi / 2), half], [0, Decimal(2)]), (third, [np.int64(1), half], [0, 2])):
        found = chain.acceleration(time, theta, omega)
        assert abs(np.array([float(x) for x in found]) - plain).max() < 4e-15 * abs(plain).max()
    states = np.array([[mpmath.mpf(1), mpmath.mpf(2)], [third, third]])
    many = chain.acceleration(third, states, states)
    assert (many == chain.acceleration(third, list(states), list(states))).all()
    assert many.dtype == object and list(many[:, 1]) == list(chain.acceleration(third, states[:, 1], states[:, 1]))


def test_a_function_of_time_takes_numbers_of_all_kinds_or_says_so():
    """numpy's functions take mpmath numbers here, and the float that math.cos makes of them is no answer."""
    smooth = CompiledChain([1], [1], [1], [1], 10, lambda s: (0, np.cos(3 * s)))
    rounded = CompiledChain([1], [1], [1], [1], 10, lambda s: (0, math.cos(3 * s)))
    context = mpmath.mp.clone()
    context.dps = 40
    x, time = context.mpf(1), context.mpf(1) / 3
    found = smooth.acceleration(time, [x], [0 * x])

    assert abs(found[0] - (10 + context.cos(3 * time)) * context.sin(x)) < 1e-38
    with pytest.raises(DriveError, match=r"numbers of more digits.*give floats"):
        rounded.acceleration(time, [x], [0 * x])


def test_compile_says_which_symbol_has_no_value():
    """scene.compile needs a number for every Symbol, and never text."""
    m, l = symbols("m l")
    with pytest.raises(QuantityError, match="Symbol l"):
        Scene([Rod.bob(m, l)]).compile({m: 1})
    with pytest.raises(QuantityError, match="gravity is g, which holds the Symbol g"):
        Scene([Rod.bob(m, l)]).compile({m: 1, l: 1})
    with pytest.raises(QuantityError, match="Symbol m"):
        Scene([Rod.bob(1, 1)], Support(eta=m * cos(l * t)), 1, t=t).compile({l: 2})
    with pytest.raises(DriveError, match=r"xi\(t\)"):
        Scene([Rod.bob(1, 1)], Support(Function("xi")(t)), 1, t=t).compile()
    with pytest.raises(DriveError, match="pair"):
        CompiledChain([1], [1], [1], [1], 9.81, lambda time: 3).acceleration(0, [0.1], [0.1])
    with pytest.raises(TextError):
        Scene([Rod.bob(m, l)]).compile({m: "1"})
    with pytest.raises(TextError):
        Scene([Rod.bob(m, l)]).compile({"m": 1})


def test_balls_of_numbers_of_any_mpmath_context_are_the_numbers_themselves():
    """Dyadic, not near them: a third in 60 digits, of a context of its own."""
    context = mpmath.mp.clone()
    context.dps = 60
    third = 1 / context.mpf(3)

    with flint.ctx.workprec(300):
        ball = Balls().coerced(third)
        mantissa, exponent = ball.man_exp()
        assert ball.is_exact() and Fraction(int(mantissa)) * Fraction(2) ** int(exponent) == Fraction(
            int(third.man)) * Fraction(2) ** int(third.exp)


def test_a_chain_does_not_change():
    """Neither its attributes nor its joints, before a call or after one; nor an ensemble's."""
    chain = CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], damping=[1, 1], springs=[1, 1])
    for made in (chain, Ensemble([[1, 1]] * 2, [1, 1], [1, 1], [1, 1], damping=1.0, springs=1.0)):
        for name, value in (("upright", False), ("gravity", 0), ("damping", None), ("other", 1)):
            with pytest.raises(AttributeError):
                setattr(made, name, value)
        for joints in (made.damping, made.springs):
            with pytest.raises(ValueError, match="read-only"):
                joints[...] = 0


@pytest.mark.parametrize("show", [
    lambda chain: chain.rods,
    lambda chain: chain.bobs,
    lambda chain: chain.damping,
    lambda chain: chain.support.floats[0],
    lambda chain: Ensemble([[1, 1]] * 3, 1, 1, 1, damping=[1, 1]).damping,
    lambda chain: simulate(chain, [1, 1], [0, 0], [0, 1]).theta,
])
def test_what_a_chain_shows_of_itself_cannot_be_written_to(show):
    """Whoever scales what he was shown would change the accelerations of the chain."""
    with pytest.raises(ValueError, match="read-only"):
        show(CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], damping=[1, 1]))[0] = 77



@pytest.mark.parametrize("eta", [I * cos(t), (1 + I) * t**2, cos(t) + I * sin(2 * t), I * t])
def test_a_support_moves_in_real_space(eta):
    """Waves and powers with complex numbers, which are real in no time."""
    with pytest.raises(QuantityError, match="not real"):
        Support(eta=eta)


def test_a_root_of_a_value_below_zero_is_not_real():
    """Which is seen when the scene is compiled."""
    a = symbols("a")
    scene = Scene([Rod.bob(1, 1)], Support(eta=sqrt(a) * cos(t)), gravity=10, t=t)
    with pytest.raises(QuantityError, match="not real"):
        scene.compile({a: -2})


@pytest.mark.parametrize("amount", [Rational(1, 10), pi, sqrt(2)])
def test_functions_of_time_may_hold_numbers_of_sympy(amount):
    """In float64, double-double and balls, as the same functions of floats and digits."""
    def shaken(c):
        return CompiledChain([1], [1], [1], [1], upright=False,
                             support_acceleration=lambda t: (c * np.cos(t) + c, c / (2 + t * t) - t**c))

    chain, like = shaken(amount), shaken(float(amount))
    times, expected = [1, 1.1], simulate(like, [1], [0], [1, 1.1]).theta[-1]
    for digits in (None, 20, 40):
        assert abs(simulate(chain, [1], [0], times, digits=digits).theta[-1] - expected).max() < 1e-12
