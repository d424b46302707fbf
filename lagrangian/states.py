r"""Time, angles and rates as they are given: the arrays that a chain computes with, or a sentence why they are none.

A state of n rods has shape (n,), and the states of many chains with the same rods have shape (n, chains).
"""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from .errors import QuantityError, SceneError, printed
from .quantities import one_array, real_number, refuse_mask, refuse_text, refuse_unordered, to_float

__all__ = ["exact_states", "float_state", "float_states", "float_time", "floats", "is_plain", "shown",
           "why_no_answer", "within_floats"]

FLOAT64 = np.dtype(np.float64)
PLAIN_TIMES = (float, int, np.float64)


def is_plain(t: Any, theta: Any, omega: Any) -> bool:
    """Whether a float, or an int, comes with two contiguous float64 arrays of one shape: nothing else is asked then."""
    return (type(theta) is np.ndarray is type(omega) and theta.dtype is FLOAT64 is omega.dtype
            and theta.shape == omega.shape and theta.flags.c_contiguous and omega.flags.c_contiguous
            and type(t) in PLAIN_TIMES)


def float_time(t: Any) -> float:
    """A time as a float; raises as :func:`lagrangian.quantities.real_number`."""
    return t if type(t) in PLAIN_TIMES else within_floats(real_number(t, "t"), "t")


def floats(values: Any, name: str) -> Any:
    """Real numbers of any kind, in nested lists or an array, as contiguous float64 of the same shape."""
    if type(values) is np.ndarray and values.dtype is FLOAT64 and values.flags.c_contiguous:
        return values
    refuse_text(values, name)
    refuse_mask(values, name)
    refuse_unordered(values, name)
    try:
        array = np.asarray(values)
    except ValueError:  # rows of unequal length
        array = one_array(values, name)
    if array.dtype.kind not in "fiu":
        array = np.array([within_floats(real_number(x, name), name) for x in array.flat]).reshape(array.shape)
    return np.asarray(array, FLOAT64, order="C")


def within_floats(exact: Any, name: str) -> float:
    """:func:`lagrangian.quantities.to_float` of an exact number; QuantityError where floats do not reach so far."""
    found = to_float(exact)
    if abs(found) == inf:
        raise QuantityError(f"{name} holds {printed(exact)}, which is beyond the range of float64: change the units, "
                            f"or compute with mpmath numbers.")
    return found


def float_state(values: Any, name: str, n: int) -> Any:
    """Angles or rates as contiguous float64, shape (n,) or (n, chains).

    Raises SceneError for another shape; TextError, NotAQuantityError, QuantityError for what are no real numbers.
    """
    array = floats(values, name)
    _check_shape(array, name, n)
    return array


def float_states(theta: Any, omega: Any, n: int) -> tuple[Any, Any]:
    """Angles and rates as :func:`float_state` gives them, of the same shape."""
    theta, omega = float_state(theta, "theta", n), float_state(omega, "omega", n)
    _check_same(theta, omega)
    return theta, omega


def exact_states(theta: Any, omega: Any, n: int) -> tuple[Any, Any]:
    """Angles and rates as arrays of the numbers given, of the same shape (n,) or (n, chains)."""
    theta, omega = one_array(theta, "theta"), one_array(omega, "omega")
    _check_same(theta, omega)
    _check_shape(theta, "theta", n)
    return theta, omega


def shown(values: Any) -> str:
    """Numbers in a message: all of a few, or the first and how many there are."""
    few = ", ".join(map(str, values.flat[:6]))
    return f"[{few}]" if values.size <= 6 else f"[{few}, ...], {values.size} in all"


def why_no_answer(t: Any, theta: Any, omega: Any) -> str:
    """What it is in a state in float64 that leaves ``theta''`` without a finite value."""
    for name, values in (("t", np.asarray(t, dtype=float)), ("theta", theta), ("omega", omega)):
        if not np.isfinite(values).all():
            return f"{name} holds {values[~np.isfinite(values)].flat[0]}, which is not finite: give finite numbers."
    return (f"theta'' is beyond float64 at t = {t}: rates up to {abs(omega).max():.3g} rad/s, or constants of the "
            f"rods, overflow.  Change the units, or give mpmath numbers.")


def _check_shape(array: Any, name: str, n: int) -> None:
    if array.ndim not in (1, 2) or array.shape[0] != n:
        raise SceneError(f"the chain has {n} rods, and {name} has shape {array.shape}: give shape ({n},), or "
                         f"({n}, chains) for many chains.")


def _check_same(theta: Any, omega: Any) -> None:
    if theta.shape != omega.shape:
        raise SceneError(f"theta has shape {theta.shape} and omega {omega.shape}: give both the same shape.")
