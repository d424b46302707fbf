"""The symbolic equations as functions of numbers, for every target, and names that would be code."""

import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from sympy import Rational, Symbol, cos, pi, sin, symbols

from lagrangian import (
    NotASceneError,
    QuantityError,
    Rod,
    Scene,
    SceneError,
    Support,
    TextError,
    compile_equations,
    euler_lagrange,
)

t = Symbol("t")
# Writing out and compiling the code of one scene takes a tenth of a second.
measured = settings(max_examples=min(30, settings.default.max_examples), deadline=None)
positive = st.builds(Rational, st.integers(1, 20), st.integers(1, 9))


@st.composite
def scenes(draw):
    """One to six rods, any drive, dampers, springs."""
    n = draw(st.integers(1, 6))
    rods = [Rod(draw(positive), draw(positive), draw(positive) / 20, 3) for _ in range(n)]
    constants = st.none() | st.lists(positive, min_size=n, max_size=n)
    drive = st.sampled_from([Rational(0), cos(2 * t) / 3, t * sin(t)])
    return Scene(rods, Support(draw(drive), draw(drive)), draw(positive), draw(st.booleans()), draw(constants),
                 draw(constants), t)


@measured
@given(scenes(), st.integers(0, 10**6))
def test_numpy_code_equals_the_recursion(scene, seed):
    """Dense and O(n), two routes to one number, to 12 digits."""
    rng = np.random.default_rng(seed)
    theta, omega = rng.uniform(-3, 3, len(scene)), rng.normal(size=len(scene))
    dense = compile_equations(euler_lagrange(scene)).acceleration(0.7, theta, omega)
    mine = scene.compile().acceleration(0.7, theta, omega)

    assert abs(dense - mine).max() < 1e-12 * max(1, abs(mine).max())


@measured
@given(scenes(), st.integers(0, 10**6))
def test_mpmath_code_equals_the_recursion_to_45_digits(scene, seed):
    """The same at 50 digits."""
    rng = np.random.default_rng(seed)
    with mpmath.workdps(50):
        floats = rng.uniform(-3, 3, len(scene)), rng.normal(size=len(scene))
        state = [[mpmath.mpf(float(x)) for x in part] for part in floats]
        dense = compile_equations(euler_lagrange(scene), target="mpmath").acceleration(mpmath.mpf(1) / 3, *state)
        mine = scene.compile().acceleration(mpmath.mpf(1) / 3, *state)

        assert max(abs(x - y) for x, y in zip(dense, mine)) < mpmath.mpf(10) ** -45 * max(1, *map(abs, mine), 1)


def test_machine_code_equals_numpy():
    """target="numba", for a driven, damped, sprung triple rod."""
    pytest.importorskip("numba")
    scene = Scene([Rod.uniform(1, 1)] * 3, Support(cos(t), sin(2 * t)), 10, False, [1, 2, 3], [1, 0, 1], t)
    equations = euler_lagrange(scene)
    state = 0.3, [0.1, 0.2, 0.3], [1.0, 2.0, 3.0]
    one, other = (compile_equations(equations, target=target).acceleration(*state) for target in ("numpy", "numba"))

    assert abs(one - other).max() < 1e-12


@pytest.mark.parametrize("target", ["numpy", "mpmath", "numba"])
def test_states_of_every_kind_have_an_answer_or_a_name(target):
    """One exact rod, fractions, pi; and nan, text, other shapes, rods without mass."""
    one = compile_equations(euler_lagrange(Scene([Rod.bob(1, 1)], gravity=10)), target=target)
    m = Symbol("m")
    light = compile_equations(euler_lagrange(Scene([Rod.bob(1, 1), Rod.bob(m, 1)], gravity=10)), {m: 0}, target)

    assert abs(float(one.acceleration(Rational(1, 3), [pi / 6], [Fraction(1, 2)])[0]) - 5) < 1e-15
    for state, error, word in (([float("nan")], QuantityError, "finite"), (["1"], TextError, "never"),
                               (1.0, SceneError, "shape"), ([[1.0]], SceneError, "shape")):
        with pytest.raises(error, match=word):
            one.acceleration(0, state, [0])
    with pytest.raises(TextError, match="never"):
        one.acceleration("0", [0], [0])
    with pytest.raises(QuantityError, match="singular"):
        light.acceleration(0, [0.3, 0.3], [1, 1])


def test_a_symbol_whose_name_is_code_stays_a_name(tmp_path):
    """Symbols are renamed before code is written, whatever they are called."""
    trap = tmp_path / "trap"
    evil = Symbol(f"open({str(trap)!r}, 'w')")
    l, g = symbols("l g")
    scene = Scene([Rod.bob(evil, l)] * 2, gravity=g)
    found = compile_equations(euler_lagrange(scene), {evil: 2, l: 1, g: 10}).acceleration(0, [0.1, 0.2], [0, 0])
    with pytest.raises(QuantityError, match="Symbol"):
        compile_equations(euler_lagrange(scene), {l: 1, g: 10})

    assert np.isfinite(found).all() and not trap.exists()


def test_what_a_scene_does_not_have_is_not_in_its_code():
    """Without drive, dampers and springs nothing but sines, cosines and rates is computed."""
    plain = compile_equations(euler_lagrange(Scene([Rod.bob(1, 1)] * 2, gravity=10)))
    sides = str(plain.equations.forcing)

    assert "Derivative(theta1(t), t)**2" in sides and sides.count("Derivative") == 2


def test_wrong_requests_are_refused():
    """Named errors, no text evaluated."""
    equations = euler_lagrange(Scene([Rod.bob(1, 1)], gravity=10))
    with pytest.raises(NotASceneError):
        compile_equations("theta1")
    with pytest.raises(SceneError, match="numpy"):
        compile_equations(equations, target="fortran")
    with pytest.raises(TextError):
        compile_equations(equations, {Symbol("m"): "1"})
    with pytest.raises(SceneError, match="1 rods"):
        compile_equations(equations).acceleration(0, [0, 0], [0, 0])


@pytest.mark.parametrize("target", ["numpy", "mpmath", "numba"])
def test_compiled_equations_can_be_sent_to_another_process(target):
    """Their code is generated again there; a fresh process has no function of this one."""
    mass, drive = Symbol("m"), Symbol("epsilon")
    equations = euler_lagrange(Scene([Rod.bob(mass, 1)] * 2, Support(eta=drive * cos(t)), 2, t=t))
    compiled = compile_equations(equations, {mass: 3, drive: Rational(1, 7)}, target)
    again = pickle.loads(pickle.dumps(compiled))
    state = Fraction(1, 3), [Fraction(1, 2), 1], [1, 2]

    assert again.target == target and repr(again) == repr(compiled)
    assert (again.acceleration(*state) == compiled.acceleration(*state)).all()


def test_compiled_equations_do_not_change():
    """Nor do the chains that they belong to."""
    compiled = compile_equations(euler_lagrange(Scene([Rod.bob(1, 1)], gravity=10)))
    with pytest.raises(AttributeError, match="do not change"):
        compiled.chain = None
