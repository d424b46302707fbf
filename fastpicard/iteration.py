"""The increments ``I_0 .. I_n`` of any problem: packed where the frequencies have a common unit, or else as series."""

from __future__ import annotations

from dataclasses import dataclass

from flint import fmpq

from fastpicard import modes as algebra
from fastpicard.coordinates import Problem, problem
from fastpicard.increments import Iterate, iterate
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import Linear, Modes
from fastpicard.ring import ONE
from fastpicard.unpacking import to_modes, without_frequencies


@dataclass(frozen=True)
class PackedIncrements:
    """The sum ``I_0 + .. + I_n`` and ``I_n`` from :mod:`fastpicard.increments`."""

    problem: Problem
    iterate: Iterate

    def to_order(self, n: int) -> PackedIncrements:
        """The same up to order ``n``; only what is new is computed, but of a lower order everything."""
        return PackedIncrements(self.problem, iterate(self.problem, n, self.iterate))

    def newest(self, i: int, j: int) -> Modes:
        """Entry ``(i, j)`` of ``I_n``."""
        return to_modes(self.problem, self.iterate.newest[j][i])

    def total(self, i: int, j: int) -> Modes:
        """Entry ``(i, j)`` of the sum."""
        return to_modes(self.problem, self.iterate.sums[j][i])

    @property
    def divided(self) -> frozenset[Linear]:
        """Frequencies of which multiples were divided by; all are of the unit."""
        return frozenset({algebra.linear(dict([self.problem.coordinates.unit]))})

    def whole_turns(self, i: int, j: int) -> Modes:
        """The same after a time in which every angle makes whole turns: powers of that time."""
        return to_modes(self.problem, without_frequencies(self.problem, self.iterate.sums[j][i]))


@dataclass(frozen=True)
class SeriesIncrements:
    """The sum and ``I_n`` as matrices of series: incommensurate frequencies, powers of ``t`` in ``P``."""

    P: SeriesMatrix
    first: SeriesMatrix
    order: int
    sums: SeriesMatrix
    increment: SeriesMatrix
    divided: frozenset[Linear] = frozenset()  # the frequencies that were divided by

    def to_order(self, n: int) -> SeriesIncrements:
        """The same up to order ``n``; only what is new is computed, but of a lower order everything."""
        if n < self.order:
            return in_series(self.P, self.first, n)
        sums, newest, divided = self.sums, self.increment, set(self.divided)
        for _ in range(n - self.order):
            newest = (self.P @ newest).integrate()
            sums = sums + newest
            divided.update(angle[0] for row in newest.rows for modes in row for _, angle, _ in modes if angle[0])
        return SeriesIncrements(self.P, self.first, n, sums, newest, frozenset(divided))

    def newest(self, i: int, j: int) -> Modes:
        """Entry ``(i, j)`` of ``I_n``."""
        return self.increment.rows[i][j]

    def total(self, i: int, j: int) -> Modes:
        """Entry ``(i, j)`` of the sum."""
        return self.sums.rows[i][j]

    def whole_turns(self, i: int, j: int) -> Modes:
        """The same after a time in which every angle makes whole turns: powers of that time."""
        modes: Modes = {}
        for (kind, (_, phase), monomial), f in self.total(i, j).items():
            turned, angle = algebra.orient(((), phase))
            algebra.add_reflected(modes, kind, turned, angle, monomial, f)
        return modes


Increments = PackedIncrements | SeriesIncrements


def first_increments(P: SeriesMatrix, columns: list[tuple[Modes, ...]], n: int) -> Increments:
    """``I_0 .. I_n`` for the given columns, packed where the frequencies of ``P`` have a common unit."""
    packed = problem(P.rows, columns)
    if packed is not None:
        return PackedIncrements(packed, iterate(packed, n))
    return in_series(P, SeriesMatrix(tuple(zip(*columns, strict=True)), P.t), n)


def in_series(P: SeriesMatrix, first: SeriesMatrix, n: int) -> SeriesIncrements:
    """``I_0 .. I_n`` from ``I_0`` by products and integrals of series."""
    return SeriesIncrements(P, first, 0, first, first).to_order(n)


def identity_columns(size: int) -> list[tuple[Modes, ...]]:
    """The columns of the identity matrix."""
    one = algebra.constant({ONE: fmpq(1)})
    return [tuple(one if i == j else {} for i in range(size)) for j in range(size)]
