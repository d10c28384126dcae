"""Commands that derive kernels anew take what verification led to, or tell why not."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from wide_record import NAME, recorded

from symgen.cli.main import main
from symgen.generation.acceptance.recorded import as_recorded
from symgen.generation.draft import Draft
from symgen.generation.results import Options
from symgen.generation.runnable import RunnableKernels
from symgen.ir.kernel import Scalar
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.laboratory.bench.candidate import Task
from symgen.laboratory.bench.symgen_kernels import generated, programs_of
from symgen.model.load import load_model

BOTH: tuple[Scalar, ...] = ("float64", "float32")
TASK = Task("forward_dynamics", "u", 3)


def draft_of(path: Path, out: Path | None) -> Draft:
    model = load_model(path)
    return as_recorded(model, model.outputs, Options(measured=out))


def wide(draft: Draft) -> set[tuple[str, Scalar]]:
    kernels = ((kernel, scalar) for scalar, program in draft.programs.items() for kernel in program.kernels)
    return {(kernel.name, scalar) for kernel, scalar in kernels if works_with_pairs(kernel)}


def test_kernels_work_with_twice_the_digits_where_the_record_says_so(tmp_path: Path) -> None:
    path, out = recorded(tmp_path, {"forward_dynamics": ["float32"], "singularity": BOTH})
    draft = draft_of(path, out)
    assert wide(draft) == {("forward_dynamics", "float32"), ("singularity", "float64"), ("singularity", "float32")}
    assert draft.notes == ()
    assert wide(draft_of(path, None)) == set()


def damaged(content: dict[str, Any]) -> str:
    return json.dumps(content)[:-20]


def without_kernels(content: dict[str, Any]) -> str:
    return json.dumps({key: value for key, value in content.items() if key != "kernels"})


def of_another_text(content: dict[str, Any]) -> str:
    return json.dumps(content | {"model_sha256": "0"})


def of_another_version(content: dict[str, Any]) -> str:
    return json.dumps(content | {"symgen": "0.0.1"})


@pytest.mark.parametrize(
    ("spoilt", "why"),
    [
        (damaged, "is damaged"),
        (without_kernels, "is damaged"),
        (of_another_text, "is of another text of the model"),
        (of_another_version, "is of symgen 0.0.1"),
        (None, "is missing"),
    ],
)
def test_a_record_that_is_of_no_use_is_told(
    tmp_path: Path, spoilt: Callable[[dict[str, Any]], str] | None, why: str
) -> None:
    path, out = recorded(tmp_path, {"forward_dynamics": BOTH})
    file = out / NAME / "derivation.json"
    if spoilt is None:
        file.unlink()
    else:
        file.write_text(spoilt(json.loads(file.read_bytes())))
    draft = draft_of(path, out)
    (note,) = draft.notes
    assert f"{file} {why}" in note
    assert "derivation chooses" in note
    assert not wide(draft)


def test_files_are_made_as_recorded_in_another_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = recorded(tmp_path, {"forward_dynamics": ["float32"]})
    other = tmp_path / "other"
    assert main([str(path), "--only", "c,package", "--recorded", str(out), "--out", str(other)]) == 0
    assert "derivation.json" not in capsys.readouterr().err
    assert f"{NAME}_steps_f" in (other / NAME / "c" / f"{NAME}_f.c").read_text()
    assert f"{NAME}_steps" not in (other / NAME / "c" / f"{NAME}.c").read_text()
    page = (other / NAME / "package" / "README.md").read_text()
    assert "With twice the digits in float, which takes ten to thirty times as long: `forward_dynamics`." in page
    assert "digits in double" not in page
    assert main([str(path), "--only", "c", "--recorded", str(tmp_path / "none"), "--out", str(other)]) == 0
    assert "derivation.json is missing: kernels are those that derivation chooses" in capsys.readouterr().err


def test_what_verification_left_out_is_left_out_and_told(tmp_path: Path) -> None:
    path, out = recorded(tmp_path, {}, {"forward_dynamics": ["float32"], "singularity": BOTH})
    draft = draft_of(path, out)
    names = {scalar: {kernel.name for kernel in program.kernels} for scalar, program in draft.programs.items()}
    assert names == {"float64": {"inverse_dynamics", "forward_dynamics"}, "float32": {"inverse_dynamics"}}
    notes = "\n".join(draft.notes)
    assert "forward_dynamics is left out in float32" in notes
    assert "singularity is left out in float64 and float32" in notes


def test_stress_takes_the_record(tmp_path: Path) -> None:
    path, out = recorded(tmp_path, {"forward_dynamics": ["float32"]}, {"inverse_dynamics": ["float32"]})
    kernels = RunnableKernels(load_model(path), tmp_path, out=out)
    assert works_with_pairs(kernels.kernel("forward_dynamics", "float32"))
    assert not works_with_pairs(kernels.kernel("forward_dynamics", "float64"))
    assert "inverse_dynamics" not in kernels.names
    assert any("inverse_dynamics is left out in float32" in note for note in kernels.notes)


def test_bench_measures_the_kernel_that_is_generated_beside_the_plain_one(tmp_path: Path) -> None:
    path, out = recorded(tmp_path, {"forward_dynamics": ["float32"]})
    model = load_model(path)
    programs = programs_of(model, TASK, BOTH, generated(model, TASK, BOTH, out))
    first, *others = programs.items()
    assert first[0].endswith(", with twice the digits in float32")
    assert works_with_pairs(first[1]["float32"].kernels[0])
    assert not any(works_with_pairs(program["float32"].kernels[0]) for _, program in others)


def test_explain_tells_what_verification_led_to(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = recorded(tmp_path, {"forward_dynamics": ["float32"]})
    assert main(["explain", str(path), "forward_dynamics", "--out", str(out)]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "with twice the digits in float32: verification speaks against" in said
    assert main(["explain", str(path), "forward_dynamics", "--out", str(tmp_path / "none")]) == 0
    assert "derivation.json is missing" in " ".join(capsys.readouterr().out.split())
