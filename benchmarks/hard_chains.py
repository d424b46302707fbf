"""How often a random hard chain loses digits in float64: theta'' against 300 digits, and what the data are worth.

    python benchmarks/hard_chains.py [6000]

None is above 4e-15, since answers in doubt are found again in pairs of floats (``lagrangian/redone.py``).  float64
alone leaves 32 of 6000 above it, the worst at 2e-13.  The chains are those of ``tests/extremes/test_chains.py``, one to
twelve rods with gravity.  Beside the worst errors stands how far the exact answer moves if every number of the chain
and its state goes to a next float.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from lagrangian import CompiledChain
from tests.extremes.test_chains import KINDS, dense, error, hard_chain, moved


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 6000
    found = []
    for seed in range(count):
        rng = np.random.default_rng(seed)
        kind, n = KINDS[seed % len(KINDS)], int(rng.integers(1, 13))
        chain = hard_chain(kind, n, rng)
        exact = dense(*chain[:4], 9.81, *chain[4:])
        loss = error(CompiledChain(*chain[:4]).acceleration(0, *chain[4:]), exact)
        found.append((loss, kind, n, chain, exact))
    losses = np.array([loss for loss, *_ in found])
    print(f"{count} random hard chains: median {np.median(losses):.1e}; {(losses > 4e-15).sum()} above 4e-15, "
          f"{(losses > 4e-14).sum()} above 4e-14; the worst ones:")
    for loss, kind, n, chain, exact in sorted(found, key=lambda x: -x[0])[:8]:
        print(f"  {loss:.1e}, {n} rods, {kind}; the data are worth {moved(chain, exact):.1e}")


if __name__ == "__main__":
    main()
