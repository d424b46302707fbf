"""Questions without an answer: every one is refused by name, with the value that is wrong and what would do."""

import json
import re
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy
from flint import arb
from sympy import (
    Derivative,
    Function,
    I,
    Integral,
    Matrix,
    Max,
    Mod,
    Piecewise,
    Rational,
    Symbol,
    Tuple,
    cos,
    exp,
    floor,
    log,
    nan,
    oo,
    pi,
    sin,
    sqrt,
    sympify,
    tan,
    zoo,
)

from fastpicard import (
    BadInputError,
    BadTypeError,
    FastPicardError,
    FloquetMatrix,
    FundamentalMatrix,
    MissingParameterError,
    NotInFamilyError,
    NotPeriodicError,
    PoissonSeries,
    ShapeError,
    boundaries,
    certify,
    chart,
    crossing,
    fast_picard,
    gather,
    new_integrate,
    picard,
    product_to_sum,
    tabulate,
    tubes,
)
from fastpicard.matrix import SeriesMatrix
from tests.oracles import vanishes

t, a, b, x, y = sympy.symbols("t a b x y")
f = Function("f")
MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])


def shown(value):
    """A name for pytest that does not depend on addresses."""
    text = type(value).__name__ if isinstance(value, set) else re.sub(" at 0x[0-9a-f]*", "", repr(value))
    return text if len(text) < 60 else text[:57] + "..."


class Trap:
    """Text that tells when somebody evaluates it: SymPy would run it as code."""

    sprung = False

    @classmethod
    def spring(cls):
        """Called by the text below if it is ever evaluated."""
        cls.sprung = True


CODE = "__import__('gc').collect() or [k for k in object.__subclasses__() if k.__name__ == 'Trap'][0].spring() or 1"
TEXTS = ["1", "t", "cos(t)", "", CODE]


# -- reference rows ----------------------------------------------------------------

ROWS = json.loads((Path(__file__).parent / "cases" / "bad_inputs.json").read_text())["cases"]


def rows(area):
    """The reference rows of one area."""
    return pytest.mark.parametrize("case", [row for row in ROWS if row["area"] == area], ids=lambda row: row["id"])


def judged(case, ask, right=lambda answer: True):
    """Ask; an error must be ours and mention one of the words, an answer must be allowed and right."""
    try:
        answer = ask()
    except FastPicardError as error:
        assert case["expect"] != "ok", error
        words = case["message_should_mention"]
        assert not words or any(word.lower() in str(error).lower() for word in words), (words, str(error))
        return
    assert case["expect"] != "error", (case["what"], answer)
    assert right(answer)


@rows("integrate")
def test_reference_integrals_are_refused_or_right(case):
    """Outside the family, limits that are not finite, no variable: an error; everything else the value given."""
    given = case["inputs"]
    variable = sympify(given["variable"])
    if "lower" in given:
        variable = (variable, sympify(given["lower"]), sympify(given["upper"]))
    if given["integrand"].startswith("sum_"):
        # A tenth of the terms here, for SymPy's own cos takes 2 ms each; all of them in tests/extremes.
        integrand = sympy.Add(*(k * t ** (k % 7) * cos(k * t, evaluate=False) for k in range(1, 2001)))
        right = lambda found: len(sympy.Add.make_args(found)) == 8001
    else:
        integrand = sympify(given["integrand"], locals={"f": f})
        value = {"bad-041": "0", "bad-045": "Matrix([[sin(t)]])"}.get(case["id"], case.get("value"))
        right = lambda found: close_to(found, sympify(value)) if value else True

    judged(case, lambda: new_integrate(integrand, variable), right)


def close_to(found, expected):
    """Equal, or equal to 1e-14 on [0, 10] where floats came in."""
    if found == expected:
        return True
    return vanishes(found - expected) or all(abs(sympy.N((found - expected).subs(t, s), 30)) < 1e-14 for s in range(11))


@rows("picard")
def test_reference_iterates_are_refused_or_right(case):
    """P, x0, n and t0 that make no sense, and unusual ones that do."""
    given = case["inputs"]
    P = Matrix(sympify(given["P"]))
    # An order in quotation marks is a text; expressions in them are how the table writes mathematics.
    n, t0 = given.get("n", 3), sympify(given.get("t0", "0"))
    x0 = [sympify(value) for value in given["x0"]]

    def right(iterate):
        before = iterate.to_order(iterate.n - 1)
        slopes = Matrix(
            P.applyfunc(lambda e: sympy.nsimplify(e, rational=True) if not e.has(sympy.Float) else e)
            * before.as_matrix()
        )
        return all(iterate[i, 0].diff() == slope for i, slope in enumerate(slopes)) or P.has(sympy.Float)

    judged(case, lambda: fast_picard(P, t, x0, n, t0), right)


@rows("floquet")
def test_reference_floquet_matrices_are_refused_or_right(case):
    """Periods that are none, parameters without a value, and legal periods that look odd."""
    given = case["inputs"]
    P = Matrix(sympify(given["P"]))
    period = 2 * pi if "default" in given.get("period", "default") else sympify(given["period"])
    values = {Symbol(name): Rational(value) for name, value in given.get("params", {}).items()}

    def ask():
        F = FloquetMatrix(P, t, 12, period)
        if values:
            F.evaluate(values)
        return F

    def right(F):
        if case["id"] != "bad-093":
            return True
        whole, half = (FloquetMatrix(P, t, 40, T).evaluate(digits=20) for T in (2 * pi, pi))
        return mpmath.mnorm(whole - half * half, 1) < 1e-12

    judged(case, ask, right)


@rows("precision")
def test_a_float_parameter_is_the_dyadic_number_it_is(case):
    """0.1 is not 1/10: forty digits show the difference, and the iterate knows which one was given."""
    F = FloquetMatrix(MATHIEU, t, 60)
    dyadic = F.trace_at({a: 0.1, b: 0.55}, 42)
    decimal = F.trace_at({a: Rational(1, 10), b: Rational(11, 20)}, 42)

    assert dyadic != decimal
    assert dyadic == F.trace_at({a: Fraction(0.1), b: Fraction(0.55)}, 42)
    for found, text in ((dyadic, "trace_binary64_values"), (decimal, "trace_exact_rational")):
        assert abs(found - mpmath.mpf(case["value"][text])) < mpmath.mpf(10) ** -12


# -- text -------------------------------------------------------------------------


def with_text(text):
    """Every public way to hand a text to the mathematics."""
    F, Phi = FloquetMatrix(MATHIEU, t, 2), FundamentalMatrix(MATHIEU, t, 2)
    series = PoissonSeries(a * cos(t), t)
    return {
        "series": lambda: PoissonSeries(text, t),
        "series time": lambda: PoissonSeries(cos(t), text),
        "gather": lambda: gather(text, t),
        "gather time": lambda: gather(cos(t), text),
        "product": lambda: product_to_sum(text, t),
        "product time": lambda: product_to_sum(cos(t), text),
        "integrand": lambda: new_integrate(text, t),
        "variable": lambda: new_integrate(cos(t), text),
        "limit": lambda: new_integrate(cos(t), (t, 0, text)),
        "lower": lambda: new_integrate(cos(t), (t, text, 1)),
        "bound variable": lambda: new_integrate(cos(t), (text, 0, 1)),
        "add": lambda: series + text,
        "radd": lambda: text + series,
        "multiply": lambda: series * text,
        "subtract": lambda: series - text,
        "rsub": lambda: text - series,
        "scale": lambda: series.scale(text),
        "power": lambda: series**text,
        "call": lambda: series(text),
        "time": lambda: series.evaluate(text, {a: 1}),
        "value": lambda: series.evaluate(1, {a: text}),
        "key": lambda: series.evaluate(1, {"a": 1}),
        "digits": lambda: series.evaluate(1, {a: 1}, text),
        "P": lambda: fast_picard(text, t, [1, 0], 1),
        "P entry": lambda: fast_picard([[text]], t, [1], 1),
        "P call": lambda: fast_picard(lambda s: text, t, [1, 0], 1),
        "P call entry": lambda: FloquetMatrix(lambda s: [[text]], t, 1),
        "iterate time": lambda: fast_picard(MATHIEU, text, [1, 0], 1),
        "x0": lambda: fast_picard(MATHIEU, t, text, 1),
        "x0 entry": lambda: fast_picard(MATHIEU, t, [1, text], 1),
        "n": lambda: fast_picard(MATHIEU, t, [1, 0], text),
        "t0": lambda: fast_picard(MATHIEU, t, [1, 0], 1, text),
        "Phi P": lambda: FundamentalMatrix(text, t, 1),
        "Phi time": lambda: FundamentalMatrix(MATHIEU, text, 1),
        "Phi n": lambda: FundamentalMatrix(MATHIEU, t, text),
        "Phi t0": lambda: FundamentalMatrix(MATHIEU, t, 1, text),
        "Phi call": lambda: Phi(text),
        "Phi value": lambda: Phi.evaluate(1, {a: text, b: 1}),
        "Phi at": lambda: Phi.evaluate(text, {a: 1, b: 1}),
        "Phi order": lambda: Phi.to_order(text),
        "increment": lambda: Phi.increment(text),
        "F P": lambda: FloquetMatrix(text, t, 1),
        "F time": lambda: FloquetMatrix(MATHIEU, text, 1),
        "F n": lambda: FloquetMatrix(MATHIEU, t, text),
        "period": lambda: FloquetMatrix(MATHIEU, t, 1, text),
        "F order": lambda: F.to_order(text),
        "F value": lambda: F.evaluate({a: text, b: 1}),
        "F digits": lambda: F.evaluate({a: 1, b: 1}, text),
        "trace value": lambda: F.trace_at({a: text, b: 1}),
        "trace digits": lambda: F.trace_at({a: 1, b: 1}, text),
        "multipliers": lambda: F.multipliers({a: text, b: 1}),
        "multiplier digits": lambda: F.multipliers({a: 1, b: 1}, text),
        "lambdify": lambda: F.lambdify(text),
        "lambdify entry": lambda: F.lambdify([a, text]),
        "lambdify trace": lambda: F.lambdify_trace([text, b]),
        "lambdify value": lambda: F.lambdify([a, b])(text, 1),
        "trace argument": lambda: F.lambdify_trace([a, b])(1, text),
        "values": lambda: F.evaluate(text),
        "picard x0": lambda: picard(lambda s, z: z, t, text, 1),
        "picard x0 entry": lambda: picard(lambda s, z: z, t, [text], 1),
        "picard time": lambda: picard(lambda s, z: z, text, [1], 1),
        "picard n": lambda: picard(lambda s, z: z, t, [1], text),
        "picard t0": lambda: picard(lambda s, z: z, t, [1], 1, text),
        "picard f": lambda: picard(text, t, [1], 1),
        "picard slope": lambda: picard(lambda s, z: [text], t, [1], 1),
        "picard slopes": lambda: picard(lambda s, z: text, t, [1], 1),
    }


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("place", with_text("1"))
def test_text_is_refused_everywhere_and_never_evaluated(place, text):
    """SymPy evaluates text as code; no public function hands it any."""
    with pytest.raises(BadTypeError):
        with_text(text)[place]()

    assert not Trap.sprung


def test_a_text_is_not_equal_to_a_series():
    """Comparison is no reason to evaluate: it answers False."""
    assert PoissonSeries(1, t) != "1"
    assert PoissonSeries(1, t) != CODE
    assert not Trap.sprung


def test_the_name_of_a_symbol_is_not_code():
    """A symbol may be called anything; lambdify does not run its name."""
    evil = Symbol("__import__('os').abort()")
    F = FloquetMatrix(Matrix([[evil * cos(t) ** 2 + evil / (1 + evil)]]), t, 2)

    assert F.lambdify_trace([evil])(1.0) == pytest.approx(F.trace_at({evil: 1}), rel=1e-12)


# -- outside the family --------------------------------------------------------------

OUTSIDE = [
    1 / t,
    t**-3,
    t * cos(t) / t**2,
    sqrt(t),
    t ** Rational(1, 2) * cos(t),
    t ** Rational(5, 2),
    t**a,
    t**-a,
    t**pi,
    2**t,
    a**t,
    t**t,
    exp(t),
    exp(-t) * cos(t),
    exp(I * t + t),
    exp(a * t),
    exp(t**2),
    exp(I * t**2),
    exp(cos(t)),
    log(t),
    log(1 + cos(t)),
    tan(t),
    sympy.cot(t),
    sympy.sec(t),
    sympy.csc(2 * t),
    sympy.sinc(t),
    1 / cos(t),
    sin(t) ** -1,
    cos(t) ** -2,
    1 / (1 + cos(t)),
    (1 + t) ** -1,
    1 / (a + b * cos(t)),
    cos(t**2),
    sin(t * cos(t)),
    cos(1 / t),
    sin(1 - t**2 * sin(1) / 2),
    sin(sin(t)),
    cos(sqrt(t)),
    cos(t) ** a,
    cos(t) ** Rational(1, 2),
    sin(t) ** Rational(1, 3),
    sympy.Abs(t),
    sympy.Abs(cos(t)),
    sympy.sign(t),
    sympy.Heaviside(t),
    sympy.DiracDelta(t),
    floor(t),
    sympy.ceiling(t),
    Mod(t, 1),
    Max(t, 0),
    sympy.Min(0, cos(t)),
    sympy.cosh(t),
    sympy.sinh(t),
    sympy.tanh(t),
    sympy.asin(t),
    sympy.atan(t),
    sympy.acos(cos(t)),
    sympy.besselj(0, t),
    sympy.erf(t),
    sympy.gamma(t),
    sympy.factorial(t),
    sympy.fresnels(t),
    sympy.Si(t),
    sympy.LambertW(t),
    sympy.re(t),
    sympy.im(cos(t)),
    sympy.conjugate(t),
    sympy.arg(t),
    Piecewise((t, t > 0), (0, True)),
    Piecewise((cos(t), a > 0), (sin(t), True)),
    f(t),
    f(t) * cos(t),
    f(a * t),
    Derivative(f(t), t),
    Derivative(f(t), t, t) + t,
    Integral(f(t), t),
    Integral(f(t), (t, 0, 1)),
    Integral(cos(t**2), t),
    Integral(cos(x), (x, 0, t)),
    Derivative(cos(t), t, evaluate=False),
    sympy.Sum(t**x, (x, 0, 3)),
    sympy.Product(t, (x, 1, 3)),
    sympy.Subs(f(x), x, t),
    sympy.Limit(cos(t), t, 0),
    sympy.Order(t),
    Symbol("A", commutative=False),
    Symbol("A", commutative=False) * cos(t),
    f(x).diff(x),
    Integral(f(x), (x, 0, 1)),
    cos(t * sqrt(t)),
    t ** (1 + a),
    (t**2) ** a,
    (1 + cos(t)) ** a,
]


@pytest.mark.parametrize("expression", OUTSIDE, ids=shown)
def test_functions_outside_the_family_are_refused_and_shown(expression):
    """No finite sum of t**r cos(q t + phi), t**r sin(q t + phi): NotInFamilyError, in every entrance."""
    for ask in (
        lambda: new_integrate(expression, t),
        lambda: PoissonSeries(expression, t),
        lambda: gather(expression, t),
        lambda: product_to_sum(expression, t),
        lambda: PoissonSeries(cos(t), t) + expression,
    ):
        with pytest.raises(NotInFamilyError, match="family"):
            ask()
    with pytest.raises(NotInFamilyError, match=r"P must be a trigonometric polynomial in t .*P\[0, 0\]"):
        fast_picard([[expression]], t, [1], 1)


@pytest.mark.parametrize(
    "expression",
    [
        sympy.Eq(t, 1),
        t < 1,
        a > 0,
        sympy.true,
        Tuple(1, t),
        sympy.FiniteSet(1),
        Matrix([[cos(t)]]),
        sympy.MatrixSymbol("M", 2, 2),
        None,
        True,
        [1],
        {1: 2},
        (t, 1),
        {t},
        object(),
        np.array([1.0]),
        b"1",
        bytearray(b"cos(t)"),
        sympy.Interval(0, 1),
        cos,
        f,
        sympy.Lambda(t, t),
        arb(1),
        sympy.Range(3),
    ],
    ids=shown,
)
def test_what_is_no_scalar_expression_is_refused(expression):
    """Relations, truth values, containers and functions are no series."""
    with pytest.raises(FastPicardError):
        PoissonSeries(expression, t)
    if not isinstance(expression, sympy.MatrixBase):
        with pytest.raises(FastPicardError):
            new_integrate(expression, t)
    with pytest.raises(FastPicardError):
        fast_picard([[expression]], t, [1], 1)


@pytest.mark.parametrize(
    "number",
    [
        nan,
        oo,
        -oo,
        zoo,
        oo * I,
        nan * t,
        a + zoo,
        oo * cos(t),
        sympy.Float("nan"),
        sympy.Float("inf"),
        float("nan"),
        float("inf"),
        -float("inf"),
        mpmath.mpf("nan"),
        mpmath.inf,
        sympy.AccumBounds(-1, 1),
        Symbol("u", infinite=True),
        np.float64("nan"),
        np.inf,
    ],
    ids=shown,
)
def test_what_is_not_finite_is_refused(number):
    """nan, infinities and the accumulation bounds that SymPy gives for a limit."""
    for ask in (
        lambda: PoissonSeries(number, t),
        lambda: new_integrate(number, t),
        lambda: fast_picard([[number]], t, [1], 1),
        lambda: fast_picard([[1]], t, [number], 1),
        lambda: fast_picard([[1]], t, [1], 1, number),
        lambda: FloquetMatrix([[1]], t, 1, number),
        lambda: new_integrate(cos(t), (t, 0, number)),
        lambda: new_integrate(cos(t), (t, number, 0)),
        lambda: picard(lambda s, z: z, t, [number], 1),
        lambda: picard(lambda s, z: z, t, [1], 1, number),
        lambda: picard(lambda s, z: [a * number], t, [1], 1),
        lambda: picard(lambda s, z: Matrix([number]), t, [1], 1),
        lambda: PoissonSeries(cos(t), t)(number),
    ):
        with pytest.raises(BadInputError, match=r"finite|depend|converge"):
            ask()


@pytest.mark.parametrize("value", [sympy.besselj(0, 1), sympy.Integral(exp(-t**2), (t, 0, oo))])
def test_a_value_that_sympy_cannot_judge_is_asked_for_in_digits(value):
    """Finite as it is; what the message says does."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - cos(t), 0]]), t, 6)
    with pytest.raises(BadInputError, match="SymPy does not tell whether .*Give its digits, as in .*evalf"):
        F.evaluate({a: value})
    assert F.trace_at({a: value.evalf(50)}, digits=20) != 2


def test_an_integral_that_is_not_finite_is_refused():
    """x' = 1/t from t = 0; and x' = x oo, where only x makes nan of it."""
    with pytest.raises(BadInputError, match=r"from 0 to t must be finite, but it is log\(t\) \+ oo"):
        picard(lambda s, z: [1 / s], t, [1], 1)
    with pytest.raises(BadInputError, match="every component of f.* must be finite, but it is nan"):
        picard(lambda s, z: [z[0] * oo], t, [0], 1)


@pytest.mark.parametrize("u", [Symbol("u", infinite=True), Symbol("u", finite=False)], ids=shown)
def test_a_symbol_that_is_infinite_is_no_coefficient(u):
    """Nor in a product, a power, a frequency or a phase."""
    for expression in (u * cos(t), t + u**2, cos(u * t), sin(t + u), 1 / (u + a)):
        with pytest.raises(BadInputError, match="coefficient must be finite, but u is not"):
            PoissonSeries(expression, t)
    with pytest.raises(BadInputError, match="reciprocal of 0"):
        PoissonSeries(t / Symbol("o", zero=True), t)


@pytest.mark.parametrize(
    "value",
    [
        nan,
        oo,
        -oo,
        float("nan"),
        float("inf"),
        mpmath.nan,
        mpmath.inf,
        arb("nan"),
        arb("inf"),
        np.float64("-inf"),
    ],
    ids=shown,
)
def test_values_that_are_not_finite_are_refused(value):
    """Parameters and times are finite numbers."""
    for ask in (
        lambda: PoissonSeries(a * cos(t), t).evaluate(1, {a: value}),
        lambda: PoissonSeries(cos(t), t).evaluate(value),
        lambda: FloquetMatrix(MATHIEU, t, 2).evaluate({a: value, b: 1}),
        lambda: FloquetMatrix(MATHIEU, t, 2).trace_at({a: 1, b: value}, 20),
        lambda: FundamentalMatrix(MATHIEU, t, 2).evaluate(value, {a: 1, b: 1}),
    ):
        with pytest.raises(BadInputError, match="finite"):
            ask()


@pytest.mark.parametrize(
    "value",
    [
        1j,
        I,
        2 + 3 * I,
        mpmath.mpc(1, 2),
        a,
        a + 1,
        True,
        None,
        [1],
        np.array([1, 2]),
        {1},
        sqrt(-2),
        sympy.true,
        Matrix([1]),
        np.complex128(1j),
        f(1),
        b"1",
    ],
    ids=shown,
)
def test_values_that_are_no_real_numbers_are_refused(value):
    """Complex numbers, expressions, truth values and containers are no values of a parameter or of the time."""
    for ask in (
        lambda: FloquetMatrix(MATHIEU, t, 2).evaluate({a: value, b: 1}),
        lambda: PoissonSeries(t, t).evaluate(value),
        lambda: PoissonSeries(a * t, t).evaluate(1, {a: value}, 30),
    ):
        with pytest.raises(FastPicardError, match="real|number"):
            ask()


# -- orders, times, starts and shapes ----------------------------------------------------


@pytest.mark.parametrize(
    "n",
    [
        -1,
        -7,
        2.0,
        2.5,
        True,
        False,
        "3",
        None,
        Rational(1, 2),
        Fraction(3),
        Symbol("n"),
        [2],
        1j,
        sympy.Float(3),
        float("nan"),
        oo,
        np.float64(2),
    ],
    ids=shown,
)
def test_an_order_is_an_integer_from_0_up(n):
    """In every function that takes one."""
    Phi, F = FundamentalMatrix(MATHIEU, t, 1), FloquetMatrix(MATHIEU, t, 1)
    for ask in (
        lambda: fast_picard(MATHIEU, t, [1, 0], n),
        lambda: FundamentalMatrix(MATHIEU, t, n),
        lambda: FloquetMatrix(MATHIEU, t, n),
        lambda: picard(lambda s, z: z, t, [1], n),
        lambda: Phi.to_order(n),
        lambda: F.to_order(n),
        lambda: Phi.increment(n),
    ):
        with pytest.raises(FastPicardError, match="order n must be an integer"):
            ask()


def test_orders_that_no_machine_reaches_are_refused():
    """Not begun and never ended."""
    for ask in (lambda: FundamentalMatrix(MATHIEU, t, 10**30), lambda: FloquetMatrix(MATHIEU, t, 1).to_order(10**6)):
        with pytest.raises(FastPicardError, match="made of all orders before it"):
            ask()
    with pytest.raises(FastPicardError, match="Pbar T, which is about 6.28e[+]20"):
        FloquetMatrix.for_accuracy(Matrix([[0, 1], [-a, 0]]), t, {a: 10**40}, 1e-10)


@pytest.mark.parametrize("n", [2, np.int64(2), sympy.Integer(2)], ids=shown)
def test_an_order_may_be_any_integer_type(n):
    """int, NumPy's and SymPy's integers mean the same order."""
    assert fast_picard(MATHIEU, t, [1, -2], n).as_matrix() == fast_picard(MATHIEU, t, [1, -2], 2).as_matrix()


@pytest.mark.parametrize("digits", [0, -3, 2.5, True, "15", Rational(1, 2), 1e3, float("inf"), [3]], ids=shown)
def test_digits_are_a_positive_integer_or_none(digits):
    """In every evaluation."""
    F = FloquetMatrix(MATHIEU, t, 1)
    for ask in (
        lambda: F.evaluate({a: 1, b: 1}, digits),
        lambda: F.trace_at({a: 1, b: 1}, digits),
        lambda: F.multipliers({a: 1, b: 1}, digits),
        lambda: PoissonSeries(t, t).evaluate(1, {}, digits),
    ):
        with pytest.raises(FastPicardError, match="digits"):
            ask()


@pytest.mark.parametrize(
    "variable", [3, cos(t), 2 * t, None, pi, f(t), f, 1.5, [t], sympy.Integer(1), Matrix([t]), object()], ids=shown
)
def test_the_independent_variable_is_a_symbol(variable):
    """Numbers, expressions and functions are no variables."""
    for ask in (
        lambda: PoissonSeries(1, variable),
        lambda: gather(1, variable),
        lambda: product_to_sum(1, variable),
        lambda: new_integrate(1, variable),
        lambda: new_integrate(1, (variable, 0, 1)),
        lambda: fast_picard([[1]], variable, [1], 1),
        lambda: FundamentalMatrix([[1]], variable, 1),
        lambda: FloquetMatrix([[1]], variable, 1),
        lambda: picard(lambda s, z: z, variable, [1], 1),
    ):
        with pytest.raises(BadTypeError, match="variable"):
            ask()


def test_a_constant_symbol_with_the_name_of_the_time_is_noticed():
    """Two symbols called t with different assumptions would give t as a constant, silently."""
    other = Symbol("t", real=True)
    for ask in (
        lambda: PoissonSeries(cos(other), t),
        lambda: new_integrate(cos(t), other),
        lambda: gather(other, t),
        lambda: fast_picard([[cos(other)]], t, [1], 1),
        lambda: FloquetMatrix(MATHIEU, other, 1),
        lambda: fast_picard(MATHIEU, t, [other, 0], 1),
        lambda: fast_picard(MATHIEU, t, [1, 0], 1, other),
        lambda: FloquetMatrix([[1]], t, 1, other),
        lambda: new_integrate(cos(t), (t, 0, other)),
        lambda: PoissonSeries(cos(t), t) + PoissonSeries(1, other),
    ):
        with pytest.raises(BadInputError, match=r"assumptions|same time"):
            ask()


@pytest.mark.parametrize("limits", [(t,), (t, 1), (t, 0, 1, 2), (), [t, 2]], ids=shown)
def test_limits_come_in_pairs(limits):
    """(t, lower, upper), or t alone."""
    with pytest.raises(FastPicardError, match="limits|variable"):
        new_integrate(cos(t), limits)


@pytest.mark.parametrize(
    "P",
    [
        Matrix([[1, 2, 3], [4, 5, 6]]),
        Matrix([[1, 2]]),
        Matrix([1, 2]),
        Matrix(0, 0, []),
        [[1, 2], [3]],
        [[1], [2]],
        [[]],
        [],
        Matrix(3, 2, range(6)),
    ],
    ids=shown,
)
def test_a_matrix_that_is_not_square_is_refused(P):
    """With its shape."""
    for ask in (
        lambda: fast_picard(P, t, [1, 0], 1),
        lambda: FundamentalMatrix(P, t, 1),
        lambda: FloquetMatrix(P, t, 1),
        lambda: FloquetMatrix(lambda s: P, t, 1),
    ):
        with pytest.raises(ShapeError, match="square"):
            ask()


@pytest.mark.parametrize(
    "P", [1, a, cos(t), None, 2.5, {1: 2}, object(), [1, 2], sympy.MatrixSymbol("M", 2, 2)], ids=shown
)
def test_what_is_no_matrix_is_refused(P):
    """A scalar is no system; [[...]] is."""
    for ask in (lambda: fast_picard(P, t, [1], 1), lambda: FundamentalMatrix(P, t, 1), lambda: FloquetMatrix(P, t, 1)):
        with pytest.raises(FastPicardError, match="P must be"):
            ask()


@pytest.mark.parametrize(
    "x0",
    [
        [1],
        [1, 2, 3],
        [],
        Matrix([1, 2, 3]),
        Matrix([[1, 2], [3, 4]]),
        (1,),
        1,
        None,
        a,
        {1, 2},
        iter([1, 2]),
        np.array([1, 2, 3]),
        np.eye(2),
    ],
    ids=shown,
)
def test_a_start_of_another_length_is_refused(x0):
    """x0 has one component for each row of P."""
    with pytest.raises(FastPicardError, match="x0"):
        fast_picard(MATHIEU, t, x0, 1)


@pytest.mark.parametrize(
    "x0",
    [
        [1, -2],
        (1, -2),
        Matrix([1, -2]),
        Matrix([[1, -2]]),
        sympy.ImmutableMatrix([1, -2]),
    ],
    ids=shown,
)
def test_a_start_may_be_any_list_of_numbers(x0):
    """Lists, tuples, row and column matrices mean the same vector."""
    assert fast_picard(MATHIEU, t, x0, 2).as_matrix() == fast_picard(MATHIEU, t, [1, -2], 2).as_matrix()


@pytest.mark.parametrize("value", [t, 2 * t + 1, cos(t), t * a], ids=shown)
def test_a_start_that_depends_on_the_time_is_refused(value):
    """x0 and t0 are free of t, and so are period and scale factor."""
    for ask in (
        lambda: fast_picard(MATHIEU, t, [value, 0], 1),
        lambda: fast_picard(MATHIEU, t, [1, 0], 1, value),
        lambda: FundamentalMatrix(MATHIEU, t, 1, value),
        lambda: picard(lambda s, z: z, t, [value], 1),
        lambda: picard(lambda s, z: z, t, [1], 1, value),
        lambda: FloquetMatrix(MATHIEU, t, 1, value),
        lambda: PoissonSeries(t, t).scale(value),
    ):
        with pytest.raises(BadInputError, match="depend on t"):
            ask()


def test_a_right_hand_side_of_another_shape_is_refused():
    """picard wants one slope for each unknown, from something it can call."""
    for slope in ([1, 2], [[1, 2]], 1, None, [None]):
        with pytest.raises(FastPicardError, match="f"):
            picard(lambda s, z, slope=slope: slope, t, [1], 1)
    for f_ in (None, 3, MATHIEU):
        with pytest.raises(FastPicardError, match="f"):
            picard(f_, t, [1, 0], 1)


# -- periods ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    "period",
    [0, -1, -2 * pi, I, 2 * pi * I, oo, nan, zoo, None, True, [1], sqrt(-1), 0.0, 6.28, 2.0 * pi, 1j],
    ids=shown,
)
def test_a_period_is_an_exact_positive_number(period):
    """Zero, negative, imaginary, infinite and floating periods are refused."""
    for P in ([[1]], MATHIEU):
        with pytest.raises(FastPicardError, match="period"):
            FloquetMatrix(P, t, 1, period)


@pytest.mark.parametrize(
    "P, period, remedy",
    [
        (MATHIEU, pi, "2*pi"),
        (MATHIEU, 3 * pi, "2*pi"),
        (MATHIEU, 1, "2*pi"),
        (MATHIEU, a, "2*pi"),
        ([[cos(t / 2)]], 2 * pi, "4*pi"),
        ([[cos(t / 2) + sin(t / 3)]], 4 * pi, "12*pi"),
        ([[cos(2 * pi * t)]], 2 * pi, "1"),
        ([[cos(a * t)]], 2 * pi, "2*pi/a"),
        ([[cos(sqrt(2) * t)]], 2 * pi, "sqrt(2)*pi"),
        ([[cos(t) + cos(sqrt(2) * t)]], 2 * pi, "no common period"),
        ([[cos(t) + cos(a * t)]], 2 * pi, "no common period"),
        ([[t]], 2 * pi, "grows"),
        ([[t * cos(t)]], 2 * pi, "grows"),
        ([[0, 1], [t**2, 0]], 2 * pi, "grows"),
        ([[sin(t + a)]], pi, "2*pi"),
        ([[0, 1], [sin(3 * t / 7), 0]], 2 * pi, "14*pi/3"),
        ([[cos((a - 1) * t) + sin(3 * (a - 1) * t)]], 2 * pi, "2*pi/(a - 1)"),
        ([[cos((a - 1) * t) + cos(a * t)]], 2 * pi / (a - 1), "no common period"),
        ([[cos((a - 1) * t)]], pi / (a - 1), "makes 1/2 of a turn"),
        ([[cos(Symbol("n", integer=True) * t / 2)]], 2 * pi, "makes n/2 of a turn"),
    ],
    ids=shown,
)
def test_a_period_that_is_none_is_refused_with_one_that_would_do(P, period, remedy):
    """The entry, how many turns it makes, and the common period of all entries."""
    with pytest.raises(NotPeriodicError, match="does not repeat with period") as caught:
        FloquetMatrix(P, t, 1, period)

    assert remedy in str(caught.value)
    assert "P[" in str(caught.value)


# -- parameters --------------------------------------------------------------------------


@pytest.mark.parametrize(
    "values", [{}, None, {a: 1}, {b: 1}, {Symbol("a", real=True): 1, b: 2}, {x: 1, y: 2}], ids=shown
)
def test_a_parameter_without_a_value_is_named(values):
    """In every evaluation, with the values that were given."""
    F, Phi = FloquetMatrix(MATHIEU, t, 4), FundamentalMatrix(MATHIEU, t, 4)
    missing = "b" if values and a in values else "a"
    for ask in (
        lambda: F.evaluate(values),
        lambda: F.trace_at(values, 20),
        lambda: F.multipliers(values),
        lambda: Phi.evaluate(1, values),
        lambda: Phi[0, 0].evaluate(1, values),
    ):
        with pytest.raises(MissingParameterError, match=f"parameter needs a value, but {missing}"):
            ask()


@pytest.mark.parametrize("value", [Rational(1, 2), 0.5, pi, sqrt(2)], ids=shown)
def test_a_symbol_that_is_an_integer_takes_integers_alone(value):
    """SymPy has written cos(n pi) as (-1)**n, which is not so at 1/2; 2.0 is an integer."""
    n = Symbol("n", integer=True)
    F = FloquetMatrix([[0, 1], [-a - cos(n * pi) * cos(t), 0]], t, 2)

    assert F.evaluate({a: 1, n: 2.0}).tolist() == F.evaluate({a: 1, n: 2}).tolist()
    with pytest.raises(BadInputError, match="n is an integer by its assumptions"):
        F.evaluate({a: 1, n: value})


@pytest.mark.parametrize("assumed, value, allowed", [
    ("even", 1, 2), ("odd", 2, 1), ("positive", -1, 0), ("positive", arb(-2, 1e-3), arb(0, 1e-3)),
    ("negative", sqrt(2), 0), ("nonnegative", -0.5, 0), ("nonpositive", Rational(1, 3), -1)], ids=shown)
def test_a_value_is_what_the_symbol_says_it_is(assumed, value, allowed):
    """SymPy has written sqrt(p**2) as p, and cos(m pi) as 1; 0 is let pass as the end of what is positive."""
    s = Symbol("s", **{assumed: True})
    F = FloquetMatrix([[0, 1], [-a - s * cos(t), 0]], t, 2)

    assert F.remainder({a: 1, s: allowed}) > 0
    with pytest.raises(BadInputError, match="s is .* by its assumptions"):
        F.remainder({a: 1, s: value})
    if not isinstance(value, arb):
        assert F.lambdify([s, a])([float(allowed), np.nan], 1).shape == (2, 2, 2)
        with pytest.raises(BadInputError, match="s is .* by its assumptions"):
            F.lambdify([s, a])([float(allowed), float(value)], 1)


@pytest.mark.parametrize("value", [arb(0.5), arb(0.5, 1e-9), (0.5, 0.5), (Rational(1, 3), Rational(2, 3))], ids=shown)
def test_a_ball_without_an_integer_is_no_value_of_one(value):
    """Its period is another; a ball with one stands for that."""
    n, m = Symbol("n", integer=True), Symbol("m", even=True)
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(n * t) - cos(m * t / 2), 0]]), t, 4)
    at = {a: Rational(1, 16), b: 0.1}
    for values in ({**at, n: value, m: 2}, {**at, n: 1, m: value}, {**at, n: 1, m: arb(1)}, {**at, n: 1, m: (1, 1)}):
        for ask in (F.verdict, F.remainder, F.multipliers):
            with pytest.raises(BadInputError, match="by its assumptions"):
                ask(values)
    assert F.remainder({**at, n: arb(1, 0.1), m: (2, 2)}) > 0


@pytest.mark.parametrize("draw", [chart, certify, tubes])
def test_charts_ask_what_symbols_assume(draw):
    """Fixed values, ends of axes, and what modes give."""
    e, p, n = Symbol("e", even=True), Symbol("p", positive=True), Symbol("n", integer=True)
    F = FloquetMatrix(Matrix([[0, 1], [-a - (-1) ** e / 4 - b * cos(t) - p * cos(2 * t) - n, 0]]), t, 4)
    G = F.to_order(0)
    for fixed in ({e: 1, p: 1, n: 1}, {e: 2, p: -1, n: 1}, {e: 2, p: 1, n: Rational(1, 2)}):
        with pytest.raises(BadInputError, match="by its assumptions"):
            draw(G, (a, 0, 1), (b, 0, 1), fixed=fixed)
    with pytest.raises(BadInputError, match="p is positive"):
        draw(G, (a, 0, 1), (p, -1, 1), fixed={e: 2, n: 1, b: 1})
    if draw is not tubes:
        for mode in ({a: a, b: b, p: -1, n: 1}, {a: a, b: b, p: a, n: 1}, {a: a, b: b, p: 1, n: b}):
            with pytest.raises(BadInputError, match="by its assumptions"):
                draw(G, (a, -1, 1), (b, 0, 1), modes=[mode])
    with pytest.raises(BadInputError, match="p is positive"):
        boundaries(F)[0].root(p, (-2, -1), {e: 2, n: 1, a: 1, b: 1})


def test_charts_and_curves_go_through_numbers_not_integers():
    """A frequency, or a parameter that is an integer, is no axis; a phase without a value is named."""
    n, w, phi = Symbol("n", integer=True), Symbol("w"), Symbol("phi")
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(n * t + 1), 0]]), t, 6)
    G = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(w * t), 0]]), t, 6, 2 * pi / w)
    H = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t + phi) - b * cos(2 * t), 0]]), t, 6)
    for draw in (chart, certify):
        for equation, match in ((F, "frequencies .* n"), (G, "frequencies .* w"), (H, "phi")):
            with pytest.raises(BadInputError, match=match):
                draw(equation, (a, 0, 1), (b, 0, 1))
        with pytest.raises(BadInputError, match="n is an integer"):
            draw(F, (a, 0, 1), (n, 1, 3), fixed={b: 1})
    found = boundaries(F)[0]
    for ask in (lambda: found.root(n, (1, 2), {a: 1, b: 1}),
                lambda: found.follow((a, 0, 1), (n, 1, 3), (0.5, 2), {b: 1}),
                lambda: crossing(found, found, a, n, (0.5, 2), {b: 1})):
        with pytest.raises(BadInputError, match="n is an integer"):
            ask()


def test_parameters_missing_from_an_argument_list_are_named():
    """A function of a alone cannot know b."""
    F = FloquetMatrix(MATHIEU, t, 4)
    for ask in (lambda: F.lambdify([a]), lambda: F.lambdify_trace([b]), lambda: F.lambdify([])):
        with pytest.raises(MissingParameterError):
            ask()
    for arguments in ((1,), (1, 2, 3), ()):
        with pytest.raises(BadTypeError, match="arguments"):
            F.lambdify([a, b])(*arguments)


@pytest.mark.parametrize("params", [3, [a, 3], None, [a, a], [a, b + 1], a + b, {a: 1, b: 2}.values()], ids=shown)
def test_arguments_of_a_function_are_distinct_symbols(params):
    """Numbers and expressions name no argument, and no symbol names two."""
    with pytest.raises(FastPicardError, match="params"):
        FloquetMatrix(MATHIEU, t, 2).lambdify(params)


@pytest.mark.parametrize(
    "values", [{a: 1, b: 1, "c": 2}, {a: 1, b: 1, 3: 2}, {a + b: 1}, {f(t): 1}, [(a, 1)], 3, [1, 2], {a, b}], ids=shown
)
def test_values_map_symbols_to_numbers(values):
    """Keys that are no symbols, and what is no mapping."""
    with pytest.raises(FastPicardError, match="values"):
        FloquetMatrix(MATHIEU, t, 2).evaluate(values)


def test_the_time_has_no_place_among_the_values():
    """It is an argument of its own; a value for it would be ignored."""
    for ask in (
        lambda: FloquetMatrix(MATHIEU, t, 2).evaluate({a: 1, b: 1, t: 3}),
        lambda: PoissonSeries(cos(t), t).evaluate(1, {t: 3}),
        lambda: FundamentalMatrix(MATHIEU, t, 2).evaluate(1, {a: 1, b: 1, t: 3}),
        lambda: FloquetMatrix(MATHIEU, t, 2).lambdify([a, b, t]),
    ):
        with pytest.raises(BadInputError, match="time"):
            ask()


# -- values at which nothing is defined -----------------------------------------------------


def test_a_value_at_a_pole_of_a_coefficient_is_refused():
    """1/a at a = 0 has no value, in digits as in floats."""
    for ask in (
        lambda: PoissonSeries(cos(t) / a, t).evaluate(1, {a: 0}),
        lambda: PoissonSeries(cos(t) / a, t).evaluate(1, {a: 0}, 30),
        lambda: PoissonSeries(t / (a + b), t).evaluate(1, {a: 1, b: -1}),
        lambda: PoissonSeries(cos(a * t), t).integrate().evaluate(1, {a: 0}),
        lambda: PoissonSeries(sqrt(a), t).evaluate(1, {a: -1}),
    ):
        with pytest.raises(BadInputError):
            ask()


def test_a_series_with_the_imaginary_unit_has_no_real_value():
    """exp(I t) is a series, but not a real one."""
    with pytest.raises(BadInputError, match="real"):
        PoissonSeries(exp(I * t), t).evaluate(1)


@pytest.mark.parametrize("exponent", [-1, 1.5, True, "2", Rational(1, 2), a, None, 2.0], ids=shown)
def test_powers_of_a_series_are_natural_numbers(exponent):
    """Other powers leave the family."""
    with pytest.raises(FastPicardError, match="exponent"):
        PoissonSeries(cos(t), t) ** exponent


@pytest.mark.parametrize(
    "expression", [t**20000, t ** (10**30), cos(t) ** (10**9), (1 + t) ** (10**12)], ids=lambda e: str(e)[:20]
)
def test_powers_beyond_all_reason_are_refused_before_any_work(expression):
    """Instead of filling the memory."""
    with pytest.raises(BadInputError, match="power"):
        PoissonSeries(expression, t)


@pytest.mark.parametrize("k", [-1, 5, 3], ids=shown)
def test_increments_outside_the_iterate_are_refused(k):
    """I_0 .. I_n exist; the rest needs a higher order."""
    with pytest.raises(BadInputError):
        FundamentalMatrix(MATHIEU, t, 2).increment(k)


def test_messages_say_claim_value_and_remedy():
    """The three sentences of a message, at one example of every exception."""
    cases = [
        (NotPeriodicError, lambda: FloquetMatrix([[cos(t / 2)]], t, 1), ("does not repeat", "cos(t/2)", "period=4*pi")),
        (NotInFamilyError, lambda: new_integrate(tan(t), t), ("family", "tan(t)", "Expand")),
        (ShapeError, lambda: FloquetMatrix([[1, 2]], t, 1), ("square", "(1, 2)", "unknowns")),
        (MissingParameterError, lambda: FloquetMatrix([[a]], t, 1).evaluate({}), ("parameter", "a", "Add a")),
        (BadTypeError, lambda: PoissonSeries("cos(t)", t), ("text", "'cos(t)'", "Symbol")),
        (BadInputError, lambda: fast_picard([[1]], t, [1], -2), ("integer from 0 up", "-2", "integrations")),
    ]
    for kind, ask, words in cases:
        with pytest.raises(kind) as caught:
            ask()
        assert all(word in str(caught.value) for word in words), str(caught.value)


@pytest.mark.parametrize(
    "kind, builtin",
    [
        (BadInputError, ValueError),
        (BadTypeError, TypeError),
        (NotInFamilyError, ValueError),
        (NotPeriodicError, ValueError),
        (ShapeError, ValueError),
        (MissingParameterError, ValueError),
    ],
)
def test_every_exception_is_also_the_builtin_one_would_guess(kind, builtin):
    """`except ValueError` keeps working for who does not know our names."""
    assert issubclass(kind, builtin) and issubclass(kind, FastPicardError)


@pytest.mark.parametrize("X", [FundamentalMatrix(MATHIEU, t, 1), FloquetMatrix(MATHIEU, t, 1)])
def test_entries_that_a_matrix_does_not_have_are_refused(X):
    """Beyond the shape; parts of the matrix; one index alone."""
    for index in [(2, 0), (0, -3)]:
        with pytest.raises(BadInputError, match=r"a matrix of shape \(2, 2\) has no entry"):
            X[index]
    for index in [(slice(0, 1), 0), 1, (0, 0, 0), (0, 1.0), (True, 0), "ab"]:
        with pytest.raises(BadTypeError, match="an entry has two integers as its index"):
            X[index]


def test_messages_show_the_shapes_that_were_given():
    """Rows of different lengths, and a matrix in place of a vector."""
    with pytest.raises(ShapeError, match=r"its 2 rows have the lengths \[2, 1\]"):
        fast_picard([[0, 1], [-1]], t, [1, 1], 1)
    with pytest.raises(BadTypeError, match=r"x0 must be .* but it is Matrix"):
        fast_picard(MATHIEU, t, sympy.eye(2), 1)


def test_an_exact_matrix_refuses_another_symbol_with_the_name_of_the_time():
    """As a series does."""
    with pytest.raises(BadInputError, match="share the name"):
        FundamentalMatrix(MATHIEU, t, 1)(Symbol("t", real=True))


@pytest.mark.parametrize(
    "value, message",
    [
        (1 + 2j, "real numbers"),
        ([1, 1j], "real numbers"),
        (sympy.I, "real numbers"),
        (True, "real numbers"),
        ([a, True], "real numbers"),
        (np.datetime64("2020-01-01"), "real numbers"),
        (np.array(["1"]), "real numbers"),
        (None, "real numbers"),
        ([[1, 2], [3]], "real numbers"),
        (np.ma.array([1.0, 2.0], mask=[True, False]), "without a mask"),
        (10**400, "range of doubles"),
        (np.ones(2), r"shapes that broadcast, but these are \[\(2,\), \(3,\)\]"),
    ],
    ids=str,
)
def test_compiled_functions_refuse_what_a_double_cannot_say(value, message):
    """The imaginary part, the mask, the unit of a date: nothing is dropped; other real numbers are taken."""
    f = FloquetMatrix(MATHIEU, t, 2).lambdify_trace([a, b])

    with pytest.raises(FastPicardError, match=f"the arguments must .*{message}"):
        f(value, np.ones(3))
    assert f(Fraction(1, 2), [1, Rational(1, 4), mpmath.mpf(3)]).tolist() == f(0.5, [1, 0.25, 3]).tolist()


@pytest.mark.parametrize("divisor", [0, 0.0, sympy.S.Zero, cos(t), PoissonSeries(cos(t), t), "2", True, nan], ids=shown)
def test_a_series_is_not_divided_by_zero_or_by_functions_of_time(divisor):
    """The quotient would leave the family."""
    with pytest.raises(FastPicardError, match="divisor"):
        PoissonSeries(cos(t), t) / divisor


@pytest.mark.parametrize("ask", [
    lambda F, B: F.lambdify({a, b}),
    lambda F, B: F.lambdify_trace(frozenset([a, b])),
    lambda F, B: F.entry(0, 2),
    lambda F, B: F.evaluate({a: mpmath.iv.mpf([0, 1]), b: 1}),
    lambda F, B: F.evaluate({a: Decimal("nan"), b: 1}),
    lambda F, B: F.evaluate({a: sympy.nan, b: 1}),
    lambda F, B: F.evaluate({a: 1, b: 1}, digits=10**10),
    lambda F, B: F.enclosure({a: sympy.Float("1e10000"), b: 1}),
    lambda F, B: tabulate(F, {a: (-1e6, 1), b: 0}),
    lambda F, B: certify(F, (a, arb("0 +/- 1"), 2), (b, 0, 1)),
    lambda F, B: certify(F, (a, 0, 1), (b, -1e-320, 1)),
    lambda F, B: certify(F, (a, -(10**400), 1), (b, 0, 1)),
    lambda F, B: certify(F, (a, 0, 1), (b, 0, Rational(1, 10**400))),
    lambda F, B: certify(F, (a, 0, 1000), (b, 0, 1)),
    lambda F, B: tubes(F, (a, 1e100, 1e101), (b, 0, 1)),
    lambda F, B: certify(F, (a, 0, 1), (b, 0, 1), fixed=5),
    lambda F, B: certify(F, (a, 0, 1), (b, 0, 1), modes=[]),
    lambda F, B: boundaries(F.P),
    lambda F, B: B.root(a, (-0.7, 0.2), 5),
    lambda F, B: B.follow((a, -1, 1), (b, 0, 1), (5, 5)),
    lambda F, B: B.follow((a, 1, -1), (b, 0, 1), (0, 0)),
    lambda F, B: B.follow((a, -1, 1), (b, 0, 1), ("0.1", "0.2")),
    lambda F, B: B.follow((a, -1, 1), (b, 0, 1), None),
    lambda F, B: B.follow((a, -1, 1), (b, 0, 1), (0, 0.1), step=0),
    lambda F, B: crossing(B, B, a, b, None),
    lambda F, B: crossing(B, B, a, a, (0, 0.1)),
    lambda F, B: crossing(F, B, a, b, (0, 0.1)),
    lambda F, B: chart(F, (a, -1, 1), (b, 0, 1), points=(10**9, 10**9)),
    lambda F, B: chart(F, (a, -1, 1), (b, 0, 1), points=(4, 4), fixed={"c": 1}),
    lambda F, B: certify(F, (a, 0, 0), (b, 0, 1)),
    lambda F, B: chart(F, (a, -1, 1), (b, 0, 1), points=(4, 4)).isel(a=3).plot(),
    lambda F, B: chart(F, (a, -1, 1), (b, 0, 1), points=(4, 4)).plot([]),
    lambda F, B: certify(F, (a, -1, 1), (b, 0, 1), undecided=1).plot("title"),
    lambda F, B: F.lambdify([a, b], [1, 2]),
    lambda F, B: F.P[1, 0].evaluate({a: 1, b: 2}),
    lambda F, B: F.P[1, 0].diff(a),
    lambda F, B: tubes(F, (a, -1, 1), (b, 0, 1)).pieces[0].points("a"),
    lambda F, B: tubes(F, (a, -1, 1), (b, 0, 1), radius=0),
    lambda F, B: tubes(F, (a, -1, 1), (b, 0, 1), radius="x"),
])
def test_what_charts_and_curves_cannot_take_is_named(ask):
    """Sets, which have no order; ends that are no floats; points outside; text."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 10)
    with pytest.raises((BadInputError, BadTypeError, ShapeError, IndexError), match=r"(but|which|has no).*\."):
        ask(F, boundaries(F)[2])


@pytest.mark.parametrize("draw", [chart, certify, tubes])
@pytest.mark.parametrize("drive, top", [(10**400 * b, 1), (10**160 * b, 1), (b**2, 1e100), (b / 10**400, 1e160)])
def test_what_overflows_floats_on_a_chart_is_named(draw, drive, top):
    """Where a warning of NumPy's, or nan, would be all there is to see."""
    F = FloquetMatrix(Matrix([[0, 1], [-a - drive * cos(t), 0]]), t, 10)
    with pytest.raises(BadInputError, match=r"other units|is not of that kind"):
        draw(F, (a, 0, 1), (b, 0, top))


@pytest.mark.parametrize("build", [lambda x: cos(t * x), lambda x: x * cos(t), lambda x: sin(x) + cos(t + x)])
def test_an_entry_of_a_matrix_without_entries_is_no_parameter(build):
    """SymPy cannot put numbers into M[0, 0]; a Symbol can have its name."""
    entry = sympy.MatrixSymbol("M", 2, 2)[0, 0]
    with pytest.raises(NotInFamilyError, match="entry of a matrix"):
        PoissonSeries(build(entry), t)
    assert PoissonSeries(build(Symbol("M00")), t)(0) == build(Symbol("M00")).subs(t, 0)


@pytest.mark.parametrize("f, words", [
    (lambda time, x: [[x[0]], [x[1], 1]], "rows have the lengths"),
    (lambda time, x: [Symbol("q", commutative=False) * x[0], 0], "commute"),
    (lambda time, x: [Symbol("t", real=True) * x[0], 0], "not the assumptions"),
], ids=["ragged", "noncommutative", "namesake"])
def test_components_of_f_are_expressions_in_the_time_given(f, words):
    """A second t would stay in the result as a constant, without a word."""
    with pytest.raises(BadInputError, match=words):
        picard(f, Symbol("t"), [1, 2], 2)


def test_an_array_where_one_number_is_asked_for_is_told_of_lambdify():
    """Values and times."""
    F = FloquetMatrix([[0, 1], [-a - b * cos(t), 0]], t, 3)
    for ask in (lambda x: F.evaluate({a: x, b: 1}), lambda x: F.verdict({a: x, b: 1}),
                lambda x: FundamentalMatrix(F.P, t, 3).evaluate(x, {a: 1, b: 1})):
        with pytest.raises(BadTypeError, match="lambdify makes take arrays"):
            ask(np.array([0.1, 0.2]))


def test_a_matrix_without_entries_is_none():
    """Nested tuples as well, the form that the engine itself uses."""
    for rows in (((),), ((), ()), [[]]):
        with pytest.raises(ShapeError):
            SeriesMatrix(rows, t)
