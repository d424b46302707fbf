"""Two rods with springs in their joints, which no normal modes decouple, and a damped rod.

Springs beside a driven weight couple the modes: the full system of four is certified through the factors of half a
period, Hermite's minors and an invariant form.  With damping multipliers are no pairs; Schur and Cohn decide, and
stable means asymptotically stable.  Writes ``docs/images/springs_and_damping.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
from sympy import Matrix, Rational, cos, symbols

from fastpicard import FloquetMatrix, certify

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "springs_and_damping.png"
h, v, t, c = symbols("h v t c")


def main() -> None:
    figure, axes = plt.subplots(1, 2, figsize=(13, 5.5), constrained_layout=True)
    springs = certify(coupled(Rational(1, 5)), (h, 0, 0.2), (v, 4, 40), seconds=40, undecided=1e-3)
    print(springs)
    springs.plot(axes[0], xlabel=r"$h = \epsilon/l$ (amplitude over length)",
                 ylabel=r"$v = \omega_0\sqrt{l/g}$ (dimensionless frequency)",
                 title=r"two rods, joint springs $\kappa = m g l/5$")
    S = Rational(3, 2) * (h * cos(t) - 1 / v**2)
    damped = FloquetMatrix(Matrix([[0, 1], [-S, -c]]), t, 0)
    chart = certify(damped, (h, 0, 0.8), (v, 2, 40), fixed={c: Rational(1, 5)}, seconds=40)
    print(chart)
    chart.plot(axes[1], xlabel=r"$h = \epsilon/l$ (amplitude over length)",
               ylabel=r"$v = \omega_0\sqrt{l/g}$ (dimensionless frequency)",
               title=r"one damped rod, $\theta'' + \theta'/5 + \ldots$: asymptotically stable")
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


def coupled(kappa: object) -> FloquetMatrix:
    """The article's (18) with ``kappa`` (theta1 from the vertical, theta2 - theta1), in units of m g l."""
    A = Matrix([[Rational(4, 3), Rational(1, 2)], [Rational(1, 2), Rational(1, 3)]])
    B = Matrix([[Rational(3, 2), 0], [0, Rational(1, 2)]])
    K = kappa * Matrix([[2, -1], [-1, 1]])
    S = A.inv() * (B * (h * cos(t) - 1 / v**2) + K / v**2)
    return FloquetMatrix(Matrix.zeros(2).row_join(Matrix.eye(2)).col_join((-S).row_join(Matrix.zeros(2))), t, 0)


if __name__ == "__main__":
    main()
