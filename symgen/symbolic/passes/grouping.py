"""Parameter groups: products are taken in the order in which least is computed at each state.

The constructors move numbers outwards and leave factors in the order in which they came, so that terms are recognised.
Here numbers go into factors that depend on parameters only, parameters join a product of parameters that exists
anyway, and a reciprocal that serves one product becomes its quotient.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

from symgen.records import dataclass
from symgen.symbolic.identity import same_values
from symgen.symbolic.passes.early_factors import early_factors, with_early_factor
from symgen.symbolic.passes.factoring import Factoring
from symgen.symbolic.passes.late_factors import with_late_factors
from symgen.symbolic.passes.opposites import with_one_difference
from symgen.symbolic.passes.shared_parts import with_shared_products, with_shared_sums
from symgen.symbolic.passes.sum_factors import with_common_factors
from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.traverse import cost, reached, topological, uses_of

_Step: TypeAlias = Callable[[Graph, Factoring, Sequence[Scalar]], list[Scalar]]
# Longer outputs are regrouped in one way only.
SHORT = 400


@dataclass(frozen=True, slots=True)
class _Weighed:
    """Outputs and their counted cost."""

    outputs: tuple[Scalar, ...]
    weight: int


def grouped(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs with their products regrouped, each step taken where it saves operations.

    What is taken out of sums decides what later steps find, so that short outputs are begun in several ways.
    """
    improved = _Improvement(graph, factoring)
    start = improved(_weighed(_unified(graph, outputs)), _SIGNS_AND_NUMBERS)
    best = _best_of_several(improved, start) if len(reached(outputs)) <= SHORT else improved(start, _ONE_WAY)
    found = list(improved(best, (_with_quotients, _with_early_factors)).outputs)
    same_values("regrouping", outputs, found)
    return found


def _best_of_several(improved: _Improvement, start: _Weighed) -> _Weighed:
    found = []
    for one in dict.fromkeys((start, improved(start, (_with_parameters_taken_out,)))):
        found.append(improved(one, (_with_collected_factors, *_STEPS)))
        pairs = improved(one, (_with_common_factors,))
        found += [] if pairs is one else [improved(pairs, _STEPS)]
    found += [improved(one, (with_late_factors,)) for one in dict.fromkeys(found)]
    ended = (improved(one, (*_LAST_STEPS, _with_late_shared_factors)) for one in dict.fromkeys(found))
    return min(ended, key=lambda one: one.weight)


class _Improvement:
    """Outputs after those steps that save operations; the ways meet often, and a step is taken once from each place."""

    def __init__(self, graph: Graph, factoring: Factoring) -> None:
        self._graph, self._factoring = graph, factoring
        self._known: dict[tuple[_Step, tuple[Scalar, ...]], _Weighed] = {}

    def __call__(self, best: _Weighed, steps: Sequence[_Step]) -> _Weighed:
        for step in steps:
            place = step, best.outputs
            if place not in self._known:
                self._known[place] = self._after(step, best)
            best = self._known[place]
        return best

    def _after(self, step: _Step, best: _Weighed) -> _Weighed:
        changed = step(self._graph, self._factoring, best.outputs)
        same_values(step.__name__.replace("_", " ").strip(), best.outputs, changed)
        if tuple(changed) == best.outputs:
            return best
        found = _weighed(_unified(self._graph, changed))
        return found if found.weight < best.weight else best


def _weighed(outputs: Sequence[Scalar]) -> _Weighed:
    operations = cost(outputs)
    return _Weighed(tuple(outputs), operations.weight + operations.signs)


def _unified(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs with one node for each operation: steps past the constructors, and other graphs, leave twins."""
    order = topological(outputs)
    if len({(node.op, node.args, node.payload) for node in order}) == len(order):
        return list(outputs)
    image: dict[Scalar, Scalar] = {}
    first: dict[tuple[str, tuple[Scalar, ...], object], Scalar] = {}
    for node in order:
        args = tuple(map(image.__getitem__, node.args))
        same = _as_it_stands(graph, node, args)
        image[node] = first.setdefault((same.op, same.args, same.payload), same)
    return [image[output] for output in outputs]


def _with_common_factors(graph: Graph, _: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """f a + f b as f (a + b) where nothing else needs the products."""
    order = topological(outputs)
    uses = uses_of(order, outputs)
    products = graph.products
    image: dict[Scalar, Scalar] = {}
    for node in order:
        args = tuple(map(image.__getitem__, node.args))
        image[node] = _as_it_stands(graph, node, args)
        if node.op not in ("add", "sub") or any(a.op != "mul" or uses[a] > 1 for a in node.args):
            continue
        left, right = (products.monomial(a)[1] for a in node.args)
        common = {f: 1 for f, count in left.items() if count > 0 and right.get(f, 0) > 0 and f.op != "const"}
        if common and all(f in image for f in common):
            rest = tuple(image.get(q, q) for q in (products.quotient(a, common) for a in node.args))
            factor = graph.product(image[f] for f in common)
            image[node] = graph.raw("mul", (factor, graph.raw(node.op, rest)))
    return [image[output] for output in outputs]


def _with_collected_factors(graph: Graph, _: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """x + f a + f b as x + f (a + b) where nothing else needs the products."""
    return with_common_factors(graph, outputs)


def _with_numbers_moved(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    image: dict[Scalar, Scalar] = {}
    for node in topological(outputs):
        args = tuple(map(image.__getitem__, node.args))
        number = args[0].constant if node.op == "mul" else None
        if number is not None and not factoring.fixed(node):
            moved = _into_parameters(graph, factoring, args[0], args[1])
            image[node] = graph.raw("mul", args) if moved is None else moved
        else:
            image[node] = _as_it_stands(graph, node, args)
    return [image[output] for output in outputs]


def _into_parameters(graph: Graph, factoring: Factoring, number: Scalar, product: Scalar) -> Scalar | None:
    """number * product with the number multiplied into the product's first parameter group, or None without one."""
    if factoring.fixed(product):
        return graph.raw("mul", (number, product))
    if product.op == "neg":
        moved = _into_parameters(graph, factoring, number, product.args[0])
        return None if moved is None else graph.raw("neg", (moved,))
    if product.op == "mul":
        for place in (0, 1):
            moved = _into_parameters(graph, factoring, number, product.args[place])
            if moved is not None:
                rest = product.args[1 - place]
                return graph.raw("mul", (moved, rest) if place == 0 else (rest, moved))
    if product.op == "div":
        moved = _into_parameters(graph, factoring, number, product.args[0])
        return None if moved is None else graph.raw("div", (moved, product.args[1]))
    return None


def _with_parameters_joined(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """a (b x) as (a b) x where the product of the parameters a and b is computed anyway."""
    order = topological(outputs)
    uses = uses_of(order, outputs)
    fixed = (node for node in order if node.op == "mul" and all(map(factoring.fixed, node.args)))
    pairs = {frozenset(map(id, node.args)): node for node in fixed}
    if not pairs:
        return list(outputs)
    image: dict[Scalar, Scalar] = {}
    for node in order:
        args = tuple(map(image.__getitem__, node.args))
        joined = None
        if node.op == "mul":
            for a, inner in (node.args, node.args[::-1]):
                if inner.op != "mul" or uses[inner] > 1 or not factoring.fixed(a) or a.constant is not None:
                    continue
                for b, x in (inner.args, inner.args[::-1]):
                    product = pairs.get(frozenset((id(a), id(b))))
                    if product is not None and product is not node:
                        joined = joined or graph.raw("mul", (image.get(product, product), image[x]))
        image[node] = _as_it_stands(graph, node, args) if joined is None else joined
    return [image[output] for output in outputs]


def _with_quotients(graph: Graph, _: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """(1 / b) a as a / b where nothing else needs 1 / b."""
    order = topological(outputs)
    inverses = {node for node in order if node.op == "div" and node.args[0].is_one}
    if not inverses:
        return list(outputs)
    uses = uses_of(order, outputs)
    image: dict[Scalar, Scalar] = {}
    for node in order:
        args = tuple(map(image.__getitem__, node.args))
        image[node] = _as_it_stands(graph, node, args)
        if node.op == "mul":
            for a, inverse in (node.args, node.args[::-1]):
                if inverse in inverses and uses[inverse] == 1:
                    image[node] = graph.raw("div", (image[a], image[inverse.args[1]]))
    return [image[output] for output in outputs]


def _as_it_stands(graph: Graph, node: Scalar, args: tuple[Scalar, ...]) -> Scalar:
    return node if args == node.args else graph.raw(node.op, args, node.payload)


def _with_numbers_joined(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """1/2 (p sqrt(3)) as (1/2 sqrt(3)) p: numbers with numbers, which compilers multiply."""
    image: dict[Scalar, Scalar] = {}
    for node in topological(outputs):
        args = tuple(map(image.__getitem__, node.args))
        joined = None
        if node.op == "mul" and args[0].constant is not None and factoring.fixed(node) and args[1].op == "mul":
            for a, b in (args[1].args, args[1].args[::-1]):
                if joined is None and _is_number(a) and not _is_number(b):
                    joined = graph.raw("mul", (graph.raw("mul", (args[0], a)), b))
        image[node] = _as_it_stands(graph, node, args) if joined is None else joined
    return [image[output] for output in outputs]


def _is_number(node: Scalar) -> bool:
    """Whether a scalar holds no symbol."""
    return all(inner.op != "symbol" for inner in topological([node]))


def _with_parameters_taken_out(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    """x + p a - p b as x + p (a - b) also where products of parameters are needed elsewhere, likewise for numbers."""
    return with_common_factors(graph, outputs, factoring.fixed)


def _with_shared_sums(graph: Graph, _: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    return with_one_difference(graph, with_shared_sums(graph, outputs))


def _with_shared_products(graph: Graph, _: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    return with_shared_products(graph, outputs)


def _with_late_shared_factors(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    return with_late_factors(graph, factoring, outputs, with_shared_products)


def _with_early_factors(graph: Graph, factoring: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    best = _weighed(outputs)
    for factor in early_factors(factoring, outputs):
        early = with_early_factor(graph, factoring, best.outputs, factor)
        if tuple(early) == best.outputs:
            continue
        changed = _with_quotients(graph, factoring, early)
        found = _weighed(_unified(graph, changed))
        if found.weight < best.weight:
            best = found
    return list(best.outputs)


def _with_one_difference(graph: Graph, _: Factoring, outputs: Sequence[Scalar]) -> list[Scalar]:
    return with_one_difference(graph, outputs)


_SIGNS_AND_NUMBERS = (_with_one_difference, _with_numbers_joined)
_STEPS = (_with_numbers_moved, _with_parameters_joined)
# what two sums held is found in more of them once those two are one: short outputs are gone through twice
_LAST_STEPS = (_with_collected_factors, _with_shared_sums, _with_shared_sums, _with_shared_products)
_ONE_WAY = (_with_common_factors, _with_collected_factors, *_STEPS, with_late_factors, *_LAST_STEPS[2:])
