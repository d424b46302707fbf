r"""Finite sums of waves, ``c cos(q w t) + s sin(q w t)`` over some ``q >= 0``, kept as ``{q: (c, s)}``.

The unit of frequency ``w`` is 1 or a Symbol, every ``q`` a real number.  Products of waves are beats,
``2 cos x cos y = cos(x + y) + cos(x - y)``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import reduce
from typing import Any

from sympy import Add, Integer, Mul, Pow, cos, expand, sin

__all__ = ["NoWave", "Waves", "waves_of"]

Waves = dict[Any, tuple[Any, Any]]


class NoWave(Exception):
    """The part of an expression, its argument, that is no sum of waves."""


def waves_of(expression: Any, t: Any, unit: Any = 1) -> Waves:
    """``expression`` in the Symbol t as a sum of waves, ``unit`` the unit of frequency.  Raises NoWave."""
    if t not in expression.free_symbols:
        return {Integer(0): (expression, Integer(0))}
    if isinstance(expression, Add):
        return _sum(waves_of(term, t, unit) for term in expression.args)
    if isinstance(expression, Mul):
        return reduce(_product, (waves_of(factor, t, unit) for factor in expression.args))
    if isinstance(expression, Pow) and expression.base != t and expression.exp.is_Integer and expression.exp > 0:
        return reduce(_product, [waves_of(expression.base, t, unit)] * int(expression.exp))
    if isinstance(expression, (cos, sin)):
        return _wave(expression, t, unit)
    raise NoWave(expression)


def _wave(wave: Any, t: Any, unit: Any) -> Waves:
    """``cos`` or ``sin`` of ``q unit t + phase``."""
    angle = expand(wave.args[0])
    rate = angle.coeff(t, 1)
    q, phase = expand(rate / unit), expand(angle - rate * t)
    if not (q.is_number and q.is_real) or t in phase.free_symbols:
        raise NoWave(wave)
    side = 1 if q > 0 else -1
    if isinstance(wave, cos):
        return {abs(q): (cos(phase), -side * sin(phase))}
    return {abs(q): (sin(phase), side * cos(phase))}


def _sum(parts: Iterable[Waves]) -> Waves:
    total: Waves = {}
    for part in parts:
        for q, (c, s) in part.items():
            c0, s0 = total.get(q, (Integer(0), Integer(0)))
            total[q] = (c0 + c, s0 + s)
    return total


def _product(left: Waves, right: Waves) -> Waves:
    """``2 (c cos p + s sin p)(C cos q + S sin q) = (cC - sS) cos(p+q) + (sC + cS) sin(p+q) + ...(p-q)``.

    Coefficients are expanded, or those of a power would double in size with every factor.
    """
    def beats() -> Iterator[Waves]:
        for p, (c, s) in left.items():
            for q, (C, S) in right.items():
                yield {p + q: ((c * C - s * S) / 2, (s * C + c * S) / 2)}
                side = 1 if p >= q else -1
                yield {abs(p - q): ((c * C + s * S) / 2, side * (s * C - c * S) / 2)}
    return {q: (expand(c), expand(s)) for q, (c, s) in _sum(beats()).items()}
