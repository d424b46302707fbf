"""Packages that are needed for a part of the work only, and are imported when it is asked for."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from .errors import NotInstalledError

__all__ = ["optional"]


def optional(module: str, purpose: str, instead: str = "") -> Any:
    """A module of a package that may be missing; raises NotInstalledError, saying what needs it, where it is.

    ``instead`` is what would do without the package.
    """
    package = module.partition(".")[0]
    if find_spec(package) is None:
        remedy = f", or {instead}" if instead else ""
        raise NotInstalledError(f"{purpose} needs {package}, which is not installed: pip install {package}{remedy}.")
    return import_module(module)
