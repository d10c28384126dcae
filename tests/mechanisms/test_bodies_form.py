"""Bodies, joints and force elements against energies, against the reference's own walk, and against each other."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from linkages import on_two_bases
from shipped import ALL, NAMES

from symgen.generation.results import Options
from symgen.mechanics.system import System
from symgen.model.kinematics.energy_form import energy_form
from symgen.model.load import load_model, load_text
from symgen.model.model import Model
from symgen.pipeline import generate
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost
from symgen.verify.reference.reference import Reference, State

HERE = Path(__file__).parent
MODELS = HERE.parents[1] / "models"
OF_THE_TESTS = {path.stem: path for path in HERE.glob("*.yaml")}
MECHANISMS = {name: MODELS / f"{name}.yaml" for name in ALL if name not in NAMES} | OF_THE_TESTS
SMALL = sorted(name for name in MECHANISMS if name not in ("chain8", "chain16", "chain32"))
QUANTITIES = (
    "mass_matrix",
    "coriolis_force",
    "potential_force",
    "applied_force",
    "constraint_residual",
    "constraint_jacobian",
    "control_matrix",
    "energy",
    "point_position",
    "point_jacobian",
)


@cache
def mechanism(name: str) -> Model:
    """A shipped mechanism, or one of those beside this file."""
    return load_model(MECHANISMS[name])


def a_state(model: Model, seed: int) -> State:
    """A state off every constraint, with parameters a little off their defaults."""
    source = random.Random(f"{model.name} {seed}")

    def drawn(count: int) -> tuple[Fraction, ...]:
        return tuple(Fraction(source.randrange(200, 1200), 1000) for _ in range(count))

    return State(drawn(model.n), drawn(model.n), drawn(model.n), drawn(model.m), drawn(len(model.parameters)))


def values(state: State, model: Model) -> dict[str, float]:
    """The state by the names of the graph's symbols."""
    coordinates = model.coordinates
    named = {c.name: float(x) for c, x in zip(coordinates, state.q, strict=True)}
    named |= {c.rate: float(x) for c, x in zip(coordinates, state.qd, strict=True)}
    named |= {c.acceleration: float(x) for c, x in zip(coordinates, state.qdd, strict=True)}
    named |= {i.name: float(x) for i, x in zip(model.inputs, state.u, strict=True)}
    return named | {p.name: float(x) for p, x in zip(model.parameters, state.parameters, strict=True)}


def exact(reference: Reference, state: State, quantity: str) -> list[float]:
    """Entries of a quantity from the reference."""
    return [float(x) for x in reference.matrices(state, [quantity])[quantity].entries()]


def on_graph(mechanics: System, quantity: str) -> list[Scalar]:
    """Entries of the same quantity on the graph."""
    if quantity == "energy":
        return [mechanics.kinetic_energy, mechanics.potential_energy]
    entries = getattr(mechanics.bodies if quantity.startswith("point_") else mechanics, quantity)
    return (
        [x for row in entries for x in row]
        if quantity in ("mass_matrix", "constraint_jacobian", "control_matrix", "point_jacobian")
        else [*entries]
    )


def offered(reference: Reference, quantity: str) -> bool:
    return quantity in reference.quantities()


@pytest.mark.parametrize("name", SMALL)
def test_the_graph_agrees_with_the_walk_of_the_reference(name: str) -> None:
    model = mechanism(name)
    reference, mechanics = Reference(model), System(model)
    for quantity in QUANTITIES:
        if not offered(reference, quantity):
            continue
        evaluate = Evaluator(on_graph(mechanics, quantity))
        for seed in range(2):
            state = a_state(model, seed)
            expected = exact(reference, state, quantity)
            size = max(map(abs, expected), default=0.0)
            assert evaluate(values(state, model)) == pytest.approx(expected, rel=1e-11, abs=max(1e-12 * size, 1e-30)), (
                quantity
            )


def test_points_move_as_their_jacobian_says() -> None:
    """By differences in many digits; the contact of a wheel moves with its material, its place with the fork."""
    model = load_text(
        """\
model: wheel
joints:
  fork: {type: planar, coordinates: [x, y, theta]}
  wheel: {type: revolute, parent: fork, at: [0, 0, 0.3], axis: y, coordinate: a}
bodies: {wheel: {mass: 1, inertia: {xx: 1, yy: 1, zz: 1}}, fork: {mass: 1, inertia: {zz: 1}}}
points:
  valve: {frame: wheel, at: [0.2, 0.05, 0.1]}
  contact: {frame: fork, at: [0, 0, 0], moves_with: wheel}
outputs: [point_position, point_jacobian]
""",
        "wheel.yaml",
    )
    reference = Reference(model)
    q, zero, step = tuple(Fraction(x, 10) for x in (3, -2, 7, 4)), (0,) * 4, Fraction(1, 10**15)

    def at(place: Sequence[Fraction], quantity: str) -> Any:
        return reference.matrices(State(tuple(place), zero, zero, (), ()), [quantity])[quantity]

    jacobian = at(q, "point_jacobian")
    assert (jacobian.nrows(), jacobian.ncols()) == (6, 4)
    for j in range(4):
        here, there = ([*q[:j], q[j] + side * step, *q[j + 1 :]] for side in (-1, 1))
        moved = at(there, "point_position") - at(here, "point_position")
        for row in range(3):
            assert float(moved[0, row]) / (2 * step) == pytest.approx(float(jacobian[row, j]), abs=1e-14)
        assert float(moved[1, 0]) / (2 * step) == pytest.approx(float(j == 0), abs=1e-14)
    # the material at the contact runs backwards under the turning wheel: -R along the heading
    expected = [-0.3 * math.cos(0.7), -0.3 * math.sin(0.7), 0]
    assert [float(jacobian[row, 3]) for row in range(3, 6)] == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("name", SMALL)
def test_newton_and_euler_agree_with_lagrange(name: str) -> None:
    model = mechanism(name)
    bodies, energies = System(model), System(energy_form(model))
    state = values(a_state(model, 3), model)
    for quantity in ("balance", "bias_force", "applied_force"):
        expected = Evaluator(getattr(energies, quantity))(state)
        assert Evaluator(getattr(bodies, quantity))(state) == pytest.approx(expected, rel=1e-10, abs=1e-10)
    for quantity in ("control_matrix", "constraint_jacobian"):
        rows = [[x for row in getattr(side, quantity) for x in row] for side in (bodies, energies)]
        assert Evaluator(rows[0])(state) == pytest.approx(Evaluator(rows[1])(state), rel=1e-11, abs=1e-11)


@pytest.mark.parametrize(("twin", "original"), [("front_car_bodies", "front_car"), ("rapkm_bodies", "rapkm_2rrr_rr")])
def test_the_twins_are_the_same_system(twin: str, original: str) -> None:
    """Identical to 40 digits: both references, which share no formula of the mechanics."""
    models = mechanism(twin), load_model(MODELS / f"{original}.yaml")
    assert [c.name for c in models[0].coordinates] == [c.name for c in models[1].coordinates]
    assert [p.name for p in models[0].parameters] == [p.name for p in models[1].parameters]
    references = [Reference(model) for model in models]
    for seed in range(2):
        state = a_state(models[0], seed)
        for quantity in (
            "mass_matrix",
            "coriolis_matrix",
            "constraint_jacobian",
            "inverse_dynamics",
            "forward_dynamics",
        ):
            one, other = (reference.matrices(state, [quantity])[quantity] for reference in references)
            size = max(abs(float(x)) for x in one.entries())
            assert all(abs(float(x)) <= 1e-40 * size for x in (one - other).entries()), quantity


def test_recursion_is_linear_in_the_number_of_links() -> None:
    four, eight = (cost(System(mechanism(name)).balance) for name in ("chain4", "chain8"))
    per_link = (eight.multiplications - four.multiplications) / 4, (eight.additive - four.additive) / 4
    assert per_link[0] <= 20
    assert per_link[1] <= 16
    assert (four.angles, eight.angles) == (4, 8)


def test_rows_across_the_plane_are_left_out() -> None:
    text = MECHANISMS["rapkm_bodies"].read_text(encoding="utf-8")
    head, _, tail = text.partition("constraints:")
    loops = "".join(f"  loop_1{i}: {{type: point, between: [tip_{i}, tip_1]}}\n" for i in (2, 3))
    model = load_text(f"{head}loops:\n{loops}inputs:{tail.partition('inputs:')[2]}", "m.yaml")
    assert [row.name for row in model.constraints] == ["loop_12_x", "loop_12_y", "loop_13_x", "loop_13_y"]
    state = a_state(model, 0)
    expected = exact(Reference(mechanism("rapkm_bodies")), state, "constraint_jacobian")
    jacobian = exact(Reference(model), state, "constraint_jacobian")
    assert [abs(x) for x in jacobian] == pytest.approx([abs(x) for x in expected], abs=1e-15)


def test_dependent_rows_of_a_full_joint() -> None:
    """Three rows of rank two in the axes of the world, two in those of a base that carries both sides."""
    four_bar = MECHANISMS["tilted_four_bar"].read_text(encoding="utf-8")
    for text, r in ((four_bar, 2), (on_two_bases(four_bar), 3)):
        reference = Reference(load_text(text, "four_bar.yaml"))
        assert (reference.model.r, reference.ranks.constraints) == (r, 2)


def test_a_joint_brings_its_coordinates_and_its_norm() -> None:
    model = mechanism("floating_body")
    assert [c.name for c in model.coordinates] == ["x", "y", "z", "e_0", "e_1", "e_2", "e_3", "a"]
    assert [row.name for row in model.constraints] == ["base_norm"]
    assert dict(model.configuration)["e_0"] == 1
    assert next(c for c in model.coordinates if c.name == "a").is_angle


def test_a_quaternion_of_any_length_is_a_rotation() -> None:
    """The height of a point on an axis that is turned by e/|e| does not know the length of e."""
    model = load_text(
        """\
model: m
joints: {j: {type: spherical, child: b, coordinates: [e_0, e_1, e_2, e_3]}}
bodies: {b: {mass: 1, com: [0, 0, 0.5], inertia: {xx: 1, yy: 1, zz: 1}}}
gravity: [0, 0, -10]
""",
        "m.yaml",
    )
    evaluate = Evaluator([System(model).potential_energy])
    tilt = {"e_0": 0.6, "e_1": 0.8, "e_2": 0.0, "e_3": 0.0}
    assert evaluate(tilt) == pytest.approx([5 * (0.36 - 0.64)])
    assert evaluate({name: 3 * value for name, value in tilt.items()}) == pytest.approx([5 * (0.36 - 0.64)])


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "rolling_disc",
        pytest.param("floating_body", marks=pytest.mark.mechanisms),
        pytest.param("tilted_four_bar", marks=pytest.mark.mechanisms),
    ],
)
def test_generated_python_is_verified(name: str) -> None:
    """All the way from the file: kernels of u, accelerations and multipliers within the tolerance."""
    result = generate(MECHANISMS[name], Options(parts=("python",), states=8), lambda _: None)
    assert result.failures == ()
    assert result.certificate is not None
