r"""Zeros and level curves of a smooth function that is given with its derivatives, in balls.

**A zero between two places of different sign** by Newton's method kept in its bracket: a step that leaves the bracket
is replaced by halving, so what is found lies between the ends.

**A curve** ``f(x, y) = 0`` by steps along the tangent ``(-f_y, f_x)`` and back onto it by Newton's method along the
gradient, ``-f (f_x, f_y)/|grad f|**2``.  The sides of the rectangle are the units.  A step is halved where the tangent
turns by more than ``arccos 0.98`` or the curve is not met near the step's end, and grows again where it is straight.

**Precision.**  Balls say what has cancelled.  The working precision grows until the radius of f, divided by its slope,
is a shift of the zero that does not matter (:func:`resolved`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import hypot
from typing import Any

from flint import arb, ctx, fmpq

from fastpicard.errors import BadInputError
from fastpicard.evaluate import exact_number, numpy, to_number
from fastpicard.precision import working

MOST = 60  # evaluations of one zero
MOST_BITS = 1 << 14  # of the working precision
Array = Any
Pair = tuple[float, float]
Function = Callable[..., list[Any]]  # of as many balls as there are variables: the value and the derivatives by them
Box = list[tuple[float, float]]  # lower end and length of every side


def exact_ball(value: Any) -> Any:
    """A coordinate as a ball: exact where it is dyadic, and as narrow as the working precision otherwise."""
    number = exact_number(value, "a coordinate")
    return arb(number) if isinstance(number, fmpq) else number


def resolved(function: Function, place: Sequence[Any], scales: Sequence[Any], tol: Any) -> list[Any]:
    """The function and its derivatives, sharp enough to place a zero to ``tol`` of the scales of the variables.

    Raises the working precision, and leaves it there, until the radius of the value is at most ``tol`` times the sum
    of ``|slope| scale``.
    """
    while True:
        value, *slopes = function(*place)
        steep = sum((abs(d.mid()) * s for d, s in zip(slopes, scales, strict=True)), arb(0))
        if value.rad() <= tol * steep or 2 * ctx.prec > MOST_BITS:
            return [value, *slopes]
        ctx.prec *= 2


def zero(function: Function, ends: tuple[Any, Any], tol: Any) -> tuple[Any, int]:
    """An exact number near a zero of a function of one variable, and how often the function was evaluated.

    To ``tol`` of itself.  The working precision is raised where need be, and left there.

    Raises
    ------
    BadInputError
        if the signs at both ends are not proved to differ.
    """
    lo, hi = sorted(map(exact_ball, ends), key=float)
    reach = [abs(lo) + abs(hi) + tol]
    (f, df), (g, dg) = (resolved(function, [end], reach, tol / 16) for end in (lo, hi))
    if not f * g <= 0:
        raise BadInputError(f"the function must change its sign between the ends {float(lo)} and {float(hi)}, but "
                            f"it is {f.str(5)} and {g.str(5)} there.  Choose ends on both sides of the boundary.")
    rising, count = bool(g > 0), 2
    here, value, slope = (lo, f, df) if abs(f / df) < abs(g / dg) else (hi, g, dg)
    while count < MOST:
        step = value / slope if not slope.contains(0) else (hi - lo) * 2
        new = (here - step).mid()
        if not (new > lo and new < hi):
            new = ((lo + hi) / 2).mid()
        moved = abs(new - here)
        value, slope = resolved(function, [new], reach, tol / 16)
        count, here = count + 1, new
        if value == 0 or value.contains(0) or abs(value / slope) < tol * (abs(here) + tol) and moved < 1:
            break
        lo, hi = (lo, here) if bool(value > 0) == rising else (here, hi)
    if not slope.contains(0):
        here = (here - value / slope).mid()
    return here, count


def curve(function: Function, box: Box, start: Pair, step: float) -> tuple[Array, Array] | None:
    """The curve through a point near ``start``, both ways, until it leaves the box or closes; None if none is there.

    Returns
    -------
    points, tangents : arrays, shape (m, 2) each
        tangents ``(dx, dy)`` in units of the sides, of length 1, all in the direction of travel.
    """
    np = numpy()
    with working(128):
        first = _onto(function, box, [(c - lo) / w for c, (lo, w) in zip(start, box, strict=True)])
        if first is None:
            return None
        halves = [_one_way(function, box, first, sign, step) for sign in (-1.0, 1.0)]
    track = [*reversed(halves[0]), first, *halves[1]]
    scale, origin = np.array([w for _, w in box]), np.array([lo for lo, _ in box])
    points = np.array([point for point, _ in track]) * scale + origin
    tangents = np.array([tangent for _, tangent in track])
    turned = [1.0]
    for old, new in pairwise(tangents):
        turned.append(turned[-1] * (1.0 if old @ new >= 0 else -1.0))
    return points, tangents * np.array(turned)[:, None]


def _one_way(function: Function, box: Box, first: tuple[Pair, Pair], sign: float,
             step: float) -> list[tuple[Pair, Pair]]:
    point, tangent = first
    tangent = (sign * tangent[0], sign * tangent[1])
    track: list[tuple[Pair, Pair]] = []
    length = step
    while len(track) < 100 / step:
        new = _onto(function, box, [p + length * d for p, d in zip(point, tangent, strict=True)])
        turn = new[1][0] * tangent[0] + new[1][1] * tangent[1] if new else 0.0
        if not new or abs(turn) < 0.98 or _distance(new[0], point) > 2 * length:
            length /= 2
            if length < 1e-6:
                break
            continue
        if not all(-1e-12 <= c <= 1 + 1e-12 for c in new[0]):
            break
        direction = 1.0 if turn > 0 else -1.0
        point, tangent = new[0], (direction * new[1][0], direction * new[1][1])
        track.append((point, tangent))
        length = min(step, 1.5 * length)
        if len(track) > 3 and _distance(point, first[0]) < length / 2:
            break
    return track


def _onto(function: Function, box: Box, at: list[float]) -> tuple[Pair, Pair] | None:
    """The point of the curve that Newton's method along the gradient finds, and the tangent there."""
    for _ in range(12):
        place = [exact_ball(lo + c * w) for c, (lo, w) in zip(at, box, strict=True)]
        f, *slope = (to_number(part, None) for part in resolved(function, place, [w for _, w in box], 1e-14))
        slope = [d * w for d, (_, w) in zip(slope, box, strict=True)]
        size = hypot(*slope)
        if size == 0:
            return None
        move = [-f * d / size**2 for d in slope]
        at = [c + m for c, m in zip(at, move, strict=True)]
        if hypot(*move) < 1e-12:
            return (at[0], at[1]), (-slope[1] / size, slope[0] / size)
    return None


def _distance(p: Pair, q: Pair) -> float:
    return hypot(p[0] - q[0], p[1] - q[1])


__all__ = ["curve", "exact_ball", "resolved", "zero"]
