"""Points per second of values within 10 ulp, against SymPy's lambdify, NumPy's Horner and mpmath in the same run.

    python benchmarks/evaluation.py

For Mathieu's trace over one period, on the article's chart |a| <= 2.5, |b| <= 1.5:

lambdify_trace     ours: every value proved to 10 ulp of itself
sympy.lambdify     the expanded polynomial with float64 coefficients, powers by NumPy: no bound
float64 Horner     the least anyone can do: coefficients collapsed exactly, the same Horner's rule, no bound
mpmath             the same polynomial with as many digits as give 10 ulp: the other way to get them

Least processor time of several repeats, in one thread.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import sympy
from sympy import Matrix, cos, symbols
from timing import least

from fastpicard import FloquetMatrix
from fastpicard.collapsed import Collapsed
from fastpicard.horner import run
from fastpicard.vectorise import Evaluator

a, b, t = symbols("a b t")
MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
NAMES = ("float64", "pairs", "balls")


def plain_horner(collapsed: Collapsed) -> Callable[..., Any]:
    """The same steps on whole blocks in float64 alone."""
    evaluator = Evaluator(collapsed, (a, b))
    (p,) = evaluator.polynomials
    rounded = [r for r, _ in p.coefficients]
    powers = [v.parameter for v in collapsed.variables]

    def function(x: Any, y: Any) -> Any:
        given = {a: x, b: y}
        variables = [np.ldexp(given[s] ** k, e) for (s, k), e in zip(powers, evaluator.scales, strict=True)]
        return run(p.steps, rounded, variables)

    def blocks(x: Any, y: Any) -> Any:
        return np.concatenate([function(x[i:i + 8192], y[i:i + 8192]) for i in range(0, len(x), 8192)])

    return blocks


def in_mpmath(F: FloquetMatrix, digits: int) -> Callable[..., Any]:
    """The expanded polynomial in mpmath, one point at a time."""
    context = mpmath.mp.clone()
    context.dps = digits
    function = sympy.lambdify([a, b], sympy.N(F.trace(), digits), "mpmath")

    def at(x: Any, y: Any) -> Any:
        with mpmath.workdps(digits):
            return [function(mpmath.mpf(float(u)), mpmath.mpf(float(v))) for u, v in zip(x, y, strict=True)]

    return at


def row(name: str, count: int, seconds: float, ours: float) -> None:
    print(f"  {name:16}{count / seconds:12.3g} points/s   {ours * count / seconds:10.3g} times ours")


def measure(n: int, points: int, repeats: int) -> None:
    """One order."""
    F = FloquetMatrix(MATHIEU, t, n)
    rng = np.random.default_rng(n)
    x, y = rng.uniform(-2.5, 2.5, points), rng.uniform(-1.5, 1.5, points)
    start = time.process_time()
    f = F.lambdify_trace([a, b], bound=True)
    build = time.process_time() - start
    collapsed = F.collapsed_trace
    values, bounds = f(x, y)
    route = Evaluator(collapsed, (a, b))([x, y])[2]
    share = ", ".join(f"{100 * np.mean(route == k):.2g}% {name}" for k, name in enumerate(NAMES))
    print(f"n = {n}: {len(collapsed.exponents[0])} monomials, built in {build:.2g} s; {share}; "
          f"largest bound {np.max(bounds / np.spacing(np.abs(values))):.2g} ulp")
    least_ours = least(lambda: f(x, y), repeats)
    row("lambdify_trace", points, least_ours, least_ours / points)
    plain = plain_horner(collapsed)
    row("float64 Horner", points, least(lambda: plain(x, y), repeats), least_ours / points)
    few = min(points, 20000)
    naive = sympy.lambdify([a, b], sympy.N(F.trace(), 17), "numpy")
    row("sympy.lambdify", few, least(lambda: naive(x[:few], y[:few]), repeats), least_ours / points)
    high = in_mpmath(F, 30)
    row("mpmath", 100, least(lambda: high(x[:100], y[:100]), repeats), least_ours / points)
    for name, found in (("float64 Horner", plain(x, y)), ("sympy.lambdify", naive(x, y))):
        print(f"  {name} is wrong by up to {np.max(np.abs(found - values) / np.spacing(np.abs(values))):.2g} ulp")
    at = {a: 0.75, b: 0.5}
    for digits in (None, 50, 1000, 10000):
        F.trace_at(at, digits)
        print(f"  trace_at, {digits or 'float64'} digits: {1e3 * least(lambda d=digits: F.trace_at(at, d), 3):.3g} ms")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--orders", type=int, nargs="*", default=[20, 50])
    options = parser.parse_args()
    for n in options.orders:
        measure(n, options.points, options.repeats)


if __name__ == "__main__":
    main()
