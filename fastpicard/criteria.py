r"""Which signs prove stability, which prove instability.

Every criterion is a list of functions of the chart's variables, given as Taylor models, and a rule that turns their
signs (1, -1, or 0 for not known) into a verdict.

**One degree of freedom, reversible**: ``trace - 2 = 4 B C``, ``trace + 2 = 4 A D`` (module ``halfway``).
Stable if ``B C < 0 < A D``, unstable if ``B C > 0`` or ``A D < 0``.

**N degrees of freedom, multipliers in pairs**: with the power sums of ``rho = lambda + 1/lambda`` Hermite's two
matrices (module ``determinants``) are positive definite exactly if all rho are real, distinct and in (-2, 2): stable,
all multipliers simple on the circle.  If a principal minor is negative, some rho is not in [-2, 2]: unstable.
``p(2)`` and ``(-1)**N p(-2)`` are products of ``2 - rho`` and ``2 + rho``: negative, and some rho is outside.
Of an odd number of multipliers one is 1, and is left out; where no rho is 2, it is simple.

**What the equation says by itself** (module ``structure``): where a positive definite quadratic form is constant along
all solutions, all is stable; where a coordinate grows in proportion to time, unstable.

**Coinciding multipliers** of one signature do no harm: with ``W`` from the Hamiltonian structure the form
``W (M - 1/M)`` is invariant; definite, it proves stability.

**Any other P**: of two multipliers the determinant and the characteristic polynomial at 1 and -1; of more, Schur and
Cohn without division.  The polynomial ``a`` of degree n has all roots inside the unit
circle exactly if ``a_n**2 - a_0**2 > 0`` and ``(a_n a(z) - a_0 z**n a(1/z))/z`` has; a step with
``a_n**2 - a_0**2 < 0`` has a root outside.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from flint import fmpq

from fastpicard.determinants import determinant, hermite, hermite_from_zero, power_sums, product, sums_of_rho, trace
from fastpicard.evaluate import numpy
from fastpicard.floquet import FloquetMatrix
from fastpicard.halfway import Signs, known_structure, reversal
from fastpicard.taylormodels import UNIT, Models

Array = Any
Rows = list[list[Any]]


@dataclass(frozen=True)
class Criterion:
    """What to compute from the Floquet matrix, and what its signs mean.

    Attributes
    ----------
    name : str
    half : bool                     whether the entries are those at half the period, or at the whole one
    functions : from the entries as models, shape (rows, rows), and the determinant, to a list of models
    verdicts : from signs, shape (functions, m), to 1, -1 or 0, shape (m,)
    everywhere : 1, -1 or 0         the verdict on all by the structure alone, if it has one
    """

    name: str
    half: bool
    functions: Callable[[Rows, Models], list[Models]]
    verdicts: Callable[[Array], Array]
    everywhere: int = 0


def criterion(F: FloquetMatrix) -> Criterion:
    """The sharpest criterion for the structure of the equation."""
    size, signs, known = F.shape[0], reversal(F.P), known_structure(F)
    if known.bounded or known.unbounded:
        return Criterion(known.bounded or known.unbounded, False, lambda rows, det: [], _all_positive,
                         everywhere=1 if known.bounded else -1)
    balanced = signs is not None and 2 * signs.count(1) == size
    if known.paired and balanced and size == 2:
        return Criterion("half-period factors of trace -+ 2", True, _flat, _by_factors)
    if known.paired and size == 2:
        return Criterion("trace", False, _by_trace, _all_positive)
    if known.paired and balanced and known.forms and signs is not None:
        return _reversible(signs, known.forms[0])
    if known.paired:
        return _paired(size)
    if size == 2:
        return Criterion("trace and determinant", False, _by_determinant, _all_positive)
    return Criterion("Schur and Cohn", False, _schur_cohn, _strictly_inside)


def _flat(rows: Rows, det: Models) -> list[Models]:
    return [x for row in rows for x in row]


def _by_trace(rows: Rows, det: Models) -> list[Models]:
    total = trace(rows)
    return [total * -1 + 2.0, total + 2.0]


def _by_determinant(rows: Rows, det: Models) -> list[Models]:
    """``1 - det`` and the characteristic polynomial at 1 and -1: all positive exactly if both roots are inside."""
    total = trace(rows)
    return [det * -1 + 1.0, det + 1.0 - total, det + 1.0 + total]


def _by_factors(signs: Array) -> Array:
    """Signs of A, B, C, D."""
    np = numpy()
    below, above = signs[1] * signs[2], signs[0] * signs[3]
    return np.where((below > 0) | (above < 0), -1, np.where((below < 0) & (above > 0), 1, 0))


def _all_positive(signs: Array) -> Array:
    np = numpy()
    return np.where((signs < 0).any(axis=0), -1, np.where((signs > 0).all(axis=0), 1, 0))


def _strictly_inside(signs: Array) -> Array:
    """The first sign that is not positive decides."""
    np = numpy()
    result = np.ones(signs.shape[1], dtype=int)
    for row in signs:
        result = np.where(result == 1, np.where(row > 0, 1, np.where(row < 0, -1, 0)), result)
    return result


# -- N degrees of freedom ------------------------------------------------------


def _reversible(signs: Signs, form: Any) -> Criterion:
    """With ``X**-1 = W**-1 X' W = [[a, b], [c, d]]``: ``M = [[a A - b C, a B - b D], [d C - c A, ...]]``,
    ``M - 1 = [[-2 b C, .]]``, ``M + 1 = [[2 a A, .]]``, so ``p(2) = det(4 b C)`` and ``(-1)**N p(-2) = det(4 a A)``,
    the ``sigma = 2 - rho`` are the eigenvalues of ``4 b C``, and the ``2 + rho`` those of ``4 a A``.  Where these are
    real and not negative, so are their elementary symmetric functions.

    ``M - 1/M`` has the blocks ``2 M12`` and ``2 M21`` off the diagonal, and of W only the blocks off the diagonal are
    taken, which are an invariant form by themselves.
    """
    size, n = len(signs), len(signs) // 2
    plus, minus = ([i for i in range(size) if signs[i] == s] for s in (1, -1))
    inverse = form.inv()

    def functions(rows: Rows, det: Models) -> list[Models]:
        back = _weighted(inverse, _weighted(form.transpose(), rows, True), False)
        (A, B), (C, D) = ([_block(rows, i, j) for j in (plus, minus)] for i in (plus, minus))
        (a, b), (c, d) = ([_block(back, i, j) for j in (plus, minus)] for i in (plus, minus))
        sigma = [[x * 4.0 for x in row] for row in product(b, C)]
        M12, M21 = _difference(product(a, B), product(b, D)), _difference(product(d, C), product(c, A))
        sums = power_sums(sigma, 2 * n)
        first, second = _models(hermite(sums, n, False), sums[0]), hermite_from_zero(sums, n)
        minors = [_minor(first, k) for k in range(2, n + 1)] + [_minor(second, k) for k in range(1, n)]
        forms = [_minor(_weighted_block(form, i, j, X), k)
                 for i, j, X in ((plus, minus, M21), (minus, plus, M12)) for k in range(1, n + 1)]
        tau = [[x * 4.0 for x in row] for row in product(a, A)]
        symmetric = _elementary(sums[:n - 1]) + _elementary(power_sums(tau, n - 1))
        return [determinant(b), determinant(C), determinant(a), determinant(A), *minors, *forms, *symmetric]

    def verdicts(found: Array) -> Array:
        np = numpy()
        below, above, minors = found[0] * found[1], found[2] * found[3], found[4:2 + 2 * n]
        forms, symmetric = found[2 + 2 * n:2 + 4 * n], found[2 + 4 * n:]
        bad = (below < 0) | (above < 0) | (minors < 0).any(axis=0) | (symmetric < 0).any(axis=0)
        good = (below > 0) & (above > 0) & (minors > 0).all(axis=0)
        one, other = _definite(forms[:n]), _definite(forms[n:])
        good |= (one != 0) & (one == other)
        return np.where(bad, -1, np.where(good, 1, 0))

    return Criterion("half-period factors, Hermite's minors, invariant form", True, functions, verdicts)


def _elementary(sums: list[Any]) -> list[Any]:
    """The elementary symmetric functions ``e_1, e_2, ...`` from power sums (Newton)."""
    e = list(sums[:1])
    for k in range(2, len(sums) + 1):
        total = sums[k - 1] * (1.0 if k % 2 else -1.0)
        for j in range(1, k):
            total = total + e[k - j - 1] * sums[j - 1] * (1.0 if j % 2 else -1.0)
        e.append(times(total, fmpq(1, k)))
    return e


def _paired(size: int) -> Criterion:
    n = size // 2

    def functions(rows: Rows, det: Models) -> list[Models]:
        traces = power_sums(rows, 2 * n)
        if size % 2:
            traces = [x + -1.0 for x in traces]  # one of the multipliers is 1
        sums = sums_of_rho(traces, 2 * n, 2 * n)
        first, second = (_models(hermite(sums, n, beyond), sums[0]) for beyond in (False, True))
        return [_minor(first, k) for k in range(2, n + 1)] + [_minor(second, k) for k in range(1, n + 1)]

    return Criterion("Hermite's minors", False, functions, _all_positive)


def _definite(minors: Array) -> Array:
    """1 for positive definite, -1 for negative definite, 0 for not known, from the signs of leading minors."""
    np = numpy()
    alternating = np.array([(-1) ** (k + 1) for k in range(len(minors))])[:, None]
    return np.where((minors > 0).all(axis=0), 1, np.where((minors * alternating > 0).all(axis=0), -1, 0))


def _minor(rows: Rows, k: int) -> Models:
    result: Models = determinant([row[:k] for row in rows[:k]])
    return result


def _models(rows: Rows, like: Models) -> Rows:
    return [[like * 0.0 + float(x) if isinstance(x, int) else x for x in row] for row in rows]


def _block(rows: Rows, i: list[int], j: list[int]) -> Rows:
    return [[rows[k][l] for l in j] for k in i]


def _difference(left: Rows, right: Rows) -> Rows:
    return [[x - y for x, y in zip(*pair, strict=True)] for pair in zip(left, right, strict=True)]


def _weighted(weights: Any, rows: Rows, transposed: bool) -> Rows:
    """``weights @ rows``, or ``(weights @ rows)'``, for a matrix of rationals."""
    size = len(rows)
    result = [[_combination([weights[i, k] for k in range(size)], [rows[k][j] for k in range(size)])
               for j in range(size)] for i in range(size)]
    return [list(column) for column in zip(*result, strict=True)] if transposed else result


def _weighted_block(weights: Any, i: list[int], j: list[int], rows: Rows) -> Rows:
    return [[_combination([weights[k, l] for l in j], [row[m] for row in rows]) for m in range(len(rows[0]))]
            for k in i]


def _combination(weights: list[Any], models: list[Models]) -> Models:
    total = None
    for q, model in zip(weights, models, strict=True):
        if q != 0:
            term = times(model, q)
            total = term if total is None else total + term
    return models[0] * 0.0 if total is None else total


def times(model: Models, q: Any) -> Models:
    """A model times a rational number."""
    result = model * (float(q.p) / float(q.q))
    result.e = result.e + 4 * UNIT * result.norm()  # the quotient is rounded once, numerator and denominator too
    return result


# -- any matrix ----------------------------------------------------------------


def _schur_cohn(rows: Rows, det: Models) -> list[Models]:
    n = len(rows)
    sums, a = power_sums(rows, n - 1), [rows[0][0] * 0.0 + 1.0]
    for k in range(1, n):  # Newton's identities, from the leading coefficient down
        total = sums[k - 1]
        for j in range(1, k):
            total = total + a[j] * sums[k - j - 1]
        a.append(times(total, fmpq(-1, k)))
    a.append(det * (-1) ** n)
    a.reverse()
    found = []
    while len(a) > 1:
        a = [a[-1] * x - a[0] * y for x, y in zip(a[1:], reversed(a[:-1]), strict=True)]
        found.append(a[-1])
    return found
