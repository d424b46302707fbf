"""How often a random hard chain loses digits: theta'' against 300 digits, and what the data are worth.

    python benchmarks/hard_chains.py [6000]
    python benchmarks/hard_chains.py motions [200]
    python benchmarks/hard_chains.py single [1600]
    python benchmarks/hard_chains.py bent

The chains are those of ``tests/extremes/test_chains.py``, one to twelve rods with gravity.  Beside what
``acceleration`` gives stands the recursion in float64 alone, and how many answers it left in doubt, which are found
again (``lagrangian/redone.py``); for chains of ordinary rods too.  Beside the worst errors stands how far the exact
answer moves if every number of the chain and its state goes to a next float.  Last, what finding again costs.

Motions of such chains, one to six rods: how far angles are from 26 digits, over the error that they state.

Single rods, let go at rest: how far angles are from the elliptic function after 10 to 1000 s, over the same.

Long even chains in any state: the largest doubt of those that are bent, and not asked for it, and of the others.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import mpmath
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from lagrangian import CompiledChain, QuantityError, simulate
from lagrangian.angles import sines_of_large_joints
from lagrangian.recursion import accelerate_rods
from lagrangian.single import BENT
from tests.extremes.test_chains import (
    KINDS,
    dense,
    error,
    hard_chain,
    hard_motion,
    moved,
    nearly_straight,
    part_of_the_stated_error,
    partly_straight,
)


def main() -> None:
    if sys.argv[1:2] == ["motions"]:
        return motions(int(sys.argv[2]) if len(sys.argv) > 2 else 200)
    if sys.argv[1:2] == ["single"]:
        return single_rods(int(sys.argv[2]) if len(sys.argv) > 2 else 1600)
    if sys.argv[1:2] == ["bent"]:
        return long_chains()
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 6000
    report("hard", count, KINDS)
    report("ordinary", count, ["nothing"])
    costs()


def report(name: str, count: int, kinds: list[str]) -> None:
    found = []
    for seed in range(count):
        rng = np.random.default_rng(seed)
        kind, n = kinds[seed % len(kinds)], int(rng.integers(1, 13))
        m, l, H, R, theta, omega = data = hard_chain(kind, n, rng)
        chain, exact, alone = CompiledChain(m, l, H, R), dense(m, l, H, R, 9.81, theta, omega), np.empty(n)
        doubtful = chain._one(theta, omega, *chain.pull(0.0), alone)[1]
        loss = error(chain.acceleration(0, theta, omega), exact)
        found.append((loss, error(alone, exact), bool(doubtful), kind, n, data, exact))
    for what, losses in (("found", [x[0] for x in found]), ("in float64 alone", [x[1] for x in found])):
        print(f"{count} {name} chains, {what}: median {np.median(losses):.1e}, {sum(x > 4e-15 for x in losses)} above "
              f"4e-15, the worst {max(losses):.1e}")
    print(f"   in doubt: {sum(x[2] for x in found)}; the worst found:")
    for loss, _, _, kind, n, data, exact in sorted(found, key=lambda x: -x[0])[:4]:
        print(f"   {loss:.1e}, {n} rods, {kind}; the data are worth {moved(data, exact):.1e}")


def costs() -> None:
    print("microseconds a call: even rods, uneven ones, an answer found again")
    for n, chains in ((3, 1), (10, 1), (100, 1), (1000, 1), (100, 1000)):
        rng = np.random.default_rng(n)
        m, l, H, R, *_ = hard_chain("nothing", n, rng)
        theta, omega = rng.uniform(-3, 3, (n, chains)), rng.normal(size=(n, chains))
        state = (theta[:, 0], omega[:, 0]) if chains == 1 else (theta, omega)
        state = tuple(np.ascontiguousarray(x) for x in state)
        even, uneven = CompiledChain(m, l, H, R), CompiledChain(np.where(np.arange(n) == 0, 100 * m, m), l, H, R)
        works = (partial(even.acceleration, 0, *state), partial(uneven.acceleration, 0, *state),
                 partial(uneven._again, 0, theta, omega))
        print(f"   n = {n}, chains: {chains}: " + ", ".join(f"{least(work):.1f}" for work in works))


def motions(count: int) -> None:
    found, refused = [], 0
    for seed in range(count):
        arguments = hard_motion(seed)
        try:
            motion, true = (simulate(*arguments, digits=digits) for digits in (None, 26))
        except QuantityError:
            refused += 1
            continue
        found.append((part_of_the_stated_error(motion, true), motion.error[-1], KINDS[seed % len(KINDS)], seed))
    print(f"{len(found)} motions of hard chains, {refused} refused: at most {max(found)[0]:.2g} of the stated error, "
          f"median {np.median([x[0] for x in found]):.2g}; the worst:")
    for part, stated, kind, seed in sorted(found, reverse=True)[:4]:
        print(f"   {part:.2g} of {stated:.1e}, {len(hard_motion(seed)[0])} rods, {kind}, seed {seed}")


def single_rods(count: int) -> None:
    parts = np.array([part for seed in range(count) for part in parts_of_one(seed)])
    print(f"{parts.size} angles of single rods: error over its estimate {np.median(parts):.2f} in the middle, "
          f"{parts.max():.2f} at most; {(parts > 1).sum()} above it")


def parts_of_one(seed: int) -> list[float]:
    """``theta = 2 arcsin(k cd(w t, k))``, with ``k = sin(theta(0)/2)`` and ``w**2 = g H/R**2``, to 40 digits."""
    rng = np.random.default_rng(seed)
    mass, length, center, gyration = rng.uniform(0.1, 1, 4).tolist()
    gyration, start = max(gyration, 1.1 * center), float(rng.uniform(0.5, 3.1))
    chain, times = CompiledChain([mass], [length], [center], [gyration], 9.81, upright=False), [0, 10, 100, 333, 1000]
    motion = simulate(chain, [start], [0], times, accuracy=1e-10)
    with mpmath.workdps(40):
        rate = mpmath.sqrt(mpmath.mpf(9.81) * center) / gyration
        k = mpmath.sin(mpmath.mpf(start) / 2)
        exact = [2 * mpmath.asin(k * mpmath.ellipfun("cd", rate * t, k=k)) for t in times[1:]]
        return [float(abs(x - y)) / e for x, y, e in zip(motion.wrapped[1:, 0], exact, motion.error[1:], strict=True)]


def long_chains() -> None:
    for n, count in ((100, 6000), (300, 2000), (1000, 500)):
        rng = np.random.default_rng(n)
        mass, length = 2.0 ** rng.uniform(-1, 1, (2, n))
        center = length * rng.uniform(0, 1, n)
        rods = CompiledChain(mass, length, center, np.hypot(center, length * rng.uniform(0.1, 1, n))).rods
        theta, doubt = np.concatenate([rng.uniform(-3, 3, (n, count)), nearly_straight(n, count, rng)[0]], axis=1), []
        theta[:, count // 2:count] = partly_straight(n, count - count // 2, rng)
        rates = 10.0 ** rng.uniform(-3, 4, 2 * count) * rng.normal(size=theta.shape)
        s, c, out, variance = *np.empty((3, *theta.shape)), np.empty((3, *theta.shape))
        sines_of_large_joints(theta, s, c)
        for gravity in (9.81, 0.0):
            accelerate_rods(rods, rates**2, None, s, c, 0.0, gravity, np.empty((n, 4, 2 * count)), variance, out)
            doubt.append(np.sqrt(variance[0].max(axis=0) / (out**2).max(axis=0)))
        eights = ((s * c) ** 2)[:n // 8 * 8].reshape(n // 8, 8, -1)
        bent, most = eights.mean(axis=1).min(axis=0) >= BENT, np.maximum(*doubt)
        print(f"{n} even rods: doubt at most {most[bent].max():.1f} of {bent.sum()} bent, {most[~bent].max():.0f} of "
              f"{(~bent).sum()} straight somewhere; 4e-15 is 36")


def least(function: Callable[[], object]) -> float:
    """Microseconds of one call, the least of thirty."""
    times = []
    for _ in range(30):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return 1e6 * min(times)


if __name__ == "__main__":
    main()
