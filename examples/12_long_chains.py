"""Two hundred rods let go from horizontal, and 400 double rods of almost the same start, in O(n) and O(chains).

Writes ``docs/images/long_chain.png``: the shape of the long chain over time, and the angles of the ensemble.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from lagrangian import CompiledChain, simulate

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "long_chain.png"


def main() -> None:
    n = 200
    ones = np.ones(n)
    chain = CompiledChain(ones / n, ones / n, ones / (2 * n), ones / (np.sqrt(3) * n), upright=False)
    motion = simulate(chain, np.full(n, np.pi / 2), np.zeros(n), np.linspace(0, 1.2, 25), accuracy=1e-6)
    print(motion, motion.verdict)
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.8), layout="constrained")
    for x, y, colour in zip(*motion.positions(), plt.cm.viridis(np.linspace(0, 1, len(motion))), strict=True):
        left.plot(x, y, color=colour, linewidth=1)
    left.set(aspect="equal", xlabel="x / m", ylabel="y / m", title="200 rods, 1 m in all, every 50 ms")

    pair, many = CompiledChain([1.0] * 2, [1.0] * 2, [0.5] * 2, [1 / np.sqrt(3)] * 2, upright=False), 400
    theta = np.stack([2.0 + 1e-6 * np.arange(many), np.full(many, 2.0)])
    omega, step, times = np.zeros_like(theta), 0.005, [0.0]
    spread = [np.ptp(theta, axis=1)]
    for i in range(3000):  # Stoermer-Verlet's positions are enough for a picture: one acceleration of all chains a step
        omega = omega + step * (0.5 if i == 0 else 1.0) * pair.acceleration(0, theta, omega)
        theta = theta + step * omega
        times.append(step * (i + 1))
        spread.append(np.ptp(theta, axis=1))
    right.semilogy(times, np.array(spread), label=[r"$\theta_1$", r"$\theta_2$"])
    right.set(xlabel="time / s", ylabel="spread / rad", title="400 double rods started within 0.0004 rad")
    right.legend()
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)


if __name__ == "__main__":
    main()
