r"""Accelerations that float64 leaves in doubt, once more with twice the digits or more.

:mod:`lagrangian.recursion` says of every answer how much of it rounding may have taken.  Where that is too much, one
random state of an ordinary chain in some hundreds, the same recursion runs again on the exact numbers: constants,
sines and torques are formed anew, because float64 has rounded them too.  With numba the numbers are pairs of floats,
31 digits; without it, or where pairs do not suffice, by their range or because all but nothing is left of what acts,
mpmath's of DIGITS digits, far slower still (``benchmarks/hard_chains.py`` prints what it costs).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

import mpmath
import numpy as np

from .angles import LARGEST, difference, product
from .arithmetic import MPNumbers
from .machine import has_numba
from .pairs import added, multiplied, subtracted, to_pairs

__all__ = ["FINE", "constants_in_pairs", "in_pairs", "rows_in_pairs"]

DIGITS = 150  # and the products of four floats are exact
LEFT = 1e-12  # of what acts: pairs lose the digits before it, and hard chains some more
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
    """Rods, damping and springs of one chain, mpmath numbers of FINE, as pairs; shapes (n, 8, 1), (n, 1) or None."""
    return [None if part is None else to_pairs(part)[..., None] for part in (rods, *joints)]


def rows_in_pairs(m: Any, l: Any, H: Any, R: Any) -> Any:
    """The constants of :func:`lagrangian.constants.rod_row` from float64, (n, chains), as pairs, (n, 8, chains).

    Only differences of exact products and their products are rounded, so that each is right to some 31 digits.
    """
    RR, none = product(R, R), 0.0 * m
    spin, coupling = subtracted(*RR, *product(H, H)), subtracted(*RR, *product(H, l))
    beyond = difference(l, H)
    Ic = multiplied(m, none, *spin)
    turned = added(*Ic, *multiplied(m, none, *multiplied(*beyond, *beyond)))
    rows = [(m, none), (l, none), multiplied(m, none, *RR), Ic, multiplied(m, none, *coupling), turned, product(m, H),
            multiplied(m, none, *beyond)]
    return np.stack([high + 1j * low for high, low in rows], axis=1)


def in_pairs(constants: Any, pull: Any, theta: Any, omega: Any) -> tuple[Any, Any]:
    """``theta''`` of states (n, chains) in double-double, rounded to float64, and which chains need more digits.

    ``constants``: rods (n, 8, chains), damping and springs (n, chains) or None, in pairs, or 1 in place of chains where
    all have the same; ``pull`` two numbers of FINE, or floats.
    """
    size = abs(constants[0].real[constants[0].real != 0])
    if not has_numba() or not (1 / WIDEST < size.min() <= size.max() < WIDEST and abs(theta).max() < 0.5 * LARGEST):
        return np.empty(theta.shape), np.ones(theta.shape[1], dtype=bool)
    ax, ay = to_pairs(pull)
    out = np.empty(theta.shape)
    each: list[Any] = [None if x is None else np.broadcast_to(x, (*x.shape[:-1], theta.shape[1])) for x in constants]
    _translated()(*each, theta, omega, ax, ay, out)
    rods, joints = each[0].real, [None if x is None else x.real for x in each[1:]]
    acts = (omega * omega).max(axis=0) + max(abs(ax.real), abs(ay.real)) / rods[:, 1].min(axis=0)
    for constant, angle in zip(joints, (omega, theta), strict=True):
        if constant is not None:
            acts = acts + (abs(constant * np.diff(angle, axis=0, prepend=0.0)) / rods[:, 2]).max(axis=0)
    largest = abs(out).max(axis=0)
    return out, ~((largest > LEFT * acts) & (largest < np.inf))
