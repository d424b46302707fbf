"""Chains of physical rods on a moving support: Lagrangian, equations of motion, small motions, large motions.

    rods -> Scene -> euler_lagrange -> linearize -> first_order -> P, tau, period
                                                 -> normal_modes -> one Mathieu equation a mode
                  -> compile -> CompiledChain -> simulate -> Trajectory, with its own error

>>> from sympy import cos, symbols
>>> m, l, epsilon, omega0, t = symbols("m l epsilon omega0 t")
>>> scene = Scene([Rod.uniform(m, l)] * 2, Support(eta=epsilon*cos(omega0*t)))
>>> P, tau, period = linearize(euler_lagrange(scene)).first_order(omega0)
>>> P[2, 0], period
(-18*h*cos(tau)/7 + 18/(7*v**2), 2*pi)
"""

from .chain import CompiledChain
from .compiled import CompiledEquations, compile_equations
from .crossings import Crossing, flips
from .energy import Scene
from .ensemble import Ensemble
from .equations import EquationsOfMotion, euler_lagrange
from .errors import (
    DriveError,
    InhomogeneousError,
    LagrangianError,
    NameClashError,
    NotAnEquilibriumError,
    NotAQuantityError,
    NotASceneError,
    NotDecoupledError,
    NotInstalledError,
    NotPeriodicError,
    QuantityError,
    SceneError,
    TextError,
)
from .linearize import FirstOrderSystem, LinearEquations, linearize
from .normal_modes import NormalModes, normal_modes
from .scene import Rod, Support
from .simulate import simulate
from .trajectories import Trajectories
from .trajectory import Trajectory

__version__ = "0.1.0"

__all__ = [
    "CompiledChain",
    "CompiledEquations",
    "Crossing",
    "DriveError",
    "Ensemble",
    "EquationsOfMotion",
    "FirstOrderSystem",
    "InhomogeneousError",
    "LagrangianError",
    "LinearEquations",
    "NameClashError",
    "NormalModes",
    "NotAQuantityError",
    "NotASceneError",
    "NotAnEquilibriumError",
    "NotDecoupledError",
    "NotInstalledError",
    "NotPeriodicError",
    "QuantityError",
    "Rod",
    "Scene",
    "SceneError",
    "Support",
    "TextError",
    "Trajectories",
    "Trajectory",
    "compile_equations",
    "euler_lagrange",
    "flips",
    "linearize",
    "normal_modes",
    "simulate",
]
