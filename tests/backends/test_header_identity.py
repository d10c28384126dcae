"""What headers say of their model: sizes, places, version and hash, and the meaning of statuses."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import handmade
import pytest

from symgen import __version__
from symgen.backends.about import status_meaning, statuses_of
from symgen.backends.c.identity import identity_view
from symgen.backends.c.names import status_name
from symgen.backends.c.plain import emit_c
from symgen.model.load import load_model
from symgen.model.model import Model

MODELS = Path(__file__).parents[2] / "models"
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")


def _headers(model: Model, folder: Path) -> None:
    for scalar in ("float64", "float32"):
        for path, text in emit_c(model, handmade.program(scalar)).items():
            (folder / Path(path).name).write_text(text)


def _printed(tool: Callable[[str], str], folder: Path, lines: list[str], compiler: str, standard: str) -> list[str]:
    """What a program prints that includes both headers of `toy`."""
    ending = "cpp" if compiler == "g++" else "c"
    statements = "\n".join(f"    puts({line});" if line.startswith('"') or "text" in line else line for line in lines)
    headers = "".join(f"#include {name}\n" for name in ('"toy.h"', '"toy_f.h"', "<stdio.h>"))
    (folder / f"main.{ending}").write_text(f"{headers}int main(void) {{\n{statements}\n    return 0;\n}}\n")
    command = [tool(compiler), f"-std={standard}", *STRICT, "-o", folder / "main", folder / f"main.{ending}"]
    subprocess.run(command, check=True)
    return subprocess.run([folder / "main"], check=True, capture_output=True, text=True).stdout.splitlines()


@pytest.mark.slow
@pytest.mark.parametrize(("compiler", "standard"), [("gcc", "c99"), ("g++", "c++11")])
def test_a_program_asks_the_header_for_places_and_meanings(
    compiler: str, standard: str, tmp_path: Path, tool: Callable[[str], str]
) -> None:
    model = handmade.model()
    _headers(model, tmp_path)
    numbers = ["TOY_SIZE_Q", "TOY_Q_X", "TOY_Q_THETA", "TOY_SIZE_U", "TOY_U_F"]
    lines = [f'    printf("%d\\n", (int){name});' for name in numbers]
    lines += [f"toy_status_text({status_name(model, status)})" for status in statuses_of(model)]
    # 7 is none of its statuses
    lines += ['"" TOY_SYMGEN_VERSION', '"" TOY_MODEL_HASH', "toy_status_text((toy_status)7)"]
    expected = ["2", "0", "1", "1", "0", *(status_meaning(status, model) for status in statuses_of(model))]
    expected += [__version__, model.text_hash, "no status of this model"]
    assert _printed(tool, tmp_path, lines, compiler, standard) == expected


def test_names_that_are_the_same_in_capitals_stay_as_they_are() -> None:
    model = handmade.model(coordinates=tuple(map(handmade.coordinate, ("x", "X", "y"))))
    (places, _) = identity_view(model).places
    assert [name for name, _, _ in places.entries] == ["TOY_Q_x", "TOY_Q_X", "TOY_Q_Y"]


def test_multipliers_measured_coordinates_and_tasks_have_places_in_their_order() -> None:
    view = identity_view(load_model(MODELS / "rapkm_2rrr_rr.yaml"))
    by_size = {one.size.rsplit("_", 1)[1]: [name for name, _, _ in one.entries] for one in view.places}
    assert {letter: len(names) for letter, names in by_size.items()} == {"Q": 6, "U": 3, "LAMBDA": 4, "QM": 3, "XT": 2}
    assert by_size["LAMBDA"][0] == "RAPKM_2RRR_RR_LAMBDA_LOOP_12_X"
    assert by_size["QM"] == [f"RAPKM_2RRR_RR_QM_A_{k}" for k in (1, 2, 3)]


def test_a_parameter_that_is_called_like_a_macro_of_the_header_has_another_name_in_c() -> None:
    parameter = handmade.parameter("TOY_SIZE_Q", handmade.number("1"))
    program = handmade.Program("float64", None, (handmade.constant(),))
    assert "double TOY_SIZE_Q_;" in emit_c(handmade.model(parameters=(parameter,)), program)["c/toy.h"]


@pytest.mark.slow
def test_doxygen_knows_what_every_name_of_a_header_is(tmp_path: Path, tool: Callable[[str], str]) -> None:
    _headers(handmade.model(), tmp_path)
    settings = {"INPUT": tmp_path, "FILE_PATTERNS": "*.h", "OUTPUT_DIRECTORY": tmp_path / "out", "QUIET": "YES"}
    settings |= {"GENERATE_LATEX": "NO", "JAVADOC_AUTOBRIEF": "YES", "HAVE_DOT": "NO", "EXTRACT_ALL": "NO"}
    (tmp_path / "Doxyfile").write_text("".join(f"{key} = {value}\n" for key, value in settings.items()))
    run = subprocess.run([tool("doxygen"), "Doxyfile"], cwd=tmp_path, check=True, capture_output=True, text=True)
    # but the one that guards what both headers have
    assert [line for line in run.stderr.splitlines() if "TOY_MODEL_DEFINED" not in line] == []
