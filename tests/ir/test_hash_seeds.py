"""The same model gives the same bytes whatever seed Python hashes with."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = """
import hashlib, sys
from pathlib import Path
from symgen.quantities.select import derive_quantities
from symgen.backends.c.plain import emit_c
from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.prepared import emit_c_prepared
from symgen.backends.python.module import emit_python
from symgen.lowering.schedule import schedule
from symgen.model.load import load_model
digest = hashlib.sha256()
for name in ("slider_crank", "front_car"):
    model = load_model(Path("models") / (name + ".yaml"))
    derivations = derive_quantities(model, ("all",))
    programs = schedule(derivations.mechanics, derivations.quantities, ("float64", "float32"))
    for program in programs.values():
        for emit in (emit_c, emit_c_batch, emit_c_prepared):
            for path, text in sorted(emit(model, program).items()):
                digest.update(path.encode() + text.encode())
    for path, text in sorted(emit_python(model, programs["float64"]).items()):
        digest.update(path.encode() + text.encode())
print(digest.hexdigest())
"""


def digest(seed: str) -> str:
    environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


@pytest.mark.slow
def test_bytes_do_not_depend_on_the_hash_seed() -> None:
    first = digest("0")
    assert len(first) == 64
    assert digest("20120731") == first
