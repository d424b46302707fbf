r"""Certified charts: every rectangle of the parameters STABLE, UNSTABLE or UNDECIDED, proved for the true equation.

1. Where ``y'' = q(t) y`` with q > 0 at all times nothing need be computed: solutions are convex and grow.
2. The rest of the chart fixes the order n of an iterate over each quarter of the period (module ``quarters``): the
   a-priori remainder there must not exceed ``1e-13``.
3. On rectangles so small that a Taylor polynomial of low degree leaves out next to nothing, the exact iterates are
   recentred (module ``local``), and what decides becomes Taylor models (module ``criteria``).
4. Undecided rectangles are halved, across the direction in which the undecided function varies more, until their
   area is what was asked for, or the time is over (module ``halving``): additions only, proved signs are inherited.

Everything that is not exact is bounded on the way: the remainder of Picard's iteration, what the Taylor polynomials
leave out, rounding.  A rectangle that is decided is decided for every point in it.
"""

from __future__ import annotations

import math
import numbers
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from sympy import Symbol

from fastpicard import plotting
from fastpicard.axes import Axis
from fastpicard.charted import Charted, images, read_chart, refuse_phases
from fastpicard.criteria import criterion
from fastpicard.errors import BadInputError, BadTypeError, printed
from fastpicard.evaluate import ball, numpy, upper_float
from fastpicard.floquet import FloquetMatrix
from fastpicard.halving import Chunk, Halving
from fastpicard.latex import interval, sentence, shown
from fastpicard.local import amplitudes, convex
from fastpicard.quarters import Way, ways
from fastpicard.rectangles import Rectangles, bisected, cells, corners, flattened, grid, joined, narrowed
from fastpicard.stability import Verdict
from fastpicard.taylormodels import stacked
from fastpicard.tubes import Tubes
from fastpicard.values import Values, exact_number

Array = Any
TAIL = 1e-10  # what a Taylor polynomial may leave out of an entry
START = 12  # rectangles along each axis to begin with
CODES: Mapping[str, int] = {"STABLE": 1, "UNSTABLE": -1, "UNDECIDED": 0}


@dataclass(frozen=True, eq=False)
class CertifiedChart:
    """Rectangles of two parameters with verdicts that are proved for the true equation.

    Attributes
    ----------
    x, y : Axis                     ``.symbol``, ``.lo``, ``.hi``
    cells : array, shape (m, 4)     x from, x to, y from, y to; together they tile the chart
    codes : array, shape (m,)       1 stable, -1 unstable, 0 undecided
    order : int                     of the iterates that were used, one for each quarter of the way
    remainder : float               the proved distance of each from the truth, in every entry
    criterion : str                 what was asked of the signs
    seconds : float                 what it took, building included
    lines : tuple of arrays, shape (2, m)    boundaries to draw, see :meth:`with_tubes`
    radius : float                  of the tubes around them, in the first parameter of the tubes; nan without tubes
    """

    x: Axis
    y: Axis
    cells: Array = field(repr=False)
    codes: Array = field(repr=False)
    order: int
    remainder: float
    criterion: str
    seconds: float
    lines: tuple[Array, ...] = field(default=(), repr=False)
    radius: float = float("nan")

    def __post_init__(self) -> None:
        for array in (self.cells, self.codes, *self.lines):
            array.flags.writeable = False

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.__post_init__()

    @property
    def areas(self) -> Array:
        """The area of every cell."""
        return (self.cells[:, 1] - self.cells[:, 0]) * (self.cells[:, 3] - self.cells[:, 2])

    def fraction(self, verdict: Verdict) -> float:
        """The part of the chart's area with this verdict; raises BadTypeError for what is none."""
        if not isinstance(verdict, Verdict):
            raise BadTypeError(f"the area is that of a verdict, but this is {verdict!r}.  Use Verdict.STABLE, "
                               "Verdict.UNSTABLE or Verdict.UNDECIDED.")
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
        balls = [ball(exact_number(z, "a coordinate")) for z in (x, y)]
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

    def with_tubes(self, tubes: Tubes, modes: Any = None) -> CertifiedChart:
        """The same chart with the boundaries that :func:`tubes` found as lines of its plot.

        Parameters
        ----------
        tubes : Tubes       of the same equation, in the plane of the chart's axes or, with modes, of F's parameters
        modes : as for :func:`certify`: every line is carried to the chart's axes, mode by mode, and drawn where the
            chart leaves open whether the system is stable

        Raises
        ------
        BadInputError
            if the tubes are of other parameters, or a mode is not two powers that can be solved for both axes.
        BadTypeError
            if these are no tubes, or ``modes`` no list of dictionaries.
        """
        if not isinstance(tubes, Tubes):
            raise BadTypeError(f"the lines are those of Tubes, but these are {tubes!r}.  Use tubes(F, x, y).")
        names = tubes.x[0], tubes.y[0]
        axes = self.x.symbol, self.y.symbol
        if modes is None and names != axes:
            raise BadInputError(f"the tubes must be in the plane of the chart's axes {axes}, but they are in that of "
                                f"{names}.  Give the modes that lead from one to the other.")
        if modes is not None and not (isinstance(modes, list | tuple) and all(isinstance(m, Mapping) for m in modes)):
            raise BadTypeError(f"modes must be a list of dictionaries, but they are {modes!r}.  Use [{{a: -1/v**2}}].")
        for mode in modes or ():
            if not set(names) <= set(mode):
                raise BadInputError(f"a mode must give both parameters {names} of the tubes, but it is {mode}.  Add "
                                    "the other one.")
        given = [piece.points(9 if modes is None else 2001) for piece in tubes.pieces]
        lines = [numpy().array(line) for line in given] if modes is None else [
            images(mode, names, axes, line) for mode in modes for line in given]
        return replace(self, lines=tuple(lines), radius=tubes.radius)

    def plot(self, ax: Any = None, xlabel: str | None = None, ylabel: str | None = None,
             title: str | None = None) -> Any:
        """The chart as a matplotlib picture, undecided cells black; returns the axes.  Labels may carry units.

        Raises
        ------
        NotInstalledError
            without matplotlib.
        """
        return plotting.certified(self, ax, xlabel, ylabel, title)

    def _parts(self) -> str:
        return ", ".join(f"{name.lower()} {self.fraction(Verdict(name)):.6g}" for name in CODES)

    def __repr__(self) -> str:
        return (f"<CertifiedChart of {self.x.symbol} in [{self.x.lo:g}, {self.x.hi:g}], {self.y.symbol} in "
                f"[{self.y.lo:g}, {self.y.hi:g}]: {self._parts()}; {len(self.codes)} cells, order {self.order}, "
                f"{self.seconds:.1f} s>")

    def _repr_latex_(self) -> str:
        return shown(*(interval(axis.symbol, axis.lo, axis.hi) for axis in (self.x, self.y)), sentence(self._parts()))


def certify(F: FloquetMatrix, x: tuple[Symbol, Any, Any], y: tuple[Symbol, Any, Any], seconds: float = 10,
            fixed: Values | None = None, modes: Any = None, undecided: float = 1e-4,
            progress: bool | Callable[[float, float], None] = False) -> CertifiedChart:
    """A chart of two parameters in which every verdict is proved for the true equation.

    Parameters
    ----------
    F : FloquetMatrix
        of any order: the order that is needed is found.
    x, y : (Symbol, lo, hi)
    seconds : float         for rectangles, after the exact iterate is built: what is not decided then stays open, nor
        is halved what has filled a gigabyte
    fixed : {Symbol: number}    for the other parameters
    modes : sequence of {Symbol: expression}, optional
        the system consists of several equations like F's, with these expressions in place of its parameters, all but
        the fixed ones: numbers, 0 too, times powers of x's and y's symbols.  It is stable where all of them are.
    undecided : float       the part of the area that may stay undecided: where to stop
    progress : bool or function
        True for a line of text on stderr; a function is called with (seconds passed, undecided part).

    Returns
    -------
    CertifiedChart

    Raises
    ------
    BadInputError, BadTypeError, MissingParameterError
        if the axes, modes or fixed values are not as described; if iterates of more than order 100 are needed, so
        far from 0 that ``sup |P|`` is in the hundreds.

    Notes
    -----
    Stable means bounded solutions; with damping, asymptotically stable.  Mathieu's equation, a in [-1, 5], b in [0, 6]:
    all but 1e-4 of the area in 2 to 10 s by machine, damped in twice that, see ``benchmarks/charts.py``.  Far from 0
    the iterates alone may take longer, which ``seconds`` does not count, and longer still with 0.1, a dyadic number of
    55 bits, in place of ``Rational(1, 10)``.

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
    seconds, undecided = _limit(seconds, "seconds"), _limit(undecided, "undecided")
    chart = read_chart(F, x, y, fixed, modes)
    refuse_phases(chart.F)
    rule = criterion(chart.F)
    boxes, done = _everywhere(chart, rule.everywhere) if rule.everywhere else _by_convexity(chart)
    state = Halving(chart, rule, start, undecided, progress, done)
    order, error = 0, 0.0
    if len(boxes):
        members, order, error = ways(chart, rule, boxes)
        degree = 8 if chart.F.shape[0] <= 4 else 6
        state.make = lambda part: stacked([f for way in members for f in way.functions(rule, part, degree)])
        state.until = time.perf_counter() + seconds
        state.refine(_first_chunks(state, boxes, members, degree))
    return _result(state, order, error)


def _limit(value: Any, name: str) -> float:
    """A number from 0 up, infinity too."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise BadTypeError(f"{name} must be a number, but it is {value!r}, a {type(value).__name__}.  "
                           f"Use {name}=1.")
    if not value >= 0:  # type: ignore[operator]
        raise BadInputError(f"{name} must be 0 or more, but it is {printed(value)}.  Use 10 seconds and "
                            "undecided=1e-4, say.")
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _result(state: Halving, order: int, error: float) -> CertifiedChart:
    """What is decided and what is left, as one chart."""
    np = numpy()
    axes = state.chart.axes
    parts = state.done + [(cells(axes, c.lower, c.upper), np.zeros(c.lower.shape[1], dtype=np.int8))
                          for c in state.chunks]
    return CertifiedChart(*axes, np.concatenate([c for c, _ in parts]), np.concatenate([v for _, v in parts]), order,
                          error, state.rule.name, time.perf_counter() - state.start)


# -- before anything is computed -----------------------------------------------


def _first_rectangles(chart: Charted) -> Rectangles:
    first, second = chart.axes
    return grid(chart.axes, (first.edges(START), second.edges(START)))


def _everywhere(chart: Charted, verdict: int) -> tuple[Rectangles, list[tuple[Array, Array]]]:
    """No rectangles that are left: all have this verdict."""
    np = numpy()
    boxes = _first_rectangles(chart)
    return boxes.at(slice(0, 0)), [(cells(chart.axes, boxes.lower, boxes.upper),
                                    np.full(len(boxes), verdict, dtype=np.int8))]


def _by_convexity(chart: Charted) -> tuple[Rectangles, list[tuple[Array, Array]]]:
    """The rectangles that are left, and those that are unstable by convexity."""
    np = numpy()
    boxes = _first_rectangles(chart)
    done: list[tuple[Array, Array]] = []
    for _ in range(24):
        proved = np.logical_or.reduce([convex(chart, member, boxes) for member in chart.members])
        if proved.any():
            done.append((cells(chart.axes, boxes.lower[:, proved], boxes.upper[:, proved]),
                         np.full(int(proved.sum()), -1, dtype=np.int8)))
        boxes = boxes.at(~proved)
        if not len(boxes):
            break
        floor, some = 0.0, np.zeros(len(boxes), dtype=bool)
        for corner in corners(boxes):
            there = np.logical_or.reduce([convex(chart, member, corner) for member in chart.members])
            some |= there
            floor = max(floor, float(np.where(there, 0.0, _speed(chart, corner)).max()))
        split = some & (_speed(chart, boxes) > 1.3 * floor)
        if not split.any():
            break
        part = boxes.at(split)
        along = np.argmin([_speed(chart, flat) for flat in flattened(part)], axis=0)
        boxes = joined(boxes.at(~split), bisected(chart.axes, part, along))
    return boxes, done


def _speed(chart: Charted, boxes: Rectangles) -> Array:
    """The largest row sum of ``sup |P|`` on every rectangle."""
    np = numpy()
    return np.max([amplitudes(chart, member, boxes).sum(axis=1).max(axis=0) for member in chart.members], axis=0)


# -- models of what decides ----------------------------------------------------


def _first_chunks(state: Halving, boxes: Rectangles, members: list[Way], degree: int) -> list[Chunk]:
    """The first models; rectangles that are too large for their degree are halved."""
    found: list[Chunk] = []
    limit = TAIL if state.chart.F.shape[0] == 2 else TAIL / 100
    for _ in range(16):
        large = _beyond(members, boxes, degree) > limit
        found += state.begin(boxes.at(~large))
        boxes = boxes.at(large)
        if state.over() or not len(boxes):
            break
        least = [_beyond(members, narrowed(boxes, k), degree) for k in (0, 1)]
        boxes = bisected(state.chart.axes, boxes, numpy().argmin(least, axis=0))
    return found + state.begin(boxes)


def _beyond(members: list[Way], boxes: Rectangles, degree: int) -> Array:
    """What Taylor polynomials leave out, the largest of all entries."""
    return numpy().max([way.beyond(boxes, degree) for way in members], axis=0)


__all__ = ["CertifiedChart", "certify"]
