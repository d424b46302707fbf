"""Times of what SymPy sees: integrals and conversion, against SymPy in the same run.

    python benchmarks/sympy_facing.py
"""

from __future__ import annotations

import random

from sympy import Add, Expr, Matrix, Mul, Rational, cos, integrate, sin, symbols
from timing import least

from fastpicard import FundamentalMatrix, new_integrate

t, a, b = symbols("t a b")


def thousand_terms() -> Expr:
    """r <= 10, q <= 20, coefficients in a and b."""
    numbers = random.Random(1)
    seen: dict[Expr, int] = {}
    while len(seen) < 1000:
        seen[a**numbers.randint(0, 3) * b**numbers.randint(0, 3) * t**numbers.randint(0, 10)
             * numbers.choice([cos, sin])(numbers.randint(1, 20) * t)] = numbers.randint(1, 20)
    return Add(*(Rational(c, 7) * e for e, c in seen.items()))


def main() -> None:
    new_integrate(t * cos(t), t)
    expression = thousand_terms()
    print(f"new_integrate of {len(expression.args)} terms: {least(lambda: new_integrate(expression, t), 1):.3f} s")
    one = t**10 * cos(t)
    ours = least(lambda: new_integrate(one, t), 5)
    theirs = least(lambda: integrate(one, t), 1)
    print(f"t**10 cos t: {1000 * ours:.2f} ms, SymPy's integrate {theirs:.1f} s, {theirs / ours:.0f} times as long")
    entry = FundamentalMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 24)[0, 0]
    written = entry.as_expr()
    ours = least(entry.as_expr)
    theirs = least(lambda: Add(*(Mul(*term.args) for term in written.args)), 1)
    print(f"conversion of {len(written.args)} terms: {ours:.3f} s, "
          f"rebuilding them by Add and Mul {theirs / ours:.1f} times as long")


if __name__ == "__main__":
    main()
