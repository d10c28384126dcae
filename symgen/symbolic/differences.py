"""Sums of coordinates and what is fixed, as x + 1.2 and x_1 - x_2: how far something is from a place.

They become small where a length does, and their squares multiplied out are the differences of numbers that do not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import TypeAlias

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

_Terms: TypeAlias = dict[Scalar, Fraction]


class Differences:
    """The sums of multiples of `coordinates` and of `fixed` scalars; those that differ by a factor are one atom."""

    def __init__(self, graph: Graph, coordinates: Iterable[Scalar], fixed: Callable[[Scalar], bool]) -> None:
        self._graph = graph
        self._coordinates = frozenset(coordinates)
        self._fixed = fixed
        self._terms: dict[Scalar, _Terms | None] = {}
        # by what they hold per unit of their first coordinate: an atom, and how much of that coordinate it holds
        self._atoms: dict[tuple[tuple[int, Fraction], ...], tuple[Scalar, Fraction]] = {}

    def read(self, node: Scalar) -> tuple[Scalar, Fraction] | None:
        """The atom that a sum is a multiple of, and the factor; None for what is no difference."""
        terms = self._linear(node)
        first = None if terms is None else min(terms.keys() & self._coordinates, key=lambda x: x.serial, default=None)
        if terms is None or first is None or len(terms) < 2:
            return None
        factor = terms[first]
        key = tuple(sorted((part.serial, value / factor) for part, value in terms.items()))
        if key not in self._atoms:
            self._atoms[key] = self._atom(node, terms, factor)
        atom, share = self._atoms[key]
        return atom, factor / share

    def _atom(self, node: Scalar, terms: _Terms, factor: Fraction) -> tuple[Scalar, Fraction]:
        """The sum as it stands where it is short, so that others have it in common with results."""
        products = [part for part, value in terms.items() if abs(value) != 1 and not part.is_one]
        if abs(factor) == 1 and node.size < len(terms) + len(products):
            return node, factor
        ordered = sorted(terms.items(), key=lambda term: (term[0] not in self._coordinates, term[0].serial))
        total = self._graph.sum(self._graph.const(value / factor) * part for part, value in ordered)
        return total, Fraction(1)

    def _linear(self, node: Scalar) -> _Terms | None:
        """The coefficients of coordinates and fixed scalars, of 1 for numbers; None for what is not linear."""
        if node not in self._terms:
            self._terms[node] = self._coefficients(node)
        return self._terms[node]

    def _coefficients(self, node: Scalar) -> _Terms | None:
        if (value := node.constant) is not None:
            return {self._graph.one: value} if value else {}
        match node.op:
            case "add" | "sub":
                left, right = (self._linear(part) for part in node.args)
                return None if left is None or right is None else _sum(left, right, 1 if node.op == "add" else -1)
            case "neg":
                inner = self._linear(node.args[0])
                return None if inner is None else {part: -value for part, value in inner.items()}
            case "mul" if any(part.constant is not None for part in node.args):
                number, inner = (self._linear(part) for part in sorted(node.args, key=lambda x: x.constant is None))
                if number is None or inner is None:
                    return None
                factor = number.get(self._graph.one, Fraction(0))
                return {part: factor * value for part, value in inner.items()}
            case _:
                return {node: Fraction(1)} if node in self._coordinates or self._fixed(node) else None


def _sum(a: _Terms, b: _Terms, sign: int) -> _Terms:
    result = dict(a)
    for part, value in b.items():
        result[part] = result.get(part, Fraction(0)) + sign * value
    return {part: value for part, value in result.items() if value}
