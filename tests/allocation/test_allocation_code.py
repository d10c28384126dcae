"""Generated code of allocated inputs: members, header, aliases, statuses of weights that are none."""

from __future__ import annotations

import ctypes
import subprocess
from collections.abc import Callable
from pathlib import Path

import allocation_models as models
import pytest
from laws_harness import System

from symgen.backends.c.plain import emit_c
from symgen.backends.python.module import emit_python
from symgen.ir.kernel import Scalar, Status
from symgen.ir.pairs.wide import widened
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import State

BARE = """\
model: bare
coordinates: {x: {}}
kinetic_energy: x_dot**2
inputs: {left: {acts_on: {x: 1}}, right: {acts_on: {x: 2}}}
"""
BLOCK = "allocation: {weights: {left: 2}, preload: 0.5, limits: {right: [-1, 3]}}\n"


def test_header_and_module_say_how_inputs_are_shared() -> None:
    made = System(BARE + BLOCK, ("inverse_dynamics",))
    header = emit_c(made.model, made.program())["c/bare.h"]
    module = emit_python(made.model, made.program())["python/bare.py"]
    for text in (header, module):
        assert "How inverse_dynamics shares the work among the inputs:" in text
        assert "within limit_*, as far as the internal force alone can keep u there" in text
    assert "double weight_left; /**< weight of left in the norm of the inputs; default 2.0 */" in header
    assert "double limit_right_lower; /**< lower limit of right; default -1.0 */" in header
    assert "    preload: float = 0.5  # preload, internal force" in module


@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_limits_work_with_twice_the_digits(scalar: Scalar) -> None:
    """What no limit reaches is taken apart into halves, which 1e38 has none of in float32."""
    made = System(BARE + BLOCK, ("inverse_dynamics",))
    program = made.program()
    state = State((0.5,), (0.25,), (3.0,), (), (2.0, 0.5, -1.0, 3.0))
    plain, pairs = (
        outcomes(kernel, program.sincos, scalar, [state])[0]
        for kernel in (program.kernels[0], widened(program.kernels[0], scalar))
    )
    assert plain.valid
    assert pairs.valid
    assert pairs.entries == pytest.approx(plain.entries, rel=1e-6)


@pytest.mark.toolchain
def test_the_result_may_overwrite_shorter_arguments(tool: Callable[[str], str], tmp_path: Path) -> None:
    """u has two entries, q, qd and qdd one each: they stand in the memory of u."""
    made = System(BARE + BLOCK, ("inverse_dynamics",))
    for path, text in emit_c(made.model, made.program()).items():
        (tmp_path / Path(path).name).write_text(text)
    library = tmp_path / "lib.so"
    command = [tool("cc"), "-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", str(library)]
    subprocess.run([*command, str(tmp_path / "bare.c"), "-lm"], check=True)
    call = ctypes.CDLL(str(library)).bare_inverse_dynamics
    parameters = (ctypes.c_double * 4)(2.0, 0.5, -1.0, 3.0)
    size = ctypes.sizeof(ctypes.c_double)
    for place in (0, 1):
        memory = (ctypes.c_double * 2)(0.3, 0.3)
        memory[place] = 4.0
        zero = (ctypes.c_double * 1)(0.3)
        argument = ctypes.byref(memory, place * size)
        assert call(zero, zero, argument, parameters, memory) == 0
        _, wanted = made.run("inverse_dynamics", made.state([0.3], [0.3], [4.0]))
        assert list(memory) == wanted


@pytest.mark.parametrize(
    ("weights", "status"),
    [
        ((2.0, 3.0), Status.OK),
        ((0.0, 3.0), Status.OK),
        ((0.0, 0.0), Status.ACTUATION_RANK),
        ((-2.0, -3.0), Status.ACTUATION_RANK),
        ((float("nan"), 1.0), Status.ACTUATION_RANK),
    ],
)
def test_weights_that_are_none(weights: tuple[float, float], status: Status) -> None:
    made = System(f"{models.AXIS}allocation: {{weights: {{left: 1, right: 1}}}}\n", ("inverse_dynamics",))
    state = made.state([0.1])
    changed = State(state.q, state.qd, state.qdd, state.u, (state.parameters[0], *weights))
    assert made.run("inverse_dynamics", changed)[0] is status
