"""numba with less to do: what a first call would wait for, and no function of this package needs.

numba is ready for all of Python and NumPy; here there are loops over arrays of floats.  Left out are SciPy's linear
algebra, which numba loads only to learn that it is there; passes over the source for closures, ``with``, array
expressions and the like; asking again for the type of what two floats give; and, in functions that make no arrays,
counting who holds one.

Importing this file imports numba; :mod:`lagrangian.machine` does so where it is installed, and when it is used.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import Any, ClassVar

from numba.core import types
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager
from numba.np import linalg

__all__ = ["Passes"]

UNNEEDED = {"DumpParforDiagnostics", "FindLiterallyCalls", "InlineClosureLikes", "InlineInlinables",
            "LiteralPropagationSubPipelinePass", "LiteralUnroll", "MakeFunctionToJitFunction",
            "NoPythonSupportedFeatureValidation", "NopythonRewrites", "RewriteDynamicRaises", "WithLifting"}
UNCOUNTED = UNNEEDED | {"IRLegalization"}  # which marks where each variable ends


class Remembering:
    """A typing context of numba that finds the types of ``float * float`` once; in all else the one it is made of.

    numba tries the rules of NumPy's arrays before those of numbers, at every operation.
    """

    found: ClassVar[dict[Any, Any]] = {}

    def __init__(self, context: Any) -> None:
        self.context = context

    def __getattr__(self, name: str) -> Any:
        return getattr(self.context, name)

    def resolve_function_type(self, function: Any, arguments: Any, named: Any) -> Any:
        """The signature, as numba's own method gives it."""
        if not all(type(x) in (types.Float, types.Integer) for x in arguments) or named:
            return self.context.resolve_function_type(function, arguments, named)
        key = function, tuple(arguments)
        if key not in self.found:
            self.found[key] = self.context.resolve_function_type(function, arguments, named)
        return self.found[key]


class Passes(CompilerBase):
    """numba's own passes, in their order, but for those above."""

    def define_pipelines(self) -> list[PassManager]:
        self.state.typingctx = Remembering(self.state.typingctx)
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
