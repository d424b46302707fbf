"""Independent routes to the numbers and expressions that the tests compare with.

Nothing here imports the packages under test.  A *plain series* is a dictionary
``{(r, q, "cos" | "sin", (i, j)): Fraction}`` that stands for the sum of
``value * a**i * b**j * t**r * cos(q t)`` (or ``sin``), with ``q >= 0`` rational.
"""

from fractions import Fraction
from functools import cache

import mpmath
import sympy
from flint import arb, arb_series, ctx, fmpq
from sympy import Add, Mul, Rational, Symbol, cos, exp, sin

t, a, b = Symbol("t"), Symbol("a"), Symbol("b")


# -- exact zero ----------------------------------------------------------------


def vanishes(expression):
    """Whether a SymPy expression is zero: exponentials, one fraction, expanded numerator."""
    expression = sympy.expand(expression)
    if expression == 0:
        return True
    waves = sympy.expand(expression.rewrite(exp).expand())
    numerator = sympy.expand(sympy.fraction(sympy.together(waves))[0])
    return numerator == 0 or sympy.simplify(numerator) == 0


def rebuilt(expression):
    """The same expression, every node evaluated again by SymPy from its leaves up."""
    if not expression.args:
        return expression
    return expression.func(*map(rebuilt, expression.args))


def same_tree(left, right):
    """Whether two expressions agree in every argument, order included."""
    return (
        type(left) is type(right)
        and left == right
        and hash(left) == hash(right)
        and len(left.args) == len(right.args)
        and all(map(same_tree, left.args, right.args))
    )


# -- plain series: the article's rules, written naively ---------------------------


def add_plain(target, key, value):
    """Add one term in place."""
    target[key] = target.get(key, 0) + value
    if target[key] == 0:
        del target[key]


def wave(r, q, kind, powers, value):
    """One term with a frequency of any sign, as a plain series."""
    if q == 0 and kind == "sin":
        return {}
    sign = -1 if q < 0 and kind == "sin" else 1
    return {(r, abs(q), kind, powers): sign * value}


def plain_sum(*series):
    """The sum of plain series."""
    result = {}
    for one in series:
        for key, value in one.items():
            add_plain(result, key, value)
    return result


def plain_product(left, right):
    """``2 cos x cos y = cos(x-y) + cos(x+y)`` and its two sisters."""
    result = {}
    for (r, p, f, m), x in left.items():
        for (s, q, g, n), y in right.items():
            powers, half = (m[0] + n[0], m[1] + n[1]), x * y / 2
            if f == g:
                kind, signs = "cos", (1, 1 if f == "cos" else -1)  # of cos(p - q) and cos(p + q)
            else:
                kind, signs = "sin", (1 if f == "sin" else -1, 1)  # of sin(p - q) and sin(p + q)
            for frequency, sign in zip((p - q, p + q), signs):
                for key, value in wave(r + s, frequency, kind, powers, sign * half).items():
                    add_plain(result, key, value)
    return result


@cache
def plain_antiderivative(r, q, kind):
    """[Neves] (8) and (9) by recursion, as ((r, q, kind), value) pairs; zero at 0."""
    if q == 0:
        return (((r + 1, Fraction(0), "cos"), Fraction(1, r + 1)),)
    if kind == "cos":
        result = {(r, q, "sin"): 1 / q}
        if r:
            for key, value in plain_antiderivative(r - 1, q, "sin"):
                add_plain(result, key, -r * value / q)
    else:
        result = {(r, q, "cos"): -1 / q}
        if r:
            for key, value in plain_antiderivative(r - 1, q, "cos"):
                add_plain(result, key, r * value / q)
        else:
            add_plain(result, (0, Fraction(0), "cos"), 1 / q)
    return tuple(result.items())


def plain_integral(series):
    """The antiderivative that is zero at 0."""
    result = {}
    for (r, q, kind, powers), value in series.items():
        for key, factor in plain_antiderivative(r, q, kind):
            add_plain(result, (*key, powers), value * factor)
    return result


def plain_picard(P, x0, n):
    """The n-th Picard iterate from 0 by the definition: ``x0 + I[P x_{n-1}]`` with all of ``x_{n-1}``."""
    start = [{(0, Fraction(0), "cos", (0, 0)): Fraction(value)} if value else {} for value in x0]
    x = start
    for _ in range(n):
        slopes = [plain_sum(*map(plain_product, row, x)) for row in P]
        x = [plain_sum(first, plain_integral(slope)) for first, slope in zip(start, slopes)]
    return x


def plain_expression(series):
    """The SymPy expression of a plain series, by SymPy's own evaluation."""
    functions = {"cos": cos, "sin": sin}
    return Add(
        *(
            Mul(Rational(value), a**i, b**j, t**r, functions[kind](Rational(q) * t))
            for (r, q, kind, (i, j)), value in series.items()
        )
    )


# -- numbers ---------------------------------------------------------------------


def quadrature(expression, variable, lower, upper, digits=30):
    """A definite integral by mpmath's quadrature, on pieces short enough for the waves in it."""
    with mpmath.workdps(digits + 10):
        f = sympy.lambdify(variable, expression, "mpmath")
        lower, upper = mpmath.mpf(sympy.N(lower, digits + 10)), mpmath.mpf(sympy.N(upper, digits + 10))
        return mpmath.quad(f, mpmath.linspace(lower, upper, 9))


def value_by_sympy(expression, substitutions, digits=40):
    """A number through SymPy's ``evalf``, with terms that cancel allowed for."""
    numbers = {key: sympy.sympify(value) for key, value in substitutions.items()}
    return sympy.N(expression.xreplace(numbers), digits, maxn=2000)


def closeness(left, right):
    """``|left - right| / max(1, |right|)`` in as many digits as both have."""
    with mpmath.workdps(150):
        left, right = mpmath.mpmathify(left), mpmath.mpmathify(right)
        return abs(left - right) / max(1, abs(right))


def distance(left, right):
    """The largest difference of two mpmath matrices, in as many digits as both have."""
    with mpmath.workdps(150):
        return mpmath.mnorm(left - right, mpmath.inf)


def within(left, right, bound, slack):
    """Whether two mpmath matrices differ by no more than a matrix of bounds, plus a slack."""
    with mpmath.workdps(150):
        return all(abs(x - y) <= z + slack for x, y, z in zip(left, right, bound))


# -- the true fundamental matrix ---------------------------------------------------


def taylor_of(expression, time, at):
    """A SymPy expression in ``time`` as a power series in balls around ``at``."""
    if expression == time:
        return arb_series([at, 1])
    if expression.is_Rational:
        return arb_series([arb(fmpq(int(expression.p), int(expression.q)))])
    if expression is sympy.pi:
        return arb_series([arb.pi()])
    parts = [taylor_of(e, time, at) for e in expression.args]
    if expression.is_Add:
        return sum(parts[1:], parts[0])
    if expression.is_Mul:
        product = parts[0]
        for part in parts[1:]:
            product *= part
        return product
    if expression.is_Pow and expression.exp.is_Integer and expression.exp > 0:
        return parts[0] ** int(expression.exp)
    if expression.is_Pow and expression.exp == Rational(1, 2):
        return parts[0].sqrt()
    return {cos: arb_series.cos, sin: arb_series.sin, exp: arb_series.exp}[expression.func](parts[0])


def true_fundamental_matrix(P, time, start, end, digits=30, steps=24, order=None):
    """``Phi(end, start)`` of ``x' = P x`` with numbers in ``P``, as an mpmath matrix: Taylor's method in balls.

    The remainder of a step is not bounded; with the default order it is far below the last digit where
    ``|P| (end - start) / steps`` is below 2.
    """
    size, order = P.rows, order or digits + 10
    with ctx.workprec(int(3.33 * digits) + 80), mpmath.workdps(digits + 10):
        old, ctx.cap = ctx.cap, order
        try:
            begin = taylor_of(sympy.sympify(start), time, arb(0))[0]
            h = (taylor_of(sympy.sympify(end), time, arb(0))[0] - begin) / steps
            X = [[arb(int(i == j)) for j in range(size)] for i in range(size)]
            for k in range(steps):
                X = _taylor_step(P, time, begin + k * h, h, X, order)
            return mpmath.matrix([[mpmath.mpf(x.mid().str(digits + 10, radius=False)) for x in row] for row in X])
        finally:
            ctx.cap = old


def _taylor_step(P, time, at, h, X, order):
    size = len(X)
    entries = [[taylor_of(P[i, j], time, at) for j in range(size)] for i in range(size)]
    terms = [X]
    for m in range(order - 1):
        new = [
            [
                sum((entries[i][l][m - s] * terms[s][l][j] for s in range(m + 1) for l in range(size)), arb(0))
                / (m + 1)
                for j in range(size)
            ]
            for i in range(size)
        ]
        terms.append(new)
    return [
        [sum((term[i][j] * h**m for m, term in enumerate(terms)), arb(0)) for j in range(size)] for i in range(size)
    ]


def truncation_bound(P, time, length, n):
    """``sum_{k>n} (Pbar T)^k / k!`` entrywise, as an mpmath matrix; ``Pbar`` adds the absolute coefficients."""
    size = P.rows
    with mpmath.workdps(30):
        reach = abs(mpmath.mpf(sympy.N(length, 30)))
        bar = mpmath.matrix(size, size)
        for i in range(size):
            for j in range(size):
                bar[i, j] = sum(
                    (_size_of(term, time, reach) for term in Add.make_args(sympy.expand(P[i, j]))), mpmath.mpf(0)
                )
        power, total, k = mpmath.eye(size), mpmath.zeros(size), 0
        while k <= n or mpmath.mnorm(power, 1) > mpmath.mpf(10) ** -200 and k < 20 * (n + 10):
            k += 1
            power = power * bar * reach / k
            if k > n:
                total += power
        return total


def _size_of(term, time, reach):
    """An upper bound on one term over the interval: waves are at most 1."""
    size = mpmath.mpf(1)
    for factor in Mul.make_args(term):
        if not factor.has(time):
            size *= abs(mpmath.mpf(sympy.N(factor, 30)))
        elif factor == time or factor.is_Pow and factor.base == time:
            size *= reach ** int(factor.as_base_exp()[1])
    return size
