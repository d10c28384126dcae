"""Definitions stay shared: lines that each use the one before twice cost what they are long, wherever they stand."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest
from counted import calls

from symgen.closedform.forms import derive_closed_forms
from symgen.diagnostics import ModelError
from symgen.generation.results import Options
from symgen.model.load import load_text
from symgen.pipeline import generate
from symgen.quantities.select import derive_quantities
from symgen.symbolic.angles.angle_forms import angle_form
from symgen.symbolic.graph import Graph
from symgen.verify.reference.reference import Reference

LINES = {
    "sines": "sin({before}) + {before}/3",
    "products": "sin({before})*cos({before})",
    "quotients": "cos({before})/(2 + cos({before})**2)",
    "roots": "sqrt(1 + {before}*{before})",
    "exponentials": "{before}*exp(-{before}**2)",
    "sums": "{before}/2 + {before}/3",
}
# All go the same way; what differs is what rewriting and closed forms make of them.
FEW = ("roots",)


def definitions(count: int, line: str, first: str) -> str:
    rows = [f"  k_0: {first}"]
    rows += [f"  k_{i}: {line.format(before=f'k_{i - 1}')}" for i in range(1, count + 1)]
    return "\n".join(rows)


def energies(count: int, line: str) -> str:
    return f"""model: spring_cam
coordinates: {{s: {{range: [-0.5, 0.5]}}, h: {{range: [-2, 2]}}}}
definitions:
{definitions(count, line, "0.7*s")}
kinetic_energy: s_dot**2*(2 + k_{count}**2/9) + h_dot**2
potential_energy: cos(k_{count})
constraints: {{geometric: {{cam: h - s - k_{count}/4}}}}
inputs: {{push: {{acts_on: {{s: 1}}}}}}
outputs: [inverse_dynamics, forward_dynamics, constraint_jacobian_dot, energy]
"""


def bodies(count: int, line: str) -> str:
    return f"""model: spring_arm
coordinates: {{a: {{unit: rad, range: [-0.5, 0.5]}}, b: {{unit: rad}}}}
definitions:
{definitions(count, line, "a/2")}
gravity: [0, -9.81, 0]
frames:
  upper: {{rotation: [[z, 2*a + k_{count}/5]]}}
  lower: {{parent: upper, translation: [0.4, 0, 0], rotation: [[z, b]]}}
bodies:
  upper: {{mass: 2, com: [0.2, 0, 0], inertia: {{zz: 0.1}}}}
  lower: {{mass: 1, com: [0.2, 0, 0], inertia: {{zz: 0.1}}}}
inputs: {{shoulder: {{acts_on: {{a: 1}}}}, elbow: {{acts_on: {{b: 1}}}}}}
outputs: [inverse_dynamics, forward_dynamics]
"""


def everything(text: str) -> None:
    """What a run does of the model: reading with all checks, derivation, closed forms, reference."""
    model = load_text(text, "nested.yaml")
    derived = derive_quantities(model, model.outputs)
    try:
        derive_closed_forms(model, {quantity.name: 100 for quantity in derived.quantities})
    except Exception as error:
        if type(error).__name__ != "TooLargeError":
            raise
    Reference(model, derived.generic)


@pytest.mark.parametrize(
    "kind", [kind if kind in FEW else pytest.param(kind, marks=pytest.mark.campaign) for kind in LINES]
)
@pytest.mark.parametrize("form", [energies, bodies], ids=["energies", "bodies"])
def test_twice_the_lines_are_twice_the_work(form: type, kind: str) -> None:
    few, many = (calls(partial(everything, form(count, LINES[kind])), 8_000_000) for count in (15, 30))
    assert many <= 3 * few


@pytest.mark.campaign
@pytest.mark.parametrize("form", [energies, bodies], ids=["energies", "bodies"])
def test_a_verified_run_ends_with_a_report_or_says_why_not(form: type, tmp_path: Path) -> None:
    path = tmp_path / "nested.yaml"
    path.write_text(form(40, LINES["sums"]))
    result = generate(path, Options(states=8), lambda _: None)
    assert not result.failures
    assert "c/" in " ".join(result.files)
    assert any(name.startswith("report/") for name in result.files)


def test_a_mistake_in_units_is_found_below_many_lines() -> None:
    text = energies(50, LINES["sums"]).replace("s: {range", "s: {unit: m, range").replace("k_0: 0.7*s", "k_0: s")
    with pytest.raises(ModelError, match="of something in m"):
        load_text(text, "nested.yaml")


@pytest.mark.campaign
def test_large_multiples_of_an_angle_take_few_steps() -> None:
    graph = Graph()
    angle = leaf = graph.symbol("x")
    for _ in range(200):
        angle = angle + angle - graph.symbol("y")
    assert angle_form(angle)[leaf] == 2**200
    assert calls(lambda: graph.trig("sin", angle), 100_000) < 20_000
