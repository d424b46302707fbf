"""What a number from an exact iterate is worth: term by term, collapsed, and with digits asked for.

At (a, b) = (2.5, 1.5), t = 1/2 and n = 40 the terms of Mathieu's iterate exceed
their sum by 1e20, so evaluating them one by one in float64 leaves nothing.  The
same iterate is right to the last digit when asked for its value.
"""

import mpmath
import numpy as np
from sympy import Matrix, Rational, cos, lambdify, symbols

from fastpicard import FloquetMatrix, FundamentalMatrix

a, b, t = symbols("a b t")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])
POINT = {a: Rational(5, 2), b: Rational(3, 2)}


def main() -> None:
    print("Phi_n[0, 0] at t = 1/2, (a, b) = (2.5, 1.5)")
    print(f"{'n':>4} {'term by term, float64':>24} {'evaluate()':>22} {'evaluate(digits=30)':>36}")
    for n in (10, 20, 30):
        X = FundamentalMatrix(P, t, n)
        naive = sum(lambdify([t, a, b], list(X[0, 0].as_expr().args))(0.5, 2.5, 1.5))
        exact = X[0, 0].evaluate(Rational(1, 2), POINT, 30)
        print(f"{n:4} {naive:24.15g} {X[0, 0].evaluate(0.5, POINT):22.15g} {mpmath.nstr(exact, 30):>36}")
    collapsed()


def collapsed() -> None:
    """The period is different: exact cancellation first leaves a harmless polynomial."""
    print("\ntrace of Phi_n(2 pi) at (2.5, 1.5): the vectorised function against thirty digits")
    for n in (20, 40, 60):
        F = FloquetMatrix(P, t, n)
        fast, exact = F.lambdify_trace([a, b])(2.5, 1.5), F.trace_at(POINT, 30)
        error = float(abs(fast / exact - 1))
        print(f"n = {n}: {float(fast):.15f}  {mpmath.nstr(exact, 30)}  relative error {error:.0e}")
    points = np.random.default_rng(1).uniform(-1, 1, (2, 1000))
    values = F.lambdify_trace([a, b])(*points)
    print(f"a thousand points at once: shape {values.shape}, {np.count_nonzero(np.abs(values) < 2)} of them stable")


if __name__ == "__main__":
    main()
