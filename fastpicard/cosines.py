r"""Cosines of rational multiples of pi in normal form: equal numbers have equal forms.

Sums of ``cos(pi x)``, ``x`` rational, are a ring by product to sum, and hold the
sines, ``sin(pi x) = cos(pi (1/2 - x))``, and the square roots of primes: with
Legendre's symbol ``(a|p)`` and the sums over ``a = 1 .. p - 1``, Gauss found

    sqrt(p) = sum (a|p) cos(2 pi a / p)   if p = 1 mod 4,
    sqrt(p) = sum (a|p) sin(2 pi a / p)   if p = 3 mod 4,         sqrt(2) = 2 cos(pi/4).

They obey one family of relations, for every prime ``p``: the sum of ``cos(pi (x + 2 j / p))``
over ``j = 0 .. p - 1`` is 0.  The normal form is a basis over ``Q``, in three steps.

1.  ``x`` is split into parts whose denominators are powers of one prime, and the
    cosine of their sum is multiplied out.  The real subfields of ``Q(exp(i pi / 2 p**e))``
    for different ``p`` are linearly disjoint (what two such cyclotomic fields share is
    ``Q(i)``), so products of basis elements, one for each prime, are a basis.
2.  For one odd prime, the relation expresses the cosine of the largest angle by the others.
3.  ``sqrt(p)`` itself takes the place of the largest angle that Gauss's sum contains.

For ``p = 2``, folding the angle into the first quadrant is enough; ``sqrt(2) / 2`` is ``cos(pi/4)``.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import Any

import sympy
from flint import fmpq

Cosines = dict[Fraction, Any]  # x -> c for the sum of c cos(pi x), x in [0, 1/2)
Basis = dict[tuple[Any, ...], Any]  # product of sqrt(p), written p, and of cos(pi x), written x -> fmpq

HALF = Fraction(1, 2)


def folded(x: Fraction) -> tuple[int, Fraction]:
    """``cos(pi x) = sign * cos(pi y)`` with ``y`` from 0 to 1/2."""
    x = abs((x + 1) % 2 - 1)
    return (1, x) if x <= HALF else (-1, 1 - x)


def _add(target: dict[Any, Any], key: Any, value: Any) -> None:
    total = target.get(key, 0) + value
    if total:
        target[key] = total
    else:
        target.pop(key, None)


def _add_cosine(target: Cosines, x: Fraction, value: Any) -> None:
    sign, y = folded(x)
    if y != HALF:
        _add(target, y, sign * value)


def product(left: Cosines, right: Cosines) -> Cosines:
    """Product to sum."""
    result: Cosines = {}
    for x, c in left.items():
        for y, d in right.items():
            _add_cosine(result, x + y, c * d / 2)
            _add_cosine(result, x - y, c * d / 2)
    return result


def power(x: Fraction, exponent: int) -> Cosines:
    """``cos(pi x)**exponent``, negative exponents too."""
    factor = {x: fmpq(1)} if exponent >= 0 else _reciprocal(x)
    result = {Fraction(0): fmpq(1)}
    for _ in range(abs(exponent)):
        result = product(result, factor)
    return result


def _reciprocal(x: Fraction) -> Cosines:
    """``1 / (2 cos) = exp(i pi x) / (1 - u)``, ``u = -exp(2 i pi x)`` of order m: ``1 / (1 - u) = -sum j u**j / m``."""
    turn = 2 * x + 1
    order = (turn / 2).denominator
    result: Cosines = {}
    for j in range(order):
        _add_cosine(result, x + j * turn, fmpq(-2 * j, order))
    return result


def root(p: int) -> Cosines:
    """``sqrt(p)`` of a prime as Gauss's sum."""
    if p == 2:
        return {Fraction(1, 4): fmpq(2)}
    result: Cosines = {}
    quarter = HALF if p % 4 == 3 else Fraction(0)
    for a in range(1, p):
        symbol = 1 if pow(a, p // 2, p) == 1 else -1
        _add_cosine(result, quarter - Fraction(2 * a, p), fmpq(symbol))
    return result


# -- the normal form -----------------------------------------------------------


def normal(cosines: Cosines) -> Basis:
    """A sum of cosines in the basis."""
    result: Basis = {}
    for x, c in cosines.items():
        for parts, value in _cosine(x).items():
            _add(result, parts, c * value)
    return result


@lru_cache(maxsize=1 << 12)
def _cosine(x: Fraction) -> Basis:
    """``cos(pi x)`` as the real part of the product of ``exp(i pi y)`` over the parts ``y`` of ``x``."""
    real: Basis = {(): fmpq(1)}
    imaginary: Basis = {}
    for p, y in _parts(x):
        c, s = _local(p, y), _local(p, HALF - y)
        real, imaginary = (_sum_of_products((real, c, 1), (imaginary, s, -1)),
                           _sum_of_products((real, s, 1), (imaginary, c, 1)))
    return real


def _sum_of_products(*terms: tuple[Basis, Basis, int]) -> Basis:
    result: Basis = {}
    for left, right, sign in terms:
        for m, c in left.items():
            for n, d in right.items():
                _add(result, m + n, sign * c * d)
    return result


def _parts(x: Fraction) -> list[tuple[int, Fraction]]:
    """``x`` as a sum of fractions, of denominators ``p**e`` with even numerators for odd ``p``."""
    parts = []
    rest = x
    for p, e in sympy.factorint(x.denominator).items():
        q = int(p) ** int(e)
        if q % 2:
            numerator = x.numerator * pow(x.denominator // q, -1, q) % q
            part = Fraction(numerator + numerator % 2 * q, q)
            rest -= part
            parts.append((int(p), part))
    return [(2, rest), *sorted(parts)]


@lru_cache(maxsize=1 << 12)
def _local(p: int, x: Fraction) -> Basis:
    """``cos(pi x)`` in the basis, for a denominator ``p**e`` or, for odd ``p``, ``2 p**e``."""
    sign, y = folded(x)
    if p == 2:
        return {} if y == HALF else _single(y, fmpq(sign)) if y != Fraction(1, 4) else {(2,): fmpq(sign, 2)}
    result: Basis = {}
    for z, c in _without_largest(p, y).items():
        for parts, value in _with_root(p, z).items():
            _add(result, parts, sign * c * value)
    return result


def _single(x: Fraction, value: Any) -> Basis:
    return {(x,) if x else (): value}


def _without_largest(p: int, x: Fraction) -> Cosines:
    """Step 2: ``cos(pi x)``, or minus the others of its relation if its angle is the largest."""
    if x in (0, HALF):
        return {} if x else {x: fmpq(1)}
    if not _is_largest(p, x):
        return {x: fmpq(1)}
    relation: Cosines = {}
    for j in range(p):
        _add_cosine(relation, x + Fraction(2 * j, p), fmpq(1))
    largest = relation.pop(x)
    return {y: -c / largest for y, c in relation.items()}


def _is_largest(p: int, x: Fraction) -> bool:
    """Whether no angle of the relation of ``x`` is larger; sines of multiples of ``2 pi / p`` have no relation."""
    if x.denominator in (p, 2 * p):
        return x == Fraction(p - 1, 2 * p)
    return x == max(folded(x + Fraction(2 * j, p))[1] for j in range(p))


def _with_root(p: int, x: Fraction) -> Basis:
    """Step 3: ``cos(pi x)``, or ``sqrt(p)`` and the others of its sum if its angle is the largest."""
    if x.denominator not in (p, 2 * p):
        return _single(x, fmpq(1))
    terms = dict(_root_without_largest(p))
    if max(terms) != x:
        return _single(x, fmpq(1))
    largest = terms.pop(x)
    result: Basis = {(p,): 1 / largest}
    for y, c in terms.items():
        _add(result, (y,) if y else (), -c / largest)
    return result


@lru_cache(maxsize=256)
def _root_without_largest(p: int) -> tuple[tuple[Fraction, Any], ...]:
    terms: Cosines = {}
    for x, c in root(p).items():
        for y, value in _without_largest(p, x).items():
            _add(terms, y, c * value)
    return tuple(terms.items())


# -- SymPy's names for them ------------------------------------------------------


def named_cosine(expression: Any) -> tuple[Fraction, Fraction] | None:
    """``(x, e)`` where ``expression**e`` is SymPy's form of ``cos(pi x)``, ``0 < x < 1/2``; None otherwise.

    Of the angles whose cosines SymPy writes with nested roots, ``cos(pi/8) = sqrt(sqrt(2)/4 + 1/2)``, the radicand
    is meant, and ``e = 1/2``.
    """
    if isinstance(expression, sympy.sin | sympy.cos):
        turns = expression.args[0] / sympy.pi
        if not turns.is_Rational:
            return None
        x = Fraction(int(turns.p), int(turns.q))
        return (x if isinstance(expression, sympy.cos) else HALF - x), Fraction(1)
    return _NESTED.get(expression)


_NESTED = {sympy.cos(sympy.pi * sympy.Rational(x)).base: (x, HALF)
           for x in map(Fraction, ("1/8", "3/8", "1/10", "3/10"))}


def expression_of(part: Any) -> Any:
    """``sqrt(p)`` or ``cos(pi x)`` as SymPy writes it."""
    return sympy.sqrt(part) if isinstance(part, int) else sympy.cos(sympy.pi * sympy.Rational(part))
