r"""Velocities, energies and the Lagrangian: the article's In[16], for any chain.

With ``s = +1`` upright and ``s = -1`` hanging, i = 1, ..., N:

    v_1 = (xi', eta')                          velocity of the near end of rod 1
    w_i = d/dt (l_i sin theta_i, s l_i cos theta_i)   of the far end with respect to the near end
    v_i = v_(i-1) + w_(i-1)
    K_i = m_i v_i.v_i / 2 + m_i R_i**2 theta_i'**2 / 2 + m_i H_i v_i.w_i / l_i
    V_i = s m_i g (sum_(k<i) l_k cos theta_k + H_i cos theta_i)
    L_n = sum_(i<=n) (K_i - V_i) - sum_(i<=n) k_i (theta_i - theta_(i-1))**2 / 2,    theta_0 = 0

The last sum, absent from the article, is the energy of springs at the joints, where a scene has them.
In[16] measures heights from the moving support.  The potential energy above the origin is larger by
``g eta(t) sum m_i``, a function of time alone, which no equation of motion sees; ``Scene.potential`` has
it and ``Scene.lagrangian``, the article's ``L[N]``, has it not.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from sympy import Add, Integer, cos, latex, sin

from .chain import CompiledChain
from .constants import NAMES, one_by_one, substitution
from .ensemble import Ensemble
from .errors import QuantityError, SceneError
from .quantities import real_number, to_float
from .scene import Arrangement
from .shaking import shaking_of_expressions

__all__ = ["K", "L", "Scene", "V", "v", "w"]


def _check_index(scene: Arrangement, i: int) -> int:
    if isinstance(i, bool) or not isinstance(i, int) or not 1 <= i <= len(scene):
        raise SceneError(f"rods are numbered 1 to {len(scene)} in this scene, and i is {i!r}.")
    return i - 1


def _add(vectors: Iterable[tuple[Any, Any]]) -> tuple[Any, Any]:
    x, y = zip(*vectors, strict=True)
    return Add(*x), Add(*y)


def _dot(a: tuple[Any, Any], b: tuple[Any, Any]) -> Any:
    return a[0] * b[0] + a[1] * b[1]


def w(scene: Arrangement, i: int) -> tuple[Any, Any]:
    """``w_i``, the velocity of the far end of rod ``i`` with respect to its near end, as a pair (x, y); m/s.

    ``w_i = (l cos theta, -s l sin theta) theta'`` ([Neves] In[16]).  Raises SceneError unless 1 <= i <= N.

    >>> from lagrangian import Rod, Scene
    >>> w(Scene([Rod.bob(1, 2)]), 1)
    (2*cos(theta1(t))*Derivative(theta1(t), t), -2*sin(theta1(t))*Derivative(theta1(t), t))
    """
    k = _check_index(scene, i)
    theta, omega, length = scene.coordinates[k], scene.velocities[k], scene.rods[k].length
    return length * cos(theta) * omega, -scene.up * length * sin(theta) * omega


def v(scene: Arrangement, i: int) -> tuple[Any, Any]:
    """``v_i``, the velocity of the near end of rod ``i``, as a pair (x, y); m/s.

    ``v_i = (xi', eta') + w_1 + ... + w_(i-1)`` ([Neves] In[16]).  Raises SceneError unless 1 <= i <= N.

    >>> from lagrangian import Rod, Scene
    >>> v(Scene([Rod.bob(1, 2)]), 1)
    (0, 0)
    """
    k = _check_index(scene, i)
    return _add([scene.support_velocity, *(w(scene, j) for j in range(1, k + 1))])


def K(scene: Arrangement, i: int) -> Any:
    """``K_i``, the kinetic energy of rod ``i``; J.

    ``K = m v.v/2 + m R**2 theta'**2/2 + m H v.w/l`` ([Neves] In[16]).  Raises SceneError unless 1 <= i <= N.

    >>> from lagrangian import Rod, Scene
    >>> K(Scene([Rod.bob(1, 2)]), 1)
    2*Derivative(theta1(t), t)**2
    """
    k = _check_index(scene, i)
    rod, velocity = scene.rods[k], v(scene, i)
    spin = rod.mass * rod.gyration**2 * scene.velocities[k] ** 2 / 2
    return rod.mass * _dot(velocity, velocity) / 2 + spin + rod.mass * rod.center / rod.length * _dot(
        velocity, w(scene, i))


def V(scene: Arrangement, i: int) -> Any:
    """``V_i``, the potential energy of the weight of rod ``i`` above the support; J.

    ``V = s m g (l_1 cos theta_1 + ... + l_(i-1) cos theta_(i-1) + H_i cos theta_i)`` ([Neves] In[16]).
    Raises SceneError unless 1 <= i <= N.

    >>> from lagrangian import Rod, Scene
    >>> V(Scene([Rod.bob(1, 2)]), 1)
    2*g*cos(theta1(t))
    """
    k = _check_index(scene, i)
    below = zip(scene.rods[:k], scene.coordinates, strict=False)
    heights = [rod.length * cos(theta) for rod, theta in below]
    rod = scene.rods[k]
    return scene.up * rod.mass * scene.gravity * Add(*heights, rod.center * cos(scene.coordinates[k]))


def joint_angles(scene: Arrangement) -> tuple[Any, ...]:
    """``delta_i = theta_i - theta_(i-1)``, the angle at every joint, ``delta_1 = theta_1``; rad."""
    before = (Integer(0), *scene.coordinates[:-1])
    return tuple(theta - previous for theta, previous in zip(scene.coordinates, before, strict=True))


def spring_energy(scene: Arrangement, n: int) -> Any:
    """``sum k_i delta_i**2 / 2`` over the first ``n`` joints; J."""
    springs = (scene.springs or ())[:n]
    return Add(*(k * delta**2 / 2 for k, delta in zip(springs, joint_angles(scene), strict=False)))


def L(scene: Arrangement, n: int | None = None) -> Any:
    """``L_n``, the Lagrangian of the first ``n`` rods (all by default) ([Neves] In[16], In[22]); J.

    Exact.  Raises SceneError unless 1 <= n <= N.

    >>> from lagrangian import Rod, Scene
    >>> L(Scene([Rod.bob(1, 2)]))
    -2*g*cos(theta1(t)) + 2*Derivative(theta1(t), t)**2
    """
    last = len(scene) if n is None else _check_index(scene, n) + 1
    return Add(*(K(scene, i) - V(scene, i) for i in range(1, last + 1))) - spring_energy(scene, last)


@dataclass(frozen=True, repr=False)
class Scene(Arrangement):
    """A chain of rods on a support, checked when it is made.  Immutable and exact.

    Only what the scene holds is modelled: no horizontal terms without horizontal motion, no explicit time for a
    support at rest.

    Attributes
    ----------
    rods : sequence of N >= 1 :class:`Rod`; rod 1 is carried by the support
    support : :class:`Support`; at rest by default
    gravity : g, pointing down, constant, may be 0; m/s**2
    upright : True: angles from the upward vertical, clockwise (the article); False: from the downward vertical,
        anticlockwise (the notes)
    damping : N constants ``c_i >= 0``, or None: joint i resists with ``c_i`` times the rate of
        ``delta_i = theta_i - theta_(i-1)``, and ``delta_1 = theta_1``; N m s
    springs : N constants ``k_i``, or None: joint i resists with ``k_i delta_i``; N m
    t : the Symbol of time; by default the support's own Symbol called ``t``
    coordinates, velocities : tuples of N, ``theta_i(t)`` and their derivatives; rad, rad/s
    kinetic, potential, lagrangian : see each; J

    Raises
    ------
    SceneError
        No rods; not one damping or spring constant for every joint.
    DriveError
        A support whose motion depends on a coordinate, is not smooth, or is written in two Symbols of one name, or in a
        Symbol t, tau or time that is not the scene's.
    QuantityError, NotAQuantityError, TextError
        A constant that depends on time or is not finite or not real; a thing of the wrong kind; text.

    Source: [Neves] section 5, In[16]; with ``upright=False`` and bobs, the notes.

    >>> from sympy import symbols
    >>> from lagrangian import Rod
    >>> m, l = symbols("m l")
    >>> Scene([Rod.uniform(m, l)]).lagrangian
    -g*l*m*cos(theta1(t))/2 + l**2*m*Derivative(theta1(t), t)**2/6
    """

    @property
    def kinetic(self) -> Any:
        """The kinetic energy ``K_1 + ... + K_N`` ([Neves] In[16]); J."""
        return Add(*(K(self, i) for i in range(1, len(self) + 1)))

    @property
    def potential(self) -> Any:
        """The energy of the weights above the origin and of the springs; J.

        ``V_1 + ... + V_N + g eta(t) sum m_i + sum k_i delta_i**2 / 2``.  The article leaves ``g eta sum m_i`` out,
        so that ``kinetic - potential`` and ``lagrangian`` differ by that function of time when ``eta`` is not 0.
        """
        weights = Add(*(V(self, i) for i in range(1, len(self) + 1)))
        lift = self.gravity * self.support.eta * Add(*(rod.mass for rod in self.rods))
        return weights + lift + spring_energy(self, len(self))

    @property
    def lagrangian(self) -> Any:
        """The article's ``L[N]`` (In[16]), less the energy of springs; J."""
        return L(self)

    def compile(self, values: Mapping[Any, Any] | None = None, model: str | None = None) -> CompiledChain | Ensemble:
        """This chain with numbers for its Symbols: accelerations in O(n), ready for :func:`lagrangian.simulate`.

        ``values`` maps Symbols to numbers, taken exactly; ``model`` as in :class:`lagrangian.CompiledChain`.  A support
        that moves in waves, ``c cos(qt) + s sin(qt)``, or products of them, costs least.  Where Symbols of rods or
        joints have an array of shape (chains,), the result is an :class:`lagrangian.Ensemble`, its constants rounded
        once to float64, which takes a ms a chain.

        Raises QuantityError where a Symbol has no number, the time has one, or one of gravity or the support has an
        array; DriveError where the support moves by a function that is not given; TextError for text.  Functions of
        which no Taylor series is known here, ``besselj`` or ``atan``, are refused when accelerations are asked for.

        >>> from sympy import symbols
        >>> from lagrangian import Rod
        >>> m, l, g = symbols("m l g")
        >>> chain = Scene([Rod.bob(m, l)] * 3).compile({m: 1, l: 2, g: 10})
        >>> chain.model, chain.acceleration(0, [0.5, 0.5, 0.5], [0, 0, 0]).round(3)
        ('bobs', array([2.397, 0.   , 0.   ]))
        """
        chains = one_by_one(values)
        return self._ensemble(chains, model) if chains else self._chain(values, model)

    def _chain(self, values: Mapping[Any, Any] | None, model: str | None) -> CompiledChain:
        replace = substitution(values, self.t)
        mass, length, center, gyration = ([replace(getattr(rod, name)) for rod in self.rods] for name in NAMES)
        damping, springs = (None if constants is None else [replace(x) for x in constants]
                            for constants in (self.damping, self.springs))
        xi, eta = self.support_acceleration
        motion = replace(self.support.xi), replace(self.support.eta)
        shaking = shaking_of_expressions(replace(xi), replace(eta), self.t, motion)
        return CompiledChain(mass, length, center, gyration, replace(self.gravity), shaking, damping, springs,
                             self.upright, model)

    def _ensemble(self, chains: Sequence[Mapping[Any, Any]], model: str | None) -> Ensemble:
        """Every chain with values of its own, those of gravity and the support excepted."""
        first = self._chain(chains[0], model)
        replaced = [substitution(values, self.t) for values in chains]

        @cache
        def numbers(expression: Any) -> list[float]:
            """For every chain."""
            name, found = str(expression), [replace(expression) for replace in replaced]
            return [to_float(x if x.is_Rational else real_number(x, name)) for x in found]

        for shared in (self.gravity, self.support.xi, self.support.eta):
            if len({replace(shared) for replace in replaced}) > 1:
                raise QuantityError(f"the chains of an ensemble have one support and one gravity, and {shared} differs "
                                    f"among these: compile a chain for each.")
        mass, length, center, gyration = (np.array([numbers(getattr(rod, name)) for rod in self.rods]).T
                                          for name in NAMES)
        damping, springs = (None if constants is None else np.array([numbers(x) for x in constants]).T
                            for constants in (self.damping, self.springs))
        return Ensemble(mass, length, center, gyration, first.gravity, first.support, damping, springs, self.upright)

    def __repr__(self) -> str:
        rods = f"{len(self)} x {self.equal_rod}" if self.equal_rod and len(self) > 1 else f"{len(self)} rods"
        rods = repr(self.rods[0]) if len(self) == 1 else rods
        side = "upright" if self.upright else "hanging"
        joints = "".join(f", {name}" for name in ("damping", "springs") if getattr(self, name))
        return f"Scene({rods}, {self.support}, gravity={self.gravity}, {side}{joints})"

    def _repr_latex_(self) -> str:
        return f"${latex(self.lagrangian)}$" if len(self) <= 3 else rf"$N = {len(self)}\text{{ rods}}$"
