"""Constants with their derivatives by parameters: exact ones in the ring, and the product rule in balls."""

from __future__ import annotations

from typing import Any

from flint import fmpq
from sympy import Symbol

from fastpicard import modes as algebra
from fastpicard.errors import BadTypeError
from fastpicard.modes import COS, Modes
from fastpicard.ring import Monomial, expression_of, multiply_monomials


def derivative(modes: Modes, symbol: Symbol) -> Modes:
    """The derivative of constants by a parameter, in monomials and in phases: ``cos' phi = -phi' sin phi``."""
    result: Modes = {}
    for (kind, angle, monomial), f in modes.items():
        for factor, lower in _rate(monomial, symbol):
            algebra.add_mode(result, kind, angle, lower, f * factor)
        for m, c in angle[1]:
            for factor, lower in _rate(m, symbol):
                number, product = multiply_monomials(monomial, lower)
                sign = -1 if kind == COS else 1
                algebra.add_mode(result, 1 - kind, angle, product,
                                 f * (sign * factor * number * fmpq(c.numerator, c.denominator)))
    return result


def _rate(monomial: Monomial, symbol: Symbol) -> list[tuple[Any, Monomial]]:
    """The derivative of a monomial, as number and monomial; nothing where it is 0."""
    found = []
    for k, (g, e) in enumerate(monomial):
        if expression_of(g) == symbol:
            lower = (*monomial[:k], *(((g, e - 1),) if e != 1 else ()), *monomial[k + 1:])
            found.append((fmpq(e.numerator, e.denominator), lower))
        elif symbol in expression_of(g).free_symbols:
            raise BadTypeError(f"a boundary is differentiated by parameters that occur as powers, but {symbol} "
                               f"occurs in {expression_of(g)}.  Name that by a symbol of its own.")
    return found


class Dual:
    """A number with its first derivatives: the product rule, in balls."""

    __slots__ = ("parts",)

    def __init__(self, parts: list[Any]) -> None:
        self.parts = parts

    def __add__(self, other: Any) -> Dual:
        if not isinstance(other, Dual):
            return Dual([self.parts[0] + other, *self.parts[1:]])
        return Dual([x + y for x, y in zip(self.parts, other.parts, strict=True)])

    def __sub__(self, other: Dual) -> Dual:
        return self + other * -1

    def __mul__(self, other: Any) -> Dual:
        if not isinstance(other, Dual):
            return Dual([x * other for x in self.parts])
        f, g = self.parts[0], other.parts[0]
        return Dual([f * g, *(f * dg + df * g for df, dg in zip(self.parts[1:], other.parts[1:], strict=True))])

