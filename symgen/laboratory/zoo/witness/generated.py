"""What the command made, called as its users call it: the Python module, the C of both types as a library."""

from __future__ import annotations

import ctypes
import importlib.util
import itertools
import re
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from symgen.laboratory.zoo.witness.states import FloatState

ARGUMENTS = {
    "inverse_dynamics": ("q", "qd", "qdd"),
    "forward_dynamics": ("q", "qd", "u"),
    "multipliers": ("q", "qd", "u"),
}
MEMBER = re.compile(r"^ {4}(?:double|float) (\w+);", re.M)
# compiled quickly: verification has run what a compiler makes of it with optimization
FLAGS = ("-O0", "-ffp-contract=off", "-fPIC", "-shared")

_libraries = itertools.count()


@dataclass(frozen=True)
class Answer:
    """What a kernel gave: a status, and the result where that is 0."""

    status: int
    value: tuple[float, ...]


@dataclass(frozen=True)
class Target:
    """One way to call what was generated."""

    name: str
    scalar: str
    quantities: tuple[str, ...]
    parameters: tuple[str, ...]
    call: Callable[[str, FloatState, int], Answer]


def targets(folder: Path, model: str) -> list[Target]:
    """Python, and the C of both types."""
    present = []
    if (folder / "python" / f"{model}.py").exists():
        present.append(_python(folder / "python" / f"{model}.py"))
    for scalar, suffix in (("float64", ""), ("float32", "_f")):
        if (folder / "c" / f"{model}{suffix}.c").exists():
            present.append(_c(folder / "c", model, scalar, suffix))
    return present


def _given(quantity: str, state: FloatState) -> list[tuple[float, ...]]:
    """The arguments of a kernel; a model without inputs has none."""
    values = [getattr(state, name) for name in ARGUMENTS[quantity]]
    return [value for value in values if value is not state.u or value]


def _python(path: Path) -> Target:
    spec = importlib.util.spec_from_file_location(f"zoo_{next(_libraries)}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    names = tuple(getattr(module.Parameters, "__dataclass_fields__", {}))

    def call(quantity: str, state: FloatState, _count: int) -> Answer:
        values = dict(zip(names, state.parameters, strict=True))
        try:
            result = getattr(module, quantity)(*_given(quantity, state), p=module.Parameters(**values))
        except module.StateError as singular:
            return Answer(int(singular.status), ())
        return Answer(0, tuple(float(x) for x in result.reshape(-1)))

    offered = tuple(name for name in ARGUMENTS if hasattr(module, name))
    return Target("Python", "float64", offered, names, call)


def _c(folder: Path, model: str, scalar: str, suffix: str) -> Target:
    source, header = folder / f"{model}{suffix}.c", folder / f"{model}{suffix}.h"
    # a name of its own each time: what is loaded once under a name is not looked at again
    library = folder / f"zoo_{next(_libraries)}{suffix}.so"
    subprocess.run(["gcc", *FLAGS, "-o", str(library), str(source), "-lm"], check=True, capture_output=True)
    text = header.read_text(encoding="utf-8")
    struct = re.search(rf"typedef struct \{{\n(.*?)\}} {model}_params{suffix};", text, re.S)
    names = tuple(MEMBER.findall(struct[1])) if struct else ()
    loaded = ctypes.CDLL(str(library))
    number = ctypes.c_double if scalar == "float64" else ctypes.c_float

    def array(values: Sequence[float]) -> Any:
        return (number * max(1, len(values)))(*values)

    def call(quantity: str, state: FloatState, count: int) -> Answer:
        function = getattr(loaded, f"{model}_{quantity}{suffix}")
        function.restype = ctypes.c_int
        out = array([0.0] * count)
        given = [array(values) for values in _given(quantity, state)]
        status = function(*given, array(state.parameters), out)
        return Answer(status, tuple(float(x) for x in out[:count]) if not status else ())

    offered = tuple(name for name in ARGUMENTS if f" {model}_{name}{suffix}(" in text)
    return Target(f"C {scalar}", scalar, offered, names, call)
