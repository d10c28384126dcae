"""The rates of matrices along a velocity v: B, M, G and the Jacobians of bodies on the line q + t v, to first order.

Polynomials in t beside one coordinate each take n times fewer terms than gradients by all coordinates.  C (3) is half
of G_dot and of how p = G v turns: C_ij = (G_dot_ij + d_j p_i - d_i p_j)/2, v being held.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

from flint import arb_mat

from symgen.model.expressions.expression import Expression, Number, Pi
from symgen.model.mechanism import component
from symgen.model.model import Model
from symgen.verify.reference.arithmetic.tape import Register, Replay, Tape, replay_of
from symgen.verify.reference.arithmetic.taylor import CONSTANT, Polynomial, Taylor
from symgen.verify.reference.configurations.parts import Part
from symgen.verify.reference.mechanism.bodies import BodyRows
from symgen.verify.reference.mechanism.frames import Frames
from symgen.verify.reference.translation import Moving, Translation, translation


class MatrixRates:
    """One replay for each matrix, made once it is needed; inputs are q, v, the parameters and the literals."""

    def __init__(self, model: Model, literals: Sequence[Number | Pi], heavy: Sequence[Part]) -> None:
        self._model, self._literals, self._heavy = model, literals, heavy
        self._n, self._tape = model.n, Tape()
        self._time = model.n  # the index of t among the coordinates
        self._places = self._translation(Taylor(self._tape, 2, 0, along=self._time), self._beside_line)
        self._frames = Frames(model.mechanism, self._places.algebra, self._places.polynomial)

    def constraints(self, inputs: Sequence[Any]) -> Any:
        """B_dot (r x n)."""
        return arb_mat(self._model.r, self._n, self._constraints.run(inputs))

    def control(self, inputs: Sequence[Any]) -> Any:
        """M_dot (n x m)."""
        return arb_mat(self._n, self._model.m, self._control.run(inputs))

    def task(self, inputs: Sequence[Any]) -> Any:
        """The rates of the derivatives of the task (k x n)."""
        return arb_mat(len(self._model.task), self._n, self._task.run(inputs))

    def written_mass(self, inputs: Sequence[Any]) -> Any:
        """G_dot (n x n) of the energy that is written out."""
        return arb_mat(self._n, self._n, self._written_mass.run(inputs))

    def written_turning(self, inputs: Sequence[Any]) -> Any:
        """d_j p_i (n x n) of the energy that is written out, p = dT/dqd at the velocity."""
        return arb_mat(self._n, self._n, self._written_turning.run(inputs))

    def bodies(self, inputs: Sequence[Any]) -> tuple[Any, ...]:
        """The rates of the Jacobians of the bodies of each part, 6 rows a body."""
        return self._bodies.split(self._heavy, self._body_rates.run(inputs))

    def operations(self, what: str) -> int:
        """Number of operations of the rate of `mass`, `constraints` or `control`, for estimates of cost."""
        replays = {
            "mass": (self._written_mass, self._written_turning, self._body_rates),
            "constraints": (self._constraints,),
            "control": (self._control,),
        }
        return sum(replay.operations for replay in replays[what])

    @cached_property
    def _constraints(self) -> Replay:
        entries: list[Register] = []
        for row in self._model.constraints:
            if row.kind == "nonholonomic":
                entries += self._coefficient_rates(row.expression)
            else:
                entries += self._gradient_rates(row.expression)
        return replay_of(self._tape, entries)

    @cached_property
    def _task(self) -> Replay:
        return replay_of(self._tape, [x for one in self._model.task for x in self._gradient_rates(one.expression)])

    def _gradient_rates(self, function: Expression) -> list[Register]:
        """Of second degree in t and one coordinate, each twice along the line."""
        polynomial = self._places.polynomial(function)
        return [polynomial.get(((j, self._time), ()), self._tape.zero) for j in range(self._n)]

    @cached_property
    def _control(self) -> Replay:
        n, zero = self._n, self._tape.zero
        columns = []
        for control in self._model.inputs:
            if control.velocity is not None:
                columns.append(self._coefficient_rates(control.velocity))
            else:
                given = {name: self._rates(1).polynomial(entry) for name, entry in control.acts_on}
                changes = (given.get(c.name, {}) for c in self._model.coordinates)
                columns.append([change.get(((self._time,), ()), zero) for change in changes])
        return replay_of(self._tape, [column[k] for k in range(n) for column in columns])

    @cached_property
    def _written_mass(self) -> Replay:
        tape, n = self._tape, self._n
        energy = self._rates(2).polynomial(self._model.kinetic_energy)

        def entry(i: int, j: int) -> Register:
            coefficient = energy.get(((self._time,), (min(i, j), max(i, j))), tape.zero)
            return tape.binary("add", coefficient, coefficient) if i == j else coefficient

        return replay_of(tape, [entry(i, j) for i in range(n) for j in range(n)])

    @cached_property
    def _written_turning(self) -> Replay:
        """From T to first order in the coordinates and in the rates, about v."""
        tape, n = self._tape, self._n

        def moving(j: int) -> tuple[Polynomial, Polynomial]:
            return self._beside(j), {CONSTANT: tape.input(n + j), ((), (j,)): tape.one}

        places = self._translation(Taylor(tape, 2, 0), lambda j: (self._beside(j), {}))
        frames = Frames(self._model.mechanism, places.algebra, places.polynomial)
        algebra = Taylor(tape, 1, 1)

        def polynomial_of(name: str) -> Polynomial:
            value = frames.component(name)
            return self._about_velocity(value) if component(name).is_rate else _to_first_order(value)

        energy = translation(self._model, self._literals, algebra, moving, polynomial_of).polynomial(
            self._model.kinetic_energy
        )
        return replay_of(tape, [energy.get(((j,), (i,)), tape.zero) for i in range(n) for j in range(n)])

    @cached_property
    def _bodies(self) -> BodyRows:
        return BodyRows(self._model.mechanism, self._frames, self._n, self._tape.zero, (self._time,))

    @cached_property
    def _body_rates(self) -> Replay:
        return replay_of(self._tape, self._bodies.needed(self._heavy))

    def _coefficient_rates(self, velocity: Expression) -> list[Register]:
        """The rates of the coefficients of a velocity by the rates of the coordinates."""
        linear = self._rates(1).polynomial(velocity)
        return [linear.get(((self._time,), (j,)), self._tape.zero) for j in range(self._n)]

    def _rates(self, degree: int) -> Translation:
        """Coordinates on the line, rates to a degree about zero."""

        def moving(j: int) -> tuple[Polynomial, Polynomial]:
            return self._on_line(j), {((), (j,)): self._tape.one}

        return self._translation(Taylor(self._tape, 1, degree, along=self._time), moving)

    def _beside(self, j: int) -> Polynomial:
        return {CONSTANT: self._tape.input(j), ((j,), ()): self._tape.one}

    def _on_line(self, j: int) -> Polynomial:
        return {CONSTANT: self._tape.input(j), ((self._time,), ()): self._tape.input(self._n + j)}

    def _beside_line(self, j: int) -> tuple[Polynomial, Polynomial]:
        return self._beside(j) | self._on_line(j), {}

    def _translation(self, algebra: Taylor, moving: Moving) -> Translation:
        def polynomial_of(name: str) -> Polynomial:
            value = self._frames.component(name)
            return {monomial: register for monomial, register in value.items() if algebra.keeps(*monomial)}

        return translation(self._model, self._literals, algebra, moving, polynomial_of)

    def _about_velocity(self, rate: Polynomial) -> Polynomial:
        """A rate that is linear in those of the coordinates, about their values v."""
        tape = self._tape
        polynomial = dict(rate)
        for (place, moving), register in rate.items():
            product = tape.binary("mul", register, tape.input(self._n + moving[0]))
            known = polynomial.get((place, ()))
            polynomial[place, ()] = product if known is None else tape.binary("add", known, product)
        return polynomial


def _to_first_order(place: Polynomial) -> Polynomial:
    return {monomial: register for monomial, register in place.items() if len(monomial[0]) <= 1}
