"""Quantities of interest at the states of a block of points, each with channels of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symgen.mechanics.genericity import assembly_of
from symgen.model.model import Model
from symgen.study.asked.request import (
    CONTROL,
    DRIVE_SPEED,
    FLOAT32,
    INPUTS,
    MODES,
    MOTOR_TORQUE,
    POWER,
    REACH,
    REGULAR,
    SENSITIVITY,
    SINGULARITY,
    UTILISATION,
)
from symgen.study.assembly_modes import assembly_modes
from symgen.study.chunks import Array
from symgen.study.determinants import choices, determinants
from symgen.study.kernels import Codes, StudyKernels
from symgen.study.plan import KERNELS, StudyPlan
from symgen.study.sizing.drives import motor_torques, rotors_at
from symgen.study.states import BlockStates

CHOICE, MODE_COUNT = "choice", "mode_count"


@dataclass(frozen=True, slots=True)
class Interest:
    """A variable of the results: `channels` along a dimension of that name, if there are several, with their units.

    `smallest` says that small magnitudes are the bad ones; `signed` that it changes its sign where it vanishes;
    `counted` that it is a whole number, of which none is bad.
    """

    name: str
    about: str
    dimension: str
    channels: tuple[str, ...]
    units: tuple[str, ...]
    smallest: bool = False
    signed: bool = False
    counted: bool = False

    @property
    def unit(self) -> str:
        """The unit of all channels, or nothing where they differ."""
        return self.units[0] if len(set(self.units)) == 1 else ""


def interests(plan: StudyPlan) -> tuple[Interest, ...]:
    """What a study shows, in the order in which it was asked for."""
    return tuple(one for name in plan.shown for one in (_sized(plan, name) or _interests(plan.model, name)))


def _sized(plan: StudyPlan, name: str) -> tuple[Interest, ...]:
    """What depends on more than the model: its assembly modes at the start, and what motors are sized by."""
    if name == MODES:
        count = len(assembly_modes(plan.model, plan.placing == "task"))
        about = "1 where an assembly mode is reached within the ranges of coordinates, else 0; that of the model first"
        numbers = tuple(f"mode {k}" for k in range(1, count + 1))
        each = Interest(MODES, about, "mode", numbers, ("1",) * count, smallest=True, counted=True)
        return Interest(MODE_COUNT, "number of assembly modes", "", ("",), ("1",), smallest=True, counted=True), each
    if name not in (DRIVE_SPEED, MOTOR_TORQUE):
        return ()
    drives = tuple(one.name for one in plan.drives)
    if name == DRIVE_SPEED:
        inputs = {one.name: one.unit for one in plan.model.inputs}
        units = tuple({"N": "m/s", "N*m": "rad/s"}.get(inputs[drive] or "", "") for drive in drives)
        return (Interest(DRIVE_SPEED, "speed of each drive", "drive", drives, units),)
    pairs = tuple(f"{drive} {motor.name}" for drive in drives for motor in plan.request.motors)
    about = "torque of the shaft of each motor at each drive, its own inertia in place of the model's"
    return (Interest(MOTOR_TORQUE, about, "drive_motor", pairs, ("N*m",) * len(pairs)),)


def _interests(model: Model, name: str) -> tuple[Interest, ...]:
    drives, units = tuple(one.name for one in model.inputs), tuple(one.unit or "" for one in model.inputs)
    if name == INPUTS:
        return (Interest(INPUTS, "inputs that produce the motion", "input", drives, units),)
    if name == FLOAT32:
        about = "how far each input in float32 is from that in float64: states, parameters and operations are rounded"
        return (Interest(FLOAT32, about, "input", drives, units),)
    if name == POWER:
        watts = tuple("W" if unit in ("N", "N*m") else "" for unit in units)
        return (Interest(POWER, "power of each input, force times velocity along it", "input", drives, watts),)
    if name == SENSITIVITY:
        about = "most that an input changes by where a parameter changes by its own value, the configuration staying"
        changed = tuple(one.name for one in model.parameters)
        common = units[0] if len(set(units)) == 1 else ""
        return (Interest(SENSITIVITY, about, "parameter", changed, (common,) * len(changed)),)
    if name == SINGULARITY:
        measures = "constraint", "input"
        about = "distances from singularities of constraints and of inputs, 0 to 1"
        sigma = Interest(SINGULARITY, about, "measure", measures, ("1", "1"), smallest=True)
        subsets = choices(model)
        if not subsets:
            return (sigma,)
        names = tuple("+".join(drives[k] for k in subset) for subset in subsets)
        about = "det [B; Mᵀ] with these inputs alone, rows scaled to length 1"
        return sigma, Interest(CHOICE, about, "drives", names, ("1",) * len(names), smallest=True, signed=True)
    if name == CONTROL:
        about = "smallest singular value of the projected control matrix that is not 0 everywhere"
        return (Interest(CONTROL, about, "", ("",), (" or ".join(dict.fromkeys(units)),), smallest=True),)
    if name == UTILISATION:
        return (Interest(UTILISATION, "share of their limits that inputs need at least", "", ("",), ("1",)),)
    if name == REGULAR:
        about = "1 where a way from the start keeps to the ranges of coordinates and passes no singularity, else 0"
        return (Interest(REGULAR, about, "", ("",), ("1",), smallest=True, counted=True),)
    about = "1 where there is a configuration, else 0"
    return (Interest(REACH, about, "", ("",), ("1",), smallest=True, counted=True),)


def keeps_figures_alone(plan: StudyPlan) -> bool:
    """Whether of the states of a point nothing is looked at a second time."""
    return plan.states > 1 and not plan.request.quantiles


def is_reduced_at_once(plan: StudyPlan) -> bool:
    """Whether that holds, and all that is shown are entries of kernels that nothing else needs."""
    quantities = [_ENTRIES_OF.get(one.name) for one in interests(plan)]
    return keeps_figures_alone(plan) and all(name is not None and not is_shared(plan, name) for name in quantities)


def is_shared(plan: StudyPlan, quantity: str) -> bool:
    """Whether several variables of the results are made from a quantity."""
    return sum(quantity in KERNELS[one] for one in plan.shown) > 1


class BlockValues:
    """The quantities of interest of a block of points; kernels run once, whatever needs them."""

    def __init__(self, plan: StudyPlan, kernels: StudyKernels, states: BlockStates) -> None:
        self._plan, self._kernels, self._states = plan, kernels, states
        self._made: dict[str, tuple[Array, Codes]] = {}
        self.shape = len(states.group), states.placed.shape[1]
        """Points and states of each."""
        self.status: Codes | None = states.placed[states.group] if states.placed.any() else None
        """Of the states (points x states), or nothing where all are 0."""

    def of(self, name: str) -> Array:
        """A variable of the results, points x channels x states; NaN where a kernel has no result."""
        return np.ascontiguousarray(_EVALUATED[name](self))

    def reduced(self, one: Interest) -> tuple[Array, NDArray[np.int64]]:
        """What the entries of a variable are reduced to along the states, see `StudyKernels.reduced`.

        Where they are those of a kernel and nothing else needs them they are not kept.
        """
        quantity = _ENTRIES_OF.get(one.name)
        if quantity is None or quantity in self._made or is_shared(self._plan, quantity):
            values = self.of(one.name)
            return self._kernels.reduced(values.reshape(-1, values.shape[2]), one.smallest)
        states = self._states
        figures, places, status = self._kernels.reduced_over(
            quantity, states.parts, states.group, states.parameters, one.smallest
        )
        self._count(status)
        return figures, places

    def _count(self, status: Codes | None) -> None:
        if status is not None and status.any():
            known = np.zeros_like(status) if self.status is None else self.status
            self.status = np.where(known == 0, status, known)

    def entries(self, name: str) -> Array:
        """A quantity of the model, points x entries x states; its statuses count where there was none before."""
        if name not in self._made:
            entries, status = self._entries(name)
            self._made[name] = entries, status
            self._count(status)
        return self._made[name][0]

    def _entries(self, name: str) -> tuple[Array, Codes]:
        """Points that differ in places alone are the states of one: the kernel for many states takes them all."""
        states = self._states
        if not self._plan.one_machine:
            return self._kernels.over(name, states.parts, states.group, states.parameters)
        points, count = self.shape
        together = {part: np.swapaxes(of, 0, 1).reshape(1, -1, points * count) for part, of in states.parts.items()}
        entries, status = self._kernels.over(name, together, np.zeros(1, dtype=np.uintp), states.parameters[:1])
        return np.swapaxes(entries.reshape(-1, points, count), 0, 1), status.reshape(points, count)

    def matrices(self, name: str, columns: int) -> Array:
        """A quantity of the model as matrices, points x states x rows x columns."""
        entries = np.moveaxis(self.entries(name), 1, 2)
        return np.asarray(entries.reshape(*entries.shape[:2], -1, columns))

    @property
    def rates(self) -> Array:
        """Rates of the points, points x states x n."""
        return np.asarray(np.moveaxis(self._of_points("qd"), 1, 2))

    @property
    def float32_errors(self) -> Array:
        """Of each input, points x m x states."""
        states = self._states
        assert self._kernels.float32_inputs is not None
        single = self._kernels.float32_inputs.over(states.parts, states.group, states.parameters)
        return np.abs(single - self.entries("inverse_dynamics"))

    @property
    def drive_speeds(self) -> Array:
        """Of the drives that a motor can sit at, points x drives x states."""
        rates = self._of_points("qd")
        return np.stack([one.share * rates[:, one.coordinate] for one in self._plan.drives], axis=1)

    @property
    def motor_torques(self) -> Array:
        """Of each motor at each of these drives, points x drives * motors x states."""
        drives = self._plan.drives
        rotors = rotors_at(self.model, drives, self._states.parameters)
        u = self.entries("inverse_dynamics")
        return motor_torques(drives, self._plan.request.motors, u, self._of_points("qdd"), rotors)

    def _of_points(self, part: str) -> Array:
        """A part of the states of the points, points x n x states."""
        return np.asarray(self._states.parts[part][self._states.group])

    @property
    def parameters(self) -> Array:
        """Of the points, points x parameters."""
        return self._states.parameters

    @property
    def reached(self) -> Array:
        """1 where there is a configuration, points x 1 x states."""
        return np.asarray(self._states.placed[self._states.group] == 0, dtype=np.float64)[:, None]

    @property
    def regular(self) -> Array:
        """1 where no singularity is passed on the way, points x 1 x states."""
        assert self._states.regular is not None
        return self._states.regular[:, None]

    @property
    def assembled(self) -> Array:
        """1 where an assembly mode is reached, points x modes x states."""
        assert self._states.assembled is not None
        return self._states.assembled

    @property
    def model(self) -> Model:
        """The model of the study."""
        return self._plan.model


def _power(block: BlockValues) -> Array:
    """Each input times the velocity along it, a column of M times the rates."""
    columns = block.matrices("control_matrix", block.model.m)
    velocities = (columns * block.rates[..., None]).sum(axis=2)
    return np.asarray(block.entries("inverse_dynamics") * np.moveaxis(velocities, 1, 2))


def _sensitivity(block: BlockValues) -> Array:
    """For each parameter the largest magnitude of p du/dp."""
    slopes = block.entries("inverse_dynamics_parameter_jacobian")
    by_input = slopes.reshape(len(slopes), block.model.m, len(block.model.parameters), -1)
    return np.asarray(np.abs(by_input).max(axis=1) * np.abs(block.parameters)[:, :, None])


def _smallest_singular_value(block: BlockValues) -> Array:
    model = block.model
    matrices = block.matrices("projected_control_matrix", model.m)
    known = np.asarray(np.isfinite(matrices).all(axis=(2, 3)))
    whole = np.where(known[..., None, None], matrices, 0.0)
    values: Array = np.linalg.svd(whole, full_matrices=False, compute_uv=False)
    rank = assembly_of(model).ranks.actuation
    return np.where(known, values[..., rank - 1] if rank else 0.0, np.nan)[:, None]


def _determinants(block: BlockValues) -> Array:
    model = block.model
    columns = block.matrices("control_matrix", model.m)
    rows = block.matrices("constraint_jacobian", model.n) if model.r else np.swapaxes(columns, 2, 3)[:, :, :0]
    return np.moveaxis(determinants(model, rows, columns), -1, 1)


# Variables that are the entries of a quantity of the model.
_ENTRIES_OF = {INPUTS: "inverse_dynamics", SINGULARITY: "singularity", UTILISATION: "utilisation"}
_EVALUATED: dict[str, Callable[[BlockValues], Array]] = {
    INPUTS: lambda block: block.entries("inverse_dynamics"),
    POWER: _power,
    SINGULARITY: lambda block: block.entries("singularity"),
    CHOICE: _determinants,
    SENSITIVITY: _sensitivity,
    FLOAT32: lambda block: block.float32_errors,
    CONTROL: _smallest_singular_value,
    UTILISATION: lambda block: block.entries("utilisation"),
    REACH: lambda block: block.reached,
    REGULAR: lambda block: block.regular,
    MODES: lambda block: block.assembled,
    MODE_COUNT: lambda block: block.assembled.sum(axis=1, keepdims=True),
    DRIVE_SPEED: lambda block: block.drive_speeds,
    MOTOR_TORQUE: lambda block: block.motor_torques,
}
