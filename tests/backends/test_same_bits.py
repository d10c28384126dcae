"""C, Python and the interpreter perform the same operations: outputs agree bit for bit, statuses too."""

from __future__ import annotations

import ctypes
import random
import subprocess
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import shipped
from generated_python import load_generated

from symgen.backends.c.plain import emit_c
from symgen.backends.defaults import default_values
from symgen.backends.literals import round_to
from symgen.backends.locals import array_arguments
from symgen.backends.python.module import emit_python
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Scalar, Status
from symgen.model.model import Model
from symgen.verify.lanes.lane_replay import LaneReplay
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.reference.translation import literal_values

C_NUMBER = {"float64": ctypes.c_double, "float32": ctypes.c_float}
STATES = 3


def states(name: str, scalar: Scalar) -> list[dict[str, list[float]]]:
    """Random states within the ranges, one at the origin, one beyond the range of angles, one not a number."""
    model, source = shipped.model(name), random.Random(5)

    def draw(kind: str) -> list[float]:
        ranges = {"q": "range", "qd": "rate_range", "qdd": "acceleration_range"}
        limits = [(-10, 10)] * model.m if kind == "u" else [getattr(c, ranges[kind]) for c in model.coordinates]
        return [float(np.dtype(scalar).type(source.uniform(float(a), float(b)))) for a, b in limits]

    drawn = [{kind: draw(kind) for kind in ("q", "qd", "qdd", "u")} for _ in range(STATES)]
    for value in (0.0, 1e30, float("nan")):
        drawn.append({kind: [float(np.dtype(scalar).type(value))] * len(numbers) for kind, numbers in drawn[0].items()})
    return [one | _measured(model.measured_places, one, scalar) | _task(model, one, scalar) for one in drawn]


def _measured(places: Sequence[int], state: dict[str, list[float]], scalar: Scalar) -> dict[str, list[float]]:
    """What encoders say a moment later."""
    moved = [float(np.dtype(scalar).type(state["q"][k] + state["qd"][k] / 1024)) for k in places]
    return {"q_m": moved, **{f"{kind}_m": [state[kind][k] for k in places] for kind in ("qd", "qdd")}}


def _task(model: Model, state: dict[str, list[float]], scalar: Scalar) -> dict[str, list[float]]:
    """Where the task is a moment later, at the default parameters."""
    if not model.task:
        return {}
    system, count = ReferenceSystem(model), len(model.task)
    places = [q + qd / 1024 for q, qd in zip(state["q"], state["qd"], strict=True)]
    numbers = [float(x) for x in (*default_parameters(model), *literal_values(system.literals))]
    with np.errstate(invalid="ignore"):
        aim = LaneReplay(system.task_replay).run([*places, *([None] * model.n), *numbers], 1)[:count, 0]
    aims = aim.astype(scalar).astype(float).tolist()
    return {"x_t": aims, "xd_t": state["qd"][:count], "xdd_t": state["qdd"][:count]}


@cache
def expected(name: str, quantity: str, scalar: Scalar) -> list[tuple[Status, list[float]]]:
    (kernel,) = (kernel for kernel in shipped.short(name, scalar).kernels if kernel.name == quantity)
    interpreter = Interpreter(shipped.short(name, scalar).sincos, scalar)
    parameters = [round_to(scalar, value) for value in default_values(shipped.model(name)).values()]
    return [interpreter.run(kernel, state, parameters) for state in states(name, scalar)]


def write(folder: Path, files: Mapping[str, str]) -> None:
    for path, text in files.items():
        (folder / Path(path).name).write_text(text)


def same(values: list[float], wanted: list[float]) -> bool:
    return np.asarray(values).tobytes() == np.asarray(wanted).tobytes()


@pytest.mark.toolchain
@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("name", shipped.sparing(shipped.SWEPT))
def test_c(tool: Callable[[str], str], tmp_path: Path, name: str, scalar: Scalar) -> None:
    suffix = "" if scalar == "float64" else "_f"
    write(tmp_path, emit_c(shipped.model(name), shipped.short(name, scalar)))
    library = tmp_path / "lib.so"
    flags = ["-std=c99", "-O1", "-ffp-contract=off", "-shared", "-fPIC", "-o", str(library)]
    subprocess.run([tool("gcc"), *flags, str(tmp_path / f"{name}{suffix}.c"), "-lm"], check=True)
    loaded = ctypes.CDLL(str(library))
    count = max(1, len(shipped.model(name).parameters))
    parameters = type("Parameters", (ctypes.Structure,), {"_fields_": [("all", C_NUMBER[scalar] * count)]})
    default = getattr(loaded, f"{name}_default_params{suffix}")
    default.restype = parameters
    p = default()
    for kernel in shipped.short(name, scalar).kernels:
        function = getattr(loaded, f"{name}_{kernel.name}{suffix}")
        for state, (status, wanted) in zip(states(name, scalar), expected(name, kernel.name, scalar), strict=True):
            arrays = [(C_NUMBER[scalar] * a.length)(*state[a.name]) for a in array_arguments(kernel)]
            output = (C_NUMBER[scalar] * len(kernel.outputs))(*[7.0] * len(kernel.outputs))
            assert function(*arrays, ctypes.byref(p), output) == status, (kernel.name, state)
            wanted = wanted if status is Status.OK else [7.0] * len(kernel.outputs)
            assert same(list(output), wanted), (kernel.name, state)


@pytest.mark.slow
@pytest.mark.parametrize("name", shipped.sparing(shipped.SWEPT))
def test_python(tmp_path: Path, name: str) -> None:
    write(tmp_path, emit_python(shipped.model(name), shipped.short(name, "float64")))
    module = load_generated(tmp_path / f"{name}.py")
    drawn = states(name, "float64")
    for kernel in shipped.short(name, "float64").kernels:
        batch = getattr(module, kernel.name)(*(np.array([s[a.name] for s in drawn]) for a in array_arguments(kernel)))
        assert batch.shape == (len(drawn), *kernel.shape)
        for state, row, (status, wanted) in zip(drawn, batch, expected(name, kernel.name, "float64"), strict=True):
            if status is Status.OK:
                assert same(row.ravel(), wanted), (kernel.name, state)
                continue
            assert np.isnan(row).all(), (kernel.name, state)
            with pytest.raises(module.StateError) as caught:
                getattr(module, kernel.name)(*(state[a.name] for a in array_arguments(kernel)))
            assert caught.value.status == status, (kernel.name, state)
