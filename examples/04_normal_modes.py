"""Charts for one to five rods from a single Mathieu equation: every mode is Mathieu's with its own mu.

Vertically driven chains of equal rods decouple into ``psi'' + mu_i (-1/v**2 + h cos tau) psi = 0``
(the article's equation (21), any number of rods); the upright chain is stable
where all of them are.  The largest ``|a| + |b|`` of the chart is 19.2, for which
the remainder of the trace after 80 iterates is below 1e-4.  Writes
``docs/images/normal_modes.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from sympy import Matrix, cos, symbols

from fastpicard import FloquetMatrix
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "normal_modes.png"
a, b, t, m, l, epsilon, omega0 = symbols("a b t m l epsilon omega0")


def main() -> None:
    mathieu = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 80)
    trace = mathieu.lambdify_trace([a, b])
    figure, axes = plt.subplots(figsize=(8, 5.5), constrained_layout=True)
    for rods, colour in zip(range(1, 6), plt.cm.viridis(np.linspace(0, 0.9, 5)), strict=True):
        mus = [float(mu) for mu in modes(rods)]
        print(f"N = {rods}: mu = {', '.join(f'{mu:.6f}' for mu in mus)}")
        h, v = np.meshgrid(np.geomspace(0.003, 0.5, 1000), np.geomspace(2, 1000, 400))
        margin = np.min([2 - np.abs(trace(-mu / v**2, mu * h)) for mu in mus], axis=0)
        axes.contourf(h, v, margin, levels=[0, 4], colors=[colour], alpha=0.15)
        axes.contour(h, v, margin, levels=[0], colors=[colour])
        axes.plot([], [], color=colour, label=f"N = {rods}")
    axes.set(xlabel=r"$h = \epsilon/l$ (amplitude over length)",
             ylabel=r"$v = \omega_0\sqrt{l/g}$ (dimensionless frequency)", xscale="log", yscale="log",
             title="Where upright chains of N equal rods are linearly stable")
    axes.legend(loc="lower left")
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


def modes(rods: int) -> tuple[object, ...]:
    """The mu_i of equal uniform rods."""
    scene = Scene([Rod.uniform(m, l)] * rods, Support(eta=epsilon * cos(omega0 * t)))
    return normal_modes(linearize(euler_lagrange(scene)), digits=20).mu


if __name__ == "__main__":
    main()
