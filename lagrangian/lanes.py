"""Many chains at once: the recursion of :mod:`lagrangian.recursion` with one chain in every lane of a vector register.

Each chain has its own state, arrays of shape (n, chains); the rods are the same for all, or each of LANES chains has
its own (:mod:`lagrangian.blocks`).  Chains are taken LANES at a time; whatever is carried from link to link is one flat
array whose rows lie LANES apart, a constant known when the loops are translated, so that the compiler sees that rows do
not overlap and the loop over lanes becomes vector instructions.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .angles import LARGEST, difference, sines, sines_of_large_joints
from .machine import allocating
from .recursion import (
    DOUBT,
    accelerate_rods,
    force,
    inertia,
    spread,
    spread_within,
    torque,
    turned_force,
    turned_inertia,
)

__all__ = ["LANES", "accelerate_lanes", "accelerate_rows"]

LANES = 64  # 32 to 128 cost the same up to n = 100; wide rows are kinder to memory at n = 1000


@allocating
def accelerate_lanes(rods: Any, theta: Any, omega: Any, tau: Any, ax: Any, ay: Any, work: Any, doubtful: Any,
                     out: Any) -> bool:
    """Write ``theta''`` of all chains to ``out``, float64 only; whether all are finite and all angles small enough.

    Shapes: rods (n, 8), or (n, 8, LANES) for LANES chains; theta, omega, out (n, chains); tau the same or None; work
    (n, 8 * LANES); doubtful (chains,) or None, written: whether the answer is in doubt.  All chains are on one support,
    with acceleration ``(ax, ay)``.  Small enough is :data:`lagrangian.angles.LARGEST` / 2.
    """
    n, chains = theta.shape
    held = np.empty(10 * LANES)
    wrong = 0
    for first in range(0, chains, LANES):
        width = min(LANES, chains - first)
        held[:] = 0.0
        for i in range(n):
            k = n - 1 - i
            o = work[k]
            here = theta[k, first:first + width]
            if k > 0:
                before = theta[k - 1, first:first + width]
                for j in range(width):
                    d, e = difference(here[j], before[j])
                    o[3 * LANES + j], o[4 * LANES + j] = sines(d, e)
            else:
                for j in range(width):
                    o[3 * LANES + j], o[4 * LANES + j] = sines(here[j], 0.0)
            for j in range(width):
                wrong += abs(here[j]) > 0.5 * LARGEST
            if rods.ndim == 2:
                m, l, I, Ic = rods[k, 0], rods[k, 1], rods[k, 2], rods[k, 3]
                J, It, mH, mG = rods[k, 4], rods[k, 5], rods[k, 6], rods[k, 7]
            rate = omega[k, first:first + width]
            for j in range(width):
                if rods.ndim == 3:
                    m, l, I, Ic = rods[k, 0, j], rods[k, 1, j], rods[k, 2, j], rods[k, 3, j]
                    J, It, mH, mG = rods[k, 4, j], rods[k, 5, j], rods[k, 6, j], rods[k, 7, j]
                Puu, Pun, Pnn, Delta = held[j], held[LANES + j], held[2 * LANES + j], held[3 * LANES + j]
                qn = held[5 * LANES + j]
                r, Er, a, x, y, det = inertia(m, l, I, Ic, J, It, Puu, Pun, Pnn, Delta)
                f0, f1, f2, f3 = force(m, l, I, Ic, J, It, mH, mG, Puu, Pun, Pnn, Delta, r, Er, held[4 * LANES + j], qn,
                                       held[6 * LANES + j], held[7 * LANES + j], rate[j] * rate[j])
                o[j] = J * r
                o[LANES + j] = l * l * Pun * r
                o[5 * LANES + j] = (mH + l * Pnn) * r
                if tau is None:
                    o[2 * LANES + j] = l * l * qn * r
                else:
                    t = tau[k, first + j]
                    o[2 * LANES + j] = (l * qn - t) * l * r
                    g0, g1, g2, g3 = torque(m, l, mH, mG, Puu, Pun, Pnn, Delta, r)
                    f0, f1, f2, f3 = f0 + t * g0, f1 + t * g1, f2 + t * g2, f3 + t * g3
                if doubtful is not None:
                    ll = l * l * r
                    o[6 * LANES + j] = ll * ll * held[8 * LANES + j] + o[2 * LANES + j] * o[2 * LANES + j]
                    o[7 * LANES + j] = ll * ll * held[9 * LANES + j]
                s, c = o[3 * LANES + j], o[4 * LANES + j]
                if doubtful is not None:
                    held[9 * LANES + j], held[8 * LANES + j] = spread_within(s, c, a, x, y, f0,
                                                                             rate[j] * rate[j] * (mH + l * Er))
                    if tau is not None:
                        w, g, h = t * l * r, t * g0, t * g1
                        o[6 * LANES + j] += w * w
                        held[8 * LANES + j] += g * g * s * s + h * h * c * c
                Puu, Pun, Pnn = turned_inertia(s, c, a, x, y)
                f0, f1, f2, f3 = turned_force(s, c, f0, f1, f2, f3)
                held[j], held[LANES + j], held[2 * LANES + j], held[3 * LANES + j] = Puu, Pun, Pnn, det
                held[4 * LANES + j], held[5 * LANES + j] = f0, f1
                held[6 * LANES + j], held[7 * LANES + j] = f2, f3
        for j in range(width):
            held[j], held[LANES + j] = ay, ax
        held[2 * LANES:7 * LANES] = 0.0  # the covariance, the largest theta''**2 and the largest variance
        for k in range(n):
            o = work[k]
            if rods.ndim == 2:
                l = rods[k, 1]
                per_length = 1.0 / l
            rate, result = omega[k, first:first + width], out[k, first:first + width]
            for j in range(width):
                if rods.ndim == 3:
                    l = rods[k, 1, j]
                    per_length = 1.0 / l
                s, c, tu, tn = o[3 * LANES + j], o[4 * LANES + j], held[j], held[LANES + j]
                au, an = tu * c + tn * s, tn * c - tu * s
                lz = l * (rate[j] * rate[j])
                if doubtful is not None:
                    uu, un, nn, v = spread(s, c, tu, tn, au - lz, lz, o[j], o[LANES + j], o[7 * LANES + j],
                                           o[6 * LANES + j], held[2 * LANES + j], held[3 * LANES + j],
                                           held[4 * LANES + j])
                    v = v * (per_length * per_length)
                    held[2 * LANES + j], held[3 * LANES + j], held[4 * LANES + j] = uu, un, nn
                    held[6 * LANES + j] = v if v > held[6 * LANES + j] else held[6 * LANES + j]
                tu = au - lz
                tn = o[j] * an - (o[2 * LANES + j] + o[LANES + j] * tu)
                result[j] = -(o[5 * LANES + j] * an + (o[2 * LANES + j] + o[LANES + j] * tu) * per_length)
                held[j], held[LANES + j] = tu, tn
                if doubtful is not None:
                    v = result[j] * result[j]
                    held[5 * LANES + j] = v if v > held[5 * LANES + j] else held[5 * LANES + j]
            for j in range(width):
                wrong += 0.0 * result[j] != 0.0
        if doubtful is not None:
            for j in range(width):
                lost = 0.0 * (held[2 * LANES + j] + held[4 * LANES + j]) != 0.0
                doubtful[first + j] = lost or held[6 * LANES + j] > DOUBT * DOUBT * held[5 * LANES + j]
    return wrong == 0


def accelerate_rows(rods: Any, theta: Any, omega: Any, tau: Any, ax: Any, ay: Any, out: Any) -> tuple[bool, Any]:
    """The same by NumPy, with one chain in every entry of a row; whether all are finite, and which are in doubt.

    Angles may have any size; rods (n, 8), or (n, 8, chains); theta (n,) does too.
    """
    n = len(theta)
    s, c = np.empty_like(theta), np.empty_like(theta)
    doubt = np.empty((2, *theta.shape))
    with np.errstate(all="ignore"):
        sines_of_large_joints(theta, s, c)
        accelerate_rods(rods, omega * omega, tau, s, c, ax, ay, np.empty((n, 4, *theta.shape[1:])), doubt, out)
        return bool(np.isfinite(out).all()), ~(doubt[0].max(axis=0) <= DOUBT**2 * (out * out).max(axis=0))
