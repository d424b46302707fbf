r"""Boundaries of stability for any number of degrees of freedom: exact functions of the parameters and their curves.

Equation (15) of [Neves], trace = +-2, is the case N = 1 of this.  Where multipliers come in pairs ``lambda, 1/lambda``
the characteristic polynomial is a polynomial p of degree N in ``rho = lambda + 1/lambda``, and stability can change
only where a rho leaves the interval [-2, 2]: at its ends, or by meeting another one:

    p(2) = 0   label "+1",        p(-2) = 0   label "-1",        disc p = 0   label "collision".

All three are polynomials in the parameters with exact coefficients: smooth, where the largest modulus of an
eigenvalue has a kink, so that Newton's method finds them in a handful of evaluations and tangents are exact.
Where P reverses in time (cosine driving), p(2) and p(-2) fall into two factors each, the boundaries of even and
of odd solutions (module ``halfway``), whose zeros are simple where those of p are double.
``disc p`` is the determinant of Hermite's matrix of power sums (module ``determinants``).
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from flint import arb, ctx
from mpmath.libmp import dps_to_prec
from sympy import Expr, Symbol, latex

from fastpicard.axes import axes_of, fixed_numbers, mapping_of, point_of, refuse_integer
from fastpicard.collapsed import Collapsed
from fastpicard.curves import curve, exact_ball, zero
from fastpicard.determinants import determinant, hermite, power_sums, sums_of_rho
from fastpicard.duals import Dual, derivative
from fastpicard.errors import BadInputError, BadTypeError, namesake
from fastpicard.evaluate import ball, check_digits, free_symbols, refine, to_number, upper_float
from fastpicard.floquet import FloquetMatrix
from fastpicard.halfway import half_period, known_structure, reversal
from fastpicard.latex import meaning, number, sentence, shown
from fastpicard.modes import Modes
from fastpicard.precision import working
from fastpicard.remainder import a_posteriori
from fastpicard.ring import symbols_of
from fastpicard.series import PoissonSeries
from fastpicard.values import Values, check_assumptions, exact_number, exact_values

Matrix = list[list[Any]]


def boundaries(F: FloquetMatrix) -> tuple[Boundary, ...]:
    """The functions whose zeros bound stability: exact polynomials in the parameters, from the n-th iterate.

    Parameters
    ----------
    F : FloquetMatrix, shape (2N, 2N), multipliers in pairs lambda, 1/lambda

    Returns
    -------
    tuple of Boundary
        where ``P`` reverses in time: ``"+1"`` even and odd, ``"-1"`` even and odd; otherwise ``"+1"`` and ``"-1"``;
        for N > 1 ``"collision"`` as well.

    Raises
    ------
    BadInputError
        if the multipliers do not come in pairs (damping), with what to do.
    BadTypeError
        if F is no FloquetMatrix.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 40)
    >>> for f in boundaries(F):
    ...     print(f.label, f.parity)
    +1 even
    +1 odd
    -1 even
    -1 odd
    >>> boundaries(F)[2].root(a, (-0.7, 0.2), {b: 1.5}).value
    -0.6963449249569149
    """
    if not isinstance(F, FloquetMatrix):
        raise BadTypeError(f"boundaries are those of a FloquetMatrix, but this is {F!r}.  Use FloquetMatrix(P, t, 20).")
    size, signs = F.shape[0], reversal(F.P)
    if size % 2 or not known_structure(F).paired:
        raise BadInputError("boundaries need multipliers in pairs lambda, 1/lambda, and those of this P do not come in "
                            "pairs (damping, say).  Use certify or F.verdict, which ask whether all are inside the "
                            "unit circle.")
    found = []
    if signs is not None and signs.count(1) == size // 2:
        half = half_period(F)
        plus, minus = ([i for i in range(size) if signs[i] == s] for s in (1, -1))
        for label, parity, rows, columns in (("+1", "even", minus, plus), ("+1", "odd", plus, minus),
                                             ("-1", "even", plus, plus), ("-1", "odd", minus, minus)):
            block = [[half[i][j] for j in columns] for i in rows]
            found.append(Boundary(F, label, parity, block, determinant, half=True))
    else:
        whole = [[F.entry(i, j) for j in range(size)] for i in range(size)]
        found += [Boundary(F, "+1", "", whole, _at_plus), Boundary(F, "-1", "", whole, _at_minus)]
    if size > 2:
        if signs is not None and signs.count(1) == size // 2:
            block = [[F.entry(i, j) for j in plus] for i in plus]
            found.append(Boundary(F, "collision", "", block, _discriminant_of_block))
        else:
            found.append(Boundary(F, "collision", "", whole, _discriminant))
    for place, boundary in enumerate(found):
        boundary._place = place
    return tuple(found)


def _boundary(F: FloquetMatrix, place: int) -> Boundary:
    return boundaries(F)[place]


def _shifted(rows: Matrix, by: int) -> Matrix:
    return [[x + by if i == j else x for j, x in enumerate(row)] for i, row in enumerate(rows)]


def _at_plus(rows: Matrix) -> Any:
    return determinant(_shifted(rows, -1))


def _at_minus(rows: Matrix) -> Any:
    return determinant(_shifted(rows, 1))


def _discriminant_of_block(rows: Matrix) -> Any:
    """disc p, where the rho are the eigenvalues of twice the block."""
    size = len(rows)
    doubled = [[x * 2 for x in row] for row in rows]
    return determinant(_summable(hermite(power_sums(doubled, 2 * size - 2), size, False), doubled[0][0]))


def _discriminant(rows: Matrix) -> Any:
    size = len(rows) // 2
    sums = sums_of_rho(power_sums(rows, 2 * size - 2), 2 * size - 2, 2 * size)
    return determinant(_summable(hermite(sums, size, False), rows[0][0]))


def _summable(rows: Matrix, like: Any) -> Matrix:
    """The same with the number N in the corner as an element of the ring."""
    return [[like * 0 + x if isinstance(x, int) else x for x in row] for row in rows]


# -- one function --------------------------------------------------------------


@dataclass(frozen=True)
class Root:
    """Where a boundary crosses a line.

    Attributes
    ----------
    value : float or mpf      of the parameter that was sought
    error : float             a root of the true boundary is proved to lie within this; ``inf`` where it is not
    evaluations : int         how often the function was evaluated
    slopes : {Symbol: float}  the derivative of ``value`` by each of the other parameters, along the boundary; nan at a
        multiple root, which has none
    """

    value: Any
    error: float
    evaluations: int
    slopes: Mapping[Symbol, float] = field(hash=False)

    def _repr_latex_(self) -> str:
        proved = rf"\pm {number(self.error, 2)}" if self.error < math.inf else sentence(", not proved")
        return shown(f"{number(self.value)} {proved}")


class Boundary:
    """A polynomial in the parameters whose zeros bound stability.

    Attributes
    ----------
    label : str           ``"+1"``: a multiplier is 1; ``"-1"``: one is -1; ``"collision"``: two pairs coincide
    parity : str          of the periodic solution on the boundary: ``"even"``, ``"odd"``, or ``""`` where not known
    symbols : tuple of Symbols, the parameters
    """

    def __init__(self, F: FloquetMatrix, label: str, parity: str, entries: list[list[Modes]],
                 combine: Callable[[Matrix], Any], half: bool = False) -> None:
        self.label, self.parity = label, parity
        self._F, self._entries, self._combine, self._half = F, entries, combine, half
        self._columns = len(entries[0])
        self._collapsed = {None: F.collapse([modes for row in entries for modes in row])}
        self.symbols = tuple(sorted(self._collapsed[None].symbols, key=str))
        self._place = 0  # among all boundaries of F

    def __reduce__(self) -> tuple[Any, ...]:
        """The arguments: the iterate is computed again."""
        return _boundary, (self._F, self._place)

    def expression(self) -> Expr:
        """The polynomial, exact and expanded: long for orders above ten."""
        t = self._F.t
        rows = [[PoissonSeries.from_modes(modes, t) for modes in row] for row in self._entries]
        return self._combine(rows).as_expr()

    def __call__(self, values: Values, digits: int | None = None) -> Any:
        """The n-th iterate's value: float, or mpf with ``digits`` digits, all of them right."""
        exact, wanted = exact_values(values, self.symbols, self._F.t), check_digits(digits)
        return to_number(refine(lambda: self._dual(exact, ()), wanted)[0], wanted)

    def gradient(self, values: Values) -> dict[Symbol, float]:
        """The derivatives by all parameters."""
        exact = exact_values(values, self.symbols, self._F.t)
        slopes = refine(lambda: self._dual(exact, self.symbols)[1:], None)
        return {s: to_number(x, None) for s, x in zip(self.symbols, slopes, strict=True)}

    @cached_property
    def parameters(self) -> set[Symbol]:
        """All of ``P`` and its period, which the polynomial of a low order may not contain."""
        occurring = (free_symbols(modes) for row in self._F.P.rows for modes in row)
        return set(self.symbols).union(symbols_of(self._F.length), *occurring)

    def _of(self, symbol: Symbol | None) -> Collapsed:
        if symbol not in self._collapsed:
            rows = [derivative(modes, symbol) for row in self._entries for modes in row]
            self._collapsed[symbol] = self._F.collapse(rows)
        return self._collapsed[symbol]

    def _dual(self, values: Mapping[Any, Any], symbols: Sequence[Symbol], slack: Any = None) -> list[Any]:
        """The value and derivatives in balls; with ``slack``, balls that contain those of the true function."""
        parts = [self._of(s).balls(dict(values)) for s in (None, *symbols)]
        if slack is not None:
            parts = [[x + arb(0, e) for x, e in zip(part, slack, strict=True)] for part in parts]
        numbers = [Dual(list(x)) for x in zip(*parts, strict=True)]
        parts_of: list[Any] = self._combine(_rows(numbers, self._columns)).parts
        return parts_of

    # -- roots -------------------------------------------------------------------

    def root(self, x: Symbol, bracket: tuple[Any, Any], fixed: Values | None = None, digits: int = 15) -> Root:
        """A zero in ``x`` between two values where the function has different signs, by Newton's method in a bracket.

        Parameters
        ----------
        x : Symbol
        bracket : (lo, hi), numbers
        fixed : {Symbol: number}      the other parameters
        digits : int                  of the zero of the n-th iterate's function; above 15 an mpf is returned

        Returns
        -------
        Root
            with a proved distance to a zero of the *true* function.

        Raises
        ------
        BadInputError
            if the signs at both ends agree, or there is a pole between them; if ``x`` is none of ``symbols``, or fixed.
        BadTypeError
            if ``x`` is no Symbol, or the bracket no pair.
        MissingParameterError
            if another parameter has no value.
        """
        wanted = check_digits(digits) or 15
        if not isinstance(x, Symbol):
            raise BadTypeError(f"the unknown must be a SymPy Symbol, but it is {x!r}.  Use one of "
                               f"{list(self.symbols)}.")
        refuse_integer(x)
        if x not in self.symbols:
            raise BadInputError(f"the unknown must be one of the parameters {list(self.symbols)}, but it is {x}.  "
                                f"Choose one of these.{namesake((x,), self.symbols)}")
        if not isinstance(bracket, tuple | list) or len(bracket) != 2:
            raise BadTypeError(f"the bracket must be two numbers (lo, hi), but it is {bracket!r}.  Give both ends.")
        for end in bracket:
            check_assumptions(x, ball(exact_number(end, "an end of the bracket")))
        if x in mapping_of(fixed):
            raise BadInputError(f"the unknown is sought, but {x} is fixed at {mapping_of(fixed)[x]}.  Leave it out of "
                                "fixed.")
        exact = exact_values(mapping_of(fixed), self.parameters - {x}, self._F.t)
        with working(dps_to_prec(wanted) + 64):
            value, count = zero(lambda here: self._dual({**exact, x: here}, (x,)), bracket, arb(10) ** -wanted)
            dual = self._dual({**exact, x: value}, (x, *(s for s in self.symbols if s != x)))
            others = [s for s in self.symbols if s != x]
            slopes = {s: float("nan") if dual[1].contains(0) else to_number(-d / dual[1], None)
                      for s, d in zip(others, dual[2:], strict=True)}
            rounded = to_number(value, None if wanted <= 15 else wanted)
            lost = abs(value - exact_ball(rounded)) + arb(self._proved(x, exact, value, dual[1]))
            return Root(rounded, upper_float(lost.upper()) if lost.is_finite() else float("inf"), count + 1, slopes)

    def _proved(self, x: Symbol, exact: dict[Any, Any], value: Any, slope: Any) -> float:
        """A distance at which the true function is proved to have different signs on both sides, and none is a pole.

        The remainder is that of the whole interval, which is made as wide as need be.
        """
        size = abs(value) if value != 0 else arb(1)
        radius, least = size * arb(2) ** -40, size * arb(2) ** (8 - ctx.prec)
        for _ in range(5):
            slack = self._slack({**exact, x: arb(value.mid(), radius.upper())})
            if slack is None or slope.contains(0) or not radius <= abs(value) + 1:
                break
            at = self._dual({**exact, x: value}, (), slack)[0]
            near = (abs(at) / abs(slope) + least).upper()
            if not near.is_finite():
                break
            for distance in ((near * factor).upper() for factor in (1.25, 2)):
                if distance <= radius and self._changes_sign(x, {**exact, x: value}, distance, slack):
                    return upper_float(distance)
            radius = max(1.5 * radius, 1.4 * near)
        return float("inf")

    def _changes_sign(self, x: Symbol, values: dict[Any, Any], distance: Any, slack: list[Any]) -> bool:
        """Whether the true function has different signs at a distance on both sides."""
        with working(ctx.prec + 32):
            left, right = (self._dual({**values, x: (values[x] + side * distance).mid()}, (), slack)[0]
                           for side in (-1, 1))
        return bool(left < 0 < right or right < 0 < left)

    def _slack(self, values: dict[Any, Any]) -> list[Any] | None:
        """The remainder for every entry; None where ``P`` has a pole in a ball."""
        try:
            P, period = self._F.at(values)
        except BadInputError:
            return None
        bound = a_posteriori(P, period / 2 if self._half else period, self._F.n)
        largest = max((entry.upper() for entry in bound.entries()), default=arb(0))
        return [largest] * (len(self._entries) * self._columns)

    # -- curves ------------------------------------------------------------------

    def follow(self, x: tuple[Symbol, Any, Any], y: tuple[Symbol, Any, Any], start: tuple[Any, Any],
               fixed: Values | None = None, step: float = 0.02) -> tuple[Any, Any]:
        """The curve through a point of it, both ways, until it leaves the rectangle or closes.

        It goes straight on where it crosses itself or another one.  It ends on an edge, to 1e-10 of the sides, or where
        it bends within 1e-10 of them, as at a cusp.  Branches nearer to each other than 1e-8 of the sides count as
        crossing.

        Parameters
        ----------
        x, y : (Symbol, lo, hi)
        start : (x, y)      near the curve
        fixed : {Symbol: number}
        step : float        the longest step, as a part of the rectangle's sides; shortened where the curve bends

        Returns
        -------
        points, tangents : arrays, shape (m, 2) each
            every point to 1e-12 of the sides, or an ulp; tangents ``(dx, dy)``, in units of the sides, of length 1,
            from each point to the next.  A curve that closes ends with its first point.

        Raises
        ------
        BadInputError, BadTypeError
            if no boundary is found near ``start``, or that is not in the rectangle; if it goes on for more
            steps than a hundred sides take; if axes, ``fixed`` or ``step`` are not as described.
        """
        axes = axes_of(x, y)
        names, box = tuple(axis.symbol for axis in axes), [(axis.lo, axis.hi - axis.lo) for axis in axes]
        numbers_given = fixed_numbers(fixed, names)
        exact = exact_values({**numbers_given, names[0]: 0, names[1]: 0}, self.symbols, self._F.t)
        place = point_of(start)
        if not all(axis.lo <= z <= axis.hi for axis, z in zip(axes, place, strict=True)):
            raise BadInputError(f"start must be in the rectangle of x and y, but it is {start}.  Give a point there.")
        if isinstance(step, bool) or not isinstance(step, numbers.Real) or not 1e-6 <= step <= 1:
            raise BadInputError(f"step must be a part of the rectangle's sides, from 1e-6 to 1, but it is {step!r}.  "
                                "Use step=0.02.")
        found = curve(lambda *place: self._dual({**exact, **dict(zip(names, place, strict=True))}, names), box, place,
                      float(step))
        if found is None:
            raise BadInputError("a boundary is followed from a point near it, but none was found in the rectangle "
                                f"near {start}.  Start from a root().")
        return found

    def __repr__(self) -> str:
        kind = f"{self.label} {self.parity}".strip()
        return f"<Boundary {kind} in {', '.join(map(str, self.symbols))}, from {self._F!r}>"

    def _repr_latex_(self) -> str:
        names = ", ".join(map(latex, self.symbols))
        return shown(meaning(self.label, self.parity), rf"{sentence('a polynomial in')}\; {names}",
                     sentence(f"order {self._F.n}"))


def _rows(numbers: list[Any], columns: int) -> Matrix:
    return [numbers[k:k + columns] for k in range(0, len(numbers), columns)]


__all__ = ["Boundary", "Root", "boundaries"]
