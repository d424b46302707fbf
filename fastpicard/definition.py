r"""Picard iteration of any equation, by the definition ([Neves] (2)).

    x_0 = x0,    x_{n+1}(t) = x0 + integral from t0 to t of f(s, x_n(s)) ds
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy
from sympy import Basic, Expr, ImmutableMatrix, Matrix, Symbol
from sympy.logic.boolalg import Boolean

from fastpicard.errors import BadInputError, BadTypeError, ShapeError
from fastpicard.matrix import as_list
from fastpicard.reading import as_expression, as_finite, as_time, check_same_time, plain
from fastpicard.values import check_order
from fastpicard.writing import dyadic

# Of an elementary function of one of these SymPy knows no antiderivative, and searches many minutes to find that out.
SPECIAL = (sympy.fresnels, sympy.fresnelc, sympy.erf, sympy.erfi, sympy.Si, sympy.Ci, sympy.Ei, sympy.li)


def picard(f: Callable[[Any, Matrix], Any], t: Symbol, x0: Any, n: int, t0: Any = 0) -> ImmutableMatrix:
    """The n-th Picard iterate of any ``x' = f(t, x)``, by the definition ([Neves] (2), In[1] and In[2]).

    Parameters
    ----------
    f : function of (t, x)
        returns the right-hand side, a list or column Matrix as long as ``x``, a column Matrix of shape (m, 1).
    t : Symbol
    x0 : list or Matrix, length m     the value at ``t0``, free of ``t``
    n : int, from 0 up
    t0 : number or expression free of ``t``

    Returns
    -------
    ImmutableMatrix, shape (m, 1)
        exact; a float is the dyadic number it is.  Integrals come from SymPy's ``integrate``; one that SymPy cannot
        do stays an unevaluated ``Integral``, which is a correct answer (Out[3]).

    Raises
    ------
    BadInputError, BadTypeError
        for an order that is no integer from 0 up, ``x0``, ``t0`` that contain ``t`` or text, and where nan or an
        infinity occurs.
    ShapeError
        if ``f`` returns another number of components.

    Examples
    --------
    >>> from sympy.abc import t
    >>> picard(lambda t, x: [x[1], -x[0]], t, [1, 0], 3)
    Matrix([
    [1 - t**2/2],
    [t**3/6 - t]])
    """
    if not callable(f):
        raise BadTypeError(f"f must be a function of (t, x), but it is {f!r}.  Use lambda t, x: [...].")
    t = as_time(t)
    start = _plain_vector(x0, t)
    t0 = _plain_constant(t0, t, "t0")
    x = Matrix(start)
    for k in range(check_order(n)):
        s = sympy.Dummy(f"s{k + 1}")  # of every integration its own, should one stay in another
        slope = _slope(f(t, x), t)
        if slope.shape != x.shape:
            raise ShapeError(f"f(t, x) must have the shape {x.shape} of x0, but its shape is {slope.shape}.  "
                             "Return one component for each unknown.")
        x = Matrix([_proper(start[i] + _integral(slope[i].subs(t, s), s, t0, t), f"the integral of component {i} of "
                            f"f(t, x) from {t0} to {t}") for i in range(len(start))])
    return ImmutableMatrix(x)


def _integral(integrand: Expr, s: Symbol, lower: Expr, upper: Expr) -> Expr:
    """SymPy's integral; left unevaluated where a function of a special function occurs, as in Out[3]."""
    compositions = (f for f in integrand.atoms(sympy.Function) if s in f.free_symbols)
    if any(argument.has(*SPECIAL) for f in compositions for argument in f.args):
        return sympy.Integral(integrand, (s, lower, upper))
    return sympy.integrate(integrand, (s, lower, upper))


def _slope(value: Any, t: Symbol) -> Matrix:
    value = value.tolist() if isinstance(value, sympy.MatrixBase) else plain(value)
    if isinstance(value, str) or not isinstance(value, list | tuple):
        raise BadTypeError(f"f(t, x) must be a list or a column vector, but it is {value!r}.  Return its components.")
    rows = [row if isinstance(row, list | tuple) else [row] for row in value]
    if len({len(row) for row in rows}) > 1:
        raise ShapeError(f"f(t, x) must be a list or a column vector, but its rows have the lengths "
                         f"{[len(row) for row in rows]}.  Return its components.")
    return Matrix([[_component(entry, t) for entry in row] for row in rows])


def _component(value: Any, t: Symbol) -> Expr:
    what = "every component of f(t, x)"
    expression = dyadic(as_expression(value, what))
    check_same_time(expression, t)
    if not expression.is_commutative:
        raise BadInputError(f"{what} must commute, but it is {expression}.  Use a commutative Symbol.")
    return _proper(expression, what)


def _proper(expression: Expr, what: str) -> Expr:
    if _is_infinite(expression):
        raise BadInputError(f"{what} must be finite, but it is {expression}.  Start at a t0 and x0 where f(t, x) is "
                            "regular.")
    return expression


def _is_infinite(e: Basic) -> bool:
    """Whether nan or an infinity occurs, not counting conditions of pieces and limits of sums and integrals."""
    if not e.args:
        return e is sympy.nan or e.is_finite is False
    return not isinstance(e, Boolean) and type(e) is not sympy.Tuple and (
        isinstance(e, sympy.AccumBounds) or any(map(_is_infinite, e.args)))


def _plain_constant(value: Any, t: Symbol, what: str) -> Expr:
    expression = dyadic(as_finite(value, what))
    check_same_time(expression, t)
    if t in expression.free_symbols:
        raise BadInputError(f"{what} must not depend on {t}, but it is {expression}.  Use another symbol.")
    return expression


def _plain_vector(x0: Any, t: Symbol) -> list[Expr]:
    x0 = as_list(x0)
    if isinstance(x0, str) or not isinstance(x0, list | tuple | sympy.MatrixBase):
        raise BadTypeError(f"x0 must be a list or a column vector, but it is {x0!r}.  Give its components.")
    return [_plain_constant(value, t, f"x0[{i}]") for i, value in enumerate(x0)]
