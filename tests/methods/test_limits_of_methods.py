"""Limits of methods that few systems meet: beyond each the method is not built, and up to it it is."""

from __future__ import annotations

import random
from collections.abc import Iterator
from itertools import count

import numpy as np
import pytest
import shipped

from symgen.linear_algebra.exterior import small_family
from symgen.linear_algebra.null_space.block_space import BlockSpace
from symgen.linear_algebra.null_space.null_spaces import has_few_minors
from symgen.mechanics.genericity import Genericity, genericity
from symgen.mechanics.system import System
from symgen.methods import selection
from symgen.methods.comparisons.printed import printed_candidate
from symgen.methods.derivation import Derivation
from symgen.methods.inverse_dynamics.nullspace import MOST_BASES, nullspace_candidate
from symgen.methods.method import INPUTS, Candidate
from symgen.methods.selection import Methods
from symgen.methods.spaces import along_minors
from symgen.methods.system import MethodInput
from symgen.methods.table import Use, methods
from symgen.methods.workspace import Workspace
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached


def dense(graph: Graph, rows: int, columns: int, letter: str = "b") -> Matrix:
    return tuple(tuple(graph.symbol(f"{letter}{i}_{j}") for j in range(columns)) for i in range(rows))


def ropes(coordinates: int, rows: int) -> System:
    """Masses that rows with an entry for each coordinate hold; as many drives as are left free."""
    names = [f"y_{k}" for k in range(coordinates)]
    parts = ["model: ropes", "coordinates:", *(f"  {name}: {{unit: rad}}" for name in names)]
    parts += ["kinetic_energy: " + " + ".join(f"{name}_dot**2" for name in names), "constraints:", "  nonholonomic:"]
    for i in range(rows):
        numbers = [1 + (7 * k * k + 3 * i * k + 5 * i * i) % 11 for k in range(coordinates)]
        terms = (f"({number} + cos({name} + {i}))*{name}_dot" for number, name in zip(numbers, names, strict=True))
        parts.append(f"    row_{i}: {' + '.join(terms)}")
    parts += ["inputs:", *(f"  u_{k}: {{acts_on: {{y_{k}: 1}}}}" for k in range(coordinates - rows))]
    return System(load_text("\n".join(parts) + "\n", "ropes.yaml"))


@pytest.mark.parametrize(("rows", "columns", "few"), [(2, 25, True), (2, 26, False), (10, 12, True), (12, 14, False)])
def test_minors_of_b_and_the_products_on_the_way_to_them_decide(rows: int, columns: int, few: bool) -> None:
    """300 minors at most; of twelve rows of fourteen there are 91, and 150 000 products."""
    assert has_few_minors(dense(Graph(), rows, columns), rows) is few


@pytest.mark.parametrize(("directions", "small"), [(9, True), (10, False)])
def test_determinants_of_nine_dense_directions_are_a_small_family(directions: int, small: bool) -> None:
    assert small_family([[0]], dense(Graph(), directions, directions), directions) is small


def test_minors_that_vanish_are_not_counted() -> None:
    graph = Graph()
    wide = dense(graph, 4, 16)
    band = tuple((*row[:i], *(graph.zero,) * 12, *row[i + 12 :]) for i, row in enumerate(wide))
    assert not has_few_minors(wide, 4)
    assert has_few_minors(band, 4)


def test_few_minors_of_many_products_are_not_formed() -> None:
    mechanics = ropes(14, 12)
    generic = genericity(mechanics)
    assert (generic.rank, generic.minors) == (12, 91)
    assert along_minors(mechanics, generic) == "B has 91 minors"
    assert len(mechanics.graph) < 5_000
    few = ropes(5, 3)
    assert isinstance(along_minors(few, genericity(few)), Derivation)


def test_a_block_of_many_minors_is_reflected() -> None:
    graph = Graph()
    first, second = dense(graph, 2, 4), dense(graph, 4, 12, "c")
    zeros = tuple(graph.zero for _ in range(12))
    rows = tuple((*row, *zeros) for row in first) + tuple((*zeros[:4], *row) for row in second)
    projector = BlockSpace(graph, rows, 16).projector

    def roots(lines: Matrix) -> bool:
        return any(node.op == "sqrt" for node in reached(entry for line in lines for entry in line))

    assert not roots(projector[:4])
    assert roots(projector[4:])
    source = random.Random(3)
    point = {str(entry.payload): source.uniform(-1, 1) for row in (*first, *second) for entry in row}
    B, N = (np.reshape(Evaluator([x for line in lines for x in line])(point), (-1, 16)) for lines in (rows, projector))
    assert N.tolist() == pytest.approx(np.eye(16) - np.linalg.pinv(B) @ B, abs=1e-12)


def _input(name: str) -> MethodInput:
    model = shipped.model(name)
    return Workspace(model, genericity(System(model))).fresh()


def test_rows_of_many_determinants_are_left_to_other_methods() -> None:
    assert nullspace_candidate(_input("gough_stewart"), lambda _: True) == (
        "too many constraint rows are left that no safe step solves"
    )
    system = _input("gough_stewart")
    assert len(system.mechanics.graph) < 20_000


@pytest.mark.parametrize("nth", [1, 2, MOST_BASES, MOST_BASES + 1])
def test_as_many_bases_are_tried(nth: int) -> None:
    """delta has twenty: two of three arms' rates, or of the platform's, each with its determinant."""
    asked: list[Scalar] = []
    numbers: Iterator[int] = count(1)

    def allowed(pivot: Scalar) -> bool:
        asked.append(pivot)
        return next(numbers) == nth

    made = nullspace_candidate(_input("delta"), allowed)
    assert isinstance(made, Candidate)
    assert len(asked) == min(nth, MOST_BASES)
    taken = asked[-1] if nth <= MOST_BASES else asked[0]
    assert taken in made.divisors


def test_methods_of_long_systems_are_not_derived_to_say_where_they_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    short = shipped.model("rapkm_2rrr_rr")
    examined = Methods(short, genericity(System(short)))
    assert [name for name, _ in examined.failing()] == ["nullspace"]
    counted = MethodInput.fresh(short, genericity(System(short)))
    least = min(bound for row in methods(INPUTS, Use.CHOSEN) if (bound := row.load().least_cost(counted)))
    for most, names in ((least, ["nullspace"]), (least - 1, [])):
        monkeypatch.setattr(selection, "LONGEST_EXAMINED", most)
        assert [name for name, _ in examined.failing()] == names
    monkeypatch.undo()
    derived: list[str] = []
    monkeypatch.setattr(Methods, "candidate", lambda _, quantity, name: derived.append(f"{quantity} by {name}"))
    long = shipped.model("chain16")
    assert Methods(long, genericity(System(long))).failing() == ()
    assert derived == []


@pytest.mark.parametrize(
    ("names", "inputs", "reason"), [("xyz", 6, ""), ("xy", 6, ""), ("xy", 7, "there are 21 choices of inputs")]
)
def test_the_printed_method_is_not_made_of_more_than_twenty_choices(names: str, inputs: int, reason: str) -> None:
    drives = "\n".join(f"  u_{k}: {{acts_on: {{{', '.join(f'{n}: {1 + k**i}' for i, n in enumerate(names))}}}}}"
                       for k in range(inputs))
    energy = " + ".join(f"{name}_dot**2" for name in names)
    coordinates = ", ".join(f"{name}: {{}}" for name in names)
    text = f"model: pushed\ncoordinates: {{{coordinates}}}\nkinetic_energy: {energy}\ninputs:\n{drives}\n"
    model = load_text(text, "pushed.yaml")
    generic: Genericity = genericity(System(model))
    made = printed_candidate(MethodInput.fresh(model, generic))
    assert made == reason if reason else isinstance(made, Candidate)
