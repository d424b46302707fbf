r"""Accelerations that float64 leaves in doubt, once more with twice the digits or more.

:mod:`lagrangian.recursion` says of every answer how much of it rounding may have taken.  Where that is too much, one
random state of an ordinary chain in some hundreds, the same recursion runs again on the exact numbers: constants,
sines and torques are formed anew, because float64 has rounded them too.  With numba the numbers are pairs of floats,
31 digits, ten times slower than float64; without it, or where the range of pairs does not suffice, mpmath's of DIGITS
digits, a thousand times slower.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

import mpmath
import numpy as np

from .angles import LARGEST
from .arithmetic import MPNumbers
from .machine import has_numba
from .pairs import to_pairs

__all__ = ["FINE", "in_pairs"]

DIGITS = 150  # and the products of four floats are exact
WIDEST = 1e40  # of a constant, and its inverse the smallest: five of them multiplied stay far within float64


def _fine() -> MPNumbers:
    context = mpmath.mp.clone()
    context.dps = DIGITS
    return MPNumbers(context)


FINE = _fine()


@cache
def _translated() -> Callable[..., None]:
    found: Callable[..., None] = import_module(f"{__package__}.pairtype").pair_accelerations
    return found


def in_pairs(rods: Any, joints: Any, pull: Any, theta: Any, omega: Any) -> Any:
    """``theta''`` of states (n, chains) in double-double, rounded to float64; None where that has not the range.

    ``rods``, damping and springs in ``joints`` and the two numbers of ``pull`` are mpmath numbers of FINE.
    """
    if not has_numba() or not abs(theta).max() < 0.5 * LARGEST:
        return None
    rods, (damping, springs), (ax, ay) = to_pairs(rods), joints, to_pairs(pull)
    size = abs(rods.real[rods.real != 0])
    if not (size.max() < WIDEST and size.min() > 1 / WIDEST):
        return None
    damping, springs = (None if part is None else to_pairs(part) for part in (damping, springs))
    out = np.empty(theta.shape)
    _translated()(rods, damping, springs, theta, omega, ax, ay, out)
    return out if np.isfinite(out).all() else None
