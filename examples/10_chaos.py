"""Three, five and ten bobs let go from 2 rad: how long float64 knows where they are, and what digits add.

Each motion carries an estimate of its own error, which chaos multiplies until nothing is left; more digits buy
more time, at a constant rate.  Writes ``docs/images/chaos.png`` and ``docs/images/triple.gif``.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from lagrangian import CompiledChain, flips, simulate

IMAGES = Path(__file__).parent.parent / "docs" / "images"


def bobs(n: int) -> CompiledChain:
    """n bobs of 1 kg, 1 m apart, angles from the downward vertical."""
    ones = np.ones(n)
    return CompiledChain(ones, ones, ones, ones, upright=False)


def main() -> None:
    IMAGES.mkdir(exist_ok=True)
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(8, 6.5), layout="constrained")
    for n, colour in ((3, "tab:blue"), (5, "tab:orange"), (10, "tab:red")):
        motion = simulate(bobs(n), [2] * n, [0] * n, np.linspace(0, 20, 401))
        print(f"n = {n}: {motion.verdict}  Energy drift {motion.energy_drift:.0e} of MgL.")
        upper.semilogy(motion.times, np.maximum(motion.error, 1e-16), color=colour, label=f"{n} bobs, float64")
    finer = simulate(bobs(3), [2] * 3, [0] * 3, np.linspace(0, 6, 61), digits=30)
    upper.semilogy(finer.times, finer.error, "--", color="tab:blue", label="3 bobs, 30 digits")
    upper.axhline(1, color="black", linewidth=0.8, linestyle=":")
    upper.set(xlabel="time / s", ylabel="estimated error / rad", ylim=(1e-32, 1e3), title="How long a motion is known")
    upper.legend(loc="center right", fontsize="small")
    triple = simulate(bobs(3), [2] * 3, [0] * 3, np.linspace(0, 10, 301), events=flips(bobs(3)))
    for k, angle in enumerate(triple.theta.T, 1):
        lower.plot(triple.times, angle, label=rf"$\theta_{k}$")
    for name, times in triple.events.items():
        print(f"{name}: {', '.join(f'{x:.4f} s' for x in times) or 'never'}")
        lower.plot(times, np.interp(times, triple.times, triple.theta[:, int(name[-1]) - 1]), "k.")
    lower.set(xlabel="time / s", ylabel="angle / rad", title="Three bobs; dots: a rod passes the upward vertical")
    lower.legend(loc="lower left", fontsize="small")
    figure.savefig(IMAGES / "chaos.png", dpi=130)
    triple.animate(IMAGES / "triple.gif", frames=120)


if __name__ == "__main__":
    main()
