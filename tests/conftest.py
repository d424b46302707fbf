"""Hypothesis profiles: ``dev`` while writing, ``ci`` before landing, ``nightly`` for the long run.

``HYPOTHESIS_PROFILE=ci`` asks for 1000 examples a law, the same ones on every run; ``brief`` is for a
second pass of the same laws with other ground types.  There are no deadlines: times belong in
``benchmarks/``.
"""

import os
import sys
from concurrent.futures import ThreadPoolExecutor

from hypothesis import HealthCheck, settings

settings.register_profile("dev", max_examples=50, deadline=None)
settings.register_profile(
    "ci",
    max_examples=1000,
    deadline=None,
    derandomize=True,
    database=None,
    print_blob=True,
    # On a busy machine drawing the first example can be slow; that says nothing about the law.
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile("brief", max_examples=10, deadline=None, derandomize=True, database=None)
# HYPOTHESIS_PROFILE=nightly python -m pytest tests/fastpicard/test_enclosure.py -k twice_the_digits: 100000 containment
# checks, an hour of processor time; or CHECKS=25000 and --hypothesis-seed=1 to 4 in processes side by side.
settings.register_profile("nightly", max_examples=10_000, deadline=None, database=None)

PROFILE = os.environ.get("HYPOTHESIS_PROFILE", "dev")
settings.load_profile(PROFILE)

# Random containment checks of an enclosure.
CHECKS = int(os.environ.get("CHECKS", {"ci": 2000, "nightly": 100_000}.get(PROFILE, 50)))


def hide(monkeypatch, package):
    """Make a package one that is not installed."""
    for name in [name for name in sys.modules if name.startswith(f"{package}.")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, package, None)


def in_threads(function, arguments):
    """The values of a function at many arguments, each in a thread of its own, all of them interrupted often."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(len(arguments)) as threads:
            return list(threads.map(function, arguments))
    finally:
        sys.setswitchinterval(before)
