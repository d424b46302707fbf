r"""Horner's rule in several variables as a program of one stack.

A polynomial ``sum c_m x**m`` with variables ``x_1, ..., x_v`` is a polynomial in
``x_1`` whose coefficients are polynomials in the others, so

    (... (p_e x_1**(e - f) + p_f) x_1**(f - g) + ...)

with every ``p`` written the same way.  Only monomials that occur are visited.
Written out for a stack, the same steps serve floats, arrays, pairs of arrays and
balls:

    (PUSH, i)    put coefficient i on the stack
    (PLUS, i)    add coefficient i to the top
    (TIMES, j)   multiply the top by variable j
    (ADD, 0)     add the top to the one below it
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

PUSH, PLUS, TIMES, ADD = range(4)
Exponents = tuple[int, ...]
Program = tuple[tuple[int, int], ...]


def program(exponents: Sequence[Exponents]) -> Program:
    """The steps for the monomials with these exponents, in their order; the first variable is the outermost."""
    steps: list[tuple[int, int]] = []
    if exponents:
        _append(steps, dict(zip(exponents, range(len(exponents)), strict=True)), 0)
    return tuple(steps)


def _append(steps: list[tuple[int, int]], places: dict[Exponents, int], variable: int) -> None:
    """Append the steps that leave the sum of these monomials, without the variables before ``variable``."""
    if len(places) == 1 and not any(next(iter(places))[variable:]):
        steps.append((PUSH, next(iter(places.values()))))
        return
    rows: dict[int, dict[Exponents, int]] = {}
    for m, place in places.items():
        rows.setdefault(m[variable], {})[m] = place
    degrees = sorted(rows, reverse=True)
    for e, below in zip(degrees, [*degrees[1:], 0], strict=True):
        if e == degrees[0]:
            _append(steps, rows[e], variable + 1)
        else:
            _append(steps, rows[e], variable + 1)
            steps[-1:] = [(PLUS, steps[-1][1])] if steps[-1][0] == PUSH else [steps[-1], (ADD, 0)]
        steps.extend([(TIMES, variable)] * (e - below))


def run(steps: Program, coefficients: Sequence[Any], variables: Sequence[Any]) -> Any:
    """The value where ``+`` and ``*`` are the numbers' own: floats, balls, fractions.  Nothing at all is 0."""
    stack: list[Any] = []
    for kind, i in steps:
        if kind == PUSH:
            stack.append(coefficients[i])
        elif kind == PLUS:
            stack[-1] = stack[-1] + coefficients[i]
        elif kind == TIMES:
            stack[-1] = stack[-1] * variables[i]
        else:
            top = stack.pop()
            stack[-1] = stack[-1] + top
    return stack[0] if stack else 0


def weights(steps: Program, leaf: int, times: Sequence[int]) -> list[int]:
    """How many roundings every coefficient goes through: ``leaf`` of its own, 1 a sum, ``times[j]`` a factor ``x_j``.

    Read backwards, the program tells what is still to come for the number on top of the stack.
    """
    found: dict[int, int] = {}
    ahead = [0]
    for kind, i in reversed(steps):
        if kind == TIMES:
            ahead[-1] += times[i]
        elif kind == PUSH:
            found[i] = ahead.pop() + leaf
        else:
            ahead[-1] += 1
            if kind == PLUS:
                found[i] = ahead[-1] + leaf
            else:
                ahead.append(ahead[-1])
    return [found[i] for i in range(len(found))]
