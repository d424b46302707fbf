r"""Immutable matrices of Poisson series in one time."""

from __future__ import annotations

import numbers
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import mpmath
import sympy
from sympy import ImmutableMatrix, Symbol

from fastpicard import modes as algebra
from fastpicard.errors import BadInputError, BadTypeError, FastPicardError, ShapeError, printed
from fastpicard.evaluate import check_digits, evaluate, free_symbols, numpy
from fastpicard.latex import shown, summary
from fastpicard.modes import Modes
from fastpicard.origin import at_time, shifted
from fastpicard.reading import as_time, plain, read, read_constant
from fastpicard.ring import Polynomial, read_only
from fastpicard.series import PoissonSeries
from fastpicard.values import Values
from fastpicard.writing import write

Rows = tuple[tuple[Modes, ...], ...]


class AsMatrix(ABC):
    """What SymPy and NumPy make of a matrix that is exact in the engine's form: that of :meth:`as_matrix`."""

    __slots__ = ()
    __iter__ = None

    @abstractmethod
    def as_matrix(self) -> ImmutableMatrix:
        """The matrix of canonical SymPy expressions."""

    def _sympy_(self) -> ImmutableMatrix:
        return self.as_matrix()

    def _latex(self, printer: Any) -> str:
        return str(printer.doprint(self.as_matrix()))

    def __neg__(self) -> Any:
        return -self.as_matrix()

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        if copy is False:
            raise ValueError("an array of a matrix of series is a new one.  Leave copy=False out.")
        return numpy().array(self.as_matrix().tolist(), dtype=dtype)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SeriesMatrix(AsMatrix):
    """A matrix whose entries are exact Poisson series in one time symbol.

    Immutable; ``==`` is mathematical equality of two of them, and with a SymPy matrix that of its trees with
    :meth:`as_matrix`; no operation rounds.

    Made from a SymPy Matrix, a NumPy array or nested lists of expressions of the family of :class:`PoissonSeries`, and
    the time.

    Attributes
    ----------
    shape : (rows, columns)
    t : Symbol                  the time
    rows : tuple of tuples      the entries as :mod:`fastpicard.modes`, read only

    Raises
    ------
    ShapeError
        if rows have different lengths, or none.
    NotInFamilyError
        if an entry is no finite sum of ``c t**r cos(q t + phi)`` and ``c t**r sin(q t + phi)``.
    BadTypeError
        for what is no matrix, and for text.
    """

    rows: Rows
    t: Symbol

    def __post_init__(self) -> None:
        object.__setattr__(self, "rows", tuple(tuple(map(read_only, row)) for row in _series(self.rows, self.t)))

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns)."""
        return len(self.rows), len(self.rows[0])

    @property
    def free_symbols(self) -> set[Symbol]:
        """The parameters: every symbol but the time."""
        return set().union(*(free_symbols(modes) for row in self.rows for modes in row))

    def __getitem__(self, index: tuple[int, int]) -> PoissonSeries:
        """One entry."""
        i, j = place(index, self.shape)
        return PoissonSeries.from_modes(self.rows[i][j], self.t)

    def __reduce__(self) -> tuple[Any, ...]:
        rows, columns = self.shape
        return _of_series, (tuple(tuple(self[i, j] for j in range(columns)) for i in range(rows)), self.t)

    def map(self, function: Callable[[Modes], Modes]) -> SeriesMatrix:
        """Apply a function of series to every entry."""
        return SeriesMatrix(tuple(tuple(function(modes) for modes in row) for row in self.rows), self.t)

    def _check(self, other: Any) -> None:
        """Refuse an operand that is no matrix of series in the same time."""
        if not isinstance(other, SeriesMatrix):
            raise BadTypeError(f"matrices of series go with each other, but the operand is {other!r}, a "
                               f"{type(other).__name__}.  Use as_matrix() for SymPy's operations.")
        if other.t != self.t:
            raise BadInputError(f"both matrices must have the same time, but they have {self.t} and {other.t}.  "
                                "Substitute one for the other.")

    def __neg__(self) -> SeriesMatrix:
        return self.map(algebra.negative)

    def __add__(self, other: SeriesMatrix) -> SeriesMatrix:
        if isinstance(other, sympy.MatrixBase):
            return NotImplemented
        self._check(other)
        if self.shape != other.shape:
            raise ShapeError("matrices can be added if their shapes agree, but they are "
                             f"{self.shape} and {other.shape}.  Check both shapes.")
        rows = tuple(tuple(map(algebra.total, left, right)) for left, right in zip(self.rows, other.rows, strict=True))
        return SeriesMatrix(rows, self.t)

    def __matmul__(self, other: SeriesMatrix) -> SeriesMatrix:
        if isinstance(other, sympy.MatrixBase):
            return NotImplemented
        self._check(other)
        if self.shape[1] != other.shape[0]:
            raise ShapeError("matrices can be multiplied if inner sizes agree, but they are "
                             f"{self.shape} and {other.shape}.  Check both shapes.")
        columns = list(zip(*other.rows, strict=True))
        return SeriesMatrix(tuple(tuple(_dot(row, column) for column in columns) for row in self.rows), self.t)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SeriesMatrix):
            return NotImplemented
        return self.shape == other.shape and all(
            self[i, j] == other[i, j] for i in range(self.shape[0]) for j in range(self.shape[1]))

    def __hash__(self) -> int:
        return hash((self.shape, self.t))

    def diff(self) -> SeriesMatrix:
        """The derivative of every entry."""
        return self.map(algebra.derivative)

    def integrate(self) -> SeriesMatrix:
        """The antiderivative of every entry that is zero at time 0."""
        return self.map(algebra.antiderivative)

    def shifted(self, by: Polynomial) -> SeriesMatrix:
        """Every entry at time ``t + by``."""
        return self.map(lambda modes: shifted(modes, by, self.t)) if by else self

    def as_matrix(self) -> ImmutableMatrix:
        """The matrix of canonical SymPy expressions."""
        return ImmutableMatrix([[write(modes, self.t) for modes in row] for row in self.rows])

    def __call__(self, time: Any) -> ImmutableMatrix:
        """The exact matrix at a time."""
        return ImmutableMatrix([[at_time(modes, time, self.t) for modes in row] for row in self.rows])

    def evaluate(self, time: Any, values: Values | None = None, digits: int | None = None) -> Any:
        """The matrix at a time: a float64 array, or an mpmath matrix with ``digits`` correct digits."""
        numbers = evaluate([modes for row in self.rows for modes in row], self.t, time, values, digits)
        return number_matrix(numbers, self.shape, check_digits(digits))

    def __repr__(self) -> str:
        return f"<{self.shape[0]} x {self.shape[1]} matrix of Poisson series in {self.t}>"

    def _repr_latex_(self) -> str:
        size = sum(f.length() for row in self.rows for modes in row for f in modes.values())
        return latex_or_summary(self, size)


def _of_series(entries: tuple[tuple[PoissonSeries, ...], ...], t: Symbol) -> SeriesMatrix:
    return SeriesMatrix(tuple(tuple(f.modes for f in row) for row in entries), t)


def place(index: Any, shape: tuple[int, int]) -> tuple[int, int]:
    """The row and the column of an index ``(i, j)``; negative ones count from the end.

    Raises
    ------
    BadTypeError
        if it is no pair of integers.
    BadInputError
        if there is no such entry.
    """
    integers = isinstance(index, tuple) and len(index) == 2 and all(
        isinstance(k, numbers.Integral) and not isinstance(k, bool) for k in index)
    if not integers:
        raise BadTypeError(f"an entry has two integers as its index, but it is {printed(index)}.  "
                           "Use X[0, 1], or X.as_matrix() for parts of the matrix.")
    i, j = map(int, index)
    if not all(-size <= k < size for k, size in zip((i, j), shape, strict=True)):
        raise BadInputError(f"a matrix of shape {shape} has no entry {printed((i, j))}.  Rows and columns count "
                            "from 0.")
    return i % shape[0], j % shape[1]


def _dot(row: tuple[Modes, ...], column: tuple[Modes, ...]) -> Modes:
    result: Modes = {}
    for left, right in zip(row, column, strict=True):
        if left and right:
            result = algebra.total(result, algebra.product(left, right))
    return result


def latex_or_summary(matrix: Any, size: int, limit: int = 100) -> str:
    """LaTeX where a person could read it, the one-line summary otherwise."""
    if size <= limit:
        return shown(sympy.latex(matrix.as_matrix()))
    return summary(matrix)


def number_matrix(values: list[Any], shape: tuple[int, int], digits: int | None) -> Any:
    """Numbers in row order as a float64 array or an mpmath matrix of the given shape."""
    if digits is None:
        return numpy().array(values, dtype=float).reshape(shape)
    rows, columns = shape
    return mpmath.matrix([values[i * columns:(i + 1) * columns] for i in range(rows)])


# -- reading -----------------------------------------------------------------


def read_matrix(P: Any, t: Symbol) -> SeriesMatrix:
    """The square matrix ``P(t)`` from a SymPy Matrix, nested lists, or a function of one argument.

    Raises
    ------
    ShapeError
        if it is not square.
    NotInFamilyError
        if an entry is no polynomial in ``t`` and sines and cosines of linear functions of ``t``.
    """
    t = as_time(t)
    if callable(P) and not isinstance(P, sympy.MatrixBase):
        try:
            P = P(t)
        except FastPicardError:
            raise
        except (TypeError, AttributeError) as error:
            raise BadTypeError(f"P must be a matrix, or a function of a SymPy Symbol, but P({t}) ends with: {error}  "
                               "Write its cosines as sympy.cos.") from error
    rows = _entries(P, "P")
    if not rows or any(len(row) != len(rows) for row in rows):
        lengths = {len(row) for row in rows} or {0}
        evidence = (f"its shape is {(len(rows), *lengths)}" if len(lengths) == 1 else
                    f"its {len(rows)} rows have the lengths {[len(row) for row in rows]}")
        raise ShapeError(f"P must be square, but {evidence}.  "
                         "A system x' = P x has as many equations as unknowns.")
    entries = tuple(tuple(_read_entry(e, t, i, j) for j, e in enumerate(row)) for i, row in enumerate(rows))
    return SeriesMatrix(entries, t)


def _series(rows: Any, t: Symbol) -> Rows:
    """Entries in the engine's form, read where they are expressions."""
    if isinstance(rows, tuple) and rows and all(row and all(isinstance(f, Mapping) for f in row) for row in rows):
        return rows
    entries = _entries(rows, "a matrix of series")
    lengths = [len(row) for row in entries]
    if len(set(lengths)) != 1 or 0 in lengths:
        raise ShapeError(f"the rows of a matrix must have one length from 1 up, but these have {lengths}.  Fill them "
                         "up.")
    return tuple(tuple(read(e, as_time(t)) for e in row) for row in entries)


def _entries(matrix: Any, what: str) -> list[list[Any]]:
    matrix = plain(matrix)
    if isinstance(matrix, list | tuple):
        matrix = [plain(row) for row in matrix]
    if isinstance(matrix, str):
        raise BadTypeError(f"{what} must be a SymPy Matrix, but it is the text {matrix!r}, which is never evaluated.  "
                           "Build it from sympy.Symbol objects.")
    if isinstance(matrix, sympy.MatrixBase):
        return list(matrix.tolist())
    if isinstance(matrix, SeriesMatrix):
        return list(matrix.as_matrix().tolist())
    if isinstance(matrix, list | tuple) and all(isinstance(row, list | tuple) for row in matrix):
        return [list(row) for row in matrix]
    raise BadTypeError(f"{what} must be a SymPy Matrix, nested lists or a function of the time, but it is {matrix!r}, "
                       f"a {type(matrix).__name__}.  Use sympy.Matrix.")


def _read_entry(entry: Any, t: Symbol, i: int, j: int) -> Modes:
    try:
        return read(entry, t)
    except (BadTypeError, ValueError) as error:
        raise type(error)(f"P must be a trigonometric polynomial in {t} ([Neves] (6)), but entry P[{i}, {j}] is not: "
                          f"{error}") from None


def as_list(x0: Any) -> Any:
    """The components of a column or row of SymPy or NumPy, or of nested lists of that shape."""
    x0 = list(x0) if isinstance(x0, sympy.MatrixBase) and 1 in x0.shape else plain(x0)
    if not isinstance(x0, list | tuple) or not all(isinstance(row, list | tuple) for row in x0):
        return x0
    return list(x0[0]) if len(x0) == 1 else [row[0] for row in x0] if all(len(row) == 1 for row in x0) else x0


def read_vector(x0: Any, t: Symbol, size: int) -> tuple[Modes, ...]:
    """The initial vector ``x0``, free of ``t``, with as many entries as ``P`` has rows."""
    x0 = as_list(x0)
    if isinstance(x0, str) or not isinstance(x0, list | tuple):
        raise BadTypeError(f"x0 must be a list or a column vector, but it is {x0!r}.  Give its {size} components.")
    if len(x0) != size:
        raise ShapeError(f"x0 must have the length {size} of P's side, but its length is {len(x0)}: {x0!r}.  "
                         f"Give {size} components.")
    return tuple(read_constant(value, t, f"x0[{i}]") for i, value in enumerate(x0))
