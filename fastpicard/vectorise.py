r"""Exact constants as NumPy functions of their parameters.

All that does not depend on the parameters is collapsed into one coefficient for
each monomial, in balls, before anything is rounded; the coefficients are then
correctly rounded float64 and the polynomial is evaluated by Horner's rule, one
parameter after another, on arrays that broadcast.  For Mathieu's equation over
one period the loss is at most about ``2.7 sqrt(|a| + |b|)`` digits.
"""

from __future__ import annotations

import numbers
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any

import sympy
from flint import arb
from sympy import Symbol

from fastpicard.errors import BadInputError, BadTypeError, MissingParameterError
from fastpicard.evaluate import Point, free_symbols, numpy, refine, to_number
from fastpicard.modes import COS, NO_ANGLE, Angle, Linear, Modes
from fastpicard.ring import expression_of, monomial_expression, symbols_of

Array = Any
Exponents = tuple[Any, ...]


def vectorise(constants: list[Modes], params: Sequence[Symbol], t: Symbol) -> Callable[..., list[Array]]:
    """A function of arrays, one for each parameter, that returns one float64 array for each constant.

    Raises
    ------
    MissingParameterError
        if a parameter that occurs is not among ``params``.
    """
    names = _checked(params, t)
    missing = sorted(set().union(*map(free_symbols, constants)) - set(names), key=str)
    if missing:
        absent = ", ".join(map(str, missing))
        raise MissingParameterError(f"every parameter must be an argument, but {absent} is missing among "
                                    f"{list(names)}.  Add it to the list.")
    polynomials = [_Polynomial(modes, names) for modes in constants]

    def function(*values: Array) -> list[Array]:
        if len(values) != len(names):
            raise BadTypeError(f"the function takes {len(names)} arguments {list(names)}, but {len(values)} were "
                               "given.  Give one number or array for each.")
        arrays = list(numpy().broadcast_arrays(*(_array(value) for value in values)))
        return [polynomial(arrays) for polynomial in polynomials]

    return function


def _array(value: Any) -> Array:
    array = numpy().asarray(value)
    if array.dtype.kind in "USO" and not all(isinstance(x, numbers.Real | sympy.Number) for x in array.flat):
        raise BadTypeError(f"the arguments must be numbers or arrays of numbers, but one is {value!r}.  "
                           "Text and expressions are not evaluated.")
    return array.astype(float)


def _checked(params: Sequence[Symbol], t: Symbol) -> tuple[Symbol, ...]:
    listed = isinstance(params, Iterable) and not isinstance(params, str)
    names = [params] if isinstance(params, Symbol) else list(params) if listed else [params]
    if not all(isinstance(name, Symbol) for name in names):
        raise BadTypeError(f"params must be a list of SymPy Symbols, but it is {params!r}.  Use [a, b].")
    if len(set(names)) < len(names) or t in names:
        raise BadInputError(f"params must be distinct and without the time {t}, but they are {names}.  "
                            "Name each parameter once.")
    return tuple(names)


class _Polynomial:
    """A constant of the family: Laurent polynomial times sines and cosines of phases."""

    def __init__(self, modes: Modes, names: tuple[Symbol, ...]) -> None:
        self.names = names
        self.variables = sorted({g for _, _, m in modes for g, _ in m if expression_of(g).free_symbols})
        groups: dict[tuple[int, Angle, Exponents], Modes] = {}
        for (kind, angle, monomial), f in modes.items():
            fixed = not symbols_of(m for m, _ in angle[1])
            exponents = tuple(dict(monomial).get(g, 0) for g in self.variables)
            rest = tuple((g, e) for g, e in monomial if g not in self.variables)
            outer = (COS, NO_ANGLE) if fixed else (kind, angle)
            inner = (kind, angle) if fixed else (COS, NO_ANGLE)
            groups.setdefault((*outer, exponents), {})[(*inner, rest)] = f
        values = _rounded(list(groups.values()))
        self.waves: dict[tuple[int, Angle], dict[Exponents, float]] = {}
        for (kind, angle, exponents), value in zip(groups, values, strict=True):
            self.waves.setdefault((kind, angle), {})[exponents] = value
        self.functions = {g: _generator_function(g, names) for g in self.variables}

    def __call__(self, arrays: list[Array]) -> Array:
        shape = arrays[0].shape if arrays else ()
        variables = [self.functions[g](arrays) for g in self.variables]
        total = numpy().zeros(shape)
        for (kind, angle), terms in self.waves.items():
            value = horner(terms, variables)
            if angle != NO_ANGLE:
                phase = _linear(angle[1], self.names)(arrays)
                value = value * (numpy().cos(phase) if kind == COS else numpy().sin(phase))
            total = total + value
        return total


def _rounded(constants: list[Modes]) -> list[float]:
    """Constants without parameters as correctly rounded floats."""
    balls = refine(lambda: [Point(arb(0), {})(modes) for modes in constants], None) if constants else []
    return [to_number(x, None) for x in balls]


def horner(terms: dict[Exponents, float], variables: list[Array]) -> Array:
    """``sum c x**i y**j ...`` by Horner's rule in the first variable, recursively in the others."""
    if not variables:
        return terms[()]
    first, *others = variables
    rows: dict[Any, dict[Exponents, float]] = {}
    for (e, *rest), value in terms.items():
        rows.setdefault(e, {})[tuple(rest)] = value
    exponents = sorted(rows, reverse=True)
    total: Array = 0.0
    for e, below in zip(exponents, [*exponents[1:], 0], strict=True):
        total = (total + horner(rows[e], others)) * _power(first, e - below)
    return total


def _power(x: Array, e: Any) -> Array:
    if e == 0:
        return 1.0
    if e == 1:
        return x
    return numpy().power(x, float(e)) if isinstance(e, Fraction) else x ** int(e)


def _generator_function(number: int, names: tuple[Symbol, ...]) -> Callable[[list[Array]], Array]:
    e = expression_of(number)
    if e in names:
        place = names.index(e)
        return lambda arrays: arrays[place]
    return _lambdified(e, names)


def _lambdified(e: Any, names: tuple[Symbol, ...]) -> Callable[[list[Array]], Array]:
    """SymPy's lambdify on renamed symbols, for a symbol's name is code to it."""
    dummies = [sympy.Dummy() for _ in names]
    function = sympy.lambdify(dummies, e.subs(dict(zip(names, dummies, strict=True))), "numpy")
    return lambda arrays: function(*arrays)


def _linear(form: Linear, names: tuple[Symbol, ...]) -> Callable[[list[Array]], Array]:
    expression = sympy.Add(*(sympy.Rational(c) * monomial_expression(m) for m, c in form))
    return _lambdified(expression, names)
