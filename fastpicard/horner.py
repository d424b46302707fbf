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
    _append(steps, [([(j, e) for j, e in enumerate(m) if e], place) for place, m in enumerate(exponents)])
    return tuple(steps)


def _append(steps: list[tuple[int, int]], terms: list[tuple[list[tuple[int, int]], int]]) -> None:
    """Append the steps that leave the sum of these monomials, given as lists of (variable, exponent)."""
    rows: dict[int, dict[int, list[Any]]] = {}
    constants = []
    for m, place in terms:
        if m:
            rows.setdefault(m[0][0], {}).setdefault(m[0][1], []).append((m[1:], place))
        else:
            constants.append(place)
    for count, variable in enumerate(sorted(rows)):
        degrees = sorted(rows[variable], reverse=True)
        for e, below in zip(degrees, [*degrees[1:], 0], strict=True):
            _append(steps, rows[variable][e])
            if e != degrees[0]:
                steps[-1:] = [(PLUS, steps[-1][1])] if steps[-1][0] == PUSH else [steps[-1], (ADD, 0)]
            steps.extend([(TIMES, variable)] * (e - below))
        if count:
            steps.append((ADD, 0))
    steps.extend([(PLUS if rows else PUSH, place) for place in constants])


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
