"""Scalars multiplied out, reduced by s^2 + c^2 = 1, and factored again: shorter where products were nested by accident.

A polynomial maps monomials over atoms to rational coefficients.  Atoms are symbols, sines and cosines, and whatever is
neither a sum nor a product; sums of parameters stay whole, because nothing cancels into them.  Exponents may be
negative: denominators are atoms too.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TypeAlias

from symgen.graph.scalar import Graph, Scalar

# Atoms are given by their serial numbers, which sort and hash faster than the scalars themselves.
Monomial: TypeAlias = tuple[tuple[int, int], ...]
# Whole coefficients are integers: their arithmetic is many times faster than that of fractions.
Coefficient: TypeAlias = int | Fraction
Polynomial: TypeAlias = dict[Monomial, Coefficient]

# Outputs beyond these are left as they are: nothing becomes shorter by multiplying out a long sum of long products.
MOST_TERMS = 120
MOST_OPERATIONS = 4000


class _TooLongError(Exception):
    """More terms than are worth handling."""


class Multiplier:
    """Multiplies scalars out; `whole` tells which sums are left alone."""

    def __init__(self, graph: Graph, whole: Callable[[Scalar], bool]) -> None:
        self._graph = graph
        self._whole = whole
        self._known: dict[Scalar, Polynomial] = {}
        self._circle = Circle(graph)

    def polynomial(self, node: Scalar) -> Polynomial | None:
        """The scalar as a reduced polynomial, or None where it has too many terms."""
        try:
            return reduced(self._circle, self._expand(node))
        except _TooLongError:
            return None

    def _expand(self, node: Scalar) -> Polynomial:
        known = self._known.get(node)
        if known is None:
            known = self._known[node] = self._expanded(node)
        if len(known) > MOST_TERMS:
            raise _TooLongError
        return known

    def _expanded(self, node: Scalar) -> Polynomial:
        if (value := node.constant) is not None:
            return {(): _whole(value)} if value else {}
        if node.op in ("add", "sub") and self._whole(node):
            return {((node.serial, 1),): 1}
        match node.op:
            case "add":
                return _sum(self._expand(node.args[0]), self._expand(node.args[1]), 1)
            case "sub":
                return _sum(self._expand(node.args[0]), self._expand(node.args[1]), -1)
            case "neg":
                return {key: -value for key, value in self._expand(node.args[0]).items()}
            case "mul":
                return self._times(self._expand(node.args[0]), self._expand(node.args[1]))
            case "div":
                return self._times(self._expand(node.args[0]), self._inverse(node.args[1]))
            case _:
                return {((node.serial, 1),): 1}

    def _inverse(self, node: Scalar) -> Polynomial:
        terms = self._expand(node)
        if len(terms) != 1:
            return {((node.serial, -1),): 1}
        ((key, value),) = terms.items()
        return {tuple((atom, -power) for atom, power in key): _whole(1 / Fraction(value))}

    def _times(self, a: Polynomial, b: Polynomial) -> Polynomial:
        if len(a) * len(b) > 8 * MOST_TERMS:
            raise _TooLongError
        result: Polynomial = {}
        for left, x in a.items():
            powers = dict(left)
            for right, y in b.items():
                key = _raised(powers, right) if left and right else left or right
                result[key] = result.get(key, 0) + x * y
        return reduced(self._circle, {key: value for key, value in result.items() if value})


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


def _sum(a: Polynomial, b: Polynomial, sign: int) -> Polynomial:
    result = dict(a)
    for key, value in b.items():
        result[key] = result.get(key, 0) + sign * value
    return {key: value for key, value in result.items() if value}


class Circle:
    """Which atoms are sines and cosines, and the cosine or sine of the same angle."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._partners: dict[str, dict[int, int | None]] = {"sin": {}, "cos": {}}

    def partner(self, name: str, atom: int) -> int | None:
        """For an atom that is a sine (`name` "sin") or a cosine ("cos") its partner on the circle, else None."""
        known = self._partners[name]
        if atom not in known:
            node = self._graph.nodes[atom]
            other = "cos" if name == "sin" else "sin"
            known[atom] = self._graph.trig(other, node.args[0]).serial if node.op == name else None
        return known[atom]

    def square(self, name: str, key: Monomial) -> int | None:
        """The first sine or cosine that stands in the monomial as a square."""
        for atom, power in key:
            if power >= 2 and self.partner(name, atom) is not None:
                return atom
        return None


def reduced(circle: Circle, terms: Polynomial) -> Polynomial:
    """No square of a sine is left (which makes cancellation certain), then squares are put where they save terms."""
    squared = _with_squares(terms)
    pending = [key for key in squared if circle.square("sin", key) is not None]
    if not pending and not any(circle.square("cos", key) is not None for key in squared):
        return terms
    work = dict(terms)
    while pending:
        key = pending.pop()
        square = circle.square("sin", key)
        if square is None or key not in work:
            continue
        value = work.pop(key)
        powers = dict(key)
        powers[square] -= 2
        pending += _put(work, powers, value)
        cosine = circle.partner("sin", square)
        assert cosine is not None
        powers[cosine] = powers.get(cosine, 0) + 2
        pending += _put(work, powers, -value)
    return _with_sines(circle, work)


def _with_squares(terms: Polynomial) -> list[Monomial]:
    found = []
    for key in terms:
        for _, power in key:
            if power >= 2:
                found.append(key)
                break
    return found


def _put(work: Polynomial, powers: dict[int, int], value: Coefficient) -> list[Monomial]:
    """Adds a term; returns its key where one stands now."""
    key = _key(powers)
    total = work.get(key, 0) + value
    if total:
        work[key] = total
        return [key]
    work.pop(key, None)
    return []


def _with_sines(circle: Circle, terms: Polynomial) -> Polynomial:
    """k T - k T c^2 = k T s^2 wherever both terms stand."""
    work = dict(terms)
    for key in sorted(key for key in _with_squares(terms) if circle.square("cos", key) is not None):
        value, square = work.get(key), circle.square("cos", key)
        if value is None or square is None:
            continue
        powers = dict(key)
        powers[square] -= 2
        partner = _key(powers)
        if work.get(partner) == -value:
            del work[key], work[partner]
            sine = circle.partner("cos", square)
            assert sine is not None
            powers[sine] = powers.get(sine, 0) + 2
            _put(work, powers, -value)
    return work


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
        total = graph.nodes[best] * factored(graph, quotient, first)
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
    above = [(graph.nodes[atom], power) for atom, power in key if power > 0]
    fixed = graph.product(atom for atom, power in above if first(atom) for _ in range(power))
    moving = graph.product(atom for atom, power in above if not first(atom) for _ in range(power))
    below = graph.product(graph.nodes[atom] for atom, power in key for _ in range(-power))
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
        terms = multiplier.polynomial(output) if output.size <= MOST_OPERATIONS else None
        result.append(output if terms is None else factored(graph, terms, first))
    return result
