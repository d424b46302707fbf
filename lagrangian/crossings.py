r"""Events: when an angle passes a value, found in the Taylor polynomials of the steps.

Each step's series of an angle is evaluated at a few points; between two of them on different sides of the value the
crossing is found by bisection of the same polynomial, to the last digit of the time.  Two crossings of one angle
within an eighth of a step can be missed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from .errors import QuantityError, SceneError
from .stepper import TURN, TURN_LOW

__all__ = ["Crossing", "Interpolant", "find_crossings", "flips"]

POINTS = 8


@dataclass(frozen=True)
class Crossing:
    """The angle of one rod passes a value, in any turn.

    Attributes
    ----------
    rod : 1, ..., n
    angle : the value, modulo a turn; rad
    direction : 0 for both ways, 1 for growing angles, -1 for shrinking ones
    """

    rod: int
    angle: float
    direction: int = 0


def flips(chain: Any) -> dict[str, Crossing]:
    """One :class:`Crossing` a rod, ``"flip 1"`` to ``"flip n"``: it passes the upward vertical."""
    top = 0.0 if chain.upright else np.pi
    return {f"flip {k}": Crossing(k, top) for k in range(1, len(chain) + 1)}


class Interpolant:
    """The motion at any time, from the series of every step that was made."""

    def __init__(self, record: Any, n: int, order: int) -> None:
        self.start, self.length = record[:, 0], record[:, 1]
        rows = record[:, 2:].reshape(-1, n, order + 4)
        self.high, self.low, self.turns, self.rates = rows[..., 0], rows[..., 1], rows[..., 2], rows[..., 3:]
        self.powers = self.rates / np.arange(1, order + 2)

    def angle(self, steps: Any, rod: int, h: Any) -> Any:
        """How far an angle moves in the time h from the start of each of ``steps``."""
        value = np.zeros(np.broadcast_shapes(np.shape(steps), np.shape(h)))
        for m in range(self.powers.shape[-1] - 1, -1, -1):
            value = (value + self.powers[steps, rod, m]) * h
        return value

    def __call__(self, t: Any) -> tuple[Any, Any]:
        """Angles with turns and rates at one time or many."""
        times = np.atleast_1d(np.asarray(t, dtype=float))
        forward = 1.0 if self.length[0] >= 0 else -1.0
        ends = self.start[-1] + self.length[-1]
        inside = (forward * times >= forward * self.start[0]) & (forward * times <= forward * ends)
        if not inside.all():
            raise QuantityError(f"the motion is known from t = {self.start[0]} to {ends}, and t is "
                                f"{times[~inside][0]}.")
        steps = np.searchsorted(forward * self.start, forward * times, side="right") - 1
        h = (times - self.start[steps])[:, None]
        theta, omega = np.zeros((len(times), self.high.shape[1])), np.zeros((len(times), self.high.shape[1]))
        for m in range(self.powers.shape[-1] - 1, -1, -1):
            theta = (theta + self.powers[steps, :, m]) * h
            omega = omega * h + self.rates[steps, :, m]
        theta = self.high[steps] + (self.low[steps] + theta) + self.turns[steps] * TURN
        return (theta[0], omega[0]) if np.ndim(t) == 0 else (theta, omega)


def find_crossings(interpolant: Interpolant, events: Mapping[str, Crossing], end: float) -> dict[str, Any]:
    """The times of every event, in order, up to ``end``."""
    return {name: _times(interpolant, event, end) for name, event in events.items()}


def _times(motion: Interpolant, event: Crossing, end: float) -> Any:
    n = motion.high.shape[1]
    if not isinstance(event, Crossing) or not 1 <= event.rod <= n:
        raise SceneError(f"an event is a Crossing of one of the rods 1 to {n}, and this one is {event!r}.")
    rod, found = event.rod - 1, []
    forward = 1.0 if motion.length[0] >= 0 else -1.0
    for step in range(len(motion.start)):
        last = motion.length[step] if forward * (motion.start[step] + motion.length[step] - end) <= 0 else (
            end - motion.start[step])
        h = np.linspace(0.0, last, POINTS + 1)
        base = motion.high[step, rod] - event.angle
        value = base + (motion.low[step, rod] + motion.angle(step, rod, h))
        for a, b, x, y in zip(h, h[1:], value, value[1:], strict=False):
            low, high = sorted((x, y))
            for turn in range(int(np.ceil(low / TURN)), int(np.floor(high / TURN)) + 1):
                target = turn * TURN
                rising = y > x
                if (y == target != x) or x == y or event.direction * (1 if rising == (forward > 0) else -1) < 0:
                    continue  # a crossing at the end of an interval belongs to the next one

                before = base - target, motion.low[step, rod] - turn * TURN_LOW
                found.append(motion.start[step] + _bisected(partial(_beyond, motion, step, rod, before), a, b, rising))
    return np.array(found)


def _beyond(motion: Interpolant, step: int, rod: int, before: tuple[float, float], h: float) -> Any:
    return before[0] + (before[1] + motion.angle(step, rod, h))


def _bisected(function: Any, a: float, b: float, rising: bool) -> float:
    for _ in range(60):
        middle = 0.5 * (a + b)
        if middle in (a, b):
            break
        if (function(middle) > 0) == rising:
            b = middle
        else:
            a = middle
    return 0.5 * (a + b)
