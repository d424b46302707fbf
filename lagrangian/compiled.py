r"""The symbolic equations as fast functions of numbers: NumPy, mpmath or machine code.

``M(theta) theta'' = f(t, theta, theta')`` is written out once, with common subexpressions shared, and the linear
system is solved for every state; M is never inverted.  Every Symbol and function of the equations is replaced by a
new one with a name of this file's choosing before any code is generated, so that no name in the equations, whatever
it says, becomes code.

This route costs O(n**3) a state and n**2 expressions to write out; it is for any equations one may want to
compare, and for chains up to about ten rods.  :meth:`lagrangian.Scene.compile` is O(n).
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

import mpmath
import numpy as np
from sympy import Dummy, Float, Matrix, Symbol, lambdify

from .arithmetic import MPNumbers
from .chain import CompiledChain
from .constants import substitution
from .equations import EquationsOfMotion
from .errors import DriveError, NotASceneError, QuantityError, SceneError
from .frozen import Frozen
from .machine import has_numba
from .quantities import one_array
from .states import float_state, float_time

__all__ = ["CompiledEquations", "compile_equations"]

TARGETS = ("numpy", "mpmath", "numba")


class CompiledEquations(Frozen):
    """``acceleration(t, theta, omega)`` from the symbolic M and f; made by :func:`compile_equations`.  Immutable.

    Attributes
    ----------
    equations : the :class:`EquationsOfMotion` that it was made from, Symbols and all
    target : ``"numpy"``, ``"mpmath"`` or ``"numba"``
    chain : the same chain as a :class:`CompiledChain`
    """

    def __init__(self, equations: EquationsOfMotion, values: Mapping[Any, Any] | None, target: str) -> None:
        self.equations, self.target = equations, target
        chain = equations.scene.compile(values)
        if not isinstance(chain, CompiledChain):
            raise QuantityError(f"equations are compiled for one chain, and these values are for {len(chain)}: give "
                                f"one number for every Symbol, or use scene.compile(values).")
        self.chain, self._values = chain, dict(values or {})
        n, replace = len(equations.scene), substitution(values, equations.t)
        self._time = Dummy("t")
        rates, angles = ([Symbol(f"{letter}{k}") for k in range(n)] for letter in ("w", "q"))
        plain = dict(zip(equations.scene.velocities, rates, strict=True)), dict(zip(equations.scene.coordinates, angles,
                                                                                   strict=True))
        names = [Dummy(f"x{i}") for i in range(2 * n)]
        final = dict(zip([*angles, *rates], names, strict=True)) | {equations.t: self._time}
        sides = []
        for matrix in (equations.mass_matrix, equations.forcing):
            numbers = Matrix(replace(matrix))
            sides.append(numbers.xreplace(plain[0]).xreplace(plain[1]).xreplace(final))
        left = set().union(*(side.free_symbols for side in sides)) - {self._time, *names}
        if left:
            raise QuantityError(f"the equations hold the Symbol {sorted(map(str, left))[0]}: give a number for it, as "
                                f"in "
                                f"compile_equations(equations, {{symbol: number}}).")
        self._function = self._translated([self._time, *names], sides)
        self._made = True

    def _translated(self, arguments: list[Any], sides: list[Any]) -> Any:
        modules = "mpmath" if self.target == "mpmath" else "numpy"
        if self.target == "numba":
            sides = [[Float(x, 17) if x.is_number else x for x in side] for side in sides]  # lists of floats alone
        function = lambdify(arguments, sides, modules=modules, cse=True, dummify=True)
        return import_module("numba").njit(function) if self.target == "numba" and has_numba() else function

    def acceleration(self, t: Any, theta: Any, omega: Any) -> Any:
        """``theta''``, shape (n,): float64, or mpmath numbers at the precision of mpmath's own context; rad/s**2.

        Raises SceneError unless theta and omega hold n numbers each; QuantityError, NotAQuantityError, TextError where
        these are no finite numbers, or the mass matrix is singular.
        """
        if self.target == "mpmath":
            time = MPNumbers(mpmath.mp).coerced(t)
            theta, omega = self._exact(theta, "theta"), self._exact(omega, "omega")
        else:
            time = float_time(t)
            theta, omega = self._floats(theta, "theta"), self._floats(omega, "omega")
        try:
            return self._solved(*self._function(time, *theta, *omega))
        except OverflowError:
            raise QuantityError(f"theta'' is beyond float64 at theta = {theta}, omega = {omega}: give smaller rates, "
                                f"or use target='mpmath'.") from None
        except NameError as unknown:
            raise DriveError(f"the drive holds a function that NumPy does not have ({unknown}): use "
                             f"target='mpmath'.") from None
        except (np.linalg.LinAlgError, ZeroDivisionError):
            raise QuantityError(f"the mass matrix is singular at theta = {theta}: where rods have no mass, use "
                                f"scene.compile(values), which takes the limit.") from None

    def _floats(self, values: Any, name: str) -> list[float]:
        n = len(self.chain)
        array = float_state(values, name, n)
        if array.ndim != 1:
            raise SceneError(f"the chain has {n} rods, and {name} has shape {array.shape}: give {n} numbers.")
        return array.tolist()  # type: ignore[no-any-return]

    def _exact(self, values: Any, name: str) -> list[Any]:
        n, array = len(self.chain), one_array(values, name)
        if array.shape != (n,):
            raise SceneError(f"the chain has {n} rods, and {name} has shape {array.shape}: give {n} numbers.")
        found: list[Any] = MPNumbers(mpmath.mp).array(array).tolist()
        if not all(map(mpmath.isfinite, found)):
            raise QuantityError(f"{name} holds {found}, which is not finite: give finite numbers.")
        return found

    def _solved(self, M: Any, f: Any) -> Any:
        if self.target == "mpmath":
            return np.array(list(mpmath.lu_solve(M, f)), dtype=object)
        n = len(self.chain)
        found = np.linalg.solve(np.asarray(M, dtype=float).reshape(n, n), np.asarray(f, dtype=float).reshape(n))
        if not found.dot(found) < np.inf and not np.isfinite(found).all():
            raise QuantityError("theta'' is not finite for this state: give finite numbers.")
        return found

    def __reduce__(self) -> tuple[Any, ...]:
        """The arguments: generated code cannot be sent, and is generated again."""
        return CompiledEquations, (self.equations, self._values, self.target)

    def __len__(self) -> int:
        return len(self.chain)

    def __repr__(self) -> str:
        return f"CompiledEquations({self.equations.scene}, {self.target})"

    def _repr_latex_(self) -> str:
        return (r"$\ddot\theta = M(\theta)^{-1} f(t, \theta, \dot\theta), "
                rf"\quad n = {len(self.equations.scene)}, \quad \text{{{self.target}}}$")


def compile_equations(equations: EquationsOfMotion, values: Mapping[Any, Any] | None = None,
                      target: str = "numpy") -> CompiledEquations:
    """Symbolic equations of motion as a function of numbers.

    ``values`` maps Symbols to numbers; ``target`` is ``"numpy"``, ``"mpmath"`` (computed at mpmath's current
    precision) or ``"numba"`` (NumPy where numba is not installed).  What the scene has not, drive, dampers, springs,
    is not in the code.

    Raises NotASceneError for anything but equations, QuantityError where a Symbol has no number or the time has one,
    SceneError for an unknown target, TextError for text.

    >>> from sympy import symbols
    >>> from lagrangian import Rod, Scene, euler_lagrange
    >>> m, l, g = symbols("m l g")
    >>> equations = euler_lagrange(Scene([Rod.bob(m, l)] * 2))
    >>> compile_equations(equations, {m: 1, l: 1, g: 10}).acceleration(0, [0, 0], [0, 0])
    array([0., 0.])
    """
    if not isinstance(equations, EquationsOfMotion):
        raise NotASceneError(f"equations is {equations!r}, not EquationsOfMotion: give euler_lagrange(scene).")
    if not isinstance(target, str) or target not in TARGETS:
        raise SceneError(f"target is {target!r}: give one of {', '.join(TARGETS)}.")
    return CompiledEquations(equations, values, target)
