"""mpmath contexts of their own precision, whose numbers can be pickled and copied.

mpmath makes a class of numbers for every context, and pickle finds only that of ``mpmath.mp``.  Here a number is
written as its context, mantissa and exponent, and a context as its digits; numbers of one context that are written
together are read with one context again.
"""

from __future__ import annotations

from typing import Any

from mpmath import MPContext
from mpmath.libmp import from_pickable, to_pickable

__all__ = ["Context"]


class Context(MPContext):  # type: ignore[misc]
    """An mpmath context of so many decimal digits.

    >>> from pickle import dumps, loads
    >>> third = Context(30).mpf(1) / 3
    >>> loads(dumps(third)) == third, loads(dumps(third)).context.dps
    (True, 30)
    """

    def __init__(self, digits: int = 15) -> None:
        super().__init__()
        self.dps = digits
        self.mpf.__reduce__ = _written

    def __reduce__(self) -> Any:
        return Context, (self.dps,)


def _written(number: Any) -> Any:
    return _read, (number.context, to_pickable(number._mpf_))


def _read(context: Context, parts: Any) -> Any:
    return context.make_mpf(from_pickable(parts))
