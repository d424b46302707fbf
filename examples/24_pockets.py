"""Pockets of instability: ``y'' + (a + b cos t + cos 2t) y = 0``, proved, with the points where they close.

A second wave lets tongues of instability close and open again.  Where the boundaries of even and of odd solutions
cross both solutions are periodic (coexistence): points proved to 1e-12, which by the theory of Ince's equation lie at
``b = k sqrt(2)``.  Writes ``docs/images/pockets.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
from sympy import Matrix, cos, symbols

from fastpicard import FloquetMatrix, boundaries, certify, crossing

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "pockets.png"
a, b, t = symbols("a b t")


def main() -> None:
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t) - cos(2 * t), 0]]), t, 44)
    chart = certify(F, (a, -1, 3), (b, -3, 3), seconds=40, undecided=3e-4)
    print(chart)
    figure, axes = plt.subplots(figsize=(8, 6), constrained_layout=True)
    chart.plot(axes, xlabel="a", ylabel="b",
               title=r"$y'' + (a + b\cos t + \cos 2t)\,y = 0$; red: both periodic solutions coexist")
    found = boundaries(F)
    for f, g, start in ((0, 1, (1.25, 1.4)), (0, 1, (1.25, -1.4)), (2, 3, (2.7, 2.8)), (2, 3, (2.7, -2.8)),
                        (2, 3, (0.1, 0.1)), (2, 3, (2.3, 0.1))):
        point = crossing(found[f], found[g], a, b, start)
        print(f"{found[f].label}: a = {point[a].str(12)}, b = {point[b].str(12)}")
        axes.plot(float(point[a]), float(point[b]), "o", color="tab:red", markersize=5)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


if __name__ == "__main__":
    main()
