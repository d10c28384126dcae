"""Every method of u is the same function: equal to the 50-digit reference within the tolerance at regular states."""

from __future__ import annotations

import pytest
from random_systems import SIZES, random_system
from shipped import NAMES, model, sparing

from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Program, Scalar, Status
from symgen.linear_algebra.null_space.null_spaces import LONGEST_PRODUCT
from symgen.lowering.schedule import schedule
from symgen.methods.selection import every_method
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import rounded, sample_states
from symgen.verify.tolerance import FACTOR, expectations

# Three arms and three rods, given by energies: after six reflections the bounds of terms are 1e12 times a determinant.
DELTA = """
model: delta
coordinates: {t1: {unit: rad}, t2: {unit: rad}, t3: {unit: rad}, x: {unit: m}, y: {unit: m}, z: {unit: m}}
parameters: {L: {value: 0.25, unit: m}, l: {value: 0.55, unit: m}, R: {value: 0.1, unit: m}, m: {value: 0.4, unit: kg}}
kinetic_energy: 0.01*(t1_dot**2 + t2_dot**2 + t3_dot**2) + m/2*(x_dot**2 + y_dot**2 + z_dot**2)
potential_energy: m*9.81*z
constraints:
  geometric:
    l1: (x - (R + L*cos(t1)))**2 + y**2 + (z + L*sin(t1))**2 - l**2
    l2: (x + (R + L*cos(t2))/2)**2 + (y - sqrt(3)/2*(R + L*cos(t2)))**2 + (z + L*sin(t2))**2 - l**2
    l3: (x + (R + L*cos(t3))/2)**2 + (y + sqrt(3)/2*(R + L*cos(t3)))**2 + (z + L*sin(t3))**2 - l**2
inputs: {u1: {acts_on: {t1: 1}}, u2: {acts_on: {t2: 1}}, u3: {acts_on: {t3: 1}}}
"""
STATES = 8
# They form B B^T, M~^T M~ or B S^-1 B^T, whose condition is the square of B's (theory 3.3).
SQUARING = {"printed", "printed_fixed", "weighted", "kkt"}
SQUARED = 100
DRIVEN = [name for name in NAMES if model(name).inputs]


def programs_of(given: Model) -> dict[str, dict[Scalar, Program]]:
    return {
        method: schedule(mechanics, quantities, ("float64", "float32"))
        for method, mechanics, quantities in every_method(given, ("inverse_dynamics",))
    }


def worst_errors(given: Model, methods: dict[str, dict[Scalar, Program]], scalar: Scalar) -> dict[str, float]:
    """The largest error of each method in units of the tolerance."""
    reference = Reference(given)
    worst = dict.fromkeys(methods, 0.0)
    for number, sample in enumerate(sample_states(reference, ("inverse_dynamics",), STATES)):
        state = rounded(sample, scalar).state
        expected = expectations(reference, state, ("inverse_dynamics",), scalar, f"forms {number}")
        parts = {part: getattr(state, part) for part in ("q", "qd", "qdd", "u")}
        for method, by_scalar in methods.items():
            program = by_scalar[scalar]
            parameters = tuple(map(float, state.parameters))
            status, u = Interpreter(program.sincos, scalar).run(program.kernels[0], parts, parameters)
            # a basis from chosen coordinates may fail at a regular state, and so may chosen inputs
            assert status == Status.OK or method in ("nullspace", "printed_fixed"), f"{method}: {status.name}"
            if status == Status.OK:
                units = expected["inverse_dynamics"].in_units(expected["inverse_dynamics"].distance(u))
                worst[method] = max(worst[method], units)
    return worst


def assert_within(worst: dict[str, float]) -> None:
    allowed = {method: FACTOR * (SQUARED if method in SQUARING else 1) for method in worst}
    assert {method: units for method, units in worst.items() if units > allowed[method]} == {}


@pytest.mark.parametrize("scalar", ["float64", "float32"])
@pytest.mark.parametrize("name", sparing(DRIVEN))
def test_methods_of_the_shipped_models_agree_with_the_reference(name: str, scalar: Scalar) -> None:
    worst = worst_errors(model(name), programs_of(model(name)), scalar)
    assert {"minor", "nullspace", "elimination", "printed", "weighted", "kkt"} <= worst.keys()
    assert_within(worst)


@pytest.mark.parametrize("seed", range(len(SIZES)))
def test_methods_of_random_systems_agree_with_the_reference(seed: int) -> None:
    given = load_text(random_system(seed), f"random_{seed}.yaml")
    worst = worst_errors(given, programs_of(given), "float64")
    assert len(worst) >= 5
    assert_within(worst)


@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_reflections_are_compared_with_lengths_and_not_with_the_terms_on_the_way(scalar: Scalar) -> None:
    given = load_text(DELTA, "delta.yaml")
    worst_errors(given, {"householder": programs_of(given)["householder"]}, scalar)


def test_many_drives_with_factors_that_may_vanish() -> None:
    """More pivots that are tested than are multiplied as they stand, and no constraint whose rank could drop."""
    count = LONGEST_PRODUCT + 1
    every = [f"x_{k}" for k in range(1, count + 1)]
    lines = ["model: slides", "coordinates:", *(f"  {x}: {{unit: m}}" for x in every)]
    lines += ["parameters:", *(f"  k_{x}: {{value: {0.5 + 0.1 * k:.1f}}}" for k, x in enumerate(every))]
    lines += [f"kinetic_energy: {' + '.join(f'{x}_dot**2' for x in every)}"]
    lines += ["inputs:", *(f"  u_{x}: {{acts_on: {{{x}: k_{x}}}}}" for x in every)]
    given = load_text("\n".join([*lines, ""]), "slides.yaml")
    methods = programs_of(given)
    assert "elimination" in methods
    assert_within(worst_errors(given, methods, "float64"))
