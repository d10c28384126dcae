"""Causes of failures that are told apart in functions of their own: where registers run out, with the same statuses."""

from __future__ import annotations

import ctypes
import math
import re
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
import shipped

from symgen.backends.c.given_sines import emit_c_sc
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Kernel, Program, Status
from symgen.ir.library_trig import with_library_trig
from symgen.ir.order import REGISTERS, waits
from symgen.ir.split import names_of_blocks
from symgen.lowering import schedule as lowering
from symgen.lowering.schedule import schedule
from symgen.model.configurations.mechanics import default_values
from symgen.quantities.select import derive_quantities

QUANTITY = "inverse_dynamics"
REGULAR = {"a_1": 0.3, "a_2": 0.3, "a_3": 0.3, "x": 0.02, "y": -0.03, "z": -0.75}


@cache
def program(name: str) -> Program:
    selection = derive_quantities(shipped.model(name), (QUANTITY,))
    return schedule(selection.mechanics, selection.quantities, ("float64",))["float64"]


def kernel(name: str) -> Kernel:
    (single,) = program(name).kernels
    return single


def states() -> dict[Status, list[float]]:
    """A state of the Delta robot for each status."""
    values = default_values(shipped.model("delta").parameters)
    flat = REGULAR | {"z": -values["l_1"] * math.sin(0.3)}  # all rods in the plane of their elbows
    reach = values["R"] - values["r"] + values["l_1"] * math.cos(0.3)
    met = flat | {"x": reach, "y": 0.0}  # the ball of rod 1 in its elbow: a row of B is zero
    return {
        Status.OK: list(REGULAR.values()),
        Status.ACTUATION_RANK: list(flat.values()),
        Status.CONSTRAINT_RANK: list(met.values()),
    }


def test_where_registers_run_out_nothing_waits_for_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    usual = kernel("delta")
    monkeypatch.setattr(lowering, "REGISTERS", 1000)
    (together,) = program.__wrapped__("delta").kernels
    assert not any(check.apart for block in together.blocks for check in block.checks)
    assert waits(together) >= REGISTERS > waits(usual)
    (check,) = (check for block in usual.blocks for check in block.checks if check.first is not None)
    assert check.apart
    assert check.first is not None
    loads = {load.local for load in usual.loads}
    own = {target for statement in check.first.statements for target in statement.targets}
    pairs = {t for s in usual.statements if s.operation == "sincos" for t in s.targets}
    assert names_of_blocks([check.first]) <= loads | own | pairs


@pytest.mark.parametrize("name", ["rapkm_2rrr_rr", "front_car", "slider_crank"])
def test_where_registers_suffice_causes_share_what_there_is(name: str) -> None:
    assert waits(kernel(name)) < REGISTERS
    assert not any(check.apart for block in kernel(name).blocks for check in block.checks)


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_c_tells_the_causes_as_the_kernel_does(tool: Callable[[str], str], tmp_path: Path, compiler: str) -> None:
    model, made = shipped.model("delta"), with_library_trig(program("delta"))
    for path, text in emit_c(model, made).items():
        (tmp_path / Path(path).name).write_text(text, encoding="utf-8")
    target = tmp_path / "delta.so"
    flags = ["-O2", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror", "-fPIC", "-shared"]
    subprocess.run([tool(compiler), *flags, "-o", str(target), str(tmp_path / "delta.c"), "-lm"], check=True)
    library, numbers = ctypes.CDLL(str(target)), default_values(model.parameters)
    structure = type("Params", (ctypes.Structure,), {"_fields_": [(p.name, ctypes.c_double) for p in model.parameters]})
    parameters, u = structure(*(numbers[p.name] for p in model.parameters)), (ctypes.c_double * 3)()
    zeros = [0.0] * model.n
    for status, q in states().items():
        array = ctypes.c_double * model.n
        code = library.delta_inverse_dynamics(array(*q), array(*zeros), array(*zeros), ctypes.byref(parameters), u)
        arguments = {"q": q, "qd": zeros, "qdd": zeros}
        interpreted, _ = Interpreter(None).run(made.kernels[0], arguments, [numbers[p.name] for p in model.parameters])
        assert code == int(interpreted) == int(status)


def test_every_file_of_one_state_has_the_function_once() -> None:
    model, made = shipped.model("delta"), program("delta")
    files = emit_c(model, made) | emit_c_prepared(model, made) | emit_c_sc(model, made)
    for tail in ("", "_prepared", "_sc"):
        text = str(files[f"c/delta{tail}.c"])
        name = f"delta_inverse_dynamics{tail}_cause"
        assert len(re.findall(rf"\nstatic DELTA_APART delta_status {name}\(", text)) == 1
        assert len(re.findall(rf"return {name}\(", text)) == 1
        assert text.count("return DELTA_CONSTRAINT_RANK;") == 1
    assert "APART" not in str(emit_c(shipped.model("front_car"), program("front_car"))["c/front_car.c"])
