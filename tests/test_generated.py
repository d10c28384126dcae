"""What symgen makes of models/ today: the bytes of generated/, by identities, and C without a warning.

Each model is made once.  Four folders are compared byte for byte, the others by checksums.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import pytest
import shipped
from generated_checksums import checksums_text
from kernel_growth import grown

from symgen.generation.results import Result
from symgen.ir.given_trig import given_trig
from symgen.ir.kernel import Kernel
from symgen.ir.library_trig import with_library_trig
from symgen.ir.lifted import Lifted, same_kernel
from symgen.ir.order import relaxed
from symgen.ir.prepare import prepare
from symgen.ir.split import split, without_first
from symgen.output.manifest import CHECKSUMS
from symgen.output.write import compare, is_measured, write_files
from symgen.symbolic.identity import every_identity_evaluated

GENERATED = shipped.ROOT / "generated"
# Kept for reading and comparing.  What is packed for build systems is a copy of c/, and is left out.
WHOLE = ("arm7", "delta", "front_car", "rapkm_2rrr_rr")
COPIED = "package/src/"
LIMIT = 1_000_000
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror"]
DOUBLE = re.compile(r"\b(v?cvtss2sd|v?cvtsd2ss|v?(?:add|sub|mul|div|sqrt|mov|ucomi|comi)sd|fcvt)\b")
COMPILERS = {
    "gcc": ["-std=c99"],
    "g++": ["-xc++", "-std=c++11", "-fsyntax-only"],
    "clang": ["-std=c99", "-fsyntax-only"],
    "clang++": ["-xc++", "-std=c++11", "-fsyntax-only"],
}
# Energies and bodies, with rows and without; the others are rewritten and written by the same rules.
FEW = ("front_car", "rolling_disc", "scara", "slider_crank")
# Three fifths of the time that all models take; smaller ones of their kinds stay, and their bytes are compared in the
# campaign of tests.
LONGEST_MADE = (
    *("gough_loops", "gough_stewart", "chain16", "chain32", "chain8", "rapkm_two_drives", "rapkm_bodies"),
    *("differential_drive", "three_rrr"),
)


@pytest.fixture(scope="module")
def made(request: pytest.FixtureRequest) -> Result:
    """Of one model after the other.

    Rewriting is held to exact evaluation for a few, and for all in the campaign of tests; bytes are the same as those
    of runs that take the word of fingerprints.
    """
    thorough = request.param in FEW or request.config.getoption("markexpr") == "campaign"
    with every_identity_evaluated() if thorough else nullcontext():
        return shipped.made(request.param)


def of(*names: str, marks: Callable[[str], bool] = lambda _: False) -> pytest.MarkDecorator:
    """Tests of what is made of models; those that are marked are members of the campaign of tests."""
    given = [pytest.param(name, marks=[pytest.mark.campaign] if marks(name) else []) for name in names]
    return pytest.mark.parametrize("made", given, indirect=True, scope="module")


@of(*shipped.ALL, marks=lambda name: name in LONGEST_MADE)
def test_generated_files_are_current(made: Result) -> None:
    """Whatever seed Python hashes with: each run of the tests has another one."""
    assert sys.flags.hash_randomization
    name, files = made.model.name, made.files
    folder = GENERATED / name
    assert folder.is_dir(), "a new model: run `make generated`"
    recorded = json.loads((folder / "derivation.json").read_bytes())
    costlier = grown(name, recorded, json.loads(files["derivation.json"]))
    assert not costlier, "kernels grew beyond the counts of derivation.json:\n" + "\n".join(costlier)
    kept = files if name in WHOLE else {"derivation.json": files["derivation.json"]}
    differences = [line for line in compare(folder, kept) if f"/{COPIED}" not in line]
    assert differences == [], "run `make generated` and look at the change"
    assert (folder / CHECKSUMS).read_text().splitlines() == checksums_text(files).splitlines(), (
        "run `make generated` and look at the change"
    )
    if name in WHOLE:
        existing = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
        others = {path for path in existing - set(files) if not is_measured(path) and "__pycache__" not in path}
        assert others == {CHECKSUMS}, "remove what is no longer generated"
    assert [path for path, content in files.items() if len(content) > LIMIT] == []


def test_every_folder_has_its_model() -> None:
    """Measurements of other models may lie beside."""
    assert {path.parent.name for path in GENERATED.glob("*/derivation.json")} == set(shipped.ALL)
    assert {path.parent.name for path in GENERATED.glob(f"*/{CHECKSUMS}")} == set(shipped.ALL)


@of(*shipped.ALL, marks=lambda name: name not in FEW)
def test_models_are_derived_and_written_by_identities(made: Result) -> None:
    """Every check of generation with exact evaluation in place of fingerprints, and what it leaves unchecked."""
    program = made.programs["float64"]
    with every_identity_evaluated():
        prepare(program, [kernel.name for kernel in program.kernels])
        with_library_trig(program)
        for kernel in program.kernels:
            given_trig(kernel)
            _cut(kernel)
            same_kernel("order", Lifted(kernel), Lifted(relaxed(kernel)))


def _cut(kernel: Kernel) -> None:
    flat = without_first(kernel)
    parts = split(flat)
    first = replace(flat.blocks[0], statements=parts.fixed, checks=())
    whole = replace(flat, blocks=(first, *parts.blocks))
    same_kernel("cutting in two", Lifted(kernel), Lifted(whole), whole=False)


@pytest.mark.toolchain
@of(*shipped.ALL, marks=lambda name: name not in FEW)
def test_no_warning_of_clang(made: Result, tool: Callable[[str], str], tmp_path: Path) -> None:
    _compiled(made, tool, tmp_path, "clang")


@pytest.mark.toolchain
@pytest.mark.parametrize("compiler", ["gcc", "g++", "clang++"])
@of(*shipped.SWEPT, marks=lambda name: name not in FEW)
def test_no_warning(made: Result, tool: Callable[[str], str], tmp_path: Path, compiler: str) -> None:
    _compiled(made, tool, tmp_path, compiler)
    if compiler == "gcc":
        command = [tool("objdump"), "-d", str(tmp_path / f"{made.model.name}_f.o")]
        text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        assert not DOUBLE.search(text)


def _compiled(made: Result, tool: Callable[[str], str], folder: Path, compiler: str) -> None:
    """As C99 or C++11, both scalar types."""
    write_files(folder, {path: text for path, text in made.files.items() if path.startswith("c/")})
    for source in sorted((folder / "c").glob("*.c")):
        flags = [*STRICT, *COMPILERS[compiler]]
        if compiler == "gcc":  # the float32 object is looked into
            flags += ["-O1"] if source.stem.endswith("_f") else ["-fsyntax-only"]
        if source.stem.endswith("_f"):
            flags += ["-Wfloat-conversion"] + (["-Wunsuffixed-float-constants"] if compiler == "gcc" else [])
        command = [tool(compiler), *flags, "-c", str(source), "-o", str(folder / f"{source.stem}.o")]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
