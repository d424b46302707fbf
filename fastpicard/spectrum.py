r"""Multipliers in balls, with the symmetry that the equation has (module ``structure``), kept exactly.

Where multipliers come in pairs ``lambda, 1/lambda`` the characteristic polynomial is palindromic, and in
``rho = lambda + 1/lambda`` it is a polynomial ``p`` of half the degree,

    chi(lambda)/lambda**m = p(rho) = c_m + sum_k c_{m-k} D_k(rho),
    D_0 = 2,  D_1 = rho,  D_{k+1} = rho D_k - D_{k-1}        (D_k = lambda**k + lambda**-k).

A multiplier is on the unit circle exactly if its ``rho`` is real with ``|rho| <= 2``; that
is a statement about a real number, which balls can prove, and no rounding leaves the circle.

Roots of ``p`` are enclosed by discs: with approximations ``z_i`` every root lies within
``m |p(z_i)| / prod |z_i - z_j|`` of some ``z_i``, and discs that hang together hold as many
roots as there are of them (Smith 1970).
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from itertools import accumulate, combinations
from typing import Any

from flint import acb, acb_poly, arb, arb_poly, ctx

from fastpicard.latex import number, shown
from fastpicard.packing import packed, unpacked
from fastpicard.structure import Structure

# -- the characteristic polynomial in rho ------------------------------------


def in_rho(matrix: Any) -> Any:
    """``p`` of a matrix of balls whose true multipliers come in pairs: an ``arb_poly``, monic.

    Of an odd number one is 1, for the determinant is: ``chi(lambda)/(lambda - 1)`` is palindromic.
    """
    coefficients = matrix.charpoly().coeffs()
    if len(coefficients) % 2 == 0:
        coefficients = list(accumulate(reversed(coefficients[1:])))[::-1]
    half = len(coefficients) // 2
    if half == 0:
        return arb_poly([1])
    even = [min(coefficients[k], coefficients[2 * half - k], key=lambda x: float(x.rad())) for k in range(half)]
    dickson = [arb_poly([2]), arb_poly([0, 1])]
    while len(dickson) <= half:
        dickson.append(arb_poly([0, 1]) * dickson[-1] - dickson[-2])
    terms = (c * d for c, d in zip(even[:0:-1], dickson[1:half], strict=True))
    return sum(terms, arb_poly([coefficients[half]])) + dickson[half]


@dataclass(frozen=True)
class Disc:
    """A disc of a cluster that holds as many roots as it has discs; one of several may hold none.

    Attributes
    ----------
    center : acb, exact
    radius : arb, exact
    reach : arb       the radius around the center that covers the whole cluster
    cluster : int     discs that hang together have the same number
    alone : bool      whether it is a cluster by itself: then it holds one root
    real : bool       whether that root is proved to be real
    """

    center: Any
    radius: Any
    reach: Any
    cluster: int
    alone: bool
    real: bool

    @property
    def ball(self) -> Any:
        """A square that holds the root, and every other of its cluster; on the real line where the root is real."""
        around = arb(0, self.reach)
        return acb(self.center.real + around, 0 if self.real else self.center.imag + around)


def root_discs(p: Any) -> list[Disc]:
    """Discs around the roots of a monic polynomial with real balls as coefficients.

    Approximations of roots that coincide may be nearer to each other than the balls allow; their discs are huge then.
    Those of the polynomial at an edge of the balls are as far apart as the balls leave open.
    """
    if p.degree() == 0:
        return []
    found = _discs(p, _approximate_roots(p))
    if all(d.alone for d in found):
        return found
    return min(found, _discs(p, _approximate_roots(_at_an_edge(p))), key=_largest)


def _at_an_edge(p: Any) -> Any:
    """Every coefficient moved up inside its ball, each by another part of the radius, so that no root stays double."""
    coefficients = p.coeffs()
    return arb_poly([c.mid() + c.rad() * (k + 1) / len(coefficients) for k, c in enumerate(coefficients)])


def _largest(discs: list[Disc]) -> Any:
    return max(d.radius for d in discs)


def _discs(p: Any, centers: list[Any]) -> list[Disc]:
    """The discs around these approximations."""
    degree, radii = p.degree(), []
    for i, z in enumerate(centers):
        distance = arb(1)
        for j, w in enumerate(centers):
            if j != i:
                distance *= abs(z - w)
        quotient = degree * abs(acb_poly(p)(z)) / distance
        radii.append(quotient.upper() if quotient.is_finite() else arb.pos_inf())
    clusters = list(range(degree))
    for i, j in combinations(range(degree), 2):
        if not abs(centers[i] - centers[j]) > radii[i] + radii[j]:
            old, new = clusters[j], clusters[i]
            clusters = [new if c == old else c for c in clusters]
    found = list(zip(centers, radii, clusters, strict=True))
    reaches = [max((abs(z - w) + s).upper() for w, s, other in found if other == c) for z, _, c in found]
    return [Disc(z, r, reach, c, clusters.count(c) == 1, clusters.count(c) == 1 and bool(z.imag == 0))
            for (z, r, c), reach in zip(found, reaches, strict=True)]


def _approximate_roots(p: Any) -> list[Any]:
    """Exact numbers near the roots (Weierstrass, also called Durand and Kerner), real where they nearly are."""
    degree = p.degree()
    middle = acb_poly([acb(c.mid()) for c in p.coeffs()])
    size = 1 + max(abs(c).upper() for c in p.coeffs()[:-1])
    roots = [acb(0.4, 0.9) ** k * (size if k else 1) for k in range(degree)]
    for _ in range(60 + 8 * degree + ctx.prec // 4):
        largest = arb(0)
        for i, z in enumerate(roots):
            distance = acb(1)
            for j, w in enumerate(roots):
                if j != i:
                    distance *= z - w
            change = middle(z) / distance if distance != 0 else acb(arb(2) ** -ctx.prec)
            roots[i] = _middle(z - change)
            largest = max(largest, abs(change).upper())
        if largest < size * arb(2) ** (8 - ctx.prec):
            break
    return [acb(z.real) if abs(z.imag) < arb(2) ** (-ctx.prec // 3) * (1 + abs(z))
            and all(abs(z - w) > 4 * abs(z.imag) for w in roots if w is not z) else z for z in roots]


def _middle(z: Any) -> Any:
    return acb(z.real.mid(), z.imag.mid())


# -- multipliers -------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Multiplier:
    """An eigenvalue of the Floquet matrix.

    Attributes
    ----------
    ball : acb                          contains the multiplier
    on_unit_circle : bool or None       proved to have modulus 1, proved not to, or neither
    """

    ball: Any
    on_unit_circle: bool | None

    @property
    def digits(self) -> float:
        """Decimals that are known, relative to the modulus."""
        radius = self.ball.real.rad() + self.ball.imag.rad()
        return -float((radius / abs(self.ball).lower()).log()) / math.log(10) if radius > 0 else math.inf

    def __complex__(self) -> complex:
        return complex(_middle(self.ball))

    def _repr_latex_(self) -> str:
        digits = int(min(max(self.digits, 2), 30))
        real, imaginary = (number(x.mid().str(digits, radius=False), digits) for x in (self.ball.real, self.ball.imag))
        sign = "" if imaginary.startswith("-") else "+ "
        radius = number(float((self.ball.real.rad() + self.ball.imag.rad()).upper()), 2)
        circle = {True: [r"\left|\lambda\right| = 1"], False: [r"\left|\lambda\right| \neq 1"], None: []}
        return shown(rf"\lambda = {real} {sign}{imaginary}\, i \pm {radius}", *circle[self.on_unit_circle])

    def __reduce__(self) -> tuple[Any, ...]:
        return _multiplier, (packed(self.ball.real, self.ball.imag), self.on_unit_circle)


def _multiplier(parts: Any, on_unit_circle: bool | None) -> Multiplier:
    return Multiplier(acb(*unpacked(parts)), on_unit_circle)


def exponent(multiplier: Multiplier, period: Any) -> Any:
    """``log(lambda)/T`` in a ball, the imaginary part in ``[-pi/T, pi/T]``, nearly; no real part on the unit circle."""
    z, turn = multiplier.ball, acb(0)
    if z.real.mid() < 0:  # the logarithm is cut there
        z, turn = -z, acb(0, arb.pi() if z.imag.mid() >= 0 else -arb.pi())
    found = z.log() + turn
    return (acb(0, found.imag) if multiplier.on_unit_circle else found) / period


def multipliers_of(matrix: Any, known: Structure) -> list[Multiplier]:
    """The multipliers of a matrix of balls, sorted by modulus, largest first.

    In pairs, number ``k`` from the front and number ``k`` from the back are reciprocal, and equal to ``1/lambda`` of
    each other as balls; of an odd number the one in the middle is 1.
    """
    if not known.paired:
        balls = sorted((disc.ball for disc in root_discs(matrix.charpoly())), key=_by_modulus)
        return [Multiplier(z, False if abs(z) > 1 or abs(z) < 1 else None) for z in balls]
    pairs = [_pair(disc) for disc in root_discs(in_rho(matrix))]
    pairs.sort(key=lambda pair: _by_modulus(pair[0].ball))
    one = [Multiplier(acb(1), True)] * (matrix.nrows() % 2)
    found = [pair[0] for pair in pairs] + one + [pair[1] for pair in reversed(pairs)]
    return [Multiplier(m.ball, True) for m in found] if known.bounded else found


def _by_modulus(z: Any) -> tuple[float, float]:
    return -float(abs(_middle(z))), cmath.phase(complex(_middle(z)))


def _pair(disc: Disc) -> tuple[Multiplier, Multiplier]:
    rho = disc.ball
    if disc.real and abs(rho.real) < 2:
        half = rho.real / 2
        height = (1 - half * half).sqrt()
        return Multiplier(acb(half, height), True), Multiplier(acb(half, -height), True)
    if disc.real and abs(rho.real) > 2:
        sign = 1 if rho.real > 0 else -1
        large = acb((rho.real + sign * (rho.real ** 2 - 4).sqrt()) / 2)
        return Multiplier(large, False), Multiplier(1 / large, False)
    off = bool(rho.imag > 0 or rho.imag < 0 or rho.real > 2 or rho.real < -2)
    if off:
        root = (rho * rho - 4).sqrt()
        large, small = (rho + root) / 2, (rho - root) / 2
        if abs(_middle(large)) < abs(_middle(small)):
            large, small = small, large
        if large.is_finite():
            return Multiplier(large, False), Multiplier(1 / large, False)
    return _near_circle(rho)


def _near_circle(rho: Any) -> tuple[Multiplier, Multiplier]:
    """Both solutions of ``lambda + 1/lambda = rho`` where it is not known which is the larger one.

    ``(lambda - w)**2`` is at most ``|rho - sigma| |lambda|`` for the point ``sigma = w + 1/w`` next to ``rho``.
    """
    middle = rho.real.mid()
    middle = min(max(middle, arb(-2)), arb(2))
    w = acb(middle / 2, (1 - middle * middle / 4).nonnegative_part().sqrt())
    gap = abs(rho - middle).upper()
    spread = (gap + (gap * gap + 4 * gap).sqrt()).upper()  # |lambda - w| |lambda - 1/w| = |rho - sigma| |lambda|
    around = acb(arb(0, spread), arb(0, spread))
    return Multiplier(w + around, None), Multiplier(w.conjugate() + around, None)
