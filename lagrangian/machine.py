"""Plain Python functions as machine code, where numba is installed.

Only this file knows of numba, :mod:`lagrangian.translator`, which says what it may leave out,
:mod:`lagrangian.pairtype`, which adds a number type to it, and :mod:`lagrangian.prefetch`, an instruction.

The recursions of this package are written once, as plain functions of numbers and arrays.  Run as they are
they take Python floats, NumPy arrays, mpmath numbers and python-flint balls; ``machine`` translates the
same source for float64.  Translation happens at the first call and is kept on disk for later processes.

A function and all that it calls are known to the cache under a digest of their instructions and constants,
so that code from an older version is never run.  Products and sums may be contracted (``a*b + c`` rounded
once); sums are reordered only in functions marked so.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from hashlib import sha256
from importlib import import_module
from importlib.util import find_spec
from types import CodeType, FunctionType
from typing import Any, TypeVar

__all__ = ["allocating", "as_written", "has_numba", "inlined", "machine", "prefetched", "rebound",
           "reordered", "stands_in"]

AnyFunction = TypeVar("AnyFunction", bound=Callable[..., Any])
PACKAGE = __name__.rpartition(".")[0]
_ALLOCATING: set[Callable[..., Any]] = set()
_INLINED: set[Callable[..., Any]] = set()
_REORDERED: set[Callable[..., Any]] = set()
_STAND_INS: dict[Callable[..., Any], Any] = {}


def allocating(function: AnyFunction) -> AnyFunction:
    """Mark a function that makes arrays; in others :func:`machine` does not count who holds one."""
    _ALLOCATING.add(function)
    return function


def inlined(function: AnyFunction) -> AnyFunction:
    """Mark a short function that :func:`machine` shall copy into its callers, so that loops over it vectorise."""
    _INLINED.add(function)
    return function


def reordered(function: AnyFunction) -> AnyFunction:
    """Mark a short function as :func:`inlined` does, whose sums may be taken in any order."""
    _REORDERED.add(function)
    return inlined(function)


def stands_in(function: Callable[..., Any]) -> Callable[[AnyFunction], AnyFunction]:
    """Mark a function that :func:`as_written` shall take in place of ``function``."""
    def mark(other: AnyFunction) -> AnyFunction:
        _STAND_INS[function] = other
        return other
    return mark


def prefetched(rows: Any, k: int, j: int) -> None:
    """Ask memory for ``rows[k, j]``, which is needed soon; nothing at all where it is not translated."""


@contextmanager
def undisturbed() -> Iterator[None]:
    """No search for garbage inside: numba makes much and keeps it, and searching would take a tenth of its time."""
    searching = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if searching:
            gc.enable()


@cache
def has_numba() -> bool:
    """Whether numba is installed; without it everything runs, some hundred times slower."""
    return find_spec("numba") is not None


def rebound(function: Any, **names: Any) -> FunctionType:
    """A copy of ``function`` that finds ``names`` in place of its globals of the same name."""
    return FunctionType(function.__code__, {**function.__globals__, **names}, function.__name__, function.__defaults__)


@cache
def machine(function: Callable[..., Any]) -> Callable[..., Any]:
    """``function`` translated for float64 and int64 arguments, or itself where numba is not installed."""
    if not has_numba():
        return function
    with undisturbed():
        return _translated(function)


def as_written(function: Any, operators: tuple[Any, ...] = ()) -> Callable[..., Any]:
    """``function`` translated by numba with every operation as it stands, neither contracted nor reordered.

    It is kept on disk where ``operators`` names the functions that it reaches as operators of its types, which no code
    shows; the file of ``function`` is to hold those types.
    """
    return _translated(function, True, operators)


@cache
def _translated(function: FunctionType, written: bool = False, operators: tuple[Any, ...] = (),
                called: bool = False) -> Callable[..., Any]:
    """``called``: from machine code alone, so that nothing is made for calls from Python, and nothing kept on disk."""
    names = {name: _part(callee, written) for name, callee in _callees(function, written)}
    copy = rebound(function, **names)
    digest = _shortened(_digest(part, written) for part in (function, *operators))
    copy.__module__, copy.__qualname__ = function.__module__, f"{function.__name__}_{digest}"
    options = {"cache": (bool(operators) or not written) and not called, "no_cpython_wrapper": called,
               "no_cfunc_wrapper": True, "fastmath": set() if written else {"contract"}, "error_model": "numpy",
               "nogil": True, "_nrt": written or function in _ALLOCATING}
    if function in _INLINED:
        options["forceinline"] = True
    if function in _REORDERED and not written:
        options["fastmath"] = {"contract", "reassoc", "nsz"}
    translator = import_module(f"{PACKAGE}.translator")
    found = import_module("numba").njit(pipeline_class=translator.Passes, **options)(copy)
    found.compile = undisturbed()(translator.remembering()(found.compile))
    return found  # type: ignore[no-any-return]


def _part(callee: FunctionType, written: bool) -> Any:
    """What stands for a function in the code of those that call it."""
    if callee is prefetched:
        return import_module(f"{PACKAGE}.prefetch").prefetch
    return _translated(callee, written, called=True)


def _callees(function: FunctionType, written: bool) -> Iterator[tuple[str, FunctionType]]:
    """The functions of this package that ``function`` calls by name, or what stands in for them."""
    for name in function.__code__.co_names:
        value = function.__globals__.get(name)
        if isinstance(value, FunctionType) and value.__module__.startswith(PACKAGE):
            yield name, _STAND_INS.get(value, value) if written else value


def _digest(function: FunctionType, written: bool) -> str:
    parts = [repr(_contents(function.__code__)), str(written)]
    parts += [f"{name}={function.__globals__[name]!r}" for name in function.__code__.co_names
              if isinstance(function.__globals__.get(name), (int, float, tuple))]
    parts += [_digest(callee, written) for _, callee in _callees(function, written)]
    return _shortened(parts)


def _shortened(parts: Iterable[str]) -> str:
    return sha256("\n".join(parts).encode()).hexdigest()[:12]


def _contents(code: CodeType) -> tuple[Any, ...]:
    constants = tuple(c for c in code.co_consts if not isinstance(c, CodeType))
    return code.co_code, constants, code.co_names, code.co_varnames
