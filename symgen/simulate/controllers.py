"""Controllers that follow a planned motion, made of the kernels that a controller's firmware would call."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from symgen.ir.kernel import Scalar, Status
from symgen.model.model import Model
from symgen.simulate.plant import MEANING, PlantError
from symgen.verify.running.compile import Outcome

Array: TypeAlias = NDArray[np.float64]
COMPUTED_TORQUE, PD, LQR = "computed-torque", "pd", "lqr"
CONTROLLERS = (COMPUTED_TORQUE, PD, LQR)
# By controller, what its kernels compute.
NEEDED = {
    COMPUTED_TORQUE: ("inverse_dynamics", "admissible_acceleration"),
    PD: ("mass_matrix", "projected_control_pseudoinverse"),
    LQR: (),
}


class RunsGiven(Protocol):
    """What runs kernels, by name and arrays."""

    def run_given(
        self, name: str, parts: Mapping[str, Sequence[float]], parameters: Sequence[float], scalar: Scalar
    ) -> Outcome:
        """One kernel."""


@dataclass(frozen=True, slots=True)
class Planned:
    """What a motion is to be at one time: q, q_dot, q_ddot (n)."""

    q: Array
    qd: Array
    qdd: Array


class Controller(Protocol):
    """The law by which inputs follow what is planned and measured."""

    def inputs(self, planned: Planned, q: Array, qd: Array) -> Array:
        """u (m); raises PlantError where a kernel has no result."""


class ModelKernels:
    """Kernels of the model that a controller knows, with its parameters."""

    def __init__(self, model: Model, parameters: Sequence[float], kernels: RunsGiven) -> None:
        self.model = model
        self._parameters, self._kernels = tuple(parameters), kernels

    def __call__(self, name: str, **arrays: Array) -> Array:
        """A quantity as a flat array; raises PlantError where it has a status."""
        given = {argument: values.tolist() for argument, values in arrays.items()}
        outcome = self._kernels.run_given(name, given, self._parameters, "float64")
        if outcome.status:
            raise PlantError(f"{name}: {MEANING[Status(outcome.status)]}")
        return np.array([float(x) for x in outcome.entries])


class ComputedTorque:
    """u of the planned acceleration and of what brings errors back: q_ddot + 2 w e_dot + w^2 e, made admissible.

    Errors decay critically damped with the bandwidth w, rad/s (Siciliano et al., Robotics, 8.5).
    """

    def __init__(self, kernels: ModelKernels, bandwidth: float) -> None:
        self._kernels, self._bandwidth = kernels, bandwidth

    def inputs(self, planned: Planned, q: Array, qd: Array) -> Array:
        """u (m)."""
        w = self._bandwidth
        wanted = planned.qdd + 2 * w * (planned.qd - qd) + w * w * (planned.q - q)
        if self._kernels.model.r:
            wanted = self._kernels("admissible_acceleration", q=q, qd=qd, qdd=wanted)
        return self._kernels("inverse_dynamics", q=q, qd=qd, qdd=wanted)


class ProportionalDerivative:
    """The same gains with the inertia at the start, and nothing of the motion: u = M~^+ G (2 w e_dot + w^2 e)."""

    def __init__(self, kernels: ModelKernels, bandwidth: float, start: Array) -> None:
        n, m = kernels.model.n, kernels.model.m
        inertia = kernels("mass_matrix", q=start).reshape(n, n)
        self._gain = kernels("projected_control_pseudoinverse", q=start).reshape(m, n) @ inertia
        self._bandwidth = bandwidth

    def inputs(self, planned: Planned, q: Array, qd: Array) -> Array:
        """u (m)."""
        w = self._bandwidth
        gained: Array = self._gain @ (2 * w * (planned.qd - qd) + w * w * (planned.q - q))
        return gained


class Regulated:
    """u of a linear-quadratic regulator about a configuration at rest."""

    def __init__(self, held: Array, of_places: Array, of_rates: Array) -> None:
        self._held, self._of_places, self._of_rates = held, of_places, of_rates

    def inputs(self, planned: Planned, q: Array, qd: Array) -> Array:
        """u (m)."""
        u: Array = self._held + self._of_places @ (planned.q - q) + self._of_rates @ (planned.qd - qd)
        return u
