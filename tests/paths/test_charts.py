"""Charts of a path: complete, well-formed, and the same text every time."""

from __future__ import annotations

import functools
import math
import re
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from symgen.model.load import load_model, load_text
from symgen.paths.charts import charts
from symgen.paths.figures import figure_data
from symgen.paths.line_chart import Line, Panel, line_chart, plain, ticks

MODELS = Path(__file__).parents[2] / "models"


@functools.cache
def drawn(name: str) -> dict[str, str]:
    model = load_model(MODELS / f"{name}.yaml")
    return charts(model, figure_data(model, model.paths[0]))


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
    assert drawn("slider_crank")["coordinates"].count('<g class="panel">') == 2
    assert drawn("rapkm_2rrr_rr")["coordinates"].count('<g class="panel">') == 1


def test_zeros_are_marked() -> None:
    """Six triangles on the determinants, six lines through every other chart."""
    text = drawn("rapkm_2rrr_rr")
    triangles = re.findall(r'<polygon class="zero" .* fill="(#\w+)"/>', text["determinants"])
    assert sorted(Counter(triangles).values()) == [2, 2, 2]
    assert text["inputs"].count('<line class="zero"') == 6


def test_ticks_are_round_and_enough() -> None:
    assert ticks(0.0, 1.0) == pytest.approx([0, 0.2, 0.4, 0.6, 0.8, 1.0])
    assert ticks(-3.1, 2.7) == pytest.approx([-3, -2, -1, 0, 1, 2])
    assert ticks(12.0, 12.001) == pytest.approx([12, 12.0002, 12.0004, 12.0006, 12.0008, 12.001])
    assert ticks(0.0, 1.7e6) == pytest.approx([0, 2e5, 4e5, 6e5, 8e5, 1e6, 1.2e6, 1.4e6, 1.6e6])


@pytest.mark.parametrize("values", [[3.0, 3.0, 3.0], [0.0, 0.0, 0.0], [1e-30, -1e-30, 0.0], [math.nan] * 3])
def test_flat_and_tiny_curves_have_axes(values: list[float]) -> None:
    text = line_chart(np.array([0.0, 0.5, 1.0]), [Panel(plain("f"), (Line(plain("f"), np.array(values)),))], 100.0)
    numbers = [float(x) for x in re.findall(r' (?:x1|y1|x2|y2|x|y)="([^"]+)"', text)]
    assert all(map(math.isfinite, numbers))
    assert text.count("<text") >= 8


def test_a_curve_is_interrupted_where_it_has_no_value() -> None:
    values = np.array([0.0, math.nan, 1.0, 2.0, math.inf, 1.0])
    text = line_chart(np.arange(6.0), [Panel(plain("f"), (Line(plain("f"), values),))], 100.0)
    (path,) = re.findall(r'<path d="([^"]+)"', text)
    assert (path.count("M"), path.count("L")) == (3, 1)


def test_powers_of_ten_stand_beside_the_axis() -> None:
    values = np.array([0.0, 2e-7, 4e-7])
    text = line_chart(np.arange(3.0), [Panel(plain("f"), (Line(plain("f"), values),))], 100.0)
    assert "×10" in text
    assert ">−7</tspan>" in text
    assert ">4</text>" in text


def test_texts_are_escaped() -> None:
    panel = Panel(plain("a < b & c"), (Line(plain("<x>"), np.zeros(2)),), title="<t>", note=("<n>",))
    ElementTree.fromstring(line_chart(np.arange(2.0), [panel], 100.0))


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
