"""Hypothesis profiles: ``dev`` while writing, ``ci`` before landing.

``HYPOTHESIS_PROFILE=ci`` asks for 1000 examples a law, the same ones on every run.  There are no
deadlines: times belong in ``benchmarks/``.
"""

import os

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
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "dev"))
