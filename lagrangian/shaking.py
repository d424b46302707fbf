r"""The acceleration of the support, as numbers and as Taylor series.

Constants and waves, ``c cos(q t) + s sin(q t)``, have their Taylor coefficients in closed form,

    [cos(q (t + h))]_j = q**j/j! cos(q t + j pi/2),

one sine and one cosine a step, computed where the steps are; whole turns are taken from ``q t`` before it rounds.  Any
other function of t is called with a :class:`~lagrangian.jets.Jet` in place of t; so it may use ``+ - * / **`` and
numpy's sin, cos, tan, exp, log, sqrt, sinh, cosh, tanh.  A function that cannot be called so (one that uses
:mod:`math`, a table, branches) has no Taylor series here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from inspect import signature
from math import isfinite, nan
from numbers import Complex, Real
from typing import Any, TypeVar

import flint
import mpmath
import numpy as np
from sympy import Integer, cosh, pi, sinh, tanh
from sympy.core.function import AppliedUndef

from .angles import revolved
from .arithmetic import Arithmetic, MPNumbers
from .errors import DriveError, QuantityError
from .frozen import locked
from .jets import FUNCTIONS, Jet, evaluate
from .quantities import high_low, real_number, refuse_text, refuse_unordered, to_float
from .waves import NoWave, waves_of

__all__ = ["Shaking", "shaking_of", "shaking_of_expressions"]

Answer = TypeVar("Answer")
LEFT = 8.0  # of which one part is left: three bits lost are within what accelerations may lose
NUMPYS = [name for name in FUNCTIONS if hasattr(np, name)]


def _fine() -> MPNumbers:
    context = mpmath.mp.clone()
    context.dps = 60
    return MPNumbers(context)


FINE = _fine()  # for sums of which next to nothing is left


@dataclass(frozen=True, eq=False)
class Shaking:
    """``(xi'', eta'')`` as ``constant + sum over waves``, or as a function of time.

    Attributes
    ----------
    constant : pair of exact numbers; m/s**2
    waves : tuple of ``(q, cx, sx, cy, sy)``, exact: ``xi'' += cx cos qt + sx sin qt`` and so eta''; rad/s, m/s**2
    function : None, or ``function(t, number)`` giving the whole pair
    motion : None, or the same for ``(xi, eta)``, which are to be real where their accelerations are; m
    name : of the pair, in messages
    """

    constant: tuple[Any, Any] = (Integer(0), Integer(0))
    waves: tuple[tuple[Any, ...], ...] = ()
    function: Callable[..., Any] | None = None
    motion: Callable[..., Any] | None = None
    name: str = "support_acceleration"

    def under(self, gravity: Any) -> Shaking:
        """The same with g, an exact number, added to the constant part of ``eta''``, before anything rounds."""
        ax, ay = self.constant
        return replace(self, constant=(ax, ay + gravity))

    @property
    def is_exact(self) -> bool:
        """Whether it is known to any number of digits, as a function of time that gives floats is not."""
        return self.function is None or isinstance(self.function, _Expressions)

    @property
    def at_rest(self) -> bool:
        """Whether the acceleration is 0 at all times."""
        return self.steady and not any(self.constant)

    @property
    def steady(self) -> bool:
        """Whether the acceleration is constant."""
        return not self.waves and self.function is None

    @cached_property
    def floats(self) -> tuple[Any, Any]:
        """``constant``, shape (2,), and ``waves``, shape (w, 7), as float64.

        The rows of waves are ``q``, turns in a second, ``q/(2 pi)``, as high and low half, ``cx, sx, cy, sy``: the
        phase is right at all times, 1e9 s too, where rounding q would take 1e-7 q of it.
        """
        rows = [[to_float(q), *high_low(q / (2 * pi)), *map(to_float, sizes)] for q, *sizes in self.waves]
        constant = np.array([to_float(x) for x in self.constant])
        return locked(constant), locked(np.array(rows).reshape(-1, 7))

    def at(self, t: Any, arithmetic: Arithmetic | None = None) -> tuple[Any, Any]:
        """The pair at a time, as floats or in ``arithmetic``.  Raises DriveError where it has no finite real value."""
        number = arithmetic.number if arithmetic else to_float
        if self.function is not None:
            if arithmetic is None:
                return self._value(t, number)
            return self._answered(lambda: self._value(t, number), "in numbers of more digits", "give floats")
        if arithmetic is None:
            return self._in_floats(float(t)) if isfinite(t) else (nan, nan)
        return _at(t, self._numbers(number), arithmetic)

    def _in_floats(self, t: float) -> tuple[float, float]:
        """The pair, from more digits where next to nothing is left of its parts, weight and waves."""
        (ax, ay), waves = self._lists
        size = abs(ax) + abs(ay)
        for _, turns, low, cx, sx, cy, sy in waves:
            s, c = revolved(turns, low, t, 0.0)
            x, p, y, q = cx * c, sx * s, cy * c, sy * s
            ax, ay, size = ax + (x + p), ay + (y + q), size + abs(x) + abs(p) + abs(y) + abs(q)
        if LEFT * (abs(ax) + abs(ay)) >= size:
            return ax, ay
        ax, ay = _at(FINE.context.mpf(t), self._fine, FINE)
        return float(ax), float(ay)

    @cached_property
    def _lists(self) -> Any:
        return [part.tolist() for part in self.floats]

    @cached_property
    def _fine(self) -> Any:
        return self._numbers(FINE.number)

    def _numbers(self, number: Any) -> Any:
        """``constant`` and ``waves`` in an arithmetic."""
        return [number(x) for x in self.constant], [[number(x) for x in wave] for wave in self.waves]

    def series(self, t: Any, order: int, arithmetic: Arithmetic | None = None) -> tuple[list[Any], list[Any]]:
        """Taylor coefficients 0, ..., order about ``t`` of both components.  Raises DriveError where there are none."""
        number = arithmetic.number if arithmetic else to_float
        if self.function is None:
            return self._waves(t, order, number, arithmetic.sines if arithmetic else lambda x: (np.sin(x), np.cos(x)))
        zero, one = number(Integer(0)), number(Integer(1))
        time = Jet([t, one, *[zero] * (order - 1)][: order + 1], FUNCTIONS)
        try:
            found = self._answered(lambda: self._expanded(t, time, zero, number), "with a power series in place of t",
                                   "choose another method, such as method='DOP853'")
        except ArithmeticError:
            found = []
        if not found or not all(_is_real(x) for part in found for x in part.coefficients):
            raise DriveError(f"{self.name} has no Taylor series about t = {_shown(t)}: not all its derivatives are "
                             f"finite there.  Start elsewhere, or choose another method, such as method='DOP853'.")
        return found[0].coefficients, found[1].coefficients

    def _expanded(self, t: Any, time: Jet, zero: Any, number: Any) -> list[Jet]:
        self._value(t, number)
        return [part if isinstance(part, Jet) else time * zero + part for part in self._pair(time, number)]

    def _answered(self, ask: Callable[[], Answer], way: str, else_do: str) -> Answer:
        """What the function answers; DriveError where it takes floats alone."""
        try:
            return ask()
        except DriveError:
            raise
        except (TypeError, AttributeError, ValueError) as refusal:
            raise DriveError(
                f"{self.name} is called {way}, and it answers {type(refusal).__name__}: {refusal}.  Write it with "
                f"+ - * / ** and numpy's {', '.join(NUMPYS)}, or {else_do}.") from refusal

    def _pair(self, t: Any, number: Any) -> tuple[Any, Any]:
        with np.errstate(all="ignore"):
            given = self.function(t, number)  # type: ignore[misc]
        try:
            ax, ay = given
        except (TypeError, ValueError):
            raise DriveError(f"support_acceleration is a function of t that gives the pair (xi'', eta''), and at "
                             f"t = {_shown(t)} it gives {given!r}.") from None
        return ax, ay

    def _value(self, t: Any, number: Any) -> tuple[Any, Any]:
        try:
            time = t if number is to_float else Jet([t], FUNCTIONS)
            found = self._pair(time, number)
            with np.errstate(all="ignore"):
                motion = self.motion(time, number) if self.motion else ()
            found = _first(found[0]), _first(found[1])
            wrong = [str(x) for x in (*found, *map(_first, motion)) if not _is_real(x)]
        except DriveError:
            raise
        except (ArithmeticError, ValueError) as failure:
            if isinstance(failure, ValueError) and number is not to_float:
                raise  # from a function that takes floats alone
            wrong = [type(failure).__name__]
        if wrong:
            raise DriveError(f"{self.name} has no finite real value at t = {_shown(t)}, but {wrong[0]}: keep within "
                             f"the times at which the support's motion is defined and smooth.")
        return found

    def _waves(self, t: Any, order: int, number: Any, sines: Any) -> tuple[list[Any], list[Any]]:
        x, y = ([number(part)] + [number(Integer(0))] * order for part in self.constant)
        for wave in self.waves:
            q, cx, sx, cy, sy = (number(part) for part in wave)
            s, c = sines(q * t)
            a, b, d, e = cx * c + sx * s, sx * c - cx * s, cy * c + sy * s, sy * c - cy * s
            for j in range(order + 1):  # a cos qh + b sin qh, d cos qh + e sin qh
                x[j] += a
                y[j] += d
                ratio = q / (j + 1)
                a, b, d, e = b * ratio, -a * ratio, e * ratio, -d * ratio
        return x, y


def _at(t: Any, numbers: Any, arithmetic: Arithmetic) -> tuple[Any, Any]:
    (ax, ay), waves = numbers
    for q, cx, sx, cy, sy in waves:
        s, c = arithmetic.sines(q * t)
        ax, ay = ax + (cx * c + sx * s), ay + (cy * c + sy * s)
    return ax, ay


def _first(x: Any) -> Any:
    return x.coefficients[0] if isinstance(x, Jet) else x


def _is_real(x: Any) -> bool:
    """Whether a number of any type is real and finite."""
    if isinstance(x, flint.arb):
        return bool(x.is_finite())
    try:
        return not (isinstance(x, Complex) and not isinstance(x, Real)) and isfinite(x)
    except TypeError:  # no number
        return False


def _shown(t: Any) -> str:
    return f"{float(t.coefficients[0] if isinstance(t, Jet) else t):.6g}"


def shaking_of(given: Any) -> Shaking:
    """A pair of numbers, or a function of t that gives one.  Raises TextError, DriveError."""
    refuse_text(given, "support_acceleration")
    refuse_unordered(given, "support_acceleration")
    if isinstance(given, Shaking):
        return given
    if callable(given):
        if not _takes_a_time(given):
            raise DriveError(f"support_acceleration is a function of t that gives the pair (xi'', eta''), and "
                             f"{given!r} does not take one argument: write it as lambda t: (0, ...).")
        return Shaking(function=_Given(given))
    try:
        ax, ay = given
    except (TypeError, ValueError):
        raise DriveError(f"support_acceleration is {given!r}: give the pair (xi'', eta''), or a function of t that "
                         f"gives one.") from None
    return Shaking((real_number(ax, "support_acceleration[0]"), real_number(ay, "support_acceleration[1]")))


def _takes_a_time(function: Callable[..., Any]) -> bool:
    """Whether it can be called with one argument, as far as Python knows."""
    try:
        signature(function).bind(0.0)
    except ValueError:  # functions of C have no signature
        return True
    except TypeError:
        return False
    return True


def shaking_of_expressions(xi: Any, eta: Any, t: Any, motion: tuple[Any, ...] = ()) -> Shaking:
    """Two SymPy accelerations in the Symbol t, all other Symbols replaced already; raises QuantityError, DriveError.

    ``motion`` are the two coordinates that have these accelerations, ``t log(1 - t)`` say, which ends where ``eta''``
    does not.
    """
    for expression in (xi, eta):
        left = sorted(map(str, expression.free_symbols - {t}))
        if left:
            raise QuantityError(f"the support's acceleration {expression} holds the Symbol {left[0]}: give a number "
                                f"for it, "
                                f"as in scene.compile({{symbol: number}}).")
        unknown = expression.atoms(AppliedUndef)
        if unknown:
            raise DriveError(f"the support moves by {sorted(map(str, unknown))[0]}, a function that is not given: "
                             f"write the "
                             f"motion, such as epsilon*cos(omega0*{t}).")
    try:
        parts = [waves_of(expression, t) for expression in (xi, eta)]
    except NoWave:
        return Shaking(function=_evaluated((xi, eta), t), motion=_evaluated(motion, t),
                       name=f"the support's acceleration ({xi}, {eta})")
    if not all(x.is_real for part in parts for q, sizes in part.items() for x in (q, *sizes)):
        raise QuantityError(f"the support's acceleration ({xi}, {eta}) is not real: give a real motion.")
    none = Integer(0), Integer(0)
    waves = {q: parts[0].get(q, none) + parts[1].get(q, none) for q in sorted({*parts[0], *parts[1]})}
    cx, _, cy, _ = waves.pop(Integer(0), none + none)
    return Shaking((cx, cy), tuple((q, *sizes) for q, sizes in waves.items() if any(sizes)))


def _evaluated(expressions: tuple[Any, ...], t: Any) -> Callable[..., Any]:
    """``sinh/cosh**2``, the quotient of two numbers beyond the range of floats, is ``tanh sech``."""
    return _Expressions(tuple(x.replace(sinh, lambda x: tanh(x) * cosh(x)) for x in expressions), t)


@dataclass(frozen=True)
class _Given:
    """A function of t alone as one that is told the arithmetic too; it can be pickled if the function can."""

    function: Callable[[Any], Any]

    def __call__(self, t: Any, number: Any) -> Any:
        return self.function(t)


@dataclass(frozen=True)
class _Expressions:
    """Expressions in the Symbol t as a function of time and arithmetic, which can be pickled."""

    expressions: tuple[Any, ...]
    t: Any

    def __call__(self, time: Any, number: Any) -> tuple[Any, ...]:
        return tuple(evaluate(expression, self.t, time, number) for expression in self.expressions)
