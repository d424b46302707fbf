"""Steps that shrink before a time which they never reach: a pole of the support's motion, say.

They are taken to do so where a hundred in succession are 1e4 times shorter than the longest one, and a million times
shorter than the time that is left.
"""

from __future__ import annotations

__all__ = ["Pace"]


class Pace:
    """What the steps of one motion have been like; asked whether they crawl."""

    def __init__(self) -> None:
        self.longest, self.short = 0.0, 0
        self.before: float | None = None

    def crawls(self, now: float, end: float) -> bool:
        """To be asked after every step."""
        if self.before is not None:
            step = abs(now - self.before)
            self.longest = max(self.longest, step)
            self.short = self.short + 1 if 1e4 * step < self.longest and 1e6 * step < abs(end - now) else 0
        self.before = now
        return self.short > 100
