"""Expressions as polynomials in some of their names: which products of these names occur."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeAlias

from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.expressions.walk import names_in

# Names with their exponents, in the order of the names; nothing for what holds none of them.
Monomial: TypeAlias = tuple[tuple[str, int], ...]


class NotInProductsError(Exception):
    """Some names stand in a function, below a fraction or under a root; `names` are those."""

    def __init__(self, names: frozenset[str]) -> None:
        super().__init__(", ".join(sorted(names)))
        self.names = names


def monomials(
    expressions: Iterable[Expression], names: frozenset[str], meanings: Mapping[str, Expression]
) -> tuple[Monomial, ...]:
    """All that occur, sorted; `meanings` are expressions that other names stand for.  Raises NotInProductsError."""
    walk = _ProductsIn(names, meanings)
    return tuple(sorted({one for expression in expressions for one in walk.of(expression)}, key=lambda m: (len(m), m)))


class _ProductsIn:
    def __init__(self, names: frozenset[str], meanings: Mapping[str, Expression]) -> None:
        self._names, self._meanings = names, meanings
        self._known: dict[str, frozenset[Monomial]] = {}

    def of(self, expression: Expression) -> frozenset[Monomial]:
        """Those of one expression."""
        match expression:
            case Number() | Pi():
                return _ONE
            case Name(name=name):
                return self._of_name(name)
            case Negation(operand=operand):
                return self.of(operand)
            case Binary(operator="+" | "-", left=left, right=right):
                return self.of(left) | self.of(right)
            case Binary(operator="*", left=left, right=right):
                return _products(self.of(left), self.of(right))
            case Binary(left=left, right=right):
                self._only_one(right)
                return self.of(left)
            case Power(base=base, exponent=exponent):
                if exponent.denominator != 1 or exponent < 0:
                    self._only_one(base)
                    return _ONE
                made = _ONE
                for _ in range(exponent.numerator):
                    made = _products(made, self.of(base))
                return made
            case Call(arguments=arguments):
                for argument in arguments:
                    self._only_one(argument)
                return _ONE

    def _of_name(self, name: str) -> frozenset[Monomial]:
        if name in self._names:
            return frozenset({((name, 1),)})
        if name not in self._meanings:
            return _ONE
        if name not in self._known:
            self._known[name] = self.of(self._meanings[name])
        return self._known[name]

    def _only_one(self, expression: Expression) -> None:
        """Raises NotInProductsError where names stand in what has to be free of them."""
        pending, seen = [expression], set[str]()
        while pending:
            for one in names_in(pending.pop()):
                if one.name not in seen:
                    seen.add(one.name)
                    if one.name not in self._names and one.name in self._meanings:
                        pending.append(self._meanings[one.name])
        if inside := seen & self._names:
            raise NotInProductsError(frozenset(inside))


_ONE: frozenset[Monomial] = frozenset({()})


def _products(left: frozenset[Monomial], right: frozenset[Monomial]) -> frozenset[Monomial]:
    made = set()
    for one in left:
        for other in right:
            powers = dict(one)
            for name, power in other:
                powers[name] = powers.get(name, 0) + power
            made.add(tuple(sorted(powers.items())))
    return frozenset(made)
