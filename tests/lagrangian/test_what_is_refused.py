"""What has no answer is refused by name, before SymPy sees text, with the value in the message."""

import math
from fractions import Fraction

import flint
import mpmath
import numpy as np
import pytest
from sympy import Abs, Function, Heaviside, I, Matrix, Rational, Symbol, besselj, cos, nan, oo, pi, sin, sqrt, symbols

from lagrangian import (
    CompiledChain,
    Crossing,
    DriveError,
    Ensemble,
    InhomogeneousError,
    LagrangianError,
    NameClashError,
    NotAnEquilibriumError,
    NotAQuantityError,
    NotASceneError,
    NotDecoupledError,
    NotPeriodicError,
    QuantityError,
    Rod,
    Scene,
    SceneError,
    Support,
    TextError,
    compile_equations,
    euler_lagrange,
    linearize,
    normal_modes,
    simulate,
)

m, l, g, t, epsilon, omega0 = symbols("m l g t epsilon omega0")
rod = Rod.uniform(m, l)
driven = Support(eta=epsilon * cos(omega0 * t))


def linear(rods=(rod,), support=driven, **options):
    """The linear equations of ``rods``, driven vertically unless said otherwise."""
    return linearize(euler_lagrange(Scene(rods, support, **options)))


@pytest.mark.parametrize("ask, error, word", [
    (lambda: Rod.uniform(1, 0), QuantityError, "length"),
    (lambda: Rod.uniform(1, -2), QuantityError, "-2"),
    (lambda: Rod.uniform(0, 1), QuantityError, "mass"),
    (lambda: Rod.bob(-1, 1), QuantityError, "mass"),
    (lambda: Rod.bob(1, Symbol("l", negative=True)), QuantityError, "positive"),
    (lambda: Rod(1, 1, 1, Rational(1, 2)), QuantityError, "moment of inertia"),
    (lambda: Rod(m, l, l, l / 2), QuantityError, "moment of inertia"),
    (lambda: Rod(1, 1, 0, 0), QuantityError, "gyration"),
    (lambda: Rod.uniform(float("nan"), 1), QuantityError, "finite"),
    (lambda: Rod.uniform(1, float("inf")), QuantityError, "finite"),
    (lambda: Rod.uniform(1, oo), QuantityError, "finite"),
    (lambda: Rod.uniform(nan, 1), QuantityError, "finite"),
    (lambda: Rod.uniform(1, I), QuantityError, "real"),
    (lambda: Rod.uniform(True, 1), NotAQuantityError, "truth"),
    (lambda: Rod.uniform(Matrix([1]), 1), NotAQuantityError, "scalar"),
    (lambda: Rod.uniform(None, 1), NotAQuantityError, "None"),
    (lambda: Rod.uniform(1j, 1), NotAQuantityError, "scalar"),
    (lambda: Rod.uniform(mpmath.iv.mpf(1), 1), NotAQuantityError, "ivmpf"),
    (lambda: Rod.uniform(mpmath.apery, 1), NotAQuantityError, "Apery"),
    (lambda: Scene([]), SceneError, "positive"),
    (lambda: Scene(-2), SceneError, "positive"),
    (lambda: Scene(rod), SceneError, "list"),
    (lambda: Scene([rod, 3]), NotAQuantityError, "Rod"),
    (lambda: Scene([rod], support=(0, 1)), NotAQuantityError, "Support"),
    (lambda: Scene([rod], upright=1), NotAQuantityError, "True"),
    (lambda: Scene([rod], t=3), NotAQuantityError, "Symbol"),
    (lambda: Scene([rod] * 2, damping=[1]), SceneError, "2 rods"),
    (lambda: Scene([rod] * 2, springs=[1, 2, 3]), SceneError, "3 values"),
    (lambda: Scene([rod], damping=[-1]), QuantityError, "-1"),
    (lambda: Scene([rod], damping=1), NotAQuantityError, "list"),
    (lambda: Scene([rod], gravity=oo), QuantityError, "gravity"),
    (lambda: Scene([rod], gravity=g + cos(t)), QuantityError, "eta''"),
    (lambda: Scene([Rod.uniform(t, l)]), QuantityError, "constant"),
    (lambda: Scene([Rod.uniform(Symbol("theta1"), l)]), QuantityError, "theta1, the name of a coordinate"),
    (lambda: Scene([rod], Support(eta=Symbol("theta1"))), DriveError, "theta1"),
    (lambda: Scene([rod], Support(xi=Function("theta1")(t))), DriveError, "theta1"),
    (lambda: Scene([rod], Support(eta=Abs(cos(t)))), DriveError, "twice"),
    (lambda: Scene([rod], Support(eta=Heaviside(t))), DriveError, "twice"),
    (lambda: Scene([rod], Support(eta=cos(t)), t=Symbol("t", real=True)), DriveError, "assumptions"),
    (lambda: Scene([rod], Support(eta=l * cos(omega0))), DriveError, "which is the time"),
    (lambda: Scene([rod], driven, t=Symbol("tau")), DriveError, "pass it, as in Scene(..., t=t)"),
    (lambda: Scene([rod], Support(eta=cos(Symbol("tau"))), t=t), DriveError, "the time is t"),
    (lambda: Scene([rod], Support(cos(Symbol("tau")), cos(t))), DriveError, "xi = cos(tau)"),
    (lambda: Support(eta=I), QuantityError, "real"),
    (lambda: Support(eta=nan), QuantityError, "finite"),
    (lambda: euler_lagrange(rod), NotASceneError, "Scene"),
    (lambda: linearize(Scene([rod])), NotASceneError, "euler_lagrange"),
    (lambda: normal_modes(Scene([rod])), NotASceneError, "linearize"),
    (lambda: linearize(euler_lagrange(Scene([rod] * 2)), about=[pi / 4, 0]), NotAnEquilibriumError, "equilibrium"),
    (lambda: linearize(euler_lagrange(Scene([rod], springs=[1])), about=[pi]), NotAnEquilibriumError, "pi"),
    (lambda: linearize(euler_lagrange(Scene([rod])), about=[0, 0]), SceneError, "2 angles"),
    (lambda: linearize(euler_lagrange(Scene([rod])), about=[t]), QuantityError, "constant"),
    (lambda: linear(support=Support(xi=cos(omega0 * t))).first_order(omega0), InhomogeneousError, "homogeneous()"),
    (lambda: linear(support=Support(eta=Function("eta")(t))).first_order(omega0), NotPeriodicError, "eta"),
    (lambda: linear(support=Support(eta=t**4)).first_order(omega0), NotPeriodicError, "t**2"),
    (lambda: linear(support=Support(eta=cos(3 * t))).first_order(sqrt(2)), NotPeriodicError, "cos(3*t)"),
    (lambda: linear(support=Support(eta=cos(t**2))).first_order(1), NotPeriodicError, "t**2"),
    (lambda: linear().first_order(0), QuantityError, "omega0"),
    (lambda: linear().first_order(t), QuantityError, "omega0"),
    (lambda: linear([Rod.uniform(Symbol("tau"), l)]).first_order(omega0), NameClashError, "the scene's tau."),
    (lambda: linear([Rod.uniform(m, l)], gravity=Symbol("v")).first_order(omega0), NameClashError, "v, or pass dim"),
    (lambda: linear().first_order(Symbol("omega0", positive=True)), NameClashError, "share the name"),
    (lambda: normal_modes(linear()).mathieu(2 * Symbol("omega0", real=True)), NameClashError, "share the name"),
    (lambda: linear([rod, Rod.bob(m, l)]).divided(), SceneError, "equal"),
    (lambda: linear().divided(0), QuantityError, "not 0"),
    (lambda: normal_modes(linear([rod] * 2, springs=[1, 1])), NotDecoupledError, "function of time"),
    (lambda: normal_modes(linear([rod], damping=[1])), NotDecoupledError, "damping"),
    (lambda: normal_modes(linear([rod] * 2, Support(xi=t**2))), InhomogeneousError, "homogeneous()"),
    (lambda: normal_modes(linear([Rod.uniform(m, x) for x in symbols("a b c")])), NotDecoupledError, "a, b, c"),
    (lambda: normal_modes(linear(), digits=0), QuantityError, "digits"),
    (lambda: normal_modes(linear(support=Support(eta=cos(2 * t)))).mathieu(1), NotPeriodicError, "2*tau"),
])
def test_impossible_question_is_refused(ask, error, word):
    """The named exception, whose message holds the value or the word that a reader looks for."""
    with pytest.raises(error) as refused:
        ask()

    assert issubclass(error, LagrangianError) and issubclass(error, (ValueError, TypeError))
    assert word in str(refused.value)


TRAP = "__import__('sys').exit(7)"


@pytest.mark.parametrize("ask", [
    lambda: Rod(TRAP, 1, 1, 1), lambda: Rod(1, TRAP, 1, 1), lambda: Rod(1, 1, TRAP, 1), lambda: Rod(1, 1, 1, TRAP),
    lambda: Rod.uniform(TRAP, 1), lambda: Rod.uniform(1, TRAP), lambda: Rod.bob(1, TRAP),
    lambda: Support(TRAP), lambda: Support(0, TRAP), lambda: Scene(TRAP), lambda: Scene([TRAP]),
    lambda: Scene([rod], TRAP), lambda: Scene([rod], gravity=TRAP), lambda: Scene([rod], damping=TRAP),
    lambda: Scene([rod], damping=[TRAP]), lambda: Scene([rod], springs=[TRAP]), lambda: Scene([rod], t="t"),
    lambda: linearize(euler_lagrange(Scene([rod])), about=TRAP),
    lambda: linearize(euler_lagrange(Scene([rod])), about=[TRAP]),
    lambda: linear().first_order(TRAP), lambda: linear().divided(TRAP), lambda: normal_modes(linear(), TRAP),
    lambda: normal_modes(linear()).mathieu(TRAP),
])
def test_text_is_never_evaluated(ask):
    """TextError wherever mathematics is expected."""
    with pytest.raises(TextError, match="never evaluated"):
        ask()


def test_a_support_may_stay_at_a_height_without_a_number():
    """Nor is a parameter taken for the time that stands beside the time."""
    tau = Symbol("tau")
    still = linear(support=Support(l, epsilon), t=tau)

    assert still.stiffness == linear(support=Support()).stiffness
    assert Scene([rod], Support(eta=cos(t / tau))).support_acceleration[1] == -cos(t / tau) / tau**2


def test_numbers_of_every_kind_are_exact():
    """A float is the dyadic number that it is; fractions stay fractions."""
    assert Rod.uniform(0.5, Fraction(1, 3)) == Rod.uniform(Rational(1, 2), Rational(1, 3))
    assert Rod.bob(0.1, 1).mass == Rational(3602879701896397, 36028797018963968)
    assert Support(eta=0.25 * cos(t)).eta == cos(t) / 4


def test_mpmath_numbers_are_exact_whatever_context_made_them():
    """So that a state computed with 40 digits can be given back; what is not finite is refused."""
    context = mpmath.mp.clone()
    context.dps = 40
    third = context.mpf(1) / 3

    assert abs(Support(eta=third).eta - Rational(1, 3)) < Rational(1, 10**40) and Rod.bob(third / third, 1).mass == 1
    with pytest.raises(QuantityError, match="finite"):
        Support(eta=context.inf)


@pytest.mark.parametrize(("ask", "error", "words"), [
    (lambda: CompiledChain(np.array(1.0), [1], [1], [1]), NotAQuantityError, "one mass for each rod"),
    (lambda: Scene([rod], damping=np.array(3.0)), NotAQuantityError, r"damping is array\(3.\): give a list"),
    (lambda: Scene([rod], springs=np.array(3)), NotAQuantityError, r"springs is array\(3\): give a list"),
    (lambda: Scene(np.array(rod, dtype=object)), SceneError, "length of a list"),
    (lambda: linearize(euler_lagrange(Scene([rod])), about=np.array(0.0)), NotAQuantityError, "a list of 1 angles"),
])
def test_an_array_without_axes_is_not_a_list(ask, error, words):
    """As a number is not."""
    with pytest.raises(error, match=words):
        ask()


@pytest.mark.parametrize("value", [np.array([1, 0]), m > 1, None, "no"], ids=str)
@pytest.mark.parametrize("ask", [
    lambda value: simulate(CompiledChain([1], [1], [1], [1]), [1], [0], [0, 1], dense=value),
    lambda value: linear().first_order(omega0, dimensionless=value),
    lambda value: normal_modes(linear()).mathieu(omega0, dimensionless=value),
])
def test_yes_and_no_are_truth_values(ask, value):
    """Arrays and relations between Symbols have none, and text always the same."""
    with pytest.raises(NotAQuantityError, match="give True or False"):
        ask(value)
    assert ask(np.True_) is not None


UNLIKE = [np.ones((2, 2)), np.ones((2, 3))]


@pytest.mark.parametrize("values", [UNLIKE, [Matrix([1, 2]), np.ones(2)], [x * mpmath.mpf(1) for x in UNLIKE]], ids=[
    "arrays", "a Matrix and an array", "arrays of mpmath's"])
@pytest.mark.parametrize("ask", [
    lambda chain, values: chain.acceleration(0, values, [0, 0]),
    lambda chain, values: chain.acceleration(0, [0, 0], values),
    lambda chain, values: chain.acceleration(mpmath.mpf(0), values, [0, 0]),
    lambda chain, values: chain.energy(values, [0, 0]),
    lambda chain, values: Ensemble(values, 1, 1, 1),
    lambda chain, values: Ensemble([[1, 1]], 1, 1, 1, springs=values),
    lambda chain, values: Ensemble([[1, 1]], 1, 1, 1).acceleration(mpmath.mpf(0), values, [[0, 0]]),
    lambda chain, values: Scene([rod]).compile({m: values, l: 1, g: 1}),
    lambda chain, values: compile_equations(euler_lagrange(Scene([Rod.bob(1, 1)] * 2, gravity=1)),
                                            target="mpmath").acceleration(0, values, [0, 0]),
])
def test_arrays_that_make_no_array_together_are_refused(ask, values):
    """And not by NumPy, which fails to put one into the other."""
    with pytest.raises(SceneError, match="make no array together"):
        ask(CompiledChain([1, 1], [1, 1], [1, 1], [1, 1]), values)


def test_lists_of_times_of_unequal_length_are_refused():
    """Between the times too."""
    motion = simulate(CompiledChain([1], [1], [1], [1]), [1], [0], [0, 1], dense=True)

    with pytest.raises(QuantityError, match="a list of times"):
        motion.at([[0, 1], [0]])


@pytest.mark.parametrize("place", [nan, 0.5, None, [0, 1]], ids=str)
def test_a_chain_is_found_by_an_integer(place):
    """In an ensemble and among motions; what is none is named."""
    ensemble = Ensemble([[1], [2]], 1, 1, 1)
    for chains in (ensemble, simulate(ensemble, [1], [0], [0, 1])):
        with pytest.raises(NotAQuantityError, match="is no integer: give one, or a slice"):
            chains[place]
        with pytest.raises(IndexError, match="a number of too many digits to print is none of them"):
            chains[10**5000]


def test_every_rod_of_an_ensemble_has_its_four_numbers():
    """None is for joints."""
    with pytest.raises(NotAQuantityError, match="center is None"):
        Ensemble([[1, 1]], 1, None, 1)


def test_an_argument_that_a_chain_has_not_is_said_by_its_name():
    """By that of the class which was called."""
    with pytest.raises(TypeError, match=r"CompiledChain.__init__\(\) got an unexpected keyword argument 'g'"):
        CompiledChain([1], [1], [1], [1], g=1)


def test_numbers_that_sympy_cannot_tell_apart_make_a_rod():
    """``sin(1)**2 + cos(1)**2 >= 1`` has no truth value for SymPy; the rod is a bob, whose theta'' is -g sin(theta)."""
    chain = CompiledChain([1.0], [1.0], [1], [sin(1) ** 2 + cos(1) ** 2], gravity=2, upright=False)

    assert abs(chain.acceleration(0, [1.0], [0.0])[0] + 2 * math.sin(1)) < 1e-15
    with pytest.raises(QuantityError, match="gyration >= "):
        CompiledChain([1.0], [1.0], [1], [sin(1) ** 2 + cos(1) ** 2 - Rational(1, 10**9)])


MASKED = np.ma.array([1.0, 2.0], mask=[False, True])


@pytest.mark.parametrize("ask", [
    lambda chain: chain.acceleration(0, MASKED, [0.0, 0.0]),
    lambda chain: simulate(chain, MASKED, [0.0, 0.0], [0, 1]),
    lambda chain: simulate(chain, [0.0, 0.0], [0.0, 0.0], MASKED),
    lambda chain: CompiledChain(MASKED, [1, 1], [1, 1], [1, 1]),
    lambda chain: Ensemble([[1, 1]] * 3, MASKED, 1, 1),
])
def test_masks_are_not_lost(ask):
    """The entries behind them would count."""
    with pytest.raises(NotAQuantityError, match="mask"):
        ask(CompiledChain([1, 1], [1, 1], [1, 1], [1, 1]))


BIG = 10**5000


@pytest.mark.parametrize(("ask", "words"), [
    (lambda chain: Rod.uniform(-BIG, 2), "mass is a number of too many digits"),
    (lambda chain: Rod(1, 1, BIG, 2), "center = a number of too many digits"),
    (lambda chain: Scene([rod], damping=[-BIG]), "a number of too many digits"),
    (lambda chain: Scene([rod]).compile({m: -BIG, l: 1, g: 1}), "a number of too many digits"),
    (lambda chain: CompiledChain([1], [1], [BIG], [1]), "a number of too many digits"),
    (lambda chain: CompiledChain([1], [1], [1], [1], damping=[-BIG]), "a number of too many digits"),
    (lambda chain: Crossing(-BIG, 0), "a number of too many digits"),
    (lambda chain: normal_modes(linear(), digits=BIG), "at most 100000"),
    (lambda chain: normal_modes(linear(), digits=-BIG), "a number of too many digits"),
    (lambda chain: simulate(chain, [1, 1], [0, 0], [0, 1], digits=BIG), "at most 100000"),
    (lambda chain: simulate(chain, [1, 1], [0, 0], [0, 1], accuracy=BIG), "positive number.*too many"),
    (lambda chain: simulate(chain, [1, BIG], [0, 0], [0, 1]), "beyond the range of float64"),
    (lambda chain: simulate(chain, [1, 1], [0, BIG], [0, 1], method="DOP853"), "beyond the range of float64"),
    (lambda chain: simulate(chain, [1, 1], [0, 0], [0, BIG]), "beyond the range of float64"),
    (lambda chain: chain.acceleration(0, [1, BIG], [0, 0]), "beyond the range of float64"),
    (lambda chain: Ensemble([[BIG, 1]], 1, 1, 1), "beyond the range of float64"),
])
def test_integers_that_python_does_not_print_are_refused_by_name(ask, words):
    """And not by Python's ValueError of 4300 digits, or as an infinity that nobody gave."""
    with pytest.raises(QuantityError, match=words):
        ask(CompiledChain([1, 1], [1, 1], [1, 1], [1, 1]))


def test_an_integer_that_python_does_not_print_is_no_equilibrium():
    """It is no multiple of pi, and SymPy cannot say so: it prints what it puts in order."""
    with pytest.raises(NotAnEquilibriumError, match="too many digits to print"):
        linearize(euler_lagrange(Scene([rod] * 2)), about=[BIG, 0])


@pytest.mark.parametrize("ask", [
    lambda chain: simulate(chain, {5: 1, 7: 2}, [0, 0], [0, 1]),
    lambda chain: simulate(chain, [1, 1], {5, 7}, [0, 1]),
    lambda chain: simulate(chain, [1, 1], [0, 0], {0: 0, 1: 1}),
    lambda chain: chain.acceleration(0, {5: 1, 7: 2}, [0, 0]),
    lambda chain: CompiledChain({1: 5, 2: 3}, [1, 1], [1, 1], [1, 1]),
    lambda chain: CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], support_acceleration={1, 2}),
    lambda chain: CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], springs={1, 2}),
    lambda chain: Ensemble({1: 5, 2: 3}, 1, 1, 1),
    lambda chain: Scene({rod: 1}),
    lambda chain: Scene([rod], damping={0: 1}),
    lambda chain: linearize(euler_lagrange(Scene([rod] * 2)), about={0, pi}),
])
def test_neither_the_keys_of_a_mapping_nor_a_set_are_a_list(ask):
    """Angles given by name, ``{theta1: 0}``, would be the names; sets have no first and last."""
    with pytest.raises(NotAQuantityError, match="no order here"):
        ask(CompiledChain([1, 1], [1, 1], [1, 1], [1, 1]))


def test_numbers_of_flint_are_numbers():
    """Rationals, integers and exact balls, as lengths and as angles; balls with a radius are none."""
    third = flint.fmpq(1, 3)
    chain = CompiledChain([1, flint.arb(1)], [third, flint.fmpz(2)], [0, 1], [third, flint.arb(2)])

    expected = CompiledChain([1, 1], [Rational(1, 3), 2], [0, 1], [Rational(1, 3), 2])
    assert (chain.rods == expected.rods).all()
    assert Rod(flint.arb(3) / 4, 1, 1, 1).mass == Rational(3, 4)
    with pytest.raises(QuantityError, match="is the ball .*give its middle"):
        Rod(flint.arb(1) / 3, 1, 1, 1)
    with pytest.raises(QuantityError, match="not finite"):
        Rod(flint.arb("inf"), 1, 1, 1)
    assert (chain.acceleration(0, [third, 0], [0, 1]) == expected.acceleration(0, [Fraction(1, 3), 0], [0, 1])).all()


@pytest.mark.parametrize(("ask", "words"), [
    (lambda chain: chain.acceleration(0, np.array([1, 2], dtype="m8[s]"), [0, 0]), "unit of time"),
    (lambda chain: simulate(chain, [1, 1], [0, 0], [0, 1], progress=3), "progress is 3"),
    (lambda chain: simulate(chain, [1, 1], [0, 0], [0, 1], digits=10**9), "at most 100000"),
    (lambda chain: Scene([rod], driven).compile({m: 1, l: 1, g: 10, epsilon: 0.1, omega0: 3, t: 1}),
     "time t is no parameter.*value 1"),
    (lambda chain: compile_equations(euler_lagrange(Scene([rod], driven)), {t: 0.5}), "time t is no parameter"),
    (lambda chain: Scene([rod], driven).compile({m: [1, 2], l: 1, t: [0, 1]}), "time t is no parameter"),
    (lambda chain: Scene([rod]).compile({Symbol("m", positive=True): 1, l: 1, g: 10}), "m is left .*share the name"),
    (lambda chain: Scene([rod]).compile({m: [1, 2], l: 1, Symbol("g", real=True): 10}), "g is left .*share the name"),
    (lambda chain: compile_equations(euler_lagrange(Scene([rod])), {m: 1, l: 1, Symbol("g", real=True): 10}),
     "g is left .*share the name"),
    (lambda chain: drum().acceleration(0.5, [1], [0]), "besselj.*target='mpmath'"),
    (lambda chain: compile_equations(euler_lagrange(Scene([Rod.bob(1, 1)] * 2, gravity=10))).acceleration(
        0, [1, 1], [1e200, 0]), "beyond float64"),
])
def test_units_of_time_and_what_has_no_number_are_named(ask, words):
    """Nothing ends in an error of NumPy or python-flint."""
    with pytest.raises((QuantityError, NotAQuantityError, DriveError), match=words):
        ask(CompiledChain([1, 1], [1, 1], [1, 1], [1, 1]))


def drum():
    """A bob on a support that moves by a function NumPy lacks, compiled."""
    t = Symbol("t")
    return compile_equations(euler_lagrange(Scene([Rod.bob(1, 1)], Support(eta=besselj(0, t)), gravity=10, t=t)))
