"""`symgen simulate` for one model: CSV, chart and animation of its motion."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from symgen.generation.results import Result
from symgen.model.model import Model
from symgen.output.write import write_files
from symgen.simulate.drive_log import drive_log_csv
from symgen.simulate.following import followed
from symgen.simulate.integrate import SimulatedMotion
from symgen.simulate.simulation import NotSimulatedError, Request, simulated
from symgen.simulate.tables import motion_csv
from symgen.simulate.tracking import ControlLoop
from symgen.simulate.tracking_tables import tracking_csv, tracking_summary
from symgen.verify.tolerance import FACTOR

Progress = Callable[[str], None]
# What a coordinate changes by at most where it stands still.
STILL = 1e-9


def run_simulate(path: Path, out: Path, request: Request, quiet: bool, progress: Progress) -> int:
    """Writes simulation.csv, .svg and, for a model with frames, .html into OUT/<model>/; 0, or 1 where it stopped.

    Raises ModelError for mistakes in the file and WrongUseError for names that the model does not have.
    """
    try:
        made = simulated(path, request, progress)
    except NotSimulatedError as reason:
        progress("")
        print(f"{path}: {reason}", file=sys.stderr)
        return 1
    progress("drawing")
    model, motion = made.model, made.motion
    files = {"simulation.csv": motion_csv(model, motion), "simulation.svg": made.chart()}
    if (page := made.animation()) is not None:
        files["simulation.html"] = page
    _written(out / model.name, files, [*_summary(model, motion), _checked(made.verified)], quiet, progress)
    return _stopped(path, motion)


def run_tracking(
    path: Path, out: Path, loop: ControlLoop, frames: int, start: Mapping[str, float], quiet: bool, progress: Progress
) -> int:
    """Writes tracking.csv, .svg, log.csv and, where there are frames, .html into OUT/<model>/; 0, or 1 if it stopped.

    Raises ModelError for mistakes in the file and WrongUseError for names that the model does not have.
    """
    try:
        made = followed(path, loop, frames, start, progress)
    except NotSimulatedError as reason:
        progress("")
        print(f"{path}: {reason}", file=sys.stderr)
        return 1
    progress("drawing")
    motion = made.tracked.motion
    files = {"tracking.csv": tracking_csv(made.model, made.tracked), "tracking.svg": made.chart()}
    files["log.csv"] = drive_log_csv(made.model, made.tracked.log)
    if (page := made.animation()) is not None:
        files["tracking.html"] = page
    lines = [*tracking_summary(made.model, made.tracked), _checked(made.verified)]
    _written(out / made.model.name, files, lines, quiet, progress)
    return _stopped(path, motion)


def _written(folder: Path, files: Mapping[str, str], summary: Sequence[str], quiet: bool, progress: Progress) -> None:
    """Writes the files, and prints a summary and their names."""
    progress("")
    written = write_files(folder, files)
    if not quiet:
        print(*summary, "written:", *(f"  {file}" for file in written), "", sep="\n")


def _stopped(path: Path, motion: SimulatedMotion) -> int:
    """The exit code, with why a motion ended early."""
    if motion.stopped is None:
        return 0
    print(f"{path}: stopped {motion.stopped}", file=sys.stderr)
    return 1


def _checked(result: Result) -> str:
    """What was verified, for the summary."""
    errors = [error.error for error in result.summary.errors]
    states = 0 if result.certificate is None else result.certificate["states"]
    return f"  verified at {states} states, off by {max(errors, default=0.0):.2g} units of {FACTOR} allowed"


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
    if not model.pictured.frames:
        lines.append("  no animation: the model has no frames")
    return lines
