"""What a user gives as an exact number or expression: finite, real, a scalar, and never text.

A float is the dyadic number that it is: 0.5 is 1/2, and 0.1 is 3602879701896397/36028797018963968; write
``Rational(1, 10)`` where the decimal is meant.  ``to_float`` and ``high_low`` lead back to floats.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Set
from decimal import Decimal
from numbers import Integral, Rational as AnyRational, Real
from typing import Any

import flint
import mpmath
import numpy as np
from sympy import Catalan, E, EulerGamma, Expr, Float, GoldenRatio, I, Integer, Rational, log, nan, oo, pi, zoo

from .errors import NotAQuantityError, QuantityError, SceneError, TextError, printed

__all__ = ["AnyMpf", "high_low", "is_list", "namesakes", "one_array", "quantity", "real_number", "refuse_mask",
           "refuse_text", "refuse_unordered", "to_float", "truth"]

AnyMpf = mpmath.ctx_mp_python._mpf  # of whatever context
_NAMED = (  # mpmath's constants of any precision: equal to their roundings, so they are told apart by identity
    (mpmath.pi, pi), (mpmath.e, E), (mpmath.euler, EulerGamma), (mpmath.catalan, Catalan), (mpmath.phi, GoldenRatio),
    (mpmath.degree, pi / 180), (mpmath.ln2, log(2)), (mpmath.ln10, log(10)),
)


def refuse_text(value: Any, name: str) -> None:
    """Raise :class:`TextError` if ``value`` is text: SymPy would evaluate it."""
    if isinstance(value, (str, bytes, bytearray)):
        raise TextError(
            f"{name} is the text {value!r}, and text is never evaluated: give a number, or a SymPy expression "
            f"such as Symbol('m') or Rational(1, 2)."
        )


def refuse_unordered(values: Any, name: str) -> None:
    """Raise :class:`NotAQuantityError` for a mapping, read as its keys otherwise, and for a set, in any order."""
    if isinstance(values, (Mapping, Set)):
        raise NotAQuantityError(f"{name} is {values!r}, a {type(values).__name__}, and what is in one has no order "
                                f"here: give a list.")


def refuse_mask(values: Any, name: str) -> None:
    """Raise :class:`NotAQuantityError` for an array of which some entries are masked."""
    if isinstance(values, np.ma.MaskedArray):
        raise NotAQuantityError(f"{name} is an array with a mask, and every entry counts here: give an array without.")


def is_list(values: Any) -> bool:
    """Whether there are entries to ask for: an array without axes has none, though NumPy's arrays are all iterable."""
    return isinstance(values, Iterable) and getattr(values, "ndim", 1) != 0


def one_array(values: Any, name: str) -> Any:
    """``values`` as an array of objects; :class:`SceneError` where they are arrays or Matrices that make none."""
    try:
        return np.asarray(values, dtype=object)
    except ValueError:
        raise SceneError(f"{name} is {printed(values, repr)}, whose parts have shapes that make no array together: "
                         f"give numbers, in lists of one length or in one array.") from None


def truth(value: Any, name: str) -> bool:
    """A truth value; :class:`NotAQuantityError` for anything else, of which many have none."""
    if not isinstance(value, (bool, np.bool_)):
        raise NotAQuantityError(f"{name} is {printed(value, repr)}, which is no truth value: give True or False.")
    return bool(value)


def quantity(value: Any, name: str) -> Any:
    """``value`` as an exact SymPy expression: finite, real, commutative; ``name`` is used in messages.

    Raises :class:`TextError`, :class:`NotAQuantityError` or :class:`QuantityError`.
    """
    refuse_text(value, name)
    expression = _exact(value, name)
    if expression.has(nan, oo, -oo, zoo):
        raise QuantityError(f"{name} is {expression}, which is not finite: give a finite number.")
    if expression.is_real is False or (expression.is_number and expression.has(I) and not expression.is_real):
        raise QuantityError(f"{name} is {expression}, which is not real: give a real number.")
    return expression


def namesakes(given: Set[Any], held: Set[Any]) -> str | None:
    """Why a Symbol that is held is none of those given, though one of them is called like it; None where none is."""
    others = {x.name for x in held} - {x.name for x in held & given}
    alike = sorted(others & {x.name for x in given})
    return (f"the {alike[0]} of the scene and the {alike[0]} that is given share the name but not the assumptions, and "
            f"are two variables to SymPy: use one and the same Symbol in both places." if alike else None)


def real_number(value: Any, name: str) -> Any:
    """An exact number; raises as :func:`quantity`, and QuantityError where a Symbol or a function is in it."""
    exact = quantity(value, name)
    if not exact.is_number:
        symbols = sorted(map(str, exact.free_symbols))
        raise QuantityError(f"{name} is {exact}, which holds the Symbol {symbols[0]}: give a number for it, as in "
                            f"scene.compile({{symbol: number}})." if symbols else
                            f"{name} is {exact}, which is no number: give a number.")
    return exact


def to_float(exact: Any) -> float:
    """An exact SymPy number, or any real number, as the nearest float."""
    return float(exact) if getattr(exact, "is_Rational", True) else float(exact.evalf(30, maxn=1200))


def high_low(exact: Any) -> tuple[float, float]:
    """An exact SymPy number as the nearest float and what that leaves."""
    high = to_float(exact)
    rest = exact - Rational(high)
    return high, float(rest if rest.is_Rational else rest.evalf(20, maxn=1200))


def _exact(value: Any, name: str) -> Any:
    """Numbers of every kind as exact rationals or constants; SymPy scalars with their floats made exact."""
    for constant, exact in _NAMED:
        if value is constant:
            return exact
    if isinstance(value, Expr) and value.is_commutative and not getattr(value, "is_Matrix", False):
        return value.xreplace({x: Rational(*_ratio(x)) for x in value.atoms(Float) if x.is_finite})
    if isinstance(value, (bool, np.timedelta64)):
        kind = "a truth value" if isinstance(value, bool) else "which has a unit of time"
        raise NotAQuantityError(f"{name} is {value}, {kind}: give a number or a SymPy expression.")
    if isinstance(value, Integral):
        return Integer(int(value))
    if isinstance(value, (flint.fmpz, flint.fmpq)):
        return Rational(int(value.numerator), int(value.denominator))
    if isinstance(value, flint.arb):
        return _of_ball(value, name)
    if isinstance(value, AnyRational):
        return Rational(int(value.numerator), int(value.denominator))
    binary = isinstance(value, AnyMpf) and not isinstance(value, mpmath.mp.constant)
    if binary or (isinstance(value, (Decimal, Real)) and hasattr(value, "as_integer_ratio")):
        if not (mpmath.isfinite(value) if binary else math.isfinite(value)):
            raise QuantityError(f"{name} is {value}, which is not finite: give a finite number.")
        return Rational(*_ratio(value))
    raise NotAQuantityError(
        f"{name} is {value!r} of type {type(value).__name__}, not a scalar: give a real number or a commutative "
        f"SymPy expression."
    )


def _of_ball(value: Any, name: str) -> Any:
    if not value.is_finite():
        raise QuantityError(f"{name} is {value}, which is not finite: give a finite number.")
    if not value.is_exact():
        raise QuantityError(f"{name} is the ball {value}, and rods and chains are made of numbers: give its middle.")
    mantissa, exponent = value.man_exp()
    return Integer(int(mantissa)) * Integer(2) ** int(exponent)


def _ratio(value: Any) -> tuple[int, int]:
    """A finite binary or decimal number as an exact fraction."""
    if not isinstance(value, (Float, AnyMpf)):
        numerator, denominator = value.as_integer_ratio()
        return int(numerator), int(denominator)
    negative, mantissa, exponent, _ = value._mpf_
    signed = -int(mantissa) if negative else int(mantissa)
    return signed * 2 ** max(int(exponent), 0), 2 ** max(-int(exponent), 0)
