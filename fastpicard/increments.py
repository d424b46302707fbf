r"""The increments of Picard iteration.

    Phi_n = I_0 + I_1 + ... + I_n,   I_{k+1}(t) = integral of P I_k from 0 to t

so only the newest increment is ever multiplied and integrated, in :mod:`fastpicard.rows`.
Where a row of ``P`` is constant, as in ``x_0' = x_1``, and commutes with the integral,
``P I_k`` is integrated twice for ``x_1``: that is the increment of ``x_0`` after the
next, and its derivative, formed only when asked for, the next one of ``x_1``.
Where entries of a row of ``P`` are multiples of each other, their columns are added first.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, field
from math import gcd, lcm
from typing import Any

from flint import fmpq, fmpq_poly

from fastpicard.coordinates import Problem, Term
from fastpicard.modes import COS
from fastpicard.rows import (
    Divisors,
    Entry,
    Rows,
    add_rows,
    derivative,
    integral,
    multiple,
    multiply_cosine,
    multiply_sine,
)

Numbers = tuple[tuple[int, Any], ...]  # (column, number)
Parts = tuple[tuple[Numbers, tuple[Term, ...]], ...]  # sums of columns, and what each is multiplied by


@dataclass(frozen=True)
class Column:
    """One column of a matrix: entries, and integrals of entries, of which the derivatives are formed when asked for."""

    entries: dict[int, Entry]
    integrals: dict[int, Entry]
    divisors: Divisors
    found: dict[int, Entry] = field(default_factory=dict)

    def __getitem__(self, i: int) -> Entry:
        if i not in self.integrals:
            return self.entries[i]
        if i not in self.found:
            rates = {monomial: derivative(rows, self.divisors) for monomial, rows in self.integrals[i].items()}
            _add_entry(rates, self.entries.get(i, {}))
            self.found[i] = rates
        return self.found[i]

    def add(self, other: Column, but: Container[int] = ()) -> None:
        """Add another column in place, but for some of its entries."""
        for i, entry in other.entries.items():
            if i not in but:
                _add_entry(self.entries.setdefault(i, {}), entry)
        for i, entry in other.integrals.items():
            _add_entry(self.integrals.setdefault(i, {}), entry)


def _add_entry(target: Entry, entry: Entry) -> None:
    for monomial, rows in entry.items():
        if monomial in target:
            add_rows(target[monomial], rows)
        else:
            target[monomial] = dict(rows)


@dataclass(frozen=True)
class Iterate:
    """``Phi_n``, and the increment ``I_n`` to go on from: column by column."""

    order: int
    sums: tuple[Column, ...]
    newest: tuple[Column, ...]


def iterate(p: Problem, n: int, known: Iterate | None = None) -> Iterate:
    """``Phi_n``, going on from an iterate of lower order; of the increments only the last is kept."""
    if known is None or known.order > n:
        known = _first(p)
    if known.order == n:
        return known
    steps, count = _steps(p), n - known.order
    pairs = [_further(p, steps, count, total, column) for total, column in zip(known.sums, known.newest, strict=True)]
    sums, newest = zip(*pairs, strict=True)
    return Iterate(n, sums, newest)


def _first(p: Problem) -> Iterate:
    """``Phi_0 = I_0``: the columns ``x(0)``."""
    columns = tuple(Column({i: _constants(terms) for i, terms in enumerate(column)}, {}, Divisors(p, 1))
                    for column in p.start)
    return Iterate(0, columns, columns)


def _constants(terms: tuple[Term, ...]) -> Entry:
    entry: Entry = {}
    for kind, angle, monomial, c in terms:
        add_rows(entry.setdefault(monomial, {}), {2 * angle + kind: fmpq_poly([c])})
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

    def is_found(self, column: Column) -> bool:
        """Whether integrals of a column are known, of which the integral of this row is a sum."""
        return self.constant and all(j in column.integrals for numbers, _ in self.parts for j, _ in numbers)


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


def _further(p: Problem, steps: list[_Step], count: int, total: Column, column: Column) -> tuple[Column, Column]:
    """Add so many integrals of ``P`` times a column; one column at a time, for its last numbers are at hand.

    What is a sum of integrals is added up when these have been.
    """
    sums = Column({}, {}, total.divisors)
    for left in reversed(range(count)):
        found = {i for i, step in enumerate(steps) if step.is_found(column)}
        column = _next_column(p, column, steps, last=not left)
        sums.add(column, found)
    known = {i: dict(_product(p, step.parts, sums.integrals)) for i, step in enumerate(steps) if step.is_found(sums)}
    sums.add(Column(known, {}, total.divisors))
    sums.add(total)
    return sums, column


def _next_column(p: Problem, column: Column, steps: list[_Step], last: bool) -> Column:
    """The integral of ``P`` times a column; of the last one no integrals are kept to go on from."""
    entries: dict[int, Entry] = {}
    integrals: dict[int, Entry] = {}
    for i, step in enumerate(steps):
        if step.twice is not None and not last:
            integrals[i] = integral(_product(p, step.parts, column), step.twice)
        elif step.is_found(column):
            entries[i] = dict(_product(p, step.parts, column.integrals))
        else:
            entries[i] = integral(_product(p, step.parts, column), step.once)
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
                rows = multiple(rows, c)
            if kind != COS:
                multiply_sine(target, rows, k)
            elif k:
                multiply_cosine(target, rows, k)
            elif target:
                add_rows(target, rows)
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
            add_rows(result.setdefault(monomial, {}), rows if c == 1 else multiple(rows, c))
    return result
