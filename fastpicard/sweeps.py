"""Charts as labelled arrays: the one file of this package that needs xarray, and only when a chart is asked for."""

from __future__ import annotations

from typing import Any

from fastpicard import plotting
from fastpicard.optional import optional


def chart_type() -> Any:
    """A class of ``xarray.Dataset`` whose ``plot()`` draws stability; raises NotInstalledError without xarray."""
    Dataset: Any = optional("xarray", "a chart of points").Dataset

    class Chart(Dataset):  # type: ignore[misc]
        """A chart: a Dataset whose ``plot()`` draws stability."""

        __slots__ = ()

        def plot(self, ax: Any = None, xlabel: str | None = None, ylabel: str | None = None,
                 title: str | None = None) -> Any:
            """The chart as a matplotlib picture; returns the axes.  Raises NotInstalledError without matplotlib."""
            return plotting.sampled(self, ax, xlabel, ylabel, title)

    return Chart
