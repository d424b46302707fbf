r"""Taylor series of the motion: every order by one pass of the same O(n) recursion.

In the axes that rod k has at the start of a step, ``phi = theta - theta_0`` and its rates have the series

    (j+1) S_(j+1) = sum_i C_i w_(j-i),   (j+1) C_(j+1) = -sum_i S_i w_(j-i)     S = sin phi, C = cos phi, w = theta'

and the joint at its far end accelerates by ``l (C, S)''`` against the near one.  In order j the only unknown of
that is ``alpha_j = [theta'']_j``, with coefficient 1:

    [(C, S)'']_j = (-z_j, alpha_j + e_j),   z_j = (j+1) sum S_i w_(j+1-i),   e_j = (j+1) sum_(i>0) C_i w_(j+1-i).

The moments about the near joint, ``I theta'' + n.B = tau`` with ``n = (-S, C)`` and ``B = m H a + l F`` (a the
acceleration of the near joint, F the force on the far one), become in order j

    I (alpha_j + e_j) + B_(n,j) = tau_j + I e_j - sum_(i>0) (C_i B_(n,j-i) - S_i B_(u,j-i)),

the very equations of order 0 with ``z_j``, this right-hand side as torque, and ``alpha_j + e_j`` as unknown.  So
the inertias are eliminated once a step, and each order costs one pass of forces and four convolutions:
O(n p**2) a step for p orders, in the same loops for every n; nothing is derived or compiled for a given n.

With the right-hand side ``t = t' + I e`` the unknown is ``t/D - q``, from which ``alpha = t'/D - e l**2 Pnn/D - q`` and
``B_n = t l**2 Pnn/D + I q`` are taken as written here: ``I/D - 1`` does not cancel.  For a single rod it is 0, where
``I fl(1/I) - 1`` would be a torque that goes always with the motion, or always against it.

The functions run on float64 after translation, and unchanged on mpmath numbers and balls.
"""

from __future__ import annotations

from typing import Any

from .machine import reordered
from .recursion import inertia, torque, turned_force, turned_inertia

__all__ = ["expand", "factor", "series_shape"]

FACTORS = 24


def series_shape(n: int, order: int) -> tuple[int, int, int]:
    """The shape of the array of series: C, S, w, B_u, B_n of every rod, padded by zeros."""
    return n, 5, order + 12 - order % 4


def factor(rods: Any, s: Any, c: Any, one: Any, factors: Any) -> None:
    """Eliminate the inertias from tip to base.

    Shapes: rods (n, 8); s, c (n,), sine and cosine of the joints; factors (n, FACTORS), written.  ``one`` is 1 in the
    arithmetic of the rest.
    """
    n = rods.shape[0]
    none = one - one
    Puu = Pun = Pnn = Delta = none
    for i in range(n):
        k = n - 1 - i
        m, l, I, Ic = rods[k, 0], rods[k, 1], rods[k, 2], rods[k, 3]
        J, It, mH, mG = rods[k, 4], rods[k, 5], rods[k, 6], rods[k, 7]
        f = factors[k]
        r, Er, a, x, y, det = inertia(m, l, I, Ic, J, It, Puu, Pun, Pnn, Delta)
        ll = l * l
        f[0], f[1], f[2] = I * r, m * Ic * r, ll * r  # of qu in qu', kappa_u'; of kappa_u in qu'
        f[3], f[4], f[5] = It * r, J * r, m * J * r  # of kappa_u in kappa_u'; of qn in qn', kappa_n'
        f[6], f[7] = -(mH + l * Er), -(J * l * Pun * r)  # of z
        f[8], f[9] = -(m * Ic * (mH + l * Puu) + It * (mH * Pnn + l * Delta)) * r, -(J * mG * Pun * r)
        f[10], f[11], f[12], f[13] = torque(m, l, mH, mG, Puu, Pun, Pnn, Delta, r)
        f[14], f[15], f[16], f[17] = l * r, Puu, Pun, r
        f[18], f[19], f[20], f[21], f[22], f[23] = s[k], c[k], l, I, mH, ll * Pnn * r
        Puu, Pun, Pnn = turned_inertia(s[k], c[k], a, x, y)
        Delta = det


@reordered
def convolved(C: Any, S: Any, w: Any, Bu: Any, Bn: Any, count: Any, none: Any) -> Any:
    """``sum C_i w_i, sum S_i w_i, sum C_i B_(n,i) - S_i B_(u,i)``; beyond the orders known the arrays hold zeros."""
    X = Y = Z = none
    for i in range(count):
        X += C[i] * w[i]
        Y += S[i] * w[i]
        Z += C[i] * Bn[i] - S[i] * Bu[i]
    return X, Y, Z


def expand(factors: Any, damping: Any, springs: Any, delta: Any, omega: Any, ax: Any, ay: Any, order: int, one: Any,
           held: Any, series: Any) -> None:
    """Write the Taylor coefficients 0, ..., order of every rate: ``series[k, 2, order - j]`` is ``[theta_k']_j``.

    Shapes: damping, springs (n,) or None; delta (n,), the joint angles, which only springs see; omega (n,);
    ax, ay (order,), the series of the acceleration of the first joint, gravity included; held (n, 6), for
    intermediate values; series as :func:`series_shape` says, all zero.
    """
    n = factors.shape[0]
    none = one - one
    for k in range(n):
        series[k, 0, 0], series[k, 1, 1], series[k, 2, order] = one, omega[k], omega[k]
    for j in range(order):
        qu = qn = ku = kn = beyond = none
        first, count = order - 1 - j, (j + 5) & -4
        per, next_per = one / (j + 1), one / (j + 2)
        for i in range(n):
            k = n - 1 - i
            f, h, x = factors[k], held[k], series[k]
            X, Y, Z = convolved(x[0], x[1], x[2, first:], x[3, first:], x[4, first:], count, none)
            z, e = (j + 1) * Y, (j + 1) * X
            t = -Z
            if damping is not None or springs is not None:
                moment = none
                if damping is not None:
                    step = series[k, 2, order - j]
                    if k > 0:
                        step = step - series[k - 1, 2, order - j]
                    moment = moment + damping[k] * step
                if springs is not None:
                    if j == 0:
                        bend = delta[k]
                    else:
                        bend = series[k, 2, order - j + 1]
                        if k > 0:
                            bend = bend - series[k - 1, 2, order - j + 1]
                        bend = bend / j
                    moment = moment + springs[k] * bend
                t = t + (beyond - moment)
                beyond = moment
            h[0], h[1], h[2], h[3], h[4], h[5] = z, t, qn, qu, X, Y
            t = t + f[21] * e
            f0 = f[0] * qu + f[2] * ku + f[6] * z + f[10] * t
            f1 = f[4] * qn + f[7] * z + f[11] * t
            f2 = f[1] * qu + f[3] * ku + f[8] * z + f[12] * t
            f3 = f[5] * qn + f[4] * kn + f[9] * z + f[13] * t
            qu, qn, ku, kn = turned_force(f[18], f[19], f0, f1, f2, f3)
        tu, tn = ay[j], ax[j]
        for k in range(n):
            f, h, x = factors[k], held[k], series[k]
            z, t, X = h[0], h[1] + f[21] * ((j + 1) * h[4]), h[4]
            au, an = tu * f[19] + tn * f[18], tn * f[19] - tu * f[18]
            tu = au - f[20] * z
            tn = f[4] * an + f[14] * t - f[2] * (h[2] + f[16] * tu)
            slower = f[11] * an + f[14] * (h[2] + f[16] * tu)
            rate = (f[17] * h[1] - slower) * per - f[23] * X
            x[2, order - 1 - j] = rate
            x[0, j + 2], x[1, j + 2] = -h[5] * next_per, (X + rate) * next_per
            x[4, order - 1 - j] = f[23] * t + f[21] * slower
            x[3, order - 1 - j] = f[22] * au + f[20] * (f[15] * tu + f[16] * tn + h[3])
