"""An arm with limits, a task and a path, and studies of it whose kernels are not verified: that takes seconds."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from study_packages import dask, xarray

from symgen.backends.python.module import emit_python
from symgen.generation.results import Options, Result
from symgen.ir.kernel import Scalar
from symgen.model.load import load_model
from symgen.pipeline import generate
from symgen.study.asked.options import request_of
from symgen.study.asked.request import check_request
from symgen.study.chunks import chunk_grid
from symgen.study.kernels import StudyKernels, kernels_hash
from symgen.study.plan import StudyPlan, planned_study
from symgen.study.shown.summary import settings_of
from symgen.study.states import StudyStates
from symgen.study.store import StudyStore
from symgen.study.work import StudyWork
from symgen.verify.running.python_module import PythonModule

ARM = """model: arm
description: Planar arm with a third drive across both joints
coordinates:
  a: {unit: rad, range: [-2, 2]}
  b: {unit: rad, range: [0.3, 2.5]}
parameters:
  m: {value: 2, unit: kg, description: mass at the tip, range: [0.5, 8]}
  l: {value: 0.5, unit: m, description: length of both links, range: [0.3, 0.8]}
  g: {value: 9.81, unit: m/s**2}
  u_max: {value: 40, unit: N*m}
  u_min: {value: -40, unit: N*m}
definitions:
  tip_x: l*cos(a) + l*cos(a + b)
  tip_y: l*sin(a) + l*sin(a + b)
kinetic_energy: m*l**2/2*(a_dot**2 + (a_dot + b_dot)**2 + 2*cos(b)*a_dot*(a_dot + b_dot)) + a_dot**2/20 + b_dot**2/20
potential_energy: m*g*tip_y
inputs:
  u_1: {unit: N*m, acts_on: {a: 1}}
  u_2: {unit: N*m, acts_on: {b: 1}}
  u_3: {unit: N*m, acts_on: {a: cos(b), b: 1}}
allocation:
  limits: {u_1: [u_min, u_max], u_2: [u_min, u_max], u_3: [u_min, u_max]}
task: {x: tip_x, y: tip_y}
configuration: {a: -0.5, b: 1.2}
outputs: [inverse_dynamics]
paths:
  swing:
    duration: 1
    samples: 41
    conditions: {of_a: a + 0.5 - 0.4*sin(2*pi*t), of_b: "b - 1.2 - l*sin(2*pi*t)"}
"""
SHIPPED = Path(__file__).parents[2] / "models"


@cache
def arm_file() -> Path:
    """The model file."""
    path = Path(mkdtemp(prefix="symgen-test-")) / "arm.yaml"
    path.write_text(ARM, encoding="utf-8")
    return path


@cache
def _result(model: Path, kernels: tuple[str, ...], scalars: tuple[Scalar, ...] = ("float64",)) -> Result:
    options = Options(outputs=kernels, scalars=scalars, parts=("c",), verify=False)
    return generate(model, options, lambda _: None)


def result_of(plan: StudyPlan) -> Result:
    """The C of a plan's kernels."""
    return _result(plan.request.model, plan.kernels, plan.scalars)


@cache
def _compiled(model: Path, kernels: tuple[str, ...], scalars: tuple[Scalar, ...] = ("float64",)) -> StudyKernels:
    return StudyKernels(_result(model, kernels, scalars))


def plan_of(
    over: list[str], show: str, model: Path | None = None, along: tuple[str, ...] = (), **more: Any
) -> StudyPlan:
    """The plan of a study asked for by options."""
    asked = {"sample": None, "count": None, "seed": None, "quantiles": (), "size": None, **more}
    request, mistakes = request_of(model or arm_file(), over, along, show.split(","), **asked)
    check_request(mistakes, request)
    return planned_study(load_model(request.model), request, mistakes)


def study_of(folder: Path, plan: StudyPlan) -> StudyWork:
    """Work on a plan, begun in a folder."""
    result, kernels = (make(plan.request.model, plan.kernels, plan.scalars) for make in (_result, _compiled))
    chunks = chunk_grid(plan)
    store = StudyStore(folder, plan, chunks)
    store.begin(settings_of(plan, kernels_hash(result)), {})
    return StudyWork(plan, chunks, StudyStates(plan, kernels), kernels, store)


def results_of(folder: Path, plan: StudyPlan) -> Any:
    """The results of a plan, all chunks worked out one after the other: an xarray Dataset in memory."""
    work = study_of(folder, plan)
    for number in range(len(work.chunks)):
        assert work.work(number).failure is None
    work.store.finish(folder.parent / "study.zarr", {})
    with opened(folder.parent / "study.zarr") as results:
        return results.load()


def opened(folder: Path) -> Any:
    """Results as users open them."""
    return xarray.open_zarr(folder)


def threads(number: int) -> Any:
    """A context with so many threads."""
    return dask.config.set(num_workers=number)


@cache
def python_kernels(kernels: tuple[str, ...], model: Path | None = None) -> Any:
    """The generated Python module of the same kernels."""
    result = _result(model or arm_file(), kernels)
    return PythonModule(next(iter(emit_python(result.model, result.programs["float64"]).values()))).module


def tree(folder: Path) -> dict[str, bytes]:
    """All files below a folder with their content."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}
