"""What importing costs: nothing heavy, and only names that exist."""

import subprocess
import sys

import pytest

import fastpicard


@pytest.mark.parametrize("heavy", ["scipy", "matplotlib", "pandas", "dask", "numba", "xarray"])
def test_importing_brings_nothing_heavy_along(heavy):
    """In a fresh process, warnings being errors; also after a first result."""
    program = (
        "import sys, sympy, fastpicard\n"
        "t = sympy.Symbol('t')\n"
        "fastpicard.FloquetMatrix([[sympy.cos(t)]], t, 2).evaluate()\n"
        f"sys.exit('{heavy}' in sys.modules)"
    )

    assert subprocess.run([sys.executable, "-W", "error", "-c", program], check=False).returncode == 0


def test_every_promised_name_exists_and_says_what_it_is():
    """__all__ holds no ghosts, and each name has a docstring."""
    assert all(getattr(fastpicard, name).__doc__ for name in fastpicard.__all__)
    for name in (
        "gather",
        "product_to_sum",
        "new_integrate",
        "picard",
        "fast_picard",
        "FundamentalMatrix",
        "FloquetMatrix",
        "PoissonSeries",
    ):
        assert name in fastpicard.__all__
