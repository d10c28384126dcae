"""Weights and forces that rows bear, whatever the configuration: left out of what does not depend on them."""

from __future__ import annotations

import pytest

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.mechanics.workless_forces import WorklessForces, without_workless_forces, workless_forces
from symgen.methods.selection import Methods
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.traverse import reached

# A rod between two balls that stand still: all that it does is spin about itself, whatever pulls it down.
ROD = """
model: rod
parameters: {{g: 9.81, m: 102, l: 0.7, k: 40, c: 0.3}}
gravity: {gravity}
joints:
  ball: {{type: spherical, coordinates: [e0, e1, e2, e3]}}
bodies:
  ball: {{mass: m, com: [{aside}, l/2, 0], inertia: {{xx: 0.5, yy: 0.02, zz: 0.5}}}}
points:
  tip: {{frame: ball, at: [0, l, 0]}}
  hook: {{at: [0.5, 0.4, 0.3]}}
constraints:
  geometric: {{beside: 0.8*tip.x - 0.6*tip.y, out: tip.z}}
springs:
  rope: {{between: [tip, hook], stiffness: k, length: 0.2, damping: c}}
inputs: {{twist: {{acts_on: {{e0: -e2, e1: -e3, e2: e0, e3: e1}}}}}}
configuration: {{e0: 0.8, e1: 0, e2: 0, e3: 0.6}}
"""
# Two slides, one of them held; what loads it, and what both rows bear, does no work.
SLIDES = """
model: slides
coordinates: {x: {}, y: {}, z: {}}
parameters: {m: 2, w: 30, k: 5}
kinetic_energy: m/2*(x_dot**2 + y_dot**2 + z_dot**2)
potential_energy: w*(x - y) - k*cos(x)
applied_forces: {z: -3*z_dot, x: -x_dot}
constraints: {geometric: {together: x - y - 1, held: z - 2}}
inputs: {push: {acts_on: {x: 1}}}
configuration: {x: 1, y: 0, z: 2}
"""
# Cranks side by side on one coupler: of four rows, three are independent on the constraints, and all beside them.
CRANKS = """
model: cranks
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}}
parameters: {l: 0.3, w: 0.8, k: 1}
kinetic_energy: a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2
potential_energy: k*(sin(a) + sin(b) + sin(c))
applied_forces: {c: -k*sin(c)}
constraints:
  geometric:
    right_x: l*cos(a) + w*cos(d) - w - l*cos(b)
    right_y: l*sin(a) + w*sin(d) - l*sin(b)
    middle_x: l*cos(a) + w/2*cos(d) - w/2 - l*cos(c)
    middle_y: l*sin(a) + w/2*sin(d) - l*sin(c)
configuration: {a: 1, b: 1, c: 1, d: 0}
"""


def _rod(aside: str = "0") -> Model:
    return load_text(ROD.format(gravity='["-0.6*g", "-0.8*g", "g"]', aside=aside), "rod.yaml")


def _workless(model: Model) -> WorklessForces:
    return workless_forces(model, genericity(System(model)))


def test_the_weight_of_a_rod_between_balls_that_stand_still_does_no_work() -> None:
    assert _workless(_rod()).weights


def test_a_weight_that_works_is_kept() -> None:
    assert not _workless(_rod(aside="0.1")).weights


def test_terms_of_energies_and_loads_of_coordinates_are_told_apart() -> None:
    assert _workless(load_text(SLIDES, "slides.yaml")) == WorklessForces(terms=frozenset({0}), loads=frozenset({0}))


def test_what_does_no_work_on_the_constraints_alone_is_kept() -> None:
    text = SLIDES.replace("w*(x - y) - k*cos(x)", "w*(x - y - 1)*y")
    assert _workless(load_text(text, "slides.yaml")).terms == frozenset()


def test_nothing_is_said_where_rows_lose_rank_on_the_constraints() -> None:
    assert _workless(load_text(CRANKS, "cranks.yaml")) == WorklessForces()


@pytest.mark.parametrize("quantity", ["inverse_dynamics", "forward_dynamics"])
@pytest.mark.parametrize("model", [_rod(), load_text(SLIDES, "slides.yaml")], ids=["rod", "slides"])
def test_what_is_left_has_the_same_inputs_and_accelerations_exactly(model: Model, quantity: str) -> None:
    generic = genericity(System(model))
    bare = without_workless_forces(model, _workless(model))
    assert bare != model
    values = []
    for one in (model, bare):
        # with all rows and forces, and by the same method
        candidate = Methods(one, generic).candidate(quantity, "kkt")
        assert not isinstance(candidate, str)
        values.append(ExactValues()(candidate.derived.outputs))
    assert values[0] == values[1]
    assert None not in values[0]


def test_multipliers_keep_what_the_rows_bear_and_nothing_else_reads_it() -> None:
    derivations = derive_quantities(_rod(), ["multipliers", "forward_dynamics", "projected_potential_force"])
    weight = derivations.mechanics.graph.symbol("g")
    reading = {derived.name for derived in derivations.quantities if weight in reached(derived.outputs)}
    assert reading == {"multipliers"}
    projected = next(one for one in derivations.quantities if one.name == "projected_potential_force")
    assert all(entry.is_zero for entry in projected.outputs)
