"""The increments ``I_0 .. I_n`` of any problem: packed where the frequencies have a common unit, or else as series."""

from __future__ import annotations

from dataclasses import dataclass

from flint import fmpq

from fastpicard import modes as algebra
from fastpicard.coordinates import Problem, problem
from fastpicard.increments import Level, levels
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import Modes
from fastpicard.ring import ONE
from fastpicard.unpacking import to_modes, without_frequencies


@dataclass(frozen=True)
class PackedIncrements:
    """``I_0 .. I_n`` from :mod:`fastpicard.increments`."""

    problem: Problem
    levels: tuple[Level, ...]

    def to_order(self, n: int) -> PackedIncrements:
        """The same up to order ``n``; only what is new is computed."""
        return PackedIncrements(self.problem, levels(self.problem, n, self.levels))

    def entry(self, k: int, i: int, j: int) -> Modes:
        """Entry ``(i, j)`` of ``I_k``."""
        return to_modes(self.problem, [self.levels[k].columns[j][i]])

    def total(self, i: int, j: int) -> Modes:
        """Entry ``(i, j)`` of the sum of all increments."""
        return to_modes(self.problem, (level.columns[j][i] for level in self.levels))

    def whole_turns(self, k: int, i: int, j: int) -> Modes:
        """The same after a time in which every angle makes whole turns: powers of that time."""
        return to_modes(self.problem, [without_frequencies(self.problem, self.levels[k].columns[j][i])])


@dataclass(frozen=True)
class SeriesIncrements:
    """``I_0 .. I_n`` as matrices of series: incommensurate frequencies, powers of ``t`` in ``P``."""

    P: SeriesMatrix
    levels: tuple[SeriesMatrix, ...]

    def to_order(self, n: int) -> SeriesIncrements:
        """The same up to order ``n``; only what is new is computed."""
        levels = list(self.levels[:n + 1])
        while len(levels) <= n:
            levels.append((self.P @ levels[-1]).integrate())
        return SeriesIncrements(self.P, tuple(levels))

    def entry(self, k: int, i: int, j: int) -> Modes:
        """Entry ``(i, j)`` of ``I_k``."""
        return self.levels[k].rows[i][j]

    def total(self, i: int, j: int) -> Modes:
        """Entry ``(i, j)`` of the sum of all increments."""
        modes: Modes = {}
        for level in self.levels:
            algebra.add_modes(modes, level.rows[i][j])
        return modes

    def whole_turns(self, k: int, i: int, j: int) -> Modes:
        """The same after a time in which every angle makes whole turns: powers of that time."""
        modes: Modes = {}
        for (kind, (_, phase), monomial), f in self.entry(k, i, j).items():
            turned, angle = algebra.orient(((), phase))
            algebra.add_reflected(modes, kind, turned, angle, monomial, f)
        return modes


Increments = PackedIncrements | SeriesIncrements


def first_increments(P: SeriesMatrix, columns: list[tuple[Modes, ...]], n: int) -> Increments:
    """``I_0 .. I_n`` for the given columns, packed where the frequencies of ``P`` have a common unit."""
    packed = problem(P.rows, columns)
    if packed is not None:
        return PackedIncrements(packed, ()).to_order(n)
    rows = tuple(zip(*columns, strict=True))
    return SeriesIncrements(P, (SeriesMatrix(rows, P.t),)).to_order(n)


def identity_columns(size: int) -> list[tuple[Modes, ...]]:
    """The columns of the identity matrix."""
    one = algebra.constant({ONE: fmpq(1)})
    return [tuple(one if i == j else {} for i in range(size)) for j in range(size)]
