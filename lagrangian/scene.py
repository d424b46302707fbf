r"""Rods, the support that carries them, and what acts at their joints: what there is, and no equations.

Rod ``i`` hangs on (or stands upon) the far end of rod ``i - 1``; rod 1 turns about the support at
``(xi(t), eta(t))``, x to the right and y upwards.  With ``s = +1`` (upright: ``theta`` from the upward
vertical, clockwise, [Neves] section 5) or ``s = -1`` (hanging: ``theta`` from the downward vertical,
anticlockwise, the notes), the far end of a rod is displaced from its near end by

    (x, y) = (l sin theta, s l cos theta).

A rod is four numbers: its mass ``m``, its length ``l``, the distance ``H`` of its centre of mass from the
near joint, and its radius of gyration ``R`` about that joint, so that its moment of inertia there is
``m R**2`` (the article's text says ``m R**2 / 2``; its In[16] is right).  By the parallel-axis theorem the
moment about the centre of mass is ``m (R**2 - H**2)``, which is why ``R >= |H|``.

Every quantity is exact (:mod:`lagrangian.quantities`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

from sympy import (
    Abs,
    Derivative,
    DiracDelta,
    Dummy,
    Function,
    Heaviside,
    I,
    ImmutableDenseMatrix,
    Max,
    Min,
    Mod,
    Piecewise,
    S,
    Symbol,
    arg,
    ceiling,
    conjugate,
    diff,
    floor,
    frac,
    im,
    latex,
    re,
    sign,
    sqrt,
)
from sympy.core.function import AppliedUndef

from .errors import DriveError, NotAQuantityError, QuantityError, SceneError, printed
from .quantities import is_list, quantity, refuse_text, refuse_unordered

__all__ = ["Arrangement", "Rod", "Support"]

_TIMES = ("t", "tau", "time")  # Symbols that are called so are meant as the time, where a motion holds no other
_ROUGH = (Abs, Heaviside, DiracDelta, Max, Min, Mod, Piecewise, ceiling, floor, frac, sign, re, im, arg, conjugate)


def _positive(value: Any, name: str) -> Any:
    expression = quantity(value, name)
    if expression.is_positive is False:
        raise QuantityError(f"the {name} of a rod is positive, and this {name} is {printed(expression)}: give a "
                            f"{name} > 0.")
    return expression


@dataclass(frozen=True, repr=False)
class Rod:
    """One rigid rod: the article's ``m``, ``l``, ``H``, ``R``.  Immutable; every quantity is exact.

    Attributes
    ----------
    mass : m > 0; kg
    length : l > 0, from joint to joint; m
    center : H, from the near joint to the centre of mass, along the rod; m
    gyration : R >= abs(H), radius of gyration about the near joint: the moment of inertia is ``m R**2``; m

    Raises
    ------
    QuantityError
        A mass, length or radius of gyration that is not positive; ``R**2 < H**2``; a value that is not finite.
    TextError, NotAQuantityError
        Text, or anything else that is not a scalar.

    Source: [Neves] In[16].

    >>> from sympy import symbols
    >>> Rod.uniform(*symbols("m l"))
    Rod(mass=m, length=l, center=l/2, gyration=sqrt(3)*l/3)
    """

    mass: Any
    length: Any
    center: Any
    gyration: Any

    def __post_init__(self) -> None:
        for name in ("mass", "length", "gyration"):
            object.__setattr__(self, name, _positive(getattr(self, name), name))
        object.__setattr__(self, "center", quantity(self.center, "center"))
        if _certainly_negative(self.gyration**2 - self.center**2):
            raise QuantityError(
                f"the radius of gyration about the joint is at least the distance of the centre of mass: "
                f"gyration = {printed(self.gyration)} and center = {printed(self.center)} would make the moment of "
                f"inertia about the centre of mass, m (R**2 - H**2), negative.  Give gyration >= |center|."
            )

    @classmethod
    def uniform(cls, mass: Any, length: Any) -> Rod:
        """A uniform rod: ``H = l/2``, ``R = l/sqrt(3)`` ([Neves] In[24]).  ``mass`` in kg, ``length`` in m.

        Raises as :class:`Rod` does.

        >>> Rod.uniform(3, 2).center
        1
        """
        length = _positive(length, "length")
        return cls(mass, length, length / 2, length / sqrt(3))

    @classmethod
    def bob(cls, mass: Any, length: Any) -> Rod:
        """A point mass (kg) at the far end of a massless rod (m): ``H = R = l``, the pendulum of the notes.

        Raises as :class:`Rod` does.

        >>> Rod.bob(3, 2)
        Rod(mass=3, length=2, center=2, gyration=2)
        """
        return cls(mass, length, length, length)

    def __repr__(self) -> str:
        inside = ", ".join(f"{field.name}={getattr(self, field.name)}" for field in fields(self))
        return f"Rod({inside})"

    def _repr_latex_(self) -> str:
        values = (self.mass, self.length, self.center, self.gyration)
        parts = (rf"{name} = {latex(value)}" for name, value in zip(("m", r"\ell", "H", "R"), values, strict=True))
        return f"${', '.join(parts)}$"


def _certainly_negative(expression: Any) -> bool:
    """Whether every real, nonzero choice of the symbols makes ``expression`` negative."""
    real = {x: Dummy(real=True, zero=False) for x in expression.free_symbols if x.is_real is None}
    return expression.is_negative is True or expression.xreplace(real).is_negative is True


@dataclass(frozen=True, repr=False)
class Support:
    """The prescribed motion ``(xi(t), eta(t))`` of the joint that carries rod 1.  Immutable; at rest by default.

    Attributes
    ----------
    xi : horizontal position, to the right; a SymPy expression in the time of the scene; m
    eta : vertical position, upwards; likewise; m

    Raises
    ------
    TextError, NotAQuantityError, QuantityError
        Text, a thing that is not a scalar, a value that is not finite or not real.  That the motion depends on
        time alone, and smoothly, is seen by the :class:`Scene` that knows which Symbol time is.

    Source: [Neves] In[16], ``v[1]``.

    >>> from sympy import cos, symbols
    >>> t, epsilon, omega0 = symbols("t epsilon omega0")
    >>> Support(eta=epsilon*cos(omega0*t))
    Support(xi=0, eta=epsilon*cos(omega0*t))
    """

    xi: Any = S.Zero
    eta: Any = S.Zero

    def __post_init__(self) -> None:
        for name in ("xi", "eta"):
            given = quantity(getattr(self, name), name)
            if given.has(I) and not im(given.xreplace({x: Dummy(real=True) for x in given.free_symbols})).equals(0):
                raise QuantityError(f"{name} is {given}, which is not real: give a real motion.")
            object.__setattr__(self, name, given)

    def __repr__(self) -> str:
        return f"Support(xi={self.xi}, eta={self.eta})"

    def _repr_latex_(self) -> str:
        return rf"$\xi = {latex(self.xi)}, \eta = {latex(self.eta)}$"


@dataclass(frozen=True, repr=False)
class Arrangement:
    """Rods on a support, checked and exact: all that a scene holds before anything is derived from it.

    The public class is :class:`lagrangian.Scene`, which adds the energies; its docstring describes the fields.
    """

    rods: tuple[Rod, ...]
    support: Support = Support()
    gravity: Any = Symbol("g")
    upright: bool = True
    damping: tuple[Any, ...] | None = None
    springs: tuple[Any, ...] | None = None
    t: Any = None

    def __post_init__(self) -> None:
        keep = object.__setattr__
        keep(self, "rods", _rods(self.rods))
        if not isinstance(self.support, Support):
            refuse_text(self.support, "support")
            raise NotAQuantityError(f"support is {self.support!r}, not a Support: give Support(xi, eta).")
        if not isinstance(self.upright, bool):
            raise NotAQuantityError(f"upright is {self.upright!r}: give True (article) or False (notes).")
        keep(self, "gravity", quantity(self.gravity, "gravity"))
        keep(self, "damping", _one_a_joint(self.damping, "damping", len(self.rods)))
        keep(self, "springs", _one_a_joint(self.springs, "springs", len(self.rods)))
        _check_damping(self.damping)
        keep(self, "t", _time(self.t, self.support))
        _check_constants(self)
        _check_drive(self)

    def __len__(self) -> int:
        return len(self.rods)

    @property
    def up(self) -> int:
        """+1 when angles are measured from the upward vertical, -1 when from the downward one."""
        return 1 if self.upright else -1

    @cached_property
    def coordinates(self) -> tuple[Any, ...]:
        """``theta1(t), ..., thetaN(t)``; rad."""
        return tuple(Function(f"theta{i}")(self.t) for i in range(1, len(self) + 1))

    @cached_property
    def velocities(self) -> tuple[Any, ...]:
        """``theta1'(t), ..., thetaN'(t)``; rad/s."""
        return tuple(Derivative(theta, self.t) for theta in self.coordinates)

    @cached_property
    def support_velocity(self) -> tuple[Any, Any]:
        """``(xi'(t), eta'(t))``; m/s."""
        return diff(self.support.xi, self.t), diff(self.support.eta, self.t)

    @cached_property
    def support_acceleration(self) -> tuple[Any, Any]:
        """``(xi''(t), eta''(t))``; m/s**2."""
        return diff(self.support.xi, self.t, 2), diff(self.support.eta, self.t, 2)

    @property
    def equal_rod(self) -> Rod | None:
        """The rod that all rods equal, or None."""
        return self.rods[0] if all(rod == self.rods[0] for rod in self.rods) else None

    @property
    def constants(self) -> tuple[tuple[str, Any], ...]:
        """Every quantity that does not depend on time, with what it is called in a message."""
        rods = [(f"the {f.name} of rod {i}", getattr(rod, f.name))
                for i, rod in enumerate(self.rods, 1) for f in fields(rod)]
        joints = [(f"{name}[{i}]", value) for name in ("damping", "springs")
                  for i, value in enumerate(getattr(self, name) or ())]
        return (*rods, *joints, ("gravity", self.gravity))

    @cached_property
    def free_symbols(self) -> frozenset[Any]:
        """Every Symbol in the scene, time included."""
        expressions = [value for _, value in self.constants] + [self.support.xi, self.support.eta, self.t]
        return frozenset().union(*(expression.free_symbols for expression in expressions))


def _rods(rods: Any) -> tuple[Rod, ...]:
    refuse_text(rods, "rods")
    refuse_unordered(rods, "rods")
    if isinstance(rods, (int, Rod)) or not is_list(rods):
        raise SceneError(
            f"rods is {printed(rods, repr)}: the number N of rods is positive and is the length of a list, so give N "
            f"rods, as in [Rod.uniform(m, l)] * N with N >= 1."
        )
    chain = tuple(rods)
    if not chain:
        raise SceneError(
            "the number N of rods is positive, and this list has N = 0: give at least one Rod "
            "(a list times a negative N is empty too)."
        )
    for i, rod in enumerate(chain, 1):
        refuse_text(rod, f"rod {i}")
        if not isinstance(rod, Rod):
            raise NotAQuantityError(f"rod {i} is {printed(rod, repr)}, not a Rod: give Rod(mass, length, center, "
                                    f"gyration).")
    return chain


def _one_a_joint(values: Any, name: str, count: int) -> tuple[Any, ...] | None:
    if values is None:
        return None
    refuse_text(values, name)
    refuse_unordered(values, name)
    if not is_list(values):
        raise NotAQuantityError(f"{name} is {printed(values, repr)}: give a list with one value for each of the "
                                f"{count} joints.")
    joints = tuple(quantity(value, f"{name}[{i}]") for i, value in enumerate(values))
    if len(joints) != count:
        raise SceneError(
            f"{name} has one value for every joint, and here are {len(joints)} values for {count} rods: "
            f"give {count} values (0 where a joint has none)."
        )
    return joints


def _check_damping(damping: tuple[Any, ...] | None) -> None:
    for i, value in enumerate(damping or ()):
        if value.is_negative:
            raise QuantityError(f"joint damping takes energy out, and damping[{i}] is {printed(value)}: give a "
                                f"value >= 0.")


def _time(t: Any, support: Support) -> Any:
    """The Symbol of time: the one given, or the support's own Symbol called ``t``, or a new one."""
    refuse_text(t, "t")
    if t is not None and not isinstance(t, Symbol):
        raise NotAQuantityError(f"t is {printed(t, repr)}, not a Symbol: give the Symbol that the support's motion "
                                f"is written in.")
    name = "t" if t is None else t.name
    symbols = support.xi.free_symbols | support.eta.free_symbols
    found = {x for x in symbols if x.name == name}
    if t is None and symbols and not found:
        motion = support.xi if support.xi.free_symbols else support.eta
        raise DriveError(f"the support moves by {motion}, in which no Symbol is called t: say which is the time, as in "
                         f"Scene(..., t=tau).")
    if len(found | ({t} if t is not None else set())) > 1:
        raise DriveError(
            f"the support moves with more than one Symbol called {name}, which differ in their assumptions and are "
            f"different variables to SymPy: write xi and eta in one Symbol and pass it as t."
        )
    return t if t is not None else found.pop() if found else Symbol("t")


def _named_like_coordinates(expression: Any, count: int) -> list[str]:
    """The coordinates theta1, ..., thetaN that ``expression`` mentions, as Symbols or functions."""
    names = {x.name for x in expression.free_symbols} | {x.func.__name__ for x in expression.atoms(AppliedUndef)}
    return [f"theta{i}" for i in range(1, count + 1) if f"theta{i}" in names]


def _check_constants(scene: Arrangement) -> None:
    for name, value in scene.constants:
        clash = _named_like_coordinates(value, len(scene))
        if clash:
            raise QuantityError(f"{name} is constant, and {value} holds {clash[0]}, the name of a coordinate: give the "
                                f"parameter another name.")
        if scene.t in value.free_symbols:
            raise QuantityError(
                f"{name} is constant, and {value} depends on {scene.t}: give a constant.  "
                f"(A gravity g + a(t) is a support with eta'' = a(t).)"
            )


def _check_drive(scene: Arrangement) -> None:
    for name, value in (("xi", scene.support.xi), ("eta", scene.support.eta)):
        clash = _named_like_coordinates(value, len(scene))
        if clash:
            raise DriveError(
                f"the drive is prescribed, and {name} = {value} depends on the coordinate {clash[0]}: give {name} as "
                f"a function of {scene.t} alone, or give the parameter another name."
            )
        meant = [] if scene.t in value.free_symbols else [x for x in value.free_symbols if x.name in _TIMES]
        if meant:
            raise DriveError(
                f"the time is {scene.t}, and {name} = {value} holds the Symbol {meant[0]} instead, so that it would "
                f"not move: write xi and eta in one Symbol of time and pass it, as in Scene(..., t={meant[0]})."
            )
        rough = [x for x in value.atoms(*_ROUGH) if scene.t in x.free_symbols]
        if rough:
            raise DriveError(
                f"the drive is twice differentiable in {scene.t}, and {name} = {value} contains {rough[0]}: give a "
                f"smooth motion, or an undefined function {name}({scene.t}) to be replaced later."
            )


def column(entries: Iterable[Any]) -> Any:
    """An immutable column, shape (n, 1)."""
    rows = list(entries)
    return ImmutableDenseMatrix(len(rows), 1, rows)
