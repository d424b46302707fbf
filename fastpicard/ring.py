r"""Parameters and exact numbers: Laurent polynomials ``Q[a, 1/a, b, 1/b, ...]``.

A *generator* is anything free of time that is not a rational number: a symbol,
``pi``, ``sqrt(2)``, ``sqrt(g/l)``, ``1/(b + c)``.  A *monomial* is a product of
generator powers, kept as sorted pairs ``(generator number, exponent)``; a
*polynomial* maps monomials to rational numbers.

Two kinds of generator obey a relation that multiplication applies at once:
primes under a root, ``2**(1/2) * 2**(1/2) = 2``, and ``I * I = -1``.  Products
of distinct fractional powers of primes are linearly independent over ``Q``
(Besicovitch), so with symbols and roots alone equal means identical.

Two other kinds obey relations that are applied when equality is asked for.
Cosines and sines of rational multiples of pi, and the roots among them, have a
normal form, see :mod:`fastpicard.cosines` and its ``normal``.  A root that is no
square root of a rational lies in none of those fields, which are abelian, and
(Kummer) stays independent.  Generators that are themselves sums, such as
``1/(b + c)``, are multiplied out.  SymPy is asked only for what then remains,
functions such as ``exp(a)``, and only if some value does not tell them apart;
what it cannot show to be zero is taken to be different from zero.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from functools import cache, lru_cache
from math import floor, gcd, lcm
from threading import Lock
from types import MappingProxyType
from typing import Any, TypeVar, cast

import sympy
from flint import fmpq
from sympy import Expr
from sympy.functions.elementary.trigonometric import TrigonometricFunction
from sympy.matrices.expressions.matexpr import MatrixElement

from fastpicard import cosines
from fastpicard.errors import BadInputError, NotInFamilyError

Exponent = int | Fraction
Monomial = tuple[tuple[int, Exponent], ...]
Polynomial = dict[Monomial, Any]  # Monomial -> fmpq
Terms = TypeVar("Terms", bound="dict[Any, Any]")

ONE: Monomial = ()

_expressions: list[Expr] = []
_numbers: dict[Expr, int] = {}
_related: set[int] = set()  # the generators with a relation: primes under a root, and I
_cosines: dict[int, tuple[Fraction, Fraction]] = {}  # (x, e) of the generators whose power e is cos(pi x)
_sums: dict[int, Polynomial] = {}  # what the generators are that are polynomials in others
_UNIT = fmpq(1)
_LOCK = Lock()
_TINY, _LARGE = 1e-12, 1e12
_LARGEST_DENOMINATOR = 10_000


def read_only(terms: Terms) -> Terms:
    """The same terms for others to read, who cannot change them."""
    return terms if isinstance(terms, MappingProxyType) else cast(Terms, MappingProxyType(terms))


def generator(expression: Expr) -> int:
    """The number of a generator; the same expression has the same number for good.  Raises NotInFamilyError."""
    number = _numbers.get(expression)
    return _numbered(expression) if number is None else number


def _numbered(expression: Expr) -> int:
    """A new number, which other threads see when all that belongs to it is known."""
    if expression.has(MatrixElement):
        raise NotInFamilyError(f"{expression} holds an entry of a matrix without entries, which SymPy cannot put "
                               "numbers into.  Use a Symbol in its place.")
    cosine = cosines.named_cosine(expression)
    with _LOCK:
        if expression not in _numbers:
            number = len(_expressions)
            _expressions.append(expression)
            if expression is sympy.I or expression.is_Integer:
                _related.add(number)
            if cosine is not None:
                _cosines[number] = cosine
            _numbers[expression] = number
        return _numbers[expression]


def expression_of(number: int) -> Expr:
    """The SymPy expression of generator ``number``."""
    return _expressions[number]


def rational(value: Any) -> Any:
    """An exact SymPy number as ``fmpq``; a Float is the dyadic rational it stands for."""
    if value.is_Rational:
        return fmpq(int(value.p), int(value.q))
    if not value.is_finite:
        raise BadInputError(f"every number must be finite, but {value} is not.  Give a finite value.")
    sign, mantissa, exponent, _ = value._mpf_
    mantissa = -int(mantissa) if sign else int(mantissa)
    return fmpq(mantissa << max(exponent, 0), 1 << max(-exponent, 0))


def fraction(value: Any) -> Exponent:
    """An ``fmpq`` or exact SymPy rational as ``int`` where it is whole, else ``Fraction``."""
    return _interned(int(value.p), int(value.q))


def ratio(value: Exponent) -> Exponent:
    """The number as ``int`` where it is whole, else as the one ``Fraction`` that stands for it in keys."""
    return value if type(value) is int else _interned(value.numerator, value.denominator)


@lru_cache(maxsize=1 << 12)
def _interned(p: int, q: int) -> Exponent:
    return p if q == 1 else _Hashed(p, q)


class _Hashed(Fraction):
    """A fraction that keeps its hash: in keys that is asked for all the time, and takes a modular inverse."""

    __slots__ = ("_hash",)
    _hash: int

    def __new__(cls, numerator: Any = 0, denominator: Any = None) -> _Hashed:
        self = super().__new__(cls, numerator, denominator)
        self._hash = Fraction.__hash__(self)
        return self

    def __hash__(self) -> int:  # type: ignore[override]  # typeshed knows none of Fraction
        return self._hash


def _normal(number: int, exponent: Exponent) -> tuple[Any, Exponent]:
    """Apply the generator's relation to one power: ``(rational factor, remaining exponent)``."""
    base = _expressions[number]
    whole, rest = divmod(exponent, 2 if base is sympy.I else 1)
    return (fmpq(-1) if base is sympy.I else fmpq(int(base))) ** int(whole), rest


@lru_cache(maxsize=1 << 16)
def multiply_monomials(left: Monomial, right: Monomial) -> tuple[Any, Monomial]:
    """The product of two monomials as ``(rational factor, monomial)``."""
    exponents = dict(left)
    for number, exponent in right:
        exponents[number] = exponents.get(number, 0) + exponent
    factor = _UNIT
    for number in exponents.keys() & _related:
        gained, exponents[number] = _normal(number, exponents[number])
        factor *= gained
    return factor, tuple(sorted((number, ratio(exponent)) for number, exponent in exponents.items() if exponent))


def power(base: Expr, exponent: Exponent, value: Polynomial | None = None) -> Polynomial:
    """``base**exponent`` for a generator base; ``value`` is the base where it is a polynomial in other generators."""
    if value:
        _sums[generator(base)] = value
    factor, monomial = multiply_monomials(ONE, ((generator(base), exponent),))
    return {monomial: factor}


def add_term(target: Polynomial, monomial: Monomial, value: Any) -> None:
    """Add ``value * monomial`` in place and drop what cancels."""
    total = target.get(monomial, 0) + value
    if total:
        target[monomial] = total
    else:
        target.pop(monomial, None)


def multiply(left: Polynomial, right: Polynomial) -> Polynomial:
    """The product of two polynomials."""
    product: Polynomial = {}
    for m, c in left.items():
        for n, d in right.items():
            factor, monomial = multiply_monomials(m, n)
            add_term(product, monomial, c * d * factor)
    return product


@cache
def radicand(number: int) -> Polynomial:
    """The sum that a generator is if it is made of roots of integers, ``5/8 - sqrt(5)/8``, or nothing; for good."""
    value = _sums.get(number, {})
    return value if all(_expressions[g].is_Integer or radicand(g) for monomial in value for g, _ in monomial) else {}


def without_powers_of_roots(monomial: Monomial) -> Polynomial:
    """``2**(1/2)`` to the power 2 is 2, and ``(5/8 - sqrt(5)/8)**(1/2)`` to the power 2 is ``5/8 - sqrt(5)/8``."""
    factor, rest = multiply_monomials(ONE, monomial)
    for g, e in rest:
        if e >= 1 and radicand(g):
            _, less = multiply_monomials(rest, ((g, -1),))
            result: Polynomial = {}
            for m, c in multiply({less: factor}, radicand(g)).items():
                for n, d in without_powers_of_roots(m).items():
                    add_term(result, n, c * d)
            return result
    return {rest: factor}


def reciprocal(terms: Polynomial) -> Polynomial:
    """``1 / terms``: a Laurent monomial where it can be, one new generator otherwise.

    Sums of square roots are rationalised, ``1/(1 + sqrt(2)) = sqrt(2) - 1``.  Of any other sum the integer multiple
    without common factor is the generator, with the sign that SymPy leaves in place.
    """
    if is_zero(terms):
        raise BadInputError("the reciprocal of 0 does not exist.  Check for a frequency that cancels.")
    if len(terms) == 1:
        ((monomial, value),) = terms.items()
        factor, inverse = multiply_monomials(ONE, tuple((g, -e) for g, e in monomial))
        return {inverse: factor / value}
    if has_square_roots_only(terms):
        return _conjugate_reciprocal(terms)
    content = fmpq(gcd(*(int(c.p) for c in terms.values())), lcm(*(int(c.q) for c in terms.values())))
    primitive = {m: c / content for m, c in terms.items()}
    if to_expression(primitive).could_extract_minus_sign():
        content, primitive = -content, {m: -c for m, c in primitive.items()}
    return {m: c / content for m, c in power(to_expression(primitive), -1, primitive).items()}


def has_square_roots_only(monomials: Iterable[Monomial]) -> bool:
    """Whether all generators that occur are square roots of primes."""
    return all(_expressions[g].is_Integer and 2 * e == 1 for monomial in monomials for g, e in monomial)


def _conjugate_reciprocal(terms: Polynomial) -> Polynomial:
    """``1/(u + v sqrt(p)) = (u - v sqrt(p)) / (u**2 - p v**2)``, one prime at a time."""
    primes = {g for monomial in terms for g, _ in monomial}
    if not primes:
        return {ONE: 1 / terms[ONE]}
    prime = max(primes)
    conjugate = {m: -c if any(g == prime for g, _ in m) else c for m, c in terms.items()}
    norm = multiply(terms, conjugate)
    return multiply(conjugate, _conjugate_reciprocal(norm))


def to_sympy_number(value: Any) -> Expr:
    """An ``fmpq`` as a SymPy Rational."""
    return sympy.Rational.from_coprime_ints(int(value.p), int(value.q))


@lru_cache(maxsize=1 << 14)
def monomial_expression(monomial: Monomial) -> Expr:
    """A monomial as SymPy writes it."""
    return sympy.Mul(*(_expressions[g] ** sympy.Rational(e) for g, e in monomial))


def to_expression(terms: Polynomial) -> Expr:
    """A polynomial as a SymPy expression."""
    return sympy.Add(*(to_sympy_number(c) * monomial_expression(m) for m, c in terms.items()))


def symbols_of(monomials: Iterable[Monomial]) -> set[Any]:
    """The free symbols of all generators that occur."""
    numbers = {g for monomial in monomials for g, _ in monomial}
    return set().union(*(_expressions[g].free_symbols for g in numbers))


# -- equality ------------------------------------------------------------------


def has_relations(monomials: Iterable[Monomial]) -> bool:
    """Whether a generator occurs that distinct monomials may relate (a cosine, a sum, a function of symbols)."""
    numbers = {g for monomial in monomials for g, _ in monomial}
    return not all(map(_is_free, numbers))


def _is_free(number: int) -> bool:
    e = _expressions[number]
    return bool(e.is_Symbol or e.is_Integer) or e in (sympy.pi, sympy.E, sympy.I)


def has_waves(monomials: Iterable[Monomial]) -> bool:
    """Whether a generator occurs that holds a sine, cosine or tangent, but for cosines of rational multiples of pi."""
    return any(_is_wave(g) for g in {g for monomial in monomials for g, _ in monomial})


@lru_cache(maxsize=1 << 12)
def _is_wave(number: int) -> bool:
    return number not in _cosines and _expressions[number].has(TrigonometricFunction)


def is_zero(terms: Polynomial) -> bool:
    """Whether a polynomial vanishes identically, relations between its generators included."""
    if not terms or not has_relations(terms):
        return not terms
    reduced = normal(_multiplied_out(terms))
    if all(_is_free(g) or _cosine_power(g, e)[1] == 0 for monomial in reduced for g, e in monomial):
        return not reduced
    return _is_zero_to_sympy(reduced)


def _multiplied_out(terms: Polynomial) -> Polynomial:
    """The polynomial times the denominators it has, without generators that are sums but for roots of them."""
    while True:
        sums = {g for monomial in terms for g, e in monomial if g in _sums and floor(e)}
        if not sums:
            return terms
        terms = _without_sum(terms, max(sums))


def _without_sum(terms: Polynomial, number: int) -> Polynomial:
    exponents = [dict(monomial).get(number, 0) for monomial in terms]
    lowest = min(map(floor, exponents))
    powers: list[Polynomial] = [{ONE: _UNIT}]
    result: Polynomial = {}
    for (monomial, value), exponent in zip(terms.items(), exponents, strict=True):
        while len(powers) <= floor(exponent) - lowest:
            powers.append(multiply(powers[-1], _sums[number]))
        _, rest = multiply_monomials(monomial, ((number, -floor(exponent)),))
        for m, c in multiply({rest: value}, powers[floor(exponent) - lowest]).items():
            add_term(result, m, c)
    return result


def rational_value(terms: Polynomial) -> Any | None:
    """The rational number (fmpq) that a polynomial always is, or None: read off one value, then proved."""
    if not terms or list(terms) == [ONE]:
        return terms.get(ONE, fmpq(0))
    if not has_relations(terms):
        return None
    value = _sample(terms)
    if value is None or abs(value) > _LARGE or abs(sympy.im(value)) > _TINY:
        return None
    near = Fraction(float(sympy.re(value))).limit_denominator(_LARGEST_DENOMINATOR)
    rest, found = dict(terms), fmpq(near.numerator, near.denominator)
    add_term(rest, ONE, -found)
    return found if is_zero(rest) else None


def _sample(terms: Polynomial) -> Expr | None:
    """The value where every symbol is some number that its assumptions allow; None where that is no finite number."""
    e = to_expression(terms)
    symbols = sorted(e.free_symbols, key=str)
    values = {x: (-1 if x.is_negative else 1) * sympy.Rational(sympy.prime(k), 1 if x.is_integer else 101)
              for k, x in enumerate(symbols, 5)}
    try:
        value = e.subs(values).evalf(20, strict=True)
    except ArithmeticError:  # it overflows, or cancels beyond all digits
        return None
    return value if value.is_number and value.is_finite else None


def normal(terms: Polynomial) -> Polynomial:
    """The same number, with the cosines of rational multiples of pi in normal form."""
    result: Polynomial = {}
    for monomial, value in terms.items():
        for m, c in _normal_monomial(monomial).items():
            add_term(result, m, value * c)
    return result


@lru_cache(maxsize=1 << 14)
def _normal_monomial(monomial: Monomial) -> Polynomial:
    """Its cosines, and the square roots of primes in their fields, are multiplied by product to sum."""
    angles = [_cosines[g][0] for g, _ in monomial if g in _cosines]
    if not angles:
        return {monomial: _UNIT}
    rest: list[tuple[int, Exponent]] = []
    number: cosines.Cosines = {Fraction(0): _UNIT}
    for g, e in monomial:
        if g in _cosines:
            whole, left = _cosine_power(g, e)
            number = cosines.product(number, cosines.power(_cosines[g][0], whole))
        elif 2 * e >= 1 and _expressions[g].is_Integer and _divides(int(_expressions[g]), angles):
            number, left = cosines.product(number, cosines.root(int(_expressions[g]))), e - Fraction(1, 2)
        else:
            left = e
        if left:
            rest.append((g, ratio(left)))
    result: Polynomial = {}
    for parts, c in cosines.normal(number).items():
        factor, m = multiply_monomials(tuple(rest), _monomial_of(parts))
        add_term(result, m, c * factor)
    return result


def _divides(prime: int, angles: list[Fraction]) -> bool:
    return any(x.denominator % prime == 0 for x in angles)


def _cosine_power(number: int, exponent: Exponent) -> tuple[int, Exponent]:
    """``(whole, left)``: the generator's power is the cosine's power ``whole`` times the generator's ``left``."""
    if number not in _cosines:
        return 0, exponent
    own = _cosines[number][1]
    whole = floor(exponent / own)
    return whole, exponent - whole * own


def _monomial_of(parts: tuple[Any, ...]) -> Monomial:
    powers = [cosines.expression_of(part).as_base_exp() for part in parts]
    return tuple(sorted((generator(base), fraction(exponent)) for base, exponent in powers))


def _constants_vanish(terms: Polynomial) -> bool:
    """Whether the constants before every product of functions of symbols cancel, which suffices."""
    groups: dict[Monomial, Polynomial] = {}
    for monomial, c in terms.items():
        variable = tuple(x for x in monomial if expression_of(x[0]).free_symbols)
        groups.setdefault(variable, {})[tuple(x for x in monomial if x not in variable)] = c
    return list(groups) != [ONE] and all(bool(to_expression(p).equals(0)) for p in groups.values())


def _is_zero_to_sympy(terms: Polynomial) -> bool:
    """Whether SymPy can show that functions of symbols cancel; what it cannot decide is not zero."""
    value = _sample(terms)
    if value is not None and abs(value) > _TINY:
        return False
    if _constants_vanish(terms):
        return True
    numerator = sympy.fraction(sympy.together(to_expression(terms)))[0].expand()
    if numerator == 0:
        return True
    symbols = sorted(numerator.free_symbols, key=str)
    if symbols and not numerator.is_polynomial(*symbols):
        in_exponentials = sympy.fraction(sympy.together(numerator.rewrite(sympy.exp)))[0]
        return any(form.expand() == 0 for form in (sympy.radsimp(numerator), in_exponentials))
    coefficients = sympy.Poly(numerator, *symbols, domain="EX").coeffs() if symbols else [numerator]
    return all(bool(c.equals(0)) for c in coefficients)
