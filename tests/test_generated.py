"""generated/ is what symgen makes of models/ today, byte for byte and file by file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from kernel_growth import grown

from symgen.pipeline import generate
from symgen.results import Options
from symgen.write import compare, is_measured

ROOT = Path(__file__).resolve().parent.parent
MODELS = sorted((ROOT / "models").glob("*.yaml"))
LIMIT = 1_000_000


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_generated_files_are_current(path: Path) -> None:
    # what verification rejected is taken from the record: it is not verified again here
    options = Options(verify=False, as_recorded=True, measured=ROOT / "generated")
    result = generate(path, options, lambda _: None)
    folder = ROOT / "generated" / result.model.name
    assert folder.is_dir(), "a new model: run `make generated`"
    recorded = json.loads((folder / "derivation.json").read_bytes())
    costlier = grown(result.model.name, recorded, json.loads(result.files["derivation.json"]))
    assert not costlier, "kernels grew beyond the counts of derivation.json:\n" + "\n".join(costlier)
    assert compare(folder, result.files) == (), "run `make generated` and look at the change"
    found = {path.relative_to(folder).as_posix() for path in outputs() if folder in path.parents}
    assert found <= set(result.files), "remove what is no longer generated"


def outputs() -> list[Path]:
    """The files but those of measurements, which git ignores."""
    paths = (path for path in (ROOT / "generated").rglob("*") if "__pycache__" not in path.parts)
    return [path for path in paths if path.is_file() and not is_measured(path.name)]


def test_every_folder_has_its_model() -> None:
    assert {path.relative_to(ROOT / "generated").parts[0] for path in outputs()} == {path.stem for path in MODELS}


def test_no_file_is_large() -> None:
    assert [path for path in outputs() if path.stat().st_size > LIMIT] == []
