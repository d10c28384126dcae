"""The C compiles without a warning under strict flags, as C99 and C++, and float32 files hold no double."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import handmade
import pytest

from symgen.backends.c.plain import emit_c
from symgen.model.model import Model

pytestmark = pytest.mark.toolchain
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror", "-O2"]
FLOAT = ["-Wfloat-conversion", "-Wunsuffixed-float-constants"]
LANGUAGES = {"c": ["-std=c99"], "c++": ["-xc++", "-std=c++11"]}
NAMES = {
    "ordinary": handmade.model(),
    "no_parameters_needed": handmade.model(name="math"),
    "nasty": handmade.model(description="*/ ??/ \\", source="// /* \\"),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("c")
    write(folder, handmade.model(), True)
    return folder


def write(folder: Path, model: Model, own_sincos: bool) -> None:
    for scalar in ("float64", "float32"):
        for path, text in emit_c(model, handmade.program(scalar, own_sincos)).items():
            (folder / Path(path).name).write_text(text)


def run(*command: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)


@pytest.mark.parametrize("own_sincos", [True, False])
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_no_warning(
    tool: Callable[[str], str], tmp_path: Path, compiler: str, language: str, name: str, own_sincos: bool
) -> None:
    write(tmp_path, NAMES[name], own_sincos)
    sources = sorted(tmp_path.glob("*.c"))
    assert len(sources) == 2
    for source in sources:
        flags = [*STRICT, *LANGUAGES[language]]
        if source.stem.endswith("_f"):
            flags += FLOAT if compiler == "gcc" and language == "c" else FLOAT[:1]
        made = run(tool(compiler), *flags, "-c", source, "-o", tmp_path / "out.o")
        assert made.returncode == 0, made.stderr


@pytest.mark.parametrize("language", LANGUAGES)
def test_both_headers_together(tool: Callable[[str], str], folder: Path, tmp_path: Path, language: str) -> None:
    user = tmp_path / "user.c"
    user.write_text(
        '#include "toy.h"\n#include "toy_f.h"\n'
        "toy_status both(const double *q, const float *q_f, double *G, float *G_f);\n"
        "toy_status both(const double *q, const float *q_f, double *G, float *G_f) {\n"
        "    const toy_params p = toy_default_params();\n    const toy_params_f p_f = toy_default_params_f();\n"
        "    const toy_status status = toy_mass_matrix(q, &p, G);\n"
        "    return status == TOY_OK ? toy_mass_matrix_f(q_f, &p_f, G_f) : status;\n}\n"
    )
    made = run(tool("gcc"), *STRICT, *LANGUAGES[language], "-I", folder, "-c", user, "-o", tmp_path / "user.o")
    assert made.returncode == 0, made.stderr


@pytest.mark.parametrize("source", ["toy.c", "toy_f.c"])
@pytest.mark.parametrize(
    ("compiler", "flag"),
    [
        ("gcc", "-ffast-math"),
        ("gcc", "-Ofast"),
        ("gcc", "-funsafe-math-optimizations"),
        ("gcc", "-ffinite-math-only"),
        ("clang", "-ffast-math"),
        ("clang", "-Ofast"),
        ("clang", "-ffinite-math-only"),
    ],
)
def test_fast_math_is_refused(
    tool: Callable[[str], str], folder: Path, tmp_path: Path, compiler: str, flag: str, source: str
) -> None:
    made = run(tool(compiler), flag, "-c", folder / source, "-o", tmp_path / "out.o")
    assert made.returncode != 0
    assert "IEEE" in made.stderr


def test_objects_hold_no_data_and_need_only_the_math_library(
    tool: Callable[[str], str], folder: Path, tmp_path: Path
) -> None:
    made = tmp_path / "toy_f.o"
    flags = ["-std=c99", "-Os", "-fno-math-errno", "-ffp-contract=off"]
    assert run(tool("gcc"), *flags, "-c", folder / "toy_f.c", "-o", made).returncode == 0
    symbols = run(tool("nm"), made).stdout
    assert not re.findall(r" [bBdDC] ", symbols)
    assert not re.findall(r" U (?!_GLOBAL_OFFSET_TABLE_)", symbols)  # square roots and signs are instructions


def test_float32_is_never_a_double(tool: Callable[[str], str], folder: Path, tmp_path: Path) -> None:
    double = re.compile(r"\b(v?cvtss2sd|v?cvtsd2ss|v?(?:add|sub|mul|div|sqrt|mov|ucomi|comi)sd|fcvt)\b")
    for stem, expected in (("toy_f", False), ("toy", True)):
        made = tmp_path / f"{stem}.o"
        assert run(tool("gcc"), "-std=c99", "-O2", "-c", folder / f"{stem}.c", "-o", made).returncode == 0
        assert bool(double.search(run(tool("objdump"), "-d", made).stdout)) == expected


def test_outputs_may_alias_inputs_and_stay_untouched_on_failure(
    tool: Callable[[str], str], folder: Path, tmp_path: Path
) -> None:
    user = tmp_path / "alias.c"
    user.write_text(
        '#include "toy.h"\n#include <stdio.h>\nint main(void) {\n'
        "    toy_params p = toy_default_params();\n    double a[2] = {1.0, 0.3}, b[2], c[2] = {1e-9, 0.3};\n"
        "    toy_status first = toy_inverse_dynamics(a, a, a, &p, b);\n"
        "    toy_status second = toy_inverse_dynamics(a, a, a, &p, a);\n"
        "    toy_status third = toy_inverse_dynamics(c, c, c, &p, c);\n"
        '    printf("%d %d %d %d %d\\n", first, second, third, a[0] == b[0] && a[1] == b[1], c[0] == 1e-9);\n'
        "    return 0;\n}\n"
    )
    program = tmp_path / "alias"
    made = run(tool("gcc"), "-std=c99", "-O3", "-I", folder, user, folder / "toy.c", "-lm", "-o", program)
    assert made.returncode == 0, made.stderr
    assert run(program).stdout == "0 0 3 1 1\n"
