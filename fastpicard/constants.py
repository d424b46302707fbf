"""mpmath's constants as the numbers that they name."""

from __future__ import annotations

from typing import Any

import mpmath
import sympy
from sympy import Expr

from fastpicard.errors import BadTypeError

_NAMED = (  # mpmath's constants of any precision: equal to their roundings, so they are told apart by identity
    (mpmath.pi, sympy.pi), (mpmath.e, sympy.E), (mpmath.euler, sympy.EulerGamma), (mpmath.catalan, sympy.Catalan),
    (mpmath.phi, sympy.GoldenRatio), (mpmath.degree, sympy.pi / 180), (mpmath.ln2, sympy.log(2)),
    (mpmath.ln10, sympy.log(10)),
)


def exact_constant(value: Any, what: str) -> Expr:
    """A constant of mpmath as the number it names, not as its rounding at the precision of the day.

    Raises
    ------
    BadTypeError
        for those that SymPy has no name for.
    """
    for constant, exact in _NAMED:
        if value is constant:
            return exact
    raise BadTypeError(f"{what} must be a number that is known exactly, but it is {value!r}, a constant of mpmath that "
                       "has no exact form here.  Give its digits, as an mpf or a SymPy Float.")
