"""What notebooks show: LaTeX of every public class, short."""

import inspect
import re

import pytest
from sympy import Matrix, Symbol, cos, exp, symbols

import fastpicard
from fastpicard import (
    FloquetMatrix,
    FundamentalMatrix,
    PoissonSeries,
    Root,
    Verdict,
    boundaries,
    certify,
    fast_picard,
    tubes,
)
from fastpicard.latex import sentence

t, a, b = symbols("t a b")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])


@pytest.fixture(scope="module")
def things():
    """One value of every public class, and some of another look."""
    F = FloquetMatrix(P, t, 12)
    curve = boundaries(F)[0]
    walls = tubes(F, (a, -0.5, 1.5), (b, 0, 1))
    values = {a: 1.3, b: 0.2}
    return [F, FundamentalMatrix(P, t, 2), fast_picard(P, t, [1, 0], 3), PoissonSeries(cos(t), t),
            FundamentalMatrix(P, t, 2).series, curve, curve.root(a, (-0.4, 0.4), {b: 0.5}), F.verdict(values),
            *F.multiplier_enclosures(values), certify(F, (a, 0.3, 0.9), (b, 0, 0.4)), walls, walls.pieces[0]]


def test_every_public_class_has_latex(things):
    """No class of values is left out; braces match, and nothing is longer than a person reads."""
    classes = {c for c in vars(fastpicard).values()
               if inspect.isclass(c) and c.__name__ in fastpicard.__all__ and not issubclass(c, Exception)}
    assert classes == {type(thing) for thing in things}
    for thing in things:
        latex = thing._repr_latex_()
        assert latex.startswith(r"$\displaystyle ") and latex.endswith("$") and len(latex) < 1000
        assert latex.count("{") == latex.count("}") and latex.count(r"\left") == latex.count(r"\right")


def shown(things, kind):
    """The LaTeX of the first of its kind, without the frame."""
    thing = next(thing for thing in things if type(thing).__name__ == kind)
    return thing._repr_latex_().removeprefix(r"$\displaystyle ").removesuffix("$")


def test_numbers_come_with_their_errors(things):
    """Multipliers, roots and tubes; a root that is not proved says so."""
    multiplier = shown(things, "Multiplier")
    assert multiplier.startswith(r"\lambda = 0.64685120916674")
    assert re.search(r" i \\pm \d\.\d \\cdot 10\^\{-\d\d\}, \\quad \\left\|\\lambda\\right\| = 1$", multiplier)
    assert r" \pm " in shown(things, "Root")
    assert Root(0.5, float("inf"), 3, {})._repr_latex_() == r"$\displaystyle 0.5 \text{, not proved}$"
    assert r"\left|a - g_k(b)\right| \le" in shown(things, "Tubes")
    assert r"b \in \left[0.0, " in shown(things, "Tube")


def test_curves_and_charts_say_of_what(things):
    """Which multiplier, which parameters, which part of the area."""
    assert shown(things, "Boundary") == (r"\lambda = 1\; \text{(even)}, \quad \text{a polynomial in}\; a, b, "
                                         r"\quad \text{order 12}")
    assert shown(things, "CertifiedChart").startswith(r"a \in \left[0.3, 0.9\right], \quad b \in \left[0.0, 0.4\right]")


def test_words_are_safe_in_latex():
    """Signs that LaTeX takes as commands."""
    assert sentence("50% of a_1 & {b}") == r"\text{50\% of a\_1 \& \{b\}}"
    assert Verdict("UNSTABLE", "x_1 > 1")._repr_latex_() == r"$\displaystyle \text{UNSTABLE: x\_1 > 1}$"
    long = PoissonSeries(sum(exp(Symbol("u_1")) * cos(k * t) for k in range(200)), t)
    assert long._repr_latex_() == r"$\displaystyle \text{Poisson series in t with 200 terms}$"
