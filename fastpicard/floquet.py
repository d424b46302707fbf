r"""The Floquet matrix: the iterate ``Phi_n`` after one period, exactly.

If ``P`` repeats with period ``T``, the solutions of ``x' = P x`` obey
``x(t + T) = Phi(T) x(t)`` at ``t = 0, T, 2 T, ...`` for the *Floquet* (or *monodromy*)
*matrix* ``Phi(T)``; its eigenvalues are the multipliers ([Neves], sections 4 and 5).
After a period all angles have made whole turns, so every cosine is 1 and every
sine 0, and what is left of the iterate is a polynomial in the parameters and ``T``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import gcd
from typing import Any

from flint import fmpq
from mpmath.libmp import dps_to_prec
from sympy import Expr, ImmutableMatrix, Symbol, pi

from fastpicard import modes as algebra
from fastpicard.collapsed import Collapsed
from fastpicard.constant import by_minimal_polynomial, constant_matrix
from fastpicard.enclosure import over_period
from fastpicard.errors import BadInputError
from fastpicard.evaluate import ball, check_digits, count_of_digits, may_vanish, to_complex
from fastpicard.harmonics import Harmonics
from fastpicard.iteration import Increments, first_increments, identity_columns
from fastpicard.latex import summary
from fastpicard.matrix import AsMatrix, SeriesMatrix, latex_or_summary, number_matrix, place, read_matrix
from fastpicard.modes import Linear, Modes
from fastpicard.parameters import BOUND_BITS, is_box, numbers_in, problem_at
from fastpicard.period import check_period, whole_turns
from fastpicard.precision import working
from fastpicard.reading import as_expression, as_time
from fastpicard.remainder import a_posteriori, reported, smallest_order, tolerance
from fastpicard.ring import ONE, Polynomial, multiply, read_only, symbols_of
from fastpicard.spectrum import Multiplier, exponent, multipliers_of
from fastpicard.stability import Verdict, judge
from fastpicard.structure import Structure, structure
from fastpicard.values import Values, check_order
from fastpicard.vectorise import vectorise
from fastpicard.writing import write


@dataclass(frozen=True, eq=False, repr=False, init=False)
class FloquetMatrix(AsMatrix):
    """``Phi_n(T)``: the n-th exact Picard iterate of the Floquet matrix, a polynomial in the parameters and ``T``.

    Immutable.  Exact for the n-th iterate: :meth:`as_matrix`, :meth:`trace`, :meth:`evaluate` and
    :meth:`trace_at` speak of that.  How far it is from the true Floquet matrix depends on the parameters
    and is bounded by :meth:`remainder`; :meth:`enclosure`, :meth:`multipliers` and :meth:`verdict` speak
    of the true one, whatever ``n`` is.

    Parameters
    ----------
    P : Matrix, shape (m, m), or a function of one argument     as for :func:`fast_picard`
    t : Symbol
    n : int, from 0 up
    period : positive number or expression free of ``t``, default ``2*pi``
        a period of ``P``, not necessarily the least; exact, so no float.
        For constant ``P`` any positive time.  Values of parameters that make it 0 or negative are refused, but
        by the exact polynomial, :meth:`evaluate`, :meth:`trace_at`, :meth:`lambdify` and :meth:`lambdify_trace`.

    Attributes
    ----------
    t : Symbol
    n : int
    period : Expr
    shape : (m, m)
    P : SeriesMatrix
    length, turns : the period as a polynomial in its symbols, and how many least common periods of ``P`` it is
    increments, entry(i, j), collapsed, collapsed_trace : the iterate in the engine's own form, not yet SymPy

    Raises
    ------
    NotPeriodicError
        if ``P`` does not repeat with this period, with the entry and a period that would do.
    NotInFamilyError, ShapeError, BadInputError, BadTypeError
        as :func:`fast_picard`.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 20)
    >>> print(F.evaluate({a: -0.1, b: 0.55}).round(7))
    [[-0.0397796 18.6577238]
     [-0.0535123 -0.0397796]]
    >>> FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 4).trace()
    4*pi**4*a**2/3 - 4*pi**2*a - 2*pi**2*b**2 + 2
    """

    P: SeriesMatrix
    n: int
    period: Expr
    length: Polynomial
    increments: Increments

    def __init__(self, P: Any, t: Symbol, n: int, period: Any = 2 * pi) -> None:
        matrix = read_matrix(P, as_time(t))
        order = check_order(n)
        length = check_period(matrix, period)
        self._fill(matrix, order, as_expression(period), length,
                   first_increments(matrix, identity_columns(matrix.shape[0]), order))

    def _fill(self, P: SeriesMatrix, n: int, period: Expr, length: Polynomial, increments: Increments) -> None:
        for name, value in (("P", P), ("n", n), ("period", period), ("length", read_only(length)),
                            ("increments", increments)):
            object.__setattr__(self, name, value)

    @property
    def t(self) -> Symbol:
        """The time symbol of ``P``."""
        return self.P.t

    @property
    def shape(self) -> tuple[int, int]:
        """(m, m)."""
        return self.P.shape

    @property
    def free_symbols(self) -> set[Symbol]:
        """The parameters, those of the period too."""
        return self.P.free_symbols | symbols_of(self.length)

    @cached_property
    def turns(self) -> int:
        """How many whole periods of ``P`` there are in ``T``."""
        frequencies = {angle[0] for row in self.P.rows for modes in row for _, angle, _ in modes if angle[0]}
        counts = [whole_turns(q, self.length) for q in frequencies]
        return max(1, gcd(*(1 if count is None else count for count in counts)))

    def to_order(self, n: int) -> FloquetMatrix:
        """The same for order ``n``, at the cost of the increments that are new; a lower one is computed anew."""
        return self._with(check_order(n), self.period, self.length)

    def over(self, turns: int, n: int) -> FloquetMatrix:
        """The same for order ``n`` and the ``turns``-th part of the period."""
        return self._with(n, self.period / turns, {m: c / turns for m, c in self.length.items()})

    def _with(self, n: int, period: Expr, length: Polynomial) -> FloquetMatrix:
        new = object.__new__(FloquetMatrix)
        new._fill(self.P, n, period, length, self.increments.to_order(n))
        return new

    # -- exact ---------------------------------------------------------------

    @cached_property
    def _powers(self) -> list[Polynomial]:
        """``T**r / r!``."""
        powers: list[Polynomial] = [{ONE: fmpq(1)}]
        for r in range(1, self.n + 1):
            powers.append(multiply(powers[-1], {m: c / r for m, c in self.length.items()}))
        return powers

    @cached_property
    def _entries(self) -> dict[tuple[int, int], Modes]:
        return {}

    def entry(self, i: int, j: int) -> Modes:
        """Entry ``(i, j)`` in the engine's form, read only; raises BadInputError where there is none."""
        i, j = place((i, j), self.shape)
        if (i, j) not in self._entries:
            self._entries[i, j] = read_only(algebra.frozen(self.increments.whole_turns(i, j), self._powers))
        return self._entries[i, j]

    def _all(self) -> list[Modes]:
        rows, columns = self.shape
        return [self.entry(i, j) for i in range(rows) for j in range(columns)]

    def _trace(self) -> Modes:
        result: Modes = {}
        for i in range(self.shape[0]):
            algebra.add_modes(result, self.entry(i, i))
        return result

    @cached_property
    def resonances(self) -> tuple[Linear, ...]:
        """Frequencies that were divided by and may vanish: they make a number of turns that depends on parameters."""
        return tuple(q for q in sorted(self.increments.divided)
                     if symbols_of(m for m, _ in q) and whole_turns(q, self.length) is None)

    def collapse(self, constants: list[Modes]) -> Collapsed:
        """Constants made of the entries, as polynomials with coefficients to any precision."""
        return Collapsed(constants, self.t, resonances=self.resonances)

    @cached_property
    def collapsed(self) -> Collapsed:
        """All entries, row by row."""
        return self.collapse(self._all())

    @cached_property
    def collapsed_trace(self) -> Collapsed:
        """The trace likewise."""
        return self.collapse([self._trace()])

    def __getitem__(self, index: tuple[int, int]) -> Expr:
        """One entry, exact."""
        return write(self.entry(*place(index, self.shape)), self.t)

    def __reduce__(self) -> tuple[Any, ...]:
        """The arguments: the iterate is computed again."""
        return FloquetMatrix, (self.P, self.t, self.n, self.period)

    def as_matrix(self) -> ImmutableMatrix:
        """The exact matrix, entries expanded: polynomials in the parameters and the period.

        With Symbols among the frequencies it is that of generic ones: at a resonance it is another.
        """
        rows, columns = self.shape
        return ImmutableMatrix([[self[i, j] for j in range(columns)] for i in range(rows)])

    def trace(self) -> Expr:
        """The exact trace, expanded; for 2 x 2 and determinant 1, ``trace = +-2`` bounds stability ([Neves] (15))."""
        return write(self._trace(), self.t)

    # -- numbers -------------------------------------------------------------

    def evaluate(self, values: Values | None = None, digits: int | None = None) -> Any:
        """The n-th iterate in numbers: a float64 array of shape (m, m), or an mpmath matrix with correct ``digits``.

        ``values`` maps every parameter to a number (int, Fraction, float as the
        dyadic number it is, mpf, SymPy number, arb).  Computed in balls, so only the last digit is rounded.

        Raises
        ------
        MissingParameterError
            if a parameter has no value.
        BadInputError
            at a resonance: where a frequency with a Symbol in it vanishes that the iterate was divided by; with a ball
            too wide for the digits, which are 53 bits if none are given.

        Notes
        -----
        The first call computes the iterate in all Symbols, once for all points.  For one point only, put the numbers
        into ``P`` first: the terms of Mathieu's iterates in s Symbols grow as the power s + 2 of the order.
        """
        return number_matrix(self.collapsed.at(values, digits), self.shape, check_digits(digits))

    def trace_at(self, values: Values | None = None, digits: int | None = None) -> Any:
        """The trace of the n-th iterate, float or mpf, every digit asked for correct; raises as :meth:`evaluate`."""
        return self.collapsed_trace.at(values, digits)[0]

    # -- the truth -----------------------------------------------------------

    @classmethod
    def for_accuracy(cls, P: Any, t: Symbol, values: Values | None, tol: Any, period: Any = 2 * pi) -> FloquetMatrix:
        """The iterate of the smallest order whose proved :meth:`remainder` is at most ``tol``.

        ``values`` gives every parameter a number, a ball, or an interval ``(lo, hi)``: the bound holds on the
        whole box.  Every higher order meets ``tol`` as well.  The other arguments are those of the class.

        Raises
        ------
        BadInputError
            if ``tol`` is not positive; where ``sup |P|`` times the period is beyond 1000, so that the order would be.

        Notes
        -----
        Put numbers into ``P`` where ``sup |P|`` times the period is large: the terms of Mathieu's iterates in s symbols
        grow as the power s + 2 of the order, and memory with them.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, t
        >>> P = Matrix([[0, 1], [-a - b*cos(t), 0]])
        >>> FloquetMatrix.for_accuracy(P, t, {a: -0.1, b: 0.55}, 1e-12).n
        22
        >>> FloquetMatrix.for_accuracy(P, t, {a: (-1, 1), b: (0, 1)}, 1e-12).n
        42
        """
        first = cls(P, t, 0, period)
        limit, exact = tolerance(tol), first.numbers(values)
        with working(BOUND_BITS):
            return first.to_order(smallest_order(*first.at(exact), ball(limit)))

    def numbers(self, values: Values | None) -> dict[Any, Any]:
        """The values of all parameters as exact numbers or balls, checked."""
        return numbers_in(self.P, values, symbols_of(self.length))

    def at(self, exact: Mapping[Any, Any]) -> tuple[Harmonics, Any]:
        """``P`` and ``T`` at :meth:`numbers`, in balls of the working precision, or of more where that is in doubt.

        Raises
        ------
        BadInputError
            if ``P`` or ``T`` is not finite there, or ``T`` not positive; in a box, everywhere.
        """
        return problem_at(self.P, self.period, self.length, exact)

    def remainder(self, values: Values | None = None, entrywise: bool = False) -> Any:
        """A rigorous upper bound of ``|Phi(T) - Phi_n(T)|``, the iterate's distance from the truth.

        Parameters
        ----------
        values : {Symbol: number, ball, or interval (lo, hi)} for every parameter
            for balls and intervals the bound holds on the whole box.
        entrywise : bool
            True for an array of bounds, one for each entry.

        Returns
        -------
        float, rounded up: a bound of the largest row sum of ``|Phi - Phi_n|``, hence of every entry;
        ``inf`` beyond the range of floats.

        Raises
        ------
        MissingParameterError
            if a parameter has no value.
        BadInputError
            if ``P`` or the period is not finite there, or the period not positive.

        Notes
        -----
        The smaller of two bounds for each entry (module ``remainder``): the a-priori sum of
        ``(Pbar T)**k / k!`` over ``k > n``, and the a-posteriori one, which computes the next increments at
        these parameters and is the true error to a few percent at points.  It takes some 0.1 s for Mathieu's
        equation (``benchmarks/enclosure.py``), and far longer where ``Pbar T`` is large or waves are fast.  Where
        ``Pbar T`` is beyond n and 300, the a-priori sum, far too large then, is all there is.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, t
        >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 20)
        >>> F.remainder({a: -0.1, b: 0.55}) < 1e-11 < 1 < F.remainder({a: 2.25, b: 0.1})
        True
        """
        exact = self.numbers(values)
        with working(BOUND_BITS):
            return reported(a_posteriori(*self.at(exact), self.n), entrywise)

    def enclosure(self, values: Values | None = None, digits: int = 15) -> Any:
        """A python-flint ``arb_mat`` that contains the true Floquet matrix of ``x' = P(t) x``.

        Parameters
        ----------
        values : {Symbol: number, ball, or interval (lo, hi)} for every parameter
        digits : int
            every radius is at most ``10**-digits`` of its entry; for entries below ``10**-digits`` of the
            largest one, ``10**-digits`` of that bound.

        Raises
        ------
        BadInputError
            if the parameters are balls too wide for the digits.
        MissingParameterError
            if a parameter has no value.

        Notes
        -----
        Independent of ``n``: the equation is integrated by Taylor polynomials whose defect is bounded, over half a
        period where ``P`` allows; steps, orders and precision follow from the digits.  Some 2.5 ms a point for
        Mathieu's equation and 30 digits, 0.1 s at ``a = 4000``.  For thousands of points see
        :func:`~fastpicard.tabulate`.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, t
        >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 0)
        >>> print(F.enclosure({a: -0.1, b: 0.55}, digits=20)[0, 1].str(20))
        [18.657723844543385212 +/- 3.39e-21]
        """
        return self._true(self.numbers(values), count_of_digits(digits))

    def _true(self, exact: Mapping[Any, Any], digits: int, strict: bool = True) -> Any:
        """The true matrix in balls with these digits, or if not strict with those that wide parameters leave."""
        return over_period(lambda: self.at(exact), self.turns, digits, is_box(exact), strict)

    def _structure(self, exact: Mapping[Any, Any]) -> Structure:
        return structure(self.P, exact, self.at(exact)[0].reversal is not None, lambda q: not may_vanish(q, exact))

    def multipliers(self, values: Values | None = None, digits: int | None = None) -> list[Any]:
        """The eigenvalues of the true Floquet matrix, complex or mpc, sorted by modulus, largest first.

        All digits are right.  Where ``P`` is Hamiltonian, reversible or keeps a quadratic form they come in pairs:
        number ``k`` from the front is the reciprocal of number ``k`` from the back, and what is proved to be on the
        unit circle is reported as ``cos + i sin`` there; :meth:`multiplier_enclosures` tells which are.

        Raises
        ------
        BadInputError
            if parameters are balls too wide for the digits, or too many multipliers coincide for them; as
            :meth:`remainder`.
        MissingParameterError
            if a parameter has no value.
        """
        wanted = check_digits(digits)
        found = self.multiplier_enclosures(values, 17 if wanted is None else wanted)
        return [to_complex(m.ball, wanted) for m in found]

    def exponents(self, values: Values | None = None, digits: int | None = None) -> list[Any]:
        """The Floquet exponents ``mu = log(lambda)/T`` of the true equation, complex or mpc; 1/unit of time.

        Solutions are ``exp(mu t)`` times functions of period T.  In the order of :meth:`multipliers`, fastest growth
        first.  The real part is a Lyapunov exponent, 0 where the multiplier is proved to be on the unit circle; the
        imaginary part, a frequency or quasienergy, is that in ``[-pi/T, pi/T]``: multiples of ``2 pi/T`` are free.
        Right to ``10**-digits`` of ``1/T`` or of ``|mu|``, whichever is larger, 15 digits where none are given.  Raises
        as :meth:`multipliers`.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, t
        >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 0)
        >>> [round(mu.real, 12) for mu in F.exponents({a: 0.25, b: 0.2})]
        [0.098204446059, -0.098204446059]
        """
        wanted, exact = check_digits(digits), self.numbers(values)
        found = self.multiplier_enclosures(values, 17 if wanted is None else wanted)
        with working(dps_to_prec(wanted or 17) + 64):
            return [to_complex(exponent(m, self.at(exact)[1]), wanted) for m in found]

    def multiplier_enclosures(self, values: Values | None = None, digits: int = 15) -> list[Multiplier]:
        """The multipliers of the true Floquet matrix in balls (``acb``), each with what is proved of its modulus.

        Parameters and order as :meth:`multipliers`; ``digits`` counts decimals relative to the multiplier's modulus.
        Of a multiplier that cannot be told from a double one the ball contains both; its digits cost twice
        the precision.  Raises as :meth:`multipliers`.
        """
        wanted = count_of_digits(digits)
        exact = self.numbers(values)
        known = self._structure(exact)
        tried = wanted + 5
        while True:
            matrix = self._true(exact, tried, strict=False)
            with working(dps_to_prec(tried) + 64):
                found = multipliers_of(matrix, known)
                if all(m.digits >= wanted for m in found):
                    return found
            if is_box(exact) and tried > 2 * wanted + 20:
                raise BadInputError(f"the digits asked for cannot be had: {wanted} were asked for, and the multipliers "
                                    f"have {max(min(m.digits for m in found), 0):.0f}: the parameters are balls with a "
                                    "radius.  Give numbers, narrower balls, or fewer digits.")
            if tried > 12 * wanted + 200:
                raise BadInputError(f"the multipliers have not {wanted} digits with {tried} digits of the Floquet "
                                    "matrix: several coincide or nearly so.  Ask for fewer digits.")
            tried *= 2

    def verdict(self, values: Values | None = None) -> Verdict:
        """Whether the zero solution of ``x' = P(t) x`` is stable, proved for the true equation, whatever ``n`` is.

        Returns
        -------
        Verdict
            ``Verdict.STABLE`` (all solutions bounded for ``t >= 0``), ``Verdict.UNSTABLE`` or ``Verdict.UNDECIDED``,
            with the sentence that proves it as ``.reason``.  Undecided means that the trace, or what else is asked,
            is within some ``1e-100`` of the end of stability (in parameters that is ``1e-50`` where two boundaries
            touch, and ``10**(-100/k)`` where k pairs of multipliers nearly coincide), or a box that a boundary may
            cross, or that is too wide for one enclosure: :func:`fastpicard.certify` divides boxes.  Where
            ``P`` is constant with rational entries it is never undecided.

        Raises
        ------
        MissingParameterError
            if a parameter has no value.
        BadInputError
            if ``P`` or the period is not finite there, or the period not positive.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, c, t
        >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 0)
        >>> print(F.verdict({a: -0.1, b: 0.55}))
        STABLE: the determinant is 1 and the trace [-0.0795591560226 +/- ...] lies strictly between -2 and 2
        >>> G = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), -c]]), t, 0)
        >>> G.verdict({a: 0.25, b: 0.2, c: 0.01})
        Verdict.UNSTABLE
        """
        exact = self.numbers(values)
        self.at(exact)  # there is no verdict at a pole, nor where the period is not positive
        constant = constant_matrix(self.P, exact)
        if constant is not None:
            return by_minimal_polynomial(constant)
        known = self._structure(exact)
        if known.bounded:
            return Verdict.STABLE.because(known.bounded)
        if known.unbounded:
            return Verdict.UNSTABLE.because(known.unbounded)
        for digits in (10, 30, 100):
            matrix = self._true(exact, digits, strict=False)
            with working(dps_to_prec(digits) + 64):
                verdict = judge(matrix, known)
            if verdict != Verdict.UNDECIDED or is_box(exact):
                break
        return verdict

    def lambdify(self, params: Sequence[Symbol], bound: bool = False) -> Callable[..., Any]:
        """A NumPy function of the parameters in this order; arrays broadcast to shape (..., m, m).

        Every entry is right to 10 ulp of the largest entry of the n-th iterate at its point that a double can hold.
        The cheapest arithmetic that is proved to do it is taken point by point: float64, pairs of float64, balls.
        Arguments are the doubles they round to.  Where the value is beyond the largest double it is infinite; where
        there is none it is nan: at a pole or resonance, and where a parameter that occurs is nan or infinite.

        Parameters
        ----------
        params : the parameters, Symbols
        bound : whether the function returns ``(values, bounds)`` with ``|value - exact| <= bound`` proved for every
            entry; bounds are infinite where the value is not finite

        Raises
        ------
        MissingParameterError
            if a parameter is not among ``params``.
        BadInputError
            by the function, for a number beyond the doubles, or where a Symbol that is an integer by its assumptions is
            given another number.

        Notes
        -----
        Speed and accuracy: for Mathieu's trace on one core 1.5e6 to 5e6 points/s at n = 20 and 4e5 to 1e6 at n = 50, by
        machine, nearly all in pairs, and a third to a fifth as many matrices; a point that needs balls takes 0.1 to
        1 ms.  See ``benchmarks/evaluation.py``.

        Examples
        --------
        >>> from sympy import Matrix, cos
        >>> from sympy.abc import a, b, t
        >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t), 0]]), t, 20)
        >>> value, error = F.lambdify_trace([a, b], bound=True)([-0.1, 0.1], 0.55)
        >>> print(value, error < 1e-15)
        [-0.07955916 -5.26098134] [ True  True]
        """
        return vectorise(self.collapsed, params, self.shape, bound)

    def lambdify_trace(self, params: Sequence[Symbol], bound: bool = False) -> Callable[..., Any]:
        """A NumPy function for the trace, right to 10 ulp of the trace itself; otherwise as :meth:`lambdify`."""
        return vectorise(self.collapsed_trace, params, (), bound)

    # -- printing ------------------------------------------------------------

    def __repr__(self) -> str:
        return f"<FloquetMatrix of order {self.n}, shape {self.shape[0]} x {self.shape[1]}, period {self.period}>"

    def _repr_latex_(self) -> str:
        if self.n > 8:
            return summary(self)
        return latex_or_summary(self, sum(len(modes) for modes in self._all()))
