"""generated/ is what symgen makes of models/ today: four folders byte for byte, the others by checksums."""

from __future__ import annotations

import json
import sys

import pytest
import shipped
from generated_checksums import CHECKSUMS, checksums_text
from kernel_growth import grown

from symgen.output.write import compare, is_measured

GENERATED = shipped.ROOT / "generated"
# Kept for reading and comparing.  What is packed for build systems is a copy of c/, and is left out.
WHOLE = ("arm7", "delta", "front_car", "rapkm_2rrr_rr")
COPIED = "package/src/"
LIMIT = 1_000_000


@pytest.mark.parametrize("name", [*map(shipped.together, shipped.ALL)])
def test_generated_files_are_current(name: str) -> None:
    """Whatever seed Python hashes with: each run of the tests has another one."""
    assert sys.flags.hash_randomization
    made = shipped.generated(name)
    folder = GENERATED / name
    assert folder.is_dir(), "a new model: run `make generated`"
    recorded = json.loads((folder / "derivation.json").read_bytes())
    costlier = grown(name, recorded, json.loads(made["derivation.json"]))
    assert not costlier, "kernels grew beyond the counts of derivation.json:\n" + "\n".join(costlier)
    kept = made if name in WHOLE else {"derivation.json": made["derivation.json"]}
    differences = [line for line in compare(folder, kept) if f"/{COPIED}" not in line]
    assert differences == [], "run `make generated` and look at the change"
    assert (folder / CHECKSUMS).read_text().splitlines() == checksums_text(made).splitlines(), (
        "run `make generated` and look at the change"
    )
    if name in WHOLE:
        found = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
        others = {path for path in found - set(made) if not is_measured(path) and "__pycache__" not in path}
        assert others == {CHECKSUMS}, "remove what is no longer generated"
    assert [path for path, content in made.items() if len(content) > LIMIT] == []


def test_every_folder_has_its_model() -> None:
    """Measurements of other models may lie beside."""
    assert {path.parent.name for path in GENERATED.glob("*/derivation.json")} == set(shipped.ALL)
    assert {path.parent.name for path in GENERATED.glob(f"*/{CHECKSUMS}")} == set(shipped.ALL)
