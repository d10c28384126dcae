"""Regrouped parameters give the same forces, and what they save; fixed turns and numbers of rows."""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

import pytest
from shipped import ROOT, model

from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.inverse_dynamics.elimination import Elimination
from symgen.methods.method import INPUTS, Candidate
from symgen.methods.selection import Methods
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.symbolic.angles.sharing import angles_of, share_angles
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.polynomials.content import divided, usual_number
from symgen.symbolic.scalar import PI, Scalar
from symgen.symbolic.traverse import cost

BODIES = ("front_car_bodies", "rapkm_bodies", "delta", "arm7", "gough_stewart", "rolling_disc", "three_rrr", "scara")


def described(name: str) -> Model:
    path = Path(ROOT / "tests" / "mechanisms" / f"{name}.yaml")
    return load_model(path) if path.exists() else model(name)


def evaluate(outputs: Sequence[Scalar], at: dict[str, float]) -> list[float]:
    return Evaluator(outputs)(at)


def values(mechanics: System, seed: int) -> dict[str, float]:
    source = random.Random(seed)
    symbols = (*mechanics.q, *mechanics.qd, *mechanics.qdd, *mechanics.parameters)
    return {str(symbol.payload): source.uniform(0.2, 1.5) for symbol in symbols}


@pytest.mark.parametrize("name", [*BODIES, "chain8", "elements"])
def test_lumped_forces_are_the_forces(name: str) -> None:
    apart, together = (System(described(name), lumped=lumped) for lumped in (False, True))
    at = values(apart, 3)
    expected = evaluate(apart.balance, at)
    assert evaluate(together.balance, at) == pytest.approx(expected, rel=1e-11, abs=1e-11)


def test_frames_that_share_parameters_are_shorter_lumped() -> None:
    for name, saved in (("rapkm_bodies", 20), ("delta", 20)):
        apart, together = (cost(System(model(name), lumped=lumped).balance).weight for lumped in (False, True))
        assert together <= apart - saved


def test_balanced_wheels_are_as_short_apart() -> None:
    car = model("front_car_bodies")
    apart, together = (cost(System(car, lumped=lumped).balance).weight for lumped in (False, True))
    assert apart == together <= 57


@pytest.mark.parametrize(("name", "most"), [("arm7", 716), ("delta", 150), ("rapkm_bodies", 155), ("chain8", 355)])
def test_products_and_sums_of_u(name: str, most: int) -> None:
    one = described(name)
    made = Methods(one, genericity(System(one))).candidate(INPUTS, "elimination")
    assert isinstance(made, Candidate)
    operations = cost(share_angles(made.system.mechanics.graph, made.derived.outputs))
    assert operations.additive + operations.multiplications <= most


def test_angles_that_differ_by_fixed_ones_take_one_pair() -> None:
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    shifts = [Fraction(k, 12) for k in (0, 2, 3, -4, 6, 8, 12, 15)]
    angles = [sign * a + graph.const(PI * shift) for shift in shifts for sign in (1, -1)]
    outputs = [graph.trig(name, angle) for angle in (*angles, a + b) for name in ("sin", "cos")]
    shared = share_angles(graph, outputs)
    assert len(angles_of(shared)) == 2
    at = {"a": 0.7, "b": -1.9}
    assert evaluate(shared, at) == pytest.approx(evaluate(outputs, at), abs=1e-15)


def test_angles_that_differ_by_other_ones_stay() -> None:
    graph = Graph()
    a = graph.symbol("a")
    outputs = [graph.trig("sin", a), graph.trig("sin", a + graph.const(Fraction(1, 3))), graph.trig("cos", a + PI / 12)]
    assert len(angles_of(share_angles(graph, outputs))) == 3


def test_numbers_of_rows() -> None:
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    two, four, sum_of_twos = 2 * x, 4 * (x * y), 2 * x + 2 * (y * y)
    assert usual_number([two, sum_of_twos, four]) == 2
    assert usual_number([x, two]) == 1
    assert usual_number([]) == 1
    assert divided(graph, two, Fraction(2)) is x
    assert divided(graph, -sum_of_twos, Fraction(2)) is -(x + y * y)
    assert divided(graph, four, Fraction(2)) is 2 * (x * y)
    for value in (two, four, sum_of_twos, x, graph.function("sqrt", (x,))):
        at = {"x": 1.25, "y": 0.75}
        (quotient,), (expected,) = evaluate([divided(graph, value, Fraction(3))], at), evaluate([value], at)
        assert quotient == pytest.approx(expected / 3)


def test_rows_of_distances_lose_their_twos() -> None:
    def number(value: Scalar) -> Fraction:
        return usual_number([value])

    elimination = Elimination(System(model("gough_stewart")))
    assert all(number(x) != 2 for row in elimination.core for x in row.coefficients.values())
