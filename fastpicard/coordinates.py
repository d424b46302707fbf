r"""``x' = P x`` packed: the coordinates in which monomials and angles are integers.

All frequencies of ``P`` are whole multiples of one unit ``w``; time is measured as
``s = w t``.  Exponent vectors of monomials and integer combinations of angles are
packed into single integers, so that multiplying monomials or adding angles is one
addition.  Powers of roots of numbers are multiplied out as they arise, ``sqrt(5)**2 = 5``:
otherwise as many monomials as powers would stand for the few numbers that span their field.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import Any

from flint import fmpq
from sympy import I

from fastpicard.modes import COS, Angle, Modes, common_unit, orient
from fastpicard.ring import ONE, Monomial, expression_of, multiply_monomials, radicand, without_powers_of_roots

FIELD = 32  # bits of one packed exponent or angle index, unless those of P are large themselves
GROWTH = 24  # bits that are left to each: an index grows by at most its largest in P from one increment to the next
Term = tuple[int, int, int, Any]  # kind, angle, monomial, coefficient (fmpq)
Row = tuple[tuple[int, tuple[Term, ...]], ...]  # (column, terms) of a row of P


def pack(indices: Sequence[int], field: int) -> int:
    """A vector of integers as one integer; adding vectors is adding integers."""
    return sum(index << (field * place) for place, index in enumerate(indices))


def unpack(packed: int, length: int, field: int) -> list[int]:
    """The inverse of :func:`pack`."""
    indices = []
    for _ in range(length):
        index = packed & ((1 << field) - 1)
        index -= (index >> (field - 1)) << field
        indices.append(index)
        packed = (packed - index) >> field
    return indices


@dataclass(frozen=True)
class Coordinates:
    """How monomials and angles of a problem become integers, and back.

    Attributes
    ----------
    unit : (Monomial, fmpq)          the unit of frequency, ``w = unit[1] * unit[0]``
    phases : (Monomial, denominator)  each phase is an integer combination of ``monomial / denominator``
    generators : (number, denominator)  each exponent is a multiple of ``1 / denominator``
    field : bits of one index: a float as a phase or a frequency, 0.1, makes indices of 55 bits
    """

    unit: tuple[Monomial, Any]
    phases: tuple[tuple[Monomial, int], ...]
    generators: tuple[tuple[int, int], ...]
    field: int = FIELD

    def exponents(self, monomial: Monomial) -> list[int]:
        """A monomial as integers, one for each generator."""
        table = dict(monomial)
        return [int(table.get(g, 0) * d) for g, d in self.generators]

    def indices(self, angle: Angle) -> list[int]:
        """An angle as integers, one for each phase, and the frequency."""
        frequency = dict(angle[0]).get(self.unit[0], 0)
        table = dict(angle[1])
        q = fmpq(frequency.numerator, frequency.denominator) / self.unit[1]
        return [*(int(table.get(m, 0) * d) for m, d in self.phases), int(q.p)]

    def pack_monomial(self, monomial: Monomial) -> int:
        """A monomial as one integer."""
        return pack(self.exponents(monomial), self.field)

    def monomial(self, packed: int) -> Monomial:
        """The inverse of :meth:`pack_monomial`; relations such as ``sqrt(2)**2 = 2`` are not applied."""
        e = unpack(packed, len(self.generators), self.field)
        return tuple((g, _quotient(x, d)) for (g, d), x in zip(self.generators, e, strict=True) if x)

    def pack_angle(self, angle: Angle) -> int:
        """An angle as one integer, the frequency in the highest field."""
        return pack(self.indices(angle), self.field)

    def angle(self, packed: int) -> Angle:
        """The inverse of :meth:`pack_angle`."""
        *indices, q = unpack(packed, len(self.phases) + 1, self.field)
        phase = tuple((m, _quotient(x, d)) for (m, d), x in zip(self.phases, indices, strict=True) if x)
        rate = self.unit[1] * q
        return (((self.unit[0], _quotient(int(rate.p), int(rate.q))),) if q else ()), phase

    def frequency(self, packed: int) -> int:
        """The integer frequency of a packed angle."""
        return unpack(packed, len(self.phases) + 1, self.field)[-1] if self.phases else packed

    def without_frequency(self, packed: int) -> int:
        """The packed angle whose frequency is put to zero."""
        return packed - (self.frequency(packed) << (self.field * len(self.phases)))


def _quotient(x: int, d: int) -> Any:
    return x // d if x % d == 0 else Fraction(x, d)


@dataclass(frozen=True)
class Problem:
    """``x' = P x`` with the columns ``x(0)``, packed.

    Attributes
    ----------
    rows : ((j, (Term, ...)), ...) for each row     the nonzero entries of ``P / w``; the coefficients of sines and
                                                  cosines are halved, as products to sums need them
    start : columns of (Term, ...)                the entries of ``x(0)``
    """

    coordinates: Coordinates
    rows: tuple[Row, ...]
    start: tuple[tuple[tuple[Term, ...], ...], ...]

    def monomial(self, packed: int) -> tuple[Any, Monomial]:
        """A packed monomial as a number times a monomial: relations such as ``sqrt(2)**2 = 2`` are applied."""
        found = self._monomials.get(packed)
        if found is None:
            found = self._monomials[packed] = multiply_monomials(ONE, self.coordinates.monomial(packed))
        return found

    def product(self, left: int, right: int) -> tuple[tuple[int, Any], ...]:
        """The product of packed monomials as pairs (packed monomial, number): powers of roots are multiplied out."""
        packed = left + right
        if not self._has_roots:
            return ((packed, 1),)
        found = self._products.get(packed)
        if found is None:
            terms = without_powers_of_roots(self.coordinates.monomial(packed))
            found = tuple((self.coordinates.pack_monomial(m), c) for m, c in terms.items())
            self._products[packed] = found
        return found

    def angle(self, packed: int) -> tuple[bool, Angle]:
        """A packed angle as :func:`fastpicard.modes.orient` gives it."""
        found = self._angles.get(packed)
        if found is None:
            found = self._angles[packed] = orient(self.coordinates.angle(packed))
        return found

    @cached_property
    def _monomials(self) -> dict[int, tuple[Any, Monomial]]:
        return {}

    @cached_property
    def _has_roots(self) -> bool:
        return any(d > 1 or expression_of(g) is I for g, d in self.coordinates.generators)

    @cached_property
    def _products(self) -> dict[int, tuple[tuple[int, Any], ...]]:
        return {}

    @cached_property
    def _angles(self) -> dict[int, tuple[bool, Angle]]:
        return {}


# -- setting up --------------------------------------------------------------


def problem(matrix: Sequence[Sequence[Modes]], start: Sequence[Sequence[Modes]]) -> Problem | None:
    """``P`` and the columns ``x(0)`` packed, or None where the frequencies have no common unit."""
    entries = [modes for row in matrix for modes in row]
    constants = [modes for column in start for modes in column]
    coordinates = _coordinates(entries, constants)
    if coordinates is None:
        return None
    gained, per_unit = multiply_monomials(ONE, tuple((g, -e) for g, e in coordinates.unit[0]))
    factor = gained / coordinates.unit[1]
    rows = tuple(tuple((j, tuple(_halved(term) for term in _terms(modes, coordinates, per_unit, factor)))
                       for j, modes in enumerate(row) if modes) for row in matrix)
    return Problem(coordinates, rows, tuple(tuple(_terms(modes, coordinates, ONE, 1) for modes in column)
                                            for column in start))


def _halved(term: Term) -> Term:
    kind, angle, monomial, c = term
    return kind, angle, monomial, c / 2 if angle or kind != COS else c


def _terms(modes: Modes, coordinates: Coordinates, unit: Monomial, factor: Any) -> tuple[Term, ...]:
    terms = []
    for (kind, angle, monomial), f in modes.items():
        packed = coordinates.pack_monomial(_join(monomial, unit))
        index = coordinates.pack_angle(angle)
        sign = -1 if index < 0 and kind != COS else 1
        terms.append((kind, abs(index), packed, f[0] * factor * sign))
    return tuple(terms)


def _join(left: Monomial, right: Monomial) -> Monomial:
    """The product of two monomials with no relation applied."""
    exponents = dict(left)
    for g, e in right:
        exponents[g] = exponents.get(g, 0) + e
    return tuple(sorted((g, e) for g, e in exponents.items() if e))


def _coordinates(entries: list[Modes], constants: list[Modes]) -> Coordinates | None:
    every = [key for modes in entries + constants for key in modes]
    if any(f.degree() > 0 for modes in entries + constants for f in modes.values()):
        return None
    frequencies = {angle[0] for _, angle, _ in every if angle[0]}
    unit = common_unit(frequencies)
    if unit is None:
        return None
    inverse = tuple((g, -e) for g, e in unit[0])
    monomials = _with_radicands([_join(m, inverse) for modes in entries for _, _, m in modes]
                                + [m for modes in constants for _, _, m in modes] + [unit[0]])
    used = {g for m in monomials for g, _ in m}
    generators = tuple((g, lcm(*(_denominator(m, g) for m in monomials))) for g in sorted(used))
    narrow = Coordinates(unit, _phases(every), generators)
    indices = [k for _, angle, _ in every for k in narrow.indices(angle)]
    indices += [e for m in monomials for e in narrow.exponents(m)]
    largest = max(map(abs, indices), default=0)
    return replace(narrow, field=max(FIELD, largest.bit_length() + GROWTH))


def _with_radicands(monomials: list[Monomial]) -> list[Monomial]:
    """Also the monomials under their roots, and those under the roots of these."""
    found = dict.fromkeys(monomials)
    while under := {m for n in found for g, _ in n for m in radicand(g)} - found.keys():
        found |= dict.fromkeys(under)
    return list(found)


def _denominator(monomial: Monomial, g: int) -> int:
    return dict(monomial).get(g, 0).denominator


def _phases(keys: list[Any]) -> tuple[tuple[Monomial, int], ...]:
    denominators: dict[Monomial, int] = {}
    for _, (_, phase), _ in keys:
        for m, c in phase:
            denominators[m] = lcm(denominators.get(m, 1), c.denominator)
    return tuple(sorted(denominators.items()))
