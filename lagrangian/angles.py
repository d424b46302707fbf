r"""Sine and cosine of a difference of angles, to the last digit, without branches.

The difference of two floats is ``d + e`` exactly, with ``e`` at most half a unit in the last place of ``d``;
dropping ``e`` would cost 1e-10 where angles are 1e6 apart.  With ``n`` the integer nearest to ``2 d/pi``,

    r = d - n pi/2,   |r| <= pi/4,

where ``pi/2`` is held in three parts, the first two short enough for ``n`` times them to be exact while
``|n| < 2**20``.  ``sin r = r + r**3 S(r**2)`` and ``cos r = 1 - r**2/2 + r**4 C(r**2)`` with the polynomials S and C of
degree 5 whose largest relative error in sine and cosine is least (Remez), 3.8e-18 and 5.7e-20 with their coefficients
rounded.  Nothing branches, so that loops over many angles vectorise, and the terms of a polynomial are taken in pairs,
which wait less for one another.  Against 40 digits the errors stay below 4e-16 in relative terms, or 2**-104 times
the angles where a sine or cosine nearly vanishes.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .machine import inlined

__all__ = ["LARGEST", "TURN", "TURN_LOW", "difference", "product", "revolved", "sines", "sines_of_large_joints"]

# pi/2 = HALF_1 + HALF_2 + HALF_3 + O(1e-36); the first two have 33 bits.
HALF_1 = float.fromhex("0x1.921fb54400000p+0")
HALF_2 = float.fromhex("0x1.0b4611a600000p-34")
HALF_3 = float.fromhex("0x1.3198a2e037073p-69")
PER_HALF = float.fromhex("0x1.45f306dc9c883p-1")  # 2/pi
ROUND = 1.5 * 2.0**52  # adding and taking it away rounds to the nearest integer
LARGEST = 1.6e6  # beyond it, n no longer fits
TURN = float.fromhex("0x1.921fb54442d18p+2")
TURN_LOW = float.fromhex("0x1.1a62633145c07p-52")

S0, S1, S2, S3, S4, S5 = map(float.fromhex, (
    "-0x1.5555555555548p-3", "0x1.111111110f764p-7", "-0x1.a01a019bf35b8p-13",
    "0x1.71de35603950dp-19", "-0x1.ae5e5572ecc0cp-26", "0x1.5d8e825ffa885p-33"))
C0, C1, C2, C3, C4, C5 = map(float.fromhex, (
    "0x1.555555555554bp-5", "-0x1.6c16c16c15015p-10", "0x1.a01a019c8f24cp-16",
    "-0x1.27e4f7f19077dp-22", "0x1.1ee9dbce1da80p-29", "-0x1.8fa683eca7a1dp-37"))


@inlined
def difference(a: Any, b: Any) -> tuple[Any, Any]:
    """``a - b`` as the nearest float and the exact remainder."""
    d = a - b
    t = a - d
    return d, (a - (d + t)) + (t - b)


@inlined
def product(a: Any, b: Any) -> tuple[Any, Any]:
    """``a * b`` as the nearest float and the exact remainder, for factors below 1e290."""
    split = 134217729.0
    p, t, u = a * b, split * a, split * b
    ah, bh = t - (t - a), u - (u - b)
    al, bl = a - ah, b - bh
    return p, ((ah * bh - p) + ah * bl + al * bh) + al * bl


@inlined
def sines(d: Any, e: Any) -> tuple[Any, Any]:
    """``sin(d + e), cos(d + e)`` for ``|d| <= LARGEST`` and ``|e|`` below 1e-9, of which the square is left out."""
    n = (d * PER_HALF + ROUND) - ROUND
    first = d - n * HALF_1
    second = n * HALF_2
    r = first - second
    e = e + (((first - r) - second) - n * HALF_3)
    z = r * r
    w = z * z
    cubic = r * z * ((S0 + z * S1) + w * ((S2 + z * S3) + w * (S4 + z * S5)))
    half = 0.5 * z
    lead = 1.0 - half
    rest = ((1.0 - lead) - half) + w * ((C0 + z * C1) + w * ((C2 + z * C3) + w * (C4 + z * C5)))
    odd = r + (cubic + e * (lead + rest))
    even = lead + (rest - e * (r + cubic))
    halves = (0.5 * n + ROUND) - ROUND
    quarter = n - 2.0 * halves  # -1, 0 or 1
    parity = halves - 2.0 * ((0.5 * halves + ROUND) - ROUND)
    sign = 1.0 - 2.0 * (parity * parity)
    turn = sign * quarter
    return (turn * even, -(turn * odd)) if quarter != 0.0 else (sign * odd, sign * even)


@inlined
def revolved(turns: Any, turns_low: Any, t: Any, t_low: Any) -> tuple[Any, Any]:
    """Sine and cosine of ``2 pi (turns + turns_low) (t + t_low)``; whole turns are left out before anything rounds."""
    whole, rest = product(turns, t)
    part, rest = difference(whole - np.rint(whole), -(rest + (turns * t_low + turns_low * t)))
    part = part - np.rint(part)
    angle, low = product(TURN, part)
    return sines(angle, low + (TURN * rest + TURN_LOW * part))


def sines_of_large_joints(theta: Any, s: Any, c: Any) -> None:
    """Write sine and cosine of ``theta_k - theta_(k-1)`` (``theta_1`` first), angles of any size, shape (n, ...)."""
    s[0], c[0] = np.sin(theta[0]), np.cos(theta[0])
    for k in range(1, theta.shape[0]):
        d, e = difference(theta[k], theta[k - 1])
        x, y, p, q = np.sin(d), np.cos(d), np.sin(e), np.cos(e)
        s[k], c[k] = x * q + y * p, y * q - x * p
