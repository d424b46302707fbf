"""The ways a question can have no answer.

Every exception says three things: what was claimed, the value that refutes it,
and what would do instead.  All of them are :class:`FastPicardError`; each is
also the built-in exception a caller would have guessed.
"""


from __future__ import annotations

from collections.abc import Iterable
from typing import Any


class FastPicardError(Exception):
    """Whatever this package refuses to answer."""


class BadInputError(FastPicardError, ValueError):
    """A value of the right kind for which the question has no meaning."""


class BadTypeError(FastPicardError, TypeError):
    """A value of the wrong kind; text, for one, is never evaluated as mathematics."""


class NotInFamilyError(BadInputError):
    """An expression that is no finite sum of ``c t**r cos(q t + phi)`` and ``c t**r sin(q t + phi)``."""


class NotPeriodicError(BadInputError):
    """A matrix that does not repeat with the period asked for."""


class ShapeError(BadInputError):
    """Matrices or vectors whose sizes do not fit together."""


class MissingParameterError(BadInputError):
    """A number was asked for while a parameter has no value."""


class NotInstalledError(FastPicardError, ImportError):
    """The work asked for is done by a package that is not installed."""


def printed(value: Any) -> str:
    """A value in a message: Python refuses to print integers of thousands of digits."""
    try:
        return repr(value) if isinstance(value, str) else str(value)
    except ValueError:
        return f"a {type(value).__name__} of too many digits to print"


def namesake(symbols: Iterable[Any], others: Iterable[Any]) -> str:
    """The sentence for a Symbol that was given in place of another which prints alike; empty where there is none."""
    names = {s.name for s in symbols} & {getattr(other, "name", None) for other in others}
    return f"  The {min(names)} given is another Symbol: they share the name but not the assumptions." if names else ""
