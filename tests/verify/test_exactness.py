"""Kernels are told to be other functions, or the same ones, whatever digits they lose: by exact values on V."""

from __future__ import annotations

from dataclasses import replace

import pytest

from symgen.ir.kernel import Kernel
from symgen.ir.pairs.wide import widened
from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.verify.exactness import ExactStates
from symgen.verify.expected import Expected
from symgen.verify.interpreted import measured

# A crank, one that turns with it and one that turns with that: two rows say what the others do, on V alone.
CRANKS = """
model: follower
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}}
parameters: {J: {value: 0.3, unit: kg*m**2}, e: {value: J/7*sin(2), unit: kg*m**2}}
kinetic_energy: J*a_dot**2 + 2*e*b_dot**2 + J/3*c_dot**2
constraints:
  geometric: {x: sin(a) - sin(b), y: cos(a) - cos(b), behind: b - c, round: a - c}
inputs: {M: {acts_on: {a: 1}}}
configuration: {a: 0.4, b: 0.4, c: 0.4}
"""
# Nothing pushes or weighs the third wheel: the force in the teeth is 0 at every state, as a sum that cancels.
GEARS = """
model: gears
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}}
kinetic_energy: 1.2/2*a_dot**2 + 0.75/2*b_dot**2
potential_energy: 5.9*cos(a) + 6.3*cos(b)
constraints:
  nonholonomic: {teeth: a_dot/3 + b_dot/7 + 3*c_dot}
inputs: {M: {acts_on: {a: -1}}}
"""
MODELS = {"cranks": load_text(CRANKS, "follower.yaml"), "gears": load_text(GEARS, "gears.yaml")}


def kernel_of(model: Model, quantity: str, method: str) -> Kernel:
    """One quantity by one method."""
    derivations = derive_quantities(model, (quantity,), {quantity: method})
    (kernel,) = schedule(derivations.mechanics, derivations.quantities, ("float64",))["float64"].kernels
    return kernel


@pytest.mark.parametrize(
    ("name", "method"),
    [
        ("cranks", "schur_qr"),
        ("cranks", "nullspace"),
        ("gears", "schur_qr"),
        ("gears", "nullspace"),
        ("gears", "kkt"),
    ],
)
def test_the_same_function_is_known(name: str, method: str) -> None:
    model = MODELS[name]
    expected = Expected(model, ("multipliers",), 8, lambda _: None)
    assert ExactStates(expected).difference(kernel_of(model, "multipliers", method)) == ""


@pytest.mark.parametrize(("name", "quantity"), [("cranks", "multipliers"), ("gears", "forward_dynamics")])
def test_another_function_is_told(name: str, quantity: str) -> None:
    expected = Expected(MODELS[name], (quantity,), 8, lambda _: None)
    kernel = kernel_of(MODELS[name], quantity, "nullspace")
    assert ExactStates(expected).difference(kernel) == ""
    first, second, *others = kernel.outputs
    exchanged = replace(kernel, outputs=(second, first, *others))
    assert "differs from the reference by" in ExactStates(expected).difference(exchanged)


# Wheels that turn to one heading: of each pair of rows one is all but 0 somewhere, and shares of lengths are all equal.
HEADINGS = """
model: headings
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}, e: {unit: rad}}
parameters: {l: 0.32, J: 0.25}
kinetic_energy: J/2*(a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2 + e_dot**2)
constraints:
  geometric:
    x_1: l*cos(a) - l*cos(b)
    y_1: l*sin(a) - l*sin(b)
    x_2: l*cos(a) - l*cos(c)
    y_2: l*sin(a) - l*sin(c)
    x_3: l*cos(c) - l*cos(d)
    y_3: l*sin(c) - l*sin(d)
    x_4: l*cos(a) - l*cos(e)
    y_4: l*sin(a) - l*sin(e)
inputs: {M: {acts_on: {c: 1}}}
configuration: {a: -2.83, b: -2.83, c: -2.83, d: -2.83, e: -2.83}
"""


@pytest.mark.campaign
def test_pivots_that_are_equal_choose_by_what_is_known_best_and_are_the_same_with_twice_the_digits() -> None:
    model = load_text(HEADINGS, "headings.yaml")
    derivations = derive_quantities(model, ("nullspace_projector",), {"nullspace_projector": "householder"})
    programs = schedule(derivations.mechanics, derivations.quantities, ("float64", "float32"))
    expected = Expected(model, ("nullspace_projector",), 64, lambda _: None)
    for scalar, program in programs.items():
        (kernel,) = program.kernels
        assert measured(kernel, program.sincos, scalar, expected)[1] is None
        assert ExactStates(expected).difference(kernel) == ""
        assert ExactStates(expected).difference(widened(kernel, scalar)) == ""
