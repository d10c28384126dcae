"""From the parsed model to numbers: what the energies, constraints, inputs and forces say about one state.

Replays of one tape: the configuration (G, B, M, g and the gradient of U), the constraint residual alone (for Newton's
method), what a velocity adds (`reference_motion`), the energies, points and the applied forces.  Inputs of a replay
are the coordinates, the rates, the parameters and the literals of the model, in this order.  Bodies enter G by the
Jacobians of their centres and turning rates, so that nothing here grows faster than with the square of a chain's
length.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from flint import arb_mat

from symgen.model.model import Model
from symgen.verify.reference.arithmetic.tape import Register, Replay, replay_of
from symgen.verify.reference.configurations.parts import parts, touched
from symgen.verify.reference.inputs.driven import blocks_of_inputs
from symgen.verify.reference.matrix_rates import MatrixRates
from symgen.verify.reference.mechanism.bodies import BodyJacobian
from symgen.verify.reference.motion import DriftAlongRate
from symgen.verify.reference.recorded_model import RecordedModel
from symgen.verify.reference.translation import uses_components


@dataclass(frozen=True)
class Configuration:
    """Everything that depends on q and parameters alone; G only where it is asked for, which no search does."""

    written_mass: Any  # n x n, of the energy that is written out
    constraints: Any  # r x n
    residual: Any  # r_g x 1
    control: Any  # n x m
    potential_gradient: Any  # n x 1
    weights: Any  # 10 a body x 1: its mass and the entries of its inertia
    bodies: Callable[[], BodyJacobian]

    @cached_property
    def jacobian(self) -> BodyJacobian:
        """That of the bodies."""
        return self.bodies()

    @cached_property
    def mass(self) -> Any:
        """G (n x n)."""
        if not self.weights.nrows():
            return self.written_mass
        return self.written_mass + self.jacobian.mass(self.weights.entries())

    def mass_times(self, vector: Any) -> Any:
        """G times a column, through the bodies: G itself of a long chain takes many times as much."""
        if not self.weights.nrows():
            return self.written_mass * vector
        return self.written_mass * vector + self.jacobian.mass_times(vector, self.weights.entries())


class _Matrix:
    """Where the entries of a matrix stand that are not always 0: of a long chain most of them are."""

    def __init__(self, rows: int, columns: int, entries: Sequence[Register], zero: Register) -> None:
        self._rows, self._columns = rows, columns
        filled = [place for place, register in enumerate(entries) if register != zero]
        self.registers = [entries[place] for place in filled]
        self._places = [divmod(place, columns) for place in filled]

    def of(self, values: Sequence[Any]) -> Any:
        """The matrix with these entries."""
        made = arb_mat(self._rows, self._columns)
        for place, value in zip(self._places, values, strict=True):
            made[place] = value
        return made


class ReferenceSystem:
    """The model as replays."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._recorded = recorded = RecordedModel(model)
        self.literals, self._tape, self._bodies = recorded.literals, recorded.tape, recorded.bodies
        n, m, r = model.n, model.m, model.r
        self.n, self.m, self.r = n, m, r
        self.r_geometric = sum(row.kind == "geometric" for row in model.constraints)
        mass, slopes, rows = recorded.written_mass(), recorded.potential_slopes(), recorded.constraint_rows()
        blocks = [
            mass,
            [entry for row, _ in rows for entry in row],
            [residual for _, residual in rows[: self.r_geometric]],
            recorded.control(),
            slopes,
            recorded.weights(),
        ]
        shapes = ((n, n), (r, n), (self.r_geometric, 1), (n, m), (n, 1), (len(blocks[5]), 1))
        self._matrices = [_Matrix(*shape, block, self._tape.zero) for shape, block in zip(shapes, blocks, strict=True)]
        self._written_mass, self._weights = blocks[0], blocks[5]
        self._set_parts(blocks)
        self._at_configuration = [x for matrix in self._matrices for x in matrix.registers]
        self._jacobian = replay_of(self._tape, self._bodies.needed(self.heavy))
        self.geometry_replay = replay_of(self._tape, [*blocks[2], *blocks[1][: self.r_geometric * n]])
        self.matrices_replay = replay_of(self._tape, [*blocks[1], *blocks[3]])

    def configuration(self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> Configuration:
        """Evaluate at q."""
        values = self._configuration.run([*q, *([None] * self.n), *parameters, *literals])
        matrices = []
        start = 0
        for matrix in self._matrices:
            end = start + len(matrix.registers)
            matrices.append(matrix.of(values[start:end]))
            start = end
        mass, constraints, residual, control, gradient, weights = matrices
        known = values[start:] if self.has_jacobians_at_hand else None

        def bodies() -> BodyJacobian:
            entries = known
            if entries is None:
                entries = self._jacobian.run([*q, *([None] * self.n), *parameters, *literals])
            return BodyJacobian(self.heavy, self._bodies.split(self.heavy, entries), self.n)

        return Configuration(mass, constraints, residual, control, gradient, weights, bodies)

    @cached_property
    def has_jacobians_at_hand(self) -> bool:
        """Whether Jacobians of bodies take no longer than what rates and forces of these need of them."""
        return self.motion is None or self._jacobian.operations <= self.motion.bodies.operations

    @cached_property
    def _configuration(self) -> Replay:
        bodies = self._bodies.needed(self.heavy) if self.has_jacobians_at_hand else []
        return replay_of(self._tape, [*self._at_configuration, *bodies])

    def _set_parts(self, blocks: Sequence[Sequence[Register]]) -> None:
        """What nothing couples: by geometric rows (`loops`), by rows and inputs (`parts`), by masses too (`heavy`)."""
        n, zero = self.n, self._tape.zero
        mass, constraints, residual, control, *_ = blocks
        rows = touched(constraints, n, zero)
        inputs = [[k for k in range(n) if control[k * self.m + j] != zero] for j in range(self.m)]
        pairs = [(i, j) for i, these in enumerate(touched(mass, n, zero)) for j in these]
        bodies = self._bodies.moved()
        coupled = parts(n, rows[: self.r_geometric])
        self.loops = tuple(part for part in coupled if part.rows)
        self._loop_replay = replay_of(
            self._tape,
            [
                x
                for loop in self.loops
                for x in (
                    *(residual[i] for i in loop.rows),
                    *(constraints[i * n + j] for i in loop.rows for j in loop.coordinates),
                )
            ],
        )
        self.parts = parts(n, rows, inputs)
        self.heavy = parts(n, rows, inputs, bodies, pairs)
        self.input_blocks = tuple(blocks_of_inputs(part, inputs) for part in self.parts)

    def matrices(self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> tuple[Any, Any]:
        """B (r x n) and M (n x m) at q."""
        values = self.matrices_replay.run([*q, *([None] * self.n), *parameters, *literals])
        size = self.r * self.n
        return arb_mat(self.r, self.n, values[:size]), arb_mat(self.n, self.m, values[size:])

    @cached_property
    def masses_replay(self) -> Replay:
        """The energy that is written out (n x n), masses and inertias of bodies, their Jacobians part by part."""
        return replay_of(self._tape, [*self._written_mass, *self._weights, *self._bodies.needed(self.heavy)])

    @cached_property
    def rates(self) -> MatrixRates:
        """The rates of G, B and M, for the quantities that contain one."""
        return MatrixRates(self.model, self.literals, self.heavy)

    @cached_property
    def motion(self) -> DriftAlongRate | None:
        """What a velocity adds; None where that takes the matrices: T is written with velocities of points."""
        if uses_components(self.model, self.model.kinetic_energy):
            return None
        return DriftAlongRate(self.model, self.literals, self._tape)

    def geometry(self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> tuple[Any, Any]:
        """g (r_g x 1) and dg/dq (r_g x n) at q."""
        values = self.geometry_replay.run([*q, *([None] * self.n), *parameters, *literals])
        r = self.r_geometric
        return arb_mat(r, 1, values[:r]), arb_mat(r, self.n, values[r:])

    def task(self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> tuple[Any, Any]:
        """The coordinates of the task (k x 1) and their derivatives (k x n) at q."""
        values = self.task_replay.run([*q, *([None] * self.n), *parameters, *literals])
        k = len(self.model.task)
        return arb_mat(k, 1, values[:k]), arb_mat(k, self.n, values[k:])

    @cached_property
    def task_replay(self) -> Replay:
        """Its coordinates, then their derivatives row by row."""
        return replay_of(self._tape, self._recorded.task())

    def loop_geometry(
        self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]
    ) -> list[tuple[Any, Any]]:
        """g and dg/dq of each loop, by its own coordinates."""
        values = self._loop_replay.run([*q, *([None] * self.n), *parameters, *literals])
        geometry, start = [], 0
        for loop in self.loops:
            rows, columns = len(loop.rows), len(loop.coordinates)
            middle, end = start + rows, start + rows * (1 + columns)
            geometry.append((arb_mat(rows, 1, values[start:middle]), arb_mat(rows, columns, values[middle:end])))
            start = end
        return geometry

    def energies(
        self, q: Sequence[Any], qd: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]
    ) -> tuple[Any, ...]:
        """T and U."""
        return self._energies.run([*q, *qd, *parameters, *literals])

    def applied(self, q: Sequence[Any], qd: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> Any:
        """Q_a (n x 1)."""
        if not self.model.has_applied_forces:
            return arb_mat(self.n, 1)
        return arb_mat(self.n, 1, self._applied.run([*q, *qd, *parameters, *literals]))

    def points(self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> tuple[Any, Any]:
        """Places (k x 3) and velocities per rate (3k x n) of the k points, in world axes."""
        values = self._points.run([*q, *([None] * self.n), *parameters, *literals])
        k = len(self.model.mechanism.points)
        return arb_mat(k, 3, values[: 3 * k]), arb_mat(3 * k, self.n, values[3 * k :])

    def gravity(self, parameters: Sequence[Any], literals: Sequence[Any]) -> Sequence[Any]:
        """The acceleration of gravity in world axes."""
        return self._gravity.run([*([None] * (2 * self.n)), *parameters, *literals])

    def operations(self, rates: Iterable[str]) -> int:
        """Number of recorded operations, for estimates of cost, with those of the `rates` of matrices."""
        needed = {*rates, *(("mass", "constraints") if self.motion is None else ())}
        return len(self._tape.records) + sum(self.rates.operations(matrix) for matrix in sorted(needed))

    @cached_property
    def _gravity(self) -> Replay:
        return replay_of(self._tape, self._recorded.gravity())

    @cached_property
    def _energies(self) -> Replay:
        return replay_of(self._tape, self._recorded.energies())

    @cached_property
    def _points(self) -> Replay:
        return replay_of(self._tape, self._recorded.points())

    @cached_property
    def _applied(self) -> Replay:
        return replay_of(self._tape, self._recorded.applied())
