r"""The Floquet matrix over half a period, where time can be reversed.

If signs ``s = diag(+-1)`` reverse time, ``s P(-t) s = -P(t)`` (cosine driving does), the second half of a period is
the first one mirrored: with ``X = Phi(T/2)``,

    Phi(T) = s X**-1 s X,        X = [[A, B], [C, D]] in blocks of s = +1 and s = -1.

The boundaries of stability then fall apart into factors.  ``Phi(T) -+ 1 = s X**-1 (s X -+ X s)``, and
``s X - X s = [[0, 2 B], [-2 C, 0]]``, ``s X + X s = [[2 A, 0], [0, -2 D]]``, so up to signs and ``det X``

    det(Phi(T) - 1) = 4**N det B det C,        det(Phi(T) + 1) = 4**N det A det D.

Where P has no diagonal, as for one degree of freedom, ``det X = 1`` and

    trace - 2 = 4 B C,        trace + 2 = 4 A D:

the zeros of the trace minus 2, double where two boundaries touch, become simple zeros of B and of C.  Each entry is
the boundary function of a Sturm-Liouville problem on half the period: ``C = 0`` (even) and ``B = 0`` (odd) belong to
solutions of period T, ``A = 0`` (even) and ``D = 0`` (odd) to those of antiperiod T.  Half a period also takes far
fewer iterates: 56 instead of 79 for thirty digits of Mathieu's equation at ``|a| + |b| = 4``.

**After half a period** an angle that makes ``m`` whole turns in T has made ``m`` half turns, so every cosine is
``(-1)**m`` and every sine 0: as exact as at the period.
"""

from __future__ import annotations

from flint import fmpq

from fastpicard import modes as algebra
from fastpicard.coordinates import Problem
from fastpicard.errors import BadInputError
from fastpicard.floquet import FloquetMatrix
from fastpicard.harmonics import reversing_signs
from fastpicard.iteration import PackedIncrements
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import Linear, Modes, orient
from fastpicard.period import turns_of, whole_turns
from fastpicard.ring import ONE, Polynomial, multiply, to_expression
from fastpicard.structure import Structure, structure
from fastpicard.unpacking import to_modes, without_frequencies

Signs = tuple[int, ...]


def reversal(P: SeriesMatrix) -> Signs | None:
    """Signs ``s`` with ``s P(-t) s = -P(t)`` at all values of the parameters, the first of them 1, or None.

    Exact: an entry has an even part unless ``P(t) + P(-t)`` vanishes as a series, an odd one unless their difference
    does.
    """
    parities = {}
    for i, row in enumerate(P.rows):
        for j, modes in enumerate(row):
            if modes:
                back = _backwards(modes)
                parities[i, j] = bool(algebra.total(modes, back)), bool(algebra.total(modes, algebra.negative(back)))
    return reversing_signs(P.shape[0], parities)


def _backwards(modes: Modes) -> Modes:
    """A series without powers of time at ``-t``."""
    result: Modes = {}
    for (kind, (frequency, phase), monomial), f in modes.items():
        turned, angle = orient((tuple((m, -c) for m, c in frequency), phase))
        algebra.add_reflected(result, kind, turned, angle, monomial, f)
    return result


def known_structure(F: FloquetMatrix) -> Structure:
    """What ``P`` says of the multipliers at all values of the parameters."""
    return structure(F.P, {}, reversal(F.P) is not None, lambda q: bool(whole_turns(q, F.length)))


def half_period(F: FloquetMatrix) -> list[list[Modes]]:
    """The n-th iterate at half the period, exactly: polynomials in the parameters, as constants."""
    return after_quarters(F, 2)


def quarter_periods(F: FloquetMatrix, n: int, count: int) -> list[list[list[Modes]]]:
    """The n-th iterates over the first quarters of the period, each from its beginning to its end, exactly.

    Their product, the last one first, is near the true matrix where that of the whole way would take far more orders.
    """
    starts = [{m: c * k / 4 for m, c in F.length.items()} for k in range(count)]
    return [after_quarters(FloquetMatrix(F.P.shifted(start), F.t, n, F.period), 1) for start in starts]


def after_quarters(F: FloquetMatrix, quarters: int) -> list[list[Modes]]:
    """The n-th iterate after so many quarters of the period, exactly: polynomials in the parameters, as constants."""
    time = {m: c * quarters / 4 for m, c in F.length.items()}
    powers: list[Polynomial] = [{ONE: fmpq(1)}]  # time**r / r!
    for r in range(1, F.n + 1):
        powers.append(multiply(powers[-1], {m: c / r for m, c in time.items()}))
    return [[algebra.frozen(_turned(F, i, j, quarters), powers) for j in range(F.shape[1])] for i in range(F.shape[0])]


def _turned(F: FloquetMatrix, i: int, j: int, quarters: int) -> Modes:
    """An entry after a time in which every angle makes quarter turns: powers of that time."""
    found = F.increments
    if isinstance(found, PackedIncrements):
        problem, turns = found.problem, _unit_turns(F, found.problem) * quarters
        return to_modes(problem, without_frequencies(problem, found.iterate.sums[j][i], turns))
    modes: Modes = {}
    for (kind, (frequency, phase), monomial), f in found.total(i, j).items():
        turned, angle = orient(((), phase))
        kind, negative = algebra.quarter_turned(kind, _turns(F, frequency) * quarters)
        algebra.add_reflected(modes, kind, turned, angle, monomial, -f if negative else f)
    return modes


def _turns(F: FloquetMatrix, frequency: Linear) -> int:
    """How many whole turns an angle of this frequency makes in the period."""
    turns = whole_turns(frequency, F.length)
    if turns is None:
        count = to_expression(turns_of(frequency, F.length))
        raise BadInputError("after half a period every angle must have made a known number of half turns, but one has "
                            f"made {count} of them.  Put a number in place of the Symbol.")
    return turns


def _unit_turns(F: FloquetMatrix, problem: Problem) -> int:
    """How many whole turns the unit of frequency makes in the period; every frequency is a multiple of it."""
    moving = any(angle[0] for row in F.P.rows for modes in row for _, angle, _ in modes)
    return _turns(F, algebra.linear(dict([problem.coordinates.unit]))) if moving else 0
