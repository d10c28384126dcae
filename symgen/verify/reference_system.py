"""From the parsed model to numbers: what the energies, constraints, inputs and forces say about one state.

Four replays of one tape: the configuration (G, B, M and their gradients, g, U and its gradient), the constraint
residual alone (for Newton's method), the energies, and the applied forces.  Inputs of a replay are the coordinates,
the rates, the parameters and the literals of the model, in this order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias

from flint import arb_mat

from symgen.model.expression import Expression
from symgen.model.mechanism import component
from symgen.model.model import Model
from symgen.verify.reference_frames import Frames
from symgen.verify.reference_tape import Register, Replay, Tape, ball, replay_of
from symgen.verify.reference_taylor import CONSTANT, Polynomial, Taylor
from symgen.verify.reference_translation import Translation, literals_of


def default_parameters(model: Model) -> list[Any]:
    """Default values of the parameters, as balls of the working precision."""
    return parameters_from(model, {})


def parameters_from(model: Model, chosen: dict[str, Any]) -> list[Any]:
    """Parameter values: the `chosen` ones, and the others from their expressions of earlier parameters."""
    tape = Tape()
    algebra = Taylor(tape, 0, 0)
    names: dict[str, Polynomial] = {}
    given: list[Any] = []
    translation = Translation(algebra, names, {}, {})
    for parameter in model.parameters:
        if parameter.name in chosen:
            given.append(ball(chosen[parameter.name]))
            names[parameter.name] = {CONSTANT: tape.input(len(given) - 1)}
        else:
            names[parameter.name] = translation.polynomial(parameter.value)
    registers = [names[parameter.name].get(CONSTANT, tape.zero) for parameter in model.parameters]
    return list(replay_of(tape, registers).run(given))


@dataclass(frozen=True)
class Configuration:
    """Everything that depends on q and parameters alone."""

    mass: Any  # n x n
    constraints: Any  # r x n
    residual: Any  # r_g x 1
    control: Any  # n x m
    potential_gradient: Any  # n x 1
    gradients: tuple[Any, ...]  # the entries of dG/dq, dB/dq, dM/dq that do not vanish identically


class System:
    """The model as replays."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.literals = literals_of(model)
        n, m, r = model.n, model.m, model.r
        self.n, self.m, self.r = n, m, r
        self.r_geometric = sum(row.kind == "geometric" for row in model.constraints)
        self._tape = Tape()
        self._shared: dict[tuple[int, int], Translation] = {}
        places = self._translation(2, 0)
        self.frames = Frames(model.mechanism, places.algebra, places.polynomial)
        energy = self._kinetic_energy(1, 2)
        potential = self._potential_energy(1, 0)
        rows = [self._constraint_row(index) for index in range(r)]
        columns = [dict(control.acts_on) for control in model.inputs]
        worked_on = [self._coefficients(control.velocity) for control in model.inputs]
        control = [
            worked[k] if worked else self._translation(1, 0).polynomial(column[c.name]) if c.name in column else {}
            for k, c in enumerate(model.coordinates)
            for column, worked in zip(columns, worked_on, strict=True)
        ]
        zero = self._tape.zero
        gradients: list[Register] = []
        self._directional: dict[str, Replay] = {}
        mass_gradient = {
            (i, j, k): self._rate_coefficient(energy, i, j, k) for i in range(n) for j in range(n) for k in range(n)
        }
        positions = _collect(mass_gradient, gradients, zero)
        directional = {"mass": _derivative(positions, n, n, n), "coriolis": _christoffel(positions, n)}
        positions = _collect(
            {(i, j, k): rows[i][1][j][k] for i in range(r) for j in range(n) for k in range(n)}, gradients, zero
        )
        directional["constraints"] = _derivative(positions, r, n, n)
        positions = _collect(
            {(i, j, k): control[i * m + j].get(((k,), ()), zero) for i in range(n) for j in range(m) for k in range(n)},
            gradients,
            zero,
        )
        directional["control"] = _derivative(positions, n, m, n)
        self._directional = {name: _bilinear(terms, n) for name, terms in directional.items()}
        outputs = [
            [self._rate_coefficient(energy, i, j, None) for i in range(n) for j in range(n)],
            [row[0][j] for row in rows for j in range(n)],
            [row[2] for row in rows[: self.r_geometric]],
            [entry.get(CONSTANT, zero) for entry in control],
            [potential.get(((k,), ()), zero) for k in range(n)],
        ]
        self._shapes = ((n, n), (r, n), (self.r_geometric, 1), (n, m), (n, 1))
        self._configuration = replay_of(self._tape, [*(x for block in outputs for x in block), *gradients])
        self._geometry = replay_of(self._tape, [*outputs[2], *outputs[1][: self.r_geometric * n]])
        self._energies = self._plain([self._kinetic_energy(0, 0), self._potential_energy(0, 0)])
        self._points: Replay | None = None
        self._applied: Replay | None = None
        if model.applied_forces or model.forces:
            self._applied = self._plain(self._applied_force())

    def configuration(self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> Configuration:
        """Evaluate at q."""
        values = self._configuration.run([*q, *([None] * self.n), *parameters, *literals])
        matrices = []
        start = 0
        for rows, columns in self._shapes:
            end = start + rows * columns
            matrices.append(arb_mat(rows, columns, values[start:end]))
            start = end
        mass, constraints, residual, control, potential = matrices
        return Configuration(mass, constraints, residual, control, potential, values[start:])

    def along(self, what: str, at: Configuration, velocity: Any) -> tuple[Any, ...]:
        """Row-major entries of d/dt of `mass`, `constraints` or `control` along a velocity, or of `coriolis` (3)."""
        return self._directional[what].run([*velocity.entries(), *at.gradients])

    def geometry(self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> tuple[Any, Any]:
        """g (r_g x 1) and dg/dq (r_g x n) at q."""
        values = self._geometry.run([*q, *([None] * self.n), *parameters, *literals])
        r = self.r_geometric
        return arb_mat(r, 1, values[:r]), arb_mat(r, self.n, values[r:])

    def energies(
        self, q: Sequence[Any], qd: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]
    ) -> tuple[Any, ...]:
        """T and U."""
        return self._energies.run([*q, *qd, *parameters, *literals])

    def applied(self, q: Sequence[Any], qd: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> Any:
        """Q_a (n x 1)."""
        if self._applied is None:
            return arb_mat(self.n, 1)
        return arb_mat(self.n, 1, self._applied.run([*q, *qd, *parameters, *literals]))

    def points(self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> tuple[Any, Any]:
        """Places (k x 3) and velocities per rate (3k x n) of the k points, in world axes."""
        if self._points is None:
            names = [point.name for point in self.model.mechanism.points]
            places = [_truncated(x, 0) for name in names for x in self.frames.place(name)]
            rates = [x for name in names for x in self.frames.velocity(name)]
            shares = [self._share(rate, j) for rate in rates for j in range(self.n)]
            self._points = self._plain([*places, *shares])
        values = self._points.run([*q, *([None] * self.n), *parameters, *literals])
        k = len(self.model.mechanism.points)
        return arb_mat(k, 3, values[: 3 * k]), arb_mat(3 * k, self.n, values[3 * k :])

    @property
    def operations(self) -> int:
        """Number of recorded operations, for estimates of cost."""
        return len(self._tape.records)

    def _kinetic_energy(self, coordinates: int, rates: int) -> Polynomial:
        """T as written out plus that of the bodies and rotors."""
        translation, mechanism = self._translation(coordinates, rates), self.model.mechanism
        algebra = translation.algebra
        total = translation.polynomial(self.model.kinetic_energy)
        if mechanism.bodies:
            settled = self._settled_rate if not rates else _unchanged
            total = algebra.add(total, self.frames.kinetic_energy(algebra, settled))
        half: Polynomial = {CONSTANT: self._tape.constant(Fraction(1, 2))}
        for rotor in mechanism.rotor_inertias:
            rate = translation.names[next(c.rate for c in self.model.coordinates if c.name == rotor.coordinate)]
            inertia = algebra.multiply(half, translation.polynomial(rotor.inertia))
            total = algebra.add(total, algebra.multiply(inertia, algebra.multiply(rate, rate)))
        return total

    def _potential_energy(self, coordinates: int, rates: int) -> Polynomial:
        """U as written out plus that of the bodies."""
        translation = self._translation(coordinates, rates)
        weight = _truncated(self.frames.potential_energy(), coordinates)
        return translation.algebra.add(translation.polynomial(self.model.potential_energy), weight)

    def _applied_force(self) -> list[Polynomial]:
        """Q_a: what is given by coordinates, and each force times the coefficients of the rate it works on."""
        plain = self._translation(0, 0)
        forces = {force.coordinate: force.expression for force in self.model.applied_forces}
        total = [plain.polynomial(forces[c.name]) if c.name in forces else {} for c in self.model.coordinates]
        for force in self.model.forces:
            magnitude = plain.polynomial(force.magnitude)
            shares = [_truncated(share, 0) for share in self._coefficients(force.velocity)]
            total = [
                plain.algebra.add(x, plain.algebra.multiply(magnitude, share))
                for x, share in zip(total, shares, strict=True)
            ]
        return total

    def _coefficients(self, velocity: Expression | None) -> list[Polynomial]:
        """The coefficients of a rate by the rates of the coordinates, to degree 1 in the coordinates."""
        if velocity is None:
            return []
        linear = self._translation(1, 1).polynomial(velocity)
        return [self._share(linear, j) for j in range(self.n)]

    def _share(self, rate: Polynomial, j: int) -> Polynomial:
        """The coefficient of the j-th rate."""
        return {(place, ()): register for (place, rates), register in rate.items() if rates == (j,)}

    def _component(self, name: str, coordinates: int, rates: int) -> Polynomial:
        """A component of a point or frame, to these degrees."""
        found = self.frames.component(name)
        if not component(name).is_rate:
            return _truncated(found, coordinates)
        return found if rates else self._settled_rate(found)

    def _settled_rate(self, rate: Polynomial) -> Polynomial:
        """A rate with the rates of the coordinates at their values."""
        total = self._tape.zero
        for (place, moving), register in rate.items():
            if not place:
                value = self._tape.input(self.n + moving[0])
                total = self._tape.binary("add", total, self._tape.binary("mul", register, value))
        return {CONSTANT: total}

    def _plain(self, polynomials: Sequence[Polynomial]) -> Replay:
        return replay_of(self._tape, [p.get(CONSTANT, self._tape.zero) for p in polynomials])

    def _rate_coefficient(self, energy: Polynomial, i: int, j: int, k: int | None) -> Register:
        """Register of d2T/dqd_i dqd_j, or of its derivative along q_k."""
        monomial = (() if k is None else (k,), (min(i, j), max(i, j)))
        register = energy.get(monomial, self._tape.zero)
        return self._tape.scaled(Fraction(2), register) if i == j else register

    def _constraint_row(self, index: int) -> tuple[list[Register], list[list[Register]], Register]:
        """Row of B, its gradient, and the residual of a geometric row."""
        row = self.model.constraints[index]
        zero, n = self._tape.zero, self.n
        if row.kind == "nonholonomic":
            linear = self._translation(1, 1).polynomial(row.expression)
            entries = [linear.get(((), (j,)), zero) for j in range(n)]
            gradient = [[linear.get(((k,), (j,)), zero) for k in range(n)] for j in range(n)]
            return entries, gradient, zero
        g = self._translation(2, 0).polynomial(row.expression)
        entries = [g.get(((j,), ()), zero) for j in range(n)]
        gradient = [
            [
                self._tape.scaled(Fraction(2), g.get(((j, j), ()), zero))
                if j == k
                else g.get(((min(j, k), max(j, k)), ()), zero)
                for k in range(n)
            ]
            for j in range(n)
        ]
        return entries, gradient, g.get(CONSTANT, zero)

    def _translation(self, coordinates: int, rates: int) -> Translation:
        """The shared translation for polynomials of these degrees; degree 0 in both takes the rates at their value."""
        key = (coordinates, rates)
        if key not in self._shared:
            self._shared[key] = self._new_translation(coordinates, rates)
        return self._shared[key]

    def _new_translation(self, coordinates: int, rates: int) -> Translation:
        tape, n = self._tape, self.n
        names: dict[str, Polynomial] = {}
        for j, coordinate in enumerate(self.model.coordinates):
            names[coordinate.name] = {CONSTANT: tape.input(j)}
            if coordinates:
                names[coordinate.name][(j,), ()] = tape.one
            if rates:
                names[coordinate.rate] = {((), (j,)): tape.one}
            elif not coordinates:
                names[coordinate.rate] = {CONSTANT: tape.input(n + j)}
        for j, parameter in enumerate(self.model.parameters):
            names[parameter.name] = {CONSTANT: tape.input(2 * n + j)}
        first = 2 * n + len(self.model.parameters)
        literals = {id(literal): tape.input(first + j) for j, literal in enumerate(self.literals)}
        definitions = {definition.name: definition.value for definition in self.model.definitions}
        return Translation(
            Taylor(tape, coordinates, rates),
            names,
            definitions,
            literals,
            lambda name: self._component(name, coordinates, rates),
        )


def _unchanged(rate: Polynomial) -> Polynomial:
    return rate


def _truncated(place: Polynomial, degree: int) -> Polynomial:
    """The polynomial up to a degree in the coordinates."""
    return {monomial: register for monomial, register in place.items() if len(monomial[0]) <= degree}


Position: TypeAlias = tuple[int, int, int]
Terms: TypeAlias = list[list[tuple[Fraction, int, int]]]


def _collect(entries: dict[Position, Register], gradients: list[Register], zero: Register) -> dict[Position, int]:
    """Append the entries that are not zero to `gradients`; where each of them went."""
    positions: dict[Position, int] = {}
    for place, register in entries.items():
        if register != zero:
            positions[place] = len(gradients)
            gradients.append(register)
    return positions


def _derivative(positions: dict[Position, int], rows: int, columns: int, n: int) -> Terms:
    """sum_k d_k X_ij v_k for every entry of a matrix: factor, position of the gradient, k."""
    return [
        [(Fraction(1), positions[i, j, k], k) for k in range(n) if (i, j, k) in positions]
        for i in range(rows)
        for j in range(columns)
    ]


def _christoffel(positions: dict[Position, int], n: int) -> Terms:
    """C_ij = sum_k (d_k G_ij + d_j G_ik - d_i G_jk)/2 v_k."""
    half = Fraction(1, 2)
    return [
        [
            (factor, positions[place], k)
            for k in range(n)
            for factor, place in ((half, (i, j, k)), (half, (i, k, j)), (-half, (j, k, i)))
            if place in positions
        ]
        for i in range(n)
        for j in range(n)
    ]


def _bilinear(terms: Terms, n: int) -> Replay:
    """The sums as a replay of the velocity (n numbers) and the gradients."""
    tape = Tape()
    outputs = []
    for entry in terms:
        total = tape.zero
        for factor, gradient, k in entry:
            product = tape.binary("mul", tape.input(n + gradient), tape.input(k))
            total = tape.binary("add", total, tape.scaled(factor, product))
        outputs.append(total)
    return replay_of(tape, outputs)
