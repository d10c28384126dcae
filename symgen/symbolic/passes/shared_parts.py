"""Parts that several sums or several products share: x + a - b and y + a - b with a - b computed once.

Sums and products are taken apart into their terms as far as nothing else needs what is inside; then the pair that most
of them hold becomes a term of its own, and so on (greedy: M. A. Breuer, Generation of optimal code for expressions via
factorization, 1969).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from heapq import heapify, heappop, heappush
from typing import TypeAlias

from symgen.symbolic.graph import Graph
from symgen.symbolic.passes.rebuilt import rebuilt
from symgen.symbolic.passes.terms import Term, product_of, sum_of, terms_of
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached, topological, uses_of

_Pair: TypeAlias = tuple[Term, Term]

# Terms of a sum or product up to which it shares parts with others.
MOST_SHARING_TERMS = 24
_SUM, _PRODUCT = ("add", "sub"), ("mul",)


def with_shared_sums(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs with pairs of terms that several sums hold, with the same or with opposite signs, added once."""
    return _Sharing(graph, _SUM, outputs).outputs()


def with_shared_products(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs with pairs of factors that several products hold multiplied once."""
    return _Sharing(graph, _PRODUCT, outputs).outputs()


class _Sharing:
    """The sums or the products of the outputs as lists of signed terms (signs of factors are positive)."""

    def __init__(self, graph: Graph, ops: Collection[str], outputs: Sequence[Scalar]) -> None:
        self._graph, self._ops, self._outputs = graph, ops, outputs
        self._order = topological(outputs)
        uses = uses_of(self._order, outputs)
        inside = {
            a for node in self._order if node.op in ops for a in node.args if a.op in ops and uses[a] == 1
        }
        # angles stay as they are: what else takes their sines and cosines has to find them
        angles = reached(node for node in self._order if node.op in ("sin", "cos"))
        roots = [node for node in self._order if node.op in ops and node not in inside and node not in angles]
        self._terms = {node: terms_of(node, inside) for node in roots}
        self._long = {node for node in roots if len(self._terms[node]) > MOST_SHARING_TERMS}

    def outputs(self) -> list[Scalar]:
        """The outputs rebuilt."""
        pairs = self._shared()
        if not pairs:
            return list(self._outputs)
        image: dict[Scalar, Scalar] = {}
        made: dict[Scalar, Scalar] = {}
        for node in self._order:
            terms = self._terms.get(node)
            if terms is None or node in self._long or not any(part in pairs for _, part in terms):
                args = tuple(map(image.__getitem__, node.args))
                image[node] = rebuilt(self._graph, node, args)
            else:
                image[node] = self._built(terms, pairs, image, made)
        return [image[output] for output in self._outputs]

    def _shared(self) -> dict[Scalar, _Pair]:
        """Pairs worth a term of their own, by the scalar that stands for them; `self._terms` then hold those."""
        places: dict[_Pair, set[Scalar]] = {}
        for node, terms in self._terms.items():
            if node not in self._long:
                for pair in _pairs(terms):
                    places.setdefault(pair, set()).add(node)
        shared: dict[Scalar, _Pair] = {}
        waiting = [_ranked(pair, nodes) for pair, nodes in places.items() if len(nodes) > 1]
        heapify(waiting)
        while waiting:
            count, *_, best = heappop(waiting)
            held = places.get(best, ())
            if len(held) != -count:
                # fewer sums hold it than when it was ranked; where more do, it was ranked again
                if 1 < len(held) < -count:
                    heappush(waiting, _ranked(best, held))
                continue
            whole = self._graph.stand_in(f"shared part {self._ops} {len(shared)}")
            shared[whole] = best
            for node in sorted(places.pop(best), key=lambda node: node.serial):
                for pair in _pairs(self._terms[node]):
                    if pair in places:
                        places[pair].discard(node)
                self._terms[node] = _with(self._terms[node], best, whole)
                for pair in _pairs(self._terms[node]):
                    nodes = places.setdefault(pair, set())
                    nodes.add(node)
                    if len(nodes) > 1:
                        heappush(waiting, _ranked(pair, nodes))
        return shared

    def _built(
        self, terms: Sequence[Term], pairs: Mapping[Scalar, _Pair], image: Mapping[Scalar, Scalar],
        made: dict[Scalar, Scalar],
    ) -> Scalar:
        """A sum or product of terms, of which some stand for pairs."""
        parts = []
        for sign, part in terms:
            if part in pairs and part not in made:
                made[part] = self._built(pairs[part], pairs, image, made)
            parts.append((sign, made[part] if part in pairs else image[part]))
        if self._ops is _PRODUCT:
            return product_of(self._graph, [factor for _, factor in parts])
        return sum_of(self._graph, parts)


def _pairs(terms: Sequence[Term]) -> set[_Pair]:
    """The pairs of different terms, the older one first and positive."""
    pairs: set[_Pair] = set()
    for k, (sign, a) in enumerate(terms):
        for second, b in terms[k + 1 :]:
            if a is not b:
                older, newer = (a, b) if a.serial < b.serial else (b, a)
                pairs.add(((1, older), (sign * second, newer)))
    return pairs


def _ranked(pair: _Pair, nodes: Collection[Scalar]) -> tuple[int, int, int, int, _Pair]:
    """A pair behind those that more sums hold, and behind older ones; sums before differences."""
    (_, a), (sign, b) = pair
    return -len(nodes), a.serial, b.serial, -sign, pair


def _with(terms: Sequence[Term], pair: _Pair, whole: Scalar) -> list[Term]:
    """The terms with `whole` in the place of the first that belongs to the pair.

    A sum may hold a part more than once and with both signs: the two that make the pair are taken.
    """
    (_, a), (opposite, b) = pair
    sign, first, second = next(
        (sign, k, second)
        for k, (sign, part) in enumerate(terms)
        if part is a
        for second, term in enumerate(terms)
        if term == (sign * opposite, b)
    )
    rest = [term for k, term in enumerate(terms) if k not in (first, second)]
    rest.insert(min(first, second), (sign, whole))
    return rest
