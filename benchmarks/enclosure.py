"""Enclosures of the true Floquet matrix, beside what finds the same digits without proof: mpmath's Taylor integrator.

``python benchmarks/enclosure.py`` prints milliseconds of processor time for a point, the least of three runs, and the
ratio to ``mpmath.odefun`` (two columns over one period, 30 digits) in the same run.
"""

import random
import time

import mpmath
from sympy import Matrix, Rational, cos, symbols
from timing import least

from fastpicard import FloquetMatrix, tabulate
from fastpicard.mathieu import mathieu_a_enclosure

a, b, t = symbols("a b t")
F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 20)


def milliseconds(function, *arguments, repeats=3):
    """The least processor time of a few calls."""
    return 1e3 * least(lambda: function(*arguments), repeats)


def points(count, sizes, seed=1):
    """Random exact points with |a| and |b| up to the sizes."""
    draw = random.Random(seed)
    return [{s: Rational(draw.randint(-1000, 1000), 1000) * size for s, size in zip((a, b), sizes, strict=True)}
            for _ in range(count)]


def by_odefun(values, digits=30):
    """Both columns by mpmath.odefun."""
    with mpmath.workdps(digits + 5):
        x, y = (mpmath.mpf(values[s].p) / values[s].q for s in (a, b))
        for start in ([1, 0], [0, 1]):
            f = mpmath.odefun(lambda s, u: [u[1], -(x + y * mpmath.cos(s)) * u[0]], 0, start)
            f(2 * mpmath.pi)


def enclose(places, digits):
    """An enclosure at every point."""
    for values in places:
        F.enclosure(values, digits)


def main():
    box = points(30, (Rational(5, 2), Rational(3, 2)))
    ours = milliseconds(enclose, box, 30) / len(box)
    theirs = milliseconds(by_odefun, box[0], repeats=1)
    print(f"enclosure, 30 digits, |a| <= 2.5, |b| <= 1.5: {ours:.2f} ms a point; "
          f"mpmath.odefun, no bound: {theirs:.0f} ms, {theirs / ours:.0f} times as long")
    start = time.process_time()
    table = tabulate(F, {a: (Rational(-5, 2), Rational(5, 2)), b: (Rational(-3, 2), Rational(3, 2))}, 30)
    build = time.process_time() - start
    looked_up = milliseconds(lambda: [table.enclosure(v, 30) for v in box]) / len(box)
    print(f"the same from a table: {looked_up:.2f} ms a point, {ours / looked_up:.1f} times as fast, after "
          f"{build:.1f} s once, as long as {1e3 * build / (ours - looked_up):.0f} points take")
    for digits in (15, 100, 1000):
        some = box[:5 if digits < 1000 else 1]
        print(f"enclosure, {digits} digits: {milliseconds(enclose, some, digits) / len(some):.1f} ms")
    for values in ({a: 4000, b: 1000}, {a: -4000, b: 10}, {a: 1, b: 1000}):
        print(f"enclosure, 30 digits at {values}: {milliseconds(enclose, [values], 30):.0f} ms")
    print(f"verdict: {milliseconds(lambda: [F.verdict(v) for v in box]) / len(box):.2f} ms a point")
    print(f"multipliers, 15 digits: {milliseconds(lambda: [F.multipliers(v) for v in box]) / len(box):.2f} ms a point")
    print(f"remainder at n = 20: {milliseconds(lambda: [F.remainder(v) for v in box[:5]]) / 5:.0f} ms a point")
    characteristic_numbers()


def characteristic_numbers():
    """The table of :func:`fastpicard.mathieu_a_enclosure`."""
    columns = (15, 30, 100, 1000)
    print(f"mathieu_a_enclosure(r, q, digits), ms, for digits = {', '.join(map(str, columns))}")
    for r, q in ((0, 5), (3, 1000), (0, 10**6), (50, 10**6), (300, 10**6)):
        cells = [milliseconds(mathieu_a_enclosure, r, q, digits, repeats=20) for digits in columns]
        print(f"  r = {r}, q = {q}: {', '.join(f'{cell:.2g}' for cell in cells)}")


if __name__ == "__main__":
    main()
