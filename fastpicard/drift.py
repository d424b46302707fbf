r"""Coordinates whose rates are constants of motion times waves: they stay bounded, or grow in proportion to time.

``v x`` is constant along all solutions if ``v P(t) = 0``.  If ``w P(t)`` is at all times a combination of such ``v``,

    d/dt (w x) = sum over k of f_k(t) v_k x(0),        f_k trigonometric polynomials,

and ``w x`` is bounded where no ``f_k`` has a mean, and grows without bound for some ``x(0)`` where one has.  So does
the center of mass of what is free to move.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from flint import fmpq_mat

from fastpicard.coefficients import coefficients, dense, kernel
from fastpicard.matrix import SeriesMatrix
from fastpicard.modes import COS, NO_ANGLE, Linear


def drift(P: SeriesMatrix, values: Mapping[Any, Any], moves: Callable[[Linear], bool]) -> int:
    """1 if all solutions stay bounded, as every coordinate is such a ``w x``; -1 if one grows; 0 if neither is known.

    Parameters as those of :func:`fastpicard.structure.structure`.
    """
    size, found = P.shape[0], coefficients(P, values)
    waves, still = [], []  # what has no mean whatever the values; what may have one
    mean = dense({}, size)
    for (kind, angle, monomial), entries in found.items():
        A = dense(entries, size)
        if angle[0] and moves(angle[0]):
            waves.append(A)
        elif (kind, angle, monomial) == (COS, NO_ANGLE, ()):
            mean = A
        else:
            still.append(A)
    matrices = [*waves, *still, mean]
    constants = kernel([A.transpose().tolist() for A in matrices], size)
    others = [fmpq_mat(size, 1, x) for x in kernel([constants], size)]  # on which all constants vanish
    onto = [(A * x).entries() for A in matrices for x in others]
    linear = kernel([onto, *(A.transpose().tolist() for A in still)], size)
    if any(any((fmpq_mat(1, size, w) * mean).entries()) for w in linear):
        return -1
    return 1 if len(linear) == size else 0
