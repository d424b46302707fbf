"""Packages that are needed for a part of the work only, and are imported when it is asked for."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from fastpicard.errors import NotInstalledError


def optional(module: str, purpose: str) -> Any:
    """A module of a package that may be missing; raises NotInstalledError, saying what needs it, where it is."""
    package = module.partition(".")[0]
    if find_spec(package) is None:
        raise NotInstalledError(f"{purpose} needs {package}, which is not installed: pip install {package}.")
    return import_module(module)
