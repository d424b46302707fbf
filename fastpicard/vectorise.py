r"""Exact constants as numbers, for one point or a million, no digit of which misleads.

The constants are polynomials in few variables (:mod:`fastpicard.collapsed`), collapsed before anything is rounded.

**Which arithmetic.**  Let v be the exact entries at a point (one, for a trace) that doubles can
hold, and ``u = 2**-53``; every one of them shall be right to ``10 u max |v|``, which is at most
10 ulp of the largest, and what is beyond doubles shall be the infinity of its sign.  For each
point the cheapest way that is *proved* to do it is taken, by the bounds of
:mod:`fastpicard.doubledouble`:

1. float64, if ``u W <= 9 u f`` for all entries,
2. pairs of float64, if ``u |r + e| + u*u K W <= 9 u f``,
3. balls, whose precision is raised until it does.

Here ``f = max (|value| - bound) <= max |v|``.  Neither bound knows the result beforehand,
both hold for every input, and the better one costs time only where it is needed.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import sympy
from flint import arb, fmpq
from sympy import Symbol

from fastpicard import doubledouble
from fastpicard.collapsed import Collapsed, Variable
from fastpicard.doubledouble import SLACK, UNIT, Polynomial
from fastpicard.errors import BadInputError, BadTypeError, MissingParameterError, ShapeError, namesake
from fastpicard.evaluate import Point, numpy, to_number
from fastpicard.precision import working
from fastpicard.ring import symbols_of
from fastpicard.values import check_assumptions

Array = Any
BLOCK = 8192  # points at a time: the arrays of a block stay in the cache
ALLOWED = 9 * UNIT  # of the largest entry; what is missing to 10 is left to the roundings of the bounds
FLOAT, PAIR, BALL = 0, 1, 2
PRECISIONS = (128, 256, 512, 1024, 2048, 8192)  # of balls: no more of them than have their coefficients remembered
BEYOND = arb(2) ** 1024  # an infinite float
POLE = 2048  # what is not finite in so many bits is taken to have no value


def values_of(variables: list[Variable], columns: dict[Symbol, Array], time: Any) -> list[doubledouble.Variable]:
    """The values of variables for columns of parameters; those that need balls once for every different point."""
    found: dict[Variable, doubledouble.Variable] = {}
    groups: dict[frozenset[Symbol], list[Variable]] = {}
    for variable in variables:
        symbol, unit = variable.parameter
        if symbol is None:
            groups.setdefault(frozenset(variable.symbols), []).append(variable)
        elif unit == 1:
            found[variable] = doubledouble.Variable(columns[symbol], None)
        else:
            make = doubledouble.square if unit == 2 else doubledouble.reciprocal
            found[variable] = doubledouble.Variable(*make(columns[symbol]))
    for group in groups.values():
        found.update(zip(group, _by_balls(group, columns, time), strict=True))
    return [found[variable] for variable in variables]


# -- many points ---------------------------------------------------------------


class Evaluator:
    """The constants as functions of arrays, each output with its bound.

    Parameters
    ----------
    collapsed : the constants
    names : the parameters in the order of the arrays; those that do not occur make no difference
    """

    def __init__(self, collapsed: Collapsed, names: tuple[Symbol, ...]) -> None:
        self.collapsed, self.names = collapsed, [name for name in names if name in collapsed.symbols]
        self.places = [i for i, name in enumerate(names) if name in collapsed.symbols]
        self.scales, rows = collapsed.rounded
        pairs = [v.parameter[1] != 1 for v in collapsed.variables]
        self.polynomials = [Polynomial(steps, row, [sum(m) for m in ms], pairs) for steps, row, ms in
                            zip(collapsed.programs, rows, collapsed.exponents, strict=True)]
        self.limit = min((p.limit() for p in self.polynomials), default=doubledouble.LARGEST)

    def __call__(self, columns: list[Array]) -> tuple[Array, Array, Array]:
        """Values and bounds, shape (constants, points), and the arithmetic of every point, shape (points,)."""
        np, size = numpy(), len(columns[0]) if columns else 1
        columns = [columns[i] for i in self.places]
        values, bounds = np.full((len(self.polynomials), size), np.nan), np.full((len(self.polynomials), size), np.inf)
        route = np.full(size, BALL, dtype=np.int8)
        finite = np.logical_and.reduce([np.ones(size, dtype=bool), *map(np.isfinite, columns)])
        finite[self._resonant(columns, finite)] = False
        if self.limit >= 0:
            with np.errstate(all="ignore"):
                for start in range(0, size, BLOCK):
                    block = slice(start, start + BLOCK)
                    self._block([x[block] for x in columns], finite[block],
                                values[:, block], bounds[:, block], route[block])
        for i in np.flatnonzero((route == BALL) & finite):
            values[:, i], bounds[:, i] = self._ball([x[i] for x in columns])
        return values, bounds, route

    def _resonant(self, columns: list[Array], finite: Array) -> Array:
        """The places of points at which there is no value; each set of frequencies is tried once."""
        np, found = numpy(), self.collapsed
        occurring = symbols_of(m for q in found.resonances for m, _ in q)
        names = [name for name in self.names if name in occurring]
        if not names:
            return []
        places = np.flatnonzero(finite)
        table = np.stack([x[places] for name, x in zip(self.names, columns, strict=True) if name in occurring])
        points, inverse = np.unique(table, axis=1, return_inverse=True)
        bad = [found.resonance({s: fmpq(*map(int, float(x).as_integer_ratio()))
                                for s, x in zip(names, point, strict=True)}) is not None for point in points.T]
        return places[np.array(bad, dtype=bool)[inverse.reshape(-1)]]

    def _block(self, columns: list[Array], finite: Array, values: Array, bounds: Array, route: Array) -> None:
        """Fill in what float64 and pairs can do for one block, at the finite points."""
        np, given = numpy(), dict(zip(self.names, columns, strict=True))
        values_here = values_of(self.collapsed.variables, given, self.collapsed.time)
        variables = [v.scaled(s) for v, s in zip(values_here, self.scales, strict=True)]
        inside = finite.copy()
        for variable in variables:
            inside &= variable.inside(self.limit)
        places = np.flatnonzero(inside)
        here = variables if len(places) == len(inside) else [v.at(places) for v in variables]
        largest = max((float(abs(v.x).max(initial=1)) for v in here), default=1.0)
        sizes = [p.sizes(here, len(places)) for p in self.polynomials]
        lost = [p.underflow(largest) for p in self.polynomials]
        for way, compute in ((FLOAT, _floats), (PAIR, _pairs)):
            if not len(places):
                return
            found = [compute(p, here, w) for p, w in zip(self.polynomials, sizes, strict=True)]
            results = np.array([x for x, _ in found])
            errors = np.array([x * SLACK + underflow for (_, x), underflow in zip(found, lost, strict=True)])
            good = errors.max(axis=0) <= ALLOWED * (abs(results) - errors).max(axis=0)
            values[:, places[good]], bounds[:, places[good]] = results[:, good], errors[:, good]
            route[places[good]] = way
            if good.any():
                rest = np.flatnonzero(~good)
                places, sizes, here = places[rest], [w[rest] for w in sizes], [v.at(rest) for v in here]

    def _ball(self, at: list[float]) -> tuple[list[float], list[float]]:
        """One point in balls: the largest entry that is a double decides when the precision is enough, poles do not."""
        exact = {name: fmpq(*map(int, float(x).as_integer_ratio())) for name, x in zip(self.names, at, strict=True)}
        found: list[Any] = []
        poles = False
        for precision in PRECISIONS:
            if poles and precision < POLE:
                continue
            with working(precision):
                found = self.collapsed.balls(exact)
                poles = not all(x.is_finite() for x in found)
                if _settled([x for x in found if x.is_finite()]) and (not poles or precision >= POLE):
                    break
        with working(precision):
            pairs = list(map(_with_bound, found))
        return [value for value, _ in pairs], [bound for _, bound in pairs]


def _settled(found: list[Any]) -> bool:
    """Whether what doubles can hold is right to ``2**-60`` of the largest such entry; what is beyond has its sign."""
    found = [x for x in found if not x.abs_lower() > BEYOND]
    widest, largest = (max(x, default=arb(0)) for x in ((x.rad() for x in found), (x.abs_lower() for x in found)))
    return bool(widest <= largest * arb(2) ** -60)


def _floats(p: Polynomial, variables: list[doubledouble.Variable], weighted: Array) -> tuple[Array, Array]:
    return p.floats(variables, len(weighted)), UNIT * weighted


def _pairs(p: Polynomial, variables: list[doubledouble.Variable], weighted: Array) -> tuple[Array, Array]:
    r, e = p.pairs(variables, len(weighted))
    value = r + e
    return value, UNIT * abs(value) + UNIT * UNIT * p.most * weighted


def _with_bound(x: Any) -> tuple[float, float]:
    """The float nearest to a ball, and how far from it the ball reaches."""
    if not x.is_finite():
        return math.nan, math.inf
    value = to_number(x, None)
    if not math.isfinite(value):
        return math.nan if x.contains(0) else value, math.inf
    if x == value:
        return value, 0.0
    return value, math.nextafter(to_number((x - arb(value)).abs_upper(), None), math.inf)


def _by_balls(variables: list[Variable], columns: dict[Symbol, Array], time: Any) -> list[doubledouble.Variable]:
    """The values of functions of the same parameters as pairs, through balls."""
    np, names = numpy(), sorted(variables[0].symbols, key=str)
    points, inverse = np.unique(np.stack([columns[s] for s in names]), axis=1, return_inverse=True)
    pairs = np.array([_ball_pairs(variables, dict(zip(names, x, strict=True)), time) for x in points.T])
    spread = pairs.reshape(-1, len(variables), 2)[inverse.reshape(-1)].transpose(1, 2, 0).copy()
    return [doubledouble.Variable(high, low) for high, low in spread]


def _ball_pairs(variables: list[Variable], at: dict[Symbol, float], time: Any) -> list[tuple[float, float]]:
    """Values as pairs of floats right to ``2**-106``, or nan where there is none: a pole, or no digits at all."""
    if not all(map(math.isfinite, at.values())):
        return [(math.nan, math.nan)] * len(variables)
    with working(256):
        point = Point(time, {s: fmpq(*map(int, float(x).as_integer_ratio())) for s, x in at.items()})
        return [_ball_pair(variable.ball(point)) for variable in variables]


def _ball_pair(x: Any) -> tuple[float, float]:
    if x == 0:
        return 0.0, 0.0
    high = to_number(x, None) if x.is_finite() and x.rel_accuracy_bits() >= 110 else 0.0
    return (high, to_number(x - arb(high), None)) if high and math.isfinite(high) else (math.nan, math.nan)


# -- functions -----------------------------------------------------------------

PLAIN = len(Symbol("x").assumptions0)  # a Symbol with more of them excludes some numbers


def vectorise(collapsed: Collapsed, params: Sequence[Symbol], shape: tuple[int, ...],
              bound: bool = False) -> Callable[..., Any]:
    """A function of arrays, one for each parameter, that broadcast to ``(..., *shape)``.

    Raises
    ------
    MissingParameterError
        if a parameter that occurs is not among ``params``.
    BadInputError
        by the function, for a number beyond the doubles, or where a Symbol that is an integer is given another number.
    """
    names = _checked(params, collapsed.t)
    if not isinstance(bound, bool):
        raise BadTypeError(f"bound must be True or False, but it is {bound!r}.  Give all parameters in one list.")
    missing = sorted(collapsed.symbols - set(names), key=str)
    if missing:
        absent = ", ".join(map(str, missing))
        raise MissingParameterError(f"every parameter must be an argument, but {absent} is missing among "
                                    f"{list(names)}.  Add it to the list.{namesake(missing, names)}")
    evaluator = Evaluator(collapsed, names)

    def function(*values: Array) -> Any:
        if len(values) != len(names):
            raise BadTypeError(f"the function takes {len(names)} arguments {list(names)}, but {len(values)} were "
                               "given.  Give one number or array for each.")
        arrays = _broadcast([_allowed(name, _array(value)) for name, value in zip(names, values, strict=True)])
        outer = arrays[0].shape if arrays else ()
        found, errors, _ = evaluator([array.reshape(-1) for array in arrays])
        results = [x.T.reshape(outer + shape)[()] for x in ((found, errors) if bound else (found,))]
        return tuple(results) if bound else results[0]

    found = "values and bounds" if bound else "values"
    function.__doc__ = f"({', '.join(map(str, names))}) -> {found}, shape ({', '.join(['...', *map(str, shape)])})."
    return function


def _array(value: Any) -> Array:
    """Real numbers as doubles; what a double cannot say is refused, not dropped."""
    np = numpy()
    if isinstance(value, np.ma.MaskedArray):
        raise BadTypeError(f"the arguments must be arrays without a mask, but one is {value!r}.  "
                           "Use its filled(nan): wherever the parameter occurs, the results there are nan.")
    try:
        array = np.asarray(value)
        real = array.dtype.kind in "iuf" or array.dtype.kind == "O" and all(map(_is_real, array.flat))
        if real:
            return _doubles(array)
    except OverflowError:
        raise BadInputError("the arguments must be in the range of doubles, up to 1.8e308, but one is beyond.  "
                            "Use evaluate, which takes numbers of any size.") from None
    except ValueError:  # rows of different lengths
        pass
    raise BadTypeError(f"the arguments must be real numbers or arrays of them, but one is {value!r}.  "
                       "Text and expressions are not evaluated; nor are complex numbers, truth values and dates.")


def _doubles(array: Array) -> Array:
    """Infinities only where there were infinities: not every kind of number raises OverflowError of its own."""
    np = numpy()
    with np.errstate(over="ignore"):
        doubles = array.astype(float)
    infinite = np.isinf(doubles)
    if infinite.any() and np.any(array[infinite] != doubles[infinite]):
        raise OverflowError
    return doubles


def _allowed(name: Symbol, array: Array) -> Array:
    """The same numbers, where the assumptions of the Symbol allow them."""
    np = numpy()
    if len(name.assumptions0) > PLAIN:
        finite = array[np.isfinite(array)]
        ends = [finite.min(), finite.max()] if finite.size else []
        for value in np.unique(finite) if name.is_integer else ends:
            check_assumptions(name, fmpq(*float(value).as_integer_ratio()))
    return array


def _is_real(x: Any) -> bool:
    return isinstance(x, numbers.Real | sympy.Number) and not isinstance(x, bool)


def _broadcast(arrays: list[Array]) -> list[Array]:
    try:
        return list(numpy().broadcast_arrays(*arrays))
    except ValueError:
        raise ShapeError("the arguments must have shapes that broadcast, but these are "
                         f"{[array.shape for array in arrays]}.  Use numpy.meshgrid or x[:, None] for all "
                         "combinations.") from None


def _checked(params: Sequence[Symbol], t: Symbol) -> tuple[Symbol, ...]:
    if isinstance(params, set | frozenset):
        raise BadTypeError(f"params must be in the order of the arguments, but it is the set {params}, which has none."
                           "  Use [a, b].")
    listed = isinstance(params, Iterable) and not isinstance(params, str)
    names = [params] if isinstance(params, Symbol) else list(params) if listed else [params]
    if not all(isinstance(name, Symbol) for name in names):
        raise BadTypeError(f"params must be a list of SymPy Symbols, but it is {params!r}.  Use [a, b].")
    if len(set(names)) < len(names) or t in names:
        raise BadInputError(f"params must be distinct and without the time {t}, but they are {names}.  "
                            "Name each parameter once.")
    return tuple(names)
