r"""Taylor series of functions of time: how a prescribed motion enters the Taylor stepper.

A ``Jet`` is ``x_0 + x_1 h + ... + x_p h**p`` with coefficients of any number type.  Products are
convolutions, and every elementary function solves a linear differential equation, read as a recurrence:

    y = exp x:   k y_k = sum_(i=1..k) i x_i y_(k-i)
    s = sin x:   k s_k = sum i x_i c_(k-i),   c = cos x:   k c_k = -sum i x_i s_(k-i)
    y = tan x:   k y_k = sum i x_i u_(k-i),   u = 1 + y**2;   tanh x:  u = 1 - y**2;   y = sech x:  y' = -y tanh(x) x'
    y = x**a:    k x_0 y_k = sum_(i=1..k) (a i - (k - i)) x_i y_(k-i)

so that nothing grows that the function does not: tanh and 1/cosh of 1000 are 1 and 0.

A SymPy expression is evaluated by walking its tree; no text is made of it and none is executed.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from operator import add, mul, neg, sub, truediv
from typing import Any

import numpy as np
from sympy import Add, E, Expr, Mul, Pow, cos, cosh, cot, coth, csc, csch, exp, log, sec, sech, sin, sinh, tan, tanh

from .arithmetic import arithmetic_of
from .errors import DriveError
from .quantities import to_float

__all__ = ["Jet", "evaluate"]

Function = Callable[[Any], Any]


class Jet:
    """A truncated Taylor series; ``sines`` takes sine and cosine of one coefficient."""

    def __init__(self, coefficients: list[Any], elementary: dict[str, Function]) -> None:
        self.coefficients, self.elementary = coefficients, elementary

    def _like(self, coefficients: list[Any]) -> Jet:
        return Jet(coefficients, self.elementary)

    def _taken(self, other: Any) -> Any:
        """A SymPy number as one of the coefficients' kind, numpy's as Python's, anything else as it is."""
        if not isinstance(other, Expr):
            return other.item() if isinstance(other, np.generic) else other
        arithmetic = arithmetic_of(self.coefficients[0])
        return to_float(other) if arithmetic is None else arithmetic.number(other)

    def _other(self, other: Any) -> list[Any]:
        other = self._taken(other)
        zero = 0 * self.coefficients[0]
        return other.coefficients if isinstance(other, Jet) else [other + zero] + [zero] * (len(self.coefficients) - 1)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        """numpy's functions of a series, and numpy's numbers on the left of one."""
        name = ufunc.__name__
        if method == "__call__" and not options and name in FUNCTIONS:
            return getattr(self, name)()
        if method == "__call__" and not options and name in _OPERATIONS:
            return _OPERATIONS[name](*(x.item() if isinstance(x, np.generic) else x for x in inputs))
        return NotImplemented

    def __add__(self, other: Any) -> Jet:
        return self._like([x + y for x, y in zip(self.coefficients, self._other(other), strict=True)])

    def __mul__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            other = self._taken(other)
            return self._like([x * other for x in self.coefficients])
        x, y = self.coefficients, other.coefficients
        return self._like([reduce(add, map(mul, x[:k + 1], y[k::-1])) for k in range(len(x))])

    def __neg__(self) -> Jet:
        return self._like([-x for x in self.coefficients])

    def __sub__(self, other: Any) -> Jet:
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Jet:
        return self.__neg__().__add__(other)

    __radd__, __rmul__ = __add__, __mul__

    def __pow__(self, a: Any) -> Jet:
        if isinstance(a, Jet):
            return (a * self.log()).exp()
        a = self._taken(a)
        if isinstance(a, (int, float, np.integer, np.floating)) and float(a).is_integer():
            a = int(a)
        if isinstance(a, int) and a >= 0:
            one = self._like(self._other(1 + 0 * self.coefficients[0]))
            power: Jet = reduce(mul, [self] * a, one)
            return power
        x = self.coefficients
        if not isinstance(a, int):
            a = a + 0 * x[0]  # of their kind, or a i - (k - i) would be rounded to a float
        y = [x[0] ** a]
        for k in range(1, len(x)):
            y.append(reduce(add, ((a * i - (k - i)) * x[i] * y[k - i] for i in range(1, k + 1))) / (k * x[0]))
        return self._like(y)

    def __rpow__(self, a: Any) -> Jet:
        return self.__mul__(self.elementary["log"](self._taken(a) + 0 * self.coefficients[0])).exp()

    def __truediv__(self, other: Any) -> Jet:
        if isinstance(other, Jet):
            return self.__mul__(other.__pow__(-1))
        other = self._taken(other)  # 1 / other would be rounded to a float
        return self._like([x / other for x in self.coefficients])

    def __rtruediv__(self, other: Any) -> Jet:
        return self.__pow__(-1).__mul__(other)

    def _solve(self, starts: list[Any], rates: list[tuple[int, int]]) -> list[Jet]:
        """Solve ``y_a' = sign x' y_b`` for all pairs ``rates[a] = (b, sign)`` at once."""
        slopes, found = [i * x for i, x in enumerate(self.coefficients)][1:], [[y] for y in starts]
        for k in range(1, len(self.coefficients)):
            new = [sign * reduce(add, map(mul, slopes[:k], found[b][k - 1::-1])) / k for b, sign in rates]
            for series, y in zip(found, new, strict=True):
                series.append(y)
        return [self._like(y) for y in found]

    def _at_start(self, *names: str) -> list[Any]:
        return [self.elementary[name](self.coefficients[0]) for name in names]

    def sin(self) -> Jet:
        return self._solve(self._at_start("sin", "cos"), [(1, 1), (0, -1)])[0]

    def cos(self) -> Jet:
        return self._solve(self._at_start("sin", "cos"), [(1, 1), (0, -1)])[1]

    def sinh(self) -> Jet:
        return self._solve(self._at_start("sinh", "cosh"), [(1, 1), (0, 1)])[0]

    def cosh(self) -> Jet:
        return self._solve(self._at_start("sinh", "cosh"), [(1, 1), (0, 1)])[1]

    def tan(self) -> Jet:
        return self._tangent("tan", 1)

    def tanh(self) -> Jet:
        return self._tangent("tanh", -1)

    def _tangent(self, name: str, sign: int) -> Jet:
        """Solve ``y' = (1 + sign y**2) x'``."""
        slopes, y = [i * x for i, x in enumerate(self.coefficients)][1:], self._at_start(name)
        u: list[Any] = []
        for k in range(1, len(self.coefficients)):
            u.append(sign * reduce(add, map(mul, y, y[::-1])) + (k == 1))
            y.append(reduce(add, map(mul, slopes[:k], u[::-1])) / k)
        return self._like(y)

    def sech(self) -> Jet:
        y, tanh = self._at_start("sech"), self.tanh().coefficients
        slopes = self._like([i * x for i, x in enumerate(self.coefficients)][1:])
        rates = slopes.__mul__(self._like(tanh[:-1])).coefficients
        for k in range(1, len(self.coefficients)):
            y.append(-reduce(add, map(mul, rates[:k], y[::-1])) / k)
        return self._like(y)

    def exp(self) -> Jet:
        return self._solve([self.elementary["exp"](self.coefficients[0])], [(0, 1)])[0]

    def sqrt(self) -> Jet:
        half = (1 + 0 * self.coefficients[0]) / 2
        return self.__pow__(half)

    def log(self) -> Jet:
        x, y = self.coefficients, [self.elementary["log"](self.coefficients[0])]
        for k in range(1, len(x)):
            past = reduce(add, (i * y[i] * x[k - i] for i in range(1, k)), 0 * x[0])
            y.append((k * x[k] - past) / (k * x[0]))
        return self._like(y)


def _elementary(name: str) -> Function:
    """A function of numbers of any type, by name."""
    def function(x: Any) -> Any:
        context = getattr(x, "context", None)
        if context is not None:
            return getattr(context, name)(x)  # an mpmath number, whose own .exp is its exponent
        method = getattr(x, name, None)
        if method is not None:
            return method()
        with np.errstate(all="ignore"):  # what is not finite is seen where it ends
            return 1 / np.cosh(x) if name == "sech" else getattr(np, name)(x)
    return function


FUNCTIONS: dict[str, Function] = {
    name: _elementary(name) for name in ("sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "tanh", "sech")}
_OPERATIONS: dict[str, Callable[..., Any]] = {
    "add": add, "subtract": sub, "multiply": mul, "divide": truediv, "negative": neg, "power": pow,
    "square": lambda x: x * x}
_SIMPLE = {sin: "sin", cos: "cos", tan: "tan", exp: "exp", log: "log", sinh: "sinh", cosh: "cosh", tanh: "tanh",
           sech: "sech"}
_REWRITTEN = {sec: lambda x: 1 / cos(x), csc: lambda x: 1 / sin(x), cot: lambda x: cos(x) / sin(x),
              csch: lambda x: 1 / sinh(x), coth: lambda x: 1 / tanh(x)}


def evaluate(expression: Any, t: Any, value: Any, number: Function) -> Any:
    """``expression`` at ``t = value``, a number or a :class:`Jet`; ``number`` brings exact constants into the type.

    Raises DriveError at anything but sums, products, powers and elementary functions.
    """
    if expression == t:
        return value
    if t not in expression.free_symbols:
        if not expression.is_number:
            raise DriveError(f"the drive is a function of {t} alone, and {expression} is in it: give it a value.")
        if expression.is_real is False:
            raise DriveError(f"the drive holds {expression}, which is not real: write it with real numbers, powers of "
                             f"{t} with positive ones.")
        return number(expression)
    if isinstance(expression, (Add, Mul)):
        parts = [evaluate(part, t, value, number) for part in expression.args]
        return reduce(add if isinstance(expression, Add) else mul, parts)
    if isinstance(expression, exp) or (isinstance(expression, Pow) and expression.base == E):
        return FUNCTIONS["exp"](evaluate(expression.exp, t, value, number))
    if isinstance(expression, Pow) and t in expression.exp.free_symbols:
        exponent, root = (evaluate(part, t, value, number) for part in (expression.exp, log(expression.base)))
        return FUNCTIONS["exp"](exponent * root)
    if isinstance(expression, Pow):
        if isinstance(expression.base, cosh) and expression.exp.is_negative:
            return evaluate(sech(expression.base.args[0]) ** -expression.exp, t, value, number)
        base = evaluate(expression.base, t, value, number)
        return base ** (int(expression.exp) if expression.exp.is_Integer else number(expression.exp))
    if type(expression) in _SIMPLE:
        return FUNCTIONS[_SIMPLE[type(expression)]](evaluate(expression.args[0], t, value, number))
    if type(expression) in _REWRITTEN:
        return evaluate(_REWRITTEN[type(expression)](expression.args[0]), t, value, number)
    raise DriveError(f"the drive contains {expression}, whose Taylor series is not known here: write it with sums, "
                     f"products, powers, {', '.join(_SIMPLE.values())}, or give support_acceleration as a function of "
                     f"t.")
