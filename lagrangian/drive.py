r"""The drive in the phase ``tau = omega0 t``: trigonometric polynomials, the period, and the scales h and v.

A coefficient of the linear equations is a finite sum of ``c cos(q tau) + s sin(q tau)`` with rational q
(:mod:`lagrangian.waves`).  All of it repeats after ``2 pi / gcd(q)``.  For equal rods ``h = epsilon/l`` and
``v = omega0 sqrt(l/g)`` ([Neves] (16), (17)) leave no other parameter: ``g/(l omega0**2) = 1/v**2``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Any

from sympy import (
    Derivative,
    ImmutableDenseMatrix,
    Integer,
    Rational,
    Symbol,
    cos,
    expand,
    gcd,
    pi,
    sin,
    sqrt,
)
from sympy.core.function import AppliedUndef

from .energy import Scene
from .errors import (
    NameClashError,
    NotPeriodicError,
    QuantityError,
)
from .quantities import namesakes, quantity
from .waves import NoWave, Waves, waves_of


def frequency(omega0: Any, scene: Scene) -> Any:
    """``omega0`` as a nonzero constant; raises as :func:`quantity`, QuantityError and NameClashError."""
    omega0 = quantity(omega0, "omega0")
    why = namesakes(omega0.free_symbols, scene.free_symbols)
    if why:
        raise NameClashError(f"omega0 is {omega0}, and {why}")
    if omega0.is_zero or scene.t in omega0.free_symbols or omega0.atoms(AppliedUndef):
        raise QuantityError(f"omega0 is a nonzero constant angular frequency, and this one is {omega0}.")
    return omega0


# --- modes: sums of waves in tau, {q: (coefficient of cos q tau, coefficient of sin q tau)}, q >= 0 ------------


def modes_of(expression: Any, t: Any, omega0: Any) -> Waves:
    """``expression(t)`` at ``t = tau/omega0`` as a sum of waves in tau, with rational frequencies.

    Raises NotPeriodicError unless it is one.
    """
    try:
        modes = waves_of(expression, t, omega0)
    except NoWave as part:
        raise _not_periodic(part.args[0], t, omega0) from None
    for q in modes:
        if not isinstance(q, Rational):
            raise _not_divided(f"{expression} has a wave that", q * omega0, t, omega0)
    return modes


def _not_periodic(part: Any, t: Any, omega0: Any) -> NotPeriodicError:
    if isinstance(part, (cos, sin)):
        angle = expand(part.args[0])
        rate = angle.coeff(t, 1)
        return _not_divided(part, angle if t in (angle - rate * t).free_symbols else rate, t, omega0)
    remedy = (f"replace {part} by the motion meant, such as epsilon*cos(omega0*{t})"
              if part.atoms(AppliedUndef, Derivative) else "write the drive as a sum of cosines and sines")
    return NotPeriodicError(f"{part} is not a trigonometric polynomial in tau = {omega0}*{t}: {remedy}.")


def _not_divided(wave: Any, turned: Any, t: Any, omega0: Any) -> NotPeriodicError:
    return NotPeriodicError(
        f"{wave} turns {turned} in time {t}, not a rational multiple of omega0 = {omega0}: give as omega0 a frequency "
        f"that divides every one of the drive."
    )


def matrix_modes(matrix: Any, t: Any, omega0: Any) -> Waves:
    """The modes of a matrix: two matrices a frequency; zero frequencies and zero modes are left out of sines."""
    shape = matrix.shape
    entries = [modes_of(entry, t, omega0) for entry in matrix]
    none = (Integer(0), Integer(0))
    found = sorted({q for modes in entries for q in modes})
    return {q: tuple(ImmutableDenseMatrix(*shape, [expand(modes.get(q, none)[k]) if q or k == 0 else Integer(0)
                                                   for modes in entries]) for k in (0, 1)) for q in found}


def period_of(modes: Mapping[Any, list[Any]]) -> Any:
    """The smallest common period of the waves that are present, ``2 pi`` where there is none."""
    present = [q for q, parts in modes.items() if q != 0 and any(any(part) for part in parts)]
    return 2 * pi / reduce(gcd, present) if present else 2 * pi


# --- h and v --------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Scale:
    """``symbol`` stands for ``meaning``; ``old`` is replaced by ``new`` to bring it in."""

    symbol: Any
    meaning: Any
    old: Any
    new: Any


def natural_scales(scene: Scene, omega0: Any) -> tuple[Scale, ...]:
    """``h = epsilon/l`` and ``v = omega0 sqrt(l/g)`` ([Neves] (16), (17)), as far as equal rods have them."""
    rod, g = scene.equal_rod, scene.gravity
    if rod is None:
        return ()
    scales: list[Scale] = []
    amplitude = _amplitude(scene, omega0)
    if amplitude is not None:
        h = fresh_symbol("h", scene, omega0, {amplitude: amplitude / rod.length})
        scales.append(Scale(h, amplitude / rod.length, amplitude, h * rod.length))
    if isinstance(omega0, Symbol) and not g.is_zero and not g.is_negative:
        second = sqrt(rod.length / g)  # of which 1/sqrt(g/l) is the negative where g < 0
        v = fresh_symbol("v", scene, omega0, {omega0: omega0 * second})
        scales.append(Scale(v, omega0 * second, omega0, v / second))
    return tuple(scales)


def _amplitude(scene: Scene, omega0: Any) -> Any:
    """The Symbol epsilon of a vertical drive ``epsilon cos q tau`` or ``epsilon sin q tau``, if it is one."""
    rise = modes_of(scene.support_acceleration[1], scene.t, omega0)
    waves = [expand(-x / (q * omega0) ** 2) for q, pair in rise.items() if q != 0 for x in pair if x != 0]
    elsewhere = {x for _, value in scene.constants for x in value.free_symbols} | omega0.free_symbols
    single = len(waves) == 1 and isinstance(waves[0], Symbol) and waves[0] not in elsewhere
    return waves[0] if single else None


def fresh_symbol(name: str, scene: Scene, omega0: Any, replaced: Mapping[Any, Any] | None = None) -> Any:
    """A Symbol called ``name``; raises NameClashError if one of that name stays in the result.

    ``replaced`` maps a Symbol that gives way to the new one to what the new one means.
    """
    gone = {old for old, meaning in (replaced or {}).items() if old == meaning} | {scene.t}
    if any(x.name == name for x in (scene.free_symbols | omega0.free_symbols) - gone):
        spared = "" if name == "tau" else ", or pass dimensionless=False, which needs no h and v"
        raise NameClashError(
            f"the result needs a Symbol called {name}, and the scene has one of its own: rename the scene's "
            f"{name}{spared}."
        )
    return Symbol(name)


def in_scales(coefficient: Any, scales: tuple[Scale, ...]) -> Any:
    """``coefficient`` with h and v put in, expanded."""
    return expand(expand(coefficient).xreplace({scale.old: scale.new for scale in scales}))
