r"""Series -> SymPy: the only writer of SymPy trees.

Expressions are built as SymPy itself would have built them, argument by
argument in canonical order, so that nothing is sorted or evaluated twice: the
order of SymPy's ``Basic.compare`` is computed once per factor, as a plain tuple.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial
from typing import Any

import sympy
from sympy import Add, Basic, Expr, Mul, Symbol, cos, pi, sin
from sympy.core.basic import ordering_of_classes

from fastpicard import modes as algebra
from fastpicard.modes import NO_ANGLE, Angle, Linear, Modes
from fastpicard.ring import (
    ONE,
    Monomial,
    Polynomial,
    add_term,
    expression_of,
    monomial_expression,
    rational,
    to_expression,
    to_sympy_number,
)

_RANK = {name: rank for rank, name in enumerate(ordering_of_classes)}
_UNKNOWN = len(ordering_of_classes) + 1
_MUL_RANK = _RANK["Mul"]


def order_key(e: Any) -> Any:
    """A tuple that sorts as SymPy's ``Basic.compare`` does."""
    if not isinstance(e, Basic):
        return e
    name = type(e).__name__
    rank = _RANK.get(name, _UNKNOWN)
    content = e._hashable_content()
    return rank, "" if rank != _UNKNOWN else name, len(content), tuple(map(order_key, content))


def write(modes: Modes, t: Symbol) -> Expr:
    """The series as the canonical, expanded SymPy expression."""
    writer = _Writer(t)
    terms: list[tuple[Any, Expr]] = []
    for (kind, angle, monomial), f in modes.items():
        writer.add(terms, kind, angle, monomial, f)
    return _sum(terms)


def _sum(terms: list[tuple[Any, Expr]]) -> Expr:
    """An Add of distinct terms that are canonical already, each with its key."""
    constants = [e for key, e in terms if key is None]
    if len(constants) > 1 or any(not e.is_Rational for e in constants):
        return Add(*(e for _, e in terms))
    keyed = sorted((item for item in terms if item[0] is not None), key=lambda item: item[0])
    return Add._from_args(constants + [e for _, e in keyed], is_commutative=True)


Keyed = tuple[tuple[Any, Expr], ...]  # factors with their order keys


def _keyed(factors: list[Expr]) -> Keyed:
    return tuple((order_key(e), e) for e in factors)


@lru_cache(maxsize=1 << 14)
def _factor(number: int, exponent: Any) -> tuple[tuple[Any, Expr], bool]:
    """A power of a generator with its key, and whether SymPy leaves its products alone."""
    e = expression_of(number) ** sympy.Rational(exponent)
    base = e.base if e.is_Pow else e
    return (order_key(e), e), base.is_Symbol or base is pi


class _Writer:
    """Writes modes, remembering factors and their order."""

    def __init__(self, t: Symbol) -> None:
        self.t = t
        self.monomials: dict[Monomial, tuple[Keyed, bool]] = {}
        self.powers: dict[int, Keyed] = {0: ()}
        self.waves: dict[tuple[bool, Angle], tuple[Any, Keyed, bool]] = {}

    def add(self, terms: list[tuple[Any, Expr]], kind: int, angle: Angle, monomial: Monomial, f: Any) -> None:
        """Append every term of one mode."""
        factors, plain = self.monomial(monomial)
        for r, c in enumerate(f.coeffs()):
            if c:
                sine, sign = algebra.function_of(kind, r)
                own, wave, regular = self.wave(sine, angle)
                value = to_sympy_number(c * (sign * own) / factorial(r))
                product = sorted((*factors, *self.power(r), *wave), key=_first)
                terms.append(_term(value, product) if plain and regular else
                             (None, Mul(value, *(e for _, e in product))))

    def monomial(self, monomial: Monomial) -> tuple[Keyed, bool]:
        """The factors of a monomial, and whether SymPy leaves their products alone."""
        if monomial not in self.monomials:
            factors = [_factor(g, e) for g, e in monomial]
            self.monomials[monomial] = tuple(factor for factor, _ in factors), all(plain for _, plain in factors)
        return self.monomials[monomial]

    def power(self, r: int) -> Keyed:
        """``t**r``, no factor for r = 0."""
        if r not in self.powers:
            self.powers[r] = _keyed([self.t**r])
        return self.powers[r]

    def wave(self, sine: bool, angle: Angle) -> tuple[Any, Keyed, bool]:
        """cos or sin of an angle as SymPy evaluates it: the number it pulls out, its factor, whether that is plain.

        The number is a sign, but for phases such as ``acos(1/3)``, of which SymPy knows the cosine.
        """
        key = (sine, angle)
        if key not in self.waves:
            if angle == NO_ANGLE:
                self.waves[key] = 1, (), True
            else:
                # Of a positive rational times t SymPy leaves the cosine as it is, after 2 ms of thought.
                known = not angle[1] and len(angle[0]) == 1 and angle[0][0][0] == ONE
                function = sin if sine else cos
                number, e = function(angle_expression(angle, self.t), evaluate=not known).as_coeff_Mul()
                self.waves[key] = (int(number) if number.is_Integer else rational(number), _keyed([e]),
                                   isinstance(e, sin | cos))
        return self.waves[key]


def _first(pair: tuple[Any, Expr]) -> Any:
    return pair[0]


def _term(value: Expr, factors: list[tuple[Any, Expr]]) -> tuple[Any, Expr]:
    """``value * factors`` with its key, both built without evaluation."""
    if not factors:
        return None, value
    keys = tuple(key for key, _ in factors)
    arguments = tuple(e for _, e in factors)
    if value is not sympy.S.One:
        keys, arguments = (order_key(value), *keys), (value, *arguments)
    if len(arguments) == 1:
        return keys[0], arguments[0]
    return (_MUL_RANK, "", len(keys), keys), Mul._from_args(arguments, is_commutative=True)


def linear_expression(form: Linear) -> Expr:
    """A linear combination of monomials as SymPy writes it."""
    return Add(*(sympy.Rational(c) * monomial_expression(m) for m, c in form))


def angle_expression(angle: Angle, time: Expr) -> Expr:
    """``q * time + phi``."""
    return linear_expression(angle[0]) * time + linear_expression(angle[1])


def dyadic(e: Expr) -> Expr:
    """The same with every finite ``Float`` as the dyadic rational it stands for: nothing after it rounds."""
    return e.xreplace({x: to_sympy_number(rational(x)) for x in e.atoms(sympy.Float) if x.is_finite})


def gathered(modes: Modes, t: Symbol) -> Expr:
    """The series with one coefficient for each ``t**r cos`` and ``t**r sin``."""
    collected: dict[Any, Polynomial] = {}
    for (kind, angle, monomial), f in modes.items():
        for r, c in enumerate(f.coeffs()):
            sine, sign = algebra.function_of(kind, r)
            add_term(collected.setdefault((r, sine, angle), {}), monomial, c * sign / factorial(r))
    coefficients: dict[Expr, list[Expr]] = {}
    for (r, sine, angle), coefficient in collected.items():
        function = (sin if sine else cos)(angle_expression(angle, t))
        constant, wave = (sympy.S.One, function) if angle[0] else (function, sympy.S.One)
        coefficients.setdefault(t**r * wave, []).append(to_expression(coefficient) * constant)
    return Add(*(Add(*parts) * wave for wave, parts in coefficients.items()))
