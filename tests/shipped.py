"""The shipped models, derived and emitted once for each test process."""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from _pytest.mark import ParameterSet

from symgen.backends.backend import backend
from symgen.generation.results import Options, Result
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.lowering.schedule import schedule
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.pipeline import generate
from symgen.quantities.select import Selection, derive_quantities
from symgen.registered import USUAL

ROOT = Path(__file__).resolve().parent.parent
ALL = tuple(sorted(path.stem for path in (ROOT / "models").glob("*.yaml")))
# Given by energies: what compiles, sweeps or mutates every kernel takes these.  Those given by bodies go the same way
# from the derivation on, are verified when generated/ is made, and have tests/mechanisms.
NAMES = (
    "double_pendulum",
    "front_car",
    "front_car_wheelset",
    "rapkm_2rrr_rr",
    "rapkm_two_drives",
    "rear_car",
    "skate",
    "slider_crank",
)
# Both parallel robots have the same links: what looks at every kernel, statement by statement, takes the one with more
# inputs.  Their bits and values are compared with the reference when generated/ is made.
SWEPT = tuple(name for name in NAMES if name != "rapkm_two_drives")
SCALARS: tuple[Scalar, ...] = ("float64", "float32")
LONG = 500  # statements
# Kernels of parallel robots take as long as those of all others, and are made of the same statements.
LONGEST = ("rapkm_2rrr_rr", "rapkm_two_drives")


def sparing(names: Iterable[str], beyond: Container[str] = LONGEST) -> list[ParameterSet]:
    """Names as parameters of tests; those `beyond` are members of the campaign of tests."""
    return [pytest.param(name, marks=pytest.mark.campaign if name in beyond else ()) for name in names]


@cache
def model(name: str) -> Model:
    return load_model(ROOT / "models" / f"{name}.yaml")


@cache
def derivations(name: str) -> Selection:
    return derive_quantities(model(name), model(name).outputs)


@cache
def programs(name: str) -> dict[Scalar, Program]:
    return schedule(derivations(name).mechanics, derivations(name).quantities, SCALARS)


@cache
def short(name: str, scalar: Scalar) -> Program:
    """Without the longest kernels, for tests that run every statement: they are made of what is in the others, too."""
    whole = programs(name)[scalar]
    kernels = tuple(kernel for kernel in whole.kernels if len(kernel.statements) < LONG)
    assert operations(kernels) == operations(whole.kernels)
    return replace(whole, kernels=kernels)


def operations(kernels: Sequence[Kernel]) -> set[str]:
    return {statement.operation for kernel in kernels for statement in kernel.statements}


@cache
def sources(name: str) -> dict[str, str]:
    files: dict[str, str] = {}
    for made in map(backend, USUAL):
        for program in made.programs(programs(name), SCALARS):
            for variant in made.variants:
                files |= variant.emit(model(name), program)
    return files


def write_sources(name: str, folder: Path) -> None:
    """C and Python of a model under `folder`."""
    for path, text in sources(name).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)


def made(name: str, *parts: str) -> Result:
    """A run without measurements; what verification rejected is taken from the record."""
    options = Options(verify=False, as_recorded=True, measured=ROOT / "generated")
    options = replace(options, parts=parts) if parts else options
    return generate(ROOT / "models" / f"{name}.yaml", options, lambda _: None)
