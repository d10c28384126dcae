"""The angles of a model: which sine-cosine pairs span every sine and cosine that occurs.

All arguments of sin, cos and tan are integer combinations of a few *atoms*.  The atoms are chosen among the arguments
themselves (preferably those of the constraints), so that a mechanism written in relative angles still gets its short
closed forms in absolute ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from math import lcm
from typing import TypeAlias

from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.expressions.walk import parts
from symgen.records import dataclass

LARGEST_MULTIPLE = 12
"""Multiples of an angle beyond this are not expanded by addition theorems; the whole argument is then an atom."""

Combination: TypeAlias = tuple[tuple[Expression, Fraction], ...]
"""A linear combination of base angles: names, or sub-expressions that are not linear in names."""


@dataclass(frozen=True, slots=True)
class SineArgument:
    """The argument of a sine: a combination of base angles plus a number of quarter turns."""

    combination: Combination
    quarter_turns: int


@dataclass(frozen=True, slots=True)
class AngleBasis:
    """Atoms as combinations of base angles, and every base angle's unit as an integer combination of the atoms."""

    atoms: tuple[Combination, ...]
    in_atoms: Mapping[Expression, tuple[int, ...]]
    units: Mapping[Expression, Fraction]

    def multiples(self, argument: SineArgument) -> tuple[int, ...]:
        """How often each atom enters an argument that was seen when the basis was chosen."""
        total = [0] * len(self.atoms)
        for base, coefficient in argument.combination:
            steps = coefficient / self.units[base]
            for index, part in enumerate(self.in_atoms[base]):
                total[index] += int(steps) * part
        return tuple(total)


def rational_constant(expression: Expression) -> Fraction | None:
    """The value of an expression made of numbers only, None for anything else."""
    match expression:
        case Number(value):
            return value
        case Negation(operand):
            value_or_none = rational_constant(operand)
            return None if value_or_none is None else -value_or_none
        case Binary(operator, left, right):
            a, b = rational_constant(left), rational_constant(right)
            if a is None or b is None or (operator == "/" and b == 0):
                return None
            return {"+": a + b, "-": a - b, "*": a * b}[operator] if operator != "/" else a / b
        case Power(base, exponent):
            value_or_none = rational_constant(base)
            if value_or_none is None or exponent.denominator != 1 or (value_or_none == 0 and exponent < 0):
                return None
            return Fraction(value_or_none**exponent.numerator)
        case _:
            return None


def read_argument(expression: Expression, definitions: LinearDefinitions) -> SineArgument:
    """Split a sine's argument into base angles and quarter turns."""
    terms: dict[Expression, Fraction] = {}
    turns = _collect(expression, Fraction(1), definitions, terms)
    if turns.denominator != 1:
        quotient = turns.numerator // turns.denominator
        rest = Binary("*", Number((turns - quotient) / 2), Pi())
        terms[rest] = terms.get(rest, Fraction(0)) + 1
        turns = Fraction(quotient)
    combination = tuple((base, factor) for base, factor in terms.items() if factor != 0)
    if any(abs(f.numerator) > LARGEST_MULTIPLE or f.denominator > LARGEST_MULTIPLE for _, f in combination):
        return SineArgument(((expression, Fraction(1)),), 0)
    return SineArgument(combination, int(turns))


def _collect(
    expression: Expression,
    factor: Fraction,
    definitions: LinearDefinitions,
    terms: dict[Expression, Fraction],
) -> Fraction:
    """Add `factor` times the expression to `terms`; returns the quarter turns found."""
    match expression:
        case Pi():
            return 2 * factor
        case Negation(operand):
            return _collect(operand, -factor, definitions, terms)
        case Binary("+" | "-" as operator, left, right):
            turns = _collect(left, factor, definitions, terms)
            return turns + _collect(right, factor if operator == "+" else -factor, definitions, terms)
        case Binary("*", left, right):
            for constant, other in ((left, right), (right, left)):
                value = rational_constant(constant)
                if value is not None:
                    return _collect(other, factor * value, definitions, terms)
        case Binary("/", left, right):
            value = rational_constant(right)
            if value:
                return _collect(left, factor / value, definitions, terms)
        case Name(name):
            known = definitions.collected(name)
            if known is not None and factor:
                for base, count in known.terms.items():
                    if isinstance(base, Number):  # a constant angle, which is kept positive
                        _add(terms, Number(abs(base.value * factor)), count if factor > 0 else -count)
                    else:
                        _add(terms, base, factor * count)
                return factor * known.turns
        case _:
            pass
    value = rational_constant(expression)
    if value is not None:
        if value * factor != 0:
            _add(terms, Number(abs(value * factor)), Fraction(1 if value * factor > 0 else -1))
        return Fraction(0)
    _add(terms, expression, factor)
    return Fraction(0)


def _add(terms: dict[Expression, Fraction], base: Expression, factor: Fraction) -> None:
    terms[base] = terms.get(base, Fraction(0)) + factor


@dataclass(frozen=True, slots=True)
class _Collected:
    """An expression's terms and quarter turns."""

    terms: dict[Expression, Fraction]
    turns: Fraction


class LinearDefinitions:
    """The terms of definitions, each taken apart once however definitions nest."""

    def __init__(self, definitions: Mapping[str, Expression]) -> None:
        self._definitions = definitions
        self._known: dict[str, _Collected | None] = {}
        for name in definitions:  # in the order of use: a long chain is no deep recursion
            self.collected(name)

    def collected(self, name: str) -> _Collected | None:
        """Terms and quarter turns of a definition; None for other names."""
        if name not in self._known:
            value = self._definitions.get(name)
            if value is None:
                self._known[name] = None
            else:
                terms: dict[Expression, Fraction] = {}
                turns = _collect(value, Fraction(1), self, terms)
                self._known[name] = _Collected(terms, turns)
        return self._known[name]


def choose_basis(preferred: Iterable[SineArgument], others: Iterable[SineArgument]) -> AngleBasis:
    """Atoms that span all arguments, taken from `preferred` (single angles first), then `others`, then base angles."""
    preferred, others = tuple(preferred), tuple(others)
    units: dict[Expression, Fraction] = {}
    for argument in preferred + others:
        for base, coefficient in argument.combination:
            step = units.get(base, Fraction(1)).denominator
            units[base] = Fraction(1, lcm(step, coefficient.denominator))
    bases = tuple(units)
    atoms: list[Combination] = []
    in_atoms: dict[Expression, dict[int, int]] = {}

    def accept(combination: Combination) -> bool:
        """Take the combination as an atom when it brings exactly one new base angle, once."""
        new = [(base, factor / units[base]) for base, factor in combination if base not in in_atoms]
        if len(new) != 1 or abs(new[0][1]) != 1:
            return False
        base, sign = new[0][0], int(new[0][1])
        expansion = {len(atoms): sign}
        for other, factor in combination:
            if other != base:
                steps = int(factor / units[other])
                for index, part in in_atoms[other].items():
                    expansion[index] = expansion.get(index, 0) - sign * steps * part
        atoms.append(combination)
        in_atoms[base] = {index: part for index, part in expansion.items() if part}
        return True

    for group in (preferred, others):
        pending = sorted({a.combination: None for a in group if a.combination}, key=len)
        progress = True
        while progress:
            progress = any(accept(combination) for combination in pending)
    for base in bases:
        if base not in in_atoms:
            accept(((base, units[base]),))
    vectors = {base: tuple(shares.get(i, 0) for i in range(len(atoms))) for base, shares in in_atoms.items()}
    return AngleBasis(tuple(atoms), vectors, units)


def trigonometric_arguments(expression: Expression) -> Iterable[Expression]:
    """The arguments of every sin, cos and tan in the tree, in order of appearance."""
    for part in parts(expression):
        if isinstance(part, Call) and part.function in ("sin", "cos", "tan"):
            yield part.arguments[0]
