"""Charts of points: pixels agree with what is proved, and truncation is visible."""

import pickle

import matplotlib
import numpy as np
import pytest
from sympy import Matrix, Rational, Symbol, cos, sin, sqrt
from sympy.abc import a, b, c, h, t, v

from fastpicard import BadInputError, BadTypeError, FloquetMatrix, certify, chart, tubes
from fastpicard.plotting import raster

matplotlib.use("Agg")
P = Matrix([[0, 1], [-a - b * cos(t), 0]])
MATHIEU, ROUGH = FloquetMatrix(P, t, 40), FloquetMatrix(P, t, 12)
DAMPED = FloquetMatrix(Matrix([[0, 1], [-a - b * cos(t), -c]]), t, 30)
MODES = [{a: -mu / v**2, b: mu * h} for mu in (3 - 6 / sqrt(7), 3 + 6 / sqrt(7))]


@pytest.mark.parametrize("x, y, more", [((a, -1, 2), (b, 0, 2), {}), ((h, 0, 0.1), (v, 0.1, 100), {"modes": MODES})])
@pytest.mark.parametrize("F", [MATHIEU, ROUGH])
def test_pixels_agree_with_certified_cells(F, x, y, more):
    """Wherever both decide; at order 12 as well, where the error bound says what the iterate cannot know."""
    data, proved = chart(F, x, y, points=(97, 89), **more), certify(F, x, y, undecided=1e-3, seconds=600, **more)
    first, second = data[str(x[0])].values, data[str(y[0])].values
    for i in range(0, 89, 4):
        for j in range(0, 97, 4):
            assert int(data["verdict"][i, j]) * int(proved.verdict(first[j], second[i])) >= 0


def test_errors_bound_the_true_margin():
    """At order 12 against the true trace."""
    data = chart(ROUGH, (a, -1, 3), (b, 0, 2), points=(7, 5))
    for y in data["b"].values:
        for x in data["a"].values:
            cell = data.sel(a=x, b=y)
            true = float(MATHIEU.enclosure({a: float(x), b: float(y)}, 20).trace())
            assert abs(float(cell["trace"]) - true) <= float(cell["error"])


def test_the_error_is_a_bound_only_where_no_parameter_is_rounded():
    """Modes round theirs, and where large ones cancel the trace moves by more than any share of its size."""
    modes = [{a: sqrt(2) * h, b: sqrt(2) * v}]
    axes = (a, 0, 1), (b, 0, 1)

    assert chart(ROUGH, *axes, points=(3, 2)).attrs["error_is"] == "bound"
    assert chart(ROUGH, (h, 0, 1), (v, 0, 1), points=(3, 2), modes=modes).attrs["error_is"] == "estimate"


def test_undecided_is_shown_where_truncation_matters():
    """The seventh boundary of Out[26], 2.2506565 at b = 0.1, is none that twelve iterates may claim."""
    data = chart(ROUGH, (a, 2, 3), (b, 0, 0.2), points=(20, 20))

    assert (data["verdict"] == 0).all()
    assert data.attrs["order"] == 12


def test_coupled_and_damped_systems():
    """By eigenvalues; the two rods as a system of four against their modes, and damping."""
    S = Matrix([[18, -9], [-27, 24]]) / 7 * (-1 / v**2 + h * cos(t))
    coupled = FloquetMatrix(Matrix.zeros(2).row_join(Matrix.eye(2)).col_join((-S).row_join(Matrix.zeros(2))), t, 30)
    whole = chart(coupled, (h, 0, 0.1), (v, 20, 100), points=(23, 19))
    modes = chart(MATHIEU, (h, 0, 0.1), (v, 20, 100), points=(23, 19), modes=MODES)
    damped = chart(DAMPED, (a, 0, 1), (b, 0, 1), points=(9, 9), fixed={c: Rational(1, 5)})

    both = (whole["verdict"].values != 0) & (modes["verdict"].values != 0)
    assert both.mean() > 0.9
    assert (whole["verdict"].values == modes["verdict"].values)[both].all()
    assert int(damped["verdict"].sel(a=0.5, b=0.1, method="nearest")) == 1


def test_a_diagonal_that_changes_areas_at_half_the_period_is_taken_along():
    """P = [[b sin t, 1], [-a, 0]] reverses in time, but det Phi(T/2) = exp(2 b): the trace is not 2 + 4 B C."""
    F = FloquetMatrix(Matrix([[b * sin(t), 1], [-a, 0]]), t, 40)
    data = chart(F, (a, 0.1, 1), (b, -1, 1), points=(10, 9))
    for y in data["b"].values:
        for x in data["a"].values:
            cell = data.sel(a=x, b=y)
            assert abs(float(cell["trace"]) - F.trace_at({a: float(x), b: float(y)})) <= float(cell["error"])


def test_weak_sum_resonance_is_not_stable():
    """Frequencies 1/3 + 2/3 = 1: rho leaves the real line by 1e-8 and more, far more than the error."""
    P = Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-Rational(1, 9) - a, -b * cos(t), 0, 0],
                [-b * cos(t), -Rational(4, 9), 0, 0]])
    data = chart(FloquetMatrix(P, t, 60), (a, -1e-9, 1e-9), (b, 1e-8, 9e-7), points=(3, 5))

    assert float(data["error"].max()) < 1e-11
    assert (data["verdict"] == -1).all()


@pytest.mark.parametrize("n", [28, 32, 36])
def test_the_error_of_coupled_charts_covers_rho_off_the_real_line_by_truncation(n):
    """Two oscillators without coupling at b = 0: their rho are 2 cos(2 pi omega), of the iterate nearly so."""
    P = Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-a, 0, 0, 0], [0, -Rational(5, 12) - b * cos(t), 0, 0]])
    data = chart(FloquetMatrix(P, t, n), (a, 1.5, 1.6), (b, 0, 0.1), points=(3, 3)).sel(b=0)
    for x in data["a"].values:
        cell = data.sel(a=x)
        true = 2 - max(abs(2 * np.cos(2 * np.pi * np.sqrt(omega2))) for omega2 in (x, 5 / 12))
        assert abs(float(cell["margin"]) - true) <= float(cell["error"])


def test_equal_oscillators_keep_each_other_on_the_circle():
    """Their multipliers coincide, with one signature; where eigenvectors are nearly parallel floats cannot tell."""
    S = a + b * cos(t)
    P = Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [-S, 0, 0, 0], [0, -S, 0, 0]])
    data = chart(FloquetMatrix(P, t, 40), (a, 0.05, 0.2), (b, 0, 0.1), points=(20, 20))
    alone = chart(MATHIEU, (a, 0.05, 0.2), (b, 0, 0.1), points=(20, 20))

    assert (data["verdict"] * alone["verdict"] >= 0).all()
    assert float((data["verdict"] == 1).mean()) > 0.7


def test_the_axes_of_a_chart_have_names_of_their_own():
    """Not those of its arrays, nor one name for two Symbols."""
    with pytest.raises(BadInputError, match="arrays called trace"):
        chart(FloquetMatrix(P.subs(a, Symbol("error")), t, 3), (Symbol("error"), 0, 1), (b, 0, 1))
    with pytest.raises(BadInputError, match="different names"):
        chart(MATHIEU, (a, 0, 1), (Symbol("a", positive=True), 0, 1))


@pytest.mark.parametrize("F, fixed", [(MATHIEU, None), (DAMPED, {c: Rational(1, 5)})])
def test_a_chart_in_parts_is_the_chart(F, fixed):
    """Computed when it is asked for; the trace to the last bit, and all where no eigenvalues are taken.

    LAPACK's last bits depend on where a matrix lies in memory: in the error they count as often as the condition of
    the eigenvectors, here up to 1e8 times.
    """
    axes = {"x": (a, -1, 2), "y": (b, 0, 2), "points": (31, 23), "fixed": fixed}
    whole, parts = chart(F, **axes), chart(F, **axes, chunks=(10, 7))
    assert parts.trace.chunks == ((7, 7, 7, 2), (10, 10, 10, 1))
    found = parts.compute()
    if fixed is None:
        assert found.identical(whole)
    assert found[["trace", "verdict"]].identical(whole[["trace", "verdict"]])
    assert found.attrs == whole.attrs
    np.testing.assert_allclose(found.margin, whole.margin, rtol=0, atol=1e-7)
    np.testing.assert_allclose(found.error, whole.error, rtol=1e-6)


def test_a_chart_can_be_pickled():
    """And draws itself still."""
    data = chart(ROUGH, (a, -1, 1), (b, 0, 1), points=(3, 3))
    again = pickle.loads(pickle.dumps(data))
    assert again.identical(data) and again.plot().get_xlabel()


def test_plots_are_drawn_with_labels():
    """Both kinds of chart; undecided pixels are those of the cells."""
    data = chart(MATHIEU, (a, -1, 2), (b, 0, 2), points=(20, 20))
    axes = data.plot(xlabel="stiffness a", ylabel="b", title="Mathieu")
    proved = certify(MATHIEU, (a, -1, 2), (b, 0, 2), undecided=1e-2, seconds=600)
    curves = tubes(MATHIEU, (a, 0, 0.5), (b, 0, 0.2))
    other = proved.with_tubes(curves).plot()
    codes = raster(proved, 60, 40)

    assert len(other.lines) == len(curves.pieces) > 0
    assert axes.get_xlabel() == "stiffness a" and other.get_xlabel() == "$a$"
    assert set(np.unique(codes)) == {-1, 0, 1}
    for i in range(0, 60, 7):
        for j in range(0, 40, 7):
            x, y = -1 + 3 * (i + 0.37) / 60, 2 * (j + 0.61) / 40
            assert codes[i, j] in (0, int(proved.verdict(x, y)))
    for picture in (axes, other):
        matplotlib.pyplot.close(picture.figure)


def test_tubes_are_lines_of_charts_of_modes():
    """v = sqrt(-mu/a), h = b/mu: every line that is drawn lies on the boundary; other planes are refused."""
    curves = tubes(MATHIEU, (a, -0.5, 0), (b, 0, 0.4))
    proved = certify(MATHIEU, (h, 0, 0.075), (v, 10, 100), modes=MODES, undecided=1e-3, seconds=600)
    drawn = proved.with_tubes(curves, MODES)
    axes = drawn.plot()
    points = np.concatenate([line.get_xydata() for line in axes.lines])
    points = points[points[:, 1] < 95]  # finite, and with room above
    legend = [text.get_text() for text in axes.get_legend().get_texts()]

    assert any("boundary" in text for text in legend) and drawn.radius == curves.radius
    assert len(points) > 100
    for x, y in points[::len(points) // 25]:
        sides = [int(proved.verdict(x, y * (1 + k * 0.02))) for k in (-1, 1)]
        assert sides == [-1, 1] or sides == [1, -1], (x, y)
    with pytest.raises(BadInputError, match="modes"):
        proved.with_tubes(curves)
    with pytest.raises(BadInputError, match="determine"):
        proved.with_tubes(curves, [{a: h, b: h**2}])
    for wrong, error, message in ((3, BadTypeError, "list of dictionaries, but they are 3"),
                                  ([{a: h}], BadInputError, "must give both parameters .a, b. .* but it is {a: h}")):
        with pytest.raises(error, match=message):
            proved.with_tubes(curves, wrong)
    with pytest.raises(BadTypeError, match="those of Tubes, but these are None"):
        proved.with_tubes(None)
    matplotlib.pyplot.close(axes.figure)


@pytest.mark.parametrize("points, error", [((1, 5), BadInputError), (400, BadTypeError), ((2.5, 3), BadTypeError)])
def test_a_chart_needs_points(points, error):
    """Two at least along each axis."""
    with pytest.raises(error, match="points"):
        chart(MATHIEU, (a, 0, 1), (b, 0, 1), points=points)


@pytest.mark.parametrize("chunks, error", [((0, 5), BadInputError), (400, BadTypeError)])
def test_parts_of_a_chart_have_points(chunks, error):
    """One at least along each axis."""
    with pytest.raises(error, match="chunks"):
        chart(MATHIEU, (a, 0, 1), (b, 0, 1), points=(5, 5), chunks=chunks)
