"""Sine and cosine of differences of angles, against 40 digits of mpmath."""

import mpmath
import pytest
from hypothesis import given, strategies as st

from lagrangian.angles import LARGEST, difference, sines

WORST = 4e-16  # relative
LAST = 2.0**-104  # of the angles: what the remainder of their difference rounds to


def check(a: float, b: float) -> None:
    """Sine and cosine of ``a - b`` are right but for their last digits."""
    with mpmath.workdps(40):
        true = mpmath.mpf(a) - mpmath.mpf(b)
        for found, right in zip(sines(*difference(a, b)), (mpmath.sin(true), mpmath.cos(true)), strict=True):
            assert abs(found - right) <= WORST * abs(right) + LAST * (abs(a) + abs(b))


@given(st.floats(-LARGEST / 2, LARGEST / 2), st.floats(-LARGEST / 2, LARGEST / 2))
def test_differences_of_any_angles(a: float, b: float) -> None:
    """What the difference of the floats rounds off is not lost."""
    check(a, b)


@given(st.integers(-1000, 1000), st.floats(1e-17, 1e-3), st.floats(-5, 5))
def test_next_to_multiples_of_a_quarter_turn(quarters: int, beside: float, b: float) -> None:
    """Where a sine or cosine nearly vanishes, it has its digits too."""
    check(b + quarters * float(mpmath.pi / 2) + beside, b)
    check(quarters * float(mpmath.pi / 2), 0.0)


@pytest.mark.parametrize(("angle", "expected"), [(0.0, (0.0, 1.0)), (-0.0, (0.0, 1.0))])
def test_at_zero_nothing_is_rounded(angle: float, expected: tuple[float, float]) -> None:
    """A rod in line with the one before it is exactly so."""
    assert sines(angle, 0.0) == expected
