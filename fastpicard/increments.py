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

from dataclasses import dataclass
from itertools import accumulate
from math import gcd, lcm
from typing import Any

from flint import fmpq, fmpz

from fastpicard.blocks import Blocks
from fastpicard.coordinates import Coordinates, Problem, Term
from fastpicard.modes import COS

Row = list[Any]  # fmpz coefficients of s**r / r!, r = 0, 1, ...
Packed = dict[tuple[int, int, int], Row]  # (kind, angle, monomial) -> Row
Factor = tuple[int, int, int, Any, int]  # kind, angle, monomial, odd coefficient, bits to shift


@dataclass(frozen=True)
class Level:
    """The increment ``I_m``: row ``r`` of entry ``i``, over ``scale[i] * base**(m - r)``, multiplies ``s**r / r!``."""

    order: int
    columns: tuple[tuple[Packed, ...], ...]
    scale: tuple[Any, ...]
    base: int
    bits: int


# -- planning: a common multiple of the frequencies, a width for the blocks ---


def common_multiple(p: Problem, n: int) -> int:
    """The least common multiple of all frequencies met in ``I_0 .. I_n``."""
    frequency = p.coordinates.frequency
    moves = [(i, j, sorted({frequency(k) for _, k, *_ in terms}))
             for i, (_, row) in enumerate(p.rows) for j, terms in row]
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
    return int(-(-((largest * base**n).bit_length() + 2) // 8) * 8)


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
        add_row(packed, (kind, angle, monomial), [fmpz(c << (bits * blocks))])
    return packed


def next_level(p: Problem, level: Level) -> Level:
    """``I_{m+1}``, the integral of ``P I_m``."""
    multiples = _Multiples(p.coordinates, level.base)
    rows = tuple(tuple((j, tuple(_factor(term, _multiplier(p, level.scale, i, j), level.bits) for term in terms))
                       for j, terms in row) for i, (_, row) in enumerate(p.rows))
    columns = tuple(tuple(_integral(_product(row, column), multiples) for row in rows) for column in level.columns)
    return Level(level.order + 1, columns, _next_scale(p, level.scale), level.base, level.bits)


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
        add_row(target, (kind, angle, m + monomial), _times(row, c, shift))


def _multiply_wave(target: Packed, factor: Factor, source: Packed) -> None:
    """Add twice ``factor * source``: product to sum of [Neves], section 4."""
    other, k, monomial, c, shift = factor
    for (kind, angle, m), row in source.items():
        outer = inner = _times(row, c, shift)
        result = (kind + other) % 2
        if other != COS:
            outer, inner = (inner, _negative(inner)) if kind == COS else (_negative(inner), inner)
        add_row(target, (result, angle + k, m + monomial), outer)
        difference = angle - k
        if difference < 0:
            difference, inner = -difference, reflected(inner, result)
        add_row(target, (result, difference, m + monomial), inner)


def _times(row: Row, c: Any, shift: int) -> Row:
    if c != 1:
        row = _negative(row) if c == -1 else [c * x for x in row]
    return [x << shift for x in row] if shift else row


def _negative(row: Row) -> Row:
    return [-x for x in row]


def reflected(row: Row, kind: int) -> Row:
    """``c_r(-x) = (-1)**r c_r(x)``, ``s_r(-x) = -(-1)**r s_r(x)``."""
    return [-x if (r + kind) % 2 else x for r, x in enumerate(row)]


def add_row(target: Packed, key: tuple[int, int, int], row: Row) -> None:
    """Add one row in place; rows are never changed, so they may be shared."""
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
        add_row(result, (1 - kind, angle, m), row)
        if multiple and (start or kind != COS):
            constant = [-row[0]]
            if start < 0:
                start, constant = -start, reflected(constant, 1 - kind)
            add_row(result, (1 - kind, start, m), constant)
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


# -- going on ----------------------------------------------------------------


def rebased(level: Level, base: int, bits: int) -> Level:
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
    level = rebased(result[-1], base, bits) if known else result[0]
    while level.order < n:
        level = next_level(p, level)
        result.append(level)
    return tuple(result)
