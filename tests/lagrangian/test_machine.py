"""What numba is spared when it translates, and that it works as before for everybody else."""

import gc
import os
import platform
import re
import subprocess
import sys

import numpy as np
import pytest

from lagrangian import CompiledChain
from lagrangian.angles import revolved
from lagrangian.machine import machine, undisturbed

event = pytest.importorskip("numba.core.event")

FIRST_MOTION = """
import sys
import numpy as np
from lagrangian import CompiledChain, simulate
chain = CompiledChain([1.0] * 2, [1.0] * 2, [0.5] * 2, [0.6] * 2)
simulate(chain, [2, -3], [0, 0], [0, 1])
print(sorted({"scipy.linalg", "sympy.tensor.tensor"} & set(sys.modules)))
import numba
dot = numba.njit(lambda x: np.dot(x, x))
print(dot(np.ones((2, 2))).tolist(), numba.njit(lambda x: np.linalg.det(x))(2 * np.eye(2)))
"""

MANY_CHAINS = """
import numpy as np
from lagrangian import CompiledChain
from lagrangian.lanes import accelerate_lanes
from lagrangian.machine import machine
CompiledChain([1.0, 200.0], [1.0] * 2, [0.5] * 2, [0.6] * 2).acceleration(0, np.ones((2, 70)), np.ones((2, 70)))
print(*machine(accelerate_lanes).inspect_asm().values())
"""


def test_a_first_motion_loads_no_linear_algebra_and_numba_still_has_it():
    """SciPy's, which takes a third of a second, nor SymPy's tensors; in a process of its own."""
    pytest.importorskip("scipy")
    done = subprocess.run([sys.executable, "-c", FIRST_MOTION], capture_output=True, text=True, check=True)

    assert done.stdout.splitlines() == ["[]", "[[2.0, 2.0], [2.0, 2.0]] 4.0"]


@pytest.mark.parametrize("searching", [True, False])
def test_the_search_for_garbage_stops_while_numba_works_and_then_is_as_it_was(searching):
    """Also where the work fails."""
    def failing():
        with undisturbed():
            assert not gc.isenabled()
            raise ZeroDivisionError

    before = gc.isenabled()
    (gc.enable if searching else gc.disable)()
    try:
        with pytest.raises(ZeroDivisionError):
            failing()
        assert gc.isenabled() is searching
    finally:
        (gc.enable if before else gc.disable)()


def test_numba_searches_no_garbage_while_it_translates(monkeypatch, tmp_path):
    """Seen from inside, by a listener of numba's own; nothing is in the cache."""
    monkeypatch.setattr("numba.config.CACHE_DIR", str(tmp_path))
    seen = []

    class Watching(event.Listener):
        def on_start(self, _):
            seen.append(gc.isenabled())

        def on_end(self, _):
            pass

    def doubled(x):
        return x + x

    with event.install_listener("numba:compile", Watching()):
        assert machine(doubled)(1.5) == 3.0
    assert seen == [False] and gc.isenabled()


def test_every_pass_left_out_is_one_of_numba():
    """A pass that numba renames would come back unseen."""
    from numba.core import typed_passes, untyped_passes

    from lagrangian.translator import UNCOUNTED

    assert {*UNCOUNTED} <= {*vars(typed_passes), *vars(untyped_passes)}


def test_remembered_types_are_those_that_numba_finds(monkeypatch, tmp_path):
    """What a translation has found once, among it float * float, asked for again of numba itself."""
    from numba import float64
    from numba.core.errors import TypingError
    from numba.core.registry import cpu_target
    from numba.core.types.functions import BaseFunction

    from lagrangian.translator import FOUND

    def curve(x, k):
        return 2.0 * (x * x) ** k - x

    monkeypatch.setattr("numba.config.CACHE_DIR", str(tmp_path))
    search = BaseFunction.get_call_type
    FOUND.clear()
    assert machine(curve)(1.5, 2) == 8.625

    assert BaseFunction.get_call_type is search
    assert (float64, float64) in [arguments for _, found in FOUND.values() for arguments in found]
    for function, found in FOUND.values():
        for arguments, signature in found.items():
            if isinstance(signature, TypingError):
                with pytest.raises(TypingError):
                    function.get_call_type(cpu_target.typing_context, arguments, {})
            else:
                assert function.get_call_type(cpu_target.typing_context, arguments, {}) == signature


def test_parts_of_functions_have_no_machine_code_of_their_own(monkeypatch, tmp_path):
    """Of a function that calls two others, numba gets one module to make machine code of."""
    from numba.core.codegen import JITCPUCodegen

    made, add = [], JITCPUCodegen._add_module

    def watching(self, module):
        made.append(module.name.partition("_")[0])
        return add(self, module)

    monkeypatch.setattr(JITCPUCodegen, "_add_module", watching)
    monkeypatch.setattr("numba.config.CACHE_DIR", str(tmp_path))
    machine.cache_clear()

    assert machine(revolved)(0.25, 0.0, 1.0, 0.0) == (1.0, 0.0)
    assert {"revolved", "product", "sines"} & {*made} == {"revolved"}


@pytest.mark.skipif(platform.machine() != "x86_64", reason="the instructions are those of this family of processors")
def test_many_chains_ask_for_memory_ahead_and_store_without_masks(tmp_path):
    """Stores under a mask doubled the time of chains that are asked for their doubt, on processors of AMD."""
    code = subprocess.run([sys.executable, "-c", MANY_CHAINS], capture_output=True, text=True, check=True,
                          env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}).stdout
    assert "prefetch" in code
    assert not re.search(r"vmaskmov\w+\s+%\w+, %\w+, .*[(]", code)


def test_translated_functions_hold_no_array_longer_than_the_call():
    """Neither those that count references nor those that do not."""
    chain, states = CompiledChain([1.0, 2.0], [1.0] * 2, [0.5] * 2, [0.6] * 2), np.ones((2, 70))
    chain.acceleration(0, np.ones(2), np.ones(2))
    held = [sys.getrefcount(x) for x in (states, chain.rods, chain.rods.base)]
    for _ in range(3):
        chain.acceleration(0, states, states)
        chain.acceleration(0, np.ones(2), np.ones(2))

    assert [sys.getrefcount(x) for x in (states, chain.rods, chain.rods.base)] == held
