"""The exact engine against a bare prototype and against the best peer, as ratios measured in one run.

    python benchmarks/engine.py             # n = 20, 30, 50
    python benchmarks/engine.py --long      # and n = 100

Every pair is run alternately, several times, and the smallest time of each counts
(processor time of this process, so that neighbours on the machine matter less).
"""

from __future__ import annotations

import sys
from pathlib import Path

from sympy import Matrix, cos, sqrt, symbols

from fastpicard import FloquetMatrix, FundamentalMatrix, SeriesMatrix

sys.path.insert(0, str(Path(__file__).parent))
import peer
import yardstick
from timing import compare

t, a, b = symbols("t a b")
DRIVE = a + b * cos(t)
MATHIEU = Matrix([[0, 1], [-DRIVE, 0]])
DOUBLE_ROD = Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-18 * DRIVE, 9 * DRIVE, 0, 0], [27 * DRIVE, -24 * DRIVE, 0, 0]])


def against_yardstick(orders: list[int]) -> None:
    print("against the prototype (ratio of times, smaller is better)")
    print(f"{'problem':12} {'n':>4} {'prototype s':>12} {'Phi_n':>7} {'trace of Phi_n(2 pi)':>21}")
    for n in orders:
        row("Mathieu", n, MATHIEU, yardstick.MATHIEU, 2)
    for n in orders:
        if n <= 50:
            row("double rod", n, DOUBLE_ROD, yardstick.DOUBLE_ROD, 4)


def row(name: str, n: int, P: Matrix, plain: dict[tuple[int, int], list[object]], size: int) -> None:
    base, phi, trace = compare(lambda: yardstick.fundamental_matrix(plain, size, n),
                               lambda: FundamentalMatrix(P, t, n),
                               lambda: FloquetMatrix(P, t, n).trace(),
                               repeats=12 if n < 30 else 4 if n < 100 else 1)
    print(f"{name:12} {n:4} {base:12.4f} {phi / base:7.2f} {trace / base:21.2f}", flush=True)


def against_peer(orders: list[int]) -> None:
    print("against fmpq_mpoly by hand, Mathieu, both sides merged and reduced (times faster, larger is better):")
    print("all four entries written out, and Phi_n as it is made, where the second row is known as a derivative")
    print(f"{'n':>4} {'terms':>8} {'peer s':>9} {'entries':>8} {'Phi_n':>7}")
    for n in orders:
        peer_row(n)


def peer_row(n: int) -> None:
    theirs, entries, phi = compare(lambda: peer.fundamental_matrix(peer.MATHIEU, 2, n),
                                   lambda: FundamentalMatrix(MATHIEU, t, n).series,
                                   lambda: FundamentalMatrix(MATHIEU, t, n), repeats=12 if n < 30 else 4)
    count = peer.terms(peer.fundamental_matrix(peer.MATHIEU, 2, n))
    print(f"{n:4} {count:8} {theirs:9.4f} {theirs / entries:8.2f} {theirs / phi:7.2f}", flush=True)


def without_unit(orders: list[int]) -> None:
    print("two waves, cos t and cos(sqrt(2) t), against cos t and cos(3 t), entries written out")
    print(f"{'n':>4} {'terms':>8} {'terms':>8} {'s':>8} {'s':>8} {'time a term':>12}")
    for n in orders:
        unit_row(n)


def unit_row(n: int) -> None:
    without, with_unit = (Matrix([[0, 1], [-DRIVE - b * cos(q * t), 0]]) for q in (sqrt(2), 3))
    slow, fast = compare(lambda: FundamentalMatrix(without, t, n).series,
                         lambda: FundamentalMatrix(with_unit, t, n).series, repeats=2)
    many, few = (terms(FundamentalMatrix(P, t, n).series) for P in (without, with_unit))
    print(f"{n:4} {many:8} {few:8} {slow:8.3f} {fast:8.3f} {slow / many / (fast / few):12.1f}", flush=True)


def terms(matrix: SeriesMatrix) -> int:
    """How many terms the entries have."""
    return sum(1 for row in matrix.rows for modes in row for f in modes.values() for c in f.coeffs() if c)


def main() -> None:
    FundamentalMatrix(MATHIEU, t, 3).as_matrix()
    against_yardstick([20, 30, 50] + [100] * ("--long" in sys.argv))
    against_peer([20, 30, 50])
    without_unit([16, 24])


if __name__ == "__main__":
    main()
