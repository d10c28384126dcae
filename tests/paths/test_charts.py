"""Charts of a path: complete, well-formed, and the same text every time."""

from __future__ import annotations

import functools
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from symgen.model.load import load_model, load_text
from symgen.paths.charts import charts
from symgen.paths.figures import figure_data

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
    for text in first.values():
        assert not re.search(r"dc:date|\b20\d\d-\d\d|/(home|tmp|usr)/", text)


def test_one_panel_for_every_unit() -> None:
    """The slider-crank has angles and a length; the RA-PKM angles only."""
    assert drawn("slider_crank")["coordinates"].count('id="axes_') == 2
    assert drawn("rapkm_2rrr_rr")["coordinates"].count('id="axes_') == 1


def test_zeros_are_marked() -> None:
    """Six triangles on the determinants, six lines through every other chart."""
    text = drawn("rapkm_2rrr_rr")
    triangles = re.findall(r'<path id="(\w+)" d="M 0 -3.5\s', text["determinants"])
    assert len(triangles) == 3
    assert [text["determinants"].count(f'<use xlink:href="#{triangle}"') for triangle in triangles] == [2, 2, 2]
    assert text["inputs"].count("stroke-dasharray: 1.4,1.4") == 6


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
