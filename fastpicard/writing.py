r"""Series -> SymPy: the only writer of SymPy trees.

Expressions are built as SymPy itself would have built them, argument by
argument in canonical order, so that nothing is sorted or evaluated twice: the
order of SymPy's ``Basic.compare`` is computed once per factor, as a plain tuple.
"""

from __future__ import annotations

from math import factorial
from typing import Any

import sympy
from sympy import Add, Basic, Expr, Mul, Symbol, cos, pi, sin
from sympy.core.basic import ordering_of_classes

from fastpicard import modes as algebra
from fastpicard.modes import NO_ANGLE, Angle, Linear, Modes
from fastpicard.ring import Monomial, Polynomial, add_term, expression_of, monomial_expression, to_expression

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


class _Writer:
    """Writes modes, remembering factors and their order."""

    def __init__(self, t: Symbol) -> None:
        self.t = t
        self.factors: dict[Any, tuple[int, tuple[tuple[Any, Expr], ...], bool]] = {}
        self.trigonometric: dict[Any, tuple[int, Expr]] = {}

    def add(self, terms: list[tuple[Any, Expr]], kind: int, angle: Angle, monomial: Monomial, f: Any) -> None:
        """Append every term of one mode."""
        numerator, denominator = f.numer().coeffs(), int(f.denom())
        for r, c in enumerate(numerator):
            if c:
                sine, sign = algebra.function_of(kind, r)
                sign, factors, plain = self.product(monomial, r, sine, angle, sign)
                value = sympy.Rational(sign * int(c), denominator * factorial(r))
                terms.append(_term(value, factors) if plain else (None, Mul(value, *(e for _, e in factors))))

    def product(self, monomial: Monomial, r: int, sine: bool, angle: Angle, sign: int) -> Any:
        """The factors of ``monomial * t**r * cos`` in canonical order."""
        key = (monomial, r, sine, angle)
        found = self.factors.get(key)
        if found is None:
            found = self.factors[key] = self._product(monomial, r, sine, angle)
        own, factors, plain = found
        return sign * own, factors, plain

    def _product(self, monomial: Monomial, r: int, sine: bool, angle: Angle) -> Any:
        sign, trigonometric = self.function(sine, angle)
        factors = [expression_of(g) ** sympy.Rational(e) for g, e in monomial]
        factors += [self.t**r] * (r > 0) + [trigonometric] * (angle != NO_ANGLE)
        plain = all(e.is_Symbol or e.is_Pow and e.base.is_Symbol or isinstance(e, sin | cos) or e is pi
                    or e.is_Pow and e.base is pi for e in factors)
        return sign, tuple(sorted(((order_key(e), e) for e in factors), key=lambda item: item[0])), plain

    def function(self, sine: bool, angle: Angle) -> tuple[int, Expr]:
        """cos or sin of an angle as SymPy evaluates it, with the sign it may pull out."""
        key = (sine, angle)
        if key not in self.trigonometric:
            sign, e = (sin if sine else cos)(angle_expression(angle, self.t)).as_coeff_Mul()
            self.trigonometric[key] = (int(sign), e) if e is not sympy.S.One else (1, sign)
        return self.trigonometric[key]


def _term(value: Expr, factors: tuple[tuple[Any, Expr], ...]) -> tuple[Any, Expr]:
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


def write_at(modes: Modes, time: Expr) -> Expr:
    """The series with ``time`` put in place of ``t``, terms evaluated by SymPy one by one."""
    terms = []
    for (kind, angle, monomial), f in modes.items():
        argument = angle_expression(angle, time)
        functions = (cos(argument), sin(argument))
        for r, c in enumerate(f.coeffs()):
            if c:
                sine, sign = algebra.function_of(kind, r)
                value = sympy.Rational(sign * int(c.p), int(c.q) * factorial(r))
                terms.append(value * monomial_expression(monomial) * time**r * functions[sine])
    return Add(*terms)




def gathered(modes: Modes, t: Symbol) -> Expr:
    """The series with one coefficient for each ``t**r cos`` and ``t**r sin``."""
    collected: dict[Any, Polynomial] = {}
    for (kind, angle, monomial), f in modes.items():
        for r, c in enumerate(f.coeffs()):
            sine, sign = algebra.function_of(kind, r)
            add_term(collected.setdefault((r, sine, angle), {}), monomial, c * sign / factorial(r))
    terms = []
    for (r, sine, angle), coefficient in collected.items():
        function = (sin if sine else cos)(angle_expression(angle, t))
        terms.append(to_expression(coefficient) * t**r * function)
    return Add(*terms)
