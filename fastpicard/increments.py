r"""The increments of Picard iteration.

    Phi_n = I_0 + I_1 + ... + I_n,   I_{k+1}(t) = integral of P I_k from 0 to t

so only the newest increment is ever multiplied and integrated.  In the basis of
:mod:`fastpicard.modes` a row of coefficients, over all powers of time, is one
polynomial ``f(x)`` with ``x**r`` for ``s**r / r!``.  Products to sums only add such
rows, and integration ``q G_r = f_r + G_{r+1}`` is one exact division,

    G = quotient of  x f(x)  by  q x - 1,

all of it inside python-flint.  Rows are reduced fractions over one denominator.
Where that grows long, the denominators of all rows of one monomial, which are
nearly the same, are cleared together: sums then need no common divisors.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from flint import fmpq_poly, fmpz

from fastpicard.coordinates import Problem, Row, Term
from fastpicard.modes import COS, SIN, Modes, mask
from fastpicard.ring import ONE, Monomial, multiply_monomials

Rows = dict[tuple[int, int], Any]  # (kind, angle) -> fmpq_poly
Entry = dict[int, tuple[Any, Rows]]  # monomial -> (scale, rows times scale)
Source = tuple[Any, Rows, Term]  # scale, rows, term of P

LONG = 400  # bits of a denominator beyond which it is cleared

_FLIP = fmpq_poly([0, -1])


@dataclass(frozen=True)
class Level:
    """The increment ``I_m``: column by column its entries."""

    order: int
    columns: tuple[tuple[Entry, ...], ...]


def levels(p: Problem, n: int, known: tuple[Level, ...] = ()) -> tuple[Level, ...]:
    """``I_0 .. I_n``, going on from those already known."""
    result = list(known[:n + 1]) or [first_level(p)]
    divisors = _Divisors(p)
    while len(result) <= n:
        result.append(next_level(p, result[-1], divisors))
    return tuple(result)


def first_level(p: Problem) -> Level:
    """``I_0``: the columns ``x(0)``."""
    return Level(0, tuple(tuple(_constants(terms) for terms in column) for column in p.start))


def _constants(terms: tuple[Term, ...]) -> Entry:
    entry: Entry = {}
    for kind, angle, monomial, c in terms:
        _add_rows(entry.setdefault(monomial, (fmpz(1), {}))[1], {(kind, angle): fmpq_poly([c])})
    return entry


def next_level(p: Problem, level: Level, divisors: _Divisors) -> Level:
    """``I_{m+1}``, the integral of ``P I_m``."""
    columns = tuple(tuple(_integrated_product(row, column, divisors) for row in p.rows) for column in level.columns)
    return Level(level.order + 1, columns)


# -- one row of P times one column, integrated --------------------------------


def _integrated_product(row: Row, column: tuple[Entry, ...], divisors: _Divisors) -> Entry:
    sources: dict[int, list[Source]] = {}
    for j, terms in row:
        for monomial, (scale, rows) in column[j].items():
            for term in terms:
                sources.setdefault(monomial + term[2], []).append((scale, rows, term))
    result: Entry = {}
    for monomial, group in sources.items():
        scale = _lcm(source[0] for source in group)
        integral = _integral(_product(group, scale), divisors)
        if integral:
            result[monomial] = _cleared(scale, integral)
    return result


def _lcm(values: Iterable[Any]) -> Any:
    result = fmpz(1)
    for value in values:
        if value != result:
            result = result // result.gcd(value) * value
    return result


def _cleared(scale: Any, rows: Rows) -> tuple[Any, Rows]:
    """The rows with their denominators cleared, where these are long and nearly the same."""
    longest = max(row.denom().bit_length() for row in rows.values())
    if longest < LONG:
        return scale, rows
    common = fmpz(1)
    for row in rows.values():
        common = _lcm((common, row.denom()))
        if common.bit_length() > 1.5 * longest:
            return scale, rows
    return scale * common, {key: row * common for key, row in rows.items()}


def _product(group: list[Source], scale: Any) -> Rows:
    """The rows of one monomial of the product."""
    target: Rows = {}
    for own_scale, rows, (other, k, _, c) in group:
        factor = c * (scale // own_scale)
        if factor != 1:
            rows = {key: row * factor for key, row in rows.items()}
        if k and other == COS:
            _multiply_cosine(target, rows, k)
        elif other == COS:
            _add_rows(target, rows)
        else:
            _multiply_sine(target, rows, k)
    return target


def _add_rows(target: Rows, rows: Rows) -> None:
    for key, row in rows.items():
        old = target.get(key)
        target[key] = row if old is None else old + row


def _multiply_cosine(target: Rows, rows: Rows, k: int) -> None:
    """Add ``2 cos(k) rows``: every row moves up by ``k`` and down by ``k`` ([Neves], section 4: product to sum)."""
    get = target.get
    for (kind, angle), row in rows.items():
        if angle == 0:
            row = row + row
        else:
            lower, below = angle - k, row
            if lower < 0:
                lower, below = -lower, reflected(kind, row)
            old = get((kind, lower))
            target[kind, lower] = below if old is None else old + below
        old = get((kind, angle + k))
        target[kind, angle + k] = row if old is None else old + row


def _multiply_sine(target: Rows, rows: Rows, k: int) -> None:
    """Add ``2 sin(k) rows``: the kind changes, and one of the two directions its sign."""
    for (kind, angle), row in rows.items():
        outer, inner = (row, -row) if kind == COS else (-row, row)
        lower = angle - k
        if lower < 0:
            lower, inner = -lower, reflected(1 - kind, inner)
        _add_rows(target, {(1 - kind, angle + k): outer})
        _add_rows(target, {(1 - kind, lower): inner})


def reflected(kind: int, row: Any) -> Any:
    """``c_r(-x) = (-1)**r c_r(x)``, ``s_r(-x) = -(-1)**r s_r(x)``."""
    return row(_FLIP) if kind == COS else -row(_FLIP)


class _Divisors:
    """The polynomials ``q x - 1`` of the packed angles of one problem, ``1 - q x`` for sines."""

    def __init__(self, p: Problem) -> None:
        self.coordinates = p.coordinates
        self.known: dict[tuple[int, int], tuple[Any, int]] = {}

    def of(self, key: tuple[int, int]) -> tuple[Any, int]:
        """``(divisor, the angle at time 0)``; None for the divisor where ``q = 0``."""
        found = self.known.get(key)
        if found is None:
            kind, angle = key
            q = self.coordinates.frequency(angle)
            divisor = fmpq_poly([-1, q] if kind == COS else [1, -q]) if q else None
            found = self.known[key] = divisor, self.coordinates.without_frequency(angle)
        return found


def _integral(product: Rows, divisors: _Divisors) -> Rows:
    """The antiderivative that is zero at 0, row by row."""
    result: Rows = {}
    constants: dict[int, Any] = {}
    for key, row in product.items():
        kind, angle = key
        divisor, start = divisors.of(key)
        if angle == 0:
            row = mask(kind, row)
        if not row:
            continue
        if divisor is None:
            _add_rows(result, {(1 - kind, angle): row.left_shift(1) * (-1 if kind == COS else 1)})
            continue
        row = row.left_shift(1) // divisor
        result[1 - kind, angle] = row
        if kind != COS:
            constants[abs(start)] = constants.get(abs(start), 0) - row[0]
        elif start:
            _add_rows(result, {(SIN, abs(start)): fmpq_poly([-row[0] if start > 0 else row[0]])})
    _add_rows(result, {(COS, start): fmpq_poly([value]) for start, value in constants.items()})
    return result


# -- leaving the packed form --------------------------------------------------


def without_frequencies(p: Problem, entry: Entry, half_turns: int = 0) -> Entry:
    """The entry after whole turns of every angle: only powers of time and phases remain.

    With ``half_turns``, after a time in which the unit of frequency makes that many half turns: every wave of
    frequency ``k`` then has the sign ``(-1)**(k half_turns)``.
    """
    result: Entry = {}
    start_of = p.coordinates.without_frequency if p.coordinates.phases else _nowhere
    for monomial, (scale, rows) in entry.items():
        collapsed: Rows = {}
        for (kind, angle), row in rows.items():
            start = start_of(angle)
            if half_turns and p.coordinates.frequency(angle) * half_turns % 2:
                row = -row
            if start < 0:
                start, row = -start, reflected(kind, row)
            old = collapsed.get((kind, start))
            collapsed[kind, start] = row if old is None else old + row
        result[monomial] = scale, {(kind, start): row if start else mask(kind, row)
                                   for (kind, start), row in collapsed.items()}
    return result


def _nowhere(angle: int) -> int:
    return 0


def to_modes(p: Problem, entries: Iterable[Entry]) -> Modes:
    """The sum of entries of increments as a series in ``t = s / unit``."""
    modes: Modes = {}
    unit, rate = p.coordinates.unit
    stretch = None if rate == 1 else fmpq_poly([0, rate])
    for entry in entries:
        for packed, (scale, rows) in entry.items():
            weight, monomial = p.monomial(packed)
            factor = None if weight == scale else weight / scale
            for (kind, angle), row in rows.items():
                if stretch is not None:
                    row = row(stretch)
                if factor is not None:
                    row = row * factor
                turned, exact = p.angle(angle)
                if turned:
                    row = reflected(kind, row)
                for m, f in ((monomial, row),) if unit == ONE else _by_power(row, monomial, unit):
                    key = (kind, exact, m)
                    old = modes.setdefault(key, f)
                    if old is not f:
                        modes[key] = old + f
    for key in [key for key, f in modes.items() if not f]:
        del modes[key]
    return modes


def _by_power(row: Any, monomial: Monomial, unit: Monomial) -> Iterator[tuple[Monomial, Any]]:
    """``s**r = unit**r t**r``: one row for each power, where the unit of frequency is a symbol."""
    for r, value in enumerate(row.coeffs()):
        gained, product = multiply_monomials(monomial, tuple((g, r * e) for g, e in unit if r))
        yield product, fmpq_poly([0] * r + [value * gained])
