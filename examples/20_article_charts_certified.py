"""The article's two charts, one rod and two, every pixel proved; and their boundaries as tubes.

One rod: h in [0, 0.5], v in [0.1, 100] (In[30], 118 s for 120 x 120 points in 2006).  Two rods: h in [0, 0.1],
both modes from one scalar matrix ([Neves] (21)).  The article: "the best we can do is locate some points".  Here
more than 99.99% of the area is proved stable or unstable for the true equations, and the boundaries are
polynomials with a radius below 1e-20.  Writes ``docs/images/article_charts.png``.
"""

import time
from pathlib import Path

import matplotlib.pyplot as plt
from sympy import Matrix, Rational, cos, symbols

from fastpicard import FloquetMatrix, boundaries, certify, tubes
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "article_charts.png"
a, b, h, v, t, m, l, epsilon, omega0 = symbols("a b h v t m l epsilon omega0")
MATHIEU = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0)


def main() -> None:
    figure, axes = plt.subplots(1, 2, figsize=(13, 5.5), constrained_layout=True)
    start = time.perf_counter()
    curves = tubes(MATHIEU, (a, -0.75, 0), (b, 0, 0.75))  # both charts where h v**2 > 1: |a| < b
    print(f"{curves} in {time.perf_counter() - start:.1f} s")
    for ax, rods, widest in zip(axes, (1, 2), (0.5, 0.1), strict=True):
        start = time.perf_counter()
        chart = certify(MATHIEU, (h, 0, widest), (v, 0.1, 100), modes=modes(rods))
        decided = 100 * (1 - chart.undecided)
        print(f"{rods} rod(s): {decided:.4f}% decided in {time.perf_counter() - start:.1f} s\n{chart}")
        chart.with_tubes(curves, modes(rods)).plot(
            ax, xlabel=r"$h = \epsilon/l$ (amplitude over length)",
            ylabel=r"$v = \omega_0\sqrt{l/g}$ (dimensionless frequency)",
            title=f"{rods} upright rod{'s' if rods > 1 else ''}: proved for the true equations")
    mark_the_articles_point(axes[1])
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


def modes(rods: int) -> list[dict[object, object]]:
    """The parameters of Mathieu's equation, mode by mode."""
    scene = Scene([Rod.uniform(m, l)] * rods, Support(eta=epsilon * cos(omega0 * t)))
    found = normal_modes(linearize(euler_lagrange(scene))).mathieu(omega0)
    return [{a: one, b: other} for one, other in found]


def mark_the_articles_point(ax: object) -> None:
    """Out[55] and Out[56]: the point at h = 0.06, from the system of four equations itself."""
    scene = Scene([Rod.uniform(m, l)] * 2, Support(eta=epsilon * cos(omega0 * t)))
    P, tau, period = linearize(euler_lagrange(scene)).first_order(omega0)
    root = boundaries(FloquetMatrix(P, tau, 30, period))[0].root(v, (20.1, 30.1), {h: Rational(6, 100)})
    print(f"h = 0.06: v = {root.value:.15g}, within {root.error:.0e}, {root.evaluations} evaluations, "
          f"dv/dh = {root.slopes[h]:.4f}    Out[56]: 27.5568")
    ax.plot(0.06, root.value, "o", color="tab:red")
    ax.annotate("Out[56]", (0.06, root.value), xytext=(6, 8), textcoords="offset points", color="tab:red")


if __name__ == "__main__":
    main()
