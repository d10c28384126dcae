"""Input equations by reflections are those by determinants, and are taken where determinants are too many."""

from __future__ import annotations

import random

import numpy as np
import pytest

from symgen.linear_algebra.exterior import ActuationForms, RowForms, small_family
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.linear_algebra.reflected_inputs import ReflectedInputs
from symgen.mechanics.genericity import Genericity, genericity
from symgen.mechanics.system import System
from symgen.methods.derivation import Derivation
from symgen.methods.method import INPUTS, Candidate
from symgen.methods.selection import Methods
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.validity.rank_measures import rank_measures

SHAPES = [(5, 7, 5), (6, 4, 4), (5, 5, 5), (6, 6, 4), (5, 8, 3), (4, 1, 1)]


def symbols(graph: Graph, prefix: str, count: int) -> tuple[Scalar, ...]:
    return tuple(graph.symbol(f"{prefix}_{k}") for k in range(count))


@pytest.mark.parametrize(("size", "count", "degree"), SHAPES)
def test_least_norm_and_least_squares(size: int, count: int, degree: int) -> None:
    source = np.random.default_rng(3)
    matrix = source.normal(size=(size, degree)) @ source.normal(size=(degree, count))
    force = source.normal(size=size)
    graph = Graph()
    columns = [symbols(graph, f"a_{k}", size) for k in range(count)]
    equations = ReflectedInputs(graph, columns, size, degree, everywhere=False)
    values = {f"a_{k}_{i}": matrix[i, k] for k in range(count) for i in range(size)}
    values |= {f"f_{i}": force[i] for i in range(size)}
    numbers = Evaluator([*equations.solve(symbols(graph, "f", size)), equations.square()])(values)
    assert numbers[:-1] == pytest.approx(np.linalg.pinv(matrix, rcond=1e-10) @ force, rel=1e-9, abs=1e-10)
    forms = ActuationForms(RowForms(graph, (), size, 0), columns, degree)
    assert numbers[-1] == pytest.approx(Evaluator([forms.square()])(values)[0], rel=1e-8)


@pytest.mark.parametrize(("size", "count", "degree"), SHAPES)
def test_what_is_divided_by_vanishes_only_with_the_rank(size: int, count: int, degree: int) -> None:
    source = np.random.default_rng(7)
    graph = Graph()
    equations = ReflectedInputs(graph, [symbols(graph, f"a_{k}", size) for k in range(count)], size, degree, False)
    evaluate = Evaluator(equations.rank_measures)
    for rank in (degree, degree - 1):
        matrix = source.normal(size=(size, rank)) @ source.normal(size=(rank, count))
        measures = evaluate({f"a_{k}_{i}": matrix[i, k] for k in range(count) for i in range(size)})
        # what rounding leaves of a direction that is not there is its square; NaN may come of it
        assert min(measures) > 1e-6 if rank == degree else not min(measures) > 1e-24


@pytest.mark.parametrize("place", [0, 3, 5])
def test_a_component_that_all_but_vanishes_is_not_divided_by(place: int) -> None:
    # what rounding leaves of a component that is 0 at this configuration points anywhere
    source = np.random.default_rng(5)
    matrix = source.normal(size=(6, 4)) @ source.normal(size=(4, 6))
    matrix[place] = 1e-15 * source.normal(size=6)
    force = source.normal(size=6)
    graph = Graph()
    columns = [symbols(graph, f"a_{k}", 6) for k in range(6)]
    equations = ReflectedInputs(graph, columns, 6, 4, everywhere=False)
    values = {f"a_{k}_{i}": matrix[i, k] for k in range(6) for i in range(6)}
    values |= {f"f_{i}": force[i] for i in range(6)}
    solution = Evaluator(equations.solve(symbols(graph, "f", 6)))(values)
    assert solution == pytest.approx(np.linalg.pinv(matrix, rcond=1e-10) @ force, rel=1e-9, abs=1e-10)


@pytest.mark.slow
def test_a_form_is_found_where_components_of_inputs_vanish_in_turn() -> None:
    # one force turns from x to y, another does what the first drive does
    names = [*(f"q_{k}" for k in range(7)), "x", "y"]
    parts = ["model: turning_push", "coordinates:", *(f"  {name}: {{unit: rad}}" for name in names)]
    parts += ["kinetic_energy: " + " + ".join(f"{name}_dot**2*(2 + sin({name}))" for name in names), "inputs:"]
    parts += [f"  u_{k}: {{acts_on: {{q_{k}: 1, q_{(k + 1) % 7}: 0.5 + cos(q_{k})/4}}}}" for k in range(7)]
    parts += ["  push: {acts_on: {x: cos(q_0), y: sin(q_0)}}", "  again: {acts_on: {x: -cos(q_0), y: -sin(q_0)}}"]
    parts += ["  same: {acts_on: {q_0: 1, q_1: 0.5 + cos(q_0)/4}}"]
    model = load_text("\n".join(parts) + "\n", "turning_push.yaml")
    methods = Methods(model, genericity(System(model)))
    made = methods.candidate(INPUTS, "minor")
    assert isinstance(made, Candidate)
    validity = methods.validity(made)
    assert validity.singular == ()
    # pivots are 0 only where the rank drops, by theorem; squares that pivoting compares may be, and are searched
    assert validity.proved > 0


def test_the_number_of_products_decides() -> None:
    graph = Graph()
    dense = [symbols(graph, f"m_{k}", 14) for k in range(14)]
    units = [tuple(graph.one if i == k else graph.zero for i in range(30)) for k in range(30)]
    assert small_family([[0]], dense[:3], 3)
    assert not small_family([[0]], dense, 14)
    assert small_family([[0]], units, 30)
    assert not small_family([[0]], units, 15)


def rope(beads: int, drives: int) -> str:
    """Beads on a rope whose ends are held; forces that each act on three neighbours."""
    names = [f"y_{k}" for k in range(beads)]
    rates = " + ".join(f"{name}_dot**2*(2 + sin({name}))" for name in names)
    row = " + ".join(f"({1 + k % 3} + cos({name}))*{name}_dot" for k, name in enumerate(names))
    arms = [", ".join(f"y_{(k + j) % beads}: {j + 1}" for j in range(3)) for k in range(drives)]
    push = [f"  f_{k}: {{acts_on: {{{arm}}}}}" for k, arm in enumerate(arms)]
    parts = ["model: rope", "coordinates:", *(f"  {name}: {{unit: rad}}" for name in names)]
    parts += [f"kinetic_energy: {rates}", f"constraints: {{nonholonomic: {{rope: {row}}}}}", "inputs:", *push]
    return "\n".join(parts) + "\n"


@pytest.mark.parametrize("drives", [13, 12, 9])
def test_twelve_directions_are_solved_and_measured(drives: int) -> None:
    mechanics = System(load_text(rope(13, drives), "rope.yaml"))
    generic = Genericity(13, 1, drives, 1, min(drives, 12), 0)
    space = reflected(mechanics.graph, mechanics.constraint_jacobian, 13, 1)
    derivation = Derivation(mechanics, generic, space)
    outputs = [*derivation.inverse_dynamics, *rank_measures(mechanics, generic, space)]
    assert len(mechanics.graph) < 60_000
    source = random.Random(5)
    point = {f"y_{k}": source.uniform(-1, 1) for k in range(13)}
    qdd = np.array([source.uniform(-1, 1) for _ in range(13)])
    still = {f"y_{k}_dot": 0.0 for k in range(13)}
    values = Evaluator(outputs)(point | still | {f"y_{k}_ddot": qdd[k] for k in range(13)})
    force = np.array([2 * (2 + np.sin(point[f"y_{k}"])) for k in range(13)]) * qdd
    row = np.array([1 + k % 3 + np.cos(point[f"y_{k}"]) for k in range(13)])
    projector = np.eye(13) - np.outer(row, row) / (row @ row)
    control = np.zeros((13, drives))
    for k in range(drives):
        for j in range(3):
            control[(k + j) % 13, k] = j + 1
    assert values[:drives] == pytest.approx(np.linalg.pinv(projector @ control, rcond=1e-9) @ force, rel=1e-7, abs=1e-8)
    assert values[drives] == pytest.approx(1)

    def squared_minors(a: np.ndarray) -> float:
        """e(A), from the characteristic polynomial of A^T A."""
        coefficients = np.poly(np.linalg.eigvalsh(a.T @ a))
        return float(abs(coefficients[generic.alpha]))

    assert values[drives + 1] == pytest.approx(squared_minors(projector @ control) / squared_minors(control), rel=1e-6)


@pytest.mark.slow
def test_directions_cost_by_their_cube() -> None:
    def nodes(beads: int) -> int:
        mechanics = System(load_text(rope(beads, beads - 1), "rope.yaml"))
        space = reflected(mechanics.graph, mechanics.constraint_jacobian, beads, 1)
        derivation = Derivation(mechanics, Genericity(beads, 1, beads - 1, 1, beads - 1, 0), space)
        before = len(mechanics.graph) if mechanics.balance else 0
        derivation.inverse_dynamics  # noqa: B018
        return len(mechanics.graph) - before

    assert nodes(26) < 10 * nodes(13)
