"""Kernels with twice the digits in C and Python: the bits of the interpreter, by tables of steps in C."""

from __future__ import annotations

import ctypes
import random
import subprocess
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from math import inf
from pathlib import Path

import numpy as np
import pytest
import shipped
from generated_python import load_generated

from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.bodies.steps import table
from symgen.backends.c.given_sines import emit_c_sc
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.backends.defaults import default_values
from symgen.backends.literals import round_to
from symgen.backends.locals import array_arguments
from symgen.backends.python.module import emit_python
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Kernel, Program, Scalar, Status
from symgen.ir.pairs.wide import widened
from symgen.ir.split import names_in, names_of_check

# A car that may stand across its way, masses on a rope, and a parallel robot: tests, roots, choices and functions.
MODELS = ("rear_car", "rapkm_two_drives")
QUANTITIES = {"inverse_dynamics", "forward_dynamics", "multipliers", "singularity", "mass_matrix"}
C_NUMBER = {"float64": ctypes.c_double, "float32": ctypes.c_float}
STATES = 4


@cache
def program(name: str, scalar: Scalar) -> Program:
    """Some of the kernels, every other one with twice the digits."""
    whole = shipped.programs(name)[scalar]
    kernels = [kernel for kernel in whole.kernels if kernel.name in QUANTITIES]
    return replace(whole, kernels=tuple(widened(k, scalar) if n % 2 == 0 else k for n, k in enumerate(kernels)))


@cache
def expected(name: str, scalar: Scalar) -> dict[str, list[tuple[Status, list[float]]]]:
    interpreter = Interpreter(program(name, scalar).sincos, scalar)
    given, drawn = parameters(name, scalar), states(name, scalar)
    return {k.name: [interpreter.run(k, one, given) for one in drawn] for k in program(name, scalar).kernels}


def parameters(name: str, scalar: Scalar) -> list[float]:
    return [round_to(scalar, value) for value in default_values(shipped.model(name)).values()]


def states(name: str, scalar: Scalar) -> list[dict[str, list[float]]]:
    """Random ones, one at the origin, one that is not finite."""
    model, source, kind = shipped.model(name), random.Random(7), np.dtype(scalar).type
    sizes = {"q": model.n, "qd": model.n, "qdd": model.n, "u": model.m}

    def draw(count: int) -> list[float]:
        return [float(kind(source.uniform(-1, 1))) for _ in range(count)]

    drawn = [{k: draw(n) for k, n in sizes.items()} for _ in range(STATES)]
    drawn += [{k: [value] * n for k, n in sizes.items()} for value in (0.0, float("nan"))]
    return drawn


def same(values: list[float], wanted: list[float]) -> bool:
    return np.asarray(values).tobytes() == np.asarray(wanted).tobytes()


@pytest.mark.toolchain
@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("level", ["-O0", "-O2"])
@pytest.mark.parametrize("name", shipped.sparing(MODELS))
def test_c(tool: Callable[[str], str], tmp_path: Path, name: str, scalar: Scalar, level: str) -> None:
    """One state at a time, and many, without a warning; nothing is prepared, no sines are given."""
    model, made = shipped.model(name), program(name, scalar)
    wide = replace(made, kernels=made.kernels[::2])
    assert emit_c_prepared(model, wide) == {}
    assert emit_c_sc(model, wide) == {}
    for path, text in (emit_c(model, made) | emit_c_batch(model, made)).items():
        (tmp_path / Path(path).name).write_text(text, encoding="utf-8")
    library = tmp_path / "lib.so"
    flags = ["-std=c99", level, "-Werror", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion"]
    sources = [str(path) for path in sorted(tmp_path.glob("*.c"))]
    command = [tool("gcc"), *flags, "-ffp-contract=off", "-shared", "-fPIC", "-o", str(library), *sources, "-lm"]
    subprocess.run(command, check=True)
    loaded, number = ctypes.CDLL(str(library)), C_NUMBER[scalar]
    suffix = "" if scalar == "float64" else "_f"
    p = (number * max(1, len(model.parameters)))(*parameters(name, scalar))
    for kernel in made.kernels:
        wanted, size = expected(name, scalar)[kernel.name], len(kernel.outputs)
        for state, (status, entries) in zip(states(name, scalar), wanted, strict=True):
            arrays = [(number * a.length)(*state[a.name]) for a in array_arguments(kernel)]
            output = (number * size)(*[7.0] * size)
            assert getattr(loaded, f"{name}_{kernel.name}{suffix}")(*arrays, p, output) == status, (kernel.name, state)
            assert same(list(output), entries if status is Status.OK else [7.0] * size), (kernel.name, state)
        batch = getattr(loaded, f"{name}_{kernel.name}_batch{suffix}", None)
        if batch is not None:
            count, drawn = len(wanted), states(name, scalar)
            columns = [np.array([one[a.name] for one in drawn], scalar).T.copy() for a in array_arguments(kernel)]
            arrays = [column.ctypes.data_as(ctypes.c_void_p) for column in columns]
            outputs, codes = np.empty((size, count), scalar), np.full(count, 9, np.uint8)
            pointers = (outputs.ctypes.data_as(ctypes.c_void_p), codes.ctypes.data_as(ctypes.c_void_p))
            refused = batch(ctypes.c_size_t(count), ctypes.c_size_t(count), *arrays, p, *pointers)
            assert refused == sum(status is not Status.OK for status, _ in wanted)
            assert [*codes] == [status for status, _ in wanted]
            for place, (status, entries) in enumerate(wanted):
                assert status is not Status.OK or same(outputs[:, place].astype(float).tolist(), entries)


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_python(tmp_path: Path, name: str) -> None:
    model, made = shipped.model(name), program(name, "float64")
    ((path, text),) = emit_python(model, made).items()
    file = tmp_path / Path(path).name
    file.write_text(text, encoding="utf-8")
    module = load_generated(file)
    for kernel in made.kernels:
        wanted = expected(name, "float64")[kernel.name]
        for state, (status, entries) in zip(states(name, "float64"), wanted, strict=True):
            arguments = [np.array([state[a.name]] * 2) for a in array_arguments(kernel)]
            outputs = getattr(module, kernel.name)(*arguments) if arguments else None
            if outputs is not None and status is Status.OK:
                assert same(outputs[1].ravel().tolist(), entries), (kernel.name, state)
            elif outputs is not None:
                assert np.isnan(outputs).all()


def alive_at_once(kernel: Kernel) -> int:
    """The most values that are known at one step and read then or later, its own results among them."""
    known, last = {load.local: -1 for load in kernel.loads}, {load.local: -1 for load in kernel.loads}
    count = 0
    for block in kernel.blocks:
        for step, statement in enumerate(block.statements, count):
            known |= dict.fromkeys(statement.targets, step)
            last |= dict.fromkeys((*names_in(statement.operands), *statement.targets), step)
        count += len(block.statements)
        last |= {name: count - 0.5 for check in block.checks for name in names_of_check(check)}
    last |= dict.fromkeys(names_in(kernel.outputs), inf)
    return max(sum(known[name] <= k <= last[name] for name in known) for k in range(count))


def test_values_share_places() -> None:
    """As many as are alive at once, and numbers."""
    made = program("rapkm_two_drives", "float64")
    kernel = max(made.kernels[::2], key=lambda one: len(one.statements))
    step_table = table(kernel, made)
    assert len(step_table.rows) == len(kernel.statements)
    assert step_table.size == len(step_table.constants) + alive_at_once(kernel) < len(step_table.rows) / 2
    assert max(place for row in step_table.rows for place in row[1:]) < step_table.size
