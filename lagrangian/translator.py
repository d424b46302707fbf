"""numba with less to do: what a first call would wait for, and no function of this package needs.

numba is ready for all of Python and NumPy; here there are loops over arrays of floats.  Left out are SciPy's linear
algebra, which numba loads only to learn that it is there; passes over the source for closures, ``with``, array
expressions and the like; and, in functions that make no arrays, counting who holds one.

Importing this file imports numba; :mod:`lagrangian.machine` does so where it is installed, and when it is used.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager
from numba.np import linalg

__all__ = ["Passes"]

UNNEEDED = {"DumpParforDiagnostics", "FindLiterallyCalls", "InlineClosureLikes", "InlineInlinables",
            "LiteralPropagationSubPipelinePass", "LiteralUnroll", "MakeFunctionToJitFunction",
            "NoPythonSupportedFeatureValidation", "NopythonRewrites", "RewriteDynamicRaises", "WithLifting"}
UNCOUNTED = UNNEEDED | {"IRLegalization"}  # which marks where each variable ends


class Passes(CompilerBase):
    """numba's own passes, in their order, but for those above."""

    def define_pipelines(self) -> list[PassManager]:
        passes, left_out = PassManager("nopython"), UNNEEDED if self.state.flags.nrt else UNCOUNTED
        for kind, description in DefaultPassBuilder.define_nopython_pipeline(self.state).passes:
            if kind.__name__ not in left_out:
                passes.add_pass(kind, description)
        passes.finalize()
        return [passes]


def _load_arrays() -> None:
    """Import numba's functions of arrays; that ``np.dot`` has its library is seen when it is used."""
    if find_spec("scipy") is not None and hasattr(linalg, "ensure_blas"):
        check, linalg.ensure_blas = linalg.ensure_blas, lambda: None
        try:
            import_module("numba.np.arraymath")
        finally:
            linalg.ensure_blas = check


_load_arrays()
