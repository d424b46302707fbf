r"""Small swings about hanging: the linear model, exact in time, for chains on a support at rest.

With the angles measured from hanging, ``M_ij = l_i p_j`` (i < j) and ``M_ii = I_i + l_i**2 (m_(i+1) + ... + m_n)``,

    M theta'' + K theta = 0,   K = diag(g p_i) + springs,   p_i = m_i H_i + l_i (m_(i+1) + ... + m_n),

whose solution is a sum of n modes, cosines and sines of ``sqrt(mu_i) t``; where ``mu_i < 0``, of rods that are heavier
behind the joint or of springs that push, these are hyperbolic, and where it is 0, they are 1 and t.  The terms left
out are of third order in the angles, which therefore lose ``theta**2`` of their phase: how much,
:func:`lagrangian.simulate` states by following the nonlinear motion too.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .chain import CompiledChain
from .errors import NotAnEquilibriumError, QuantityError, SceneError

__all__ = ["swing"]


def swing(chain: CompiledChain, theta: Any, omega: Any, times: Any) -> tuple[Any, Any, int]:
    """Angles and rates of the linear model at ``times``, shape (times, n) each, and the number of steps, 0.

    Raises NotAnEquilibriumError where the chain does not hang still: a support that accelerates sideways or in waves,
    no weight, springs whose rest is upright; and where dampers would make the modes decay.  Raises SceneError where
    masses are too far apart for M to be inverted, QuantityError where modes grow beyond float64.
    """
    ax, ay = chain.steady_pull
    pull = chain.up * ay
    reasons = [(not chain.support.steady or ax != 0, "the support of this one accelerates"),
               (pull <= 0, f"this one's weight is {pull:.3g} m/s**2"),
               (chain.damping is not None, "this one has dampers"),
               (chain.springs is not None and chain.upright, "the springs of this one rest upright")]
    for wrong, reason in reasons:
        if wrong:
            raise NotAnEquilibriumError(f"the linear model is that of a chain that hangs and swings, and {reason}: "
                                        f"choose "
                                        f"method='taylor'.")
    M, K = _matrices(chain, pull)
    rest = np.pi * chain.upright + (2 * np.pi * np.rint((theta - np.pi * chain.upright) / (2 * np.pi))
                                    if chain.springs is None else 0.0)
    try:
        lower = np.linalg.cholesky(M)
    except np.linalg.LinAlgError:
        raise SceneError(f"the linear model inverts M, which is singular in float64 where masses reach from "
                         f"{chain.rods[:, 0].min():.3g} to {chain.rods[:, 0].max():.3g} kg: choose "
                         f"method='taylor'.") from None
    mu, modes = np.linalg.eigh(np.linalg.solve(lower, np.linalg.solve(lower, K).T))
    shapes, root = np.linalg.solve(lower.T, modes), np.sqrt(mu + 0j)
    a, b = (modes.T @ lower.T @ part for part in (theta - rest, omega))
    t = (np.asarray(times) - times[0])[:, None]
    with np.errstate(all="ignore"):
        cosine, sine = np.cos(root * t).real, (t * np.sinc(root * t / np.pi)).real  # sine / root
        angles, rates = (a * cosine + b * sine) @ shapes.T + rest, (b * cosine - a * mu * sine) @ shapes.T
    if not (np.isfinite(angles).all() and np.isfinite(rates).all()):
        raise QuantityError(f"the linear model grows as exp({abs(root.imag).max():.3g} t), beyond float64 in "
                            f"{abs(t).max():.3g} s: choose method='taylor'.")
    return angles, rates, 0


def _matrices(chain: CompiledChain, pull: float) -> tuple[Any, Any]:
    m, l, I, _, _, _, mH, _ = chain.rods.T
    n = len(chain)
    beyond = np.append(np.cumsum(m[::-1])[::-1][1:], 0.0)
    p = mH + l * beyond
    upper = np.triu(np.outer(l, p), 1)
    M = upper + upper.T + np.diag(I + l * l * beyond)
    K = np.diag(pull * p)
    if chain.springs is not None:
        step = np.eye(n) - np.eye(n, k=-1)
        K = K + step.T @ (chain.springs[:, None] * step)
    return M, K
