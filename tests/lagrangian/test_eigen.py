"""Modes as numbers: proved in balls, against mpmath's symmetric eigenproblem, and where modes are equal."""

import random

import pytest
from flint import arb
from sympy import Integer, Matrix, Rational, diag, laguerre_poly, sqrt, symbols, zeros

from lagrangian import eigen


def bobs(masses, lengths):
    """A and B of bobs about rest, in which g is 1."""
    n = len(masses)
    A = Matrix(n, n, lambda i, j: sum(masses[max(i, j):]) * lengths[i] * lengths[j])
    return A, diag(*[sum(masses[i:]) * lengths[i] for i in range(n)])


@pytest.mark.parametrize("seed", range(6))
def test_proved_modes_equal_those_of_the_symmetric_problem(seed, monkeypatch):
    """Masses 1e12 apart, irrational lengths, 3 to 8 bobs: 30 digits, by two routes; and by none that is not proved."""
    draw = random.Random(seed)
    n = 3 + seed
    masses = [Rational(draw.randint(1, 45), 5) * Integer(10) ** draw.choice([-6, 0, 6]) for _ in range(n)]
    A, B = bobs(masses, [sqrt(draw.randint(1, 9)) for _ in range(n)])
    mu, U = eigen._until_still(A, B, 30, 400)
    monkeypatch.delattr(eigen, "_until_still")
    proved, modes = eigen.eigenpairs(A, B, 30)

    assert all(abs(x - y) <= Rational(1, 10**29) * abs(y) for x, y in zip(proved, mu, strict=True))
    least = Rational(1, 10**28)
    assert all(abs(x - y) <= least * max(abs(y), least) for x, y in zip(modes, U, strict=True))


@pytest.mark.parametrize("step", [-12, 12])
def test_the_precision_follows_the_masses(step):
    """Masses 1, 1e12, 1e24, 1e36 and the other way round: the digits are as many."""
    A, B = bobs([Integer(10) ** (step * k) for k in range(4)], [1] * 4)
    (mu, U), (finer, modes) = eigen.eigenpairs(A, B, 30), eigen._until_still(A, B, 30, 1000)

    assert all(abs(x - y) <= Rational(1, 10**29) * y for x, y in zip(mu, finer, strict=True))
    assert all(abs(x - y) <= Rational(1, 10**29) * abs(y) for x, y in zip(U, modes, strict=True) if abs(y) > 1e-25)


def test_twenty_five_bobs_have_the_zeros_of_the_laguerre_polynomial():
    """With 60 digits, by the change of sign of L_25 about every one of them."""
    mu, _ = eigen.eigenpairs(*bobs([1] * 25, [1] * 25), 60)
    x = symbols("x")
    near = Rational(1, 10**58)
    for value in map(Rational, mu):
        below, above = (laguerre_poly(25, x, polys=True).eval(value * (1 + side * near)) for side in (-1, 1))
        assert below * above < 0


@pytest.mark.parametrize("ball, digits, enough", [
    (arb(3, 1e-21), 20, True), (arb(3, 1e-19), 20, False), (arb("1e-25", 1e-42), 20, True),
    (arb("1e-25", 1e-38), 20, False), (arb(0, 1e-42), 20, True)])
def test_no_ball_is_rounded_that_is_too_wide(ball, digits, enough):
    """Beside a number 1, small ones need be right to 20 digits of 1e-20 only, as they say."""
    assert (eigen._rounded([arb(1), ball], digits) is not None) == enough


@pytest.mark.parametrize("B", [zeros(4, 4), Matrix([[4, 3, 2, 1], [3, 3, 2, 1], [2, 2, 2, 1], [1, 1, 1, 1]])])
def test_equal_modes_stay_orthogonal(B):
    """All mu equal 0, or 1: no ball can prove it, and U still diagonalises A."""
    A, _ = bobs([1] * 4, [1] * 4)
    mu, U = eigen.eigenpairs(A, B, 20)
    product = U.T * A * U

    assert all(abs(x - (1 if B[0] else 0)) < Rational(1, 10**19) for x in mu)
    assert all(abs(product[i, j]) < Rational(1, 10**15) * product[i, i] for i in range(4) for j in range(4) if i != j)
