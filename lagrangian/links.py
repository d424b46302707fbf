"""What a chain of rods is, as numbers: its rods, joints and support, and their constants in every arithmetic."""

from __future__ import annotations

from functools import cached_property
from itertools import accumulate
from typing import Any

import numpy as np
from sympy import Rational

from .arithmetic import Arithmetic
from .constants import LIGHT, NAMES, check_joints, checked, column, float_row, joint_constants, rod_row, to_floats
from .errors import NotAQuantityError, SceneError
from .frozen import Frozen, locked
from .quantities import high_low, quantity, real_number, to_float
from .redone import FINE, constants_in_pairs
from .shaking import LEFT, Shaking, shaking_of
from .single import MODELS
from .states import float_states
from .stepper import total

__all__ = ["Links"]


class Links(Frozen):
    """The links of a :class:`lagrangian.CompiledChain`, its parameters those of this class.  Immutable."""

    def __init__(self, mass: Any, length: Any, center: Any, gyration: Any, gravity: Any = 9.81,
                 support_acceleration: Any = (0, 0), damping: Any = None, springs: Any = None, upright: bool = True,
                 model: str | None = None) -> None:
        columns = [column(values, name) for values, name in zip((mass, length, center, gyration), NAMES, strict=True)]
        self._columns = checked(columns)
        self._count = len(self._columns[0])
        self._shape = (self._count,)
        self.gravity = real_number(gravity, "gravity")
        self.support: Shaking = shaking_of(support_acceleration)
        self._steady = self.support.steady
        self._joints = [joint_constants(values, name, len(self)) for values, name in
                        ((damping, "damping"), (springs, "springs"))]
        check_joints(self._columns[0], self._joints)
        if not isinstance(upright, bool):
            raise NotAQuantityError(f"upright is {upright!r}: give True (article) or False (notes).")
        self.upright = upright
        self.has_torques = any(values is not None for values in self._joints)
        self.model = self._model(model)
        self._made = True

    def __len__(self) -> int:
        return self._count

    def __getstate__(self) -> dict[str, Any]:
        """What it was made of: what is cached is found again."""
        return {name: value for name, value in self.__dict__.items() if not hasattr(type(self), name)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)

    def __repr__(self) -> str:
        named = zip(("damping", "springs"), self._joints, strict=True)
        features = [name for name, values in named if values is not None]
        features += ["support at rest" if self.support.at_rest else "moving support"]
        side = "upright" if self.upright else "hanging"
        links = self.model if len(self) > 1 else self.model[:-1]
        return f"{type(self).__name__}({len(self)} {links}, {', '.join(features)}, {side})"

    def _repr_latex_(self) -> str:
        side = "upright" if self.upright else "hanging"
        return rf"$M(\theta)\, \ddot\theta = f(t, \theta, \dot\theta), \quad n = {len(self)}, \quad \text{{{side}}}$"

    # -- what the chain is --------------------------------------------------------------------------------

    @property
    def up(self) -> int:
        """+1 when angles are measured from the upward vertical, -1 when from the downward one."""
        return 1 if self.upright else -1

    @property
    def damping(self) -> Any:
        """The n damping constants as float64, or None; N m s."""
        return self._joint_floats[0]

    @property
    def springs(self) -> Any:
        """The n spring constants as float64, or None; N m."""
        return self._joint_floats[1]

    @property
    def conserves_energy(self) -> bool:
        """Whether ``energy`` is a constant of the motion: no dampers, and a support whose acceleration is constant."""
        return self._joints[0] is None and self.support.steady

    def _model(self, asked: str | None) -> str:
        _, length, center, gyration = self._columns
        bobs = bool(np.all(center == length) and np.all(gyration == length)) and not self.has_torques
        if asked is None:
            return "bobs" if bobs else "rods"
        refuse = None if isinstance(asked, str) and asked in MODELS else f"model is {asked!r}"
        if asked == "bobs" and not bobs:
            refuse = "model is 'bobs', and not every rod is a point mass at its end (H = R = l) with free joints"
        if refuse:
            raise SceneError(f"{refuse}: give model='rods', which holds for every chain, or None for the least that "
                             f"will do.")
        return asked

    # -- its constants in every arithmetic ----------------------------------------------------------------

    @cached_property
    def rods(self) -> Any:
        """Rows ``m, l, I, Ic, J, It, m H, m (l - H)`` as float64, shape (n, 8), each rounded once or twice; read only.
        """
        return locked(self._rods)

    @cached_property
    def bobs(self) -> Any:
        """Rows ``m, l, m_k/m_(k-1), 1/m`` as float64, shape (n, 4); read only."""
        return locked(self._bobs)

    @cached_property
    def _rods(self) -> Any:
        """:attr:`rods` for machine code, which would be translated again for what is read only."""
        if self._columns[0].dtype == object:
            exact = self._exact_rods(Rational(LIGHT))
            return np.array([[to_float(x) for x in row] for row in exact])
        return np.stack(float_row(*self._columns), axis=1)

    @cached_property
    def _bobs(self) -> Any:
        m, l = self.rods[:, 0], self.rods[:, 1]
        ratio = np.concatenate([[0.0], m[1:] / m[:-1]])
        return np.ascontiguousarray(np.stack([m, l, ratio, 1 / m], axis=1))

    def _exact_rods(self, light: Any) -> list[tuple[Any, ...]]:
        columns = [[quantity(x, name) for x in column] for column, name in zip(self._columns, NAMES, strict=True)]
        light = light * max(columns[0])
        return [rod_row(m if m != 0 else light, l, H, R**2) for m, l, H, R in zip(*columns, strict=True)]

    def rods_in(self, arithmetic: Arithmetic) -> Any:
        """:attr:`rods` in an arithmetic of :mod:`lagrangian.arithmetic`, from the exact numbers; shape (n, 8)."""
        out = np.empty((len(self), 8), dtype=object)
        for k, row in enumerate(self._exact_rods(Rational(1, 10**400))):
            out[k] = [arithmetic.number(x) for x in row]
        return out

    def joints_in(self, arithmetic: Arithmetic) -> list[Any]:
        """Damping and springs in an arithmetic of :mod:`lagrangian.arithmetic`, each None or shape (n,)."""
        return [None if values is None else arithmetic.array(arithmetic.number(quantity(x, "joint")) for x in values)
                for values in self._joints]

    def pull(self, t: Any, arithmetic: Arithmetic | None = None) -> tuple[Any, Any]:
        """``(xi'', +-(g + eta''))``, the acceleration that the first joint seems to have; m/s**2."""
        if self.support.function is None:
            ax, ay = self.weighted.at(t, arithmetic)
            return ax, self.up * ay
        ax, ay = self.support.at(t, arithmetic)
        if arithmetic:
            return ax, self.up * (arithmetic.number(self.gravity) + ay)
        g, size = self.add_weight(0.0), abs(float(ay))
        ay = self.add_weight(float(ay))
        if self.support.is_exact and LEFT * (abs(ax) + abs(ay)) < abs(g) + size:  # and little is left of them
            ax, ay = self.pull(FINE.coerced(t), FINE)
            return float(ax), float(ay)
        return ax, self.up * ay

    def add_weight(self, ay: float) -> float:
        """``g + ay`` rounded once, for the float ``ay``; m/s**2."""
        high, low = self._gravity_pair
        found, rest = total(high, ay)
        return float(found + (rest + low))

    @cached_property
    def _gravity_pair(self) -> tuple[float, float]:
        return high_low(self.gravity)

    @cached_property
    def weighted(self) -> Shaking:
        """The support's acceleration with g added to its constant part exactly; of no use for functions of time."""
        return self.support.under(self.gravity)

    @cached_property
    def steady_pull(self) -> tuple[float, float]:
        """The constant part of :meth:`pull` in float64, rounded once, which weights are counted with; m/s**2."""
        ax, ay = self.weighted.floats[0].tolist()
        return ax, self.up * ay

    @cached_property
    def _joint_floats(self) -> tuple[Any, Any]:
        return to_floats(self._joints[0]), to_floats(self._joints[1])

    def fine_pull(self, t: Any) -> Any:
        """:meth:`pull` in numbers of FINE, or in floats where the support moves by a function of them."""
        if self._steady:
            return self._steady_fine
        return self.pull(FINE.coerced(t), FINE) if self.support.is_exact else self.pull(t)

    @cached_property
    def _steady_fine(self) -> Any:
        return self.pull(FINE.coerced(0), FINE)

    @cached_property
    def _in_pairs(self) -> Any:
        return constants_in_pairs(*self._fine)

    @cached_property
    def _fine(self) -> tuple[Any, Any]:
        """Rods and joints as mpmath numbers of FINE."""
        if self._columns[0].dtype == object:
            return self.rods_in(FINE), self.joints_in(FINE)
        number = FINE.context.mpf
        m, l, H, R = ([number(x) for x in values.tolist()] for values in self._columns)
        light = LIGHT * max(m)
        rows = [rod_row(x or light, *rest) for x, *rest in zip(m, l, H, [x**2 for x in R], strict=True)]
        return np.array(rows, dtype=object), self.joints_in(FINE)

    @cached_property
    def _counterweighted(self) -> bool:
        """Whether a rod has its centre beyond its near joint: then sums cancel that are positive otherwise."""
        return bool((self.rods[:, 6] < 0).any())

    # -- energy -------------------------------------------------------------------------------------------

    def energy(self, theta: Any, omega: Any) -> Any:
        """Kinetic and potential energy in the frame of the support, float64; J.

        Weights are those of gravity and of the constant part of the support's acceleration, and springs are counted.
        A constant of the motion where :attr:`conserves_energy`.  Shapes: (n,) gives a number, (n, any) shape (any,).
        """
        return self.energy_of(*float_states(theta, omega, len(self)))

    def energy_of(self, angle: Any, omega: Any, turns: Any = None) -> Any:
        """:meth:`energy` of angles, rates and, where given, whole turns of the angles, shapes (n,) or (n, any); J.

        Springs count the turns; sines of the rest lose nothing.  Of float64 arrays, which are not checked.
        """
        shape = (-1,) + (1,) * (angle.ndim - 1)
        m, l, _, Ic, _, _, mH, mG = (column.reshape(shape) for column in self.rods.T)
        s, c = np.sin(angle), np.cos(angle)
        ends = [np.cumsum(l * c * omega, axis=0), -np.cumsum(l * s * omega, axis=0)]
        mx, my = (m * end for end in ends)
        centres = [(mx - mG * c * omega) / m, (my + mG * s * omega) / m]
        kinetic = (m * (centres[0] ** 2 + centres[1] ** 2) + Ic * omega**2).sum(axis=0) / 2
        ax, ay = self.steady_pull
        beyond = np.concatenate([np.cumsum(m[::-1], axis=0)[::-1][1:], np.zeros_like(m[:1])])
        p = mH + l * beyond
        potential = (p * (ax * s + ay * c)).sum(axis=0)
        if self._joints[1] is not None:
            delta = np.diff(angle, axis=0, prepend=0.0)
            if turns is not None:
                delta += 2 * np.pi * np.diff(turns, axis=0, prepend=0).astype(float)
            potential = potential + (self.springs.reshape(shape) * delta**2).sum(axis=0) / 2
        return kinetic + potential

    @cached_property
    def energy_scale(self) -> float:
        """``M g L``-like: the weight of every rod times the length of chain that holds it, without signs; J.

        0 without weight.
        """
        reach = np.array(list(accumulate(self.rods[:, 1])))
        return float((self.rods[:, 0] * reach).sum() * max(map(abs, self.steady_pull)))
