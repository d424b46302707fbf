"""Many motions at once are those of each chain alone, with its own error."""

import pickle
from importlib import import_module

import mpmath
import numpy as np
import pytest
from sympy import Rational, pi

from lagrangian import (
    CompiledChain,
    Ensemble,
    QuantityError,
    Rod,
    Scene,
    SceneError,
    TextError,
    Trajectories,
    compile_equations,
    euler_lagrange,
    flips,
    simulate,
)

TIMES = [0.0, 0.5, 1.0]


@pytest.fixture
def chain():
    """Two bobs, hanging."""
    return CompiledChain([1.0, 1.0], [1.0, 1.0], [1.0, 1.0], [1.0, 1.0], upright=False)


@pytest.fixture
def ensemble():
    """Four chains of two rods."""
    mass = np.random.default_rng(0).uniform(0.5, 2, (4, 2))
    return Ensemble(mass, 1, 0.5, 0.6, damping=[[0], [0.1], [0.2], [0.3]], upright=False)


@pytest.fixture
def cloud():
    """Four states next to each other."""
    return 2 + 1e-6 * np.random.default_rng(1).normal(size=(4, 2))


def same(motions, alone):
    """Whether every bit is."""
    return all((getattr(motions, name) == np.stack([getattr(x, name) for x in alone])).all()
               for name in ("theta", "omega", "turns", "wrapped", "energy", "error", "accurate"))


def test_a_cloud_of_states_moves_as_each_state_alone(chain, cloud):
    """Bit for bit; angles of shape (chains, times, n), errors of shape (chains, times)."""
    motions = simulate(chain, cloud, [0.0, 0.5], TIMES)

    assert isinstance(motions, Trajectories) and len(motions) == 4
    assert motions.theta.shape == (4, 3, 2) and motions.error.shape == motions.energy.shape == (4, 3)
    assert same(motions, [simulate(chain, x, [0.0, 0.5], TIMES) for x in cloud])
    assert (motions.times == TIMES).all() and motions[2].chain is chain


def test_an_ensemble_moves_as_each_chain_alone(ensemble, cloud):
    """From states of their own, or all from one."""
    own = simulate(ensemble, cloud, cloud - 2, TIMES, accuracy=1e-8)
    one = simulate(ensemble, [2.0, 1.0], [0.0, 0.0], TIMES)

    assert same(own, [simulate(x, a, a - 2, TIMES, accuracy=1e-8) for x, a in zip(ensemble, cloud, strict=True)])
    assert same(one, [simulate(x, [2.0, 1.0], [0.0, 0.0], TIMES) for x in ensemble])
    assert not one.theta.flags.writeable and not one.error.flags.writeable
    assert (pickle.loads(pickle.dumps(one)).theta == one.theta).all()


def test_exact_states_digits_events_and_other_methods_are_those_of_each(ensemble):
    """What simulate takes for one chain it takes for many."""
    states, still = [[pi / 2, Rational(1, 3)]] * 4, [0, 0]
    motions = simulate(ensemble, states, still, [0, 1], digits=25)
    assert isinstance(motions.theta[0, 0, 0], mpmath.ctx_mp_python._mpf)
    assert (motions.error < 1e-20).all()
    assert same(motions, [simulate(x, states[0], still, [0, 1], digits=25) for x in ensemble])

    motions = simulate(ensemble, [3.0, 3.0], [2.0, 2.0], TIMES, dense=True, events=flips(ensemble[0]))
    alone = simulate(ensemble[1], [3.0, 3.0], [2.0, 2.0], TIMES, dense=True, events=flips(ensemble[1]))
    assert all((motions[1].events[name] == times).all() for name, times in alone.events.items())
    assert (motions[1].at(0.25)[0] == alone.at(0.25)[0]).all()

    pytest.importorskip("scipy")
    motions = simulate(ensemble, [1.0, 1.0], [0.0, 0.0], TIMES, accuracy=1e-6, method="DOP853")
    assert motions[3].method == "DOP853" and motions.accurate.all()


def test_symbolic_equations_move_clouds_too_and_are_compiled_once(cloud, monkeypatch):
    """Equations are compiled for one chain, which starts from many states; times may be an iterator."""
    module = import_module("lagrangian.simulate")
    compiled = []
    monkeypatch.setattr(module, "compile_equations", lambda x: compiled.append(1) or compile_equations(x))
    equations = euler_lagrange(Scene([Rod.bob(1, 1)] * 2, gravity=10, upright=False))
    motions = simulate(equations, cloud[:2], [0.0, 0.0], iter(TIMES))

    assert len(compiled) == 1
    assert same(motions, [simulate(equations, x, [0.0, 0.0], TIMES) for x in cloud[:2]])


def test_some_of_many_are_many(ensemble, cloud):
    """Slices of an ensemble and of its motions; an empty one has no chain to follow."""
    some = ensemble[1:3]

    assert isinstance(some, Ensemble) and some.shape == (2, 2)
    motions, later = simulate(ensemble, cloud, [0.0, 0.5], TIMES)[1:3], simulate(some, cloud[1:3], [0.0, 0.5], TIMES)
    assert isinstance(motions, Trajectories) and same(motions, later)
    with pytest.raises(SceneError, match="holds none of them"):
        motions[:0]
    with pytest.raises(SceneError, match="shape"):
        ensemble[4:]
    with pytest.raises(IndexError, match="motions of 2 chains, counted from 0, and 2 is none"):
        motions[2]


def test_the_verdict_counts_the_chains_that_are_accurate(chain):
    """One at rest, one in chaos: the worst has its say."""
    motions = simulate(chain, [[0.0, 0.0], [3.0, 3.0]], [0.0, 0.0], [0.0, 60.0])

    assert motions.accurate.tolist() == [True, False]
    assert motions.verdict.startswith("1 of 2 chains") and motions[1].verdict in motions.verdict


def test_many_motions_are_a_labelled_data_set(ensemble, cloud):
    """chain (0, 1, ...), time and rod (1, ..., n); one motion has no chain."""
    pytest.importorskip("xarray")
    motions = simulate(ensemble, cloud, [0.0, 0.0], TIMES)
    found, alone = motions.to_xarray(), motions[1].to_xarray()

    assert found.theta.dims == ("chain", "time", "rod") and found.error.dims == ("chain", "time")
    assert found.rod.values.tolist() == [1, 2] and found.chain.values.tolist() == [0, 1, 2, 3]
    assert found.attrs["verdict"] == motions.verdict and found.attrs["method"] == "taylor"
    assert (found.theta.sel(chain=1).values == alone.theta.values).all()
    assert alone.theta.dims == ("time", "rod") and "chain" not in alone.coords


@pytest.mark.parametrize(("theta", "omega", "error", "words"), [
    (np.ones((3, 2)), [0, 0], SceneError, ["4 in system", "3 in theta0", "(chains, n)"]),
    (np.ones((4, 2)), np.ones((2, 2)), SceneError, ["4 in theta0", "2 in omega0"]),
    (np.ones((0, 2)), [0, 0], SceneError, ["0 in theta0"]),
    (np.ones((4, 3)), [0, 0], SceneError, ["2 rods", "(3,)"]),
    (np.ones((4, 2, 2)), [0, 0], SceneError, ["2 rods", "(4, 2, 2)"]),
    ([[1, 2]] * 3 + [[1]], [0, 0], SceneError, ["2 rods", "(1,)"]),
    ([[1, 2]] * 3 + [[1, "2"]], [0, 0], TextError, ["theta0[1]", "never evaluated"]),
    ([[1, 2]] * 3 + [[1, np.nan]], [0, 0], QuantityError, ["chain 3", "theta0[1]", "nan"]),
    ([1, [1, 2]], [0, 0], Exception, ["theta0[1]", "[1, 2]"]),
    ("ab", [0, 0], TextError, ["theta0"]),
])
def test_states_that_fit_no_ensemble_are_refused(ensemble, theta, omega, error, words):
    """As many states as chains, n numbers each; a chain that has no motion is named."""
    with pytest.raises(error) as refusal:
        simulate(ensemble, theta, omega, [0, 1])

    assert all(word in str(refusal.value) for word in words)
