"""Many chains at once: the recursion of :mod:`lagrangian.recursion` with one chain in every lane of a vector register.

Each chain has its own state, arrays of shape (n, chains) in any order of memory; the rods are the same for all, or each
chain has its own.  Chains are taken LANES at a time; whatever is carried from link to link is one flat array whose rows
lie LANES apart, a constant known when the loops are translated, so that the compiler sees that rows do not overlap and
the loop over lanes becomes vector instructions.  States are copied to such rows first, a link at a time.

Rods of their own are five numbers, m, l, H, Ic and J, from which the other constants follow without cancellation:
reading them from memory costs more than that.  They stand in the order in which the loops go through them: LANES
chains after LANES chains, rod by rod from the tip, each number for these chains side by side.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .angles import LARGEST, difference, sines, sines_of_large_joints
from .machine import allocating, inlined, machine, prefetched
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

__all__ = ["accelerate_rows", "accelerate_together", "in_lanes"]

LANES = 64  # 32 to 128 cost the same
AHEAD = 4  # links
LINE = 8  # numbers in a line of memory


def in_lanes(m: Any, l: Any, H: Any, Ic: Any, J: Any) -> Any:
    """Columns of rods, shape (chains, n) each, as (blocks, n, 5 * LANES), the tip first; the last chain fills up."""
    rods = np.stack((m, l, H, Ic, J))[:, :, ::-1]
    five, chains, n = rods.shape
    filled = np.pad(rods, ((0, 0), (0, -chains % LANES), (0, 0)), mode="edge").reshape(five, -1, LANES, n)
    return np.ascontiguousarray(filled.transpose(1, 3, 0, 2)).reshape(-1, n, five * LANES)


@inlined
def larger(a: Any, b: Any) -> Any:
    """The larger number, b where a is none; adding 0 keeps stores unconditional, masked ones take AMD's cores long."""
    return (a if a > b else b) + 0.0


@inlined
def fetch(rows: Any, k: int, first: int, end: int, step: int) -> None:
    """Ask memory for entries of row k, if there is one."""
    if 0 <= k < rows.shape[0]:
        for j in range(first, end, step):
            prefetched(rows, k, j)


@allocating
def accelerate_lanes(rods: Any, theta: Any, omega: Any, tau: Any, ax: Any, ay: Any, work: Any, excess: Any,
                     out: Any) -> tuple[bool, bool]:
    """Write ``theta''`` of all chains to ``out``, float64 only.

    Returns whether all are finite and all angles small enough, and whether an answer is in doubt.

    Shapes: rods (n, 8), or as of :func:`in_lanes`; theta, omega, out (n, chains); tau the same or None; work
    (n, 7 * LANES), or (n, 9 * LANES) with excess, which is (chains,) or None, written: how far the largest variance is
    beyond what is in no doubt, positive or no number where the answer is in doubt.  All chains are on one support, with
    acceleration ``(ax, ay)``.  Small enough is :data:`lagrangian.angles.LARGEST` / 2.
    """
    n, chains = theta.shape
    step = LINE if rods.ndim == 2 else 1
    held = np.zeros(16 * LANES)
    largest = nought = again = 0.0
    for first in range(0, chains, LANES):
        width = min(LANES, chains - first)
        held[:(8 if excess is None else 10) * LANES] = 0.0
        row = theta[n - 1, first:first + width]
        for j in range(width):
            held[12 * LANES + j] = row[j]
        for i in range(n):
            k = n - 1 - i
            o = work[k]
            fetch(theta, k - AHEAD, first, first + width, step)
            fetch(omega, k - AHEAD, first, first + width, step)
            if rods.ndim == 3:
                fetch(rods[first // LANES], n - 1 - k + AHEAD, 0, rods.shape[2], LINE)
            if k > 0:
                row = theta[k - 1, first:first + width]
                for j in range(width):
                    held[13 * LANES + j] = row[j]
            else:
                held[13 * LANES:14 * LANES] = 0.0
            for j in range(width):
                here, before = held[12 * LANES + j], held[13 * LANES + j]
                d, e = difference(here, before)
                o[3 * LANES + j], o[4 * LANES + j] = sines(d, e)
                held[10 * LANES + j] = larger(abs(here), held[10 * LANES + j])
                held[12 * LANES + j] = before
            row = omega[k, first:first + width]
            for j in range(width):
                o[6 * LANES + j] = row[j]
            if tau is not None:
                row = tau[k, first:first + width]
                for j in range(width):
                    held[14 * LANES + j] = row[j]
            if rods.ndim == 2:
                m, l, I, Ic = rods[k, 0], rods[k, 1], rods[k, 2], rods[k, 3]
                J, It, mH, mG = rods[k, 4], rods[k, 5], rods[k, 6], rods[k, 7]
            else:
                own = rods[first // LANES, n - 1 - k]
            for j in range(width):
                if rods.ndim == 3:
                    m, l, H, Ic, J = own[j], own[LANES + j], own[2 * LANES + j], own[3 * LANES + j], own[4 * LANES + j]
                    G = l - H
                    mH, mG = m * H, m * G
                    I, It = Ic + mH * H, Ic + mG * G
                Puu, Pun, Pnn, Delta = held[j], held[LANES + j], held[2 * LANES + j], held[3 * LANES + j]
                qn, rate = held[5 * LANES + j], o[6 * LANES + j]
                r, Er, a, x, y, det = inertia(m, l, I, Ic, J, It, Puu, Pun, Pnn, Delta)
                f0, f1, f2, f3 = force(m, l, I, Ic, J, It, mH, mG, Puu, Pun, Pnn, Delta, r, Er, held[4 * LANES + j], qn,
                                       held[6 * LANES + j], held[7 * LANES + j], rate * rate)
                o[j] = J * r
                lr = l * r
                o[LANES + j] = lr * Pun
                o[5 * LANES + j] = (mH + l * Pnn) * r
                if tau is None:
                    o[2 * LANES + j] = lr * qn
                else:
                    t = held[14 * LANES + j]
                    o[2 * LANES + j] = (l * qn - t) * r
                    g0, g1, g2, g3 = torque(m, l, mH, mG, Puu, Pun, Pnn, Delta, r)
                    f0, f1, f2, f3 = f0 + t * g0, f1 + t * g1, f2 + t * g2, f3 + t * g3
                if excess is not None:
                    llr, w = l * lr, l * o[2 * LANES + j]
                    o[7 * LANES + j] = llr * llr * held[8 * LANES + j] + w * w
                    o[8 * LANES + j] = llr * llr * held[9 * LANES + j]
                s, c = o[3 * LANES + j], o[4 * LANES + j]
                if excess is not None:
                    held[9 * LANES + j], held[8 * LANES + j] = spread_within(s, c, a, x, y, f0,
                                                                             rate * rate * (mH + l * Er))
                    if tau is not None:
                        w, g, h = t * lr, t * g0, t * g1
                        o[7 * LANES + j] += w * w
                        held[8 * LANES + j] += g * g * s * s + h * h * c * c
                Puu, Pun, Pnn = turned_inertia(s, c, a, x, y)
                f0, f1, f2, f3 = turned_force(s, c, f0, f1, f2, f3)
                held[j], held[LANES + j], held[2 * LANES + j], held[3 * LANES + j] = Puu, Pun, Pnn, det
                held[4 * LANES + j], held[5 * LANES + j] = f0, f1
                held[6 * LANES + j], held[7 * LANES + j] = f2, f3
        for j in range(width):
            held[j], held[LANES + j] = ay, ax
        if excess is not None:
            held[2 * LANES:7 * LANES] = 0.0  # the covariance, the largest theta''**2, the largest variance
        for k in range(n):
            o = work[k]
            fetch(out, k + AHEAD, first, first + width, step)
            if rods.ndim == 2:
                l = rods[k, 1]
                per = 1.0 / l
            else:
                own = rods[first // LANES, n - 1 - k]
            for j in range(width):
                if rods.ndim == 3:
                    l = own[LANES + j]
                s, c, tu, tn = o[3 * LANES + j], o[4 * LANES + j], held[j], held[LANES + j]
                au, an = tu * c + tn * s, tn * c - tu * s
                lz = l * (o[6 * LANES + j] * o[6 * LANES + j])
                if excess is not None:
                    uu, un, nn, v = spread(s, c, tu, tn, au - lz, lz, o[j], l * o[LANES + j], o[8 * LANES + j],
                                           o[7 * LANES + j], held[2 * LANES + j], held[3 * LANES + j],
                                           held[4 * LANES + j])
                    held[2 * LANES + j], held[3 * LANES + j], held[4 * LANES + j] = uu, un, nn
                    if rods.ndim == 3:
                        per = 1.0 / l
                    held[6 * LANES + j] = larger(v * (per * per), held[6 * LANES + j])
                tu = au - lz
                q = o[2 * LANES + j] + o[LANES + j] * tu
                tn, x = o[j] * an - l * q, -(o[5 * LANES + j] * an + q)
                held[j], held[LANES + j], held[13 * LANES + j] = tu, tn, x
                held[11 * LANES + j] += 0.0 * x
                if excess is not None:
                    held[5 * LANES + j] = larger(x * x, held[5 * LANES + j])
            row = out[k, first:first + width]
            for j in range(width):
                row[j] = held[13 * LANES + j]
        if excess is not None:
            row = excess[first:first + width]
            for j in range(width):
                lost = 0.0 * (held[2 * LANES + j] + held[4 * LANES + j])
                x = lost + (held[6 * LANES + j] - DOUBT * DOUBT * held[5 * LANES + j])
                row[j] = x
                held[15 * LANES + j] = (held[15 * LANES + j] if x <= 0.0 else 1.0) + 0.0
    for j in range(LANES):
        largest = max(largest, held[10 * LANES + j])
        nought, again = nought + held[11 * LANES + j], again + held[15 * LANES + j]
    return nought == 0.0 and largest <= 0.5 * LARGEST, again > 0.0


def accelerate_together(rods: Any, theta: Any, omega: Any, tau: Any, ax: float, ay: float, asked: bool,
                        out: Any) -> tuple[bool, Any]:
    """:func:`accelerate_lanes`, ``asked`` for doubt or not; whether it could, and which are in doubt or False."""
    n, chains = theta.shape
    excess: Any = np.empty(chains) if asked else None
    work = np.empty((n, (9 if asked else 7) * LANES))
    done, again = machine(accelerate_lanes)(rods, theta, omega, tau, ax, ay, work, excess, out)
    return done, again and ~(excess <= 0.0)


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
