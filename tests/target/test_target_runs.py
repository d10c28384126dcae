"""Generated C on emulated cores: bits, statuses, counts, footprints; and that these checks can fail."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from shipped import model, programs

from symgen.backends.c.plain import emit_c
from symgen.laboratory.target import run
from symgen.laboratory.target.build import STACK_WATCHED, Workshop
from symgen.laboratory.target.compare import compare
from symgen.laboratory.target.cores import BY_NAME, CORES
from symgen.laboratory.target.driver import driver_source, pack_states, results_file, states_file, unpack_results
from symgen.laboratory.target.emulator import addresses, build_counter, count_calls, emulate, stage
from symgen.laboratory.target.entries import plain_entries
from symgen.laboratory.target.footprint import footprints
from symgen.laboratory.target.record import KernelCost, TargetReport
from symgen.laboratory.target.run import measure
from symgen.laboratory.target.tables import target_tables
from symgen.laboratory.target.vectors import vectors_of
from symgen.verify.reference.reference import Reference

ARM = ("gcc", "arm-none-eabi-gcc", "qemu-system-arm")
LEVELS = ("-O0", "-O2", "-Os")  # `make firmware` takes all
RISCV = ("gcc", "riscv64-unknown-elf-gcc", "qemu-system-riscv32")
# Known counts: 2; 1 + 3 * 5 + 1 with the loop's branches; and a call of the second inside the third.
COUNTED = """
int main(void);
void two(void);
void loop(void);
void outer(void);
__attribute__((naked)) void two(void) { __asm__("nop\\n bx lr"); }
__attribute__((naked)) void loop(void) { __asm__("movs r0, #5\\n 1: subs r0, #1\\n nop\\n bne 1b\\n bx lr"); }
__attribute__((naked)) void outer(void) { __asm__("push {r4, lr}\\n bl loop\\n pop {r4, pc}"); }
int main(void) { two(); loop(); two(); outer(); return 0; }
"""
HUNGRY = """
float held[3];
static float square(float x) { return x * x; }
float with_data(float x);
float with_library(float x);
float sqrtf(float x);
float sinf(float x);
float with_data(float x) { held[0] += x; return square(held[0]); }
float with_library(float x) { return sinf(x); }
"""


@pytest.fixture(scope="module")
def report(tool: Callable[[str], str]) -> TargetReport:
    for name in ARM:
        tool(name)
    with pytest.MonkeyPatch.context() as fewer:
        fewer.setattr(run, "LEVELS", LEVELS)
        return measure(replace(model("front_car"), outputs=("inverse_dynamics",)), [BY_NAME["cortex-m4f"]])


@pytest.mark.firmware
def test_a_model_passes_with_the_same_bits_at_every_level(report: TargetReport) -> None:
    assert report.failures == ()
    assert report.vectors["regular"] == 256
    portable = [cell for cell in report.cells if cell.trig == "portable"]
    assert all(cell.different == 0 for cell in portable)
    # the host's gcc at -O2 is what the others are compared with
    on_the_host = set(LEVELS) if shutil.which("clang") else {*LEVELS} - {"-O2"}
    assert {c.level for c in portable if c.where == "host"} == on_the_host
    assert {c.level for c in portable if c.where == "cortex-m4f" and c.compiler != "package"} == {*LEVELS}
    assert any("clang" in note for note in report.notes) == (shutil.which("clang") is None)
    assert {"0", "1", "4"} <= set(report.statuses["float32"])  # vectors reach what statuses are for
    json.dumps(report.to_json())
    assert "the same bits" in target_tables(report)


@pytest.mark.firmware
def test_the_package_passes_as_its_user_builds_it(report: TargetReport, tool: Callable[[str], str]) -> None:
    tool("cmake")
    cells = {c.scalar: c for c in report.cells if c.compiler == "package"}
    assert set(cells) == {"float64", "float32"}
    assert all(c.where == "cortex-m4f" and c.kernels == 3 and c.records == 48 for c in cells.values())


def _cost(report: TargetReport, level: str, kernel: str = "inverse_dynamics") -> KernelCost:
    return next(c for c in report.cores[0].costs if (c.scalar, c.level, c.kernel) == ("float32", level, kernel))


def test_cost_and_footprint_of_inverse_dynamics_on_a_cortex_m4f(report: TargetReport) -> None:
    fast, small = _cost(report, "-O2"), _cost(report, "-Os")
    assert fast.fewest == fast.most
    assert fast.calls >= 256
    size = small.footprint
    assert size is not None
    assert size.code == size.linked <= 600
    assert size.undefined == ()
    assert size.ram == 0
    assert small.stack <= size.frame < STACK_WATCHED


def test_prepared_parameters_and_given_sines_cost_less(report: TargetReport) -> None:
    plain, prepared, given = (
        _cost(report, "-O2", f"inverse_dynamics{form}").most for form in ("", "_prepared", "_sc")
    )
    assert given < prepared < plain


def test_calls_are_counted_exactly(tool: Callable[[str], str], tmp_path: Path) -> None:
    for name in ARM:
        tool(name)
    shop = Workshop(tmp_path, BY_NAME["cortex-m4f"])
    shop.write({"counted.c": COUNTED})
    image = shop.link("counted", shop.harness("counted.c", 0))
    counts = count_calls(BY_NAME["cortex-m4f"], image, build_counter(tmp_path), addresses(shop, image, ["two", "loop"]))
    assert counts == {"two": (2, 2), "loop": (17, 17)}
    functions = addresses(shop, image, ["outer", "loop"])
    counts = count_calls(BY_NAME["cortex-m4f"], image, build_counter(tmp_path), functions)
    assert counts == {"outer": (20,), "loop": (17,)}  # a call inside a call belongs to the outer one


def test_footprints_see_data_helpers_and_libraries(tool: Callable[[str], str], tmp_path: Path) -> None:
    for name in ARM:
        tool(name)
    shop = Workshop(tmp_path, BY_NAME["cortex-m4f"])
    shop.write({"hungry.c": HUNGRY})
    by_name = footprints(shop, shop.compile("hungry.c", "-O0"), ["with_data", "with_library"])
    assert by_name["with_data"].ram == 12
    assert by_name["with_data"].undefined == ()
    assert by_name["with_library"].undefined == ("sinf",)
    assert by_name["with_library"].linked > by_name["with_library"].code


@pytest.mark.parametrize("name", [core.name for core in CORES])
def test_images_run_on_every_core(tool: Callable[[str], str], tmp_path: Path, name: str) -> None:
    core = BY_NAME[name]
    for needed in ARM if core.family == "arm" else RISCV:
        tool(needed)
    shop = Workshop(tmp_path, core)
    shop.write({"main.c": '#include "board.h"\nint main(void) { board_write(board_open("o", BOARD_WRITE), "ok", 2u);'
                " volatile float x = 2.0f; return x * x == 4.0f ? 0 : 1; }\n"})
    image = shop.link("image", shop.harness("main.c", 0))
    emulate(core, image)
    assert (image.parent / "o").read_bytes() == b"ok"


@pytest.mark.firmware
def test_fused_operations_would_be_noticed(tool: Callable[[str], str], tmp_path: Path) -> None:
    """Compiled against the rules (contraction), the bits differ: what the flags are for, and that a run can fail."""
    for name in ARM:
        tool(name)
    core, program = BY_NAME["cortex-m4f"], programs("front_car")["float32"]
    only = {"float32": replace(program, kernels=tuple(k for k in program.kernels if k.name == "inverse_dynamics"))}
    files = {path.removeprefix("c/"): text for path, text in emit_c(model("front_car"), only["float32"]).items()}
    shop = Workshop(tmp_path, core)
    entries = plain_entries(model("front_car"), only["float32"])
    shop.write({**files, "driver.c": driver_source(model("front_car"), {"float32": entries})})
    states = vectors_of(Reference(model("front_car"))).rounded("float32")
    inputs = tmp_path / states_file("float32")
    inputs.write_bytes(pack_states(states, "float32", model("front_car")))
    results = []
    for name, flags in (("plain", ()), ("fused", ("-std=gnu99", "-ffp-contract=fast"))):
        image = shop.link(name, [*shop.harness("driver.c", 0), shop.compile("front_car_f.c", "-O2", flags=flags)])
        stage(image, [inputs])
        emulate(core, image)
        results.append((image.parent / results_file("float32")).read_bytes())
    plain, fused = (unpack_results(data, entries, len(states)) for data in results)
    units = {"inverse_dynamics": (1.0,) * len(states)}
    assert compare(entries, True, plain, fused, units, 256).wrong
