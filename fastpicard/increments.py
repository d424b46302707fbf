r"""The increments of Picard iteration.

    Phi_n = I_0 + I_1 + ... + I_n,   I_{k+1}(t) = integral of P I_k from 0 to t

so only the newest increment is ever multiplied and integrated.  In the basis of
:mod:`fastpicard.modes` a row of coefficients, over all powers of time, is one
polynomial ``f(x)`` with ``x**r`` for ``s**r / r!``.  Products to sums only add such
rows, and integration ``q G_r = f_r + G_{r+1}`` is one exact division,

    G = quotient of  x f(x)  by  q x - 1,

all of it inside python-flint.  Rows are found by one integer, twice the packed
angle plus the kind: moving by ``2 k`` moves the angle by ``k``.  Two integrals are one division too, of ``x**2 f(x)``
by ``-(q x - 1)**2``, and differentiation is a product, ``(1 - q x) G / x``.  So
where a row of ``P`` is constant, as in ``x_0' = x_1``, and commutes with the integral,
``P I_k`` is integrated twice for ``x_1``: that is the increment of ``x_0`` after the
next, and its derivative, formed only when asked for, the next one of ``x_1``.
Where entries of a row of ``P`` are multiples of each other, their columns are added first.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import gcd, lcm
from typing import Any

from flint import fmpq, fmpq_poly

from fastpicard.coordinates import Problem, Term
from fastpicard.modes import COS, SIN, Modes, mask
from fastpicard.ring import ONE, Monomial, multiply_monomials

Rows = dict[int, Any]  # 2 * angle + kind -> fmpq_poly
Entry = dict[int, Rows]  # monomial -> rows
Numbers = tuple[tuple[int, Any], ...]  # (column, number)
Parts = tuple[tuple[Numbers, tuple[Term, ...]], ...]  # sums of columns, and what each is multiplied by

_FLIP = fmpq_poly([0, -1])


@dataclass(frozen=True)
class Column:
    """One column of an increment: its entries, or their integrals, of which they are the derivatives."""

    entries: dict[int, Entry]
    integrals: dict[int, Entry]
    divisors: Divisors

    def __getitem__(self, i: int) -> Entry:
        if i not in self.entries:
            self.entries[i] = {monomial: _derivative(rows, self.divisors)
                               for monomial, rows in self.integrals[i].items()}
        return self.entries[i]


@dataclass(frozen=True)
class Level:
    """The increment ``I_m``: column by column its entries."""

    order: int
    columns: tuple[Column, ...]


def levels(p: Problem, n: int, known: tuple[Level, ...] = ()) -> tuple[Level, ...]:
    """``I_0 .. I_n``, going on from those already known."""
    known = known[:n + 1] or (first_level(p),)
    steps = _steps(p)
    columns = [_next_columns(p, column, steps, n + 1 - len(known)) for column in known[-1].columns]
    return (*known, *(Level(m, new) for m, new in enumerate(zip(*columns, strict=True), len(known))))


def first_level(p: Problem) -> Level:
    """``I_0``: the columns ``x(0)``."""
    return Level(0, tuple(Column({i: _constants(terms) for i, terms in enumerate(column)}, {}, Divisors(p, 1))
                          for column in p.start))


def _constants(terms: tuple[Term, ...]) -> Entry:
    entry: Entry = {}
    for kind, angle, monomial, c in terms:
        _add_rows(entry.setdefault(monomial, {}), {2 * angle + kind: fmpq_poly([c])})
    return entry


@dataclass(frozen=True)
class _Step:
    """A row of ``P``: unless it is constant, what is common to its coefficients goes into the divisors.

    Attributes
    ----------
    parts : entries that are multiples of each other, as those of ``K (a + b cos t)``: their columns are added first
    once, twice : divisors of one integral and of two; None for ``twice`` where one is needed at a time
    """

    parts: Parts
    constant: bool
    once: Divisors
    twice: Divisors | None

    @property
    def columns(self) -> list[int]:
        """All columns that the row takes."""
        return [j for numbers, _ in self.parts for j, _ in numbers]


def _steps(p: Problem) -> list[_Step]:
    constant = [all(kind == COS and angle == 0 for _, terms in row for kind, angle, _, _ in terms) for row in p.rows]
    awaited = {j for i, row in enumerate(p.rows) if constant[i] and not any(constant[j] for j, _ in row)
               for j, _ in row}
    steps = []
    for i, row in enumerate(p.rows):
        found: dict[tuple[Term, ...], Numbers] = {}
        for j, terms in row:
            number = _content([c for *_, c in terms])
            primitive = tuple(sorted((kind, k, m, int((c / number).p)) for kind, k, m, c in terms))
            found[primitive] = (*found.get(primitive, ()), (j, number))
        common = fmpq(1) if constant[i] else _content([c for numbers in found.values() for _, c in numbers])
        parts = tuple((tuple((j, _number(c / common)) for j, c in numbers), terms) for terms, numbers in found.items())
        steps.append(_Step(parts, constant[i], Divisors(p, 1, common),
                           Divisors(p, 2, common) if i in awaited and not constant[i] else None))
    return steps


def _content(values: list[Any]) -> Any:
    """The number with the sign of the first of which all are coprime integer multiples."""
    common = fmpq(gcd(*(int(c.p) for c in values)), lcm(*(int(c.q) for c in values)))
    return common if values[0] > 0 else -common


def _number(c: Any) -> Any:
    """A rational number, as int where it is whole: comparing an int costs much less."""
    return int(c.p) if c.q == 1 else c


def _next_columns(p: Problem, column: Column, steps: list[_Step], count: int) -> list[Column]:
    """Integrals of ``P`` times a column, again and again; one column at a time, for its last numbers are at hand."""
    result = []
    for left in reversed(range(count)):
        column = _next_column(p, column, steps, last=not left)
        result.append(column)
    return result


def _next_column(p: Problem, column: Column, steps: list[_Step], last: bool) -> Column:
    """The integral of ``P`` times a column; of the last one no integrals are kept to go on from."""
    entries: dict[int, Entry] = {}
    integrals: dict[int, Entry] = {}
    for i, step in enumerate(steps):
        if step.twice is not None and not last:
            integrals[i] = _integral(_product(p, step.parts, column), step.twice)
        elif step.constant and all(j in column.integrals for j in step.columns):
            entries[i] = dict(_product(p, step.parts, column.integrals))
        else:
            entries[i] = _integral(_product(p, step.parts, column), step.once)
    return Column(entries, integrals, column.divisors)


# -- one row of P times one column --------------------------------------------


def _product(p: Problem, parts: Parts, column: Column | Mapping[int, Entry]) -> Iterator[tuple[int, Rows]]:
    """The rows of every monomial in turn, so that what is formed is integrated while it is at hand."""
    sources: dict[int, list[tuple[Rows, int, int, Any]]] = {}
    for numbers, terms in parts:
        entry = _combination(numbers, column)
        for kind, k, own, c in terms:
            for monomial, rows in entry.items():
                for product, number in p.product(monomial, own):
                    sources.setdefault(product, []).append((rows, kind, k, c * number))
    for monomial, found in sources.items():
        target: Rows = {}
        for rows, kind, k, c in found:
            if c != 1:
                rows = _multiple(rows, c)
            if kind != COS:
                _multiply_sine(target, rows, k)
            elif k:
                _multiply_cosine(target, rows, k)
            elif target:
                _add_rows(target, rows)
            else:
                target.update(rows)
        yield monomial, target


def _combination(numbers: Numbers, column: Column | Mapping[int, Entry]) -> Entry:
    """The sum of columns times numbers."""
    if len(numbers) == 1 and numbers[0][1] == 1:
        return column[numbers[0][0]]
    result: Entry = {}
    for j, c in numbers:
        for monomial, rows in column[j].items():
            _add_rows(result.setdefault(monomial, {}), rows if c == 1 else _multiple(rows, c))
    return result


def _multiple(rows: Rows, c: Any) -> Rows:
    inverse = fmpq(1) / c  # python-flint divides a polynomial by a number faster than it multiplies by one
    return {key: row / inverse for key, row in rows.items()}


def _add_rows(target: Rows, rows: Rows) -> None:
    for key, row in rows.items():
        old = target.get(key)
        target[key] = row if old is None else old + row


def _multiply_cosine(target: Rows, rows: Rows, k: int) -> None:
    """Add ``2 cos(k) rows``: every row moves up by ``k`` and down by ``k`` ([Neves], section 4: product to sum)."""
    get, step = target.get, 2 * k
    for key, row in rows.items():
        if key < 2:
            row = row + row
        else:
            lower, below = key - step, row
            if lower < 0:
                lower, below = _reflection(lower, row)
            old = get(lower)
            target[lower] = below if old is None else old + below
        upper = key + step
        old = get(upper)
        target[upper] = row if old is None else old + row


def _multiply_sine(target: Rows, rows: Rows, k: int) -> None:
    """Add ``2 sin(k) rows``: the kind changes, and one of the two directions its sign."""
    for key, row in rows.items():
        outer, inner = (-row, row) if key & 1 else (row, -row)
        other = key ^ 1
        lower = other - 2 * k
        if lower < 0:
            lower, inner = _reflection(lower, inner)
        _add_rows(target, {other + 2 * k: outer})
        _add_rows(target, {lower: inner})


def _reflection(key: int, row: Any) -> tuple[int, Any]:
    """The place and the row of the same function where the angle is negative."""
    kind = key & 1
    return 2 * kind - key, reflected(kind, row)


def reflected(kind: int, row: Any) -> Any:
    """``c_r(-x) = (-1)**r c_r(x)``, ``s_r(-x) = -(-1)**r s_r(x)``."""
    return row(_FLIP) if kind == COS else -row(_FLIP)


# -- calculus -----------------------------------------------------------------


class Divisors(dict[int, Any]):
    """For places of rows ``(divisor, place of the integral, q, 1 - q x, value, slope)``.

    The divisors are ``q x - 1`` of cosines, ``1 - q x`` of sines, for two integrals the product of both; where the
    integrand has the number ``common`` as a factor, over it.  ``value`` and ``slope`` are the places, where the
    frequency is gone, of the constant and of the multiple of ``t`` that let the integral and its derivative vanish at
    0, or None where they do anyhow.
    """

    def __init__(self, p: Problem, times: int, common: Any = 1) -> None:
        self.coordinates, self.times, self.common = p.coordinates, times, common

    def __missing__(self, key: int) -> tuple[Any, int, int, Any, int | None, int | None]:
        angle = key >> 1
        q = self.coordinates.frequency(angle)
        cosine, sine = fmpq_poly([-1, q]), fmpq_poly([1, -q])
        divisor = cosine * sine if self.times == 2 else sine if key & 1 else cosine
        target = key if self.times == 2 else key ^ 1
        start, kind = self.coordinates.without_frequency(angle), target & 1
        place = 2 * start + kind
        value = place if start or kind == COS else None
        slope = place if self.times == 2 and (start or kind == SIN) else None
        found = self[key] = divisor / self.common, target, q, sine, value, slope
        return found


def _integral(product: Iterable[tuple[int, Rows]], divisors: Divisors) -> Entry:
    """The antiderivative that is zero at 0, and its derivative too, if it is the second one."""
    found = {monomial: _integrated(rows, divisors) for monomial, rows in product}
    return {monomial: rows for monomial, rows in found.items() if rows}


def _integrated(rows: Rows, divisors: Divisors) -> Rows:
    result: Rows = {}
    values: dict[int, list[Any]] = {}
    slopes: dict[int, list[Any]] = {}
    times = divisors.times
    for key, row in rows.items():
        if key < 2:
            row = mask(key, row)
        if not row:
            continue
        divisor, target, q, factor, value, slope = divisors[key]
        row = row.left_shift(times) // divisor
        if not q:
            _add_rows(result, {target: row})
            continue
        result[target] = row
        if value is not None:
            values.setdefault(value, []).append(row[0])
        if slope is not None:
            slopes.setdefault(slope, []).append(row.mul_low(factor, 2)[1])
    for starts, r in ((values, 0), (slopes, 1)):
        for place, numbers in starts.items():
            row = fmpq_poly([0] * r + [-_sum(numbers)])
            if place < 0:
                place, row = _reflection(place, row)
            _add_rows(result, {place: row})
    return result


def _sum(numbers: list[Any]) -> Any:
    """The sum of rational numbers, over one denominator inside python-flint."""
    return fmpq_poly(numbers)(1)


def _derivative(rows: Rows, divisors: Divisors) -> Rows:
    """The inverse of integration: ``(1 - q x) G / x``."""
    result: Rows = {}
    for key, row in rows.items():
        result[key ^ 1] = (row * divisors[key ^ 1][0]).right_shift(1)
    return result


# -- leaving the packed form --------------------------------------------------


def without_frequencies(p: Problem, entry: Entry, half_turns: int = 0) -> Entry:
    """The entry after whole turns of every angle: only powers of time and phases remain.

    With ``half_turns``, after a time in which the unit of frequency makes that many half turns: every wave of
    frequency ``k`` then has the sign ``(-1)**(k half_turns)``.
    """
    result: Entry = {}
    start_of = p.coordinates.without_frequency if p.coordinates.phases else _nowhere
    for monomial, rows in entry.items():
        collapsed: Rows = {}
        for key, row in rows.items():
            angle = key >> 1
            place = 2 * start_of(angle) + (key & 1)
            if half_turns and p.coordinates.frequency(angle) * half_turns % 2:
                row = -row
            if place < 0:
                place, row = _reflection(place, row)
            old = collapsed.get(place)
            collapsed[place] = row if old is None else old + row
        result[monomial] = {place: mask(place, row) if place < 2 else row for place, row in collapsed.items()}
    return result


def _nowhere(angle: int) -> int:
    return 0


def to_modes(p: Problem, entries: Iterable[Entry]) -> Modes:
    """The sum of entries of increments as a series in ``t = s / unit``."""
    total = _total(p, entries)
    waves = {key: (key & 1, *p.angle(key >> 1)) for key in set().union(*total.values())}
    modes = {(kind, angle, monomial): reflected(kind, row) if turned else row
             for monomial, rows in total.items() for key, row in rows.items() if row
             for kind, turned, angle in (waves[key],)}
    return modes if p.coordinates.unit == (ONE, 1) else _in_time(modes, *p.coordinates.unit)


def _total(p: Problem, entries: Iterable[Entry]) -> dict[Monomial, Rows]:
    """The sum of entries, which is cheaper to form before angles are unpacked."""
    total: dict[Monomial, Rows] = {}
    for entry in entries:
        for packed, rows in entry.items():
            factor, monomial = p.monomial(packed)
            if factor != 1:
                rows = {key: row * factor for key, row in rows.items()}
            if monomial in total:
                _add_rows(total[monomial], rows)
            else:
                total[monomial] = dict(rows)
    return total


def _in_time(modes: Modes, unit: Monomial, number: Any) -> Modes:
    """A series in ``s`` as one in ``t``, where ``s = number unit t``."""
    result: Modes = {}
    for (kind, angle, monomial), row in modes.items():
        if number != 1:
            row = row(fmpq_poly([0, number]))
        for m, f in ((monomial, row),) if unit == ONE else _by_power(row, monomial, unit):
            old = result.get((kind, angle, m))
            result[kind, angle, m] = f if old is None else old + f
    for mode in [mode for mode, f in result.items() if not f]:
        del result[mode]
    return result


def _by_power(row: Any, monomial: Monomial, unit: Monomial) -> Iterator[tuple[Monomial, Any]]:
    """``s**r = unit**r t**r``: one row for each power, where the unit of frequency is a symbol."""
    for r, value in enumerate(row.coeffs()):
        gained, product = multiply_monomials(monomial, tuple((g, r * e) for g, e in unit if r))
        yield product, fmpq_poly([0] * r + [value * gained])
