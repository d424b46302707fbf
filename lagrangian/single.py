"""One chain in float64 from angles to accelerations, in one call of machine code.

For short chains the call from Python costs more than the arithmetic, so that sines, recursion and the check that
every result is finite are one function, and none of it allocates in Python.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .angles import LARGEST, difference, sines
from .machine import rebound, reordered
from .recursion import DOUBT, accelerate_bobs, accelerate_rods

__all__ = ["MODELS", "ordinary", "single_bobs", "single_rods"]

BENT = 0.01  # long even chains whose joints are so bent are in no doubt (benchmarks/hard_chains.py bent)


@reordered
def count_beyond(theta: Any, limit: float) -> float:
    """How many angles are no smaller than the limit."""
    total = 0.0
    for k in range(theta.shape[0]):
        total += 1.0 if abs(theta[k]) >= limit else 0.0
    return total


@reordered
def bent(s: Any, c: Any) -> bool:
    """Whether every eight joints in a row are, by the mean of ``(s c)**2``, 1/8 where angles are any.

    Joints that are straight, folded or square count nothing.
    """
    straight = 0.0
    for first in range(0, s.shape[0] - 7, 8):
        total = 0.0
        for k in range(first, first + 8):
            total += (s[k] * c[k]) ** 2
        straight += 1.0 if total < 8 * BENT else 0.0
    return straight == 0.0


@reordered
def finite(out: Any) -> bool:
    """Whether every number is."""
    total = 0.0
    for k in range(out.shape[0]):
        total += 0.0 * out[k]
    return total == 0.0


def joint_sines(theta: Any, omega: Any, large: Any, s: Any, c: Any, z: Any) -> bool:
    """Sine and cosine of every joint angle, and the squares of the rates; all shapes (n,).  Whether they are right.

    ``large`` is None where no angle passes ``LARGEST / 2``, so that the code for larger ones is not even translated.
    """
    n = theta.shape[0]
    for k in range(n):
        z[k] = omega[k] * omega[k]
    if large is None:
        s[0], c[0] = sines(theta[0], 0.0)
        for k in range(1, n):
            d, e = difference(theta[k], theta[k - 1])
            s[k], c[k] = sines(d, e)
        return count_beyond(theta, 0.5 * LARGEST) == 0.0
    s[0], c[0] = np.sin(theta[0]), np.cos(theta[0])
    for k in range(1, n):
        d, e = difference(theta[k], theta[k - 1])
        x, y, p, q = np.sin(d), np.cos(d), np.sin(e), np.cos(e)
        s[k], c[k] = x * q + y * p, y * q - x * p
    return True


def judged(out: Any, doubt: Any) -> tuple[bool, bool]:
    """Whether every number is finite, and whether the answer is in doubt."""
    total = lost = size = most = 0.0
    for k in range(out.shape[0]):
        x, v = out[k], doubt[k]
        total += 0.0 * x
        lost += 0.0 * v
        size = max(size, x * x)
        most = max(most, v)
    return total == 0.0, lost != 0.0 or most > DOUBT * DOUBT * size


def single_rods(rods: Any, theta: Any, omega: Any, tau: Any, ax: float, ay: float, large: Any, unasked: Any, space: Any,
                out: Any) -> tuple[bool, bool]:
    """Write ``theta''`` of rods to ``out``, shape (n,); whether it is finite and right with these sines; its doubt.

    ``tau`` is (n,) or None; ``large`` None or True, see :func:`joint_sines`; ``unasked`` True where a chain that is
    bent is not asked for its doubt, else None, so that the code for that is not translated; one that is not bent is
    left undone and in doubt.  ``space``, (10 n,), is for intermediate values.
    """
    n = theta.shape[0]
    s, c, z, work = space[:n], space[n:2 * n], space[2 * n:3 * n], space[3 * n:7 * n].reshape(n, 4)
    right = joint_sines(theta, omega, large, s, c, z)
    if unasked is None:
        doubt = space[7 * n:10 * n].reshape(3, n)
        accelerate_rods(rods, z, tau, s, c, ax, ay, work, doubt, out)
        done, doubtful = judged(out, doubt[0])
    elif not bent(s, c):
        done, doubtful = False, True
    else:
        accelerate_rods(rods, z, tau, s, c, ax, ay, work, None, out)
        done, doubtful = finite(out), False
    return done and right, doubtful


def single_bobs(bobs: Any, theta: Any, omega: Any, tau: None, ax: float, ay: float, large: Any, unasked: Any,
                space: Any, out: Any) -> tuple[bool, bool]:
    """The same for bobs, which have no torques."""
    n = theta.shape[0]
    s, c, z, work = space[:n], space[n:2 * n], space[2 * n:3 * n], space[3 * n:5 * n].reshape(n, 2)
    right = joint_sines(theta, omega, large, s, c, z)
    if unasked is None:
        doubt = space[5 * n:6 * n]
        accelerate_bobs(bobs, z, s, c, ax, ay, work, doubt, out)
        done, doubtful = judged(out, doubt)
    elif not bent(s, c):
        done, doubtful = False, True
    else:
        accelerate_bobs(bobs, z, s, c, ax, ay, work, None, out)
        done, doubtful = finite(out), False
    return done and right, doubtful


MODELS = {"bobs": single_bobs, "rods": single_rods}
single, unasked = single_rods, None  # of the function below, for each of which there is a copy


def free(constants: Any, theta: Any, omega: Any, ax: float, ay: float, space: Any, out: Any) -> bool:
    """Write ``theta''`` of a chain without torques; whether it is finite, right with these sines, and in no doubt."""
    done, doubtful = single(constants, theta, omega, None, ax, ay, None, unasked, space, out)
    return done and not doubtful


ordinary = {(model, spared): rebound(free, single=function, unasked=spared)
            for model, function in MODELS.items() for spared in (None, True)}
