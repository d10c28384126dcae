"""Functions with several results that differ from the kernels alone are found: results, statuses, what is stored."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import shipped
from single_outcomes import alone

from symgen.backends.c.plain import emit_c
from symgen.backends.c.together import emit_c_together
from symgen.backends.defaults import default_values
from symgen.ir.pairs.wide import widened
from symgen.model.model import Model
from symgen.verify.reference.reference import State
from symgen.verify.running.compile import Compilation, find_compiler
from symgen.verify.running.several_results import run_several
from symgen.verify.running.sources import generated_sources
from symgen.verify.sampling.states import Sample

pytestmark = pytest.mark.toolchain
GROUP = ("inverse_dynamics", "forward_dynamics", "constraint_jacobian")
FUNCTION = "_".join(GROUP)


def model() -> Model:
    return replace(shipped.model("skate"), together=(GROUP, ("energy", "no_quantity")))


def complaints(folder: Path, edit: Callable[[str], str], wide: str = "") -> list[str]:
    """What a comparison at two states says after an edit of the file; a `wide` kernel works with pairs of numbers."""
    compiler, program = find_compiler(), shipped.programs("skate")["float64"]
    kernels = (widened(kernel, "float64") if kernel.name == wide else kernel for kernel in program.kernels)
    program = replace(program, kernels=tuple(kernels))
    assert compiler is not None
    source = generated_sources(model(), emit_c(model(), program) | emit_c_together(model(), program))[0]["float64"]
    assert [name for name, _ in source.companions] == ["skate_together.h", "skate_together.c"]
    edited = replace(source, companions=tuple((name, edit(text)) for name, text in source.companions))
    library = Compilation(compiler, edited, folder).library()
    parameters = tuple(float(value) for value in default_values(model()).values())
    n, m = len(model().coordinates), len(model().inputs)
    states = [State((a,) * n, (a / 2,) * n, (0.3,) * n, (a - 1,) * m, parameters) for a in (0.2, 0.7)]
    by_themselves = alone(library, model().name, program.kernels, states)
    samples = [Sample(state, True, (1.0, 1.0)) for state in states]
    header = dict(source.companions)["skate_together.h"]
    assert f"skate_{FUNCTION}_together(" in header
    given = library, model(), program.kernels, "float64", samples, by_themselves
    outcomes, faults = run_several(*given, header)
    assert tuple(outcomes) == GROUP
    return [fault.text for fault in faults]


def test_what_is_generated_passes(tool: Callable[[str], str], tmp_path: Path) -> None:
    tool("cc")
    assert complaints(tmp_path, str) == []


@pytest.mark.parametrize("wide", GROUP)
def test_kernels_that_work_with_pairs_and_others_are_merged(
    tool: Callable[[str], str], tmp_path: Path, wide: str
) -> None:
    tool("cc")
    assert complaints(tmp_path, str, wide) == []


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("    qdd_out[1] = ", "    qdd_out[1] = 2.0 * ", "state 0 alone and in one call differ"),
        ("    B[0] = ", "    B[1] = ", "state 0 alone and in one call differ"),
        ("return SKATE_ANGLE_RANGE;", "return SKATE_NOT_FINITE;", "differ where every input is 1e+30"),
        ("return SKATE_ANGLE_RANGE;", "u_out[0] = 1.0; return SKATE_ANGLE_RANGE;", "differ where every input is 1e+30"),
    ],
)
def test_wrong_functions_are_found(
    tool: Callable[[str], str], tmp_path: Path, old: str, new: str, complaint: str
) -> None:
    tool("cc")
    messages = complaints(tmp_path, lambda text: text.replace(old, new))
    assert any(complaint in text for text in messages), messages
