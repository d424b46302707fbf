"""Charts as labelled arrays: the one file of this package that needs xarray, and only when a chart is asked for."""

from __future__ import annotations

from typing import Any

from fastpicard import plotting


def dataset(values: dict[str, tuple[Any, Any, dict[str, str]]], coordinates: dict[str, tuple[Any, dict[str, str]]],
            attributes: dict[str, Any]) -> Any:
    """An ``xarray.Dataset`` with ``.plot()``.

    Parameters
    ----------
    values : {name: (dimensions, array, attributes)}
    coordinates : {name: (array, attributes)}
    attributes : provenance
    """
    import xarray

    class Chart(xarray.Dataset):  # type: ignore[no-untyped-call]
        """A chart: a Dataset whose ``plot()`` draws stability."""

        __slots__ = ()

        def plot(self, ax: Any = None, xlabel: str | None = None, ylabel: str | None = None,  # type: ignore[override]
                 title: str | None = None) -> Any:
            """The chart as a matplotlib picture; returns the axes."""
            return plotting.sampled(self, ax, xlabel, ylabel, title)

    return Chart({name: (dims, array, notes) for name, (dims, array, notes) in values.items()},
                 {name: (name, array, notes) for name, (array, notes) in coordinates.items()}, attributes)
