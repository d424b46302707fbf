"""Many chains, each with its own rods: blocks of LANES chains, whose constants lie one chain in every lane.

A rod has eight constants, and reading them from memory is what costs, so that they stand in the order in which
:mod:`lagrangian.lanes` goes through them: block by block, rod by rod, each constant for the LANES chains of the block
side by side.  States, shape (chains, n), are turned to lie so too, a block at a time.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .lanes import LANES, accelerate_lanes
from .machine import allocating

__all__ = ["accelerate_blocks", "in_blocks"]


def in_blocks(rows: Any) -> Any:
    """Eight constants, shape (chains, n) each, as blocks, shape (blocks, n, 8, LANES); the last chain fills up."""
    rods = np.stack(rows)
    eight, chains, n = rods.shape
    filled = np.pad(rods, ((0, 0), (0, -chains % LANES), (0, 0)), mode="edge")
    return np.ascontiguousarray(filled.reshape(eight, -1, LANES, n).transpose(1, 3, 0, 2))


def turned(states: Any, first: int, rows: Any) -> None:
    """Write the states of a block to ``rows``, shape (n, LANES)."""
    width = min(LANES, states.shape[0] - first)
    for k in range(states.shape[1]):
        for j in range(width):
            rows[k, j] = states[first + j, k]


@allocating
def accelerate_blocks(rods: Any, theta: Any, omega: Any, tau: Any, ax: Any, ay: Any, doubtful: Any, out: Any) -> bool:
    """Write ``theta''`` of all chains to ``out``; whether all are finite and all angles small enough.

    Shapes: rods as of :func:`in_blocks`; theta, omega, out (chains, n); tau the same or None; doubtful
    (blocks * LANES,) or None, written.  The rest as for :func:`lagrangian.lanes.accelerate_lanes`.
    """
    chains, n = theta.shape
    space, work = np.zeros((4, n, LANES)), np.empty((n, 8 * LANES))
    angle, rate, moment, found = space[0], space[1], space[2], space[3]
    done = True
    for block in range(rods.shape[0]):
        first = block * LANES
        turned(theta, first, angle)
        turned(omega, first, rate)
        if tau is not None:
            turned(tau, first, moment)
        done &= accelerate_lanes(rods[block], angle, rate, None if tau is None else moment, ax, ay, work,
                                 None if doubtful is None else doubtful[first:first + LANES], found)
        for j in range(min(LANES, chains - first)):
            for k in range(n):
                out[first + j, k] = found[k, j]
    return done
