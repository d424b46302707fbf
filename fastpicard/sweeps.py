"""Charts as labelled arrays, whole or in parts: the one file that needs xarray and dask, when a chart asks for them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from fastpicard import plotting
from fastpicard.optional import optional


def chart_type() -> Any:
    """A class of ``xarray.Dataset`` whose ``plot()`` draws stability; raises NotInstalledError without xarray."""
    return _chart_type(optional("xarray", "a chart of points").Dataset)


@cache
def _chart_type(Dataset: Any) -> Any:
    class Chart(Dataset):  # type: ignore[misc]
        """A chart: a Dataset whose ``plot()`` draws stability."""

        __slots__ = ()
        __qualname__ = "Chart"  # by which it is found again when a chart is unpickled

        def plot(self, ax: Any = None, xlabel: str | None = None, ylabel: str | None = None,
                 title: str | None = None) -> Any:
            """The chart as a matplotlib picture; returns the axes.  Raises NotInstalledError without matplotlib."""
            return plotting.sampled(self, ax, xlabel, ylabel, title)

    return Chart


def __getattr__(name: str) -> Any:
    if name == "Chart":
        return chart_type()
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def in_parts(sample: Callable[[Any, Any], Any], xs: Any, ys: Any, part: Sequence[int]) -> Any:
    """``sample(xs, ys)``, shape (4, up, across), by dask: parts of (across, up) points, made when asked for.

    Raises NotInstalledError without dask.
    """
    array: Any = optional("dask.array", "a chart in chunks")
    rows, columns = array.from_array(ys, chunks=part[1]), array.from_array(xs, chunks=part[0])
    return array.map_blocks(lambda y, x: sample(x[0], y[:, 0]), rows[:, None], columns[None, :], dtype=float,
                            new_axis=0, chunks=((4,), *rows.chunks, *columns.chunks), meta=xs[:0])
