"""Monomials as whole numbers, so that a product of two is one addition; sums of them reduced by s^2 + c^2 = 1.

Squares of the roots of numbers are numbers.

Every atom has a field of 16 bits, to which its power is added: of either sign, `LARGEST_POWER` at most.  A bias makes
all fields positive; with a bias of 2^15 - 2 the highest bit of a field tells that a power is 2 or more.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import lcm
from struct import unpack
from typing import TypeAlias

from symgen.symbolic.graph import Graph

Code: TypeAlias = int
# Whole coefficients are integers: their arithmetic is many times faster than that of fractions.
Coefficient: TypeAlias = int | Fraction
Terms: TypeAlias = dict[Code, Coefficient]
# Atoms are given by their serial numbers, which sort and hash faster than the scalars themselves.
Monomial: TypeAlias = tuple[tuple[int, int], ...]

# Binary digits of the field that one atom has in the code of a monomial.
FIELD_BITS = 16
MIDDLE = 1 << (FIELD_BITS - 1)
LARGEST_POWER = MIDDLE - 3


class Monomials:
    """The fields of a graph's atoms, and which of them are sines, cosines and roots of numbers."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._places: dict[int, int] = {}
        self._atoms: list[int] = []
        self._positive = 0  # MIDDLE in every field
        self._squares = 0  # MIDDLE - 2 in every field
        self._sines = 0  # the highest bit of the fields of sines
        self._cosines = 0
        self._roots = 0
        self._partners: dict[Code, Code] = {}

    def unit(self, atom: int) -> Code:
        """The code of an atom to the power 1."""
        return 1 << self._shift(atom)

    def _shift(self, atom: int) -> int:
        shift = self._places.get(atom)
        if shift is None:
            shift = self._places[atom] = FIELD_BITS * len(self._atoms)
            self._atoms.append(atom)
            top = MIDDLE << shift
            self._positive += top
            self._squares += top - (2 << shift)
            node = self._graph.at(atom)
            if node.op == "sin":
                self._sines |= top
            elif node.op == "cos":
                self._cosines |= top
            elif node.op == "sqrt" and node.args[0].constant is not None:
                self._roots |= top
        return shift

    def read(self, code: Code) -> Monomial:
        """The atoms with their powers, in the order of the atoms."""
        count = len(self._atoms)
        fields = unpack(f"<{count}H", (code + self._positive).to_bytes(FIELD_BITS // 8 * count, "little"))
        return tuple(
            sorted([(atom, field - MIDDLE) for atom, field in zip(self._atoms, fields, strict=True) if field != MIDDLE])
        )

    def product(self, a: Terms, b: Terms) -> Terms:
        """The product, reduced."""
        (first, below), (second, other) = _whole(a), _whole(b)
        scale = below * other
        result: dict[Code, int] = {}
        get = result.get
        for left, x in first:
            for right, y in second:
                key = left + right
                result[key] = get(key, 0) + x * y
        if scale == 1:
            return self.reduced({key: value for key, value in result.items() if value})
        return self.reduced({key: _quotient(value, scale) for key, value in result.items() if value})

    def reduced(self, terms: Terms) -> Terms:
        """No square of a sine is left, which makes cancellation certain; then squares are put where they save terms."""
        bias, sines = self._squares, self._sines
        if self._roots and any((key + bias) & self._roots for key in terms):
            terms = self._without_squared_roots(terms)
        both = sines | self._cosines
        squared = [key for key in terms if (key + bias) & both]
        if not squared:
            return terms
        pending = [key for key in squared if (key + bias) & sines]
        work = dict(terms)
        while pending:
            key = pending.pop()
            squared_sines = (key + bias) & sines
            if not squared_sines or key not in work:
                continue
            value = work.pop(key)
            square = 2 << (squared_sines.bit_length() - FIELD_BITS)
            rest = key - square
            turned = rest + 2 * self._partner(square)
            # the partner may be an atom of its own from now on
            bias, sines = self._squares, self._sines
            pending += [put for put in (_put(work, rest, value), _put(work, turned, -value)) if put is not None]
        return self._with_sines(work)

    def _without_squared_roots(self, terms: Terms) -> Terms:
        work: Terms = {}
        for key, value in terms.items():
            while squared_roots := (key + self._squares) & self._roots:
                square = 2 << (squared_roots.bit_length() - FIELD_BITS)
                number = self._graph.at(self._atoms[(square.bit_length() - 2) // FIELD_BITS]).args[0].constant
                assert number is not None
                key, value = key - square, value * number
            _put(work, key, value.numerator if value.denominator == 1 else value)
        return work

    def _partner(self, square: Code) -> Code:
        """The code of the cosine or sine of the same angle as an atom, given by the code of its square."""
        known = self._partners.get(square)
        if known is None:
            node = self._graph.at(self._atoms[(square.bit_length() - 2) // FIELD_BITS])
            other = self._graph.trig("cos" if node.op == "sin" else "sin", node.args[0])
            known = self._partners[square] = self.unit(other.serial)
        return known

    def _with_sines(self, terms: Terms) -> Terms:
        """k T - k T c^2 = k T s^2 wherever both terms stand."""
        bias, cosines = self._squares, self._cosines
        squares = {key: self._first((key + bias) & cosines) for key in terms if (key + bias) & cosines}
        if not any(terms.get(key - square) == -terms[key] for key, square in squares.items()):
            return terms
        work = dict(terms)
        for key in sorted(squares, key=self.read):
            value, rest = work.get(key), key - squares[key]
            if value is not None and work.get(rest) == -value:
                del work[key], work[rest]
                _put(work, rest + 2 * self._partner(squares[key]), -value)
        return work

    def _first(self, marked: int) -> Code:
        """The square of the first atom, in the order of atoms, among fields whose highest bit is set."""
        if not marked & (marked - 1):
            return 2 << (marked.bit_length() - FIELD_BITS)
        return 2 * min(self._fields(marked), key=lambda unit: self._atoms[unit.bit_length() // FIELD_BITS])

    def _fields(self, marked: int) -> Iterator[Code]:
        """The units of the fields whose highest bit is set."""
        while marked:
            top = marked.bit_length()
            yield 1 << (top - FIELD_BITS)
            marked ^= 1 << (top - 1)


def _whole(terms: Terms) -> tuple[list[tuple[Code, int]], int]:
    """The terms with whole coefficients, and what they are to be divided by."""
    scale = lcm(*[value.denominator for value in terms.values()])
    return [(key, value.numerator * (scale // value.denominator)) for key, value in terms.items()], scale


def _quotient(value: int, divisor: int) -> Coefficient:
    return Fraction(value, divisor) if value % divisor else value // divisor


def _put(work: Terms, key: Code, value: Coefficient) -> Code | None:
    """Adds a term; returns its key where one stands now."""
    total = work.get(key, 0) + value
    if total:
        work[key] = total
        return key
    work.pop(key, None)
    return None
