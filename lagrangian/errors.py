"""The ways a mechanical question can have no answer.

One base, :class:`LagrangianError`, and one name for each kind of claim that fails.  Every message says the
claim, the value that contradicts it, and what would do instead.  Each class is also a ``ValueError`` (the
kind of object is right, its value is not), a ``TypeError`` (the kind of object is wrong) or an ``ImportError``.
"""

from __future__ import annotations

from collections.abc import Callable
from numbers import Number
from typing import Any

__all__ = [
    "DriveError",
    "InhomogeneousError",
    "LagrangianError",
    "NameClashError",
    "NotAQuantityError",
    "NotASceneError",
    "NotAnEquilibriumError",
    "NotDecoupledError",
    "NotInstalledError",
    "NotPeriodicError",
    "QuantityError",
    "SceneError",
    "TextError",
    "printed",
]


class LagrangianError(Exception):
    """The base of every exception that the package raises on purpose."""


class TextError(LagrangianError, TypeError):
    """Text stood where mathematics was expected; text is never evaluated."""


class NotAQuantityError(LagrangianError, TypeError):
    """The object given is neither a number nor a scalar SymPy expression."""


class NotASceneError(LagrangianError, TypeError):
    """The object given is not the stage of the derivation that the function starts from."""


class QuantityError(LagrangianError, ValueError):
    """A mass, length, angle or other quantity has a value that no chain can have."""


class SceneError(LagrangianError, ValueError):
    """The parts do not make a chain: no rods, or not one joint constant for every rod."""


class DriveError(LagrangianError, ValueError):
    """The motion of the support is not a prescribed, twice differentiable function of time."""


class NameClashError(LagrangianError, ValueError):
    """A Symbol of the scene has the name of another one, that is given or that the result needs."""


class NotAnEquilibriumError(LagrangianError, ValueError):
    """The chain does not stay at the angles about which it was to be linearised."""


class InhomogeneousError(LagrangianError, ValueError):
    """The linear equations have a remainder, and the form asked for has no place for it."""


class NotInstalledError(LagrangianError, ImportError):
    """The work asked for is done by a package that is not installed."""


class NotPeriodicError(LagrangianError, ValueError):
    """The coefficients are not a finite trigonometric polynomial of the phase ``tau = omega0 t``."""


class NotDecoupledError(LagrangianError, ValueError):
    """No constant change of coordinates turns the linear equations into one equation a mode."""


def printed(value: Any, form: Callable[[Any], str] = str) -> str:
    """A value in a message: Python refuses to print integers of thousands of digits.

    >>> printed(2), printed(-10**5000), printed([10**5000], repr)
    ('2', 'a number of too many digits to print', 'a list of too many digits to print')
    """
    try:
        return form(value)
    except ValueError:
        kind = "number" if isinstance(value, Number) or hasattr(value, "is_number") else type(value).__name__
        return f"a {kind} of too many digits to print"
