"""The structure analysis: blocks of B with their freedom, vanishing parts, shared work, each with its reason."""

from __future__ import annotations

import pytest
import shipped

from symgen.mechanics.genericity import genericity
from symgen.mechanics.structure import Structure, analyse
from symgen.mechanics.system import System
from symgen.model.load import load_text

BLOCKS = """\
model: blocks
coordinates: {a: {}, b: {}, c: {}, d: {}, e: {}, f: {}, g: {}, h: {}, k: {}, i: {}}
parameters: {m: 1, l: 2}
kinetic_energy: >-
  m/2*(a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2 + e_dot**2 + f_dot**2 + g_dot**2 + h_dot**2 + k_dot**2 + i_dot**2)
  + m/4*cos(c + d)*c_dot*d_dot
potential_energy: m*l*cos(c)*sin(d)
constraints:
  geometric: {one: a + sin(a)}
  nonholonomic:
    two: b_dot + c*c_dot
    three: d_dot + 2*e_dot + f*f_dot
    four: g_dot + sin(h)*h_dot + k_dot + cos(g)*i_dot
    five: 2*b_dot + 2*c*c_dot
inputs: {u: {acts_on: {b: 1, d: l}}, v: {acts_on: {f: 1}}}
"""
ROBOT = """\
model: redundant
coordinates: {x: {}, y: {}}
kinetic_energy: x_dot**2 + y_dot**2
constraints: {nonholonomic: {row: x_dot + y_dot}}
inputs: {u: {acts_on: {x: 1}}, v: {acts_on: {y: 1}}}
"""


def analysed(text: str) -> Structure:
    mechanics = System(load_text(text, "m.yaml"))
    return analyse(mechanics, genericity(mechanics))


def reasons(text: str) -> dict[str, str]:
    return {decision.what: decision.why for decision in analysed(text).decisions}


def test_blocks_with_rank_and_freedom() -> None:
    structure = analysed(BLOCKS)
    by_rows = {block.rows: (block.coordinates, block.rank, block.delta) for block in structure.blocks}
    assert by_rows == {
        ("one",): (("a",), 1, 0),
        ("two", "five"): (("b", "c"), 1, 1),
        ("three",): (("d", "e", "f"), 1, 2),
        ("four",): (("g", "h", "k", "i"), 1, 3),
    }
    assert structure.dependent_rows == ("two", "five")
    assert structure.free_coordinates == ()
    ways = [block.null_space for block in structure.blocks]
    assert [way.split(",")[0] for way in ways] == [
        "locked",
        "one direction",
        "its minors",
        "4 minors or Householder reflections",
    ]


def test_every_block_has_its_reason() -> None:
    explanations = reasons(BLOCKS)
    assert explanations["coupling between constraint blocks"].startswith("the rows fall into 4 blocks: one on a; ")
    assert explanations["(B Bᵀ)⁻¹ of one"] == "δ = 0 for 1 coordinate: locked, no velocity is left"
    assert explanations["(B Bᵀ)⁻¹ of three"].startswith("δ = 2 for 3 coordinates: its minors")


def test_zero_and_constant_parts() -> None:
    explanations = reasons(BLOCKS)
    assert explanations["38 of 50 entries of B"] == "they are zero"
    assert explanations["rates of 6 of 50 entries of B"] == "they are constant"
    assert explanations["17 of 20 entries of M"] == "they are zero"
    assert explanations["8 of 10 potential forces"] == "they are zero"
    assert explanations["44 of 45 couplings in G"] == "they are zero"
    assert explanations["derivatives of 10 of 55 entries of G"] == "they are constant"
    assert explanations["the values of b, e, k, i"] == "only their rates and accelerations matter"


@pytest.mark.parametrize(("name", "looked_through"), [("chain8", True), ("chain16", False)])
def test_a_large_mass_matrix_of_bodies_is_not_formed(name: str, looked_through: bool) -> None:
    """u does without it: to look through that of 32 links takes ten times as long as all the rest."""
    mechanics = System(shipped.model(name))
    subjects = {decision.what for decision in analyse(mechanics, genericity(mechanics)).decisions}
    assert ("mass_matrix" in vars(mechanics)) is looked_through
    assert any("entries of G" in what or "couplings in G" in what for what in subjects) is looked_through


def test_shared_work() -> None:
    explanations = reasons(BLOCKS)
    assert "sine and cosine of c + d" in explanations
    assert any(what.startswith("repeated work on ") for what in explanations)


def test_redundant_inputs_are_summed() -> None:
    assert reasons(ROBOT)["switching between choices of inputs"] == "m = 2 inputs for δ = 1: all 2 choices are summed"
    assert reasons(ROBOT)["rates of B and N_B"] == "the constraint Jacobian is constant"
    assert "minimum-norm step" not in reasons(ROBOT)
