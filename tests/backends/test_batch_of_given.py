"""Batches of what encoders and a task determine: the bits and statuses of single states, in C and in Python."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shipped
from batch_library import NATIVE, Library
from generated_python import load_generated

from symgen.backends.c.batch import BLOCK, emit_c_batch
from symgen.backends.c.plain import emit_c
from symgen.backends.locals import array_arguments
from symgen.backends.python.module import emit_python
from symgen.ir.kernel import Kernel, Program, Scalar, Status
from symgen.ir.pairs.wide import widened
from symgen.lowering.schedule import schedule
from symgen.model.quantities import GIVEN_MOTIONS, GIVEN_PLACES
from symgen.quantities.select import derive_quantities

pytestmark = pytest.mark.toolchain
# One of closed forms, and one that takes steps from its encoders; the third is long.
MODELS = shipped.sparing(["five_bar", "delta", "rapkm_2rrr_rr"], ("delta", "rapkm_2rrr_rr"))
GIVEN = (*GIVEN_PLACES, *GIVEN_MOTIONS)
COUNT, STRIDE = 3 * BLOCK + 5, 3 * BLOCK + 7
# rad or m between the configuration of the file and those of the states, and from there to what is given.
ASIDE, MOVED = 0.05, 1e-3
HARD = (0.0, np.nan, np.inf, 1e30, -101.0, 1e5, 1e-30)
FAR = (0.3, 1.2, 5.0)


@cache
def programs(name: str) -> dict[Scalar, Program]:
    """With the place of the task, which states are made of."""
    derived = derive_quantities(shipped.model(name), (*GIVEN, "task_position"))
    return schedule(derived.mechanics, derived.quantities, shipped.SCALARS)


def kernel_of(program: Program, quantity: str) -> Kernel:
    (kernel,) = (kernel for kernel in program.kernels if kernel.name == quantity)
    return kernel


def rows_of(name: str, library: Library, program: Program) -> dict[str, Any]:
    """Components, (length, STRIDE) each, of closed configurations and of what is given beside them.

    At every seventh state all is a hard value, and at others the places are far from where the configuration stands.
    """
    model, source = shipped.model(name), np.random.default_rng(5)
    start = np.array([[float(dict(model.configuration)[c.name])] for c in model.coordinates])
    encoders, k = list(model.measured_places), len(model.task)

    def beside(values: Any, most: float) -> Any:
        moved = values + source.uniform(-most, most, (len(values), STRIDE))
        return np.ascontiguousarray(moved.astype(library.dtype))

    near = {"q": beside(start, 0.0), "q_m": beside(start[encoders], ASIDE)}
    refused, _, q = library.batch(kernel_of(program, "configuration_from_measured"), near, STRIDE)
    assert refused == 0
    moved = {"q": beside(q, MOVED)}
    tasks = [library.one(kernel_of(program, "task_position"), moved, state)[1] for state in range(STRIDE)]
    rows = {"q": q, "q_m": beside(q[encoders], MOVED), "x_t": np.ascontiguousarray(np.array(tasks).T)}
    rows |= {argument: beside(np.zeros((len(encoders), 1)), 1.0) for argument in ("qd_m", "qdd_m")}
    rows |= {argument: beside(np.zeros((k, 1)), 1.0) for argument in ("xd_t", "xdd_t")}
    for state, value in zip(range(3, STRIDE, 7), HARD * STRIDE, strict=False):
        for array in rows.values():
            array[:, state] = value
    for state, far in zip(range(5, STRIDE, 14), FAR * STRIDE, strict=False):
        for argument in ("q_m", "x_t"):
            rows[argument][0, state] += far
    return rows


@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("name", MODELS)
def test_same_bits_as_single_states(tool: Callable[[str], str], tmp_path: Path, name: str, scalar: Scalar) -> None:
    program = programs(name)[scalar]
    library = Library(tmp_path, shipped.model(name), program, [tool("gcc"), *NATIVE])
    rows = rows_of(name, library, program)
    statuses = {kernel.name: assert_same(library, kernel, rows) for kernel in program.kernels if kernel.name in GIVEN}
    assert {*statuses} == {*GIVEN}
    for quantity in GIVEN_PLACES:
        assert statuses[quantity] & {Status.BRANCH, Status.NOT_CLOSED}
        assert len(statuses[quantity]) > 2


def assert_same(library: Library, kernel: Kernel, rows: dict[str, Any]) -> set[int]:
    """Results and statuses of every state, of no state beyond them, and where the result takes the place of q.

    Returns the statuses there are.
    """
    refused, statuses, results = library.batch(kernel, rows, COUNT)
    wanted = [library.one(kernel, rows, k) for k in range(COUNT)]
    assert statuses[:COUNT].tolist() == [status for status, _ in wanted]
    assert refused == np.count_nonzero(statuses[:COUNT])
    assert 0 < refused < COUNT / 3, kernel.name
    for k, (status, entries) in enumerate(wanted):
        assert np.isnan(results[:, k]).all() if status else results[:, k].tobytes() == entries.tobytes(), k
    assert (results[:, COUNT:] == 7.0).all(), "states beyond the count are written"
    assert (statuses[COUNT:] == 99).all()
    copies = {name: array.copy() for name, array in rows.items()}
    again, _, result = library.batch(kernel, copies, COUNT, copies["q"], with_status=False)
    assert again == refused
    assert result[:, :COUNT].tobytes() == results[:, :COUNT].tobytes()
    assert result[:, COUNT:].tobytes() == rows["q"][:, COUNT:].tobytes()
    return {status for status, _ in wanted}


@pytest.mark.parametrize("scalar", shipped.SCALARS)
def test_twice_the_digits_run_one_state_after_the_other(
    tool: Callable[[str], str], tmp_path: Path, scalar: Scalar
) -> None:
    plain = programs("five_bar")[scalar]
    wide = widened(kernel_of(plain, "velocity_from_measured"), scalar)
    kernels = tuple(wide if kernel.name == wide.name else kernel for kernel in plain.kernels)
    program = replace(plain, kernels=kernels)
    library = Library(tmp_path, shipped.model("five_bar"), program, [tool("gcc"), "-O1"])
    assert_same(library, wide, rows_of("five_bar", library, program))


@pytest.mark.parametrize("name", MODELS)
def test_python_makes_the_same_of_arrays(
    tool: Callable[[str], str], tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """NumPy and what it compiles, against the C of single states."""
    monkeypatch.setenv("CC", os.environ.get("CC", tool("cc")))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    model, program = shipped.model(name), programs(name)["float64"]
    for path, text in (emit_c(model, program) | emit_c_batch(model, program) | emit_python(model, program)).items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text)
    module = load_generated(tmp_path / f"python/{name}.py")
    compiled = module.compile()
    library = Library(tmp_path, model, program, [tool("gcc"), "-O1"])
    rows = rows_of(name, library, program)
    for kernel in (kernel_of(program, quantity) for quantity in GIVEN):
        states = [rows[argument.name].T for argument in array_arguments(kernel)]
        wanted = [library.one(kernel, rows, k) for k in range(STRIDE)]
        for functions in (module, compiled):
            made = getattr(functions, kernel.name)(*states)
            for k, (status, entries) in enumerate(wanted):
                assert np.isnan(made[k]).all() if status else made[k].tobytes() == entries.tobytes(), (kernel.name, k)
