"""What Picard iteration is, where it fails and where it does not: the article's In[1] to In[15].

For the pendulum, ``theta'' + sin theta = 0``, the fifth iterate holds an integral
that nobody can do.  For ``x' = P(t) x`` every iterate can be written down, and the
article recommends two graphs that it does not print: the fourth iterate of the
pendulum, and the eighth of Mathieu's equation at (a, b) = (0.9, 0.6), each against
the solution.  The script prints Out[3], Out[5], Out[12] and Out[15] and writes
both graphs to ``docs/images/picard.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import mpmath
import numpy as np
from sympy import Integral, Matrix, Rational, cos, pi, sin, symbols

from fastpicard import FloquetMatrix, FundamentalMatrix, fast_picard, picard

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "picard.png"
a, b, t = symbols("a b t")
MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
MIXED = Matrix([[-1 + a * cos(t) ** 2, 1 - a * sin(t) * cos(t)], [-1 - a * sin(t) * cos(t), -1 + a * sin(t) ** 2]])


def main() -> None:
    iterates = {n: pendulum(n) for n in (2, 4, 5)}
    print(f"pendulum, iterate 4: theta = {iterates[4][0]}")
    print(f"pendulum, iterate 5: theta' holds an integral left as it is: {iterates[5][1].has(Integral)}    Out[3]\n")
    for n in (1, 2, 3):
        print(f"Mathieu, iterate {n}: y = {fast_picard(MATHIEU, t, (1, -2), n)[0, 0]}    Out[5]")
    print_matrices()
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), constrained_layout=True)
    draw_pendulum(axes[0], {n: iterates[n] for n in (2, 4)})
    draw_mathieu(axes[1])
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


def pendulum(n: int) -> Matrix:
    """The n-th iterate of ``(theta, theta')`` from (1, 0), with g = l = 1."""
    return picard(lambda time, x: [x[1], -sin(x[0])], t, [1, 0], n)


def print_matrices() -> None:
    end = FundamentalMatrix(MIXED, t, 20).evaluate(2 * pi, {a: 2}) @ (1, -2)
    exact = np.exp(2 * np.pi), -2 * np.exp(-2 * np.pi)
    floquet = FloquetMatrix(MATHIEU, t, 20).evaluate({a: Rational(-1, 10), b: Rational(55, 100)})
    print(f"\n{'':26}{'here':44}article")
    print(f"{'20 iterates at 2 pi':26}{six(end):44}Out[12]: 535.492, -0.00373489")
    print(f"{'closed form':26}{six(exact):44}Out[13]: 535.492, -0.00373489")
    print(f"{'Floquet, (-0.1, 0.55)':26}{six(floquet.ravel()):44}"
          "Out[15]: -0.0397796, 18.6577, -0.0535123, -0.0397796\n")


def six(values: object) -> str:
    """Numbers as the article prints them."""
    return ", ".join(f"{x:.6g}" for x in values)


def draw_pendulum(axes: object, iterates: dict[int, Matrix]) -> None:
    """The article's remark after Out[3]: the fourth iterate is not accurate over one period."""
    k = mpmath.sin(0.5) ** 2  # the pendulum from theta = 1: sin(theta/2) = sin(1/2) cd(t, k)
    period = float(4 * mpmath.ellipk(k))
    times = np.linspace(0, period, 161)
    true = [float(2 * mpmath.asin(mpmath.sin(0.5) * mpmath.ellipfun("cd", x, m=k))) for x in times]
    axes.plot(times, true, "k", label="solution")
    for (n, x), style in zip(iterates.items(), (":", "--"), strict=True):
        values = [float(x[0].subs(t, time).evalf()) for time in times]
        axes.plot(times, values, style, label=f"iterate {n}")
    axes.set(xlabel=r"$t$ (dimensionless, $g = l = 1$)", ylabel=r"$\theta$ (rad)", ylim=(-3, 3), xlim=(0, period),
             title="Pendulum from 1 rad, one period")
    axes.legend(loc="lower left")


def draw_mathieu(axes: object) -> None:
    """The article's remark after Out[7]: eight iterates are too few up to 2 pi, and twenty are not."""
    values = {a: Rational(9, 10), b: Rational(6, 10)}
    times = np.linspace(0, 2 * np.pi, 81)
    column = fast_picard(MATHIEU.subs(values), t, (1, -2), 40)
    for n, style, name in ((40, "k", "40 iterates: the solution"), (8, ":", "iterate 8"), (12, "-.", "iterate 12"),
                           (20, "--", "iterate 20")):
        iterate = column.to_order(n)
        axes.plot(times, [iterate.evaluate(float(time), {})[0, 0] for time in times], style, label=name)
    axes.set(xlabel=r"$t$ (dimensionless)", ylabel=r"$y$", ylim=(-4, 6), xlim=(0, 2 * np.pi),
             title="Mathieu's equation, (a, b) = (0.9, 0.6), from (1, -2)")
    axes.legend(loc="upper left")


if __name__ == "__main__":
    main()
