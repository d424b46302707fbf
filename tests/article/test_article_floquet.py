"""The article's section 5, one rod: stability boundaries from traces and characteristic numbers, Out[26]-[31]."""

import mpmath
import pytest
from sympy import Matrix, Poly, Rational, cos, symbols

from fastpicard import FloquetMatrix, mathieu_a, mathieu_b

a, b, t = symbols("a b t")

MATHIEU = Matrix([[0, 1], [-a - b * cos(t), 0]])


def printed(number):
    """A number as Mathematica prints it: six significant digits, no zeros at the end."""
    return f"{float(number):.6g}"


def boundaries(amplitude, n=20):
    """All real ``a`` at which the trace of the n-th iterate is 2 or -2, ascending: In[26] in 60 digits."""
    trace = FloquetMatrix(MATHIEU.subs(b, amplitude), t, n).trace()
    found = []
    with mpmath.workdps(60):
        for bound in (-2, 2):
            coefficients = [mpmath.mpf(c.evalf(60)) for c in Poly(trace - bound, a).all_coeffs()]
            roots = mpmath.polyroots(coefficients, maxsteps=300, extraprec=300)
            found += [root.real for root in roots if abs(root.imag) < mpmath.mpf(10) ** -30]
    return sorted(found)


def characteristic_numbers(amplitude):
    """In[28]: a_0 .. a_3 and b_1, b_2 of q = -2 b, divided by 4, ascending."""
    q = -2 * amplitude
    return sorted([mathieu_a(r, q) / 4 for r in range(4)] + [mathieu_b(r, q) / 4 for r in (1, 2)])


def test_out_26():
    """At b = 0.1 the trace of the twentieth iterate is 2 or -2 at the six a printed, and nowhere else."""
    assert [printed(x) for x in boundaries(Rational(1, 10))] == [
        "-0.00497832", "0.198781", "0.298719", "0.993783", "1.01023", "2.2429"]


def test_out_27():
    """At b = 1.5 the trace of the twentieth iterate is 2 or -2 at the six a printed, and nowhere else."""
    assert [printed(x) for x in boundaries(Rational(3, 2))] == [
        "-0.708598", "-0.696345", "0.62976", "0.81923", "1.51241", "2.3711"]


def test_out_28():
    """The characteristic numbers at b = 0.1 are those printed."""
    assert [printed(x) for x in characteristic_numbers(Rational(1, 10))] == [
        "-0.00497832", "0.198781", "0.298719", "0.999167", "1.00414", "2.25059"]


def test_out_29():
    """The characteristic numbers at b = 1.5 are those printed."""
    assert [printed(x) for x in characteristic_numbers(Rational(3, 2))] == [
        "-0.708598", "-0.696345", "0.62976", "0.81923", "1.5113", "2.30578"]


@pytest.mark.parametrize("amplitude, sixth, seventh", [
    (Rational(1, 10), "2.250594027010409", "2.2506565"),
    (Rational(3, 2), "2.305783212066977", "2.4788766"),
])
def test_seventh_boundary_is_missed(amplitude, sixth, seventh):
    """A seventh boundary, b_3, lies in the range of Out[26]-[29]; the list of Out[28], [29] stops at a_3.

    Between a_3 and b_3 the trace is a little below -2.  Twenty iterates show one boundary there, forty show both.
    """
    a_3, b_3 = mathieu_a(3, -2 * amplitude) / 4, mathieu_b(3, -2 * amplitude) / 4
    assert abs(a_3 - mpmath.mpf(sixth)) < 1e-14 and f"{float(b_3):.8g}" == seventh
    assert max(characteristic_numbers(amplitude)) == a_3
    assert len([x for x in boundaries(amplitude) if x > 2]) == 1
    width = b_3 - a_3
    forty = FloquetMatrix(MATHIEU, t, 40)
    inside = [forty.trace_at({a: x, b: amplitude}, digits=20) < -2
              for x in (a_3 - width / 10, a_3 + width / 10, b_3 - width / 10, b_3 + width / 10)]
    assert inside == [False, True, True, False]


def test_out_31():
    """At (h, v) = (0.2, 40), that is a = -3/(2 v^2) and b = 3h/2, both multipliers lie on the unit circle.

    So the rod is stable there; the multipliers are a complex pair, hence different, hence no Jordan block.
    """
    values = {a: Rational(-3, 2 * 40**2), b: Rational(3, 2) * Rational(1, 5)}
    multipliers = FloquetMatrix(MATHIEU, t, 20).multipliers(values)
    assert [printed(abs(x)) for x in multipliers] == ["1", "1"]
    assert abs(multipliers[0] - multipliers[1]) > 1
