"""Rewriting rules as identities in a prime field: what a rule makes has the value of what was asked for, exactly."""

from __future__ import annotations

import random
from fractions import Fraction

from symgen.symbolic.fingerprint import PRIME
from symgen.symbolic.graph import Graph
from symgen.symbolic.passes.shared_parts import with_shared_products, with_shared_sums
from symgen.symbolic.scalar import Scalar

DRAWS = 400


def _product(graph: Graph, draw: random.Random, powers: dict[Scalar, int], angles: list[Scalar]) -> Scalar:
    """A number times powers, of either sign, and a sine or cosine of each angle."""
    counts = dict(powers)
    for angle in angles:
        turned = graph.trig(draw.choice(("sin", "cos")), angle)
        counts[turned] = counts.get(turned, 0) + 1
    total = graph.const(draw.choice((1, -1, 1, 1, Fraction(1, 2))))
    for factor in draw.sample([*counts], len(counts)):
        count = counts[factor]
        for _ in range(abs(count)):
            total = total * factor if count > 0 else total / factor
    return total


def test_sums_of_products_of_sines_keep_every_divisor() -> None:
    combined = 0
    for seed in range(DRAWS):
        graph, draw = Graph(), random.Random(seed)
        p, q = (graph.symbol(name) for name in "pq")
        factors = [graph.trig(op, angle) for op in ("sin", "cos") for angle in (p, q, p + q)]
        factors += [graph.symbol(name) for name in "km"]
        common = {factor: draw.choice((0, 0, 1, -1, -2)) for factor in factors}
        a, b = (_product(graph, draw, common, draw.choice(([p, q], [p, p + q], [q, q]))) for _ in range(2))
        assert (a + b).value == (a.value + b.value) % PRIME
        assert (a - b).value == (a.value - b.value) % PRIME
        combined += (a + b).op != "add"
    assert combined > DRAWS // 20


def _sum(graph: Graph, draw: random.Random, op: tuple[str, ...], parts: list[Scalar]) -> Scalar:
    total = draw.choice(parts)
    for _ in range(draw.randrange(2, 6)):
        total = graph.raw(draw.choice(op), (total, draw.choice(parts)))
    return total


def test_parts_that_stand_in_a_sum_with_both_signs_are_told_apart() -> None:
    changed = 0
    for seed in range(DRAWS):
        draw = random.Random(seed)
        for op, step in ((("add", "sub"), with_shared_sums), (("mul",), with_shared_products)):
            graph = Graph()
            parts = [graph.symbol(name) for name in "abcd"]
            outputs = [_sum(graph, draw, op, parts) for _ in range(4)]
            rewritten = step(graph, outputs)
            assert [x.value for x in rewritten] == [x.value for x in outputs]
            changed += rewritten != outputs
    assert changed > DRAWS
