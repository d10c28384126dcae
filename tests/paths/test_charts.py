"""Charts of a path: complete, well-formed, and the same text every time."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.mathtext import MathTextParser

from symgen.model.load import load_model, load_text
from symgen.paths.charts import Line, Panel, charts, draw_panels, panels_of, symbol
from symgen.paths.drawing import svg
from symgen.paths.figures import FigureData, figure_data

MODELS = Path(__file__).parents[2] / "models"


@functools.cache
def data_of(name: str) -> FigureData:
    model = load_model(MODELS / f"{name}.yaml")
    return figure_data(model, model.paths[0])


@functools.cache
def drawn(name: str) -> dict[str, str]:
    return charts(load_model(MODELS / f"{name}.yaml"), data_of(name))


def axes_of(times: Any, panels: Sequence[Panel]) -> list[Any]:
    figure = Figure()
    draw_panels(figure, times, panels)
    return list(figure.axes)


def axes_of_model(name: str, chart: str) -> list[Any]:
    data = data_of(name)
    return axes_of(data.trajectory.t, panels_of(load_model(MODELS / f"{name}.yaml"), data)[chart])


@pytest.mark.parametrize("name", ["rapkm_2rrr_rr", "slider_crank"])
def test_every_chart_is_there_and_well_formed(name: str) -> None:
    assert list(drawn(name)) == ["coordinates", "determinants", "inputs"]
    for text in drawn(name).values():
        assert ElementTree.fromstring(text).tag.endswith("svg")
        assert len(text) < 100_000


def test_charts_are_reproducible() -> None:
    first = dict(drawn("slider_crank"))
    drawn.cache_clear()
    assert drawn("slider_crank") == first


def test_one_panel_for_every_unit() -> None:
    """The slider-crank has angles and a length; the RA-PKM angles only."""
    assert [axis.get_ylabel() for axis in axes_of_model("slider_crank", "coordinates")] == [
        "coordinates in rad",
        "coordinates in m",
    ]
    assert len(axes_of_model("rapkm_2rrr_rr", "coordinates")) == 1


def test_curves_are_the_numbers() -> None:
    data = data_of("slider_crank")
    angles, lengths = axes_of_model("slider_crank", "coordinates")
    shown = [np.asarray(line.get_ydata()) for line in (*angles.lines[:2], lengths.lines[0])]
    assert np.array_equal(np.array(shown).T, data.trajectory.q)
    assert angles.get_xlim() == (data.trajectory.t[0], data.trajectory.t[-1])


def test_zeros_are_marked() -> None:
    """Six triangles on the determinants, two a curve in its colour, and six lines through every other chart."""
    data = data_of("rapkm_2rrr_rr")
    (axis,) = axes_of_model("rapkm_2rrr_rr", "determinants")
    marks = [line for line in axis.lines if line.get_marker() == "^"]
    curves = [line for line in axis.lines if line.get_linestyle() != "None" and len(line.get_xdata()) > 2]
    assert [tuple(mark.get_xdata()) for mark in marks] == [curve.zeros for curve in data.curves]
    assert [mark.get_color() for mark in marks] == [line.get_color() for line in curves]
    (axis,) = axes_of_model("rapkm_2rrr_rr", "inputs")
    verticals = [line.get_xdata()[0] for line in axis.lines if list(line.get_ydata()) == [0, 1]]
    assert verticals == sorted(t for curve in data.curves for t in curve.zeros)
    assert len(verticals) == 6


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("values", [[3.0, 3.0, 3.0], [0.0, 0.0, 0.0], [1e-30, -1e-30, 0.0], [math.nan] * 3])
def test_flat_and_tiny_curves_have_axes(values: list[float]) -> None:
    panels = [Panel("f", (Line("f", np.array(values)),))] * 2
    for axis in axes_of(np.array([0.0, 0.5, 1.0]), panels):
        low, high = axis.get_ylim()
        assert low < high
    text = svg(lambda figure: draw_panels(figure, np.array([0.0, 0.5, 1.0]), panels), 4.0)
    assert ElementTree.fromstring(text).tag.endswith("svg")


def test_a_curve_is_interrupted_where_it_has_no_value() -> None:
    values = np.array([0.0, math.nan, 1.0, 2.0, math.inf, 1.0])
    (axis,) = axes_of(np.arange(6.0), [Panel("f", (Line("f", values),))])
    shown = np.asarray(axis.lines[0].get_ydata())
    assert np.isnan(shown[[1, 4]]).all()
    assert np.array_equal(shown[[0, 2, 3, 5]], values[[0, 2, 3, 5]])


@pytest.mark.parametrize(
    ("name", "formula"),
    [
        ("theta_1", r"$\mathit{θ}_{\mathrm{1}}$"),
        ("theta1", r"$\mathit{θ}_{\mathrm{1}}$"),
        ("x", r"$\mathit{x}$"),
        ("tip_left_2", r"$\mathrm{tip}_{\mathrm{left\ 2}}$"),
        ("a__b", r"$\mathit{a}_{\mathrm{\ b}}$"),
        ("l2_long", r"$\mathrm{l2\_long}$"),
    ],
)
def test_names_are_formulas(name: str, formula: str) -> None:
    assert symbol(name) == formula
    MathTextParser("path").parse(formula)


@pytest.mark.parametrize(
    ("inputs", "expected"),
    [("", ["coordinates"]), ("inputs: {f: {acts_on: {x: 1}}}", ["coordinates", "inputs"])],
)
def test_systems_with_fewer_inputs_than_degrees_of_freedom(inputs: str, expected: list[str]) -> None:
    text = f"""
model: free
coordinates: {{x: {{}}, y: {{}}}}
kinetic_energy: x_dot**2 + y_dot**2
{inputs}
paths: {{go: {{duration: 1, samples: 5, conditions: {{along: x - t**2, across: y}}}}}}
"""
    model = load_text(text, "free.yaml")
    data = figure_data(model, model.paths[0])
    assert (data.curves, data.printed) == ((), None)
    assert list(charts(model, data)) == expected
    if model.inputs:
        assert data.u[:, 0] == pytest.approx(4.0)
