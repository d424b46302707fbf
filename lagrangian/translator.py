"""numba with less to do: what a first call would wait for, and no function of this package needs.

numba is ready for all of Python and NumPy; here there are loops over arrays of floats.  Left out are SciPy's linear
algebra, which numba loads only to learn that it is there; passes over the source for closures, ``with``, array
expressions and the like; asking again for the type of what an operation gives; machine code of functions that are
parts of others; and, in functions that make no arrays, counting who holds one.

Importing this file imports numba; :mod:`lagrangian.machine` does so where it is installed, and when it is used.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import PassManager
from numba.core.errors import TypingError
from numba.core.types.functions import BaseFunction
from numba.np import linalg

__all__ = ["Passes", "remembering"]

UNNEEDED = {"DumpParforDiagnostics", "FindLiterallyCalls", "InlineClosureLikes", "InlineInlinables",
            "LiteralPropagationSubPipelinePass", "LiteralUnroll", "MakeFunctionToJitFunction",
            "NoPythonSupportedFeatureValidation", "NopythonRewrites", "RewriteDynamicRaises", "WithLifting"}
UNCOUNTED = UNNEEDED | {"IRLegalization"}  # which marks where each variable ends


_search = BaseFunction.get_call_type
FOUND: dict[int, tuple[Any, dict[Any, Any]]] = {}  # by identity: a function, and what it gives for types of arguments


def _find(function: Any, context: Any, arguments: Any, named: Any) -> Any:
    """The signature of one of numba's functions for arguments of these types, or its error that there is none."""
    if named:
        return _search(function, context, arguments, named)
    found = FOUND.setdefault(id(function), (function, {}))[1]
    key = tuple(arguments)
    if key not in found:
        try:
            found[key] = _search(function, context, arguments, named)
        except TypingError as error:
            found[key] = error
    if isinstance(found[key], TypingError):
        raise found[key].with_traceback(None)
    return found[key]


@contextmanager
def remembering() -> Iterator[None]:
    """Inside, numba finds the types of an operation once.

    It tries the rules of NumPy's arrays before those of numbers at every operation, and again when it is translated.
    """
    with global_compiler_lock:
        before = BaseFunction.get_call_type
        BaseFunction.get_call_type = _find  # type: ignore[assignment,method-assign]
        try:
            yield
        finally:
            BaseFunction.get_call_type = before  # type: ignore[method-assign]


class Part(JITCodeLibrary):
    """A function that machine code alone calls: its callers contain it, optimised and made machine code with them."""

    @property
    def codegen(self) -> Any:
        """What numba would tell the address of the function's globals: there is no address."""
        return self

    def set_env(self, name: str, environment: Any) -> None:
        """Nothing to do."""

    def get_pointer_to_function(self, name: str) -> int:
        """0, numba's word for none."""
        self._ensure_finalized()
        return 0

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


class Passes(CompilerBase):
    """numba's own passes, in their order, but for those above."""

    def define_pipelines(self) -> list[PassManager]:
        if self.state.flags.no_cpython_wrapper:
            self.state.library = Part(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
            self.state.library.enable_object_caching()
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
