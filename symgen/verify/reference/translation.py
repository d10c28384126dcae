"""From parsed expressions to Taylor polynomials on a tape, and the literals that stand in them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias

from flint import arb

from symgen.diagnostics import SymgenBug
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.mechanism import Mechanism, Quaternion, is_component
from symgen.model.model import Model
from symgen.verify.reference.arithmetic.tape import Register, ball
from symgen.verify.reference.arithmetic.taylor import CONSTANT, Polynomial, Taylor
from symgen.verify.reference.fixed_turns import is_known, sine_and_cosine

Moving: TypeAlias = Callable[[int], tuple[Polynomial, Polynomial]]


def literals_of(model: Model) -> tuple[Number | Pi, ...]:
    """Every literal of the model's formulas, in order of reading; default values of parameters do not count."""
    literals: dict[int, Number | Pi] = {}
    for expression in _formulas(model):
        for node in _walk(expression):
            if isinstance(node, Pi) or (isinstance(node, Number) and node.value != 0):
                literals.setdefault(id(node), node)
    return tuple(literals.values())


def literal_values(literals: Sequence[Number | Pi]) -> list[Any]:
    """The literals as balls of the working precision."""
    return [arb.pi() if isinstance(literal, Pi) else ball(literal.value) for literal in literals]


@dataclass(frozen=True)
class Translation:
    """Expressions to polynomials; a literal that is not among `literals` is a constant."""

    algebra: Taylor
    names: dict[str, Polynomial]
    definitions: dict[str, Expression]
    literals: dict[int, Register]
    component: Callable[[str], Polynomial] | None = None

    def polynomial(self, expression: Expression) -> Polynomial:
        """The Taylor polynomial of an expression."""
        algebra = self.algebra
        match expression:
            case Number(value):
                if value == 0:
                    return {}
                register = self.literals.get(id(expression))
                return {CONSTANT: algebra.tape.constant(value) if register is None else register}
            case Pi():
                register = self.literals.get(id(expression))
                return {CONSTANT: self._pi() if register is None else register}
            case Name(name):
                if name not in self.names:
                    of_component = self.component(name) if self.component is not None and is_component(name) else None
                    self.names[name] = self.polynomial(self.definitions[name]) if of_component is None else of_component
                return self.names[name]
            case Negation(operand):
                return algebra.negate(self.polynomial(operand))
            case Binary(operator, left, right):
                combine = {
                    "+": algebra.add,
                    "-": algebra.subtract,
                    "*": algebra.multiply,
                    "/": algebra.divide,
                }[operator]
                return combine(self.polynomial(left), self.polynomial(right))
            case Power(base, exponent):
                return algebra.power(self.polynomial(base), exponent)
            case Call("atan2", (y, x)):
                return algebra.angle(self.polynomial(y), self.polynomial(x))
            case Call("sin" | "cos" as function, (argument,)) if (exact := sine_and_cosine(argument)) is not None:
                known = exact[function == "cos"]
                return {CONSTANT: algebra.tape.constant(Fraction(known))} if known else {}
            case Call(function, (argument,)):
                return algebra.function(function, self.polynomial(argument))
        raise SymgenBug(f"reference: no rule for {expression}")

    def _pi(self) -> Register:
        """pi of a parameter's default value, as 4 atan(1)."""
        tape = self.algebra.tape
        return tape.scaled(Fraction(4), tape.unary("atan", tape.one))


def translation(
    model: Model,
    literals: Sequence[Number | Pi],
    algebra: Taylor,
    moving: Moving,
    component: Callable[[str], Polynomial],
) -> Translation:
    """The model's names on the inputs of a replay: coordinates, rates, parameters, literals, in this order.

    `moving` gives the polynomials of the j-th coordinate and of its rate; an empty one for a rate that must not occur.
    """
    tape, n = algebra.tape, model.n
    names: dict[str, Polynomial] = {}
    for j, coordinate in enumerate(model.coordinates):
        place, rate = moving(j)
        names[coordinate.name] = place
        if rate:
            names[coordinate.rate] = rate
    for j, parameter in enumerate(model.parameters):
        names[parameter.name] = {CONSTANT: tape.input(2 * n + j)}
    first = 2 * n + len(model.parameters)
    known = {id(literal): tape.input(first + j) for j, literal in enumerate(literals)}
    definitions = {definition.name: definition.value for definition in model.definitions}
    return Translation(algebra, names, definitions, known, component)


def uses_components(model: Model, expression: Expression) -> bool:
    """Whether points or frames occur in an expression or in the definitions it uses."""
    definitions = {definition.name: definition.value for definition in model.definitions}
    pending, seen = [expression], set[str]()
    while pending:
        for node in _walk(pending.pop()):
            if isinstance(node, Name) and node.name not in seen:
                seen.add(node.name)
                if node.name in definitions:
                    pending.append(definitions[node.name])
                elif is_component(node.name):
                    return True
    return False


def _formulas(model: Model) -> Iterator[Expression]:
    yield from (definition.value for definition in model.definitions)
    yield model.kinetic_energy
    yield model.potential_energy
    yield from (row.expression for row in model.constraints)
    yield from (x.expression for x in model.task)
    yield from (entry for control in model.inputs for _, entry in control.acts_on)
    yield from (force.expression for force in model.applied_forces)
    for control in model.inputs:
        if control.velocity is not None:
            yield control.velocity
    for element in model.forces:
        yield element.magnitude
        yield element.velocity
    for place in model.rough:
        yield from (place.coefficient, place.radius, place.width, place.velocity)
        yield from () if place.load is None else (place.load,)
    yield from _of_mechanism(model.mechanism)


def _of_mechanism(mechanism: Mechanism) -> Iterator[Expression]:
    """What places frames and points and what bodies weigh; axes are directions, their literals are exact.

    So are turns by angles whose sines everybody knows, such as pi/2: no kernel rounds the pi of a quarter turn.
    """
    yield from mechanism.gravity
    for frame in mechanism.frames:
        yield from frame.translation
        rotation = frame.rotation
        if isinstance(rotation, Quaternion):
            yield from rotation.parts
        else:
            yield from (turn.angle for turn in rotation if not is_known(turn.angle))
    for body in mechanism.bodies:
        yield body.mass
        yield from body.com
        for row in body.inertia.rows:
            yield from row
    for point in mechanism.points:
        yield from point.at
    yield from (rotor.inertia for rotor in mechanism.rotor_inertias)


def _walk(expression: Expression) -> Iterator[Expression]:
    """All that an expression is made of, but for known angles: no kernel rounds what their sines are made of."""
    pending = [expression]
    while pending:
        node = pending.pop()
        yield node
        match node:
            case Negation(operand):
                pending.append(operand)
            case Binary(_, left, right):
                pending.extend((right, left))
            case Power(base, _):
                pending.append(base)
            case Call("sin" | "cos", (angle,)) if is_known(angle):
                continue
            case Call(_, arguments):
                pending.extend(reversed(arguments))
