"""A model that follows one of its paths: kernels made and verified, the plan, the controller, the motion."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from symgen.drawing.scene import scene
from symgen.generation.requested import check_known
from symgen.generation.results import Result, WrongUseError
from symgen.generation.runnable import Runner
from symgen.linearization.linear_system import NotLinearizedError, linearized
from symgen.linearization.regulator import regulator
from symgen.mechanics.genericity import parameter_values
from symgen.mechanics.system import System
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.paths.path_equations import PathError
from symgen.paths.trajectory import PathSolver
from symgen.simulate.animation import animation
from symgen.simulate.controllers import (
    COMPUTED_TORQUE,
    LQR,
    NEEDED,
    Array,
    ComputedTorque,
    Controller,
    ModelKernels,
    Planned,
    ProportionalDerivative,
    Regulated,
)
from symgen.simulate.plant import QUANTITIES, Plant, PlantError
from symgen.simulate.simulation import NotSimulatedError, start_on_constraints, verified_kernels
from symgen.simulate.tracking import ControlLoop, Encoders, TrackedMotion, tracked
from symgen.simulate.tracking_tables import tracking_chart

Progress = Callable[[str], None]
MEASURED = ("configuration_from_measured", "velocity_from_measured")


@dataclass(frozen=True, slots=True)
class Following:
    """A model that followed a path, with the parameters of the machine, and the kernels that were `verified` for it."""

    model: Model
    parameters: Mapping[str, float]
    tracked: TrackedMotion
    verified: Result

    def chart(self) -> str:
        """SVG: errors by unit, and the inputs."""
        return tracking_chart(self.model, self.tracked)

    def animation(self) -> str | None:
        """A page of HTML that plays the motion, with the planned one drawn; None for a model without frames."""
        shown = scene(self.model, self.parameters, self.tracked.motion.q)
        if shown is None:
            return None
        planned = scene(self.model, self.parameters, self.tracked.planned)
        name = self.model.description or self.model.name
        return animation(name, self.tracked.motion.times, shown, planned)


class PlannedPath:
    """What a path of a model is at times that grow."""

    def __init__(self, model: Model, name: str) -> None:
        (path,) = (path for path in model.paths if path.name == name)
        self.duration = float(path.duration)
        self._solver = PathSolver(model, path)
        self._time, self._q = 0.0, self._solver.start()
        self._rates = self._solver.derivatives(self._q, 0.0)

    def __call__(self, time: float) -> Planned:
        """q, q_dot and q_ddot; raises PathError where the path has no solution."""
        if time > self._time:
            self._q = self._solver.follow(self._q, self._time, time, self._rates)
            self._time, self._rates = time, self._solver.derivatives(self._q, time)
        return Planned(self._q, *self._rates)


def followed(
    path: Path, loop: ControlLoop, frames: int, start: Mapping[str, float], progress: Progress
) -> Following:
    """The motion of the model at `path` under control.  What is integrated and what controls has been verified.

    Raises ModelError for mistakes in the file, WrongUseError for names that the model does not have or a controller
    that it cannot have, and NotSimulatedError.
    """
    model = load_model(path)
    names = [one.name for one in model.paths]
    if not names:
        raise WrongUseError(f"{model.name} has no `paths` to track; write one in the model file")
    check_known(model, "track", [loop.path], names)
    check_known(model, "start", start, [name for c in model.coordinates for name in (c.name, c.rate)])
    check_known(model, "machine", loop.machine, [p.name for p in model.parameters])
    if not model.m:
        raise WrongUseError(f"{model.name} has no inputs to follow a path with")
    parameters = parameter_values(System(model))
    of_machine = {**parameters, **loop.machine}
    encoders = MEASURED if model.measured and len(model.measured) < model.n else ()
    verified = verified_kernels(path, (*QUANTITIES, *NEEDED[loop.controller], *encoders), progress)
    with tempfile.TemporaryDirectory(prefix="symgen-track-") as folder:
        runner = Runner(model, {"float64": verified.programs["float64"]}, Path(folder))
        plant = Plant(model, tuple(of_machine[p.name] for p in model.parameters), runner)
        known = ModelKernels(model, tuple(parameters[p.name] for p in model.parameters), runner)
        try:
            plan = PlannedPath(model, loop.path)
            first = plan(0.0)
            place = [start.get(c.name, x) for c, x in zip(model.coordinates, first.q.tolist(), strict=True)]
            rates = [start.get(c.rate, x) for c, x in zip(model.coordinates, first.qd.tolist(), strict=True)]
            begin = start_on_constraints(plant, System(model), place, rates, chosen=True)
            controller = _controller(model, known, loop, first.q)
            count = max(1, round(plan.duration * frames))
            times = [plan.duration * k / count for k in range(count + 1)]
            made = tracked(
                plant, begin, plan, controller, Encoders(known, loop, np.array(begin[0])), loop, times,
                lambda t: progress(f"tracking, {t:.2f} of {times[-1]:g} s"),
            )  # fmt: skip
        except (PlantError, PathError, NotLinearizedError) as fault:
            raise NotSimulatedError(f"not tracked: {fault}") from fault
    return Following(model, of_machine, made, verified)


def _controller(model: Model, known: ModelKernels, loop: ControlLoop, start: Array) -> Controller:
    if loop.controller == COMPUTED_TORQUE:
        return ComputedTorque(known, loop.bandwidth)
    if loop.controller == LQR:
        system = linearized(model, dict(zip((c.name for c in model.coordinates), start.tolist(), strict=True)))
        gains = regulator(system, *loop.weights)
        return Regulated(system.u, gains.of_places, gains.of_rates)
    return ProportionalDerivative(known, loop.bandwidth, start)
