"""What the campaigns consist of: commands, what goes in, and what is kept of the results."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from campaigns import Member

PYTHON = "python"  # this one, wherever it is
SYMGEN = (PYTHON, "-m", "symgen")
PYTEST = (PYTHON, "-m", "pytest")
CORES = ("arm-none-eabi-gcc", "qemu-system-arm", "riscv64-unknown-elf-gcc", "qemu-system-riscv32", "gcc", "clang")
# What looks at the product as a whole.
PRODUCT = ("symgen", "templates", "models", "pyproject.toml")
# What in tests/ has tests of the mark `campaign`, and the tools they need; a part of each class stays in `make test`.
TESTED = {
    "backends": ("gcc",),
    "growth": (),
    "ir": (),
    "mechanics": ("gcc",),
    "methods": ("gcc",),
    "model": (),
    "package": ("cmake", "arm-none-eabi-gcc", "riscv64-unknown-elf-gcc"),
    "proof": ("frama-c", "gappa", "gcc", "clang", "cppcheck", "clang-tidy"),
    "stress": ("gcc",),
    "test_generated.py": ("gcc", "g++", "clang", "clang++"),
    "toolchain": ("gcc", "g++", "clang", "arm-none-eabi-gcc", "riscv64-unknown-elf-gcc"),
    "verify": ("gcc",),
    "witness": (),
    "zoo": ("gcc",),
}


def all_members(root: Path) -> tuple[Member, ...]:
    """Every member of every campaign, the longest first."""
    models = sorted((path.stem for path in (root / "models").glob("*.yaml")), key=lambda name: -_size(root, name))
    energies = [name for name in models if _by_energies(root, name)]
    bodies = [name for name in models if name not in energies]
    others = sorted(path.stem for path in (root / "tests/mechanisms").glob("*.yaml"))
    return (
        *(_target(name) for name in models),
        Member("firmware", "goals", ((*PYTEST, "tests/target", "-m", "firmware"),),
               (*PRODUCT, "tests/target", "examples"), CORES),
        *(_proof(name) for name in models),
        *(_stress(name) for name in energies),
        *(_mechanism(f"models/{name}.yaml", name, (f"generated/{name}/files.sha256",)) for name in bodies),
        *(_mechanism(f"tests/mechanisms/{name}.yaml", name, PRODUCT) for name in others),
        Member("mechanisms", "witnesses", ((*PYTEST, "tests/mechanisms", "-m", "mechanisms or not mechanisms"),),
               (*PRODUCT, "tests/mechanisms"), ("gcc",)),
        *(_tests(path, tools) for path, tools in TESTED.items()),
        Member("trig", "every_float32", ((*PYTEST, "tests/toolchain/test_portable_pair.py", "-k", "everywhere"),),
               ("symgen/ir", "symgen/backends", "templates/c", "tests/toolchain"), ("gcc",),
               environment=(("SYMGEN_TRIG_STRIDE", "1"),)),
        *(_bench(f"models/{name}.yaml", name) for name in energies),
        _bench("docs/bench/rapkm_without_payload.yaml", "rapkm_without_payload"),
        Member("bench", "tests", ((*PYTEST, "tests/bench", "-m", "bench"),), (*PRODUCT, "tests/bench"),
               ("gcc", "valgrind"), alone=True),
    )  # fmt: skip


def _by_energies(root: Path, name: str) -> bool:
    """Whether a model is given by its energies alone: those sweeps and benchmarks take; bodies have witnesses."""
    return "\nkinetic_energy:" in (root / f"models/{name}.yaml").read_text(encoding="utf-8")


def _size(root: Path, name: str) -> int:
    """How long a model takes: its kernels' operations."""
    kernels = json.loads((root / "generated" / name / "derivation.json").read_bytes())["kernels"]
    return sum(sum(kernel["operations"].values()) for kernel in kernels.values())


def _tests(path: str, tools: tuple[str, ...]) -> Member:
    command = (*PYTEST, f"tests/{path}", "-m", "campaign")
    return Member("tests", path.partition(".")[0], (command,), (*PRODUCT, "tests/shipped.py", f"tests/{path}"), tools)


def _made(name: str) -> tuple[str, ...]:
    return (f"models/{name}.yaml", f"generated/{name}/files.sha256")


def _target(name: str) -> Member:
    def result(root: Path) -> Any:
        found = json.loads((root / f"generated/{name}/target.json").read_bytes())
        cells = found["cells"]
        return {"passed": found["passed"], "builds": len(cells), "different": sum(c["different"] for c in cells)}

    command = (*SYMGEN, "target", f"models/{name}.yaml", "--cpu", "all", "--quiet")
    code = ("symgen/laboratory/target", "templates/target")
    return Member("firmware", name, (command,), (*_made(name), *code), CORES, result)


def _proof(name: str) -> Member:
    def result(root: Path) -> Any:
        found = json.loads((root / f"generated/{name}/proof.json").read_bytes())
        return {"unproven": found["unproven"], "bounds": found["bounds"], "without": found["without"]}

    make = (*SYMGEN, f"models/{name}.yaml", "--only", "c,proof", "--recorded", "generated", "--out", "build/proof")
    table = (PYTHON, "tools/proof_table.py", "build/proof", "generated", name)
    code = ("symgen/proof", "templates/proof", "tools/proof_table.py")
    return Member("proof", name, (make, table), (*_made(name), *code), ("frama-c", "gappa", "gcc"), result)


def _stress(name: str) -> Member:
    def result(root: Path) -> Any:
        found = json.loads((root / f"generated/{name}/stress.json").read_bytes())
        counts = [(one["quantity"], one["scalar"], one["beyond"], one["unexplained"]) for one in found["rule"]]
        return {"failures": found["failures"], "rule": [list(one) for one in counts]}

    command = (*SYMGEN, "stress", f"models/{name}.yaml", "--quiet")
    code = ("symgen/laboratory/stress", "symgen/verify", "templates/stress")
    return Member("stress", name, (command,), (*_made(name), *code), ("gcc",), result)


def _mechanism(path: str, name: str, made: tuple[str, ...]) -> Member:
    command = (*SYMGEN, path, "--only", "c,python", "--states", "32", "--quiet", "--out", "build/mechanisms")
    return Member("mechanisms", name, (command,), (path, *made, "symgen/verify"), ("gcc",))


def _bench(path: str, name: str) -> Member:
    command = (*SYMGEN, "bench", path, "--quiet")
    files = (path, *PRODUCT) if path.startswith("docs") else _made(name)
    code = ("symgen/laboratory/bench", "templates/bench")
    return Member("bench", name, (command,), (*files, *code), ("gcc", "valgrind"), alone=True)
