"""A study with its names looked up in the model: what is varied, how configurations come about, what is computed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

from symgen.diagnostics import Span
from symgen.ir.kernel import Scalar
from symgen.model.expressions.names import did_you_mean
from symgen.model.model import Model
from symgen.study.asked.request import (
    CONTROL,
    DRIVE_SPEED,
    FLOAT32,
    GRID,
    INPUTS,
    MODES,
    MOTOR_TORQUE,
    POWER,
    REACH,
    REGULAR,
    SENSITIVITY,
    SHOWN,
    SINGULARITY,
    UTILISATION,
    StudyAxis,
    StudyMistakes,
    StudyRequest,
)
from symgen.study.sizing.drives import MotorDrive, drives_of

Kind: TypeAlias = Literal["parameter", "coordinate", "task", "measured"]
# How the configuration of a state comes about: on a path, from values of the task or of measured coordinates by a walk
# from the model's configuration, with coordinates as they are given, or as the model has it.
Placing: TypeAlias = Literal["path", "task", "measured", "given"]
FROM_TASK, FROM_MEASURED, TASK_PLACE = "configuration_from_task", "configuration_from_measured", "task_position"
# Made where nothing is asked of the model but its paths.
NO_KERNEL_NEEDED = ("mass_matrix",)
# What each quantity of interest is computed from.
KERNELS = {
    INPUTS: ("inverse_dynamics",),
    POWER: ("inverse_dynamics", "control_matrix"),
    SINGULARITY: ("singularity", "constraint_jacobian", "control_matrix"),
    SENSITIVITY: ("inverse_dynamics_parameter_jacobian",),
    FLOAT32: ("inverse_dynamics",),
    CONTROL: ("projected_control_matrix",),
    UTILISATION: ("utilisation",),
    REACH: (),
    MODES: (),
    REGULAR: ("constraint_jacobian", "control_matrix"),
    MOTOR_TORQUE: ("inverse_dynamics",),
    DRIVE_SPEED: (),
}


@dataclass(frozen=True, slots=True)
class VariedName:
    """A range of the study, and the place of its name among those of its kind."""

    axis: StudyAxis
    kind: Kind
    place: int
    unit: str


@dataclass(frozen=True, slots=True)
class StudyPlan:
    """A study of a model: `over` are the names varied from point to point, `along` those of the states of a point.

    `drives` are those for which motors are looked for.
    """

    request: StudyRequest
    model: Model
    over: tuple[VariedName, ...]
    along: tuple[VariedName, ...]
    placing: Placing
    drives: tuple[MotorDrive, ...] = ()

    @property
    def shown(self) -> tuple[str, ...]:
        """The quantities of interest, those that motors are sized by last."""
        sized = (DRIVE_SPEED, MOTOR_TORQUE) if self.request.motors else ()
        return (*dict.fromkeys(one.name for one in self.request.show), *sized)

    @property
    def kernels(self) -> tuple[str, ...]:
        """The quantities of the model that are called."""
        placing = {"task": (FROM_TASK, TASK_PLACE), "measured": (FROM_MEASURED,)}.get(self.placing, ())
        counts = {"constraint_jacobian": self.model.r, "control_matrix": self.model.m}
        lacking = {name for name, count in counts.items() if not count}
        named = dict.fromkeys((*placing, *(name for one in self.shown for name in KERNELS[one])))
        return tuple(name for name in named if name not in lacking) or NO_KERNEL_NEEDED

    @property
    def scalars(self) -> tuple[Scalar, ...]:
        """The types that kernels are made in."""
        return ("float64", "float32") if FLOAT32 in self.shown else ("float64",)

    @property
    def one_machine(self) -> bool:
        """Whether all points have the same parameters, and states of their own."""
        return self.placing != "path" and all(one.kind != "parameter" for one in self.over)

    @property
    def shape(self) -> tuple[int, ...]:
        """How many points there are: along each axis of a grid, else of the sample."""
        if self.request.sample == GRID:
            return tuple(one.axis.count or 1 for one in self.over)
        return (self.request.count or 1,)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of these axes."""
        return tuple(one.axis.name for one in self.over) if self.request.sample == GRID else ("point",)

    @property
    def points(self) -> int:
        """How many points there are."""
        return _product(self.shape)

    @property
    def states(self) -> int:
        """How many states are reduced at each point."""
        path = next((one for one in self.model.paths if self.request.path and one.name == self.request.path.name), None)
        return path.samples if path is not None else _product(one.axis.count or 1 for one in self.along)


def planned_study(model: Model, request: StudyRequest, mistakes: StudyMistakes) -> StudyPlan:
    """The plan; raises ModelError or WrongUseError with everything that the model does not have."""
    over = [_varied(model, "over", axis, mistakes) for axis in request.over]
    along = [_varied(model, "along", axis, mistakes) for axis in request.along]
    if request.path is not None:
        names = [path.name for path in model.paths]
        _check_name(mistakes, "along", request.path.name, names, "path", request.path.span)
    known = [one for one in (*over, *along) if one is not None]
    placing = _placing(model, request, known, mistakes)
    for one in request.show:
        _check_shown(model, one.name, one.span, mistakes)
        if one.name in (MODES, REGULAR) and placing not in ("task", "measured"):
            said = "are those" if one.name == MODES else "is said"
            message = f"`{one.name}` {said} of a place, which nothing gives"
            mistakes.wrong("show", message, "vary the `task` or `measured` coordinates of a mechanism", one.span)
    drives = drives_of(model) if request.motors else ()
    if request.motors and not drives:
        remedy = "give an input the `joint` that it drives"
        message = "no input acts along one coordinate in a constant ratio, as a motor does"
        mistakes.wrong("size", message, remedy, request.motors_span)
    mistakes.check()
    return StudyPlan(request, model, tuple(filter(None, over)), tuple(filter(None, along)), placing, drives)


def _varied(model: Model, key: str, axis: StudyAxis, mistakes: StudyMistakes) -> VariedName | None:
    groups: tuple[tuple[Kind, dict[str, str]], ...] = (
        ("parameter", {one.name: one.unit or "" for one in model.parameters}),
        ("coordinate", {} if _closes_loops(model) else {one.name: one.unit or "" for one in model.coordinates}),
        ("task", {one.name: "" for one in model.task}),
        ("measured", {c.name: c.unit or "" for c in (model.coordinates[k] for k in model.measured_places)}),
    )
    for kind, units in groups:
        if axis.name in units:
            return VariedName(axis, kind, list(units).index(axis.name), units[axis.name])
    known = tuple(dict.fromkeys(name for _, units in groups for name in units))
    if axis.name in {one.name for one in model.coordinates}:
        remedy = "name it under `measured`, or vary the `task`"
        mistakes.wrong(key, f"`{axis.name}` follows from the others, which close the loops", remedy, axis.span)
    else:
        _check_name(mistakes, key, axis.name, known, "parameter, coordinate or task", axis.span)
    return None


def _check_name(
    mistakes: StudyMistakes, key: str, name: str, known: Iterable[str], what: str, span: Span | None
) -> None:
    names = tuple(known)
    if name not in names:
        remedy = did_you_mean(name, names, f"the model has {', '.join(names) or 'none'}")
        mistakes.wrong(key, f"the model has no {what} `{name}`", remedy, span)


def _closes_loops(model: Model) -> bool:
    return any(row.kind == "geometric" for row in model.constraints)


def _placing(
    model: Model, request: StudyRequest, varied: Iterable[VariedName], mistakes: StudyMistakes
) -> Placing:
    """How configurations come about; places that are varied beside a path, or in two ways, are mistakes."""
    kinds: dict[Kind, VariedName] = {}
    for one in varied:
        kinds.setdefault(one.kind, one)
    placed = [one for kind, one in kinds.items() if kind != "parameter"]
    if request.path is not None:
        if placed:
            first = placed[0].axis
            message = f"`{first.name}` is a place, and the path `{request.path.name}` gives the places"
            mistakes.wrong("over", message, "leave one of them out", first.span)
        return "path"
    if len(placed) > 1:
        last = placed[1].axis
        message = f"`{placed[0].axis.name}` and `{last.name}` give places in two ways"
        mistakes.wrong("over", message, "vary the task, or coordinates, not both", last.span)
    if "task" in kinds or (_closes_loops(model) and not placed and model.task):
        return "task"
    if "measured" in kinds or (_closes_loops(model) and not placed and model.measured):
        return "measured"
    if _closes_loops(model) and kinds:
        message = "nothing says where the mechanism is while parameters change its loops"
        mistakes.wrong("over", message, "give the model a `task` or `measured`, or study it along a path")
    return "given"


def _check_shown(model: Model, name: str, span: Span | None, mistakes: StudyMistakes) -> None:
    """A quantity that the model cannot have."""
    if name not in SHOWN:
        _check_name(mistakes, "show", name, SHOWN, "quantity of interest", span)
    elif name in (INPUTS, POWER, SENSITIVITY, FLOAT32, CONTROL, UTILISATION) and not model.m:
        mistakes.wrong("show", f"`{name}` needs inputs, of which the model has none", "give it `inputs`", span)
    elif name == SENSITIVITY and not model.parameters:
        mistakes.wrong("show", f"`{name}` is by parameters, of which the model has none", "give it `parameters`", span)
    elif name == UTILISATION and (model.allocation is None or len(model.allocation.limits) < model.m):
        remedy = "give the model `limits` of every input under `allocation`"
        mistakes.wrong("show", "`utilisation` is the share of limits, which the inputs do not have", remedy, span)


def _product(counts: Iterable[int]) -> int:
    product = 1
    for count in counts:
        product *= count
    return product
