r"""Accelerations of a chain in one pass from tip to base and one back: O(n), and no subtraction of like numbers.

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

The functions are plain Python.  What is passed decides the arithmetic: float64 after translation
(:mod:`lagrangian.machine`), NumPy rows (one entry a chain), mpmath numbers, python-flint balls.
Both forms were checked against the dense equations at 50 digits.
"""

from __future__ import annotations

from typing import Any

from .machine import inlined

__all__ = ["accelerate_bobs", "accelerate_rods", "force", "inertia", "turned_force", "turned_inertia"]


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


def accelerate_rods(rods: Any, z: Any, tau: Any, s: Any, c: Any, ax: Any, ay: Any, work: Any, out: Any) -> None:
    """Write ``theta''`` of physical rods to ``out``.

    Shapes: rods (n, 8), rows ``m, l, I, Ic, J, It, m H, m (l - H)``; z, s, c, out (n,); work (n, 4); tau (n,) or
    None, the torque on each rod; ``(ax, ay)`` the acceleration of the support, with g added to ay.
    """
    n = rods.shape[0]
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
        Puu, Pun, Pnn = turned_inertia(s[k], c[k], a, x, y)
        Delta = det
        qu, qn, ku, kn = turned_force(s[k], c[k], f0, f1, f2, f3)
    tu, tn = ay, ax
    for k in range(n):
        l = rods[k, 1]
        au, an = tu * c[k] + tn * s[k], tn * c[k] - tu * s[k]
        tu = au - l * z[k]
        tn = work[k, 0] * an - work[k, 2] - work[k, 1] * tu
        out[k] = -(work[k, 3] * an + (work[k, 2] + work[k, 1] * tu) / l)


def accelerate_bobs(bobs: Any, z: Any, s: Any, c: Any, ax: Any, ay: Any, work: Any, out: Any) -> None:
    """Write ``theta''`` of point masses on massless rods to ``out``; no torques.

    Shapes: bobs (n, 4), rows ``m, l, m_k/m_(k-1) (0 for k = 1), 1/m``; z, s, c, out (n,); work (n, 2); the rest
    as for :func:`accelerate_rods`.
    """
    n = bobs.shape[0]
    y = bobs[0, 1] * z[0] - (ax * s[0] + ay * c[0])
    rho = 0 * z[0]
    work[0, 0], work[0, 1] = y, 1 / (1 + rho)
    for k in range(1, n):
        h = work[k - 1, 1]
        y = bobs[k, 1] * z[k] + c[k] * y * h
        rho = bobs[k, 2] * (s[k] * s[k] + rho) * h
        work[k, 0], work[k, 1] = y, 1 / (1 + rho)
    T = cT = 0 * z[0]
    beyond = T
    for i in range(n):
        k = n - 1 - i
        T = (bobs[k, 0] * work[k, 0] + cT) * work[k, 1]
        if k + 1 < n:
            # theta'' of the rod beyond needs the tension on this side of it
            out[k + 1] = (out[k + 1] - T * s[k + 1] * bobs[k, 3]) / bobs[k + 1, 1]
        out[k] = beyond * bobs[k, 3]
        cT = c[k] * T
        beyond = T * s[k]
    out[0] = (out[0] - (ax * c[0] - ay * s[0])) / bobs[0, 1]
