r"""Taylor models on many rectangles at once: polynomials of two variables with a proved error.

On a rectangle with its centre at the origin and half its sides as units a model is

    f(s, t) = sum over k + l <= d of c_kl s**k t**l + r(s, t),    |s|, |t| <= 1,    |r| <= e,

and ``|f| <= sum |c_kl| + e``: where ``|c_00|`` exceeds the rest the sign of f is known on the whole rectangle.
Arithmetic is float64 on arrays, one entry a rectangle, and every operation adds to e what it may have lost:

- what a product has beyond degree d, at most ``sum over p + q > d of F_p G_q``, ``F_p = sum over k + l = p of |c_kl|``;
- rounding.  ``n`` operations on numbers whose absolute values sum to S lose at most ``n u S (1 + n u)``, u = 2**-53
  (the standard model; no underflow matters, ``2**-1000`` is added once).  Bounds themselves are sums of positive
  numbers, right to ``n u`` of themselves, and are multiplied by ``1 + 2**-40``.

Halving a rectangle is ``s = (s' -+ 1)/2``: multiplications by powers of 2 are exact, and only the additions round.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from flint import arb

from fastpicard.evaluate import numpy
from fastpicard.precision import working

Array = Any
UNIT = 2.0**-53
SLACK = 1 + 2.0**-40
TINY = 2.0**-1000


@cache
def exponents(degree: int) -> tuple[tuple[int, int], ...]:
    """The exponents ``(k, l)`` by total degree: those of a lower degree stand in front."""
    return tuple((p - l, l) for p in range(degree + 1) for l in range(p + 1))


@cache
def _places(degree: int) -> dict[tuple[int, int], int]:
    return {kl: place for place, kl in enumerate(exponents(degree))}


def size(degree: int) -> int:
    """How many coefficients there are."""
    return (degree + 1) * (degree + 2) // 2


class Models:
    """Taylor models of one degree on an array of rectangles.

    Attributes
    ----------
    degree : int
    c : array, shape (size(degree), ...)     coefficients, in the order of :func:`exponents`
    e : array, shape (...)                   the proved error
    """

    __slots__ = ("c", "degree", "e")

    def __init__(self, degree: int, c: Array, e: Array) -> None:
        self.degree, self.c, self.e = degree, c, e

    def norm(self) -> Array:
        """``sum |c_kl|``, rounded up."""
        return abs(self.c).sum(axis=0) * SLACK

    def __add__(self, other: Any) -> Models:
        if not isinstance(other, Models):
            c = self.c.copy()
            c[0] += other
            return Models(self.degree, c, (self.e + UNIT * abs(c[0])) * SLACK + TINY)
        c = self.c + other.c
        return Models(self.degree, c, (self.e + other.e + UNIT * abs(c).sum(axis=0)) * SLACK + TINY)

    def __sub__(self, other: Models) -> Models:
        return self + other * -1

    def __mul__(self, other: Any) -> Models:
        if not isinstance(other, Models):
            c = self.c * other
            return Models(self.degree, c, (self.e * abs(other) + UNIT * abs(c).sum(axis=0)) * SLACK + TINY)
        np, d = numpy(), self.degree
        c = np.zeros(np.broadcast_shapes(self.c.shape, other.c.shape))
        places = _places(d)
        terms = exponents(d)
        for i, (k, l) in enumerate(terms):
            for j in range(size(d - k - l)):
                p, q = terms[j]
                c[places[k + p, l + q]] += self.c[i] * other.c[j]
        f, g = self._by_degree(), other._by_degree()
        beyond = sum((f[p] * g[q] for p in range(d + 1) for q in range(d + 1 - p, d + 1)), np.zeros(c.shape[1:]))
        f_norm, g_norm = sum(f), sum(g)
        e = (beyond + f_norm * other.e + self.e * (g_norm + other.e) + 2 * len(terms) * UNIT * f_norm * g_norm)
        return Models(d, c, e * SLACK + TINY)

    def _by_degree(self) -> list[Array]:
        absolute = abs(self.c)
        return [absolute[size(p) - p - 1:size(p)].sum(axis=0) for p in range(self.degree + 1)]

    def signs(self) -> Array:
        """1 or -1 where the function is proved to be positive or negative on the whole rectangle, else 0."""
        np = numpy()
        rest = (abs(self.c[1:]).sum(axis=0) + self.e) * SLACK + TINY
        return np.where(abs(self.c[0]) > rest, np.sign(self.c[0]), 0.0).astype(np.int8)

    def truncated(self, degree: int) -> Models:
        """The same of a lower degree: what is dropped is added to the error."""
        keep = size(degree)
        return Models(degree, self.c[:keep].copy(), (self.e + abs(self.c[keep:]).sum(axis=0)) * SLACK)

    def at(self, places: Array) -> Models:
        """The models of some of the rectangles: places along the last axis."""
        return Models(self.degree, self.c[..., places], self.e[..., places])

    def halved(self, along_y: bool, upper: bool) -> Models:
        """On the lower or upper half along an axis."""
        c = self.c.copy()
        places, d, sign = _places(self.degree), self.degree, 1.0 if upper else -1.0
        before = abs(c).sum(axis=0)
        for other in range(d + 1):
            line = [places[(other, k) if along_y else (k, other)] for k in range(d - other + 1)]
            for k in range(1, len(line)):
                c[line[k]] *= 0.5**k
            # sum c_k (s' + sign)**k, by repeated synthetic division
            for start in range(len(line) - 1):
                for k in range(len(line) - 2, start - 1, -1):
                    c[line[k]] += sign * c[line[k + 1]]
        return Models(d, c, (self.e + (d + 1) * UNIT * before) * SLACK + TINY)


def exponential(f: Models) -> Models:
    """``exp f``: of the value at the centre in balls, of the rest ``g`` by its series."""
    np = numpy()
    center, rest = f.c[0], f.c.copy()
    rest[0] = 0.0
    g = Models(f.degree, rest, f.e)
    size = g.norm() + g.e
    with np.errstate(all="ignore"):  # where it is beyond floats the error is infinite, and nothing is known
        last, beyond = 0, np.exp(size) * size
        while last < 3 * f.degree and (beyond > UNIT).any():
            last += 1
            beyond = beyond * size / (last + 1)
        total = Models(f.degree, np.zeros_like(rest), np.zeros_like(f.e)) + 1.0
        for k in range(last, 0, -1):
            total = g * total * (1.0 / k) + 1.0
            total.e = total.e + 2 * UNIT * total.norm()  # 1/k is rounded
        with working(64):
            factor = np.array([float(arb(x).exp()) for x in center.tolist()])
        result: Models = Models(f.degree, total.c, (total.e + 2 * beyond) * SLACK) * factor
        result.e = np.nan_to_num((result.e + 4 * UNIT * result.norm()) * SLACK + TINY, nan=np.inf)
        return result


def stacked(models: list[Models]) -> Models:
    """Several functions on the same rectangles as one array: shape (size, functions, rectangles)."""
    np = numpy()
    return Models(models[0].degree, np.stack([m.c for m in models], axis=1), np.stack([m.e for m in models]))


def joined(parts: list[Models]) -> Models:
    """Models on several sets of rectangles, one after the other."""
    np = numpy()
    return Models(parts[0].degree, np.concatenate([m.c for m in parts], axis=-1),
                  np.concatenate([m.e for m in parts], axis=-1))
