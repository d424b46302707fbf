"""What the laws are tried on: series with every kind of frequency, phase and constant; matrices without symmetry."""

from fractions import Fraction

from hypothesis import strategies as st
from sympy import Add, Matrix, Mul, Rational, S, Symbol, cos, pi, sin, sqrt

t, a, b, c, g, l, w, phi, t0 = map(Symbol, ("t", "a", "b", "c", "g", "l", "w", "phi", "t0"))

# Values at which no frequency that is divided by vanishes, and none of 1/(b + c), g/l, ...
VALUES = {
    a: Rational(2, 3),
    b: Rational(-3, 7),
    c: Rational(5, 4),
    g: 3,
    l: Rational(9, 8),
    w: Rational(11, 5),
    phi: Rational(1, 3),
    t0: Rational(-5, 6),
}

rationals = st.builds(Rational, st.integers(-9, 9), st.integers(1, 6))
nonzero_rationals = rationals.filter(bool)
powers = st.integers(0, 4)
plain_frequencies = st.sampled_from([1, 2, 3, -1, -2, 5, Rational(1, 2), Rational(-2, 3), Rational(7, 5)])
other_frequencies = st.sampled_from([sqrt(2), -3 * sqrt(2) / 2, w, -2 * w, w - 1, w + 1, w / 3, pi, 2 * pi / 3, a - w])
frequencies = st.one_of(plain_frequencies, plain_frequencies, other_frequencies)
phases = st.one_of(
    st.just(S.Zero),
    st.sampled_from(
        [
            S.Zero,
            phi,
            -phi,
            phi / 2,
            S.One,
            Rational(-1, 3),
            pi / 2,
            -pi,
            pi / 3,
            phi - pi / 4,
            -2 * t0,
            pi / 5,
            pi / 7,
            2 * pi / 5 - phi,
            3 * pi / 7,
        ]
    ),
)
plain_constants = st.sampled_from([S.One, S.One, a, b, a * b, a**2, 1 / a, b / a**3])
other_constants = st.sampled_from(
    [
        sqrt(2),
        sqrt(6),
        sqrt(5),
        cos(pi / 7),
        pi,
        1 / pi,
        g / l,
        sqrt(g / l),
        cos(t0),
        sin(1),
        (a + b),
        sqrt(a),
        1 / (b + c),
        (a - b) / (b + c),
    ]
)
constants = st.one_of(plain_constants, plain_constants, other_constants)
functions = st.sampled_from([cos, sin])


def modes(coefficients=constants, rates=frequencies, angles=phases):
    """``value * constant * t**r * cos(q t + phase)`` or sin; sometimes a power of t alone."""
    wave = st.builds(lambda f, q, p: f(q * t + p), functions, rates, angles)
    return st.builds(
        lambda value, constant, r, x: Mul(value, constant, t**r, x),
        nonzero_rationals,
        coefficients,
        powers,
        st.one_of(wave, wave, wave, st.just(S.One)),
    )


def sums(terms, most=3):
    """Sums of up to ``most`` terms, zero among them."""
    return st.lists(terms, max_size=most).map(lambda found: Add(*found))


expressions = sums(modes())
plain_expressions = sums(modes(plain_constants, plain_frequencies, st.just(S.Zero)))
short_expressions = sums(modes(), most=2)
single_modes = sums(modes(), most=1)
plain_times = st.sampled_from([Rational(1), Rational(-2, 3), Rational(7, 4), Rational(5)])


# -- plain series and matrices of them, see tests.oracles --------------------------


def plain_series(most_power=1, most=2):
    """Dictionaries ``{(r, q, kind, (i, j)): Fraction}`` with ``q > 0``, or constants."""
    rates = st.sampled_from([Fraction(1), Fraction(2), Fraction(3), Fraction(1, 2), Fraction(2, 3)])
    waves = st.tuples(st.integers(0, most_power), rates, st.sampled_from(["cos", "sin"]))
    key = st.one_of(waves, waves, st.just((0, Fraction(0), "cos")))
    degrees = st.sampled_from([(0, 0), (1, 0), (0, 1), (1, 1)])
    value = st.sampled_from([Fraction(n, d) for n in (-3, -2, -1, 1, 2, 5) for d in (1, 2, 3)])
    return st.dictionaries(st.builds(lambda k, m: (*k, m), key, degrees), value, max_size=most)


def plain_matrices(size, **options):
    """Square lists of plain series; nothing makes them symmetric, even or triangular."""
    row = st.lists(plain_series(**options), min_size=size, max_size=size)
    return st.lists(row, min_size=size, max_size=size)


no_phase = st.just(S.Zero)


def matrices(size=2, rates=plain_frequencies, angles=no_phase, most=1):
    """Matrices of trigonometric polynomials without symmetry, sines as well as cosines."""
    wave = st.builds(lambda f, q, p: f(q * t + p), functions, rates, angles)
    factors = st.one_of(wave, wave, st.just(S.One))
    term = st.builds(Mul, nonzero_rationals, st.sampled_from([S.One, a, b]), factors)
    entry = st.lists(term, max_size=most).map(lambda found: Add(*found))
    return st.lists(entry, min_size=size * size, max_size=size * size).map(lambda flat: Matrix(size, size, flat))


small_integers = st.integers(-3, 3)
vectors = st.lists(st.sampled_from([S.Zero, S.One, Rational(-2, 3), a, sqrt(2)]), min_size=2, max_size=2)
