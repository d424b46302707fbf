"""Stability boundaries of Mathieu's equation: the iterate's, the article's and the true ones (Out[26] to Out[29]).

The boundaries of ``y'' + (a + b cos t) y = 0`` at a given ``b`` are the real ``a``
where the trace of the Floquet matrix is +-2.  Twenty iterates cannot see the
seventh below ``a = 2.5``, which the article's list leaves out; forty can.
The picture ``docs/images/mathieu_boundaries.png`` shows twenty beside the true curves.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import mpmath
import numpy as np
from sympy import Matrix, Poly, Rational, cos, pi, symbols

from fastpicard import FloquetMatrix, mathieu_a, mathieu_b

ARTICLE = {Rational(1, 10): (-0.00497832, 0.198781, 0.298719, 0.993783, 1.01023, 2.2429),
           Rational(3, 2): (-0.708598, -0.696345, 0.62976, 0.81923, 1.51241, 2.3711)}
PICTURE = Path(__file__).parent.parent / "docs" / "images" / "mathieu_boundaries.png"
a, b, t = symbols("a b t")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])


def main() -> None:
    for value, printed in ARTICLE.items():
        columns = {f"n = {n}": roots(FloquetMatrix(P, t, n), value) for n in (20, 40)}
        columns["article"] = [f"{x:.8g}" for x in printed]
        columns["true"] = true_boundaries(value)
        print(f"\nb = {value}")
        print("  ".join(f"{name:>14}" for name in columns))
        for row in range(max(map(len, columns.values()))):
            print("  ".join(f"{column[row] if row < len(column) else '-':>14}" for column in columns.values()))
    draw()


def roots(F: FloquetMatrix, value: Rational) -> list[str]:
    """The real roots of trace = +-2 up to a = 2.6, from the exact polynomial."""
    found = []
    with mpmath.workdps(60):
        for level in (2, -2):
            coefficients = Poly(F.trace().subs(b, value) - level, a).all_coeffs()
            numbers = [mpmath.mpf(c.subs(pi, pi.evalf(60))) for c in coefficients]
            found += [x.real for x in mpmath.polyroots(numbers, maxsteps=500, extraprec=400)
                      if abs(mpmath.im(x)) < 1e-25 and mpmath.re(x) < 2.6]
    return [mpmath.nstr(x, 10) for x in sorted(found)]


def true_boundaries(value: Rational) -> list[str]:
    """``a_r(-2b)/4`` and ``b_r(-2b)/4``, proved digits."""
    return [mpmath.nstr(x, 10) for x in sorted(boundaries(value, 20))]


def boundaries(value: Rational, digits: int) -> list[mpmath.mpf]:
    """The seven below ``a = 2.6``."""
    q = -2 * value
    return [mathieu_a(r, q, digits) / 4 for r in range(4)] + [mathieu_b(r, q, digits) / 4 for r in range(1, 4)]


def draw() -> None:
    """The curves trace = +-2 of twenty iterates over the true boundaries, up to b = 1.5."""
    x, y = np.meshgrid(np.linspace(0, 1.5, 301), np.linspace(-0.8, 2.6, 681))
    figure, axes = plt.subplots(figsize=(8, 5.5), constrained_layout=True)
    grid = [Rational(k, 20) for k in range(31)]
    axes.plot([float(value) for value in grid], [[float(number) for number in boundaries(value, 15)] for value in grid],
              color="k", linewidth=1)
    axes.plot([], [], color="k", linewidth=1, label="true boundaries")
    axes.contour(x, y, FloquetMatrix(P, t, 20).lambdify_trace([a, b])(y, x), levels=[-2, 2], colors="tab:red",
                 linestyles="dashed")
    axes.plot([], [], color="tab:red", linestyle="dashed", label="trace = +-2, 20 iterates")
    for value, printed in ARTICLE.items():
        axes.plot([float(value)] * len(printed), printed, "o", color="tab:blue", markersize=4,
                  label="Out[26] to Out[29]" if value == min(ARTICLE) else None)
    axes.set(xlabel="b", ylabel="a", title="y'' + (a + b cos t) y = 0: where the trace is +-2")
    axes.legend(loc="lower left", fontsize=9)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"\npicture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


if __name__ == "__main__":
    main()
