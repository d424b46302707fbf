r"""SymPy -> series: the only reader of SymPy trees.

Reading accepts exactly the family F of [Neves], section 3, with symbolic
coefficients: sums and products of constants, ``t**r``, ``sin`` and ``cos`` of
``q t + phi`` and ``exp(I (q t + phi))``.  Everything else is refused by name.
Every constant that is no polynomial in something simpler is its own generator,
so ``sqrt(2)``, ``g/l`` and ``1/(b + c)`` come back as what they were.
"""

from __future__ import annotations

import numbers
from decimal import Decimal
from functools import lru_cache
from typing import Any

import mpmath
import sympy
from flint import fmpq, fmpq_poly, fmpz
from sympy import Basic, Expr, I, Symbol, cos, exp, pi, sin

from fastpicard import modes as algebra
from fastpicard.constants import exact_constant
from fastpicard.errors import BadInputError, BadTypeError, NotInFamilyError, printed
from fastpicard.modes import COS, NO_ANGLE, SIN, Angle, Linear, Modes
from fastpicard.ring import (
    ONE,
    Monomial,
    Polynomial,
    add_term,
    fraction,
    generator,
    multiply,
    multiply_monomials,
    normal,
    power,
    rational,
    reciprocal,
    to_expression,
    to_sympy_number,
)
from fastpicard.writing import dyadic

MAXIMAL_POWER = 10_000
NUMBERS, TIMES = tuple("biufcOU"), tuple("mM")  # kinds of NumPy's arrays; text is refused later
_INFINITE = (sympy.nan, sympy.zoo, sympy.oo, -sympy.oo, sympy.AccumBounds)
_FAMILY = "is not in the family of sums of t**r cos(q t + phi) and t**r sin(q t + phi)"


# -- what may come in --------------------------------------------------------


def as_expression(value: Any, what: str = "the expression") -> Expr:
    """A SymPy expression from a SymPy expression or a Python number; text is refused unread, ``mpmath.pi`` is pi.

    Raises
    ------
    BadTypeError
        for ``str`` (SymPy would evaluate it as code), for anything that is no scalar, and for a constant of mpmath
        that SymPy has no name for.
    """
    value = plain(value)
    if isinstance(value, str):
        raise BadTypeError(f"{what} must be a SymPy expression or a number, but it is the text {value!r}, "
                           "which is never evaluated as mathematics.  Build it from sympy.Symbol objects.")
    if isinstance(value, Expr) and not isinstance(value, sympy.Lambda):
        return value
    if isinstance(value, fmpq | fmpz):
        return sympy.Rational(int(fmpq(value).p), int(fmpq(value).q))
    if isinstance(value, mpmath.mp.constant):
        return exact_constant(value, what)
    scalar = isinstance(value, numbers.Number) or hasattr(value, "_sympy_") and not hasattr(value, "shape")
    if isinstance(value, bool | sympy.Lambda) or not scalar:
        raise BadTypeError(f"{what} must be a SymPy expression or a number, but it is {value!r}, "
                           f"a {type(value).__name__}.  For a matrix, work on its entries.")
    if isinstance(value, Decimal) and value.is_finite():
        return sympy.Rational(*value.as_integer_ratio())  # SymPy would round it to 15 digits
    return sympy.sympify(value)


def plain(value: Any) -> Any:
    """What a NumPy array holds, as nested lists, or as a number where it has no axes; anything else unchanged."""
    kind = getattr(getattr(value, "dtype", None), "kind", None)
    if kind in TIMES:
        return str(value)  # refused as text: in integers they would be numbers of nanoseconds
    return value.tolist() if kind in NUMBERS and hasattr(value, "tolist") else value


def as_finite(value: Any, what: str) -> Expr:
    """The same for a value that must be finite."""
    expression = as_expression(value, what)
    if expression.is_finite is False or expression.has(*_INFINITE):
        raise BadInputError(f"{what} must be finite, but it is {expression}.  Give a finite value.")
    return expression


def as_time(t: Any) -> Symbol:
    """The independent variable, which must be a SymPy Symbol."""
    if not isinstance(t, Symbol):
        raise BadTypeError(f"the independent variable must be a SymPy Symbol, but it is {t!r}.  "
                           "Use t = sympy.Symbol('t').")
    return t


def check_same_time(expression: Basic, t: Symbol) -> None:
    """Refuse a second symbol that prints like ``t`` but has other assumptions."""
    for symbol in expression.free_symbols:
        if symbol != t and symbol.name == t.name:
            raise BadInputError(f"the expression contains a symbol {symbol} that is not the variable {t}: they share "
                                "the name but not the assumptions.  Use one and the same Symbol in both places.")


# -- reading -----------------------------------------------------------------


def read(value: Any, t: Symbol) -> Modes:
    """The series of an expression of the family, exactly; ``Float`` is the dyadic rational it stands for.

    Raises
    ------
    NotInFamilyError
        with the part of the expression that is outside.
    """
    expression = dyadic(as_expression(value))
    check_same_time(expression, t)
    return _read(expression, t)


def read_constant(value: Any, t: Symbol, what: str) -> Modes:
    """The same for a value that must not depend on ``t``."""
    expression = as_expression(value, what)
    if t in expression.free_symbols:
        raise BadInputError(f"{what} must not depend on {t}, but it is {expression}.  Use another symbol.")
    return read(expression, t)


def _read(e: Expr, t: Symbol) -> Modes:
    if e.is_Number:
        return algebra.constant({ONE: rational(e)})
    if e.is_Symbol:
        return _read_symbol(e, t)
    if e.is_Add:
        return _read_sum(e, t)
    if e.is_Mul:
        return _read_product(e, t)
    if isinstance(e, sin | cos):
        return _read_trigonometric(e, t)
    if isinstance(e, exp):
        return _read_exponential(e, t)
    if e.is_Pow:
        return _read_power(e, t)
    return _read_other(e, t)


def _read_symbol(e: Expr, t: Symbol) -> Modes:
    if e == t:
        return _time_power(1)
    if not e.is_commutative:
        raise NotInFamilyError(f"{e} {_FAMILY}: it does not commute.  Use a commutative Symbol.")
    _check_finite(e)
    return {} if e.is_zero else algebra.constant(power(e, 1))


@lru_cache(maxsize=1 << 10)
def _is_parameter(base: Expr, t: Symbol) -> bool:
    return bool(base.is_Symbol and base != t and base.is_commutative and base.is_finite is not False
                and not base.is_zero)


def _check_finite(e: Expr) -> None:
    if e.is_finite is False or e.has(*_INFINITE):
        raise BadInputError(f"every coefficient must be finite, but {e} is not.  Give a finite value.")


def _read_other(e: Expr, t: Symbol) -> Modes:
    """A constant that is its own generator, or a refusal."""
    if t in e.free_symbols or t in e.atoms(Symbol):
        raise NotInFamilyError(f"{e} {_FAMILY} in {t}.  Expand it in such terms first, "
                               "for example by its Fourier or Taylor series.")
    _check_finite(e)
    if not e.is_commutative or e.has(sympy.Derivative, sympy.Integral):
        raise NotInFamilyError(f"{e} {_FAMILY}.  Evaluate it first, or put a Symbol in its place.")
    return algebra.constant(power(e, 1))


def _read_sum(e: Expr, t: Symbol) -> Modes:
    result: Modes = {}
    for argument in e.args:
        for (kind, angle, monomial), polynomial in _read(argument, t).items():
            algebra.add_mode(result, kind, angle, monomial, polynomial)
    return result


def _read_product(e: Expr, t: Symbol) -> Modes:
    """Numbers, symbols and powers of ``t`` are gathered first; what remains is multiplied."""
    number, monomial, r = fmpq(1), ONE, 0
    rest: list[Modes] = []
    for factor in e.args:
        base, exponent = factor.as_base_exp() if factor.is_Pow or factor.is_Symbol else (factor, sympy.S.One)
        if factor.is_Rational:
            number *= rational(factor)
        elif base == t and exponent.is_Integer and exponent > 0:
            r += _checked_power(exponent, e)
        elif _is_parameter(base, t) and exponent.is_Integer:
            monomial = multiply_monomials(monomial, ((generator(base), int(exponent)),))[1]
        else:
            rest.append(_read(factor, t))
    if len(rest) == 1 and r and _is_pure_trigonometric(rest[0]):
        return _times_power(rest[0], r, number, monomial)
    result = algebra.scaled(_time_power(r), {monomial: number})
    for factor_modes in rest:
        result = algebra.product(result, factor_modes)
    return result


def _is_pure_trigonometric(modes: Modes) -> bool:
    return len(modes) == 1 and all(f.degree() == 0 and angle[0] for (_, angle, _), f in modes.items())


def _times_power(modes: Modes, r: int, number: Any, monomial: Monomial) -> Modes:
    """``number * monomial * t**r`` times one cosine or sine."""
    (((sine, angle, own), value),) = modes.items()
    kind, polynomial = algebra.trigonometric(sine == SIN, r)
    factor, product = multiply_monomials(own, monomial)
    return {(kind, angle, product): polynomial * (value[0] * number * factor)} if number else {}


def _checked_power(exponent: Any, e: Expr) -> int:
    if exponent > MAXIMAL_POWER:
        raise BadInputError(f"powers up to {MAXIMAL_POWER} are supported, but {printed(e)} has the power "
                            f"{printed(exponent)}.  Rescale the problem.")
    return int(exponent)


@lru_cache(maxsize=1024)
def _time_power(r: int) -> Modes:
    kind, polynomial = algebra.trigonometric(False, r)
    return {(kind, NO_ANGLE, ONE): polynomial}


def _read_power(e: Expr, t: Symbol) -> Modes:
    base, exponent = e.base, e.exp
    if t in exponent.free_symbols:
        return _read_other(e, t)
    if exponent.is_Integer and exponent >= 0:
        whole = _checked_power(exponent, e)
        return _time_power(whole) if base == t else algebra.power(_read(base, t), whole)
    if t in base.free_symbols:
        return _read_other(e, t)
    if exponent.is_Integer:
        return _negative_power(base, int(exponent), e, t)
    if exponent.is_Rational and base.is_Integer and base > 1:
        return algebra.constant(_root_of_integer(int(base), exponent))
    if exponent.is_Rational and base.is_Integer:
        turn = algebra.total(_fixed_value(cos(pi * exponent), t),
                             algebra.scaled(_fixed_value(sin(pi * exponent), t), power(I, 1)))
        return algebra.scaled(turn, _root_of_integer(-int(base), exponent))
    if exponent.is_Rational:
        return algebra.constant(power(base, fraction(exponent), _polynomial_or_none(base, t)))
    return _read_other(e, t)


def _root_of_integer(base: int, exponent: Any) -> Polynomial:
    result: Polynomial = {ONE: fmpq(1)}
    for prime, multiplicity in sympy.factorint(base).items():
        result = multiply(result, power(sympy.Integer(prime), fraction(exponent * multiplicity)))
    return result


def _polynomial_or_none(base: Expr, t: Symbol) -> Polynomial | None:
    """What a sum or product under a root is in other generators."""
    if not (base.is_Add or base.is_Mul):
        return None
    modes = _read(base, t)
    return None if any(angle != NO_ANGLE for _, angle, _ in modes) else {m: f[0] for (_, _, m), f in modes.items()}


def _negative_power(base: Expr, exponent: int, e: Expr, t: Symbol) -> Modes:
    modes = _read(base, t)
    if any(angle != NO_ANGLE for _, angle, _ in modes):
        return algebra.constant(power(base, exponent))
    inverse = reciprocal({m: f[0] for (_, _, m), f in modes.items()})
    return algebra.power(algebra.constant(inverse), -exponent)


@lru_cache(maxsize=1 << 12)
def _read_trigonometric(e: Expr, t: Symbol) -> Modes:
    argument = _linear_argument(e.args[0], t)
    if argument is None:
        return _read_other(e, t)
    angle, half_turns = argument
    return trigonometric(SIN if isinstance(e, sin) else COS, angle, half_turns, t)


def _linear_argument(argument: Expr, t: Symbol) -> tuple[Angle, Any] | None:
    """``q t + phi + rho pi`` as ``((q, phi), rho)``, or None where the argument is not of this form."""
    modes = _read(argument, t)
    if any(angle[0] or f.degree() > 1 for (_, angle, _), f in modes.items()):
        return None
    phase, frequency = _coefficient(modes, 0), _coefficient(modes, 1)
    half_turns = phase.pop(((generator(pi), 1),), fmpq(0))
    return (algebra.settled(algebra.linear(normal(frequency))), algebra.linear(normal(phase))), half_turns


def _coefficient(modes: Modes, r: int) -> Polynomial:
    """What stands before ``t**r / r!`` in a series without frequencies; constant cosines are generators in it."""
    result: Polynomial = {}
    for (kind, (_, start), monomial), f in modes.items():
        sine, sign = algebra.function_of(kind, r)
        for m, value in _wave_at_rest(sine, start).items() if f[r] else ():
            factor, product = multiply_monomials(monomial, m)
            add_term(result, product, f[r] * sign * value * factor)
    return result


@lru_cache(maxsize=1 << 12)
def _wave_at_rest(sine: bool, phase: Linear) -> Polynomial:
    value = (sin if sine else cos)(to_expression(algebra.as_polynomial(phase)))
    sign, wave = value.as_coeff_Mul()
    return {m: c * rational(sign) for m, c in ({ONE: fmpq(1)} if wave == 1 else power(wave, 1)).items()}


def trigonometric(kind: int, angle: Angle, half_turns: Any, t: Symbol) -> Modes:
    """cos or sin of ``angle + half_turns * pi``."""
    turned, angle = algebra.orient(angle)
    result: Modes = {}
    if (2 * half_turns).q == 1:
        shift = kind + int((-2 * half_turns).p)  # cos(x - k pi/2): k = 1 is sin
        other, sign = shift % 2, 1 if shift % 4 < 2 else -1
        algebra.add_reflected(result, other, turned, angle, ONE, fmpq_poly([sign]))
        return result
    fixed = to_sympy_number(half_turns) * pi
    along, across = _fixed_value(cos(fixed), t), _fixed_value(sin(fixed), t)
    same: Modes = {}
    turned_quarter: Modes = {}
    algebra.add_reflected(same, kind, turned, angle, ONE, fmpq_poly([1]))
    algebra.add_reflected(turned_quarter, 1 - kind, turned, angle, ONE, fmpq_poly([-1 if kind == COS else 1]))
    return algebra.total(algebra.product(along, same), algebra.product(across, turned_quarter))


def _fixed_value(value: Expr, t: Symbol) -> Modes:
    """cos or sin of a rational multiple of pi: radicals where SymPy knows them, a generator of its own otherwise."""
    sign, rest = value.as_coeff_Mul()
    if isinstance(rest, sin | cos):
        return algebra.scaled(algebra.constant(power(rest, 1)), {ONE: rational(sign)})
    return _read(value, t)


def _read_exponential(e: Expr, t: Symbol) -> Modes:
    """``exp(c + I x) = exp(c) (cos x + I sin x)`` for real-linear ``x``."""
    constant_part, imaginary = sympy.expand(e.args[0]).as_independent(I, as_Add=True)
    if t in constant_part.free_symbols:
        return _read_other(e, t)
    x = sympy.expand(imaginary / I)
    if imaginary == 0 or x.has(I):
        return _read_other(e, t)
    wave = algebra.total(_read(cos(x), t), algebra.scaled(_read(sin(x), t), power(I, 1)))
    return wave if constant_part == 0 else algebra.scaled(wave, power(exp(constant_part), 1))


def as_polynomial(modes: Modes) -> Polynomial:
    """A constant series as a polynomial in the parameters."""
    return _coefficient(modes, 0)
