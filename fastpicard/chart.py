r"""Charts of points: traces, margins and verdicts on a grid, in float64 with bounds.

    margin > 0  stable,   margin < 0  unstable,   |margin| <= error  undecided

For one degree of freedom the margin is ``2 - |trace|``; for modes, the least of theirs; for coupled systems
``min (2 - |rho|)`` over the real rho, and ``-max |Im rho|`` where one is not real; with damping, one minus the largest
modulus of a multiplier.

Where P reverses in time and has no diagonal the trace is ``2 + 4 B C`` (module ``halfway``), from the n-th iterate at
half the period.
Two bounds make up the error of a trace: that of the evaluation (module ``vectorise``) and the remainder of the iterate,
here the a-priori one at every point: ``sum over k > n of (Pbar T)**k / k!``, which for ``y'' + s(t) y = 0`` has
``sqrt(sup |s|) T`` for ``Pbar T``.  Where ``y'' = q y`` with q > 0 at all times, unstable by convexity, none is needed.
Where the error is more than the margin the pixel is undecided: truncation is visible, not hidden.  The error of
coupled and damped charts is an estimate (the matrix's bound times its eigenvectors' condition), and so is that of
modes: their parameters, ``-mu/v**2``, are rounded, which is taken to move the trace by ``2**-46`` of its size, more
than it does unless large ones cancel; proofs come from ``certify``.  Where rho of coupled systems coincide to within
the error, a point is undecided unless their signatures (Krein) keep the multipliers on the circle.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import lgamma
from typing import Any

from sympy import Symbol

from fastpicard.charted import Charted, Member, read_chart
from fastpicard.collapsed import Collapsed
from fastpicard.errors import BadInputError, BadTypeError, printed
from fastpicard.evaluate import numpy
from fastpicard.floquet import FloquetMatrix
from fastpicard.halfway import half_period, known_structure, reversal
from fastpicard.local import BITS, convex, span_at
from fastpicard.matrix import SeriesMatrix
from fastpicard.precision import working
from fastpicard.rectangles import Rectangles
from fastpicard.structure import Structure
from fastpicard.sweeps import chart_type, in_parts
from fastpicard.values import Values
from fastpicard.vectorise import Evaluator

Array = Any
RESULTS = ("trace", "margin", "error", "verdict")
MOST = 10**8  # points of a chart in memory, some ten floats each while it is computed; coupled ones take far more


def chart(F: FloquetMatrix, x: tuple[Symbol, Any, Any], y: tuple[Symbol, Any, Any],
          points: tuple[int, int] = (400, 400), fixed: Values | None = None, modes: Any = None,
          chunks: tuple[int, int] | None = None) -> Any:
    """Trace, margin, verdict and error bound of the n-th iterate on a grid of two parameters.

    Parameters
    ----------
    F : FloquetMatrix       its order ``n`` is taken as it is
    x, y : (Symbol, lo, hi)
    points : (across, up)
    fixed : {Symbol: number} for the other parameters
    modes : sequence of {Symbol: expression}, as for :func:`certify`
    chunks : None, or the points (across, up) of a part
        the arrays are then dask's: parts are computed when they are asked for, on all cores, and charts may be larger
        than memory; ``chart(...).to_zarr(...)`` and dask's schedulers take them.  Where eigenvalues decide, LAPACK's
        last bits depend on the parts

    Returns
    -------
    xarray.Dataset with coordinates y and x, and
        ``trace`` (of the Floquet matrix; of the mode with the least margin), ``margin``, ``error``, ``verdict``
        (1 stable, -1 unstable, 0 undecided: the margin is not larger than the error); ``attrs`` say where it comes
        from; ``.plot()`` draws it with matplotlib.

    Raises
    ------
    BadInputError, BadTypeError, MissingParameterError
        if the axes, points, chunks, modes or fixed values are not as described; more than 1e8 points without chunks;
        axes with the name of one of the arrays.
    NotInstalledError
        without xarray; for chunks, without dask.

    Notes
    -----
    A million points of one rod take a second or less (``benchmarks/charts.py``).  What is proved for whole
    rectangles is :func:`certify`.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 40)
    >>> data = chart(F, (a, -1, 2), (b, 0, 2), points=(31, 21))
    >>> int(data.verdict.sel(a=-0.1, b=0.5, method="nearest"))
    1
    """
    problem = read_chart(F, x, y, fixed, modes)
    across, up = _counts(points, 2, "points", "a chart needs two points along each axis")
    if chunks is None and across * up > MOST:
        raise BadInputError(f"a chart in memory has {MOST:,} points at most, but {printed(across)} times "
                            f"{printed(up)} are asked for.  Use chunks=(1000, 1000).")
    np, Chart = numpy(), chart_type()
    first, second = problem.axes
    dims = (str(second.symbol), str(first.symbol))
    if {*dims} & {*RESULTS}:
        raise BadInputError(f"a chart holds arrays called {', '.join(RESULTS)}, but its axes are called "
                            f"{' and '.join(dims)}.  Use a Symbol of another name.")
    xs, ys = np.linspace(first.lo, first.hi, across), np.linspace(second.lo, second.hi, up)
    if chunks is None:
        trace, margin, error, verdict = _sample(problem, xs, ys)
    else:
        part = _counts(chunks, 1, "chunks", "a part of a chart has at least one point along each axis")
        trace, margin, error, verdict = in_parts(partial(_sample, problem), xs, ys, part)
    return Chart(
        {"trace": (dims, trace, {"long_name": "trace of the Floquet matrix"}),
         "margin": (dims, margin, {"long_name": "distance from the boundary: positive where stable"}),
         "error": (dims, error, {"long_name": "bound of the margin's error"}),
         "verdict": (dims, verdict.astype(np.int8), {"long_name": "1 stable, -1 unstable, 0 undecided"})},
        {dims[0]: ys, dims[1]: xs},
        {"order": problem.F.n, "period": str(problem.F.period), "modes": len(problem.members),
         "error_is": "bound" if _is_scalar(problem) and _is_exact(problem) else "estimate",
         "equation": _shown(problem)})


def _is_exact(problem: Charted) -> bool:
    """Whether all parameters are coordinates of the grid themselves, so that none is rounded."""
    return all(number == 1 and sum(powers) == 1 and min(powers) == 0
               for member in problem.members for number, powers in member.values())


def _is_scalar(problem: Charted) -> bool:
    """Whether the trace alone decides."""
    return problem.F.shape == (2, 2) and known_structure(problem.F).paired


def _sample(problem: Charted, xs: Array, ys: Array) -> Array:
    """Trace, margin, error and verdict at the points of a grid, shape (4, up, across)."""
    np = numpy()
    grid = [z.ravel() for z in np.meshgrid(xs, ys)]
    known = known_structure(problem.F)
    scalar = _is_scalar(problem)
    compute = _by_matrix if not scalar else _by_factors if _is_mirrored(problem.F.P) else _by_trace
    best: list[Array] = []
    for member in problem.members:
        found = list(compute(problem, member, grid, known))
        if best:
            worse = found[1] < best[1]
            found = [np.where(worse, new, old) for new, old in zip(found, best, strict=True)]
        best = found
    trace, margin, error = best
    verdict = np.where(abs(margin) <= error, 0, np.sign(margin))
    verdict = np.where(np.isfinite(margin) & np.isfinite(error), verdict, 0)
    if known.bounded or known.unbounded:
        verdict = np.where(np.isfinite(margin), 1.0 if known.bounded else -1.0, 0.0)
    open_ = np.flatnonzero(verdict == 0)
    corner = np.stack([axis.inner(z[open_]) for axis, z in zip(problem.axes, grid, strict=True)])
    convex_there = np.logical_or.reduce([convex(problem, m, Rectangles(corner, corner)) for m in problem.members])
    verdict[open_[convex_there]] = -1
    return np.stack([trace, margin, error, verdict]).reshape(4, len(ys), len(xs))


def _is_mirrored(P: SeriesMatrix) -> bool:
    """Whether ``trace = 2 + 4 B C``: time reverses, and no diagonal makes ``det X`` at half the period other than 1."""
    return reversal(P) == (1, -1) and not P.rows[0][0] and not P.rows[1][1]


def _counts(given: Any, least: int, name: str, claim: str) -> Sequence[int]:
    if not isinstance(given, tuple | list) or len(given) != 2 or not all(isinstance(k, int) for k in given):
        raise BadTypeError(f"{name} must be (across, up), but it is {printed(given)}.  Use {name}=(400, 400).")
    if min(given) < least:
        raise BadInputError(f"{claim}, but {name} is {printed(given)}.  Use (400, 400).")
    return given


def _shown(problem: Charted) -> str:
    text = str(problem.F.P.as_matrix().tolist())
    return text if len(text) < 300 else text[:297] + "..."


def _columns(problem: Charted, member: Member, names: Sequence[Symbol], grid: list[Array]) -> list[Array]:
    """The parameters of P at the points of the grid."""
    columns = []
    for name in names:
        number, (i, j) = member[name]
        columns.append(float(number) * grid[0]**i * grid[1]**j)
    return columns


def _evaluated(problem: Charted, member: Member, collapsed: Collapsed, grid: list[Array]) -> tuple[Array, Array]:
    names = tuple(sorted(collapsed.symbols, key=str))
    columns = _columns(problem, member, names, grid)
    values, bounds, _ = Evaluator(collapsed, names)(columns)
    if values.shape[1] != len(grid[0]):  # no parameters at all
        np = numpy()
        values, bounds = (np.repeat(z, len(grid[0]), axis=1) for z in (values, bounds))
    return values, bounds


def _by_trace(problem: Charted, member: Member, grid: list[Array], *_: Any) -> tuple[Array, Array, Array]:
    np = numpy()
    values, bounds = _evaluated(problem, member, problem.F.collapsed_trace, grid)
    trace = values[0]
    error = bounds[0] + 2 * _remainder(problem, member, grid) + 2.0**-46 * (1 + abs(trace))  # the parameters' rounding
    return trace, np.where(np.isnan(trace), np.nan, 2 - abs(trace)), error


def _by_factors(problem: Charted, member: Member, grid: list[Array], *_: Any) -> tuple[Array, Array, Array]:
    """``trace = 2 + 4 B C`` from half the period: half the terms, and a far smaller remainder."""
    np = numpy()
    half = half_period(problem.F)
    values, bounds = _evaluated(problem, member, problem.F.collapse([half[0][1], half[1][0]]), grid)
    left, right = values
    with np.errstate(all="ignore"):
        down, up = _balance(problem, member, grid)
        tail = _remainder(problem, member, grid, 0.5)
        slack = [bounds[0] + tail * down, bounds[1] + tail * up]
        trace = 2 + 4 * left * right
        error = 4 * (abs(left) * slack[1] + abs(right) * slack[0] + slack[0] * slack[1]) + 2.0**-46 * (1 + abs(trace))
    return trace, np.where(np.isnan(trace), np.nan, 2 - abs(trace)), error


def _balance(problem: Charted, member: Member, grid: list[Array]) -> tuple[Array, Array]:
    """``sqrt(p12/p21)`` and its reciprocal: what the entries off the diagonal have beside ``s**k / k!``."""
    np = numpy()
    bound = _amplitudes(problem, member, grid)
    first, second = (np.maximum(z, 1e-300) for z in (bound[0, 1], bound[1, 0]))
    return np.sqrt(bound[0, 1] / second), np.sqrt(bound[1, 0] / first)


def _amplitudes(problem: Charted, member: Member, grid: list[Array]) -> Array:
    """``sup |P_ij|`` at every point: shape (size, size, points)."""
    np = numpy()
    with working(BITS):
        waves = problem.waves(member)
    bound = np.zeros((*problem.F.shape, len(grid[0])))
    for (i, j), parts in waves.items():
        bound[i, j] = sum((abs(span_at(problem, terms, grid)) for terms in parts.values()), np.zeros(len(grid[0])))
    return bound


def _of_one_signature(multipliers: Array, vectors: Array, form: Any) -> Array:
    """Whether multipliers number i and j on the circle, or i and the conjugate of j, would keep each other there.

    They do where ``i v* W v`` is definite on what their eigenvectors span (Krein), for a symplectic form W.
    """
    np = numpy()
    size = multipliers.shape[1]
    if form is None:
        return np.zeros((len(multipliers), size, size), dtype=bool)
    W = np.array([int(x.p) / int(x.q) for x in form.entries()]).reshape(size, size)
    left = 1j * vectors.conj().transpose(0, 2, 1) @ W
    grams = left @ vectors, left @ vectors.conj()
    own = np.diagonal(grams[0], axis1=1, axis2=2).real
    product = own[:, :, None] * own[:, None, :]
    alike, opposite = (sign * product > 1e-12 * abs(W).max() ** 2 + (1 + 1e-6) * abs(gram) ** 2
                       for sign, gram in zip((1, -1), grams, strict=True))
    far = abs(multipliers[:, :, None] - multipliers[:, None, :]) > abs(
        multipliers[:, :, None] - multipliers[:, None, :].conj())
    return np.where(far, opposite, alike)


def _without_one(multipliers: Array, vectors: Array) -> tuple[Array, Array]:
    """The multipliers that come in pairs, where their number is odd: all but the one next to 1, and their vectors."""
    np = numpy()
    points, size = multipliers.shape
    kept = np.arange(size) != np.argmin(abs(multipliers - 1), axis=1)[:, None]
    return multipliers[kept].reshape(points, size - 1), vectors.transpose(0, 2, 1)[kept].reshape(
        points, size - 1, size).transpose(0, 2, 1)


def _margin_of_pairs(multipliers: Array, moved: Array, of_one_signature: Array) -> tuple[Array, Array]:
    """The margin of ``rho = lambda + 1/lambda``, and its error, where multipliers may have moved so far.

    Values of rho are real or come with their conjugates.  One that may be real is, unless that of another pair is so
    near that both may be off the real line, and their signatures do not forbid it: then nothing is known.  Of a pair
    the multiplier inside the circle is left out, as its reciprocal is known better.
    """
    np = numpy()
    outer = abs(multipliers) >= 1 - moved[:, None]
    rho = multipliers + 1 / multipliers
    slack = np.where(outer, moved[:, None] * (1 + 1 / abs(multipliers) ** 2), 0)
    real = outer & (abs(rho.imag) <= slack)
    each = np.where(real, 2 - abs(rho.real), -abs(rho.imag))
    margin, error = np.where(outer, each, np.inf).min(axis=1), slack.max(axis=1)
    itself = np.eye(multipliers.shape[1], dtype=bool)
    distance = abs(multipliers[:, None, :] - 1 / multipliers[:, :, None])
    distance[:, itself] = np.inf
    others = outer[:, None, :] & ~itself & (distance > distance.min(axis=2, keepdims=True))
    near = abs(rho[:, None, :] - rho.conj()[:, :, None]) <= slack[:, None, :] + slack[:, :, None]
    unknown = (real[:, :, None] & others & near & ~of_one_signature).any(axis=(1, 2))
    error = np.where(outer.any(axis=1), error, np.inf)
    return margin, np.where(unknown & (margin > 0), np.maximum(error, margin), error)


def _remainder(problem: Charted, member: Member, grid: list[Array], part: float = 1.0) -> Array:
    """A bound of the entries of ``Phi - Phi_n`` after a part of the period: the a-priori sum.

    For second order, of the diagonal; the others have the factors of :func:`_balance` beside.
    """
    np = numpy()
    with working(BITS):
        length = part * float(problem.period) * (1 + 2.0**-40)
    bound = _amplitudes(problem, member, grid)
    if problem.F.shape == (2, 2) and not bound[0, 0].any() and not bound[1, 1].any():
        # the terms of the diagonal are s**k / k! for even k; only they enter the trace
        return _tail(np.sqrt(bound[0, 1] * bound[1, 0]) * length, problem.F.n)
    return _tail(bound.sum(axis=1).max(axis=0) * length, problem.F.n)


def _tail(z: Array, n: int) -> Array:
    """``sum over k > n of z**k / k!``, rounded up: by a table, at the next larger entry."""
    np = numpy()
    table = np.geomspace(1e-3, 60.0, 2048)  # beyond, nothing is claimed
    log_terms = np.array([k * np.log(table) - lgamma(k + 1) for k in range(n + 1, n + 401)])
    with np.errstate(over="ignore"):
        sums = np.append(np.exp(log_terms).sum(axis=0), np.inf) * (1 + 1e-9)
    return sums[np.searchsorted(table, z)]


def _by_matrix(problem: Charted, member: Member, grid: list[Array], known: Structure) -> tuple[Array, Array, Array]:
    np = numpy()
    size = problem.F.shape[0]
    values, bounds = _evaluated(problem, member, problem.F.collapsed, grid)
    matrices = values.T.reshape(-1, size, size)
    good = np.isfinite(matrices).all(axis=(1, 2))
    matrices = np.where(good[:, None, None], matrices, np.eye(size))
    multipliers, vectors = np.linalg.eig(matrices)
    with np.errstate(all="ignore"):
        condition = np.linalg.cond(vectors)
        rounding = 2.0**-48 * abs(matrices).max(axis=(1, 2))
        moved = (bounds.max(axis=0) + _remainder(problem, member, grid) + rounding) * size * np.minimum(condition, 1e8)
        if known.paired and size > 1:
            if size % 2:
                multipliers, vectors = _without_one(multipliers, vectors)
            form = known.forms[0] if known.forms else None
            margin, error = _margin_of_pairs(multipliers, moved, _of_one_signature(multipliers, vectors, form))
        else:
            margin, error = 1 - abs(multipliers).max(axis=1), moved
    trace = np.trace(matrices, axis1=1, axis2=2)
    return (np.where(good, trace, np.nan), np.where(good, margin, np.nan),
            np.where(good & np.isfinite(error), error, np.inf))


__all__ = ["chart"]
