r"""Chains that differ in their rods, as many as one likes: an ensemble over masses, lengths, dampers or springs.

In float64 all of them go through the recursion together (:mod:`lagrangian.lanes`).  Whatever else is asked, digits,
balls, an answer in doubt, a motion, is asked of one chain after the other, and each is a
:class:`lagrangian.CompiledChain`.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from operator import index
from typing import Any

import numpy as np

from .arithmetic import arithmetic_of
from .chain import CompiledChain
from .constants import NAMES, check_damping, check_joints, checked, float_row
from .errors import NotAQuantityError, QuantityError, SceneError, printed
from .frozen import Frozen, locked
from .lanes import accelerate_rows, accelerate_together, in_lanes
from .machine import has_numba, machine
from .quantities import one_array
from .redone import in_pairs, rows_in_pairs
from .shaking import shaking_of
from .states import float_time, floats, is_plain, why_no_answer
from .torques import joint_torques, joint_torques_of_each

__all__ = ["Ensemble", "place"]

SUSPICIOUS = 1e30  # rad/s**2, where there may be no answer


class Ensemble(Frozen):
    """Many chains of n rods, each with rods of its own, on one support; O(n) accelerations of all at once.  Immutable.

    ``Ensemble(mass, length, center, gyration, gravity=9.81, support_acceleration=(0, 0), damping=None, springs=None,
    upright=True)``

    ``ensemble[j]`` is chain j as a :class:`lagrangian.CompiledChain`, ``ensemble[:3]`` the ensemble of three,
    ``len(ensemble)`` how many there are.  From symbols: ``scene.compile({m: array})``.

    Parameters
    ----------
    mass, length, center, gyration : shape (chains, n), or what NumPy repeats to it: (n,) where all chains have the same
        numbers, (chains, 1) where all rods of a chain have; float64, to which other numbers are rounded; kg, m
    damping, springs : the same, or None; N m s, N m
    gravity, support_acceleration, upright : as for :class:`lagrangian.CompiledChain`, the same for all chains

    Raises
    ------
    SceneError
        Shapes that do not fit together; a chain without any mass; a damper or spring at a rod without mass.
    QuantityError, NotAQuantityError, TextError
        As for :class:`lagrangian.CompiledChain`, with the chain and the rod, ``mass[2, 0]``.

    Speed and accuracy
    ------------------
    Accelerations are as good as those of a :class:`lagrangian.CompiledChain`, within 4e-15 of the largest, and those
    in doubt are found again.  A thousand chains of two to a hundred rods take 4 to 14 ns a link and chain, a quarter
    more than chains with common rods (``benchmarks/chains.py many``).  Without numba NumPy's rows do it, tens of times
    slower.

    >>> ensemble = Ensemble([[1, 1], [1, 2], [1, 3]], [1, 1], [1, 1], [1, 1], gravity=10)
    >>> len(ensemble), ensemble.acceleration(0, [[0.5, 0.0]] * 3, [[0.0, 1.0]] * 3).round(3)[:, 0]
    (3, array([ 7.407,  9.196, 10.499]))
    """

    def __init__(self, mass: Any, length: Any, center: Any, gyration: Any, gravity: Any = 9.81,
                 support_acceleration: Any = (0, 0), damping: Any = None, springs: Any = None,
                 upright: bool = True) -> None:
        names = (*NAMES, "damping", "springs")
        given = {name: floats(values, name) for name, values in
                 zip(names, (mass, length, center, gyration, damping, springs), strict=True)
                 if values is not None or name in NAMES}
        arrays = _repeated(given)
        self._columns = checked([arrays[name] for name in NAMES])
        joints = [arrays.get(name) for name in ("damping", "springs")]
        if joints[0] is not None:
            check_damping(joints[0])
        self.damping, self.springs = (None if x is None or not x.any() else x for x in joints)
        check_joints(self._columns[0], [self.damping, self.springs])
        self.gravity, self.support, self.upright = gravity, shaking_of(support_acceleration), upright
        self._members: dict[int, CompiledChain] = {}
        self._first = self[0]
        self.gravity = self._first.gravity  # exact, once the first chain has checked it
        self._made = True

    def __len__(self) -> int:
        return len(self._columns[0])

    def __getitem__(self, j: Any) -> Any:
        """Chain j, a :class:`lagrangian.CompiledChain`; of a slice the ensemble of its chains.

        Raises IndexError where there is no chain j, NotAQuantityError where j is no integer, SceneError where a slice
        holds none.
        """
        if isinstance(j, slice):
            return Ensemble(*self._constants_of(j))
        j = place(j, len(self), "the ensemble has")
        if j not in self._members:
            self._members[j] = CompiledChain(*self._constants_of(j))
        return self._members[j]

    def _constants_of(self, which: int | slice) -> tuple[Any, ...]:
        """Of some chains, or of one, what :class:`Ensemble` and :class:`lagrangian.CompiledChain` are made from."""
        joints = (None if x is None else x[which] for x in (self.damping, self.springs))
        return *(x[which] for x in self._columns), self.gravity, self.support, *joints, self.upright

    def __iter__(self) -> Iterator[CompiledChain]:
        return map(self.__getitem__, range(len(self)))

    def __repr__(self) -> str:
        return f"Ensemble({len(self)} chains, the first of which is {self[0]})"

    def _repr_latex_(self) -> str:
        chains, n = self.shape
        return (r"$M_j(\theta_j)\, \ddot\theta_j = f_j(t, \theta_j, \dot\theta_j), "
                rf"\quad j = 0, \ldots, {chains - 1}, \quad n = {n}$")

    @property
    def shape(self) -> tuple[int, int]:
        """``(chains, n)``, the shape of theta."""
        return self._columns[0].shape  # type: ignore[no-any-return]

    def acceleration(self, t: Any, theta: Any, omega: Any) -> Any:
        """``theta''`` at time t, shape (chains, n) as theta and omega have; rad/s**2.

        (For many chains with the same rods :meth:`lagrangian.CompiledChain.acceleration` takes (n, chains).)
        The arithmetic is that of the numbers given, as for :meth:`lagrangian.CompiledChain.acceleration`; mpmath
        numbers and balls take one chain after the other.

        Raises SceneError if the shapes do not fit, QuantityError where there is no finite answer, TextError for text.
        """
        if not (is_plain(t, theta, omega) and theta.shape == self._columns[0].shape):
            if arithmetic_of(t, theta, omega) is not None:
                return self._exactly(t, theta, omega)
            t = float_time(t)
            theta, omega = (self._checked(floats(x, name), name) for x, name in ((theta, "theta"), (omega, "omega")))
        out = np.empty(theta.shape)
        ax, ay = self._first.steady_pull if self.support.steady else map(float, self._first.pull(t))
        done, doubtful = self._accelerated(theta, omega, ax, ay, out)
        if not done:
            raise QuantityError(why_no_answer(t, theta, omega))
        if self._may_lack_limit:
            for j in np.flatnonzero(abs(out).max(axis=1) > SUSPICIOUS).tolist():
                self[j].acceleration(t, theta[j], omega[j])  # which says so
        if doubtful is not False and np.any(doubtful):
            out[doubtful] = self._again(t, doubtful, theta[doubtful], omega[doubtful])
        return out

    @cached_property
    def _may_lack_limit(self) -> bool:
        """Whether some rods have no mass and others are turned by joints."""
        return not self.damping is None is self.springs and bool((self._columns[0] == 0).any())

    def _exactly(self, t: Any, theta: Any, omega: Any) -> Any:
        """``theta''`` in another arithmetic, of one chain after the other."""
        theta, omega = (self._checked(one_array(x, name), name) for x, name in ((theta, "theta"), (omega, "omega")))
        return np.stack([chain.acceleration(t, *state) for chain, *state in zip(self, theta, omega, strict=True)])

    def _again(self, t: Any, doubtful: Any, theta: Any, omega: Any) -> Any:
        """``theta''`` of some chains from exact numbers: all at once in pairs, or one after the other."""
        constants = [None if x is None else x[..., doubtful] for x in self._in_pairs]
        found, left = in_pairs(constants, self._first.fine_pull(t), theta.T, omega.T)
        which = np.flatnonzero(doubtful)
        for j in np.flatnonzero(left).tolist():
            found[:, j] = self[int(which[j])].acceleration(t, theta[j], omega[j])
        return found.T

    def _checked(self, state: Any, name: str) -> Any:
        if state.shape != self._columns[0].shape:
            raise SceneError(f"the ensemble has {len(self)} chains of {self.shape[1]} rods, and {name} has shape "
                             f"{state.shape}: give shape {self.shape}.")
        return state

    def _accelerated(self, theta: Any, omega: Any, ax: float, ay: float, out: Any) -> tuple[bool, Any]:
        """Write ``theta''`` in float64 alone; whether all are finite, and which chains are in doubt."""
        tau = self._torques(theta, omega)
        if has_numba():
            tau_across = None if tau is None else tau.T
            found = accelerate_together(self._lanes, theta.T, omega.T, tau_across, ax, ay, self._counterweighted, out.T)
            if found[0]:
                return found
        rods = np.stack([row.T for row in float_row(*self._columns)], axis=1)
        return accelerate_rows(rods, theta.T, omega.T, None if tau is None else tau.T, ax, ay, out.T)

    def _torques(self, theta: Any, omega: Any) -> Any:
        if self.damping is None is self.springs:
            return None
        tau = np.empty(self.shape)
        if has_numba():
            machine(joint_torques_of_each)(theta, omega, self.damping, self.springs, tau)
        else:
            damping, springs = (None if x is None else x.T for x in (self.damping, self.springs))
            joint_torques(theta.T, omega.T, damping, springs, tau.T)
        return tau

    @cached_property
    def _counterweighted(self) -> bool:
        """As for one chain: whether a rod has its centre beyond its near joint."""
        return bool((self._columns[2] < 0).any())

    @cached_property
    def _lanes(self) -> Any:
        m, l, _, Ic, J, *_ = float_row(*self._columns)
        return in_lanes(m, l, self._columns[2], Ic, J)

    @cached_property
    def _in_pairs(self) -> Any:
        _, *rest = self._columns
        light = float_row(*self._columns)[0]
        return rows_in_pairs(light.T, *(x.T for x in rest)), *(None if x is None else x.T + 0j
                                                               for x in (self.damping, self.springs))


def place(j: Any, count: int, these: str) -> int:
    """Chain j of ``count``, counted from the end where j is negative; IndexError where there is none.

    Raises NotAQuantityError for what is no integer.
    """
    try:
        return range(count)[index(j)]
    except IndexError:
        raise IndexError(f"{these} {count} chains, counted from 0, and {printed(j)} is none of them.") from None
    except TypeError:
        raise NotAQuantityError(f"{these} {count} chains, counted from 0, and {printed(j, repr)} is no integer: give "
                                f"one, or a slice.") from None


def _repeated(given: dict[str, Any]) -> dict[str, Any]:
    """Arrays of constants, all of the shape (chains, n) that they have together, and finite."""
    for name, array in given.items():
        if not np.isfinite(array).all():
            raise QuantityError(f"{name} holds {array[~np.isfinite(array)].flat[0]}, which is not finite: give finite "
                                f"numbers.")
    shapes = ", ".join(f"{name} {array.shape}" for name, array in given.items())
    try:
        shape = np.broadcast_shapes(*(array.shape for array in given.values()))
    except ValueError:
        shape = ()
    if len(shape) != 2 or 0 in shape:
        raise SceneError(f"an ensemble is chains of n rods, and its constants have the shapes {shapes}: give shape "
                         f"(chains, n), (n,) for what all chains share, or (chains, 1) for what all rods of a chain "
                         f"share.")
    return {name: locked(np.array(np.broadcast_to(array, shape), order="C")) for name, array in given.items()}
