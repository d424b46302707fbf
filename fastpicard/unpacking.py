"""Rows of increments as series again, and their values after whole turns of all waves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from flint import fmpq_poly

from fastpicard.coordinates import Problem
from fastpicard.modes import Modes, mask, quarter_turned
from fastpicard.ring import ONE, Monomial, multiply_monomials
from fastpicard.rows import Entry, Rows, add_rows, reflected, reflection


def without_frequencies(p: Problem, entry: Entry, quarter_turns: int = 0) -> Entry:
    """The entry after whole turns of every angle: only powers of time and phases remain.

    With ``quarter_turns``, after a time in which the unit of frequency makes that many quarter turns: a wave of
    frequency ``k`` has then made ``k`` times as many, and is a wave of the phase alone.
    """
    result: Entry = {}
    start_of = p.coordinates.without_frequency if p.coordinates.phases else _nowhere
    for monomial, rows in entry.items():
        collapsed: Rows = {}
        for key, row in rows.items():
            angle = key >> 1
            kind = key & 1
            if quarter_turns:
                kind, negative = quarter_turned(kind, p.coordinates.frequency(angle) * quarter_turns)
                row = -row if negative else row
            place = 2 * start_of(angle) + kind
            if place < 0:
                place, row = reflection(place, row)
            old = collapsed.get(place)
            collapsed[place] = row if old is None else old + row
        result[monomial] = {place: mask(place, row) if place < 2 else row for place, row in collapsed.items()}
    return result


def _nowhere(angle: int) -> int:
    return 0


def to_modes(p: Problem, entry: Entry) -> Modes:
    """An entry as a series in ``t = s / unit``."""
    total = _unpacked(p, entry)
    waves = {key: (key & 1, *p.angle(key >> 1)) for key in set().union(*total.values())}
    modes = {(kind, angle, monomial): reflected(kind, row) if turned else row
             for monomial, rows in total.items() for key, row in rows.items() if row
             for kind, turned, angle in (waves[key],)}
    return modes if p.coordinates.unit == (ONE, 1) else _in_time(modes, *p.coordinates.unit)


def _unpacked(p: Problem, entry: Entry) -> dict[Monomial, Rows]:
    """The rows of true monomials, of which several packed ones may be multiples."""
    result: dict[Monomial, Rows] = {}
    for packed, rows in entry.items():
        factor, monomial = p.monomial(packed)
        if factor != 1:
            rows = {key: row * factor for key, row in rows.items()}
        if monomial in result:
            rows = dict(rows)
            add_rows(rows, result[monomial])
        result[monomial] = rows
    return result


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
