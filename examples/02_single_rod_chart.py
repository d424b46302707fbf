"""The article's figure for one rod: where the trace of the Floquet matrix is +-2, in (h, v).

One uniform rod upside down on a vertically driven support is Mathieu's equation
with ``a = -3/(2 v**2)``, ``b = 3 h/2`` (In[22] to Out[31]).  The script checks the
article's sample point and writes ``docs/images/single_rod.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from sympy import cos, symbols

from fastpicard import FloquetMatrix
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize

ORDERS = 20, 40
PICTURE = Path(__file__).parent.parent / "docs" / "images" / "single_rod.png"
h, v, t, m, l, epsilon, omega0 = symbols("h v t m l epsilon omega0")


def main() -> None:
    scene = Scene([Rod.uniform(m, l)], Support(eta=epsilon * cos(omega0 * t)))
    P, tau, period = linearize(euler_lagrange(scene)).first_order(omega0)
    print(f"P(tau) = {P.tolist()}")
    article, better = (FloquetMatrix(P, tau, n, period) for n in ORDERS)
    print(f"|multipliers| at (h, v) = (0.2, 40): {[abs(x) for x in article.multipliers({h: 0.2, v: 40})]}"
          "    Out[31]: 1., 1.")
    draw(article.lambdify_trace([h, v]), better.lambdify_trace([h, v]))


def draw(article: object, better: object) -> None:
    """The curves of n = 20, and in grey where n = 40 disagrees with it by more than 0.01."""
    x, y = np.meshgrid(np.linspace(0, 0.5, 500), np.linspace(0.1, 100, 1000))
    value, check = article(x, y), better(x, y)
    unsure = ~(np.abs(value - check) < 0.01)
    figure, axes = plt.subplots(figsize=(8, 5.5), constrained_layout=True)
    axes.contour(x, y, np.where(unsure, np.nan, value), levels=[-2, 2], colors=["tab:purple", "tab:blue"])
    axes.contourf(x, y, ~unsure & (np.abs(value) < 2), levels=[0.5, 1.5], colors=["tab:green"], alpha=0.2)
    axes.contourf(x, y, unsure, levels=[0.5, 1.5], colors=["0.7"])
    axes.plot(0.2, 40, "k.", label="the article's sample point (0.2, 40)")
    axes.plot([], [], color="tab:blue", label="trace = 2")
    axes.plot([], [], color="tab:purple", label="trace = -2")
    axes.fill([], [], color="tab:green", alpha=0.2, label="upright position stable")
    axes.fill([], [], color="0.7", label=f"{ORDERS[0]} and {ORDERS[1]} iterates disagree")
    axes.set(xlabel=r"$h = \epsilon/l$ (amplitude over length)",
             ylabel=r"$v = \omega_0\sqrt{l/g}$ (dimensionless frequency)",
             title="Linear stability of one driven rod, upside down", xlim=(0, 0.5), ylim=(0, 100))
    axes.legend(loc="upper right", fontsize=9)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


if __name__ == "__main__":
    main()
