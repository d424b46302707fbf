"""The article's double rod, from the rods to the last figure, with the article's numbers beside ours.

Two equal uniform rods stand upside down on a support that moves up and down as
``eta(t) = epsilon cos(omega0 t)``.  The script derives the equations of motion,
linearises them, computes the Floquet matrix exactly in ``h = epsilon/l`` and
``v = omega0 sqrt(l/g)``, and finds where the upright position is stable in two
ways: points by bisection on the eigenvalues of the 4 x 4 matrix, and curves from
two Mathieu equations in normal coordinates.  It writes ``docs/images/double_rod.png``.
"""

from itertools import pairwise
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from sympy import Matrix, Rational, cos, pretty, symbols

from fastpicard import FloquetMatrix, mathieu_a
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes

ORDER = 20
PICTURE = Path(__file__).parent.parent / "docs" / "images" / "double_rod.png"
a, b, h, v, t, m, l, epsilon, omega0 = symbols("a b h v t m l epsilon omega0")


def main() -> None:
    linear = derive()
    P, tau, period = linear.first_order(omega0)
    F = FloquetMatrix(P, tau, ORDER, period)
    print(f"\nFloquet matrix: {F}, trace with {len(F.trace().args)} terms in h, v and pi")
    modes = normal_modes(linear)
    points = boundary_points(F)
    report(F, points, modes)
    draw(points, modes)


def derive() -> object:
    """From the rods to the matrices A and B of the article's equation (18)."""
    scene = Scene([Rod.uniform(m, l)] * 2, Support(eta=epsilon * cos(omega0 * t)))
    equations = euler_lagrange(scene)
    linear = linearize(equations).divided()
    print("equations of motion, M(theta) theta'' = f(theta, theta', t), with M =")
    print(pretty(equations.mass_matrix, use_unicode=False))
    modes = normal_modes(linear)
    print(f"{'':12}{'here':44}article")
    print(f"{'A':12}{modes.A.tolist()!s:44}Out[38]: [[4/3, 1/2], [1/2, 1/3]]")
    print(f"{'B':12}{modes.B.tolist()!s:44}Out[42]: [[3/2, 0], [0, 1/2]]")
    print(f"{'A^-1 B':12}{(modes.A.inv() * modes.B).tolist()!s:44}Out[43]: [[18/7, -9/7], [-27/7, 24/7]]")
    return linear


# -- points by bisection: the article's In[46] to In[52] ------------------------


def boundary_points(F: FloquetMatrix) -> list[tuple[float, float]]:
    """Bisection between neighbours of the article's grid, along v to 0.1 and along h to 0.0001."""
    matrix = F.lambdify([h, v])

    def grows(x: float, y: float) -> bool:
        """Whether an eigenvalue leaves the unit circle; 1e-10 is the article's Chop."""
        return np.abs(np.linalg.eigvals(matrix(x, y))).max() > 1 + 1e-10

    hs, vs = [k / 100 for k in range(11)], [0.1 + 10 * k for k in range(10)]
    points = []
    for x in hs:
        points += [(x, bisect(lambda y, x=x: grows(x, y), low, high, 0.1)) for low, high in pairwise(vs)
                   if grows(x, low) != grows(x, high)]
    for y in vs:
        points += [(bisect(lambda x, y=y: grows(x, y), low, high, 1e-4), y) for low, high in pairwise(hs)
                   if grows(low, y) != grows(high, y)]
    return points


def bisect(grows: object, low: float, high: float, tolerance: float) -> float:
    """Halve as often as the article's In[50] and give the middle of what is left."""
    for _ in range(max(1, int(np.ceil(np.log2((high - low) / tolerance))))):
        middle = (low + high) / 2
        low, high = (middle, high) if grows(middle) == grows(low) else (low, middle)
    return (low + high) / 2


# -- what came out -------------------------------------------------------------


def report(F: FloquetMatrix, points: list[tuple[float, float]], modes: object) -> None:
    places = [{h: Rational(2, 100), v: Rational(y, 10)} for y in (801, 901)]
    moduli = [abs(F.multipliers(place)[0]) for place in places]
    proved = ", ".join(f"({float(place[h])}, {float(place[v])}): {F.verdict(place).name}" for place in places)
    print(f"{'largest':12}{'(0.02, 80.1): {:.6g}, (0.02, 90.1): {:.6g}'.format(*moduli):44}Out[48]: 1.01665, 1.")
    print(f"{'proved':12}{proved:54} of the true equation, in balls")
    slow = min(modes.mu, key=lambda mu: mu.evalf())
    found = next(y for x, y in points if x == 0.06 and y < 40)
    exact = (-slow / (mathieu_a(0, -2 * slow * Rational(6, 100), 20) / 4)) ** Rational(1, 2)
    print(f"{'mu':12}{', '.join(f'{mu.evalf(8)}' for mu in modes.mu):44}eigenvalues of A^-1 B")
    print(f"{'bisection':12}{f'h = 0.06, v = {found:.7f}':44}Out[55]: 27.5609")
    print(f"{'exact':12}{f'h = 0.06, v = {exact.evalf(14)}':44}Out[56]: 27.5568")


def draw(points: list[tuple[float, float]], modes: object) -> None:
    """Both ways in one picture; where n = 20 proves nothing, the picture says so."""
    mathieu = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, ORDER)
    trace = mathieu.lambdify_trace([a, b])
    x, y = np.meshgrid(np.linspace(0, 0.1, 401), np.linspace(0.1, 100, 800))
    figure, axes = plt.subplots(figsize=(8, 5.5), constrained_layout=True)
    stable, trusted = np.ones_like(x, dtype=bool), np.ones_like(x, dtype=bool)
    for mu, colour, name in zip(modes.mu, ("tab:red", "tab:cyan"), ("slow mode", "fast mode"), strict=True):
        mu = float(mu)
        value = trace(-mu / y**2, mu * x)
        trusted &= remainder(mu / y**2 + mu * x) < 0.01
        stable &= np.abs(value) < 2
        axes.contour(x, y, np.where(trusted, value, np.nan), levels=[-2, 2], colors=colour, linestyles="-")
        axes.plot([], [], color=colour, label=rf"trace = $\pm 2$, {name}, $\mu$ = {mu:.4f}")
    axes.contourf(x, y, stable & trusted, levels=[0.5, 1.5], colors=["tab:green"], alpha=0.2)
    axes.contourf(x, y, ~trusted, levels=[0.5, 1.5], colors=["0.7"])
    axes.plot(*zip(*points), "k.", markersize=5, label="bisection on the 4 x 4 Floquet matrix")
    axes.fill([], [], color="tab:green", alpha=0.2, label="upright position stable")
    axes.fill([], [], color="0.7", label=f"{ORDER} iterates are not enough here")
    axes.set(xlabel=r"$h = \epsilon/l$ (amplitude over length)",
             ylabel=r"$v = \omega_0\sqrt{l/g}$ (dimensionless frequency)",
             title="Linear stability of the driven double rod, upside down", xlim=(0, 0.1), ylim=(0, 100))
    axes.legend(loc="upper center", fontsize=9)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


def remainder(c: np.ndarray) -> np.ndarray:
    """What the trace of Mathieu's iterate leaves out, at most: 2 sum (c (2 pi)**2)**j / (2j)! over 2j > n."""
    z, term, total = c * (2 * np.pi) ** 2, np.ones_like(c), np.zeros_like(c)
    for j in range(1, 200):
        term = term * z / (2 * j * (2 * j - 1))
        total += np.where(2 * j > ORDER, 2 * term, 0)
    return total


if __name__ == "__main__":
    main()
