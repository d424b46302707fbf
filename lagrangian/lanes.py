"""Many chains at once: the recursion of :mod:`lagrangian.recursion` with one chain in every lane of a vector register.

Each chain has its own state, arrays of shape (n, chains) in any order of memory; the rods are the same for all, or each
chain has its own.  Chains are taken LANES at a time; whatever is carried from link to link is one flat array whose rows
lie LANES apart, a constant known when the loops are translated, so that the compiler sees that rows do not overlap and
the loop over lanes becomes vector instructions.  States are copied to such rows first, a link at a time; but GROUP
links, a line of memory, at a time where the same links of all chains fall to the same few lines of the cache.

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
GROUP = 8  # numbers in a line of memory
PART = LANES // GROUP
CROWDED = 64  # links, or a multiple: a cache has 64 places for a line, and the next chain's lines go to the same eight

# Rows of what is carried from link to link: inertia and forces of all beyond, two variances; the largest angle, 0
# theta'', 1 where an answer is in doubt; the angles of this rod and the one before, its torque.
PUU, PUN, PNN, DELTA, QU, QN, KU, KN, VAR_QN, VAR_PUN, ANGLE, NOUGHT, ASKED, HERE, BEFORE, TAU = (
    range(0, 16 * LANES, LANES))
VAR_QU = TAU + LANES  # of counterweighted chains: the variance of qu'
# On the way back: the acceleration and its covariance, the largest theta''**2 and variance, theta''.
TU, TN, C_UU, C_UN, C_NN, SIZE, SPREAD, FOUND = range(0, 8 * LANES, LANES)
# What is kept of every link: w0, w1/l, w2/l, sine and cosine, (m H + l Pnn)/D, theta', variances of w2 and w1.
W0, W1, W2, SIN, COS, W3, RATE, VAR_W2, VAR_W1 = range(0, 9 * LANES, LANES)
LOST = VAR_W1 + LANES  # of counterweighted chains: what w3 loses
# Rods of their own.
MASS, LENGTH, CENTER, SPIN, COUPLING = range(0, 5 * LANES, LANES)


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


@inlined
def take(rows: Any, k: int, first: int, end: int, groups: Any, which: int, held: Any, at: int) -> None:
    """Copy row k of some chains, from the last to the first: from where it lies, or a group at a time."""
    if groups is None:
        fetch(rows, k - AHEAD, first, end, GROUP if rows.strides[1] == rows.itemsize else 1)
        row = rows[k, first:end]
        for j in range(end - first):
            held[at + j] = row[j]
    else:
        group, place = groups[which], k % GROUP
        if place == GROUP - 1:
            for j in range(end - first):
                for i in range(GROUP):
                    group[i * LANES + j] = rows[k - GROUP + 1 + i, first + j]
        part = first + place * PART
        fetch(rows, k - place - 1, part, min(part + PART, end), 1)
        for j in range(end - first):
            held[at + j] = group[place * LANES + j]


@inlined
def give(rows: Any, k: int, first: int, end: int, groups: Any, held: Any, at: int) -> None:
    """Write row k of some chains, from the first to the last: to where it lies, or a group at a time."""
    if groups is None:
        fetch(rows, k + AHEAD, first, end, GROUP if rows.strides[1] == rows.itemsize else 1)
        row = rows[k, first:end]
        for j in range(end - first):
            row[j] = held[at + j]
    else:
        group, place = groups[0], k % GROUP
        part = first + place * PART
        fetch(rows, k - place + GROUP, part, min(part + PART, end), 1)
        for j in range(end - first):
            group[place * LANES + j] = held[at + j]
        if place == GROUP - 1:
            for j in range(end - first):
                for i in range(GROUP):
                    rows[k - GROUP + 1 + i, first + j] = group[i * LANES + j]


@allocating
def accelerate_lanes(rods: Any, theta: Any, omega: Any, tau: Any, ax: Any, ay: Any, counter: Any, work: Any,
                     groups: Any, excess: Any, out: Any) -> tuple[bool, bool]:
    """Write ``theta''`` of all chains to ``out``, float64 only.

    Returns whether all are finite and all angles small enough, and whether an answer is in doubt.

    Shapes: rods (n, 8), or as of :func:`in_lanes`; theta, omega, out (n, chains); tau the same or None; counter True
    where a rod has its centre beyond its near joint, else None; work (n, 9 * LANES), or 10 with counter; groups None,
    or (3, GROUP * LANES), and then GROUP divides n; excess (chains,), written: how far the largest variance is beyond
    what is in no doubt, positive or no number where the answer is in doubt.  All chains are on one support, with
    acceleration ``(ax, ay)``.  Small enough is :data:`lagrangian.angles.LARGEST` / 2.
    """
    n, chains = theta.shape
    held = np.zeros(VAR_QU + LANES)
    largest = nought = again = 0.0
    for first in range(0, chains, LANES):
        width = min(LANES, chains - first)
        held[PUU:ANGLE] = 0.0
        held[VAR_QU:] = 0.0
        take(theta, n - 1, first, first + width, groups, 0, held, HERE)
        for i in range(n):
            k = n - 1 - i
            o = work[k]
            if rods.ndim == 3:
                fetch(rods[first // LANES], n - 1 - k + AHEAD, 0, rods.shape[2], GROUP)
            if k > 0:
                take(theta, k - 1, first, first + width, groups, 0, held, BEFORE)
            else:
                held[BEFORE:BEFORE + LANES] = 0.0
            for j in range(width):
                here, before = held[HERE + j], held[BEFORE + j]
                d, e = difference(here, before)
                o[SIN + j], o[COS + j] = sines(d, e)
                held[ANGLE + j] = larger(abs(here), held[ANGLE + j])
                held[HERE + j] = before
            take(omega, k, first, first + width, groups, 1, o, RATE)
            if tau is not None:
                take(tau, k, first, first + width, groups, 2, held, TAU)
            if rods.ndim == 2:
                m, l, I, Ic = rods[k, 0], rods[k, 1], rods[k, 2], rods[k, 3]
                J, It, mH, mG = rods[k, 4], rods[k, 5], rods[k, 6], rods[k, 7]
            else:
                own = rods[first // LANES, n - 1 - k]
            for j in range(width):
                if rods.ndim == 3:
                    m, l, H, Ic, J = own[MASS + j], own[LENGTH + j], own[CENTER + j], own[SPIN + j], own[COUPLING + j]
                    G = l - H
                    mH, mG = m * H, m * G
                    I, It = Ic + mH * H, Ic + mG * G
                Puu, Pun, Pnn, Delta = held[PUU + j], held[PUN + j], held[PNN + j], held[DELTA + j]
                qn, rate = held[QN + j], o[RATE + j]
                r, Er, a, x, y, det = inertia(m, l, I, Ic, J, It, Puu, Pun, Pnn, Delta)
                f0, f1, f2, f3 = force(m, l, I, Ic, J, It, mH, mG, Puu, Pun, Pnn, Delta, r, Er, held[QU + j], qn,
                                       held[KU + j], held[KN + j], rate * rate)
                o[W0 + j] = J * r
                lr = l * r
                o[W1 + j] = lr * Pun
                o[W3 + j] = (mH + l * Pnn) * r
                if tau is None:
                    o[W2 + j] = lr * qn
                else:
                    t = held[TAU + j]
                    o[W2 + j] = (l * qn - t) * r
                    g0, g1, g2, g3 = torque(m, l, mH, mG, Puu, Pun, Pnn, Delta, r)
                    f0, f1, f2, f3 = f0 + t * g0, f1 + t * g1, f2 + t * g2, f3 + t * g3
                llr, w = l * lr, l * o[W2 + j]
                o[VAR_W2 + j] = llr * llr * held[VAR_QN + j] + w * w
                o[VAR_W1 + j] = llr * llr * held[VAR_PUN + j]
                s, c = o[SIN + j], o[COS + j]
                size = abs(mH)
                b = rate * rate * (size + l * Er)
                held[VAR_PUN + j], held[VAR_QN + j] = spread_within(s, c, a, x, y, f0, b)
                if counter is not None:
                    lost, before = (size - mH) * r, I * I * (r * r) * held[VAR_QU + j]
                    o[LOST + j] = lost
                    held[VAR_QN + j] += before * (s * s)
                    held[VAR_QU + j] = (f0 * f0 + b * b + before) * (c * c)
                if tau is not None:
                    w, g, h = t * lr, t * g0, t * g1
                    if counter is not None:
                        h = t * (g1 + lost)
                    o[VAR_W2 + j] += w * w
                    held[VAR_QN + j] += g * g * s * s + h * h * c * c
                Puu, Pun, Pnn = turned_inertia(s, c, a, x, y)
                f0, f1, f2, f3 = turned_force(s, c, f0, f1, f2, f3)
                held[PUU + j], held[PUN + j], held[PNN + j], held[DELTA + j] = Puu, Pun, Pnn, det
                held[QU + j], held[QN + j] = f0, f1
                held[KU + j], held[KN + j] = f2, f3
        for j in range(width):
            held[TU + j], held[TN + j] = ay, ax
        held[C_UU:SPREAD + LANES] = 0.0
        for k in range(n):
            o = work[k]
            if rods.ndim == 2:
                l = rods[k, 1]
                per = 1.0 / l
            else:
                own = rods[first // LANES, n - 1 - k]
                fetch(rods[first // LANES], n - 1 - k - AHEAD, LENGTH, LENGTH + LANES, GROUP)
            for j in range(width):
                if rods.ndim == 3:
                    l = own[LENGTH + j]
                s, c, tu, tn = o[SIN + j], o[COS + j], held[TU + j], held[TN + j]
                au, an = tu * c + tn * s, tn * c - tu * s
                lz = l * (o[RATE + j] * o[RATE + j])
                uu, un, nn, v = spread(s, c, tu, tn, au - lz, lz, o[W0 + j], l * o[W1 + j], o[VAR_W1 + j],
                                       o[VAR_W2 + j], held[C_UU + j], held[C_UN + j], held[C_NN + j])
                held[C_UU + j], held[C_UN + j], held[C_NN + j] = uu, un, nn
                if rods.ndim == 3:
                    per = 1.0 / l
                v = v * (per * per)
                if counter is not None:
                    v += (an * o[LOST + j]) * (an * o[LOST + j])
                held[SPREAD + j] = larger(v, held[SPREAD + j])
                tu = au - lz
                q = o[W2 + j] + o[W1 + j] * tu
                tn, x = o[W0 + j] * an - l * q, -(o[W3 + j] * an + q)
                held[TU + j], held[TN + j], held[FOUND + j] = tu, tn, x
                held[NOUGHT + j] += 0.0 * x
                held[SIZE + j] = larger(x * x, held[SIZE + j])
            give(out, k, first, first + width, groups, held, FOUND)
        row = excess[first:first + width]
        for j in range(width):
            lost = 0.0 * (held[C_UU + j] + held[C_NN + j])
            x = lost + (held[SPREAD + j] - DOUBT * DOUBT * held[SIZE + j])
            row[j] = x
            held[ASKED + j] = (held[ASKED + j] if x <= 0.0 else 1.0) + 0.0
    for j in range(LANES):
        largest = max(largest, held[ANGLE + j])
        nought, again = nought + held[NOUGHT + j], again + held[ASKED + j]
    return nought == 0.0 and largest <= 0.5 * LARGEST, again > 0.0


def accelerate_together(rods: Any, theta: Any, omega: Any, tau: Any, ax: float, ay: float, counterweighted: bool,
                        out: Any) -> tuple[bool, Any]:
    """:func:`accelerate_lanes`: whether it could, and which answers are in doubt, False for none."""
    n, chains = theta.shape
    excess, work = np.empty(chains), np.empty((n, LOST + LANES if counterweighted else LOST))
    crowded = theta.strides[1] > theta.itemsize and n % CROWDED == 0
    groups = np.empty((3, GROUP * LANES)) if crowded else None
    done, again = machine(accelerate_lanes)(rods, theta, omega, tau, ax, ay, True if counterweighted else None, work,
                                            groups, excess, out)
    return done, again and ~(excess <= 0.0)


def accelerate_rows(rods: Any, theta: Any, omega: Any, tau: Any, ax: Any, ay: Any, out: Any) -> tuple[bool, Any]:
    """The same by NumPy, with one chain in every entry of a row; whether all are finite, and which are in doubt.

    Angles may have any size; rods (n, 8), or (n, 8, chains); theta (n,) does too.
    """
    n = len(theta)
    s, c = np.empty_like(theta), np.empty_like(theta)
    doubt = np.empty((3, *theta.shape))
    with np.errstate(all="ignore"):
        sines_of_large_joints(theta, s, c)
        accelerate_rods(rods, omega * omega, tau, s, c, ax, ay, np.empty((n, 4, *theta.shape[1:])), doubt, out)
        return bool(np.isfinite(out).all()), ~(doubt[0].max(axis=0) <= DOUBT**2 * (out * out).max(axis=0))
