r"""Polynomials in twice the precision of float64, with a bound that is proved.

A number ``v`` is carried as a pair ``r + e``: ``r`` is what float64 alone would
give and ``e`` the sum, in float64, of all the rounding errors made on the way.  With
``u = 2**-53`` and ``fl`` the rounded result, sums and products have errors that
are floats themselves, found without branches (Knuth; Dekker and Veltkamp):

    s = fl(x + y),   z = fl(s - x),   x + y - s = fl(fl(x - fl(s - z)) + fl(y - z))
    p = fl(x y),     x y - p = ((x1 y1 - p) + x1 y2 + x2 y1) + x2 y2

where ``x = x1 + x2`` is cut in two halves of 26 bits whose products are exact.
The steps of :mod:`fastpicard.horner` become, for a float x and a pair (x, x'),

    constant c     r = fl(c),  e = fl(c - r)
    times x        r -> p = fl(r x),   e -> fl(fl(e x) + (r x - p))
    times (x, x')  r -> p = fl(r x),   e -> fl(fl(e x) + fl(fl(r x') + (r x - p)))
    sum            r -> s = fl(r1 + r2),   e -> fl(fl(e1 + e2) + (r1 + r2 - s))

**Bound.**  Let ``t`` run over the monomials, ``|t|`` be absolute values, and ``k`` count for every
monomial 2 for its coefficient, 1 for every sum and every float it meets, 3 for
every pair.  Then, without over- and underflow,

    (A)  |r|         <=      sum (1 + u)**k |t|
    (B)  |e|         <=  u   sum k (1 + u)**(3k) |t|
    (C)  |r + e - v| <=  u*u sum k**2 (1 + u)**(3k) |t|

*Proof* by induction over the steps; all three are linear in ``|t|``.  A constant
from a ball has ``|r - c| <= u (1 + u) |c|`` and ``|r + e - c| <= 2 u*u |c|``: k = 2 will do.
A product with x: the error ``d = r x - p`` has ``|d| <= u |r x|``, so (A) gains one factor
1 + u and (B) one ``u (1 + u)**k |t x|``.  Two roundings of ``e x`` and one of ``d`` add to
(C) at most ``(2u + u*u) |e x| + u |d| <= u*u (2k + 1) (1 + u)**(3k + 2) |t x|``, and
``k**2 + 2k + 1 = (k + 1)**2``.  A sum is the same with ``d = r1 + r2 - s``, since both
numbers enter with their own monomials.  A pair with ``|x'| <= u (1 + u) |x|`` that is within
``3 u*u |x|`` of its variable adds to (C) what is rounded of ``r x'``, 3, what is
dropped, ``|e x'|``, k, and its own error, 3: together ``2k + 1 + k + 6 <= 6k + 9``,
the difference of ``(k + 3)**2`` and ``k**2``.

With ``W = sum k |t|`` and K the largest k, float64 alone is therefore right to
``u W`` and the pair to ``u*u K W``, both times ``(1 + u)**(5k) < 1 + 2**-20`` where ``K < 2**20``.
W is computed in float64 by the same steps from ``k |c|`` and ``|x|``; all terms are
positive, so it is right to the same factor.  For Mathieu's trace at n = 50, K is
about 100: the pair loses nothing visible until the terms exceed their sum by 1e13.

**Range.**  An underflow leaves at most ``2**-1075``, in a product of halves together
``5 * 2**-1074`` (Ogita, Rump and Oishi, *Accurate sum and dot product*, 2005), and a
coefficient below the range ``2**-1075``; what follows multiplies it by no more than ``X**D``
with ``X >= 1, |x|`` for all variables and D the degree.  So ``2**-1069 X**D`` for every step
covers underflow.  Nothing overflows while ``sum k |c| X**|m| <= 2**900``.  The
variables are scaled by powers of 2, exactly, to make room; what is still
outside is not computed here but in balls.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from fastpicard.evaluate import numpy
from fastpicard.horner import ADD, PLUS, PUSH, TIMES, Program, run, weights

Array = Any
UNIT = 2.0**-53
SLACK = 1 + 2.0**-18  # for (1 + u)**(5k), and for the few roundings of the bounds themselves
ROOM = 900  # binary orders of magnitude that no number on the way exceeds
NEAR_ZERO = 2.0**-400  # variables below are left to the balls, so that pairs and their reciprocals have no underflow
LARGEST = 400  # the same from above, as a power of 2
MOST = 1 << 20  # roundings
SPLITTER = 2.0**27 + 1


# -- errors that are floats ----------------------------------------------------


def split(x: Array) -> tuple[Array, Array]:
    """``x = x1 + x2``, each of 26 bits (Veltkamp)."""
    big = x * SPLITTER
    high = big - (big - x)
    return high, x - high


def product(x: Array, y: Array) -> tuple[Array, Array]:
    """``fl(x y)`` and its error (Dekker)."""
    p = x * y
    (x1, x2), (y1, y2) = split(x), split(y)
    return p, (((x1 * y1 - p) + x1 * y2) + x2 * y1) + x2 * y2


def square(x: Array) -> tuple[Array, Array]:
    """``x**2`` as a pair, exactly."""
    p, d = product(x, x)
    return unless_underflow(p, x), d


def unless_underflow(result: Array, source: Array) -> Array:
    """nan where the result is 0 and what it was made of is not."""
    np = numpy()
    return np.where((result == 0) & (source != 0), np.nan, result)


def reciprocal(x: Array) -> tuple[Array, Array]:
    """``1/x`` as a pair: ``1 - x y`` is found with one rounding, so the pair is right to ``3 u*u``."""
    y = 1 / x
    p, d = product(x, y)
    return y, ((1 - p) - d) / x


@dataclass(frozen=True)
class Variable:
    """The values of a variable: floats ``x``, and what is to be added to them, if anything."""

    x: Array
    rest: Array | None

    def scaled(self, exponent: int) -> Variable:
        """Times ``2**exponent``."""
        ldexp = numpy().ldexp
        x = unless_underflow(ldexp(self.x, exponent), self.x)
        return Variable(x, None if self.rest is None else ldexp(self.rest, exponent))

    def inside(self, limit: int) -> Array:
        """Where the values are 0 or neither too large nor too small."""
        size = abs(self.x)
        return (size == 0) | (size >= NEAR_ZERO) & (size <= math.ldexp(1.0, limit))

    def at(self, places: Array) -> Variable:
        """The values at some of the places."""
        return Variable(self.x[places], None if self.rest is None else self.rest[places])


# -- polynomials ---------------------------------------------------------------


class Polynomial:
    """``sum c_m x**m`` for arrays of x, in float64 and in pairs, with the proved bounds.

    Parameters
    ----------
    steps : the program, with coefficients in its order
    coefficients : pairs of floats (r, e)
    degrees : the degree of every monomial
    pairs : for every variable, whether it is a pair
    """

    def __init__(self, steps: Program, coefficients: Sequence[tuple[float, float]], degrees: Sequence[int],
                 pairs: Sequence[bool]) -> None:
        self.steps, self.coefficients = steps, coefficients
        counts = weights(steps, 2, [3 if pair else 1 for pair in pairs])
        self.weighted = [k * abs(r) for k, (r, _) in zip(counts, coefficients, strict=True)]
        self.most, self.degrees = max(counts, default=0), degrees

    def limit(self) -> int:
        """The largest ``j <= LARGEST`` such that no number exceeds ``2**ROOM`` where ``|x| <= 2**j``; -1 if none."""
        if self.most >= MOST or not all(map(math.isfinite, self.weighted)):
            return -1
        spare = ROOM - len(self.degrees).bit_length()
        room = [(d, spare - math.frexp(w)[1]) for d, w in zip(self.degrees, self.weighted, strict=True) if w]
        if any(space < 0 for _, space in room):
            return -1
        bounds = [min(space, ROOM) // d for d, space in room if d] + [ROOM // d for d in self.degrees if d]
        return min([LARGEST, *bounds])

    def underflow(self, largest: float) -> float:
        """What underflow may have cost where ``|x| <= largest``."""
        return len(self.steps) * math.ldexp(max(largest, 1.0) ** max(self.degrees, default=0), -1069)

    def floats(self, variables: Sequence[Variable], size: int) -> Array:
        """The value in float64, right to ``u W`` and the underflow."""
        return self._filled(run(self.steps, [r for r, _ in self.coefficients], [v.x for v in variables]), size)

    def sizes(self, variables: Sequence[Variable], size: int) -> Array:
        """W."""
        return self._filled(run(self.steps, self.weighted, [abs(v.x) for v in variables]), size)

    def _filled(self, value: Any, size: int) -> Array:
        return value if hasattr(value, "shape") else numpy().full(size, float(value))

    def pairs(self, variables: Sequence[Variable], size: int) -> tuple[Array, Array]:
        """The value as a pair ``r, e``, right to ``u*u K W`` and the underflow."""
        machine = _Machine(variables, size)
        for kind, i in self.steps:
            if kind == PUSH:
                machine.push(*self.coefficients[i])
            elif kind == PLUS:
                machine.plus(*self.coefficients[i])
            elif kind == TIMES:
                machine.times(i)
            elif kind == ADD:
                machine.add()
        return machine.result()


class _Machine:
    """A stack of pairs of arrays.  All work is done in place: the arrays of one block stay in the cache."""

    def __init__(self, variables: Sequence[Variable], size: int) -> None:
        self.np, self.size = numpy(), size
        self.variables = [(v.x, *split(v.x), v.rest) for v in variables]
        self.stack: list[tuple[Array, Array]] = []
        self.free: list[Array] = []

    def _new(self) -> Array:
        return self.free.pop() if self.free else self.np.empty(self.size)

    def push(self, c: float, rest: float) -> None:
        r, e = self._new(), self._new()
        r.fill(c)
        e.fill(rest)
        self.stack.append((r, e))

    def plus(self, c: Any, rest: Any) -> None:
        """The top plus a pair: 8 operations."""
        np, (r, e), s, z = self.np, self.stack.pop(), self._new(), self._new()
        np.add(r, c, out=s)
        np.subtract(s, r, out=z)
        np.add(e, rest, out=e)
        t = self._new()
        np.subtract(s, z, out=t)
        np.subtract(r, t, out=t)
        np.subtract(c, z, out=z)
        np.add(t, z, out=t)
        np.add(e, t, out=e)
        self.free += [r, z, t]
        self.stack.append((s, e))

    def add(self) -> None:
        r, e = self.stack.pop()
        self.plus(r, e)
        self.free += [r, e]

    def times(self, variable: int) -> None:
        """The top times a variable: 15 operations, 17 for a pair."""
        np, (r, e), (x, x1, x2, rest) = self.np, self.stack.pop(), self.variables[variable]
        p, d, r1, r2 = self._new(), self._new(), self._new(), self._new()
        np.multiply(r, SPLITTER, out=r1)
        np.subtract(r1, r, out=r2)
        np.subtract(r1, r2, out=r1)
        np.subtract(r, r1, out=r2)
        np.multiply(r, x, out=p)
        np.multiply(r1, x1, out=d)
        np.subtract(d, p, out=d)
        np.multiply(r1, x2, out=r1)
        np.add(d, r1, out=d)
        np.multiply(r2, x1, out=r1)
        np.add(d, r1, out=d)
        np.multiply(r2, x2, out=r2)
        np.add(d, r2, out=d)
        np.multiply(e, x, out=e)
        if rest is not None:
            np.multiply(r, rest, out=r1)
            np.add(d, r1, out=d)
        np.add(e, d, out=e)
        self.free += [r, d, r1, r2]
        self.stack.append((p, e))

    def result(self) -> tuple[Array, Array]:
        if not self.stack:
            self.push(0.0, 0.0)
        return self.stack[0]
