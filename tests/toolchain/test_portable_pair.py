"""The portable sine and cosine as compiled C: every float32, and lanes of vectors against one angle at a time.

`make trig` sweeps every float32; the test takes a stride that is coprime to every power of two.
"""

from __future__ import annotations

import os
import struct
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import shipped

from symgen.backends.c.plain import emit_c
from symgen.ir.kernel import Scalar
from symgen.ir.sincos import angle_limit, sincos

pytestmark = pytest.mark.toolchain
HERE = Path(__file__).resolve().parent
STRIDE = int(os.environ.get("SYMGEN_TRIG_STRIDE", "401"))
EXACT = ["-std=c99", "-ffp-contract=off"]
MODEL = "front_car"
# What a sweep comes to, the same on every machine: errors in units in the last place, distances, counts.
FIGURES = ("sine", "cosine", "near", "far", "asymmetric", "uncontrolled", "compared")


def run(*command: str | Path) -> str:
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


def written(folder: Path, suffix: str, wide: bool = False) -> Path:
    """The source of one kernel with several angles; beside it its header."""
    scalar: Scalar = "float32" if suffix else "float64"
    program = replace(shipped.programs(MODEL)[scalar], sincos=sincos(scalar, wide))
    kernels = tuple(kernel for kernel in program.kernels if kernel.name == "inverse_dynamics")
    for path, text in emit_c(shipped.model(MODEL), replace(program, kernels=kernels)).items():
        (folder / Path(path).name).write_text(text)
    return folder / f"{MODEL}{suffix}.c"


def compiled(folder: Path, compiler: str, flags: list[str], driver: str, suffix: str, wide: bool = False) -> Path:
    """A driver around the generated source, whose private functions it calls."""
    source = written(folder, suffix, wide)
    names = [f"-DPAIR={MODEL}_pair{suffix}", f"-DGROUP={MODEL}_sincos_group{suffix}", f'-DSOURCE="{source}"']
    program = folder / "driver"
    kind = f"-DREAL={'float' if suffix else 'double'}"
    run(compiler, *flags, kind, *names, f"-DSTRIDE={STRIDE}", HERE / driver, "-o", program, "-lm")
    return program


@pytest.mark.parametrize("wide", [False, True], ids=["normal", "wide"])
def test_single_precision_everywhere(
    tool: Callable[[str], str], tmp_path: Path, wide: bool, record_property: Callable[[str, object], None]
) -> None:
    limit = int(angle_limit("float32", wide))
    flags = [*EXACT, "-O3", f"-DLIMIT={limit}.0f"]
    figures = run(compiled(tmp_path, tool("gcc"), flags, "sweep_pair.c", "_f", wide)).split()
    sine, cosine, near, far, asymmetric, uncontrolled, compared = figures
    for name, figure in zip(FIGURES, figures, strict=True):
        record_property(name, figure)
    # numbers of one sign in order have bits in order, so that those of the last one count them
    assert int(compared) == struct.unpack("<I", struct.pack("<f", limit))[0] // STRIDE + 1
    assert float(sine) <= 1.6
    assert float(cosine) <= 1.6
    assert float(near) <= 7e-8
    assert float(far) <= (9e-8 if wide else 0.0)
    assert int(asymmetric) == 0
    assert int(uncontrolled) == 0


@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize(
    ("compiler", "flags"),
    [
        ("gcc", [*EXACT, "-O2"]),
        ("gcc", [*EXACT, "-O3"]),
        ("gcc", [*EXACT, "-O2", "-U__SSE2__", "-U__aarch64__"]),
        ("clang", [*EXACT, "-O2"]),
        ("g++", ["-xc++", "-std=c++11", "-ffp-contract=off", "-O2"]),
    ],
    ids=["gcc", "gcc -O3", "one lane", "clang", "g++"],
)
def test_lanes_have_the_bits_of_one_angle(
    tool: Callable[[str], str], tmp_path: Path, compiler: str, flags: list[str], scalar: str
) -> None:
    suffix = "" if scalar == "float64" else "_f"
    different, compared = run(compiled(tmp_path, tool(compiler), flags, "same_lanes.c", suffix)).split()
    assert int(compared) > 50_000
    assert int(different) == 0


@pytest.mark.parametrize(("suffix", "product"), [("", "mulpd"), ("_f", "mulps")])
def test_gcc_makes_vector_code_of_a_group(
    tool: Callable[[str], str], tmp_path: Path, suffix: str, product: str
) -> None:
    gcc = tool("gcc")
    if not run(gcc, "-dumpmachine").startswith("x86_64") or int(run(gcc, "-dumpversion").split(".")[0]) < 12:
        pytest.skip("gcc vectorises at -O2 from version 12 on; the mnemonics are those of x86-64")
    text = run(gcc, *EXACT, "-O2", "-S", written(tmp_path, suffix), "-o", "-")
    assert text.count(product) >= 15
