r"""The algebra of modes: Poisson series as plain data.

For an angle ``alpha = q t + phi`` put

    c_r(alpha) = t**r / r! * cos(alpha - r pi/2)
    s_r(alpha) = t**r / r! * sin(alpha - r pi/2)

A quarter turn for every power of ``t`` makes all signs disappear:

    d/dt c_r = s_{r-1} - q s_r                 d/dt s_r = -(c_{r-1} - q c_r)

so the antiderivative of ``sum f_r c_r`` is ``sum G_r s_r`` with one recurrence
from the highest power down, ``q G_r = f_r + G_{r+1}`` ([Neves] (8) and (9),
summed).  Products turn into sums,

    2 c_r(x) c_s(y) = C(r+s, r) [c_{r+s}(x + y) + (-1)**s c_{r+s}(x - y)]

and angles reflect, ``c_r(-x) = (-1)**r c_r(x)``, ``s_r(-x) = -(-1)**r s_r(x)``.
Even functions of ``t`` are made of ``c`` alone and odd ones of ``s`` alone (where
phases vanish), so parity costs nothing to keep.

Data: ``Modes`` maps ``(kind, angle, monomial)`` to a polynomial ``f`` in ``x``
whose coefficient of ``x**r`` multiplies ``c_r`` (kind 0) or ``s_r`` (kind 1).
An angle is a pair ``(q, phi)`` of linear combinations of monomials.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial, gcd, lcm
from typing import Any

from flint import fmpq, fmpq_poly

from fastpicard.ring import (
    ONE,
    Monomial,
    Polynomial,
    fraction,
    has_square_roots_only,
    is_zero,
    multiply,
    multiply_monomials,
    ratio,
    reciprocal,
)

Linear = tuple[tuple[Monomial, Any], ...]  # sorted (monomial, int or Fraction) pairs
Angle = tuple[Linear, Linear]
Key = tuple[int, Angle, Monomial]
Modes = dict[Key, Any]  # Key -> fmpq_poly

COS, SIN = 0, 1
NO_ANGLE: Angle = ((), ())

_FLIP = fmpq_poly([0, -1])


# -- angles ------------------------------------------------------------------


def linear(terms: Polynomial) -> Linear:
    """A polynomial as a canonical linear combination of monomials."""
    return tuple((m, fraction(terms[m])) for m in sorted(terms))


def as_polynomial(form: Linear) -> Polynomial:
    """A linear combination as a polynomial."""
    return {m: fmpq(c.numerator, c.denominator) for m, c in form}


def _combine(left: Linear, right: Linear, sign: int) -> Linear:
    if not right:
        return left
    total = dict(left)
    for monomial, value in right:
        value = total.get(monomial, 0) + sign * value
        if value:
            total[monomial] = ratio(value)
        else:
            del total[monomial]
    return tuple(sorted(total.items()))


@lru_cache(maxsize=1 << 16)
def add_angles(left: Angle, right: Angle, sign: int) -> tuple[bool, Angle]:
    """``left + sign * right`` with its leading coefficient made positive: ``(was reflected, angle)``."""
    return orient((settled(_combine(left[0], right[0], sign)), _combine(left[1], right[1], sign)))


@lru_cache(maxsize=1 << 14)
def settled(frequency: Linear) -> Linear:
    """A frequency, or none where its terms cancel by relations between parameters: resonance, not a division by 0."""
    return () if is_zero(as_polynomial(frequency)) else frequency


def orient(angle: Angle) -> tuple[bool, Angle]:
    """Of an angle and its negative, the one that stands for both."""
    frequency, phase = angle
    lead = frequency or phase
    if not lead or lead[-1][1] > 0:
        return False, angle
    return True, (tuple((m, ratio(-c)) for m, c in frequency), tuple((m, ratio(-c)) for m, c in phase))


def common_unit(frequencies: set[Linear]) -> tuple[Monomial, Any] | None:
    """The largest unit ``(monomial, fmpq)`` of which every frequency is a whole multiple, or None."""
    if not frequencies:
        return ONE, fmpq(1)
    if any(len(frequency) > 1 for frequency in frequencies):
        return None
    monomials = {frequency[0][0] for frequency in frequencies}
    if len(monomials) > 1:
        return None
    values = [frequency[0][1] for frequency in frequencies]
    return monomials.pop(), fmpq(gcd(*(v.numerator for v in values)), lcm(*(v.denominator for v in values)))


# -- building ----------------------------------------------------------------


def mask(kind: int, polynomial: Any) -> Any:
    """Drop the modes that vanish identically where the angle is zero: ``c_1, c_3, ...``, ``s_0, s_2, ...``."""
    reflected = polynomial(_FLIP)
    return (polynomial + reflected) / 2 if kind == COS else (polynomial - reflected) / 2


def add_mode(target: Modes, kind: int, angle: Angle, monomial: Monomial, polynomial: Any) -> None:
    """Add one mode in place; ``angle`` must be oriented."""
    if angle == NO_ANGLE:
        polynomial = mask(kind, polynomial)
    key = (kind, angle, monomial)
    old = target.get(key)
    total = polynomial if old is None else old + polynomial
    if total:
        target[key] = total
    elif old is not None:
        del target[key]


def add_reflected(target: Modes, kind: int, turned: bool, angle: Angle, monomial: Monomial, polynomial: Any) -> None:
    """Add a mode at an angle that :func:`orient` may have reflected."""
    if turned:
        polynomial = polynomial(_FLIP) if kind == COS else -polynomial(_FLIP)
    add_mode(target, kind, angle, monomial, polynomial)


def trigonometric(sine: bool, r: int) -> tuple[int, Any]:
    """``t**r cos`` or ``t**r sin`` of any angle as ``(kind, polynomial)``; ``t**r`` is the cosine of the angle zero."""
    kind = (r + sine) % 2
    quarter_turns = (r + 1) // 2 if kind == SIN else r // 2
    return kind, fmpq_poly([0] * r + [(-1) ** quarter_turns * factorial(r)])


def constant(terms: Polynomial) -> Modes:
    """A polynomial in the parameters as a series."""
    return {(COS, NO_ANGLE, m): fmpq_poly([c]) for m, c in terms.items() if c}


# -- ring operations ---------------------------------------------------------


def add_modes(target: Modes, modes: Modes) -> None:
    """Add a canonical series in place."""
    for key, polynomial in modes.items():
        old = target.get(key)
        sum_ = polynomial if old is None else old + polynomial
        if sum_:
            target[key] = sum_
        else:
            del target[key]


def total(left: Modes, right: Modes) -> Modes:
    """The sum of two series."""
    result = dict(left)
    add_modes(result, right)
    return result


def negative(modes: Modes) -> Modes:
    """The series with all signs changed."""
    return {key: -polynomial for key, polynomial in modes.items()}


def scaled(modes: Modes, terms: Polynomial) -> Modes:
    """A series times a polynomial in the parameters."""
    result: Modes = {}
    for (kind, angle, monomial), polynomial in modes.items():
        for m, c in terms.items():
            factor, product = multiply_monomials(monomial, m)
            add_mode(result, kind, angle, product, polynomial * (c * factor))
    return result


def divided_product(f: Any, g: Any) -> Any:
    """The product where ``x**r`` stands for ``t**r / r!``."""
    if f.degree() == 0 or g.degree() == 0:
        return f * g
    ordinary = _to_ordinary(f) * _to_ordinary(g)
    return fmpq_poly([c * factorial(r) for r, c in enumerate(ordinary.coeffs())])


def _to_ordinary(f: Any) -> Any:
    return fmpq_poly([c / factorial(r) for r, c in enumerate(f.coeffs())])


def product(left: Modes, right: Modes) -> Modes:
    """The product of two series, by product to sum."""
    result: Modes = {}
    for (kind, x, m), f in left.items():
        for (other, y, n), g in right.items():
            if kind < other or (kind == other and f.degree() < g.degree()):
                _multiply_modes(result, (other, y, n), g, (kind, x, m), f)
            else:
                _multiply_modes(result, (kind, x, m), f, (other, y, n), g)
    return result


def power(modes: Modes, exponent: int) -> Modes:
    """A power with an exponent from 0 up, by repeated squaring."""
    result = constant({ONE: fmpq(1)})
    while exponent:
        if exponent & 1:
            result = product(result, modes)
        exponent >>= 1
        if exponent:
            modes = product(modes, modes)
    return result


def _multiply_modes(target: Modes, left: Key, f: Any, right: Key, g: Any) -> None:
    """cos cos, sin cos and sin sin; the first factor is the sine where only one is, else that of the higher degree."""
    (kind, x, m), (other, y, n) = left, right
    factor, monomial = multiply_monomials(m, n)
    if y == NO_ANGLE and g.degree() == 0:  # a constant
        add_mode(target, kind, x, monomial, f * (g[0] * factor))
        return
    half = factor / 2
    outer = inner = divided_product(f, g) * half
    if g.degree() > 0:
        inner = divided_product(f, g(_FLIP)) * half
    if other == SIN:
        kind, outer = COS, -outer
    add_reflected(target, kind, *add_angles(x, y, 1), monomial, outer)
    add_reflected(target, kind, *add_angles(x, y, -1), monomial, inner)


# -- calculus ----------------------------------------------------------------


def derivative(modes: Modes) -> Modes:
    """``d/dt``: ``sum f_r c_r`` becomes ``sum (f_{r+1} - q f_r) s_r``, and ``s`` minus that in ``c``."""
    result: Modes = {}
    for (kind, angle, monomial), f in modes.items():
        sign = 1 if kind == COS else -1
        add_mode(result, 1 - kind, angle, monomial, f.right_shift(1) * sign)
        for m, q in as_polynomial(angle[0]).items():
            factor, scaled_monomial = multiply_monomials(monomial, m)
            add_mode(result, 1 - kind, angle, scaled_monomial, f * (-sign * q * factor))
    return result


def antiderivative(modes: Modes) -> Modes:
    """The antiderivative that is zero at ``t = 0``."""
    result: Modes = {}
    starts: dict[Key, list[Any]] = {}
    for (kind, angle, monomial), f in modes.items():
        sign = 1 if kind == COS else -1
        turned, start = orient(((), angle[1]))
        for m, g in mode_antiderivative(angle[0], f):
            factor, product_monomial = multiply_monomials(monomial, m)
            polynomial = g if sign * factor == 1 else g * (sign * factor)
            add_mode(result, 1 - kind, angle, product_monomial, polynomial)
            if angle[0]:
                value = polynomial[0] if turned and kind == COS else -polynomial[0]
                starts.setdefault((1 - kind, start, product_monomial), []).append(value)
    for (kind, start, monomial), values in starts.items():
        add_mode(result, kind, start, monomial, fmpq_poly([rational_sum(values)]))
    return result


def rational_sum(numbers: list[Any]) -> Any:
    """The sum of rational numbers, over one denominator inside python-flint; of many by halves."""
    if len(numbers) > 64:
        middle = len(numbers) // 2
        return rational_sum(numbers[:middle]) + rational_sum(numbers[middle:])
    return fmpq_poly(numbers)(1)


def mode_antiderivative(frequency: Linear, f: Any) -> list[tuple[Monomial, Any]]:
    """Solve ``q G_r = f_r + G_{r+1}`` downwards: pairs (monomial, polynomial) whose sum is ``G``.

    That is one division, ``x f = (q x - 1) G + G_0``.  Where q has square roots in it both sides are multiplied by the
    conjugates of ``q x - 1``, so that the divisor is rational.
    """
    if not frequency:
        return [(ONE, -f.left_shift(1))]
    divisor, factors = _divisor(frequency)
    return [(m, f * x // divisor) for m, x in factors] if divisor else _generic_antiderivative(frequency, f)


@lru_cache(maxsize=1 << 12)
def _divisor(frequency: Linear) -> tuple[Any, tuple[tuple[Monomial, Any], ...]]:
    """The product of all conjugates of ``q x - 1``, and x times that of the others; None where there are none."""
    if not has_square_roots_only(m for m, _ in frequency):
        return None, ()
    product = {m: fmpq_poly([0, c]) for m, c in as_polynomial(frequency).items()}
    product[ONE] = product.get(ONE, fmpq_poly()) - 1
    others = {ONE: fmpq_poly([0, 1])}
    for g in sorted({g for m in product for g, _ in m}):
        conjugate = {m: -c if any(g == other for other, _ in m) else c for m, c in product.items()}
        if conjugate != product:
            product, others = _times(product, conjugate), _times(others, conjugate)
    return product[ONE], tuple(others.items())


def _times(left: dict[Monomial, Any], right: dict[Monomial, Any]) -> dict[Monomial, Any]:
    """The product of two polynomials in x with square roots in their coefficients."""
    result: dict[Monomial, Any] = {}
    for m, c in left.items():
        for n, d in right.items():
            factor, monomial = multiply_monomials(m, n)
            result[monomial] = result.get(monomial, fmpq_poly()) + c * d * factor
    return {m: c for m, c in result.items() if c}


def _generic_antiderivative(frequency: Linear, f: Any) -> list[tuple[Monomial, Any]]:
    """``G = sum_k q**-(k+1) S**k f`` with ``S`` the shift down."""
    collected: dict[Monomial, Any] = {}
    for k in range(f.degree() + 1):
        shifted = f.right_shift(k)
        for m, c in _inverse_power(frequency, k + 1).items():
            old = collected.get(m)
            collected[m] = shifted * c if old is None else old + shifted * c
    return list(collected.items())


@lru_cache(maxsize=1 << 14)
def _inverse_power(frequency: Linear, k: int) -> Polynomial:
    if k == 1:
        return reciprocal(as_polynomial(frequency))
    return multiply(_inverse_power(frequency, k - 1), _inverse_power(frequency, 1))


# -- values ------------------------------------------------------------------


def function_of(kind: int, r: int) -> tuple[bool, int]:
    """``c_r`` or ``s_r`` over ``t**r / r!`` as ``(is it a sine, its sign)``."""
    quarter_turns = r // 2 if kind == COS else (r + 1) // 2
    return (r + kind) % 2 == 1, -1 if quarter_turns % 2 else 1


@lru_cache(maxsize=64)
def _functions_of(kind: int, count: int) -> list[tuple[bool, int]]:
    return [function_of(kind, r) for r in range(count)]


def quarter_turned(kind: int, turns: int) -> tuple[int, bool]:
    """``cos`` or ``sin`` of an angle with so many quarter turns added: which of the two, and whether its sign changes.

    >>> [quarter_turned(COS, k) for k in range(4)]      # cos, -sin, -cos, sin
    [(0, False), (1, True), (0, True), (1, False)]
    """
    return (kind + turns) % 2, (kind + 1 + turns) % 4 > 1 if kind == COS else turns % 4 > 1


def frozen(modes: Modes, powers: list[Polynomial]) -> Modes:
    """A series without frequencies at a fixed time ``T``, given ``T**r / r!``: only constants are left."""
    values: dict[Key, Any] = {}
    functions = [_functions_of(kind, len(powers)) for kind in (COS, SIN)]
    terms = [list(power.items()) for power in powers]
    for (kind, angle, monomial), f in modes.items():
        for c, (sine, sign), at_time in zip(f.coeffs(), functions[kind], terms, strict=False):
            if not c or sine and angle == NO_ANGLE:
                continue
            for m, value in at_time:
                factor, product_monomial = multiply_monomials(monomial, m)
                key = (SIN if sine else COS, angle, product_monomial)
                amount = c * value if sign > 0 else -c * value
                values[key] = values.get(key, 0) + (amount if factor == 1 else amount * factor)
    return {key: fmpq_poly([value]) for key, value in values.items() if value}
