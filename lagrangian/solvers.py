"""Other people's integrators on the same right-hand side: SciPy's ``solve_ivp``, and heyoka's Taylor method."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .chain import CompiledChain
from .errors import QuantityError, SceneError
from .optional import optional
from .recursion import accelerate_rods

__all__ = ["FINEST", "SCIPY_METHODS", "integrate_heyoka", "integrate_scipy"]

SCIPY_METHODS = ("RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA")
FINEST = 3e-14  # below it SciPy warns that nothing is gained


def integrate_scipy(system: Any, theta: Any, omega: Any, times: Any, method: str, tolerance: float,
                    progress: Callable[[float], None] | None = None) -> tuple[Any, Any, int]:
    """Angles and rates, shape (times, n) each, and the number of evaluations, by ``scipy.integrate.solve_ivp``.

    ``system`` is anything with ``acceleration(t, theta, omega)``; ``progress`` is told how far evaluations have come.
    Raises QuantityError where the solver gives up, NotInstalledError without SciPy.
    """
    solve = optional("scipy.integrate", f"method={method!r}", "method='taylor'").solve_ivp
    n, reached = len(theta), times[0]

    def rate(t: float, y: Any) -> Any:
        nonlocal reached
        if progress is not None and abs(t - times[0]) > abs(reached - times[0]):
            reached = t
            progress(float(t))
        return np.concatenate([y[n:], system.acceleration(t, y[:n], y[n:])])

    start = np.concatenate([theta, omega])
    asked, where = _distinct(times)
    if len(asked) == 1:
        return np.tile(theta, (len(times), 1)), np.tile(omega, (len(times), 1)), 0
    tolerance = max(FINEST, tolerance)
    result = solve(rate, (asked[0], asked[-1]), start, method, asked, rtol=tolerance, atol=tolerance)
    if not result.success:
        raise QuantityError(f"{method} stopped: {result.message}  Ask for less accuracy, or method='taylor'.")
    if progress is not None and reached != asked[-1]:
        progress(float(asked[-1]))
    return result.y[:n, where].T, result.y[n:, where].T, int(result.nfev)


def _distinct(times: Any) -> tuple[Any, Any]:
    """Monotone times, each once, and where each of those given is among them; shapes (k,), (m,)."""
    new = np.append(True, np.diff(times) != 0)
    return np.asarray(times)[new], np.cumsum(new) - 1


def heyoka_system(chain: CompiledChain, heyoka: Any) -> Any:
    """The equations as heyoka expressions: the recursion of this package, run on expressions instead of numbers."""
    n = len(chain)
    names = heyoka.make_vars(*(f"theta{k}" for k in range(n)), *(f"omega{k}" for k in range(n)))
    theta, omega = (np.array(part, dtype=object) for part in (names[:n], names[n:]))
    joints = [theta[0], *(theta[k] - theta[k - 1] for k in range(1, n))]
    s, c = (np.array([f(x) for x in joints], dtype=object) for f in (heyoka.sin, heyoka.cos))
    if chain.support.function is not None:
        raise SceneError("heyoka gets the support's motion as waves c cos(qt) + s sin(qt): choose method='taylor'.")
    constant, waves = chain.weighted.floats
    ax, ay = (heyoka.expression(part) for part in constant)
    for q, _, _, cx, sx, cy, sy in waves:
        cosine, sine = heyoka.cos(q * heyoka.time), heyoka.sin(q * heyoka.time)
        ax, ay = ax + cx * cosine + sx * sine, ay + cy * cosine + sy * sine
    out, work = np.empty(n, dtype=object), np.empty((n, 4), dtype=object)
    accelerate_rods(chain.rods, omega * omega, chain.torques(theta, omega), s, c, ax, chain.up * ay, work, None, out)
    return [*zip(theta, omega, strict=True), *zip(omega, out, strict=True)]


def integrate_heyoka(chain: CompiledChain, theta: Any, omega: Any, times: Any,
                     tolerance: float) -> tuple[Any, Any, int]:
    """Angles and rates by heyoka, which first compiles the equations, for minutes where chains are long.

    Raises NotInstalledError without it.
    """
    heyoka = optional("heyoka", "method='heyoka'", "method='taylor'")
    n, start = len(theta), [*theta, *omega]
    system = heyoka_system(chain, heyoka)
    integrator = heyoka.taylor_adaptive(system, start, time=float(times[0]), tol=max(1e-16, tolerance))
    asked, where = _distinct(times)
    outcome = integrator.propagate_grid(np.asarray(asked, dtype=float))
    states = outcome[-1][where]
    if not np.isfinite(states).all():
        raise QuantityError(f"heyoka stopped with the outcome {outcome[0]}.")
    return states[:, :n], states[:, n:], int(outcome[3])
