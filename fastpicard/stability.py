r"""Stable, unstable or undecided: verdicts with the sentence that proves them.

The zero solution of ``x' = P(t) x`` is *stable* if all solutions stay bounded for ``t >= 0``.
From a matrix of balls that contains the true ``M = Phi(T)``:

Where multipliers come in pairs ``lambda, 1/lambda`` (Hamiltonian or reversible ``P``; 2 x 2, determinant 1), with
``p`` the characteristic polynomial in ``rho = lambda + 1/lambda``:

- a root of ``p`` off the real interval [-2, 2] is a multiplier outside the unit circle: unstable.
  For 2 x 2 this is ``|trace| > 2``, [Neves] (15);
- all roots of ``p`` real, simple and inside (-2, 2): all multipliers simple on the circle: stable.  Of an odd number of
  multipliers one is 1, and then it is simple, too;
- a definite invariant form: with ``W`` from the Hamiltonian structure and any real polynomial ``f``,
  ``K = W (M - 1/M) f(M + 1/M)`` is symmetric and ``M' K M = K``; if a sum of such forms is definite, orbits stay
  on ellipsoids: stable, also where multipliers coincide.  (``W M`` and ``M' W M = W`` give
  ``(W M)' = -M' W = -W/M``, so ``W (M - 1/M)`` is symmetric; ``f`` of ``M + 1/M`` is self-adjoint in ``W``.)

For every other ``P``, by Schur and Cohn: the polynomial ``a_n z**n + ... + a_0`` has all roots inside the
unit circle exactly if ``|a_0| < |a_n|`` and ``(a_n a(z) - a_0 z**n a(1/z))/z`` has.  If all are inside, the
zero solution is asymptotically stable; if a step has ``|a_0| > |a_n|``, some root is outside: unstable.  Where a step
cannot tell them apart, as when all multipliers have the product 1, a root may still be enclosed outside.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

from flint import arb, arb_mat

from fastpicard.errors import BadInputError, BadTypeError
from fastpicard.evaluate import numpy
from fastpicard.latex import sentence, shown
from fastpicard.spectrum import Disc, in_rho, root_discs
from fastpicard.structure import Structure, is_definite


@dataclass(frozen=True, repr=False)
class Verdict:
    """STABLE, UNSTABLE or UNDECIDED, with the sentence that proves it.

    Verdicts compare by their outcome alone, so ``F.verdict(values) == Verdict.STABLE`` asks what
    one means to ask.  ``int(verdict)`` is 1, -1 or 0; a verdict is not a truth value.

    Attributes
    ----------
    name : str        ``"STABLE"``, ``"UNSTABLE"`` or ``"UNDECIDED"``
    reason : str      the sentence that proves it, or says why there is no proof
    """

    STABLE: ClassVar[Verdict]
    UNSTABLE: ClassVar[Verdict]
    UNDECIDED: ClassVar[Verdict]

    name: str
    reason: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        if self.name not in ("STABLE", "UNSTABLE", "UNDECIDED"):
            raise BadInputError(f"a verdict is STABLE, UNSTABLE or UNDECIDED, but it is {self.name!r}.  Use "
                                "Verdict.STABLE, say.")

    def because(self, reason: str) -> Verdict:
        """The same outcome with its reason."""
        return Verdict(self.name, reason)

    def __int__(self) -> int:
        return {"STABLE": 1, "UNSTABLE": -1}.get(self.name, 0)

    def __bool__(self) -> bool:
        raise BadTypeError(f"a verdict has three outcomes and no truth value; this one is {self.name}.  "
                           "Compare it: verdict == Verdict.STABLE.")

    def __repr__(self) -> str:
        return f"Verdict.{self.name}"

    def __str__(self) -> str:
        return f"{self.name}: {self.reason}" if self.reason else self.name

    def _repr_latex_(self) -> str:
        return shown(sentence(str(self)))


Verdict.STABLE, Verdict.UNSTABLE, Verdict.UNDECIDED = Verdict("STABLE"), Verdict("UNSTABLE"), Verdict("UNDECIDED")


def judge(matrix: Any, known: Structure) -> Verdict:
    """The verdict on every true Floquet matrix in a matrix of balls.

    Parameters
    ----------
    matrix : arb_mat                contains ``M``
    known : Structure               what ``P`` says of the multipliers
    """
    if not known.paired:
        return schur_cohn(matrix)
    if matrix.nrows() == 2:
        return by_trace(matrix.trace())
    discs = root_discs(in_rho(matrix))
    proved = _by_rho(discs, "the multiplier 1 is simple, and " if matrix.nrows() % 2 else "")
    if proved is None:
        proved = _by_form(matrix, known.forms, discs)
    if proved is None:
        return Verdict.UNDECIDED.because("the balls leave open whether a value of rho = lambda + 1/lambda is in "
                                         "[-2, 2]: " + ", ".join(_place(d) for d in discs))
    return proved


def by_trace(trace: Any) -> Verdict:
    """The verdict from the trace of a 2 x 2 matrix of determinant 1 ([Neves] (15))."""
    end = 2 if trace > 0 else -2
    if abs(trace) < 2:
        return Verdict.STABLE.because(f"the determinant is 1 and the trace {_told_from(end, trace)} lies strictly "
                                      "between -2 and 2")
    if abs(trace) > 2:
        return Verdict.UNSTABLE.because(f"the determinant is 1 and the trace {_told_from(end, trace)} exceeds 2 in "
                                        "absolute value, so one multiplier is outside the unit circle")
    return Verdict.UNDECIDED.because(f"the trace, which differs from {end} by {(trace - end).str(3)}, cannot be told "
                                     "from it")


def _told_from(end: int, trace: Any) -> str:
    """A trace as printed: where few digits would hold the end of stability, how far from it."""
    shown = str(trace.str(12))
    if not arb(shown).contains(end):
        return shown
    gap = trace - end
    apart, sign = str(abs(gap).str(5)), "+" if gap > 0 else "-"
    if arb(apart).contains(0):  # no digit of it is known, but its sign
        return f"{end} {sign} d, 0 < d < {(abs(gap).upper() * 1.1).str(2, radius=False)},"
    return f"{end} {sign} {apart}"


def _by_rho(discs: list[Disc], before: str) -> Verdict | None:
    for cluster in {d.cluster for d in discs}:
        members = [d for d in discs if d.cluster == cluster]
        if all(_off_segment(d) for d in members):
            return Verdict.UNSTABLE.because(
                f"rho = lambda + 1/lambda has the value {_place(members[0])}, off the real interval [-2, 2], so a "
                "multiplier is outside the unit circle")
    if all(d.real and abs(d.ball.real) < 2 for d in discs):
        return Verdict.STABLE.because(
            f"{before}all values of rho = lambda + 1/lambda are real, distinct and strictly between -2 and 2: "
            + ", ".join(_place(d) for d in discs))
    return None


def _off_segment(d: Disc) -> bool:
    z = d.center
    beyond = abs(z.real) - 2
    return bool((beyond > 0 and abs(z - (2 if z.real > 0 else -2)) > d.radius) or (not beyond > 0
                                                                                   and abs(z.imag) > d.radius))


def _place(d: Disc) -> str:
    return str(d.ball.real.str(8)) if d.real else str(d.ball.str(8))


# -- the invariant form ------------------------------------------------------


def _by_form(matrix: Any, forms: list[Any], discs: list[Disc]) -> Verdict | None:
    """Stable if the invariant form that is next to the mean of ``(M**k)' M**k`` over all ``k`` is definite.

    That mean is an invariant form itself, and definite exactly if the powers stay bounded; it is computed in floats and
    replaced by its neighbour among the invariant forms that are known, which balls then examine.
    """
    if not forms or not all(abs(d.center.real) < 2 for d in discs):
        return None
    W = arb_mat(forms[0])
    inverse = arb_mat(forms[0].inv()) * matrix.transpose() * W
    factor, invariant = matrix - inverse, []
    for _ in discs:
        invariant += [arb_mat(form) * factor for form in forms[1:]]
        factor = factor * (matrix + inverse)
    weights = _next_to(_mean_form(matrix), invariant)
    total = sum((K * arb(x) for K, x in zip(invariant, weights, strict=True)), matrix * 0)
    if is_definite(total):
        return Verdict.STABLE.because("a quadratic form W (M - 1/M) f(M + 1/M) is invariant and definite, so orbits "
                                      "stay on ellipsoids")
    return None


def _floats(matrix: Any) -> Any:
    return numpy().array([float(x.mid()) for x in matrix.entries()]).reshape(matrix.nrows(), matrix.ncols())


def _mean_form(matrix: Any) -> Any:
    """The mean of ``(M**k)' M**k`` over the first ``2**20`` powers, in floats."""
    power = _floats(matrix)
    mean = numpy().eye(len(power))
    for _ in range(20):
        mean = (mean + power.T @ mean @ power) / 2
        power = power @ power
    return mean


def _next_to(target: Any, invariant: list[Any]) -> list[float]:
    """The coefficients of the combination next to a matrix, in least squares; zeros if floats do not reach."""
    columns = numpy().array([_floats(K + K.transpose()).ravel() / 2 for K in invariant]).T
    if not (numpy().isfinite(columns).all() and numpy().isfinite(target).all()):
        return [0.0] * len(invariant)
    return [float(x) for x in numpy().linalg.lstsq(columns, target.ravel(), rcond=None)[0]]


# -- any matrix --------------------------------------------------------------


def schur_cohn(matrix: Any) -> Verdict:
    """The verdict from the characteristic polynomial, without pairs."""
    a = matrix.charpoly().coeffs()
    while len(a) > 1:
        if abs(a[0]) < abs(a[-1]):
            ratio = a[0] / a[-1]
            a = [x - ratio * y for x, y in zip(a, reversed(a), strict=True)][1:]
        elif abs(a[0]) > abs(a[-1]):
            return Verdict.UNSTABLE.because(
                "by Schur and Cohn a root of the characteristic polynomial is outside the unit circle: a step has "
                f"|a_0| = {abs(a[0]).str(8)} > |a_n| = {abs(a[-1]).str(8)}")
        elif (outside := next(iter(_outside(matrix.charpoly())), None)) is not None:
            return Verdict.UNSTABLE.because(f"a multiplier is in the disc {outside}, outside the unit circle")
        else:
            return Verdict.UNDECIDED.because(
                f"a step of Schur and Cohn cannot tell |a_0| = {abs(a[0]).str(8)} from |a_n| = {abs(a[-1]).str(8)}")
    return Verdict.STABLE.because("by Schur and Cohn all multipliers are strictly inside the unit circle: the zero "
                                  "solution is asymptotically stable")


def _outside(p: Any) -> list[str]:
    """The discs of clusters of roots that lie outside the unit circle with all of their discs."""
    discs = root_discs(p)
    inside = {d.cluster for d in discs if not abs(d.center) - d.radius > 1}
    return [_place(d) for d in discs if d.cluster not in inside]
