"""Sums and products of waves against the expressions they come from."""

import pytest
from hypothesis import given, strategies as st
from sympy import Integer, Rational, cos, exp, sin, sqrt, symbols

from lagrangian import Rod, Scene, Support
from lagrangian.waves import NoWave, waves_of

t, epsilon, phi, omega0 = symbols("t epsilon phi omega0")
rates = st.sampled_from([Integer(1), Integer(-2), Rational(1, 3), sqrt(2), Integer(100)])
leaves = st.builds(lambda wave, q, phase, c: c * wave(q * t + phase), st.sampled_from([cos, sin]), rates,
                   st.sampled_from([Integer(0), phi, Rational(1, 2)]), st.sampled_from([Integer(1), epsilon, sqrt(3)]))
sums = st.recursive(leaves | st.just(Integer(2)), lambda inner: st.one_of(
    st.builds(lambda x, y: x + y, inner, inner), st.builds(lambda x, y: x * y, inner, inner)), max_leaves=4)
powers = st.builds(lambda x, n: x**n, sums, st.integers(1, 2))


@given(powers, st.fractions(-5, 5))
def test_a_product_of_waves_is_the_sum_of_its_beats(expression, time):
    """Whatever is multiplied, its value stays."""
    found = waves_of(expression, t)
    assert all(q >= 0 for q in found)
    total = sum(c * cos(q * t) + s * sin(q * t) for q, (c, s) in found.items())
    at = {t: Rational(time), epsilon: Rational(3, 7), phi: Rational(5, 4)}
    assert abs((total - expression).xreplace(at).evalf(30)) < 1e-20


def test_a_high_power_of_a_wave_with_a_phase_has_short_coefficients():
    """Of degree 16 in cos(1/2) and sin(1/2), not of 2**16 factors."""
    found = waves_of(cos(t + Rational(1, 2))**16, t)
    assert len(found) == 9 and all(len(c.args) <= 17 for c, _ in found.values())


@pytest.mark.parametrize("expression", [t * cos(t), exp(-t) * cos(t), cos(t**2), 1 / cos(t), sqrt(cos(t)),
                                        cos(omega0 * t)])
def test_what_is_no_sum_of_waves_is_told_apart(expression):
    """Then the support moves by a function."""
    with pytest.raises(NoWave):
        waves_of(expression, t)


@pytest.mark.parametrize(("eta", "rates"), [
    (cos(t) * cos(2 * t), [1, 3]), ((1 + cos(t) / 2) * cos(10 * t), [9, 10, 11]), (cos(t)**8, [2, 4, 6, 8]),
    (cos(sqrt(2) * t)**2, [2 * sqrt(2)])])
def test_a_support_driven_by_a_product_moves_in_waves(eta, rates):
    """Beats are waves too, which cost least."""
    support = Scene([Rod.uniform(1, 1)], Support(0, eta / 10), gravity=1).compile().support
    assert support.function is None and [q for q, *_ in support.waves] == rates
    exact = eta.diff(t, 2).subs(t, Rational(7, 10)).evalf(20) / 10
    assert support.at(0.7) == pytest.approx((0, float(exact)), rel=1e-14)
