r"""A chain of rods as numbers: its accelerations in O(n), for one chain or many, in the arithmetic of the state.

    M(theta) theta'' = f(t, theta, theta')   is solved without forming M;  see lagrangian/recursion.py.

Angles are from the upward vertical, clockwise, as in the article; ``upright=False`` counts them from the
downward vertical, anticlockwise, as in the notes: the same equations with ``g + eta''`` negated.

The model is the least that the chain requires: ``"bobs"`` (tensions alone) where every rod is a point mass on a
massless rod and no joint has a damper or a spring, ``"rods"`` otherwise.  Rods without mass are the limit of
ever lighter rods of the same H and R, which all have the same mass: where two of them are neighbours it matters.
"""

from __future__ import annotations

from functools import cached_property
from threading import local
from typing import Any

import numpy as np

from .angles import LARGEST
from .arithmetic import Arithmetic, arithmetic_of
from .constants import even
from .errors import QuantityError
from .lanes import accelerate_rows, accelerate_together
from .links import Links
from .machine import has_numba, machine
from .recursion import accelerate_bobs, accelerate_rods
from .redone import FINE, in_pairs
from .single import MODELS, ordinary
from .states import exact_states, float_states, float_time, is_plain, shown, why_no_answer
from .torques import exact_torques, joint_torques, joint_torques_of_many, without_limit

__all__ = ["CompiledChain"]

LONG = 10_000
LONG_EVEN = 100  # even rods, from which on they are asked for their doubt only if straight somewhere


class CompiledChain(Links):
    """A chain of n rods with numbers for everything; O(n) accelerations.  Immutable.

    ``CompiledChain(mass, length, center, gyration, gravity=9.81, support_acceleration=(0, 0), damping=None,
    springs=None, upright=True, model=None)``

    Parameters
    ----------
    mass, length, center, gyration : n numbers each, as for :class:`lagrangian.Rod`, with masses that may be 0; kg, m
    gravity : g, pointing down; m/s**2
    support_acceleration : ``(xi'', eta'')``, or a function of t giving the pair; m/s**2
    damping, springs : n joint constants each, or None, as for :class:`lagrangian.Scene`; N m s, N m
    upright : whether angles are from the upward vertical (the article) or the downward one (the notes)
    model : None, ``"bobs"`` or ``"rods"``; None takes the least that will do, and ``chain.model`` says which

    Attributes
    ----------
    gravity : g as the exact SymPy number it was given as; ``float(chain.gravity)`` is a float again; m/s**2
    upright, model : as above, ``"bobs"`` or ``"rods"``; ``len(chain)`` is n
    rods : shape (n, 8), float64: mass, length and moments of every rod, see :attr:`rods`; kg, m, kg m**2, kg m
    damping, springs : shape (n,), float64, or None; N m s, N m

    Floats are taken as the exact numbers they are, SymPy numbers and fractions too.  Accelerations in float64 round:
    within 4e-15 of the largest for masses 1e12 and lengths 1e6 apart.  Where float64 leaves that in doubt, at one
    ordinary state in 750 and at one in nineteen of such chains, the same recursion runs again with 31 digits or more.
    Not asked is one chain of a hundred links and more with free joints whose rods are even (masses and lengths within a
    factor 4) while all its joints are bent: what it would be in doubt of is a fifth of 4e-15 at most
    (``benchmarks/hard_chains.py bent``).

    Raises
    ------
    SceneError
        No rods; lists of different lengths; no mass at all; a damper or spring at a rod without mass.
    QuantityError, NotAQuantityError, TextError
        A negative mass, a length or gyration that is not positive, ``gyration < abs(center)``, a number that is not
        finite or not real; a thing of the wrong kind; text.

    Speed and accuracy
    ------------------
    With numba: 16 to 40 ns a link for one long chain, 3 to 12 ns a link and chain for a thousand chains; an answer in
    doubt costs 12 to 50 times more, and the first one seconds of translation.  Without numba the same source runs as
    Python, 10 us a link.  Beyond angles of 8e5 the library's sine is used, a third slower; such an angle loses nothing
    as the float that it is, but that float itself knows the angle to 1e-10.

    >>> chain = CompiledChain([1, 1], [2, 2], [1, 1], [1.2, 1.2], gravity=10)
    >>> chain.model, chain.acceleration(0, [0.0, 0.0], [1.0, -1.0]).round(12) + 0.0
    ('rods', array([0., 0.]))
    """

    def __init__(self, mass: Any, length: Any, center: Any, gyration: Any, gravity: Any = 9.81,
                 support_acceleration: Any = (0, 0), damping: Any = None, springs: Any = None, upright: bool = True,
                 model: str | None = None) -> None:
        super().__init__(mass, length, center, gyration, gravity, support_acceleration, damping, springs, upright,
                         model)

    def acceleration(self, t: Any, theta: Any, omega: Any) -> Any:
        """``theta''`` at time t; rad/s**2.

        Shapes: theta and omega (n,), or (n, chains) for many chains with the same rods; the result likewise.  (It is
        (chains, n) for :class:`lagrangian.Ensemble` and :func:`lagrangian.simulate`: where there are as many chains as
        rods, nothing tells one from the other.)  The arithmetic is that of the numbers given: float64; mpmath numbers,
        at the precision of their context; python-flint balls, at flint's current precision, and then the result
        contains the true one for all states and times in the balls.

        Raises SceneError if the shapes do not fit, QuantityError where there is no finite answer, TextError for text.
        """
        plain = is_plain(t, theta, omega)
        tried = plain and theta.shape == self._shape and self._ordinary
        if tried:  # one call of machine code is all
            free, constants, pull = tried
            out = np.empty(self._shape)
            if free(constants, theta, omega, *pull, np.empty(10 * self._count), out):
                return out
        if not (plain and 0 < theta.ndim < 3 and len(theta) == self._count):
            arithmetic = arithmetic_of(t, theta, omega)
            if arithmetic is not None:
                return self._exactly(arithmetic, t, theta, omega)
            t = float_time(t)
            theta, omega = float_states(theta, omega, self._count)
        ax, ay = self.steady_pull if self._steady else map(float, self.pull(t))
        out = np.empty(theta.shape)
        if theta.ndim == 2:
            done, doubtful = self._many(theta, omega, ax, ay, out)
        else:
            done, doubtful = self._one(theta, omega, ax, ay, out, *((self._large(theta), True) if tried else ()))
        if not done:
            raise QuantityError(why_no_answer(t, theta, omega))
        if self._may_lack_limit:
            self._check_limit(t, theta, omega, self.torques(theta, omega), out)
        if doubtful is not False and np.any(doubtful):
            n, doubtful = len(self), np.atleast_1d(doubtful)
            out.reshape(n, -1)[:, doubtful] = self._again(t, *(x.reshape(n, -1)[:, doubtful] for x in (theta, omega)))
        return out

    @cached_property
    def _may_lack_limit(self) -> bool:
        """Whether some rods have no mass and others are turned by joints."""
        return self.has_torques and bool((self._columns[0] == 0).any())

    def _check_limit(self, t: Any, theta: Any, omega: Any, torques: Any, found: Any) -> None:
        """Raise QuantityError where ``theta''`` has no limit, see :func:`lagrangian.torques.without_limit`."""
        m, l = self.rods[:, :2].T.tolist()
        if np.any(without_limit(max(m), min(l), max(map(abs, self.steady_pull)), omega, torques, found)):
            raise QuantityError(f"theta'' has no limit at t = {t}, theta = {shown(theta)}: rods without mass lie "
                                f"folded in one line, and the torques of joints beyond turn them infinitely fast.  "
                                f"Give them a mass, or other angles.")

    @cached_property
    def _unasked(self) -> bool | None:
        """True where the chain is not asked for its doubt while it is bent, else None: torques might balance."""
        spared = self._count >= LONG_EVEN and not self.has_torques and not self._counterweighted
        return spared and even(*self.rods[:, :3].T) or None

    def _again(self, t: Any, theta: Any, omega: Any) -> Any:
        """``theta''`` of states (n, chains) from exact numbers, rounded once."""
        pull = self.fine_pull(t)
        found, left = in_pairs(self._in_pairs, pull, theta, omega)
        for j in np.flatnonzero(left).tolist():
            found[:, j] = self._in_arithmetic(FINE, t, theta[:, j], omega[:, j], self._fine, pull).astype(float)
        return found

    def _one(self, theta: Any, omega: Any, ax: float, ay: float, out: Any,
             large: bool | None = None, asked: bool = False) -> tuple[bool, Any]:
        single, constants = self._single
        if single is None:
            return self._many(theta, omega, ax, ay, out)
        space = np.empty(10 * self._count) if self._count < LONG else self._space()
        tau = self.torques(theta, omega) if self.has_torques else None
        unasked = None if asked else self._unasked
        done, doubtful = single(constants, theta, omega, tau, ax, ay, large, unasked, space, out)
        if unasked and doubtful:
            return self._one(theta, omega, ax, ay, out, large, asked=True)
        if done or large or not self._large(theta):
            return done, doubtful
        return self._one(theta, omega, ax, ay, out, True, asked)

    @staticmethod
    def _large(theta: Any) -> bool | None:
        """True where an angle is too large for the quicker sines, else None."""
        return bool(abs(theta).max() >= 0.5 * LARGEST) or None

    @cached_property
    def _ordinary(self) -> tuple[Any, Any, Any] | None:
        """The machine code, constants and pull of most calls, for one chain that nothing shakes, damps or bends."""
        if not has_numba() or self.has_torques or not self._steady or self._count >= LONG:
            return None
        return machine(ordinary[self.model, self._unasked]), self._single[1], self.steady_pull

    @cached_property
    def _single(self) -> tuple[Any, Any]:
        """The machine code for one chain, None without numba, and the constants that it takes."""
        constants = self._bobs if self.model == "bobs" else self._rods
        return machine(MODELS[self.model]) if has_numba() else None, constants

    @cached_property
    def _kept(self) -> local:
        return local()

    def _space(self) -> Any:
        """Room for intermediate values, kept by every thread: the system takes longer to give it than it is used."""
        if not hasattr(self._kept, "space"):
            self._kept.space = np.empty(10 * self._count)
        return self._kept.space

    def _many(self, theta: Any, omega: Any, ax: float, ay: float, out: Any) -> tuple[bool, Any]:
        tau = self.torques(theta, omega) if self.has_torques else None
        if has_numba() and theta.ndim == 2:
            found = accelerate_together(self._rods, theta, omega, tau, ax, ay, self._counterweighted, out)
            if found[0]:
                return found
        return accelerate_rows(self.rods, theta, omega, tau, ax, ay, out)

    def torques(self, theta: Any, omega: Any) -> Any:
        """The torque of dampers and springs on every rod, None where there are none; N m, the shape of theta."""
        if not self.has_torques:
            return None
        if theta.dtype == object:
            return exact_torques(theta, omega, *self._joint_floats)
        tau = np.empty_like(theta)
        if not has_numba():
            joint_torques(theta, omega, *self._joint_floats, tau)
        elif theta.ndim == 1:
            machine(joint_torques)(theta, omega, *self._joint_floats, tau)
        else:
            machine(joint_torques_of_many)(theta, omega, *self._joint_floats, tau)
        return tau

    def _exactly(self, arithmetic: Arithmetic, t: Any, theta: Any, omega: Any) -> Any:
        """``theta''`` of states (n,) or (n, chains) in another arithmetic."""
        theta, omega = exact_states(theta, omega, len(self))
        out = np.empty(theta.shape, dtype=object)
        for chain in np.ndindex(theta.shape[1:]):
            at = (slice(None), *chain)
            out[at] = self._in_arithmetic(arithmetic, t, theta[at], omega[at])
            if self._may_lack_limit:
                self._check_limit(t, theta[at], omega[at], self.torques(theta[at], omega[at]), out[at])
        if not all(map(arithmetic.answers, out.flat)):
            raise QuantityError(f"theta'' is not finite at t = {t}, theta = {shown(theta)}, omega = "
                                f"{shown(omega)}: give finite numbers, or balls that are narrower, with more bits for "
                                f"them (flint.ctx).")
        return out

    def _in_arithmetic(self, arithmetic: Arithmetic, t: Any, theta: Any, omega: Any, constants: Any = None,
                       pull: Any = None) -> Any:
        """``constants``: rods and joints, and ``pull``, where they are known already."""
        n = len(self)
        theta, omega = (arithmetic.array(x) for x in (theta, omega))
        s, c = (np.empty(n, dtype=object) for _ in range(2))
        for k in range(n):
            s[k], c[k] = arithmetic.sines(theta[k] - theta[k - 1] if k else theta[0])
        rods, joints = constants or (self.rods_in(arithmetic), self.joints_in(arithmetic))
        ax, ay = pull or self.pull(arithmetic.coerced(t), arithmetic)
        out, work = np.empty(n, dtype=object), arithmetic.zeros(n, 4)
        if self.model == "bobs":
            ratios = [0 * rods[0, 0], *(rods[1:, 0] / rods[:-1, 0])]
            bobs = np.stack([rods[:, 0], rods[:, 1], np.array(ratios, dtype=object), 1 / rods[:, 0]], axis=1)
            accelerate_bobs(bobs, omega * omega, s, c, ax, ay, work, None, out)
        else:
            tau = exact_torques(theta, omega, *joints)
            accelerate_rods(rods, omega * omega, tau, s, c, ax, ay, work, None, out)
        return out
