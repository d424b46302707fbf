"""Short LaTeX of values that are numbers and sentences, as notebooks show them."""

from __future__ import annotations

from typing import Any

import sympy

SPACE = r", \quad "
MEANINGS = {"+1": r"\lambda = 1", "-1": r"\lambda = -1", "collision": r"\lambda_i = \lambda_j"}  # of boundaries
_ESCAPED = str.maketrans({c: rf"\{c}" for c in "#$%&_{}"})


def shown(*parts: str) -> str:
    """Formulas beside each other."""
    return rf"$\displaystyle {SPACE.join(parts)}$"


def sentence(words: str) -> str:
    """Words in a formula."""
    return rf"\text{{{words.translate(_ESCAPED)}}}"


def summary(thing: Any) -> str:
    """What is too long for a formula, as it prints."""
    return shown(sentence(repr(thing).strip("<>")))


def number(x: Any, digits: int = 15) -> str:
    """A real number, rounded to decimal digits."""
    return str(sympy.latex(sympy.Float(x, digits)))


def interval(symbol: Any, lo: Any, hi: Any) -> str:
    """Where a parameter lies."""
    return rf"{sympy.latex(symbol)} \in \left[{number(lo)}, {number(hi)}\right]"


def meaning(label: str, parity: str) -> str:
    """What multipliers and periodic solutions do on a boundary."""
    return MEANINGS[label] + (rf"\; {sentence(f'({parity})')}" if parity else "")
