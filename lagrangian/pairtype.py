"""Pairs of floats as a number type of numba, so that the Taylor recursion is translated to double-double as it stands.

An array of complex128 is taken as an array of pairs, high halves real and low halves imaginary: the same memory under
another name.  numba itself then indexes and cuts arrays of pairs; ``+ - * /`` between pairs, or a pair and a number,
are the functions of :mod:`lagrangian.pairs`, run as written.  The remainder of a product is one fused instruction in
place of Dekker's seventeen; both give the same float.

Importing this file imports numba; :mod:`lagrangian.doubled` does so where it is installed, and when it is used.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from math import factorial
from typing import Any

import numpy as np
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, make_attribute_wrapper, models, overload, register_model

from .angles import HALF_1, HALF_2, HALF_3, PER_HALF, ROUND, difference, product
from .machine import as_written, inlined, stands_in
from .pairs import added, divided, multiplied, normal, subtracted, summed
from .recursion import accelerate_rods
from .stepper import increments
from .taylor import convolved, expand, factor

__all__ = ["pair_accelerations", "pair_increments", "pair_series"]

HALF_4 = float.fromhex("0x1.129024e088a68p-123")  # pi/2 = HALF_1 + ... + HALF_4 + O(1e-53)
# 15! sin(x)/x and 16! cos(x) as polynomials in x**2 have whole coefficients, up to these powers; then floats will do
SINE = tuple(float((-1) ** k * (factorial(15) // factorial(2 * k + 1))) for k in range(7, 0, -1))
COSINE = tuple(float((-1) ** k * (factorial(16) // factorial(2 * k))) for k in range(8, 0, -1))
SIN_UNIT, COS_UNIT = float(factorial(15)), float(factorial(16))
SINE_TAIL = tuple((-1) ** k * factorial(15) / factorial(2 * k + 1) for k in range(13, 7, -1))
COSINE_TAIL = tuple((-1) ** k * factorial(16) / factorial(2 * k) for k in range(14, 8, -1))

INLINE = {"forceinline": True, "fastmath": False, "error_model": "numpy"}


class PairType(types.Type):
    """The type of ``h + l``."""

    def __init__(self) -> None:
        super().__init__("Pair")


PAIR = PairType()
PLAIN = types.Integer, types.Float


@register_model(PairType)
class PairModel(models.StructModel):
    """Two float64, as a complex128 has them."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, [("h", types.float64), ("l", types.float64)])


make_attribute_wrapper(PairType, "h", "h")
make_attribute_wrapper(PairType, "l", "l")


@intrinsic
def pair(typing: Any, h: Any, l: Any) -> Any:
    """The pair of two floats."""
    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        made = cgutils.create_struct_proxy(PAIR)(context, builder)
        made.h, made.l = arguments
        return made._getvalue()
    return PAIR(types.float64, types.float64), build


@intrinsic
def pairs(typing: Any, array: Any) -> Any:
    """An array of complex128 as one of pairs, in the same memory."""
    kind = types.Array(PAIR, array.ndim, array.layout)

    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = context.make_array(array)(context, builder, arguments[0])
        made = context.make_array(kind)(context, builder)
        for field in ("meminfo", "parent", "nitems", "itemsize", "shape", "strides"):
            setattr(made, field, getattr(given, field))
        made.data = builder.bitcast(given.data, made.data.type)
        context.nrt.incref(builder, kind, made._getvalue())
        return made._getvalue()
    return kind(array), build


@intrinsic
def fused(typing: Any, a: Any, b: Any, c: Any) -> Any:
    """``a b + c``, rounded once."""
    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)
    return types.float64(types.float64, types.float64, types.float64), build


@stands_in(product)
@inlined
def fused_product(a: Any, b: Any) -> Any:
    """:func:`lagrangian.angles.product`."""
    p = a * b
    return p, fused(a, b, -p)


@stands_in(convolved)
@inlined
def pair_convolved(C: Any, S: Any, w: Any, Bu: Any, Bn: Any, count: Any, none: Any) -> Any:
    """:func:`lagrangian.taylor.convolved`, with the sums of :func:`lagrangian.pairs.summed`."""
    Xh = Yh = Zh = Xl = Yl = Zl = 0.0
    for i in range(count):
        c, s, v, u, n = C[i], S[i], w[i], Bu[i], Bn[i]
        Xh, Xl = summed(Xh, Xl, c.h, c.l, v.h, v.l)
        Yh, Yl = summed(Yh, Yl, s.h, s.l, v.h, v.l)
        Zh, Zl = summed(Zh, Zl, c.h, c.l, n.h, n.l)
        Zh, Zl = summed(Zh, Zl, -s.h, -s.l, u.h, u.l)
    Xh, Xl = normal(Xh, Xl)
    Yh, Yl = normal(Yh, Yl)
    Zh, Zl = normal(Zh, Zl)
    return pair(Xh, Xl), pair(Yh, Yl), pair(Zh, Zl)


def halves(x: Any) -> Any:
    """The two floats of a pair or a number; known to translated code only."""


@overload(halves, jit_options=INLINE)
def _halves(x: Any) -> Any:
    def of_pair(x: Any) -> Any:
        return x.h, x.l

    def of_number(x: Any) -> Any:
        return float(x), 0.0
    return of_pair if x is PAIR else of_number if isinstance(x, PLAIN) else None


@overload(operator.neg, jit_options=INLINE)
def _negative(x: Any) -> Any:
    def negative(x: Any) -> Any:
        return pair(-x.h, -x.l)
    return negative if x is PAIR else None


def _overload(sign: Callable[..., Any], function: Callable[..., Any]) -> None:
    operation = as_written(function)

    @overload(sign, jit_options=INLINE)
    def chosen(x: Any, y: Any) -> Any:
        if PAIR not in (x, y) or not all(z is PAIR or isinstance(z, PLAIN) for z in (x, y)):
            return None

        def computed(x: Any, y: Any) -> Any:
            xh, xl = halves(x)
            yh, yl = halves(y)
            h, l = operation(xh, xl, yh, yl)
            return pair(h, l)
        return computed


OPERATIONS = added, subtracted, multiplied, divided
for _sign, _operation in zip((operator.add, operator.sub, operator.mul, operator.truediv), OPERATIONS, strict=True):
    _overload(_sign, _operation)


def _series(rods: Any, s: Any, c: Any, damping: Any, springs: Any, delta: Any, omega: Any, ax: Any, ay: Any, order: Any,
            factors: Any, held: Any, series: Any) -> None:
    """:func:`lagrangian.taylor.factor` and :func:`~lagrangian.taylor.expand` on arrays of complex128."""
    one, f = pair(1.0, 0.0), pairs(factors)
    factor(pairs(rods), pairs(s), pairs(c), one, f)
    expand(f, None if damping is None else pairs(damping), None if springs is None else pairs(springs), pairs(delta),
           pairs(omega), pairs(ax), pairs(ay), order, one, pairs(held), pairs(series))


def _increments(series: Any, order: Any, h: Any, l: Any, out: Any) -> None:
    """Write how far angles and rates move in the time ``h + l`` to ``out``, shape (2, n)."""
    x, y = pairs(series), pairs(out)
    for k in range(x.shape[0]):
        y[0, k], y[1, k] = increments(x, k, order, pair(h, l))


def pair_sines(d: Any, e: Any) -> tuple[Any, Any]:
    """``sin(d + e), cos(d + e)`` to 31 digits, d and e as for :func:`lagrangian.angles.sines`.

    Beyond degree 16 the terms are below 1e-14, and float64 has their digits.
    """
    n = (d * PER_HALF + ROUND) - ROUND
    r = pair(d, e) - n * HALF_1 - n * HALF_2 - pair(HALF_3, HALF_4) * n
    z = r * r
    a, b = 0.0, 0.0
    for x in SINE_TAIL:
        a = a * z.h + x
    for x in COSINE_TAIL:
        b = b * z.h + x
    p, q = z * a, z * b
    for x in SINE:
        p = (p + x) * z
    for x in COSINE:
        q = (q + x) * z
    s, c = r + r * (p / SIN_UNIT), q / COS_UNIT + 1.0
    quarter = n - 4.0 * ((0.25 * n + ROUND) - ROUND)  # n mod 4, between -2 and 2
    if quarter == 1.0 or quarter == -1.0:
        s, c = c, -s
    if quarter == 2.0 or quarter == -2.0 or quarter == -1.0:
        s, c = -s, -c
    return s, c


def _accelerations(rods: Any, damping: Any, springs: Any, theta: Any, omega: Any, ax: Any, ay: Any, out: Any) -> None:
    """:func:`lagrangian.recursion.accelerate_rods` on pairs for float64 states, shape (n, chains), as is out.

    Rods (n, 8, chains), damping and springs (n, chains) or None.
    """
    n = theta.shape[0]
    pull = pairs(np.array([ax, ay]))
    space = pairs(np.zeros((9, n), np.complex128))
    s, c, z, tau, found = space[0], space[1], space[2], space[3], space[4]
    work = pairs(np.zeros((n, 4), np.complex128))
    for j in range(theta.shape[1]):
        constants = pairs(rods[:, :, j])
        moment = pair(0.0, 0.0)
        for i in range(n):
            k = n - 1 - i
            before, rate = (theta[k - 1, j], omega[k - 1, j]) if k > 0 else (0.0, 0.0)
            d, e = difference(theta[k, j], before)
            s[k], c[k] = pair_sines(d, e)
            z[k] = pair(omega[k, j], 0.0) * omega[k, j]
            tau[k] = moment
            if damping is not None or springs is not None:
                moment = pair(0.0, 0.0)
                if damping is not None:
                    moment = moment + pairs(damping)[k, j] * (pair(omega[k, j], 0.0) - rate)
                if springs is not None:
                    moment = moment + pairs(springs)[k, j] * pair(d, e)
                tau[k] = tau[k] - moment
        if damping is not None or springs is not None:
            accelerate_rods(constants, z, tau, s, c, pull[0], pull[1], work, None, found)
        else:
            accelerate_rods(constants, z, None, s, c, pull[0], pull[1], work, None, found)
        for k in range(n):
            out[k, j] = found[k].h


pair_accelerations = as_written(_accelerations, OPERATIONS)
pair_series = as_written(_series, OPERATIONS)
pair_increments = as_written(_increments, OPERATIONS)
