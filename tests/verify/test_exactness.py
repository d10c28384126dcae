"""Kernels are told to be other functions, or the same ones, whatever digits they lose: by exact values on V."""

from __future__ import annotations

from dataclasses import replace

import pytest

from symgen.dynamics.select import derive_quantities
from symgen.ir.kernel import Kernel
from symgen.ir.schedule import schedule
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.verify.exactness import difference
from symgen.verify.expected import Expected

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


def kernel_of(model: Model, quantity: str, form: str) -> Kernel:
    """One quantity by one form."""
    derivations = derive_quantities(model, (quantity,), {quantity: form})
    (kernel,) = schedule(derivations.mechanics, derivations.quantities, ("float64",))["float64"].kernels
    return kernel


@pytest.mark.parametrize(
    ("name", "form"),
    [
        ("cranks", "schur_qr"),
        ("cranks", "nullspace"),
        ("gears", "schur_ldl"),
        ("gears", "nullspace"),
        ("gears", "kkt"),
    ],
)
def test_the_same_function_is_known(name: str, form: str) -> None:
    model = MODELS[name]
    expected = Expected(model, ("multipliers",), 8, lambda _: None)
    assert difference(kernel_of(model, "multipliers", form), expected) == ""


@pytest.mark.parametrize(("name", "quantity"), [("cranks", "multipliers"), ("gears", "forward_dynamics")])
def test_another_function_is_told(name: str, quantity: str) -> None:
    expected = Expected(MODELS[name], (quantity,), 8, lambda _: None)
    kernel = kernel_of(MODELS[name], quantity, "nullspace")
    assert difference(kernel, expected) == ""
    first, second, *others = kernel.outputs
    exchanged = replace(kernel, outputs=(second, first, *others))
    assert "differs from the reference by" in difference(exchanged, expected)
