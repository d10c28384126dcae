"""A platform on six legs that are bodies: the elimination solves the legs' rows by their lengths and leaves six."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from symgen.ir.kernel import Status
from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace
from symgen.mechanics.genericity import genericity, parameter_values
from symgen.mechanics.rigid_bodies.body_axes import BodyAxes
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.articulated import articulated
from symgen.methods.inverse_dynamics.elimination import Elimination
from symgen.methods.inverse_dynamics.forces_eliminated import elimination_candidate
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.traverse import cost


@pytest.fixture(scope="module")
def platform() -> Model:
    """24 coordinates, 18 rows, six inputs."""
    return load_model(Path(__file__).parents[2] / "models" / "gough_loops.yaml")


@pytest.mark.parametrize(("kind", "rows"), [(System, 6), (BodyAxes, 6)])
def test_rows_of_the_legs_are_solved(platform: Model, kind: type[System], rows: int) -> None:
    mechanics = kind(platform)
    elimination = Elimination(mechanics)
    elimination.reduce()
    assert len(elimination.core) == len(elimination.names) == rows
    graph = mechanics.graph
    legs = range(1, 7)
    expected = [graph.symbol(f"s_{k}") for k in legs]
    expected += [graph.function("cos", (graph.symbol(f"b_{k}"),)) for k in legs]
    assert graph.product(elimination.lengths()) is graph.product(expected)


def test_the_lengths_are_tested(platform: Model) -> None:
    mechanics = System(platform)
    candidate = elimination_candidate(mechanics, genericity(mechanics))
    assert candidate is not None
    assert cost(candidate.derived.outputs).weight < 2600  # by reflections 8976
    (guard,) = candidate.derived.guards
    assert guard.status == Status.ACTUATION_RANK
    evaluate = Evaluator([guard.denominator, guard.scale or guard.denominator])
    point = parameter_values(mechanics) | {c.name: 0.1 for c in platform.coordinates}
    point |= {name: float(value) for name, value in platform.configuration}
    sizes = []
    for off in (1.2, 1e-3, 1e-6):
        denominator, scale = evaluate(point | {"b_3": math.pi / 2 - off})
        sizes.append(abs(denominator) / scale)
    assert sizes[0] > 1e-12
    assert sizes[1] < 1e-4 * sizes[0]
    assert sizes[2] < 1e-4 * sizes[1]


@pytest.mark.parametrize("kind", [System, BodyAxes])
def test_the_rank_of_b_is_told_apart(platform: Model, kind: type[System]) -> None:
    """One leg of no length leaves B its rank; four leave eight forces on a body with six motions."""
    mechanics, plain = kind(platform), System(platform)
    candidate = elimination_candidate(mechanics, genericity(plain))
    assert candidate is not None
    (guard,) = candidate.derived.guards
    (cause,) = guard.first
    assert cause.status == Status.CONSTRAINT_RANK
    whole = HouseholderSpace(plain.graph, plain.constraint_jacobian, plain.n).volume
    assert cost([cause.denominator]).weight < 0.7 * cost([whole.denominator]).weight
    evaluate = Evaluator([cause.denominator, cause.scale or cause.denominator])
    point = parameter_values(mechanics) | {c.name: 0.1 * k for k, c in enumerate(platform.coordinates, 1)}
    point |= {"psi": 0.3, "theta": 0.2, "phi": 0.1}

    def measured(length: float, legs: int) -> float:
        denominator, scale = evaluate(point | {f"s_{k}": length for k in range(1, legs + 1)})
        return abs(denominator / scale)

    assert measured(1e-7, 1) > 1e-12
    assert measured(1e-7, 4) < 1e-24
    upright = point | {"theta": math.pi / 2}
    assert math.isfinite(evaluate(upright)[0])


@pytest.mark.parametrize("kind", [System, BodyAxes])
def test_each_leg_is_a_direction_of_its_own(platform: Model, kind: type[System]) -> None:
    """Six legs that have lost nine tenths each are no lost direction (draw 1116:557)."""
    candidate = elimination_candidate(kind(platform), genericity(System(platform)))
    assert candidate is not None
    (guard,) = candidate.derived.guards
    assert guard.directions > 12


def test_accelerations_measure_the_rank_of_b_where_they_reflect(platform: Model) -> None:
    """Legs of no length: one leaves B its rank, also where u is lost, four do not."""
    derived = articulated(platform, genericity(System(platform)))
    assert derived is not None
    mechanics, motion = derived
    *before, guard = (guard for guard in motion.guards if guard.status == Status.CONSTRAINT_RANK)
    # what is divided by on the way is compared with 0 alone
    assert all(one.scale is one.denominator for one in before)
    assert guard.scale is not None
    evaluate = Evaluator([guard.denominator, guard.scale])
    point = parameter_values(mechanics) | {c.name: 0.1 for c in platform.coordinates}
    point |= {name: float(value) for name, value in platform.configuration}

    def measured(length: float, legs: int) -> float:
        left, scale = evaluate(point | {f"s_{k}": length for k in range(1, legs + 1)})
        return abs(left / scale)

    assert measured(0.9, 1) > 1e-9
    assert measured(1e-7, 1) > 1e-12
    assert measured(1e-7, 4) < 1e-20


def test_small_cores_need_no_tested_lengths() -> None:
    mechanics = System(load_model(Path(__file__).parents[2] / "models" / "rapkm_bodies.yaml"))
    elimination = Elimination(mechanics)
    elimination.reduce()
    assert not elimination.lengths()
