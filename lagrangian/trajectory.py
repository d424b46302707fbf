"""What a simulation gives: states, energies, and how far they may be believed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from sympy import Float, latex

from .animation import animate
from .errors import QuantityError
from .frozen import locked
from .optional import optional
from .plotting import plot

__all__ = ["Trajectory", "labelled"]

ARRAYS = ("times", "theta", "omega", "turns", "wrapped", "energy", "error")


@dataclass(frozen=True, repr=False, eq=False)
class Trajectory:
    """The motion of a chain at given times, with an estimate of its own error.  Immutable; ``==`` is identity.

    Attributes
    ----------
    times : shape (m,); s
    theta, omega : shape (m, n): angles with all their turns, and rates; rad, rad/s
    turns, wrapped : shape (m, n): ``theta = wrapped + 2 pi turns``, ``|wrapped| <= pi``, which keeps digits that theta
        itself cannot hold after many turns
    energy : shape (m,), in the frame of the support; J.  See :meth:`lagrangian.CompiledChain.energy`
    error : shape (m,): estimated largest error of any angle up to each time; rad.  It is an estimate from
        further runs with other rounding of the data, not a bound
    accuracy : the error that was asked for; rad
    method, steps, order : how the motion was found
    events : mapping of names to arrays of times, s, in the numbers of theta; see :class:`lagrangian.Crossing`
    chain : the :class:`lagrangian.CompiledChain`
    """

    times: Any
    theta: Any
    omega: Any
    turns: Any
    wrapped: Any
    energy: Any
    error: Any
    accuracy: float
    method: str
    steps: int
    order: int
    chain: Any
    events: Mapping[str, Any] = field(default_factory=dict)
    interpolant: Any = None

    def __post_init__(self) -> None:
        for name in ARRAYS:
            object.__setattr__(self, name, locked(getattr(self, name)))
        object.__setattr__(self, "events", {name: locked(times) for name, times in self.events.items()})

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.__post_init__()  # arrays that were pickled can be written to again

    def __len__(self) -> int:
        return len(self.times)

    @property
    def accurate(self) -> bool:
        """Whether the estimated error stays within the accuracy asked for."""
        return bool(self.error[-1] <= self.accuracy)

    @property
    def predictable_until(self) -> Any:
        """The first of ``times`` at which the accuracy asked for is lost, to chaos or rounding; None if it never is."""
        lost = np.flatnonzero(self.error > self.accuracy)
        return self.times[lost[0]] if lost.size else None

    @property
    def energy_changes(self) -> Any:
        """The change of energy since the start, shape (times,), as a fraction of ``M g L``.

        Without weight it is a fraction of the largest energy.
        """
        change = abs(np.asarray(self.energy - self.energy[0], dtype=float))
        scale = self.chain.energy_scale or float(abs(np.asarray(self.energy, dtype=float)).max())
        return change / scale if scale else change

    @property
    def energy_drift(self) -> float:
        """The largest of :attr:`energy_changes`."""
        return float(self.energy_changes.max())

    @property
    def verdict(self) -> str:
        """One sentence on how far the numbers may be believed."""
        worst = float(self.error[-1])
        if self.accurate:
            return f"Every angle is within about {worst:.1e} rad of the true motion; {self.accuracy:.1e} was asked for."
        remedy = ("Ask for more digits, as in simulate(..., digits=40), to see further."
                  if self.method.startswith("taylor")
                  else "Choose method='taylor', and digits=40 with it where that is not enough.")
        return (f"From t = {float(self.predictable_until):.6g} on the accuracy asked for, {self.accuracy:.1e} rad, is "
                f"lost: errors grow to {worst:.1e} rad.  {remedy}")

    def at(self, t: Any) -> tuple[Any, Any]:
        """Angles and rates at any time within the span, shape (n,), or (k, n) for k times; needs ``dense=True``.

        They come from the series of the step that holds the time, in the numbers of ``theta`` and with their error.
        With digits a time is the exact number it is given as: a fraction, ``pi/3``, the dyadic that a float is.

        Raises QuantityError for a time outside the span, for what is no number, and without ``dense=True``.
        """
        if self.interpolant is None:
            raise QuantityError("states between the times asked for are kept on request: simulate(..., dense=True).")
        return self.interpolant(t)  # type: ignore[no-any-return]

    def positions(self) -> tuple[Any, Any]:
        """Joints and tip relative to the support, x to the right and y upwards, shape (m, n + 1) each; m."""
        theta = np.asarray(self.wrapped, dtype=float)
        length = self.chain.rods[:, 1]
        x, y = np.cumsum(length * np.sin(theta), axis=1), np.cumsum(self.chain.up * length * np.cos(theta), axis=1)
        start = np.zeros((len(theta), 1))
        return np.concatenate([start, x], axis=1), np.concatenate([start, y], axis=1)

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` over time and rod (1, ..., n); raises NotInstalledError without xarray."""
        return labelled(self, [self], ("time", "rod"))

    def plot(self, axes: Any = None) -> Any:
        """Angles over time, and the estimated error below them; returns the matplotlib figure."""
        return plot(self, axes)

    def animate(self, path: Any = None, seconds: float | None = None, frames: int = 150, trail: int = 40) -> Any:
        """A film of the chain: a matplotlib animation, written to ``path`` if it ends in .gif or .html.

        It runs ``seconds``, or the time of the motion, in at most ``frames`` pictures, each with the path of the tip
        over the last ``trail`` of them.  Raises QuantityError where these make no film, NotInstalledError without
        matplotlib.
        """
        return animate(self, path, seconds, frames, trail)

    def __repr__(self) -> str:
        span = f"{float(self.times[0]):.6g} to {float(self.times[-1]):.6g}"
        return (f"Trajectory({self.theta.shape[1]} rods, {len(self)} times from {span}, {self.method}, {self.steps} "
                f"steps, error {float(self.error[-1]):.1e} rad)")

    def _repr_latex_(self) -> str:
        start, end, error = (latex(Float(float(x), digits)) for x, digits in (
            (self.times[0], 6), (self.times[-1], 6), (self.error[-1], 2)))
        return (rf"$\theta_1, \ldots, \theta_{{{self.theta.shape[1]}}}(t), \quad t = {start} \ldots {end}, "
                rf"\quad \text{{error}} \approx {error}$")


def labelled(motion: Any, members: Sequence[Trajectory], axes: tuple[str, ...]) -> Any:
    """The arrays of a motion, or of many, over these axes as an ``xarray.Dataset``."""
    xarray = optional("xarray", "a motion as a labelled data set")
    units = {"theta": "rad", "omega": "rad/s", "energy": "J", "error": "rad"}
    variables = {name: (axes[:getattr(motion, name).ndim], getattr(motion, name).copy(),
                        {"units": units[name]} if name in units else {})
                 for name in ("theta", "omega", "turns", "energy", "error")}
    places = {"chain": np.arange(len(members)), "time": motion.times, "rod": np.arange(1, motion.theta.shape[-1] + 1)}
    notes = {"method": "; ".join(sorted({one.method for one in members})), "accuracy": members[0].accuracy,
             "verdict": motion.verdict, "model": "; ".join(sorted({one.chain.model for one in members}))}
    return xarray.Dataset(variables, {axis: places[axis] for axis in axes}, notes)
