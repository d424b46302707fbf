r"""The increments of Picard iteration in whole numbers.

    Phi_n = I_0 + I_1 + ... + I_n,   I_{k+1}(t) = integral of P I_k from 0 to t

so only the newest increment is ever multiplied and integrated.  Three choices
leave nothing but additions of integers and multiplications by small ones.

*Time.*  All frequencies of ``P`` are whole multiples of one unit ``w``; time is
measured as ``s = w t``, which makes them integers ``q``.

*No fractions.*  Let ``N`` be a common multiple of the frequencies that occur.  In
the basis of :mod:`fastpicard.modes` the coefficient of ``s**r / r!`` in ``I_m``,
times ``N**(m - r)`` and times one factor 2 and one common denominator of a row
of ``P`` for every product, is an integer, and integration ``q G_r = f_r + G_{r+1}``
becomes ``G_r = (N/q) (f_r + G_{r+1})``.

*Kronecker substitution.*  One direction of the exponent lattice, such as
``a/b`` for Mathieu's equation, is evaluated at a power of two so large that the
coefficients, each a block of bits, never touch.  A whole row of monomials is
then a single integer, and ``bits`` is proved large enough beforehand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate
from math import gcd, lcm
from typing import Any

from flint import fmpq, fmpq_poly, fmpz

from fastpicard.modes import COS, Angle, Modes, add_reflected, common_unit, orient
from fastpicard.ring import ONE, Monomial, multiply_monomials

FIELD = 32  # bits of one packed exponent or angle index
Row = list[Any]  # fmpz coefficients of s**r / r!, r = 0, 1, ...
Packed = dict[tuple[int, int, int], Row]  # (kind, angle, monomial) -> Row
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


@dataclass(frozen=True)
class Level:
    """The increment ``I_m``: row ``r`` of entry ``i``, over ``scale[i] * base**(m - r)``, multiplies ``s**r / r!``."""

    order: int
    columns: tuple[tuple[Packed, ...], ...]
    scale: tuple[Any, ...]
    base: int
    bits: int


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
    return factor, tuple((j, tuple(_integer(term, factor) for term in terms)) for j, terms in enumerate(halved) if terms)


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


# -- planning: a common multiple of the frequencies, a width for the blocks ---


def common_multiple(p: Problem, n: int) -> int:
    """The least common multiple of all frequencies met in ``I_0 .. I_n``."""
    frequency = p.coordinates.frequency
    moves = [(i, j, sorted({frequency(k) for _, k, *_ in terms})) for i, (_, row) in enumerate(p.rows) for j, terms in row]
    reached = {q for column in p.start for terms in column for _, k, *_ in terms for q in (frequency(k),)}
    now = [{0} | reached if any(column[i] for column in p.start) else set() for i in range(len(p.rows))]
    met: set[int] = {1}
    for _ in range(n):
        after: list[set[int]] = [set() for _ in p.rows]
        for i, j, steps in moves:
            after[i].update(abs(q + s * k) for q in now[j] for k in steps for s in (1, -1))
        now = [{0} | qs if qs else qs for qs in after]
        met.update(*now)
    return lcm(*(q for q in met if q))


def block_bits(p: Problem, n: int, base: int) -> int:
    """Bits enough for every coefficient of ``I_0 .. I_n`` with its sign.

    A majorant: absolute values everywhere, every frequency 1, all angles and
    monomials lumped together.  It obeys the same recursion on ``n`` numbers.
    """
    now = [[max((sum(abs(c) for *_, c, _ in column[i]) for column in p.start), default=0)] for i in range(len(p.rows))]
    scale = _first_scale(p)
    largest = max(row[0] for row in now) + 1
    for _ in range(n):
        product = [[0] * len(now[0]) for _ in now]
        for i, (_, row) in enumerate(p.rows):
            for j, terms in row:
                weight = _multiplier(p, scale, i, j) * sum((2 if k else 1) * abs(c) for _, k, _, c, _ in terms)
                product[i] = [x + weight * y for x, y in zip(product[i], now[j], strict=True)]
        scale = _next_scale(p, scale)
        now = [_majorant(entry) for entry in product]
        largest = max(largest, *(max(entry) for entry in now))
    return -(-((largest * base**n).bit_length() + 2) // 8) * 8


def _first_scale(p: Problem) -> tuple[Any, ...]:
    return tuple(fmpq(p.start_denominator) for _ in p.rows)


def _common(scale: tuple[Any, ...], row: tuple[tuple[int, tuple[Term, ...]], ...]) -> Any:
    """The least common multiple of the scales of all entries a row reads, with the sign of the first."""
    values = [scale[j] for j, _ in row] or [fmpq(1)]
    return fmpq(lcm(*(int(v.p) for v in values)), gcd(*(int(v.q) for v in values))) * (-1 if values[0] < 0 else 1)


def _next_scale(p: Problem, scale: tuple[Any, ...]) -> tuple[Any, ...]:
    return tuple(factor * _common(scale, row) for factor, row in p.rows)


def _multiplier(p: Problem, scale: tuple[Any, ...], i: int, j: int) -> int:
    """What brings entry ``j`` to the scale at which row ``i`` is summed."""
    return int((_common(scale, p.rows[i][1]) / scale[j]).p)


def _majorant(row: list[int]) -> list[int]:
    """Suffix sums (q = 1), the shift (q = 0) and the constant that makes the value at 0 vanish."""
    suffix = list(accumulate(reversed(row)))[::-1]
    return [2 * suffix[0], *(x + y for x, y in zip(suffix[1:], row, strict=False)), row[-1]]


# -- the iteration -----------------------------------------------------------


def first_level(p: Problem, base: int, bits: int) -> Level:
    """``I_0``: the columns ``x(0)``."""
    columns = tuple(tuple(_initial(terms, bits) for terms in column) for column in p.start)
    return Level(0, columns, _first_scale(p), base, bits)


def _initial(terms: tuple[Term, ...], bits: int) -> Packed:
    packed: Packed = {}
    for kind, angle, monomial, c, blocks in terms:
        _add(packed, (kind, angle, monomial), [fmpz(c << (bits * blocks))])
    return packed


def next_level(p: Problem, level: Level) -> Level:
    """``I_{m+1}``, the integral of ``P I_m``."""
    multiples = _Multiples(p.coordinates, level.base)
    rows = tuple(tuple((j, tuple(_factor(term, _multiplier(p, level.scale, i, j), level.bits) for term in terms))
                       for j, terms in row) for i, (_, row) in enumerate(p.rows))
    columns = tuple(tuple(_integral(_product(row, column), multiples) for row in rows) for column in level.columns)
    return Level(level.order + 1, columns, _next_scale(p, level.scale), level.base, level.bits)


Factor = tuple[int, int, int, Any, int]  # kind, angle, monomial, odd coefficient, bits to shift


def _factor(term: Term, multiplier: int, bits: int) -> Factor:
    """A term with its powers of two turned into a shift."""
    kind, k, m, c, blocks = term
    c *= multiplier
    twos = (c & -c).bit_length() - 1
    return kind, k, m, fmpz(c >> twos), bits * blocks + twos


def _product(row: tuple[tuple[int, tuple[Factor, ...]], ...], column: tuple[Packed, ...]) -> Packed:
    """One row of ``P`` times one column, with the denominator cleared."""
    product: Packed = {}
    for j, factors in row:
        for factor in factors:
            if factor[1] or factor[0] != COS:
                _multiply_wave(product, factor, column[j])
            else:
                _multiply_constant(product, factor, column[j])
    return product


def _multiply_constant(target: Packed, factor: Factor, source: Packed) -> None:
    _, _, monomial, c, shift = factor
    for (kind, angle, m), row in source.items():
        _add(target, (kind, angle, m + monomial), _times(row, c, shift))


def _multiply_wave(target: Packed, factor: Factor, source: Packed) -> None:
    """Add twice ``factor * source``: product to sum of [Neves], section 4."""
    other, k, monomial, c, shift = factor
    for (kind, angle, m), row in source.items():
        outer = inner = _times(row, c, shift)
        result = (kind + other) % 2
        if other != COS:
            outer, inner = (inner, _negative(inner)) if kind == COS else (_negative(inner), inner)
        _add(target, (result, angle + k, m + monomial), outer)
        difference = angle - k
        if difference < 0:
            difference, inner = -difference, _reflected(inner, result)
        _add(target, (result, difference, m + monomial), inner)


def _times(row: Row, c: Any, shift: int) -> Row:
    if c != 1:
        row = _negative(row) if c == -1 else [c * x for x in row]
    return [x << shift for x in row] if shift else row


def _negative(row: Row) -> Row:
    return [-x for x in row]


def _reflected(row: Row, kind: int) -> Row:
    """``c_r(-x) = (-1)**r c_r(x)``, ``s_r(-x) = -(-1)**r s_r(x)``."""
    return [-x if (r + kind) % 2 else x for r, x in enumerate(row)]


def _add(target: Packed, key: tuple[int, int, int], row: Row) -> None:
    old = target.get(key)
    if old is not None:
        if len(old) < len(row):
            old, row = row, old
        row = [x + y for x, y in zip(old, row, strict=False)] + old[len(row):]
    target[key] = row


class _Multiples:
    """``N / q`` for the packed angles of one problem."""

    def __init__(self, coordinates: Coordinates, base: int) -> None:
        self.coordinates, self.base = coordinates, base
        self.known: dict[int, tuple[Any, int]] = {}

    def of(self, angle: int) -> tuple[Any, int]:
        """``(N / q, the angle at time 0)``; 0 stands for ``1 / 0``."""
        found = self.known.get(angle)
        if found is None:
            q = self.coordinates.frequency(angle)
            start = self.coordinates.without_frequency(angle)
            found = self.known[angle] = (fmpz(self.base // q) if q else 0, start)
        return found


def _integral(product: Packed, multiples: _Multiples) -> Packed:
    """The antiderivative that is zero at 0, row by row."""
    result: Packed = {}
    for (kind, angle, m), row in product.items():
        multiple, start = multiples.of(angle)
        if angle == 0:
            row = [fmpz(0) if (r + kind) % 2 else x for r, x in enumerate(row)]
        if not any(row):
            continue
        row = _recurrence(row, multiple, kind) if multiple else [fmpz(0), *(row if kind != COS else _negative(row))]
        _add(result, (1 - kind, angle, m), row)
        if multiple and (start or kind != COS):
            constant = [-row[0]]
            if start < 0:
                start, constant = -start, _reflected(constant, 1 - kind)
            _add(result, (1 - kind, start, m), constant)
    return result


def _recurrence(row: Row, multiple: Any, kind: int) -> Row:
    """``G_r = (N/q) (f_r + G_{r+1})`` from the highest power down; ``-G`` for a sine series."""
    g, result = fmpz(0), []
    if kind == COS:
        for x in reversed(row):
            g = multiple * (g + x)
            result.append(g)
    else:
        for x in reversed(row):
            g = multiple * (g - x)
            result.append(g)
    result.reverse()
    return result


# -- reading blocks ----------------------------------------------------------


class Blocks:
    """Cuts packed integers into their signed blocks, lowest first, by halving."""

    def __init__(self, bits: int) -> None:
        self.bits = bits
        self.half = fmpz(1) << (bits - 1)
        self.bias = [fmpz(0)]
        self.mask = [fmpz(0)]

    def of(self, value: Any) -> Row:
        """The blocks of one packed integer; every block is smaller than ``2**(bits - 1)``."""
        if not value:
            return []
        count = abs(value).bit_length() // self.bits + 1
        while len(self.bias) <= count:
            self.bias.append((self.bias[-1] << self.bits) + self.half)
            self.mask.append((fmpz(1) << (self.bits * len(self.mask))) - 1)
        blocks: Row = []
        self._cut(value + self.bias[count], count, blocks)
        return blocks

    def _cut(self, value: Any, count: int, blocks: Row) -> None:
        if count == 1:
            blocks.append(value - self.half)
            return
        lower = count // 2
        self._cut(value & self.mask[lower], lower, blocks)
        self._cut(value >> (self.bits * lower), count - lower, blocks)


def rebased(p: Problem, level: Level, base: int, bits: int) -> Level:
    """The same increment over another common multiple and block width, to go on further from it."""
    ratio = fmpz(base // level.base)
    blocks = Blocks(level.bits)

    def convert(row: Row) -> Row:
        return [sum((x << (bits * b) for b, x in enumerate(blocks.of(value))), fmpz(0)) * ratio ** (level.order - r)
                for r, value in enumerate(row)]

    columns = tuple(tuple({key: convert(row) for key, row in packed.items()} for packed in column)
                    for column in level.columns)
    return Level(level.order, columns, level.scale, base, bits)


def levels(p: Problem, n: int, known: tuple[Level, ...] = ()) -> tuple[Level, ...]:
    """``I_0 .. I_n``, going on from those already known."""
    if len(known) > n:
        return known[:n + 1]
    base = common_multiple(p, n)
    bits = block_bits(p, n, base)
    result = list(known) or [first_level(p, base, bits)]
    level = rebased(p, result[-1], base, bits) if known else result[0]
    while level.order < n:
        level = next_level(p, level)
        result.append(level)
    return tuple(result)


# -- leaving the integers ----------------------------------------------------


def without_frequencies(p: Problem, packed: Packed) -> Packed:
    """The packed series after whole turns of every angle: only powers of time and phases remain."""
    result: Packed = {}
    for (kind, angle, m), row in packed.items():
        start = p.coordinates.without_frequency(angle)
        if start < 0:
            start, row = -start, _reflected(row, kind)
        _add(result, (kind, start, m), row)
    return result


def to_modes(p: Problem, level: Level, entry: int, packed: Packed) -> Modes:
    """One entry of one increment as a series in ``t`` with rational coefficients."""
    reader = _Reader(p, level, entry)
    modes: Modes = {}
    for (kind, angle, m), row in packed.items():
        turned, exact_angle = orient(p.coordinates.angle(angle))
        for block, column in enumerate(reader.columns(row)):
            if any(column):
                factor, monomial = reader.monomial(m, block)
                reader.add(modes, kind, turned, exact_angle, monomial, column, factor)
    return modes


class _Reader:
    """The scales of one entry of one increment: ``s**r = unit**r t**r`` over ``scale * base**(m - r)``."""

    def __init__(self, p: Problem, level: Level, entry: int) -> None:
        self.coordinates = p.coordinates
        self.unit, rate = p.coordinates.unit
        self.blocks = Blocks(level.bits)
        self.numerators = [fmpz(level.base * int(rate.p)) ** r * fmpz(int(rate.q)) ** (level.order - r)
                           for r in range(level.order + 1)]
        scale = level.scale[entry]
        self.factor = fmpz(int(scale.q))
        self.denominator = fmpz(int(scale.p)) * fmpz(level.base * int(rate.q)) ** level.order
        self.monomials: dict[tuple[int, int], tuple[Any, Monomial]] = {}

    def columns(self, row: Row) -> list[Row]:
        """Block by block, the coefficients of all powers."""
        blocks = [self.blocks.of(value) for value in row]
        count = max(map(len, blocks))
        return [[b[k] if k < len(b) else 0 for b in blocks] for k in range(count)]

    def monomial(self, packed: int, block: int) -> tuple[Any, Monomial]:
        """The monomial of a block, with the factor its relations give."""
        key = (packed, block)
        if key not in self.monomials:
            self.monomials[key] = multiply_monomials(ONE, self.coordinates.monomial(packed, block))
        return self.monomials[key]

    def add(self, target: Modes, kind: int, turned: bool, angle: Angle, monomial: Monomial, column: Row, factor: Any) -> None:
        """Add the mode of one block."""
        values = [c * g if c else c for c, g in zip(column, self.numerators, strict=False)]
        polynomial = fmpq_poly(values, self.denominator)
        if self.factor != 1 or factor != 1:
            polynomial *= factor * self.factor
        if self.unit == ONE:
            add_reflected(target, kind, turned, angle, monomial, polynomial)
        else:
            self._add_by_powers(target, kind, turned, angle, monomial, polynomial)

    def _add_by_powers(self, target: Modes, kind: int, turned: bool, angle: Angle, monomial: Monomial, f: Any) -> None:
        for r, value in enumerate(f.coeffs()):
            if value:
                factor, product = multiply_monomials(monomial, tuple((g, r * e) for g, e in self.unit if r))
                add_reflected(target, kind, turned, angle, product, fmpq_poly([0] * r + [value * factor]))
