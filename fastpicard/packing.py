"""Balls as integers and back, for pickling: python-flint's numbers cannot be pickled."""

from __future__ import annotations

from typing import Any

import flint

__all__ = ["packed", "unpacked"]


def packed(*balls: Any) -> tuple[tuple[int, ...], ...]:
    """Mantissa and exponent of the middle and of the radius, for finite real balls."""
    return tuple(tuple(int(part) for half in (x.mid(), x.rad()) for part in half.man_exp()) for x in balls)


def unpacked(numbers: tuple[tuple[int, ...], ...]) -> list[Any]:
    """The balls again: the middles exactly, the radii rounded up in their ninth digit."""
    return [flint.arb(flint.arf((m, e)), flint.arf((r, s))) for m, e, r, s in numbers]
