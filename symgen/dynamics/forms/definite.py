"""Which scalars of parameters cannot vanish: intervals over the declared ranges (Moore, Interval Analysis)."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from functools import reduce
from typing import TypeAlias

from symgen.dynamics.mechanics import Mechanics
from symgen.graph.scalar import Scalar
from symgen.graph.traverse import topological

Interval: TypeAlias = tuple[Fraction, Fraction]


class Definite:
    """Bounds of scalars that depend on parameters with a declared range only."""

    def __init__(self, mechanics: Mechanics) -> None:
        self._ranges: dict[str, Interval] = {
            parameter.name: (Fraction(parameter.range[0]), Fraction(parameter.range[1]))
            for parameter in mechanics.model.parameters
            if parameter.range is not None
        }
        self._known: dict[Scalar, Interval | None] = {}
        self._graph = mechanics.graph

    def holds(self, node: Scalar) -> bool:
        """Whether the scalar is never 0, whatever the parameters are within their ranges."""
        bounds = self.bounds(node)
        return bounds is not None and (bounds[0] > 0 or bounds[1] < 0)

    def parameter(self, name: str) -> Scalar:
        """The parameter of that name."""
        return self._graph.symbol(name)

    def bounds(self, node: Scalar) -> Interval | None:
        """An enclosure, or None where the scalar depends on anything else or may be unbounded."""
        for inner in topological([node], self._known):
            args = [self._known[argument] for argument in inner.args]
            self._known[inner] = self._enclosure(inner, args)
        return self._known[node]

    def _enclosure(self, node: Scalar, args: list[Interval | None]) -> Interval | None:
        if node.constant is not None:
            return node.constant, node.constant
        if node.op == "symbol":
            return self._ranges.get(str(node.payload))
        given = [a for a in args if a is not None]
        if len(given) < len(args):
            return None
        match node.op:
            case "add":
                return given[0][0] + given[1][0], given[0][1] + given[1][1]
            case "sub":
                return given[0][0] - given[1][1], given[0][1] - given[1][0]
            case "neg":
                return -given[0][1], -given[0][0]
            case "mul" if node.args[0] is node.args[1]:
                low, high = sorted(map(abs, given[0]))
                return (Fraction(0) if given[0][0] <= 0 <= given[0][1] else low * low), high * high
            case "mul":
                return _hull(a * b for a in given[0] for b in given[1])
            case "div" if not given[1][0] <= 0 <= given[1][1]:
                return _hull(a / b for a in given[0] for b in given[1])
            case _:
                return None

    def content(self, entries: list[Scalar]) -> Scalar:
        """The largest product of definite factors that divides every entry; 1 where there is none."""
        products = [self._graph.products.monomial(entry)[1] for entry in entries if not entry.is_zero]
        if not products:
            return self._graph.one
        shared = reduce(lambda a, b: {f: min(c, b[f]) for f, c in a.items() if c > 0 and b.get(f, 0) > 0}, products)
        factors = sorted((f for f in shared if shared[f] > 0 and self.holds(f)), key=lambda f: f.serial)
        return self._graph.product(f for f in factors for _ in range(shared[f]))

    def without(self, entry: Scalar, content: Scalar) -> Scalar:
        """entry / content for a content that divides it, without a division."""
        if content.is_one or entry.is_zero:
            return entry
        coefficient, powers = self._graph.products.monomial(entry)
        divided, taken = self._graph.products.monomial(content)
        rest = {factor: count - taken.get(factor, 0) for factor, count in powers.items()}
        ordered = sorted(rest.items(), key=lambda item: item[0].serial)
        product = self._graph.product(factor for factor, count in ordered for _ in range(count))
        for factor, count in ordered:
            for _ in range(-count):
                product = product / factor
        return self._graph.const(Fraction(coefficient) / divided) * product

    def ratio(self, entry: Scalar, divisor: Scalar) -> Scalar:
        """entry / divisor with the parameters' quotient in one piece, so that it is shared and can be computed once."""
        if entry.is_zero or divisor.is_one:
            return entry
        content = self.content([entry])
        return (content / divisor) * self.without(entry, content)


def _hull(values: Iterable[Fraction]) -> Interval:
    found = list(values)
    return min(found), max(found)
