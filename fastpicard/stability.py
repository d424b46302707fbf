r"""Stable, unstable or undecided: verdicts with the sentence that proves them.

The zero solution of ``x' = P(t) x`` is *stable* if all solutions stay bounded for ``t >= 0``.
From a matrix of balls that contains the true ``M = Phi(T)``:

Where multipliers come in pairs ``lambda, 1/lambda`` (Hamiltonian or reversible ``P``), with
``p`` the characteristic polynomial in ``rho = lambda + 1/lambda``:

- a root of ``p`` off the real interval [-2, 2] is a multiplier outside the unit circle: unstable.
  For 2 x 2 this is ``|trace| > 2``, [Neves] (15);
- all roots of ``p`` real, simple and inside (-2, 2): all multipliers simple on the circle: stable;
- a definite invariant form: with ``W`` from the Hamiltonian structure and any real polynomial ``f``,
  ``K = W (M - 1/M) f(M + 1/M)`` is symmetric and ``M' K M = K``; if it is definite, orbits stay on
  ellipsoids: stable, also where multipliers coincide.  (``W M`` and ``M' W M = W`` give
  ``(W M)' = -M' W = -W/M``, so ``W (M - 1/M)`` is symmetric; ``f`` of ``M + 1/M`` is self-adjoint in ``W``.)

For every other ``P``, by Schur and Cohn: the polynomial ``a_n z**n + ... + a_0`` has all roots inside the
unit circle exactly if ``|a_0| < |a_n|`` and ``(a_n a(z) - a_0 z**n a(1/z))/z`` has.  If all are inside, the
zero solution is asymptotically stable; if a step has ``|a_0| > |a_n|``, some root is outside: unstable.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

from flint import arb, arb_mat, arb_poly

from fastpicard.spectrum import Disc, in_rho, root_discs


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

    def because(self, reason: str) -> Verdict:
        """The same outcome with its reason."""
        return Verdict(self.name, reason)

    def __int__(self) -> int:
        return {"STABLE": 1, "UNSTABLE": -1}.get(self.name, 0)

    def __bool__(self) -> bool:
        raise TypeError(f"a verdict has three outcomes and no truth value; this one is {self.name}.  "
                        "Compare it: verdict == Verdict.STABLE.")

    def __repr__(self) -> str:
        return f"Verdict.{self.name}"

    def __str__(self) -> str:
        return f"{self.name}: {self.reason}" if self.reason else self.name


Verdict.STABLE, Verdict.UNSTABLE, Verdict.UNDECIDED = Verdict("STABLE"), Verdict("UNSTABLE"), Verdict("UNDECIDED")


def judge(matrix: Any, paired: bool, form: Any) -> Verdict:
    """The verdict on every true Floquet matrix in a matrix of balls.

    Parameters
    ----------
    matrix : arb_mat                contains ``M``
    paired : bool                   whether the multipliers of ``M`` are known to come in pairs lambda, 1/lambda
    form : fmpq_mat or None         ``W`` with ``M' W M = W``, if there is one
    """
    if not paired:
        return schur_cohn(matrix)
    if matrix.nrows() == 2:
        return by_trace(matrix.trace())
    discs = root_discs(in_rho(matrix))
    proved = _by_rho(discs)
    if proved is None:
        proved = _by_form(matrix, form, discs)
    if proved is None:
        return Verdict.UNDECIDED.because("the balls leave open whether a value of rho = lambda + 1/lambda is in "
                                         "[-2, 2]: " + ", ".join(_place(d) for d in discs))
    return proved


def by_trace(trace: Any) -> Verdict:
    """The verdict from the trace of a 2 x 2 matrix of determinant 1 ([Neves] (15))."""
    shown = trace.str(12)
    if abs(trace) < 2:
        return Verdict.STABLE.because(f"the determinant is 1 and the trace {shown} lies strictly between -2 and 2")
    if abs(trace) > 2:
        return Verdict.UNSTABLE.because(f"the determinant is 1 and the trace {shown} exceeds 2 in absolute value, so "
                                        "one multiplier is outside the unit circle")
    return Verdict.UNDECIDED.because(f"the trace {shown} cannot be told from {2 if trace > 0 else -2}")


def _by_rho(discs: list[Disc]) -> Verdict | None:
    for cluster in {d.cluster for d in discs}:
        members = [d for d in discs if d.cluster == cluster]
        if all(_off_segment(d) for d in members):
            return Verdict.UNSTABLE.because(
                f"rho = lambda + 1/lambda has the value {_place(members[0])}, off the real interval [-2, 2], so a "
                "multiplier is outside the unit circle")
    if all(d.real and abs(d.ball.real) < 2 for d in discs):
        return Verdict.STABLE.because(
            "all values of rho = lambda + 1/lambda are real, distinct and strictly between -2 and 2: "
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


def _by_form(matrix: Any, form: Any, discs: list[Disc]) -> Verdict | None:
    if form is None or not all(abs(d.center.real) < 2 for d in discs):
        return None
    W = arb_mat(form)
    inverse = arb_mat(form.inv()) * matrix.transpose() * W
    K, rho = W * (matrix - inverse), matrix + inverse
    size = matrix.nrows()
    one = arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])
    for f in [arb_poly([1]), *_signed(K, rho, discs, one)]:
        form_f = K * _at_matrix(f, rho, one)
        if is_definite(form_f) or is_definite(-1 * form_f):
            return Verdict.STABLE.because(
                "the quadratic form W (M - 1/M) f(M + 1/M) is invariant and definite, so orbits stay on ellipsoids; "
                f"f has degree {f.degree()}")
    return None


def _signed(K: Any, rho: Any, discs: list[Disc], one: Any) -> list[Any]:
    """``f`` that is 1 where the form is positive and -1 where it is negative: one candidate."""
    centers = []
    for cluster in sorted({d.cluster for d in discs}):
        members = [d.center.real.mid() for d in discs if d.cluster == cluster]
        centers.append((sum(members, arb(0)) / len(members)).mid())
    total = arb_poly()
    for i, x in enumerate(centers):
        basis = arb_poly([1])
        for j, y in enumerate(centers):
            if j != i:
                basis = basis * arb_poly([-y, 1]) / (x - y)
        positive = (K * _at_matrix(basis, rho, one)).trace().mid() > 0
        total = total + basis * (1 if positive else -1)
    return [total] if len(centers) > 1 else []


def _at_matrix(f: Any, matrix: Any, one: Any) -> Any:
    total = one * 0
    for c in reversed(f.coeffs()):
        total = total * matrix + one * c
    return total


def is_definite(matrix: Any) -> bool:
    """Whether the symmetric part of a matrix of balls is positive definite, by elimination."""
    rows = ((matrix + matrix.transpose()) / 2).tolist()
    while rows:
        pivot, *rest = rows[0]
        if not pivot > 0:
            return False
        rows = [[x - row[0] * y / pivot for x, y in zip(row[1:], rest, strict=True)] for row in rows[1:]]
    return True


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
        else:
            return Verdict.UNDECIDED.because(
                f"a step of Schur and Cohn cannot tell |a_0| = {abs(a[0]).str(8)} from |a_n| = {abs(a[-1]).str(8)}")
    return Verdict.STABLE.because("by Schur and Cohn all multipliers are strictly inside the unit circle: the zero "
                                  "solution is asymptotically stable")
