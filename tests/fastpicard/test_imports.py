"""What importing costs: nothing heavy, and only names that exist."""

import subprocess
import sys

import pytest
from sympy import Matrix, cos
from sympy.abc import a, b, t

import fastpicard
import lagrangian
from fastpicard import FloquetMatrix, NotInstalledError, certify, chart
from tests.conftest import hide


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
    """__all__ holds no ghosts, and each name has a docstring: that which Python gives to data is its signature."""
    for package in (fastpicard, lagrangian):
        for name in package.__all__:
            said = getattr(package, name).__doc__
            assert said and not said.startswith(f"{name}(")


@pytest.mark.parametrize("package, ask", [
    ("xarray", lambda F: lambda: chart(F, (a, -1, 2), (b, 0, 2), points=(2, 2))),
    ("matplotlib", lambda F: chart(F, (a, -1, 2), (b, 0, 2), points=(2, 2)).plot),
    ("matplotlib", lambda F: certify(F, (a, 0.1, 0.2), (b, 0, 0.01), undecided=0.5, seconds=60).plot)])
def test_a_package_that_is_not_installed_is_named(monkeypatch, package, ask):
    """With what to do; it is an ImportError too."""
    question = ask(FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), 0]]), t, 8))
    hide(monkeypatch, package)
    with pytest.raises(NotInstalledError, match=f"needs {package}, which is not installed: pip install {package}"):
        question()

    assert issubclass(NotInstalledError, ImportError)
