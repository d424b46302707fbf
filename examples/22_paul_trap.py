"""Mathieu's chart and the Paul trap: q_max = 0.908046... is where a boundary crosses a = 0.

An ion's equation in a Paul trap without direct voltage is Mathieu's with a = 0; it is held while
``q = 2 b < q_max``, ``trace = -2``.  The boundary "-1 even" crosses a = 0 there; the 24 digits below are proved.
Writes ``docs/images/paul_trap.png``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
from mpmath import nstr, workdps
from sympy import Matrix, cos, symbols

from fastpicard import FloquetMatrix, boundaries, certify, tubes

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "paul_trap.png"
a, b, t = symbols("a b t")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])


def main() -> None:
    F = FloquetMatrix(P, t, 40)
    roots = [(f, f.root(b, (0.3, 0.6), {a: 0}, digits=25)) for f in boundaries(F)[2:3]]
    for f, root in roots:
        with workdps(25):  # else mpmath rounds 2 b to 15
            print(f"boundary {f.label} {f.parity}: q_max = 2 b = {nstr(2 * root.value, 24)}, proved to "
                  f"{2 * root.error:.0e}, {root.evaluations} evaluations")
    figure, axes = plt.subplots(1, 2, figsize=(13, 5.5), constrained_layout=True)
    whole = certify(F, (a, -1, 5), (b, 0, 6), seconds=25)
    print(whole)
    whole.plot(axes[0], xlabel="a", ylabel="b", title="y'' + (a + b cos t) y = 0: proved")
    near = certify(F, (a, -0.5, 0.6), (b, 0, 0.9))
    curves = tubes(F, (a, -0.5, 0.6), (b, 0, 0.9))
    print(curves)
    near.with_tubes(curves).plot(axes[1], xlabel="a", ylabel="b = q/2",
                                 title="The trap works below q = 0.908")
    axes[1].plot(0, float(roots[0][1].value), "o", color="tab:red")
    axes[1].annotate("q = 0.908046...", (0, float(roots[0][1].value)), xytext=(0.12, 0.62), color="tab:red",
                     arrowprops={"arrowstyle": "->", "color": "tab:red"})
    axes[1].set(xlim=(-0.5, 0.6), ylim=(0, 0.9))
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


if __name__ == "__main__":
    main()
