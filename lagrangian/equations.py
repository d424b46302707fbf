r"""The equations of motion of a chain, from the closed form of the mass matrix.

The Lagrangian is quadratic in the rates with coefficients that depend on differences of angles only, so that
Lagrange's equations need no differentiation.  With the first moment of rod ``i`` and of all it carries,

    p_i = m_i H_i + l_i (m_(i+1) + ... + m_N),

the mass matrix ``M = d2K / dtheta' dtheta'`` is

    M_ii = m_i R_i**2 + l_i**2 (m_(i+1) + ... + m_N),
    M_ij = l_i p_j cos(theta_i - theta_j)                    for i < j, symmetric,

and Lagrange's equation i, ``d/dt dL/dtheta_i' - dL/dtheta_i`` plus the moments of the dampers, is

    sum_j M_ij theta_j''
      + sum_j l_i p_j sin(theta_i - theta_j) theta_j'**2     (i < j; l_j p_i for i > j)
      + p_i xi'' cos theta_i - s p_i (g + eta'') sin theta_i
      + c_i delta_i' - c_(i+1) delta_(i+1)' + k_i delta_i - k_(i+1) delta_(i+1)  =  0,

``delta_i = theta_i - theta_(i-1)``, s = +1 upright and -1 hanging.  For hanging bobs ``p_i = l_i mu_i``, and
divided by ``l_i`` this is the matrix form of the notes (whose entries (n, 2) should hold ``l_2``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import accumulate
from typing import Any

from sympy import Add, Derivative, ImmutableDenseMatrix, Integer, cos, latex, sin

from .energy import Scene, joint_angles
from .errors import NotASceneError
from .scene import column

__all__ = ["EquationsOfMotion", "euler_lagrange"]


@dataclass(frozen=True, repr=False)
class EquationsOfMotion:
    """``mass_matrix @ theta'' = forcing``, complete once constructed.  Immutable and exact.

    Made by :func:`euler_lagrange`.

    Attributes
    ----------
    scene : the :class:`Scene` they belong to
    coordinates : Matrix, shape (N, 1)      theta, functions of t; rad
    mass_matrix : Matrix, shape (N, N)      M(theta), symmetric, positive definite; kg m**2
    forcing : Matrix, shape (N, 1)          f(t, theta, theta'); N m
    lhs : Matrix, shape (N, 1)              M theta'' - f, which is zero along every motion; N m
    t : the Symbol of time
    """

    scene: Scene
    coordinates: Any = field(repr=False)
    mass_matrix: Any = field(repr=False)
    forcing: Any = field(repr=False)
    lhs: Any = field(repr=False)

    @property
    def t(self) -> Any:
        """The Symbol of time."""
        return self.scene.t

    def __repr__(self) -> str:
        n = len(self.scene)
        return f"EquationsOfMotion(M theta'' = f, M of shape ({n}, {n}), {self.scene})"

    def _repr_latex_(self) -> str:
        if len(self.scene) > 3:
            return rf"$M(\theta)\,\ddot\theta = f(t, \theta, \dot\theta), \quad N = {len(self.scene)}$"
        theta = column(Derivative(x, self.t, 2) for x in self.coordinates)
        return f"${latex(self.mass_matrix)} {latex(theta)} = {latex(self.forcing)}$"


def _carried_masses(scene: Scene) -> list[Any]:
    """``m_(i+1) + ... + m_N`` for i = 1, ..., N; kg."""
    beyond = accumulate((rod.mass for rod in reversed(scene.rods[1:])), initial=Integer(0))
    return list(beyond)[::-1]


def first_moments(scene: Scene) -> list[Any]:
    """``p_i = m_i H_i + l_i (m_(i+1) + ... + m_N)``; kg m."""
    return [rod.mass * rod.center + rod.length * beyond
            for rod, beyond in zip(scene.rods, _carried_masses(scene), strict=True)]


def _mass_matrix(scene: Scene, couplings: list[list[Any]]) -> Any:
    theta = scene.coordinates

    def entry(i: int, j: int) -> Any:
        return couplings[i][j] * cos(theta[i] - theta[j]) if i != j else couplings[i][i]

    return _symmetric(len(scene), entry)


def _symmetric(n: int, entry: Any) -> Any:
    upper = {(i, j): entry(i, j) for i in range(n) for j in range(i, n)}
    return ImmutableDenseMatrix(n, n, [upper[min(i, j), max(i, j)] for i in range(n) for j in range(n)])


def _couplings(scene: Scene, moments: list[Any]) -> list[list[Any]]:
    """``l_i p_j`` above the diagonal and mirrored below it; the moments of inertia on it; kg m**2."""
    n, rods, beyond = len(scene), scene.rods, _carried_masses(scene)
    inertia = [rod.mass * rod.gyration**2 + rod.length**2 * m for rod, m in zip(rods, beyond, strict=True)]
    return [[inertia[i] if i == j else rods[min(i, j)].length * moments[max(i, j)] for j in range(n)]
            for i in range(n)]


def _centrifugal(scene: Scene, couplings: list[list[Any]]) -> Iterator[list[Any]]:
    """The terms in ``theta_j'**2`` of every equation."""
    theta, omega = scene.coordinates, scene.velocities
    for i, row in enumerate(couplings):
        yield [c * sin(theta[i] - theta[j]) * omega[j] ** 2 for j, c in enumerate(row) if j != i]


def thrust(scene: Scene) -> list[Any]:
    """``p_i xi'' cos theta_i``: what the horizontal motion of the support adds to each left-hand side; N m."""
    horizontal, _ = scene.support_acceleration
    return [p * horizontal * cos(theta) for p, theta in zip(first_moments(scene), scene.coordinates, strict=True)]


def _weight(scene: Scene, moments: list[Any]) -> list[Any]:
    """``-s p_i (g + eta'') sin theta_i``; N m."""
    pull = scene.gravity + scene.support_acceleration[1]
    return [-scene.up * p * pull * sin(theta) for p, theta in zip(moments, scene.coordinates, strict=True)]


def _joint_moments(scene: Scene) -> list[Any]:
    """``tau_i - tau_(i+1)`` with ``tau_i = c_i delta_i' + k_i delta_i``; N m."""
    nothing = (Integer(0),) * len(scene)
    torques = [k * delta + c * delta.diff(scene.t) for c, k, delta in zip(
        scene.damping or nothing, scene.springs or nothing, joint_angles(scene), strict=True)]
    return [here - after for here, after in zip(torques, [*torques[1:], Integer(0)], strict=True)]


def euler_lagrange(scene: Scene) -> EquationsOfMotion:
    """The equations of motion ``M(theta) theta'' = f`` of ``scene``, for any number N of rods.

    Lagrange's equations, [Neves] (10) and In[32], with the moments of dampers and springs at the joints, written
    from the closed form that opens this module.  ``M`` has shape (N, N), ``f`` and ``lhs`` (N, 1); kg m**2 and N m.
    Exact; nothing is simplified or expanded.

    Raises NotASceneError if ``scene`` is not a :class:`Scene`.

    Speed and accuracy: the work is proportional to N**2 and involves no differentiation of the Lagrangian.
    Everything is exact, so there is no accuracy to trade.

    >>> from sympy import symbols
    >>> from lagrangian import Rod, Scene
    >>> m, l = symbols("m l")
    >>> equations = euler_lagrange(Scene([Rod.uniform(m, l)]))
    >>> equations.mass_matrix[0], equations.forcing[0]
    (l**2*m/3, g*l*m*sin(theta1(t))/2)
    """
    if not isinstance(scene, Scene):
        raise NotASceneError(f"equations of motion are those of a Scene, and this is {scene!r}: give Scene(rods).")
    moments = first_moments(scene)
    couplings = _couplings(scene, moments)
    mass = _mass_matrix(scene, couplings)
    rows = zip(_centrifugal(scene, couplings), thrust(scene), _weight(scene, moments), _joint_moments(scene),
               strict=True)
    resistance = [Add(*swing, push, weight, joint) for swing, push, weight, joint in rows]
    acceleration = [Derivative(theta, (scene.t, 2)) for theta in scene.coordinates]
    lhs = [Add(*(mass[i, j] * a for j, a in enumerate(acceleration)), r) for i, r in enumerate(resistance)]
    return EquationsOfMotion(scene, column(scene.coordinates), mass, column(-r for r in resistance), column(lhs))
