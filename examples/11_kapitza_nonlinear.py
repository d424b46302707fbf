"""A double rod upside down on a shaking support: nonlinear motions on both sides of the exact boundary.

The Floquet matrix of the linearised rods is stable above v = 27.5568 at h = 0.06.  Started near upright, the
nonlinear rods stay up where it is stable and fall where it is not.  Writes ``docs/images/kapitza.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from sympy import Rational, cos, symbols

from fastpicard import FloquetMatrix
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, simulate

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "kapitza.png"
t, omega0, epsilon = symbols("t omega0 epsilon")
DEPTH = Rational(6, 100)


def main() -> None:
    scene = Scene([Rod.uniform(1, 1)] * 2, Support(eta=epsilon * cos(omega0 * t)), gravity=1, t=t)
    P, tau, period = linearize(euler_lagrange(scene)).first_order(omega0)
    floquet = FloquetMatrix(P, tau, 40, period)
    h, v = (next(x for x in P.free_symbols if x.name == name) for name in "hv")
    figure, axes = plt.subplots(2, 2, figsize=(9, 6), layout="constrained", sharex=True)
    for part, speed in zip(axes.flat, (26, 27, 28, 32), strict=True):
        verdict = floquet.verdict({h: DEPTH, v: speed})
        chain = scene.compile({epsilon: DEPTH, omega0: speed})
        periods = np.linspace(0, 80, 1601)
        motion = simulate(chain, [0.02, -0.01], [0, 0], periods * 2 * np.pi / speed, accuracy=1e-6)
        print(f"v = {speed}: {verdict}\n        largest angle {abs(motion.theta).max():.3g} rad.  {motion.verdict}")
        for k, angle in enumerate(motion.theta.T, 1):
            part.plot(periods, angle, linewidth=0.8, label=rf"$\theta_{k}$")
        part.set_title(f"v = {speed}: {str(verdict).split(':')[0].split('.')[-1].lower()}")
    axes[0, 0].legend(loc="upper left")
    for part in axes[1]:
        part.set_xlabel("periods of the support")
    for part in axes[:, 0]:
        part.set_ylabel("angle from upright / rad")
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)


if __name__ == "__main__":
    main()
