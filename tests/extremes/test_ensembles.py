"""Ensembles whose every chain is hard in its own way: 4e-15 of 300 digits for each."""

import pickle

import numpy as np
import pytest

from lagrangian import Ensemble, chain as chains, ensemble as ensembles, redone

from .test_chains import KINDS, WORST_RODS, balanced_chain, dense, error, hard_chain, seeded, sprung_chain


@pytest.fixture(params=[True, False], ids=["numba", "plain"], autouse=True)
def _with_and_without_numba(request, monkeypatch):
    for module in (chains, redone, ensembles) if not request.param else ():
        monkeypatch.setattr(module, "has_numba", lambda: False)


def rows(parts):
    """What the chains have, side by side: shape (chains, n) each."""
    return [np.stack(x) for x in zip(*parts, strict=True)]


@pytest.mark.parametrize("n", [1, 2, 3, 7])
def test_hard_chains_of_all_kinds_side_by_side(n):
    """Masses 1e12 apart beside lengths 1e6 apart beside rates of 1e8."""
    rng = np.random.default_rng(n)
    parts = [hard_chain(kind, n, rng) for kind in KINDS * 7]
    *rods, theta, omega = rows(parts)
    found = Ensemble(*rods).acceleration(0, theta, omega)

    assert max(error(x, dense(*part[:4], 9.81, *part[4:])) for x, part in zip(found, parts, strict=True)) < 4e-15


@pytest.mark.parametrize("seed", WORST_RODS)
def test_the_chains_that_float64_loses_are_right_among_others(seed):
    """Wrong by up to 2e-13 if they are not found again; the others are not in doubt."""
    part = seeded(seed)
    others = [hard_chain("nothing", len(part[0]), np.random.default_rng(j)) for j in range(2)]
    *rods, theta, omega = rows([others[0], part, others[1]])
    ensemble, exact = Ensemble(*rods), dense(*part[:4], 9.81, *part[4:])
    found = ensemble.acceleration(0, theta, omega)

    assert error(found[1], exact) < 4e-15
    assert (pickle.loads(pickle.dumps(ensemble)).acceleration(0, theta, omega) == found).all()


@pytest.mark.parametrize("seed", range(20))
def test_joints_that_balance_lose_no_digits(seed):
    """Springs against dampers in one chain, springs against weights in another, none in a third."""
    rods, state, (damping, springs) = next(x for x in map(sprung_chain, range(seed, 999, 4)) if len(x[2][0]) <= 6)
    n = len(damping)
    light, still, carrying = next(x for x in map(balanced_chain, range(seed, 900)) if len(x[2]) == n)
    plain = hard_chain("random masses", n, np.random.default_rng(seed))
    chain = [(*rods, *state), (*light, *still), plain]
    joints = [(damping, springs), (np.zeros(n), carrying), (np.zeros(n), np.zeros(n))]
    *rods, theta, omega = rows(chain)
    dampers, springs = rows(joints)
    found = Ensemble(*rods, damping=dampers, springs=springs).acceleration(0, theta, omega)

    for x, part, joint in zip(found, chain, joints, strict=True):
        assert error(x, dense(*part[:4], 9.81, *part[4:], *joint)) < 4e-15
