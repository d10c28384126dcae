"""Products and sums regrouped, so that least is computed: the steps of three passes, each taken where it saves.

The constructors leave factors and terms in the order in which they came, so that equal ones are recognised.  What a
pass is worth over all models is on a page of its own, docs/passes.md.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import same_values
from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.passes.quotients import with_quotients
from symgen.symbolic.passes.shared_parts import with_shared_products, with_shared_sums
from symgen.symbolic.passes.sum_factors import with_common_factors
from symgen.symbolic.passes.twins import without_twins
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, reached

Rewriting: TypeAlias = Callable[[Graph, Factoring, Sequence[Scalar]], list[Scalar]]


# The passes, each with what it does in a sentence; what one leaves the next may find.
COMMON_FACTORS, SHARED_PARTS, QUOTIENTS = "common factors", "shared parts", "quotients"
PASSES = {
    COMMON_FACTORS: "x + f a + f b becomes x + f (a + b): first for any f, or for parameters, where that leads to less "
    "in the end; then where nothing else needs the products",
    SHARED_PARTS: "a + b, or a b, is computed once where several sums, or products, hold both",
    QUOTIENTS: "(1 / b) a becomes a / b where nothing else needs 1 / b",
}


@dataclass(frozen=True, slots=True)
class Step:
    """A rewriting that keeps all values: the pass that it belongs to, and what it looks at."""

    of: str
    at: str
    rewrite: Rewriting


LONE_FACTORS = Step(
    COMMON_FACTORS, "of products that nothing else needs", lambda graph, _, outputs: with_common_factors(graph, outputs)
)
PARAMETER_FACTORS = Step(
    COMMON_FACTORS,
    "that are parameters or numbers",
    lambda graph, factoring, outputs: with_common_factors(graph, outputs, factoring.fixed),
)
ALL_FACTORS = Step(
    COMMON_FACTORS, "of all products", lambda graph, _, outputs: with_common_factors(graph, outputs, shared=True)
)
SHARED_SUMS = Step(SHARED_PARTS, "of sums", lambda graph, _, outputs: with_shared_sums(graph, outputs))
SHARED_PRODUCTS = Step(SHARED_PARTS, "of products", lambda graph, _, outputs: with_shared_products(graph, outputs))
LONE_RECIPROCALS = Step(QUOTIENTS, "of reciprocals", lambda graph, _, outputs: with_quotients(graph, outputs))
# In their order: what two sums held is found in more of them once those two are one, so that three are taken twice.
STEPS = (*(LONE_FACTORS, SHARED_SUMS, SHARED_PRODUCTS) * 2, LONE_RECIPROCALS)
# Scalars of outputs beyond which each is taken once: again takes seconds of these and finds half a percent.
LONG_OUTPUTS = 12_000
# What comes out of sums first decides what is found later, and what cancels exactly.  Outputs of few scalars begin with
# each of these, and with none; longer ones with the first, and long ones with none.
BEGINNINGS = (ALL_FACTORS, PARAMETER_FACTORS)
# Scalars of outputs up to which these begin with each of BEGINNINGS, and with none.
SHORT_OUTPUTS = 400


@dataclass(frozen=True, slots=True)
class _Weighed:
    """Outputs and their counted cost."""

    outputs: tuple[Scalar, ...]
    weight: int


def grouped(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs after the steps, each taken where it saves operations."""
    improved = _Improvement(graph, factoring)
    start = _weighed(without_twins(graph, outputs))
    held = len(reached(outputs))
    beginnings = BEGINNINGS if held <= SHORT_OUTPUTS else BEGINNINGS[:1] if held <= LONG_OUTPUTS else ()
    begun = [improved(start, (one,)) for one in beginnings]
    starts = begun if len(begun) == 1 else [*begun, start]
    steps = tuple(dict.fromkeys(STEPS)) if held > LONG_OUTPUTS else STEPS
    best = min((improved(one, steps) for one in dict.fromkeys(starts)), key=lambda one: one.weight)
    same_values("regrouping", outputs, best.outputs)
    return list(best.outputs)


class _Improvement:
    """Outputs after those steps that save operations; two ways meet often, and a step is taken once from a place."""

    def __init__(self, graph: Graph, factoring: Factoring) -> None:
        self._graph, self._factoring = graph, factoring
        self._known: dict[tuple[Step, tuple[Scalar, ...]], _Weighed] = {}

    def __call__(self, best: _Weighed, steps: Sequence[Step]) -> _Weighed:
        for one in steps:
            place = one, best.outputs
            if place not in self._known:
                self._known[place] = self._after(one, best)
            best = self._known[place]
        return best

    def _after(self, taken: Step, best: _Weighed) -> _Weighed:
        changed = taken.rewrite(self._graph, self._factoring, best.outputs)
        same_values(f"{taken.of} {taken.at}", best.outputs, changed)
        if tuple(changed) == best.outputs:
            return best
        weighed = _weighed(without_twins(self._graph, changed))
        return weighed if weighed.weight < best.weight else best


def _weighed(outputs: Sequence[Scalar]) -> _Weighed:
    operations = cost(outputs)
    return _Weighed(tuple(outputs), operations.weight + operations.signs)
