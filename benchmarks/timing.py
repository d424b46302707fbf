"""How the scripts of this folder measure: processor time, the least of some runs, as other work adds to it only."""

from __future__ import annotations

import time
from collections.abc import Callable


def least(work: Callable[[], object], repeats: int = 3) -> float:
    """Seconds."""
    return compare(work, repeats=repeats)[0]


def compare(*works: Callable[[], object], repeats: int) -> list[float]:
    """Seconds of each, run alternately."""
    runs = [[_seconds(work) for work in works] for _ in range(repeats)]
    return [min(column) for column in zip(*runs)]


def _seconds(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start
