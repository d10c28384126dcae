"""`symgen simulate` for one model: start, integrate, write CSV, chart and animation."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from symgen.generation.results import Options, Result, WrongUseError
from symgen.generation.runnable import Runner
from symgen.mechanics.genericity import configurations, parameter_values
from symgen.mechanics.system import System
from symgen.model.expressions.names import did_you_mean
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.output.write import write_files
from symgen.pipeline import generate
from symgen.simulate.animation import animation
from symgen.simulate.integrate import SimulatedMotion, consistent_start, integrate
from symgen.simulate.plant import QUANTITIES, Plant, PlantError
from symgen.simulate.scene import scene
from symgen.simulate.tables import motion_chart, motion_csv
from symgen.verify.running.compile import find_compiler
from symgen.verify.tolerance import FACTOR

Progress = Callable[[str], None]
# What a coordinate changes by at most where it stands still.
STILL = 1e-9
ACCELERATIONS = "forward_dynamics"


@dataclass(frozen=True, slots=True)
class Request:
    """What to simulate: seconds, frames a second, values at the start and constant inputs by name."""

    duration: float
    frames: int
    start: Mapping[str, float]
    inputs: Mapping[str, float]


def run_simulate(path: Path, out: Path, request: Request, quiet: bool, progress: Progress) -> int:
    """Writes simulation.csv, .svg and, for a model with frames, .html into OUT/<model>/; 0, or 1 where it stopped.

    What is integrated has been verified as generated code is; what verification rejects is not integrated.

    Raises ModelError for mistakes in the file and WrongUseError for names that the model does not have.
    """
    model = load_model(path)
    coordinates = {c.name: i for i, c in enumerate(model.coordinates)}
    rates = {c.rate: i for i, c in enumerate(model.coordinates)}
    given = {i.name: k for k, i in enumerate(model.inputs)}
    _known(path, "start", request.start, [*coordinates, *rates])
    _known(path, "inputs", request.inputs, [*given])
    declared = {name: float(value) for name, value in model.configuration}
    q = [request.start.get(c.name, declared.get(c.name, float(sum(c.range)) / 2)) for c in model.coordinates]
    qd = [request.start.get(c.rate, 0.0) for c in model.coordinates]
    u = [request.inputs.get(i.name, 0.0) for i in model.inputs]
    count = max(1, round(request.duration * request.frames))
    times = [request.duration * k / count for k in range(count + 1)]
    mechanics = System(model)
    parameters = parameter_values(mechanics)
    verified = _verified(path, progress)
    if verified is None:
        return 1
    with tempfile.TemporaryDirectory(prefix="symgen-simulate-") as folder:
        runner = Runner(model, {"float64": verified.programs["float64"]}, Path(folder))
        plant = Plant(model, tuple(parameters[p.name] for p in model.parameters), runner)
        try:
            start = _start(plant, mechanics, q, qd, chosen=bool(request.start or declared))
        except PlantError as fault:
            progress("")
            print(f"{path}: no consistent start: {fault}", file=sys.stderr)
            return 1
        motion = integrate(plant, start, u, times, lambda t: progress(f"integrating, {t:.2f} of {times[-1]:g} s"))
    progress("drawing")
    files = {"simulation.csv": motion_csv(model, motion), "simulation.svg": motion_chart(model, motion)}
    shown = scene(model, parameters, motion.q)
    if shown is not None:
        files["simulation.html"] = animation(model.description or model.name, motion.times, shown)
    progress("")
    written = write_files(out / model.name, files)
    if not quiet:
        lines = [*_summary(model, motion), _checked(verified), "written:"]
        print(*lines, *(f"  {file}" for file in written), "", sep="\n")
    if motion.stopped is not None:
        print(f"{path}: stopped {motion.stopped}", file=sys.stderr)
        return 1
    return 0


def _verified(path: Path, progress: Progress) -> Result | None:
    """The kernels that are integrated, as `symgen` makes and verifies them; None, told why, where one is rejected.

    Without a C compiler the Python is verified, whose bits are those of the interpreter that runs then.
    """
    part = "c" if find_compiler() is not None else "python"
    result = generate(path, Options(outputs=QUANTITIES, scalars=("float64",), parts=(part,)), progress)
    kernels = {kernel.name for kernel in result.programs["float64"].kernels}
    found: list[str] = []
    if result.failures or result.left_out:
        found.append("verification rejects what would be integrated")
        found += [f"  {failure}" for failure in result.failures]
        for one in result.left_out:
            found += [f"  {one.quantity}, {method}: {why}" for method, why in one.tried]
            found.append(f"  {one.quantity}: remedy: {one.remedy}")
    elif ACCELERATIONS not in kernels:
        # other quantities may be missing: a system without constraints has no violations of them
        found += [notice.message for notice in result.notices if notice.message.startswith(ACCELERATIONS)]
    if not found:
        return result
    progress("")
    print(f"{path}: not simulated: {found[0]}", *found[1:], sep="\n", file=sys.stderr)
    return None


def _checked(result: Result) -> str:
    """What was verified, for the summary."""
    errors = [error.error for error in result.summary.errors]
    states = 0 if result.certificate is None else result.certificate["states"]
    return f"  verified at {states} states, off by {max(errors, default=0.0):.2g} units of {FACTOR} allowed"


def _start(
    plant: Plant, mechanics: System, q: list[float], qd: list[float], chosen: bool
) -> tuple[list[float], list[float]]:
    """The start on the constraints; where nobody chose one, any configuration that satisfies them serves."""
    try:
        return consistent_start(plant, q, qd)
    except PlantError:
        found = [] if chosen else configurations(mechanics, 1)
        if not found:
            raise
        return consistent_start(plant, [found[0][c.name] for c in plant.model.coordinates], qd)


def _known(path: Path, option: str, values: Mapping[str, float], names: list[str]) -> None:
    for name in values:
        if name not in names:
            remedy = did_you_mean(name, names, f"the model has {', '.join(names) or 'none'}")
            raise WrongUseError(f"{path}: --{option}: unknown name {name!r}; {remedy}")


def _summary(model: Model, motion: SimulatedMotion) -> list[str]:
    totals = [t + u for t, u in motion.energy]
    scale = max(max(abs(t), abs(u)) for t, u in motion.energy) or 1.0
    gained = totals[-1] - totals[0]
    lines = [
        f"{model.name}: {motion.times[-1]:g} s in {len(motion.times)} frames",
        f"  energy gained           {gained: .3e}, {abs(gained) / scale:.1e} of the largest",
        f"  constraints violated by {max(motion.residual): .1e} at most",
    ]
    if all(max(curve) - min(curve) < STILL for curve in zip(*motion.q, strict=True)):
        lines.append("  nothing moves: give rates or another place with --start, or --inputs")
    if not model.mechanism.frames:
        lines.append("  no animation: the model has no frames")
    return lines
