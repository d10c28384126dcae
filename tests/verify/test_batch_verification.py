"""Batch and prepared kernels that differ from the plain ones are found, in results, statuses and counts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import shipped
from single_outcomes import alone

from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.backends.defaults import default_values
from symgen.backends.quantities import BATCHED
from symgen.ir.kernel import Program
from symgen.verify.reference.reference import State
from symgen.verify.running.batch import run_batch
from symgen.verify.running.compile import Compilation, find_compiler
from symgen.verify.running.prepared import run_prepared
from symgen.verify.running.sources import generated_sources
from symgen.verify.sampling.states import Sample

pytestmark = pytest.mark.toolchain
NAME = "skate"


def program() -> Program:
    whole = shipped.programs(NAME)["float64"]
    return replace(whole, kernels=tuple(kernel for kernel in whole.kernels if kernel.name in BATCHED))


def complaints(folder: Path, edit: Callable[[str], str]) -> list[str]:
    """What a comparison at three states says after an edit of the batch's files."""
    model, compiler = shipped.model(NAME), find_compiler()
    assert compiler is not None
    files = emit_c(model, program()) | emit_c_batch(model, program()) | emit_c_prepared(model, program())
    source = generated_sources(model, files)[0]["float64"]
    names = [f"{NAME}_{kind}.{ending}" for kind in ("batch", "prepared") for ending in "hc"]
    assert [name for name, _ in source.companions] == names
    edited = replace(source, companions=tuple((name, edit(text)) for name, text in source.companions))
    library = Compilation(compiler, edited, folder).library()
    parameters = tuple(float(value) for value in default_values(model).values())
    n, m = len(model.coordinates), len(model.inputs)
    states = [
        State((a,) * n, (a / 2,) * n, (0.3,) * n, (a - 1,) * m, tuple(scale * x for x in parameters))
        for a, scale in ((0.2, 1.0), (0.7, 1.25), (1.1, 1.0))
    ]
    by_themselves = alone(library, model.name, program().kernels, states)
    samples = [Sample(state, True, (1.0, 1.0)) for state in states]
    outcomes, faults = run_batch(library, model.name, program().kernels, "float64", samples, by_themselves)
    assert set(outcomes) == set(by_themselves)
    header = dict(source.companions)[f"{NAME}_prepared.h"]
    given = library, model.name, program().kernels, "float64", samples, by_themselves
    outcomes, differing = run_prepared(*given, header)
    assert {"forward_dynamics"} <= set(outcomes) < set(by_themselves)
    return [fault.text for fault in faults + differing]


def test_what_is_generated_passes(tool: Callable[[str], str], tmp_path: Path) -> None:
    tool("cc")
    assert complaints(tmp_path, str) == []


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("result[0][k] = ", "result[0][k] = 0.5 * ", "state 0 alone and in a batch differ"),
        ("* stride + start;", "* stride + start + 1;", "state 0 alone and in a batch differ"),
        ("(unsigned char)code", "0", "other status than alone where every input is"),
        ("refused += code != 0;", "", "other status than alone where every input is"),
        ("flags |= bits[k];", "", "other status than alone where every input is"),
        ("prepared.value[0] = ", "prepared.value[0] = 2.0 * ", "at state 0 the plain kernel gives something else"),
        ("return SKATE_ANGLE_RANGE;", "return SKATE_NOT_FINITE;", "other status than the plain kernel's where"),
    ],
)
def test_wrong_batch_kernels_are_found(
    tool: Callable[[str], str], tmp_path: Path, old: str, new: str, complaint: str
) -> None:
    tool("cc")
    messages = complaints(tmp_path, lambda text: text.replace(old, new))
    assert any(complaint in text for text in messages), messages


def of_encoders(folder: Path, edit: Callable[[str], str]) -> set[str]:
    """Of which quantities of encoders a comparison complains after an edit of the batch's files."""
    name, compiler = "five_bar", find_compiler()
    assert compiler is not None
    model, whole = shipped.model(name), shipped.programs(name)["float64"]
    made = replace(whole, kernels=tuple(kernel for kernel in whole.kernels if kernel.name.endswith("_from_measured")))
    source = generated_sources(model, emit_c(model, made) | emit_c_batch(model, made))[0]["float64"]
    edited = replace(source, companions=tuple((file, edit(text)) for file, text in source.companions))
    library = Compilation(compiler, edited, folder).library()
    parameters = tuple(float(value) for value in default_values(model).values())
    q = tuple(float(dict(model.configuration)[coordinate.name]) for coordinate in model.coordinates)
    rates = [(0.2, -0.3, 0.5, 0.1), (-1.0, 0.4, 0.3, 0.6)]
    states = [State(q, qd, qd[::-1], (0.0,) * model.m, parameters) for qd in rates]
    by_themselves = alone(library, name, made.kernels, states)
    assert all(outcome.valid for outcomes in by_themselves.values() for outcome in outcomes)
    samples = [Sample(state, True, (1.0, 1.0)) for state in states]
    outcomes, faults = run_batch(library, name, made.kernels, "float64", samples, by_themselves)
    assert set(outcomes) == {kernel.name for kernel in made.kernels}
    return {fault.quantity for fault in faults}


def test_batches_of_what_is_measured_are_compared_with_values_of_encoders(
    tool: Callable[[str], str], tmp_path: Path
) -> None:
    tool("cc")
    every = {f"{what}_from_measured" for what in ("configuration", "velocity", "acceleration")}
    for number, (old, new, complained) in enumerate(
        [
            ("", "", set()),
            ("result[1][k] = ", "result[1][k] = 0.5 * ", every),
            ("= qd_m + 1 *", "= qd_m + 0 *", every - {"configuration_from_measured"}),
        ]
    ):
        folder = tmp_path / str(number)
        folder.mkdir()
        assert of_encoders(folder, lambda text, old=old, new=new: text.replace(old, new) if old else text) == complained
