"""Scalars multiplied out, reduced by s^2 + c^2 = 1, and factored again: shorter where products were nested by accident.

A polynomial maps monomials over atoms to rational coefficients.  Atoms are symbols, sines and cosines, and whatever is
neither a sum nor a product; sums of parameters stay whole, because nothing cancels into them, and differences of
coordinates where nothing cancels between them.  Exponents may be negative: denominators are atoms too.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TypeAlias

from symgen.symbolic.differences import Differences
from symgen.symbolic.graph import Graph
from symgen.symbolic.polynomials.monomials import LARGEST_POWER, Coefficient, Monomial, Monomials, Terms
from symgen.symbolic.scalar import Scalar

Polynomial: TypeAlias = dict[Monomial, Coefficient]

# Terms of an output that is multiplied out: nothing becomes shorter by multiplying out a long sum of long products.
MOST_EXPANDED_TERMS = 120
# Operations of an output that is multiplied out.
MOST_EXPANDED_OPERATIONS = 4000


class _TooManyTermsError(Exception):
    """More terms than are worth handling."""


class Multiplier:
    """Multiplies scalars out; `whole` tells which sums are left alone, `differences` which may be."""

    def __init__(self, graph: Graph, whole: Callable[[Scalar], bool], differences: Differences | None = None) -> None:
        self._graph = graph
        self._whole = whole
        self._differences = differences
        # all of it multiplied out, asked where differences were met
        self._further = None if differences is None else Multiplier(graph, whole)
        self._met: set[int] = set()
        self._known: dict[Scalar, tuple[Terms, int]] = {}
        self._monomials = Monomials(graph)

    def polynomial(self, node: Scalar) -> Polynomial | None:
        """The scalar as a reduced polynomial, or None where it has too many terms or too high a degree.

        What becomes small with products of differences stays a polynomial of these, unless without them no more terms
        are left.  A single factor multiplied out is as exact as the coordinates are.
        """
        own = self._polynomial(node)
        if self._further is None:
            return own
        if own is not None:
            powers = [[power for atom, power in key if atom in self._met] for key in own]
            if not any(powers):
                return own
        further = self._further.polynomial(node)
        if own is None or further is None:
            return further if own is None else own
        squared = any(sum(power for power in each if power > 0) > 1 for each in powers)
        return own if squared and len(own) < len(further) else further

    def _polynomial(self, node: Scalar) -> Polynomial | None:
        try:
            terms, _ = self._expand(node)
        except _TooManyTermsError:
            return None
        read = self._monomials.read
        return {read(key): value for key, value in self._monomials.reduced(terms).items()}

    def _expand(self, node: Scalar) -> tuple[Terms, int]:
        """The terms of a scalar and a bound of every power in them."""
        known = self._known.get(node)
        if known is None:
            known = self._known[node] = self._expanded(node)
        if len(known[0]) > MOST_EXPANDED_TERMS or known[1] > LARGEST_POWER:
            raise _TooManyTermsError
        return known

    def _expanded(self, node: Scalar) -> tuple[Terms, int]:
        if (value := node.constant) is not None:
            return ({0: _whole(value)} if value else {}), 0
        if node.op in ("add", "sub") and self._whole(node):
            return {self._monomials.unit(node.serial): 1}, 1
        if node.op in ("add", "sub") and self._differences is not None and (read := self._differences.read(node)):
            atom, factor = read
            self._met.add(atom.serial)
            return {self._monomials.unit(atom.serial): _whole(factor)}, 1
        match node.op:
            case "add" | "sub":
                (a, high), (b, other) = self._expand(node.args[0]), self._expand(node.args[1])
                return _sum(a, b, 1 if node.op == "add" else -1), max(high, other)
            case "neg":
                terms, high = self._expand(node.args[0])
                return {key: -value for key, value in terms.items()}, high
            case "mul":
                return self._times(self._expand(node.args[0]), self._expand(node.args[1]))
            case "div":
                return self._times(self._expand(node.args[0]), self._inverse(node.args[1]))
            case _:
                return {self._monomials.unit(node.serial): 1}, 1

    def _inverse(self, node: Scalar) -> tuple[Terms, int]:
        terms, high = self._expand(node)
        if len(terms) != 1:
            return {-self._monomials.unit(node.serial): 1}, 1
        ((key, value),) = terms.items()
        return {-key: _whole(1 / Fraction(value))}, high

    def _times(self, a: tuple[Terms, int], b: tuple[Terms, int]) -> tuple[Terms, int]:
        power = a[1] + b[1]
        if len(a[0]) * len(b[0]) > 8 * MOST_EXPANDED_TERMS or power > LARGEST_POWER:
            raise _TooManyTermsError
        return self._monomials.product(a[0], b[0]), power


def _whole(value: Fraction) -> Coefficient:
    return value.numerator if value.denominator == 1 else value


def _product(a: Monomial, b: Monomial) -> Monomial:
    if not b:
        return a
    if not a:
        return b
    return _raised(dict(a), b)


def _raised(powers: dict[int, int], b: Monomial) -> Monomial:
    """The product of a monomial, given by its powers, and another."""
    powers = powers.copy()
    for atom, power in b:
        powers[atom] = powers.get(atom, 0) + power
    return _key(powers)


def _key(powers: dict[int, int]) -> Monomial:
    return tuple(sorted([entry for entry in powers.items() if entry[1]]))


def _sum(a: Terms, b: Terms, sign: int) -> Terms:
    result = dict(a)
    for key, value in b.items():
        result[key] = result.get(key, 0) + sign * value
    return {key: value for key, value in result.items() if value}


def factored(graph: Graph, terms: Polynomial, first: Callable[[Scalar], bool]) -> Scalar:
    """The polynomial as a scalar: common factors out, then the most frequent atom, and so on (greedy Horner).

    Atoms for which `first` holds are multiplied with each other before the rest, so that their products are shared.
    """
    if not terms:
        return graph.zero
    shared = _common(terms)
    inner = {_product(key, tuple((a, -p) for a, p in shared)): value for key, value in terms.items()}
    if len(inner) == 1:
        ((key, value),) = inner.items()
        return _multiply(graph, value, _product(key, shared), first)
    counts = Counter([atom for key in inner for atom, power in key if power > 0])
    best = max(counts, key=lambda atom: (counts[atom], -atom), default=None)
    if best is None or counts[best] == 1:
        total = graph.sum(_multiply(graph, value, key, first) for key, value in sorted(inner.items()))
    else:
        chosen = {key: value for key, value in inner.items() if dict(key).get(best, 0) > 0}
        quotient = {_product(key, ((best, -1),)): value for key, value in chosen.items()}
        rest = {key: value for key, value in inner.items() if key not in chosen}
        total = graph.at(best) * factored(graph, quotient, first)
        if rest:
            total = total + factored(graph, rest, first)
    return _multiply(graph, 1, shared, first, total)


def _common(terms: Polynomial) -> Monomial:
    """The largest monomial that divides every term, the smallest power of each denominator included."""
    keys = [dict(key) for key in terms]
    atoms = {atom for key in keys for atom in key}
    return _key({atom: min(key.get(atom, 0) for key in keys) for atom in atoms})


def _multiply(
    graph: Graph, value: Coefficient, key: Monomial, first: Callable[[Scalar], bool], rest: Scalar | None = None
) -> Scalar:
    above = [(graph.at(atom), power) for atom, power in key if power > 0]
    fixed = graph.product(atom for atom, power in above if first(atom) for _ in range(power))
    moving = graph.product(atom for atom, power in above if not first(atom) for _ in range(power))
    below = graph.product(graph.at(atom) for atom, power in key for _ in range(-power))
    weight = fixed if below.is_one else fixed / below
    if rest is not None:
        moving = moving * rest
    return graph.const(value) * (weight * moving)


def refactored(
    graph: Graph, outputs: Sequence[Scalar], multiplier: Multiplier, first: Callable[[Scalar], bool]
) -> list[Scalar]:
    """Each output multiplied out and factored again; the output itself where that would be too long."""
    result = []
    for output in outputs:
        terms = multiplier.polynomial(output) if output.size <= MOST_EXPANDED_OPERATIONS else None
        result.append(output if terms is None else factored(graph, terms, first))
    return result
