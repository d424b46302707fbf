r"""A periodic matrix at numbers: ``P(t) = sum over q of (C_q cos qt + S_q sin qt)`` in balls.

Everything rigorous starts here.  Parameters become balls (python-flint ``arb``: a
midpoint and a radius that provably contains the truth), so a number, a ball and a
whole interval of values are one case.  The entries of

    Pbar = sup over t of |P(t)|  <=  sum over q of sqrt(C_q**2 + S_q**2)

bound every majorant of the package.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from sys import maxsize
from typing import Any

from flint import arb, arb_mat

from fastpicard.evaluate import Point
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import COS

Place = tuple[int, int]
Wave = tuple[Any, Any, Any]  # q, the cosine's amplitude, the sine's: balls


@dataclass(frozen=True)
class Harmonics:
    """``P`` at numbers.

    Attributes
    ----------
    size : int                              rows of ``P``
    waves : {(i, j): list of (q, C, S)}     entry ``(i, j)`` is the sum of ``C cos qt + S sin qt``; no zero entries
    """

    size: int
    waves: Mapping[Place, list[Wave]]

    @cached_property
    def bound(self) -> Any:
        """``Pbar``: an ``arb_mat`` whose entries bound ``|P(t)|`` at every real ``t``."""
        entries = [[arb(0)] * self.size for _ in range(self.size)]
        for (i, j), waves in self.waves.items():
            entries[i][j] = sum((_amplitude(c, s) for _, c, s in waves), arb(0)).upper()
        return arb_mat(entries)

    @cached_property
    def highest(self) -> float:
        """An upper bound of the frequencies, as a float."""
        return max((float(abs(q).upper()) for waves in self.waves.values() for q, _, _ in waves), default=0.0)

    @cached_property
    def is_finite(self) -> bool:
        """Whether no ball contains a pole."""
        return all(x.is_finite() for waves in self.waves.values() for wave in waves for x in wave)

    @cached_property
    def is_constant(self) -> bool:
        """Whether ``P`` does not depend on time."""
        return all(q == 0 or c == 0 == s for waves in self.waves.values() for q, c, s in waves)

    @cached_property
    def is_wide(self) -> bool:
        """Whether ``P`` stands for many matrices: a coefficient has a radius that is not rounding."""
        return self.accuracy < 32

    @cached_property
    def accuracy(self) -> int:
        """The bits of the least accurate coefficient."""
        return min((x.rel_accuracy_bits() for waves in self.waves.values() for wave in waves for x in wave),
                   default=maxsize)

    @cached_property
    def reversal(self) -> tuple[int, ...] | None:
        """Signs ``s`` with ``s P(-t) s = -P(t)``, ``s = diag(s_i)``, or None.

        Then ``Phi(-t) = s Phi(t) s``: the second half of a period is the first one mirrored.
        """
        return reversing_signs(self.size, {place: _parities(waves) for place, waves in self.waves.items()})

    def shifted(self, start: Any) -> Harmonics:
        """``P(start + t)``."""
        def turned(wave: Wave) -> Wave:
            q, c, s = wave
            cos, sin = (q * start).cos(), (q * start).sin()
            return q, c * cos + s * sin, s * cos - c * sin

        return Harmonics(self.size, {place: [turned(wave) if wave[0] != 0 else wave for wave in waves]
                                     for place, waves in self.waves.items()})


def reversing_signs(size: int, parities: Mapping[Place, tuple[bool, bool]]) -> tuple[int, ...] | None:
    """Signs ``s_i``, the first of them 1, that reverse time, if entry ``(i, j)`` has an even part, an odd one."""
    links = [(i, j, even, odd) for (i, j), (even, odd) in parities.items() if even or odd]  # not those that vanish
    if any(even and odd or i == j and even for i, j, even, odd in links):
        return None
    signs: dict[int, int] = {}
    while len(signs) < size:
        signs[min(set(range(size)) - set(signs))] = 1
        while new := {k: (-1 if even else 1) * signs[m] for i, j, even, _ in links for k, m in ((i, j), (j, i))
                      if m in signs and k not in signs}:
            signs.update(new)
    if any(signs[i] * signs[j] != (-1 if even else 1) for i, j, even, _ in links):
        return None
    return tuple(signs[i] for i in range(size))


def _amplitude(c: Any, s: Any) -> Any:
    c, s = abs(c).upper(), abs(s).upper()  # the square of a ball around 0 would reach below 0
    return (c * c + s * s).sqrt() if c > 0 and s > 0 else c + s


def _parities(waves: list[Wave]) -> tuple[bool, bool]:
    """Whether an entry has an even part, and an odd one."""
    return any(not c.is_zero() for _, c, _ in waves), any(not s.is_zero() for _, _, s in waves)


def harmonics(P: SeriesMatrix, values: Mapping[Any, Any]) -> Harmonics:
    """``P`` at exact parameter values (see :mod:`fastpicard.parameters`), in balls of the working precision."""
    point = Point(arb(0), values)
    waves: dict[Place, list[Wave]] = {}
    for i, row in enumerate(P.rows):
        for j, modes in enumerate(row):
            found: dict[Any, Wave] = {}
            for (kind, angle, monomial), f in modes.items():
                amplitude = point.monomial(monomial) * f[0]
                cos, sin = _turned(point, angle, amplitude)
                if kind != COS:
                    cos, sin = sin, -cos
                q, c, s = found.get(angle[0], (point.linear(angle[0]), arb(0), arb(0)))
                found[angle[0]] = q, c + cos, s - sin
            if found:
                waves[i, j] = [(q, c, arb(0) if q == 0 else s) for q, c, s in found.values()]
    return Harmonics(P.shape[0], waves)


def _turned(point: Point, angle: Any, amplitude: Any) -> tuple[Any, Any]:
    """``amplitude`` times cosine and sine of the phase."""
    if not angle[1]:
        return amplitude, arb(0)
    phase = point.linear(angle[1])
    return amplitude * phase.cos(), amplitude * phase.sin()
