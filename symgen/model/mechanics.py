"""A model seen numerically at one configuration: g, B, G in floats, for the checks made while loading."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator

from symgen.model.algebra import Expansion, Polynomial
from symgen.model.dense import Rows, solve_definite
from symgen.model.expression import Expression
from symgen.model.float_kinematics import FloatKinematics
from symgen.model.gradient import Gradients
from symgen.model.mechanism import NO_MECHANISM, Mechanism, component
from symgen.model.model import ConstraintRow, Coordinate, Definition, Parameter
from symgen.model.walk import evaluate, exact_value

SEED = 20140211
STARTS = 40
STEPS = 80
POINTS = 2
ATTEMPTS = 30
RESIDUAL = 1e-11
NEARBY = 8


class Mechanics:
    """The parts of a model that say how it moves, evaluated in floats."""

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
        self.mechanism = mechanism
        self._kinetic = kinetic_energy
        self._definitions = {definition.name: definition.value for definition in definitions}
        self._index = {coordinate.name: index for index, coordinate in enumerate(coordinates)}
        self._rates = frozenset(coordinate.rate for coordinate in coordinates)
        self._parameters = parameters
        self._expanded: dict[int, tuple[Expression, list[Polynomial]]] = {}
        self.defaults = default_values(parameters)

    def expansion(self, q: list[float], parameters: dict[str, float]) -> Expansion:
        """Polynomials in the rates at a configuration."""
        values = {**parameters, **self._named(q)}
        kinematics = self._kinematics(values)
        rates = [coordinate.rate for coordinate in self.coordinates]

        def polynomial(name: str) -> Polynomial:
            if component(name).is_rate:
                return {(rates[i],): (value, abs(value)) for i, value in kinematics.rate(name).items()}
            value = kinematics.value(name)
            return {(): (value, abs(value))}

        return Expansion(values, self._rates, self._definitions, polynomial)

    def polynomials(self, expression: Expression) -> list[Polynomial]:
        """The expression in the rates at a few random points of its domain; NotPolynomialError where it is none."""
        # Keyed by identity: the trees of a model live as long as this object, and comparing them costs a walk.
        if id(expression) not in self._expanded:
            self._expanded[id(expression)] = (expression, list(self._expansions(expression)))
        return self._expanded[id(expression)][1]

    def _expansions(self, expression: Expression) -> Iterator[Polynomial]:
        found = 0
        for q, parameters in self.anywhere(ATTEMPTS):
            try:
                yield self.expansion(q, parameters).of(expression)
            except (ArithmeticError, ValueError):
                continue
            found += 1
            if found == POINTS:
                return

    def turning(self) -> dict[str, tuple[bool, bool, bool]]:
        """For the frame of each body, about which of its own axes it can turn: at a few random configurations."""
        able: dict[str, tuple[bool, bool, bool]] = {}
        points = self.anywhere(POINTS) if self.mechanism.bodies else ()
        for q, parameters in points:
            kinematics = self._kinematics({**parameters, **self._named(q)})
            for frame in dict.fromkeys(body.frame for body in self.mechanism.bodies):
                try:
                    found = [any(abs(x) > RESIDUAL for x in form.values()) for form in kinematics.turning(frame)]
                except (ArithmeticError, ValueError, KeyError):
                    continue
                before = able.get(frame, (False, False, False))
                x, y, z = (one or other for one, other in zip(before, found, strict=True))
                able[frame] = x, y, z
        return able

    @property
    def mass_is_sure(self) -> bool:
        """Whether T is that of bodies alone, whose masses and inertias are checked one by one."""
        return self.mechanism.has_mass and exact_value(self._kinetic) == 0

    def mass_matrix(self, q: list[float]) -> Rows:
        """G, n x n."""
        n = len(self.coordinates)
        matrix = self._kinematics({**self.defaults, **self._named(q)}).mass_matrix(n)
        order = {coordinate.rate: index for index, coordinate in enumerate(self.coordinates)}
        for monomial, (value, _) in self.expansion(q, self.defaults).of(self._kinetic).items():
            if len(monomial) == 2:
                i, j = order[monomial[0]], order[monomial[1]]
                matrix[i][j] += value
                matrix[j][i] += value
        return matrix

    def geometric(self, q: list[float]) -> tuple[list[float], Rows]:
        """g and its Jacobian, r_g and r_g x n."""
        values = {**self.defaults, **self._named(q)}
        gradients = Gradients(values, self._index, self._definitions, self._kinematics(values).place)
        residual: list[float] = []
        jacobian: Rows = []
        for row in self.constraints:
            if row.kind == "geometric":
                value, gradient = gradients.of(row.expression)
                residual.append(value)
                jacobian.append([gradient.get(index, 0.0) for index in range(len(self.coordinates))])
        return residual, jacobian

    def jacobian(self, q: list[float]) -> Rows:
        """B, r x n."""
        rows = self.geometric(q)[1]
        expansion = self.expansion(q, self.defaults)
        for row in self.constraints:
            if row.kind == "nonholonomic":
                polynomial = expansion.of(row.expression)
                rows.append([polynomial.get((c.rate,), (0.0, 0.0))[0] for c in self.coordinates])
        return rows

    def admissible(self, start: dict[str, float], count: int) -> Iterator[list[float]]:
        """Up to `count` configurations on the geometric constraints: from `start`, then around it or at random."""
        anchor: list[float] | None = None
        guesses = self._guesses(start)
        around = random.Random(SEED + 2)
        for attempt in range(STARTS):
            # Near a known point Newton is quick; without one, or now and then, the whole range is tried.
            if anchor is not None and attempt % 4:
                guess = [
                    a + around.uniform(-0.15, 0.15) * float(c.range[1] - c.range[0])
                    for a, c in zip(anchor, self.coordinates, strict=True)
                ]
            else:
                guess = next(guesses)
            found = self._project(guess)
            if found is not None:
                anchor = anchor or found
                yield found
                count -= 1
                if count == 0:
                    return

    def widest_open(self, start: dict[str, float]) -> tuple[ConstraintRow, float] | None:
        """Where nothing closes the mechanism: the worst geometric row at the nearest configuration found, and its
        value; None where no row has a value."""
        nearest: tuple[float, list[float]] | None = None
        for guess in itertools.islice(self._guesses(start), NEARBY):
            found = self._settle(guess)
            if found is not None and (nearest is None or found[0] < nearest[0]):
                nearest = found
        if nearest is None:
            return None
        rows = [row for row in self.constraints if row.kind == "geometric"]
        values = self.geometric(nearest[1])[0]
        worst = max(range(len(rows)), key=lambda index: abs(values[index]))
        return rows[worst], values[worst]

    def anywhere(self, count: int) -> Iterator[tuple[list[float], dict[str, float]]]:
        """Random configurations with random parameters, for what must hold whatever their values."""
        generator = random.Random(SEED + 1)
        for _ in range(count):
            q = [generator.uniform(float(c.range[0]), float(c.range[1])) for c in self.coordinates]
            yield q, {p.name: _drawn(p, self.defaults[p.name], generator) for p in self._parameters}

    def _kinematics(self, values: dict[str, float]) -> FloatKinematics:
        # frames use definitions, definitions may use points: those that frames use are evaluated without components
        return FloatKinematics(self.mechanism, Gradients(values, self._index, self._definitions))

    def _named(self, q: list[float]) -> dict[str, float]:
        return {coordinate.name: value for coordinate, value in zip(self.coordinates, q, strict=True)}

    def _guesses(self, start: dict[str, float]) -> Iterator[list[float]]:
        """The start, completed with the middles of the ranges, then random configurations."""
        generator = random.Random(SEED)
        yield [start.get(c.name, float(sum(c.range)) / 2) for c in self.coordinates]
        while True:
            yield [generator.uniform(float(c.range[0]), float(c.range[1])) for c in self.coordinates]

    def _project(self, q: list[float]) -> list[float] | None:
        """The configuration with g = 0 that Levenberg and Marquardt's method reaches from q."""
        found = self._settle(q)
        return found[1] if found is not None and found[0] == 0 else None

    def _settle(self, q: list[float]) -> tuple[float, list[float]] | None:
        """Where that method stops: |g|^2, 0 where g vanishes, and the configuration; None outside of g's domain."""
        n = len(q)
        damping = 1e-3
        try:
            residual, jacobian = self.geometric(q)
        except (ArithmeticError, ValueError):
            return None
        for _ in range(STEPS):
            if _vanishes(residual, jacobian, q):
                return 0.0, q
            step = _damped_step(jacobian, residual, damping, n)
            if step is None:
                break
            trial = [a + b for a, b in zip(q, step, strict=True)]
            try:
                trial_residual, trial_jacobian = self.geometric(trial)
            except (ArithmeticError, ValueError):
                damping *= 10
                continue
            if sum(g * g for g in trial_residual) < sum(g * g for g in residual):
                q, residual, jacobian = trial, trial_residual, trial_jacobian
                damping = max(damping / 30, 1e-14)
            else:
                damping *= 10
                if damping > 1e12:
                    break
        return sum(g * g for g in residual), q


def _damped_step(jacobian: Rows, residual: list[float], damping: float, n: int) -> list[float] | None:
    """-(J'J + mu)^-1 J'g, which is -J'(JJ' + mu)^-1 g: the smaller of the two systems is solved."""
    scale = max((sum(row[i] * row[i] for row in jacobian) for i in range(n)), default=0.0) or 1.0
    if len(jacobian) >= n:
        normal = [[sum(row[i] * row[j] for row in jacobian) for j in range(n)] for i in range(n)]
        slope = [-sum(row[i] * g for row, g in zip(jacobian, residual, strict=True)) for i in range(n)]
        for i in range(n):
            normal[i][i] += damping * scale
        return solve_definite(normal, slope)
    gram = [[sum(a * b for a, b in zip(row, other, strict=True)) for other in jacobian] for row in jacobian]
    for i, row in enumerate(gram):
        row[i] += damping * scale
    weights = solve_definite(gram, residual)
    if weights is None:
        return None
    return [-sum(w * row[i] for w, row in zip(weights, jacobian, strict=True)) for i in range(n)]


def default_values(parameters: tuple[Parameter, ...]) -> dict[str, float]:
    """The parameters' defaults in floats; one that cannot be evaluated (a mistake reported elsewhere) counts as 1."""
    values: dict[str, float] = {}
    for parameter in parameters:
        try:
            values[parameter.name] = evaluate(parameter.value, values)
        except (ArithmeticError, ValueError):
            values[parameter.name] = 1.0
    return values


def _drawn(parameter: Parameter, default: float, generator: random.Random) -> float:
    if parameter.range is not None:
        return generator.uniform(float(parameter.range[0]), float(parameter.range[1]))
    return default * generator.uniform(0.7, 1.3) if default else generator.uniform(-0.1, 0.1)


def _vanishes(residual: list[float], jacobian: Rows, q: list[float]) -> bool:
    """Whether each g is zero relative to what its terms can be expected to be."""
    for value, row in zip(residual, jacobian, strict=True):
        size = sum(abs(a) * max(1.0, abs(b)) for a, b in zip(row, q, strict=True))
        if abs(value) > RESIDUAL * size:
            return False
    return True
