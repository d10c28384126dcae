"""From a model's expressions to fractions of ring elements, and their derivatives."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction

from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.angles import (
    AngleBasis,
    LinearDefinitions,
    SineArgument,
    choose_basis,
    read_argument,
    trigonometric_arguments,
)
from symgen.closedform.algebra.quotient import Quotient, polynomial
from symgen.closedform.algebra.ring import Opaque, TrigRing
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.expressions.walk import names_in, parts

ONE = Number(Fraction(1))


class Translator:
    """Translates expressions of one model into its ring, and differentiates ring elements."""

    def __init__(
        self,
        variables: Iterable[str],
        configuration: Iterable[str],
        definitions: Mapping[str, Expression],
        preferred: Iterable[Expression],
        others: Iterable[Expression],
    ) -> None:
        self.definitions = dict(definitions)
        self._linear = LinearDefinitions(self.definitions)
        atoms: dict[Expression, Opaque] = {}
        arguments = [self._scan(group, atoms) for group in (preferred, others)]
        basis: AngleBasis = choose_basis(*arguments)
        self.ring = TrigRing(tuple(variables), tuple(configuration), basis, tuple(atoms.values()))
        self.nested = self._below([base for atom in basis.atoms for base, _ in atom], atoms)
        self._opaque = {key: self.ring.opaque_position[i] for i, key in enumerate(atoms)}
        self._values: dict[Expression, Quotient] = {}
        self._slopes: dict[tuple[int, str], Quotient] = {}
        self._last: tuple[PolyElement, frozenset[int]] | None = None

    def _scan(self, expressions: Iterable[Expression], atoms: dict[Expression, Opaque]) -> list[SineArgument]:
        """Angle arguments and opaque atoms of the expressions, of everything they name and of their derivatives."""
        arguments: list[SineArgument] = []
        pending = list(expressions)
        seen: set[Expression] = set()
        while pending:
            expression = pending.pop(0)
            if expression in seen:
                continue
            seen.add(expression)
            for argument in trigonometric_arguments(expression):
                split = read_argument(argument, self._linear)
                arguments.append(split)
                pending += [base for base, _ in split.combination]
            for part in parts(expression):
                if isinstance(part, Name) and part.name in self.definitions:
                    pending.append(self.definitions[part.name])
                atom = opaque_atom(part)
                if atom is not None and atom.expression not in atoms:
                    atoms[atom.expression] = atom
                    pending += [slope for _, slope in atom.outer_derivatives]
        return arguments

    def _below(self, *groups: Iterable[Expression]) -> tuple[str, ...]:
        """The definitions that these expressions use, directly or by others, in the order of use."""
        used: set[str] = set()
        pending = [expression for group in groups for expression in group]
        while pending:
            for name in names_in(pending.pop()):
                if name.name in self.definitions and name.name not in used:
                    used.add(name.name)
                    pending.append(self.definitions[name.name])
        return tuple(name for name in self.definitions if name in used)

    def value(self, expression: Expression) -> Quotient:
        """The expression as a fraction of ring elements, definitions by value."""
        known = self._values.get(expression)
        if known is None:
            known = self._values[expression] = self._translate(expression)
        return known

    def constant(self, value: Fraction | int) -> Quotient:
        """A rational number."""
        return polynomial(self.ring, self.ring.constant(value))

    def name(self, name: str) -> Quotient:
        """A variable of the ring."""
        return polynomial(self.ring, self.ring.generator(self.ring.position[name]))

    def _translate(self, expression: Expression) -> Quotient:
        match expression:
            case Number(value):
                return self.constant(value)
            case Name(name):
                if name in self.definitions:
                    return self.value(self.definitions[name])
                return self.name(name)
            case Negation(operand):
                return -self.value(operand)
            case Binary("+", left, right):
                return self.value(left) + self.value(right)
            case Binary("-", left, right):
                return self.value(left) - self.value(right)
            case Binary("*", left, right):
                return self.value(left) * self.value(right)
            case Binary("/", left, right):
                return self.value(left) / self.value(right)
            case Power(base, exponent):
                return self._power(base, exponent)
            case Call("sin" | "cos" | "tan" as function, (argument,)):
                split = read_argument(argument, self._linear)
                sine, cosine = self.ring.multiple_angle(self.ring.basis.multiples(split), split.quarter_turns)
                pair = polynomial(self.ring, sine), polynomial(self.ring, cosine)
                return pair[0] if function == "sin" else pair[1] if function == "cos" else pair[0] / pair[1]
            case Call("sqrt", (argument,)):
                return self._power(argument, Fraction(1, 2))
            case _:
                return polynomial(self.ring, self.ring.generator(self._opaque[expression]))

    def _power(self, base: Expression, exponent: Fraction) -> Quotient:
        whole, part = divmod(exponent, 1)
        value = self.value(base)
        result = self.constant(1)
        for _ in range(abs(whole)):
            result = result * value
        if whole < 0:
            result = self.constant(1) / result
        if part:
            root = polynomial(self.ring, self.ring.generator(self._opaque[Power(base, Fraction(1, part.denominator))]))
            for _ in range(part.numerator):
                result = result * root
        return result

    def derivative(self, value: Quotient, name: str) -> Quotient:
        """The partial derivative of a fraction with respect to a variable."""
        slope = self._polynomial_derivative(value.numerator, name)
        if value.is_polynomial:
            return slope
        bottom = polynomial(self.ring, value.denominator)
        fall = self._polynomial_derivative(value.denominator, name)
        if not fall:
            return slope / bottom
        return (slope * bottom - polynomial(self.ring, value.numerator) * fall) / (bottom * bottom)

    def _polynomial_derivative(self, p: PolyElement, name: str) -> Quotient:
        ring = self.ring
        used = self._used(p)
        ring.work.spend(len(p))
        position = ring.position[name]
        total = polynomial(ring, p.diff(position) if position in used else ring.zero)
        for index, (s, c) in enumerate(zip(ring.sine, ring.cosine, strict=True)):
            if s not in used and c not in used:
                continue
            rate = self._angle_slope(index, name)
            if rate:
                ring.work.spend(4 * len(p))
                x, y = ring.generator(s), ring.generator(c)
                turn = ring.normal(y * p.diff(s) - x * p.diff(c))
                total = total + polynomial(ring, turn) * rate
        for index, position in enumerate(ring.opaque_position):
            if position in used:
                slope = self.constant(0)
                for argument, outer in ring.opaque[index].outer_derivatives:
                    inner = self.derivative(self.value(argument), name)
                    if inner:
                        slope = slope + self.value(outer) * inner
                total = total + polynomial(ring, ring.normal(p.diff(position))) * slope
        return total

    def _used(self, p: PolyElement) -> frozenset[int]:
        """The positions of the generators that occur, kept for the next of the variables."""
        if self._last is None or self._last[0] is not p:
            self._last = p, frozenset(self.ring.shape(p))
        return self._last[1]

    def _angle_slope(self, index: int, name: str) -> Quotient:
        """The derivative of an angle atom with respect to a variable."""
        key = (index, name)
        if key not in self._slopes:
            total = self.constant(0)
            for base, factor in self.ring.basis.atoms[index]:
                if isinstance(base, Name):
                    inner = self.constant(1 if base.name == name else 0)
                else:
                    inner = self.derivative(self.value(base), name)
                total = total + self.constant(factor) * inner
            self._slopes[key] = total
        return self._slopes[key]


def opaque_atom(expression: Expression) -> Opaque | None:
    """The atom an expression needs because the ring cannot hold it, with its derivative; None if it can."""
    match expression:
        case Pi():
            return Opaque(expression, ())
        case Power(base, exponent) if exponent.denominator != 1:
            return _root(base, exponent.denominator)
        case Call("sqrt", (argument,)):
            return _root(argument, 2)
        case Call("sin" | "cos" | "tan", _):
            return None
        case Call("atan2", (y, x)):
            square = Binary("+", Power(x, Fraction(2)), Power(y, Fraction(2)))
            return Opaque(expression, ((y, Binary("/", x, square)), (x, Negation(Binary("/", y, square)))))
        case Call(function, (u,)):
            rest = Binary("-", ONE, Power(u, Fraction(2)))
            slopes: dict[str, Expression] = {
                "asin": Power(rest, Fraction(-1, 2)),
                "acos": Negation(Power(rest, Fraction(-1, 2))),
                "atan": Binary("/", ONE, Binary("+", ONE, Power(u, Fraction(2)))),
                "exp": expression,
                "log": Binary("/", ONE, u),
                "sinh": Call("cosh", (u,)),
                "cosh": Call("sinh", (u,)),
                "tanh": Binary("-", ONE, Power(expression, Fraction(2))),
            }
            return Opaque(expression, ((u, slopes[function]),))
        case _:
            return None


def _root(base: Expression, degree: int) -> Opaque:
    root = Power(base, Fraction(1, degree))
    return Opaque(root, ((base, Binary("/", root, Binary("*", Number(Fraction(degree)), base))),))
