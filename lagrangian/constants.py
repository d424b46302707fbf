r"""The constants of a chain, checked: lists of numbers as float64 columns, or as exact SymPy numbers.

From mass m, length l, centre H and radius of gyration R the recursion needs

    I = m R**2,   Ic = m (R**2 - H**2),   J = m (R**2 - H l),   It = Ic + m (l - H)**2,   m H,   m (l - H).

The two differences of products are formed with the low halves of the products, so that a bob, or a rod whose
centre of percussion is near its end, loses no digits here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from math import prod
from typing import Any

import numpy as np
from sympy import Symbol
from sympy.core.relational import Relational

from .angles import product
from .errors import NotAQuantityError, QuantityError, SceneError, printed
from .frozen import locked
from .quantities import (
    is_list,
    namesakes,
    one_array,
    quantity,
    real_number,
    refuse_mask,
    refuse_text,
    refuse_unordered,
    to_float,
)

__all__ = ["EPSILON", "LIGHT", "NAMES", "check_damping", "check_joints", "checked", "column", "even", "float_row",
           "joint_constants", "one_by_one", "rod_row", "signs", "substitution", "to_floats", "unsettled"]

EPSILON = float(np.finfo(float).eps)

NAMES = ("mass", "length", "center", "gyration")
LIGHT = 1e-90  # of the largest mass: stands for no mass, also where rods fold back to 1e-16 and masses are 1e12 apart


def rod_row(m: Any, l: Any, H: Any, RR: Any) -> tuple[Any, ...]:
    """``m, l, I, Ic, J, It, m H, m (l - H)`` from exact numbers, ``RR = R**2``."""
    Ic = m * (RR - H**2)
    return m, l, m * RR, Ic, m * (RR - H * l), Ic + m * (l - H) ** 2, m * H, m * (l - H)


def products(a: Any, b: Any, c: Any, d: Any) -> Any:
    """``a b - c d`` for arrays, as if rounded once: the low halves of the products are kept."""
    (p, pe), (q, qe) = product(a, b), product(c, d)
    return (p - q) + (pe - qe)


def float_row(m: Any, l: Any, H: Any, R: Any) -> tuple[Any, ...]:
    """:func:`rod_row` of float64 columns, each rounded once or twice; shapes (n,), or (chains, n)."""
    m = np.where(m == 0, LIGHT * m.max(axis=-1, keepdims=True), m)
    spin, coupling = products(R, R, H, H), products(R, R, H, l)
    return m, l, m * R * R, m * spin, m * coupling, m * (spin + (l - H) ** 2), m * H, m * (l - H)


def even(m: Any, l: Any, I: Any) -> bool:
    """Whether masses, and lengths, are within a factor 4 of each other, and no rod is a tenth as wide as long."""
    return bool(m.max() <= 4 * m.min() and l.max() <= 4 * l.min() and (m * l * l <= 100 * I).all())


@lru_cache(64)
def signs(shape: tuple[int, ...]) -> Any:
    """1 and -1 by the Thue-Morse sequence, so that ``I`` and ``m H`` of every rod differ, and those of its neighbours.

    A single rod knows nothing of its constants but ``m H/I``.
    """
    found, size = np.ones(1), prod(shape)
    while found.size < size:
        found = np.concatenate([found, -found])
    return locked(found[:size].reshape(shape))


def unsettled(values: Any, sign: int) -> Any:
    """Floats moved by a unit in the last place or two, up and down by :func:`signs`, or by their negatives; any shape.

    Sign 0 leaves them.
    """
    return values * (1.0 + sign * EPSILON * signs(values.shape)) if sign else values


def to_floats(values: Any) -> Any:
    """Numbers as float64, shape (n,), read only; None stays None."""
    if values is None:
        return None
    return locked(np.array([to_float(x) for x in values]))


def column(values: Any, name: str) -> Any:
    """float64 where that is what was given, else exact SymPy numbers as an object array."""
    refuse_text(values, name)
    refuse_mask(values, name)
    refuse_unordered(values, name)
    if getattr(values, "ndim", 1) > 1:
        raise SceneError(f"{name} has shape {values.shape}, and the rods of a CompiledChain are given by n numbers: "
                         f"give Ensemble(mass, length, center, gyration) for many chains, each with its own rods.")
    if isinstance(values, np.ndarray) and values.dtype.kind in "fiu" and values.ndim == 1:
        if not np.isfinite(values).all():
            bad = values[~np.isfinite(values)][0]
            raise QuantityError(f"{name} holds {bad}, which is not finite: give finite numbers.")
        return values.astype(np.float64)
    if not is_list(values):
        raise NotAQuantityError(f"{name} is {printed(values, repr)}: give a list with one {name} for each rod.")
    found = list(values)
    if all(type(x) is float for x in found):
        return column(np.array(found, dtype=np.float64), name)
    out = np.empty(len(found), dtype=object)
    for i, x in enumerate(found):
        out[i] = real_number(x, f"{name}[{i}]")
    return out


def checked(columns: list[Any]) -> list[Any]:
    """The four columns of a chain, or of many, all of one type; raises as :class:`lagrangian.CompiledChain` says.

    Shapes: (n,); or (chains, n), float64.
    """
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
        for at, x in _wrong(column, fine):
            allowed = "positive or 0" if name == "mass" else "positive"
            raise QuantityError(f"the {name} of a rod is {allowed}, and {name}{at} is {printed(x)}.")
    for at, x in _wrong(gyration, ~_shorter(gyration, abs(center))):
        raise QuantityError(f"the radius of gyration about the joint is at least the distance of the centre of mass, "
                            f"and gyration{at} is {printed(x)} and center{at} is {printed(center[*at])}: give "
                            f"gyration >= |center|.")
    if not (mass > 0).astype(bool).any(axis=-1).all():
        raise SceneError("a chain without any mass has no equations of motion, 0 theta'' = 0: give a rod a mass.")
    return columns


def _wrong(column: Any, fine: Any) -> Iterator[tuple[list[int], Any]]:
    """Where, and what, the entries are that are not fine."""
    for at in np.argwhere(~fine.astype(bool)).tolist():
        yield at, column[*at]


def check_damping(damping: Any) -> None:
    """Raise QuantityError where a damper would put energy in."""
    for at, x in _wrong(damping, damping >= 0):
        raise QuantityError(f"joint damping takes energy out, and damping{at} is {printed(x)}: give a value >= 0.")


def _shorter(left: Any, right: Any) -> Any:
    """Where ``left < right``; SymPy leaves that open for equal numbers such as ``sin(1)**2 + cos(1)**2`` and 1."""
    if left.dtype != object:
        return left < right

    def is_shorter(x: Any, y: Any) -> bool:
        relation = x < y
        return not isinstance(relation, Relational) and bool(relation)
    return np.frompyfunc(is_shorter, 2, 1)(left, right).astype(bool)


def joint_constants(values: Any, name: str, count: int) -> Any:
    """Dampers or springs as a column; None where all are 0."""
    if values is None:
        return None
    found = column(values, name)
    if len(found) != count:
        raise SceneError(f"{name} has one value for every joint, and here are {len(found)} values for {count} rods: "
                         f"give {count} values (0 where a joint has none).")
    if name == "damping":
        check_damping(found)
    return found if any(found != 0) else None


def check_joints(mass: Any, joints: list[Any]) -> None:
    """Raise SceneError where a joint turns a rod without mass."""
    for name, values in zip(("damping", "springs"), joints, strict=True):
        if values is not None:
            acts = (values != 0).astype(bool)
            acts[..., :-1] |= acts[..., 1:]
            for at, _ in _wrong(mass, ~acts | (mass != 0).astype(bool)):
                rod = f"rod {at[-1] + 1}" + (f" of chain {at[0]}" if len(at) > 1 else "")
                raise SceneError(f"{rod} has no mass, and the {name} at its joints would turn it infinitely fast: give "
                                 f"it a mass, or free its joints.")


def substitution(values: Mapping[Any, Any] | None, t: Any) -> Callable[[Any], Any]:
    """``expression -> expression`` with numbers for Symbols, of which the time ``t`` is none.

    Raises as :func:`quantity`, and NotAQuantityError.
    """
    refuse_text(values, "values")
    if values is not None and not isinstance(values, Mapping):
        raise NotAQuantityError(f"values is {printed(values, repr)}: give a mapping of Symbols to numbers, "
                                f"as in {{m: 1, l: 2}}.")
    numbers = {}
    for symbol, value in (values or {}).items():
        refuse_text(symbol, "a key of values")
        if not isinstance(symbol, Symbol):
            raise NotAQuantityError(f"values maps {printed(symbol, repr)}, which is not a Symbol, to "
                                    f"{printed(value, repr)}: give Symbols.")
        if symbol == t:
            raise QuantityError(f"the time {t} is no parameter, and values gives it the value {printed(value, repr)}, "
                                f"which would stop the support: leave {t} out, and give it to acceleration(t, theta, "
                                f"omega).")
        numbers[symbol] = quantity(value, f"the value of {symbol}")

    def replaced(expression: Any) -> Any:
        found = expression.xreplace(numbers)
        why = namesakes(numbers.keys(), found.free_symbols)
        if why:
            raise QuantityError(f"{expression} is left without a number: {why}")
        return found
    return replaced


def one_by_one(values: Mapping[Any, Any] | None) -> list[Mapping[Any, Any]]:
    """The values of every chain, where some Symbols have an array of one number a chain; empty where none has."""
    if not isinstance(values, Mapping):
        return []
    many = {symbol: one_array(x, f"the value of {symbol}") for symbol, x in values.items()
            if isinstance(x, (np.ndarray, list, tuple))}
    shapes = {x.shape for x in many.values()}
    if len(shapes) > 1 or any(len(shape) != 1 or not shape[0] for shape in shapes):
        raise SceneError(f"the chains of an ensemble have one number each for a Symbol, and here are the shapes "
                         f"{', '.join(f'{symbol} {x.shape}' for symbol, x in many.items())}: give shape (chains,).")
    return [{**values, **dict(zip(many, row))} for row in zip(*many.values())]
