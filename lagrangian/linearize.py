r"""Small motions about rest, and the same in the phase ``tau = omega0 t``: ``x' = P(tau) x``.

About angles ``about`` at which the chain can stay, with ``theta`` now the deviation from them,

    A theta'' + damping theta' + stiffness(t) theta + remainder(t) = 0        ([Neves] Out[36])
    A = M(about),   stiffness = -df/dtheta,   damping = -df/dtheta',   remainder = -f,   all at rest there.

The article divides by ``m l**2`` (In[36]); here that is :meth:`lagrangian.LinearEquations.divided`, and the undivided
matrices keep their units.  Its "equilibrium" allows a remainder from horizontal driving (Out[40]), and so does
this file: ``about`` must balance weight, springs and vertical driving at every time.  Where it balances them together
with the horizontal driving (a drive along the rod, ``tan theta = xi''/g`` in a cart) the chain stays, and no remainder
is left.

In ``tau = omega0 t`` with ``x = (theta, dtheta/dtau)`` ([Neves] (11), (18))

    P(tau) = [[0, 1], [-A**-1 stiffness(tau/omega0) / omega0**2,  -A**-1 damping / omega0]],

every entry a finite sum of ``c cos(q tau)`` and ``s sin(q tau)`` with rational q, which repeats after
``2 pi / gcd(q)``.  For equal rods ``h = epsilon/l`` and ``v = omega0 sqrt(l/g)`` ([Neves] (16), (17)) leave no
other parameter: ``g/(l omega0**2) = 1/v**2``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import compress
from typing import Any

from sympy import (
    Dummy,
    ImmutableDenseMatrix,
    Integer,
    Pow,
    cos,
    expand,
    eye,
    latex,
    sin,
    zeros,
)
from sympy.core.function import AppliedUndef

from .drive import frequency, fresh_symbol, in_scales, matrix_modes, natural_scales, period_of
from .energy import Scene
from .equations import EquationsOfMotion, thrust
from .errors import (
    InhomogeneousError,
    NotAnEquilibriumError,
    NotAQuantityError,
    NotASceneError,
    QuantityError,
    SceneError,
    printed,
)
from .inverse import inverse
from .quantities import is_list, quantity, refuse_text, refuse_unordered, truth
from .scene import column

__all__ = ["FirstOrderSystem", "LinearEquations", "linearize"]


@dataclass(frozen=True, repr=False)
class FirstOrderSystem:
    """``dx/dtau = P(tau) x`` with ``x = (theta, dtheta/dtau)``; unpacks as ``P, tau, period``.  Immutable, exact.

    Made by :meth:`LinearEquations.first_order`.

    Attributes
    ----------
    P : Matrix, shape (2N, 2N), a trigonometric polynomial in tau; dimensionless
    tau : Symbol, the phase omega0 t; rad
    period : the smallest period of P, a rational multiple of pi (2 pi where P is constant)
    where : pairs (symbol, what it stands for): (h, epsilon/l) and (v, omega0*sqrt(l/g)) when they are used
    """

    P: Any
    tau: Any
    period: Any
    where: tuple[tuple[Any, Any], ...] = ()

    def __iter__(self) -> Iterator[Any]:
        return iter((self.P, self.tau, self.period))

    def __getitem__(self, index: int) -> Any:
        return (self.P, self.tau, self.period)[index]

    def __repr__(self) -> str:
        where = "".join(f", {symbol} = {meaning}" for symbol, meaning in self.where)
        return f"FirstOrderSystem(P of shape {self.P.shape}, tau={self.tau}, period={self.period}{where})"

    def _repr_latex_(self) -> str:
        return rf"$\frac{{dx}}{{d{latex(self.tau)}}} = {latex(self.P)} x, \quad T = {latex(self.period)}$"


@dataclass(frozen=True, repr=False)
class LinearEquations:
    """``A theta'' + damping theta' + stiffness theta + remainder = 0``, theta the deviation from ``about``.

    Made by :func:`linearize`.

    Attributes
    ----------
    scene : the :class:`Scene` they belong to
    about : tuple of N angles; rad
    A : Matrix, shape (N, N), symmetric, positive definite, constant; kg m**2
    damping : Matrix, shape (N, N), symmetric, constant; N m s
    stiffness : Matrix, shape (N, N), symmetric, a function of t: the coefficient of theta; N m
    remainder : Matrix, shape (N, 1), a function of t; zero without horizontal driving; N m
    divisor : what the equations have been divided by; 1, or as :meth:`divided` says

    The units are those before :meth:`divided`.  Immutable and exact.
    """

    scene: Scene
    about: tuple[Any, ...]
    A: Any = field(repr=False)
    damping: Any = field(repr=False)
    stiffness: Any = field(repr=False)
    remainder: Any = field(repr=False)
    divisor: Any = Integer(1)

    @property
    def t(self) -> Any:
        """The Symbol of time."""
        return self.scene.t

    @property
    def coordinates(self) -> Any:
        """The deviations ``theta1(t), ..., thetaN(t)``, shape (N, 1); rad."""
        return column(self.scene.coordinates)

    def divided(self, by: Any = None) -> LinearEquations:
        """The same equations divided by ``by``, or by ``m l**2`` of equal rods when nothing is given.

        ``by = m l**2`` is the normalisation of [Neves] In[36]: A has no unit (Out[38]), and stiffness (Out[39]) and
        remainder (Out[40]) are in 1/s**2; doing it twice changes nothing.  ``by`` is a nonzero constant, in kg m**2
        for these units.

        Raises SceneError if nothing is given and the rods differ; QuantityError if ``by`` is 0 or depends on t.

        >>> from sympy import symbols
        >>> from lagrangian import Rod, Scene, euler_lagrange
        >>> rods = [Rod.uniform(*symbols("m l"))] * 2
        >>> linearize(euler_lagrange(Scene(rods))).divided().A
        Matrix([
        [4/3, 1/2],
        [1/2, 1/3]])
        """
        factor = self.divisor / _inertia(self.scene) if by is None else 1 / _divisor(by, self.t)
        parts = {name: (getattr(self, name) * factor).applyfunc(expand)
                 for name in ("A", "damping", "stiffness", "remainder")}
        return replace(self, divisor=self.divisor / factor, **parts)

    def homogeneous(self) -> LinearEquations:
        """The same equations without the remainder: what decides their stability, not where a driven chain goes.

        Two motions of a chain that is pushed horizontally differ by a solution of these.  The forced motion that both
        share changes the stiffness only in second order of the horizontal amplitude, which linear equations leave out;
        where fast horizontal driving matters, simulate.
        """
        return replace(self, remainder=column([Integer(0)] * len(self.scene)))

    def first_order(self, omega0: Any, dimensionless: bool = True) -> FirstOrderSystem:
        """``P, tau, period`` of ``dx/dtau = P(tau) x`` in the phase ``tau = omega0 t``, for ``FloquetMatrix``.

        The article's P after Out[43], for any N.  ``omega0`` is a constant angular frequency (rad/s), a Symbol or a
        number; ``P`` has shape (2N, 2N) and no unit.  With ``eta = epsilon cos(omega0 t)`` the period is 2 pi.

        For equal rods with ``dimensionless=True`` the parameters are ``h = epsilon/l``, if epsilon is a Symbol and
        the only amplitude, and ``v = omega0 sqrt(l/g)``, if omega0 is a Symbol; ``where`` of the result says what was
        used.  Otherwise P keeps the symbols of the scene.

        Exact.  With a nonzero remainder there is no such P, and the call raises: take ``homogeneous()`` first.

        Raises
        ------
        InhomogeneousError
            The remainder is not zero (horizontal driving).
        NotPeriodicError
            The driving is not a sum of cosines and sines of rational multiples of omega0 t.
        NameClashError
            The scene uses a Symbol called tau, h or v for something else, or one called like omega0 that is another.
        QuantityError, NotAQuantityError, TextError
            omega0 is zero, depends on time, or is not a number or expression; dimensionless is no truth value.

        Speed and accuracy: with equal rods A is a matrix of numbers and its inverse is immediate.  The inverse for N
        rods with all-different symbols is a quotient of polynomials that grows fast with N.

        >>> from sympy import cos, symbols
        >>> from lagrangian import Rod, Scene, Support, euler_lagrange
        >>> m, l, epsilon, omega0, t = symbols("m l epsilon omega0 t")
        >>> scene = Scene([Rod.uniform(m, l)], Support(eta=epsilon*cos(omega0*t)))
        >>> P, tau, period = linearize(euler_lagrange(scene)).first_order(omega0)
        >>> P[1, 0], period
        (-3*h*cos(tau)/2 + 3/(2*v**2), 2*pi)
        """
        omega0 = frequency(omega0, self.scene)
        if any(expand(entry) != 0 for entry in self.remainder):
            raise InhomogeneousError(
                f"x' = P x has no place for a remainder, and this one is {_short(self.remainder)} (from the "
                f"horizontal driving).  lin.homogeneous().first_order(omega0) drops it: the Floquet multipliers, and "
                f"with them the stability of the linear equations, are those of that part.  What the forced motion "
                f"itself does to stability is of second order in the horizontal amplitude, and not in these equations."
            )
        scales = natural_scales(self.scene, omega0) if truth(dimensionless, "dimensionless") else ()
        tau = fresh_symbol("tau", self.scene, omega0)
        lin = self.divided() if self.scene.equal_rod else self
        A_inverse = inverse(lin.A)

        def accelerations(torque: Any, power: int) -> Any:
            return _times(-A_inverse, (torque / omega0**power).applyfunc(lambda x: in_scales(x, scales)))

        modes = {q: [accelerations(part, 2) for part in pair]
                 for q, pair in matrix_modes(lin.stiffness, self.t, omega0).items()}
        block = sum((c * cos(q * tau) + s * sin(q * tau) for q, (c, s) in modes.items()), zeros(len(self.scene)))
        drag = accelerations(lin.damping, 1)
        P = ImmutableDenseMatrix(_blocks(block, drag))
        return FirstOrderSystem(P, tau, period_of(modes), tuple((scale.symbol, scale.meaning) for scale in scales))

    def __repr__(self) -> str:
        n, rest = len(self.scene), "" if not any(self.about) else f", about {self.about}"
        terms = ["A theta''", "damping theta'", "stiffness theta", "remainder"]
        held = [True, any(self.damping), any(self.stiffness), any(self.remainder)]
        left = " + ".join(compress(terms, held))
        return f"LinearEquations({left} = 0, A of shape ({n}, {n}){rest}, {self.scene})"

    def _repr_latex_(self) -> str:
        terms = [(self.A, 2), (self.damping, 1), (self.stiffness, 0)]
        theta = {k: latex(column(x.diff((self.t, k)) if k else x for x in self.coordinates)) for k in (0, 1, 2)}
        sides = [f"{latex(matrix)} {theta[k]}" for matrix, k in terms if any(matrix)]
        sides += [latex(self.remainder)] if any(self.remainder) else []
        return f"${' + '.join(sides)} = 0$" if len(self.scene) <= 3 else r"$A\ddot\theta + K(t)\theta = 0$"


def linearize(equations: EquationsOfMotion, about: Iterable[Any] | None = None) -> LinearEquations:
    """Small motions about the angles ``about`` at rest; all zero, upright or hanging, by default.

    ``A = M``, ``stiffness = -df/dtheta``, ``damping = -df/dtheta'`` and ``remainder = -f`` at rest there
    ([Neves] In[36]-[40] before its division by ``m l**2``; see :meth:`LinearEquations.divided`).  ``about`` holds N
    constant angles in rad; for an upright scene N times ``pi`` is hanging rest.  Exact.

    Raises
    ------
    NotAnEquilibriumError
        Weight, springs and vertical driving leave a moment at ``about``, with and without horizontal driving.
    NotASceneError
        ``equations`` is not from :func:`euler_lagrange`.
    SceneError, QuantityError, NotAQuantityError, TextError
        ``about`` has not N entries, or one of them is not a constant angle.

    >>> from sympy import pi, symbols
    >>> from lagrangian import Rod, Scene, euler_lagrange
    >>> equations = euler_lagrange(Scene([Rod.bob(*symbols("m l"))]))
    >>> linearize(equations).stiffness, linearize(equations, about=[pi]).stiffness
    (Matrix([[-g*l*m]]), Matrix([[g*l*m]]))
    """
    if not isinstance(equations, EquationsOfMotion):
        raise NotASceneError(f"linearize takes the result of euler_lagrange, and this is {equations!r}.")
    scene = equations.scene
    rest = _rest_angles(about, scene)
    x = [Dummy(f"x{i}") for i in range(len(scene))]
    y = [Dummy(f"y{i}") for i in range(len(scene))]
    to_symbols = dict(zip((*scene.velocities, *scene.coordinates), (*y, *x), strict=True))
    still, there = dict.fromkeys(y, Integer(0)), dict(zip(x, rest, strict=True))
    resistance = [-force.xreplace(to_symbols) for force in equations.forcing]
    at_rest = [side.xreplace(still) for side in resistance]
    moving = [side.xreplace(there) for side in resistance]
    pushes = [push.xreplace(to_symbols).xreplace(there) for push in thrust(scene)]
    remainder = _remainder(rest, [expand(side.xreplace(there)) for side in at_rest], pushes)
    return LinearEquations(
        scene, rest,
        A=equations.mass_matrix.xreplace(to_symbols).xreplace(there),
        damping=_gradient(moving, y, still),
        stiffness=_gradient(at_rest, x, there),
        remainder=column(remainder),
    )


def _gradient(sides: list[Any], variables: list[Any], values: Mapping[Any, Any]) -> Any:
    """``d sides[i] / d variables[j]`` at ``values``, expanded."""
    rows = [[expand(side.diff(x).xreplace(values)) if x in side.free_symbols else Integer(0) for x in variables]
            for side in sides]
    return ImmutableDenseMatrix(rows)


def _rest_angles(about: Iterable[Any] | None, scene: Scene) -> tuple[Any, ...]:
    if about is None:
        return (Integer(0),) * len(scene)
    refuse_text(about, "about")
    refuse_unordered(about, "about")
    if not is_list(about):
        raise NotAQuantityError(f"about is {printed(about, repr)}: give a list of {len(scene)} angles.")
    angles = tuple(quantity(angle, f"about[{i}]") for i, angle in enumerate(about))
    if len(angles) != len(scene):
        raise SceneError(f"about holds one angle a rod, and here are {len(angles)} angles for {len(scene)} rods.")
    for angle in angles:
        if scene.t in angle.free_symbols or angle.atoms(AppliedUndef):
            raise QuantityError(f"an equilibrium is constant, and the angle {angle} is not: give constant angles.")
    return angles


def _remainder(rest: tuple[Any, ...], moments: list[Any], pushes: list[Any]) -> list[Any]:
    """What turns the rods at an equilibrium: the horizontal driving alone, or nothing where it is balanced too."""
    without = [expand(moment - push) for moment, push in zip(moments, pushes, strict=True)]
    i = _first_turned(without)
    if i is None:
        return moments
    k = _first_turned(moments)
    if k is None:
        return [Integer(0)] * len(moments)
    still = f", and {printed(-without[i])} rod {i + 1} without the horizontal driving" if any(pushes) else ""
    raise NotAnEquilibriumError(
        f"the angles {printed(rest)} are no equilibrium: there the moment {printed(-moments[k])} turns rod {k + 1}"
        f"{still}.  Linearise about an equilibrium: 0 or pi for every angle is one where no spring is strained."
    )


def _first_turned(moments: list[Any]) -> int | None:
    """The index of the first moment that is not 0 at all times."""
    return next((i for i, moment in enumerate(moments) if not _is_zero(moment)), None)


def _is_zero(moment: Any) -> bool:
    try:
        return moment == 0 or moment.equals(0) is True
    except ValueError:  # SymPy prints what it puts in order, and Python no integers of thousands of digits
        return False


def _inertia(scene: Scene) -> Any:
    rod = scene.equal_rod
    if rod is None:
        raise SceneError(
            f"m l**2 has a meaning where all rods are equal, and here they differ: {scene.rods[0]} and "
            f"{next(r for r in scene.rods if r != scene.rods[0])}.  Say by what to divide: divided(by)."
        )
    return rod.mass * rod.length**2


def _divisor(by: Any, t: Any) -> Any:
    factor = quantity(by, "by")
    if factor.is_zero or t in factor.free_symbols:
        raise QuantityError(f"equations are divided by a constant that is not 0, and by is {factor}.")
    return factor


def _short(matrix: Any) -> str:
    text = str(list(matrix))
    return text if len(text) < 120 else text[:117] + "..."


def _times(left: Any, right: Any) -> Any:
    """``left @ right``, expanded where ``left`` is a matrix of numbers without sums in denominators."""
    product = left * right
    return product.applyfunc(expand) if all(entry.is_number and not _is_quotient(entry) for entry in left) else product


def _is_quotient(entry: Any) -> bool:
    return any(x.exp.is_negative and x.base.is_Add for x in entry.atoms(Pow))


def _blocks(stiffness: Any, damping: Any) -> Any:
    n = stiffness.rows
    return zeros(n).row_join(eye(n)).col_join(stiffness.row_join(damping))
