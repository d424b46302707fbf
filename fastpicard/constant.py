r"""Constant coefficients: the verdict on ``x' = A x`` without integration, exact on boundaries too.

All solutions stay bounded for ``t >= 0`` exactly if no root of the minimal polynomial ``m`` of ``A`` has a
positive real part and those on the imaginary axis are simple.  The roots of ``g = gcd(m(x), m(-x))`` are the
roots of ``m`` whose opposite is one, too: all that are on the axis, and pairs off it, of which one is on the
right.  So ``g`` may have ``x`` once, and ``G`` in ``g = x**e G(x**2)`` only negative, simple roots; the roots
of ``m/g`` are off the axis, where balls tell left from right.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flint import fmpq_poly

from fastpicard.coefficients import coefficients, dense
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import COS, NO_ANGLE
from fastpicard.precision import working
from fastpicard.stability import Verdict

_OPPOSITE = fmpq_poly([0, -1])


def constant_matrix(P: SeriesMatrix, values: Mapping[Any, Any]) -> Any:
    """The ``fmpq_mat`` that ``P`` is at these values, or None where it depends on time or has irrational entries."""
    found = {key: matrix for key, matrix in coefficients(P, values).items() if any(matrix.values())}
    constant = found.pop((COS, NO_ANGLE, ()), {})
    if found:
        return None
    return dense(constant, P.shape[0])


def by_minimal_polynomial(A: Any) -> Verdict:
    """The verdict on ``x' = A x``, ``A`` an ``fmpq_mat``; never undecided."""
    m = A.minpoly()
    where = f"P is constant there, with the minimal polynomial {m}"
    g = m.gcd(m(_OPPOSITE))
    if _right_of_axis(m // g):
        return Verdict.UNSTABLE.because(f"{where}, a root of which has a positive real part")
    if not _on_axis(g):
        return Verdict.UNSTABLE.because(f"{where}, a root of which has a positive real part or is a multiple one on "
                                        "the imaginary axis")
    return Verdict.STABLE.because(f"{where}: no root has a positive real part, and those on the imaginary axis are "
                                  "simple")


def _on_axis(g: Any) -> bool:
    """Whether all roots of ``g``, each of which has its opposite among them, are simple and on the imaginary axis."""
    coeffs = g.coeffs()
    e = next(k for k, c in enumerate(coeffs) if c != 0)
    roots: list[Any] = fmpq_poly(coeffs[e::2]).complex_roots()
    return e <= 1 and all(count == 1 and root.imag == 0 and root.real < 0 for root, count in roots)


def _right_of_axis(p: Any) -> bool:
    """Whether a root of ``p`` has a positive real part, where none is on the imaginary axis."""
    precision = 64
    while True:
        with working(precision):
            parts = [root.real for root, _ in p.complex_roots()]
        if any(x > 0 for x in parts):
            return True
        if all(x < 0 for x in parts):
            return False
        precision *= 2
