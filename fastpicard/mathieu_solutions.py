r"""Solutions of Mathieu's equation ``y'' + (a - 2 q cos 2z) y = 0`` and its characteristic exponent, in balls.

The basic solutions (DLMF 28.2(ii)) are the even ``w_I`` with ``w_I(0) = 1, w_I'(0) = 0`` and the odd ``w_II`` with
``w_II(0) = 0, w_II'(0) = 1``: the first row of the fundamental matrix.  Floquet's theorem gives solutions with
``y(z + pi) = exp(i pi nu) y(z)``, and

    cos(pi nu) = w_I(pi; a, q)                                              (DLMF 28.2.16)

fixes the exponent ``nu`` up to its sign and even integers.  Real ``nu`` means bounded solutions; here
``0 <= Re nu <= 1`` and ``Im nu >= 0``.  Half the way is enough: the other half mirrors it, and the Wronskian
``w_I w_II' - w_I' w_II = 1`` leaves, without an inverse that would lose digits where solutions grow,

    w_I(pi) = w_I w_II' + w_I' w_II  at pi/2  =  2 w_I w_II' - 1.
"""

from __future__ import annotations

from typing import Any

from flint import acb, arb, arb_mat
from mpmath.libmp import dps_to_prec

from fastpicard.enclosure import over_time, shortfall, to_digits, transition
from fastpicard.errors import BadInputError
from fastpicard.evaluate import EXTRA_BITS, ball, count_of_digits, to_complex, to_number
from fastpicard.harmonics import Harmonics
from fastpicard.parameters import is_box
from fastpicard.precision import working
from fastpicard.values import exact_number


def mathieu_c(a: Any, q: Any, z: Any, digits: int = 15) -> Any:
    """``w_I(z; a, q)``, the even solution with value 1 at ``z = 0``: an mpf with all ``digits`` right.

    At ``a = mathieu_a(r, q)`` it is periodic, ``ce_r(z, q) / ce_r(0, q)``.  A value that 4096 bits beyond the digits
    cannot tell from 0 is returned as 0, so that ``cos(pi/2)`` is.

    Parameters
    ----------
    a, q, z : real numbers: int, Fraction, float (the dyadic number it is), mpf, SymPy number, arb
    digits : int from 1 up

    Raises
    ------
    BadTypeError
        for text, symbols, complex numbers.
    BadInputError
        for nan and infinities, balls too wide for the digits, and numbers that take more than a million steps.

    Examples
    --------
    >>> import mpmath
    >>> print(mpmath.nstr(mathieu_c(9, 0, 1, 20), 20))      # cos 3z
    -0.98999249660044545727
    """
    return _solution(a, q, z, digits, 0)


def mathieu_s(a: Any, q: Any, z: Any, digits: int = 15) -> Any:
    """``w_II(z; a, q)``, the odd solution with slope 1 at ``z = 0``; see :func:`mathieu_c`.

    At ``a = mathieu_b(r, q)`` it is periodic, ``se_r(z, q) / se_r'(0, q)``.

    Examples
    --------
    >>> import mpmath
    >>> print(mpmath.nstr(mathieu_s(9, 0, 1, 20), 20))      # sin(3z)/3
    0.047040002686622407367
    """
    return _solution(a, q, z, digits, 1)


def mathieu_exponent(a: Any, q: Any, digits: int = 15) -> Any:
    """The characteristic exponent ``nu``, ``cos(pi nu) = w_I(pi; a, q)``: an mpc with all ``digits`` right.

    Of all that have this cosine the one with real part in [0, 1] and no negative imaginary part: real (stable) or with
    real part 0 or 1 (unstable).  Arguments and errors as :func:`mathieu_c`.  At ``q = 0`` it is the distance of
    ``sqrt(a)`` from the nearest even integer, on the boundaries too.

    Raises
    ------
    BadInputError
        also where ``a`` cannot be told from a characteristic number: half the digits of ``w_I`` are lost there.

    Examples
    --------
    >>> import mpmath
    >>> mathieu_exponent(0.25, 0, 12)
    mpc(real='0.5', imag='0.0')
    >>> print(mpmath.nstr(mathieu_exponent(1, 1, 12), 12))  # in the first zone of instability
    (1.0 + 0.453453534347j)
    """
    wanted, numbers = count_of_digits(digits), _numbers(a=a, q=q)
    if ball(numbers["q"]).is_zero() and not is_box(numbers):
        return to_complex(acb(*to_digits(lambda: _free(ball(numbers["a"])), wanted + 2).entries()), wanted)

    def once() -> Any:
        half = transition(_equation(*map(ball, numbers.values())), arb(0), arb.pi() / 2)
        return arb_mat([[2 * half[0, 0] * half[1, 1] - 1, 1]])  # next to 1, as a cosine of 0 has no relative digits

    tried = wanted + 5
    while tried <= 8 * wanted + 200:
        found = to_digits(once, tried, is_box(numbers), strict=False)
        with working(dps_to_prec(tried) + 32):
            nu = _exponent(found[0, 0])
            if nu is not None and _is_known(nu.real, wanted) and _is_known(nu.imag, wanted):
                return to_complex(nu, wanted)
        if shortfall(found, dps_to_prec(tried)) > 0:
            raise BadInputError(f"{wanted} digits of nu cannot be had: at a = {a}, q = {q} its cos(pi nu) lies in "
                                f"{found[0, 0].str(5)}.  Give numbers, narrower balls, or fewer digits.")
        tried *= 2
    raise BadInputError(f"a = {a} cannot be told from a characteristic number at q = {q}: w_I(pi) is +-1 to "
                        f"{tried // 2} digits.  On the boundary nu is 0 or 1.")


def _free(a: Any) -> Any:
    """Real and imaginary part of ``nu`` without a wave, where solutions are ``cos(sqrt(a) z)``."""
    if a < 0:
        return arb_mat([[0, (-a).sqrt()]])
    if not a >= 0:  # not yet told from 0
        return arb_mat([[arb.nan(), 0]])
    root = a.sqrt()
    nearest = ((root.mid() + 1) / 2).mid().floor().unique_fmpz()
    return arb_mat([[abs(root - 2 * nearest), 0]])


def _is_known(x: Any, digits: int) -> bool:
    return bool(x.is_zero() or x.rel_accuracy_bits() > dps_to_prec(digits))


def _exponent(cosine: Any) -> Any:
    """``nu`` from ``cos(pi nu)``, or None at the edges."""
    if abs(cosine) < 1:
        return acb(cosine.acos() / arb.pi())
    if abs(cosine) > 1:
        return acb(0 if cosine > 0 else 1, abs(cosine).acosh() / arb.pi())
    return None


def _solution(a: Any, q: Any, z: Any, digits: Any, column: int) -> Any:
    wanted, numbers = count_of_digits(digits), _numbers(a=a, q=q, z=z)
    least = arb(2) ** -(dps_to_prec(wanted) + EXTRA_BITS)

    def once() -> Any:
        x, y, end = map(ball, numbers.values())
        end = _settled(end, least)
        value = over_time(_equation(x, y), end, arb.pi())[0, column]
        return arb_mat([[_settled(value, least * end.abs_lower())]])  # w_II is like z where z is small

    return to_number(to_digits(once, wanted + 2, is_box(numbers))[0, 0], wanted)


def _settled(x: Any, least: Any) -> Any:
    """0 in place of a ball around 0 with a radius below the least."""
    return arb(0) if x.contains(0) and x.rad() < least else x


def _equation(a: Any, q: Any) -> Harmonics:
    """``(y, y')' = P (y, y')`` in balls."""
    zero = arb(0)
    return Harmonics(2, {(0, 1): [(zero, arb(1), zero)], (1, 0): [(zero, -a, zero), (arb(2), 2 * q, zero)]})


def _numbers(**values: Any) -> dict[str, Any]:
    return {name: exact_number(value, name) for name, value in values.items()}
