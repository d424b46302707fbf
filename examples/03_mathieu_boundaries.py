"""Stability boundaries of Mathieu's equation: the iterate's, the article's and the true ones (Out[26] to Out[29]).

The boundaries of ``y'' + (a + b cos t) y = 0`` at a given ``b`` are the real ``a``
where the trace of the Floquet matrix is +-2.  Twenty iterates cannot see the
seventh below ``a = 2.5``, which the article's list leaves out; forty can.
"""

import mpmath
from sympy import Matrix, Poly, Rational, cos, pi, symbols

from fastpicard import FloquetMatrix, mathieu_a, mathieu_b

ARTICLE = {Rational(1, 10): (-0.00497832, 0.198781, 0.298719, 0.993783, 1.01023, 2.2429),
           Rational(3, 2): (-0.708598, -0.696345, 0.62976, 0.81923, 1.51241, 2.3711)}
a, b, t = symbols("a b t")


def main() -> None:
    P = Matrix([[0, 1], [-a - b * cos(t), 0]])
    for value, printed in ARTICLE.items():
        columns = {f"n = {n}": roots(FloquetMatrix(P, t, n), value) for n in (20, 40)}
        columns["article"] = [f"{x:.8g}" for x in printed]
        columns["true"] = true_boundaries(value)
        print(f"\nb = {value}")
        print("  ".join(f"{name:>14}" for name in columns))
        for row in range(max(map(len, columns.values()))):
            print("  ".join(f"{column[row] if row < len(column) else '-':>14}" for column in columns.values()))


def roots(F: FloquetMatrix, value: Rational) -> list[str]:
    """The real roots of trace = +-2 up to a = 2.6, from the exact polynomial."""
    found = []
    with mpmath.workdps(60):
        for level in (2, -2):
            coefficients = Poly(F.trace().subs(b, value) - level, a).all_coeffs()
            numbers = [mpmath.mpf(c.subs(pi, pi.evalf(60))) for c in coefficients]
            found += [x.real for x in mpmath.polyroots(numbers, maxsteps=500, extraprec=400)
                      if abs(mpmath.im(x)) < 1e-25 and mpmath.re(x) < 2.6]
    return [mpmath.nstr(x, 10) for x in sorted(found)]


def true_boundaries(value: Rational) -> list[str]:
    """``a_r(-2b)/4`` and ``b_r(-2b)/4``, proved digits."""
    q = -2 * value
    numbers = [mathieu_a(r, q, 20) / 4 for r in range(4)] + [mathieu_b(r, q, 20) / 4 for r in range(1, 4)]
    return [mpmath.nstr(x, 10) for x in sorted(numbers)]


if __name__ == "__main__":
    main()
