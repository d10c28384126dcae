"""The equations of motion of what was read: G, the other forces, B and what its change adds, M, all as nodes."""

from __future__ import annotations

from dataclasses import dataclass

from symgen.laboratory.zoo.witness.numbers.tape import Node
from symgen.laboratory.zoo.witness.reading.frames import Vector, cross, dot, transposed, turned
from symgen.laboratory.zoo.witness.reading.reader import SystemReader


@dataclass(frozen=True)
class Equations:
    """G q'' + bias + B^T lambda = M u,  B q'' = -drift; bias = C q' + Q - Q_a.  Matrices as rows."""

    mass: tuple[tuple[Node, ...], ...]
    bias: tuple[Node, ...]
    rows: tuple[tuple[Node, ...], ...]
    drift: tuple[Node, ...]
    residual: tuple[Node, ...]
    control: tuple[tuple[Node, ...], ...]

    @property
    def flat(self) -> tuple[Node, ...]:
        """All entries in a row."""
        matrices = (self.mass, self.rows, self.control)
        return (
            *(entry for matrix in matrices for row in matrix for entry in row),
            *self.bias,
            *self.drift,
            *self.residual,
        )


def equations(system: SystemReader) -> Equations:
    """Lagrange's equations for energies that are written out, Newton's and Euler's, projected, for bodies."""
    tape, names, rates = system.tape, system.coordinates, system.rate_names
    n = len(names)
    kinetic = system.kinetic_energy
    momenta = tape.gradient(kinetic, rates)
    mass = [tape.gradient(momentum, rates) for momentum in momenta]
    bias = [
        system.rate(momentum) - force for momentum, force in zip(momenta, tape.gradient(kinetic, names), strict=True)
    ]
    for body in system.bodies:
        pose = system.frames.pose(body.frame)
        axes = transposed(pose.axes)
        spin = turned(axes, pose.turning)
        velocity = system.frames.rates(body.centre)
        moves = [_partial(system, velocity, rate) for rate in rates]
        turns = [_partial(system, spin, rate) for rate in rates]
        push = system.frames.rates(velocity)
        momentum_of_spin = turned(body.tensor, spin)
        twist = _sum(turned(body.tensor, system.frames.rates(spin)), cross(spin, momentum_of_spin))
        spun = [turned(body.tensor, turn) for turn in turns]
        for i in range(n):
            bias[i] = bias[i] + body.mass * dot(moves[i], push) + dot(turns[i], twist)
            for j in range(n):
                mass[i][j] = mass[i][j] + body.mass * dot(moves[i], moves[j]) + dot(turns[i], spun[j])
    potential = tape.gradient(system.potential_energy, names)
    bias = [force + more for force, more in zip(bias, potential, strict=True)]
    for magnitude, rate in system.applied:
        bias = [force - magnitude * part for force, part in zip(bias, tape.gradient(rate, rates), strict=True)]
    drift = [system.rate(system.rate(row.value) if row.geometric else row.value) for row in system.rows]
    columns = [tape.gradient(system.power(entry), rates) for entry in (system.blocks.get("inputs") or {}).values()]
    return Equations(
        mass=tuple(map(tuple, mass)),
        bias=tuple(bias),
        rows=constraint_jacobian(system),
        drift=tuple(drift),
        residual=tuple(row.value for row in system.rows if row.geometric),
        control=tuple(tuple(column[i] for column in columns) for i in range(n)),
    )


def constraint_jacobian(system: SystemReader) -> tuple[tuple[Node, ...], ...]:
    """The rows of the constraints, alone."""
    tape, names, rates = system.tape, system.coordinates, system.rate_names
    return tuple(tuple(tape.gradient(row.value, names if row.geometric else rates)) for row in system.rows)


def _partial(system: SystemReader, vector: Vector, rate: str) -> Vector:
    """The derivative of a velocity with respect to one rate."""
    tape = system.tape
    x, y, z = (tape.derivative(part, {rate: tape.one}, f"by {rate}") for part in vector)
    return x, y, z


def _sum(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]
