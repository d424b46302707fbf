"""How far an iterate is from the truth, and what is proved whatever the order.

For Mathieu's equation at two points: the true error of the iterates of order 1 to 80, the a-posteriori bound, which
is the same to a few percent, and the a-priori bound, which is not.  Then an enclosure of the true Floquet matrix,
multipliers, and verdicts with their reasons.  Writes ``docs/images/remainder.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import mpmath
import numpy as np
from sympy import Matrix, Rational, cos, symbols

from fastpicard import FloquetMatrix

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "remainder.png"
a, b, c, t = symbols("a b c t")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])
POINTS = {"(-0.1, 0.55)": {a: Rational(-1, 10), b: Rational(11, 20)},
          "(2.5, 1.5)": {a: Rational(5, 2), b: Rational(3, 2)}}


def main() -> None:
    figure, axes = plt.subplots(figsize=(8, 5.5), constrained_layout=True)
    for (name, values), colour in zip(POINTS.items(), ("tab:blue", "tab:red"), strict=True):
        orders = np.arange(4, 81, 4)
        truth = FloquetMatrix(P, t, 0).enclosure(values, 110)
        errors, proved = [], []
        for n in orders:
            F = FloquetMatrix(P.subs(values), t, int(n))
            errors.append(distance(F, truth))
            proved.append(F.remainder())
        excess = max(x / y for x, y in zip(proved, errors, strict=True))
        print(f"(a, b) = {name}: the bound is at most {excess:.3f} times the error; 30 digits need "
              f"n = {FloquetMatrix.for_accuracy(P, t, values, Rational(1, 10**30)).n}")
        axes.semilogy(orders, errors, "o", color=colour, label=f"true error at (a, b) = {name}")
        axes.semilogy(orders, proved, "-", color=colour, label="proved, a posteriori")
        axes.semilogy(orders, [a_priori(values, int(n)) for n in orders], ":", color=colour, label="proved, a priori")
    axes.set(xlabel="order n of the iterate", ylabel=r"largest row sum of $|\Phi - \Phi_n|$",
             title="Mathieu's equation over one period: error of the n-th Picard iterate, and its bounds")
    axes.legend()
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")

    F = FloquetMatrix(P, t, 0)
    print("\nthe true matrix at (2.5, 1.5):", F.enclosure(POINTS["(2.5, 1.5)"], 30)[0, 0].str(30), "...")
    print("multipliers there:", F.multipliers(POINTS["(2.5, 1.5)"]))
    for values in (*POINTS.values(), {a: Rational(1, 4), b: Rational(1, 5)}, {a: 0, b: 0}):
        print(f"(a, b) = ({values[a]}, {values[b]})  {F.verdict(values)}")
    damped = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), -c]]), t, 0)
    for friction in (Rational(1, 50), Rational(1, 10)):
        print(f"(1/4, 1/5), damping {friction}  {damped.verdict({a: Rational(1, 4), b: Rational(1, 5), c: friction})}")


def distance(F: FloquetMatrix, truth: object) -> float:
    """The largest row sum of the difference, from 110 digits."""
    iterate = F.evaluate(digits=110)
    return max(float(sum(abs(iterate[i, j] - mpf(truth[i, j])) for j in range(2))) for i in range(2))


def mpf(x: object) -> object:
    """The midpoint of a ball as an exact mpmath number."""
    mantissa, exponent = x.mid().man_exp()
    return mpmath.mp.make_mpf(mpmath.libmp.from_man_exp(int(mantissa), int(exponent)))


def a_priori(values: dict, n: int) -> float:
    """sum over k > n of (Pbar T)**k / k!, largest row sum."""
    bound = np.array([[0, 1], [float(abs(values[a]) + abs(values[b])), 0]]) * 2 * np.pi
    term, total = np.eye(2), np.zeros((2, 2))
    for k in range(1, n + 200):
        term = term @ bound / k
        total += term if k > n else 0
    return float(total.sum(axis=1).max())


if __name__ == "__main__":
    main()
