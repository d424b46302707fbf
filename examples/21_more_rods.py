"""Three and five rods upright, proved, with Acheson's bounds for comparison.

Acheson (1993): N rods are stable if ``h < 0.450/mu_max`` and ``h v > sqrt(2/mu_min)``, approximately.  The chart
says where they truly are.  Writes ``docs/images/more_rods.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from sympy import Matrix, cos, symbols

from fastpicard import FloquetMatrix, certify
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "more_rods.png"
a, b, h, v, t, m, l, epsilon, omega0 = symbols("a b h v t m l epsilon omega0")
MATHIEU = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 0)


def main() -> None:
    figure, axes = plt.subplots(1, 2, figsize=(13, 5.5), constrained_layout=True)
    for ax, rods, widest, fastest in zip(axes, (3, 5), (0.05, 0.02), (300, 1000), strict=True):
        scene = Scene([Rod.uniform(m, l)] * rods, Support(eta=epsilon * cos(omega0 * t)))
        found = normal_modes(linearize(euler_lagrange(scene)))
        chart = certify(MATHIEU, (h, 0, widest), (v, 0.1, fastest),
                        modes=[{a: one, b: other} for one, other in found.mathieu(omega0)])
        print(f"{rods} rods: {chart}")
        chart.plot(ax, xlabel=r"$h = \epsilon/l$ (amplitude over length)",
                   ylabel=r"$v = \omega_0\sqrt{l/g}$ (dimensionless frequency)", title=f"{rods} upright rods")
        low, high = float(found.mu[0]), float(found.mu[-1])
        line = np.linspace(np.sqrt(2 / low) / fastest, 0.45 / high, 200)
        ax.plot(line, np.sqrt(2 / low) / line, "--", color="tab:red", linewidth=1)
        ax.plot([0.45 / high] * 2, [np.sqrt(2 / low) * high / 0.45, fastest], "--", color="tab:red", linewidth=1)
        ax.text(0.03, 0.03, "dashed: Acheson's bounds", color="tab:red", transform=ax.transAxes, fontsize=9)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


if __name__ == "__main__":
    main()
