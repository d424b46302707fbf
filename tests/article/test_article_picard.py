"""The article's sections 1 to 4: Picard iterates, Out[3] to Out[15]."""

import mpmath
from sympy import (
    Integral,
    Matrix,
    Rational,
    cos,
    cot,
    csc,
    exp,
    expand,
    fresnelc,
    fresnels,
    lambdify,
    mathieuc,
    mathieus,
    pi,
    simplify,
    sin,
    sqrt,
    symbols,
)

from fastpicard import (
    FloquetMatrix,
    FundamentalMatrix,
    fast_picard,
    gather,
    mathieu_a,
    mathieu_b,
    new_integrate,
    picard,
    product_to_sum,
)

a, b, s, t = symbols("a b s t")

MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])
START = [1, -2]

# In[10]
SPIRAL = Matrix([[-1 + a * cos(t) ** 2, 1 - a * sin(t) * cos(t)], [-1 - a * sin(t) * cos(t), -1 + a * sin(t) ** 2]])

# What Out[3] integrates minus the sine of, from 0 to t.
INNER_ARGUMENT = (1 - cot(1) + cos(1 - s**2 * sin(1) / 2) * csc(1)
                  - s * fresnelc(s / sqrt(pi * csc(1))) * sqrt(pi * sin(1))
                  + s * cot(1) * fresnels(s / sqrt(pi * csc(1))) * sqrt(pi * sin(1)))

OUT_5 = [
    [1 - 2*t,
     -2 - a*t - b*sin(t)],
    [1 - b - 2*t - a*t**2/2 + b*cos(t),
     -2 - 2*b - a*t + a*t**2 + 2*b*cos(t) - b*sin(t) + 2*b*t*sin(t)],
    [1 - b - 2*t - 2*b*t - a*t**2/2 + a*t**3/3 + b*cos(t) - 2*b*t*cos(t) + 4*b*sin(t),
     -2 - 2*b - a*t + a*b*t - b**2*t/2 + a*t**2 + a**2*t**3/6 + 2*b*cos(t) + a*b*t*cos(t) - b*sin(t)
     - 2*a*b*sin(t) + b**2*sin(t) + 2*b*t*sin(t) + a*b*t**2*sin(t)/2 - b**2*cos(t)*sin(t)/2],
]

OUT_6 = [OUT_5[2][1], (-a - b*cos(t)) * OUT_5[2][0]]


def printed(number):
    """A number as Mathematica prints it: six significant digits, no zeros at the end."""
    return f"{float(number):.6g}"


def pendulum(_time, x):
    """In[3], with components taken by ``[[ ]]``, as the article means it."""
    return [x[1], -sin(x[0])]


def test_out_03():
    """The fifth iterate of the pendulum is an unevaluated integral, minus the sine of the fourth, as printed."""
    fourth = picard(pendulum, t, [1, 0], 4)[0]
    assert not fourth.has(Integral)
    for place, value in ((Rational(1, 2), "0.8960384188627918871686463001263022985899"),
                         (2, "-0.2617747293319052899809507654326111740005")):
        assert abs(fourth.subs(t, place).evalf(40) - INNER_ARGUMENT.subs(s, place).evalf(40)) < 1e-38
        assert abs(fourth.subs(t, place).evalf(45) - Rational(value)) < 1e-39
    fifth = picard(pendulum, t, [1, 0], 5)[1]
    assert isinstance(fifth, Integral)
    (variable, low, high), = fifth.limits
    assert (low, high) == (0, t)
    assert fifth.function == -sin(fourth.subs(t, variable))
    value_at_1 = mpmath.quad(lambdify(variable, fifth.function, "mpmath"), [0, 1])
    assert abs(value_at_1 - mpmath.mpf("-0.7550130260910318948")) < 1e-14


def test_out_04():
    """MathieuC and MathieuS of (4a, -2b, t/2) solve Mathieu's equation, and bound stability where theirs are periodic.

    SymPy knows the derivatives of these functions, not their values.
    """
    for solution in (mathieuc, mathieus):
        y = solution(4*a, -2*b, t/2)
        assert expand(y.diff(t, 2) + (a + b*cos(t)) * y) == 0
    floquet = FloquetMatrix(MATHIEU, t, 40)
    for characteristic, r, trace in ((mathieu_a, 0, 2), (mathieu_a, 1, -2), (mathieu_b, 1, -2), (mathieu_b, 2, 2)):
        edge = characteristic(r, Rational(-6, 5)) / 4
        assert abs(floquet.trace_at({a: edge, b: Rational(3, 5)}) - trace) < 1e-13


def test_out_05():
    """The first three iterates of Mathieu's equation from (1, -2) are those printed, by either function.

    The right-hand side may use the time it is given, or the symbol itself.
    """
    for n, expected in enumerate(OUT_5, start=1):
        slow = picard(lambda time, x: MATHIEU.subs(t, time) * x, t, START, n)
        assert slow == picard(lambda _, x: MATHIEU * x, t, START, n)
        fast = fast_picard(MATHIEU, t, START, n).as_matrix()
        for i in range(2):
            assert product_to_sum(slow[i] - expected[i], t) == 0
            assert fast[i] == product_to_sum(expected[i], t)


def test_out_06():
    """P times the third iterate is what is printed, stays in the family, and integrates to the fourth iterate."""
    product = MATHIEU * fast_picard(MATHIEU, t, START, 3).as_matrix()
    for found, expected in zip(product, OUT_6, strict=True):
        assert product_to_sum(found, t) == product_to_sum(expected, t)
        assert expand(gather(found, t) - product_to_sum(expected, t)) == 0
    fourth = Matrix(START) + new_integrate(product, t)
    assert fast_picard(MATHIEU, t, START, 4).as_matrix() == fourth.applyfunc(expand)


def test_out_07():
    """Its times are of another century, but the remark below it holds: eight iterates are too few up to 2 pi.

    At a = 0.9, b = 0.6 the eighth iterate of In[7] is 30 times too large there; the twentieth has three digits.
    """
    values = {a: Rational(9, 10), b: Rational(6, 10)}
    eighth = fast_picard(MATHIEU, t, START, 8)
    for iterate, expected in ((eighth, [35.9197246105361505, -0.469752223345679]),
                              (eighth.to_order(20), [1.20054451472886152, -0.554085727733101555]),
                              (eighth.to_order(40), [1.20019630407787456, -0.554213050376101321])):
        assert abs(iterate.evaluate(2*pi, values)[:, 0] - expected).max() < 1e-13


def test_out_12():
    """Twenty iterates of the 2 x 2 example, a = 2, from (1, -2) to 2 pi give the two numbers printed."""
    P = SPIRAL.applyfunc(lambda entry: product_to_sum(entry, t))
    found = FundamentalMatrix(P, t, 20).evaluate(2*pi, {a: 2}) @ START
    assert [printed(x) for x in found] == ["535.492", "-0.00373489"]


def test_out_13():
    """The closed form, its exponent read as (a - 1) t and multiplied by (1, -2), gives the same; so does iteration.

    The true period is pi, not 2 pi: the multipliers over pi are negative, and 2 pi hides their sign.
    """
    closed = Matrix([[exp((a - 1)*t) * cos(t), exp(-t) * sin(t)], [-exp((a - 1)*t) * sin(t), exp(-t) * cos(t)]])
    assert simplify(closed.diff(t) - SPIRAL * closed) == Matrix.zeros(2)
    exact = (closed * Matrix(START)).subs({a: 2, t: 2*pi})
    assert [printed(x.evalf()) for x in exact] == ["535.492", "-0.00373489"]
    iterate = FundamentalMatrix(SPIRAL, t, 20).evaluate(2*pi, {a: 2}, digits=30)
    for i in range(2):
        assert abs(iterate[i, 0] * START[0] + iterate[i, 1] * START[1] - exact[i].evalf(30)) < 1e-11
    half = FloquetMatrix(SPIRAL, t, 20, period=pi).multipliers({a: 2})
    assert [printed(x.real) for x in half] == [printed(-exp(pi)), printed(-exp(-pi))]


def test_out_15():
    """The Floquet matrix of Mathieu's equation at (a, b) = (-0.1, 0.55) is the one printed."""
    found = FloquetMatrix(MATHIEU, t, 20).evaluate({a: -0.1, b: 0.55})
    assert [[printed(x) for x in row] for row in found] == [["-0.0397796", "18.6577"], ["-0.0535123", "-0.0397796"]]
