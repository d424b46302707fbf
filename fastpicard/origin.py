"""Series in another origin of time, and their values at exact times."""

from __future__ import annotations

from typing import Any

import sympy
from flint import fmpq
from sympy import Expr, Symbol, pi

from fastpicard import modes as algebra
from fastpicard.modes import Angle, Linear, Modes
from fastpicard.reading import as_finite, as_polynomial, check_same_time, read, trigonometric
from fastpicard.ring import ONE, Polynomial, add_term, generator, multiply, normal
from fastpicard.writing import write


def shifted(modes: Modes, by: Polynomial, t: Symbol) -> Modes:
    """The series at time ``t + by``: ``by`` joins the phases, and powers expand by the binomial theorem."""
    if not by:
        return modes
    powers = [algebra.constant({ONE: fmpq(1)})]
    step = algebra.total(read(t, t), algebra.constant(by))
    result: Modes = {}
    for (kind, angle, monomial), f in modes.items():
        phase, half_turns = _moved(angle, by)
        for r, c in enumerate(f.coeffs()):
            if len(powers) <= r:
                powers.append(algebra.scaled(algebra.product(powers[-1], step), {ONE: fmpq(1, r)}))
            if c:
                wave = trigonometric(kind, (angle[0], phase), half_turns - fmpq(r, 2), t)
                algebra.add_modes(result, algebra.scaled(algebra.product(powers[r], wave), {monomial: c}))
    return result


def at_time(modes: Modes, time: Expr, t: Symbol) -> Expr:
    """The value at a time, canonical and expanded.

    Raises BadInputError for a time that is not finite, or contains another Symbol of the same name as ``t``.
    """
    time = as_finite(time, "the time")
    check_same_time(time, t)
    at = as_polynomial(read(time, sympy.Dummy()))  # the time may contain t
    powers = [{ONE: fmpq(1)}]
    for r in range(1, max((f.length() for f in modes.values()), default=0)):
        powers.append({m: c / r for m, c in multiply(powers[-1], at).items()})
    waves: dict[tuple[int, Angle], Modes] = {}
    result: Modes = {}
    for (kind, angle, monomial), f in algebra.frozen(modes, powers).items():
        if (kind, angle) not in waves:
            phase, half_turns = _moved(angle, at)
            waves[kind, angle] = trigonometric(kind, ((), phase), half_turns, t)
        algebra.add_modes(result, algebra.scaled(waves[kind, angle], {monomial: f[0]}))
    return write(result, t)


def _moved(angle: Angle, by: Polynomial) -> tuple[Linear, Any]:
    """The phase at a time, and the half turns that are in it besides."""
    offset = multiply(algebra.as_polynomial(angle[0]), by)
    half_turns = offset.pop(((generator(pi), 1),), fmpq(0))
    for m, c in algebra.as_polynomial(angle[1]).items():
        add_term(offset, m, c)
    return algebra.linear(normal(offset)), half_turns
