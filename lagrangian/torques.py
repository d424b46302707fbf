r"""The torques of dampers and springs on the rods, ``tau_k = b_(k+1) - b_k`` with ``b_k = c_k delta_k' + k_k delta_k``.

A spring may all but balance a damper, and the joints of a rod each other.  In float64 every product and sum is formed
with its low half, so that a torque is wrong by little more than its own rounding, whatever cancels.
"""

from __future__ import annotations

from typing import Any

from .angles import difference, product
from .machine import inlined
from .stepper import total

__all__ = ["exact_torques", "joint_torques", "joint_torques_of_each", "joint_torques_of_many", "without_limit"]

# Rods without mass are 1e-90 of the heaviest, or 1e-400 with more digits; joints are folded to 1e-16, or to their
# digits: answers reach 1e32 or 1e90, ordinary ones being 1, or twice the digits or 1e400.
NO_LIMIT, NO_EXACT_LIMIT = 1e55, 1e280


def exact_torques(theta: Any, omega: Any, damping: Any, springs: Any) -> Any:
    """``tau`` in the arithmetic of the numbers given, arrays (n,); None where there is neither damper nor spring."""
    moment = None
    for constants, angle in ((damping, omega), (springs, theta)):
        if constants is not None:
            steps = angle.copy()
            steps[1:] = steps[1:] - angle[:-1]
            moment = constants * steps if moment is None else moment + constants * steps
    if moment is None:
        return None
    tau = -moment
    tau[:-1] = tau[:-1] + moment[1:]
    return tau


@inlined
def moment(constant: Any, ahead: Any, behind: Any) -> tuple[Any, Any]:
    """``constant (ahead - behind)`` as the nearest float and the rest."""
    d, e = difference(ahead, behind)
    p, q = product(constant, d)
    return p, q + constant * e


def joint_torques(theta: Any, omega: Any, damping: Any, springs: Any, tau: Any) -> None:
    """Write ``tau``; theta, omega, tau (n,) or (n, chains), damping and springs (n,) or None, all float64."""
    n = theta.shape[0]
    none = 0.0 * omega[0]
    beyond = rest_beyond = none
    for i in range(n):
        k = n - 1 - i
        b = rest = none
        if damping is not None:
            b, rest = moment(damping[k], omega[k], omega[k - 1] if k > 0 else none)
        if springs is not None:
            p, q = moment(springs[k], theta[k], theta[k - 1] if k > 0 else none)
            b, e = total(b, p)
            rest = rest + (q + e)
        t, e = difference(beyond, b)
        tau[k] = t + (e + (rest_beyond - rest))
        beyond, rest_beyond = b, rest


def joint_torques_of_many(theta: Any, omega: Any, damping: Any, springs: Any, tau: Any) -> None:
    """The same for many chains, one after the other, in machine code."""
    for j in range(theta.shape[1]):
        joint_torques(theta[:, j], omega[:, j], damping, springs, tau[:, j])


def joint_torques_of_each(theta: Any, omega: Any, damping: Any, springs: Any, tau: Any) -> None:
    """The same for chains with joints of their own: all shapes (chains, n), damping and springs may be None."""
    for j in range(theta.shape[0]):
        joint_torques(theta[j], omega[j], None if damping is None else damping[j],
                      None if springs is None else springs[j], tau[j])


def without_limit(mass: float, length: float, weight: float, omega: Any, torques: Any, found: Any) -> Any:
    """Whether a torque turns folded rods without mass, so that their ``theta''`` has no limit; for every chain.

    Shapes: omega, torques and found, ``theta''``, (n,) or (n, chains).  ``mass`` and ``length`` are those of the
    heaviest and of the shortest rod, ``weight`` the acceleration of gravity and support.
    """
    ordinary = abs(torques).max(axis=0) / (mass * length**2) + abs(weight) / length + (omega * omega).max(axis=0)
    return abs(found).max(axis=0) > (NO_EXACT_LIMIT if found.dtype == object else NO_LIMIT) * ordinary
