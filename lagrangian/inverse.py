r"""The inverse of a mass matrix that holds more than rationals, computed where equal numbers are equal.

Roots of rationals are elements of one algebraic field; every other number, and every entry with symbols, is a variable
over it.  With variables the inverse is the cofactors over the determinant, which need no division:

    A**-1 = adj(A) / det(A),    entries of A in Q(sqrt(2), ...)[pi, ...]

Numbers that satisfy an equation unknown here, such as cos(1) and sin(1), only miss a simplification as variables: A is
positive definite, so the determinant is not 0 at their values.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from sympy import QQ, Dummy, Expr, Pow, default_sort_key
from sympy.polys.constructor import construct_domain
from sympy.polys.matrices import DomainMatrix

__all__ = ["inverse"]

LARGEST_DEGREE = 8  # of the algebraic field: arithmetic in large ones is slower than with variables


def inverse(A: Any) -> Any:
    """``A**-1`` for a symmetric positive definite A, shape (N, N); exact."""
    if all(entry.is_Rational for entry in A):
        return A.to_DM(field=True).inv().to_Matrix()
    roots = _roots(A)
    atoms = {x for entry in A for x in (_atoms(entry, roots) if entry.is_number else [entry])}
    names = {x: Dummy() for x in sorted(atoms.difference(roots), key=default_sort_key)}
    meanings = {name: x for x, name in names.items()}
    numbers, known = construct_domain(roots, extension=True) if roots else (QQ, [])
    ring = numbers[tuple(meanings)] if names else numbers
    values = {x: ring.from_sympy(name) for x, name in names.items()}
    values |= {x: ring.convert_from(element, numbers) for x, element in zip(roots, known, strict=True)}
    rows = [[_element(entry, values, ring) for entry in row] for row in A.tolist()]
    matrix = DomainMatrix(rows, A.shape, ring)
    if not names:
        return matrix.inv().to_Matrix()
    adjugate, determinant = matrix.adj_det()
    return adjugate.to_Matrix().xreplace(meanings) / ring.to_sympy(determinant).xreplace(meanings)


def _roots(A: Any) -> list[Any]:
    """The roots of rationals in A's numbers, if their field is small."""
    powers = {x for entry in A if entry.is_number for x in entry.atoms(Pow)}
    roots = sorted((x for x in powers if x.base.is_Rational and x.exp.is_Rational), key=default_sort_key)
    return roots if math.prod(int(x.exp.q) for x in roots) <= LARGEST_DEGREE else []


def _whole_power(x: Expr) -> tuple[Any, int]:
    """``base, n`` with ``x = base**n``; ``exp(2)`` is E**2."""
    base, exponent = x.as_base_exp()
    return (base, int(exponent)) if exponent.is_Integer else (x, 1)


def _atoms(x: Expr, roots: Collection[Expr]) -> Iterator[Expr]:
    """The parts of a number that sums, products and quotients of rationals and ``roots`` do not explain, and roots."""
    base, n = _whole_power(x)
    if base.is_Rational:
        return
    parts = [y for part in base.args for y in _atoms(part, roots)] if base.is_Add or base.is_Mul else [base]
    yield from parts if n > 0 or all(part in roots for part in parts) else [x]


def _element(x: Expr, values: Mapping[Expr, Any], ring: Any) -> Any:
    """``x`` in ``ring``, where ``values`` are the elements of its atoms."""
    if x in values:
        return values[x]
    if x.is_Rational:
        return ring.from_sympy(x)
    base, n = _whole_power(x)
    if n != 1:
        power = _element(base, values, ring) ** abs(n)
        return power if n > 0 else ring.exquo(ring.one, power)
    parts = [_element(part, values, ring) for part in x.args]
    return sum(parts, ring.zero) if x.is_Add else math.prod(parts, start=ring.one)
