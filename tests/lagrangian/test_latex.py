"""What notebooks show: LaTeX of every public class."""

import inspect

import numpy as np
from sympy import pi, symbols

import lagrangian
from lagrangian import (
    CompiledChain,
    Crossing,
    Ensemble,
    Rod,
    Scene,
    Support,
    Trajectories,
    compile_equations,
    euler_lagrange,
    linearize,
    normal_modes,
    simulate,
)


def things():
    """One value of every public class."""
    chain = CompiledChain([1, 1], [1, 1], [0.5, 0.5], [0.6, 0.6], upright=False)
    scene = Scene([Rod.bob(1, 1)], upright=False)
    equations = euler_lagrange(scene)
    linear = linearize(equations)
    motion = simulate(chain, [1, 2], [0, 0], [0, 1, 2])
    motions = simulate(chain, [[1, 2], [1, 1]], [[0, 0], [0, 0]], [0, 1])
    return [Rod.bob(1, 1), Support(), scene, equations, linear, linear.first_order(symbols("omega0", positive=True)),
            normal_modes(linear), chain, Ensemble(np.ones((3, 2)), [1, 1], [0.5, 0.5], [0.6, 0.6]),
            compile_equations(euler_lagrange(Scene([Rod.bob(1, 1)], gravity=9.81))), Crossing(2, pi / 2, -1), motion,
            motions]


def test_every_public_class_has_latex():
    """No class of values is left out, and braces match."""
    classes = {c for c in vars(lagrangian).values()
               if inspect.isclass(c) and c.__name__ in lagrangian.__all__ and not issubclass(c, Exception)}
    assert classes == {type(thing) for thing in things()}
    for thing in things():
        latex = thing._repr_latex_()
        assert latex.startswith("$") and latex.endswith("$") and latex.count("{") == latex.count("}")


def test_crossings_say_which_way():
    """An angle modulo a turn, and the sign of its rate."""
    assert Crossing(2, pi / 2, -1)._repr_latex_() == (
        r"$\theta_{2} = \frac{\pi}{2} \pmod{2\pi}, \quad \dot\theta_{2} < 0$")
    assert Crossing(1, 0)._repr_latex_() == r"$\theta_{1} = 0 \pmod{2\pi}$"


def test_motions_say_their_error():
    """The last estimate, with two digits."""
    chain = CompiledChain([1], [1], [0.5], [0.6], upright=False)
    motion = simulate(chain, [0], [0], [0, 0.5])
    assert motion._repr_latex_().startswith(r"$\theta_1, \ldots, \theta_{1}(t), \quad t = 0.0 \ldots 0.5, \quad")
    assert Trajectories(())._repr_latex_() == r"$\emptyset$"
