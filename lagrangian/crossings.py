r"""Events: when an angle passes a value, found in the Taylor polynomials of the steps.

Each step's polynomial of an angle is evaluated at a few points; between two of them on different sides of the value
the crossing is found by Newton's iteration on the same polynomial, to the last digit of the time, in float64 and in
balls.  Two crossings of one angle within an eighth of a step can be missed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, partial
from math import ceil, floor
from numbers import Integral
from typing import Any

import numpy as np
from sympy import Integer, latex, pi

from .angles import TURN
from .chain import CompiledChain
from .errors import NotASceneError, QuantityError, SceneError, printed
from .pieces import Pieces
from .precision import working
from .quantities import quantity

__all__ = ["Crossing", "checked", "find_crossings", "flips"]

POINTS = 8
ROUNDED = 1e-6  # turns: more than float64 rounds


@dataclass(frozen=True)
class Crossing:
    """The angle of one rod passes a value, in any turn.

    Attributes
    ----------
    rod : 1, ..., n
    angle : the value, modulo a turn, as the exact number it is: ``pi/2`` is pi/2, a float is its dyadic; rad
    direction : 0 for both ways, 1 for growing angles, -1 for shrinking ones

    A motion that starts on the value crosses it then, as far as floats know, with the direction that follows; one that
    ends there, or rests there, has not crossed it.

    Raises QuantityError where one of them is none of these, TextError where the angle is text.

    >>> Crossing(1, 0.5).angle, Crossing(2, pi/2).angle
    (1/2, pi/2)
    """

    rod: int
    angle: Any
    direction: int = 0

    def __post_init__(self) -> None:
        if not _is_whole(self.rod) or self.rod < 1:
            raise QuantityError(f"a crossing's rod is {printed(self.rod, repr)}: give its number, 1 for that at the "
                                f"support.")
        if not _is_whole(self.direction) or self.direction not in (-1, 0, 1):
            raise QuantityError(f"a crossing's direction is {printed(self.direction, repr)}: give 0 for both ways, 1 "
                                f"for growing angles or -1 for shrinking ones.")
        for name in ("rod", "direction"):
            object.__setattr__(self, name, int(getattr(self, name)))
        object.__setattr__(self, "angle", quantity(self.angle, "angle"))
        if not self.angle.is_number:
            raise QuantityError(f"a crossing's angle is {self.angle}, which is no number: give one, such as pi/2.")


    def _repr_latex_(self) -> str:
        rate = {0: "", 1: rf", \quad \dot\theta_{{{self.rod}}} > 0", -1: rf", \quad \dot\theta_{{{self.rod}}} < 0"}
        return rf"$\theta_{{{self.rod}}} = {latex(self.angle)} \pmod{{2\pi}}{rate[self.direction]}$"


def _is_whole(number: Any) -> bool:
    return isinstance(number, Integral) and not isinstance(number, bool)


def flips(chain: Any) -> dict[str, Crossing]:
    """One :class:`Crossing` a rod, ``"flip 1"`` to ``"flip n"``: it passes the upward vertical.

    Raises NotASceneError for anything else than a :class:`CompiledChain`.

    >>> flips(CompiledChain([1, 1], [1, 1], [1, 1], [1, 1], upright=False))["flip 2"]
    Crossing(rod=2, angle=pi, direction=0)
    """
    if not isinstance(chain, CompiledChain):
        raise NotASceneError(f"flips are those of a CompiledChain's rods, and this is {chain!r}: give "
                             f"scene.compile(values).")
    top = Integer(0) if chain.upright else pi
    return {f"flip {k}": Crossing(k, top) for k in range(1, len(chain) + 1)}


def checked(events: Mapping[str, Crossing] | None, n: int) -> Mapping[str, Crossing]:
    """The events asked for, each a :class:`Crossing` of one of n rods; raises SceneError."""
    if events is None:
        return {}
    if not isinstance(events, Mapping):
        raise SceneError(f"events have names, and events is {events!r}: give flips(chain), or a mapping such as "
                         f"{{'down': Crossing(1, 0)}}.")
    for event in events.values():
        if not isinstance(event, Crossing) or not 1 <= event.rod <= n:
            raise SceneError(f"an event is a Crossing of one of the rods 1 to {n}, and this one is "
                             f"{printed(event, repr)}.")
    return events


def find_crossings(motion: Pieces, events: Mapping[str, Crossing], end: Any) -> dict[str, Any]:
    """The times of every event, in order, up to ``end``; shape (crossings,) each, in the motion's numbers; s."""
    with working(motion.bits):
        lengths = motion.until(motion.given(end)[0])
        return {name: motion.shown(list(_times(motion, event, lengths))) for name, event in events.items()}


def _times(motion: Pieces, event: Crossing, lengths: Any) -> Iterator[Any]:
    goal = cache(partial(motion.goal, event.angle))
    for step, length in enumerate(lengths):
        h = motion.plain(np.arange(POINTS + 1) * length / POINTS)
        done = motion.whole_turns(motion.beyond(step, event.rod - 1, goal(0), h[0]))
        turns = motion.beyond(step, event.rod - 1, goal(done), h).astype(float) / TURN
        for turn in range(ceil(turns.min() - ROUNDED), floor(turns.max() + ROUNDED) + 1):
            yield from _in_step(motion, event, step, goal(done + turn), h)


def _in_step(motion: Pieces, event: Crossing, step: int, goal: Any, h: Any) -> Iterator[Any]:
    """The times at which the angle passes the goal, between neighbours of ``h`` on different sides of it."""
    rod = event.rod - 1
    value = _joined(motion, step, rod, goal, h)
    for a, b, x, y in zip(h, h[1:], value, value[1:]):
        rising = bool(y > x)
        if min(x, y) <= 0 <= max(x, y) and y != 0 and event.direction * motion.forward * (2 * rising - 1) >= 0:
            beyond, rate = partial(motion.beyond, step, rod, goal), partial(motion.rate, step, rod)
            root = a if x == 0 else _root(beyond, rate, a, b, rising, motion)
            yield motion.plain(motion.start[step] + root)


def _joined(motion: Pieces, step: int, rod: int, goal: Any, h: Any) -> Any:
    """How far the angle is beyond the goal, at the end as the next step sees it: what is 0 there is 0 in it alone."""
    value = motion.beyond(step, rod, goal, h)
    if step + 1 < len(motion.start):
        after = motion.beyond(step + 1, rod, goal, 0 * h[-1])
        value[-1] = after + TURN * round(float(value[-1] - after) / TURN)
    return value


def _root(value: Callable[[Any], Any], slope: Callable[[Any], Any], a: Any, b: Any, rising: bool,
          motion: Pieces) -> Any:
    """Where ``value`` is 0 between a and b: Newton's steps, and halves of the interval where they lead out of it."""
    last = abs(b - a) / 2 ** (motion.bits - 3)
    h = motion.plain((a + b) / 2)
    for _ in range(2 * motion.bits):
        y, rate = value(h), slope(h)
        a, b = (a, h) if (y > 0) == rising else (h, b)
        near = motion.plain(h - y / rate) if rate != 0 else a
        if abs(near - h) <= last:
            return near
        h = near if min(a, b) < near < max(a, b) else motion.plain((a + b) / 2)
    return h
