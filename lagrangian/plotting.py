"""Pictures of a motion; matplotlib is loaded when the first one is asked for."""

from __future__ import annotations

from typing import Any

import numpy as np

from .errors import QuantityError
from .optional import optional

__all__ = ["plot"]

MANY = 12  # more rods than this are shown as an image


def plot(trajectory: Any, axes: Any = None) -> Any:
    """Angles over time (an image for long chains) above the estimated error and the energy drift.

    ``axes`` is None or a pair of matplotlib axes.  Where the accuracy asked for is lost the background is grey.
    Raises QuantityError for anything else than a pair, NotInstalledError without matplotlib.
    """
    if axes is None:
        pyplot = optional("matplotlib.pyplot", "a picture of a motion")
        _, axes = pyplot.subplots(2, 1, sharex=True, height_ratios=[3, 1], figsize=(8, 6), layout="constrained")
    try:
        upper, lower = axes
    except (TypeError, ValueError):
        raise QuantityError(f"angles and their error are drawn in a pair of axes, and axes is {axes!r}: give "
                            f"pyplot.subplots(2)[1].") from None
    times, theta = (np.asarray(x, dtype=float) for x in (trajectory.times, trajectory.theta))
    if theta.shape[1] <= MANY:
        for k, angle in enumerate(theta.T, 1):
            upper.plot(times, angle, label=rf"$\theta_{{{k}}}$", linewidth=1.2)
        upper.legend(loc="upper left", fontsize="small", ncols=4)
        upper.set_ylabel("angle / rad")
    else:
        mesh = upper.pcolormesh(times, np.arange(1, theta.shape[1] + 1), np.asarray(trajectory.wrapped, dtype=float).T,
                                cmap="twilight", vmin=-np.pi, vmax=np.pi, shading="nearest", rasterized=True)
        upper.figure.colorbar(mesh, ax=upper, label="angle / rad")
        upper.set_ylabel("rod")
    error = np.asarray(trajectory.error, dtype=float)
    lower.semilogy(times, np.maximum(error, 1e-18), label="estimated error / rad", color="tab:red")
    if trajectory.chain.conserves_energy:
        unit = "MgL" if trajectory.chain.energy_scale else "energy"
        lower.semilogy(times, np.maximum(trajectory.energy_changes, 1e-18), label=f"energy drift / {unit}",
                       color="tab:gray", linewidth=0.8)
    lower.axhline(float(trajectory.accuracy), color="black", linestyle=":", linewidth=1, label="accuracy asked")
    lower.legend(loc="upper left", fontsize="small", ncols=3)
    lower.set_xlabel("time / s")
    if trajectory.predictable_until is not None:
        for part in axes:
            part.axvspan(float(trajectory.predictable_until), times[-1], color="0.9", zorder=0)
    return upper.figure
