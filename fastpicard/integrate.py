r"""`gather`, `product_to_sum` and `new_integrate`: the article's tools on SymPy expressions.

``new_integrate`` replaces the built-in integral for the family F ([Neves],
section 4): the antiderivative is found by the recursion (8) and (9), summed to one
division whose divisor is remembered, and its constant makes it vanish at time 0,

    I[sin qt] = 1/q - (1/q) cos qt

so that the definite integral from 0 costs nothing more than the indefinite one.
"""

from __future__ import annotations

from typing import Any

import sympy
from sympy import Expr, Symbol

from fastpicard import modes as algebra
from fastpicard.errors import BadTypeError
from fastpicard.origin import at_time
from fastpicard.reading import as_finite, as_time, check_same_time, read
from fastpicard.writing import gathered, write


def gather(expr: Any, t: Symbol) -> Expr:
    """Collect like terms: one coefficient for each ``t**r cos(q t + phi)`` and ``t**r sin(q t + phi)``.

    [Neves], section 4.  Exact; products of sines and cosines are turned into sums first.

    Raises
    ------
    NotInFamilyError, BadTypeError
        as :class:`PoissonSeries` does.

    Examples
    --------
    >>> from sympy.abc import a, b, t
    >>> from sympy import cos
    >>> gather(a*t*cos(2*t) + b*t*cos(2*t) + 3, t)
    t*(a + b)*cos(2*t) + 3
    """
    t = as_time(t)
    return gathered(read(expr, t), t)


def product_to_sum(expr: Any, t: Symbol) -> Expr:
    """Turn products and powers of sines and cosines into sums: the expanded, canonical form.

    [Neves], section 4 (the replacement for ``TrigReduce``).  Exact.

    Raises
    ------
    NotInFamilyError, BadTypeError
        as :class:`PoissonSeries` does.

    Examples
    --------
    >>> from sympy.abc import t
    >>> from sympy import cos, sin
    >>> product_to_sum(sin(t)*cos(t)**2, t)
    sin(t)/4 + sin(3*t)/4
    """
    t = as_time(t)
    return write(read(expr, t), t)


def new_integrate(expr: Any, variable: Any) -> Any:
    """Integrate a function of the family, exactly.

    ``new_integrate(expr, t)`` is the antiderivative that is zero at ``t = 0``
    ([Neves] (8), (9)); ``new_integrate(expr, (t, lo, hi))`` the definite
    integral, limits symbolic or numbers, in either order.  A matrix is
    integrated entry by entry.  Where a frequency is symbolic the result holds
    wherever it does not vanish.

    Raises
    ------
    NotInFamilyError
        if the integrand is no sum of ``t**r cos(q t + phi)`` and ``t**r sin(q t + phi)``.
    BadInputError
        if a limit is not finite.
    BadTypeError
        if the variable is no Symbol, or text is given.

    Examples
    --------
    >>> from sympy.abc import a, t
    >>> from sympy import cos, pi, sin
    >>> new_integrate(sin(2*t), t)
    1/2 - cos(2*t)/2
    >>> new_integrate(a*t*sin(t), (t, 0, pi))
    pi*a
    """
    t, limits = _variable(variable)
    if isinstance(expr, sympy.MatrixBase):
        return expr.applyfunc(lambda entry: new_integrate(entry, variable))
    antiderivative = algebra.antiderivative(read(expr, t))
    if limits is None:
        return write(antiderivative, t)
    lower, upper = limits
    if lower == 0:
        return write(antiderivative, t) if upper == t else at_time(antiderivative, upper, t)
    return at_time(antiderivative, upper, t) - at_time(antiderivative, lower, t)


def _variable(variable: Any) -> tuple[Symbol, tuple[Expr, Expr] | None]:
    if not isinstance(variable, tuple | list | sympy.Tuple):
        return as_time(variable), None
    if len(variable) != 3:
        raise BadTypeError(f"the variable must be t or (t, lower, upper), but it is {variable!r}.  "
                           "Give both limits or none.")
    t = as_time(variable[0])
    return t, (_limit(variable[1], t), _limit(variable[2], t))


def _limit(value: Any, t: Symbol) -> Expr:
    limit = as_finite(value, "a limit of the integral")
    check_same_time(limit, t)
    return limit
