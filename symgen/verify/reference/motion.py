"""What a velocity adds to forces and accelerations: C(q, v) v and B_dot v along the line q + t v.

Everything is a polynomial in the time t here: places to second order give the accelerations of bodies, and the work of
the forces and torques that those take, on the Jacobians of the bodies, is their share of C v (the principle of virtual
power).  An energy that is written out gives d/dt dT/dqd - dT/dq, with T to first order in t or in the coordinates and
in the rates.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from flint import arb_mat

from symgen.model.expressions.expression import Number, Pi
from symgen.model.mechanism import Body, component
from symgen.model.model import Model
from symgen.verify.reference.arithmetic.tape import Register, Tape, replay_of
from symgen.verify.reference.arithmetic.taylor import CONSTANT, Monomial, Polynomial, Taylor
from symgen.verify.reference.mechanism.bodies import BodyJacobian, constants
from symgen.verify.reference.mechanism.frames import Frames
from symgen.verify.reference.mechanism.moved_bodies import MovedBodies
from symgen.verify.reference.translation import Moving, Translation, translation

# The number of the one coordinate of polynomials in t; its rate is 1.
TIME = 0
SECOND: Monomial = ((TIME, TIME), ())
SPEED: Monomial = ((), (TIME,))
CHANGE: Monomial = ((TIME,), (TIME,))


class DriftAlongRate:
    """One replay for C(q, v) v and B_dot(q, v) v, with q and v as the coordinates and rates of its inputs."""

    def __init__(self, model: Model, literals: Sequence[Number | Pi], tape: Tape) -> None:
        self._model, self._literals, self._tape = model, literals, tape
        self._n, self._r = model.n, model.r
        places = self._in_time(2, 0)
        self._frames = Frames(model.mechanism, places.algebra, places.polynomial)
        rows = [self._constraint_bias(index) for index in range(self._r)]
        written = self._written() if not _is_zero(model.kinetic_energy) else [tape.zero] * self._n
        plain = self._plain()
        wrenches = [x for body in model.mechanism.bodies for x in self._wrench(body, plain)]
        self._replay = replay_of(tape, [*rows, *written, *wrenches])
        given = 2 * self._n + len(model.parameters) + len(literals)
        self.bodies = MovedBodies(tape, self._velocities(), self._n, given)

    def along(
        self,
        q: Sequence[Any],
        velocity: Sequence[Any],
        parameters: Sequence[Any],
        literals: Sequence[Any],
        jacobian: Callable[[], BodyJacobian] | None,
    ) -> tuple[Any, Any]:
        """C v (n x 1) and B_dot v (r x 1); `jacobian` is that of the bodies at q, where it takes less."""
        inputs = [*q, *velocity, *parameters, *literals]
        values = self._replay.run(inputs)
        n, r = self._n, self._r
        force = arb_mat(n, 1, values[r : r + n])
        wrenches = values[r + n :]
        if wrenches:
            force += self.bodies.force(inputs, wrenches) if jacobian is None else jacobian().force(wrenches)
        return force, arb_mat(r, 1, values[:r])

    def _velocities(self) -> list[Register]:
        """Velocities of centres in world axes and turning rates in body axes, along the line."""
        zero = self._tape.zero
        return [
            x
            for body in self._model.mechanism.bodies
            for x in (
                *(place.get(((TIME,), ()), zero) for place in self._frames.center(body)),
                *(rate.get(SPEED, zero) for rate in self._frames.turning(body)),
            )
        ]

    def _constraint_bias(self, index: int) -> Register:
        row = self._model.constraints[index]
        if row.kind == "nonholonomic":
            return self._in_time(1, 1).polynomial(row.expression).get(CHANGE, self._tape.zero)
        g = self._in_time(2, 0).polynomial(row.expression)
        return self._tape.scaled(Fraction(2), g.get(SECOND, self._tape.zero))

    def _wrench(self, body: Body, plain: Translation) -> list[Register]:
        """Mass times the acceleration of the centre, and I w_dot + w x I w in body axes."""
        tape = self._tape
        mass, *inertia = constants(plain, [body.mass, *(entry for row in body.inertia.rows for entry in row)])
        accelerations = [
            tape.scaled(Fraction(2), place.get(SECOND, tape.zero)) for place in self._frames.center(body)
        ]
        turning = self._frames.turning(body)
        rate = [w.get(SPEED, tape.zero) for w in turning]
        change = [w.get(CHANGE, tape.zero) for w in turning]
        spin, asked = self._applied(inertia, rate), self._applied(inertia, change)
        torque = [
            tape.binary(
                "add",
                asked[i],
                tape.binary("sub", tape.binary("mul", rate[j], spin[k]), tape.binary("mul", rate[k], spin[j])),
            )
            for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        ]
        return [*(tape.binary("mul", mass, a) for a in accelerations), *torque]

    def _applied(self, inertia: Sequence[Register], vector: Sequence[Register]) -> list[Register]:
        tape = self._tape
        totals = []
        for row in (inertia[:3], inertia[3:6], inertia[6:]):
            total = tape.zero
            for entry, x in zip(row, vector, strict=True):
                total = tape.binary("add", total, tape.binary("mul", entry, x))
            totals.append(total)
        return totals

    def _written(self) -> list[Register]:
        """d/dt dT/dqd - dT/dq of the energy that is written out; rotors have a constant G."""
        tape, energy = self._tape, self._model.kinetic_energy
        along, across = self._with_rates(), self._with_coordinates()
        momentum, slope = along.polynomial(energy), across.polynomial(energy)
        return [
            tape.binary("sub", momentum.get(((TIME,), (j,)), tape.zero), slope.get(((j,), ()), tape.zero))
            for j in range(self._n)
        ]

    def _in_time(self, coordinates: int, rates: int) -> Translation:
        """Coordinates along q + t v, their rates v times that of t."""

        def moving(j: int) -> tuple[Polynomial, Polynomial]:
            speed = self._tape.input(self._n + j)
            return self._line(j), {SPEED: speed} if rates else {}

        return self._translation(Taylor(self._tape, coordinates, rates), moving, coordinates)

    def _with_rates(self) -> Translation:
        """Coordinates along q + t v, rates to first order about v."""

        def moving(j: int) -> tuple[Polynomial, Polynomial]:
            return self._line(j), {CONSTANT: self._tape.input(self._n + j), ((), (j,)): self._tape.one}

        return self._translation(Taylor(self._tape, 1, 1), moving, 1)

    def _with_coordinates(self) -> Translation:
        """Coordinates to first order about q, rates v."""

        def moving(j: int) -> tuple[Polynomial, Polynomial]:
            place: Polynomial = {CONSTANT: self._tape.input(j), ((j,), ()): self._tape.one}
            return place, {CONSTANT: self._tape.input(self._n + j)}

        return self._translation(Taylor(self._tape, 1, 0), moving, 1)

    def _plain(self) -> Translation:
        def moving(j: int) -> tuple[Polynomial, Polynomial]:
            return {CONSTANT: self._tape.input(j)}, {}

        return self._translation(Taylor(self._tape, 0, 0), moving, 0)

    def _line(self, j: int) -> Polynomial:
        return {CONSTANT: self._tape.input(j), ((TIME,), ()): self._tape.input(self._n + j)}

    def _translation(self, algebra: Taylor, moving: Moving, coordinates: int) -> Translation:
        return translation(
            self._model, self._literals, algebra, moving, lambda name: self._component(name, coordinates)
        )

    def _component(self, name: str, coordinates: int) -> Polynomial:
        """A component of a point or frame along the line, to this degree in t."""
        polynomial = self._frames.component(name)
        if component(name).is_rate:
            return polynomial
        return {monomial: register for monomial, register in polynomial.items() if len(monomial[0]) <= coordinates}


def _is_zero(expression: object) -> bool:
    return isinstance(expression, Number) and expression.value == 0
