"""Charts: points a second beside what one would use instead, and how long a certified chart takes.

    python benchmarks/charts.py                              # SciPy and eigenvalues, if installed
    python benchmarks/charts.py --heyoka /path/to/python     # heyoka in an environment of its own

All compute the trace of the Floquet matrix of one driven rod, h in [0, 0.5], v in [2, 100], to 1e-9.  Times are
processor times of one process, the least of three runs; building is included in the figures for a million points.
"""

import argparse
import json
import subprocess
import time

import numpy as np
from sympy import CRootOf, Expr, Matrix, Poly, Rational, cos, eye, sin, sqrt, symbols, zeros
from timing import least

from fastpicard import FloquetMatrix, certify, chart, tubes
from fastpicard.collapsed import Collapsed
from fastpicard.halfway import half_period
from fastpicard.vectorise import Evaluator

a, b, h, v, t = symbols("a b h v t")
MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
MILLION = 1_000_000
FIVE = Poly([362, -15699, 194760, -811026, 1011366, -229635], symbols("x"))  # det(B - mu A) of five equal rods
MU = {2: (3 - 6 / sqrt(7), 3 + 6 / sqrt(7)), 5: [CRootOf(FIVE, k) for k in range(5)]}

HEYOKA = """
import json, sys, time
import numpy as np, heyoka as hy
x, y = hy.make_vars("x", "y")
a, b = hy.par[0], hy.par[1]
count = int(sys.argv[1])
rng = np.random.default_rng(1)
h, v = rng.uniform(0, 0.5, count), rng.uniform(2, 100, count)
A, B = -1.5 / v**2, 1.5 * h
size = 4
start = time.process_time()
ta = hy.taylor_adaptive_batch([(x, y), (y, -(a + b * hy.cos(hy.time)) * x)], state=np.zeros((2, size)),
                              pars=np.zeros((2, size)), tol=1e-10, time=np.zeros(size))
build = time.process_time() - start
start = time.process_time()
traces = np.zeros(count)
for k in range(0, count - size + 1, size):
    total = np.zeros(size)
    for column in (0, 1):
        ta.set_time(0.0)
        ta.state[:] = 0.0
        ta.state[column] = 1.0
        ta.pars[0], ta.pars[1] = A[k:k + size], B[k:k + size]
        ta.propagate_until(2 * np.pi)
        total += ta.state[column]
    traces[k:k + size] = total
print(json.dumps({"rate": count / (time.process_time() - start), "build": build, "traces": traces[:8].tolist()}))
"""


def points(count: int) -> tuple[np.ndarray, np.ndarray]:
    """The same points for all."""
    rng = np.random.default_rng(1)
    hh, vv = rng.uniform(0, 0.5, count), rng.uniform(2, 100, count)
    return -1.5 / vv**2, 1.5 * hh


def ours() -> float:
    """Points a second at a million points, building included: trace = 2 + 4 B C from half the period."""
    A, B = points(MILLION)

    def run() -> None:
        F = FloquetMatrix(MATHIEU, t, 20)
        (_, upper), (lower, _) = half_period(F)
        (left, right), _, _ = Evaluator(Collapsed([upper, lower], t), (a, b))([A, B])
        kept[:] = [2 + 4 * left * right]

    kept: list[np.ndarray] = []
    seconds = least(run)
    exact = FloquetMatrix(MATHIEU, t, 40).lambdify_trace([a, b])(A[:100_000], B[:100_000])
    print(f"fastpicard, a million points, built and evaluated: {seconds:.2f} s, {MILLION / seconds:.3g} points/s, "
          f"largest error {np.abs(kept[0][:100_000] - exact).max():.0e}")
    return MILLION / seconds


def scipy_rate() -> float | None:
    """DOP853 on each point: both columns at once."""
    try:
        from scipy.integrate import solve_ivp
    except ImportError:
        print("SciPy is not installed")
        return None
    A, B = points(60)

    def run() -> None:
        for x, y in zip(A, B, strict=True):
            solve_ivp(lambda s, z, x=x, y=y: [z[1], -(x + y * np.cos(s)) * z[0], z[3], -(x + y * np.cos(s)) * z[2]],
                      (0, 2 * np.pi), [1, 0, 0, 1], method="DOP853", rtol=1e-9, atol=1e-10)

    return 60 / least(run)


def eigenvalue_rate() -> float:
    """The article's way: the matrix of the iterate and the eigenvalues of every point, one by one."""
    F = FloquetMatrix.for_accuracy(MATHIEU, t, {a: (-0.375, 0), b: (0, 0.75)}, 1e-9)
    A, B = points(100)
    matrix = F.lambdify([a, b])
    return 100 / least(lambda: [np.abs(np.linalg.eigvals(matrix(x, y))).max() for x, y in zip(A, B, strict=True)])


def heyoka_rate(python: str | None) -> float | None:
    """Adaptive Taylor, compiled, four points at a time, in another environment."""
    if python is None:
        return None
    found = subprocess.run([python, "-c", HEYOKA, "4000"], capture_output=True, text=True, check=False)
    if found.returncode:
        print("heyoka is not available there:", found.stderr.strip().splitlines()[-1] if found.stderr else "")
        return None
    answer = json.loads(found.stdout)
    F = FloquetMatrix(MATHIEU, t, 40)
    expected = F.lambdify_trace([a, b])(*(z[:8] for z in points(4000)))
    print(f"heyoka: compiled in {answer['build']:.2f} s, largest difference "
          f"{np.abs(expected - answer['traces']).max():.1e}")
    return float(answer["rate"])


def certified() -> None:
    """Seconds for certified charts and tubes, building included."""
    F = FloquetMatrix(MATHIEU, t, 0)
    rod = FloquetMatrix(MATHIEU.subs({a: Rational(-3, 2) / v**2, b: Rational(3, 2) * h}), t, 0)
    two, five = ([{a: -mu / v**2, b: mu * h} for mu in values] for values in (MU[2], MU[5]))

    def waves(part: Rational) -> FloquetMatrix:
        return FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t) - part * cos(2 * t), 0]]), t, 0)

    for name, run in (
        ("float chart with bounds, one rod, 1000 x 1000",
         lambda: chart(rod.to_order(20), (h, 0, 0.5), (v, 0.1, 100), points=(1000, 1000)).sizes),
        ("one rod, h in [0, 0.5], v in [0.1, 100]", lambda: certify(rod, (h, 0, 0.5), (v, 0.1, 100))),
        ("two rods, h in [0, 0.1], v in [0.1, 100]", lambda: certify(F, (h, 0, 0.1), (v, 0.1, 100), modes=two)),
        ("five rods, h in [0, 0.02], v in [0.1, 1000]", lambda: certify(F, (h, 0, 0.02), (v, 0.1, 1000), modes=five)),
        ("tubes of rods, a in [-0.75, 0], b in [0, 0.75]", lambda: tubes(F, (a, -0.75, 0), (b, 0, 0.75))),
        ("Mathieu, a in [-1, 5], b in [0, 6]", lambda: certify(F, (a, -1, 5), (b, 0, 6), seconds=25)),
        ("Mathieu with damping 1/10, a in [-1, 5], b in [0, 6]",
         lambda: certify(damped(cos(t)), (a, -1, 5), (b, 0, 6), seconds=25)),
        ("damped, with a wave that does not reverse, a in [-1, 3], b in [-3, 3]",
         lambda: certify(damped(cos(t) + sin(2 * t) / 3), (a, -1, 3), (b, -3, 3), seconds=25)),
        ("tubes of Mathieu, a in [-1, 5], b in [0, 6]", lambda: tubes(F, (a, -1, 5), (b, 0, 6))),
        ("two rods with joint springs, h in [0, 0.3], v in [2, 30]",
         lambda: certify(springs(2), (h, 0, 0.3), (v, 2, 30), seconds=60, undecided=1e-3)),
        ("three rods with joint springs, h in [0, 0.15], v in [2, 30]",
         lambda: certify(springs(3), (h, 0, 0.15), (v, 2, 30), seconds=120, undecided=1e-2)),
        ("three rods with joint springs, h in [0, 0.15], v in [2, 100]",
         lambda: certify(springs(3), (h, 0, 0.15), (v, 2, 100), seconds=120, undecided=1e-3)),
        *((f"y'' + (a + b cos t + {part} cos 2t) y, a in [-1, 3], b in [-3, 3]",
           lambda part=part: certify(waves(part), (a, -1, 3), (b, -3, 3), seconds=25))
          for part in (Rational(1, 5), Rational(1), Rational(2))),
    ):
        start = time.process_time()
        found = run()
        print(f"{name}: {time.process_time() - start:.1f} s of processor time; {found}", flush=True)


def damped(wave: Expr) -> FloquetMatrix:
    """``y'' + y'/10 + (a + b wave) y``."""
    return FloquetMatrix(Matrix([[0, 1], [-a - b * wave, -Rational(1, 10)]]), t, 0)


def springs(rods: int) -> FloquetMatrix:
    """Equal upright rods with springs of m g l/5 in their joints, [Neves] (18): no normal modes decouple them."""
    A = Matrix(rods, rods, lambda i, j: rods - max(i, j) - (Rational(2, 3) if i == j else Rational(1, 2)))
    B = Matrix.diag(*(rods - i - Rational(1, 2) for i in range(rods)))
    K = Matrix(rods, rods, lambda i, j: -1 if abs(i - j) == 1 else 0 if i != j else 1 if i == rods - 1 else 2)
    S = A.inv() * (B * (h * cos(t) - 1 / v**2) + K / (5 * v**2))
    return FloquetMatrix(zeros(rods).row_join(eye(rods)).col_join((-S).row_join(zeros(rods))), t, 0)


def main() -> None:
    options = argparse.ArgumentParser()
    options.add_argument("--heyoka", help="a Python that has heyoka")
    chosen = options.parse_args()
    mine = ours()
    for name, rate in (("SciPy DOP853", scipy_rate()), ("eigenvalues point by point", eigenvalue_rate()),
                       ("heyoka, batches of four", heyoka_rate(chosen.heyoka))):
        if rate is not None:
            print(f"{name}: {rate:.3g} points/s; ours is {mine / rate:.3g} times as fast")
    certified()


if __name__ == "__main__":
    main()
