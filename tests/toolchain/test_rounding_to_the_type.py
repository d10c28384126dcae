"""Where operations or numbers are not rounded to their own type, compilation ends: x87, single precision constants."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from shipped import model, programs, sources, write_sources

from symgen.package.files import emit_package
from symgen.package.single_header import implementation_macro

pytestmark = pytest.mark.toolchain
NAME = "slider_crank"
STRICT = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-ffp-contract=off")
SSE = ("-m32", "-msse2", "-mfpmath=sse")
KINDS = ("", "_batch", "_prepared", "_sc")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The C in `c`, the package in `package`."""
    folder = tmp_path_factory.mktemp("kinds")
    write_sources(NAME, folder)
    c_files = {path: text for path, text in sources(NAME).items() if path.startswith("c/")}
    for path, text in emit_package(model(NAME), [*programs(NAME).values()], c_files).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    return folder


@pytest.fixture(scope="module")
def gcc32(tool: Callable[[str], str], tmp_path_factory: pytest.TempPathFactory) -> str:
    """gcc for x86-64, where it builds and this machine runs programs of 32 bits: gcc-multilib is a tool like others."""
    probe = tmp_path_factory.mktemp("probe") / "probe.c"
    probe.write_text('#include <stdio.h>\nint main(void) { return printf("%d", (int)sizeof(void *)) - 1; }\n')
    gcc, made = _gcc_of_x86(tool), probe.with_suffix("")
    if _run(gcc, "-m32", probe, "-o", made).returncode or _run(made).stdout != "4":
        message = "gcc builds no programs of 32 bits here: gcc-multilib is not installed"
        if os.environ.get("SYMGEN_REQUIRE_TOOLS"):
            pytest.fail(message)
        pytest.skip(message)
    return gcc


def _gcc_of_x86(tool: Callable[[str], str]) -> str:
    gcc = tool("gcc")
    if "__x86_64__" not in _run(gcc, "-dM", "-E", "-xc", "/dev/null").stdout:
        pytest.skip("gcc is not for x86-64")
    return gcc


def _run(*command: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)


def _compiled(compiler: str, source: Path, *flags: str) -> subprocess.CompletedProcess[str]:
    return _run(compiler, *flags, "-I", source.parent, "-c", source, "-o", source.with_suffix(".o"))


def _single_header(folder: Path, stem: str) -> Path:
    """A file that brings the definitions of a package's header."""
    user = folder / f"use_{stem}.c"
    user.write_text(f'#define {implementation_macro(stem)}\n#include "package/src/{stem}.h"\n')
    return user


def _every(folder: Path) -> list[Path]:
    stems = [f"{NAME}{kind}{suffix}" for kind in KINDS for suffix in ("", "_f")]
    kept = [stem for stem in stems if (folder / "c" / f"{stem}.c").exists()]
    single = [_single_header(folder, stem) for stem in kept if (folder / "package/src" / f"{stem}.h").exists()]
    paths = [folder / "c" / f"{stem}.c" for stem in kept] + [*(folder / "package/src").glob("*.c"), *single]
    assert len(paths) > 12
    return paths


@pytest.mark.campaign
@pytest.mark.parametrize("flags", [("-m32", "-O2"), ("-m32", "-std=c99"), ("-m32", "-mfpmath=387", "-msse2")])
def test_x87_is_refused(gcc32: str, folder: Path, flags: tuple[str, ...]) -> None:
    for source in _every(folder):
        made = _compiled(gcc32, source, *flags)
        assert made.returncode, source.name
        assert "-msse2 -mfpmath=sse" in made.stderr


@pytest.mark.campaign
@pytest.mark.parametrize("flags", [("-mfpmath=387",), ("-mfpmath=sse+387",)])
def test_x87_is_refused_on_64_bits(tool: Callable[[str], str], folder: Path, flags: tuple[str, ...]) -> None:
    gcc = _gcc_of_x86(tool)
    for source in _every(folder):
        made = _compiled(gcc, source, *flags)
        assert made.returncode, source.name
        assert "FLT_EVAL_METHOD" in made.stderr


@pytest.mark.campaign
def test_32_bits_with_sse_are_accepted_without_a_warning(gcc32: str, folder: Path) -> None:
    for source in _every(folder):
        made = _compiled(gcc32, source, *STRICT, *SSE, "-Wno-unused-function")
        assert made.returncode == 0, made.stderr


@pytest.mark.campaign
def test_numbers_of_double_precision_are_asked_for_where_there_are_any(
    tool: Callable[[str], str], folder: Path
) -> None:
    for source in _every(folder):
        made = _compiled(tool("gcc"), source, "-fsingle-precision-constant")
        if source.stem.endswith("_f"):
            assert made.returncode == 0, made.stderr
        else:
            assert "symgen_needs_no_fsingle_precision_constant" in made.stderr
            assert made.returncode


def test_both_types_in_one_file(tool: Callable[[str], str], folder: Path) -> None:
    """The checks of several sources stand in one file, as single headers put them there."""
    user = folder / "all.c"
    headers = [folder / "package/src" / f"{NAME}{suffix}.h" for suffix in ("", "_f")]
    user.write_text(
        "".join(f'#define {implementation_macro(h.stem)}\n#include "package/src/{h.name}"\n' for h in headers)
    )
    for compiler in ("gcc", "clang"):
        made = _compiled(tool(compiler), user, *STRICT, "-Wredundant-decls")
        assert made.returncode == 0, made.stderr


@pytest.mark.parametrize("suffix", ["", "_f"])
def test_bits_of_32_are_those_of_64(gcc32: str, folder: Path, suffix: str) -> None:
    real = "float" if suffix else "double"
    program = folder / f"bits{suffix}.c"
    n, m = model(NAME).n, model(NAME).m
    program.write_text(
        f'#include "c/{NAME}{suffix}.h"\n#include <stdio.h>\n#include <string.h>\n'
        f"int main(void) {{\n    {NAME}_params{suffix} p = {NAME}_default_params{suffix}();\n"
        f"    {real} q[{n}], qd[{n}], qdd[{n}], u[{m}];\n    int k, i;\n"
        f"    for (k = 0; k < 200; k++) {{\n        unsigned char b[sizeof u];\n        size_t j;\n"
        f"        for (i = 0; i < {n}; i++) {{\n            q[i] = ({real})(k * 7 % 31 - 15 + 3 * i) / ({real})11;\n"
        f"            qd[i] = ({real})(k % 13 - 6 + i) / ({real})7;\n"
        f"            qdd[i] = ({real})(k % 17 - 8) / ({real})3;\n"
        "        }\n        memset(u, 0, sizeof u);\n"
        f'        printf("%d ", (int){NAME}_inverse_dynamics{suffix}(q, qd, qdd, &p, u));\n'
        "        memcpy(b, u, sizeof u);\n"
        '        for (j = 0; j < sizeof u; j++) printf("%02x", b[j]);\n'
        '        printf("\\n");\n    }\n    return 0;\n}\n'
    )
    printed = []
    for flags in ((), SSE):
        made = folder / f"bits{suffix}{len(flags)}"
        source = folder / "c" / f"{NAME}{suffix}.c"
        built = _run(gcc32, "-std=c99", "-O2", *flags, "-I", folder, program, source, "-o", made, "-lm")
        assert built.returncode == 0, built.stderr
        printed.append(_run(made).stdout)
    assert printed[0] == printed[1]
    assert sum(line.startswith("0 ") for line in printed[0].splitlines()) > 100
