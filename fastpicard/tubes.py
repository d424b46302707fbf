r"""Tubes: boundary curves as polynomials with a rigorous radius, outside which everything is decided.

For Hill's equation ``y'' + (a + q(t; b)) y = 0`` with even q every boundary is an eigenvalue ``a(b)`` of a
Sturm-Liouville problem on half the period (module ``halfway``): a zero of one of four entries f of ``Phi(T/2)``,
simple in a, so a graph over b.  On a slab, an interval of b:

1. The interval of a is cut into blocks on which ``f != 0`` or ``df/da != 0`` is proved (Taylor models of f, df/da).
   Where df/da has one sign and f opposite signs at both ends of a block, there is exactly one zero ``a(b)`` for all b.
2. From a zero at the middle of the slab Newton's method for power series gives the Taylor polynomial ``g(b)`` of a(b).
   It need not be trusted: ``eps = sup |f(g(b), b)|`` over the slab, the polynomial f composed with g in balls, and
   ``m = inf |df/da|`` on the block prove ``|a(b) - g(b)| <= eps/m``, as long as g stays inside the block.
3. Slabs on which a step fails are halved.

Both bounds include the remainder of Picard's iteration: a majorant for ``|a| + 1`` in place of ``|a|`` holds for
complex a within 1 as well, so Cauchy's estimate makes it a bound of the derivative's remainder, too.
"""

from __future__ import annotations

import numbers
from dataclasses import dataclass, field, replace
from typing import Any

from flint import arb, arb_mat, arb_poly, arb_series, ctx
from mpmath.libmp import dps_to_prec
from sympy import Matrix, Symbol, latex

from fastpicard.charted import Charted, Exponents, read_chart
from fastpicard.criteria import criterion
from fastpicard.errors import BadInputError, printed
from fastpicard.evaluate import ball, numpy, to_number, upper_float
from fastpicard.floquet import FloquetMatrix
from fastpicard.halfway import half_period
from fastpicard.harmonics import Harmonics
from fastpicard.latex import interval, meaning, number, shown
from fastpicard.local import LocalMap, amplitudes, common_bound, order_for, polynomials, shift
from fastpicard.packing import packed, unpacked
from fastpicard.precision import working
from fastpicard.rectangles import Rectangles
from fastpicard.remainder import a_priori
from fastpicard.taylormodels import Models
from fastpicard.values import Values, exact_number

Array = Any
TERMS = 30  # of the Taylor polynomials
NAMES = (("-1", "even"), ("+1", "odd"), ("+1", "even"), ("-1", "odd"))  # of A, B, C, D
BLOCK = 0.09  # the first length of a block in a


LEAST_RADIUS = 1e-250


@dataclass(frozen=True)
class Tube:
    """A piece of a boundary: ``|a(b) - g(b)| <= radius`` for b in [lo, hi], ``g(b) = sum c_k ((b - center)/half)**k``.

    Attributes
    ----------
    label, parity : str         as of :class:`Boundary`
    lo, hi : float              the interval of b
    center, half : arb          its middle and half length
    coefficients : tuple of arb, exact
    radius : float              proved
    """

    label: str
    parity: str
    lo: float
    hi: float
    center: Any = field(repr=False)
    half: Any = field(repr=False)
    coefficients: tuple[Any, ...] = field(repr=False)
    radius: float = 0.0

    def __call__(self, b: Any, digits: int | None = None) -> Any:
        """A ball that contains the true ``a(b)``, or with ``digits`` an mpf; raises BadInputError beyond the piece."""
        with working(dps_to_prec(40)):
            here = ball(exact_number(b, "b"))
            if here < self.lo or here > self.hi:
                raise BadInputError(f"this piece of a boundary is proved for b from {self.lo} to {self.hi}, but b is "
                                    f"{b}.  Choose the piece that holds it, or use at(b) of all tubes.")
            t = (here - self.center) / self.half
            value = arb_poly(list(self.coefficients))(t) + arb(0, arb(self.radius))
            return value if digits is None else to_number(value, digits)

    def _repr_latex_(self) -> str:
        return shown(meaning(self.label, self.parity), rf"\left|a - g(b)\right| \le {number(self.radius, 2)}",
                     interval(Symbol("b"), self.lo, self.hi))

    def __reduce__(self) -> tuple[Any, ...]:
        exact = packed(self.center, self.half, *self.coefficients)
        return _tube, (self.label, self.parity, self.lo, self.hi, exact, self.radius)

    def points(self, count: int = 9) -> tuple[Array, Array]:
        """Points of the curve, for pictures: arrays of a and b, in floats; ``count`` of them, an integer from 1."""
        if isinstance(count, bool) or not isinstance(count, int) or count < 1:
            raise BadInputError(f"a curve is drawn through a number of points, but count is {printed(count)}.  Use 9.")
        np = numpy()
        line = np.linspace(-1, 1, count)
        return np.polynomial.polynomial.polyval(line, [float(c) for c in self.coefficients]), np.clip(
            float(self.center) + float(self.half) * line, self.lo, self.hi)


def _tube(label: str, parity: str, lo: float, hi: float, exact: Any, radius: float) -> Tube:
    center, half, *coefficients = unpacked(exact)
    return Tube(label, parity, lo, hi, center, half, tuple(coefficients), radius)


@dataclass(frozen=True)
class Tubes:
    """All boundaries in a rectangle of (a, b): outside them the equation is proved stable or unstable.

    Attributes
    ----------
    x, y : (Symbol, float, float)       a and b with their intervals
    pieces : tuple of Tube
    radius : float      the largest
    area : float        an upper bound of the part of the rectangle inside tubes
    order : int         of the iterate that was used
    """

    x: tuple[Symbol, float, float]
    y: tuple[Symbol, float, float]
    pieces: tuple[Tube, ...] = field(repr=False)
    radius: float
    area: float
    order: int

    def at(self, b: Any) -> list[tuple[str, str, Any]]:
        """(label, parity, ball of a) of every boundary in the rectangle at one b, ascending.

        Raises BadInputError where b is beyond the rectangle.
        """
        with working(dps_to_prec(40)):
            here = ball(exact_number(b, "b"))
        name, lo, hi = self.y
        if here < lo or here > hi:
            raise BadInputError(f"boundaries are known for {name} from {lo} to {hi}, but it is {b}.  Find tubes of a "
                                "larger rectangle.")
        found: dict[tuple[str, str, float], Any] = {}
        for piece in self.pieces:
            if not (here < piece.lo or here > piece.hi):
                value = piece(b)
                if not (value.upper() >= self.x[1] and value.lower() <= self.x[2]):
                    continue  # the piece leaves the rectangle
                found[piece.label, piece.parity, round(float(value), 9)] = value
        return sorted(((label, parity, a) for (label, parity, _), a in found.items()), key=lambda item: float(item[2]))

    def __repr__(self) -> str:
        return (f"<Tubes of {self.x[0]}({self.y[0]}): {len(self.pieces)} pieces, radius {self.radius:.1e}, "
                f"{self.area:.1e} of the area, order {self.order}>")

    def _repr_latex_(self) -> str:
        a, b = latex(self.x[0]), latex(self.y[0])
        return shown(rf"\left|{a} - g_k({b})\right| \le {number(self.radius, 2)}",
                     rf"k = 1, \ldots, {len(self.pieces)}", interval(*self.x), interval(*self.y))


def tubes(F: FloquetMatrix, x: tuple[Symbol, Any, Any], y: tuple[Symbol, Any, Any], radius: float = 1e-20,
          fixed: Values | None = None) -> Tubes:
    """All boundaries ``a(b)`` of an even Hill equation in a rectangle, as polynomials with a proved radius.

    Parameters
    ----------
    F : FloquetMatrix of ``y'' + (a + q(t; b)) y = 0`` with q even in t; of any order
    x : (a, lo, hi), y : (b, lo, hi)    Symbol and numbers
    radius : float      asked of every tube, in a; from 1e-250 to 1
    fixed : {Symbol: number} for the other parameters

    Raises
    ------
    BadInputError
        if a is no such parameter, or the radius cannot be reached; if an iterate of more than order 200 is needed.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 0)
    >>> found = tubes(F, (a, -0.2, 0.5), (b, 0, 0.25))
    >>> found.radius <= 1e-20
    True
    >>> for label, parity, value in found.at(0.25):
    ...     print(label, parity, value.str(18, radius=False))
    +1 even -0.0304413862352706740
    -1 even 0.117663588733459778
    -1 odd 0.366691710629013944
    """
    chart = read_chart(F, x, y, fixed, None)
    first, second = (replace(axis, power=min(axis.power, 1)) for axis in chart.axes)
    chart = replace(chart, axes=(first, second))
    rule = criterion(chart.F)
    if chart.F.shape != (2, 2) or not rule.half or first.power < 0 or second.power < 0:
        raise BadInputError("tubes are drawn of y'' + (a + q(t; b)) y = 0 with q even in t and no negative powers of "
                            "the parameters, and this equation is not of that kind.  Count time from where q is even, "
                            "or use certify.")
    slope = chart.F.P.as_matrix().diff(first.symbol)
    if slope != Matrix([[0, 0], [-1, 0]]):
        name = first.symbol
        raise BadInputError(f"tubes are graphs of the constant {name} in y'' + ({name} + q(t)) y = 0, but dP/d{name} "
                            f"is {slope.tolist()}.  Choose as x the parameter that is added to q.")
    if isinstance(radius, bool) or not isinstance(radius, numbers.Real) or not LEAST_RADIUS <= radius <= 1:
        raise BadInputError(f"the radius of tubes must be from {LEAST_RADIUS} to 1, but it is {printed(radius)}.  Use "
                            "radius=1e-8.")
    work = _Work(chart, float(radius))
    pieces = work.run()
    area = sum(2 * p.radius * (p.hi - p.lo) for p in pieces)
    return Tubes((first.symbol, first.lo, first.hi), (second.symbol, second.lo, second.hi), tuple(pieces),
                 max((p.radius for p in pieces), default=0.0),
                 area / ((first.hi - first.lo) * (second.hi - second.lo)), work.order)


class _Work:
    """The four entries and their derivatives by a, recentred anywhere."""

    def __init__(self, chart: Charted, radius: float) -> None:
        np = numpy()
        self.first, self.second = chart.axes
        self.radius = radius
        whole = Rectangles(np.array([[self.first.lo - 0.5], [self.second.lo]]),
                           np.array([[self.first.hi + 0.5], [self.second.hi]]))
        member = chart.members[0]
        majorant = common_bound([amplitudes(chart, member, whole)])
        more = {place: [(q, c + int(place == (1, 0)), s) for q, c, s in waves]
                for place, waves in majorant.waves.items()}
        with working(int(-3.33 * np.log10(radius)) + 64):
            half = chart.period / 2
            wider = Harmonics(2, more)
            self.order = order_for(wider, half, radius * 1e-4)
            self.error = max(upper_float(z.upper()) for z in a_priori(wider, half, self.order).entries())
        G = chart.F.to_order(self.order)
        collapsed = G.collapse([modes for row in half_period(G) for modes in row])
        (functions,), self.bits = polynomials(chart, collapsed, whole, radius * 1e-8)
        with working(self.bits):
            self.local = LocalMap(functions + [_by_first(terms) for terms in functions], [self.error] * 8, self.bits)
        self.shape, self.matrices = self.local.shape, self.local.matrices[:4]

    def run(self) -> list[Tube]:
        """Slab by slab."""
        np = numpy()
        length = self.second.hi - self.second.lo
        edges = np.linspace(self.second.lo, self.second.hi, max(2, int(np.ceil(length / 0.2)) + 1))
        edges[-1] = self.second.hi
        pieces: list[Tube] = []
        todo = [(lo, hi, BLOCK) for lo, hi in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True)][::-1]
        while todo:
            lo, hi, block = todo.pop()
            found = self.slab(lo, hi, block)
            if found is not None:
                pieces += found
            elif hi - lo < 1e-4:
                raise BadInputError(f"the radius {self.radius} must be reached on every slab, but it is not at "
                                    f"{self.second.symbol} = {lo}: boundaries are no graphs over it, or too steep.  "
                                    "Ask for a larger radius, or use certify.")
            else:
                todo += [((lo + hi) / 2, hi, block / 1.5), (lo, (lo + hi) / 2, block / 1.5)]
        return pieces

    def slab(self, lo: float, hi: float, block: float) -> list[Tube] | None:
        """The tubes over [lo, hi], or None where a proof fails."""
        np = numpy()
        count = int(np.ceil((self.first.hi - self.first.lo + 0.8) / block))
        edges = np.linspace(self.first.lo - 0.4, self.first.hi + 0.4, count + 1)
        boxes = Rectangles(np.stack([edges[:-1], np.full(count, lo)]), np.stack([edges[1:], np.full(count, hi)]))
        models = self.local.models(boxes, 9)
        signs = models.signs()
        pieces: list[Tube] = []
        for k in range(4):
            f, slope = signs[k], signs[k + 4]
            open_ = f == 0
            if (slope[open_] == 0).any():
                return None
            for start, stop in _runs(open_):
                if edges[stop] <= self.first.lo or edges[start] >= self.first.hi:
                    continue  # beyond the chart
                inside = start > 0 and stop < count
                if not inside or len(set(slope[start:stop].tolist())) > 1:
                    return None
                if f[start - 1] == f[stop]:
                    continue  # monotone between equal signs: no zero
                least = _least_slope(models, k + 4, start, stop)
                piece = self.tube(k, (lo, hi), (float(edges[start]), float(edges[stop])), least)
                if piece is None:
                    return None
                pieces.append(piece)
        return pieces

    def tube(self, k: int, slab: tuple[float, float], block: tuple[float, float], least: float) -> Tube | None:
        """One curve over one slab."""
        with working(self.bits):
            b0, half = (arb(slab[0]) + arb(slab[1])) / 2, (arb(slab[1]) - arb(slab[0])) / 2
            a0 = self.zero(k, b0, block)
            if a0 is None:
                return None
            reach = max(a0 - arb(block[0]), arb(block[1]) - a0).mid()
            table = shift(a0, reach, TERMS, self.shape[0]) * self.matrices[k] * shift(
                b0, half, TERMS, self.shape[1]).transpose()
            rows = table.tolist()
            g = _series(rows)
            if g is None:
                return None
            defect = _composed(rows, g) + arb(self.error) + self.left_out(k, a0, reach, b0, half)
            radius = upper_float((defect / arb(least)).upper())
            extent = sum((abs(c) for c in g[1:]), arb(0)) * reach + radius
            if not radius <= self.radius or not (a0 - extent > block[0] and a0 + extent < block[1]):
                return None
            coefficients = (a0, *(c * reach for c in g[1:]))
            exact = tuple(c.mid() for c in coefficients)
            lost = sum((abs(c - m) for c, m in zip(coefficients, exact, strict=True)), arb(0))
            return Tube(*NAMES[k], slab[0], slab[1], b0.mid(), half.mid(), exact,
                        upper_float((arb(radius) + lost).upper()))

    def zero(self, k: int, b0: Any, block: tuple[float, float]) -> Any:
        """An exact number near the zero at one b."""
        column = shift(b0, arb(0), 0, self.shape[1]).transpose()
        f = arb_poly([row[0] for row in (self.matrices[k] * column).tolist()])
        df = f.derivative()
        lo, hi = arb(block[0]), arb(block[1])
        rising = bool(f(hi) > 0)
        here = (lo + hi) / 2
        for _ in range(60):
            value, slope = f(here), df(here)
            if bool(value > 0) == rising:
                hi = here
            else:
                lo = here
            new = (here - value / slope).mid() if not slope.contains(0) else (lo + hi) / 2
            if abs(new - here) < arb(self.radius) * arb(2) ** -30:
                return new.mid()
            if not (new > lo and new < hi):
                new = ((lo + hi) / 2).mid()
            here = new.mid()
        return here

    def left_out(self, k: int, a0: Any, reach: Any, b0: Any, half: Any) -> Any:
        """What the table of ``TERMS`` by ``TERMS`` terms leaves out, by absolute values."""
        size = arb_mat([[abs(x) for x in row] for row in self.matrices[k].tolist()])
        full = [shift(abs(c), r, n - 1, n) for c, r, n in ((a0, reach, self.shape[0]), (b0, half, self.shape[1]))]
        n = TERMS + 1
        ones = arb_mat([[1]] * self.shape[1])
        right = full[1].transpose() * ones  # all columns
        cut = arb_mat([[arb(int(l < n))] for l in range(self.shape[1])])
        kept = full[1].transpose() * cut
        total, part = (full[0] * size * z for z in (right, kept))
        rows = [total[i, 0] - (part[i, 0] if i < n else 0) for i in range(self.shape[0])]
        return sum((abs(x).upper() for x in rows), arb(0))


def _by_first(terms: dict[Exponents, Any]) -> dict[Exponents, Any]:
    return {(i - 1, j): c * i for (i, j), c in terms.items() if i} or {(0, 0): arb(0)}


def _runs(flags: Array) -> list[tuple[int, int]]:
    """Where flags are set without a gap: [start, stop)."""
    np = numpy()
    steps = np.diff(np.concatenate([[0], flags.astype(int), [0]]))
    return list(zip(np.flatnonzero(steps == 1).tolist(), np.flatnonzero(steps == -1).tolist(), strict=True))


def _least_slope(models: Models, k: int, start: int, stop: int) -> float:
    """A lower bound of ``|df/da|`` on the block."""
    c = abs(models.c[:, k, start:stop])
    return float((c[0] - (c[1:].sum(axis=0) + models.e[k, start:stop]) * (1 + 2.0**-30)).min() * (1 - 2.0**-30))


def _series(rows: list[list[Any]]) -> list[Any] | None:
    """The power series g with ``sum rows_kl g**k t**l = 0``, ``g(0) = 0``, exact coefficients."""
    lines = [[x.mid() for x in row] for row in rows]
    old = ctx.cap
    try:
        g, known = arb_series([0], prec=TERMS + 1), 1
        while known <= TERMS:
            known *= 2
            ctx.cap = TERMS + 1
            value, slope = arb_series([0], prec=TERMS + 1), arb_series([0], prec=TERMS + 1)
            for k in range(len(lines) - 1, -1, -1):
                slope = slope * g + value
                value = value * g + arb_series(lines[k], prec=TERMS + 1)
            if slope[0].contains(0):
                return None
            step = value / slope
            g = arb_series([(x.mid()) for x in (g - step).coeffs()], prec=TERMS + 1)
        found = [x.mid() for x in g.coeffs()]
        return [arb(0), *found[1:]]
    finally:
        ctx.cap = old


def _composed(rows: list[list[Any]], g: list[Any]) -> Any:
    """A bound of ``|sum rows_kl g(t)**k t**l|`` for |t| <= 1."""
    inner, total = arb_poly(g), arb_poly()
    for row in reversed(rows):
        total = _folded(total * inner + arb_poly(row), 2 * TERMS)
    return sum((abs(c).upper() for c in total.coeffs()), arb(0)).upper()


def _folded(polynomial: Any, degree: int) -> Any:
    """The same for |t| <= 1, with everything beyond the degree in the constant's ball."""
    if polynomial.degree() <= degree:
        return polynomial
    coefficients = polynomial.coeffs()
    beyond = sum((abs(c).upper() for c in coefficients[degree + 1:]), arb(0)).upper()
    return arb_poly([coefficients[0] + arb(0, beyond), *coefficients[1:degree + 1]])


__all__ = ["Tube", "Tubes", "tubes"]
