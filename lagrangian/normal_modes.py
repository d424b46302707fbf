r"""Normal coordinates: N coupled rods as N single equations, [Neves] (18)-(21).

If the stiffness is one function of time times a constant matrix, ``stiffness = s(t) B``, then

    A theta'' + s(t) B theta = 0,   A^-1 B u_i = mu_i u_i,   theta = U psi   give   psi_i'' + mu_i s(t) psi_i = 0.

``A^-1 B`` is not symmetric, so U is not orthogonal (as the article has it) but A-orthogonal: ``U^T A U`` and
``U^T B U`` are diagonal.  All mu are real because A is positive definite and B symmetric.

Upright, ``s = -(g + eta'')/l`` for equal rods, and with ``eta = epsilon cos(omega0 t)`` every mode is Mathieu's
equation ``y'' + (a + b cos tau) y = 0`` with ``a = -mu/v**2``, ``b = mu h``.  Hanging, ``s = +(g + eta'')/l``; for
bobs the mu are then the zeros of the Laguerre polynomial ``L_N``.  Unequal rods decouple too, with ``s`` in
m/s**2 and mu in 1/m; springs beside a time-dependent weight do not.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from sympy import (
    QQ,
    CRootOf,
    Dummy,
    Eq,
    Function,
    Integer,
    Poly,
    Symbol,
    cancel,
    cos,
    expand,
    latex,
    sqrt,
)

from .drive import frequency, in_scales, modes_of, natural_scales
from .eigen import eigenpairs
from .energy import Scene
from .errors import InhomogeneousError, NotASceneError, NotDecoupledError, NotPeriodicError, QuantityError, printed
from .linearize import LinearEquations
from .quadratic import modes_in_radicals
from .quantities import refuse_text, truth

__all__ = ["NormalModes", "normal_modes"]

_DIGITS = 30
_MOST_DIGITS = 100_000


@dataclass(frozen=True, repr=False)
class NormalModes:
    """``psi_i'' + mu_i s(t) psi_i = 0`` with ``theta = U psi``.  Immutable.

    Made by :func:`normal_modes`.

    Attributes
    ----------
    mu : tuple of N, ascending where they are numbers; without unit for equal rods, else 1/m (1/s**2 where s is 1)
    U : Matrix, shape (N, N), the modes in its columns, the last component of each 1, or 0; A-orthogonal
    A, B : Matrices, shape (N, N), constant, symmetric; A of equal rods is divided by ``m l**2``
    time_factor : s(t); ``A theta'' + s(t) B theta = 0``
    digits : None where mu is exact; else the number of correct digits of mu

    ``mu`` and ``U`` are exact for N <= 2.  For N > 2, ``mu`` is exact where A and B are rational (up to a common
    factor), and the entries of ``U`` are numbers of 30 digits, or of ``digits``: SymPy Floats of that precision, since
    Matrices and symbols stand beside them.
    """

    scene: Scene
    mu: tuple[Any, ...]
    U: Any = field(repr=False)
    A: Any = field(repr=False)
    B: Any = field(repr=False)
    time_factor: Any
    digits: int | None = None

    def __iter__(self) -> Iterator[Any]:
        return iter((self.mu, self.U))

    @property
    def equations(self) -> tuple[Any, ...]:
        """``psi_i'' + mu_i s(t) psi_i = 0`` as N SymPy equations in ``psi1(t), ...`` ([Neves] (21))."""
        t = self.scene.t
        psi = [Function(f"psi{i}")(t) for i in range(1, len(self.mu) + 1)]
        return tuple(Eq(y.diff(t, 2) + mu * self.time_factor * y, 0) for mu, y in zip(self.mu, psi, strict=True))

    def mathieu(self, omega0: Any, dimensionless: bool = True) -> tuple[tuple[Any, Any], ...]:
        """``(a_i, b_i)`` of ``y'' + (a_i + b_i cos tau) y = 0``, tau = omega0 t, for every mode ([Neves] (21)).

        For equal upright rods ``a = -mu/v**2`` and ``b = mu h``; the symbols h and v as in
        :meth:`LinearEquations.first_order`.  ``omega0`` in rad/s; a and b have no unit.

        Raises NotPeriodicError unless the drive is ``constant + epsilon cos(omega0 t)``; otherwise as
        ``first_order``.

        >>> from sympy import cos, symbols
        >>> from lagrangian import Rod, Scene, Support, euler_lagrange, linearize
        >>> m, l, epsilon, omega0, t = symbols("m l epsilon omega0 t")
        >>> scene = Scene([Rod.uniform(m, l)], Support(eta=epsilon*cos(omega0*t)))
        >>> normal_modes(linearize(euler_lagrange(scene))).mathieu(omega0)
        ((-3/(2*v**2), 3*h/2),)
        """
        omega0 = frequency(omega0, self.scene)
        found = {(q, k): part for q, pair in modes_of(self.time_factor, self.scene.t, omega0).items()
                 for k, part in enumerate(pair) if expand(part) != 0}
        other = [(q, "cos" if k == 0 else "sin") for q, k in found if (q, k) not in ((0, 0), (1, 0))]
        if other:
            tau = Symbol("tau")
            raise NotPeriodicError(
                f"Mathieu's equation has the one wave cos tau, and this drive has {other[0][1]}({other[0][0] * tau}) "
                f"with tau = {omega0}*{self.scene.t}: choose omega0 and the origin of time so that the drive is "
                f"epsilon*cos(omega0*{self.scene.t}), or use first_order."
            )
        scales = natural_scales(self.scene, omega0) if truth(dimensionless, "dimensionless") else ()
        a, b = (in_scales(found.get((q, 0), Integer(0)) / omega0**2, scales) for q in (0, 1))
        return tuple((expand(mu * a), expand(mu * b)) for mu in self.mu)

    def __repr__(self) -> str:
        mu = [f"{value.evalf(6)}" if value.is_number else str(value) for value in self.mu]
        shown = mu if len(mu) <= 4 else [*mu[:2], "...", mu[-1]]
        return f"NormalModes(mu = {', '.join(shown)}; psi'' + mu*({self.time_factor}) psi = 0)"

    def _repr_latex_(self) -> str:
        mu = ", ".join(latex(x if len(self.mu) <= 2 else x.evalf(6)) for x in self.mu)
        return rf"$\ddot\psi_i + \mu_i \left({latex(self.time_factor)}\right) \psi_i = 0, \quad \mu = {mu}$"


def normal_modes(lin: LinearEquations, digits: int | None = None) -> NormalModes:
    """``mu_i`` and ``U`` that turn ``A theta'' + s(t) B theta = 0`` into one equation a mode, for any N.

    ``U**-1 A**-1 B U = diag(mu)`` ([Neves] (18)-(21)); ``mu`` ascending, ``U`` of shape (N, N), A-orthogonal.
    N <= 2: radicals, symbols allowed.  N > 2: A and B must be numbers up to a common factor each.

    Raises
    ------
    NotDecoupledError
        Damping, or a stiffness that is not one function of time times a constant matrix (springs beside a driven
        weight), or N > 2 with symbols that do not cancel.
    InhomogeneousError
        A remainder that is not zero: take ``lin.homogeneous()``.
    NotASceneError, TextError, QuantityError
        ``lin`` is not from :func:`linearize`; ``digits`` is not a positive integer, 100,000 at most.

    Speed and accuracy: with ``digits=None`` mu is exact (rationals, radicals, or roots of irreducible polynomials
    that SymPy isolates and refines on demand), and U for N > 2 has 30 digits.  ``digits=d`` computes both as numbers,
    whose d digits are proved in balls unless some mu are equal (:mod:`lagrangian.eigen`); it is the faster way, a
    second for N = 50, where ``mpmath.eigsy`` takes 5 times as long and exact mu 12 times (``benchmarks/chains.py
    modes``).

    >>> from sympy import symbols
    >>> from lagrangian import Rod, Scene, euler_lagrange, linearize
    >>> rods = [Rod.uniform(*symbols("m l"))] * 2
    >>> normal_modes(linearize(euler_lagrange(Scene(rods)))).mu
    (3 - 6*sqrt(7)/7, 6*sqrt(7)/7 + 3)
    """
    _check(lin, digits)
    scaled = lin.divided() if lin.scene.equal_rod else lin
    factor, B = _factor(scaled)
    A, n = scaled.A, len(lin.scene)
    if n <= 2 and digits is None:
        mu, U = modes_in_radicals(A, B)
        return NormalModes(lin.scene, mu, U, A, B, factor)
    unit, A0, B0 = _in_numbers(A, B)
    rational = digits is None and all(x.is_Rational for x in (*A0, *B0))
    values, U = eigenpairs(A0, B0, digits or _DIGITS)
    mu = _exact_roots(A0, B0) if rational else tuple(values)
    return NormalModes(lin.scene, tuple(unit * x for x in mu), U, A, B, factor,
                       None if rational else digits or _DIGITS)


def _check(lin: LinearEquations, digits: int | None) -> None:
    refuse_text(digits, "digits")
    if not isinstance(lin, LinearEquations):
        raise NotASceneError(f"normal_modes takes the result of linearize, and this is {lin!r}.")
    if digits is not None and (isinstance(digits, bool) or not isinstance(digits, int) or digits < 1):
        raise QuantityError(f"digits is a positive integer or None, and this is {printed(digits, repr)}.")
    if digits is not None and digits > _MOST_DIGITS:
        raise QuantityError(f"digits is {printed(digits)}: give at most {_MOST_DIGITS}; balls of more take for ever.")
    if any(lin.damping):
        raise NotDecoupledError(
            f"normal modes are those of an undamped chain, and the damping matrix here is {lin.damping.tolist()}: "
            f"use lin.first_order(omega0), or a scene without damping."
        )
    if any(expand(x) != 0 for x in lin.remainder):
        raise InhomogeneousError(
            f"the modes are those of the homogeneous equations, and the remainder here is {list(lin.remainder)}: "
            f"use normal_modes(lin.homogeneous())."
        )


def _factor(lin: LinearEquations) -> tuple[Any, Any]:
    """``s(t)`` and constant ``B`` with ``stiffness = s B``."""
    for s in _candidates(lin):
        B = lin.stiffness.applyfunc(lambda x, s=s: cancel(x / s) if x != 0 else x)
        if lin.t not in B.free_symbols:
            return s, B
    raise NotDecoupledError(
        f"the stiffness is not one function of time times a constant matrix: its entries {_two_unlike(lin)} vary "
        f"differently, so no constant U decouples it (springs beside a driven weight do this).  "
        f"Use lin.first_order(omega0)."
    )


def _candidates(lin: LinearEquations) -> Iterator[Any]:
    """The weight, if nothing else acts; 1; the first entry."""
    scene = lin.scene
    weight = scene.gravity + scene.support_acceleration[1]
    if weight != 0 and not any(scene.springs or ()):
        length = scene.equal_rod.length if scene.equal_rod else Integer(1)
        side = -scene.up if cos(lin.about[0]) != -1 else scene.up
        yield expand(side * weight / length)
    yield Integer(1)
    yield next((x for x in lin.stiffness if lin.t in x.free_symbols), Integer(1))


def _two_unlike(lin: LinearEquations) -> str:
    entries = [x for x in lin.stiffness if x != 0]
    unlike = next(x for x in entries if lin.t in cancel(x / entries[0]).free_symbols or x is entries[-1])
    return f"{entries[0]} and {unlike}"


def _in_numbers(A: Any, B: Any) -> tuple[Any, Any, Any]:
    """``mu = unit * mu0`` with mu0 the eigenvalues of two matrices of numbers, shape (N, N) each."""
    if all(x.is_number for x in (*A, *B)):
        return Integer(1), A, B
    alpha = A[0, 0]
    beta = next((x for x in B if x != 0), Integer(1))
    A0, B0 = (matrix.applyfunc(lambda x, c=c: cancel(x / c)) for matrix, c in ((A, alpha), (B, beta)))
    left = sorted(str(x) for x in A0.free_symbols | B0.free_symbols)
    if left:
        raise NotDecoupledError(
            f"the modes of {A.rows} rods are roots of a polynomial of degree {A.rows}, and it still contains "
            f"{', '.join(left)}: give these quantities numerical values (two rods have modes in symbols)."
        )
    return cancel(beta / alpha), A0, B0


def _exact_roots(A: Any, B: Any) -> tuple[Any, ...]:
    """The eigenvalues of ``A**-1 B`` for rational matrices: exact, ascending."""
    x = Dummy("x")
    domain_matrix = (A.to_DM().convert_to(QQ).inv() * B.to_DM().convert_to(QQ))
    polynomial = Poly([QQ.to_sympy(c) for c in domain_matrix.charpoly()], x, domain=QQ)
    roots = [root for f, k in polynomial.factor_list()[1] for root in _roots(f) * k]
    return tuple(sorted(roots, key=lambda root: root.evalf(_DIGITS)))


def _roots(f: Any) -> list[Any]:
    """The roots of an irreducible rational polynomial, all real: a rational, two radicals, or indexed roots."""
    if f.degree() == 1:
        a, b = f.all_coeffs()
        return [-b / a]
    if f.degree() == 2:
        a, b, c = f.all_coeffs()
        return [(-b + side * sqrt(b**2 - 4 * a * c)) / (2 * a) for side in (-1, 1)]
    return [CRootOf(f, k) for k in range(f.degree())]
