"""The number types that the recursions run on beside float64: mpmath numbers and python-flint balls.

An ``Arithmetic`` knows how to bring an exact SymPy number into its type and how to take sine and cosine;
everything else is ``+ - * /``.  Nothing here touches a global precision: mpmath numbers carry their context,
and balls are computed at the precision that is current where the caller computes.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import flint
import numpy as np
from sympy import Integer, N, Rational

from .quantities import AnyMpf, real_number

__all__ = ["Arithmetic", "Balls", "MPNumbers", "arithmetic_of"]


class Arithmetic:
    """What differs between number types."""

    def number(self, exact: Any) -> Any:
        """An exact SymPy number, rounded once (or enclosed)."""
        raise NotImplementedError

    def sines(self, x: Any) -> tuple[Any, Any]:
        """``sin x, cos x``."""
        raise NotImplementedError

    def answers(self, x: Any) -> bool:
        """Whether ``x`` says anything: it is finite."""
        raise NotImplementedError

    def midpoint(self, x: Any) -> Any:
        """``x`` without its radius, where it has one."""
        return x

    def array(self, numbers: Iterable[Any]) -> Any:
        """Exact numbers, or numbers of any accepted kind, as an array of this type; shape (n,)."""
        found = list(numbers)
        out = np.empty(len(found), dtype=object)
        for i, x in enumerate(found):
            out[i] = self.coerced(x)
        return out

    def zeros(self, *shape: int) -> Any:
        """An array of zeros of this type."""
        out = np.empty(shape, dtype=object)
        out.fill(self.number(Integer(0)))
        return out

    def coerced(self, x: Any) -> Any:
        """A number of any accepted kind in this type; raises as :func:`lagrangian.quantities.quantity`."""
        raise NotImplementedError


@dataclass(frozen=True)
class MPNumbers(Arithmetic):
    """mpmath numbers of one context, whose precision they keep."""

    context: Any

    def number(self, exact: Any) -> Any:
        if isinstance(exact, Rational):
            return self.context.mpf(int(exact.p)) / int(exact.q)
        return +self.context.make_mpf(N(exact, self.context.dps + 10)._mpf_)

    def sines(self, x: Any) -> tuple[Any, Any]:
        cosine, sine = self.context.cos_sin(x)
        return sine, cosine

    def answers(self, x: Any) -> bool:
        return bool(self.context.isfinite(x))

    def coerced(self, x: Any) -> Any:
        if isinstance(x, (float, AnyMpf)):
            return self.context.convert(x)
        return self.number(real_number(x, "a number among mpmath's"))


@dataclass(frozen=True)
class Balls(Arithmetic):
    """python-flint balls at the current precision: every result contains the true one."""

    def number(self, exact: Any) -> Any:
        if isinstance(exact, Rational):
            return flint.arb(flint.fmpq(int(exact.p), int(exact.q)))
        digits = int(flint.ctx.prec * 0.302) + 10
        middle = N(exact, digits + 5)
        ratio = flint.arb(_dyadic(middle._mpf_))
        return ratio + flint.arb(0, 1) * ratio * flint.arb(10) ** -digits

    def sines(self, x: Any) -> tuple[Any, Any]:
        sine, cosine = x.sin_cos()
        return sine, cosine

    def answers(self, x: Any) -> bool:
        return bool(x.is_finite())

    def midpoint(self, x: Any) -> Any:
        return x.mid()

    def coerced(self, x: Any) -> Any:
        if isinstance(x, (flint.arb, flint.fmpq, flint.fmpz)):
            return flint.arb(x)
        return self.number(real_number(x, "a number among balls"))


def _dyadic(parts: Any) -> Any:
    sign, mantissa, exponent, _ = parts
    value = flint.arb(int(mantissa)) * flint.arb(2) ** int(exponent)
    return -value if sign else value


def arithmetic_of(*arrays: Any) -> Arithmetic | None:
    """The arithmetic of the numbers given: balls if there is one, else mpmath numbers if there is one, else None."""
    kinds: dict[type, Any] = {}
    for array in arrays:
        _note_types(array, kinds)
    if flint.arb in kinds:
        return Balls()
    contexts = [x.context for x in kinds.values() if isinstance(x, AnyMpf)]
    return MPNumbers(contexts[0]) if contexts else None


def _note_types(values: Any, kinds: dict[type, Any]) -> None:
    """A number of every type in an array of objects, in lists of lists or arrays, or alone."""
    if isinstance(values, np.ndarray):
        values = values.ravel().tolist() if values.dtype == object else ()
    elif not isinstance(values, (list, tuple)):
        values = (values,)
    for x in values:
        if isinstance(x, (list, tuple, np.ndarray)):
            _note_types(x, kinds)
        else:
            kinds[type(x)] = x
