"""One instruction that NumPy and Python have no word for: memory is asked for a number before it is needed.

Processors guess what is read next where addresses go on and on; rows of a matrix that are read in pieces, from the
last to the first, they do not guess, and wait at every piece.

Importing this file imports numba; :mod:`lagrangian.machine` does so where it is installed, and when it is used.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

__all__ = ["prefetch"]

READ, KEEP, DATA = 0, 3, 1  # what LLVM's prefetch asks: for reading, into the nearest cache, no instructions


@intrinsic
def prefetch(typing: Any, rows: Any, k: Any, j: Any) -> Any:
    """Ask memory for the line of ``rows[k, j]``, whose indices are in range."""
    def instruction(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = context.make_array(rows)(context, builder, arguments[0])
        place = cgutils.get_item_pointer(context, builder, rows, array, arguments[1:], wraparound=False)
        place, number = builder.bitcast(place, cgutils.voidptr_t), cgutils.int32_t
        kind = cgutils.ir.FunctionType(cgutils.ir.VoidType(), [place.type, number, number, number])
        function = builder.module.declare_intrinsic("llvm.prefetch", [place.type], kind)
        builder.call(function, [place, number(READ), number(KEEP), number(DATA)])
        return context.get_dummy_value()
    return types.none(rows, types.intp, types.intp), instruction
