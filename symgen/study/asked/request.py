"""What a study is asked for, as the command line or a study file says it, and its mistakes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from symgen.diagnostics import Mistake, ModelError, Span
from symgen.generation.results import WrongUseError
from symgen.study.sizing.catalogue import Motor

GRID, RANDOM, LATIN_HYPERCUBE, SOBOL = "grid", "random", "latin_hypercube", "sobol"
SAMPLES = (GRID, RANDOM, LATIN_HYPERCUBE, SOBOL)
INPUTS, POWER, SINGULARITY = "inputs", "power", "singularity"
CONTROL, UTILISATION, REACH, SENSITIVITY = "control", "utilisation", "reach", "sensitivity"
FLOAT32, MODES, REGULAR = "float32", "modes", "regular"
# Points of a Latin hypercube at most: the strata of each name are drawn as a whole.
MOST_STRATA = 10_000_000
# States that are reduced at a point at most: they stand in memory together.
MOST_REDUCED = 2_000_000
# What is worked out for a catalogue of motors.
MOTOR_TORQUE, DRIVE_SPEED = "motor_torque", "drive_speed"
SHOWN = (INPUTS, POWER, SENSITIVITY, FLOAT32, SINGULARITY, CONTROL, UTILISATION, REACH, MODES, REGULAR)


@dataclass(frozen=True, slots=True)
class StudyAxis:
    """A name with the range of its values, in its unit; `count` of them where they form a grid."""

    name: str
    first: float
    last: float
    count: int | None
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class AskedName:
    """A name that was asked for, and where."""

    name: str
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class StudyRequest:
    """A study before its names are looked up in a model.

    Points are `over` these ranges, `sample` says how; at each the states `along` a path or a grid of its own are
    reduced.  `count` and `seed` are those of samples that are no grid.  `quantiles` are levels between 0 and 1.  Of
    `motors` those are looked for that can be the drives.
    """

    model: Path
    over: tuple[StudyAxis, ...]
    show: tuple[AskedName, ...]
    sample: str = GRID
    count: int | None = None
    seed: int = 0
    path: AskedName | None = None
    along: tuple[StudyAxis, ...] = ()
    quantiles: tuple[float, ...] = ()
    quantiles_span: Span | None = None
    sample_span: Span | None = None
    motors: tuple[Motor, ...] = ()
    motors_span: Span | None = None


@dataclass(slots=True)
class StudyMistakes:
    """All that is wrong with a study: in its `file` with places, else behind the options of the command line."""

    file: str = ""
    text: str = ""
    mistakes: list[Mistake] = field(default_factory=list)

    def wrong(self, key: str, message: str, remedy: str, span: Span | None = None) -> None:
        """A mistake of what stands under `key`."""
        self.mistakes.append(Mistake(message if self.file else f"--{key}: {message}", remedy, span))

    def check(self) -> None:
        """Raises ModelError, or WrongUseError without a file, where there are mistakes."""
        if not self.mistakes:
            return
        if self.file:
            raise ModelError(self.file, self.text, tuple(self.mistakes))
        raise WrongUseError("\n".join(f"{one.message}; {one.remedy}" for one in self.mistakes))


def check_axis(mistakes: StudyMistakes, key: str, axis: StudyAxis, of_a_grid: bool) -> None:
    """An axis has values; a grid says how many, a sample does not."""
    if not axis.first <= axis.last or (axis.first == axis.last and axis.count not in (None, 1)):
        message = f"the range of `{axis.name}` from {axis.first:g} to {axis.last:g} is empty"
        mistakes.wrong(key, message, "give the smaller end first", axis.span)
    if of_a_grid and axis.count is None:
        ends = f"{axis.first:g}, {axis.last:g}, 11"
        remedy = f"add a count, such as {axis.name}={ends.replace(', ', ':')} or [{ends}]"
        mistakes.wrong(key, f"a grid needs the number of values of `{axis.name}`", remedy, axis.span)
    if of_a_grid and axis.count is not None and axis.count < 1:
        mistakes.wrong(key, f"`{axis.name}` has {axis.count} values", "give 1 or more", axis.span)
    if of_a_grid and axis.count == 1 and axis.first < axis.last:
        message = f"one value of `{axis.name}` cannot reach from {axis.first:g} to {axis.last:g}"
        mistakes.wrong(key, message, "give 2 or more", axis.span)
    if not of_a_grid and axis.count is not None:
        message = f"`{axis.name}` has a number of values, which a sample takes from `count`"
        mistakes.wrong(key, message, f"write {axis.first:g}:{axis.last:g}, or sample: grid", axis.span)


def check_request(mistakes: StudyMistakes, request: StudyRequest) -> None:
    """What is wrong whatever the model is."""
    gridded = request.sample == GRID
    for axis in request.over:
        check_axis(mistakes, "over", axis, gridded)
    for axis in request.along:
        check_axis(mistakes, "along", axis, True)
    if not gridded and request.count is None:
        remedy = "write how many points, such as 1024"
        mistakes.wrong("count", f"a {request.sample} sample needs `count`", remedy, request.sample_span)
    if gridded and request.count is not None:
        remedy = f"leave it out, or choose {', '.join(SAMPLES[1:])}"
        mistakes.wrong("count", "a grid has as many points as its axes say", remedy, request.sample_span)
    if request.sample == LATIN_HYPERCUBE and (request.count or 0) > MOST_STRATA:
        message = f"a latin_hypercube sample has at most {MOST_STRATA} points"
        mistakes.wrong("count", message, "choose sobol or random", request.sample_span)
    states = math.prod(axis.count or 1 for axis in request.along)
    if states > MOST_REDUCED:
        message = f"{states} states at each point are more than {MOST_REDUCED}"
        mistakes.wrong("along", message, "vary some of it under `over`, or more coarsely")
    if request.motors and request.path is None:
        remedy = "add --along with the name of a path of the model" if not mistakes.file else "add `along: PATH`"
        message = "motors are sized for a motion, and the study has none"
        mistakes.wrong("size", message, remedy, request.motors_span)
    _check_repeated(mistakes, request)
    if not request.show:
        mistakes.wrong("show", "nothing to show", f"choose from {', '.join(SHOWN)}")
    for level in request.quantiles:
        if not 0 < level < 1:
            message = f"{level:g} is no level between 0 and 1"
            mistakes.wrong("quantiles", message, "write levels such as 0.05,0.95", request.quantiles_span)


def _check_repeated(mistakes: StudyMistakes, request: StudyRequest) -> None:
    seen: set[str] = set()
    for key, axes in (("over", request.over), ("along", request.along)):
        for axis in axes:
            if axis.name in seen:
                mistakes.wrong(key, f"`{axis.name}` is varied twice", "keep one of its ranges", axis.span)
            seen.add(axis.name)
