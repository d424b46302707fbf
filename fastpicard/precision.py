"""The precision of balls, set by one thread at a time.

``flint.ctx.prec`` belongs to the process, not to a thread: who sets it sets it for all.  So whoever computes with
bits of his own holds a lock until the precision is back, and other threads wait.  The lock is kept in python-flint,
which every package that follows this rule imports, so that all of them take the same one.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock

import flint

__all__ = ["working"]

_LOCK = vars(flint).setdefault("_precision_lock", RLock())


@contextmanager
def working(bits: int) -> Iterator[None]:
    """Balls of so many bits inside; within one thread blocks may be nested.

    >>> with working(200):
    ...     print(flint.arb(2).sqrt().str(50, radius=False))
    1.4142135623730950488016887242096980785696718753769
    """
    with _LOCK, flint.ctx.workprec(bits):
        yield
