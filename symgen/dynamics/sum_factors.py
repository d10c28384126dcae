"""Factors that terms of one sum have in common, taken out: x + f a + f b as x + f (a + b)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence

from symgen.graph.scalar import Graph, Scalar
from symgen.graph.traverse import topological
from symgen.records import dataclass

_SUMS = frozenset({"add", "sub"})
# Longer sums stay as they are.
MOST_TERMS = 64


@dataclass(frozen=True, slots=True)
class _Term:
    """A signed product and its factors."""

    sign: int
    product: Scalar
    factors: tuple[Scalar, ...]


@dataclass(frozen=True, slots=True)
class _Group:
    """`common` times the sum of the terms; what shares nothing is a group of one term without common factors."""

    place: int
    common: tuple[Scalar, ...]
    terms: tuple[_Term, ...]


def with_common_factors(graph: Graph, outputs: Sequence[Scalar]) -> list[Scalar]:
    """The outputs with common factors taken out of sums, from products and inner sums that nothing else needs."""
    order = topological(outputs)
    uses = Counter([*(argument for node in order for argument in node.args), *outputs])
    inside = {a for node in order if node.op in _SUMS for a in node.args if a.op in _SUMS and uses[a] == 1}
    image: dict[Scalar, Scalar] = {}
    for node in order:
        args = tuple(image[argument] for argument in node.args)
        image[node] = node if args == node.args else graph.raw(node.op, args, node.payload)
        if node.op in _SUMS and node not in inside:
            groups = _grouped([_Term(sign, term, _factors(term, uses)) for sign, term in _terms(node, inside)])
            if any(group.common for group in groups):
                quotients = _Quotients(graph, uses, image)
                image[node] = _sum(graph, [(g.terms[0].sign, quotients.product(g)) for g in groups])
    return [image[output] for output in outputs]


def _terms(node: Scalar, inside: Collection[Scalar]) -> list[tuple[int, Scalar]]:
    """The signed terms of a sum in their order, the sums `inside` taken apart."""
    found = []
    stack = [(1, node)]
    while stack:
        sign, term = stack.pop()
        if term is node or term in inside:
            left, right = term.args
            stack += [(-sign if term.op == "sub" else sign, right), (sign, left)]
        else:
            found.append((sign, term))
    return found


def _factors(term: Scalar, uses: Mapping[Scalar, int]) -> tuple[Scalar, ...]:
    """The factors of a product that nothing else needs, shared products whole."""
    if term.op != "mul" or uses[term] > 1:
        return (term,)
    return tuple(factor for argument in term.args for factor in _factors(argument, uses))


def _grouped(terms: Sequence[_Term]) -> list[_Group]:
    """The terms in groups, those first that save most products; in the order of their first terms."""
    left = dict(enumerate(terms)) if len(terms) <= MOST_TERMS else {}
    groups = []
    while left:
        holders: dict[Scalar, list[int]] = {}
        for place, term in left.items():
            for factor in dict.fromkeys(term.factors):
                if factor.constant is None and len(term.factors) > 1:
                    holders.setdefault(factor, []).append(place)
        shared = [(_common([left[place].factors for place in places]), places) for places in holders.values()]
        common, places = max(shared, key=lambda found: len(found[0]) * (len(found[1]) - 1), default=((), []))
        if len(places) < 2:
            break
        chosen = [left.pop(place) for place in places]
        groups.append(_Group(places[0], common, tuple(chosen)))
    groups += [_Group(place, (), (term,)) for place, term in left.items()]
    return sorted(groups, key=lambda group: group.place)


def _common(products: Sequence[tuple[Scalar, ...]]) -> tuple[Scalar, ...]:
    first, *others = (Counter(factors) for factors in products)
    for other in others:
        first &= other
    return tuple(factor for factor in first.elements() if factor.constant is None)


@dataclass(frozen=True, slots=True)
class _Quotients:
    """Products without some of their factors, otherwise multiplied in the order in which they were."""

    graph: Graph
    uses: Mapping[Scalar, int]
    image: Mapping[Scalar, Scalar]

    def product(self, group: _Group) -> Scalar:
        """The group without the sign of its first term."""
        sign = group.terms[0].sign
        rests = [(sign * term.sign, self._rest(term.product, Counter(group.common), True)) for term in group.terms]
        inner = _sum(self.graph, [(s, self.graph.one if rest is None else rest) for s, rest in rests])
        if not group.common:
            return inner
        return self.graph.raw("mul", (_product(self.graph, [self.image[f] for f in group.common]), inner))

    def _rest(self, node: Scalar, gone: Counter[Scalar], whole: bool) -> Scalar | None:
        """The product without the factors in `gone`, which loses them; None where nothing is left."""
        if node.op == "mul" and (whole or self.uses[node] == 1):
            left, right = (self._rest(argument, gone, False) for argument in node.args)
            if left is None or right is None:
                return right if left is None else left
            return self.graph.raw("mul", (left, right))
        if gone[node] > 0:
            gone[node] -= 1
            return None
        return self.image[node]


def _product(graph: Graph, factors: Sequence[Scalar]) -> Scalar:
    first, *others = factors
    for factor in others:
        first = graph.raw("mul", (first, factor))
    return first


def _sum(graph: Graph, terms: Sequence[tuple[int, Scalar]]) -> Scalar:
    """The sum of signed scalars, a positive one first if there is one."""
    start = next((place for place, (sign, _) in enumerate(terms) if sign > 0), 0)
    sign, total = terms[start]
    total = total if sign > 0 else graph.raw("neg", (total,))
    for place, (sign, term) in enumerate(terms):
        if place != start:
            total = graph.raw("add" if sign > 0 else "sub", (total, term))
    return total
