"""The motions of many chains at the same times: a row of trajectories, each with its own error, and their arrays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .ensemble import Ensemble, place
from .errors import SceneError
from .frozen import locked
from .trajectory import Trajectory, labelled

__all__ = ["Trajectories", "chains_and_states"]


@dataclass(frozen=True, repr=False, eq=False)
class Trajectories:
    """The motions of many chains, ``motions[j]`` that of chain j, a :class:`Trajectory`, ``motions[:3]`` of three.

    Immutable.

    Attributes
    ----------
    members : tuple of :class:`Trajectory`, what each chain alone would give, estimated error, events and all
    times : shape (m,), of all; s
    theta, omega : shape (chains, m, n); rad, rad/s
    turns, wrapped : the same, see :class:`Trajectory`
    energy, error : shape (chains, m); J, rad
    accurate : shape (chains,): whether the error of a chain stays within the accuracy asked for
    """

    members: tuple[Trajectory, ...]

    def __len__(self) -> int:
        return len(self.members)

    def __getitem__(self, j: Any) -> Any:
        """The motion of chain j, a :class:`Trajectory`; of a slice those of its chains.

        Raises IndexError where there is no chain j, NotAQuantityError where j is no integer, SceneError where a slice
        holds none.
        """
        if isinstance(j, slice):
            if not self.members[j]:
                raise SceneError(f"these are the motions of {len(self)} chains, and {j} holds none of them: give a "
                                 f"slice that does.")
            return Trajectories(self.members[j])
        return self.members[place(j, len(self), "these are the motions of")]

    def __iter__(self) -> Iterator[Trajectory]:
        return iter(self.members)

    def _stacked(self, name: str) -> Any:
        return locked(np.stack([getattr(motion, name) for motion in self.members]))

    @property
    def times(self) -> Any:
        """Shape (m,); s."""
        return self.members[0].times

    @cached_property
    def theta(self) -> Any:
        """Angles with all their turns, shape (chains, m, n); rad."""
        return self._stacked("theta")

    @cached_property
    def omega(self) -> Any:
        """Rates, shape (chains, m, n); rad/s."""
        return self._stacked("omega")

    @cached_property
    def turns(self) -> Any:
        """Whole turns, shape (chains, m, n)."""
        return self._stacked("turns")

    @cached_property
    def wrapped(self) -> Any:
        """Angles without their turns, shape (chains, m, n); rad."""
        return self._stacked("wrapped")

    @cached_property
    def energy(self) -> Any:
        """Shape (chains, m); J."""
        return self._stacked("energy")

    @cached_property
    def error(self) -> Any:
        """The estimated largest error of any angle of a chain up to each time, shape (chains, m); rad."""
        return self._stacked("error")

    @cached_property
    def accurate(self) -> Any:
        """Whether the estimated error of a chain stays within the accuracy asked for, shape (chains,)."""
        return self._stacked("accurate")

    @property
    def verdict(self) -> str:
        """One sentence, or two, on how far the numbers may be believed: how many chains are, and that of the worst."""
        worst = max(self.members, key=lambda motion: float(motion.error[-1]))
        return f"{int(self.accurate.sum())} of {len(self)} chains are as accurate as asked.  The worst: {worst.verdict}"

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` over chain (0, 1, ...), time and rod (1, ..., n).

        Raises NotInstalledError without xarray.
        """
        return labelled(self, self.members, ("chain", "time", "rod"))

    def __repr__(self) -> str:
        return f"Trajectories({len(self)} chains" + (f", the first of which is {self[0]})" if self.members else ")")

    def _repr_latex_(self) -> str:
        return rf"$\theta^{{(j)}}(t), \quad j = 0, \ldots, {len(self) - 1}$" if self.members else r"$\emptyset$"


def chains_and_states(system: Any, theta0: Any, omega0: Any) -> list[tuple[Any, Any, Any]] | None:
    """System, angles and rates of every chain where there are many, what is given once repeated; None for one chain."""
    given = {"system": list(system) if isinstance(system, Ensemble) else None,
             "theta0": _rows(theta0), "omega0": _rows(omega0)}
    many = {name: rows for name, rows in given.items() if rows is not None}
    if not many:
        return None
    counts = [len(rows) for rows in many.values()]
    if len(set(counts)) > 1 or not counts[0]:
        raise SceneError("there are as many chains as states, and here are "
                         + ", ".join(f"{len(rows)} in {name}" for name, rows in many.items())
                         + ": give theta0 and omega0 the shape (chains, n), or (n,) where all start alike.")
    alike = {"system": system, "theta0": theta0, "omega0": omega0}
    return list(zip(*(many.get(name, [one] * counts[0]) for name, one in alike.items()), strict=True))


def _rows(states: Any) -> Any:
    """The states of many chains, each shape (n,); None for that of one, and for whatever else is no state."""
    if isinstance(states, (list, tuple)) and states and all(isinstance(x, (list, tuple, np.ndarray)) for x in states):
        return states
    return states if isinstance(states, np.ndarray) and states.ndim == 2 else None
