"""Run by .ci/run in an environment that holds only the wheel and the core dependencies."""

import sys
from importlib.metadata import files, version
from pathlib import Path

import fastpicard
import lagrangian

assert "site-packages" in Path(fastpicard.__file__).parts, fastpicard.__file__
assert "site-packages" in Path(lagrangian.__file__).parts, lagrangian.__file__

shipped = {str(path) for path in files("fastpicard") or []}
assert {"fastpicard/py.typed", "lagrangian/py.typed"} <= shipped, sorted(shipped)
assert not any(name.startswith(("tests/", "examples/", "docs/")) for name in shipped), sorted(shipped)

heavy = {"scipy", "matplotlib", "pandas", "xarray", "dask", "numba"} & sys.modules.keys()
assert not heavy, f"importing fastpicard and lagrangian imported {sorted(heavy)}"

missing = [name for name in fastpicard.__all__ if not hasattr(fastpicard, name)]
missing += [name for name in lagrangian.__all__ if not hasattr(lagrangian, name)]
assert not missing, f"promised by __all__ but absent: {missing}"

print(f"fastpicard {version('fastpicard')} imports from its wheel; nothing heavy came along")
