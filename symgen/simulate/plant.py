"""The model as a plant: its generated kernels at the default parameters, run as C or by the interpreter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from symgen.ir.kernel import Scalar, Status
from symgen.mechanics.genericity import assembly_of
from symgen.model.configurations.closing import row_unit
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.model import Model
from symgen.verify.reference.reference import State
from symgen.verify.running.compile import Outcome

QUANTITIES = ("forward_dynamics", "admissible_velocity", "projected_configuration", "constraint_residual", "energy")
MEANING = {
    Status.NOT_FINITE: "a result is not finite",
    Status.CONSTRAINT_RANK: "the rank of the constraints drops",
    Status.ACTUATION_RANK: "the rank of the projected control matrix drops",
    Status.ANGLE_RANGE: "an angle has left the range of the sine and cosine",
    Status.MASS_RANK: "the accelerations are not determined",
    Status.PARAMETER_RANGE: "a parameter is too far from its value in the model file",
    Status.COORDINATE_RANGE: "a coordinate is too far out of its range in the model file",
    Status.MEASURED_RANK: "what is measured does not determine the rest",
    Status.NOT_CLOSED: "no configuration with what is measured closes the loops",
    Status.BRANCH: "what is measured is too far from where the machine was",
    Status.LIMITS: "no inputs within their limits produce the motion",
    Status.FRICTION_LOCK: "friction grows too much with the reactions that it causes itself",
}


class PlantError(Exception):
    """A kernel has no result at a state; says where and why."""


class Runs(Protocol):
    """What runs kernels, by name."""

    def run(self, name: str, state: State, scalar: Scalar) -> Outcome:
        """One kernel at one state."""


class Plant:
    """Accelerations, projections and energies of a model at q, q_dot under inputs u."""

    def __init__(self, model: Model, parameters: Sequence[float], kernels: Runs) -> None:
        self._kernels = kernels
        self.parameters = tuple(parameters)
        self.model = model
        self._units = _units(model)

    def accelerations(self, q: Sequence[float], qd: Sequence[float], u: Sequence[float]) -> tuple[float, ...]:
        """q_ddot (n)."""
        return self._run("forward_dynamics", q, qd, u)

    def admissible(self, q: Sequence[float], qd: Sequence[float]) -> tuple[float, ...]:
        """The nearest rates that the constraints allow, N q_dot (n)."""
        return self._run("admissible_velocity", q, qd) if self.model.r else tuple(qd)

    def projected(self, q: Sequence[float]) -> tuple[float, ...]:
        """Two Newton steps towards the constraints (n)."""
        return self._run("projected_configuration", q) if self._has_geometric else tuple(q)

    def residual(self, q: Sequence[float]) -> float:
        """The largest violation of a geometric constraint; rows in units of their own count as `row_unit` says."""
        if not self._has_geometric:
            return 0.0
        return max(abs(g * unit) for g, unit in zip(self._run("constraint_residual", q), self._units, strict=True))

    def energy(self, q: Sequence[float], qd: Sequence[float]) -> tuple[float, float]:
        """(T, U)."""
        kinetic, potential = self._run("energy", q, qd)
        return kinetic, potential

    @property
    def _has_geometric(self) -> bool:
        return any(row.kind == "geometric" for row in self.model.constraints)

    def _run(
        self, name: str, q: Sequence[float], qd: Sequence[float] = (), u: Sequence[float] = ()
    ) -> tuple[float, ...]:
        zeros = (0.0,) * self.model.n
        state = State(tuple(q), tuple(qd) or zeros, zeros, tuple(u) or (0.0,) * self.model.m, self.parameters)
        outcome = self._kernels.run(name, state, "float64")
        if outcome.status:
            raise PlantError(f"{name}: {MEANING[Status(outcome.status)]}")
        return tuple(map(float, outcome.entries))


def _units(model: Model) -> list[float]:
    """For each geometric row, by its gradient where the mechanism is known to be assembled."""
    known = assembly_of(model)
    numbers = NumericSystem.of(model)
    rows = numbers.residuals(known.places[0].q, range(len(numbers.geometric)))[1]
    return [row_unit(row.values()) for row in rows]
