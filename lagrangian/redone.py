r"""Accelerations that float64 leaves in doubt, once more with twice the digits or more.

:mod:`lagrangian.recursion` says of every answer how much of it rounding may have taken.  Where that is too much, one
random state of an ordinary chain in some hundreds, the same recursion runs again on the exact numbers: constants,
sines and torques are formed anew, because float64 has rounded them too.  With numba the numbers are pairs of floats,
31 digits; without it, or where the range of pairs does not suffice, mpmath's of DIGITS digits, far slower still
(``benchmarks/hard_chains.py`` prints what it costs).
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

__all__ = ["FINE", "constants_in_pairs", "in_pairs"]

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


def constants_in_pairs(rods: Any, joints: Any) -> Any:
    """Rods, damping and springs, mpmath numbers of FINE, as pairs; None where these have not the range."""
    rods, *joints = (None if part is None else to_pairs(part) for part in (rods, *joints))
    size = abs(rods.real[rods.real != 0])
    return (rods, *joints) if size.max() < WIDEST and size.min() > 1 / WIDEST else None


def in_pairs(constants: Any, pull: Any, theta: Any, omega: Any) -> Any:
    """``theta''`` of states (n, chains) in double-double, rounded to float64; None where that has not the range.

    ``constants`` are those of :func:`constants_in_pairs`; ``pull`` two numbers of FINE, or floats.
    """
    if constants is None or not has_numba() or not abs(theta).max() < 0.5 * LARGEST:
        return None
    ax, ay = to_pairs(pull)
    out = np.empty(theta.shape)
    _translated()(*constants, theta, omega, ax, ay, out)
    return out if np.isfinite(out).all() else None
