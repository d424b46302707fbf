r"""Undecided rectangles are halved until little is left, or the time is over.

A chunk is an array of rectangles with Taylor models of the functions that decide.  What they decide is recorded; the
rest is cut in two across the direction in which its undecided functions vary more, and the models are recentred on the
halves by additions.  Signs once proved are inherited, so functions that are known on all of a chunk are dropped, and
the degree is lowered where what is dropped stays invisible to the end.

A half inherits its models' errors too.  Where these are all that is left of the undecided functions, halving is no
help: the models are made anew for what the rectangles are by then, and where that is no help either, they stay open.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from fastpicard.charted import Charted
from fastpicard.criteria import Criterion
from fastpicard.evaluate import numpy
from fastpicard.rectangles import Axes, Rectangles, cells
from fastpicard.taylormodels import Models, joined, size

Array = Any
CHUNK = 8192  # rectangles at a time
FINEST = 2.0**-27  # of what is left: how far ahead is planned where all shall be decided
AGE = 6  # halvings, after which new models leave out 2**-27 of what old ones of degree 8 did
BATCH = 256  # rectangles whose models are made at a time, and
FIRST = 48  # how many of them are a chunk, which keeps the degree and the functions of the one that needs most
MOST = 1 << 27  # coefficients of undecided rectangles, a gigabyte: where nothing is decided they would fill the memory


@dataclass
class Chunk:
    """Undecided rectangles with models: halves of rectangles, given exactly by the place inside their first one.

    ``rows`` are the places of the models' functions among all of them, ``signs`` the signs of all of them; ``age`` is
    how often the rectangles were halved since the models were made.
    """

    lower: Array
    upper: Array
    models: Models
    rows: Array
    signs: Array
    age: int = 0

    def at(self, places: Array) -> Chunk:
        """Some of the rectangles."""
        return replace(self, lower=self.lower[:, places], upper=self.upper[:, places], models=self.models.at(places),
                       signs=self.signs[:, places])

    @property
    def open(self) -> Array:
        """Which functions are undecided where: shape (functions, m)."""
        found: Array = self.signs[self.rows] == 0
        return found

    @property
    def stuck(self) -> Array:
        """Where an undecided function varies less than its error."""
        found: Array = ((self.models.e >= abs(self.models.c[1:]).sum(axis=0)) & self.open).any(axis=0)
        return found


class Halving:
    """What is decided, what is not, and how long it may take."""

    make: Callable[[Rectangles], Models]  # the models of what decides on rectangles
    until = math.inf

    def __init__(self, chart: Charted, rule: Criterion, start: float, target: float,
                 progress: bool | Callable[[float, float], None], done: list[tuple[Array, Array]]) -> None:
        self.chart, self.rule, self.start, self.target = chart, rule, start, target
        self.progress, self.done = progress, done
        self.whole = (chart.axes[0].hi - chart.axes[0].lo) * (chart.axes[1].hi - chart.axes[1].lo)
        self.chunks: list[Chunk] = []
        self.last = 0.0

    def area(self, chunk: Chunk) -> float:
        """The part of the chart's area that a chunk takes."""
        c = cells(self.chart.axes, chunk.lower, chunk.upper)
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
            self.done.append((cells(self.chart.axes, chunk.lower[:, decided], chunk.upper[:, decided]),
                              verdicts[decided].astype(np.int8)))
        left = np.flatnonzero(~decided)
        if not len(left):
            return []
        rest = chunk.at(left)
        open_, models = rest.open.any(axis=1), rest.models
        return [replace(rest, models=Models(models.degree, models.c[:, open_], models.e[open_]),
                        rows=rest.rows[open_])]

    def begin(self, boxes: Rectangles) -> list[Chunk]:
        """What is left of rectangles for which models are made, or all of them if the time is over."""
        np = numpy()
        found: list[Chunk] = []
        for start in range(0, len(boxes), BATCH):
            if self.over():
                self.leave(boxes.at(slice(start, None)))
                break
            part = boxes.at(slice(start, start + BATCH))
            models = self.make(part)
            rows = np.arange(models.c.shape[1])
            self.progress_line()
            found += self._settled(Chunk(part.lower, part.upper, models, rows,
                                         np.zeros((len(rows), len(part)), dtype=np.int8)))
        return found

    def _settled(self, chunk: Chunk) -> list[Chunk]:
        """What is left of new models, in chunks that are small at first."""
        count = chunk.lower.shape[1]
        return [left for start in range(0, count, FIRST) for left in self.settle(chunk.at(slice(start, start + FIRST)))]

    def renewed(self, chunk: Chunk) -> list[Chunk]:
        """The chunk, with new models where halving the old ones is no help; where new ones are none, it is left."""
        np = numpy()
        stuck = chunk.stuck if chunk.age >= AGE else np.zeros(chunk.lower.shape[1], dtype=bool)
        if not stuck.any():
            return [chunk]
        found = [] if stuck.all() else [chunk.at(~stuck)]
        places = np.flatnonzero(stuck)
        for start in range(0, len(places), BATCH):
            if self.over():
                found.append(chunk.at(places[start:]))
                break
            old = chunk.at(places[start:start + BATCH])
            models = self.make(Rectangles(old.lower, old.upper))
            helped = ((models.e[old.rows] < old.models.e / 2) & old.open).any(axis=0)
            new = replace(old, models=models, rows=np.arange(models.c.shape[1]), age=0)
            found += self._settled(new.at(helped))
            self.leave(Rectangles(old.lower[:, ~helped], old.upper[:, ~helped]))
        return found

    def leave(self, boxes: Rectangles) -> None:
        """Record rectangles as undecided."""
        self.done.append((cells(self.chart.axes, boxes.lower, boxes.upper), numpy().zeros(len(boxes), dtype="int8")))

    def refine(self, chunks: list[Chunk]) -> None:
        """Halve until the target, the end of the time, or of the memory."""
        while chunks:
            rest = sum(map(self.area, chunks))
            if rest <= self.target or self.over():
                break
            halvings = max(1.0, 1.0 + numpy().log2(rest / max(self.target, rest * FINEST)))
            new: list[Chunk] = []
            stored = 0
            for k, chunk in enumerate(chunks):
                if self.over() or stored > MOST:
                    self.until = 0.0
                    new += chunks[k:]
                    break
                self.progress_line(rest)
                halves = [half for part in self.renewed(chunk) for half in self.halved_twice(part, halvings)]
                stored += sum(half.models.c.size for half in halves)
                new += halves
            chunks = new
        self.chunks = chunks
        if self.progress is True:
            sys.stderr.write("\r" + " " * 60 + "\r")

    def over(self) -> bool:
        """Whether the time is."""
        return time.perf_counter() > self.until

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


def _halved(chunk: Chunk, axes: Axes) -> Chunk:
    """Every rectangle cut in two, across the direction in which its undecided functions vary more."""
    np = numpy()
    c = abs(chunk.models.c)
    total = c[1] + c[2] + 1e-300
    lean = np.where(chunk.open, (c[1] - c[2]) / total, 0.0).sum(axis=0)
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
                 np.concatenate(signs, axis=1), chunk.age + 1)


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
    return [chunk.at(slice(start, start + CHUNK // 2)) for start in range(0, count, CHUNK // 2)]
