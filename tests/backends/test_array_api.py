"""Modules on the array API: the bits and statuses of the interpreter or, with NumPy's sine, of the Python module."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
import types
from dataclasses import replace
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import handmade
import numpy as np
import pytest
import shipped
from test_same_bits import expected, same, states

from symgen.backends.array_api.module import emit_array_api
from symgen.backends.defaults import default_values
from symgen.backends.literals import round_to
from symgen.backends.locals import array_arguments
from symgen.backends.python.module import emit_python
from symgen.generation.results import Options
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Kernel, Program, Scalar, Status
from symgen.ir.library_trig import with_library_trig
from symgen.ir.pairs.wide import widened
from symgen.pipeline import generate
from symgen.verify.run import verify

# Of the standard, 2023.12: https://data-apis.org/array-api/2023.12
_STANDARD = """abs acos all asarray asin atan atan2 broadcast_arrays copysign cos cosh exp float32 float64 full_like
int32 isfinite log nan ones_like pow reshape sin sinh sqrt stack tan tanh where zeros_like"""
STANDARD = set(_STANDARD.split())
# What verification calls is a module of NumPy that raises its own error for a single state.
AS_PYTHON = """
import numpy as np


class StateError(ArithmeticError):
    def __init__(self, status):
        self.status = status


def _called(function):
    def call(*arrays, p=PARAMETERS):
        with np.errstate(all="ignore"):
            result, status = function(np, *map(np.asarray, arrays), p=p)
        if status.ndim == 0 and status:
            raise StateError(Status(int(status)))
        return result
    return call


for _name in _NAMES:
    globals()[_name] = _called(globals()[_name])
"""


def run(text: str) -> types.ModuleType:
    module = types.ModuleType("made")
    exec(compile(text, "<array_api>", "exec"), module.__dict__)
    return module


@cache
def module(name: str, scalar: Scalar) -> types.ModuleType:
    (text,) = emit_array_api(shipped.model(name), shipped.short(name, scalar)).values()
    return run(text)


def with_pair(program: Program) -> types.SimpleNamespace:
    """NumPy with the program's own sine and cosine."""
    assert program.sincos is not None
    interpreter = Interpreter(program.sincos, program.scalar)

    def half(index: int) -> Any:
        return np.vectorize(lambda angle: interpreter._pair(float(angle))[index], otypes=[program.scalar])

    return types.SimpleNamespace(**{**vars(np), "sin": half(0), "cos": half(1)})


def checked(kernel: Kernel, made: tuple[Any, Any], wanted: list[tuple[Status, list[float]]]) -> None:
    values, statuses = made
    assert values.shape == (len(wanted), *kernel.shape)
    assert statuses.tolist() == [int(status) for status, _ in wanted], kernel.name
    for row, (status, numbers) in zip(values, wanted, strict=True):
        assert np.isnan(row).all() if status else same(row.ravel(), list(np.asarray(numbers, row.dtype))), kernel.name


@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("name", shipped.sparing(shipped.SWEPT))
def test_the_interpreters_bits_and_statuses(name: str, scalar: Scalar) -> None:
    program, made = shipped.short(name, scalar), module(name, scalar)
    xp, drawn = with_pair(program), states(name, scalar)
    for kernel in program.kernels:
        arrays = [np.array([state[a.name] for state in drawn], dtype=scalar) for a in array_arguments(kernel)]
        with np.errstate(all="ignore"):
            results = getattr(made, kernel.name)(xp, *arrays)
        assert results[0].dtype == scalar
        checked(kernel, results, expected(name, kernel.name, scalar))


@pytest.mark.parametrize("name", shipped.sparing(["front_car", "rapkm_2rrr_rr"]))
def test_numpy_has_the_bits_of_the_python_module(name: str) -> None:
    model, program = shipped.model(name), with_library_trig(shipped.short(name, "float64"))
    (ours,), (theirs,) = emit_array_api(model, program).values(), emit_python(model, program).values()
    ours, theirs, drawn = run(ours), run(theirs), states(name, "float64")
    for kernel in program.kernels:
        arrays = [np.array([state[a.name] for state in drawn]) for a in array_arguments(kernel)]
        with np.errstate(all="ignore"):
            values, _ = getattr(ours, kernel.name)(np, *arrays)
        assert values.tobytes() == getattr(theirs, kernel.name)(*arrays).tobytes(), kernel.name


@pytest.mark.parametrize("name", ["slider_crank", "rear_car"])
def test_passes_the_verification_of_the_python_module(name: str) -> None:
    kernels = shipped.programs(name)["float64"].kernels
    (text,) = emit_array_api(shipped.model(name), shipped.programs(name)["float64"]).values()
    names = [kernel.name for kernel in kernels]
    assert not verify(shipped.model(name), kernels, {}, f"{text}\n_NAMES = {names}\n{AS_PYTHON}", 8).faults
    wrong = text.replace(" - ", " + ")
    assert verify(shipped.model(name), kernels, {}, f"{wrong}\n_NAMES = {names}\n{AS_PYTHON}", 8).faults


@pytest.mark.parametrize("scalar", shipped.SCALARS)
def test_statements_by_hand(scalar: Scalar) -> None:
    """Every kind of statement, nested checks, constants, half a pair, names that C alone has taken."""
    program, model = handmade.program(scalar), handmade.model()
    (text,) = emit_array_api(model, program).values()
    made, xp = run(text), with_pair(program)
    assert made.PARAMETERS._fields == ("L", "I", "half_turn", "root")
    q = [[0.7, 0.3], [0.0, 0.2], [1e-5, 1.2], [-2.0, 1.5708], [float("inf"), 0.1], [0.3, 200.0]]
    parameters = [round_to(scalar, value) for value in default_values(model).values()]
    rounded = np.array(q, dtype=scalar)
    for kernel in program.kernels:
        rest = [np.ones((1, argument.length), dtype=scalar) for argument in kernel.arguments[1:]]
        states = [{"q": row, "qd": [1.0, 1.0], "qdd": [1.0, 1.0]} for row in rounded.tolist()]
        wanted = [Interpreter(program.sincos, scalar).run(kernel, state, parameters) for state in states]
        with np.errstate(all="ignore"):
            checked(kernel, getattr(made, kernel.name)(xp, rounded, *rest), wanted)
            value, status = getattr(made, kernel.name)(xp, rounded[0], *(array[0] for array in rest))
        assert value.shape == kernel.shape
        assert status.shape == ()


@pytest.mark.parametrize("scalar", shipped.SCALARS)
def test_parameters_by_state_and_broadcast_arguments(scalar: Scalar) -> None:
    made = module("front_car", scalar)
    masses = np.array([900.0, 1100.0], dtype=scalar)
    q, motion = np.array([0.1, 0.2, 0.3, 0.4], dtype=scalar), np.zeros((2, 4), dtype=scalar)
    several, status = made.inverse_dynamics(np, q, motion, motion + 1, made.PARAMETERS._replace(m_1=masses))
    assert not status.any()
    for row, mass in zip(several, masses, strict=True):
        one, _ = made.inverse_dynamics(np, q, motion[0], motion[0] + 1, made.PARAMETERS._replace(m_1=mass))
        assert same(row, one)
    matrices, status = made.mass_matrix(np, q, made.PARAMETERS._replace(m_1=masses))
    assert matrices.shape == (2, 4, 4)
    assert status.shape == (2,)


def test_other_types_and_shapes_are_refused() -> None:
    q = np.zeros(4)
    with pytest.raises(TypeError, match=r"in float32, expected float64; front_car_f\.py takes the other type"):
        module("front_car", "float64").mass_matrix(np, q.astype(np.float32))
    with pytest.raises(TypeError, match=r"in float64, expected float32; front_car\.py takes"):
        module("front_car", "float32").mass_matrix(np, q)
    with pytest.raises(ValueError, match=r"q has shape \(3,\), expected \(\.\.\., 4\)"):
        module("front_car", "float64").mass_matrix(np, np.zeros(3))


def with_twice_the_digits(name: str, scalar: Scalar) -> Program:
    program = shipped.programs(name)[scalar]
    kernels = (kernel for kernel in program.kernels if kernel.name in ("inverse_dynamics", "singularity"))
    return replace(program, kernels=tuple(widened(kernel, scalar) for kernel in kernels))


@pytest.mark.parametrize("scalar", shipped.SCALARS)
def test_twice_the_digits(scalar: Scalar) -> None:
    program, drawn = with_twice_the_digits("rear_car", scalar), states("rear_car", scalar)
    (text,) = emit_array_api(shipped.model("rear_car"), program).values()
    made, interpreter = run(text), Interpreter(program.sincos, scalar)
    parameters = [round_to(scalar, value) for value in default_values(shipped.model("rear_car")).values()]
    for kernel in program.kernels:
        arrays = [np.array([state[a.name] for state in drawn], dtype=scalar) for a in array_arguments(kernel)]
        with np.errstate(all="ignore"):
            results = getattr(made, kernel.name)(with_pair(program), *arrays)
        checked(kernel, results, [interpreter.run(kernel, state, parameters) for state in drawn])


@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("name", shipped.sparing(shipped.SWEPT))
def test_functions_branch_on_nothing_and_ask_for_nothing_but_the_standard(name: str, scalar: Scalar) -> None:
    for program in (shipped.short(name, scalar), with_twice_the_digits(name, scalar)):
        (text,) = emit_array_api(shipped.model(name), program).values()
        assert set(re.findall(r"\bxp\.(\w+)", text)) <= STANDARD
        kernels = {kernel.name for kernel in program.kernels}
        functions = [node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)]
        assert kernels <= {function.name for function in functions}
        for function in functions:
            if function.name in kernels or function.name.startswith("_wide"):
                kinds = {type(node) for node in ast.walk(function)}
                assert not kinds & {ast.If, ast.IfExp, ast.While, ast.For, ast.BoolOp, ast.Assert, ast.comprehension}


_NAMES = "xp like status entries p_ Status Parameters PARAMETERS index count range type property Any NamedTuple"
NAMES = _NAMES.split()


@pytest.mark.campaign
def test_names_of_a_model_and_of_the_module_do_not_meet(tmp_path: Path) -> None:
    """Parameters called as what the module uses, and by other names; only what is asked for is written."""

    def made(names: list[str]) -> types.ModuleType:
        terms = " + ".join(f"{name}*cos({k + 2}*phi)" for k, name in enumerate(names))
        values = ", ".join(f"{name}: {k + 2}" for k, name in enumerate(names))
        path = tmp_path / "named.yaml"
        path.write_text(
            f"model: named\ncoordinates: {{phi: {{}}}}\nparameters: {{{values}}}\nkinetic_energy: 3*phi_dot**2\n"
            f"potential_energy: {terms}\ninputs: {{u_1: {{acts_on: {{phi: 1}}}}}}\n"
        )
        files = generate(path, Options(parts=("array_api",), states=8), lambda _: None).files
        modules = {"array_api/named.py", "array_api/named_f.py"}
        assert set(files) == modules | {"derivation.json", "certificate.json"}
        assert "Python float64" in files["certificate.json"]
        return run(str(files["array_api/named.py"]))

    arrays = np.random.default_rng(3).uniform(-1, 1, (3, 5, 1))
    clashing, plain = (made(names) for names in (NAMES, [f"c_{k}" for k in range(len(NAMES))]))
    assert clashing.PARAMETERS._fields == tuple(NAMES)
    values, status = clashing.inverse_dynamics(np, *arrays)
    assert not status.any()
    assert values.tobytes() == plain.inverse_dynamics(np, *arrays)[0].tobytes()


# Where `make jax` and `make torch` put them: beside the environment, where nothing else meets them.
BESIDE = {library: shipped.ROOT / "build" / library for library in ("jax", "torch")}
SHOWN = {
    "numpy": "assert u.shape == (1000, 2)",
    "jax": "assert u.shape == (2,)\nassert all(jnp.isfinite(x).all() for x in (u, by_q, *by_p))",
    "torch": "assert u.shape == (1000, 2) and by_q.shape == (1000, 2, 4)\n"
    "assert all(torch.isfinite(x).all() for x in (u, by_q, m_1.grad))",
}


def has(library: str) -> bool:
    """Whether it is there; PyTorch, of 5 GB, is never asked for."""
    if library == "numpy" or BESIDE[library].is_dir() or find_spec(library) is not None:
        return True
    message = f"{library} (make {library}) is not installed"
    if library == "jax" and os.environ.get("SYMGEN_REQUIRE_TOOLS"):
        pytest.fail(message)
    pytest.skip(message)


def run_beside(library: str, folder: Path, program: str) -> str:
    """What a program prints that has the modules of the front car, in a process of its own: the threads of such
    libraries do not outlive it."""
    for scalar in shipped.SCALARS:
        for path, text in emit_array_api(shipped.model("front_car"), shipped.programs("front_car")[scalar]).items():
            (folder / Path(path).name).write_text(text, encoding="utf-8")
    (folder / "program.py").write_text(program, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(BESIDE.get(library, ""))}
    command = [sys.executable, str(folder / "program.py")]
    made = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
    return made.stdout


CAMPAIGN = pytest.mark.campaign


@pytest.mark.parametrize(
    "library", ["numpy", pytest.param("jax", marks=CAMPAIGN), pytest.param("torch", marks=CAMPAIGN)]
)
def test_what_the_page_shows_runs(library: str, tmp_path: Path) -> None:
    assert has(library)
    page = (shipped.ROOT / "docs/array-api.md").read_text(encoding="utf-8")
    (block,) = (one for one in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if f"import {library}" in one)
    run_beside(library, tmp_path, f"{block}\nassert not status.any()\n{SHOWN[library]}\n")


@CAMPAIGN
def test_pytorch_has_the_numbers_of_numpy(tmp_path: Path) -> None:
    """Its sines are its own; statuses, derivatives by vmap and what a tracer makes of a kernel are compared, too."""
    assert has("torch")
    program = """
import numpy as np
import torch
import array_api_compat.torch as xp
import front_car

arrays = np.random.default_rng(5).uniform(-1, 1, (3, 200, 4))
arrays[0, 7, 2] = np.nan
q, qd, qdd = map(torch.tensor, arrays)
u, status = front_car.inverse_dynamics(xp, q, qd, qdd)
expected, codes = front_car.inverse_dynamics(np, *arrays)
assert (status.numpy() == codes).all() and np.isnan(u.numpy()[7]).all() and codes[7] != 0
traced = torch.compile(front_car.inverse_dynamics, backend="eager", fullgraph=True)
assert torch.equal(torch.nan_to_num(traced(xp, q, qd, qdd)[0]), torch.nan_to_num(u))
print(np.nanmax(np.abs(u.numpy() - expected)) / np.nanmax(np.abs(expected)))
jacobian = torch.func.jacrev(lambda a: front_car.inverse_dynamics(xp, q[0], qd[0], a)[0])
by_qdd = torch.func.vmap(jacobian)(qdd[:7])
step = np.array([1.0, 0.0, 0.0, 0.0])
first = arrays[0, 0], arrays[1, 0]
moved = np.subtract(*(front_car.inverse_dynamics(np, *first, arrays[2, :7] + one)[0] for one in (step, 0 * step)))
print(np.abs(by_qdd.numpy()[..., 0] - moved).max() / np.abs(moved).max())
"""
    of_inputs, of_derivatives = map(float, run_beside("torch", tmp_path, program).split())
    # a sine that is off by a unit in the last place, and the difference of two results
    assert of_inputs < 1e-15
    assert of_derivatives < 1e-12
