r"""Where two boundaries cross: solutions of both kinds coexist, and a pocket of instability closes.

Newton's operator in balls, ``N(X) = c - J(X)**-1 (f, g)(c)``, J the Jacobian of two boundary functions f, g on a box X
around c: if it maps X into its own interior, f and g have exactly one common zero in X, and it lies in ``N(X)``.
"""

from __future__ import annotations

from typing import Any

from flint import arb, arb_mat, fmpq
from sympy import Symbol

from fastpicard.axes import fixed_numbers, point_of, refuse_integer
from fastpicard.boundaries import Boundary
from fastpicard.curves import exact_ball, resolved
from fastpicard.errors import BadInputError, BadTypeError
from fastpicard.evaluate import Point
from fastpicard.harmonics import Harmonics
from fastpicard.precision import working
from fastpicard.remainder import a_priori
from fastpicard.ring import Monomial, expression_of, symbols_of
from fastpicard.values import Values, exact_values

EXPONENTS = (-60, -48, -36, -24)  # of 2: half the sides of the boxes that are tried


def crossing(f: Boundary, g: Boundary, x: Symbol, y: Symbol, start: tuple[Any, Any],
             fixed: Values | None = None) -> dict[Symbol, Any]:
    """Where two boundaries cross: balls in which the true curves have exactly one common point.

    Where ``+1`` even and odd cross, or ``-1`` even and odd, both periodic solutions coexist: the unstable pocket
    between them closes.

    Parameters
    ----------
    f, g : Boundary
    x, y : Symbol
    start : (x, y)          near the crossing; what Newton's method leads to from there may be another one
    fixed : {Symbol: number}

    Returns
    -------
    {x: arb, y: arb}

    Raises
    ------
    BadInputError
        if Newton's method does not lead to a crossing that can be proved; if ``fixed`` is not as described.
    BadTypeError
        if f and g are no boundaries, x and y not two Symbols, ``start`` no pair of numbers.

    Notes
    -----
    Newton's operator in balls, ``N = c - J(X)**-1 (f, g)(c)``: if it maps the box X into itself there is one zero in
    it.  The remainders of the iterates of f and of g are in both, over the time that each takes; those of J by Cauchy,
    from complex parameters within 1, or half the way to a pole.

    Examples
    --------
    >>> from sympy import Matrix, cos
    >>> from sympy.abc import a, b, t
    >>> from fastpicard import FloquetMatrix, boundaries
    >>> F = FloquetMatrix(Matrix([[0, 1], [-a - b*cos(t) - cos(2*t), 0]]), t, 40)
    >>> even, odd = boundaries(F)[:2]
    >>> found = crossing(even, odd, a, b, (1.25, 1.4))
    >>> print(round(float(found[a]), 6), round(float(found[b]) ** 2, 6))
    1.253463 2.0
    """
    if not isinstance(f, Boundary) or not isinstance(g, Boundary):
        raise BadTypeError(f"two boundaries cross, but they are {f!r} and {g!r}.  Take two of boundaries(F).")
    if not isinstance(x, Symbol) or not isinstance(y, Symbol) or x == y:
        raise BadTypeError(f"curves cross in a plane of two Symbols, but they are {x!r} and {y!r}.  Use "
                           "crossing(f, g, a, b, (0, 1)), say.")
    for name in (x, y):
        refuse_integer(name)
    names = (x, y)
    exact = exact_values(fixed_numbers(fixed, names), (f.parameters | g.parameters) - {x, y}, f._F.t)
    with working(192):
        center = [exact_ball(z) for z in point_of(start)]
        for part in (f, g):  # as many bits as cancel in them
            resolved(lambda *at, part=part: part._dual({**exact, **dict(zip(names, at, strict=True))}, names), center,
                     [1, 1], arb(2) ** -120)
        for _ in range(40):
            value, slope = _both(f, g, names, {**exact, **dict(zip(names, center, strict=True))}, (None, None))
            move = slope.solve(value) if slope.det() != 0 else None
            if move is None:
                break
            center = [(c - move[k, 0]).mid() for k, c in enumerate(center)]
            if all(abs(move[k, 0]) < arb(2) ** -120 for k in (0, 1)):
                break
        values = {**exact, **dict(zip(names, center, strict=True))}
        radius = min(_radius(part, values, names) for part in (f, g))
        exponents = [e for e in EXPONENTS if arb(2) ** e <= radius / 4]
        reach = radius + arb(2) ** max(exponents, default=EXPONENTS[0])
        slacks = [_wide_remainder(part, values, names, reach) / radius for part in (f, g)]
        value, _ = _both(f, g, names, values, slacks)
        for exponent in exponents:
            box = [c + arb(0, arb(2) ** exponent) for c in center]
            _, slope = _both(f, g, names, {**exact, **dict(zip(names, box, strict=True))}, slacks)
            try:
                step = slope.solve(value)
            except ZeroDivisionError:
                continue
            image = [c - step[k, 0] for k, c in enumerate(center)]
            if all(z.contains_interior(w) for z, w in zip(box, image, strict=True)):
                return dict(zip(names, image, strict=True))
    raise BadInputError(f"the curves must cross near {start}, but no crossing is proved there.  Start nearer, or take "
                        "a FloquetMatrix of higher order.")


def _both(f: Boundary, g: Boundary, names: tuple[Symbol, Symbol], values: dict[Any, Any], slacks: Any) -> Any:
    """Values and Jacobian of two functions; with ``slacks``, the remainders of their entries, of the true ones."""
    rows = [part._dual(values, names, None if slack is None else [slack] * (len(part._entries) * part._columns))
            for part, slack in zip((f, g), slacks, strict=True)]
    return arb_mat([[row[0]] for row in rows]), arb_mat([row[1:] for row in rows])


def _radius(part: Boundary, values: dict[Any, Any], names: tuple[Symbol, Symbol]) -> Any:
    """How far parameters may be complex around the boxes that are tried: 1, or less where a pole is near."""
    F = part._F
    if symbols_of(F.length) & set(names):
        raise BadInputError(f"curves cross where the period is one for all parameters, but it is {F.period}.  Measure "
                            "time in units of it.")
    powers = {(expression_of(g), e) for row in F.P.rows for modes in row for _, angle, own in modes
              for m in (own, *dict(angle[0]), *dict(angle[1])) for g, e in m}
    sizes = {s: abs(exact_ball(values[s])) for s in names}
    radius = min([arb(1), *((sizes[s] / 2).mid() for s, e in powers if s in names and (e < 0 or e != int(e)))])
    if not radius > 0:
        raise BadInputError(f"P must be smooth where curves cross, but it has a pole or a root at "
                            f"{ {s: str(values[s]) for s in names} }.  Start elsewhere.")
    return radius


def _wide_remainder(part: Boundary, values: dict[Any, Any], names: tuple[Symbol, Symbol], reach: Any) -> Any:
    """The remainder of a function for complex parameters as far away; derivatives follow by Cauchy's inequality."""
    F, point = part._F, Point(arb(0), values)
    wide = {s: abs(exact_ball(values[s])) + arb(0, reach) for s in names}
    period = F.at(values)[1] / (2 if part._half else 1)
    waves = {(i, j): [(arb(0), sum((_largest(mode, f, point, wide, period) for mode, f in modes.items()), arb(0)),
                       arb(0))]
             for i, row in enumerate(F.P.rows) for j, modes in enumerate(row) if modes}
    bound = a_priori(Harmonics(F.shape[0], waves), period, F.n)
    return max((entry.upper() for entry in bound.entries()), default=arb(0))


def _largest(mode: Any, f: Any, point: Point, wide: dict[Symbol, Any], period: Any) -> Any:
    """How large a mode of ``P`` is for complex parameters whose absolute values, and their changes, lie in the balls.

    ``|cos z| <= exp |Im z|``, and an angle is real at the middle.
    """
    _, (frequency, phase), monomial = mode
    turned = sum((abs(arb(fmpq(c.numerator, c.denominator))) * _change(m, point, wide) * time
                  for form, time in ((frequency, period), (phase, arb(1))) for m, c in form), arb(0))
    return abs(arb(f[0])) * _size(monomial, point, wide) * turned.exp()


def _change(monomial: Monomial, point: Point, wide: dict[Symbol, Any]) -> Any:
    """``|m(z) - m(center)|``: the difference of absolute values where no exponent is negative or broken."""
    exponents = [e for g, e in monomial if expression_of(g) in wide]
    if not exponents:
        return arb(0)
    here, there = abs(point.monomial(monomial)), _size(monomial, point, wide)
    return there - here if all(e > 0 and e == int(e) for e in exponents) else there + here


def _size(monomial: Monomial, point: Point, wide: dict[Symbol, Any]) -> Any:
    size = arb(1)
    for g, e in monomial:
        s = expression_of(g)
        if s in wide:
            end = (wide[s].upper() if e > 0 else wide[s].lower())
            size = size * (end ** int(e) if e == int(e) else (end.log() * fmpq(e.numerator, e.denominator)).exp())
        else:
            size = size * abs(point.monomial(((g, e),)))
    return size


__all__ = ["crossing"]
