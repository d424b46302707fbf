"""States between the times and events, in float64 and with digits: closed forms, second runs, runs backwards."""

import copy
import math
import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from flint import ctx
from sympy import Float, Integer, Matrix, Rational, Symbol, cos, pi

from fastpicard import FloquetMatrix
from lagrangian import (
    CompiledChain,
    Crossing,
    NotASceneError,
    QuantityError,
    Rod,
    Scene,
    SceneError,
    TextError,
    euler_lagrange,
    flips,
    simulate,
)
from tests.conftest import in_threads

t = Symbol("t")
HALF, G = Rational(1, 2), Rational("9.81")
ROD = CompiledChain([1], [1], [HALF], [Rational(3, 5)], G, upright=False)
BOB = CompiledChain([1], [1], [1], [1], G, upright=False)
TWO = CompiledChain([1, 2], [1, 1], [HALF] * 2, [Rational(3, 5)] * 2, G, upright=False)
FREE = CompiledChain([1], [1], [1], [1], 0, upright=False)
each_kind = pytest.mark.parametrize("digits", [None, 35], ids=["float64", "balls"])


def apart(x, y):
    """The largest difference, in the numbers of x."""
    context = np.ravel(x)[0].context
    return max(abs(a - context.convert(b)) for a, b in zip(np.ravel(x), np.ravel(y), strict=True))


def test_states_between_the_times_are_those_of_a_run_that_has_them_among_its_times():
    """To 38 of 40 digits, whatever kind of exact number says the time."""
    between = [Fraction(1, 7), 0.3, Rational(1, 3), pi / 9, mpmath.mpf(0.4375), np.float64(0.49)]
    exact = [Rational(1, 7), Rational(0.3), Rational(1, 3), pi / 9, Rational(7, 16), Rational(0.49)]
    motion = simulate(TWO, [2, 1], [0, 1], [0, HALF], digits=40, dense=True)
    other = simulate(TWO, [2, 1], [0, 1], [0, *exact, HALF], digits=40)
    theta, omega = motion.at(between)

    assert theta.shape == omega.shape == (6, 2) and theta[0, 0].context is motion.theta[0, 0].context
    assert max(apart(theta, other.theta[1:-1]), apart(omega, other.omega[1:-1])) < mpmath.mpf(10) ** -38
    assert apart(motion.at(Fraction(1, 7))[0], theta[0]) == 0 and motion.at(0)[1].shape == (2,)
    assert apart(motion.at([0, HALF])[0], motion.theta) < mpmath.mpf(10) ** -39


def test_a_float_time_is_the_dyadic_number_that_it_is():
    """0.1 and 1/10 are 5.55e-18 s apart, and the states as far as the rate makes them."""
    motion = simulate(FREE, [0], [1], [0, 1], digits=35, dense=True)
    gap = mpmath.mpf(5) * 2 ** -mpmath.mpf(53) / 100
    found = motion.at(0.1)[0][0] - motion.at(Rational(1, 10))[0][0]

    with mpmath.workdps(35):
        assert abs(found - (mpmath.mpf(0.1) - mpmath.mpf(1) / 10)) < mpmath.mpf(10) ** -35
    assert found > gap / 1000 > 0


def test_a_quarter_of_a_period_is_an_elliptic_integral_to_40_digits():
    """From rest at theta_0 a bob hangs first at t = K(sin(theta_0/2)) sqrt(l/g); then after half periods."""
    events = {"down": Crossing(1, 0), "to the right": Crossing(1, 0, 1), "let go": Crossing(1, 2)}
    motion = simulate(BOB, [2], [0], [0, 2], digits=44, events=events)
    with mpmath.workdps(44):
        quarter = mpmath.ellipk(mpmath.sin(1) ** 2) / mpmath.sqrt(mpmath.mpf("9.81"))
        down = motion.events["down"]

        assert abs(down[0] - quarter) < mpmath.mpf(10) ** -41 and abs(down[1] - 3 * quarter) < mpmath.mpf(10) ** -40
        assert len(down) == 2 and apart(motion.events["to the right"], down[1:]) == 0
        assert motion.events["let go"].tolist() == [0]


@each_kind
def test_angles_of_crossings_are_exact(digits):
    """Without gravity theta = t: pi/2 is passed at pi/2, its float at that float, in every turn and no sooner."""
    events = {"exact": Crossing(1, pi / 2), "later": Crossing(1, -7 * pi / 2), "float": Crossing(1, math.pi / 2),
              "falling": Crossing(1, 1, -1), "turn": Crossing(1, Integer(0))}
    found = simulate(FREE, [0], [1], [0, 13], digits=digits, accuracy=1e-12, events=events).events
    with mpmath.workdps(digits or 15):
        unit = mpmath.mpf(10) ** (-digits + 2) if digits else 4e-15
        quarters = [mpmath.pi / 2 + 2 * mpmath.pi * k for k in range(2)]
        exact = {"exact": quarters, "later": quarters, "turn": [0, 2 * mpmath.pi, 4 * mpmath.pi], "falling": [],
                 "float": [math.pi / 2, math.pi / 2 + 2 * mpmath.pi]}

        for name, times in exact.items():
            assert len(found[name]) == len(times)
            assert all(abs(x - y) < unit for x, y in zip(found[name], times, strict=True))
    assert found["float"][0] == math.pi / 2 and found["turn"][0] == 0


def test_flips_are_the_same_in_float64_and_with_digits():
    """A double pendulum let go upwards at 12 and 9 rad/s; at the flips the angle is an odd number of half turns."""
    rough, fine = (simulate(TWO, [0, 0], [12, 9], [0, HALF], digits=digits, dense=True, events=flips(TWO))
                   for digits in (None, 33))
    for k, name in enumerate(flips(TWO)):
        times = fine.events[name]
        assert len(times) == len(rough.events[name]) > 0
        assert abs(rough.events[name] - times.astype(float)).max() < 1e-12
        context = times[0].context
        for angle in fine.at(times)[0][:, k]:
            assert abs(context.sin(angle)) < context.mpf(10) ** -30 and context.cos(angle) < 0


def test_a_motion_backwards_passes_the_same_states_and_events_in_reverse():
    """From the last state, in mpmath numbers, to the first; what grew shrinks in time, and is still called growing."""
    events = {"both": Crossing(2, Rational(4, 5)), "growing": Crossing(2, Rational(4, 5), 1)}
    there = simulate(TWO, [1, HALF], [0, 0], [0, HALF], digits=35, dense=True, events=events)
    back = simulate(TWO, there.theta[-1], there.omega[-1], [HALF, 0], digits=35, dense=True, events=events)
    times = [0, 0.25, Rational(1, 3), HALF]

    assert all(apart(x, y) < mpmath.mpf(10) ** -32 for x, y in zip(there.at(times), back.at(times), strict=True))
    for name, count in (("both", 2), ("growing", 1)):
        assert len(there.events[name]) == len(back.events[name]) == count
        assert apart(there.events[name], back.events[name][::-1]) < mpmath.mpf(10) ** -32


@each_kind
def test_a_crossing_where_two_steps_meet_belongs_to_one_of_them(digits):
    """The very angle that a step starts from, for every step of a rod that turns over and falls back."""
    motion = simulate(ROD, [2], [3], [0, 2], digits=digits, dense=True)
    pieces = motion.interpolant
    if digits is None:
        angles = [Rational(high) + Rational(low) for high, low in zip(pieces.high[:, 0], pieces.low[:, 0])]
    else:
        exact = [angle[0].man_exp() for (angle,) in pieces.angles]
        angles = [Rational(int(mantissa)) * Rational(2) ** int(exponent) for mantissa, exponent in exact]
    events = {str(k): Crossing(1, angle) for k, angle in enumerate(angles)}
    found = simulate(ROD, [2], [3], [0, 2], digits=digits, events=events).events

    assert len(angles) > 10
    for k, start in enumerate(pieces.shown(pieces.start)):
        assert [x for x in found[str(k)] if abs(x - start) < 1e-9] == [start]


@each_kind
def test_what_happens_after_the_last_time_is_not_reported(digits):
    """The last step is longer than the motion: theta = t would pass 5/4 within it, after the motion ends."""
    events = {"inside": Crossing(1, Rational(3, 4)), "after": Crossing(1, Rational(5, 4))}
    motion = simulate(FREE, [0], [1], [0, 1], digits=digits, dense=True, events=events)

    assert motion.interpolant.length[-1] > 1.25
    assert motion.events["inside"].tolist() == [0.75] and motion.events["after"].shape == (0,)


@each_kind
@pytest.mark.parametrize("times", [[0, Rational(1, 10)], [Rational(1, 3), Rational(1, 10)], [Rational(1, 10), pi / 5],
                                   [3]], ids=str)
def test_states_are_known_at_the_first_and_the_last_time_and_between_them(digits, times):
    """Also at the floats next to exact times, whose steps lead farther; forwards, backwards and at rest."""
    motion = simulate(TWO, [1, 2], [0, 1], times, digits=digits, dense=True)
    least, largest = sorted(motion.times[[0, -1]])
    states = [*(motion.at(x)[0] for x in times), *motion.at(motion.times)[0]]

    assert all(abs(x - y) < 1e-15 for x, y in zip(np.ravel(states), np.ravel([*motion.theta, *motion.theta])))
    for beyond in (np.nextafter(least, -math.inf), least - 1e-3, np.nextafter(largest, math.inf), largest + 1e-3):
        with pytest.raises(QuantityError, match="known from t ="):
            motion.at(beyond)


@each_kind
@pytest.mark.parametrize(("t", "error", "words"), [
    (1.5, QuantityError, ["known from t = 0", "1.5"]),
    ([0.0625, -0.25], QuantityError, ["known from t = 0", "-0.25"]),
    ("0.5", TextError, ["'0.5'"]),
    (["0.5"], TextError, ["0.5"]),
    (Symbol("x"), QuantityError, ["x", "no number"]),
    (math.inf, QuantityError, ["inf"]),
])
def test_times_beyond_the_steps_and_what_is_no_time_are_refused(digits, t, error, words):
    """The same exceptions in both kinds of numbers."""
    motion = simulate(ROD, [1], [0], [0, 0.125], digits=digits, dense=True)
    with pytest.raises(error) as refusal:
        motion.at(t)

    assert all(word in str(refusal.value) for word in words)


@pytest.mark.parametrize(("angle", "error"), [("pi", TextError), (Symbol("x"), QuantityError),
                                              (math.nan, QuantityError), (Float("inf"), QuantityError)])
def test_a_crossing_has_a_number_for_its_angle(angle, error):
    """Text, symbols and infinities are refused where the crossing is made."""
    with pytest.raises(error):
        Crossing(1, angle)


@pytest.mark.parametrize(("arguments", "words"), [
    ((1.0, 1), ["rod is 1.0", "its number"]),
    (("1", 1), ["rod is '1'"]),
    ((True, 1), ["rod is True"]),
    ((0, 1), ["rod is 0"]),
    ((1, 1, "up"), ["direction is 'up'", "-1 for shrinking"]),
    ((1, 1, 5), ["direction is 5"]),
    ((1, 1, True), ["direction is True"]),
    ((1, 1, 0.5), ["direction is 0.5"]),
    ((1, 1, None), ["direction is None"]),
])
def test_a_crossing_has_the_number_of_a_rod_and_a_direction(arguments, words):
    """What is neither is refused where the crossing is made; whole numbers of NumPy and SymPy are numbers too."""
    with pytest.raises(QuantityError) as refusal:
        Crossing(*arguments)

    assert all(word in str(refusal.value) for word in words)
    assert Crossing(np.int64(1), 1, Integer(-1)) == Crossing(1, 1, -1)


@pytest.mark.parametrize("events", [[Crossing(1, 1)], [], Crossing(1, 1), "flips", 5, {"down": 1}])
def test_events_have_names(events):
    """They come as a mapping."""
    with pytest.raises(SceneError, match="event"):
        simulate(ROD, [1], [0], [0, 1], events=events)


@pytest.mark.parametrize("system", [euler_lagrange(Scene([Rod.bob(1, 1)])), "rods", None])
def test_flips_are_those_of_a_compiled_chain(system):
    """Equations have no rods that turn over; their chain has."""
    with pytest.raises(NotASceneError, match=r"scene\.compile"):
        flips(system)


def test_events_are_checked_before_the_motion_is_followed():
    """A thousand seconds in 200 digits are not waited for."""
    with pytest.raises(SceneError, match="rods 1 to 1"):
        simulate(ROD, [1], [0], [0, 1000], digits=200, events={"x": Crossing(2, 0)})


def test_states_between_the_times_are_kept_on_request_alone():
    """Events leave nothing behind that dense=True was not asked for."""
    motion = simulate(ROD, [1], [0], [0, 0.125], digits=35, events={"down": Crossing(1, 0)})
    with pytest.raises(QuantityError, match="dense=True"):
        motion.at(0)

    assert motion.events["down"].shape == (0,)


def test_an_accuracy_beyond_floats_has_states_and_events_too():
    """accuracy=1e-33 takes as many digits as it needs, and both come with them."""
    motion = simulate(BOB, [1], [0], [0, 1], accuracy=1e-33, dense=True, events={"down": Crossing(1, 0)})
    (angle,), _ = motion.at(motion.events["down"][0])

    assert motion.accurate and abs(angle) < 1e-33


@each_kind
@pytest.mark.parametrize("times", [[1], [3, 3], [-2]], ids=str)
def test_a_motion_of_no_length_is_its_start(digits, times):
    """At whatever time it is."""
    motion = simulate(TWO, [2, 1], [0, 3], times, digits=digits)

    assert [float(x) for x in motion.theta[-1]] == [2, 1] and [float(x) for x in motion.omega[-1]] == [0, 3]


def test_a_time_that_is_a_symbol_is_refused():
    """With its name."""
    with pytest.raises(QuantityError, match="times holds t, which is no number"):
        simulate(TWO, [2, 1], [0, 3], [0, Symbol("t")])


def test_threads_wait_for_each_other_and_change_no_digit():
    """The precision of python-flint belongs to the whole process: motions, states and events, and the other package."""
    F, before = FloquetMatrix(Matrix([[0, 1], [-cos(t), 0]]), t, 0), ctx.prec

    def numbers(digits):
        if digits > 100:
            return F.enclosure({}, digits)[0, 0].mid().man_exp()
        motion = simulate(BOB, [1], [0], [0, 0.5], digits=digits, dense=True, events={"down": Crossing(1, 0.75)})
        return motion.theta.tolist(), motion.at(0.25)[0][0], motion.events["down"][0]

    wanted = [40, 80, 200] * 2
    assert in_threads(numbers, wanted) == [numbers(digits) for digits in wanted] and ctx.prec == before


@each_kind
@pytest.mark.parametrize("dense", [False, True])
@pytest.mark.parametrize("copied", [lambda x: pickle.loads(pickle.dumps(x)), copy.deepcopy], ids=["pickle", "deepcopy"])
def test_a_motion_that_was_kept_in_a_file_is_the_same_motion(digits, dense, copied):
    """Every digit of states, events and what lies between, in numbers of one context; == and hash are identity."""
    motion = simulate(TWO, [2, 1], [0, 1], [HALF, 0], digits=digits, dense=dense, events={"x": Crossing(1, 1.75)})
    again = copied(motion)

    for name in ("times", "theta", "omega", "turns", "wrapped", "energy", "error"):
        assert getattr(again, name).tolist() == getattr(motion, name).tolist()
    assert again.events["x"].tolist() == motion.events["x"].tolist() and len(again.events["x"]) == 1
    assert again.method == motion.method and again.chain.energy_scale == motion.chain.energy_scale
    if dense:
        assert all((x == y).all() for x, y in zip(again.at([0.1, 1 / 3]), motion.at([0.1, 1 / 3]), strict=True))
    if digits is not None:
        assert {x.context.dps for x in again.theta.flat} == {digits} and len({x.context for x in again.theta.flat}) == 1
    assert motion == motion and again != motion and len({again, motion}) == 2


@each_kind
def test_a_motion_cannot_be_written_to(digits):
    """Nor one that was read from a file."""
    motion = simulate(FREE, [0], [1], [0, 1], digits=digits, events={"x": Crossing(1, HALF)})
    for found in (motion, pickle.loads(pickle.dumps(motion))):
        for array in (found.times, found.theta, found.omega, found.turns, found.wrapped, found.energy, found.error,
                      found.events["x"]):
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 7


@pytest.mark.parametrize("digits", [20, 40])
@pytest.mark.parametrize("angle", [1e6, 1e40, -1e300])
def test_large_angles_lose_no_digit(digits, angle):
    """What is left of 1e300 rad within a turn has the digits asked for, and so have its motion and its crossings."""
    with mpmath.workdps(400):
        turns = int(mpmath.nint(angle / (2 * mpmath.pi)))
        rest = angle - 2 * mpmath.pi * turns
    options = {"digits": digits, "dense": True, "events": {"down": Crossing(1, 0)}}
    motion = simulate(TWO, [angle, 2], [0, 0], [0, 1], **options)
    same = simulate(TWO, [Rational(angle) - 2 * pi * turns, 2], [0, 0], [0, 1], **options | {"digits": digits + 20})

    assert motion.turns[0, 0] == turns and abs(motion.wrapped[0, 0] - rest) <= motion.error[0]
    assert (motion.turns - same.turns).tolist() == [[turns, 0]] * 2
    assert apart(motion.wrapped[1], same.wrapped[1]) <= motion.error[1] < 1e-15
    assert len(same.events["down"]) > 0 and apart(motion.events["down"], same.events["down"]) < motion.error[1]


@pytest.mark.parametrize("digits", [None, 20])
def test_an_angle_of_1e300_can_be_followed(digits):
    """In floats too, from lists and from arrays; what is left of it within a turn is right."""
    with mpmath.workdps(400):
        rest = float(mpmath.fmod(1e300, 2 * mpmath.pi))
    for start in ([1e300, 2], np.array([1e300, 2])):
        motion = simulate(TWO, start, [0, 0], [0, 1], digits=digits)
        assert abs(math.remainder(float(motion.wrapped[0, 0]) - rest, 2 * math.pi)) < 4e-15


def test_times_of_1e16_have_the_digits_asked_for():
    """The chain does not know what time it is."""
    late, early = (simulate(TWO, [1, 2], [0, 0], [start, start + 2], digits=20) for start in (10**16, 0))
    assert apart(late.theta, early.theta) < 1e-17 and late.error[-1] < 1e-17


@pytest.mark.parametrize("digits", [None, 20])
def test_a_late_motion_of_no_length_is_its_start(digits):
    """No step is needed, however small steps are beside the time."""
    motion = simulate(TWO, [1, 2], [3, 0], [1e300, 1e300], digits=digits)
    assert motion.theta.tolist() == [[1, 2]] * 2 and motion.accurate


@pytest.mark.parametrize("digits", [None, 20])
def test_tables_of_times_are_refused(digits):
    """They were taken for rods."""
    motion = simulate(TWO, [1, 2], [0, 0], [0, 1], digits=digits, dense=True)
    with pytest.raises(QuantityError, match=r"\(2, 2\)"):
        motion.at([[0, 1], [0, 0.5]])
