"""The parsed model on one tape: energies, rows, inputs and forces as registers, by Taylor polynomials."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from symgen.model.expressions.expression import Expression
from symgen.model.mechanism import component
from symgen.model.model import Model
from symgen.verify.reference.arithmetic.adjoints import shorter_gradients
from symgen.verify.reference.arithmetic.tape import Register, Tape
from symgen.verify.reference.arithmetic.taylor import CONSTANT, Polynomial, Taylor
from symgen.verify.reference.mechanism.bodies import BodyRows, constants, weights_of
from symgen.verify.reference.mechanism.frames import Frames
from symgen.verify.reference.translation import Translation, literals_of, translation


class RecordedModel:
    """Registers of what the model says; inputs of the tape are q, the rates, the parameters and the literals."""

    def __init__(self, model: Model) -> None:
        self.model, self.literals = model, literals_of(model)
        self._n, self.tape = model.n, Tape()
        self._shared: dict[tuple[int, int], Translation] = {}
        places = self._translation(1, 0)
        self._frames = Frames(model.mechanism, places.algebra, places.polynomial)
        self.bodies = BodyRows(model.mechanism, self._frames, self._n, self.tape.zero)

    def written_mass(self) -> list[Register]:
        """d2T/dqd2 of the energy that is written out and of the rotors (n x n, row by row)."""
        energy = self._written_energy(self._translation(0, 2))
        return [self._rate_coefficient(energy, i, j) for i in range(self._n) for j in range(self._n)]

    def potential_slopes(self) -> list[Register]:
        """The gradient of U, by Taylor polynomials or backwards, what takes less."""
        potential, zero = self._potential_energy(1), self.tape.zero
        known = [potential.get(((k,), ()), zero) for k in range(self._n)]
        value = potential.get(CONSTANT, zero)
        gradients = shorter_gradients(self.tape, [value], [value, *known], self._n)
        return known if gradients is None else gradients[0]

    def weights(self) -> list[Register]:
        """Of each body its mass and the entries of its inertia."""
        return weights_of(self.model.mechanism, self._translation(0, 0))

    def gravity(self) -> list[Register]:
        """Its acceleration in world axes."""
        return constants(self._translation(0, 0), self.model.mechanism.gravity)

    def energies(self) -> list[Register]:
        """T and U."""
        plain = self._translation(0, 0)
        total = self._written_energy(plain)
        if self.model.mechanism.bodies:
            total = plain.algebra.add(total, self._frames.kinetic_energy(plain.algebra, self._settled_rate))
        return self._values([total, self._potential_energy(0)])

    def points(self) -> list[Register]:
        """Places (k x 3) and velocities per rate (3k x n) of the k points."""
        names = [point.name for point in self.model.mechanism.points]
        places = [x for name in names for x in self._frames.place(name)]
        rates = [x for name in names for x in self._frames.velocity(name)]
        return self._values([*places, *(_share(rate, j) for rate in rates for j in range(self._n))])

    def task(self) -> list[Register]:
        """The coordinates of the task, then their derivatives row by row."""
        zero, given = self.tape.zero, self._translation(1, 0)
        polynomials = [given.polynomial(x.expression) for x in self.model.task]
        slopes = [x.get(((j,), ()), zero) for x in polynomials for j in range(self._n)]
        return [*(x.get(CONSTANT, zero) for x in polynomials), *slopes]

    def applied(self) -> list[Register]:
        """Q_a: what is given by coordinates, and each force times the coefficients of the rate it works on."""
        plain = self._translation(0, 0)
        forces = {force.coordinate: force.expression for force in self.model.applied_forces}
        total = [plain.polynomial(forces[c.name]) if c.name in forces else {} for c in self.model.coordinates]
        for force in self.model.forces:
            magnitude = plain.polynomial(force.magnitude)
            shares = self._coefficients(force.velocity)
            total = [
                plain.algebra.add(x, plain.algebra.multiply(magnitude, share))
                for x, share in zip(total, shares, strict=True)
            ]
        return self._values(total)

    def control(self) -> list[Register]:
        """M, row by row."""
        plain, zero = self._translation(0, 0), self.tape.zero
        columns = [dict(control.acts_on) for control in self.model.inputs]
        worked_on = [self._coefficients(control.velocity) for control in self.model.inputs]
        entries = [
            worked[k] if worked else plain.polynomial(column[c.name]) if c.name in column else {}
            for k, c in enumerate(self.model.coordinates)
            for column, worked in zip(columns, worked_on, strict=True)
        ]
        return [entry.get(CONSTANT, zero) for entry in entries]

    def constraint_rows(self) -> list[tuple[list[Register], Register]]:
        """Rows of B with the residuals of the geometric ones, by Taylor polynomials or backwards, what takes less."""
        rows = [self._constraint_row(index) for index in range(self.model.r)]
        geometric = [one for one, row in zip(rows, self.model.constraints, strict=True) if row.kind == "geometric"]
        residuals = [residual for _, residual in geometric]
        known = [*residuals, *(entry for row, _ in geometric for entry in row)]
        gradients = shorter_gradients(self.tape, residuals, known, self._n)
        if gradients is None:
            return rows
        return [*zip(gradients, residuals, strict=True), *rows[len(geometric) :]]

    def _written_energy(self, given: Translation) -> Polynomial:
        """T as written out plus that of the rotors."""
        algebra = given.algebra
        total = given.polynomial(self.model.kinetic_energy)
        half: Polynomial = {CONSTANT: self.tape.constant(Fraction(1, 2))}
        for rotor in self.model.mechanism.rotor_inertias:
            rate = given.names[next(c.rate for c in self.model.coordinates if c.name == rotor.coordinate)]
            inertia = algebra.multiply(half, given.polynomial(rotor.inertia))
            total = algebra.add(total, algebra.multiply(inertia, algebra.multiply(rate, rate)))
        return total

    def _potential_energy(self, coordinates: int) -> Polynomial:
        """U as written out plus that of the bodies."""
        given = self._translation(coordinates, 0)
        weight = _truncated(self._frames.potential_energy(), coordinates)
        return given.algebra.add(given.polynomial(self.model.potential_energy), weight)

    def _coefficients(self, velocity: Expression | None) -> list[Polynomial]:
        """The coefficients of a rate by the rates of the coordinates."""
        if velocity is None:
            return []
        linear = self._translation(0, 1).polynomial(velocity)
        return [_share(linear, j) for j in range(self._n)]

    def _component(self, name: str, coordinates: int, rates: int) -> Polynomial:
        """A component of a point or frame, to these degrees."""
        polynomial = self._frames.component(name)
        if not component(name).is_rate:
            return _truncated(polynomial, coordinates)
        return polynomial if rates else self._settled_rate(polynomial)

    def _settled_rate(self, rate: Polynomial) -> Polynomial:
        """A rate with the rates of the coordinates at their values."""
        total = self.tape.zero
        for (_, moving), register in rate.items():
            value = self.tape.input(self._n + moving[0])
            total = self.tape.binary("add", total, self.tape.binary("mul", register, value))
        return {CONSTANT: total}

    def _values(self, polynomials: Sequence[Polynomial]) -> list[Register]:
        return [p.get(CONSTANT, self.tape.zero) for p in polynomials]

    def _rate_coefficient(self, energy: Polynomial, i: int, j: int) -> Register:
        """Register of d2T/dqd_i dqd_j."""
        register = energy.get(((), (min(i, j), max(i, j))), self.tape.zero)
        return self.tape.scaled(Fraction(2), register) if i == j else register

    def _constraint_row(self, index: int) -> tuple[list[Register], Register]:
        """Row of B, and the residual of a geometric row."""
        row = self.model.constraints[index]
        zero, n = self.tape.zero, self._n
        if row.kind == "nonholonomic":
            linear = self._translation(0, 1).polynomial(row.expression)
            return [linear.get(((), (j,)), zero) for j in range(n)], zero
        g = self._translation(1, 0).polynomial(row.expression)
        return [g.get(((j,), ()), zero) for j in range(n)], g.get(CONSTANT, zero)

    def _translation(self, coordinates: int, rates: int) -> Translation:
        """The shared translation for polynomials of these degrees; degree 0 in both takes the rates at their value."""
        key = (coordinates, rates)
        if key not in self._shared:
            tape, n = self.tape, self._n

            def moving(j: int) -> tuple[Polynomial, Polynomial]:
                place: Polynomial = {CONSTANT: tape.input(j)}
                if coordinates:
                    place[(j,), ()] = tape.one
                rate: Polynomial = {((), (j,)): tape.one} if rates else {CONSTANT: tape.input(n + j)}
                return place, {} if coordinates and not rates else rate

            self._shared[key] = translation(
                self.model,
                self.literals,
                Taylor(tape, coordinates, rates),
                moving,
                lambda name: self._component(name, coordinates, rates),
            )
        return self._shared[key]


def _share(rate: Polynomial, j: int) -> Polynomial:
    """The coefficient of the j-th rate."""
    return {(place, ()): register for (place, rates), register in rate.items() if rates == (j,)}


def _truncated(place: Polynomial, degree: int) -> Polynomial:
    """The polynomial up to a degree in the coordinates."""
    return {monomial: register for monomial, register in place.items() if len(monomial[0]) <= degree}
