"""Interval analysis, rounding bounds, fuzzing and static analysis of the C as it is generated."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import pytest
from shipped import ROOT, SCALARS, model, programs, sources
from wide_record import NAME, recorded

from symgen.backends.c.given_sines import emit_c_sc
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.cli.main import main
from symgen.ir.kernel import Scalar
from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.proof.eva import emit_eva
from symgen.proof.files import emit_proofs
from symgen.proof.fuzz import emit_fuzz
from symgen.proof.gappa import emit_gappa
from symgen.proof.slices import slices
from symgen.quantities.select import derive_quantities

SUMMED = """
model: summed
coordinates: {a: {unit: rad, range: [-3, 3]}, b: {unit: rad, range: [-3, 3]}}
parameters: {J: {value: 2, unit: kg*m**2}, k: {value: 3, unit: N*m}}
kinetic_energy: J*(a_dot**2 + b_dot**2)
potential_energy: k*cos(a + b)
inputs: {M_a: {unit: N*m, acts_on: {a: 1}}, M_b: {unit: N*m, acts_on: {b: 1}}}
"""
SANITIZE = ["-O1", "-std=c99", "-ffp-contract=off", "-fno-sanitize-recover=all", "-DSTANDALONE"]


def run(*command: str | Path, folder: Path | None = None) -> str:
    made = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, cwd=folder)
    assert made.returncode == 0, made.stdout + made.stderr
    return made.stdout + made.stderr


def write(folder: Path, files: dict[str, str]) -> None:
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)


def proofs(name: str) -> dict[str, str]:
    return emit_proofs(model(name), [programs(name)[scalar] for scalar in SCALARS])


def alarms(tool: Callable[[str], str], name: str, limit: Fraction | None, folder: Path) -> int:
    """Alarms of Eva for u in float32, with another range of the last coordinate if one is given."""
    tool("gcc")  # Frama-C's preprocessor
    system = model(name)
    if limit is not None:
        *others, last = system.coordinates
        system = replace(system, coordinates=(*others, replace(last, range=(-limit, limit))))
    write(folder, sources(name) | emit_eva(system, programs(name)["float32"]))
    printed = run(
        tool("frama-c"), "-eva", "-eva-precision", "1", "-warn-special-float", "non-finite",
        f"-cpp-extra-args=-I{folder}/c", "-main", "eva_inverse_dynamics",
        folder / f"proof/{name}_f_eva.c", folder / f"c/{name}_f.c",
    )  # fmt: skip
    counted = re.search(r"(\d+) alarms? generated", printed)
    assert counted, printed
    unproved = re.search(r"Assertions +\d+ valid +(\d+) unknown +(\d+) invalid", printed)
    assert unproved, printed
    return int(counted[1]) + int(unproved[1]) + int(unproved[2])


def test_front_car_has_no_alarm_in_its_box(tool: Callable[[str], str], tmp_path: Path) -> None:
    assert alarms(tool, "front_car", None, tmp_path) == 0


@pytest.mark.campaign
@pytest.mark.parametrize(("limit", "proved"), [(Fraction(12, 10), True), (Fraction(165, 100), False)])
def test_eva_separates_the_input_singularity_of_the_rear_car(
    tool: Callable[[str], str], tmp_path: Path, limit: Fraction, proved: bool
) -> None:
    assert (alarms(tool, "rear_car", limit, tmp_path) == 0) == proved


@pytest.mark.parametrize("name", ["front_car", "skate"])
def test_drivers_compile(tool: Callable[[str], str], tmp_path: Path, name: str) -> None:
    write(tmp_path, proofs(name) | {path: text for path, text in sources(name).items() if path.endswith(".h")})
    for driver in sorted((tmp_path / "proof").glob("*.c")):
        run(tool("gcc"), "-std=c99", "-fsyntax-only", "-Wall", "-Wextra", "-I", tmp_path / "c", driver)


@pytest.mark.parametrize("scalar", SCALARS)
def test_slices_cover_the_range_without_overlap(scalar: Scalar) -> None:
    cuts = slices(scalar, (Fraction(-33, 10), Fraction(33, 10)))
    assert all(cut.low <= cut.high for cut in cuts)
    gaps = [after.low - before.high for before, after in pairwise(cuts)]
    assert all(0 <= gap < 1e-6 for gap in gaps)
    assert sum(gap > 0 for gap in gaps) == 4  # the multiple of pi/2 changes between two floats
    assert cuts[0].low == -cuts[-1].high


@pytest.mark.parametrize(
    "name", ["skate", *(pytest.param(name, marks=pytest.mark.campaign) for name in ("front_car", "differential_drive"))]
)
def test_gappa_certifies_a_rounding_bound_above_the_measured_error(
    tool: Callable[[str], str], tmp_path: Path, name: str
) -> None:
    files = emit_gappa(model(name), programs(name)["float32"])
    script = f"proof/{name}_f_inverse_dynamics.gappa"
    measuring = f"proof/{name}_f_inverse_dynamics_error.c"
    assert set(files) == {script, measuring}
    few = {measuring: files[measuring].replace("1000000ul", "20000ul")}
    write(tmp_path, files | sources(name) | few)
    printed = run(tool("gappa"), tmp_path / script)
    bounds = [float(bound) for bound in re.findall(r"\{([0-9.e+-]+),", printed)]
    assert len(bounds) == files[script].count(" in ?")
    made = [measuring, f"c/{name}.c", f"c/{name}_f.c"]
    run(tool("gcc"), "-std=c99", "-O1", "-ffp-contract=off", "-Ic", *made, "-o", "error", "-lm", folder=tmp_path)
    measured = [float(line) for line in run(tmp_path / "error").split()]
    assert len(measured) == len(bounds)
    assert all(0 < error <= bound * (1 + 1e-5) < 1e4 for error, bound in zip(measured, bounds, strict=True))


def test_gappa_counts_the_rounding_of_a_sum_of_angles() -> None:
    """Half a unit in the last place of |a + b| < 8 is 2^-22, beside the 2^-23 of the sine."""
    system = load_text(SUMMED, "summed.yaml")
    derivations = derive_quantities(system, ("inverse_dynamics",))
    program = schedule(derivations.mechanics, derivations.quantities, ("float32",))["float32"]
    script = emit_gappa(system, program)["proof/summed_f_inverse_dynamics.gappa"]
    assert set(re.findall(r"\| <= (\S+)", script)) == {"3b-23"}


# make fuzz takes every kernel of every model, for longer
TRIED = ("double_pendulum", "front_car", "slider_crank", "rear_car")
FEW = ("double_pendulum", "front_car")
SHORT = ("inverse_dynamics", "forward_dynamics", "multipliers", "nullspace_projector", "singularity")
CAMPAIGNS = {
    "clang": ["-fsanitize=address,undefined,float-cast-overflow"],
    "gcc": ["-DINSIDE", "-fsanitize=address,undefined,float-divide-by-zero"],
}


@pytest.mark.parametrize(
    ("name", "compiler"),
    [
        pytest.param(name, [*CAMPAIGNS][k % 2], marks=() if name in FEW else pytest.mark.campaign)
        for k, name in enumerate(TRIED)
    ],
)
def test_short_campaign(tool: Callable[[str], str], tmp_path: Path, name: str, compiler: str) -> None:
    """Sanitizers, statuses, aliasing and float32 against float64; `make fuzz` takes every model."""
    fewer = [
        replace(program, kernels=tuple(k for k in program.kernels if k.name in SHORT))
        for program in programs(name).values()
    ]
    files = emit_fuzz(model(name), fewer)
    for program in fewer:
        for emit in (emit_c, emit_c_prepared, emit_c_sc):
            files |= emit(model(name), program)
    write(tmp_path, files)
    made = [f"proof/{name}_fuzz.c", *(path for path in files if path.startswith("c/") and path.endswith(".c"))]
    run(tool(compiler), *SANITIZE, *CAMPAIGNS[compiler], "-Ic", *made, "-o", "fuzz", "-lm", folder=tmp_path)
    printed = run(tmp_path / "fuzz", "10000")
    counted = re.findall(r"^(\w+): (\d+) compared, (\d+) beyond", printed, re.MULTILINE)
    functions = {kernel for kernel, _, _ in counted}
    assert {k.name for k in programs(name)["float64"].kernels if k.name in SHORT} <= functions
    assert "inverse_dynamics_sc" in functions
    assert all(int(compared) > 100 for _, compared, _ in counted)


def test_short_campaign_of_what_encoders_say(tool: Callable[[str], str], tmp_path: Path) -> None:
    """Arrays beside q, qd, qdd and u: all of them are given, changed and aliased."""
    path = tmp_path / "levers.yaml"
    path.write_text(SUMMED.replace("summed", "levers") + "coupling: {b: 2*a}\nmeasured: [a]\n")
    outputs = "inverse_dynamics,velocity_from_measured,acceleration_from_measured"
    asked = ["--outputs", outputs, "--only", "c,proof", "--no-verify", "--quiet", "--out", str(tmp_path)]
    assert main([str(path), *asked]) == 0
    folder = tmp_path / "levers"
    made = [f"c/{file.name}" for file in (folder / "c").glob("*.c") if "_batch" not in file.name]
    options = [*SANITIZE, *CAMPAIGNS["clang"], "-Ic", "proof/levers_fuzz.c", *made, "-o", "fuzz", "-lm"]
    run(tool("clang"), *options, folder=folder)
    printed = run(folder / "fuzz", "4000")
    counted = {name: int(count) for name, count in re.findall(r"(?m)^(\w+): (\d+) compared", printed)}
    assert counted["velocity_from_measured"] > 100
    assert counted["acceleration_from_measured"] > 100


@pytest.mark.campaign
@pytest.mark.parametrize("compiler", [*CAMPAIGNS])
def test_short_campaign_with_twice_the_digits_in_one_type(
    tool: Callable[[str], str], tmp_path: Path, compiler: str
) -> None:
    """A kernel that takes sines in float64 and, with twice the digits, none in float32."""
    path, out = recorded(tmp_path, {"inverse_dynamics": ("float32",), "forward_dynamics": ("float32",)})
    assert main([str(path), "--only", "c,proof", "--recorded", str(out), "--quiet", "--out", str(out)]) == 0
    folder = out / NAME
    assert not (folder / "c" / f"{NAME}_sc_f.c").exists()
    page = (folder / "proof" / "README.md").read_text()
    assert "`inverse_dynamics` in float32, `forward_dynamics` in float32" in page.partition("## Twice the digits")[2]
    made = [f"c/{file.name}" for file in (folder / "c").glob("*.c") if "_batch" not in file.name]
    options = [*SANITIZE, *CAMPAIGNS[compiler], "-Ic", f"proof/{NAME}_fuzz.c", *made, "-o", "fuzz", "-lm"]
    run(tool(compiler), *options, folder=folder)
    printed = run(folder / "fuzz", "10000")
    counted = re.findall(r"^(\w+): (\d+) compared, (\d+) beyond", printed, re.MULTILINE)
    often = {kernel for kernel, compared, _ in counted if int(compared) > 100}
    assert often >= {"inverse_dynamics", "forward_dynamics"}


def test_what_works_with_twice_the_digits_is_told_not_to_be_proved(tmp_path: Path) -> None:
    path, out = recorded(tmp_path, {"inverse_dynamics": ("float32",)})
    assert main([str(path), "--only", "c,proof", "--recorded", str(out), "--quiet", "--out", str(out)]) == 0
    table = [sys.executable, ROOT / "tools" / "proof_table.py", out, tmp_path / "found", NAME]
    row = run(*table).splitlines()[-1]
    assert f"| {NAME} | not run: twice the digits | no script |" in row


@pytest.mark.parametrize("level", ["-O1", "-O2"])
def test_no_compiler_divides_by_a_length_of_zero(tool: Callable[[str], str], tmp_path: Path, level: str) -> None:
    """clang takes divisions out of branches: with l_2 = 0 rows have no length, and the processor tells."""
    name = "rapkm_two_drives"
    program = programs(name)["float32"]
    few = replace(program, kernels=tuple(k for k in program.kernels if k.name == "singularity"))
    main = f"""#include "{name}_f.h"
#include <fenv.h>
int main(void) {{
    const volatile float zero = 0.0f;
    const float q[6] = {{1.8f, 0.25f, zero, 2.2f, -3.0f, -2.4f}};
    float y[2] = {{-1.0f, -1.0f}};
    {name}_params_f p = {name}_default_params_f();
    p.l_1 = zero;
    p.l_2 = zero;
    const int status = (int){name}_singularity_f(q, &p, y);
    return status != 0 || !(y[0] == 0.0f) || fetestexcept(FE_DIVBYZERO) != 0;
}}
"""
    write(tmp_path, emit_c(model(name), few) | {"main.c": main})
    options = ["-std=c99", level, "-ffp-contract=off", "-Ic"]
    run(tool("clang"), *options, "main.c", f"c/{name}_f.c", "-lm", "-o", "main", folder=tmp_path)
    run(tmp_path / "main")


def test_remaining_denominators_are_named() -> None:
    page = proofs("rapkm_2rrr_rr")["proof/README.md"]
    assert "| inverse_dynamics(q, qd, qdd) |" in page
    assert "There is no script for Gappa" in page
    assert "| inverse_dynamics(" not in proofs("front_car")["proof/README.md"]


LISTED = {("h", "misra-c2012-2.4"), ("h", "misra-c2012-2.5"), ("c", "misra-c2012-15.5")}


def deviations(printed: str) -> set[tuple[str, str]]:
    """In which kind of file what cppcheck prints finds something, and the rule."""
    return set(re.findall(r"^[^\s:]+\.(\w+):.*\[([\w.-]+)\]$", printed, re.MULTILINE))


@pytest.mark.campaign
def test_static_analysis_has_listed_deviations_only(tool: Callable[[str], str], tmp_path: Path) -> None:
    """package/DEVIATIONS.md lists them; each is found, so none is stale."""
    write(tmp_path, {path: text for path, text in sources("skate").items() if "batch" not in path})
    given = ["--std=c99", "--addon=misra", "--enable=warning,style,performance,portability", "-q", "c/skate_f.c"]
    assert deviations(run(tool("cppcheck"), *given, folder=tmp_path)) == LISTED
    checks = "-checks=-*,bugprone-*,cert-*,clang-analyzer-*,-bugprone-easily-swappable-parameters"
    printed = run(tool("clang-tidy"), "--quiet", checks, "c/skate.c", "c/skate_f.c", "--", "-std=c99", folder=tmp_path)
    assert "warning:" not in printed


@pytest.mark.campaign
def test_static_analysis_of_kernels_with_twice_the_digits(tool: Callable[[str], str], tmp_path: Path) -> None:
    """Tables of steps and what runs them deviate from no other rule."""
    path, out = recorded(tmp_path, {"forward_dynamics": ("float64", "float32")})
    assert main([str(path), "--only", "c", "--recorded", str(out), "--quiet", "--out", str(out)]) == 0
    sources = [f"out/{NAME}/c/{NAME}{suffix}.c" for suffix in ("", "_f")]
    assert all("_steps" in (tmp_path / source).read_text() for source in sources)
    given = ["--std=c99", "--addon=misra", "--enable=warning,style,performance,portability", "-q", sources[1]]
    assert deviations(run(tool("cppcheck"), *given, folder=tmp_path)) == LISTED
    checks = "-checks=-*,bugprone-*,cert-*,clang-analyzer-*,-bugprone-easily-swappable-parameters"
    printed = run(tool("clang-tidy"), "--quiet", checks, *sources, "--", "-std=c99", folder=tmp_path)
    assert "warning:" not in printed
