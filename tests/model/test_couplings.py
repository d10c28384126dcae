"""Couplings: what follows others by a gear is a row of its own, and mistakes in it are told where they stand."""

from __future__ import annotations

import pytest

import symgen
from symgen.diagnostics import ModelError
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.traverse import substitute

WINCH = """
model: winch
coordinates: {motor: {unit: rad}, drum: {unit: rad}, x: {unit: m}}
parameters:
  r: {value: 0.05, unit: m}
  i: 12
  J: {value: 2e-4, unit: kg*m**2}
  m: {value: 8, unit: kg}
  g: {value: 9.81, unit: m/s**2}
kinetic_energy: J/2*motor_dot**2 + m/2*x_dot**2
potential_energy: m*g*x
inputs: {T: {unit: N*m, acts_on: {motor: 1}}}
"""
COUPLED = f"{WINCH}coupling: {{motor: i*drum, x: r*drum}}\n"
WRITTEN = f"{WINCH}constraints: {{geometric: {{motor_coupling: motor - i*drum, x_coupling: x - r*drum}}}}\n"


def _mistakes(text: str) -> list[tuple[str, str, int]]:
    with pytest.raises(ModelError) as error:
        load_text(text, "winch.yaml")
    return [(one.message, one.remedy, one.span.column) for one in error.value.mistakes]


def test_a_coupling_is_the_row_that_one_would_write() -> None:
    coupled, written = load_text(COUPLED, "winch.yaml"), load_text(WRITTEN, "winch.yaml")
    rows = [[(row.name, row.kind, row.expression) for row in one.constraints] for one in (coupled, written)]
    assert rows[0] == rows[1]
    for quantity in ("inverse_dynamics", "forward_dynamics", "multipliers"):
        values = [ExactValues()(derive_quantities(one, [quantity]).quantities[0].outputs) for one in (coupled, written)]
        assert values[0] == values[1]


def test_the_torque_is_what_a_winch_needs() -> None:
    derived = derive_quantities(load_text(COUPLED, "winch.yaml"), ["inverse_dynamics"])
    (torque,) = derived.quantities[0].outputs
    mechanics: System = derived.mechanics
    graph = mechanics.graph
    r, i, inertia, m, g = (graph.symbol(name) for name in ("r", "i", "J", "m", "g"))
    # by virtual work along the one motion, of accelerations that keep the rows
    (_, drum, _) = mechanics.qdd
    by_hand = inertia * i * drum + m * r / i * (r * drum + g)
    kept = {mechanics.qdd[0]: i * drum, mechanics.qdd[2]: r * drum}
    assert ExactValues()(substitute(graph, [torque], kept)) == ExactValues()([by_hand])


def test_what_is_no_coordinate_or_follows_itself_is_a_mistake_at_its_place() -> None:
    text = WINCH + "coupling:\n  motro: i*drum\n  x: r*drum + x/2\n"
    assert _mistakes(text) == [
        ("`motro` in `coupling` is no coordinate", "did you mean `motor`?", 3),
        (
            "the coupling of `x` holds `x` itself",
            "write what `x` follows of other coordinates, or a row under `constraints`",
            6,
        ),
    ]


def test_units_and_names_are_checked_as_in_any_row() -> None:
    clashing = [one for one in _mistakes(WINCH + "coupling: {x: g*drum}\n") if "this term is in" in one[0]]
    assert [message for message, _, _ in clashing] == ["this term is in m/s**2, the one before in m"]
    clash = COUPLED.replace("coupling: {", "constraints: {geometric: {x_coupling: x - r*drum}}\ncoupling: {")
    taken = "the row `x_coupling` that is made here has the name of another thing (constraint row)"
    assert _mistakes(clash)[0][0] == taken


def test_the_builder_has_the_word() -> None:
    made = symgen.Model("winch")
    made.coordinate("a")
    made.coordinate("b")
    made.kinetic_energy("a_dot**2 + b_dot**2")
    made.coupling(a="2*b")
    assert "coupling:\n  a: 2*b\n" in made.text
