r"""What a periodic matrix says of its multipliers before anything is computed.

With every multiplier ``lambda`` also ``1/lambda`` is one

- if a constant, regular, antisymmetric ``W`` makes ``W P(t)`` symmetric at all times (``P`` is Hamiltonian), for then
  ``Phi(T)' W Phi(T) = W``;
- if a constant, regular, symmetric ``S`` makes ``S P(t)`` antisymmetric, for then ``Phi(T)' S Phi(T) = S``.  If it is
  positive definite, as for the precession of a spin, ``x' S x`` keeps all solutions on ellipsoids;
- if time reverses, ``s P(-t) s = -P(t)`` with signs ``s`` (modules ``harmonics`` and ``halfway``);
- for one by one and two by two, if ``det Phi(T) = exp(integral of trace P) = 1`` (Liouville).

Of an odd number of multipliers in pairs one is 1, since ``det Phi(T) > 0``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import factorial
from typing import Any

from flint import fmpq, fmpq_mat

from fastpicard.coefficients import coefficients, kernel
from fastpicard.drift import drift
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import Linear


@dataclass(frozen=True)
class Structure:
    """What is known of the multipliers from ``P`` alone.

    Attributes
    ----------
    paired : bool       whether with every multiplier ``lambda`` also ``1/lambda`` is one; of an odd number one is 1
    forms : list of antisymmetric fmpq_mat ``W`` with ``Phi(T)' W Phi(T) = W``: a regular one, then a basis; or empty
    bounded : str       why all solutions are bounded; empty where that is not known
    unbounded : str     why some solution is not; the same
    """

    paired: bool
    forms: list[Any]
    bounded: str
    unbounded: str = ""


def structure(P: SeriesMatrix, values: Mapping[Any, Any], reverses: bool, moves: Callable[[Linear], bool]) -> Structure:
    """The structure of ``P`` with these values, if it reverses in time, and of a frequency whether it is not 0.

    Exact: parameters with rational values are put in, all others stay symbols, so that a form that is found holds at
    every value of those.
    """
    matrices = list(coefficients(P, values).values())
    forms = _with_a_regular_one(_invariant_forms(matrices, P.shape[0], -1))
    symmetric = _with_a_regular_one(_invariant_forms(matrices, P.shape[0], 1))
    paired = bool(forms or symmetric) or reverses or _keeps_area(P, values, moves)
    bounded, drifts = "", drift(P, values, moves)
    if drifts > 0:
        bounded = "the rates of all coordinates are waves times constants of motion"
    elif symmetric and _holds_definite(symmetric[1:]):
        bounded = "a positive definite quadratic form is constant along all solutions, so they stay on ellipsoids"
    elif paired and P.shape[0] == 1:
        bounded = "the only multiplier is 1"
    unbounded = "a coordinate grows in proportion to time: its mean rate is a constant of motion" if drifts < 0 else ""
    return Structure(paired, forms, bounded, unbounded)


def _invariant_forms(matrices: list[dict[tuple[int, int], Any]], size: int, sign: int) -> list[Any]:
    """A basis of the ``X = sign X'`` with ``X A + sign (X A)' = 0`` for all ``A``: then ``Phi' X Phi = X``.

    Antisymmetric for sign -1: ``X P`` is symmetric, ``P`` Hamiltonian.  Symmetric for sign 1: ``x' X x`` is constant.
    """
    places = [(i, j) for i in range(size) for j in range(i + (sign < 0), size)]
    vectors = kernel([_condition(A, size, places, sign) for A in matrices], len(places))
    return [_form(vector, size, places, sign) for vector in vectors]


def _with_a_regular_one(basis: list[Any]) -> list[Any]:
    """A regular combination, then the basis; nothing if none is found."""
    for attempt in range(1, 6):
        weights = [fmpq(factorial(attempt + k) % 97 + k + 1) for k in range(len(basis))]
        form = _combined(weights, basis)
        if basis and form.det() != 0:
            return [form, *basis]
    return []


def _combined(weights: list[Any], basis: list[Any]) -> Any:
    return sum((X * weight for X, weight in zip(basis, weights, strict=True)), 0 * basis[0]) if basis else None


def _holds_definite(basis: list[Any]) -> bool:
    """Whether the combination of symmetric matrices next to the identity is positive definite."""
    products = fmpq_mat([[_trace(X * Y) for Y in basis] for X in basis])
    weights = products.solve(fmpq_mat([[_trace(X)] for X in basis]))
    return is_definite(_combined(weights.entries(), basis))


def is_definite(matrix: Any) -> bool:
    """Whether the symmetric part of a matrix, exact or of balls, is positive definite, by elimination."""
    rows = ((matrix + matrix.transpose()) / 2).tolist()
    while rows:
        pivot, *rest = rows[0]
        if not pivot > 0:
            return False
        rows = [[x - row[0] * y / pivot for x, y in zip(row[1:], rest, strict=True)] for row in rows[1:]]
    return True


def _trace(X: Any) -> Any:
    return sum((X[i, i] for i in range(X.nrows())), fmpq(0))


def _keeps_area(P: SeriesMatrix, values: Mapping[Any, Any], moves: Callable[[Linear], bool]) -> bool:
    """Whether ``P`` is 2 x 2 or smaller and its trace has no mean, so that the determinant of ``Phi(T)`` is 1."""
    still = [A for (_, (q, _), _), A in coefficients(P, values).items() if not q or not moves(q)]
    return P.shape[0] <= 2 and all(A.get((0, 0), fmpq(0)) + A.get((1, 1), fmpq(0)) == 0 for A in still)


def _form(vector: list[Any], size: int, places: list[tuple[int, int]], sign: int) -> Any:
    form = fmpq_mat(size, size)
    for (i, j), x in zip(places, vector, strict=True):
        form[j, i] = sign * x
        form[i, j] = x
    return form


def _condition(A: dict[tuple[int, int], Any], size: int, places: list[tuple[int, int]], sign: int) -> list[list[Any]]:
    """The rows of ``X A + sign (X A)' = 0`` in the entries of ``X`` at these places."""
    number = {place: k for k, place in enumerate(places)}
    rows: dict[tuple[int, int], list[Any]] = {place: [fmpq(0)] * len(places) for place in places}
    for (k, j), value in A.items():
        for i in range(size):
            source, target = (min(i, k), max(i, k)), (min(i, j), max(i, j))
            if source in number and target in number:  # what is missing vanishes: diagonals of antisymmetric matrices
                turned = (i > k) + (i > j)
                rows[target][number[source]] += value * sign**turned
    return list(rows.values())
