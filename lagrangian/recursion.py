r"""Accelerations of a chain in one pass from tip to base and one back: O(n), and an estimate of what rounding took.

Everything beyond the far end of rod k acts on it as a force ``P a + q``, linear in the acceleration ``a`` of
that end (gravity included).  In the rod's own axes, u along it and n across, with the constants of the rod

    I = m R**2,  Ic = I - m H**2,  J = Ic - m H (l - H),  It = Ic + m (l - H)**2,

``z = theta'**2``, the torque ``tau`` on the rod, ``Delta = det P`` and ``kappa = adj(P) q``, at the near end

    D     = I + l**2 Pnn
    Puu'  = m + (I Puu + l**2 Delta)/D     Pun' = J Pun/D     Pnn' = (m Ic + It Pnn)/D
    Delta'= [m Ic (m + Puu) + It (m Pnn + Delta)]/D
    qu'   = [I qu + l**2 kappa_u + l Pun tau]/D - z (m H + l (I Puu + l**2 Delta)/D)
    qn'   = J (qn - l z Pun)/D + (m H + l Pnn) tau/D
    kappa_u' = [m Ic qu + It kappa_u + m (l - H) Pun tau - z (m Ic (m H + l Puu) + It (m H Pnn + l Delta))]/D
    kappa_n' = J (m qn + kappa_n - m (l - H) z Pun)/D + [m H (m + Puu) + l (m Pnn + Delta)] tau/D

and then turns by ``delta = theta_k - theta_(k-1)``, s and c its sine and cosine, with P written as
``Puu v v^T + (Delta/Puu) e e^T``, ``v = (1, Pun/Puu)``, ``e = (0, 1)``.  Carrying Delta and kappa, which plain
articulated-body recursion does not, is what keeps the digits: masses 1e12 apart lose none.  On the way back,
from the acceleration ``alpha`` of the near end,

    tu = alpha_u - l z,   tn = [J alpha_n + l tau - l**2 (qn + Pun tu)]/D,
    theta'' = (tn - alpha_n)/l = [tau - (m H + l Pnn) alpha_n - l (qn + Pun tu)]/D.

**Bobs** need less.  The tensions T solve the notes' tridiagonal system ``Re(Z**-1) T = L theta'**2 - alpha_u e_1``,
whose pivots are ``(1 + rho_k)/m_k`` without subtraction, and

    rho_1 = 0,   rho_k = (m_k/m_(k-1)) (s_k**2 + rho_(k-1))/(1 + rho_(k-1))
    l_k theta_k'' = T_(k+1) s_(k+1)/m_k - T_(k-1) s_k/m_(k-1),   less alpha_n for k = 1.

**Doubt.**  P is a sum of positive terms, but forces and accelerations have the signs of the motion, and their sums
cancel.  Three things lose digits: light rods before a heavy end, where ``w1 = l**2 Pun/D`` grows to the root of the
ratio of masses and a rounding of tu comes back so many times larger; short rods beyond long ones, which divide by
their length what the long ones leave of each other; and motions whose accelerations are all small beside
``theta'**2``.  How much, the same pass can tell.  Let every signed sum be wrong by u = 2**-53 of each of its terms,
independently.  Then variances, in units of u**2, add.  With ``qu' = A - b`` the two parts of qu' above, the turn leaves

    var Pun = (Puu p q)**2 + (s c Delta/Puu)**2, p and q the components of v,   var qn = qn**2 + s**2 (qu'**2 + b**2)

(where a torque acts, its parts of qu', qn' and w2 below count as terms of their own)
and on the way back, with ``w0 = J/D``, ``w1`` and ``w2 = l**2 qn/D``, the covariance C of the errors of ``(tu, tn)``
follows the linear map that the pair itself follows,

    C <- T (C + diag(tu**2, tn**2)) T^T + (what l z, w1 and w2 add),   T = [[1, 0], [-w1, w0]] [[c, s], [-s, c]],

so that errors which belong together stay together, and the estimate does not grow from rod to rod as balls do.
Counterweights, rods with ``H < 0``, are the one case in which ``m H + l Pnn`` and ``m H + l E/D`` cancel: what they
lose is counted too, ``2 |m H| alpha_n/D`` in theta'', and what qu' loses is carried on.  The
root of the largest variance of a theta'' over the largest theta'' is the *doubt*, an estimate and no bound.  An answer
in more doubt than DOUBT is found again with twice the digits (:mod:`lagrangian.redone`); of random hard chains, none
in less was beyond 4e-15 (``benchmarks/hard_chains.py``).  Tensions of bobs have a doubt by the same rule.

The functions are plain Python.  What is passed decides the arithmetic: float64 after translation
(:mod:`lagrangian.machine`), NumPy rows (one entry a chain), mpmath numbers, python-flint balls.
Both forms were checked against the dense equations at 50 digits.
"""

from __future__ import annotations

from typing import Any

from .machine import inlined

__all__ = ["DOUBT", "accelerate_bobs", "accelerate_rods", "force", "inertia", "spread", "spread_within", "torque",
           "turned_force", "turned_inertia"]

DOUBT = 7.0  # units of 2**-53, normwise: 4e-15 is 36


@inlined
def inertia(m: Any, l: Any, I: Any, Ic: Any, J: Any, It: Any, Puu: Any, Pun: Any, Pnn: Any, Delta: Any) -> Any:
    """``1/D, E/D, Puu', Pun'/Puu', Delta'/Puu', Delta'`` at the near end, with ``E = I Puu + l**2 Delta``."""
    D = I + l * l * Pnn
    E = I * Puu + l * l * Delta
    N = m * D + E
    r = 1 / D
    det = m * Ic * (m + Puu) + It * (m * Pnn + Delta)
    R = 1 / N
    return r, E * r, N * r, J * Pun * R, det * R, det * r


@inlined
def turned_inertia(s: Any, c: Any, a: Any, x: Any, y: Any) -> Any:
    """``Puu, Pun, Pnn`` of ``a v v^T + y e e^T``, ``v = (1, x)``, in axes turned back by delta."""
    p = c - x * s
    q = s + x * c
    return a * p * p + y * s * s, a * p * q - y * s * c, a * q * q + y * c * c


@inlined
def force(m: Any, l: Any, I: Any, Ic: Any, J: Any, It: Any, mH: Any, mG: Any, Puu: Any, Pun: Any, Pnn: Any, Delta: Any,
          r: Any, Er: Any, qu: Any, qn: Any, ku: Any, kn: Any, z: Any) -> Any:
    """``qu', qn', kappa_u', kappa_n'`` at the near end without torque; ``r = 1/D``, ``Er = E/D``, ``mG = m(l-H)``."""
    ll = l * l
    lz = l * z
    return ((I * qu + ll * ku) * r - z * (mH + l * Er),
            J * (qn - lz * Pun) * r,
            (m * Ic * (qu - z * (mH + l * Puu)) + It * (ku - z * (mH * Pnn + l * Delta))) * r,
            J * (m * qn + kn - z * mG * Pun) * r)


@inlined
def torque(m: Any, l: Any, mH: Any, mG: Any, Puu: Any, Pun: Any, Pnn: Any, Delta: Any, r: Any) -> Any:
    """What a torque of 1 adds to ``qu', qn', kappa_u', kappa_n'``."""
    return l * Pun * r, (mH + l * Pnn) * r, mG * Pun * r, (mH * (m + Puu) + l * (m * Pnn + Delta)) * r


@inlined
def turned_force(s: Any, c: Any, qu: Any, qn: Any, ku: Any, kn: Any) -> Any:
    """The two vectors in axes turned back by delta."""
    return qu * c - qn * s, qu * s + qn * c, ku * c - kn * s, ku * s + kn * c


@inlined
def spread_within(s: Any, c: Any, a: Any, x: Any, y: Any, f0: Any, b: Any) -> Any:
    """The variances of ``Pun`` and, beside its own size, of ``qn``, after the turn; ``f0 = qu' = A - b``."""
    u, v, w = a * (c - x * s) * (s + x * c), y * s * c, s * s
    return u * u + v * v, (f0 * f0 + b * b) * w


@inlined
def spread(s: Any, c: Any, tu: Any, tn: Any, ahead: Any, lz: Any, w0: Any, w1: Any, v1: Any, v2: Any, uu: Any, un: Any,
           nn: Any) -> Any:
    """The covariance ``uu, un, nn`` of ``(tu, tn)`` taken over a rod, and the variance of its ``l theta''``.

    ``tu, tn`` are before, ``ahead`` is tu after the rod; ``v1, v2`` are the variances of ``w1, w2``.
    """
    uu, nn = uu + tu * tu, nn + tn * tn
    x, y = uu * c + un * s, un * c + nn * s
    duu, dun = x * c + y * s, y * c - x * s
    dnn = (nn * c - un * s) * c - (un * c - uu * s) * s  # not the trace less duu, where little acts across
    duu = duu + lz * lz
    un, g = w0 * dun - w1 * duu, w0 * dnn - w1 * dun
    nn = (w0 * g - w1 * un) + (v1 * (ahead * ahead) + v2)
    return duu, un, nn, (nn - g) + (dnn - g)


def accelerate_rods(rods: Any, z: Any, tau: Any, s: Any, c: Any, ax: Any, ay: Any, work: Any, doubt: Any,
                    out: Any) -> None:
    """Write ``theta''`` of physical rods to ``out``.

    Shapes: rods (n, 8), rows ``m, l, I, Ic, J, It, m H, m (l - H)``; z, s, c, out (n,); work (n, 4); tau (n,) or
    None, the torque on each rod; ``(ax, ay)`` the acceleration of the support, with g added to ay; doubt (3, n) or
    None, in its row 0 the variance of each ``theta''``, written.
    """
    n = rods.shape[0]
    Vp = Vq = Vu = 0 * z[n - 1]
    Puu = Pun = Pnn = Delta = qu = qn = ku = kn = 0 * z[n - 1]
    for i in range(n):
        k = n - 1 - i
        m, l, I, Ic = rods[k, 0], rods[k, 1], rods[k, 2], rods[k, 3]
        J, It, mH, mG = rods[k, 4], rods[k, 5], rods[k, 6], rods[k, 7]
        r, Er, a, x, y, det = inertia(m, l, I, Ic, J, It, Puu, Pun, Pnn, Delta)
        work[k, 0] = J * r
        work[k, 1] = l * l * Pun * r
        work[k, 3] = (mH + l * Pnn) * r
        f0, f1, f2, f3 = force(m, l, I, Ic, J, It, mH, mG, Puu, Pun, Pnn, Delta, r, Er, qu, qn, ku, kn, z[k])
        if tau is None:
            work[k, 2] = l * l * qn * r
        else:
            t = tau[k]
            work[k, 2] = (l * qn - t) * l * r
            g0, g1, g2, g3 = torque(m, l, mH, mG, Puu, Pun, Pnn, Delta, r)
            f0, f1, f2, f3 = f0 + t * g0, f1 + t * g1, f2 + t * g2, f3 + t * g3
        if doubt is not None:
            ll = l * l * r
            size = abs(mH)
            doubt[0, k], doubt[1, k] = ll * ll * Vq + work[k, 2] * work[k, 2], ll * ll * Vp
            doubt[2, k] = (size - mH) * r
            b, before = z[k] * (size + l * Er), I * I * (r * r) * Vu
            Vp, Vq = spread_within(s[k], c[k], a, x, y, f0, b)
            Vq, Vu = Vq + before * (s[k] * s[k]), (f0 * f0 + b * b + before) * (c[k] * c[k])
            if tau is not None:
                w, g, h = t * l * r, t * g0, t * (g1 + doubt[2, k])
                doubt[0, k] += w * w
                Vq = Vq + (g * g * s[k] * s[k] + h * h * c[k] * c[k])
        Puu, Pun, Pnn = turned_inertia(s[k], c[k], a, x, y)
        Delta = det
        qu, qn, ku, kn = turned_force(s[k], c[k], f0, f1, f2, f3)
    tu, tn = ay, ax
    uu = un = nn = 0 * z[0]
    for k in range(n):
        l = rods[k, 1]
        per = 1 / l
        au, an = tu * c[k] + tn * s[k], tn * c[k] - tu * s[k]
        lz = l * z[k]
        if doubt is not None:
            uu, un, nn, v = spread(s[k], c[k], tu, tn, au - lz, lz, work[k, 0], work[k, 1], doubt[1, k], doubt[0, k],
                                   uu, un, nn)
            lost = an * doubt[2, k]
            doubt[0, k] = v * (per * per) + lost * lost
        tu = au - lz
        tn = work[k, 0] * an - work[k, 2] - work[k, 1] * tu
        out[k] = -(work[k, 3] * an + (work[k, 2] + work[k, 1] * tu) * per)


def accelerate_bobs(bobs: Any, z: Any, s: Any, c: Any, ax: Any, ay: Any, work: Any, doubt: Any, out: Any) -> None:
    """Write ``theta''`` of point masses on massless rods to ``out``; no torques.

    Shapes: bobs (n, 4), rows ``m, l, m_k/m_(k-1) (0 for k = 1), 1/m``; z, s, c, out (n,); work (n, 2); doubt
    (n,) or None; the rest as for :func:`accelerate_rods`.
    """
    n = bobs.shape[0]
    a, b, d = bobs[0, 1] * z[0], ax * s[0], ay * c[0]
    y = a - (b + d)
    loose = a * a + b * b + d * d
    rho = 0 * z[0]
    work[0, 0], work[0, 1] = y, 1 / (1 + rho)
    if doubt is not None:
        doubt[0] = loose
    for k in range(1, n):
        h = work[k - 1, 1]
        a, d = bobs[k, 1] * z[k], c[k] * h
        b = d * y
        y = a + b
        rho = bobs[k, 2] * (s[k] * s[k] + rho) * h
        work[k, 0], work[k, 1] = y, 1 / (1 + rho)
        if doubt is not None:
            loose = d * d * loose + (a * a + b * b)
            doubt[k] = loose
    T = cT = beyond = loose_c = loose_s = 0 * z[0]
    for i in range(n):
        k = n - 1 - i
        a, h, per = bobs[k, 0] * work[k, 0], work[k, 1], bobs[k, 3]
        T = (a + cT) * h
        if doubt is not None:
            loose = (bobs[k, 0] * bobs[k, 0] * doubt[k] + loose_c + (a * a + cT * cT)) * (h * h)
            doubt[k] = per * per * (loose_s + beyond * beyond)
            loose_c, loose_s = c[k] * c[k] * loose, s[k] * s[k] * loose
        if k + 1 < n:
            # theta'' of the rod beyond needs the tension on this side of it
            d = T * s[k + 1] * per
            out[k + 1] = (out[k + 1] - d) / bobs[k + 1, 1]
            if doubt is not None:
                a = s[k + 1] * per
                doubt[k + 1] = (doubt[k + 1] + d * d + a * a * loose) / (bobs[k + 1, 1] * bobs[k + 1, 1])
        out[k] = beyond * per
        cT = c[k] * T
        beyond = T * s[k]
    a, b = ax * c[0], ay * s[0]
    out[0] = (out[0] - (a - b)) / bobs[0, 1]
    if doubt is not None:
        doubt[0] = (doubt[0] + (a * a + b * b)) / (bobs[0, 1] * bobs[0, 1])
