"""Laws that hold for every chain, on random rational chains and states, with exact equality."""

from hypothesis import given, settings, strategies as st
from sympy import Add, Derivative, Function, Integer, Matrix, Rational, cos, cosh, expand, pi, sin, symbols

from lagrangian import Rod, Scene, Support, euler_lagrange, linearize, normal_modes

t = symbols("t")
# Each example derives equations anew, a tenth of a second: at most 200 of them in any profile.
measured = settings(max_examples=min(200, settings.default.max_examples), deadline=None)
fractions = st.builds(Rational, st.integers(-20, 20), st.integers(1, 9))
positive = st.builds(Rational, st.integers(1, 20), st.integers(1, 9))


@st.composite
def any_rods(draw):
    """A rod with every quantity rational, its centre on either side of the joint."""
    length, center = draw(positive), draw(fractions)
    return Rod(draw(positive), length, center, abs(center) + draw(positive))


@st.composite
def scenes(draw, moving=True, lossless=False, max_size=3, joints=True):
    """Chains with any support motion, convention, gravity, dampers and springs."""
    rods = draw(st.lists(any_rods(), min_size=1, max_size=max_size))
    n = len(rods)
    drives = st.sampled_from([Integer(0), t**2 / 3, t**3 - t, cos(2 * t), sin(t) / 2]) if moving else st.just(0)
    constants = st.none() | st.lists(positive, min_size=n, max_size=n) if joints else st.none()
    return Scene(rods, Support(draw(drives), draw(drives)), draw(fractions), draw(st.booleans()),
                 None if lossless else draw(constants), draw(constants), t)


def at(expression, scene, halves, rates):
    """``expression`` at angles ``2 arctan(u)`` and rates, as an exact rational in the other symbols."""
    sines = [2 * u / (1 + u**2) for u in halves]
    cosines = [(1 - u**2) / (1 + u**2) for u in halves]
    waves = {}
    for i, x in enumerate(scene.coordinates):
        waves |= {sin(x): sines[i], cos(x): cosines[i]}
        for j, y in enumerate(scene.coordinates):
            waves |= {cos(x - y): cosines[i] * cosines[j] + sines[i] * sines[j],
                      sin(x - y): sines[i] * cosines[j] - cosines[i] * sines[j]}
    return expression.xreplace(waves | dict(zip(scene.velocities, rates)))


def state(n):
    """Half-angle tangents and rates for n rods."""
    return st.tuples(*(st.lists(fractions, min_size=n, max_size=n) for _ in range(2)))


class Plain:
    """A scene's angles and rates as plain Symbols q, w, which SymPy differentiates ten times as fast as functions."""

    def __init__(self, scene):
        n = len(scene)
        self.q, self.w = symbols(f"q:{n}"), symbols(f"w:{n}")
        self.accelerations = [Derivative(x, (t, 2)) for x in scene.coordinates]
        self.angles, self.rates = dict(zip(scene.coordinates, self.q)), dict(zip(scene.velocities, self.w))
        self.names = {name: x for names in (self.angles, self.rates) for x, name in names.items()}

    def plain(self, expression):
        """Of functions of t, in Symbols."""
        return expression.xreplace(self.rates).xreplace(self.angles)

    def again(self, expression):
        """Of Symbols, in functions of t."""
        return expression.xreplace(self.names)

    def rate(self, expression):
        """d/dt of an expression in Symbols, by the chain rule."""
        moving = zip((*self.q, *self.w), (*self.w, *self.accelerations))
        return Add(expression.diff(t), *(expression.diff(x) * y for x, y in moving))


def plain_lagrange(scene):
    """d/dt dL/dtheta' - dL/dtheta + dD/dtheta', by differentiation alone."""
    to, n = Plain(scene), len(scene)
    L = to.plain(scene.lagrangian)
    steps = zip(scene.damping or [0] * n, to.w, (0, *to.w[:-1]))
    loss = sum((c * (x - y) ** 2 / 2 for c, x, y in steps), Integer(0))
    return [to.again(to.rate(L.diff(w)) - L.diff(x) + loss.diff(w)) for x, w in zip(to.q, to.w)]


@measured
@given(st.data())
def test_closed_form_equals_plain_differentiation(data):
    """M theta'' - f is Lagrange's equation, at random states, for every feature a scene can have."""
    scene = data.draw(scenes())
    halves, rates = data.draw(state(len(scene)))

    for mine, plain in zip(euler_lagrange(scene).lhs, plain_lagrange(scene)):
        assert expand(at(mine - plain, scene, halves, rates)) == 0


def test_closed_form_equals_plain_differentiation_in_symbols():
    """The same for one to four rods whose every quantity is a Symbol, on an arbitrary support."""
    drive = Support(Function("xi")(t), Function("eta")(t))
    for n in (1, 2, 3, 4):
        rods = [Rod(*symbols(f"m{i} l{i} H{i} R{i}")) for i in range(1, n + 1)]
        for upright in (True, False):
            scene = Scene(rods, drive, upright=upright, damping=symbols(f"c:{n}"), springs=symbols(f"k:{n}"))
            halves = [Rational(k + 2, 2 * k + 5) for k in range(n)]
            for mine, plain in zip(euler_lagrange(scene).lhs, plain_lagrange(scene)):
                assert expand(at(mine - plain, scene, halves, symbols(f"w:{n}"))) == 0


@measured
@given(st.data())
def test_mass_matrix_is_the_second_derivative_of_the_kinetic_energy(data):
    """M_ij = d2K / dtheta_i' dtheta_j', and lhs = M theta'' - f."""
    scene = data.draw(scenes(max_size=2))
    equations = euler_lagrange(scene)
    halves, rates = data.draw(state(len(scene)))
    acceleration = equations.coordinates.diff(t, 2)
    to = Plain(scene)
    K = to.plain(scene.kinetic)

    assert (equations.mass_matrix * acceleration - equations.forcing - equations.lhs).applyfunc(expand).is_zero_matrix
    for i, x in enumerate(to.w):
        for j, y in enumerate(to.w):
            assert expand(at(to.again(K.diff(x, y)) - equations.mass_matrix[i, j], scene, halves, rates)) == 0


@measured
@given(st.data())
def test_dampers_alone_change_the_energy_of_a_chain_at_rest(data):
    """d(K + V)/dt = - sum c_i delta_i'**2 along the motion."""
    scene = data.draw(scenes(moving=False))
    halves, rates = data.draw(state(len(scene)))
    equations = euler_lagrange(scene)
    M, f = (at(part, scene, halves, rates) for part in (equations.mass_matrix, equations.forcing))
    to = Plain(scene)
    change = to.again(to.rate(to.plain(scene.kinetic + scene.potential)))
    accelerations = dict(zip(to.accelerations, M.LUsolve(f)))
    steps = zip(scene.damping or [0] * len(scene), rates, [0, *rates[:-1]])

    assert expand(at(change.xreplace(accelerations), scene, halves, rates)
                  + sum(c * (a - b) ** 2 for c, a, b in steps)) == 0


@measured
@given(st.data())
def test_conventions_describe_one_motion(data):
    """With theta = pi - phi, every upright equation is the hanging one with the other sign."""
    up = data.draw(scenes(joints=False))
    up = Scene(up.rods, up.support, up.gravity, True, t=t)
    down = Scene(up.rods, up.support, up.gravity, False, t=t)
    turned = {Derivative(x, (t, 2)): -Derivative(x, (t, 2)) for x in up.coordinates}
    turned |= {w: -w for w in up.velocities} | {x: pi - x for x in up.coordinates}

    for mine, other in zip(euler_lagrange(up).lhs, euler_lagrange(down).lhs):
        assert expand(mine.xreplace(turned) + other) == 0


@measured
@given(st.data())
def test_linear_parts_are_the_derivatives_of_the_equations(data):
    """A, damping, stiffness and remainder against the first order of the left-hand sides in a small factor."""
    scene = data.draw(scenes())
    n, small = len(scene), symbols("s")
    lin = linearize(euler_lagrange(scene))
    q = Matrix([Function(f"q{i}")(t) for i in range(n)])
    substituted = euler_lagrange(scene).lhs.xreplace(dict(zip(scene.coordinates, small * q))).doit()
    linear = small * (lin.A * q.diff(t, 2) + lin.damping * q.diff(t) + lin.stiffness * q) + lin.remainder

    at_rest = {small: Integer(0)}
    assert (substituted.xreplace(at_rest) - lin.remainder).applyfunc(expand).is_zero_matrix
    slope = (substituted - linear).diff(small).xreplace(at_rest)
    assert slope.applyfunc(lambda x: expand(x.doit())).is_zero_matrix


@measured
@given(st.lists(any_rods(), min_size=1, max_size=5), positive)
def test_modes_diagonalise_both_matrices(rods, gravity):
    """U^T A U and U^T B U are diagonal, and A u mu = B u."""
    modes = normal_modes(linearize(euler_lagrange(Scene(rods, gravity=gravity))), digits=25)
    size = max(abs(x) for x in (*(modes.U.T * modes.A * modes.U), *(modes.U.T * modes.B * modes.U)))

    for matrix in (modes.U.T * modes.A * modes.U, modes.U.T * modes.B * modes.U):
        off = [abs(matrix[i, j]) for i in range(len(rods)) for j in range(len(rods)) if i != j]
        assert all(x < Rational(1, 10**18) * size for x in off)


@measured
@given(st.data())
def test_first_order_system_is_the_linear_equations_in_tau(data):
    """theta'' from P equals -A^-1 (stiffness theta + damping theta') at t = tau/omega0."""
    scene = data.draw(scenes(moving=False))
    omega0 = data.draw(positive)
    eta = data.draw(st.sampled_from([Integer(0), cos(omega0 * t) / 7, sin(2 * omega0 * t + 1) * cos(omega0 * t)]))
    scene = Scene(scene.rods, Support(eta=eta), scene.gravity, scene.upright, scene.damping, scene.springs, t)
    lin, n = linearize(euler_lagrange(scene)), len(scene)
    P, tau, period = lin.first_order(omega0)
    torque = (lin.stiffness / omega0**2).row_join(lin.damping / omega0)
    difference = (lin.A * P[n:, :] + torque.xreplace({t: tau / omega0})).xreplace({tau: Rational(5, 7)})

    assert max(abs(x.evalf(30)) for x in difference) < Rational(1, 10**20)
    repeated = P.xreplace({tau: 1 + period}) - P.xreplace({tau: Integer(1)})
    assert max(abs(x.evalf(30)) for x in repeated) < Rational(1, 10**20)
    assert not P.has(cosh) and P[:n, n:] == Matrix.eye(n)
