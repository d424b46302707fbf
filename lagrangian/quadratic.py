r"""The modes of one or two rods in radicals: ``mu`` and the columns u of U with ``B u = mu A u``, symbols allowed.

For two rods ``det(B - mu A) = 0`` is a quadratic equation, ``mu = half -+ sqrt(D)``, and u is the kernel of the
singular ``G = B - mu A``,

    u = (-G12/G11, 1),   or (0, 1) where G12 = 0, or (1, 0) where G11 = 0 too.

G12 is 0 only where ``mu = B12/A12``, or ``A12 = B12 = 0``: then mu is rational in the quantities of the rods, and D is
the square of such a function.  That function, of either sign, is taken for its root: Symbols leave the sign of
``sqrt(x**2)`` open, and with it for which mu G12 is 0.
"""

from __future__ import annotations

from math import prod
from typing import Any

from sympy import ImmutableDenseMatrix, Integer, Poly, Rational, cancel, expand, prime, radsimp, sqrt

__all__ = ["modes_in_radicals"]


def modes_in_radicals(A: Any, B: Any) -> tuple[tuple[Any, ...], Any]:
    """``mu``, ascending where they are numbers, and U of shape (n, n), A-orthogonal, for n <= 2."""
    if A.rows == 1:
        return (cancel(B[0] / A[0]),), ImmutableDenseMatrix([[1]])
    if _vanishes(A[0, 1]) and _vanishes(B[0, 1]):
        return _apart([cancel(B[k, k] / A[k, k]) for k in (0, 1)])
    determinant = A[0, 0] * A[1, 1] - A[0, 1] ** 2
    half = cancel((A[1, 1] * B[0, 0] + A[0, 0] * B[1, 1] - 2 * A[0, 1] * B[0, 1]) / (2 * determinant))
    square = cancel(half**2 - (B[0, 0] * B[1, 1] - B[0, 1] ** 2) / determinant)
    if _vanishes(square):
        return (half, half), ImmutableDenseMatrix([[1, -A[0, 1] / A[0, 0]], [0, 1]])
    root = _root(square)
    if root is None:
        mu = half - sqrt(square), half + sqrt(square)
    else:
        mu = cancel(half - root), cancel(half + root)
    columns = [_kernel(B - x * A, rational=root is not None) for x in mu]
    return mu, ImmutableDenseMatrix([[u[k] for u in columns] for k in (0, 1)])


def _apart(mu: list[Any]) -> tuple[tuple[Any, ...], Any]:
    """Of two rods that do not act on each other: each is a mode."""
    if all(x.is_number for x in mu) and mu[0].evalf() > mu[1].evalf():
        return (mu[1], mu[0]), ImmutableDenseMatrix([[0, 1], [1, 0]])
    return (mu[0], mu[1]), ImmutableDenseMatrix([[1, 0], [0, 1]])


def _root(square: Any) -> Any:
    """The root of what holds Symbols, if it is a rational function of them; else None."""
    if not square.free_symbols:
        return None
    roots = []
    for part in map(expand, square.as_numer_denom()):
        number, factors = Poly(part, extension=True).sqf_list() if part.free_symbols else (part, [])
        if any(f.free_symbols and k % 2 for f, k in factors):
            return None
        roots.append(prod([f.as_expr() ** Rational(k, 2) for f, k in factors], start=sqrt(number)))
    return roots[0] / roots[1]


def _kernel(G: Any, rational: bool) -> tuple[Any, Any]:
    """A vector with ``G u = 0`` for a symmetric singular G that is not 0, its last component 1 where it can be."""
    p, q = expand(G[0, 0]), expand(G[0, 1])
    if _vanishes(q):
        return (Integer(1), Integer(0)) if _vanishes(p) else (Integer(0), Integer(1))
    ratio = cancel(-q / p) if rational else -q / p
    return (expand(radsimp(ratio)) if ratio.is_number else ratio), Integer(1)


def _vanishes(x: Any) -> bool:
    """Whether x is 0, to a hundred digits, with a ratio of primes for every Symbol."""
    at = {symbol: Rational(prime(k + 20), prime(k + 5)) for k, symbol in enumerate(sorted(x.free_symbols, key=str))}
    value = x.xreplace(at).evalf()
    return all(part == 0 or part._prec == 1 for part in value.as_real_imag())
