"""What the package needs and does not need to be installed, and what is loaded when."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lagrangian import CompiledChain, simulate

TOP = Path(__file__).parent.parent.parent


def run(code):
    """The output of ``code`` in a new Python that turns warnings into errors."""
    command = [sys.executable, "-W", "error", "-c", code]
    done = subprocess.run(command, cwd=TOP, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_importing_loads_neither_compilers_nor_solvers_nor_pictures():
    """numba, SciPy, matplotlib, xarray and heyoka are loaded when they are used."""
    heavy = "numba", "scipy", "matplotlib", "xarray", "heyoka", "pandas", "dask"
    found = run(f"import sys, lagrangian; print([name for name in {heavy} if name in sys.modules])")

    assert found.strip() == "[]"


WITHOUT_NUMBA = """
import json, sys
sys.modules["numba"] = None
from lagrangian import CompiledChain, simulate
from lagrangian.machine import has_numba
assert not has_numba()
chain = CompiledChain([1.0, 2.0, 0.5], [1.0, 0.7, 1.2], [0.5, 0.3, 0.6], [0.6, 0.5, 0.8], damping=[0.1, 0, 0.2])
bobs = CompiledChain([1.0, 2.0], [1.0, 0.7], [1.0, 0.7], [1.0, 0.7])
state = [0.1, 0.2, 0.3], [1.0, -2.0, 0.5]
many = [[[x, x + 0.5] for x in part] for part in state]
print(json.dumps([chain.acceleration(0, *state).tolist(), chain.acceleration(0, *many).tolist(),
                  bobs.acceleration(0, [1e9, 0.3], [1.0, 1.0]).tolist(),
                  simulate(chain, *state, [0, 0.2], accuracy=1e-8).theta.tolist()]))
"""


def test_without_numba_everything_runs_and_gives_the_same_numbers():
    """The same source as plain Python: accelerations, many chains, bobs, large angles, Taylor steps."""
    pytest.importorskip("numba")
    single, many, bobs, theta = json.loads(run(WITHOUT_NUMBA))
    chain = CompiledChain([1.0, 2.0, 0.5], [1.0, 0.7, 1.2], [0.5, 0.3, 0.6], [0.6, 0.5, 0.8], damping=[0.1, 0, 0.2])
    state = [0.1, 0.2, 0.3], [1.0, -2.0, 0.5]
    both = [np.array([[x, x + 0.5] for x in part]) for part in state]
    other = CompiledChain([1.0, 2.0], [1.0, 0.7], [1.0, 0.7], [1.0, 0.7])

    assert np.allclose(single, chain.acceleration(0, *state), rtol=1e-12, atol=1e-12)
    assert np.allclose(many, chain.acceleration(0, *both), rtol=1e-12, atol=1e-12)
    assert np.allclose(bobs, other.acceleration(0, [1e9, 0.3], [1.0, 1.0]), rtol=1e-12, atol=1e-12)
    assert np.allclose(theta, simulate(chain, *state, [0, 0.2], accuracy=1e-8).theta, rtol=0, atol=1e-11)
