r"""Numbers from exact results: float64, mpmath digits, balls.

A sum of terms in ``t**r cos(q t)`` evaluated term by term in float64 may lose
every digit: the terms of an iterate of order 40 exceed their sum by ``1e20``.
So every number is computed in balls (python-flint ``arb``: a midpoint and a
radius that provably contains the truth), the working precision is raised until
the radius is below the digits asked for, and only then is the midpoint rounded.

A whole mode is one polynomial at an imaginary point,

    sum f_r c_r + i sum f_r s_r = exp(i alpha) sum_r f_r (-i t)**r / r!
"""

from __future__ import annotations

import math
import numbers
import operator
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import mpmath
import sympy
from flint import acb, acb_poly, arb, ctx, fmpq, fmpz, fmpz_poly
from mpmath import libmp
from sympy import Expr, Symbol

from fastpicard.errors import BadInputError, BadTypeError, printed
from fastpicard.modes import COS, Key, Linear, Modes
from fastpicard.precision import working
from fastpicard.ring import Monomial, Polynomial, expression_of, rational, symbols_of
from fastpicard.values import Values, exact_number, exact_values

EXTRA_BITS = 4096  # beyond the digits asked for, before a value is taken to be zero
Prepared = list[tuple[Key, Any, Any]]  # integer coefficients of powers, and their common rational factor


def numpy() -> Any:
    """NumPy, imported when arrays are first asked for: it takes longer to load than all of this package."""
    import numpy as module

    return module


# -- balls -------------------------------------------------------------------


def ball(value: Any) -> Any:
    """An exact number as a ball at the working precision."""
    if isinstance(value, arb):
        return value
    return arb(value) if isinstance(value, fmpq) else expression_ball(value, {})


_CONSTANTS: dict[Any, Callable[[], Any]] = {
    sympy.pi: arb.pi, sympy.E: arb.const_e, sympy.Catalan: arb.const_catalan, sympy.EulerGamma: arb.const_euler,
    sympy.GoldenRatio: lambda: (1 + arb(5).sqrt()) / 2,
}
_FUNCTIONS: dict[Any, Callable[[Any], Any]] = {
    sympy.sin: lambda x: x.sin(), sympy.cos: lambda x: x.cos(), sympy.tan: lambda x: x.tan(),
    sympy.exp: lambda x: x.exp(), sympy.log: lambda x: x.log(), sympy.atan: lambda x: x.atan(),
    sympy.sinh: lambda x: x.sinh(), sympy.cosh: lambda x: x.cosh(), sympy.tanh: lambda x: x.tanh(),
    sympy.Abs: abs, sympy.gamma: lambda x: x.gamma(), sympy.asin: lambda x: x.asin(), sympy.acos: lambda x: x.acos(),
}


def expression_ball(e: Expr, values: Mapping[Symbol, Any]) -> Any:
    """A constant SymPy expression as a ball, at the values of its symbols."""
    if e.is_Symbol:
        return ball(values[e])
    if e.is_Rational or e.is_Float:
        return arb(rational(e))
    if e in _CONSTANTS:
        return _CONSTANTS[e]()
    if isinstance(e, sympy.CRootOf):
        return _root_ball(e)
    if not (e.is_Add or e.is_Mul or e.is_Pow or e.func in _FUNCTIONS):
        raise BadInputError(f"no rigorous value of {e} is known: {e.func.__name__} has no ball arithmetic here.  "
                            "Replace it by a Symbol and give that a value.")
    parts = [expression_ball(x, values) for x in e.args]
    if e.is_Add:
        return sum(parts, arb(0))
    if e.is_Mul:
        return math.prod(parts, start=arb(1))
    return _power(parts[0], parts[1], e.exp) if e.is_Pow else _FUNCTIONS[e.func](*parts)


def _root_ball(root: Any) -> Any:
    """A real ``CRootOf``: SymPy counts the real roots of a polynomial first, in ascending order."""
    real = _real_roots(tuple(map(int, reversed(root.poly.all_coeffs()))), ctx.prec)
    if root.index >= len(real):
        raise BadInputError(f"a value must be real, but {root} is not: the real roots of its polynomial are those "
                            f"with an index below {len(real)}.  Use one of them.")
    return real[root.index]


@lru_cache(maxsize=256)
def _real_roots(coefficients: tuple[int, ...], bits: int) -> list[Any]:
    """The real roots of an irreducible polynomial in disjoint balls of ``bits`` bits, ascending."""
    found: Any = fmpz_poly(list(coefficients)).complex_roots()
    return sorted(z.real for z, _ in found if z.imag == 0)


def _power(base: Any, exponent: Any, e: Expr) -> Any:
    if not e.is_Rational and exponent.is_exact() and exponent.is_integer():  # by its value: (-1)**k
        e = sympy.Integer(int(exponent.unique_fmpz()))
    if e.is_Integer and e > 0 and base.mid() == 0:  # FLINT gives nan for powers of a ball around 0
        return arb(0, abs(base).upper() ** int(e))
    if e.is_Integer:
        return base ** int(e)
    return base.root(int(e.q)) ** int(e.p) if e.is_Rational and e.q < 64 else (exponent * base.log()).exp()


# -- series at a point -------------------------------------------------------


def free_symbols(modes: Modes) -> set[Symbol]:
    """The parameters of a series."""
    angles = {m for _, (q, phi), _ in modes for m, _ in (*q, *phi)}
    return symbols_of({m for _, _, m in modes} | angles)


class Point:
    """A time and parameter values in balls; remembers powers and angles while the precision lasts."""

    def __init__(self, time: Any, values: Mapping[Symbol, Any]) -> None:
        self.time = ball(time)
        self.values = values
        self.generators: dict[int, Any] = {}
        self.monomials: dict[Monomial, Any] = {}
        self.waves: dict[Any, Any] = {}

    def monomial(self, monomial: Monomial) -> Any:
        """The value of a monomial."""
        if monomial not in self.monomials:
            self.monomials[monomial] = math.prod((self._generator_power(g, e) for g, e in monomial), start=arb(1))
        return self.monomials[monomial]

    def _generator_power(self, number: int, exponent: Any) -> Any:
        if number not in self.generators:
            e = expression_of(number)
            if e is sympy.I:
                raise BadInputError("the value must be real, but the series contains I.  Evaluate its real and "
                                    "imaginary parts one by one; write a complex P as a real one of twice the size.")
            self.generators[number] = expression_ball(e, self.values)
        exact = sympy.Rational(exponent)
        return _power(self.generators[number], arb(rational(exact)), exact)

    def linear(self, form: Linear) -> Any:
        """The value of a linear combination."""
        return sum((self.monomial(m) * fmpq(c.numerator, c.denominator) for m, c in form), arb(0))

    def polynomial(self, terms: Polynomial) -> Any:
        """The value of a polynomial in the ring."""
        return sum((self.monomial(m) * c for m, c in terms.items()), arb(0))

    def wave(self, angle: Any) -> Any:
        """``exp(i (q t + phi))``."""
        if angle not in self.waves:
            alpha = self.linear(angle[0]) * self.time + self.linear(angle[1])
            self.waves[angle] = acb(alpha.cos(), alpha.sin())
        return self.waves[angle]

    def __call__(self, modes: Modes) -> Any:
        """The value of a series."""
        return self.total(prepared(modes))

    def total(self, series: Prepared) -> Any:
        """The value of a series that was prepared once for several precisions."""
        place = acb(0, -self.time)
        value = arb(0)
        for (kind, angle, monomial), f, scale in series:
            amplitude = acb_poly(f)(place) * scale if f.degree() > 0 else acb(arb(f[0] * scale))
            wave = self.wave(angle) * amplitude
            value += (wave.real if kind == COS else wave.imag) * self.monomial(monomial)
        return value


def prepared(modes: Modes) -> Prepared:
    """From the basis ``t**r / r!`` to powers, ``f = sum (L!/r!) n_r x**r / (L! d)``: integers, no gcd for each."""
    result = []
    for key, f in modes.items():
        row = _quotients(f.degree())
        numerators = fmpz_poly(list(map(operator.mul, f.numer().coeffs(), row)))
        result.append((key, numerators, fmpq(1, f.denom() * row[0])))
    return result


@lru_cache(maxsize=256)
def _quotients(top: int) -> list[Any]:
    """``L!/r!`` for r = 0 .. L."""
    found = [fmpz(1)]
    for r in range(top, 0, -1):
        found.append(found[-1] * r)
    return found[::-1]


# -- as many digits as asked for ---------------------------------------------


MOST_DIGITS = 10_000_000


def check_digits(digits: Any) -> int | None:
    """``None`` for float64, or a positive number of decimal digits."""
    return None if digits is None else count_of_digits(digits, "None or a positive integer", "None for float64")


def count_of_digits(digits: Any, kind: str = "a positive integer", least: str = "15") -> int:
    """A positive number of decimal digits, where float64 is none of the answers; refusals name what would do."""
    if isinstance(digits, bool) or not isinstance(digits, numbers.Integral):
        raise BadTypeError(f"digits must be {kind}, but it is {printed(digits)}.  Use digits=50, say.")
    if digits < 1:
        raise BadInputError(f"digits must be at least 1, but it is {printed(digits)}.  Use digits={least}.")
    if int(digits) > MOST_DIGITS:
        raise BadInputError(f"digits must be at most {MOST_DIGITS}, but it is {printed(digits)}.  Use fewer.")
    return int(digits)


def refine(compute: Callable[[], list[Any]], digits: int | None) -> list[Any]:
    """Balls as accurate as asked for: the precision grows until every relative radius is small enough.

    For float64, ``digits=None``, it also grows until a ball rounds to one float, unless ``EXTRA_BITS`` bits more do not
    tell on which side of the middle of two floats the value lies.  A value that they cannot tell from zero is returned
    as an exact zero.
    """
    needed = 56 if digits is None else libmp.dps_to_prec(digits) + 4
    precision = needed + 64
    while True:
        with working(precision):
            result = compute()
            if all(_accurate(x, needed) and (digits is not None or _is_one_float(x)) for x in result):
                return result
        if precision > needed + EXTRA_BITS:
            return [_settle(x, needed) for x in result]
        precision *= 2


def _accurate(x: Any, needed: int) -> bool:
    return bool(x == 0) or bool(x.is_finite() and x.rel_accuracy_bits() >= needed)


def _is_one_float(x: Any) -> bool:
    return bool(x.is_exact()) or _to_float(x.lower()) == _to_float(x.upper())


def _settle(x: Any, needed: int) -> Any:
    if _accurate(x, needed):
        return x
    if x.contains(0) and x.rad() < arb(2) ** -(needed + EXTRA_BITS // 2):
        return arb(0)
    if not x.is_finite():
        raise BadInputError(f"a value must be finite, but it is {x} here: a pole of the coefficients, or a resonance "
                            "of frequencies.  Keep away from there, or put these frequencies into P as numbers.")
    raise BadInputError(f"the digits asked for cannot be had: the value lies in {x}.  Give exact parameters instead of "
                        "balls with a radius, or ask for fewer digits.")


def to_number(x: Any, digits: int | None) -> Any:
    """The midpoint of a ball as float, or as mpf with the digits asked for."""
    if digits is None:
        return _to_float(x)
    mantissa, exponent = x.mid().man_exp()
    return mpmath.mp.make_mpf(libmp.from_man_exp(int(mantissa), int(exponent), libmp.dps_to_prec(digits), "n"))


def _to_float(x: Any) -> float:
    """The float nearest to the midpoint, rounded once from normal to denormal: Python's quotient of integers is."""
    mantissa, exponent = map(int, x.mid().man_exp())
    top = mantissa.bit_length() + exponent  # |x| < 2**top <= 2 |x|
    if top < -1074:
        return -0.0 if mantissa < 0 else 0.0
    try:
        if top <= 1024:
            return float(mantissa << exponent) if exponent >= 0 else mantissa / (1 << -exponent)
    except OverflowError:  # nearer to 2**1024 than to the largest float
        pass
    return -math.inf if mantissa < 0 else math.inf


def to_complex(z: Any, digits: int | None) -> Any:
    """The midpoint of a complex ball as complex, or as mpc with the digits asked for."""
    real, imag = to_number(z.real, digits), to_number(z.imag, digits)
    return complex(real, imag) if digits is None else mpmath.mp.make_mpc((real._mpf_, imag._mpf_))


def upper_float(x: Any) -> float:
    """The least float that is not below an exact ball; ``inf`` beyond all floats."""
    if not x.is_finite():
        return math.inf
    top = x.upper()
    found = _to_float(top)
    return found if arb(found) >= top else math.nextafter(found, math.inf)


def may_vanish(frequency: Linear, values: Mapping[Symbol, Any]) -> bool:
    """Whether a frequency is 0 at exact numbers, or may be in balls."""
    with working(256):
        return bool(Point(arb(0), values).linear(frequency).contains(0))


def check_time(time: Any, number: Callable[[Any, str], Any] = exact_number) -> Any:
    """The time as an exact number, or as what ``number`` makes of it."""
    if isinstance(time, Mapping):
        raise BadTypeError(f"the time must be a number, but it is {printed(time)}, a {type(time).__name__}.  Give it "
                           "before the values: evaluate(1, {a: 2}).")
    return number(time, "the time")


def evaluate(series: list[Modes], t: Symbol, time: Any, values: Values | None, digits: int | None) -> list[Any]:
    """The values of several series at one time and one set of parameters, as numbers.

    Raises
    ------
    MissingParameterError
        if a parameter that occurs has no value.
    """
    when = check_time(time)
    needed = set().union(*map(free_symbols, series)) if series else set()
    exact = exact_values(values, needed, t)
    digits = check_digits(digits)
    ready = list(map(prepared, series))

    def compute() -> list[Any]:
        point = Point(when, exact)
        return list(map(point.total, ready))

    return [to_number(x, digits) for x in refine(compute, digits)]
