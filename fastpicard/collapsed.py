r"""Exact constants collapsed: polynomials in few variables, with coefficients to any precision.

All that does not depend on the parameters, the time too, is collapsed, in balls,
into one coefficient for each monomial *before* anything is rounded.  What is left
is a polynomial in few variables: the parameters, their reciprocals, roots and
functions, sines and cosines of symbolic phases and frequencies.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from flint import arb, ctx
from sympy import Symbol

from fastpicard import modes as algebra
from fastpicard.errors import BadInputError, printed
from fastpicard.evaluate import Point, check_digits, free_symbols, may_vanish, numpy, refine, to_number
from fastpicard.horner import Exponents, program, run
from fastpicard.modes import COS, NO_ANGLE, SIN, Angle, Linear, Modes, as_polynomial
from fastpicard.precision import working
from fastpicard.ring import Monomial, expression_of, symbols_of, to_expression
from fastpicard.values import Values, exact_number, exact_values

REMEMBERED = 6  # precisions whose coefficients are kept


@dataclass(frozen=True)
class Variable:
    """What a collapsed polynomial is a polynomial in: a power of a generator, or a wave of a phase."""

    power: Monomial = ()
    wave: tuple[int, Angle] = (COS, NO_ANGLE)

    @property
    def symbols(self) -> set[Symbol]:
        """The parameters it depends on."""
        return symbols_of([self.power, *(m for form in self.wave[1] for m, _ in form)])

    def ball(self, point: Point) -> Any:
        """Its value in balls."""
        if self.power:
            return point.monomial(self.power)
        kind, angle = self.wave
        wave = point.wave(angle)
        return wave.real if kind == COS else wave.imag

    @property
    def parameter(self) -> tuple[Any, int]:
        """The parameter, and which of its powers 1, 2 and -1; (None, 0) where it is none of these."""
        if len(self.power) == 1 and self.power[0][1] in (1, 2, -1) and expression_of(self.power[0][0]).is_Symbol:
            return expression_of(self.power[0][0]), int(self.power[0][1])
        return None, 0


class Collapsed:
    """Several constants of one family as polynomials in few variables, with coefficients to any precision.

    Immutable to its users; remembers the coefficients of the precisions last used.

    Parameters
    ----------
    constants : series
    t : Symbol
    time : the time at which the series are taken, an exact number
    resonances : frequencies that were divided by, which may leave no trace where that was in front of a 0: there is no
        value where one of them vanishes
    """

    def __init__(self, constants: list[Modes], t: Symbol, time: Any = 0, resonances: tuple[Linear, ...] = ()) -> None:
        self.t, self.time, self.resonances = t, exact_number(time, "the time"), resonances
        self.symbols = symbols_of(m for q in resonances for m, _ in q).union(*map(free_symbols, constants))
        names = _variables(constants)
        parts = [_parts(modes, names) for modes in constants]
        self.variables = list(names)
        kept = [j for j in range(len(self.variables)) if any(m[j] for part in parts for m in part)]
        kept.sort(key=lambda j: len({m[j] for part in parts for m in part}))  # the fewest powers outermost
        self.variables = [self.variables[j] for j in kept]
        self.exponents = [[tuple(m[j] for j in kept) for m in part] for part in parts]
        self.programs = [program(list(exponents)) for exponents in self.exponents]
        self._inner = [list(part.values()) for part in parts]
        self._balls: dict[int, list[list[Any]]] = {}

    def coefficients(self) -> list[list[Any]]:
        """The coefficients of every constant, balls at the working precision."""
        found = self._balls.pop(ctx.prec, None)
        if found is None:
            constant = Point(self.time, {})
            found = [[constant(modes) for modes in part] for part in self._inner]
        self._balls[ctx.prec] = found  # the last used comes last
        if len(self._balls) > REMEMBERED:
            del self._balls[next(iter(self._balls))]
        return found

    def balls(self, values: dict[Symbol, Any]) -> list[Any]:
        """The constants at a point, at the working precision; raises BadInputError at a resonance."""
        found = self.resonance(values)
        if found is not None:
            raise BadInputError(f"an iterate is divided by its frequencies, but {to_expression(as_polynomial(found))} "
                                f"vanishes at {printed(values)}: a resonance.  Put these numbers into P, and iterate "
                                "then.")
        point = Point(self.time, values)
        variables = [v.ball(point) for v in self.variables]
        return [arb(run(steps, row, variables)) for steps, row in zip(self.programs, self.coefficients(), strict=True)]

    def resonance(self, values: dict[Symbol, Any]) -> Linear | None:
        """A frequency that was divided by and vanishes, if there is one."""
        return next((q for q in self.resonances if may_vanish(q, values)), None)

    def at(self, values: Values | None, digits: int | None) -> list[Any]:
        """The constants at one point, every digit right: see :func:`fastpicard.evaluate.evaluate`."""
        exact = exact_values(values, self.symbols, self.t)
        digits = check_digits(digits)
        return [to_number(x, digits) for x in refine(lambda: self.balls(exact), digits)]

    @cached_property
    def rounded(self) -> tuple[list[int], list[list[tuple[float, float]]]]:
        """Exponents of two that scale the variables, and the scaled coefficients as pairs of floats."""
        flat = iter(refine(lambda: [c for row in self.coefficients() for c in row], 40))
        rows = [[next(flat) for _ in row] for row in self._inner]
        scales = _scales([(m, c) for ms, row in zip(self.exponents, rows, strict=True)
                          for m, c in zip(ms, row, strict=True) if c != 0], self.variables)
        return scales, [[_rounded(c, -sum(map(int.__mul__, scales, m))) for m, c in zip(ms, row, strict=True)]
                        for ms, row in zip(self.exponents, rows, strict=True)]


def _variables(constants: list[Modes]) -> dict[Variable, int]:
    """The variables that occur, each with its place."""
    powers: dict[tuple[int, bool], set[Any]] = {}
    waves: dict[Variable, int] = {}
    for modes in constants:
        for _, angle, monomial in modes:
            if _is_symbolic(angle):
                waves.update({Variable(wave=(COS, angle)): 0, Variable(wave=(SIN, angle)): 0})
            for g, e in monomial:
                if expression_of(g).free_symbols:
                    powers.setdefault((g, e > 0), set()).add(e)
    found = [*waves, *(Variable(((g, _unit(g, exponents)),)) for (g, _), exponents in sorted(powers.items()))]
    return {variable: j for j, variable in enumerate(found)}


def _is_symbolic(angle: Angle) -> bool:
    return bool(symbols_of(m for form in angle for m, _ in form))


def _unit(g: int, exponents: set[Any]) -> Any:
    """The power of a generator that the others are powers of; a square at most where it is a parameter."""
    sign = 1 if min(exponents) > 0 else -1
    unit = sign * Fraction(math.gcd(*(Fraction(e).numerator for e in exponents)),
                           math.lcm(*(Fraction(e).denominator for e in exponents)))
    if unit.denominator > 1:
        return unit
    if expression_of(g).is_Symbol and unit != 2:
        return sign * (2 if sign > 0 and unit % 2 == 0 else 1)
    return int(unit)


def _parts(modes: Modes, names: dict[Variable, int]) -> dict[Exponents, Modes]:
    """A constant by monomials: exponents of the variables, and the rest, which is free of parameters.

    A wave with a symbolic angle leaves a polynomial in t, the real and imaginary parts of ``f(-i t)`` at angle 0:

        Re (c + i s)(x + i y) = c x - s y,     Im (c + i s)(x + i y) = s x + c y
    """
    places = {(v.power[0][0], v.power[0][1] > 0): (j, v.power[0][1]) for v, j in names.items() if v.power}
    parts: dict[Exponents, Modes] = {}
    for (kind, angle, monomial), f in modes.items():
        exponents, rest = [0] * len(names), []
        for g, e in monomial:
            if (g, e > 0) in places and expression_of(g).free_symbols:
                j, unit = places[g, e > 0]
                exponents[j] = int(Fraction(e) / unit)
            else:
                rest.append((g, e))
        if not _is_symbolic(angle):
            parts.setdefault(tuple(exponents), {})[kind, angle, tuple(rest)] = f
            continue
        other = ((1 - kind, SIN, -f if kind == COS else f),) if f.degree() > 0 else ()
        for wave, part, g in ((kind, COS, f), *other):
            j = names[Variable(wave=(wave, angle))]
            place = (*exponents[:j], 1, *exponents[j + 1:])
            algebra.add_mode(parts.setdefault(place, {}), part, NO_ANGLE, tuple(rest), g)
    return parts


def _scales(terms: list[tuple[Exponents, Any]], variables: list[Variable]) -> list[int]:
    """Powers of two for the variables that make the coefficients as equal as may be, by least squares; waves keep 1."""
    places = [j for j, variable in enumerate(variables) if variable.power]
    scales = [0] * len(variables)
    if terms and places:
        np = numpy()
        rows = np.array([[1, *(m[j] for j in places)] for m, _ in terms], dtype=float)
        sizes = np.array([_magnitude(c) for _, c in terms], dtype=float)
        for j, slope in zip(places, np.linalg.lstsq(rows, sizes, rcond=None)[0][1:], strict=True):
            scales[j] = round(float(slope))
    return scales


def _magnitude(c: Any) -> int:
    mantissa, exponent = c.mid().man_exp()
    return int(abs(mantissa)).bit_length() + int(exponent)


def _rounded(c: Any, exponent: int) -> tuple[float, float]:
    """``c * 2**exponent`` as a pair of floats."""
    with working(256):
        c = c * arb(2) ** exponent
        high = to_number(c, None)
        return high, to_number(c - arb(high), None) if math.isfinite(high) else 0.0
