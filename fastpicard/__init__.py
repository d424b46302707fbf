r"""Exact Picard iterates for linear differential equations with periodic coefficients.

``x' = P(t) x`` with ``P`` a finite trigonometric polynomial whose coefficients
may hold symbolic parameters: the port and continuation of Armando G. M. Neves'
Mathematica package FastPicard ([Neves]: "Approximating Solutions of Linear
Ordinary Differential Equations with Periodic Coefficients by Exact Picard
Iterates", The Mathematica Journal 10(1), 2006).

The order in which the files are best read, which is the order in which they may import one another, stands in
``setup.cfg``, and the import linter holds it.
"""

from fastpicard.boundaries import Boundary, Root, boundaries
from fastpicard.certify import CertifiedChart, certify
from fastpicard.chart import chart
from fastpicard.crossing import crossing
from fastpicard.errors import (
    BadInputError,
    BadTypeError,
    FastPicardError,
    MissingParameterError,
    NotInFamilyError,
    NotInstalledError,
    NotPeriodicError,
    ShapeError,
)
from fastpicard.floquet import FloquetMatrix
from fastpicard.integrate import gather, new_integrate, product_to_sum
from fastpicard.mathieu import mathieu_a, mathieu_b
from fastpicard.mathieu_solutions import mathieu_c, mathieu_exponent, mathieu_s
from fastpicard.matrix import SeriesMatrix
from fastpicard.picard import FundamentalMatrix, PicardIterate, fast_picard, picard
from fastpicard.series import PoissonSeries
from fastpicard.spectrum import Multiplier
from fastpicard.stability import Verdict
from fastpicard.tables import tabulate
from fastpicard.tubes import Tube, Tubes, tubes

__version__ = "0.1.0"

__all__ = [
    "BadInputError",
    "BadTypeError",
    "Boundary",
    "CertifiedChart",
    "FastPicardError",
    "FloquetMatrix",
    "FundamentalMatrix",
    "MissingParameterError",
    "Multiplier",
    "NotInFamilyError",
    "NotInstalledError",
    "NotPeriodicError",
    "PicardIterate",
    "PoissonSeries",
    "Root",
    "SeriesMatrix",
    "ShapeError",
    "Tube",
    "Tubes",
    "Verdict",
    "boundaries",
    "certify",
    "chart",
    "crossing",
    "fast_picard",
    "gather",
    "mathieu_a",
    "mathieu_b",
    "mathieu_c",
    "mathieu_exponent",
    "mathieu_s",
    "new_integrate",
    "picard",
    "product_to_sum",
    "tabulate",
    "tubes",
]
