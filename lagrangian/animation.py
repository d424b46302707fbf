"""Films of a motion, as a matplotlib animation, a GIF or a page of HTML."""

from __future__ import annotations

from math import ceil
from numbers import Integral
from pathlib import Path
from typing import Any

import numpy as np

from .errors import QuantityError
from .optional import optional
from .quantities import quantity

__all__ = ["animate"]

HUNDREDTH = 10  # ms, the unit that a GIF counts in
LEAST = 2  # hundredths: browsers slow down what is faster


def animate(trajectory: Any, path: Any = None, seconds: float | None = None, frames: int = 150, trail: int = 40) -> Any:
    """A film of the chain in the frame of its support; returns the matplotlib animation.

    ``path`` ends in .gif or .html (which holds all its frames), or is None; ``seconds`` is how long the film runs, to
    half a frame, the time of the motion by default; ``frames`` is how many there are at most, of some of the times; the
    tip's path over the last ``trail`` of them is shown.  Raises QuantityError for other endings, for a film without
    length or frames, and for a motion of one time; NotInstalledError without matplotlib.
    """
    ending = None if path is None else Path(str(path)).suffix.lower()
    if ending not in (None, ".gif", ".html"):
        raise QuantityError(f"a film is written as .gif or .html, and path is {path}: change its ending.")
    x, y = trajectory.positions()
    times = np.asarray(trajectory.times, dtype=float)
    _check_whole(frames, "frames", 1)
    _check_whole(trail, "trail", 0)
    if len(times) < 2:
        raise QuantityError(f"a film shows a motion, and this one has the single time {times[0]}: simulate more times.")
    count, each = timing(abs(times[-1] - times[0]) if seconds is None else seconds, min(frames, len(times)))
    shown = np.linspace(0, len(times) - 1, count).astype(int)
    pyplot, animation = (optional(f"matplotlib.{part}", "a film of a motion") for part in ("pyplot", "animation"))
    figure, axes = pyplot.subplots(figsize=(4.5, 4.5), layout="constrained")
    reach = 1.05 * trajectory.chain.rods[:, 1].sum()
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xticks=[], yticks=[])
    axes.plot([0], [0], "k^", markersize=6)
    path_line, = axes.plot([], [], color="tab:orange", linewidth=1)
    rods, = axes.plot([], [], "o-", color="tab:blue", linewidth=2, markersize=4 if x.shape[1] < 30 else 0)
    clock = axes.text(0.02, 0.97, "", transform=axes.transAxes, verticalalignment="top")

    def draw(i: int) -> Any:
        first, now = shown[max(0, i - trail)], shown[i]
        rods.set_data(x[now], y[now])
        path_line.set_data(x[first:now + 1, -1], y[first:now + 1, -1])
        lost = trajectory.predictable_until
        doubt = "  (one possible motion)" if lost is not None and times[now] >= float(lost) else ""
        clock.set_text(f"t = {times[now]:.2f} s{doubt}")
        return rods, path_line, clock

    film = animation.FuncAnimation(figure, draw, frames=count, interval=each, blit=True)
    fps = 1000 / (each + 0.5)  # which both writers turn into milliseconds again, and round down
    if ending == ".gif":
        film.save(path, writer=animation.PillowWriter(fps=fps), dpi=80)
    elif ending == ".html":
        Path(path).write_text(film.to_jshtml(fps=fps), encoding="utf-8")
    if ending is not None:
        pyplot.close(figure)
    return film


def timing(seconds: Any, most: int) -> tuple[int, int]:
    """How many frames, ``most`` at most, of how many ms each, whole hundredths of a second, make up a film.

    >>> timing(2, 150), timing(100, 21)
    ((100, 20), (21, 4770))
    """
    exact = quantity(seconds, "seconds")
    if not exact.is_number or 100 * exact < LEAST:
        raise QuantityError(f"a film runs for some time, {LEAST / 100} s at least, and seconds is {seconds}: give "
                            f"seconds=5, for instance.")
    hundredths = float(100 * exact)
    each = max(LEAST, ceil(hundredths / most))
    return round(hundredths / each), HUNDREDTH * each


def _check_whole(number: Any, name: str, least: int) -> None:
    if isinstance(number, bool) or not isinstance(number, Integral) or number < least:
        raise QuantityError(f"{name} is {number!r}: give a whole number from {least} on.")
