"""What a number from an exact iterate is worth: term by term, collapsed, in pairs, and with digits asked for.

At (a, b) = (2.5, 1.5), t = 1/2 and n = 40 the terms of Mathieu's iterate exceed
their sum by 1e20, so evaluating them one by one in float64 leaves nothing.  The
same iterate is right to the last digit when asked for its value.  The picture is
``docs/images/accuracy.png``.

    python examples/05_accuracy.py --table      # and docs/accuracy_table.txt, with n = 120: some minutes
"""

import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import mpmath
import numpy as np
from sympy import Add, Matrix, Rational, cos, lambdify, pi, symbols

from fastpicard import FloquetMatrix, FundamentalMatrix, PoissonSeries
from fastpicard.collapsed import Collapsed
from fastpicard.vectorise import Evaluator, values_of

a, b, t = symbols("a b t")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])
POINT = {a: Rational(5, 2), b: Rational(3, 2)}
TABLE = Path(__file__).parent.parent / "docs" / "accuracy_table.txt"
PICTURE = Path(__file__).parent.parent / "docs" / "images" / "accuracy.png"


def main() -> None:
    print("Phi_n[0, 0] at t = 1/2, (a, b) = (2.5, 1.5)")
    print(f"{'n':>4} {'term by term, float64':>24} {'evaluate()':>22} {'evaluate(digits=30)':>36}")
    errors = [row(n) for n in range(5, 31, 5)]
    collapsed()
    draw(*zip(*errors, strict=True))


def row(n: int) -> tuple[int, float, float]:
    """The order, and the relative errors of both floats."""
    X = FundamentalMatrix(P, t, n)
    naive = sum(lambdify([t, a, b], list(X[0, 0].as_expr().args))(0.5, 2.5, 1.5))
    value, exact = X[0, 0].evaluate(0.5, POINT), X[0, 0].evaluate(Rational(1, 2), POINT, 30)
    print(f"{n:4} {naive:24.15g} {value:22.15g} {mpmath.nstr(exact, 30):>36}")
    with mpmath.workdps(30):
        return n, float(abs(naive / exact - 1)), float(abs(value / exact - 1))


def draw(orders: tuple[int, ...], naive: tuple[float, ...], exact: tuple[float, ...]) -> None:
    """Errors of both against the order."""
    figure, axes = plt.subplots(figsize=(8, 4.5), constrained_layout=True)
    axes.semilogy(orders, naive, "o-", color="tab:red", label="the terms one by one in float64")
    axes.semilogy(orders, exact, "o-", color="k", label="evaluate()")
    axes.axhline(2.0**-53, color="0.7", label="half a unit of the last place")
    axes.set(xlabel="order n of the iterate", ylabel="relative error of its value",
             title="The same exact iterate in numbers: Phi_n[0, 0] at t = 1/2, (a, b) = (2.5, 1.5)")
    axes.legend(loc="upper left", fontsize=9)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)
    print(f"picture: {PICTURE.relative_to(PICTURE.parent.parent.parent)}")


def collapsed() -> None:
    """The period is different: exact cancellation first leaves a harmless polynomial."""
    print("\ntrace of Phi_n(2 pi) at (2.5, 1.5): the vectorised function against thirty digits")
    for n in (20, 40, 60):
        F = FloquetMatrix(P, t, n)
        fast, exact = F.lambdify_trace([a, b])(2.5, 1.5), F.trace_at(POINT, 30)
        error = float(abs(fast / exact - 1))
        print(f"n = {n}: {float(fast):.15f}  {mpmath.nstr(exact, 30)}  relative error {error:.0e}")
    points = np.random.default_rng(1).uniform(-1, 1, (2, 1000))
    values = F.lambdify_trace([a, b])(*points)
    print(f"a thousand points at once: shape {values.shape}, {np.count_nonzero(np.abs(values) < 2)} of them stable")


# -- digits lost ---------------------------------------------------------------

AT_THE_PERIOD = [  # order, a, b
    (20, "-0.1", "0.55"), (20, "2.25", "0.1"), (20, "100", "1"), (20, "10000", "1000"), (50, "0.1", "0.1"),
    (50, "2.5", "1.5"), (50, "4", "0.5"), (50, "10", "3"), (50, "1e-300", "1e-300"), (50, "10000", "1000"),
    (120, "2.5", "1.5"), (120, "20", "5"), (120, "45", "1"), (120, "10000", "1000"),
]
AT_OTHER_TIMES = [  # order, a, b, time in periods
    (10, "2.5", "1.5", "0.01"), (10, "2.5", "1.5", "1/4"), (20, "2.5", "1.5", "0.01"), (20, "2.5", "1.5", "1/4"),
    (20, "2.5", "1.5", "-3/4"), (20, "0.01", "0.002", "1/4"), (20, "0.001", "0.0002", "10"),
    (20, "1e-8", "1e-8", "1000"), (20, "2.5", "1.5", "1000"), (20, "2.5", "1.5", "-1000"), (30, "2.5", "1.5", "1/4"),
]


def lost(value: float, exact: mpmath.mpf) -> str:
    """How many of the sixteen digits are wrong."""
    with mpmath.workdps(60):
        error = abs(mpmath.mpf(float(value)) / exact - 1)
        wrong = float(mpmath.log10(error)) + 53 * math.log10(2) if error else 0.0
    return "all" if not wrong < 15.95 else f"{max(wrong, 0):.1f}"


def cells(expression: object, x: str, y: str) -> list[str]:
    """Condition, digits lost by four routes and the route that ``lambdify`` takes, for an exact polynomial in a, b."""
    at = {a: Rational(float(x)), b: Rational(float(y))}
    constants = Collapsed([PoissonSeries(expression, t).modes], t)
    exact = constants.at(at, 50)[0]
    terms = [float(v) for v in lambdify([a, b], list(Add.make_args(expression)))(float(x), float(y))]
    evaluator = Evaluator(constants, (a, b))
    columns = [np.array([float(x)]), np.array([float(y)])]
    (polynomial,), given = evaluator.polynomials, dict(zip((a, b), columns, strict=True))
    unscaled = values_of(constants.variables, given, constants.time)
    variables = [v.scaled(s) for v, s in zip(unscaled, evaluator.scales, strict=True)]
    with np.errstate(all="ignore"):
        plain, (r, e) = polynomial.floats(variables, 1), polynomial.pairs(variables, 1)
        values, bounds, route = evaluator(columns)
        condition = math.log10(sum(map(abs, terms)) / abs(float(exact)))
        inside = all(v.inside(evaluator.limit).all() for v in variables)
    assert abs(mpmath.mpf(float(values[0, 0])) - exact) <= bounds[0, 0] <= 10 * np.spacing(abs(values[0, 0]))
    return [f"{condition:.0f}", lost(sum(terms), exact), lost(plain[0], exact) if inside else "range",
            lost((r + e)[0], exact) if inside else "range", lost(constants.at(at, None)[0], exact),
            ("float64", "pairs", "balls")[route[0]]]


HEADS = ["log10 cond", "term by term", "collapsed", "pairs", "balls", "lambdify takes"]


def write_table() -> None:
    """Both tables for the page on accuracy."""
    last, rows = 0, []
    for n, x, y in AT_THE_PERIOD:
        if n != last:
            trace, last = FloquetMatrix(P, t, n).trace(), n
        rows.append([str(n), x, y, *cells(trace, x, y)])
        print("  ".join(rows[-1]), flush=True)
    text = listed("The trace after one period", ["n", "a", "b", *HEADS], rows)
    last, rows = 0, []
    for n, x, y, turns in AT_OTHER_TIMES:
        if n != last:
            entry, last = FundamentalMatrix(P, t, n)[0, 0], n
        at_time = entry(2 * pi * Rational(turns))
        rows.append([str(n), x, y, turns, *cells(at_time, x, y)])
        print("  ".join(rows[-1]), flush=True)
    text += listed("The first entry at other times, counted in periods", ["n", "a", "b", "time", *HEADS], rows)
    TABLE.write_text(f".. Written by {Path(__file__).parent.name}/{Path(__file__).name} --table.\n\n{text}")


def listed(title: str, heads: list[str], rows: list[list[str]]) -> str:
    """A table as reStructuredText."""
    lines = [f".. list-table:: {title}: digits lost of sixteen", "   :header-rows: 1", ""]
    for row_of in [heads, *rows]:
        lines += [f"   {'*' if i == 0 else ' '} - {cell}" for i, cell in enumerate(row_of)]
    return "\n".join(lines) + "\n\n"


if __name__ == "__main__":
    main()
    if "--table" in sys.argv:
        write_table()
