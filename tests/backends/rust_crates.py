"""Crates built and run: a program beside them feeds their functions with numbers and writes what comes back."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from symgen.backends.locals import array_arguments
from symgen.backends.rust.backend import BACKEND
from symgen.backends.rust.module import RUST_TYPE
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.model.model import Model


def crate(model: Model, programs: Mapping[Scalar, Program], folder: Path) -> Path:
    """The crate of a model under `folder`."""
    assert BACKEND.around is not None
    files = BACKEND.around(model, list(programs.values()))
    for program in programs.values():
        for variant in BACKEND.variants:
            files |= variant.emit(model, program)
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return folder / "rust"


def cargo(path: str, *arguments: str, folder: Path, flags: str = "-D warnings") -> str:
    """What cargo says; nothing is looked for on a network, and a warning is an error."""
    environment = {**os.environ, "RUSTFLAGS": flags, "RUSTDOCFLAGS": flags, "CARGO_NET_OFFLINE": "true"}
    made = subprocess.run(
        [path, *arguments], cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=600
    )
    assert made.returncode == 0, made.stdout + made.stderr
    return made.stdout


def driver(made: Path, name: str, main: str, features: Sequence[str] = ()) -> Path:
    """The folder of a program that uses a crate."""
    folder = made.parent / "driver"
    (folder / "src").mkdir(parents=True)
    given = f'path = "../{made.name}", features = [{", ".join(f"{one!r}" for one in features)}]'
    manifest = '[package]\nname = "driver"\nversion = "0.0.0"\nedition = "2021"\n[dependencies]\n'
    manifest += f"{name} = {{ {given} }}\n"
    (folder / "Cargo.toml").write_text(manifest)
    (folder / "src/main.rs").write_text(main)
    return folder


def replaying(name: str, scalar: Scalar, kernels: Sequence[Kernel], states: int) -> str:
    """Reads the arguments of each kernel at so many states as raw numbers; writes statuses and results."""
    kind = RUST_TYPE[scalar]
    size = int(kind[1:]) // 8
    lines = [
        "use std::io::{Read, Write};",
        f"use {name}::{scalar} as kernels;",
        "",
        "fn main() {",
        "    let (mut given, mut made) = (Vec::new(), Vec::new());",
        "    std::io::stdin().read_to_end(&mut given).unwrap();",
        f"    let mut numbers = given.chunks_exact({size}).map(|x| {kind}::from_le_bytes(x.try_into().unwrap()));",
        "    let p = kernels::Parameters::default();",
    ]
    for kernel in kernels:
        arrays = array_arguments(kernel)
        lines.append(f"    for _ in 0..{states} {{")
        drawn = "std::array::from_fn(|_| numbers.next().unwrap())"
        lines += [f"        let {a.name}: [{kind}; {a.length}] = {drawn};" for a in arrays]
        called = ", ".join([*(f"&{a.name}" for a in arrays), "&p"])
        lines += [
            f"        match kernels::{kernel.name}({called}) {{",
            "            Ok(y) => {",
            "                made.push(0);",
            *_pushing("y", len(kernel.shape)),
            "            }",
            "            Err(status) => made.push(status.code()),",
            "        }",
            "    }",
        ]
    return "\n".join([*lines, "    std::io::stdout().write_all(&made).unwrap();", "}", ""])


def _pushing(name: str, depth: int) -> list[str]:
    indent = " " * 16
    if not depth:
        return [f"{indent}made.extend({name}.to_le_bytes());"]
    inner = [f"    {line}" for line in _pushing(f"{name}_", depth - 1)]
    return [f"{indent}for {name}_ in {name} {{", *inner, f"{indent}}}"]


def run(folder: Path, cargo_path: str, given: bytes = b"", release: bool = False) -> bytes:
    """What a program writes."""
    cargo(cargo_path, "build", *(("--release",) if release else ()), folder=folder)
    made = folder / "target" / ("release" if release else "debug") / "driver"
    return subprocess.run([made], input=given, capture_output=True, check=True).stdout
