"""Many chains, each with its own rods: an ensemble is its chains, one by one."""

import pickle

import flint
import mpmath
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from sympy import Rational, cos, pi, symbols

from lagrangian import (
    CompiledChain,
    DriveError,
    Ensemble,
    NotAQuantityError,
    QuantityError,
    Rod,
    Scene,
    SceneError,
    Support,
    TextError,
    chain as chains,
    compile_equations,
    ensemble as ensembles,
    euler_lagrange,
    lanes,
    redone,
)
from lagrangian.constants import rod_row

measured = settings(deadline=None, max_examples=25)
m, l, c, g, t = symbols("m l c g t")


def ordinary(rng, count, n):
    """Mass, length, centre and gyration of ordinary rods, shape (count, n) each."""
    mass, length = rng.uniform(0.5, 2, (2, count, n))
    center = rng.uniform(0, 1, (count, n)) * length
    return mass, length, center, np.sqrt(center**2 + rng.uniform(0.02, 0.3, (count, n)) * length**2)


def state(rng, count, n):
    """Angles and rates of any chains."""
    return rng.uniform(-9, 9, (count, n)), rng.normal(size=(count, n))


def one_by_one(ensemble, time, theta, omega):
    """What each chain alone gives."""
    return np.stack([chain.acceleration(time, *x) for chain, *x in zip(ensemble, theta, omega, strict=True)])


def apart(mine, other):
    """The largest difference of any chain over its largest entry."""
    return (abs(mine - other).max(axis=1) / abs(other).max(axis=1)).max()


@measured
@given(st.data(), st.integers(1, 150), st.integers(1, 6))
@pytest.mark.parametrize("has_numba", [True, False])
def test_an_ensemble_moves_as_its_chains_alone(has_numba, data, count, n):
    """With and without joints, light rods among them, driven, from either vertical: twice 4e-15 at most."""
    rng = np.random.default_rng(data.draw(st.integers(0, 10**6)))
    damping, springs = (data.draw(st.sampled_from([None, x])) for x in rng.uniform(0, 5, (2, count, n)))
    mass, *rest = ordinary(rng, count, n)
    if data.draw(st.booleans()) and damping is None is springs and n > 1:
        mass[rng.integers(count), rng.integers(n)] = data.draw(st.sampled_from([0.0, 1e-9]))
    support, upright = data.draw(st.sampled_from([(0, 0), lambda time: (time, 3.0)])), data.draw(st.booleans())
    ensemble, (theta, omega) = Ensemble(mass, *rest, 9.81, support, damping, springs, upright), state(rng, count, n)
    with pytest.MonkeyPatch.context() as patch:
        for module in (chains, redone, ensembles) if not has_numba else ():
            patch.setattr(module, "has_numba", lambda: False)
        together = ensemble.acceleration(0.5, theta, omega)

    assert together.shape == (count, n) == ensemble.shape
    assert apart(together, one_by_one(ensemble, 0.5, theta, omega)) < 8e-15


@pytest.mark.parametrize("n", [63, 64, 65, 128])
@pytest.mark.parametrize("damping", [None, 0.5])
def test_links_that_crowd_the_cache_are_taken_in_groups(n, damping, monkeypatch):
    """Chains of 64 links and multiples, the last block of chains not full: as those near by, which are not."""
    rng = np.random.default_rng(n)
    ensemble, (theta, omega) = Ensemble(*ordinary(rng, 70, n), damping=damping), state(rng, 70, n)
    groups, found = [], lanes.machine
    monkeypatch.setattr(lanes, "machine", lambda function: lambda *given: groups.append(given[8]) or
                        found(function)(*given))
    together = ensemble.acceleration(0, theta, omega)

    assert [group is not None for group in groups] == [n % 64 == 0]
    assert apart(together, one_by_one(ensemble, 0, theta, omega)) < 8e-15


def test_the_chains_of_an_ensemble_are_those_of_its_rows():
    """By index, negative too, and in a loop; constants kept to the last bit."""
    rng = np.random.default_rng(1)
    rods, damping = ordinary(rng, 4, 3), rng.uniform(0, 1, (4, 3))
    ensemble = Ensemble(*rods, gravity=Rational("9.81"), damping=damping, upright=False)
    theta, omega = state(rng, 4, 3)

    assert len(ensemble) == 4 and len(list(ensemble)) == 4 and ensemble[-1] is ensemble[3]
    for j, chain in enumerate(ensemble):
        alone = CompiledChain(*(x[j] for x in rods), gravity=Rational("9.81"), damping=damping[j], upright=False)
        assert (chain.acceleration(0, theta[j], omega[j]) == alone.acceleration(0, theta[j], omega[j])).all()
    with pytest.raises(IndexError):
        ensemble[4]
    with pytest.raises(TypeError):
        ensemble["1"]


def test_common_rods_are_an_ensemble_too():
    """The same rods in every chain: what a CompiledChain gives for many states."""
    rng = np.random.default_rng(2)
    rods, (theta, omega) = ordinary(rng, 1, 5), state(rng, 130, 5)
    ensemble = Ensemble(*(np.tile(x, (130, 1)) for x in rods), springs=2.0)
    common = CompiledChain(*(x[0] for x in rods), springs=np.full(5, 2.0))

    assert apart(ensemble.acceleration(0, theta, omega), common.acceleration(0, theta.T, omega.T).T) < 8e-15


def test_what_chains_or_rods_share_is_given_once():
    """(n,), (chains, 1) and single numbers are repeated; exact numbers are rounded to float64."""
    mass, theta, omega = np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]), np.ones((3, 2)), np.zeros((3, 2))
    short = Ensemble(mass, [1, Rational(1, 2)], 0.25, [[1], [2], [3]], damping=[[0], [1], [2]])
    length, gyration = np.tile([1, 0.5], (3, 1)), np.repeat([[1.0], [2], [3]], 2, axis=1)
    full = Ensemble(mass, length, np.full((3, 2), 0.25), gyration, damping=gyration - 1)

    assert (short.acceleration(0, theta, omega) == full.acceleration(0, theta, omega)).all()


def test_an_ensemble_keeps_its_own_numbers():
    """What is done to the arrays afterwards changes nothing; pickle gives the same ensemble."""
    rng = np.random.default_rng(3)
    rods, (theta, omega) = ordinary(rng, 3, 2), state(rng, 3, 2)
    ensemble, same = Ensemble(*rods, damping=rods[0]), Ensemble(*(x.copy() for x in rods), damping=rods[0].copy())
    for x in rods:
        x *= 3
    copy = pickle.loads(pickle.dumps(ensemble))

    assert (ensemble.acceleration(0, theta, omega) == same.acceleration(0, theta, omega)).all()
    assert (copy.acceleration(0, theta, omega) == same.acceleration(0, theta, omega)).all()
    assert (ensemble[1].rods == same[1].rods).all()
    with pytest.raises(ValueError, match="read-only"):
        ensemble.damping[0, 0] = 1


def test_digits_and_balls_take_one_chain_after_the_other():
    """mpmath numbers in, mpmath numbers out, those of each chain; so are balls."""
    rng = np.random.default_rng(4)
    ensemble = Ensemble(*ordinary(rng, 3, 2))
    context = mpmath.mp.clone()
    context.dps = 40
    for number in (context.mpf, flint.arb):
        theta, omega = ([[number(float(x)) for x in row] for row in part] for part in state(rng, 3, 2))
        found = ensemble.acceleration(number(0.5), theta, omega)
        assert found.shape == (3, 2) and isinstance(found[0, 0], type(theta[0][0]))
        for j, chain in enumerate(ensemble):
            assert list(map(str, found[j])) == list(map(str, chain.acceleration(number(0.5), theta[j], omega[j])))


def test_angles_after_many_turns_lose_nothing():
    """Beyond 8e5 rad the sines are the library's; states in another order of memory are the same states."""
    rng = np.random.default_rng(5)
    ensemble, (theta, omega) = Ensemble(*ordinary(rng, 70, 3)), state(rng, 70, 3)
    theta[17] += 1e7

    found = ensemble.acceleration(0, theta, omega)
    assert apart(found, one_by_one(ensemble, 0, theta, omega)) < 8e-15
    assert (found == ensemble.acceleration(0, np.asfortranarray(theta), omega.tolist())).all()


o = np.ones


@pytest.mark.parametrize(("arguments", "error", "words"), [
    ((o((2, 3)), o(2), 1, 1), SceneError, ["mass (2, 3), length (2,)", "(chains, n)", "(chains, 1)"]),
    ((o(3), o(3), o(3), o(3)), SceneError, ["mass (3,)", "(chains, n)"]),
    ((1, 1, 1, 1), SceneError, ["mass ()", "(chains, n)"]),
    ((o((0, 3)), 1, 1, 1), SceneError, ["mass (0, 3)"]),
    ((o((2, 2, 2)), 1, 1, 1), SceneError, ["mass (2, 2, 2)"]),
    ((o((2, 3)), 1, 1, 1, 9.81, (0, 0), o((3, 2))), SceneError, ["damping (3, 2)"]),
    (([[1, 1], [1, -2]], 1, 1, 1), QuantityError, ["mass[1, 1] is -2.0"]),
    ((o((2, 3)), 0, 1, 1), QuantityError, ["length[0, 0] is 0.0", "positive"]),
    ((o((2, 2)), 1, [[1, 1], [1, 2]], 1), QuantityError, ["gyration[1, 1] is 1.0 and center[1, 1] is 2.0"]),
    ((o((2, 2)), 1, 1, np.inf), QuantityError, ["gyration holds inf"]),
    (([[1, 1], [0, 0]], 1, 1, 1), SceneError, ["without any mass"]),
    (([[1, 1], [1, 0]], 1, 1, 1, 9.81, (0, 0), None, 1), SceneError, ["rod 2 of chain 1", "springs"]),
    ((o((2, 2)), 1, 1, 1, 9.81, (0, 0), [[1, 1], [1, -1]]), QuantityError, ["damping[1, 1] is -1.0"]),
    (([["1", "2"]], 1, 1, 1), TextError, ["mass", "never evaluated"]),
    ((o((2, 2)) * 1j, 1, 1, 1), NotAQuantityError, ["mass", "1j"]),
    (([[1, 2], [1]], 1, 1, 1), NotAQuantityError, ["mass", "[1, 2]"]),
    ((o((2, 2)), 1, 1, m), QuantityError, ["gyration", "Symbol m"]),
    ((o((2, 2)), 1, 1, 1, o(2)), NotAQuantityError, ["gravity"]),
    ((o((2, 2)), 1, 1, 1, 9.81, 7), DriveError, ["pair"]),
    ((o((2, 2)), 1, 1, 1, 9.81, (0, 0), None, None, 1), NotAQuantityError, ["upright"]),
])
def test_what_no_ensemble_can_be_is_refused(arguments, error, words):
    """A named error with the claim, the chain and the rod, and the remedy."""
    with pytest.raises(error) as refusal:
        Ensemble(*arguments)

    assert all(word in str(refusal.value) for word in words)


@pytest.mark.parametrize(("time", "theta", "omega", "error", "words"), [
    (0, o((3, 2)), o((3, 2)), SceneError, ["2 chains of 3 rods", "theta", "(3, 2)", "give shape (2, 3)"]),
    (0, o((2, 3)), o(3), SceneError, ["omega", "(3,)"]),
    (0, [[mpmath.mpf(1)] * 2] * 2, o((2, 3)), SceneError, ["theta", "(2, 2)"]),
    (0, o((2, 3)) * np.nan, o((2, 3)), QuantityError, ["theta", "nan"]),
    (0, o((2, 3)), o((2, 3)) * 1e200, QuantityError, ["1e+200", "float64"]),
    (0, "ab", o((2, 3)), TextError, ["theta"]),
    ("1", o((2, 3)), o((2, 3)), TextError, ["t is"]),
])
def test_a_state_without_an_answer_is_refused(time, theta, omega, error, words):
    """Shapes, infinities and overflow are named."""
    with pytest.raises(error) as refusal:
        Ensemble(o((2, 3)), 1, 1, 1).acceleration(time, theta, omega)

    assert all(word in str(refusal.value) for word in words)


def test_symbols_take_one_number_for_every_chain():
    """scene.compile with arrays: the chains are those of the values one by one, rounded once."""
    scene = Scene([Rod.uniform(m, l), Rod.bob(2 * m, l / 3)], Support(eta=cos(3 * t) / 10), g, damping=[c, 0], t=t)
    rng = np.random.default_rng(6)
    masses, lengths = rng.uniform(1, 2, (2, 5))
    ensemble = scene.compile({m: masses, l: list(lengths), c: Rational(1, 10), g: 9.81})
    theta, omega = state(rng, 5, 2)
    alone = np.stack([scene.compile({m: masses[j], l: lengths[j], c: Rational(1, 10), g: 9.81})
                      .acceleration(0.5, theta[j], omega[j]) for j in range(5)])

    assert isinstance(ensemble, Ensemble) and len(ensemble) == 5
    assert apart(ensemble.acceleration(0.5, theta, omega), alone) < 1e-14
    assert apart(one_by_one(ensemble, 0.5, theta, omega), alone) < 1e-14


@pytest.mark.parametrize(("values", "error", "words"), [
    ({m: [1, 2], l: [1, 2, 3], g: 1}, SceneError, ["m (2,)", "l (3,)", "(chains,)"]),
    ({m: [[1, 2]], l: 1, g: 1}, SceneError, ["m (1, 2)"]),
    ({m: [], l: 1, g: 1}, SceneError, ["m (0,)"]),
    ({m: [1, 2], g: 1}, QuantityError, ["Symbol l"]),
    ({m: [1, 2], l: 1, g: [1, 2]}, QuantityError, ["one gravity", "g differs"]),
    ({m: [1, -2], l: 1, g: 1}, QuantityError, ["mass[1, 0] is -2.0"]),
    ({m: ["1", "2"], l: 1, g: 1}, TextError, ["never evaluated"]),
    ({m: [1, [2]], l: 1, g: 1}, NotAQuantityError, ["[2]"]),
    ({m: [1, np.nan], l: 1, g: 1}, QuantityError, ["nan"]),
])
def test_values_that_make_no_ensemble_are_refused(values, error, words):
    """Lengths that differ, Symbols without numbers, gravity that differs among the chains."""
    with pytest.raises(error) as refusal:
        Scene([Rod.uniform(m, l)] * 2, gravity=g).compile(values)

    assert all(word in str(refusal.value) for word in words)


def test_symbolic_equations_are_compiled_for_one_chain():
    """compile_equations refuses arrays, and says what takes them."""
    with pytest.raises(QuantityError, match=r"for 2.*scene.compile"):
        compile_equations(euler_lagrange(Scene([Rod.uniform(m, 1)], gravity=1)), {m: [1, 2]})


def test_constants_in_pairs_have_31_digits():
    """Against mpmath numbers, bobs and nearly bobs among them: only exact differences are rounded."""
    rng, number = np.random.default_rng(7), redone.FINE.context.mpf
    m, l, H, R = 10.0 ** rng.uniform(-10, 10, (4, 3, 40))
    R = np.maximum(R, H)
    H[0], R[0], R[1] = l[0], l[0], np.nextafter(H[1], np.inf)
    found = redone.rows_in_pairs(m, l, H, R)
    for k, j in np.ndindex(3, 40):
        exact = rod_row(*(number(x[k, j]) for x in (m, l, H)), number(R[k, j]) ** 2)
        assert all(abs(number(x.real) + number(x.imag) - y) <= 2.0**-103 * abs(y)
                   for x, y in zip(found[k, :, j], exact, strict=True))


def test_pi_among_the_numbers_is_rounded_once():
    """Numbers of all kinds stand side by side."""
    ensemble = Ensemble([[pi, 1], [mpmath.mpf(2), 3]], 1, 1, 1)

    assert ensemble[0].rods[0, 0] == np.pi and ensemble[1].rods[0, 0] == 2


def test_a_chain_that_is_none_of_the_ensemble_is_named():
    """By its number, and how many there are."""
    with pytest.raises(IndexError, match=r"3 chains.*and 5 is none"):
        Ensemble([[1, 1], [1, 2], [1, 3]], [1, 1], [1, 1], [1, 1])[5]
