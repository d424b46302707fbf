r"""Characteristic numbers of Mathieu's equation ``y'' + (a - 2 q cos 2z) y = 0``, every digit proved.

``a_r(q)`` and ``b_r(q)`` are the values of ``a`` at which the equation has an even, respectively an odd,
solution of period pi (r even) or antiperiod pi (r odd); ``a_r(0) = b_r(0) = r**2``.  They bound the stable
regions.  Nothing here uses Picard iteration, so this file and the Floquet matrix check each other.

They are the eigenvalues of four tridiagonal matrices.  :mod:`fastpicard.mathieu_guess` guesses one in float64,
:mod:`fastpicard.mathieu_matrices` brings it to the digits wanted, and two counts of the eigenvalues below, on either
side of it, are the proof.

**The parameter.**  ``2 cos 2z`` has norm 2, so ``|a_r(p) - a_r(q)| <= 2 |p - q|`` (Weyl), and the same for
b: a q that is not a binary number is replaced by one that is, and the enclosure widened by that much.
"""

import math
import operator
from decimal import MAX_EMAX, MIN_EMIN, ROUND_HALF_EVEN, Context, Decimal
from typing import Any

import mpmath
from flint import arb
from mpmath.libmp import dps_to_prec, from_rational

from fastpicard.errors import BadInputError, BadTypeError, printed
from fastpicard.evaluate import ball, count_of_digits
from fastpicard.mathieu_guess import Guess, float_guess
from fastpicard.mathieu_matrices import Matrix
from fastpicard.precision import working
from fastpicard.values import exact_number


def mathieu_a(r: int, q: Any, digits: int = 15) -> Any:
    r"""The characteristic number ``a_r(q)`` of ``y'' + (a - 2 q cos 2z) y = 0``, to ``digits`` significant digits.

    ``a_r(q)`` belongs to the even solution ``ce_r(z, q)`` (DLMF 28.2(v)); in the article's form
    ``y'' + (a + b cos t) y = 0`` it is the boundary ``a = a_r(-2b)/4``.

    Parameters
    ----------
    r : int >= 0
    q : int, Fraction, float, mpf, SymPy number, python-flint fmpz, fmpq or arb; real, of either sign.
        float and mpf are taken as the exact binary numbers they are.
    digits : int >= 1

    Returns an mpmath ``mpf``: the decimal number of ``digits`` significant digits nearest to ``a_r(q)``,
    ties excluded by proof, stored with a few bits more than it takes to print it back (``mpmath.nstr(x,
    digits)``).  Both the digits and the index r are proved.  At ``q = 0`` it is ``r**2`` itself, exact.
    For the nearest float64 take ``float`` of 20 digits. mpmath's global precision is neither read nor
    changed.

    Raises BadTypeError (q is text, complex or symbolic; r or digits is not an integer) and BadInputError (r
    negative, q infinite or nan, digits not from 1 to 10,000,000, a ball q too wide for ``digits``, a matrix of
    more than a million rows).

    Speed and accuracy: see ``fastpicard.mathieu.mathieu_a_enclosure``, which does the work and gives the ball itself.

    >>> mpmath.nstr(mathieu_a(0, 25, digits=30), 30)
    '-40.2567795465667872758017193249'
    """
    return _rounded("a", r, q, digits)


def mathieu_b(r: int, q: Any, digits: int = 15) -> Any:
    r"""The characteristic number ``b_r(q)`` of ``y'' + (a - 2 q cos 2z) y = 0``, to ``digits`` significant digits.

    ``b_r(q)``, ``r >= 1``, belongs to the odd solution ``se_r(z, q)`` (DLMF 28.2(v)); in the article's form
    it is the boundary ``a = b_r(-2b)/4``.  Arguments, result, guarantee and errors are those of
    `mathieu_a`.

    >>> mpmath.nstr(mathieu_b(1, 25, digits=30), 30)
    '-40.2567789846841592832950489197'
    """
    return _rounded("b", r, q, digits)


def mathieu_a_enclosure(r: int, q: Any, digits: int = 15) -> Any:
    r"""A python-flint ball that contains ``a_r(q)``, of radius at most ``10**-digits |a_r(q)|``.

    If q is itself a ball of radius s, the result contains ``a_r`` of every point of it and is wider by ``2
    s``.  Arguments and errors are those of `mathieu_a`.

    Speed and accuracy: one call for 15, 30, 100 and 1000 digits, measured on one core of a small server by
    ``benchmarks/enclosure.py``: at (r, q) = (0, 5) 0.1, 0.2, 0.3 and 4 ms; (3, 1000) 0.2, 0.3, 0.7 and 7 ms;
    (0, 1e6) 0.6, 0.9, 2 and 27 ms; (50, 1e6) 1.0, 1.4, 3 and 28 ms; (300, 1e6) 2.3, 3.0, 5 and 35 ms.  Time grows as
    the number of rows, about ``max(r/2, 10 |q|**(1/4))`` plus a third of the digits.

    >>> mathieu_a_enclosure(0, 25, digits=12).contains(mathieu_a_enclosure(0, 25, digits=40))
    True
    """
    return _enclosure(_matrix("a", r), exact_number(q, "q"), _positive(digits))


def mathieu_b_enclosure(r: int, q: Any, digits: int = 15) -> Any:
    r"""A python-flint ball that contains ``b_r(q)``; see `mathieu_a_enclosure`.

    >>> mathieu_b_enclosure(2, 0)
    4.00000000000000
    """
    return _enclosure(_matrix("b", r), exact_number(q, "q"), _positive(digits))


# --- what was asked ---------------------------------------------------------------------------------------------------


def _matrix(name: str, r: Any) -> Matrix:
    r = _integer(r, f"r in {name}_r(q)")
    least = 0 if name == "a" else 1
    if r < least:
        raise BadInputError(f"{name}_r(q) needs an integer r >= {least}, got r = {printed(r)}: r counts the "
                            "zeros of an "
                            f"{'even' if name == 'a' else 'odd'} solution.  Take r = {least} for the lowest.")
    if r % 2:
        return Matrix(name, r, 1, 1 if name == "a" else -1)
    return Matrix(name, r, 0 if name == "a" else 2, 0)


def _integer(value: Any, what: str) -> int:
    if isinstance(value, (bool, str)) or not hasattr(value, "__index__"):
        raise BadTypeError(f"{what} must be an integer, got {printed(value)} of type {type(value).__name__}.  "
                           "Pass an int.")
    return int(operator.index(value))


def _positive(digits: Any) -> int:
    return count_of_digits(_integer(digits, "digits"))


def _is_wide(q: Any) -> bool:
    return isinstance(q, arb) and not q.is_exact()


# --- the answer -------------------------------------------------------------------------------------------------------


def _rounded(name: str, r: Any, q: Any, digits: Any) -> Any:
    """Narrow the ball until both its ends round to one decimal number (Ziv's strategy)."""
    matrix, q, digits = _matrix(name, r), exact_number(q, "q"), _positive(digits)
    if q == 0:
        return mpmath.mp.make_mpf(mpmath.libmp.from_int(matrix.r**2))
    for extra in (4, 40, 400, 4000):
        found = _enclosure(matrix, q, digits + extra)
        nearest, other = (_decimal(end, digits) for end in _ends(found))
        if nearest == other:
            return mpmath.mp.make_mpf(from_rational(*nearest.as_integer_ratio(), dps_to_prec(digits) + 10, "n"))
    known = f"{name}_{matrix.r} lies in {found.str(20)}, which does not fix {digits} digits"
    if _is_wide(q):
        raise BadInputError(f"q is the ball {q!r}; {known}.  Ask for fewer digits, give a narrower q, or take the "
                            f"ball from fastpicard.mathieu.mathieu_{name}_enclosure.")
    raise BadInputError(f"{known}, for q = {q!r}: it cannot be told from a tie.  Change digits by one.")


def _ends(ball: Any) -> tuple[Any, Any]:
    with working(ball.bits() + 64):
        return ball.lower(), ball.upper()


def _decimal(x: Any, digits: int) -> Decimal:
    """The decimal number of ``digits`` significant digits nearest to the exact binary number x."""
    context = Context(prec=digits, rounding=ROUND_HALF_EVEN, Emax=MAX_EMAX, Emin=MIN_EMIN)
    mantissa, exponent = (int(part) for part in x.man_exp())
    top, bottom = mantissa << max(exponent, 0), 1 << max(-exponent, 0)
    return context.divide(Decimal(top), Decimal(bottom))


def _enclosure(matrix: Matrix, parameter: Any, digits: int) -> Any:
    """Raise the working precision until the relative accuracy suffices, or until q's own radius is what limits it."""
    wanted = math.ceil(digits * math.log2(10)) + 2
    with working(64):
        about = ball(parameter)
        if about.is_zero():
            return arb(matrix.r**2)
        guess = float_guess(matrix, about.mid())
    known = wanted + 2
    while known < 8 * wanted + 100_000:
        bits = max(known - guess.exponent, 2)  # narrower than the gap to the next eigenvalue of the same matrix
        with working(known + 64):
            q = ball(parameter)
            middle = q.mid()
            spread = 2 * abs(q - middle).upper()
            found = _certified(guess, middle, bits) + arb(0, spread)
            accurate = found.rel_accuracy_bits()
            if accurate >= wanted or (_is_wide(parameter) and spread > arb((8, -bits))):
                return found
        known += wanted - accurate + 8 if accurate > 0 else known
    raise BadInputError(f"{matrix.name}_{matrix.r}({parameter!r}) cannot be told from 0 with {known // 2} bits, so no "
                        "significant digit is known.  If q is an expression equal to 0, pass 0.")


def _certified(guess: Guess, q: Any, bits: int) -> Any:
    """The ball of radius ``2**-bits`` around a guess, after two counts have proved that it holds the eigenvalue."""
    index = guess.matrix.index
    for guard, slope in ((32, guess.slope), (32, None), (128, None), (512, None), (2048, None)):
        section, scale = guess.section(q, bits + guard)
        with working(bits + scale + guard):
            middle = section.refine(guess.eigenvalue, slope, bits + scale, guard)
            low, high = middle - arb((1, -bits)), middle + arb((1, -bits))
            if section.count_below(low) == index and section.count_below(high) == index + 1:
                return low.union(high)
    raise BadInputError(f"{guess.matrix.name}_{guess.matrix.r}({q.str(20)}) was not isolated to 2**{-bits}.  "
                        "Ask for fewer digits.")
