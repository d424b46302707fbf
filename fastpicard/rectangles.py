r"""Rectangles of a chart: many at once, as arrays, in the inner variables ``u = x**p``, ``w = y**q``.

Their edges are numbers of 24 bits, so that all halvings are exact and a half is exactly half of its first rectangle.
At the rim of a chart whose ends have more bits, rectangles reach a little beyond it.
"""

from __future__ import annotations

from typing import Any

from fastpicard.axes import Axis
from fastpicard.evaluate import numpy
from fastpicard.taylormodels import UNIT

Array = Any
Axes = tuple[Axis, Axis]


class Rectangles:
    """Rectangles in ``(u, w)``: centres and half sides as floats, the sides rounded up.

    Attributes
    ----------
    center, half : arrays, shape (2, m)
    """

    def __init__(self, lower: Array, upper: Array) -> None:
        np = numpy()
        self.lower, self.upper = lower, upper
        self.center = (lower + upper) / 2
        self.half = np.nextafter(np.maximum(upper - self.center, self.center - lower) * (1 + 4 * UNIT), np.inf)

    def __len__(self) -> int:
        return int(self.center.shape[1])

    def at(self, places: Array) -> Rectangles:
        """Some of them."""
        return Rectangles(self.lower[:, places], self.upper[:, places])


def shortened(u: Array, away: Array | None = None) -> Array:
    """Numbers of 24 bits near ``u``: then all halvings of the rectangles between them are exact.

    Where ``away`` is 1 or -1 they are rounded up or down, by a few ulp of a float more than need be.
    """
    np = numpy()
    mantissa, exponent = np.frexp(u)
    scaled = np.ldexp(mantissa, 24)
    if away is not None:
        scaled = np.where(away > 0, np.ceil(scaled + 2.0**-20), np.where(away < 0, np.floor(scaled - 2.0**-20), scaled))
    return np.ldexp(np.round(scaled), exponent - 24)


def grid(axes: Axes, edges: tuple[Array, Array]) -> Rectangles:
    """The rectangles between edges given in the parameters of the chart; at its rim they may reach a little beyond."""
    np = numpy()
    sides = []
    for axis, line in zip(axes, edges, strict=True):
        inner = np.sort(axis.inner(line))
        away = np.zeros(len(inner))
        away[0], away[-1] = -1, 1
        if axis.power == 1:  # ends of 24 bits are exact
            away[[0, -1]] = np.where(shortened(inner[[0, -1]]) == inner[[0, -1]], 0, away[[0, -1]])
        inner = shortened(inner, away)
        sides.append((inner[:-1], inner[1:]))
    lower, upper = (np.stack([a.ravel() for a in np.meshgrid(sides[0][k], sides[1][k], indexing="ij")])
                    for k in (0, 1))
    return Rectangles(lower, upper)


def cells(axes: Axes, lower: Array, upper: Array) -> Array:
    """Rectangles in the chart's parameters: shape (m, 4)."""
    np = numpy()
    sides = [np.sort(np.stack([axis.outer(lower[k]), axis.outer(upper[k])]), axis=0) for k, axis in enumerate(axes)]
    return np.stack([sides[0][0], sides[0][1], sides[1][0], sides[1][1]], axis=1)


# -- others made of them ---------------------------------------------------------


def joined(left: Rectangles, right: Rectangles) -> Rectangles:
    """Two sets of rectangles, one after the other."""
    np = numpy()
    return Rectangles(np.concatenate([left.lower, right.lower], axis=1),
                      np.concatenate([left.upper, right.upper], axis=1))


def corners(boxes: Rectangles) -> list[Rectangles]:
    """The four corners, as rectangles without extent."""
    np = numpy()
    found = []
    for i in (0, 1):
        for j in (0, 1):
            point = np.stack([(boxes.lower, boxes.upper)[i][0], (boxes.lower, boxes.upper)[j][1]])
            found.append(Rectangles(point, point))
    return found


def flattened(boxes: Rectangles) -> list[Rectangles]:
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


def narrowed(boxes: Rectangles, k: int) -> Rectangles:
    """The same centres with half the sides along one axis."""
    lower, upper = boxes.lower.copy(), boxes.upper.copy()
    lower[k], upper[k] = (lower[k] + boxes.center[k]) / 2, (upper[k] + boxes.center[k]) / 2
    return Rectangles(lower, upper)


def bisected(axes: Axes, boxes: Rectangles, along: Array) -> Rectangles:
    """The rectangles halved, in the chart's parameters, along the axes given: 0 or 1 for each."""
    np = numpy()
    lower, upper = [], []
    for k, axis in enumerate(axes):
        low, high = boxes.lower[:, along == k], boxes.upper[:, along == k]
        middle = shortened(axis.inner((axis.outer(low[k]) + axis.outer(high[k])) / 2))
        middle = np.clip(middle, low[k], high[k])
        for part in (0, 1):
            a, b = low.copy(), high.copy()
            (b, a)[part][k] = middle
            lower.append(a)
            upper.append(b)
    return Rectangles(np.concatenate(lower, axis=1), np.concatenate(upper, axis=1))
