"""Every pass over scalars and kernels, on random sums and on shipped models, exactly; a wrong pass is named."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction

import pytest
from shipped import model

from symgen.diagnostics import SymgenBug
from symgen.ir.kernel import Program
from symgen.ir.lifted import Lifted, same_kernel
from symgen.lowering.schedule import schedule
from symgen.quantities.select import derive_quantities
from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.passes import grouping
from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.polynomials.content import divided, usual_number
from symgen.symbolic.polynomials.polynomial import Multiplier, refactored
from symgen.symbolic.scalar import Scalar

SEEDS = range(60)
PARAMETERS, STATES = "abcd", "pqrs"
Rewriting = Callable[[Graph, Factoring, Sequence[Scalar]], Sequence[Scalar]]


def _sums(graph: Graph, draw: random.Random) -> list[Scalar]:
    """Sums of products that share parts, with both signs, divided here and there; as they stand or by constructors."""
    parameters, states = ([graph.symbol(name) for name in names] for names in (PARAMETERS, STATES))
    numbers = [graph.const(value) for value in (2, Fraction(1, 2), Fraction(3, 10))]
    angles = [*states[:2], states[0] + states[1], states[0] - states[1]]
    turned = [graph.trig(op, angle) for angle in angles for op in ("sin", "cos")]
    parts = draw.sample([*parameters, *states, *turned], 6)
    root = graph.function("sqrt", (graph.const(3),))
    outputs: list[Scalar] = []
    for _ in range(6):
        terms = [_product(graph, draw, [*parts, *outputs[-2:]], numbers, root) for _ in range(draw.randrange(2, 5))]
        again = [draw.choice([*terms, *parts]) for _ in range(draw.randrange(2))]
        total = terms[0]
        for term in [*terms[1:], *again]:
            total = _made(graph, draw, draw.choice(("add", "sub")), (total, term))
        if draw.random() < 0.3:
            total = graph.function("abs", (total,)) if draw.random() < 0.5 else total * 2
        outputs.append(total)
    return outputs


def _product(graph: Graph, draw: random.Random, parts: list[Scalar], numbers: list[Scalar], root: Scalar) -> Scalar:
    """Some factors and perhaps a number, a reciprocal, a root of a number."""
    total = draw.choice(parts)
    for _ in range(draw.randrange(1, 4)):
        total = _made(graph, draw, "mul", (total, draw.choice(parts)))
    if draw.random() < 0.3:
        below = graph.raw("div", (graph.one, draw.choice(parts)))
        total = graph.raw("mul", (total, below))
    if draw.random() < 0.3:
        total = graph.raw("mul", (draw.choice(numbers), graph.raw("mul", (graph.symbol("a"), root))))
    return draw.choice(numbers) * total if draw.random() < 0.3 else total


def _made(graph: Graph, draw: random.Random, op: str, args: tuple[Scalar, Scalar]) -> Scalar:
    """By the constructors, or as it stands."""
    if draw.random() < 0.4:
        return graph.mul(*args) if op == "mul" else graph.add(*args) if op == "add" else graph.sub(*args)
    return graph.raw(op, args)


def _divided(graph: Graph, _: Factoring, outputs: Sequence[Scalar]) -> Sequence[Scalar]:
    number = usual_number(outputs[:1])
    return [divided(graph, output, number) * number for output in outputs]


def _out(graph: Graph, _: Factoring, outputs: Sequence[Scalar]) -> Sequence[Scalar]:
    return refactored(graph, outputs, Multiplier(graph, lambda _: False), lambda _: False)


PASSES: dict[str, Rewriting] = {
    **{f"{one.of} {one.at}": one.rewrite for one in (*grouping.STEPS, *grouping.BEGINNINGS)},
    "dividing by a number": _divided,
    "multiplying out": _out,
    "sharing angles": lambda graph, _, outputs: share_angles(graph, outputs),
    "shortening": lambda _, factoring, outputs: factoring.shorten(outputs),
    "all of them": lambda graph, factoring, outputs: grouping.grouped(graph, factoring, outputs),
}


@pytest.mark.parametrize("name", PASSES)
def test_a_pass_keeps_every_value(name: str) -> None:
    changed = 0
    for seed in SEEDS:
        graph = Graph()
        outputs = _sums(graph, random.Random(seed))
        rewritten = PASSES[name](graph, Factoring(graph, [graph.symbol(x) for x in PARAMETERS]), outputs)
        with every_identity_evaluated():
            same_values(name, outputs, rewritten)
        changed += any(one is not other for one, other in zip(outputs, rewritten, strict=True))
    assert changed, "no draw gives this pass anything to do"


def test_a_wrong_pass_ends_generation_and_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(graph: Graph, _: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
        return [graph.raw("neg", (output,)) for output in outputs]

    monkeypatch.setattr(grouping, "STEPS", (grouping.Step("made", "wrong", wrong),))
    with pytest.raises(SymgenBug, match="made wrong: changes the value of"):
        derive_quantities(model("scara"), ("inverse_dynamics",))


def _program() -> Program:
    derivations = derive_quantities(model("slider_crank"), ("inverse_dynamics",))
    return schedule(derivations.mechanics, derivations.quantities, ("float64",))["float64"]


def test_wrong_statements_and_lost_checks_are_noticed() -> None:
    (kernel,) = _program().kernels
    *others, last = kernel.blocks
    tested = next(block for block in kernel.blocks if block.checks and block is not kernel.blocks[0])
    wrong = replace(last.statements[-1], operation="div" if last.statements[-1].operation != "div" else "mul")
    damaged = replace(kernel, blocks=(*others, replace(last, statements=(*last.statements[:-1], wrong))))
    with pytest.raises(SymgenBug, match="damage: changes the value"):
        same_kernel("damage", Lifted(kernel), Lifted(damaged))
    blocks = tuple(replace(block, checks=()) if block is tested else block for block in kernel.blocks)
    with pytest.raises(SymgenBug, match="loss: changes the checks"):
        same_kernel("loss", Lifted(kernel), Lifted(replace(kernel, blocks=blocks)))
    unsorted = replace(last, statements=last.statements[::-1])
    with pytest.raises(SymgenBug, match="nothing has assigned"):
        same_kernel("order", Lifted(kernel), Lifted(replace(kernel, blocks=(*others, unsorted))))
