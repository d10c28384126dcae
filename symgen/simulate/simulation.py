"""The motion of a model: its kernels made and verified, a start on the constraints, integration."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from symgen.drawing.scene import scene
from symgen.generation.rejections import rejected_lines
from symgen.generation.requested import check_known, configuration_near
from symgen.generation.results import Options, Result
from symgen.generation.runnable import Runner
from symgen.mechanics.genericity import configurations, parameter_values
from symgen.mechanics.system import System
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.pipeline import generate
from symgen.simulate.animation import animation
from symgen.simulate.integrate import SimulatedMotion, consistent_start, integrate
from symgen.simulate.plant import QUANTITIES, Plant, PlantError
from symgen.simulate.tables import motion_chart
from symgen.verify.running.compile import find_compiler

Progress = Callable[[str], None]
ACCELERATIONS = "forward_dynamics"
# Seconds of a motion, and frames a second, unless others are asked for.
DURATION, FRAMES = 5.0, 50


@dataclass(frozen=True, slots=True)
class Request:
    """What to simulate: seconds, frames a second, values at the start and constant inputs by name."""

    duration: float
    frames: int
    start: Mapping[str, float]
    inputs: Mapping[str, float]


class NotSimulatedError(Exception):
    """There is no motion: verification rejects a kernel, or there is no consistent start; the text says why."""


@dataclass(frozen=True, slots=True)
class Simulation:
    """A motion of a model with the default values of its `parameters`, and the kernels that were `verified` for it."""

    model: Model
    parameters: Mapping[str, float]
    motion: SimulatedMotion
    verified: Result

    def chart(self) -> str:
        """SVG: coordinates by unit, energies, and the violation of the constraints where there are any."""
        return motion_chart(self.model, self.motion)

    def animation(self) -> str | None:
        """A page of HTML that plays the motion; None for a model without frames."""
        shown = scene(self.model, self.parameters, self.motion.q)
        name = self.model.description or self.model.name
        return None if shown is None else animation(name, self.motion.times, shown)


def simulated(path: Path, request: Request, progress: Progress) -> Simulation:
    """The motion of the model at `path`.  What is integrated has been verified as generated code is.

    Raises ModelError for mistakes in the file, WrongUseError for names that the model does not have, and
    NotSimulatedError.
    """
    model = load_model(path)
    coordinates = {c.name: i for i, c in enumerate(model.coordinates)}
    rates = {c.rate: i for i, c in enumerate(model.coordinates)}
    given = {i.name: k for k, i in enumerate(model.inputs)}
    check_known(model, "start", request.start, [*coordinates, *rates])
    check_known(model, "inputs", request.inputs, [*given])
    q = configuration_near(model, request.start)
    qd = [request.start.get(c.rate, 0.0) for c in model.coordinates]
    u = [request.inputs.get(i.name, 0.0) for i in model.inputs]
    count = max(1, round(request.duration * request.frames))
    times = [request.duration * k / count for k in range(count + 1)]
    mechanics = System(model)
    parameters = parameter_values(mechanics)
    verified = verified_kernels(path, QUANTITIES, progress)
    with tempfile.TemporaryDirectory(prefix="symgen-simulate-") as folder:
        runner = Runner(model, {"float64": verified.programs["float64"]}, Path(folder))
        plant = Plant(model, tuple(parameters[p.name] for p in model.parameters), runner)
        try:
            start = start_on_constraints(plant, mechanics, q, qd, chosen=bool(request.start or model.configuration))
        except PlantError as fault:
            raise NotSimulatedError(f"no consistent start: {fault}") from fault
        motion = integrate(plant, start, u, times, lambda t: progress(f"integrating, {t:.2f} of {times[-1]:g} s"))
    return Simulation(model, parameters, motion, verified)


def verified_kernels(path: Path, quantities: Sequence[str], progress: Progress) -> Result:
    """The kernels that are run, as `symgen` makes and verifies them; NotSimulatedError where one is rejected.

    Without a C compiler the Python is verified, whose bits are those of the interpreter that runs then.
    """
    part = "c" if find_compiler() is not None else "python"
    result = generate(path, Options(outputs=tuple(quantities), scalars=("float64",), parts=(part,)), progress)
    kernels = {kernel.name for kernel in result.programs["float64"].kernels}
    reasons: list[str] = []
    if rejected := rejected_lines(result):
        reasons += ["verification rejects what would be integrated", *rejected]
    elif ACCELERATIONS not in kernels:
        # other quantities may be missing: a system without constraints has no violations of them
        reasons += [notice.message for notice in result.notices if notice.message.startswith(ACCELERATIONS)]
    if reasons:
        raise NotSimulatedError("\n".join((f"not simulated: {reasons[0]}", *reasons[1:])))
    return result


def start_on_constraints(
    plant: Plant, mechanics: System, q: list[float], qd: list[float], chosen: bool
) -> tuple[list[float], list[float]]:
    """The start on the constraints; where nobody chose one, any configuration that satisfies them serves."""
    try:
        return consistent_start(plant, q, qd)
    except PlantError:
        starts = [] if chosen else configurations(mechanics)[:1]
        if not starts:
            raise
        return consistent_start(plant, [starts[0][c.name] for c in plant.model.coordinates], qd)
