r"""``x' = P x`` in integers: the coordinates in which monomials and angles are numbers.

Exponent vectors of monomials and integer combinations of angles are packed into
single integers, so that multiplying monomials or adding angles is one addition.
One direction of the exponent lattice is kept apart as *blocks*, see
:mod:`fastpicard.increments`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import gcd, lcm
from typing import Any

from flint import fmpq

from fastpicard.modes import COS, Angle, Modes, common_unit
from fastpicard.ring import ONE, Monomial, multiply_monomials

FIELD = 32  # bits of one packed exponent or angle index
Term = tuple[int, int, int, Any, int]  # kind, angle, monomial, coefficient, blocks to shift


def pack(indices: Sequence[int]) -> int:
    """A vector of integers as one integer; adding vectors is adding integers."""
    return sum(index << (FIELD * place) for place, index in enumerate(indices))


def unpack(packed: int, length: int) -> list[int]:
    """The inverse of :func:`pack`."""
    indices = []
    for _ in range(length):
        index = packed & ((1 << FIELD) - 1)
        index -= (index >> (FIELD - 1)) << FIELD
        indices.append(index)
        packed = (packed - index) >> FIELD
    return indices


@dataclass(frozen=True)
class Coordinates:
    """How monomials and angles of a problem become integers.

    Attributes
    ----------
    unit : (Monomial, fmpq)          the unit of frequency, ``w = unit[1] * unit[0]``
    phases : (Monomial, denominator)  each phase is an integer combination of ``monomial / denominator``
    generators : (number, denominator)  each exponent is a multiple of ``1 / denominator``
    pivot, direction                 exponent vectors are ``e = rest + e[pivot] * direction``
    """

    unit: tuple[Monomial, Any]
    phases: tuple[tuple[Monomial, int], ...]
    generators: tuple[tuple[int, int], ...]
    pivot: int | None
    direction: tuple[int, ...]

    def exponents(self, monomial: Monomial) -> tuple[int, ...]:
        """The exponent vector of a monomial."""
        table = dict(monomial)
        return tuple(int(table.get(g, 0) * d) for g, d in self.generators)

    def pack_monomial(self, monomial: Monomial) -> tuple[int, int]:
        """A monomial as (packed rest, number of blocks to shift)."""
        e = self.exponents(monomial)
        if self.pivot is None:
            return pack(e), 0
        s = e[self.pivot]
        return pack([x - s * v for x, v in zip(e, self.direction, strict=True)]), s

    def monomial(self, packed: int, block: int) -> Monomial:
        """The monomial at one block of a packed row."""
        e = unpack(packed, len(self.generators))
        if self.pivot is not None:
            e = [x + block * v for x, v in zip(e, self.direction, strict=True)]
        return tuple((g, _quotient(x, d)) for (g, d), x in zip(self.generators, e, strict=True) if x)

    def pack_angle(self, angle: Angle) -> int:
        """An angle as one integer, the frequency in the highest field."""
        frequency = dict(angle[0]).get(self.unit[0], 0)
        table = dict(angle[1])
        q = fmpq(frequency.numerator, frequency.denominator) / self.unit[1]
        return pack([*(int(table.get(m, 0) * d) for m, d in self.phases), int(q.p)])

    def angle(self, packed: int) -> Angle:
        """The inverse of :meth:`pack_angle`."""
        *indices, q = unpack(packed, len(self.phases) + 1)
        phase = tuple((m, _quotient(x, d)) for (m, d), x in zip(self.phases, indices, strict=True) if x)
        rate = self.unit[1] * q
        return (((self.unit[0], _quotient(int(rate.p), int(rate.q))),) if q else ()), phase

    def frequency(self, packed: int) -> int:
        """The integer frequency of a packed angle."""
        return unpack(packed, len(self.phases) + 1)[-1] if self.phases else packed

    def without_frequency(self, packed: int) -> int:
        """The packed angle whose frequency is put to zero."""
        return packed - (self.frequency(packed) << (FIELD * len(self.phases)))




def _quotient(x: int, d: int) -> Any:
    return x // d if x % d == 0 else Fraction(x, d)


@dataclass(frozen=True)
class Problem:
    """``x' = P x`` with the columns ``x(0)``, all in integers.

    Attributes
    ----------
    rows : (factor, ((j, (Term, ...)), ...))   row i of ``P / w`` times ``factor``, where not zero;
                                     products to sums leave the coefficients integers
    start : columns of (Term, ...)   the entries of ``x(0)``, times ``start_denominator``
    """

    coordinates: Coordinates
    rows: tuple[tuple[Any, tuple[tuple[int, tuple[Term, ...]], ...]], ...]
    start_denominator: int
    start: tuple[tuple[tuple[Term, ...], ...], ...]


# -- setting up --------------------------------------------------------------


def problem(matrix: Sequence[Sequence[Modes]], start: Sequence[Sequence[Modes]]) -> Problem | None:
    """``P`` and the columns ``x(0)`` in integers, or None where the frequencies have no common unit."""
    entries = [modes for row in matrix for modes in row]
    constants = [modes for column in start for modes in column]
    coordinates = _coordinates(entries, constants)
    if coordinates is None:
        return None
    gained, per_unit = multiply_monomials(ONE, tuple((g, -e) for g, e in coordinates.unit[0]))
    factor = gained / coordinates.unit[1]
    rows = tuple(_row([_terms(modes, coordinates, per_unit, factor) for modes in row]) for row in matrix)
    start_denominator = lcm(1, *(int(f[0].q) for modes in constants for f in modes.values()))
    columns = tuple(tuple(tuple(_integer(term, fmpq(start_denominator)) for term in _terms(modes, coordinates, ONE, 1))
                          for modes in column) for column in start)
    return Problem(coordinates, rows, start_denominator, columns)


def _row(entries: list[tuple[Term, ...]]) -> tuple[Any, tuple[tuple[int, tuple[Term, ...]], ...]]:
    """A row of ``P / w`` times the factor that makes it primitive: (factor, nonzero entries).

    A product to sum halves the coefficient, so terms with an angle count half;
    the sign is that of the last term, which saves a negation for most problems.
    """
    halved = [tuple((kind, k, m, c / 2 if k else c, blocks) for kind, k, m, c, blocks in terms) for terms in entries]
    values = [c for terms in halved for *_, c, _ in terms]
    if not values:
        return fmpq(1), ()
    factor = fmpq(lcm(*(int(c.q) for c in values)), gcd(*(int(c.p) for c in values)))
    factor *= -1 if values[-1] < 0 else 1
    entries_left = ((j, terms) for j, terms in enumerate(halved) if terms)
    return factor, tuple((j, tuple(_integer(term, factor) for term in terms)) for j, terms in entries_left)


def _integer(term: Term, factor: Any) -> Term:
    kind, k, m, c, blocks = term
    return kind, k, m, int((c * factor).p), blocks


def _terms(modes: Modes, coordinates: Coordinates, unit: Monomial, factor: Any) -> tuple[Term, ...]:
    terms = []
    for (kind, angle, monomial), f in modes.items():
        packed, blocks = coordinates.pack_monomial(_join(monomial, unit))
        index = coordinates.pack_angle(angle)
        sign = -1 if index < 0 and kind != COS else 1
        terms.append((kind, abs(index), packed, f[0] * factor * sign, blocks))
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
    used = {g for _, _, m in every for g, _ in m} | {g for g, _ in unit[0]}
    inverse = tuple((g, -e) for g, e in unit[0])
    monomials = [_join(m, inverse) for modes in entries for _, _, m in modes]
    initial = [m for modes in constants for _, _, m in modes]
    generators = tuple((g, lcm(*(_denominator(m, g) for m in [*monomials, *initial, unit[0]]))) for g in sorted(used))
    plain = Coordinates(unit, _phases(every), generators, None, ())
    pivot, direction = _direction([plain.exponents(m) for m in monomials], [plain.exponents(m) for m in initial])
    return Coordinates(unit, plain.phases, generators, pivot, direction)


def _denominator(monomial: Monomial, g: int) -> int:
    return dict(monomial).get(g, 0).denominator


def _phases(keys: list[Any]) -> tuple[tuple[Monomial, int], ...]:
    denominators: dict[Monomial, int] = {}
    for _, (_, phase), _ in keys:
        for m, c in phase:
            denominators[m] = lcm(denominators.get(m, 1), c.denominator)
    return tuple(sorted(denominators.items()))


def _direction(monomials: list[tuple[int, ...]], initial: list[tuple[int, ...]]) -> tuple[int | None, tuple[int, ...]]:
    """A direction of the exponent lattice along which products of the monomials spread."""
    distinct = list(dict.fromkeys(e for e in monomials if any(e)))
    if not distinct:
        return None, ()
    origin = distinct[1] if len(distinct) > 1 else tuple(0 for _ in distinct[0])
    step = [x - y for x, y in zip(distinct[0], origin, strict=True)]
    for pivot, size in enumerate(step):
        if abs(size) == 1 and all(e[pivot] >= 0 for e in [*monomials, *initial]):
            return pivot, tuple(size * x for x in step)
    return None, ()
