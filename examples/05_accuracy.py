"""What a number from an exact iterate is worth: term by term, collapsed, and with digits asked for.

At (a, b) = (2.5, 1.5), t = 1/2 and n = 40 the terms of Mathieu's iterate exceed
their sum by 1e20, so evaluating them one by one in float64 leaves nothing.  The
same iterate is right to the last digit when asked for its value.  The picture is
``docs/images/accuracy.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import mpmath
import numpy as np
from sympy import Matrix, Rational, cos, lambdify, symbols

from fastpicard import FloquetMatrix, FundamentalMatrix

a, b, t = symbols("a b t")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])
POINT = {a: Rational(5, 2), b: Rational(3, 2)}
PICTURE = Path(__file__).parent.parent / "docs" / "images" / "accuracy.png"


def main() -> None:
    print("Phi_n[0, 0] at t = 1/2, (a, b) = (2.5, 1.5)")
    print(f"{'n':>4} {'term by term, float64':>24} {'evaluate()':>22} {'evaluate(digits=30)':>36}")
    errors = [row(n) for n in range(5, 31, 5)]
    collapsed()
    draw(*zip(*errors, strict=True))


def row(n: int) -> tuple[int, float, float]:
    """The order, and the relative errors of both floats."""
    X = FundamentalMatrix(P, t, n)
    naive = sum(lambdify([t, a, b], list(X[0, 0].as_expr().args))(0.5, 2.5, 1.5))
    value, exact = X[0, 0].evaluate(0.5, POINT), X[0, 0].evaluate(Rational(1, 2), POINT, 30)
    print(f"{n:4} {naive:24.15g} {value:22.15g} {mpmath.nstr(exact, 30):>36}")
    with mpmath.workdps(30):
        return n, float(abs(naive / exact - 1)), float(abs(value / exact - 1))


def draw(orders: tuple[int, ...], naive: tuple[float, ...], exact: tuple[float, ...]) -> None:
    """Errors of both against the order."""
    figure, axes = plt.subplots(figsize=(8, 4.5), constrained_layout=True)
    axes.semilogy(orders, naive, "o-", color="tab:red", label="the terms one by one in float64")
    axes.semilogy(orders, exact, "o-", color="k", label="evaluate()")
    axes.axhline(2.0**-53, color="0.7", label="half a unit of the last place")
    axes.set(xlabel="order n of the iterate", ylabel="relative error of its value",
             title="The same exact iterate in numbers: Phi_n[0, 0] at t = 1/2, (a, b) = (2.5, 1.5)")
    axes.legend(loc="upper left", fontsize=9)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


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
