r"""Double-double arithmetic: a number as the unevaluated sum ``h + l`` of two floats, some 31 decimal digits.

``l`` is at most half a unit in the last place of ``h``.  With ``u = 2**-53``, without over- and underflow:

    x + y   |error| <= 3 u**2/(1 - 4u) |x + y|, whatever the signs
    x y     |error| <= 7 u**2 |x y|
    x/y     |error| <= (12 u**2 + O(u**3)) |x/y|

The first two are algorithms 6 and 10 of Joldes, Muller, Popescu, *Tight and rigorous error bounds for basic building
blocks of double-word arithmetic* (ACM TOMS 44, 2017).  The bound of the sum is what keeps differences right; the
"sloppy" sum, half as long, has none.  For the quotient let ``q = fl(xh/yh)``: the remainder ``xh - q yh`` is a float
of at most ``u |x|``, found without rounding; ``xl - q yl`` costs ``3 u**2 |x|``, adding both, at most ``3u |x|``,
another 3, dividing by yh in place of y 3, and rounding that 3 more.

The sums of a convolution need less.  Keeping the high parts' sum exactly as ``X + sum of remainders``, and everything
small in one float (Ogita, Rump, Oishi, *Accurate sum and dot product*, 2005), their error is about
``count**2 u**2 sum |terms|``, in half the operations.

The functions are plain Python of floats.  They must be run as written, neither contracted nor reordered.
:mod:`lagrangian.pairtype` makes them the operators of a number type of numba.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .angles import product
from .machine import inlined
from .stepper import total

__all__ = ["added", "divided", "multiplied", "normal", "subtracted", "summed", "to_pairs"]


@inlined
def normal(h: Any, l: Any) -> tuple[Any, Any]:
    """``h + l`` as the nearest float and the exact remainder, for ``|l| <= |h|``."""
    s = h + l
    return s, l - (s - h)


@inlined
def added(xh: Any, xl: Any, yh: Any, yl: Any) -> tuple[Any, Any]:
    """``x + y``."""
    s, e = total(xh, yh)
    t, f = total(xl, yl)
    s, e = normal(s, e + t)
    return normal(s, e + f)


@inlined
def subtracted(xh: Any, xl: Any, yh: Any, yl: Any) -> tuple[Any, Any]:
    """``x - y``."""
    return added(xh, xl, -yh, -yl)


@inlined
def multiplied(xh: Any, xl: Any, yh: Any, yl: Any) -> tuple[Any, Any]:
    """``x y``."""
    p, e = product(xh, yh)
    return normal(p, e + (xh * yl + xl * yh))


@inlined
def divided(xh: Any, xl: Any, yh: Any, yl: Any) -> tuple[Any, Any]:
    """``x/y``."""
    q = xh / yh
    p, e = product(q, yh)
    return normal(q, (((xh - p) - e) + (xl - q * yl)) / yh)


@inlined
def summed(sh: Any, sl: Any, xh: Any, xl: Any, yh: Any, yl: Any) -> tuple[Any, Any]:
    """``s + x y``, with ``sl`` anything small; :func:`normal` makes a pair of the last sum."""
    p, e = product(xh, yh)
    sh, f = total(sh, p)
    return sh, sl + ((e + f) + (xh * yl + xl * yh))


def to_pairs(numbers: Any) -> Any:
    """Balls or mpmath numbers as pairs, the high half real and the low half imaginary; complex128 of the same shape."""
    flat = np.asarray(numbers, dtype=object)
    high = flat.astype(float)
    return high + 1j * (flat - high).astype(float)
