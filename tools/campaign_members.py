"""What the campaigns consist of: commands, what goes in, and what is kept of the results.

A campaign on a shipped model depends on the product by the bytes it made (`files.sha256`, but for the report), on its
own code, and on what this imports besides the way to those bytes; one on anything else depends on the product as a
whole.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from campaign_member import Member
from imported import imported

PYTHON = "python"  # this one, wherever it is
SYMGEN = (PYTHON, "-m", "symgen")
PYTEST = (PYTHON, "-m", "pytest")
CORES = ("arm-none-eabi-gcc", "qemu-system-arm", "riscv64-unknown-elf-gcc", "qemu-system-riscv32", "gcc", "clang")
# The packages of Python, and those that some tests need besides.
LOCK = "requirements.lock"
MORE_LOCKS = (
    *("tests/mechanisms/robots.lock", "tests/backends/jax.lock", "tests/backends/fmpy.lock"),
    *("tests/study/study.lock", "tests/identification/semidefinite.lock"),
)
# What looks at the product as a whole.
PRODUCT = ("symgen", "templates", "models", "pyproject.toml", LOCK)
# What a campaign's code imports and does not depend on by it: the way from model to C, which its bytes stand for, and
# how results are told.
BY_BYTES = (
    *("symgen/model", "symgen/symbolic", "symgen/ir", "symgen/linear_algebra", "symgen/mechanics", "symgen/methods"),
    *("symgen/quantities", "symgen/lowering", "symgen/backends", "symgen/registered.py"),
)
TELLING = ("symgen/output", "symgen/report", "symgen/terminal.py", "symgen/cli")
# A minute of two cores: always the same random systems, beside those that CI draws anew.
ZOO_SEED, ZOO_DRAWS = 7, 16
FIGURES = "build/campaigns/every_float32.xml"
NOTED = (f"--junitxml={FIGURES}", "-o", "junit_family=xunit1")
# What in tests/ has tests of the mark `campaign`, and the tools they need; a part of each class stays in `make test`.
TESTED = {
    "accuracy": ("gcc",),
    "allocation": ("gcc",),
    "backends": ("gcc", "g++", "cargo", "octave-cli", "mkoctfile"),
    "cli": ("gcc",),
    "closedform": (),
    "friction": ("gcc",),
    "generation": ("gcc",),
    "growth": (),
    "identification": (),
    "ir": (),
    "laws": ("gcc",),
    "linear_algebra": ("gcc",),
    "mechanics": ("gcc",),
    "methods": ("gcc",),
    "model": (),
    "notebook": ("gcc",),
    "package": ("cmake", "arm-none-eabi-gcc", "riscv64-unknown-elf-gcc"),
    "packaging": ("gcc",),
    "proof": ("frama-c", "gappa", "gcc", "clang", "cppcheck", "clang-tidy"),
    "simulate": ("gcc",),
    "stress": ("gcc",),
    "study": ("gcc",),
    "symbolic": (),
    "test_generated.py": ("gcc", "g++", "clang", "clang++"),
    "test_site.py": (),
    "test_start_page.py": ("gcc",),
    "toolchain": ("gcc", "g++", "clang", "arm-none-eabi-gcc", "riscv64-unknown-elf-gcc"),
    "urdf": ("gcc",),
    "verify": ("gcc",),
    "witness": (),
    "zoo": ("gcc",),
}


def all_members(root: Path) -> tuple[Member, ...]:
    """Every member of every campaign, the longest first."""
    models = sorted((path.stem for path in (root / "models").glob("*.yaml")), key=lambda name: -_size(root, name))
    energies = [name for name in models if _by_energies(root, name)]
    bodies = [name for name in models if name not in energies]
    benching = _code(root, "symgen/laboratory/bench")
    others = sorted(path.stem for path in (root / "tests/mechanisms").glob("*.yaml"))
    return (
        *(_target(root, name) for name in models),
        Member("firmware", "goals", ((*PYTEST, "tests/target", "-m", "firmware"),),
               (*PRODUCT, *_tests_of(root, "target"), "examples"), CORES),
        *(_proof(root, name) for name in models),
        *(_stress(root, name) for name in energies),
        *(_mechanism(f"models/{name}.yaml", name, (*_made(name), *_code(root, "symgen/verify")), _checksums(name))
          for name in bodies),
        *(_mechanism(path := f"tests/mechanisms/{name}.yaml", name, (path, *PRODUCT)) for name in others),
        Member("mechanisms", "witnesses", ((*PYTEST, "tests/mechanisms", "-m", "mechanisms or not mechanisms"),),
               (*PRODUCT, *_tests_of(root, "mechanisms")), ("gcc",)),
        _zoo(),
        *(_tests(root, path, tools) for path, tools in TESTED.items()),
        Member("trig", "every_float32",
               ((*PYTEST, "tests/toolchain/test_portable_pair.py", "-k", "everywhere", *NOTED),),
               (LOCK, "symgen/ir", "symgen/backends", "templates/c", *_tests_of(root, "toolchain")), ("gcc",),
               lambda root: figures(root / FIGURES), environment=(("SYMGEN_TRIG_STRIDE", "1"),)),
        *(_bench(f"models/{name}.yaml", name, (*_made(name), *benching), _checksums(name)) for name in energies),
        _bench(other := "docs/bench/rapkm_without_payload.yaml", "rapkm_without_payload", (other, *PRODUCT)),
        Member("bench", "tests", ((*PYTEST, "tests/bench", "-m", "bench"),), (*PRODUCT, *_tests_of(root, "bench")),
               ("gcc", "valgrind"), alone=True),
    )  # fmt: skip


def _by_energies(root: Path, name: str) -> bool:
    """Whether a model is given by its energies alone: those sweeps and benchmarks take; bodies have witnesses."""
    return "\nkinetic_energy:" in (root / f"models/{name}.yaml").read_text(encoding="utf-8")


def _size(root: Path, name: str) -> int:
    """How long a model takes: its kernels' operations."""
    kernels = json.loads((root / "generated" / name / "derivation.json").read_bytes())["kernels"]
    return sum(sum(kernel["operations"].values()) for kernel in kernels.values())


@cache
def _code(root: Path, path: str, *outside: str) -> tuple[str, ...]:
    """A campaign's own files, and what they import besides the way to the bytes they are about."""
    files = imported(root, (path,), (*BY_BYTES, *TELLING, *outside))
    return (path, *(file for file in files if not file.startswith(f"{path}/")))


def _tests_of(root: Path, path: str) -> tuple[str, ...]:
    """A folder or file of tests, with the helpers that they share with others."""
    files = imported(root, (f"tests/{path}",), ("symgen",))
    helpers = (file for file in files if not file.startswith(f"tests/{path}"))
    return (f"tests/{path}", "tests/conftest.py", *helpers, *MORE_LOCKS)


def _tests(root: Path, path: str, tools: tuple[str, ...]) -> Member:
    command = (*PYTEST, f"tests/{path}", "-m", "campaign")
    kept = ("derivation.json", "files.sha256") if path == "test_generated.py" else ()
    compared = [f"generated/{model.stem}/{file}" for model in sorted((root / "models").glob("*.yaml")) for file in kept]
    files = (*PRODUCT, *_tests_of(root, path), *compared)
    return Member("tests", path.partition(".")[0], (command,), files, tools)


def _made(name: str) -> tuple[str, ...]:
    return (f"models/{name}.yaml", LOCK)


def _checksums(name: str) -> tuple[str, ...]:
    return (f"generated/{name}/files.sha256",)


def _written(name: str, file: str) -> Callable[[Path], Any]:
    return lambda root: json.loads((root / f"generated/{name}/{file}").read_bytes())


def _target(root: Path, name: str) -> Member:
    def result(root: Path) -> Any:
        record = _written(name, "target.json")(root)
        cells = record["cells"]
        return {"passed": record["passed"], "builds": len(cells), "different": sum(c["different"] for c in cells)}

    command = (*SYMGEN, "target", f"models/{name}.yaml", "--cpu", "all", "--quiet")
    code = (*_code(root, "symgen/laboratory/target", "symgen/closedform"), "templates/target", "templates/package")
    files = (*_made(name), *code)
    return Member("firmware", name, (command,), files, CORES, result, checksums=_checksums(name))


def _proof(root: Path, name: str) -> Member:
    def result(root: Path) -> Any:
        record = _written(name, "proof.json")(root)
        return {"unproven": record["unproven"], "bounds": record["bounds"], "without": record["without"]}

    make = (*SYMGEN, f"models/{name}.yaml", "--only", "c,proof", "--recorded", "generated", "--out", "build/proof")
    table = (PYTHON, "tools/proof_table.py", "build/proof", "generated", name)
    code = (*_code(root, "symgen/proof"), "templates/proof", *imported(root, ("tools/proof_table.py",), ("symgen",)))
    files, tools = (*_made(name), *code), ("frama-c", "gappa", "gcc")
    return Member("proof", name, (make, table), files, tools, result, checksums=_checksums(name))


def _stress(root: Path, name: str) -> Member:
    def result(root: Path) -> Any:
        record = _written(name, "stress.json")(root)
        counts = [(one["quantity"], one["scalar"], one["beyond"], one["unexplained"]) for one in record["rule"]]
        return {"failures": record["failures"], "rule": [list(one) for one in counts]}

    command = (*SYMGEN, "stress", f"models/{name}.yaml", "--quiet")
    code = (*_code(root, "symgen/laboratory/stress"), "templates/stress")
    return Member("stress", name, (command,), (*_made(name), *code), ("gcc",), result, checksums=_checksums(name))


def _mechanism(path: str, name: str, files: tuple[str, ...], checksums: tuple[str, ...] = ()) -> Member:
    command = (*SYMGEN, path, "--only", "c,python", "--states", "32", "--quiet", "--out", "build/mechanisms")
    return Member("mechanisms", name, (command,), files, ("gcc",), checksums=checksums)


def _zoo() -> Member:
    """Random systems that are always the same: how many of each family end how."""
    out = Path("build/campaigns/zoo")
    command = (
        *(PYTHON, "-m", "symgen.laboratory.zoo", "--seed", str(ZOO_SEED), "--draws", str(ZOO_DRAWS)),
        *("--shrink", "0", "--out", str(out)),
    )

    def result(root: Path) -> Any:
        drawn = (root / out / f"{ZOO_SEED}_0.jsonl").read_text(encoding="utf-8").splitlines()
        endings = Counter((record["family"], record["ending"]) for record in map(json.loads, drawn))
        return [[*one, count] for one, count in sorted(endings.items())]

    return Member("zoo", "same_draws", (command,), (*PRODUCT, *MORE_LOCKS), ("gcc",), result, alone=True)


def _bench(path: str, name: str, files: tuple[str, ...], checksums: tuple[str, ...] = ()) -> Member:
    """What symgen's own kernels with its own sine and cosine take: nothing of it depends on the processor."""

    def result(root: Path) -> Any:
        return counted(_written(name, "bench.json")(root))

    command = (*SYMGEN, "bench", path, "--quiet")
    tools = ("gcc", "valgrind")
    files = (*files, "templates/bench")
    return Member("bench", name, (command,), files, tools, result, alone=True, checksums=checksums)


def counted(bench: Any) -> Any:
    """Instructions, operations, states beyond the tolerance of each generated kernel."""
    return [
        [one["quantity"], row["scalar"], row["instructions"], sum(row["operations"].values()), row["beyond"]]
        for one in bench["comparisons"]
        for row in one["measured"]
        if row["chosen"] and row["form"].endswith(", portable")
    ]


def figures(path: Path) -> Any:
    """What the tests of a run noted as properties, by the name of the test."""
    return {
        case.attrib["name"]: {one.attrib["name"]: one.attrib["value"] for one in case.iter("property")}
        for case in ElementTree.parse(path).iter("testcase")
    }
