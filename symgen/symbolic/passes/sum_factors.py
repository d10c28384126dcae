"""Factors that terms of one sum have in common, taken out: x + f a + f b as x + f (a + b)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence

from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.passes.rebuilt import rebuilt
from symgen.symbolic.passes.terms import MOST_FACTORED_TERMS, SUMS, product_of, sum_of, terms_of, without_opposites
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological, uses_of


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


def with_common_factors(
    graph: Graph, outputs: Sequence[Scalar], apart: Callable[[Scalar], bool] | None = None, shared: bool = False
) -> list[Scalar]:
    """The outputs with common factors taken out of sums, from products and inner sums that nothing else needs.

    `apart` tells which terms of sums, such as parameters, are to be found though others need the products or the
    sums that hold them; numbers are factors too then.  `shared` products are taken apart, whatever they hold; sums
    that others need never are, as each would be written out at every place.
    """
    order = topological(outputs)
    uses = uses_of(order, outputs)
    whole = {node for node in order if uses[node] > 1 and not shared and (apart is None or not apart(node))}
    sums = [a for node in order if node.op in SUMS for a in node.args if a.op in SUMS]
    inside = {a for a in sums if uses[a] == 1 or (apart is not None and any(map(apart, a.args)))}
    image: dict[Scalar, Scalar] = {}
    for node in order:
        args = tuple(map(image.__getitem__, node.args))
        image[node] = rebuilt(graph, node, args)
        if node.op in SUMS and (node not in inside or uses[node] > 1):
            plain = terms_of(node, inside)
            kept = without_opposites(plain, uses) if len(plain) <= MOST_FACTORED_TERMS else plain
            terms = [_Term(sign, term, _factors(term, whole)) for sign, term in kept]
            groups = _grouped(terms, numbers=apart is not None)
            if len(kept) < len(plain) or any(group.common for group in groups):
                quotients = _Quotients(graph, whole, image, uses)
                signs = _signs(groups)
                image[node] = sum_of(graph, [(s, quotients.product(g, s)) for s, g in zip(signs, groups, strict=True)])
    return [image[output] for output in outputs]


def _factors(term: Scalar, whole: Collection[Scalar]) -> tuple[Scalar, ...]:
    """The factors of a product, those products left alone that are to stay whole."""
    if term.op != "mul" or term in whole:
        return (term,)
    return tuple(factor for argument in term.args for factor in _factors(argument, whole))


def _grouped(terms: Sequence[_Term], numbers: bool) -> list[_Group]:
    """The terms in groups, those first that save most products; in the order of their first terms."""
    left = dict(enumerate(terms)) if len(terms) <= MOST_FACTORED_TERMS else {}
    groups = []
    while left:
        holders: dict[Scalar, list[int]] = {}
        for place, term in left.items():
            for factor in dict.fromkeys(term.factors):
                if (numbers or factor.constant is None) and len(term.factors) > 1:
                    holders.setdefault(factor, []).append(place)
        several = (places for places in holders.values() if len(places) > 1)
        shared = [(_common([left[place].factors for place in places], numbers), places) for places in several]
        common, places = max(shared, key=lambda group: len(group[0]) * (len(group[1]) - 1), default=((), []))
        if not places:
            break
        chosen = [left.pop(place) for place in places]
        groups.append(_Group(places[0], common, tuple(chosen)))
    groups += [_Group(place, (), (term,)) for place, term in left.items()]
    return sorted(groups, key=lambda group: group.place)


def _signs(groups: Sequence[_Group]) -> list[int]:
    """Of each group that of its oldest term, so that a - b in one sum and b - a in another become the same.

    At least one is positive where that needs no sign of its own.
    """
    signs = [min(group.terms, key=lambda term: term.product.serial).sign for group in groups]
    if all(sign < 0 for sign in signs):
        mixed = (k for k, group in enumerate(groups) if any(term.sign > 0 for term in group.terms))
        signs[next(mixed, 0)] *= -1
    return signs


def _common(products: Sequence[tuple[Scalar, ...]], numbers: bool) -> tuple[Scalar, ...]:
    first, *others = (Counter(factors) for factors in products)
    for other in others:
        first &= other
    return tuple(factor for factor in first.elements() if numbers or factor.constant is None)


@dataclass(frozen=True, slots=True)
class _Quotients:
    """Products without some of their factors, otherwise multiplied in the order in which they were."""

    graph: Graph
    kept: Collection[Scalar]
    image: Mapping[Scalar, Scalar]
    uses: Mapping[Scalar, int]

    def product(self, group: _Group, sign: int) -> Scalar:
        """The group, divided by a sign."""
        rests = [(sign * term.sign, self._rest(term.product, Counter(group.common))) for term in group.terms]
        terms = [(s, self.graph.one if rest is None else rest) for s, rest in rests]
        inner = sum_of(self.graph, without_opposites(terms, self.uses) if group.common else terms)
        if not group.common:
            return inner
        return self.graph.raw("mul", (product_of(self.graph, [self.image[f] for f in group.common]), inner))

    def _rest(self, node: Scalar, gone: Counter[Scalar]) -> Scalar | None:
        """The product without the factors in `gone`, which loses them; None where nothing is left."""
        if node.op == "mul" and node not in self.kept:
            left, right = (self._rest(argument, gone) for argument in node.args)
            if left is None or right is None:
                return right if left is None else left
            return self.graph.raw("mul", (left, right))
        if gone[node] > 0:
            gone[node] -= 1
            return None
        return self.image[node]
