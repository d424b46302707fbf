r"""The two variables of a chart, and the polynomials in them.

A chart has two parameters x and y.  What the equation holds of them may be a power, as ``1/v**2`` in the rods'
equations, so inside the variables are ``u = x**p`` and ``w = y**q``: monotone, so that rectangles stay
rectangles, and everything is a polynomial in them.

Problems that decouple into *modes* are one small equation with several sets of parameters (vertically driven rods:
Mathieu's equation with ``a = -mu_i/v**2``, ``b = mu_i h``, [Neves] (21)).  One exact polynomial serves them all:
a monomial ``a**i b**j`` becomes a number times a monomial in u and w.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import gcd
from typing import Any

import sympy
from flint import arb, ctx
from sympy import Expr, Symbol

from fastpicard.axes import LARGEST, Axis, axes_of, fixed_numbers, refuse_integer
from fastpicard.collapsed import Collapsed
from fastpicard.errors import BadInputError, BadTypeError, MissingParameterError, namesake
from fastpicard.evaluate import expression_ball, numpy, upper_float
from fastpicard.floquet import FloquetMatrix
from fastpicard.reading import as_expression
from fastpicard.ring import Monomial, expression_of, symbols_of
from fastpicard.values import Values, check_assumptions

Array = Any
Exponents = tuple[int, int]
Member = Mapping[Symbol, tuple[Expr, Exponents]]  # a parameter of P: a number times x**i y**j


@dataclass(frozen=True)
class Charted:
    """An equation with two parameters left.

    Attributes
    ----------
    F : FloquetMatrix        its parameters are those of the members
    axes : (Axis, Axis)
    members : sequence of {Symbol: (number, (i, j))}     the parameters as numbers times ``x**i y**j``, mode by mode
    decoupled : bool         whether the members are modes of one system, which is stable where all of them are
    """

    F: FloquetMatrix
    axes: tuple[Axis, Axis]
    members: tuple[Member, ...]
    decoupled: bool

    @property
    def period(self) -> Any:
        """The period T, a ball at the working precision."""
        if self.F.period.free_symbols:
            raise BadInputError(f"the period of a chart must be a number, but it is {self.F.period}.  Measure the time "
                                "in units of it.")
        return expression_ball(self.F.period, {})

    def exponents(self, member: Member, powers: Sequence[tuple[Symbol, int]]) -> Exponents:
        """The exponents of u and w of a monomial in the parameters."""
        return _exponents(member, powers, self.axes)

    def factor(self, member: Member, powers: Sequence[tuple[Symbol, int]]) -> Any:
        """The number in front of it, a ball."""
        return math.prod((constant_ball(member[s][0]) ** e for s, e in powers if member[s][0] != 1), start=arb(1))

    def polynomials(self, collapsed: Collapsed, member: Member) -> list[dict[Exponents, Any]]:
        """Exact constants as polynomials in u and w with balls as coefficients."""
        parameters = [v.parameter for v in collapsed.variables]
        if any(symbol is None for symbol, _ in parameters):
            raise BadInputError("a chart needs polynomials in its parameters, but a phase or function of them is left: "
                                f"{next(v for v in collapsed.variables if v.parameter[0] is None).symbols}.  Name it "
                                "by a symbol of its own.")
        found = []
        for exponents, row in zip(collapsed.exponents, collapsed.coefficients(), strict=True):
            terms: dict[Exponents, Any] = {}
            for m, c in zip(exponents, row, strict=True):
                powers = [(symbol, unit * k) for (symbol, unit), k in zip(parameters, m, strict=True) if k]
                place = self.exponents(member, powers)
                terms[place] = terms.get(place, arb(0)) + c * self.factor(member, powers)
            found.append(terms)
        return found

    def waves(self, member: Member) -> dict[tuple[int, int], dict[Any, dict[Exponents, Any]]]:
        """``P`` by entries and waves (kind, frequency): the amplitudes as polynomials in u and w."""
        found: dict[tuple[int, int], dict[Any, dict[Exponents, Any]]] = {}
        for i, row in enumerate(self.F.P.rows):
            for j, modes in enumerate(row):
                for (kind, angle, monomial), f in modes.items():
                    powers, number = parameters_of(monomial)
                    terms = found.setdefault((i, j), {}).setdefault((kind, angle), {})
                    place = self.exponents(member, powers)
                    amount = arb(f[0]) * constant_ball(number) * self.factor(member, powers)
                    terms[place] = terms.get(place, arb(0)) + amount
        return found


def parameters_of(monomial: Monomial) -> tuple[list[tuple[Symbol, int]], Expr]:
    """The powers of Symbols in a monomial, and the rest, a number."""
    powers, number = [], sympy.Integer(1)
    for g, e in monomial:
        expression = expression_of(g)
        if expression.is_Symbol and e == int(e):
            powers.append((expression, int(e)))
        elif expression.free_symbols:
            raise BadInputError(f"a chart needs whole powers of its parameters, but P contains {expression}**{e}.  "
                                "Name that by a symbol of its own.")
        else:
            number *= expression ** sympy.Rational(e)
    return powers, number


def _exponents(member: Member, powers: Sequence[tuple[Symbol, int]], axes: tuple[Axis, Axis]) -> Exponents:
    i = sum(member[s][1][0] * e for s, e in powers)
    j = sum(member[s][1][1] * e for s, e in powers)
    return i // axes[0].power, j // axes[1].power


@lru_cache(maxsize=512)
def _constant(e: Expr, bits: int) -> Any:
    return expression_ball(e, {})


def constant_ball(e: Expr) -> Any:
    """A constant SymPy expression as a ball at the working precision; roots of polynomials included."""
    return _constant(e, ctx.prec)


# -- reading -------------------------------------------------------------------


def read_chart(F: FloquetMatrix, x: Any, y: Any, fixed: Values | None, modes: Any) -> Charted:
    """The chart of an equation, or of one equation for each mode.

    Raises
    ------
    BadTypeError, BadInputError
        if an axis is not ``(Symbol, lo, hi)`` with ``lo < hi``, or a parameter occurs in another way than as a power.
    MissingParameterError
        if a parameter is neither on an axis, nor fixed, nor given by the modes.
    """
    if not isinstance(F, FloquetMatrix):
        raise BadTypeError(f"a chart is drawn of a FloquetMatrix, but this is {F!r}.  Use FloquetMatrix(P, t, 20).")
    first, second = axes_of(x, y)
    decoupled = modes is not None
    given = list(modes) if decoupled else [{s: s for s in (first.symbol, second.symbol)}]
    if not given:
        raise BadInputError("a chart with modes is one of several equations, but modes is empty.  Give one or more.")
    numbers = fixed_numbers(fixed, (first.symbol, second.symbol,
                                    *(s for mode in given if isinstance(mode, Mapping) for s in mode)))
    if numbers:
        F = with_values(F, numbers)
    waves = symbols_of(m for row in F.P.rows for entry in row for _, (q, _), _ in entry for m, _ in q)
    if waves:
        raise BadInputError(f"the frequencies of a chart must be numbers, but one contains {min(waves, key=str)}.  "
                            "Give it a number in fixed={...}, or measure the time in units of it.")
    members = tuple(_member(mode, numbers, first.symbol, second.symbol) for mode in given)
    for member in members:
        missing = sorted((s for s in parameters(F) if s not in member), key=str)
        if missing and decoupled:
            raise MissingParameterError(f"every mode gives all parameters of P but the fixed ones, also those on the "
                                        f"axes, and one does not give {missing[0]}.  Add {missing[0]}: ... to it.")
        if missing:
            raise MissingParameterError(f"every parameter must be on an axis or have a value, but there is neither for "
                                        f"{', '.join(map(str, missing))}.  Use fixed={{{missing[0]}: 1}}, say."
                                        + namesake(missing, (first.symbol, second.symbol, *numbers)))
        zeros = [s for row in F.P.rows for entry in row for _, _, monomial in entry
                 for s, e in parameters_of(monomial)[0] if e < 0 and member[s][0] == 0]
        if zeros:
            raise BadInputError(f"P contains a negative power of {zeros[0]}, which is 0 in a mode.  Give it another "
                                "value.")
    used = [[sum(member[s][1][k] * e for s, e in parameters_of(monomial)[0]) for member in members
             for row in F.P.rows for entry in row for _, _, monomial in entry] for k in (0, 1)]
    axes = (_with_power(first, used[0]), _with_power(second, used[1]))
    chart = Charted(F, axes, members, decoupled)
    _refuse_infinities(chart)
    _check_members(chart)
    return chart


def _check_members(chart: Charted) -> None:
    """Raise BadInputError where a mode gives a parameter values that its assumptions exclude."""
    for member in chart.members if chart.decoupled else ():
        for s, (number, powers) in member.items():
            if any(powers):
                refuse_integer(s)
            for x in (chart.axes[0].lo, chart.axes[0].hi):
                for y in (chart.axes[1].lo, chart.axes[1].hi):
                    value = constant_ball(number) * arb(x) ** powers[0] * arb(y) ** powers[1]
                    check_assumptions(s, value)


def _refuse_infinities(chart: Charted) -> None:
    """Raise BadInputError where a term of ``P`` or a power of an axis grows beyond what floats can hold."""
    reach = [max((abs(arb(end) ** axis.power) for end in (axis.lo, axis.hi)), key=upper_float) for axis in chart.axes]
    sizes = [abs(c) * reach[0]**i * reach[1]**j for member in chart.members for waves in chart.waves(member).values()
             for terms in waves.values() for (i, j), c in terms.items()]
    largest = max(upper_float(size) for size in (*reach, *sizes))
    if not largest < LARGEST:
        raise BadInputError(f"what is on a chart must stay below {LARGEST:g}, floats end soon after it, but P or a "
                            f"power of a parameter reaches {largest:.3g}.  Measure the parameters in other units.")


def refuse_phases(F: FloquetMatrix) -> None:
    """Raise BadInputError where a parameter is left in a phase, before an iterate is computed."""
    phases = symbols_of(m for row in F.P.rows for entry in row for _, (_, phase), _ in entry for m, _ in phase)
    if phases:
        raise BadInputError(f"a chart is proved of polynomials in its parameters, but P has a phase with "
                            f"{', '.join(sorted(map(str, phases)))}.  Give it a number in fixed={{...}}.")


def parameters(F: FloquetMatrix) -> set[Symbol]:
    """All parameters of ``P``, in amplitudes and phases."""
    modes = [key for row in F.P.rows for entry in row for key in entry]
    return {s for _, _, monomial in modes for s, _ in parameters_of(monomial)[0]}.union(
        *(symbols_of(m for m, _ in phase) for _, (_, phase), _ in modes))


def with_values(F: FloquetMatrix, values: Mapping[Symbol, Expr]) -> FloquetMatrix:
    """The same equation with numbers put in, exactly."""
    return FloquetMatrix(F.P.as_matrix().xreplace(dict(values)), F.t, F.n, F.period.xreplace(dict(values)))


def _member(mode: Mapping[Symbol, Any], numbers: Mapping[Symbol, Expr], x: Symbol, y: Symbol) -> Member:
    if not isinstance(mode, Mapping):
        raise BadTypeError(f"every mode maps the parameters of P to expressions, but one is {mode!r}.  "
                           "Use [{a: -mu/v**2, b: mu*h} for mu in ...].")
    result = {}
    for symbol, value in mode.items():
        expression = sympy.expand(as_expression(value, f"the value of {symbol}").xreplace(dict(numbers)))
        if expression.is_zero:
            result[symbol] = sympy.Integer(0), (0, 0)
            continue
        terms: dict[Expr, Expr] = {}
        for term in sympy.Add.make_args(expression):
            number, monomial = term.as_independent(x, y, as_Add=False)
            terms[monomial] = terms.get(monomial, sympy.Integer(0)) + number
        monomial, coefficient = next(iter(terms.items()))
        powers = dict(monomial.as_powers_dict())
        powers.pop(sympy.Integer(1), None)
        whole = set(powers) <= {x, y} and all(e.is_Integer for e in powers.values())
        if len(terms) > 1 or coefficient.free_symbols or not whole:
            raise BadInputError(f"the parameters of a mode must be numbers times powers of {x} and {y}, but {symbol} "
                                f"is {expression}.  Fix the other symbols.")
        result[symbol] = coefficient, (int(powers.get(x, 0)), int(powers.get(y, 0)))
    return result


def _with_power(axis: Axis, exponents: list[int]) -> Axis:
    used = {e for e in exponents if e}
    if not used:
        return axis
    if min(used) < 0 < max(used):
        raise BadInputError(f"a chart needs powers of {axis.symbol} of one sign, but {sorted(used)} occur.  Multiply "
                            "the time by a power of it, or name its reciprocal by a symbol of its own.")
    power = int(math.copysign(gcd(*used), max(used, key=abs)))
    if power < 0 and axis.lo <= 0:
        raise BadInputError(f"P contains a negative power of {axis.symbol}, so its interval must be positive, but it "
                            f"is [{axis.lo}, {axis.hi}].  Begin above 0.")
    if power > 1 and axis.lo < 0:
        power = 1
    return Axis(axis.symbol, axis.lo, axis.hi, power)


def images(mode: Mapping[Symbol, Any], names: tuple[Symbol, Symbol], axes: tuple[Symbol, Symbol],
           points: tuple[Array, Array]) -> Array:
    """Points in the plane of a mode's two parameters, in the plane of the axes: shape (2, m), nan where there is none.

    ``a = c x**i y**j`` and ``b = d x**k y**l`` are linear equations for the logarithms of x and y.
    """
    np = numpy()
    member = _member(mode, {}, *axes)
    (c, (i, j)), (d, (k, l)) = (member[name] for name in names)
    determinant = i * l - j * k
    if determinant == 0:
        raise BadInputError(f"{names[0]} = {mode[names[0]]} and {names[1]} = {mode[names[1]]} must determine {axes[0]} "
                            f"and {axes[1]}, but they do not.  Draw these tubes in the plane of {names}.")
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (np.log(np.asarray(z, dtype=float) / float(z0)) for z, z0 in zip(points, (c, d), strict=True))
        found = np.exp(np.array([l * first - j * second, i * second - k * first]) / determinant)
    return np.where(np.isfinite(found), found, np.nan)
