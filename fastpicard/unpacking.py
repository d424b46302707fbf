r"""From packed integers back to series with rational coefficients."""

from __future__ import annotations

from typing import Any

from flint import fmpq_poly, fmpz

from fastpicard.blocks import Blocks
from fastpicard.coordinates import Problem
from fastpicard.increments import Level, Packed, Row, add_row, reflected
from fastpicard.modes import Angle, Modes, add_reflected, orient
from fastpicard.ring import ONE, Monomial, multiply_monomials


def without_frequencies(p: Problem, packed: Packed) -> Packed:
    """The packed series after whole turns of every angle: only powers of time and phases remain."""
    result: Packed = {}
    for (kind, angle, m), row in packed.items():
        start = p.coordinates.without_frequency(angle)
        if start < 0:
            start, row = -start, reflected(row, kind)
        add_row(result, (kind, start, m), row)
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

    def add(self, target: Modes, kind: int, turned: bool, angle: Angle, monomial: Monomial, column: Row,
            factor: Any) -> None:
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
