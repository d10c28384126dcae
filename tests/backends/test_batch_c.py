"""Batch kernels: the bits and the statuses of the kernel for one state, for any count, stride, compiler and flags."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import handmade
import numpy as np
import pytest
import shipped
from batch_library import NATIVE, Library

from symgen.backends.c.batch import BLOCK, VECTOR, emit_c_batch
from symgen.backends.c.plain import emit_c
from symgen.backends.quantities import BATCHED
from symgen.ir.kernel import Kernel, Program, Scalar, Status
from symgen.model.quantities import MAIN

pytestmark = pytest.mark.toolchain
MODELS = ("front_car", "rapkm_2rrr_rr")


def rows_of(kernel: Kernel, dtype: Any, stride: int) -> dict[str, Any]:
    """Random components, (length, stride) each; every seventh state is a hard one."""
    source = np.random.default_rng(11)
    rows = {a.name: source.normal(size=(a.length, stride)).astype(dtype) for a in kernel.arguments}
    for k, value in zip(range(3, stride, 7), [0.0, np.nan, np.inf, 1e30, -101.0, 1e5, 1e-30] * stride, strict=False):
        name = [*rows][k % len(rows)] if value != 0.0 else "q"
        rows[name][k % len(rows[name]) if value != 0.0 else slice(None), k] = value
    return rows


def batched(program: Program) -> Program:
    """u, q̈ and λ, for the sake of the compiler's time; what encoders and a task determine wants other states."""
    return replace(program, kernels=tuple(kernel for kernel in program.kernels if kernel.name in MAIN))


@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("name", shipped.sparing(["toy", "toy with libm", *MODELS]))
def test_same_bits_and_statuses(tool: Callable[[str], str], tmp_path: Path, name: str, scalar: Scalar) -> None:
    if name in MODELS:
        model, program = shipped.model(name), batched(shipped.programs(name)[scalar])
    else:
        model, program = handmade.model(), batched(handmade.program(scalar, own_sincos=name == "toy"))
    library = Library(tmp_path, model, program, [tool("gcc"), *NATIVE])
    for kernel in program.kernels:
        count = 3 * BLOCK + 5
        rows = rows_of(kernel, library.dtype, count + 2)
        refused, statuses, results = library.batch(kernel, rows, count)
        wanted = [library.one(kernel, rows, k) for k in range(count)]
        assert statuses[:count].tolist() == [status for status, _ in wanted]
        assert refused == np.count_nonzero(statuses[:count])
        assert 0 < refused < count / 2
        for k, (status, entries) in enumerate(wanted):
            assert np.isnan(results[:, k]).all() if status else results[:, k].tobytes() == entries.tobytes(), k
        assert (results[:, count:] == 7.0).all(), "states beyond the count are written"
        assert (statuses[count:] == 99).all()


@pytest.mark.parametrize("count", [0, 1, VECTOR - 1, VECTOR, VECTOR + 1, BLOCK - 1, BLOCK, BLOCK + 1])
def test_any_count_in_place_and_without_statuses(tool: Callable[[str], str], tmp_path: Path, count: int) -> None:
    program = handmade.program()
    library = Library(tmp_path, handmade.model(), program, [tool("gcc"), "-O1"])
    kernel = next(k for k in program.kernels if k.name in BATCHED)
    rows = rows_of(kernel, library.dtype, BLOCK + 3)
    refused, _, expected = library.batch(kernel, rows, count)
    for place in rows:
        copies = {name: array.copy() for name, array in rows.items()}
        again, _, result = library.batch(kernel, copies, count, copies[place], with_status=False)
        assert again == refused
        assert result[:, :count].tobytes() == expected[:, :count].tobytes(), place


@pytest.mark.parametrize("scalar", shipped.SCALARS)
def test_several_threads_make_the_same_of_every_state(
    tool: Callable[[str], str], tmp_path: Path, scalar: Scalar, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    name = "front_car"
    model, program = shipped.model(name), batched(shipped.programs(name)[scalar])
    folders = tmp_path / "one", tmp_path / "several"
    for folder in folders:
        folder.mkdir()
    one, several = (
        Library(folder, model, program, [tool("gcc"), *NATIVE, *flags])
        for folder, flags in zip(folders, ([], ["-fopenmp"]), strict=True)
    )
    symbols = subprocess.run(["nm", str(folders[1] / "lib.so")], capture_output=True, text=True, check=True).stdout
    assert "GOMP_parallel" in symbols
    for kernel in program.kernels:
        for count in (63 * BLOCK, 70 * BLOCK + 5):
            rows = rows_of(kernel, one.dtype, count + 2)
            refused, statuses, results = one.batch(kernel, rows, count)
            again, statuses_again, results_again = several.batch(kernel, rows, count)
            assert again == refused > 0
            assert statuses_again.tobytes() == statuses.tobytes()
            assert results_again.tobytes() == results.tobytes()


def test_nested_checks_tell_their_statuses(tool: Callable[[str], str], tmp_path: Path) -> None:
    program = handmade.program()
    library = Library(tmp_path, handmade.model(), program, [tool("gcc"), "-O3"])
    kernel = next(k for k in program.kernels if k.name in BATCHED)
    states = [(1.0, 0.3), (1e-5, 0.3), (0.05, 1.41), (1.0, 101.0), (1.0, np.nan), (np.nan, 0.3), (np.inf, 0.3)]
    rows = {"q": np.array(states).T.copy(), "qd": np.zeros((2, 7)), "qdd": np.zeros((2, 7))}
    refused, statuses, _ = library.batch(kernel, rows, len(states))
    names = [Status(status).name for status in statuses]
    assert names == ["OK", "ACTUATION_RANK", "CONSTRAINT_RANK", *["ANGLE_RANGE"] * 2, "ACTUATION_RANK", "NOT_FINITE"]
    assert refused == 6


@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("flags", [["-O2"], ["-O3"], ["-O3", "-march=native"]], ids=" ".join)
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize(
    ("name", "quantity"),
    [
        ("front_car", "inverse_dynamics"),
        ("five_bar", "configuration_from_task"),  # in closed form
        ("delta", "configuration_from_measured"),  # by steps
    ],
)
def test_loop_over_states_is_vector_code(
    tool: Callable[[str], str],
    tmp_path: Path,
    name: str,
    quantity: str,
    compiler: str,
    flags: list[str],
    scalar: Scalar,
) -> None:
    """The compilers' own reports name the loop; `-fno-math-errno` is for square roots (README)."""
    model, whole = shipped.model(name), shipped.programs(name)[scalar]
    program = replace(whole, kernels=tuple(kernel for kernel in whole.kernels if kernel.name == quantity))
    files = emit_c_batch(model, program)
    header = emit_c(model, program)
    for path, text in (files | header).items():
        (tmp_path / Path(path).name).write_text(text)
    source = next(tmp_path / Path(path).name for path in files if path.endswith(".c"))
    reporting = ["-fopt-info-vec-optimized"] if compiler == "gcc" else ["-Rpass=loop-vectorize"]
    common = ["-std=c99", "-ffp-contract=off", "-fno-math-errno", "-c", "-o", str(tmp_path / "out.o")]
    command = [tool(compiler), *flags, *reporting, *common, str(source)]
    report = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    lines = source.read_text().splitlines()
    loops = [k for k, line in enumerate(lines, 1) if "k < lanes" in line and "= from[0][k]" in lines[k]]
    assert len(loops) == 1
    assert f":{loops[0]}:" in report, f"line {loops[0]} of {source.name} is not vectorised"


def test_no_batch_without_a_quantity_for_it() -> None:
    program = Program("float64", None, (handmade.mass_matrix(),))
    assert emit_c_batch(handmade.model(), program) == {}
