"""A million steps of computed-torque tracking with the generated C: does anything drift?

The reference is a path of the model, repeated.  Inputs come from `inverse_dynamics` and are held over a step, the plant
is `forward_dynamics` integrated by Runge-Kutta's method of order 4, once as it is and once with the projections of
Remark 9 (`projected_configuration`, `admissible_velocity`) after every step.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path as FilePath

import numpy as np

from symgen.backends.render import render
from symgen.generation.runnable import RunnableKernels
from symgen.model.model import Model, Path
from symgen.paths.path_equations import PathError
from symgen.paths.trajectory import solve_path
from symgen.runtime import processes
from symgen.runtime.processes import ToolError
from symgen.verify.reference.reference import Reference

STEPS_PER_LAP = 10_000
NODES = 1001
RECORDS = 200
BANDWIDTH = 20.0  # of the controller, in rad per lap-time unit: critically damped
NEEDED = ("inverse_dynamics", "forward_dynamics", "control_matrix", "applied_force", "energy")
LONGEST_SECONDS = LONGEST_COMPILATION = 300.0


@dataclass(frozen=True, slots=True)
class LongRun:
    """Records over a run: time in s, and the largest since the record before of |g|, |B q̇|, |q − q_ref|, and of the
    energy that neither inputs nor applied forces account for (in J); `complaint` where it ended early.
    """

    path: str
    projected: bool
    steps: int
    time: tuple[float, ...]
    position_drift: tuple[float, ...]
    rate_drift: tuple[float, ...]
    tracking: tuple[float, ...]
    energy: tuple[float, ...]
    complaint: str


def long_runs(
    reference: Reference, kernels: RunnableKernels, folder: FilePath, steps: int
) -> tuple[tuple[LongRun, ...], str]:
    """Both runs along the first path of a model, and why there are none."""
    model = reference.model
    if not model.paths:
        return (), "the model has no path"
    if kernels.compiler is None:
        return (), "there is no C compiler"
    if reference.ranks.actuation < model.n - reference.ranks.constraints or any(n not in kernels.names for n in NEEDED):
        return (), "the inputs do not determine the motion"
    path = model.paths[0]
    try:
        table = _table(model, path)
    except PathError as error:
        return (), str(error)
    program = _built(model, path, kernels, folder)
    (folder / "table.bin").write_bytes(table.tobytes())
    return tuple(_run(program, folder / "table.bin", path.name, steps, projected) for projected in (False, True)), ""


def _table(model: Model, path: Path) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """q, q̇, q̈ at equal times over one lap (nodes × 3 × n)."""
    lap = solve_path(model, replace(path, samples=NODES))
    return np.ascontiguousarray(np.stack([lap.q, lap.qd, lap.qdd], axis=1), dtype=np.float64)


def _built(model: Model, path: Path, kernels: RunnableKernels, folder: FilePath) -> FilePath:
    assert kernels.compiler is not None
    stem = model.c_name
    period = float(path.duration)
    view = {
        "stem": stem,
        "model": model.c_name,
        "n": model.n,
        "m": model.m,
        "r": model.r,
        "r_g": sum(row.kind == "geometric" for row in model.constraints),
        "nodes": NODES,
        "records": RECORDS,
        "period": repr(period),
        "steps_per_lap": STEPS_PER_LAP,
        "bandwidth": repr(BANDWIDTH / period),
    }
    (folder / "long_run.c").write_text(render("stress/long_run.c.jinja", view), encoding="utf-8")
    target = folder / "long_run"
    flags = ("-std=c99", "-O2", "-ffp-contract=off")
    sources = (str(folder / "long_run.c"), str(folder / f"{stem}.c"))
    result = processes.run([*kernels.compiler.command, *flags, "-o", str(target), *sources, "-lm"], LONGEST_COMPILATION)
    if result.returncode or not target.is_file():
        raise ToolError(f"{kernels.compiler.command[0]} makes no program: {result.stderr.strip()[:2000]}")
    return target


def _run(program: FilePath, table: FilePath, path: str, steps: int, projected: bool) -> LongRun:
    command = [str(program), str(table), str(steps), str(int(projected))]
    try:
        done = processes.run(command, LONGEST_SECONDS)
        output, complaint = done.stdout, done.stderr.strip()
    except ToolError as error:
        output, complaint = "", str(error)
    rows = [tuple(map(float, line.split())) for line in output.splitlines()]
    time, drift, slip, tracking, energy = zip(*rows, strict=True) if rows else ((),) * 5
    return LongRun(path, projected, steps, time, drift, slip, tracking, energy, complaint)


def complaints(runs: tuple[LongRun, ...]) -> tuple[str, ...]:
    """What ended a run early, or left it without finite numbers."""
    sentences = [f"long run along {run.path}: {run.complaint}" for run in runs if run.complaint]
    for run in runs:
        values = (*run.position_drift, *run.rate_drift, *run.tracking, *run.energy)
        if not run.complaint and not np.all(np.isfinite(values)):
            sentences.append(f"long run along {run.path}: numbers that are not finite")
    return tuple(sentences)
