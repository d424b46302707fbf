"""Problems at the edge of size: many terms, high powers, large matrices, extreme numbers."""

import mpmath
import pytest
import sympy
from flint import fmpq, fmpq_poly
from sympy import Add, Matrix, Rational, cos, pi, sin, symbols

from fastpicard import FloquetMatrix, FundamentalMatrix, PoissonSeries, new_integrate
from tests.oracles import closeness, same_tree

a, b, t = symbols("a b t")


def test_twenty_thousand_terms_are_integrated_and_differentiated_back():
    """sum k t**(k mod 7) cos(k t), k up to 20000: 80000 terms, their derivative is where they came from."""
    f = PoissonSeries(Add(*(k * t ** (k % 7) * cos(k * t, evaluate=False) for k in range(1, 20001))), t)
    found = f.integrate()

    assert len(f) == 20000
    assert len(found) == 79999
    assert found.diff() == f


@pytest.mark.parametrize("r", [30, 100, 300])
def test_high_powers_have_the_coefficients_of_repeated_integration_by_parts(r):
    """I[t**r cos t] = sum_k r!/(r-k)! t**(r-k) sin(t + k pi/2), less the value at 0."""
    expected = Add(*(sympy.ff(r, k) * t ** (r - k) * sin(t + k * pi / 2) for k in range(r + 1)))

    assert same_tree(new_integrate(t**r * cos(t), t), sympy.expand(expected - expected.subs(t, 0)))


@pytest.mark.parametrize("frequency", [Rational(1, 10**12), Rational(10**9 + 7, 10**9 + 9), 10**15], ids=str)
def test_frequencies_of_any_size_cancel_no_digit(frequency):
    """t cos(q t) over [0, 1] in fifty digits, where q**-2 cancels or vanishes."""
    found = PoissonSeries(t * cos(frequency * t), t).integrate().evaluate(1, {}, 50)

    with mpmath.workdps(90):
        q = (
            mpmath.mpf(int(frequency.p)) / int(frequency.q)
            if isinstance(frequency, Rational)
            else mpmath.mpf(frequency)
        )
        assert abs(found / (mpmath.sin(q) / q + (mpmath.cos(q) - 1) / q**2) - 1) < mpmath.mpf(10) ** -49


def test_order_two_hundred_of_a_constant_system_is_the_exponential_series():
    """x' = A x with rational A: Phi_200(t) = sum A**k t**k / k!, against plain rational arithmetic."""
    A = Matrix([[Rational(1, 3), 2, 0], [-1, Rational(1, 2), 1], [0, Rational(-2, 5), 1]])
    found = FundamentalMatrix(A, t, 200)
    power, series = [[fmpq(int(i == j)) for j in range(3)] for i in range(3)], fmpq_poly([1])
    exact = [[fmpq(int(x.p), int(x.q)) for x in A.row(i)] for i in range(3)]
    coefficients = [fmpq(1)]
    factorial = fmpq(1)
    for k in range(1, 201):
        power = [[sum((exact[i][m] * power[m][j] for m in range(3)), fmpq(0)) for j in range(3)] for i in range(3)]
        factorial *= k
        coefficients.append(power[0][0] / factorial)
    series = fmpq_poly(coefficients)

    value = series(fmpq(7, 3))
    with mpmath.workdps(60):
        assert (
            closeness(found[0, 0].evaluate(Rational(7, 3), {}, 50), mpmath.mpf(int(value.p)) / int(value.q))
            < mpmath.mpf(10) ** -48
        )


def test_eight_unknowns_with_a_chain_of_couplings():
    """A nilpotent chain of eight: x_8 is fed through seven waves; order 20 is order 7."""
    size = 8
    P = sympy.zeros(size)
    for i in range(size - 1):
        P[i + 1, i] = sin((i + 1) * t) + a
    at_seven, at_twenty = FundamentalMatrix(P, t, 7), FundamentalMatrix(P, t, 20)

    assert at_seven.series == at_twenty.series
    assert at_seven[7, 0].diff() == at_twenty[6, 0] * (sin(7 * t) + a)


@pytest.mark.parametrize("scale", [Rational(1, 10**30), 10**30], ids=str)
def test_coefficients_of_any_size_are_exact(scale):
    """Parameters scaled by 1e30 scale the trace polynomial's monomials exactly."""
    plain = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 8).trace()
    scaled = FloquetMatrix(Matrix([[0, 1], [-scale * a - scale * b * cos(t), 0]]), t, 8).trace()

    assert sympy.expand(plain.subs({a: scale * a, b: scale * b}, simultaneous=True)) == scaled
