"""The description that opens every generated file: model, symbols with units, operation counts."""

from __future__ import annotations

from collections.abc import Iterator

from symgen.backends.comments import docstring_lines, indent_of, one_line
from symgen.backends.locals import Names, array_arguments
from symgen.backends.operations import count_operations
from symgen.backends.quantities import meaning
from symgen.ir.bounded import Bound, bounds_of
from symgen.ir.bounded_coordinates import CoordinateBound, coordinate_bounds_of
from symgen.ir.kernel import Kernel, Program, Status
from symgen.model.model import Allocation, Model, Parameter

# Bounds of a parameter that stand on one line.
BOUNDS_A_LINE = 4
STATUS_MEANING: dict[Status, str] = {
    Status.OK: "the result is valid",
    Status.NOT_FINITE: "an input that matters, or a result, is not finite",
    Status.CONSTRAINT_RANK: "the constraints lose rank at this configuration",
    Status.ACTUATION_RANK: "the inputs lose rank at this configuration",
    Status.ANGLE_RANGE: "an angle is beyond the range of the sine and cosine",
    Status.MASS_RANK: "the masses do not determine the acceleration although the constraints keep their rank",
    Status.PARAMETER_RANGE: "a parameter is so far from its value in the model file that the result would lose digits",
    Status.MEASURED_RANK: "what is measured does not determine the rest at this configuration",
    Status.NOT_CLOSED: "Newton's method has not closed the loops from this start",
    Status.BRANCH: "the start is so far away that the result may belong to another assembly mode",
    Status.TASK_RANK: "the task does not determine the rest at this configuration",
    Status.LIMITS: "no inputs within their limits produce this motion",
    Status.COORDINATE_RANGE: "a coordinate is so far out of its range in the model file that digits would be lost",
    Status.FRICTION_LOCK: "friction returns half of the reactions it grows with, or more than its steps hold",
}
# Those of models that name what is measured, of models that have a task, of limits that are kept or refused, of
# friction that grows with reactions, and of coordinates whose range is stated.
_OF_MEASURED = frozenset({Status.MEASURED_RANK, Status.NOT_CLOSED, Status.BRANCH})
_OF_TASK = frozenset({Status.TASK_RANK, Status.NOT_CLOSED, Status.BRANCH})
_OF_LIMITS = frozenset({Status.LIMITS})
_OF_FRICTION = frozenset({Status.FRICTION_LOCK})
_OF_RANGES = frozenset({Status.COORDINATE_RANGE})
_OPEN_TASK = "the task loses rank at this configuration: a direction in which it cannot be moved"


def status_meaning(status: Status, model: Model) -> str:
    """What a status says of a model: a task that leaves directions open determines the rest nowhere."""
    open_ = status is Status.TASK_RANK and model.task_leaves.rates > 0
    return _OPEN_TASK if open_ else STATUS_MEANING[status]


def statuses_of(model: Model) -> tuple[Status, ...]:
    """The statuses that kernels of a model may have."""
    special = _OF_MEASURED | _OF_TASK | _OF_LIMITS | _OF_FRICTION | _OF_RANGES
    met = (_OF_MEASURED if model.measured else frozenset()) | (_OF_TASK if model.task else frozenset())
    met |= _OF_LIMITS if model.keeps_limits else frozenset()
    met |= _OF_FRICTION if model.rough else frozenset()
    met |= _OF_RANGES if any(c.has_range for c in model.coordinates) else frozenset()
    return tuple(status for status in Status if status not in special or status in met)


def symbol_lines(model: Model) -> Iterator[str]:
    """Coordinates and inputs with indices, units and descriptions, unescaped."""
    yield "Coordinates q (rates qd and accelerations qdd in the same order):"
    for index, coordinate in enumerate(model.coordinates):
        yield _symbol(f"q[{index}]", coordinate.name, coordinate.unit, coordinate.description)
    if model.inputs:
        yield "Inputs u:"
        for index, control in enumerate(model.inputs):
            yield _symbol(f"u[{index}]", control.name, control.unit, control.description)
    if model.measured:
        yield "Measured coordinates q_m (rates qd_m and accelerations qdd_m in the same order):"
        yield f"  {', '.join(model.measured)}"
    if model.task:
        yield "Coordinates of the task x_t (rates xd_t and accelerations xdd_t in the same order):"
        yield f"  {', '.join(x.name for x in model.task)}"
    if model.allocation is not None:
        yield "How inverse_dynamics shares the work among the inputs:"
        yield from _allocation_lines(model.allocation, model.keeps_limits)
    if model.rough and model.friction_steps is not None:
        yield "Friction that grows with reactions, in inverse_dynamics and not in applied_force:"
        yield f"  of {', '.join(place.name for place in model.rough)}"
        how = "explicit" if model.friction_steps.explicit else f"worked out in {model.friction_steps.steps} steps"
        yield f"  {how}; status FRICTION_LOCK where it returns half of the reactions that it grows with"


def _allocation_lines(allocation: Allocation, keeps_limits: bool) -> Iterator[str]:
    yield f"  of all u that produce the motion {'the nearest to preload_*' if allocation.preferred else 'the least'}"
    if allocation.weights:
        yield "  in the norm with the factors weight_* (1 where there is none), which must be positive"
    if allocation.preload is not None:
        yield "  and preload times the internal force of norm 1"
    if keeps_limits:
        yield "  within limit_*, or the status LIMITS where no inputs within them produce the motion"
    elif allocation.limits:
        yield "  within limit_*, as far as the internal force alone can keep u there: compare u with its limits"


def renaming_lines(names: Names) -> Iterator[str]:
    """Parameters that are not called as in the model file."""
    if names.renamed:
        yield "Renamed, because the name clashes with C, C++ or a common macro:"
        for old, new in names.renamed:
            yield f"  {old} is {new}"


def count_lines(program: Program) -> Iterator[str]:
    """Operation counts of every kernel as a table."""
    width = max((len(kernel.name) for kernel in program.kernels), default=0)
    yield f"{'Operations':<{width}}     + -      *      /   sqrt sincos  other"
    for kernel in program.kernels:
        c = count_operations(kernel.statements)
        yield f"{kernel.name:<{width}} {c.add:7d}{c.mul:7d}{c.div:7d}{c.sqrt:7d}{c.sincos:7d}{c.other:7d}"
    yield "(changes of sign are not counted)"


def bound_lines(model: Model, program: Program) -> Iterator[str]:
    """The bounds of parameters, and of coordinates, beyond which kernels refuse."""
    by_kernel = {kernel.name: [_bound(*one) for one in bounds_of(kernel)] for kernel in program.kernels}
    if any(by_kernel.values()):
        yield "Beyond these bounds of parameters results would lose digits; they have the status PARAMETER_RANGE there:"
        for name, bounds in by_kernel.items():
            lines = [bounds[start : start + BOUNDS_A_LINE] for start in range(0, len(bounds), BOUNDS_A_LINE)]
            yield from (f"  {name}  {', '.join(line)}" for line in lines)
    coordinates = [c.name for c in model.coordinates]
    by_kernel = {
        kernel.name: [_coordinate_bound(one) for one in coordinate_bounds_of(kernel, coordinates)]
        for kernel in program.kernels
    }
    if any(by_kernel.values()):
        yield "Out of their ranges coordinates have bounds, too, with the status COORDINATE_RANGE beyond them:"
        yield from (f"  {name}  {', '.join(bounds)}" for name, bounds in by_kernel.items() if bounds)


def _coordinate_bound(bound: CoordinateBound) -> str:
    low, high = (None if end is None else f"{float(end):g}" for end in (bound.low, bound.high))
    return " <= ".join(part for part in (low, bound.coordinate, high) if part is not None)


def _bound(bound: Bound, signed: bool) -> str:
    low, high = (None if end is None else f"{float(end):g}" for end in (bound.low, bound.high))
    name = f"|{bound.parameter}|" if signed else bound.parameter
    return " <= ".join(part for part in (low, name, high) if part is not None)


def module_lines(model: Model, program: Program) -> tuple[str, ...]:
    """What opens the docstring of a module in Python."""
    lines = list(docstring_lines(f"{model.name}: {model.description or 'constrained mechanical system'}"))
    if model.source:
        lines += ["", *docstring_lines(f"Source: {model.source}")]
    for group in (symbol_lines(model), count_lines(program), bound_lines(model, program)):
        wrapped: list[str] = []
        for line in group:
            indent = indent_of(line)
            wrapped += [indent + part for part in docstring_lines(line, "    ")] if indent else [line]
        lines += ["", *wrapped] if wrapped else []
    return tuple(lines)


def parameter_text(parameter: Parameter) -> str:
    """Unit and description of a parameter, on one line."""
    return one_line(" ".join(part for part in (unit_text(parameter.unit), parameter.description) if part))


def shape_text(kernel: Kernel) -> str:
    """The shape of a result, such as `4 x 2, row-major`."""
    shape = " x ".join(str(extent) for extent in kernel.shape)
    return f"{shape}, row-major" if len(kernel.shape) > 1 else f"length {shape}"


def array_line(kernel: Kernel) -> str:
    """What a function of arrays is: its meaning, and the last axes of its arguments and of its result."""
    given = ", ".join(f"{one.name} (..., {one.length})" for one in array_arguments(kernel))
    return f"{meaning(kernel)}: {given} -> (..., {', '.join(map(str, kernel.shape))})"


def unit_text(unit: str | None) -> str:
    """A unit in brackets, or nothing."""
    return f"[{unit}]" if unit else ""


def symbol_text(unit: str | None, description: str) -> str:
    """A unit in brackets and a description, where there are any."""
    return " ".join(part for part in (unit_text(unit), description) if part)


def _symbol(place: str, name: str, unit: str | None, description: str) -> str:
    return "  " + " ".join(part for part in (place, name, symbol_text(unit, description)) if part)
