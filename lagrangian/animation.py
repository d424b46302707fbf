"""Films of a motion, as a matplotlib animation, a GIF or a page of HTML."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from .errors import QuantityError

__all__ = ["animate"]


def animate(trajectory: Any, path: Any = None, seconds: float | None = None, frames: int = 150, trail: int = 40) -> Any:
    """A film of the chain in the frame of its support; returns the matplotlib animation.

    ``path`` ends in .gif or .html (which holds all its frames), or is None; ``seconds`` is how long the film runs, the
    time of the motion by default; ``trail`` frames of the tip's path are shown.  Raises QuantityError for other
    endings.
    """
    pyplot, animation = import_module("matplotlib.pyplot"), import_module("matplotlib.animation")
    ending = None if path is None else Path(path).suffix
    if ending not in (None, ".gif", ".html"):
        raise QuantityError(f"a film is written as .gif or .html, and path is {path}: change its ending.")
    x, y = trajectory.positions()
    times = np.asarray(trajectory.times, dtype=float)
    shown = np.unique(np.linspace(0, len(times) - 1, min(frames, len(times))).astype(int))
    duration = abs(times[-1] - times[0]) if seconds is None else seconds
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

    interval = 1000 * duration / max(1, len(shown))
    film = animation.FuncAnimation(figure, draw, frames=len(shown), interval=interval, blit=True)
    if ending == ".gif":
        film.save(path, writer=animation.PillowWriter(fps=max(1, round(len(shown) / max(duration, 1e-3)))), dpi=80)
    elif ending == ".html":
        Path(path).write_text(film.to_jshtml(), encoding="utf-8")
    if ending is not None:
        pyplot.close(figure)
    return film
