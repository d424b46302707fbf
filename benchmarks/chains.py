"""Chains of rods against SymPy with SciPy, PyDy, heyoka, MuJoCo, Pinocchio and mpmath, in one run, as ratios.

    python benchmarks/chains.py [rhs] [many] [motion] [digits [--until=2.8]] [modes] [start]

A peer that is not installed is left out with a sentence (pip install heyoka mujoco pin pydy cython).  Every time is
the least of several repeats on one core; the machine decides the times, the ratios are what matters.  Every peer's
answer is compared with ours before its time is printed.  The 50 digits are those of a tenth of a second, or of as
many as are given: 2.8 take mpmath.odefun a quarter of an hour, 10 three quarters.
"""

# ruff: noqa: B023  (every function here is timed before its loop goes on)
from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from importlib import import_module, metadata
from importlib.util import find_spec
from typing import Any

import mpmath
import numpy as np
from sympy import Integer, Rational, symbols

from lagrangian import (
    CompiledChain,
    Ensemble,
    Rod,
    Scene,
    compile_equations,
    euler_lagrange,
    linearize,
    normal_modes,
    simulate,
)
from lagrangian.digits import Steps, integrate_digits
from lagrangian.doubled import DoubledSteps
from lagrangian.floats import FINEST, ORDER, integrate_floats
from lagrangian.solvers import heyoka_system

GRAVITY = 9.81


def least(function: Callable[[], Any], seconds: float = 1.0) -> float:
    """The least time of one call, over about ``seconds``."""
    function()
    calls, best, end = 1, float("inf"), time.perf_counter() + seconds
    while time.perf_counter() < end:
        start = time.perf_counter()
        for _ in range(calls):
            function()
        spent = (time.perf_counter() - start) / calls
        best = min(best, spent)
        calls = max(1, min(1000, int(2e-3 / spent)))
    return best


def version(package: str) -> str | None:
    """The version installed, or None after saying so."""
    if find_spec({"pin": "pinocchio"}.get(package, package)) is None:
        print(f"  {package} is not installed; its rows are left out (pip install {package}).")
        return None
    return metadata.version(package)


def random_rods(n: int) -> tuple[Any, ...]:
    rng = np.random.default_rng(n)
    length = rng.uniform(0.5, 1.5, n) / n
    center = rng.uniform(0.3, 0.7, n) * length
    return rng.uniform(0.5, 1.5, n), length, center, np.sqrt(center**2 + rng.uniform(0.05, 0.15, n) * length**2)


def state(n: int) -> tuple[Any, Any]:
    rng = np.random.default_rng(n + 1)
    return rng.uniform(-3, 3, n), rng.normal(size=n)


def pinocchio_chain(rods: tuple[Any, ...]) -> Callable[[Any, Any], Any]:
    pin = import_module("pinocchio")
    model, parent = pin.Model(), 0
    for k, (m, _, H, R) in enumerate(zip(*rods)):
        offset = np.array([0.0, 0.0, rods[1][k - 1] if k else 0.0])
        parent = model.addJoint(parent, pin.JointModelRY(), pin.SE3(np.eye(3), offset), f"joint{k}")
        model.appendBodyToJoint(parent, pin.Inertia(m, np.array([0.0, 0.0, H]), np.eye(3) * m * (R * R - H * H)),
                                pin.SE3.Identity())
    model.gravity.linear = np.array([0.0, 0.0, -GRAVITY])
    data, zero = model.createData(), np.zeros(model.nv)
    return lambda q, v: pin.aba(model, data, q, v, zero)


def mujoco_chain(rods: tuple[Any, ...]) -> Callable[[Any, Any], Any]:
    mujoco = import_module("mujoco")
    body = ""
    for k, (m, _, H, R) in reversed(list(enumerate(zip(*(part.tolist() for part in rods))))):
        height, spin = float(rods[1][k - 1]) if k else 0.0, m * (R * R - H * H)
        body = (f'<body pos="0 0 {height}"><joint type="hinge" axis="0 1 0"/>'
                f'<inertial pos="0 0 {H}" mass="{m}" diaginertia="{spin} {spin} {spin}"/>{body}</body>')
    options = '<compiler balanceinertia="false" boundmass="0" boundinertia="0"/>'
    model = mujoco.MjModel.from_xml_string(f'<mujoco>{options}<option gravity="0 0 {-GRAVITY}"/>'
                                           f"<worldbody>{body}</worldbody></mujoco>")
    data = mujoco.MjData(model)

    def forward(q: Any, v: Any) -> Any:
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_forward(model, data)
        return data.qacc
    return forward


def pydy_chain(rods: tuple[Any, ...]) -> Callable[[Any, Any], Any]:
    """PyDy's C (by Cython, where that is installed) for the equations of SymPy's KanesMethod."""
    mechanics = import_module("sympy.physics.mechanics")
    generate = import_module("pydy.codegen.ode_function_generators").generate_ode_function
    n, frame, last = len(rods[0]), mechanics.ReferenceFrame("I"), mechanics.Point("O")
    last.set_vel(frame, 0)
    q, u = (mechanics.dynamicsymbols(f"{letter}:{n}") for letter in "qu")
    g, t = symbols("g t")
    names = [symbols(f"{letter}:{n}") for letter in "mlHJ"]
    bodies, weights = [], []
    for k, (m, l, H, J) in enumerate(zip(*names)):
        axes = frame.orientnew(f"B{k}", "Axis", [-q[k], frame.z])
        axes.set_ang_vel(frame, -u[k] * frame.z)
        center, end = last.locatenew(f"C{k}", H * axes.y), last.locatenew(f"P{k}", l * axes.y)
        for point in (center, end):
            point.v2pt_theory(last, frame, axes)
        inertia = mechanics.inertia(axes, 0, 0, J), center
        bodies.append(mechanics.RigidBody(f"R{k}", center, axes, m, inertia))
        weights.append((center, -m * g * frame.y))
        last = end
    kane = mechanics.KanesMethod(frame, q_ind=q, u_ind=u, kd_eqs=[x.diff(t) - y for x, y in zip(q, u)])
    kane.kanes_equations(bodies, weights)
    rates = generate(kane.forcing_full, q, u, [*(x for part in names for x in part), g],
                     mass_matrix=kane.mass_matrix_full, generator="cython" if find_spec("Cython") else "lambdify")
    mass, length, center_of, gyration = rods
    numbers = np.concatenate([mass, length, center_of, mass * (gyration**2 - center_of**2), [GRAVITY]])
    return lambda theta, omega: rates(np.concatenate([theta, omega]), 0.0, numbers)[n:]


def right_hand_sides() -> None:
    print("\nOne right-hand side, random rods: us a call, and how many times ours")
    print(f"{'n':>8} {'ours':>9} {'ns/link':>8}   peers")
    packages = {name: version(name) for name in ("mujoco", "pin", "pydy")}
    for n in (2, 5, 10, 100, 300, 1000, 10_000, 100_000, 1_000_000):
        rods, (theta, omega) = random_rods(n), state(n)
        chain = CompiledChain(*rods, GRAVITY)
        mine = chain.acceleration(0, theta, omega)
        ours = least(lambda: chain.acceleration(0, theta, omega), 2.0)
        cells = []
        q, v = np.diff(theta, prepend=0.0), np.diff(omega, prepend=0.0)
        q = np.remainder(q + np.pi, 2 * np.pi) - np.pi
        for name, build in (("pin", pinocchio_chain), ("mujoco", mujoco_chain)):
            if packages[name] is None or n > 300:
                continue
            peer = build(rods)
            assert abs(np.cumsum(peer(q, v)) - mine).max() < 1e-6 * abs(mine).max(), name
            spent = least(lambda: peer(q, v))
            cells.append(f"{name} {packages[name]}: {1e6 * spent:.4g} ({spent / ours:.3g}x)")
        if n <= 10:
            scene = Scene([Rod(*x) for x in zip(*rods)], gravity=GRAVITY)
            dense = compile_equations(euler_lagrange(scene))
            assert abs(dense.acceleration(0, theta, omega) - mine).max() < 1e-9 * abs(mine).max()
            spent = least(lambda: dense.acceleration(0, theta, omega))
            cells.append(f"SymPy lambdify: {1e6 * spent:.4g} ({spent / ours:.3g}x)")
        if n <= 10 and packages["pydy"]:
            start = time.perf_counter()
            generated = pydy_chain(rods)
            found = generated(theta, omega)
            waited = time.perf_counter() - start
            assert abs(found - mine).max() < 1e-9 * abs(mine).max()
            spent = least(lambda: generated(theta, omega))
            cells.append(f"pydy {packages['pydy']}, after {waited:.1f} s: {1e6 * spent:.4g} ({spent / ours:.3g}x)")
        print(f"{n:>8} {1e6 * ours:>9.4g} {1e9 * ours / n:>8.3g}   {'; '.join(cells)}")


def many_chains() -> None:
    count = 1000
    print(f"\n{count} chains at once: ns a link and chain; common rods, rods of their own, with counterweights")
    for n in (2, 10, 100, 1000):
        rng = np.random.default_rng(n)
        theta, omega = rng.uniform(-3, 3, (count, n)), rng.normal(size=(count, n))
        across = [np.ascontiguousarray(x.T) for x in (theta, omega)]
        mass, length = rng.uniform(0.5, 1.5, (2, count, n)) / np.array([1, n])[:, None, None]
        mass[:, 0] *= 100
        center = rng.uniform(0.3, 0.7, (count, n)) * length
        rods = mass, length, center, np.sqrt(center**2 + rng.uniform(0.05, 0.15, (count, n)) * length**2)
        common, own = CompiledChain(*(x[0] for x in rods), GRAVITY), Ensemble(*rods, GRAVITY)
        counter = Ensemble(mass, length, -center, rods[3], GRAVITY)
        spent, other, third = (1e9 * least(work, 3.0) / n / count for work in (
            partial(common.acceleration, 0, *across), partial(own.acceleration, 0, theta, omega),
            partial(counter.acceleration, 0, theta, omega)))
        print(f"{n:>8}   {spent:.3g}, {other:.3g} ({other / spent:.2g}x), {third:.3g}")


def swinging(n: int) -> CompiledChain:
    """n bobs of 1 kg on rods of 1 m, angles from the downward vertical."""
    ones = np.ones(n)
    return CompiledChain(ones, ones, ones, ones, GRAVITY, upright=False)


def motions() -> None:
    print("\n10 s from 2 rad at rest, to roundoff: ms (error of the worst angle), and how many times ours")
    heyoka_version = version("heyoka")
    for n in (2, 5, 10, 20):
        chain, theta, omega, times = swinging(n), np.full(n, 2.0), np.zeros(n), np.array([0.0, 10.0])
        def mine() -> Any:
            return integrate_floats(chain, theta, omega, times, ORDER, FINEST)
        true = simulate(chain, theta, omega, times, digits=25 + 2 * n).theta[-1].astype(float) if n <= 5 else None

        def wrong(angles: Any) -> str:
            return f"{abs(angles - true).max():.0e}" if true is not None else "chaos"
        ours = least(mine, 3.0)
        print(f"n = {n}: ours {1e3 * ours:.3g} ({wrong(mine().theta[-1])}), {mine().steps} steps")
        whole = least(lambda: simulate(chain, theta, omega, times), 2.0)
        print(f"   simulate(...), which runs it three times to know its error: {1e3 * whole:.3g} ({whole / ours:.3g}x)")
        if n <= 2:
            scene = Scene([Rod.bob(1, 1)] * n, gravity=GRAVITY, upright=False)
            dense = compile_equations(euler_lagrange(scene))
            solve = import_module("scipy.integrate").solve_ivp

            def other() -> Any:
                return solve(lambda t, y: np.concatenate([y[n:], dense.acceleration(t, y[:n], y[n:])]), (0, 10),
                             np.concatenate([theta, omega]), "DOP853", rtol=1e-13, atol=1e-13).y[:n, -1]
            spent = least(other, 3.0)
            print(f"   SciPy DOP853, SymPy right-hand side: {1e3 * spent:.4g} ({wrong(other())}): {spent / ours:.4g}x")
        if heyoka_version and n <= 10:
            heyoka = import_module("heyoka")
            start = time.perf_counter()
            integrator = heyoka.taylor_adaptive(heyoka_system(chain, heyoka), [*theta, *omega], tol=2.3e-16)
            compiled = time.perf_counter() - start

            def fast() -> Any:
                integrator.time = 0.0
                integrator.state[:] = [*theta, *omega]
                integrator.propagate_until(10.0)
                return integrator.state[:n]
            spent = least(fast, 3.0)
            print(f"   heyoka {heyoka_version}, after {compiled:.1f} s of compiling: {1e3 * spent:.4g} "
                  f"({wrong(fast())}): "
                  f"{spent / ours:.3g}x")


    what_chaos_leaves()


def what_chaos_leaves() -> None:
    print("\nthe same ten seconds: error of the worst angle against 28 digits, and what simulate estimates, in rad")
    for n in (2, 5, 10):
        ones = np.ones(n)
        rods = CompiledChain(ones, ones, ones / 2, ones / np.sqrt(3), GRAVITY, upright=False)
        for name, chain in (("bobs", swinging(n)), ("uniform rods", rods)):
            motion = simulate(chain, [2] * n, [0] * n, [0, 10])
            finer, spent = timed(lambda: simulate(chain, [2] * n, [0] * n, [0, 10], digits=28), 2)
            lost = abs(motion.theta[-1] - finer.theta[-1].astype(float)).max()
            print(f"{n:>4} {name}: {lost:.1e}, estimated {motion.error[-1]:.1e}; "
                  f"28 digits in {spent:.2g} s, {float(finer.error[-1]):.0e}", flush=True)


def digits() -> None:
    end = next((Rational(x.partition("=")[2]) for x in sys.argv if x.startswith("--until=")), Rational(1, 10))
    print(f"\n50 digits, double pendulum from 2 rad, {float(end)} s of motion: processor time")
    before = time.process_time()
    mine = integrate_digits(swinging(2), [Integer(2)] * 2, [Integer(0)] * 2, [Integer(0), end], 50).theta[-1]
    ours = time.process_time() - before
    with mpmath.workdps(50):
        g = mpmath.mpf(GRAVITY)

        def rates(_: Any, y: Any) -> Any:
            a, b, u, v = y
            s, c = mpmath.sin(a - b), mpmath.cos(a - b)
            p, q = -v * v * s - 2 * g * mpmath.sin(a), u * u * s - g * mpmath.sin(b)
            return [u, v, (p - c * q) / (2 - c * c), (2 * q - c * p) / (2 - c * c)]
        before = time.process_time()
        other = mpmath.odefun(rates, 0, [mpmath.mpf(2)] * 2 + [mpmath.mpf(0)] * 2)(mpmath.mpf(end.p) / end.q)
        spent = time.process_time() - before
        apart = mpmath.nstr(max(abs(x - y) for x, y in zip(mine, other)), 2)
    print(f"ours {ours:.3g} s, mpmath.odefun {mpmath.__version__} {spent:.4g} s: {spent / ours:.4g}x; apart by {apart}")
    error = simulate(swinging(2), [2] * 2, [0] * 2, [0, end], digits=50).error[-1]
    print(f"simulate(..., digits=50), which runs it again, estimates its error as {float(error):.0e}")
    print("\n28 digits from 2 rad, one run, ms of processor time: double-double, the same steps in balls, how apart")
    for n, end in ((2, Integer(5)), (10, Integer(1)), (100, Rational(1, 8))):
        motion = swinging(n), [Integer(2)] * n, [Integer(0)] * n, [Integer(0), end], 28
        doubled, balls = (partial(integrate_digits, *motion, None, None, kind) for kind in (DoubledSteps, Steps))
        doubled()
        started = time.process_time()
        run = doubled()
        between = time.process_time()
        other = balls().theta
        mine, theirs = 1e3 * (between - started), 1e3 * (time.process_time() - between)
        apart = mpmath.nstr(abs(run.theta - other).max(), 2)
        print(f"{n:>4} bobs, {run.steps} steps: {mine:.4g}, {theirs:.5g}: {theirs / mine:.3g}x; apart by {apart}")


def modes() -> None:
    print("\nNormal modes of N rods, 15 digits, proved: ms of processor time; how many times that mpmath.eigsy and "
          "exact mu take")
    for n in (5, 10, 20, 30, 50):
        lin = linearize(euler_lagrange(Scene([Rod.uniform(1, 1)] * n, gravity=1)))
        found, ours = timed(lambda: normal_modes(lin, digits=15))
        exact, longer = timed(lambda: normal_modes(lin), 1)  # SymPy keeps the roots of a polynomial
        with mpmath.workdps(20):
            A, B = (mpmath.matrix(n, n) + mpmath.matrix(matrix.tolist()) for matrix in (found.A, found.B))

            def by_mpmath() -> Any:
                inverse = mpmath.cholesky(A) ** -1
                return mpmath.eigsy(inverse * B * inverse.T)[0]
            theirs, spent = timed(by_mpmath)
            scale = max(map(abs, theirs))
            assert max(abs(x - mpmath.mpf(y._mpf_)) for x, y in zip(theirs, found.mu)) < 1e-14 * scale
            assert max(abs(x - mpmath.mpf(y.evalf(20)._mpf_)) for x, y in zip(theirs, exact.mu)) < 1e-14 * scale
        print(f"N = {n}: {1e3 * ours:.3g}; {spent / ours:.2g}x; {longer / ours:.2g}x")


def timed(function: Callable[[], Any], calls: int = 3) -> tuple[Any, float]:
    """What it gives, and the least processor time of a few calls."""
    best = float("inf")
    for _ in range(calls):
        before = time.process_time()
        found = function()
        best = min(best, time.process_time() - before)
    return found, best


FIRST_MOTION = """
import time, numpy as np
from lagrangian import CompiledChain, simulate
chain = CompiledChain([1.0] * 2, [1.0] * 2, [1.0] * 2, [1.0] * 2, upright=False)
start = time.perf_counter()
simulate(chain, [2.0] * 2, [0.0] * 2, [0, 1])
print(f"{time.perf_counter() - start:.2f} s to a first motion before anything else")
"""

START = """
import time; start = time.perf_counter()
import numpy as np
from lagrangian import CompiledChain, simulate
chain = CompiledChain([1.0] * 5, [1.0] * 5, [0.5] * 5, [0.6] * 5, upright=False)
loaded = time.perf_counter()
chain.acceleration(0, [0.1] * 5, [0.0] * 5); first = time.perf_counter()
simulate(chain, [2] * 5, [0] * 5, [0, 1]); second = time.perf_counter()
simulate(chain, [2] * 5, [0] * 5, [0, 1], digits=28); third = time.perf_counter()
heavy = CompiledChain([1.0, 1.0, 1e12], [1.0] * 3, [0.5] * 3, [0.6] * 3)
heavy.acceleration(0, [0.6, -2.4, 0.3], [-2.6, 1.1, 1.7]); fourth = time.perf_counter()
print(f"{loaded - start:.2f} s to import, {first - loaded:.2f} s more to the first acceleration, "
      f"{second - first:.2f} s more to the first motion, {third - second:.2f} s more to one in double-double, "
      f"{fourth - third:.2f} s more to an answer in doubt")
"""


def start() -> None:
    print("\nFirst calls in a new process: without and with numba's cache")
    for script in (START, FIRST_MOTION):
        with tempfile.TemporaryDirectory() as folder:
            for label in ("translated", "from the cache"):
                environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
                done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True,
                                      check=True)
                print(f"{label:>15}: {done.stdout.strip()}")


PARTS = {"rhs": right_hand_sides, "many": many_chains, "motion": motions, "digits": digits, "modes": modes,
         "start": start}

if __name__ == "__main__":
    for name in [x for x in sys.argv[1:] if not x.startswith("--")] or PARTS:
        PARTS[name]()
