"""One state of the reference: every intermediate that the quantities are made of, once.

Equation numbers are those of the paper as corrected in docs/paper.md.  Notation: N = I - B+B projects onto ker B,
P = I - N, v = N qd, Z = N (N G N + P)^-1 N = F (F'GF)^-1 F' for every basis F of ker B.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, wraps
from typing import Any, TypeAlias

from symgen.verify.reference.arithmetic.blocks import pseudoinverse_of_parts, right_pseudoinverse_of_parts
from symgen.verify.reference.arithmetic.linear import (
    column,
    columns_of,
    identity,
    rows_of,
    solve,
)
from symgen.verify.reference.configurations.manifold import ManifoldRanks
from symgen.verify.reference.configurations.parts import piece, placed
from symgen.verify.reference.inputs.driven import Driven
from symgen.verify.reference.system import Configuration, ReferenceSystem

Derivative: TypeAlias = Callable[["Evaluation", Any], Any]


def _once_a_velocity(derivative: Derivative) -> Derivative:
    """A derivative along a velocity, computed once for each; an evaluation keeps the few velocities it has."""

    @wraps(derivative)
    def known(evaluation: Evaluation, velocity: Any) -> Any:
        key = derivative.__name__, id(velocity)
        if key not in evaluation.derivatives:
            evaluation.derivatives[key] = velocity, derivative(evaluation, velocity)
        return evaluation.derivatives[key][1]

    return known


@dataclass
class Evaluation:
    """One state; every intermediate is computed once, when it is needed."""

    system: ReferenceSystem
    ranks: ManifoldRanks
    q: Sequence[Any]
    qd: Sequence[Any]
    qdd: Sequence[Any]
    u: Sequence[Any]
    parameters: Sequence[Any]
    literals: Sequence[Any]
    task: Sequence[Any] = ()
    derivatives: dict[tuple[str, int], tuple[Any, Any]] = field(default_factory=dict)

    @cached_property
    def at(self) -> Configuration:
        """What depends on q alone."""
        return self.system.configuration(self.q, self.parameters, self.literals)

    @cached_property
    def points(self) -> tuple[Any, Any]:
        """Places of the points and their velocities per rate."""
        return self.system.points(self.q, self.parameters, self.literals)

    def _at(self, velocity: Any) -> list[Any]:
        """The inputs of replays along a velocity."""
        return [*self.q, *velocity.entries(), *self.parameters, *self.literals]

    @_once_a_velocity
    def body_rates(self, velocity: Any) -> tuple[Any, ...]:
        """The rates of the Jacobians of the bodies of each part along a velocity."""
        return self.system.rates.bodies(self._at(velocity))

    @_once_a_velocity
    def written_mass_dot(self, velocity: Any) -> Any:
        """d/dt G of the energy that is written out, along a velocity."""
        return self.system.rates.written_mass(self._at(velocity))

    @_once_a_velocity
    def motion(self, velocity: Any) -> tuple[Any, Any]:
        """C v (n x 1) and B_dot v (r x 1) along a velocity v, without the matrices."""
        motion = self.system.motion
        if motion is None:
            return self.coriolis(velocity) * velocity, self.constraints_dot(velocity) * velocity
        jacobian = (lambda: self.at.jacobian) if self.system.has_jacobians_at_hand else None
        return motion.along(self.q, velocity.entries(), self.parameters, self.literals, jacobian)

    @cached_property
    def inverse(self) -> Any:
        """B+ (n x r)."""
        return right_pseudoinverse_of_parts(self.at.constraints, self.ranks.constraints, self.system.parts)

    @cached_property
    def projector_off(self) -> Any:
        """P = B+B."""
        inverse, constraints = self.inverse, self.at.constraints
        return placed(
            self.system.n,
            self.system.n,
            (
                (
                    part.coordinates,
                    part.coordinates,
                    piece(inverse, part.coordinates, part.rows) * piece(constraints, part.rows, part.coordinates),
                )
                for part in self.system.parts
            ),
        )

    @cached_property
    def projector(self) -> Any:
        """N_B (21)."""
        return identity(self.system.n) - self.projector_off

    @cached_property
    def rate(self) -> Any:
        """qd as given."""
        return column(self.qd)

    @cached_property
    def projected_rate(self) -> Any:
        """N qd."""
        return self.projector * self.rate

    @_once_a_velocity
    def coriolis(self, velocity: Any) -> Any:
        """Christoffel C (3) along a velocity."""
        turning = self.system.rates.written_turning(self._at(velocity))
        written = (self.written_mass_dot(velocity) + turning - turning.transpose()) / 2
        at = self.at
        if not at.weights.nrows():
            return written
        return written + at.jacobian.coriolis(self.body_rates(velocity), velocity, at.weights.entries())

    def mass_dot(self, velocity: Any) -> Any:
        """d/dt G along a velocity."""
        at, written = self.at, self.written_mass_dot(velocity)
        if not at.weights.nrows():
            return written
        return written + at.jacobian.mass_dot(self.body_rates(velocity), at.weights.entries())

    @_once_a_velocity
    def constraints_dot(self, velocity: Any) -> Any:
        """d/dt B along a velocity."""
        return self.system.rates.constraints(self._at(velocity))

    @_once_a_velocity
    def task_jacobian_dot(self, velocity: Any) -> Any:
        """The rates of the derivatives of the task along a velocity."""
        return self.system.rates.task(self._at(velocity))

    def control_dot(self, velocity: Any) -> Any:
        """d/dt M along a velocity."""
        return self.system.rates.control(self._at(velocity))

    @_once_a_velocity
    def projector_dot(self, velocity: Any) -> Any:
        """d/dt N_B along a velocity (Remark 9): -X - X', X = B+ Bdot N."""
        x = self.inverse * (self.constraints_dot(velocity) * self.projector)
        return -x - x.transpose()

    def applied(self, velocity: Any) -> Any:
        """Q_a at a velocity."""
        return self.system.applied(self.q, velocity.entries(), self.parameters, self.literals)

    @cached_property
    def rate_coriolis(self) -> Any:
        """C along qd as given."""
        return self.coriolis(self.rate)

    @cached_property
    def bias(self) -> Any:
        """C qd + Q - Q_a."""
        return self.motion(self.rate)[0] + self.at.potential_gradient - self.applied(self.rate)

    @cached_property
    def load(self) -> Any:
        """tau = G qdd + C qd + Q - Q_a."""
        motion, at, accelerations = self.system.motion, self.at, column(self.qdd)
        if motion is None or self.system.has_jacobians_at_hand:
            return at.mass_times(accelerations) + self.bias
        inputs = self._at(accelerations)
        momenta = motion.bodies.momenta(inputs, at.weights.entries())
        return at.written_mass * accelerations + motion.bodies.force(inputs, momenta) + self.bias

    @cached_property
    def weighted(self) -> Any:
        """Z (symmetric): N_BG = Z G."""
        pieces = []
        for part in self.system.heavy:
            mass, projector, off = (
                piece(matrix, part.coordinates, part.coordinates)
                for matrix in (self.at.mass, self.projector, self.projector_off)
            )
            inverse = projector * solve(projector * mass * projector + off, projector)
            pieces.append((part.coordinates, part.coordinates, inverse))
        return placed(self.system.n, self.system.n, pieces)

    @cached_property
    def projected_control(self) -> Any:
        """N_B M (21)."""
        pieces = []
        for part in self.system.parts:
            inverse = piece(self.inverse, part.coordinates, part.rows)
            rows = piece(self.at.constraints, part.rows, part.coordinates)
            control = piece(self.at.control, part.coordinates, part.inputs)
            pieces.append((part.coordinates, part.inputs, control - inverse * (rows * control)))
        return placed(self.system.n, self.system.m, pieces)

    @cached_property
    def driven(self) -> tuple[Driven, ...] | None:
        """Each part by its inputs, where all of these are independent and more than rows; None where they are not."""
        if self.ranks.actuation < self.system.m or self.ranks.constraints < self.system.r or not self.system.m:
            return None
        parts = self.system.parts
        # no fewer rows than inputs: the Gram matrix of M~ is no larger than that of B then
        if any(len(part.inputs) <= len(part.rows) for part in parts):
            return None
        return tuple(
            Driven(
                piece(self.at.constraints, part.rows, part.coordinates),
                piece(self.at.control, part.coordinates, part.inputs),
                blocks,
            )
            for part, blocks in zip(parts, self.system.input_blocks, strict=True)
        )

    @cached_property
    def inputs(self) -> Any:
        """u (27)."""
        if self.driven is None:
            return self.control_inverse * (self.projector * self.load)
        pairs = zip(self.system.parts, self.driven, strict=True)
        pieces = ((x.inputs, (0,), own.inputs(piece(self.load, x.coordinates, (0,)))) for x, own in pairs)
        return placed(self.system.m, 1, pieces)

    @cached_property
    def control_inverse(self) -> Any:
        """M~+ (27), (28), at the generic degree of actuation."""
        full = self.ranks.actuation == self.system.n - self.ranks.constraints < self.system.m
        if full:  # range(N M) = ker B: (M~ M~' + P) is regular
            pieces = []
            for part in self.system.parts:
                control = piece(self.projected_control, part.coordinates, part.inputs)
                off = piece(self.projector_off, part.coordinates, part.coordinates)
                inverse = solve(control * control.transpose() + off, control).transpose()
                pieces.append((part.inputs, part.coordinates, inverse))
            return placed(self.system.m, self.system.n, pieces)
        return pseudoinverse_of_parts(self.projected_control, self.ranks.actuation, self.system.parts)

    @cached_property
    def accelerations(self) -> Any:
        """qdd of the KKT system: a - Z (G a - f), a = -B+ Bdot qd, f = M u - C qd - Q + Q_a."""
        particular = -(self.inverse * self.motion(self.rate)[1])
        return particular - self.weighted * (self.at.mass * particular - self.force)

    @cached_property
    def force(self) -> Any:
        """M u - C qd - Q + Q_a."""
        return self.at.control * column(self.u) - self.bias

    @cached_property
    def independent(self) -> list[int]:
        """Positions of the independent velocities."""
        names = [coordinate.name for coordinate in self.system.model.coordinates]
        return [names.index(name) for name in self.system.model.independent_velocities]

    @cached_property
    def complement(self) -> Any:
        """F (8): the basis of ker B with the identity in the rows of the independent velocities."""
        basis = columns_of(self.projector, self.independent)
        return solve(rows_of(basis, self.independent).transpose(), basis.transpose()).transpose()

    @cached_property
    def complement_dot(self) -> Any:
        """d/dt F along qd as given, from d/dt (B F) = 0 and the constant rows."""
        x = self.inverse * (self.constraints_dot(self.rate) * self.complement)
        return self.complement * rows_of(x, self.independent) - x

    @cached_property
    def quasi(self) -> Any:
        """W = (M~+)' (Remark 10), for m = delta."""
        return self.control_inverse.transpose()

    @cached_property
    def quasi_velocity(self) -> Any:
        """v = W nu, nu = M' qd."""
        return self.quasi * (self.at.control.transpose() * self.rate)

    def quasi_dot(self, velocity: Any) -> Any:
        """d/dt W along a velocity: W = N M S^-1, S = M' N M."""
        control, projector = self.at.control, self.projector
        control_dot, projector_dot = self.control_dot(velocity), self.projector_dot(velocity)
        mixed = control_dot.transpose() * self.projected_control
        gram = control.transpose() * self.projected_control
        gram_dot = mixed + mixed.transpose() + control.transpose() * (projector_dot * control)
        top = projector_dot * control + projector * control_dot - self.quasi * gram_dot
        return solve(gram, top.transpose()).transpose()
