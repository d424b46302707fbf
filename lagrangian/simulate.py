r"""The motion of a chain to the accuracy asked, with an estimate of what was reached.

Every motion is computed three times: as asked, and twice to three more digits, with a higher order and with the
constants of rods and joints, weight and waves moved by a unit in the last place or two, this way and that, so that the
differences show truncation, rounding and the rounding of the data, as the motion itself amplifies them.  The estimate
is six times the largest difference so far, between the times asked for too; two of them are seldom both small by
chance.  Where it exceeds the accuracy asked for, steps are made finer, down to the rounding of float64; what chaos then
still takes is reported, never hidden: from 2 rad, 10 s, two bobs keep 12 digits, ten one, ten uniform rods none.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from math import ceil, inf, log10, nan
from numbers import Integral
from typing import Any

import numpy as np
from sympy import floor, log

from .angles import TURN
from .chain import CompiledChain
from .compiled import CompiledEquations, compile_equations
from .constants import EPSILON, unsettled
from .crossings import Crossing, checked, find_crossings
from .digits import DigitRun, apart_by_then, best_order, integrate_digits
from .doubled import UNIT, DoubledSteps, OutOfRange, has_doubled
from .ensemble import Ensemble
from .equations import EquationsOfMotion
from .errors import DriveError, NotAQuantityError, NotASceneError, QuantityError, SceneError, printed
from .floats import FINEST, ORDER, FloatRun, integrate_floats, split, wrapped
from .pieces import BallPieces, FloatPieces
from .quantities import quantity, refuse_mask, refuse_text, refuse_unordered, to_float, truth
from .solvers import FINEST as FINEST_SCIPY, SCIPY_METHODS, integrate_heyoka, integrate_scipy
from .states import within_floats
from .swings import swing
from .trajectories import Trajectories, chains_and_states
from .trajectory import Trajectory

__all__ = ["simulate"]

METHODS = ("taylor", *SCIPY_METHODS, "heyoka", "linear")
SAFETY = 6.0
TINY = float(np.finfo(float).tiny)  # beyond so many digits the error, a float, is stated as this
MOST_DIGITS = 100_000
MOST_BETWEEN = 100_000  # angles that are compared between the times asked for
FLOAT_LIMIT = 1e-14  # accuracies below it need more digits than float64 has


def simulate(system: CompiledChain | Ensemble | EquationsOfMotion | CompiledEquations, theta0: Any, omega0: Any,
             times: Any, accuracy: float = 1e-10, method: str = "taylor", digits: int | None = None,
             dense: bool = False, events: Mapping[str, Crossing] | None = None,
             progress: bool | Callable[[float], None] = False) -> Trajectory | Trajectories:
    """The motion from ``theta0, omega0`` at ``times[0]``, at all ``times``, as a :class:`Trajectory`.

    Many at once are followed one after the other, and given as :class:`Trajectories`: those of an :class:`Ensemble`, or
    of one chain from many states, shape (chains, n).  (:meth:`CompiledChain.acceleration` takes (n, chains): where
    there are as many chains as rods, nothing tells one from the other.)

    Parameters
    ----------
    system : a :class:`CompiledChain`, an :class:`Ensemble`, or :func:`euler_lagrange` equations without free Symbols
    theta0, omega0 : n numbers each, floats or exact (``pi/2`` is pi/2), or shape (chains, n); rad, rad/s
    times : m monotone times, growing or shrinking (the motion is followed backwards); s
    accuracy : largest error of any angle that is wanted; rad.  Below 1e-14 numbers of enough digits are used
    method : ``"taylor"``, a method of SciPy's ``solve_ivp`` (``"DOP853"``, ...), ``"heyoka"`` if installed, or
        ``"linear"``, small swings about hanging, with their error against the nonlinear motion.  Errors of all but
        the first are against Taylor steps; where the support has no Taylor series (a table, functions of :mod:`math`),
        against the same solver of SciPy with another tolerance
    digits : None, or how many decimal digits to compute with; results are then mpmath numbers.  Up to 31 it is done in
        double-double where numba is installed and its range suffices, else in balls; ``trajectory.method`` says so
    dense : whether ``trajectory.at(t)`` shall work between the times, with as many digits as at them
    events : named :class:`Crossing` to look for, such as ``flips(chain)``; their times have the digits of the states
    progress : True for a line on the screen, or a function of the time reached, by Taylor steps or SciPy

    Raises
    ------
    NotASceneError, SceneError
        Not a chain; a state of another length; times that are not monotone; a method that does not exist; an event
        that is no crossing of one of the rods.
    QuantityError, NotAQuantityError, TextError, DriveError
        Numbers that are not finite; more than 100,000 digits; things that are no numbers; text; a motion that cannot be
        followed; a support without a Taylor series, or without a finite real place and acceleration at a time.
    NotInstalledError
        A method of SciPy's or heyoka's without that package.

    Speed and accuracy
    ------------------
    Ten seconds from 2 rad: 2 to 3 ms by machine for two bobs (12 digits are left), 6 to 10 ms for five (8), 20 to 30 ms
    for ten (one), after a few seconds of translation once per machine.  These are true errors; the estimate claims up
    to two digits less.  Of uniform rods two keep 9 digits, five and ten none.  Two bobs with 28 digits: 0.03 to 0.12 s,
    after 6 s of translation; with 50 digits 5 to 10 s.  A trajectory never claims what it has not: see
    ``trajectory.error``, ``.predictable_until`` and ``.verdict``.  ``benchmarks/chains.py motion`` measures this.

    >>> chain = CompiledChain([1, 1], [1, 1], [0.5, 0.5], [0.6, 0.6], upright=False)
    >>> motion = simulate(chain, [1, 2], [0, 0], [0, 1, 2])
    >>> motion.accurate, motion.theta.shape, motion.energy_drift < 1e-13
    (True, (3, 2), True)
    """
    if not isinstance(system, Ensemble):
        _, system = _system(system)  # equations are compiled once, for however many chains
    times = list(times) if isinstance(times, Iterator) else times
    follow = partial(_motion, times=times, accuracy=accuracy, method=method, digits=digits, dense=dense, events=events,
                     progress=progress)
    many = chains_and_states(system, theta0, omega0)
    return follow(system, theta0, omega0) if many is None else Trajectories(tuple(_motions(follow, many)))


def _motions(follow: Callable[..., Trajectory], many: list[tuple[Any, Any, Any]]) -> Iterator[Trajectory]:
    for j, one in enumerate(many):
        try:
            yield follow(*one)
        except QuantityError as error:
            raise QuantityError(f"chain {j}: {error}") from None


def _motion(system: Any, theta0: Any, omega0: Any, times: Any, accuracy: Any, method: str, digits: int | None,
            dense: bool, events: Mapping[str, Crossing] | None, progress: Any) -> Trajectory:
    """:func:`simulate` for one chain."""
    chain, evaluated = _system(system)
    n = len(chain)
    times, given_times = _times(times)
    theta, omega = (_initial(x, name, n) for x, name in ((theta0, "theta0"), (omega0, "omega0")))
    accuracy, digits = _accuracy(accuracy), _digits(digits)
    if not isinstance(method, str) or method not in METHODS:
        raise SceneError(f"method is {method!r}: give one of {', '.join(METHODS)}.")
    if chain.support.function is not None and method in ("taylor", *SCIPY_METHODS):
        for x in times.tolist():
            chain.support.at(x)  # which refuses times at which the support is nowhere
    report = _reporter(progress, times)
    events = checked(events, n)
    dense = truth(dense, "dense")
    keep = dense or bool(events)
    if digits is not None or accuracy < FLOAT_LIMIT:
        if method != "taylor":
            asked = f"{digits} digits" if digits is not None else f"an accuracy of {accuracy:.1e} rad"
            raise SceneError(f"method={method!r} computes in float64, which cannot give {asked}: choose 'taylor'.")
        return _with_digits(chain, theta, omega, times, given_times, accuracy, digits, dense, events, report)
    if method == "taylor":
        start = split(theta, True), split(omega, False)
        run, error = _to_accuracy(chain, *start, split(given_times, False), accuracy, keep, report)
    else:
        if keep:
            raise SceneError(f"dense output and events come from Taylor series, and method is {method!r}: choose "
                             f"'taylor'.")
        run, error = _by_others(chain, evaluated, theta, omega, times, accuracy, method, report)
    motion = FloatPieces(run.record, n, run.order, times) if keep else None
    found = find_crossings(motion, events, times[-1]) if motion is not None else {}
    return Trajectory(times, run.theta, run.omega, _whole(run.turns), run.angle,
                      chain.energy_of(run.angle.T, run.omega.T, run.turns.T), error, accuracy,
                      method, run.steps, run.order, chain, found, motion if dense else None)


# -- Taylor series in float64 ---------------------------------------------------------------------------------


def _to_accuracy(chain: CompiledChain, theta: Any, omega: Any, times: Any, accuracy: float, keep: bool,
                 report: Callable[[float], None] | None) -> tuple[FloatRun, Any]:
    tolerance, times = max(FINEST, accuracy * 1e-3), split(times, False)
    while True:
        order = min(ORDER, best_order(-log10(tolerance)))
        run = integrate_floats(chain, theta, omega, times, order, tolerance, 0, keep, report)
        every, at = _filled(times, min(run.steps, MOST_BETWEEN // len(chain)))
        others: list[FloatRun] = []
        for sign in (1, -1):
            others.append(integrate_floats(chain, theta, omega, every, order + 4, tolerance / 1000, sign))
            error = _estimate(run, others, at)
            if error[-1] > accuracy and tolerance > FINEST:
                break
        else:
            return run, error
        tolerance = max(FINEST, tolerance * min(1e-2, 1e-2 * accuracy / error[-1]))


def _whole(turns: Any) -> Any:
    """Numbers of turns as int64, or Python's integers where they are too large for that."""
    return turns.astype(np.int64) if (abs(turns) < 2.0**63).all() else np.frompyfunc(int, 1, 1)(turns)


def _filled(times: Any, count: int) -> tuple[Any, Any]:
    """``times``, as :func:`split` gives them, with so many more spread evenly among them, and where they are."""
    more = np.linspace(times[0, 0], times[0, -1], count + 2)[1:-1]
    every = np.concatenate([times, [more, 0 * more, 0 * more]], axis=1)
    order = np.argsort(every[0] if times[0, -1] >= times[0, 0] else -every[0], kind="stable")
    return every[:, order], np.argsort(order)[:times.shape[1]]


def _estimate(run: FloatRun, others: Sequence[FloatRun], at: Any = slice(None)) -> Any:
    """From the differences of a run from others, which are at its times with their rows ``at``.

    Between these times the others are compared with each other: a rod that falls, and turns, comes back.
    """
    apart = _apart(others[0], others[-1]) / 2
    for other in others:
        apart[at] = np.maximum(apart[at], _apart(run, other, at))
    grown = np.maximum.accumulate(np.where(np.isfinite(apart), apart, np.inf))[at]
    return SAFETY * grown + 2 * EPSILON * np.pi


def _apart(one: FloatRun, other: FloatRun, at: Any = slice(None)) -> Any:
    return abs((one.angle - other.angle[at]) + TURN * (one.turns - other.turns[at])).max(axis=1)


# -- other methods, other digits ------------------------------------------------------------------------------


def _by_others(chain: CompiledChain, system: Any, theta: Any, omega: Any, times: Any, accuracy: float, method: str,
               report: Callable[[float], None] | None) -> tuple[FloatRun, Any]:
    """The error is that against Taylor steps two digits finer, and theirs added.

    Where the support has no Taylor series, SciPy's solver runs again: with a 30th of the tolerance, or 30 times that
    where it is as fine as SciPy goes, and with the constants of the rods moved.
    """
    first, rates = (np.array([within_floats(x, "a state") for x in part]) for part in (theta, omega))
    tolerance = max(FINEST_SCIPY, accuracy * 1e-2)
    if method == "linear":
        run = _run(swing(chain, first, rates, times))
    elif method == "heyoka":
        run = _run(integrate_heyoka(chain, first, rates, times, accuracy * 1e-3))
    else:
        run = _run(integrate_scipy(system, first, rates, times, method, tolerance, report))
    try:
        better, error = _to_accuracy(chain, theta, omega, times, max(accuracy * 1e-2, FLOAT_LIMIT), False, None)
    except DriveError:
        other = tolerance / 30 if tolerance >= 30 * FINEST_SCIPY else tolerance * 30
        return run, _estimate(run, [_run(integrate_scipy(_moved_chain(chain), first, rates, times, method, other))])
    return run, _estimate(run, [better]) + error


def _run(found: tuple[Any, Any, int]) -> FloatRun:
    """Angles, rates and steps as others give them."""
    angles, rates, steps = found
    return FloatRun(*wrapped(angles, np.zeros_like(angles)), rates, steps, 0)


def _moved_chain(chain: CompiledChain) -> CompiledChain:
    """The chain with its constants moved as :func:`unsettled` does."""
    m, l, I, _, _, _, mH, _ = unsettled(chain.rods, 1).T
    center = mH / m
    gyration = np.maximum(np.sqrt(I / m), abs(center))
    return CompiledChain(m, l, center, gyration, chain.gravity, chain.support, chain.damping, chain.springs,
                         chain.upright)


def _with_digits(chain: CompiledChain, theta: Any, omega: Any, times: Any, given_times: Any, accuracy: float,
                 digits: int | None, dense: bool, events: Mapping[str, Crossing],
                 report: Callable[[float], None] | None) -> Trajectory:
    used = digits if digits is not None else ceil(-log10(accuracy)) + 6
    exact = [[quantity(x, "state") for x in part] for part in (theta, omega)]
    exact_times = [quantity(x, "times") for x in given_times]
    while True:
        kind, run, apart = _twice(chain, exact[0], exact[1], exact_times, used, dense or bool(events), report)
        error = SAFETY * apart + max(10.0**-used, TINY)
        if digits is not None or error[-1] <= accuracy:
            break
        used += 2 + ceil(log10(error[-1] / accuracy))
    energy = chain.energy_of(run.angle.astype(float).T, run.omega.astype(float).T, run.turns.T)
    context = run.angle.flat[0].context
    motion = BallPieces(run.pieces, context, exact_times, run.halves) if run.pieces is not None else None
    found = find_crossings(motion, events, exact_times[-1]) if motion is not None else {}
    return Trajectory(times, run.theta, run.omega, _whole(run.turns), run.angle, energy, error, accuracy,
                      f"taylor, {used} digits in {kind}", run.steps, best_order(used), chain, found,
                      motion if dense else None)


def _twice(chain: CompiledChain, theta: Any, omega: Any, times: Any, digits: int, keep: bool,
           report: Callable[[float], None] | None) -> tuple[str, DigitRun, Any]:
    """The numbers used, the motion, and its differences from a finer one.

    That one has other rounding of the data, or eight digits more.
    """
    first = partial(integrate_digits, chain, theta, omega, times, digits, None, report)
    if has_doubled(digits):
        try:
            run = first(DoubledSteps, keep)
            return "double-double", run, apart_by_then(run, chain, theta, omega, digits + 3, best_order(digits) + 4,
                                                       partial(DoubledSteps, unsettled=UNIT))
        except OutOfRange:
            pass
    run = first(None, keep)
    return "balls", run, apart_by_then(run, chain, theta, omega, digits + 8)


# -- what is given --------------------------------------------------------------------------------------------


def _system(system: Any) -> tuple[CompiledChain, Any]:
    """The chain, and what evaluates accelerations for other people's solvers."""
    if isinstance(system, CompiledChain):
        return system, system
    if isinstance(system, EquationsOfMotion):
        system = compile_equations(system)
    if isinstance(system, CompiledEquations):
        return system.chain, system
    refuse_text(system, "system")
    raise NotASceneError(f"simulate moves a CompiledChain or euler_lagrange equations, and this is {system!r}: give "
                         f"scene.compile(values).")


def _accuracy(asked: Any) -> float:
    exact = quantity(asked, "accuracy")
    found = to_float(exact) if exact.is_number else nan
    if not exact.is_number or not exact > 0 or not found < inf:
        raise QuantityError(f"an accuracy is a positive number, and this one is {printed(exact)}: give the error in "
                            f"rad that may remain.")
    if found < TINY:
        power = int(floor(log(exact, 10)))
        raise QuantityError(f"an accuracy is a float, and this one, 1e{power}, is below all of them: say how many "
                            f"digits to compute with, as in digits={5 - power}.")
    return found


def _digits(asked: Any) -> int | None:
    if asked is None:
        return None
    if isinstance(asked, bool) or not isinstance(asked, Integral) or asked < 1:
        raise QuantityError(f"digits is {printed(asked, repr)}: give how many decimal digits to compute with, such "
                            f"as 30.")
    if int(asked) > MOST_DIGITS:
        raise QuantityError(f"digits is {printed(asked)}: give at most {MOST_DIGITS}; orders grow with them.")
    return int(asked)


def _times(times: Any) -> tuple[Any, Any]:
    """Times as floats, and as they were given: the same floats, or exact numbers."""
    refuse_mask(times, "times")
    given: Any = _plain_times(times)
    if given is None:
        given = _quantities(times, "times", "a list of times, the first of which is that of theta0")
    found = np.array([within_floats(x, "times") for x in given]) if isinstance(given, list) else given
    steps = np.diff(found)
    if not len(found) or not ((steps >= 0).all() or (steps <= 0).all()):
        raise SceneError(f"times must grow, or shrink for the motion backwards, and be at least one, but they are "
                         f"{found.tolist()}: give times in order.")
    return found, given


def _plain_times(times: Any) -> Any:
    """Finite floats as they are, which may be many, shape (m,); None for anything else."""
    if isinstance(times, list) and all(type(x) is float for x in times):
        times = np.array(times)
    if isinstance(times, np.ndarray) and times.ndim == 1 and times.dtype.kind == "f" and np.isfinite(times).all():
        return times.astype(np.float64)
    return None


def _quantities(values: Any, name: str, wanted: str) -> list[Any]:
    """Exact numbers from any sequence of numbers; raises SceneError, saying what is wanted, where it is none."""
    refuse_text(values, name)
    refuse_unordered(values, name)
    try:
        entries = list(values)
    except TypeError:
        raise SceneError(f"{name} is {printed(values, repr)}: give {wanted}.") from None
    found = [quantity(x, f"{name}[{k}]") for k, x in enumerate(entries)]
    symbols = [x for x in found if not x.is_number]
    if symbols:
        raise QuantityError(f"{name} holds {symbols[0]}, which is no number: give numbers, such as 1/2 or pi.")
    return found


def _initial(values: Any, name: str, n: int) -> Any:
    refuse_mask(values, name)
    if isinstance(values, np.ndarray) and values.dtype.kind in "fiu":
        found: Any = values.astype(np.float64)
        if not np.isfinite(found).all():
            raise QuantityError(f"{name} holds {found[~np.isfinite(found)].flat[0]}, which is not finite: give finite "
                                f"numbers.")
    elif isinstance(values, np.ndarray) and values.ndim == 0:
        raise SceneError(f"{name} is the single number {values}: give one number for each of the {n} rods.")
    else:
        found = _quantities(values, name, f"one number for each of the {n} rods")
    if np.shape(found) != (n,):
        raise SceneError(f"the chain has {n} rods, and {name} has shape {np.shape(found)}: give {n} numbers.")
    return found


def _reporter(progress: Any, times: Any) -> Callable[[float], None] | None:
    if callable(progress):
        return progress  # type: ignore[no-any-return]
    if not isinstance(progress, bool):
        raise NotAQuantityError(f"progress is {progress!r}: give True for a line on the screen, or a function of the "
                                f"time reached.")
    if not progress:
        return None
    started = written = time.monotonic()

    def line(now: float) -> None:
        nonlocal written
        part = (now - times[0]) / (times[-1] - times[0]) if times[-1] != times[0] else 1.0
        if part < 1 and time.monotonic() < written + 0.1:
            return
        written = time.monotonic()
        sys.stderr.write(f"\rt = {now:.4g} of {times[-1]:.4g} ({100 * min(1.0, part):.0f} %), "
                         f"{written - started:.0f} s")
        sys.stderr.write("\n" if part >= 1 else "")
    return line


