"""The article's section 5: Lagrangians, equations of motion and stability of one rod and of two, Out[22]-[56]."""

from itertools import pairwise
from math import ceil, log2

import mpmath
import numpy
from sympy import Function, Matrix, Rational, cos, expand, pi, sin, sqrt, symbols

from fastpicard import FloquetMatrix, mathieu_a
from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes

epsilon, g, h, l, m, omega0, t, v = symbols("epsilon g h l m omega0 t v")
xi, eta = Function("xi")(t), Function("eta")(t)

COSINE = Support(eta=epsilon * cos(omega0 * t))
INERTIA = Matrix([[Rational(4, 3), Rational(1, 2)], [Rational(1, 2), Rational(1, 3)]])
WEIGHT = Matrix([[Rational(3, 2), 0], [0, Rational(1, 2)]])


def rods(number, support):
    """The equations of motion of equal uniform rods, upright."""
    return euler_lagrange(Scene([Rod.uniform(m, l)] * number, support))


def two_linear_rods(support):
    """Two equal uniform rods, linearised and divided by ``m l**2``, as in In[36]."""
    return linearize(rods(2, support)).divided()


def printed(number):
    """A number as Mathematica prints it: six significant digits, no zeros at the end."""
    return f"{float(number):.6g}"


def test_out_22():
    """The Lagrangian of one rod, with the moment of inertia m R^2 of In[16] and not the m R^2/2 of the prose."""
    m1, l1, H1, R1 = symbols("m1 l1 H1 R1")
    scene = Scene([Rod(m1, l1, H1, R1)], Support(xi, eta))
    theta = scene.coordinates[0]
    out_22 = (-g * cos(theta) * H1 * m1
              + m1 * (eta.diff(t)**2 + xi.diff(t)**2) / 2 + m1 * R1**2 * theta.diff(t)**2 / 2
              + H1 * m1 * (-l1 * sin(theta) * eta.diff(t) * theta.diff(t)
                           + cos(theta) * l1 * xi.diff(t) * theta.diff(t)) / l1)
    assert expand(scene.lagrangian - out_22) == 0


def test_out_24():
    """The equation of motion of the uniform driven rod; In[23] means the derivative with respect to theta'."""
    equations = rods(1, COSINE)
    theta = equations.coordinates[0]
    out_24 = l * m * (-3*g*sin(theta) + 3*epsilon*cos(t*omega0)*sin(theta)*omega0**2 + 2*l*theta.diff(t, 2)) / 6
    assert expand(equations.lhs[0] - out_24) == 0


def test_out_25():
    """The same linearised and divided by m l^2/3, which is what In[25] means."""
    linear = linearize(rods(1, COSINE)).divided(m * l**2 / 3)
    assert linear.A[0] == 1
    assert expand(linear.stiffness[0] - (-3*g/(2*l) + 3*epsilon*cos(t*omega0)*omega0**2/(2*l))) == 0
    assert linear.remainder[0] == 0 and linear.damping[0] == 0


def test_out_32():
    """The equations of motion of two rods, with H = l/2, R = l/sqrt(3) and the prefactor l m/6 (printed: m/6)."""
    equations = rods(2, Support(xi, eta))
    one, two = equations.coordinates
    out_32 = [
        l * m * (-9*g*sin(one) + 3*l*sin(one - two)*two.diff(t)**2 - 9*sin(one)*eta.diff(t, 2)
                 + 9*cos(one)*xi.diff(t, 2) + 8*l*one.diff(t, 2) + 3*l*cos(one - two)*two.diff(t, 2)) / 6,
        l * m * (-3*g*sin(two) - 3*l*sin(one - two)*one.diff(t)**2 - 3*sin(two)*eta.diff(t, 2)
                 + 3*cos(two)*xi.diff(t, 2) + 3*l*cos(one - two)*one.diff(t, 2) + 2*l*two.diff(t, 2)) / 6,
    ]
    even_cosine = {cos(two - one): cos(one - two), sin(two - one): -sin(one - two)}
    for found, expected in zip(equations.lhs, out_32, strict=True):
        assert expand((found - expected).xreplace(even_cosine)) == 0


def test_out_36():
    """The linearised left-hand sides of two rods, divided by m l^2."""
    linear = two_linear_rods(Support(xi, eta))
    one, two = linear.coordinates
    out_36 = [
        (-3*g*l*m*one/2 - 3*l*m*one*eta.diff(t, 2)/2 + 3*l*m*xi.diff(t, 2)/2
         + 4*l**2*m*one.diff(t, 2)/3 + l**2*m*two.diff(t, 2)/2) / (l**2*m),
        (-g*l*m*two/2 - l*m*two*eta.diff(t, 2)/2 + l*m*xi.diff(t, 2)/2
         + l**2*m*one.diff(t, 2)/2 + l**2*m*two.diff(t, 2)/3) / (l**2*m),
    ]
    theta = Matrix([one, two])
    left = linear.A * theta.diff(t, 2) + linear.stiffness * theta + linear.remainder
    assert linear.damping == Matrix.zeros(2)
    for found, expected in zip(left, out_36, strict=True):
        assert expand(found - expected) == 0


def test_out_38():
    """The matrix A."""
    assert two_linear_rods(Support(xi, eta)).A == INERTIA


def test_out_39():
    """The coefficient of theta: weight and vertical acceleration of the support."""
    pull = -(g + eta.diff(t, 2)) / l
    assert (two_linear_rods(Support(xi, eta)).stiffness - pull * WEIGHT).applyfunc(expand) == Matrix.zeros(2)


def test_out_40():
    """What remains is the horizontal driving, and nothing remains without it."""
    push = xi.diff(t, 2) / l
    found = two_linear_rods(Support(xi, eta)).remainder
    assert (found - Matrix([3 * push / 2, push / 2])).applyfunc(expand) == Matrix([0, 0])
    assert two_linear_rods(Support(0, eta)).remainder == Matrix([0, 0])


def test_out_41():
    """The coefficient of theta when the support is driven by epsilon cos(omega0 t)."""
    wave = epsilon * cos(t*omega0) * omega0**2
    out_41 = Matrix([[-3*g/(2*l) + 3*wave/(2*l), 0], [0, -g/(2*l) + wave/(2*l)]])
    assert (two_linear_rods(COSINE).stiffness - out_41).applyfunc(expand) == Matrix.zeros(2)


def test_out_42():
    """The matrix B: the same divided by -g/l + (epsilon/l) omega0^2 cos(omega0 t), where In[42] prints tau for t."""
    modes = normal_modes(two_linear_rods(COSINE))
    assert modes.B == WEIGHT
    assert expand(modes.time_factor - (-g/l + epsilon * cos(omega0*t) * omega0**2 / l)) == 0


def test_out_43():
    """A^-1 B, with its eigenvalues; the matrix U is A-orthogonal and not, as the article has it, orthogonal."""
    modes = normal_modes(two_linear_rods(COSINE))
    found = modes.A.inv() * modes.B
    assert found == Matrix([[Rational(18, 7), Rational(-9, 7)], [Rational(-27, 7), Rational(24, 7)]])
    assert modes.mu == (3 - 6*sqrt(7)/7, 3 + 6*sqrt(7)/7)
    U = modes.U
    for column, mu in enumerate(modes.mu):
        assert (found * U[:, column] - mu * U[:, column]).applyfunc(expand) == Matrix([0, 0])
    assert expand((U.T * modes.A * U)[0, 1]) == 0
    assert expand((U.T * U)[0, 1]) == Rational(2, 3)


def test_matrix_p_of_the_double_rod():
    """P(tau) as printed after Out[43], in the symbols of the scene and in h = epsilon/l, v = omega0 sqrt(l/g)."""
    for dimensionless, a, b in ((False, -g/(omega0**2*l), epsilon/l), (True, -1/v**2, h)):
        P, tau, period = linearize(rods(2, COSINE)).first_order(omega0, dimensionless)
        wave = a + b * cos(tau)
        expected = Matrix([[0, 0, 1, 0], [0, 0, 0, 1],
                           [-18*wave/7, 9*wave/7, 0, 0], [27*wave/7, -24*wave/7, 0, 0]])
        assert (P - expected).applyfunc(expand) == Matrix.zeros(4)
        assert period == 2 * pi


# In[44] to In[56]: the stability boundary of two rods.

H_GRID = [Rational(k, 100) for k in range(11)]
V_GRID = [Rational(1, 10) + 10 * k for k in range(10)]


def floquet_of_two_rods():
    """In[44] and In[45]: twenty iterates, in h and v."""
    P, tau, period = linearize(rods(2, COSINE)).first_order(omega0)
    return FloquetMatrix(P, tau, 20, period)


def chop(x):
    """Mathematica's Chop: what is below 1e-10 is 0."""
    return 0 if abs(x) < 1e-10 else x


def stability_changes(first, second):
    """In[47], for two pairs ((h, v), largest modulus)."""
    one, two = chop(first[1] - 1), chop(second[1] - 1)
    return (one == 0 and two > 0) or (two == 0 and one > 0)


def grid(floquet):
    """In[46]: the largest modulus on the grid, one line for each h."""
    xs, ys = numpy.meshgrid(numpy.array(H_GRID, float), numpy.array(V_GRID, float), indexing="ij")
    largest = abs(numpy.linalg.eigvals(floquet.lambdify([h, v])(xs, ys))).max(axis=-1)
    return [[((x, y), largest[i, k]) for k, y in enumerate(V_GRID)] for i, x in enumerate(H_GRID)]


def changing_pairs(lines):
    """In[48], and In[52] for the transposed grid: neighbours on a line between which stability changes."""
    return [pair for line in lines for pair in pairwise(line) if stability_changes(*pair)]


def bisected(floquet, pair, tolerance):
    """In[49] and In[50]: the place on the way from one point to the other where stability changes."""
    first, second = pair
    length = max(abs(x - y) for x, y in zip(first[0], second[0], strict=True))
    for _ in range(max(1, ceil(log2(length / tolerance)))):
        middle = midpoint(first, second)
        found = (middle, abs(floquet.multipliers(dict(zip((h, v), middle, strict=True)), digits=20)[0]))
        first, second = (first, found) if stability_changes(first, found) else (found, second)
    return midpoint(first, second)


def midpoint(first, second):
    """Halfway between two points of the plane."""
    return tuple((x + y) / 2 for x, y in zip(first[0], second[0], strict=True))


def test_out_48():
    """Nine pairs of the grid enclose the boundary, the first two and the last with the moduli printed.

    The six moduli that the article leaves out are those of a computation through normal modes, in 70 digits.
    """
    pairs = [[(printed(x), printed(y), printed(largest)) for (x, y), largest in pair]
             for pair in changing_pairs(grid(floquet_of_two_rods()))]
    assert pairs == [
        [("0.02", "80.1", "1.01665"), ("0.02", "90.1", "1")],
        [("0.03", "50.1", "1.04569"), ("0.03", "60.1", "1")],
        [("0.04", "40.1", "1.03297"), ("0.04", "50.1", "1")],
        [("0.05", "30.1", "1.07682"), ("0.05", "40.1", "1")],
        [("0.06", "20.1", "1.20122"), ("0.06", "30.1", "1")],
        [("0.07", "20.1", "1.15132"), ("0.07", "30.1", "1")],
        [("0.08", "20.1", "1.06484"), ("0.08", "30.1", "1")],
        [("0.09", "10.1", "1.56307"), ("0.09", "20.1", "1")],
        [("0.09", "20.1", "1"), ("0.09", "30.1", "1.53615")],
    ]


def test_in_51_to_54():
    """All points of the last figure lie on the curves of the two modes: both ways lead to one picture.

    Within the tolerance of the bisection on either side of every point, In[51] along v and In[52] along h, the
    trace of one mode passes 2 or -2.
    """
    floquet, lines = floquet_of_two_rods(), grid(floquet_of_two_rods())
    mathieu = FloquetMatrix(Matrix([[0, 1], [-epsilon - g * cos(t), 0]]), t, 40).lambdify_trace([epsilon, g])
    mus = [float(mu) for mu in normal_modes(two_linear_rods(COSINE)).mu]

    def stable_modes(x, y):
        return [abs(mathieu(-mu / y**2, mu * x)) < 2 for mu in mus]

    vertical = [bisected(floquet, pair, Rational(1, 10)) for pair in changing_pairs(lines)]
    horizontal = [bisected(floquet, pair, Rational(1, 10000)) for pair in changing_pairs(zip(*lines, strict=True))]
    assert (len(vertical), len(horizontal)) == (9, 16)
    for x, y in vertical:
        assert stable_modes(float(x), float(y) - 0.1) != stable_modes(float(x), float(y) + 0.1)
    for x, y in horizontal:
        assert stable_modes(float(x) - 1e-4, float(y)) != stable_modes(float(x) + 1e-4, float(y))


def test_out_55():
    """The fifth boundary point by seven halvings is (0.06, 27.5609375), printed as 27.5609."""
    floquet = floquet_of_two_rods()
    x, y = bisected(floquet, changing_pairs(grid(floquet))[4], Rational(1, 10))
    assert (x, y) == (Rational(6, 100), Rational("27.5609375"))
    assert [printed(x), printed(y)] == ["0.06", "27.5609"]


def test_out_56():
    """The same point from a characteristic number of the slower mode, a = -mu/v^2 and b = mu h."""
    mu = normal_modes(two_linear_rods(COSINE)).mu[0]
    edge = mathieu_a(0, -2 * mu * Rational(6, 100), digits=30)
    with mpmath.workdps(30):
        y = mpmath.sqrt(-mpmath.mpf(mu.evalf(35)) / (edge / 4))
        assert abs(y - mpmath.mpf("27.556756338772449091547030263")) < 1e-25
    assert printed(y) == "27.5568"
