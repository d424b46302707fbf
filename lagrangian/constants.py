r"""The constants of a chain, checked: lists of numbers as float64 columns, or as exact SymPy numbers.

From mass m, length l, centre H and radius of gyration R the recursion needs

    I = m R**2,   Ic = m (R**2 - H**2),   J = m (R**2 - H l),   It = Ic + m (l - H)**2,   m H,   m (l - H).

The two differences of products are formed with the low halves of the products, so that a bob, or a rod whose
centre of percussion is near its end, loses no digits here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from sympy import Symbol

from .angles import product
from .errors import NotAQuantityError, QuantityError, SceneError
from .quantities import quantity, real_number, refuse_text, to_float

__all__ = ["NAMES", "check_joints", "checked", "column", "joint_constants", "products", "rod_row", "substitution",
           "to_floats"]

NAMES = ("mass", "length", "center", "gyration")


def rod_row(m: Any, l: Any, H: Any, RR: Any) -> tuple[Any, ...]:
    """``m, l, I, Ic, J, It, m H, m (l - H)`` from exact numbers, ``RR = R**2``."""
    Ic = m * (RR - H**2)
    return m, l, m * RR, Ic, m * (RR - H * l), Ic + m * (l - H) ** 2, m * H, m * (l - H)


def products(a: Any, b: Any, c: Any, d: Any) -> Any:
    """``a b - c d`` for arrays, as if rounded once: the low halves of the products are kept."""
    (p, pe), (q, qe) = product(a, b), product(c, d)
    return (p - q) + (pe - qe)


def to_floats(values: Any) -> Any:
    """Numbers as float64, shape (n,); None stays None."""
    return None if values is None else np.array([to_float(x) for x in values])


def column(values: Any, name: str) -> Any:
    """float64 where that is what was given, else exact SymPy numbers as an object array."""
    refuse_text(values, name)
    if getattr(values, "ndim", 1) > 1:
        raise SceneError(f"{name} has shape {values.shape}: many chains at once have the same rods and differ in "
                         f"their states, so give n numbers, and make one CompiledChain for every set of rods.")
    if isinstance(values, np.ndarray) and values.dtype.kind in "fiu" and values.ndim == 1:
        if not np.isfinite(values).all():
            bad = values[~np.isfinite(values)][0]
            raise QuantityError(f"{name} holds {bad}, which is not finite: give finite numbers.")
        return values.astype(np.float64)
    if isinstance(values, (int, float)) or not isinstance(values, Iterable):
        raise NotAQuantityError(f"{name} is {values!r}: give a list with one {name} for each rod.")
    found = list(values)
    if all(type(x) is float for x in found):
        return column(np.array(found, dtype=np.float64), name)
    out = np.empty(len(found), dtype=object)
    for i, x in enumerate(found):
        out[i] = real_number(x, f"{name}[{i}]")
    return out


def checked(columns: list[Any]) -> list[Any]:
    """The four columns of a chain, all of one type; raises as :class:`lagrangian.CompiledChain` says."""
    counts = [len(column) for column in columns]
    if not all(counts):
        raise SceneError("the number N of rods is positive, and a list here is empty: give at least one rod.")
    if len(set(counts)) > 1:
        raise SceneError("every rod has one mass, length, center and gyration, and here are "
                         + ", ".join(f"{count} x {name}" for count, name in zip(counts, NAMES, strict=True)) + ".")
    if any(column.dtype == object for column in columns):
        columns = [np.array([quantity(x, "number") for x in column], dtype=object) for column in columns]
    mass, length, center, gyration = columns
    for name, column, fine in (("mass", mass, mass >= 0), ("length", length, length > 0),
                               ("gyration", gyration, gyration > 0)):
        wrong = np.flatnonzero(~fine.astype(bool))
        if wrong.size:
            allowed = "positive or 0" if name == "mass" else "positive"
            raise QuantityError(f"the {name} of a rod is {allowed}, and {name}[{wrong[0]}] is {column[wrong[0]]}.")
    wrong = np.flatnonzero(~(gyration >= abs(center)).astype(bool))
    if wrong.size:
        i = wrong[0]
        raise QuantityError(f"the radius of gyration about the joint is at least the distance of the centre of mass, "
                            f"and rod {i + 1} has gyration = {gyration[i]} and center = {center[i]}: give "
                            f"gyration >= |center|.")
    if not any(mass > 0):
        raise SceneError("a chain without any mass has no equations of motion, 0 theta'' = 0: give a rod a mass.")
    return columns


def joint_constants(values: Any, name: str, count: int) -> Any:
    """Dampers or springs as a column; None where all are 0."""
    if values is None:
        return None
    found = column(values, name)
    if len(found) != count:
        raise SceneError(f"{name} has one value for every joint, and here are {len(found)} values for {count} rods: "
                         f"give {count} values (0 where a joint has none).")
    wrong = np.flatnonzero(~(found >= 0).astype(bool)) if name == "damping" else np.array([], dtype=int)
    if wrong.size:
        raise QuantityError(f"joint damping takes energy out, and damping[{wrong[0]}] is {found[wrong[0]]}: give a "
                            f"value >= 0.")
    return found if any(found != 0) else None


def check_joints(mass: Any, joints: list[Any]) -> None:
    """Raise SceneError where a joint turns a rod without mass."""
    for name, values in zip(("damping", "springs"), joints, strict=True):
        for k in np.flatnonzero((mass == 0).astype(bool)) if values is not None else ():
            if values[k] != 0 or (k + 1 < len(values) and values[k + 1] != 0):
                raise SceneError(f"rod {k + 1} has no mass, and the {name} at its joints would turn it infinitely "
                                 f"fast: give it a mass, or free its joints.")


def substitution(values: Mapping[Any, Any] | None) -> Callable[[Any], Any]:
    """``expression -> expression`` with numbers for Symbols; raises as :func:`quantity`, and NotAQuantityError."""
    refuse_text(values, "values")
    if values is not None and not isinstance(values, Mapping):
        raise NotAQuantityError(f"values is {values!r}: give a mapping of Symbols to numbers, as in {{m: 1, l: 2}}.")
    numbers = {}
    for symbol, value in (values or {}).items():
        refuse_text(symbol, "a key of values")
        if not isinstance(symbol, Symbol):
            raise NotAQuantityError(f"values maps {symbol!r}, which is not a Symbol, to {value!r}: give Symbols.")
        numbers[symbol] = quantity(value, f"the value of {symbol}")
    return lambda expression: expression.xreplace(numbers)
