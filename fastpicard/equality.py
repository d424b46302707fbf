r"""Whether a series is zero as a function of time and parameters.

Modes are canonical, so where no relation binds the parameters a series is zero when it has no modes.  Otherwise

    sum over q, r of t**r (c cos qt + s sin qt),   c and s of the parameters

is formed with one name for every angle, for ``(b**2 - c**2)/(b + c)`` is ``b - c``; where ``cos phi`` is among the
coefficients, phases join them, ``cos(qt + phi) = cos phi cos qt - sin phi sin qt``, and so do always the terms of a
phase whose cosine SymPy writes as another function, ``cos(atan a) = 1/sqrt(1 + a**2)``.  These functions of time are
independent, so that every coefficient is asked whether it is zero (``fastpicard.ring.is_zero``).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from sympy import I, cos, expand_trig, sin
from sympy.functions.elementary.trigonometric import InverseTrigonometricFunction

from fastpicard.modes import (
    COS,
    NO_ANGLE,
    Angle,
    Linear,
    Modes,
    add_angles,
    add_reflected,
    as_polynomial,
    orient,
    settled,
)
from fastpicard.ring import (
    Monomial,
    Polynomial,
    add_term,
    expression_of,
    has_relations,
    has_waves,
    is_zero,
    multiply_monomials,
    power,
    rational_value,
    to_expression,
)


def vanishes(modes: Modes) -> bool:
    """Whether a series is zero as a function of time and parameters."""
    monomials = {m for _, (frequency, phase), own in modes for m in (own, *dict(frequency), *dict(phase))}
    return not support(modes) if has_relations(monomials) or _known_phases(modes) else not modes


def support(modes: Modes) -> frozenset[tuple[Any, int]]:
    """The ``(q, r)`` of the waves of rational frequency ``q``, or of other frequencies (None), at ``t**r``.

    Waves that cancel by relations between parameters do not count, so equal series have equal support.
    """
    if _known_phases(modes):
        modes = _without_phases(modes, _is_known)
    if has_waves(m for _, _, m in modes):
        modes = _without_phases(modes, lambda m: True)
    collected: dict[tuple[int, Angle, int], Polynomial] = {}
    for (kind, angle, monomial), f in _with_one_name(modes).items():
        for r, c in enumerate(f.coeffs()):
            if c:
                add_term(collected.setdefault((kind, angle, r), {}), monomial, c)
    return frozenset((_rate(angle[0]), r) for (_, angle, r), terms in collected.items() if not is_zero(terms))


def _known_phases(modes: Modes) -> bool:
    """Whether a phase has a term whose cosines SymPy writes otherwise."""
    return any(_is_known(m) for m in {m for _, (_, phase), _ in modes for m, _ in phase})


@lru_cache(maxsize=1 << 12)
def _is_known(monomial: Monomial) -> bool:
    """Whether SymPy writes cosines of such a phase otherwise: ``atan a``, ``I a`` (cosh), an integer times pi."""
    factors = [expression_of(g) for g, _ in monomial]
    return any(e is I or isinstance(e, InverseTrigonometricFunction) or e.is_integer and not e.is_Integer
               for e in factors)


@lru_cache(maxsize=1 << 12)
def _rate(frequency: Linear) -> tuple[int, int] | None:
    value = rational_value(as_polynomial(frequency))
    return None if value is None else (abs(int(value.p)), int(value.q))


def _without_phases(modes: Modes, join: Callable[[Monomial], bool]) -> Modes:
    """``cos(q t + phi) = cos phi cos qt - sin phi sin qt`` for the terms ``phi`` of a phase that join coefficients."""
    result: Modes = {}
    for (kind, (frequency, phase), monomial), f in modes.items():
        turned, angle = orient((frequency, tuple((m, c) for m, c in phase if not join(m))))
        start = to_expression(as_polynomial(tuple((m, c) for m, c in phase if join(m))))
        for other, g, wave in ((kind, f, cos(start)), (1 - kind, -f if kind == COS else f, sin(start))):
            value = expand_trig(wave)
            for m, c in (power(value, 1) if value else {}).items():
                factor, product_monomial = multiply_monomials(monomial, m)
                add_reflected(result, other, turned, angle, product_monomial, g * (c * factor))
    return result


def _with_one_name(modes: Modes) -> Modes:
    """The same series, where angles that are equal by relations between parameters have become one."""
    if not has_relations({m for _, (frequency, phase), _ in modes for m in (*dict(frequency), *dict(phase))}):
        return modes
    names: dict[Angle, tuple[bool, Angle]] = {NO_ANGLE: (False, NO_ANGLE)}
    result: Modes = {}
    for (kind, angle, monomial), f in modes.items():
        if angle not in names:
            chosen = (found for _, found in list(names.values()))
            equal = ((sign < 0, other) for other in chosen for sign in (1, -1) if _are_equal(angle, other, sign))
            names[angle] = next(equal, (False, angle))
        add_reflected(result, kind, *names[angle], monomial, f)
    return result


def _are_equal(left: Angle, right: Angle, sign: int) -> bool:
    _, (frequency, phase) = add_angles(left, right, -sign)
    return not frequency and not settled(phase)
