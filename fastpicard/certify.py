r"""Certified charts: every rectangle of the parameters STABLE, UNSTABLE or UNDECIDED, proved for the true equation.

1. Where ``y'' = q(t) y`` with q > 0 at all times nothing need be computed: solutions are convex and grow.
2. The rest of the chart fixes the order n: the a-priori remainder there must not exceed ``1e-13``.
3. On rectangles so small that a Taylor polynomial of low degree leaves out next to nothing, the exact iterate is
   recentred (module ``local``), and what decides becomes Taylor models (module ``criteria``).
4. Undecided rectangles are halved, across the direction in which the undecided function varies more, until their
   area is what was asked for, or the time is over.  Halving costs additions only; signs once proved are inherited.

Everything that is not exact is bounded on the way: the remainder of Picard's iteration, what the Taylor polynomials
leave out, rounding.  A rectangle that is decided is decided for every point in it.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from flint import arb, ctx
from sympy import Symbol

from fastpicard import plotting
from fastpicard.charted import Axis, Charted, read_chart
from fastpicard.criteria import Criterion, criterion
from fastpicard.errors import BadInputError
from fastpicard.evaluate import Values, exact_number, numpy, upper_float
from fastpicard.floquet import FloquetMatrix
from fastpicard.local import BITS, LocalMap, Rectangles, amplitudes, common_bound, convex, grid, order_for, shortened
from fastpicard.remainder import a_priori
from fastpicard.stability import Verdict
from fastpicard.taylormodels import Models, joined, size, stacked
from fastpicard.vectorise import Collapsed

Array = Any
REMAINDER = 1e-13  # of every entry, on all rectangles that are not decided by convexity
TAIL = 1e-10  # what a Taylor polynomial may leave out of an entry
START = 12  # rectangles along each axis to begin with
CHUNK = 8192  # rectangles at a time
CODES: Mapping[str, int] = {"STABLE": 1, "UNSTABLE": -1, "UNDECIDED": 0}


@dataclass(frozen=True)
class CertifiedChart:
    """Rectangles of two parameters with verdicts that are proved for the true equation.

    Attributes
    ----------
    x, y : Axis                     ``.symbol``, ``.lo``, ``.hi``
    cells : array, shape (m, 4)     x from, x to, y from, y to; together they tile the chart
    codes : array, shape (m,)       1 stable, -1 unstable, 0 undecided
    order : int                     of the iterate that was used
    remainder : float               its proved distance from the truth, in every entry
    criterion : str                 what was asked of the signs
    seconds : float                 what it took, building included
    tubes : tuple of Tube           boundaries to draw, see :meth:`with_tubes`
    """

    x: Axis
    y: Axis
    cells: Array = field(repr=False)
    codes: Array = field(repr=False)
    order: int
    remainder: float
    criterion: str
    seconds: float
    tubes: tuple[Any, ...] = field(default=(), repr=False)

    @property
    def areas(self) -> Array:
        """The area of every cell."""
        return (self.cells[:, 1] - self.cells[:, 0]) * (self.cells[:, 3] - self.cells[:, 2])

    def fraction(self, verdict: Verdict) -> float:
        """The part of the chart's area with this verdict."""
        whole = (self.x.hi - self.x.lo) * (self.y.hi - self.y.lo)
        return float(self.areas[self.codes == CODES[verdict.name]].sum() / whole)

    @property
    def undecided(self) -> float:
        """The part of the chart's area that is not decided."""
        return self.fraction(Verdict.UNDECIDED)

    def verdict(self, x: Any, y: Any) -> Verdict:
        """The verdict on one point, of the cell that holds it.

        Raises
        ------
        BadInputError
            if the point is outside the chart.
        """
        balls = [_ball(exact_number(z, "a coordinate")) for z in (x, y)]
        (px, py), (qx, qy) = [-upper_float(-z) for z in balls], [upper_float(z) for z in balls]
        c = self.cells
        inside = (c[:, 0] <= qx) & (px <= c[:, 1]) & (c[:, 2] <= qy) & (py <= c[:, 3])
        found = set(self.codes[inside].tolist())
        if not found:
            raise BadInputError(f"the point ({px}, {py}) must be in the chart {self.x.symbol} in [{self.x.lo}, "
                                f"{self.x.hi}], {self.y.symbol} in [{self.y.lo}, {self.y.hi}].  Certify a larger one.")
        code = found.pop() if len(found) == 1 else 0
        name = next(name for name, value in CODES.items() if value == code)
        reason = (f"the point lies in a rectangle that is proved {name.lower()} by {self.criterion}" if code
                  else "the point lies in a rectangle that is not decided, or on the edge of two unlike ones")
        return Verdict(name, reason)

    def with_tubes(self, tubes: Any) -> CertifiedChart:
        """The same chart with the boundaries that :func:`tubes` found in the plane of its axes: lines of its plot."""
        return replace(self, tubes=tuple(tubes.pieces))

    def plot(self, ax: Any = None, xlabel: str | None = None, ylabel: str | None = None,
             title: str | None = None) -> Any:
        """The chart as a matplotlib picture, undecided cells black; returns the axes.  Labels may carry units."""
        return plotting.certified(self, ax, xlabel, ylabel, title)

    def __repr__(self) -> str:
        parts = ", ".join(f"{name.lower()} {self.fraction(Verdict(name)):.6g}" for name in CODES)
        return (f"<CertifiedChart of {self.x.symbol} in [{self.x.lo:g}, {self.x.hi:g}], {self.y.symbol} in "
                f"[{self.y.lo:g}, {self.y.hi:g}]: {parts}; {len(self.codes)} cells, order {self.order}, "
                f"{self.seconds:.1f} s>")


def _ball(number: Any) -> Any:
    return number if isinstance(number, arb) else arb(number)


def certify(F: FloquetMatrix, x: tuple[Symbol, Any, Any], y: tuple[Symbol, Any, Any], seconds: float = 10,
            fixed: Values | None = None, modes: Any = None, undecided: float = 1e-4,
            progress: bool | Callable[[float, float], None] = False) -> CertifiedChart:
    """A chart of two parameters in which every verdict is proved for the true equation.

    Parameters
    ----------
    F : FloquetMatrix
        of any order: the order that is needed is found.
    x, y : (Symbol, lo, hi)
    seconds : float         when to stop halving; the models are built before that, whatever it takes
    fixed : {Symbol: number}    for the other parameters
    modes : sequence of {Symbol: expression}, optional
        the system consists of several equations like F's, with these expressions in place of its parameters:
        numbers times powers of x's and y's symbols.  It is stable where all of them are.
    undecided : float       the part of the area that may stay undecided: where to stop
    progress : bool or function
        True for a line of text on stderr; a function is called with (seconds passed, undecided part).

    Returns
    -------
    CertifiedChart

    Raises
    ------
    BadInputError, BadTypeError, MissingParameterError
        if the axes, modes or fixed values are not as described.

    Notes
    -----
    Stable means bounded solutions; with damping, asymptotically stable.  Mathieu's equation, a in [-1, 5], b in [0, 6]:
    all but 1e-4 of the area in some 10 s.  See ``benchmarks/charts.py``.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 0)
    >>> chart = certify(F, (a, -0.5, 1), (b, 0, 1), undecided=0.01)
    >>> chart.undecided < 0.01
    True
    >>> chart.verdict(-0.1, 0.5)
    Verdict.STABLE
    """
    start = time.perf_counter()
    chart = read_chart(F, x, y, fixed, modes)
    rule = criterion(chart.F)
    boxes, done = _by_convexity(chart)
    state = _State(chart, rule, start, seconds, undecided, progress, done)
    order, error = 0, 0.0
    if len(boxes):
        local, order, error = _local_maps(chart, rule, boxes)
        state.refine(_chunks(state, boxes, local))
    return state.result(order, error)


# -- before anything is computed -----------------------------------------------


def _by_convexity(chart: Charted) -> tuple[Rectangles, list[tuple[Array, Array]]]:
    """The rectangles that are left, and those that are unstable by convexity."""
    np = numpy()
    first, second = chart.axes
    boxes = grid(chart.axes, (first.edges(START), second.edges(START)))
    done: list[tuple[Array, Array]] = []
    for _ in range(24):
        proved = np.logical_or.reduce([convex(chart, member, boxes) for member in chart.members])
        if proved.any():
            done.append((_cells(chart.axes, boxes.lower[:, proved], boxes.upper[:, proved]),
                         np.full(int(proved.sum()), -1, dtype=np.int8)))
        boxes = boxes.at(~proved)
        if not len(boxes):
            break
        floor, some = 0.0, np.zeros(len(boxes), dtype=bool)
        for corner in _corners(boxes):
            there = np.logical_or.reduce([convex(chart, member, corner) for member in chart.members])
            some |= there
            floor = max(floor, float(np.where(there, 0.0, _speed(chart, corner)).max()))
        split = some & (_speed(chart, boxes) > 1.3 * floor)
        if not split.any():
            break
        part = boxes.at(split)
        along = np.argmin([_speed(chart, flat) for flat in _flattened(part)], axis=0)
        boxes = _joined(boxes.at(~split), _bisected(chart, part, along))
    return boxes, done


def _speed(chart: Charted, boxes: Rectangles) -> Array:
    """The largest row sum of ``sup |P|`` on every rectangle."""
    np = numpy()
    return np.max([amplitudes(chart, member, boxes).sum(axis=1).max(axis=0) for member in chart.members], axis=0)


def _joined(left: Rectangles, right: Rectangles) -> Rectangles:
    np = numpy()
    return Rectangles(np.concatenate([left.lower, right.lower], axis=1),
                      np.concatenate([left.upper, right.upper], axis=1))


def _corners(boxes: Rectangles) -> list[Rectangles]:
    np = numpy()
    found = []
    for i in (0, 1):
        for j in (0, 1):
            point = np.stack([(boxes.lower, boxes.upper)[i][0], (boxes.lower, boxes.upper)[j][1]])
            found.append(Rectangles(point, point))
    return found


def _bisected(chart: Charted, boxes: Rectangles, along: Array) -> Rectangles:
    """The rectangles halved, in the chart's parameters, along the axes given: 0 or 1 for each."""
    np = numpy()
    lower, upper = [], []
    for k, axis in enumerate(chart.axes):
        low, high = boxes.lower[:, along == k], boxes.upper[:, along == k]
        middle = shortened(axis.inner((axis.outer(low[k]) + axis.outer(high[k])) / 2))
        middle = np.clip(middle, low[k], high[k])
        for part in (0, 1):
            a, b = low.copy(), high.copy()
            (b, a)[part][k] = middle
            lower.append(a)
            upper.append(b)
    return Rectangles(np.concatenate(lower, axis=1), np.concatenate(upper, axis=1))


def _flattened(boxes: Rectangles) -> list[Rectangles]:
    """The rectangles with one of their sides shrunk to its end nearest to 0."""
    np = numpy()
    found = []
    for k in (0, 1):
        lower, upper = boxes.lower.copy(), boxes.upper.copy()
        end = np.where(abs(lower[k]) < abs(upper[k]), lower[k], upper[k])
        end = np.where((lower[k] < 0) & (upper[k] > 0), 0.0, end)
        lower[k] = upper[k] = end
        found.append(Rectangles(lower, upper))
    return found


def _cells(axes: tuple[Axis, Axis], lower: Array, upper: Array) -> Array:
    """Rectangles in the chart's parameters: shape (m, 4)."""
    np = numpy()
    sides = [np.sort(np.stack([axis.outer(lower[k]), axis.outer(upper[k])]), axis=0) for k, axis in enumerate(axes)]
    return np.stack([sides[0][0], sides[0][1], sides[1][0], sides[1][1]], axis=1)


# -- models of what decides ----------------------------------------------------


def _local_maps(chart: Charted, rule: Criterion, boxes: Rectangles) -> tuple[list[LocalMap], int, float]:
    """One map for each member, from an iterate whose remainder on all rectangles is small."""
    majorant = common_bound([amplitudes(chart, member, boxes) for member in chart.members])
    with ctx.workprec(BITS):
        period = chart.period / (2 if rule.half else 1)
        order = order_for(majorant, period, REMAINDER)
        error = max(upper_float(x.upper()) for x in a_priori(majorant, period, order).entries())
        F = chart.F.to_order(order)
        collapsed = Collapsed([modes for row in rule.entries(F) for modes in row], F.t)
        maps = [LocalMap(chart.polynomials(collapsed, member), [error] * (F.shape[0] * F.shape[1]))
                for member in chart.members]
    return maps, order, error


def _functions(rule: Criterion, maps: list[LocalMap], boxes: Rectangles, degree: int, rows: int) -> Models:
    """What decides, for all members: shape (size, functions, m)."""
    found = []
    for local in maps:
        entries = local.models(boxes, degree)
        parts = [Models(degree, entries.c[:, e], entries.e[e]) for e in range(rows * rows)]
        found += rule.functions([parts[k:k + rows] for k in range(0, len(parts), rows)])
    return stacked(found)


@dataclass
class Chunk:
    """Undecided rectangles with models: halves of rectangles, given exactly by the place inside their first one.

    ``rows`` are the places of the models' functions among all of them, ``signs`` the signs of all of them.
    """

    lower: Array
    upper: Array
    models: Models
    rows: Array
    signs: Array


def _chunks(state: _State, boxes: Rectangles, maps: list[LocalMap]) -> list[Chunk]:
    """The first models; rectangles that are too large for their degree are halved."""
    np = numpy()
    rows = state.chart.F.shape[0]
    degree = 8 if rows <= 4 else 6
    found = []
    for round_ in range(16):
        beyond = _beyond(maps, boxes, degree)
        large = beyond > ((TAIL if rows == 2 else TAIL / 100) if round_ < 15 else np.inf)
        good = np.flatnonzero(~large)
        for start in range(0, len(good), 48):
            part = boxes.at(good[start:start + 48])
            models = _functions(state.rule, maps, part, degree, rows)
            count = models.c.shape[1]
            chunk = Chunk(part.lower, part.upper, models, np.arange(count),
                          np.zeros((count, len(part)), dtype=np.int8))
            state.progress_line()
            found += state.settle(chunk)
        if not large.any():
            break
        boxes = boxes.at(large)
        narrow = [_narrowed(boxes, k) for k in (0, 1)]
        boxes = _bisected(state.chart, boxes, np.argmin([_beyond(maps, part, degree) for part in narrow], axis=0))
    return found


def _beyond(maps: list[LocalMap], boxes: Rectangles, degree: int) -> Array:
    """What a Taylor polynomial leaves out, the largest of all entries."""
    return numpy().max([local.beyond(boxes, degree).max(axis=0) for local in maps], axis=0)


def _narrowed(boxes: Rectangles, k: int) -> Rectangles:
    """The same centres with half the sides along one axis."""
    lower, upper = boxes.lower.copy(), boxes.upper.copy()
    lower[k], upper[k] = (lower[k] + boxes.center[k]) / 2, (upper[k] + boxes.center[k]) / 2
    return Rectangles(lower, upper)


class _State:
    """What is decided, what is not, and how long it may take."""

    def __init__(self, chart: Charted, rule: Criterion, start: float, seconds: float, target: float,
                 progress: bool | Callable[[float, float], None], done: list[tuple[Array, Array]]) -> None:
        self.chart, self.rule, self.start, self.seconds, self.target = chart, rule, start, seconds, target
        self.progress, self.done = progress, done
        self.whole = (chart.axes[0].hi - chart.axes[0].lo) * (chart.axes[1].hi - chart.axes[1].lo)
        self.chunks: list[Chunk] = []
        self.last = 0.0

    def area(self, chunk: Chunk) -> float:
        c = _cells(self.chart.axes, chunk.lower, chunk.upper)
        return float(((c[:, 1] - c[:, 0]) * (c[:, 3] - c[:, 2])).sum()) / self.whole

    def verdicts(self, signs: Array) -> Array:
        """Of all members together: one unstable mode is enough."""
        np = numpy()
        members = len(self.chart.members)
        each = np.stack([self.rule.verdicts(part) for part in np.split(signs, members)])
        return np.where((each < 0).any(axis=0), -1, np.where((each > 0).all(axis=0), 1, 0))

    def settle(self, chunk: Chunk) -> list[Chunk]:
        """Record what the models decide; what is left, without functions that are known everywhere, or nothing."""
        np = numpy()
        now = chunk.models.signs()
        chunk.signs[chunk.rows] = np.where(chunk.signs[chunk.rows] != 0, chunk.signs[chunk.rows], now)
        verdicts = self.verdicts(chunk.signs)
        decided = verdicts != 0
        if decided.any():
            self.done.append((_cells(self.chart.axes, chunk.lower[:, decided], chunk.upper[:, decided]),
                              verdicts[decided].astype(np.int8)))
        left = np.flatnonzero(~decided)
        if not len(left):
            return []
        signs = chunk.signs[:, left]
        open_ = (signs[chunk.rows] == 0).any(axis=1)
        models = chunk.models.at(left)
        return [Chunk(chunk.lower[:, left], chunk.upper[:, left], Models(models.degree, models.c[:, open_],
                models.e[open_]), chunk.rows[open_], signs)]

    def refine(self, chunks: list[Chunk]) -> None:
        """Halve until the target or the end of the time."""
        while chunks:
            rest = sum(map(self.area, chunks))
            if rest <= self.target or self.over():
                break
            halvings = max(1.0, 1.0 + numpy().log2(rest / self.target))
            new: list[Chunk] = []
            for k, chunk in enumerate(chunks):
                if self.over():
                    new += chunks[k:]
                    break
                self.progress_line(rest)
                new += self.halved_twice(chunk, halvings)
            chunks = new
        self.chunks = chunks

    def over(self) -> bool:
        return time.perf_counter() - self.start > self.seconds

    def halved_twice(self, chunk: Chunk, halvings: float) -> list[Chunk]:
        """Two halvings, on the average one of each side."""
        parts = [chunk]
        for _ in range(2):
            parts = [p for part in parts for p in self.settle(_halved(part, self.chart.axes))]
        result: list[Chunk] = []
        for part in parts:
            part.models = _lower_degree(part.models, halvings)
            result += _split(part)
        return result

    def progress_line(self, rest: float | None = None) -> None:
        """Tell how far it is, ten times a second at most."""
        now = time.perf_counter() - self.start
        if not self.progress or now - self.last < 0.1:
            return
        self.last = now
        if callable(self.progress):
            self.progress(now, 1.0 if rest is None else rest)
        else:
            text = "building" if rest is None else f"undecided {rest:.2e} of the area"
            sys.stderr.write(f"\r{now:6.1f} s  {text:40}")
            sys.stderr.flush()

    def result(self, order: int, error: float) -> CertifiedChart:
        """The chart."""
        np = numpy()
        parts = self.done + [(_cells(self.chart.axes, c.lower, c.upper), np.zeros(c.lower.shape[1], dtype=np.int8))
                             for c in self.chunks]
        if self.progress is True:
            sys.stderr.write("\r" + " " * 60 + "\r")
        return CertifiedChart(*self.chart.axes, np.concatenate([c for c, _ in parts]),
                              np.concatenate([v for _, v in parts]), order, error, self.rule.name,
                              time.perf_counter() - self.start)


def _halved(chunk: Chunk, axes: tuple[Axis, Axis]) -> Chunk:
    """Every rectangle cut in two, across the direction in which its undecided functions vary more."""
    np = numpy()
    c = abs(chunk.models.c)
    open_ = chunk.signs[chunk.rows] == 0
    total = c[1] + c[2] + 1e-300
    lean = np.where(open_, (c[1] - c[2]) / total, 0.0).sum(axis=0)
    along_y = lean < 0
    places = [np.flatnonzero(along_y == y) for y in (False, True)]
    lower, upper, models, signs = [], [], [], []
    for y, chosen in zip((False, True), places, strict=True):
        if not len(chosen):
            continue
        part = chunk.models.at(chosen)
        k = int(y)
        middle = (chunk.lower[k, chosen] + chunk.upper[k, chosen]) / 2
        for high in (False, True):
            a, b = chunk.lower[:, chosen].copy(), chunk.upper[:, chosen].copy()
            (a if high else b)[k] = middle
            lower.append(a)
            upper.append(b)
            models.append(part.halved(y, high))
            signs.append(chunk.signs[:, chosen])
    return Chunk(np.concatenate(lower, axis=1), np.concatenate(upper, axis=1), joined(models), chunk.rows,
                 np.concatenate(signs, axis=1))


def _lower_degree(models: Models, halvings: float) -> Models:
    """A lower degree where what is dropped stays invisible to the end."""
    np = numpy()
    for degree in (2, 4):
        if models.degree > degree:
            keep = size(degree)
            dropped, kept = abs(models.c[keep:]).sum(axis=0), abs(models.c[1:3]).sum(axis=0)
            if np.all(dropped <= kept * (0.02 * 2.0**-halvings)):
                return models.truncated(degree)
    return models


def _split(chunk: Chunk) -> list[Chunk]:
    count = chunk.lower.shape[1]
    if count <= CHUNK:
        return [chunk]
    result = []
    for start in range(0, count, CHUNK // 2):
        part = slice(start, start + CHUNK // 2)
        result.append(Chunk(chunk.lower[:, part], chunk.upper[:, part],
                            Models(chunk.models.degree, chunk.models.c[..., part], chunk.models.e[..., part]),
                            chunk.rows, chunk.signs[:, part]))
    return result


__all__ = ["CertifiedChart", "certify"]
