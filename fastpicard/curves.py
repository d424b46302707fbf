r"""Zeros and level curves of a smooth function that is given with its derivatives, in balls.

**A zero between two places of different sign** by Newton's method kept in its bracket: a step that leaves the bracket
is replaced by halving, so what is found lies between the ends.

**A curve** ``f(x, y) = 0`` by steps along the tangent ``(-f_y, f_x)`` and back onto it by Newton's method along the
gradient, ``-f (f_x, f_y)/|grad f|**2``.  The sides of the rectangle are the units.  A step is halved where the tangent
turns by more than ``arccos 0.98`` or the curve is not met near the step's end, and grows again where it is straight.
Along one curve the gradient stays on the same side.  On the next branch it is on the other, so a step over to that one
is noticed, and taken only where the two are so near that they count as one: where the function has the same sign on
both sides, or for a step as short.  Elsewhere the gradient neither changes sides nor more than doubles or halves.

**Precision.**  Balls say what has cancelled.  The working precision grows until the radius of f, divided by its slope,
is a shift of the zero that does not matter (``resolved``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot, isfinite, nan
from typing import Any

from flint import arb, ctx, fmpq

from fastpicard.errors import BadInputError
from fastpicard.evaluate import numpy, to_number
from fastpicard.precision import working
from fastpicard.values import exact_number

MOST = 60  # evaluations of one zero
MOST_BITS = 1 << 14  # of the working precision
STRAIGHT, BESIDE = 0.98, 0.125  # a step turns by less, and the curve is met nearer to its end, in parts of its length
NEAR, SHORTEST = 1e-8, 1e-10  # branches so near count as one; no step is shorter
MOST_SIDES = 100
Array = Any
Pair = tuple[float, float]
Place = tuple[Pair, Pair]  # a point of a curve and the gradient there, in units of the sides
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
        if the signs at both ends are not proved to differ, or there is a pole between them.
    """
    lo, hi = sorted(map(exact_ball, ends), key=float)
    reach = [abs(lo) + abs(hi) + tol]
    (f, df), (g, dg) = (resolved(function, [end], reach, tol / 16) for end in (lo, hi))
    if not f * g <= 0 or f == 0 == g:
        raise BadInputError(f"the function must change its sign between the ends {float(lo)} and {float(hi)}, but "
                            f"it is {f.str(5)} and {g.str(5)} there.  Choose ends on both sides of the boundary.")
    for end, at_end in ((lo, f), (hi, g)):
        if at_end == 0:
            return end.mid(), 2
    rising, count, moved = bool(g > 0), 2, 2 * (hi - lo)
    here, value, slope = (lo, f, df) if abs(f / df) < abs(g / dg) else (hi, g, dg)
    while count < MOST - 4 * float(tol.log()):
        step = value / slope if not slope.contains(0) else (hi - lo) * 2
        new = (here - step).mid()
        if not (lo <= new <= hi and 2 * abs(step) < moved):  # Newton's steps halve at least, or it does
            new = ((lo + hi) / 2).mid()
        moved = abs(new - here)
        value, slope = resolved(function, [new], reach, tol / 16)
        if not (value.is_finite() and slope.is_finite()):
            raise BadInputError(f"the function must be finite between the ends {float(ends[0])} and {float(ends[1])}, "
                                f"but it is not at {new.str(5, radius=False)}.  Choose ends on one side of a pole.")
        count, here = count + 1, new
        if value == 0 or value.contains(0) or abs(value / slope) < tol * (abs(here) + tol) and moved < 1:
            break
        lo, hi = (lo, here) if bool(value > 0) == rising else (here, hi)
    last = (here - value / slope).mid() if not slope.contains(0) else here
    return last if lo <= last <= hi else here, count


def curve(function: Function, box: Box, start: Pair, step: float) -> tuple[Array, Array] | None:
    """The curve through a point near ``start``, both ways, until it leaves the box or closes; None if none is there.

    Returns
    -------
    points, tangents : arrays, shape (m, 2) each
        tangents ``(dx, dy)`` in units of the sides, of length 1, all in the direction of travel; a curve that closes
        ends with its first point.

    Raises
    ------
    BadInputError
        if it goes on for more steps than a hundred sides of the rectangle take, or has no direction at its start.
    """
    np, plane = numpy(), Plane(function, box)
    with working(128):
        first = plane.onto([(c - lo) / w for c, (lo, w) in zip(start, box, strict=True)])
        if first is None or not _inside(first[0]):
            return None
        ahead, closes = _one_way(plane, first, 1.0, step)
        behind = [] if closes else _one_way(plane, first, -1.0, step)[0]
        inner = all(SHORTEST < c < 1 - SHORTEST for c in first[0])
        if not ahead and not behind and (inner or plane.is_double(first)):
            raise BadInputError(f"a curve goes both ways from its start, but none leaves {start}: curves cross there, "
                                "or it is a point of its own.  Start elsewhere on the curve.")
    point, gradient = first
    back = [(other, _times(-1.0, tangent)) for other, tangent in reversed(behind)]
    track = [*back, (point, _along(gradient)), *ahead]
    track += [track[0]] if closes else []
    scale, origin = np.array([w for _, w in box]), np.array([lo for lo, _ in box])
    return np.array([point for point, _ in track]) * scale + origin, np.array([tangent for _, tangent in track])


def _one_way(plane: Plane, first: Place, side: float, step: float) -> tuple[list[Place], bool]:
    """Points and directions of the curve from its first place on, and whether it comes back there.

    ``side`` tells on which one the gradient is.
    """
    track: list[Place] = []
    here = first
    start = tangent = _along(here[1], side)
    length = step
    while len(track) < MOST_SIDES / step:
        target = _moved(here[0], length, tangent)
        new = plane.onto(target)
        turn = _dot(_along(new[1], side), tangent) if new else 0.0
        if new is None or not _goes_on(plane, here, new, target, turn):
            length /= 2
            if length < SHORTEST:
                return track, False
            continue
        side = side if turn > 0 else -side
        if not _inside(new[0]):
            end = plane.leave(here, new)
            return [*track, *([(end[0], _along(end[1], side))] if end else [])], False
        here = new
        tangent = _along(here[1], side)
        track.append((here[0], tangent))
        if len(track) > 3 and _distance(here[0], first[0]) < 0.6 * length and _dot(tangent, start) > STRAIGHT:
            is_past = _dot(_moved(first[0], -1.0, here[0]), tangent) < 0
            return track[:-1] if is_past else track, True
        length = min(step, 1.5 * length)
    raise BadInputError(f"a curve is followed for {len(track)} steps at most, but this one goes on from there.  Take a "
                        "smaller rectangle, or a longer step.")


def _goes_on(plane: Plane, here: Place, new: Place, target: Pair, turn: float) -> bool:
    """Whether a step from ``here``, to ``target`` and back onto the curve, has kept to its branch."""
    length = _distance(here[0], target)
    if abs(turn) < STRAIGHT or _distance(new[0], target) > BESIDE * length:
        return False
    before, after = hypot(*here[1]), hypot(*new[1])
    if turn > 0 and before < 2 * after < 4 * before:
        return True
    return length < NEAR or plane.is_double(here) and plane.is_double(new)


@dataclass(frozen=True)
class Plane:
    """A function in units of the sides of a rectangle."""

    function: Function
    box: Box

    def at(self, point: Sequence[float]) -> tuple[Any, list[float]]:
        """The value, a ball, and the gradient."""
        place = [exact_ball(lo) + exact_ball(c) * exact_ball(w) for c, (lo, w) in zip(point, self.box, strict=True)]
        f, *slope = resolved(self.function, place, [w for _, w in self.box], 1e-14)
        return f, [_float(d) * w for d, (_, w) in zip(slope, self.box, strict=True)]

    def onto(self, at: Sequence[float], held: int | None = None) -> Place | None:
        """The point of the curve that Newton's method along the gradient finds, and the gradient there.

        One of the coordinates may be held.
        """
        for _ in range(12):
            if not all(map(isfinite, at)):
                return None
            value, slope = self.at(at)
            f, free = _float(value), [0.0 if k == held else d for k, d in enumerate(slope)]
            size = hypot(*free)
            if size == 0 or not isfinite(size) or not isfinite(f):
                return None
            move = [-(f / size) * (d / size) for d in free]
            at = [c + m for c, m in zip(at, move, strict=True)]
            if hypot(*move) < 1e-12:
                return (at[0], at[1]), (slope[0], slope[1])
        return None

    def is_double(self, place: Place) -> bool:
        """Whether another branch is near: the function has the same sign on both sides."""
        point, gradient = place
        unit = _times(1 / hypot(*gradient), gradient)
        below, above = (self.at(_moved(point, sign * NEAR, unit))[0] for sign in (-1, 1))
        return bool(below * above > 0)

    def leave(self, here: Place, new: Place) -> Place | None:
        """Where the curve leaves the rectangle on its way to a place outside; None where it is on an edge already."""
        point, outside = here[0], new[0]
        parts = [((float(q > 1) - p) / (q - p), k) for k, (p, q) in enumerate(zip(point, outside, strict=True))
                 if not 0 <= q <= 1]
        part, held = min(parts)
        target = [p + part * (q - p) for p, q in zip(point, outside, strict=True)]
        target[held] = float(outside[held] > 1)
        found = self.onto(target, held)
        if found is None or not _inside(found[0]) or _dot(found[1], new[1]) < 0:
            return None
        return found if SHORTEST < _distance(found[0], point) <= 2 * _distance(point, outside) else None


def _float(x: Any) -> float:
    """nan where there is none: at a pole, or where a root is not real."""
    return float(to_number(x, None)) if x.is_finite() else nan


def _along(gradient: Pair, side: float = 1.0) -> Pair:
    """The direction of the curve that has the gradient on its left, or on its right for ``side = -1``."""
    size = side * hypot(*gradient)
    return -gradient[1] / size, gradient[0] / size


def _inside(point: Pair) -> bool:
    return all(-1e-12 <= c <= 1 + 1e-12 for c in point)


def _moved(point: Pair, length: float, direction: Pair) -> Pair:
    return point[0] + length * direction[0], point[1] + length * direction[1]


def _times(factor: float, v: Pair) -> Pair:
    return factor * v[0], factor * v[1]


def _dot(v: Pair, w: Pair) -> float:
    return v[0] * w[0] + v[1] * w[1]


def _distance(p: Pair, q: Pair) -> float:
    return hypot(p[0] - q[0], p[1] - q[1])


__all__ = ["curve", "exact_ball", "resolved", "zero"]
