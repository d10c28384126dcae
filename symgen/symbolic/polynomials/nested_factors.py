"""The factors of a determinant of blocks, which nest in it: a (d p) - c (b p), with p = e h - g f, is (a d - c b) p."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar


def nested_factors(scalar: Scalar, fixed: Callable[[Scalar], bool]) -> tuple[Scalar, ...]:
    """Scalars one of which is 0 wherever the scalar is; those that are `fixed` belong to the first of the others.

    The scalar itself where it is no product.
    """
    factors = list(dict.fromkeys(_factors(scalar)))
    constant, moving = [x for x in factors if fixed(x)], [x for x in factors if not fixed(x)]
    if len(moving) < 2:
        return (scalar,)
    return (scalar.graph.product([*constant, moving[0]]), *moving[1:])


def _factors(scalar: Scalar) -> Iterator[Scalar]:
    graph = scalar.graph
    _, powers = graph.products.monomial(scalar)
    if any(power < 0 for power in powers.values()):
        yield scalar
        return
    for factor in powers:
        common, rest = _content(graph, factor)
        if rest is None:
            yield factor
        else:
            yield from (inner for x in common for inner in _factors(x))
            yield from _factors(rest)


def _content(graph: Graph, factor: Scalar) -> tuple[list[Scalar], Scalar | None]:
    """What all terms of a sum have as a factor, and the sum without it; None where there is nothing."""
    if factor.op not in ("add", "sub"):
        return [], None
    terms = list(_terms(factor))
    monomials = [graph.products.monomial(term)[1] for _, term in terms]
    first, *others = monomials
    shared = {x: min(power, *(other.get(x, 0) for other in others)) for x, power in first.items()}
    common = {x: power for x, power in shared.items() if power > 0}
    if not common:
        return [], None
    rest = graph.sum(sign * graph.products.quotient(term, common) for sign, term in terms)
    return list(common), rest


def _terms(scalar: Scalar) -> Iterator[tuple[int, Scalar]]:
    """What a sum consists of, however deep sums stand in it, with their signs."""
    stack = [(1, scalar)]
    while stack:
        sign, part = stack.pop()
        if part.op in ("add", "sub"):
            left, right = part.args
            stack += [(-sign if part.op == "sub" else sign, right), (sign, left)]
        elif part.op == "neg":
            stack.append((-sign, part.args[0]))
        else:
            yield sign, part
