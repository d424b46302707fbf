"""Signed blocks of bits inside one large integer: the digits of a Kronecker substitution."""

from __future__ import annotations

from typing import Any

from flint import fmpz


class Blocks:
    """Cuts packed integers into their signed blocks, lowest first, by halving."""

    def __init__(self, bits: int) -> None:
        self.bits = bits
        self.half = fmpz(1) << (bits - 1)
        self.bias = [fmpz(0)]
        self.mask = [fmpz(0)]

    def of(self, value: Any) -> list[Any]:
        """The blocks of one packed integer; every block is smaller than ``2**(bits - 1)``."""
        if not value:
            return []
        count = abs(value).bit_length() // self.bits + 1
        while len(self.bias) <= count:
            self.bias.append((self.bias[-1] << self.bits) + self.half)
            self.mask.append((fmpz(1) << (self.bits * len(self.mask))) - 1)
        blocks: list[Any] = []
        self._cut(value + self.bias[count], count, blocks)
        return blocks

    def _cut(self, value: Any, count: int, blocks: list[Any]) -> None:
        if count == 1:
            blocks.append(value - self.half)
            return
        lower = count // 2
        self._cut(value & self.mask[lower], lower, blocks)
        self._cut(value >> (self.bits * lower), count - lower, blocks)
