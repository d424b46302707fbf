r"""The Floquet matrix on rectangles, as a product of quarters.

The order that an iterate needs grows with the length of the way, and its terms as a power of the order.  So the way,
a period or half of one, is gone in quarters of the period,

    Phi(T) = Phi(T, 3T/4) Phi(3T/4, T/2) Phi(T/2, T/4) Phi(T/4, 0):

an exact iterate for each (module ``halfway``), recentred on every rectangle (module ``local``), and a product of
Taylor models.  The determinant of the whole is known without them (Liouville),

    det Phi(T) = exp(T times the mean of the trace of P),

and with no digit lost to large entries.
"""

from __future__ import annotations

from typing import Any

from flint import arb

from fastpicard.charted import Charted, Member
from fastpicard.criteria import Criterion
from fastpicard.determinants import product
from fastpicard.evaluate import Point, numpy, upper_float
from fastpicard.halfway import quarter_periods
from fastpicard.local import BITS, LocalMap, amplitudes, common_bound, order_for, polynomials
from fastpicard.modes import COS
from fastpicard.precision import working
from fastpicard.rectangles import Rectangles
from fastpicard.remainder import a_priori
from fastpicard.taylormodels import Models, exponential

Array = Any
REMAINDER = 1e-13  # of every entry of a quarter, on all rectangles
HIGHEST = 100  # order over a quarter: the terms of an iterate in two parameters grow as the fourth power


class Way:
    """The true matrix of one member over the way that a criterion asks for, on rectangles.

    Parameters
    ----------
    quarters : one map each, from the first one on
    determinant : the logarithm of the determinant over the period, as a map of one polynomial
    size : int      rows of the matrix
    """

    def __init__(self, quarters: list[LocalMap], determinant: LocalMap, size: int) -> None:
        self.quarters, self.determinant, self.size = quarters, determinant, size

    def functions(self, rule: Criterion, boxes: Rectangles, degree: int) -> list[Models]:
        """What decides."""
        matrix = self._rows(self.quarters[0], boxes, degree)
        for quarter in self.quarters[1:]:
            matrix = product(self._rows(quarter, boxes, degree), matrix)
        logarithm = self.determinant.models(boxes, degree)
        return rule.functions(matrix, exponential(Models(degree, logarithm.c[:, 0], logarithm.e[0])))

    def _rows(self, quarter: LocalMap, boxes: Rectangles, degree: int) -> list[list[Models]]:
        entries = quarter.models(boxes, degree)
        parts = [Models(degree, entries.c[:, e], entries.e[e]) for e in range(self.size**2)]
        return [parts[k:k + self.size] for k in range(0, len(parts), self.size)]

    def beyond(self, boxes: Rectangles, degree: int) -> Array:
        """About what Taylor polynomials leave out of the whole way, the largest of all entries: shape (m,).

        That of a quarter is a bound; the whole varies as many times faster as there are quarters.
        """
        largest = numpy().max([quarter.beyond(boxes, degree).max(axis=0) for quarter in self.quarters], axis=0)
        return largest * float(len(self.quarters)) ** (degree + 1)


def ways(chart: Charted, rule: Criterion, boxes: Rectangles) -> tuple[list[Way], int, float]:
    """One way for each member, from iterates of one order with a small remainder, and both."""
    majorant = common_bound([amplitudes(chart, member, boxes) for member in chart.members])
    F = chart.F
    with working(BITS):
        time = chart.period / 4
        order = order_for(majorant, time, REMAINDER, HIGHEST)
        error = max(upper_float(x.upper()) for x in a_priori(majorant, time, order).entries())
    quarters: list[list[LocalMap]] = [[] for _ in chart.members]
    for rows in quarter_periods(F, order, 2 if rule.half else 4):
        found, bits = polynomials(chart, F.collapse([modes for row in rows for modes in row]), boxes, REMAINDER)
        for maps, terms in zip(quarters, found, strict=True):
            maps.append(LocalMap(terms, [error] * len(terms), bits))
    return [Way(maps, _logarithm(chart, member), F.shape[0])
            for maps, member in zip(quarters, chart.members, strict=True)], order, error


def _logarithm(chart: Charted, member: Member) -> LocalMap:
    """The period times the mean of the trace of ``P``; who asks for half the period does not ask for this."""
    total: dict[tuple[int, int], Any] = {}
    with working(BITS):
        point, length = Point(arb(0), {}), chart.period
        for (i, j), waves in chart.waves(member).items():
            for (kind, angle), terms in waves.items():
                if i == j and not angle[0]:
                    wave = point.wave(angle)
                    for place, c in terms.items():
                        mean = c * (wave.real if kind == COS else wave.imag)
                        total[place] = total.get(place, arb(0)) + mean * length
        return LocalMap([total], [0.0])
