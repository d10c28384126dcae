"""A model seen numerically at one configuration: g, B, G in floats or other numbers, for checks while loading."""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from types import MappingProxyType

from symgen.model.checks.bodies import unsound_bodies
from symgen.model.configurations.algebra import Expansion, Polynomial
from symgen.model.configurations.dense import Rows
from symgen.model.configurations.gradient import Gradients
from symgen.model.configurations.numbers import FLOATS, Numbers
from symgen.model.configurations.sparse import Row
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import evaluate, exact_value
from symgen.model.kinematics.float_kinematics import FloatKinematics
from symgen.model.mechanism import NO_MECHANISM, Body, Mechanism, component
from symgen.model.model import ConstraintRow, Coordinate, Definition, Input, Model, Parameter

# The seed of random configurations and parameters: the same model is looked at at the same ones.
ANYWHERE_SEED = 20140211
# Configurations at which an expression is expanded in the rates, and at which bodies are seen to turn.
EXPANSION_POINTS = 2
# Draws to find as many, where expressions have no value at some.
EXPANSION_DRAWS = 30
# Turning rates of a frame, up to which rounding makes them.
LEAST_TURN = 1e-11


class NumericSystem:
    """The parts of a model that say how it moves, evaluated in floats unless `within` other numbers."""

    def __init__(
        self,
        coordinates: tuple[Coordinate, ...],
        parameters: tuple[Parameter, ...],
        definitions: tuple[Definition, ...],
        constraints: tuple[ConstraintRow, ...],
        kinetic_energy: Expression,
        mechanism: Mechanism = NO_MECHANISM,
    ) -> None:
        self.coordinates, self.constraints = coordinates, constraints
        self.geometric = tuple(row for row in constraints if row.kind == "geometric")
        self.mechanism = mechanism
        self._kinetic = kinetic_energy
        self.definitions = definitions
        self._definitions = {definition.name: definition.value for definition in definitions}
        self._index = {coordinate.name: index for index, coordinate in enumerate(coordinates)}
        self._rates = frozenset(coordinate.rate for coordinate in coordinates)
        self.parameters = parameters
        self._expanded: dict[int, tuple[Expression, list[Polynomial]]] = {}
        self.defaults = default_values(parameters)
        self.numbers = FLOATS

    @classmethod
    def of(cls, model: Model) -> NumericSystem:
        """That of a model, as its formulas and its mechanism say how it moves."""
        return cls(
            model.coordinates,
            model.parameters,
            model.definitions,
            model.constraints,
            model.kinetic_energy,
            model.mechanism,
        )

    def having(
        self,
        defaults: dict[str, float],
        constraints: tuple[ConstraintRow, ...] | None = None,
        definitions: tuple[Definition, ...] | None = None,
        mechanism: Mechanism | None = None,
    ) -> NumericSystem:
        """The same with other default parameters, and with other parts where these are given."""
        other = NumericSystem(
            self.coordinates,
            self.parameters,
            self.definitions if definitions is None else definitions,
            self.constraints if constraints is None else constraints,
            self._kinetic,
            self.mechanism if mechanism is None else mechanism,
        )
        other.defaults = defaults
        return other

    def within(self, numbers: Numbers) -> NumericSystem:
        """The same with its default parameters, evaluated in other numbers."""
        other = self.having(self.defaults)
        other.numbers, values = numbers, dict[str, float]()
        for parameter in self.parameters:
            try:
                values[parameter.name] = numbers.evaluate(parameter.value, values)
            except (ArithmeticError, ValueError):
                values[parameter.name] = self.defaults[parameter.name]
        other.defaults = values
        return other

    def expansion(self, q: Sequence[float], parameters: dict[str, float]) -> Expansion:
        """Polynomials in the rates at a configuration."""
        values = {**parameters, **self._named(q)}
        kinematics = self._kinematics(values, self._index)
        rates = [coordinate.rate for coordinate in self.coordinates]

        def polynomial(name: str) -> Polynomial:
            if component(name).is_rate:
                return {(rates[i],): (value, abs(value)) for i, value in kinematics.rate(name).items()}
            value = kinematics.value(name)
            return {(): (value, abs(value))}

        return Expansion(values, self._rates, self._definitions, polynomial, self.numbers)

    def polynomials(self, expression: Expression) -> list[Polynomial]:
        """The expression in the rates at a few random points of its domain; NotPolynomialError where it is none."""
        # Keyed by identity: the trees of a model live as long as this object, and comparing them costs a walk.
        if id(expression) not in self._expanded:
            self._expanded[id(expression)] = (expression, list(self._expansions(expression)))
        return self._expanded[id(expression)][1]

    def _expansions(self, expression: Expression) -> Iterator[Polynomial]:
        count = 0
        for q, parameters in self.anywhere(EXPANSION_DRAWS):
            try:
                yield self.expansion(q, parameters).of(expression)
            except (ArithmeticError, ValueError):
                continue
            count += 1
            if count == EXPANSION_POINTS:
                return

    def turning(self) -> dict[str, tuple[bool, bool, bool]]:
        """For the frame of each body, about which of its own axes it can turn: at a few random configurations."""
        able: dict[str, tuple[bool, bool, bool]] = {}
        points = self.anywhere(EXPANSION_POINTS) if self.mechanism.bodies else ()
        for q, parameters in points:
            kinematics = self._kinematics({**parameters, **self._named(q)}, self._index)
            for frame in dict.fromkeys(body.frame for body in self.mechanism.bodies):
                try:
                    turns = [any(abs(x) > LEAST_TURN for x in form.values()) for form in kinematics.turning(frame)]
                except (ArithmeticError, ValueError, KeyError):
                    continue
                before = able.get(frame, (False, False, False))
                x, y, z = (one or other for one, other in zip(before, turns, strict=True))
                able[frame] = x, y, z
        return able

    @property
    def mass_is_sure(self) -> bool:
        """Whether T is that of bodies alone, each of which has none below 0."""
        return self.mechanism.has_mass and exact_value(self._kinetic) == 0 and not self.unsound

    @cached_property
    def unsound(self) -> tuple[Body, ...]:
        """The bodies with a negative principal moment, as identified values may have it."""
        return unsound_bodies(self.mechanism, self.defaults)

    def mass_matrix(self, q: Sequence[float]) -> Rows:
        """G, n x n."""
        n = len(self.coordinates)
        matrix = self._kinematics({**self.defaults, **self._named(q)}, self._index).mass_matrix(n)
        order = {coordinate.rate: index for index, coordinate in enumerate(self.coordinates)}
        for monomial, (value, _) in self.expansion(q, self.defaults).of(self._kinetic).items():
            if len(monomial) == 2:
                i, j = order[monomial[0]], order[monomial[1]]
                matrix[i][j] += value
                matrix[j][i] += value
        return matrix

    def values(self, q: Sequence[float], numbers: Sequence[int]) -> list[float]:
        """Of the geometric rows with these numbers."""
        evaluated = self._gradients(q, {})
        return [evaluated.of(self.geometric[i].expression)[0] for i in numbers]

    def residuals(self, q: Sequence[float], numbers: Sequence[int]) -> tuple[list[float], list[Row]]:
        """Values and gradients of the geometric rows with these numbers."""
        gradients = self._gradients(q, self._index)
        pairs = [gradients.of(self.geometric[i].expression) for i in numbers]
        return [value for value, _ in pairs], [gradient for _, gradient in pairs]

    def gradients(self, q: Sequence[float], expressions: Iterable[Expression]) -> list[Row]:
        """Those of functions of the configuration."""
        gradients = self._gradients(q, self._index)
        return [gradients.of(expression)[1] for expression in expressions]

    def _gradients(self, q: Sequence[float], index: Mapping[str, int]) -> Gradients:
        """Values, and gradients by the coordinates in the index."""
        values = {**self.defaults, **self._named(q)}
        place = self._kinematics(values, index).place
        return Gradients(values, index, self._definitions, place, self.numbers)

    def rows(self, q: Sequence[float]) -> list[Row]:
        """B, r rows."""
        rows = self.residuals(q, range(len(self.geometric)))[1]
        if len(rows) == len(self.constraints):
            return rows
        expansion = self.expansion(q, self.defaults)
        for row in self.constraints:
            if row.kind == "nonholonomic":
                rows.append(self._coefficients(expansion.of(row.expression)))
        return rows

    def columns(self, q: Sequence[float], inputs: Sequence[Input]) -> list[Row]:
        """The columns of M, as rows."""
        expansion = self.expansion(q, self.defaults)
        columns = []
        for item in inputs:
            if item.velocity is not None:
                columns.append(self._coefficients(expansion.of(item.velocity)))
            else:
                values = ((self._index[c], expansion.of(value).get((), (0.0, 0.0))[0]) for c, value in item.acts_on)
                columns.append(dict(values))
        return columns

    def _coefficients(self, polynomial: Polynomial) -> Row:
        """Of the rates, in an expression that is linear in them."""
        terms = ((i, polynomial.get((c.rate,))) for i, c in enumerate(self.coordinates))
        return {i: pair[0] for i, pair in terms if pair is not None}

    def jacobian(self, q: Sequence[float]) -> Rows:
        """B, r x n."""
        return [[row.get(j, 0.0) for j in range(len(self.coordinates))] for row in self.rows(q)]

    def anywhere(self, count: int) -> Iterator[tuple[list[float], dict[str, float]]]:
        """Random configurations with random parameters, for what must hold whatever their values."""
        generator = random.Random(ANYWHERE_SEED + 1)
        for _ in range(count):
            q = [generator.uniform(float(c.range[0]), float(c.range[1])) for c in self.coordinates]
            yield q, {p.name: _drawn(p, self.defaults[p.name], generator) for p in self.parameters}

    def _kinematics(self, values: dict[str, float], index: Mapping[str, int]) -> FloatKinematics:
        # frames use definitions, definitions may use points: those that frames use are evaluated without components
        return FloatKinematics(self.mechanism, Gradients(values, index, self._definitions, numbers=self.numbers))

    def _named(self, q: Sequence[float]) -> dict[str, float]:
        return {coordinate.name: value for coordinate, value in zip(self.coordinates, q, strict=True)}


def default_values(
    parameters: tuple[Parameter, ...], chosen: Mapping[str, float] = MappingProxyType({})
) -> dict[str, float]:
    """The parameters' defaults in floats, where some are `chosen` others follow from these.

    One that cannot be evaluated (a mistake reported elsewhere) counts as 1.
    """
    values: dict[str, float] = {}
    for parameter in parameters:
        try:
            values[parameter.name] = (
                chosen[parameter.name] if parameter.name in chosen else evaluate(parameter.value, values)
            )
        except (ArithmeticError, ValueError):
            values[parameter.name] = 1.0
    return values


def _drawn(parameter: Parameter, default: float, generator: random.Random) -> float:
    if parameter.range is not None:
        return generator.uniform(float(parameter.range[0]), float(parameter.range[1]))
    return default * generator.uniform(0.7, 1.3) if default else generator.uniform(-0.1, 0.1)
