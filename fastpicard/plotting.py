"""Pictures of charts: the one file of this package that needs matplotlib, and only when a picture is asked for."""

from __future__ import annotations

from typing import Any

from fastpicard.errors import BadInputError, BadTypeError
from fastpicard.evaluate import numpy
from fastpicard.optional import optional

STABLE, UNSTABLE, UNDECIDED, LINE = "#8fbf8f", "#f4f1ea", "#000000", "#3a62d0"


def _matplotlib(part: str) -> Any:
    """A module of matplotlib, imported when the first picture is drawn."""
    return optional(f"matplotlib.{part}", "a picture of a chart")


def _axes(ax: Any) -> Any:
    if ax is not None:
        if not isinstance(ax, _matplotlib("axes").Axes):
            raise BadTypeError(f"a picture is drawn into matplotlib's axes, but ax is {ax!r}.  Use one of those of "
                               "plt.subplots(), or none.")
        return ax
    _, ax = _matplotlib("pyplot").subplots(figsize=(8, 5.5), constrained_layout=True)
    return ax


def _finish(ax: Any, x: Any, y: Any, xlabel: str | None, ylabel: str | None, title: str | None) -> Any:
    ax.set(xlim=(x.lo, x.hi), ylim=(y.lo, y.hi), xlabel=xlabel or f"${x.symbol}$", ylabel=ylabel or f"${y.symbol}$")
    if title:
        ax.set_title(title)
    return ax


def _key(ax: Any, entries: list[tuple[str, str]], line: str | None = None) -> None:
    Line2D, Patch = _matplotlib("lines").Line2D, _matplotlib("patches").Patch
    handles: list[Any] = [Patch(facecolor=colour, edgecolor="0.5", label=label) for colour, label in entries]
    if line:
        handles.append(Line2D([], [], color=LINE, linewidth=1.2, label=line))
    ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.11), ncols=2 if line else 3, fontsize=9,
              frameon=False)


def certified(chart: Any, ax: Any, xlabel: str | None, ylabel: str | None, title: str | None) -> Any:
    """A certified chart on a raster: a pixel is painted black if any part of it is undecided."""
    np = numpy()
    ax = _axes(ax)
    extent = ax.get_window_extent()  # no finer than the picture, which would lose black pixels otherwise
    codes = raster(chart, *(int(min(1200, max(200, 0.9 * side))) for side in (extent.width, extent.height)))
    colours = np.array([_rgb(colour) for colour in (UNSTABLE, UNDECIDED, STABLE)])
    ax.imshow(colours[codes.T + 1], origin="lower", aspect="auto", interpolation="nearest",
              extent=(chart.x.lo, chart.x.hi, chart.y.lo, chart.y.hi))
    for x, y in chart.lines:
        ax.plot(x, np.where(_open(chart, codes, x, y), y, np.nan), color=LINE, linewidth=1.2)
    _key(ax, [(STABLE, "stable, proved"), (UNSTABLE, "unstable, proved"),
              (UNDECIDED, f"undecided: {chart.undecided:.1e} of the area")],
         f"boundary, proved to {chart.radius:.0e}" if chart.lines else None)
    return _finish(ax, chart.x, chart.y, xlabel, ylabel, title)


def _open(chart: Any, codes: Any, x: Any, y: Any) -> Any:
    """Whether points lie in pixels that are not decided."""
    np = numpy()
    with np.errstate(invalid="ignore"):
        places = [(z - axis.lo) / (axis.hi - axis.lo) for z, axis in ((x, chart.x), (y, chart.y))]
        inside = np.logical_and.reduce([(p >= 0) & (p <= 1) for p in places])
    i, j = (np.minimum((np.where(inside, p, 0.0) * n).astype(int), n - 1)
            for p, n in zip(places, codes.shape, strict=True))
    return inside & (codes[i, j] == 0)


def _rgb(colour: str) -> tuple[float, ...]:
    return tuple(_matplotlib("colors").to_rgb(colour))


def raster(chart: Any, width: int, height: int) -> Any:
    """Codes of pixels, shape (width, height): what all of a pixel is proved to be, else 0."""
    np = numpy()
    x, y, cells = chart.x, chart.y, chart.cells
    places = [np.clip(np.round((cells[:, k] - axis.lo) / (axis.hi - axis.lo) * n, 9), 0, n)
              for k, axis, n in ((0, x, width), (1, x, width), (2, y, height), (3, y, height))]
    first = [np.minimum(np.floor(p), n - 1).astype(int) for p, n in zip(places[::2], (width, height), strict=True)]
    last = [np.maximum(np.ceil(p), f + 1).astype(int) for p, f in zip(places[1::2], first, strict=True)]
    marks = {code: np.zeros((width + 1, height + 1), dtype=np.int32) for code in (1, 0, -1)}
    for code, mark in marks.items():  # each rectangle of pixels as four corners of a sum over the plane
        chosen = chart.codes == code
        a, b, c, d = first[0][chosen], last[0][chosen], first[1][chosen], last[1][chosen]
        for i, j, sign in ((a, c, 1), (b, c, -1), (a, d, -1), (b, d, 1)):
            np.add.at(mark, (i, j), sign)
    touched = {code: mark.cumsum(axis=0).cumsum(axis=1)[:width, :height] > 0 for code, mark in marks.items()}
    result = np.where(touched[1], 1, -1)
    return np.where(touched[0] | (touched[1] & touched[-1]), 0, result)


def sampled(data: Any, ax: Any, xlabel: str | None, ylabel: str | None, title: str | None) -> Any:
    """A chart of points: stable and unstable shaded, undecided black, the boundary as the zero line of the margin."""
    names = [str(name) for name in data["verdict"].dims]
    if len(names) != 2:
        raise BadInputError(f"a chart is drawn over two parameters, but of this one {len(names)} are left: {names}.  "
                            "Use data.margin.plot(), which draws lines.")
    ax = _axes(ax)
    x, y = (data[name].values for name in (names[1], names[0]))
    colours = numpy().array([_rgb(colour) for colour in (UNSTABLE, UNDECIDED, STABLE)])
    dx, dy = (x[1] - x[0]) / 2, (y[1] - y[0]) / 2
    ax.imshow(colours[data["verdict"].values.astype(int) + 1], origin="lower", aspect="auto", interpolation="nearest",
              extent=(x[0] - dx, x[-1] + dx, y[0] - dy, y[-1] + dy))
    margin = data["margin"].values
    if (margin > 0).any() and (margin < 0).any():
        ax.contour(x, y, margin, levels=[0.0], colors=LINE, linewidths=0.8)
    _key(ax, [(STABLE, "stable"), (UNSTABLE, "unstable"), (UNDECIDED, "undecided")])
    ax.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]), xlabel=xlabel or f"${names[1]}$", ylabel=ylabel or f"${names[0]}$")
    if title:
        ax.set_title(title)
    return ax
